//! Massless rods: tension and path of a pendulum, and a linkage that must be that with a link of no mass.

use crate::support::{difference, run, run_scene};
use ladder::{Rung, Worst};
use looselink::scene::Scene;

/// A point mass on a rod; released where the rod is level.
const PENDULUM: &str = r#"
format = 1
title = "a point mass on a rod"
simulation = { duration = 2.0, gravity = [0.0, -9.81] }
integrator = { method = "dormand_prince", step = 1e-3 }
output = { interval = 1e-2, channels = ["bob.*", "rod.*", "energy.*"] }
bodies.ground = { type = "ground", points.top = [0.1, 0.2] }
bodies.bob = { type = "point_mass", mass = 0.7 }
joints.rod = { type = "rod", first = "ground.top", second = "bob.center", length = 0.5 }
initial.bodies.bob = { x = 0.6, y = 0.2 }
"#;

/// With the height y below the level of the start the speed is sqrt(2 g y), and the tension 3 m g y/l.
#[test]
fn a_rod_pulls_as_the_string_of_a_pendulum() {
    let scene = Scene::parse("rod", PENDULUM, &[]).unwrap();
    let (run, _) = run_scene(&scene);
    let [length, tension] = [Worst::new(), Worst::new()];
    let names = ["bob.x", "bob.y", "rod.fx", "rod.fy"];
    let [x, y, fx, fy] = names.map(|name| run.get(name));
    for row in 0..run.len() {
        let r = [x[row] - 0.1, y[row] - 0.2];
        length.see(r[0].hypot(r[1]) / 0.5 - 1.0);
        let pull = -(fx[row] * r[0] + fy[row] * r[1]) / 0.5;
        tension.see((pull + 3.0 * 0.7 * 9.81 * r[1] / 0.5) / (3.0 * 0.7 * 9.81));
    }
    assert!(
        fy.iter().any(|f| *f > 20.0),
        "the bob passes its lowest point"
    );
    Rung::Routes
        .asks("Point mass on a rod: change of the length, relative")
        .within(
            &length,
            1e-14,
            "every step ends on the constraint: rounding",
        );
    Rung::Routes
        .asks("Point mass on a rod, released where it is level: tension against 3 m g y/l, relative to the largest")
        .within(&tension, 1e-9, "steps of 1/1400 of a period, order 5: (2 pi/1400)^5 = 2e-12 a step, 2000 steps");
}

/// A rod is a rigid link without mass: one of 3e-7 kg between discs of 2.5 kg and more.
#[test]
fn a_rod_is_a_link_without_mass() {
    let link = [
        "materials.nothing={density=7.85e-3}",
        "sections={thin={width=0.01,height=0.01}}",
        "bodies.bar={type=\"link\",model=\"rigid\",length=0.4,section=\"thin\",material=\"nothing\"}",
        "joints.rod={type=\"revolute\",bearing=\"small.rim\",journal=\"bar.start\",model=\"ideal\"}",
        "joints.other={type=\"revolute\",bearing=\"bar.end\",journal=\"large.rim\",model=\"ideal\"}",
    ];
    let [rod, link] = [&[][..], &link].map(|overrides| run("rod-linkage.toml", overrides).0);
    let names = [
        "large.theta",
        "large.omega",
        "large.alpha",
        "axle.torque",
        "rod.fx",
        "rod.fy",
    ];
    let worst = difference([&rod, &link], names, 0.0);
    Rung::Routes
        .asks("Two discs joined by a rod, and by a rigid link of 1e-7 of their mass: difference of angle, rates, torque and force, relative to the largest value")
        .within(&worst, 1e-6, "the inertia of the link: 1.2e-7 of that of the discs, times accelerations up to a few times theirs");
}

#[test]
fn a_rod_needs_a_length() {
    for (change, told) in [
        ("joints.rod.length=0.0", "`joints.rod.length` must be"),
        ("joints.rod.size=1.0", "unknown key"),
        (
            "joints.rod.second=\"ground.top\"",
            "connects a body to itself",
        ),
    ] {
        let error = Scene::parse("rod", PENDULUM, &[change.to_owned()]).unwrap_err();
        assert!(error.to_string().contains(told), "{change}: {error}");
    }
}

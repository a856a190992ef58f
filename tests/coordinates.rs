//! Coordinates of rigid bodies: which ones a scene gets, and that the motion is the same in all of them.

use crate::support::{NATURAL, load, run, run_scene};
use ladder::{Rung, Worst};
use looselink::scene::Scene;
use looselink::simulate::Simulation;
use std::collections::BTreeMap;

const CENTRED: [&str; 3] = [
    "bodies.link1.coordinates=\"center\"",
    "bodies.link2.coordinates=\"center\"",
    "bodies.link3.coordinates=\"center\"",
];

/// Numbers of unknowns and multipliers.
fn size(scene: &str, overrides: &[&str]) -> [usize; 2] {
    let simulation = Simulation::new(&load(scene, overrides)).unwrap();
    let shape = simulation.model().shape();
    [shape.unknowns, shape.multipliers]
}

#[test]
fn links_that_share_no_node_have_the_coordinates_of_their_centres() {
    assert_eq!(size("3rrr/case3.toml", &[]), [12, 0]);
    assert_eq!(size("3rrr/case3.toml", &NATURAL), [15, 3]);
    // B1 makes the start of link1 the end of the driven crank
    let ideal = "joints.B1={type=\"revolute\",bearing=\"crank1.end\",journal=\"link1.start\",model=\"ideal\"}";
    assert_eq!(size("3rrr/case3.toml", &[ideal]), [10, 0]);
    let natural = NATURAL[0];
    assert_eq!(size("3rrr/case3.toml", &[ideal, natural]), [11, 1]);
    // C1 is at a corner of the platform: two rows keep the end of link1 there
    let ideal = "joints.C1={type=\"revolute\",bearing=\"platform.C1\",journal=\"link1.end\",model=\"ideal\"}";
    assert_eq!(size("3rrr/case3.toml", &[ideal]), [12, 2]);
    assert_eq!(size("3rrr/case1.toml", &[]), [6, 6]);
    assert_eq!(size("3rrr/case1.toml", &NATURAL), [9, 9]);
    // the cranks are driven
    let simulation = Simulation::new(&load("3rrr/case3.toml", &NATURAL[2..])).unwrap();
    let notes = simulation.inspect().assumptions;
    for expected in [
        "rigid links with x, y of their centres of mass and theta: link1, link2",
        "rigid links with natural coordinates, x, y of their ends: link3",
    ] {
        assert!(notes.iter().any(|note| note == expected), "{notes:?}");
    }
}

#[test]
fn a_body_that_one_joint_holds_has_the_coordinate_of_this_joint() {
    const CENTER: &str = "bodies.rod.coordinates='center'";
    assert_eq!(size("pendulum.toml", &[]), [1, 0]);
    assert_eq!(size("pendulum.toml", &[CENTER]), [3, 2]);
    let loose = |overrides: &[&str]| size("slider-crank/loose.toml", overrides);
    assert_eq!(loose(&[]), [2, 0]);
    let slider = "bodies.slider.coordinates='center'";
    assert_eq!(loose(&[CENTER]), [4, 2]);
    assert_eq!(loose(&[CENTER, slider]), [6, 4]);
    // a guide that is not along an axis, and one on which the slider turns
    assert_eq!(loose(&["joints.guide.direction=[1.0, 1e-30]"]), [4, 2]);
    let free = ["joints.guide.rotation='free'"];
    assert_eq!(size("slider-crank/ideal.toml", &free), [4, 3]);
    let simulation = Simulation::new(&load("slider-crank/loose.toml", &[])).unwrap();
    let notes = simulation.inspect().assumptions;
    let note = "rigid bodies with the one coordinate that an ideal joint leaves: rod (theta, joint crank_pin), slider (x, joint guide)";
    assert!(notes.contains(&note.to_owned()), "{notes:?}");
}

/// Bodies on a turning wheel, away from its axis, and on a cart that moves and turns, with either side of their joint first; a ram on
/// a guide along y that carries a couple; springs and a follower force.
const HELD: &str = r#"
format = 1
title = "bodies that joints hold"
simulation = { duration = 0.2, gravity = [0.0, -9.81] }
bodies.ground = { type = "ground", points.A = [0.0, 0.0], points.G = [2.0, 0.3] }
bodies.wheel = { type = "rigid_body", mass = 1.0, inertia = 0.01, points.hub = [0.02, 0.0], points.inner = [0.1, 0.05] }
bodies.arm = { type = "rigid_body", mass = 0.4, inertia = 0.002, points.end = [-0.1, 0.02], points.tip = [0.15, 0.0] }
bodies.cart = { type = "moving", path = { type = "coordinates", x = "1 + 0.1 * sin(8 * t)", y = 0.0, theta = "0.3 * t" }, points.left = [-0.05, 0.1], points.right = [0.05, 0.1] }
bodies.bob = { type = "disc", radius = 0.05, mass = 0.3, points.pin = [0.0, 0.2] }
bodies.plumb = { type = "rigid_body", mass = 0.2, inertia = 0.001, points.pin = [0.0, 0.15] }
bodies.ram = { type = "rigid_body", mass = 0.5, inertia = 0.01, points.foot = [0.1, 0.03], points.top = [0.0, 0.2] }
joints.hub = { type = "revolute", bearing = "ground.A", journal = "wheel.hub", model = "ideal" }
joints.elbow = { type = "revolute", bearing = "arm.end", journal = "wheel.inner", model = "ideal" }
joints.left = { type = "revolute", bearing = "bob.pin", journal = "cart.left", model = "ideal" }
joints.right = { type = "revolute", bearing = "cart.right", journal = "plumb.pin", model = "ideal" }
joints.guide = { type = "prismatic", guide = "ground.G", direction = [0.0, -1.0], slider = "ram.foot", rotation = "locked", angle = 0.4 }
drives.motor = { type = "angle", joint = "hub", angle = { type = "polynomial", coefficients = [0.3, 5.0, 3.0] } }
forces.twist = { type = "torsion_spring", joint = "elbow", stiffness = 2.0, damping = 0.01, rest_angle = 0.0 }
forces.string = { type = "spring_damper", from = "arm.tip", to = "bob.center", stiffness = 30.0, damping = 0.5, rest_length = 0.7 }
forces.push = { type = "force", point = "ram.top", x = "3 * sin(20 * t)", y = 6.0, frame = "body" }
[initial]
sketch.arm.tip = [0.3, 0.1]
sketch.bob.center = [0.95, -0.1]
bodies.plumb = { x = 1.05, y = -0.05, theta = 0.0, vx = 0.77, vy = 0.015, omega = 0.0 }
sketch.guide = [2.0, 0.1]
sketch.ram.top = [1.842, 0.22]
"#;

/// Two bodies on one axle, with lost motion between them: their contact closes and opens twice.
const LOST_MOTION: &str = r#"
format = 1
title = "lost motion between bodies on one axle"
simulation = { duration = 0.02 }
contacts.pin = { law = "hertz", bearing_radius = 0.01, clearance = 1e-4, stiffness = 1e8, exponent = 1.5 }
bodies.ground = { type = "ground", points.O = [0.0, 0.0] }
bodies.inner = { type = "disc", radius = 0.1, mass = 0.5, points.pin = [0.06, 0.0] }
bodies.outer = { type = "disc", radius = 0.15, mass = 1.5, points.hole = [0.06, 0.0] }
joints.first = { type = "revolute", bearing = "ground.O", journal = "inner.center", model = "ideal" }
joints.second = { type = "revolute", bearing = "ground.O", journal = "outer.center", model = "ideal" }
joints.play = { type = "revolute", bearing = "outer.hole", journal = "inner.pin", model = "clearance", contact = "pin" }
initial.bodies.inner = { x = 0.0, y = 0.0, theta = 0.0, vx = 0.0, vy = 0.0, omega = 0.5 }
initial.bodies.outer = { x = 0.0, y = 0.0, theta = 0.0, vx = 0.0, vy = 0.0, omega = 0.0 }
"#;

/// Positions, forces of joints, torques of drives and energies. A position that is wrong by 1e-10 m is wrong by 1e-8 of the smallest
/// mechanism, which is 1 cm long, and so are its accelerations and forces; both runs may be wrong.
#[test]
fn all_channels_are_those_of_other_coordinates() {
    let worst = Worst::new();
    let natural = ["link1", "link2", "link3"];
    for (name, bodies, method, duration) in [
        (
            "bodies that joints hold",
            &["arm", "bob", "plumb", "ram"][..],
            "esdirk5",
            0.2,
        ),
        ("lost motion", &["inner", "outer"], "dop853", 0.02),
        ("3rrr/case1.toml", &natural, "esdirk5", 0.01),
        ("pendulum.toml", &["rod"], "esdirk5", 1.0),
        ("quick-return.toml", &["lever", "ram"], "esdirk5", 0.5),
        ("harmonic-slider.toml", &["rod", "slider"], "esdirk5", 0.2),
        (
            "slider-crank/ideal.toml",
            &["rod", "slider"],
            "esdirk5",
            0.012,
        ),
        ("slider-crank/free-slider.toml", &["crank"], "esdirk5", 0.1),
        ("slider-crank/flexible.toml", &["slider"], "esdirk5", 0.003),
        (
            "andrews-squeezer.toml",
            &["K1", "K3", "K5", "K7"],
            "esdirk5",
            0.02,
        ),
    ] {
        let settings = [
            format!(
                "integrator={{method='{method}',newton_tolerance=1e-12,onset_tolerance=1e-13,accuracy={{position=1e-10,horizon=0.5}}}}"
            ),
            "assumptions={}".to_owned(),
            format!("output={{interval={},channels=['*']}}", duration / 50.0),
            format!("simulation.duration={duration}"),
        ];
        let other = bodies.iter().map(|body| {
            let other = if natural.contains(body) {
                "natural"
            } else {
                "center"
            };
            format!("bodies.{body}.coordinates='{other}'")
        });
        let other: Vec<String> = settings.iter().cloned().chain(other).collect();
        let of = |set: &[String]| {
            let scene = match name {
                "bodies that joints hold" => Scene::parse(name, HELD, set).unwrap(),
                "lost motion" => Scene::parse(name, LOST_MOTION, set).unwrap(),
                _ => load(name, &set.iter().map(String::as_str).collect::<Vec<_>>()),
            };
            run_scene(&scene).0
        };
        let [held, other] = [of(&settings), of(&other)];
        let kind = |channel: &str| match channel.starts_with("energy.") {
            true => "energy".to_owned(),
            false => channel.rsplit('.').next().unwrap_or_default().to_owned(),
        };
        let mut sizes: BTreeMap<String, f64> = BTreeMap::new();
        for channel in held.names() {
            let values = held.get(channel);
            let largest = values.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
            let size = sizes.entry(kind(channel)).or_default();
            *size = size.max(largest);
        }
        for channel in held.names() {
            worst.at(format!("{channel} of {name}"));
            for (a, b) in held.get(channel).iter().zip(other.get(channel)) {
                worst.see((a - b) / sizes[&kind(channel)]);
            }
        }
    }
    Rung::Routes
        .asks("Ten mechanisms, in coordinates of joints and others: difference of all channels, over the largest of the same kind")
        .within(&worst, 2e-8, "1e-10 m, the accuracy of both, over 1 cm, the size of the smallest");
}

/// Each run may be wrong by the accuracy times the amplification of the motion: 876 over 10 ms in case 3 (ACCURACY.md), 1
/// in the ideal mechanism, where the drives determine the motion.
#[test]
fn the_motion_does_not_depend_on_the_coordinates() {
    for (scene, accuracy, amplification, scheme) in [
        ("3rrr/case3.toml", 1e-11, 876.0, "dormand_prince"),
        ("3rrr/case1.toml", 1e-8, 1.0, "esdirk5"),
    ] {
        let integrator = format!(
            "integrator={{method={scheme:?},newton_tolerance=1e-12,onset_tolerance=1e-13,accuracy={{position={accuracy:e},horizon=0.01}}}}"
        );
        let span = [
            &*integrator,
            "assumptions={}",
            "simulation.duration=0.01",
            "output.interval=1e-3",
            "output.channels=[\"platform.x\",\"platform.y\",\"link*.x\",\"link*.y\",\"link*.theta\"]",
        ];
        let [(natural, _), (centred, _)] =
            [NATURAL, CENTRED].map(|coordinates| run(scene, &[&span[..], &coordinates].concat()));
        for name in natural.names() {
            let pairs = natural.get(name).into_iter().zip(centred.get(name));
            let apart = pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            // an angle is a difference of positions over half a link, 0.121 m
            let lever = if name.ends_with("theta") { 0.121 } else { 1.0 };
            let allowed = 2.0 * accuracy * amplification / lever;
            assert!(
                apart <= allowed,
                "{scene}, {name}: {apart:e} of {allowed:e}"
            );
        }
    }
}

//! Another model of a link or a joint needs no other change of the scene, whatever the model before it needed.

use crate::support::{all_scenes, load, path, run_scene};
use ladder::{Rung, Worst};
use looselink::body::FlexibleLink;
use looselink::scene::Scene;
use looselink::simulate::Simulation;

/// A link that turns about the ground, with damping, a bob at an inner point and a probe at another.
const HANGING: &str = r#"
format = 1
title = "a bob hangs from a link"
simulation = { duration = 0.2, gravity = [0.0, -9.81] }
integrator = { method = "dop853", accuracy = { position = 1e-12 } }
output = { interval = 1e-2, channels = ["t", "rod.strain", "rod.theta", "bob.*", "P.f*", "points.rod.probe.*", "points.rod.probe.slope_x", "P.ex"] }
materials.steel = { density = 7800.0, youngs_modulus = 2e9 }
sections.bar = { width = 0.004, height = 0.01 }
bodies.ground = { type = "ground", points.O = [0.0, 0.0] }
joints.O = { type = "revolute", bearing = "ground.O", journal = "rod.start", model = "ideal" }
joints.P = { type = "revolute", bearing = "rod.middle", journal = "bob.top", model = "ideal" }

[bodies.rod]
type = "link"
model = "flexible"
elements = 4
length = 0.2
section = "bar"
material = "steel"
points = { middle = 0.1, probe = 0.05 }
kelvin_voigt = 1e-4
rayleigh = { mass = 0.1, stiffness = 1e-5 }

[bodies.bob]
type = "rigid_body"
mass = 0.4
inertia = 1e-3
points.top = [0.0, 0.05]

[initial.bodies]
rod = { x = 0.1, y = 0.0, theta = 0.0, vx = 0.0, vy = 0.0, omega = 0.0, strain = 0.0, bending_rate = 0.0 }
bob = { x = 0.1, y = -0.05, theta = 0.0, vx = 0.0, vy = 0.0, omega = 0.0 }
"#;

fn hanging(overrides: &[&str]) -> Result<Scene, String> {
    let overrides: Vec<String> = overrides.iter().map(|s| (*s).to_owned()).collect();
    Scene::parse("hanging.toml", HANGING, &overrides).map_err(|e| e.to_string())
}

/// A string that is stretched between two fixed pins cannot be rigid: its ends do not reach them.
const STRETCHED: &str = "plucked-string.toml";

#[test]
fn every_flexible_link_of_every_scene_can_be_rigid() {
    let mut switched = 0;
    for scene in all_scenes() {
        for body in load(&scene, &[]).bodies {
            if body.kind.get::<FlexibleLink>().is_none() {
                continue;
            }
            let rigid = [format!("bodies.{}.model=rigid", body.name)];
            let loaded = Scene::load(&path(&scene), &rigid);
            let loaded = loaded.unwrap_or_else(|e| panic!("{scene}, {}: {e}", body.name));
            let simulation = Simulation::new(&loaded);
            match (simulation, &*scene) {
                (Err(error), STRETCHED) => {
                    let error = error.to_string();
                    assert!(error.contains("start"), "{error}");
                }
                (Err(error), _) => panic!("{scene}, {}: {error}", body.name),
                (Ok(_), _) => switched += 1,
            }
        }
    }
    assert!(switched > 30, "only {switched} links were switched");
}

/// In the coordinate of its joint, in those of its centre and in those of its ends a rigid link with inner points moves alike.
#[test]
fn a_rigid_link_has_inner_points_in_all_its_coordinates() {
    let run = |more: &[&str]| {
        let rigid = ["bodies.rod.model=rigid"];
        let scene = hanging(&[&rigid, more].concat()).unwrap();
        run_scene(&scene).0
    };
    let held = run(&[]);
    let worst = Worst::new();
    for coordinates in ["center", "natural"] {
        let other = run(&[&format!("bodies.rod.coordinates={coordinates}")]);
        for name in ["bob.x", "bob.theta", "P.fx", "P.fy", "points.rod.probe.ay"] {
            for (a, b) in held.get(name).iter().zip(other.get(name)) {
                worst.see(a - b);
            }
        }
    }
    assert!(held.get("bob.theta").iter().any(|theta| theta.abs() > 0.1));
    Rung::Routes
        .asks("Rigid link with a body at an inner point: difference of its motion [m, rad, m/s2] and forces [N] in three sets of coordinates")
        .within(&worst, 1e-6, "errors of positions of 1e-12 m in vibrations of none; accelerations and forces of 10 N are those of states with errors of 1e-9");
    // the bob and the probe stay on the link
    let (theta, probe) = (held.get("rod.theta"), held.get("points.rod.probe.y"));
    for (theta, y) in theta.iter().zip(probe) {
        assert!((0.05 * theta.sin() - y).abs() < 1e-9);
    }
}

#[test]
fn a_rigid_link_still_refuses_what_no_link_has() {
    let fault = |change: &str| hanging(&["bodies.rod.model=rigid", change]).unwrap_err();
    let misspelt = fault("bodies.rod.kelvin_voight=1.0");
    assert!(
        misspelt.contains("unknown key `kelvin_voight`"),
        "{misspelt}"
    );
    let outside = fault("bodies.rod.points.middle=0.2");
    let expected = "`bodies.rod.points.middle` must lie between the ends: more than 0 m, less than 0.2 m, not 0.2";
    assert_eq!(outside, expected);
    assert!(fault("bodies.rod.kelvin_voigt=-1.0").contains("must not be negative"));
    assert!(fault("bodies.rod.elements=0").contains("must lie between 1 and 10000"));
    // no node is needed
    hanging(&["bodies.rod.model=rigid", "bodies.rod.points.middle=0.0123"]).unwrap();
}

#[test]
fn channels_that_the_mechanism_does_not_have_are_notes() {
    let notes = |overrides: &[&str]| {
        let scene = hanging(overrides).unwrap();
        Simulation::new(&scene)
            .map(|s| s.report().notes())
            .map_err(|e| e.to_string())
    };
    let as_written = ["the channel \"P.ex\" is not recorded: the joint P has no clearance"];
    assert_eq!(notes(&[]).unwrap(), as_written);
    let rigid = [
        "the channel \"rod.strain\" is not recorded: rod is rigid",
        "the channel \"points.rod.probe.slope_x\" is not recorded: rod is rigid",
        as_written[0],
    ];
    assert_eq!(notes(&["bodies.rod.model=rigid"]).unwrap(), rigid);
    let pattern = notes(&["output.channels=[\"*.ex\", \"bob.x\"]"]).unwrap();
    assert_eq!(
        pattern,
        ["the pattern \"*.ex\" of `output.channels` matches no channel"]
    );
    for misspelt in [
        "rod.strian",
        "rods.strain",
        "points.rod.prob.slope_x",
        "P.exx",
        "ground.strain",
    ] {
        let error = notes(&[&format!("output.channels=[\"{misspelt}\"]")]).unwrap_err();
        assert!(
            error.contains(&format!("no channel of this scene is named {misspelt:?}")),
            "{error}"
        );
    }
}

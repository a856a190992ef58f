//! Where a motion starts: what the poses, velocities and angles of `[initial]` mean.

use crate::support::{Recording, run_scene};
use ladder::{Rung, Worst};
use looselink::scene::Scene;

/// The head of a scene over one step, and a bar for links.
const HEAD: &str = r#"
format = 1
title = "a start"
simulation = { duration = 1e-3 }
integrator = { method = "bathe", step = 1e-3, newton_tolerance = 1e-9 }
output = { interval = 1e-3, channels = ["*"] }
materials.steel = { density = 7800.0, youngs_modulus = 2e9 }
sections.bar = { width = 0.01, height = 0.01 }
"#;

fn scene(text: &str) -> Scene {
    let text = HEAD.to_owned() + text;
    Scene::parse("start", &text, &[]).unwrap_or_else(|e| panic!("{e} at {:?}", e.place()))
}

fn run(text: &str) -> Recording {
    run_scene(&scene(text)).0
}

/// The same pose and velocities of a rigid link, a flexible one and a rigid body, exact and completed by assembly.
#[test]
fn poses_and_velocities_are_those_of_the_channels() {
    let link = |model: &str| {
        format!(
            r#"{{ type = "link", model = "{model}", elements = 3, length = 0.7, section = "bar", material = "steel" }}"#
        )
    };
    let given = [
        ("x", 0.3),
        ("y", -0.2),
        ("theta", 0.8),
        ("vx", 1.5),
        ("vy", -0.4),
        ("omega", 3.0),
    ];
    let starts = [
        "initial.bodies.it = { x = 0.3, y = -0.2, theta = 0.8, vx = 1.5, vy = -0.4, omega = 3.0 }",
        "initial.bodies.it = { x = 0.3, y = -0.2, theta = 0.8 }\ninitial.velocities.it = { vx = 1.5, vy = -0.4, omega = 3.0 }",
    ];
    let worst = Worst::new();
    for body in [
        link("rigid"),
        link("flexible"),
        r#"{ type = "rigid_body", mass = 1.0, inertia = 0.1 }"#.to_owned(),
    ] {
        for start in starts {
            let run = run(&format!(
                "bodies.ground = {{ type = \"ground\" }}\nbodies.it = {body}\n{start}\n"
            ));
            for (quantity, value) in given {
                worst.at(quantity);
                worst.see(run.get(&format!("it.{quantity}"))[0] - value);
            }
        }
    }
    Rung::Identities
        .asks("Pose and velocities given in [initial] for links and a rigid body: do the channels of the first row have them? Largest difference [m, rad, m/s, rad/s]")
        .within(
            &worst,
            1e-14,
            "rounding of numbers up to 3 in a few sums over the nodes of a link",
        );
}

/// A link that is pinned at its start and given as if `x` were that of the pin.
#[test]
fn a_pose_off_the_pin_says_what_x_is() {
    let text = r#"
bodies.ground = { type = "ground", points.O = [0.0, 0.0] }
bodies.rod = { type = "link", model = "rigid", length = 1.0, section = "bar", material = "steel" }
joints.O = { type = "revolute", bearing = "ground.O", journal = "rod.start", model = "ideal" }
initial.bodies.rod = { x = 0.0, y = 0.0, theta = 0.0 }
"#;
    let error = looselink::simulate::Simulation::new(&scene(text)).expect_err("it starts");
    let shown = crate::bad_input::rendered(&error);
    assert!(shown.contains("centre of mass"), "{shown}");
}

//! Couples on bodies that are moved: they are work, and a part of what the drive must hold.

use crate::support::{TestRecording, difference, load, run_scene};
use ladder::Rung;
use looselink::scene::Scene;

/// A crank that is turned, with a torsional spring and a torque on it and a flexible antenna welded to its end.
const CRANK: &str = r#"
format = 1
title = "a crank with an antenna"
simulation = { duration = 0.2, gravity = [0.0, -9.81] }
integrator = { method = "bathe", step = 1e-5, newton_tolerance = 1e-11 }
output = { interval = 1e-2, channels = ["O.*", "tip.*", "antenna.*", "energy.*"] }
materials.steel = { density = 7800.0, youngs_modulus = 2e9 }
sections.bar = { width = 0.01, height = 0.01 }
bodies.ground = { type = "ground", points.O = [0.1, 0.2] }
bodies.crank = CRANK
bodies.antenna = { type = "link", model = "flexible", elements = 2, length = 0.2, section = "bar", material = "steel", kelvin_voigt = 1e-4 }
joints.O = { type = "revolute", bearing = "ground.O", journal = "crank.start", model = "ideal" }
joints.tip = { type = "weld", first = "crank.end", second = "antenna.start", angle = 0.7 }
forces.coil = { type = "torsion_spring", joint = "O", stiffness = 5.0, damping = 0.1, rest_angle = -0.4 }
forces.twist = { type = "torque", point = "crank.end", reaction = "antenna.end", value = 0.3 }
drives.motor = { type = "angle", joint = "O", angle = { type = "harmonic", mean = 0.2, amplitude = 0.5, frequency = 3.0, phase = 0.0 } }
initial.sketch = { tip = [0.39, 0.26] }
initial.bodies.antenna = { x = 0.4561809701794389, y = 0.33793349020126673, theta = 0.9 }
"#;

fn crank(body: &str) -> TestRecording {
    let text = CRANK.replace("= CRANK", &format!("= {body}"));
    let scene =
        Scene::parse("crank", &text, &[]).unwrap_or_else(|e| panic!("{e} at {:?}", e.place()));
    run_scene(&scene).0
}

/// The same crank as a rod in natural coordinates, where couples are pairs of forces, and as a rigid body with an angle.
#[test]
fn a_drive_holds_the_couples_on_its_crank() {
    let link =
        r#"{ type = "link", model = "rigid", length = 0.3, section = "bar", material = "steel" }"#;
    let mass = 7800.0 * 1e-4 * 0.3;
    let inertia = mass * 0.09 / 12.0;
    let body = format!(
        r#"{{ type = "rigid_body", mass = {mass:?}, inertia = {inertia:?}, points.start = [-0.15, 0.0], points.end = [0.15, 0.0] }}"#
    );
    let (link, body) = (crank(link), crank(&body));
    let worst = difference([&link, &body], link.names(), 1e-3);
    assert!(link.get("O.torque").iter().any(|m| m.abs() > 1.0));
    Rung::Routes
        .asks("Driven crank under couples, modelled as a link and as a rigid body: difference of all channels, relative to the largest value")
        .within(&worst,
            1e-9,
            "different rounding of positions, times EA = 2e5 N: 1e-11 N",
        );
}

/// Every element in one scene, with bodies that are moved and turned while couples act on them.
#[test]
fn the_ledger_of_every_element_closes() {
    let numerical = |step: f64| {
        let step = format!("integrator.step={step:e}");
        let overrides = [
            &step,
            "simulation.duration=0.2",
            r#"output.channels=["energy.*"]"#,
        ];
        let (_, report) = run_scene(&load("../verify/scenes/everything.toml", &overrides));
        let ledger = report.ledger.unwrap();
        assert!(ledger.work.abs() > 0.1 && ledger.damping_dissipated > 0.1);
        ledger.numerical.abs()
    };
    let errors: Vec<_> = [4e-4, 2e-4, 1e-4].map(|h| (h, numerical(h))).into();
    Rung::Balance
        .asks("Scene with every element: numerical loss of energy [J]")
        .falls(
            "Step h [s]",
            &errors,
            1.8..2.2,
            "the order of the scheme; about 1 J is stored and dissipated",
        );
}

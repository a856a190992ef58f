//! Questions that users of mechanism programs ask, with answers that are known.

use crate::support::run_scene;
use ladder::{Rung, Worst};
use looselink::scene::Scene;
use looselink::simulate::{Report, Simulation};

const HEAD: &str = r#"
format = 1
title = "a question"
output = { interval = 0.01, channels = ["*"] }
materials.steel = { density = 7850.0, youngs_modulus = 210e9 }
"#;

fn scene(text: &str, overrides: &[&str]) -> Scene {
    let overrides: Vec<String> = overrides.iter().map(|o| (*o).to_owned()).collect();
    let text = HEAD.to_owned() + text;
    Scene::parse("question", &text, &overrides).unwrap_or_else(|e| panic!("{e:?}"))
}

/// How a run ends and what it reports, whatever its end.
fn report(scene: &Scene) -> Report {
    let mut simulation = Simulation::new(scene).unwrap_or_else(|e| panic!("{e:?}"));
    let _ = simulation.run(&mut ());
    simulation.report()
}

const PRESS: &str = r#"
simulation = { analysis = "static", duration = 1.0, gravity = [0.0, -9.81] }
integrator = { step = 0.1 }
sections.bar = { width = 0.02, height = 0.02 }
bodies.ground = { type = "ground", points.O = [0.0, 0.0] }
bodies.crank = { type = "link", model = "rigid", length = 0.1, section = "bar", material = "steel" }
bodies.rod = { type = "link", model = "rigid", length = 0.3, section = "bar", material = "steel" }
bodies.ram = { type = "point_mass", mass = 2.0 }
joints.O = { type = "revolute", bearing = "ground.O", journal = "crank.start", model = "ideal" }
joints.A = { type = "revolute", bearing = "crank.end", journal = "rod.start", model = "ideal" }
joints.B = { type = "revolute", bearing = "ram.center", journal = "rod.end", model = "ideal" }
joints.rail = { type = "prismatic", guide = "ground.O", slider = "ram.center", direction = [1.0, 0.0], rotation = "free" }
drives.motor = { type = "angle", joint = "O", angle = 0.8 }
forces.work = { type = "force", point = "ram.center", x = -1000.0, y = 0.0, frame = "ground" }
initial.sketch = { B = [0.36, 0.0] }
"#;

/// A crank that is held by a drive carries a slider-crank under load: the torque by virtual work, and no stiffness anywhere.
#[test]
fn a_press_at_rest_needs_no_elasticity() {
    let (run, report) = run_scene(&scene(PRESS, &["output.interval=0.1"]));
    let torque = *run.get("O.torque").last().unwrap();
    let (angle, crank, rod, load, gravity): (f64, f64, f64, f64, f64) =
        (0.8, 0.1, 0.3, 1000.0, 9.81);
    // rod: sin(beta) = crank sin(angle)/rod below the line of the ram
    let beta = (crank * angle.sin() / rod).asin();
    let by_angle = crank * angle.cos() / (rod * beta.cos());
    let ram = -crank * angle.sin() - rod * beta.sin() * by_angle;
    let weight = |length: f64| 7850.0 * 0.02 * 0.02 * length * gravity;
    let heights =
        weight(crank) * 0.5 * crank * angle.cos() + weight(rod) * 0.5 * crank * angle.cos();
    let expected = heights + load * ram;
    let worst = Worst::new();
    worst.see(torque / expected - 1.0);
    Rung::ClosedForms
        .asks("Torque that holds the crank of a loaded press, by statics without elasticity, against virtual work: relative error")
        .within(&worst, 1e-12, "rounding of a dozen operations");
    assert!((torque + 88.463_677).abs() < 5e-7, "{torque}");
    assert_eq!(report.warnings(), Vec::<String>::new());
    assert!(report.rest.unwrap().smallest_eigenvalue.is_none());
}

/// A torsion spring of 2 N m/rad wound by three turns before the start turns a drum of 0.5 kg m2.
#[test]
fn a_spring_wound_by_three_turns_keeps_them() {
    let text = r#"
simulation = { duration = 0.5 }
integrator = { method = "esdirk5", step = 1e-3 }
bodies.ground = { type = "ground", points.O = [0.0, 0.0] }
bodies.drum = { type = "rigid_body", mass = 10.0, inertia = 0.5, points.axle = [0.0, 0.0] }
joints.O = { type = "revolute", bearing = "ground.O", journal = "drum.axle", model = "ideal" }
forces.spring = { type = "torsion_spring", joint = "O", stiffness = 2.0, damping = 0.0, rest_angle = 18.84955592153876 }
initial.bodies.drum = { x = 0.0, y = 0.0, theta = 0.0, vx = 0.0, vy = 0.0, omega = 0.0 }
"#;
    let (run, _) = run_scene(&scene(text, &[]));
    let worst = Worst::new();
    let turns = 18.849_555_921_538_76_f64;
    worst.see(run.get("spring.torque")[0] / (2.0 * turns) - 1.0);
    let exact = turns * (1.0 - (2.0 * 0.5_f64).cos());
    worst.see(run.get("drum.theta").last().unwrap() / exact - 1.0);
    Rung::ClosedForms
        .asks("A torsion spring wound by three turns: torque at the start and angle after half a second, relative error")
        .within(&worst, 1e-11, "500 steps of order 5, each with (0.002)^6 of the angle");
    // a sketch says no turns
    let sketched = text.replace(
        "initial.bodies.drum = { x = 0.0, y = 0.0, theta = 0.0, vx = 0.0, vy = 0.0, omega = 0.0 }",
        "initial.sketch = { O = [0.0, 0.0] }",
    );
    assert!(Scene::parse("sketch", &(HEAD.to_owned() + &sketched), &[]).is_ok());
}

/// A bracket of two bars without a freedom: forces of statics, and not a word.
#[test]
fn bars_that_rest_warn_of_nothing() {
    let text = r#"
simulation = { duration = 0.1 }
integrator = { method = "bathe", step = 1e-3 }
bodies.ground = { type = "ground", points.P = [0.0, 0.0], points.Q = [0.0, 0.3] }
materials.light = { density = 1e-3 }
sections.bar = { width = 0.01, height = 0.01 }
bodies.strut = { type = "link", model = "rigid", length = 0.4, section = "bar", material = "light" }
bodies.tie = { type = "link", model = "rigid", length = 0.5, section = "bar", material = "light" }
joints.P = { type = "revolute", bearing = "ground.P", journal = "strut.start", model = "ideal" }
joints.Q = { type = "revolute", bearing = "ground.Q", journal = "tie.start", model = "ideal" }
joints.tip = { type = "revolute", bearing = "strut.end", journal = "tie.end", model = "ideal" }
forces.load = { type = "force", point = "tie.end", x = 0.0, y = -1000.0, frame = "ground" }
initial.sketch = { tip = [0.4, 0.0] }
"#;
    let (run, report) = run_scene(&scene(text, &[]));
    let worst = Worst::new();
    for (joint, force) in [("Q", 5000.0 / 3.0), ("P", 4000.0 / 3.0)] {
        let [x, y] = ["fx", "fy"].map(|c| *run.get(&format!("{joint}.{c}")).last().unwrap());
        worst.at(joint);
        worst.see(x.hypot(y) / force - 1.0);
    }
    Rung::ClosedForms
        .asks("Forces in the two bars of a bracket at rest, relative error")
        .within(
            &worst,
            1e-9,
            "the weight of bars of 1e-3 kg/m3 is left out of the closed form, 1e-10 of the load",
        );
    assert_eq!(report.warnings(), Vec::<String>::new());
}

/// A rod whose Young's modulus was typed in GPa.
#[test]
fn a_modulus_in_gigapascals_is_told_by_its_strain() {
    let text = r#"
simulation = { duration = 0.2, gravity = [0.0, -9.81] }
integrator = { method = "generalized_alpha", spectral_radius = 0.8, step = 1e-4 }
sections.bar = { width = 0.01, height = 0.01 }
bodies.ground = { type = "ground", points.O = [0.0, 0.0] }
bodies.rod = { type = "link", model = "flexible", elements = 4, length = 0.3, section = "bar", material = "steel" }
joints.O = { type = "revolute", bearing = "ground.O", journal = "rod.start", model = "ideal" }
initial.bodies.rod = { x = 0.15, y = 0.0, theta = 0.0 }
"#;
    let right = report(&scene(text, &[]));
    assert_eq!(right.warnings(), Vec::<String>::new());
    let wrong = report(&scene(text, &["materials.steel.youngs_modulus=210"]));
    let told = wrong.warnings();
    assert!(
        told.iter()
            .any(|w| w.contains("rod has a") && w.contains("2.1e11 Pa")),
        "{told:?}"
    );
}

/// A law that delivers another restitution than it is given says so in the run.
#[test]
fn the_restitution_that_is_delivered_is_said() {
    let text = |law: &str| {
        format!(
            r#"
simulation = {{ duration = 0.02 }}
integrator = {{ method = "bathe", step = 2e-5 }}
bodies.ground = {{ type = "ground", points.bearing = [0, 0] }}
bodies.journal = {{ type = "rigid_body", mass = 0.05, inertia = 2.5e-6, points.centre = [0, 0] }}
joints.pin = {{ type = "revolute", bearing = "ground.bearing", journal = "journal.centre", model = "clearance", contact = "steel" }}
initial.bodies.journal = {{ x = 0, y = 0, theta = 0, vx = 0.02, vy = 0, omega = 0 }}
contacts.steel = {{ law = "{law}", bearing_radius = 0.01, clearance = 2e-5, stiffness = 1.2e11, exponent = 1.5, restitution = 0.5, impact_velocity_floor = 1e-6 }}
"#
        )
    };
    for (law, delivered) in [("flores", "0.47"), ("lankarani_nikravesh", "0.72")] {
        let notes = report(&scene(&text(law), &[])).notes();
        let said = |n: &String| n.contains("pin: ") && n.contains(law) && n.contains(delivered);
        assert!(notes.iter().any(said), "{notes:?}");
    }
}

/// A block on a slope below its angle of friction creeps with a regularised law, which is said.
#[test]
fn a_block_that_should_stick_is_said_to_creep() {
    let text = r#"
simulation = { duration = 2.0, gravity = [0.0, -9.81] }
integrator = { method = "bathe", step = 1e-3, onset_tolerance = 1e-10 }
bodies.ground = { type = "ground", points.O = [0.0, 0.0] }
bodies.block = { type = "point_mass", mass = 1.0 }
joints.slope = { type = "loose_guide", guide = "ground.O", slider = "block.center", direction = [0.9659258262890683, 0.25881904510252074], contact = "floor" }
initial.bodies.block = { x = 2.6127154510252075e-05, y = -9.7507868089463106e-05 }
[contacts.floor]
law = "hunt_crossley"
clearance = 1e-4
stiffness = 1e7
exponent = 1.0
restitution = 0.2
impact_velocity_floor = 1e-6
friction = { law = "ambrosio", coefficient = 0.5, v0 = 1e-4, v1 = 1e-3 }
"#;
    let report = report(&scene(text, &[]));
    let creep = report.creep["slope"];
    // T = c_f N (v - v0)/(v1 - v0) holds g sin(15 degrees)
    let (sin, cos) = 15.0_f64.to_radians().sin_cos();
    let speed = 1e-4 + 9e-4 * sin / (0.5 * cos);
    let worst = Worst::new();
    worst.see(creep.distance / (speed * (creep.to - creep.from)) - 1.0);
    Rung::ClosedForms
        .asks("Creep of a block on a slope with a regularised friction law: speed against the closed form, relative error")
        .within(&worst, 0.05, "the block comes to this speed within the first tenth of the time");
    let told = report.warnings();
    assert!(told.iter().any(|w| w.contains("slope creeps")), "{told:?}");
    let free = report_without_friction(text);
    assert!(free.creep.is_empty());
}

/// The same slip creeps in a pendulum that its pin should hold, and not in one that a drive turns as slowly.
#[test]
fn slip_that_a_drive_imposes_is_no_creep() {
    let text = r#"
simulation = { duration = 1.0, gravity = [0.0, -9.81] }
integrator = { method = "bathe", step = 1e-4, onset_tolerance = 1e-10 }
bodies.ground = { type = "ground", points.O = [0.0, 0.0] }
bodies.bar = { type = "rigid_body", mass = 1.0, inertia = 1e-3, points = { pin = [0.0, 0.05], end = [0.0, -0.05] } }
joints.pin = { type = "revolute", model = "clearance", contact = "bearing", bearing = "ground.O", journal = "bar.pin" }
initial = { journals = "pressed", sketch = { pin = [0.0, 0.0], bar.end = [0.005, -0.099875] } }
[contacts.bearing]
law = "hunt_crossley"
bearing_radius = 0.01
clearance = 2e-5
stiffness = 1e10
exponent = 1.5
restitution = 0.2
impact_velocity_floor = 1e-6
friction = { law = "ambrosio", coefficient = 0.5 }
"#;
    let drive = "[drives.hand]\ntype = \"point\"\npoint = \"bar.end\"\nx = \"0.005 - 0.003*t\"\n";
    let free = report(&scene(text, &[]));
    assert!(free.creep.contains_key("pin"), "{:?}", free.warnings());
    let driven = report(&scene(&format!("{text}{drive}"), &[]));
    assert!(driven.creep.is_empty(), "{:?}", driven.warnings());
}

fn report_without_friction(text: &str) -> Report {
    let start = text.find("friction = {").unwrap();
    report(&scene(&text[..start], &[]))
}

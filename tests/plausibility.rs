//! What no machine has is told, on the far side of every bound and not on the near one; the scenes of the project have none of it.

use crate::good_input;
use crate::support::{all_scenes, load, path, run, run_scene};
use looselink::scene::Scene;
use looselink::simulate::Simulation;
use miette::Diagnostic;

/// A bar in a loose bearing, with a disc on its end.
const SCENE: &str = r#"
format = 1
title = "a bar and a disc"
simulation = { duration = 1.0, gravity = [0.0, -9.81] }
integrator = { method = "bathe", step = 1e-3, newton_tolerance = 1e-9, onset_tolerance = 1e-12 }
output = { interval = 1e-2, channels = ["bar.*"] }
materials.steel = { density = 7850.0, youngs_modulus = 210e9, poissons_ratio = 0.3 }
sections.strip = { width = 0.02, height = 0.02 }
bodies.ground = { type = "ground", points.pivot = [0.0, 0.0] }
bodies.bar = { type = "link", model = "rigid", length = 0.5, section = "strip", material = "steel" }
bodies.block = { type = "rigid_body", mass = 1.0, inertia = 1e-3, points = { pin = [0.0, 0.0], far = [0.1, 0.0] } }
joints.pivot = { type = "revolute", bearing = "ground.pivot", journal = "bar.start", model = "clearance", contact = "pin" }
joints.end = { type = "revolute", bearing = "bar.end", journal = "block.pin", model = "ideal" }
forces.coil = { type = "torsion_spring", joint = "end", stiffness = 1.0, damping = 0.0, rest_angle = 0.0 }

[contacts.pin]
law = "hunt_crossley"
bearing_radius = 0.01
clearance = 2e-5
stiffness = 1e10
exponent = 1.5
restitution = 0.8
impact_velocity_floor = 1e-6
friction = { law = "ambrosio", coefficient = 0.1, v0 = 1e-4, v1 = 1e-3 }

[initial.bodies]
bar = { x = 0.25, y = 0.0, theta = 0.0 }
block = { x = 0.5, y = 0.0, theta = 0.0 }
"#;

fn told(change: &str) -> Vec<String> {
    good_input::load(SCENE, &[change]).implausible()
}

#[test]
fn bounds_of_scenes_have_two_sides() {
    assert_eq!(told("title=plain"), Vec::<String>::new());
    #[rustfmt::skip]
    let bounds = [
        ("simulation.gravity=[0.0, -0.1]", "simulation.gravity=[0.0, -0.099]", "m/s2"),
        ("simulation.gravity=[18.0, -24.0]", "simulation.gravity=[18.0, -24.1]", "The earth has 9.81 m/s2"),
        ("simulation.gravity=[0.0, 0.0]", "simulation.gravity=[0.0, -9810]", "are these SI units?"),
        ("simulation.duration=0.99e5", "simulation.duration=1e5", "1e8 steps of 0.001 s"),
        ("materials.steel.density=10", "materials.steel.density=9.9", "materials.steel.density is 9.9 kg/m3"),
        ("materials.steel.density=0.1", "materials.steel.density=0.11", "materials.steel.density is 0.11 kg/m3"),
        ("materials.steel.density=1e-4", "materials.steel.density=9e-5", "out of the range of all materials"),
        ("materials.steel.density=25000", "materials.steel.density=25100", "steel is 7850 kg/m3"),
        ("materials.steel.youngs_modulus=1e5", "materials.steel.youngs_modulus=0.9e5", "youngs_modulus is 90000 Pa"),
        ("materials.steel.youngs_modulus=2e12", "materials.steel.youngs_modulus=2.1e12", "steel is 210e9 Pa"),
        ("sections.strip.width=0.499", "sections.strip.width=0.501", "link bar is 0.501 m wide"),
        ("bodies.bar={ type = \"link\", model = \"flexible\", elements = 1, length = 0.101, section = \"strip\", material = \"steel\" }", "bodies.bar={ type = \"link\", model = \"flexible\", elements = 1, length = 0.099, section = \"strip\", material = \"steel\" }", "slender beams"),
        ("bodies.cart={ type = \"moving\", path = { type = \"circle\", center = [0.0, 0.0], radius = 0.1, frequency = 1.0, phase = 6.0, theta = 0.0 } }", "bodies.cart={ type = \"moving\", path = { type = \"circle\", center = [0.0, 0.0], radius = 0.1, frequency = 1.0, phase = 90.0, theta = 0.0 } }", "bodies.cart.path.phase is 90 rad"),
        ("bodies.cart={ type = \"moving\", path = { type = \"line\", from = [0.0, 0.0, 6.0], to = [0.1, 0.0, 6.0], duration = 1.0 } }", "bodies.cart={ type = \"moving\", path = { type = \"line\", from = [0.0, 0.0, 45.0], to = [0.1, 0.0, 45.0], duration = 1.0 } }", "the theta of bodies.cart.path at t = 0 is 45 rad"),
        ("contacts.pin.clearance=0.999e-3", "contacts.pin.clearance=1.001e-3", "contacts.pin.clearance is 0.001001 m"),
        ("contacts.pin.bearing_radius=4.9", "contacts.pin.bearing_radius=5.1", "contacts.pin.bearing_radius is 5.1 m"),
        ("contacts.pin.friction.coefficient=5", "contacts.pin.friction.coefficient=5.1", "is it in per cent?"),
        ("bodies.block.mass=1e6", "bodies.block.mass=1.1e6", "the mass of body block is 1.1e6 kg"),
        ("bodies.block.inertia=24.9", "bodies.block.inertia=25.1", "The unit of inertia is kg m2"),
        ("bodies.block.points.far=[49.9, 0.0]", "bodies.block.points.far=[50.1, 0.0]", "block is 50.1 m large, but the next largest 0.5 m"),
        ("initial.bodies.bar.theta=6", "initial.bodies.bar.theta=7", "initial.bodies.bar.theta is 7 rad, 1.11 turns: are these degrees?"),
        ("initial.bodies.bar.theta=18.849556", "initial.bodies.bar.theta=-22.5", "are these degrees?"),
        ("forces.coil.rest_angle=6.25", "forces.coil.rest_angle=90", "forces.coil.rest_angle is 90 rad, 14.3 turns"),
    ];
    for (within, beyond, words) in bounds {
        assert_eq!(told(within), Vec::<String>::new(), "{within}");
        let said = told(beyond);
        assert!(
            said.len() == 1 && said[0].contains(words),
            "{beyond}: {said:?}"
        );
    }
}

/// Everything is a kilometre large here, or a micrometre.
#[test]
fn sizes_have_two_sides() {
    let sized = |size: f64| {
        let block = format!(
            "bodies.block={{ type = \"rigid_body\", mass = 1.0, inertia = {}, points = {{ pin = [0.0, 0.0], far = [{size:?}, 0.0] }} }}",
            0.1 * size * size
        );
        let changes = [
            format!("bodies.bar.length={size:?}"),
            format!(
                "sections.strip={{ width = {0:?}, height = 1e-9 }}",
                0.1 * size
            ),
            format!("contacts.pin.bearing_radius={:?}", 0.1 * size),
            format!("contacts.pin.clearance={:?}", 1e-3 * size),
            block,
        ];
        let changes: Vec<&str> = changes.iter().map(String::as_str).collect();
        good_input::load(SCENE, &changes).implausible()
    };
    for size in [1.01e-6, 999.0] {
        assert_eq!(sized(size), Vec::<String>::new());
    }
    for size in [0.99e-6, 1001.0] {
        let said = sized(size);
        assert!(
            said.len() == 2 && said[0].contains("body bar is"),
            "{said:?}"
        );
    }
}

#[test]
fn angles_of_drives_in_degrees_are_told() {
    let driven = |angle: &str| {
        let drive =
            format!("drives={{ spin = {{ type = \"angle\", joint = \"end\", angle = {angle} }} }}");
        told(&drive)
    };
    for (radians, degrees) in [
        ("6", "30"),
        (
            r#"{ type = "polynomial", coefficients = [1.5, 600] }"#,
            r#"{ type = "polynomial", coefficients = [90, 0.5] }"#,
        ),
        (
            r#"{ type = "harmonic", mean = 0, amplitude = 2, frequency = 60, phase = 90 }"#,
            r#"{ type = "harmonic", mean = 0, amplitude = 60, frequency = 1, phase = 0 }"#,
        ),
        (
            r#"{ type = "smooth_step", from = 0, to = 6.5831, start = 0, duration = 45 }"#,
            r#"{ type = "smooth_step", from = 0, to = 45, start = 0, duration = 1 }"#,
        ),
        (
            r#"{ type = "spin_up", start = 1, speed = 30, duration = 20 }"#,
            r#"{ type = "spin_up", start = 90, speed = 1, duration = 1 }"#,
        ),
    ] {
        assert_eq!(driven(radians), Vec::<String>::new());
        let said = driven(degrees);
        assert!(
            said.len() == 1 && said[0].contains("drives.spin.angle is"),
            "{said:?}"
        );
    }
}

/// A fault of the mechanism is told with what may have caused it.
#[test]
fn a_mechanism_that_does_not_close_is_told_its_units() {
    let scene = load(
        "quick-return.toml",
        &["simulation.gravity=[0.0, -9810]", "initial={}"],
    );
    let error = Simulation::new(&scene).unwrap_err();
    let advice = error.advice().unwrap_or_default();
    assert!(advice.contains("are these SI units?"), "{error}: {advice}");
}

/// A mass of 1e5 kg at 1 m/s that a force accelerates for a microsecond: the mean power is F (v + F t/(2 m)).
#[test]
fn the_power_of_a_run_has_two_sides() {
    let pushed = |force: f64| {
        let text = format!(
            r#"
format = 1
title = "a mass is pushed"
simulation = {{ duration = 1e-6 }}
integrator = {{ method = "bathe", step = 1e-7, newton_tolerance = 1e-9 }}
output = {{ interval = 1e-6, channels = ["mass.x"] }}
bodies.ground = {{ type = "ground" }}
bodies.mass = {{ type = "point_mass", mass = 1e5 }}
forces.push = {{ type = "force", point = "mass.center", x = {force:?}, y = 0, frame = "ground" }}
initial.bodies.mass = {{ x = 0, y = 0, vx = 1, vy = 0 }}
"#
        );
        let (_, report) = run_scene(&good_input::load(&text, &[]));
        report.warnings()
    };
    assert_eq!(pushed(0.98e9), Vec::<String>::new());
    let said = pushed(1e9);
    assert!(
        said.len() == 1 && said[0].contains("W between two rows"),
        "{said:?}"
    );
}

/// In 2 ms the platform falls through its clearance of 2e-5 m. That is less than the path that it follows meanwhile, or more.
#[test]
fn a_body_off_its_path_has_two_sides() {
    let fallen = |radius: f64| {
        let path = format!(
            "drives.input.path={{ type = \"circle\", center = [{}, 0], radius = {radius:?}, frequency = 1, phase = 0, theta = 0 }}",
            0.1 - radius
        );
        let weight = [
            "simulation.gravity=[0, -9.81]",
            "simulation.duration=2e-3",
            &path,
        ];
        run("3rrr/case3.toml", &weight).1.warnings()
    };
    let off = |said: &[String]| {
        said.iter()
            .any(|w| w.contains("platform is up to") && w.contains("off its path"))
    };
    let [far, near] = [0.1, 1e-4].map(fallen);
    assert!(!off(&far), "{far:?}");
    assert!(off(&near), "{near:?}");
}

/// The scenes of the project are machines, or tests scaled as these are.
#[test]
fn scenes_of_the_project_are_plausible() {
    let mut told = Vec::new();
    for name in all_scenes() {
        let scene = Scene::load(&path(&name), &[]).unwrap();
        told.extend(
            scene
                .implausible()
                .into_iter()
                .map(|said| format!("{name}: {said}")),
        );
    }
    assert_eq!(told, Vec::<String>::new());
}

/// A crank that a drive turns by an angle, as written, with a sketch.
fn driven_crank(angle: &str, sketch: &str) -> Scene {
    let text = format!(
        "format = 1\n\
         title = \"a crank\"\n\
         simulation = {{ duration = 0.1 }}\n\
         integrator = {{ method = \"bathe\", step = 1e-3 }}\n\
         output = {{ interval = 1e-2, channels = [\"*\"] }}\n\
         bodies.ground = {{ type = \"ground\", points.O = [0.1, 0.0] }}\n\
         bodies.crank = {{ type = \"rigid_body\", mass = 1.0, inertia = 1e-3, points = {{ o = [0.0, 0.0], tip = [0.2, 0.0] }} }}\n\
         joints.O = {{ type = \"revolute\", model = \"ideal\", bearing = \"ground.O\", journal = \"crank.o\" }}\n\
         drives.motor = {{ type = \"angle\", joint = \"O\", angle = {angle} }}\n\
         {sketch}"
    );
    Scene::parse("scene.toml", &text, &[]).unwrap()
}

/// Of an expression the value at the start; of a table rows that all are whole numbers of halves.
#[test]
fn angles_of_expressions_and_tables_are_judged() {
    let told = |angle: &str| driven_crank(angle, "").implausible();
    let table = |shape: &str, rows: &str| {
        format!("{{ type = \"table\", shape = \"{shape}\", rows = {rows} }}")
    };
    let asked = "drives.motor.angle is 90 rad, 14.3 turns: are these degrees? Angles are in radians, and 90 degrees are 1.5708 rad";
    for angle in [
        "90",
        "\"90 + 30*t\"",
        "\"90 * cos(2*t)\"",
        &table("natural", "[[0, 0], [0.03, 90], [0.1, 22.5]]"),
        &table("monotone", "[[0, 0], [0.03, 4.5], [0.1, 90]]"),
    ] {
        assert_eq!(told(angle), [asked], "{angle}");
    }
    for angle in [
        "\"6 + 30*t\"",
        "\"30*pi + 30*t\"",
        &table("natural", "[[0, 0], [0.03, 90], [0.1, 22.6]]"),
        &table("monotone", "[[0, 0], [0.03, 4.5], [0.1, 6]]"),
    ] {
        assert_eq!(told(angle), Vec::<String>::new(), "{angle}");
    }
}

/// A drive whose angle would fit the sketch as a number of degrees: the error says so.
#[test]
fn a_drive_that_contradicts_the_sketch_in_degrees_is_asked() {
    let crank = |angle: &str| {
        let sketch = "initial.sketch = { crank = { tip = [-0.0489, 0.1336] } }\n";
        let scene = driven_crank(angle, sketch);
        Simulation::new(&scene)
            .map(drop)
            .map_err(|error| Diagnostic::help(&error).map(|help| help.to_string()))
    };
    assert!(crank("2.41029").is_ok());
    let asked = "are these degrees? Angles are in radians, and 138.1 degrees are 2.4103 rad";
    for angle in ["138.1", "\"138.1 + 20*t\""] {
        assert_eq!(crank(angle), Err(Some(asked.to_owned())));
    }
    assert_eq!(crank("0.7"), Err(None));
}

//! Malformed mechanisms: each is refused with an error that names the culprit.

use looselink::scene::Scene;
use looselink::simulate::Simulation;

/// A crank-rocker, driven at the crank.
const FOUR_BAR: &str = r#"
format = 1
title = "crank-rocker"
[simulation]
duration = 0.1
[integrator]
method = "bathe"
step = 1e-3
newton_tolerance = 1e-11
onset_tolerance = 1e-13
[output]
interval = 0.1
channels = ["rocker.theta"]
[materials.steel]
density = 7800.0
youngs_modulus = 2.1e11
poissons_ratio = 0.3
[sections.bar]
width = 0.01
height = 0.02
[contacts.pin]
law = "lankarani_nikravesh"
bearing_radius = 0.01
clearance = 1e-4
bearing_material = "steel"
journal_material = "steel"
exponent = 1.5
restitution = 0.9
impact_velocity_floor = 1e-6
[bodies.ground]
type = "ground"
points.A = [0.0, 0.0]
points.D = [0.4, 0.0]
points.E = [0.1, 0.0]
[bodies.crank]
type = "link"
model = "rigid"
length = 0.1
section = "bar"
material = "steel"
[bodies.coupler]
type = "rigid_body"
mass = 0.5
inertia = 0.004
points.B = [-0.15, 0.0]
points.C = [0.15, 0.0]
points.M = [0.0, 0.05]
[bodies.rocker]
type = "link"
model = "rigid"
length = 0.25
section = "bar"
material = "steel"
[joints.A]
type = "revolute"
bearing = "ground.A"
journal = "crank.start"
model = "ideal"
[joints.B]
type = "revolute"
bearing = "crank.end"
journal = "coupler.B"
model = "ideal"
[joints.C]
type = "revolute"
bearing = "coupler.C"
journal = "rocker.end"
model = "ideal"
[joints.D]
type = "revolute"
bearing = "ground.D"
journal = "rocker.start"
model = "ideal"
[drives.motor]
type = "angle"
joint = "A"
angle = { type = "polynomial", coefficients = [1.0, 30.0] }
[initial]
sketch.B = [0.054, 0.084]
sketch.C = [0.32, 0.24]
"#;

const BAR: &str = r#"
[bodies.bar]
type = "link"
model = "rigid"
length = LENGTH
section = "bar"
material = "steel"
[joints.E]
type = "revolute"
bearing = "ground.E"
journal = "bar.start"
model = "ideal"
[joints.M]
type = "revolute"
bearing = "coupler.M"
journal = "bar.end"
model = "ideal"
"#;

/// The error of a changed scene.
fn error(text: &str) -> String {
    let scene = match Scene::parse("four-bar.toml", text, &[]) {
        Err(error) => return error.to_string(),
        Ok(scene) => scene,
    };
    match Simulation::new(&scene) {
        Err(error) => {
            assert!(error.place().is_some(), "{error} has no place");
            error.to_string()
        }
        Ok(_) => panic!("accepted"),
    }
}

fn changed(from: &str, to: &str) -> String {
    assert_eq!(FOUR_BAR.matches(from).count(), 1, "`{from}` stands once");
    FOUR_BAR.replace(from, to)
}

#[test]
fn the_four_bar_itself_is_fine() {
    let scene = Scene::parse("four-bar.toml", FOUR_BAR, &[]).unwrap();
    let simulation = Simulation::new(&scene).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(simulation.inspect().unknowns, 2);
}

#[test]
fn ten_malformed_mechanisms_name_the_culprit() {
    let cases: [(&str, String, &[&str]); 12] = [
        (
            "over-constrained and contradictory",
            FOUR_BAR.to_owned() + &BAR.replace("LENGTH", "0.02"),
            &["cannot be assembled"],
        ),
        (
            "under-constrained drive",
            changed(
                "[drives.motor]\ntype = \"angle\"\njoint = \"A\"\nangle = { type = \"polynomial\", coefficients = [1.0, 30.0] }",
                "[bodies.load]\ntype = \"rigid_body\"\nmass = 1.0\ninertia = 1.0\n[drives.motor]\ntype = \"inverse_kinematics\"\njoints = [\"A\"]\nbody = \"load\"\npath = { type = \"line\", from = [0.19, 0.16, 0.5], to = [0.2, 0.16, 0.5], duration = 0.1 }",
            ),
            &["motor", "load", "does not determine"],
        ),
        (
            "zero mass",
            changed("mass = 0.5", "mass = 0.0"),
            &["bodies.coupler.mass", "greater than zero"],
        ),
        (
            "coincident points",
            FOUR_BAR.to_owned()
                + "[forces.spring]\ntype = \"spring_damper\"\nfrom = \"crank.end\"\nto = \"coupler.B\"\nstiffness = 1e3\ndamping = 1.0\nrest_length = 0.05\n",
            &["spring", "coincide"],
        ),
        (
            "a loop that cannot close",
            changed("length = 0.25", "length = 0.05"),
            &["cannot be assembled"],
        ),
        (
            "a point beyond the end of a link",
            changed(
                "length = 0.25\nsection = \"bar\"",
                "length = 0.25\npoints.tip = 0.3\nsection = \"bar\"",
            ),
            &["bodies.rocker.points.tip", "between the ends"],
        ),
        (
            "friction without contact",
            changed(
                "journal = \"rocker.end\"\nmodel = \"ideal\"",
                "journal = \"rocker.end\"\nmodel = \"ideal\"\nfriction = { law = \"ambrosio\", coefficient = 0.1, v0 = 1e-4, v1 = 1e-3 }",
            ),
            &["friction", "joints.C"],
        ),
        (
            "negative damping",
            FOUR_BAR.to_owned()
                + "[forces.damper]\ntype = \"torsion_spring\"\njoint = \"D\"\nstiffness = 0.0\ndamping = -0.1\nrest_angle = 0.0\n",
            &["forces.damper.damping", "not be negative"],
        ),
        (
            "duplicate names",
            changed("[joints.C]", "[joints.coupler]"),
            &["coupler", "both a body and a joint"],
        ),
        (
            "duplicate tables",
            FOUR_BAR.to_owned() + "[bodies.crank]\ntype = \"link\"\n",
            &["crank"],
        ),
        (
            "a length in millimetres",
            changed("length = 0.25", "length = 250.0"),
            &["rocker", "cannot be assembled"],
        ),
        (
            "a drive of what is known",
            FOUR_BAR.to_owned()
                + "[drives.hand]\ntype = \"point\"\npoint = \"crank.end\"\nx = 0.05\n",
            &["drive hand", "known"],
        ),
    ];
    for (name, text, parts) in cases {
        let error = error(&text);
        for part in parts {
            assert!(
                error.contains(part),
                "{name}: `{error}` does not say `{part}`"
            );
        }
    }
}

/// A bar that fits repeats what the others enforce only in one pose; here it makes the mechanism immobile, which the drive
/// contradicts. A bar of a parallelogram repeats them everywhere: it is left out, and named.
#[test]
fn a_redundant_bar_of_a_parallelogram_is_named_and_left_out() {
    let parallelogram = FOUR_BAR
        .replace("points.D = [0.4, 0.0]", "points.D = [0.3, 0.0]")
        .replace("points.E = [0.1, 0.0]", "points.E = [0.15, 0.0]")
        .replace("points.M = [0.0, 0.05]", "points.M = [0.0, 0.0]")
        .replace("length = 0.25", "length = 0.1")
        .replace("sketch.C = [0.32, 0.24]", "sketch.C = [0.354, 0.084]")
        + &BAR.replace("LENGTH", "0.1");
    let scene = Scene::parse("four-bar.toml", &parallelogram, &[]).unwrap();
    let mut simulation = Simulation::new(&scene).unwrap_or_else(|e| panic!("{e}"));
    let notes = simulation.inspect().assumptions;
    assert!(
        notes.iter().any(|n| n.contains("is redundant")),
        "{notes:?}"
    );
    simulation.run(&mut ()).unwrap_or_else(|e| panic!("{e}"));
    let report = simulation.report();
    assert_eq!(report.redundant.len(), 1, "{:?}", report.redundant);
    // 0.1 s at 30 rad/s: the work of the motor is the kinetic energy but for the error of the scheme
    assert!(report.ledger.unwrap().numerical.abs() < 1e-3);
    assert_eq!(report.rejected_steps, 0);
}

/// What nothing holds rests anywhere, and a note says so.
#[test]
fn a_static_analysis_of_a_free_mechanism_says_that_it_can_move() {
    let free = changed("duration = 0.1", "analysis = \"static\"\nduration = 1.0")
        .replace("interval = 0.1", "interval = 1.0")
        .replace("step = 1e-3", "step = 0.5")
        .replace("joint = \"A\"", "joint = \"A\" # removed");
    let free = free
        .replace("[drives.motor]\ntype = \"angle\"\njoint = \"A\" # removed\nangle = { type = \"polynomial\", coefficients = [1.0, 30.0] }\n", "");
    let scene = Scene::parse("four-bar.toml", &free, &[]).unwrap();
    let mut simulation = Simulation::new(&scene).unwrap_or_else(|e| panic!("{e}"));
    simulation.run(&mut ()).unwrap();
    let notes = simulation.report().notes();
    assert!(notes.iter().any(|n| n.contains("is neutral")), "{notes:?}");
    let settled = free.replace("[initial]", "[initial]\nequilibrium = true");
    let scene = Scene::parse("four-bar.toml", &settled, &[]).unwrap();
    let error = Simulation::new(&scene).unwrap_err().to_string();
    assert!(error.contains("undeformed"), "{error}");
}

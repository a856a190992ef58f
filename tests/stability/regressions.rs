//! What random mechanisms have found, one test each.

use crate::support::{load, run_scene};
use looselink::scene::Scene;
use looselink::simulate::{self, RunError, Simulation};
use stability::random::judge;

/// Every scene of the folder keeps what is asked of random ones.
#[test]
fn hard_scenes_keep_their_promises() {
    let folder = crate::support::path("hard");
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let text = std::fs::read_to_string(&path).unwrap();
        let text = text.lines().map(|line| match line.starts_with("channels") {
            true => "channels = [\"*\"]",
            false => line,
        });
        let text = text.collect::<Vec<_>>().join("\n");
        judge(&text, None).unwrap_or_else(|b| panic!("{path:?}: {}: {}", b.property, b.detail));
    }
}

/// The couple of a weld turns the body on its second side, also where the flexible end is on the first.
#[test]
fn a_weld_reports_the_couple_on_its_second_side() {
    let scene = load("hard/slope-on-the-first-side.toml", &[]);
    let run = run_scene(&scene).0;
    let [theta, alpha, torque, fx, fy] = [
        "flag.theta",
        "flag.alpha",
        "weld.torque",
        "weld.fx",
        "weld.fy",
    ]
    .map(|name| run.get(name));
    for k in 0..run.len() {
        let (s, c) = theta[k].sin_cos();
        let lever = [c * -0.03 - s * 0.01, s * -0.03 + c * 0.01];
        let moment = torque[k] + lever[0] * fy[k] - lever[1] * fx[k];
        let rest = moment - 2e-5 * alpha[k];
        // a linear solve of well conditioned equations; moments are of 0.01 N m
        assert!(rest.abs() < 1e-11, "{rest:e} N m in row {k}");
    }
    assert!(torque.iter().any(|m| m.abs() > 1e-3), "nothing was tested");
}

fn parse(text: &str) -> Scene {
    Scene::parse("regression", text, &[]).unwrap_or_else(|e| panic!("{e} at {:?}", e.place()))
}

/// Runs a scene that cannot come to its end.
fn stopped(text: &str) -> (RunError, simulate::Recording) {
    let mut simulation = Simulation::new(&parse(text)).unwrap_or_else(|e| panic!("{e}"));
    let mut kept = simulate::Recording::new(&simulation);
    let error = simulation.run(&mut kept).expect_err("the run goes on");
    (error, kept)
}

/// An explicit scheme beyond its bound of stability multiplies the motion by a constant a step, until coordinates are numbers
/// whose squares are none; the first row that lives on that energy ends the run.
#[test]
fn rows_hold_numbers_only() {
    let (error, kept) = stopped(
        r#"
format = 1
title = "a mass on a spring, the step fifty times too long"
simulation = { duration = 10.0 }
integrator = { method = "velocity_verlet", step = 0.1 }
output = { interval = 0.1, channels = ["*"] }
bodies.ground = { type = "ground", points.O = [0.0, 0.0] }
bodies.bob = { type = "point_mass", mass = 1.0 }
forces.spring = { type = "spring_damper", from = "ground.O", to = "bob.center", stiffness = 1e6, damping = 0.0, rest_length = 0.0 }
initial.bodies.bob = { x = 1.0, y = 0.0 }
"#,
    );
    for (name, values) in kept.into_columns() {
        assert!(values.iter().all(|x| x.is_finite()), "{name}");
    }
    let text = error.to_string();
    assert!(
        text.starts_with("bob.center.x: the method is unstable with these steps"),
        "{text}"
    );
}

/// A beam pressed together until the slope at its driven end passes through zero length: the angle that the drive holds has
/// a second zero there, half a turn off. The spring of that joint jumped by half a turn, and the ledger with it.
const PRESSED: &str = r#"
format = 1
title = "a soft beam is pressed through itself"
simulation = { duration = 0.02 }
integrator = { method = "bathe", step = 1e-5, newton_tolerance = 1e-9 }
output = { interval = 1e-3, channels = ["*"] }
materials.soft = { density = 1000.0, youngs_modulus = 1e6 }
sections.bar = { width = 0.1, height = 0.1 }
bodies.ground = { type = "ground", points.O = [0.0, 0.0] }
bodies.beam = { type = "link", model = "flexible", elements = 1, length = 1.0, section = "bar", material = "soft" }
joints.O = { type = "revolute", bearing = "ground.O", journal = "beam.start", model = "ideal" }
drives.hold = { type = "angle", joint = "O", angle = 0.0 }
forces.coil = { type = "torsion_spring", joint = "O", stiffness = 10.0, damping = 0.0, rest_angle = 1.0 }
forces.press = { type = "force", point = "beam.end", x = -2e5, y = 0.0, frame = "ground" }
initial.bodies.beam = { x = 0.0, y = 0.0, theta = 0.0 }
"#;

#[test]
fn a_held_direction_does_not_turn_over() {
    let (error, kept) = stopped(PRESSED);
    let text = error.to_string();
    assert!(
        text.starts_with("drive hold (angle): the direction it holds turns over by half a turn"),
        "{text}"
    );
    // the spring keeps its energy as long as the run goes
    let springs = kept.get("energy.springs").unwrap();
    assert!(
        springs.iter().all(|e| (e - 5.0).abs() < 1e-9),
        "{springs:?}"
    );
}

/// Nor does it begin there: the cross product that holds a weld is zero half a turn off, too.
#[test]
fn a_start_half_a_turn_off_is_refused() {
    let text = r#"
format = 1
title = "a body welded the wrong way round"
simulation = { duration = 0.01 }
integrator = { method = "bathe", step = 1e-3, newton_tolerance = 1e-9 }
output = { interval = 1e-3, channels = ["*"] }
bodies.ground = { type = "ground", points.O = [0.0, 0.0] }
bodies.block = { type = "rigid_body", mass = 1.0, inertia = 0.1, points.O = [0.0, 0.0] }
joints.O = { type = "weld", first = "ground.O", second = "block.O" }
initial.bodies.block = { x = 0.0, y = 0.0, theta = 3.141592653589793 }
"#;
    let error = Simulation::new(&parse(text)).expect_err("it starts");
    assert_eq!(
        error.to_string(),
        "the start has joint O (angle) half a turn away from its angle"
    );
    assert!(error.place().is_some());
}

/// Two bars and the ground make a triangle, which a drive cannot move. Its constraint repeats those of the bars where the
/// motion starts, so it was left out, and the run went to its end without it.
#[test]
fn a_drive_that_nothing_can_follow_is_told() {
    let text = r#"
format = 1
title = "a triangle is driven"
simulation = { duration = 0.1 }
integrator = { method = "bathe", step = 1e-3, newton_tolerance = 1e-9 }
output = { interval = 1e-3, channels = ["*"] }
materials.steel = { density = 7800.0 }
sections.bar = { width = 0.01, height = 0.01 }
bodies.ground = { type = "ground", points.A = [0.0, 0.0], points.C = [1.0, 0.0] }
bodies.left = { type = "link", model = "rigid", length = 1.0, section = "bar", material = "steel" }
bodies.right = { type = "link", model = "rigid", length = 1.4142135623730951, section = "bar", material = "steel" }
joints.A = { type = "revolute", bearing = "ground.A", journal = "left.start", model = "ideal" }
joints.B = { type = "revolute", bearing = "left.end", journal = "right.start", model = "ideal" }
joints.C = { type = "revolute", bearing = "ground.C", journal = "right.end", model = "ideal" }
drives.open = { type = "angle", joint = "B", angle = { type = "smooth_step", from = -2.356194490192345, to = -2.2, start = 0.0, duration = 0.1 } }
initial.bodies.left = { x = 0.0, y = 0.0, theta = 1.5707963267948966 }
initial.bodies.right = { x = 0.0, y = 1.0, theta = -0.7853981633974483 }
"#;
    let (error, _) = stopped(text);
    let text = error.to_string();
    assert!(
        text.starts_with("drive open (angle): the other constraints do not allow it, it is off by"),
        "{text}"
    );
}

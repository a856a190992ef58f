//! What random mechanisms have found, one test each.

use crate::support::{TestRecording, load, run, run_scene};
use looselink::scene::Scene;
use looselink::simulate::{self, RunError, Simulation};

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

/// Steps of DOP853 that are far too long end in numbers that are not finite; shorter ones have nothing of them.
#[test]
fn a_run_recovers_from_steps_that_overflow() {
    let run = |method: &str| {
        let integrator = format!("integrator={{method={method},accuracy={{position=1e-6}}}}");
        let changes = [
            &integrator,
            "assumptions={}",
            "simulation.duration=0.4",
            "output.interval=0.4",
        ];
        run("cantilever-dynamic.toml", &changes)
    };
    let (kept, report) = run("\"dop853\"");
    assert!(report.rejected_steps > 3);
    let tip = |kept: &TestRecording| kept.get("points.beam.end.y")[1];
    let difference = tip(&kept) - tip(&run("\"esdirk5\",newton_tolerance=1e-10").0);
    // each has its accuracy
    assert!(difference.abs() < 2e-6, "{difference:e} m");
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
initial.bodies.beam = { x = 0.5, y = 0.0, theta = 0.0 }
"#;

#[test]
fn a_held_direction_does_not_turn_over() {
    let (error, kept) = stopped(PRESSED);
    let text = error.to_string();
    assert!(
        text.starts_with("drive hold (angle): its direction has flipped by half a turn"),
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
        "joint O (angle) starts half a turn away from the angle it holds"
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
initial.bodies.left = { x = 0.0, y = 0.5, theta = 1.5707963267948966 }
initial.bodies.right = { x = 0.5, y = 0.5, theta = -0.7853981633974483 }
"#;
    let (error, _) = stopped(text);
    let text = error.to_string();
    assert!(
        text.starts_with(
            "drive open (angle): the other constraints contradict it; it is violated by"
        ),
        "{text}"
    );
}

/// Accelerations grow without bound where the lever cannot go further. A step from there turned the crank by 1e9 rad, and
/// Newton's method took the angle that its first leap happened on for the solution: the pin was open by 10 mm.
const DEAD_CENTRE: &str = r#"
format = 1
title = "a slotted lever is driven into its dead centre"
simulation = { duration = 0.03 }
integrator = { method = "generalized_alpha", spectral_radius = 0.76, step = 6e-4, newton_tolerance = 1e-11 }
output = { interval = 6e-4, channels = ["*"] }
materials.wood = { density = 2600.0 }
sections.bar = { width = 0.012, height = 0.05 }
bodies.ground = { type = "ground", points.A = [0.0, 0.0], points.B = [0.0, -0.38] }
bodies.crank = { type = "rigid_body", mass = 0.01, inertia = 1.2e-5, points.A = [0.074, 0.0], points.P = [-0.092, 0.0] }
bodies.lever = { type = "link", model = "rigid", length = 0.7, section = "bar", material = "wood" }
joints.A = { type = "revolute", bearing = "ground.A", journal = "crank.A", model = "ideal" }
joints.B = { type = "revolute", bearing = "ground.B", journal = "lever.start", model = "ideal" }
joints.P = { type = "prismatic", guide = "lever.start", direction = [1.0, 0.0], slider = "crank.P", rotation = "free" }
drives.swing = { type = "angle", joint = "B", angle = { type = "harmonic", mean = 2.6473, amplitude = 2.6031, frequency = 0.42745, phase = 5.9944 } }
initial.sketch = { A = [0.0, 0.0], P = [-0.154, 0.061] }
"#;

#[test]
fn a_dead_centre_makes_up_no_turns() {
    let (error, kept) = stopped(DEAD_CENTRE);
    let expected = "crank is perpendicular to the line of joint P";
    assert!(error.to_string().ends_with(expected), "{error}");
    let [x, y, theta] = ["crank.x", "crank.y", "crank.theta"].map(|name| kept.get(name).unwrap());
    for ((x, y), theta) in x.iter().zip(y).zip(theta) {
        let (s, c) = theta.sin_cos();
        let open = (x + 0.074 * c).hypot(y + 0.074 * s);
        // rounding of 0.1 m, seen through steps halved 24 times
        assert!(open < 1e-12, "the pin is open by {open:e} m");
        // it starts within half a turn of zero, and its centre is half a turn on
        assert!(theta.abs() < 7.0, "{theta} rad");
    }
}

/// A lever in a guide may be longer than all other bodies together; where a given pose is off, the lever is not the fault.
#[test]
fn a_long_lever_is_not_blamed_for_a_pose() {
    let text =
        DEAD_CENTRE.to_owned() + "initial.bodies.crank = { x = -0.074, y = 0.001, theta = 0.0 }\n";
    let error = Simulation::new(&parse(&text)).expect_err("it starts");
    let text = error.to_string();
    assert!(
        text.starts_with("the sketch draws joint P at (-0.1540, 0.0610) m, but the given pose of crank puts it at"),
        "{text}"
    );
}

//! Where a motion starts: what the poses, velocities and angles of `[initial]` mean.

use crate::bad_input::rendered;
use crate::support::{TestRecording, load, run_scene};
use ladder::{Rung, Worst};
use looselink::scene::{Scene, SceneError};
use looselink::simulate::Simulation;
use std::f64::consts::TAU;

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

fn run(text: &str) -> TestRecording {
    run_scene(&scene(text)).0
}

/// The error of a scene that reads well and cannot start, as it is shown.
fn refused(text: &str) -> (SceneError, String) {
    let Err(error) = Simulation::new(&scene(text)) else {
        panic!("it starts");
    };
    let shown = rendered(&error);
    (error, shown)
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
        .asks("Pose and velocities given in [initial] for links and a rigid body: difference from the first row of the channels [m, rad, m/s, rad/s]")
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
    let (error, shown) = refused(text);
    assert!(error.to_string().contains("the pose of rod"), "{error}");
    assert!(shown.contains("centre of mass"), "{shown}");
}

/// The turn that an angle starts in: that of the drive or of the given pose; of inverse kinematics the one nearest to zero.
#[test]
fn angles_start_in_the_turn_that_the_scene_gives() {
    let rigid = r#"{ type = "rigid_body", mass = 1.0, inertia = 0.1, points.start = [-0.5, 0.0] }"#;
    let link = r#"{ type = "link", model = "MODEL", elements = 2, length = 1.0, section = "bar", material = "steel" }"#;
    let hinge = r#"
bodies.ground = { type = "ground", points.O = [0.0, 0.0] }
joints.O = { type = "revolute", bearing = "ground.O", journal = "it.start", model = "ideal" }
"#;
    let worst = Worst::new();
    let bodies = [
        rigid.to_owned(),
        link.replace("MODEL", "rigid"),
        link.replace("MODEL", "flexible"),
    ];
    for body in &bodies {
        for angle in [-8.0, -4.0, 1.0, 4.0, 20.0_f64] {
            let (x, y) = (0.5 * angle.cos(), 0.5 * angle.sin());
            let given = format!(
                "bodies.it = {body}\ninitial.bodies.it = {{ x = {x:?}, y = {y:?}, theta = {angle} }}\n"
            );
            worst.at(format!("given {angle}"));
            worst.see(run(&(hinge.to_owned() + &given)).get("it.theta")[0] - angle);
            // a flexible link is driven by a constraint and needs its pose, the others are turned
            let driven = if body.contains("flexible") {
                given
            } else {
                format!("bodies.it = {body}\n")
            };
            let drive =
                format!("drives.spin = {{ type = \"angle\", joint = \"O\", angle = {angle} }}\n");
            worst.at(format!("driven {angle}"));
            worst.see(run(&(hinge.to_owned() + &driven + &drive)).get("O.angle")[0] - angle);
        }
    }
    Rung::Identities
        .asks("Angles beyond half a turn at t = 0, given by a pose or a drive: difference from the first row of the channels [rad]")
        .within(&worst, 2e-14, "rounding of 20 rad and of its sine and cosine");

    let arm = |theta: f64| {
        run(&format!(
            r#"
bodies.ground = {{ type = "ground", points.O = [0.0, 0.0] }}
bodies.it = {rigid}
joints.O = {{ type = "revolute", bearing = "ground.O", journal = "it.start", model = "ideal" }}
drives.input = {{ type = "inverse_kinematics", joints = ["O"], body = "it", path = {{ type = "table", rows = [[0, {x:?}, {y:?}, {theta:?}], [1, {x:?}, {y:?}, {theta:?}]] }} }}
"#,
            x = 0.5 * theta.cos(),
            y = 0.5 * theta.sin(),
        ))
    };
    for (theta, start) in [(1.0, 1.0), (6.0, 6.0 - TAU), (-4.0, TAU - 4.0)] {
        let run = arm(theta);
        let (body, joint) = (run.get("it.theta")[0], run.get("O.angle")[0]);
        // rounding of a full turn
        assert!((body - theta).abs() < 1e-14, "{body} {theta}");
        assert!((joint - start).abs() < 1e-14, "{joint} {start}");
    }
}

const FOUR_BAR: &str = r#"
bodies.ground = { type = "ground", points.A = [0.0, 0.0], points.D = [0.4, 0.0] }
bodies.crank = { type = "link", model = "rigid", length = 0.1, section = "bar", material = "steel" }
bodies.coupler = { type = "link", model = "rigid", length = 0.3, section = "bar", material = "steel" }
bodies.rocker = { type = "link", model = "rigid", length = 0.25, section = "bar", material = "steel" }
joints.A = { type = "revolute", bearing = "ground.A", journal = "crank.start", model = "ideal" }
joints.B = { type = "revolute", bearing = "crank.end", journal = "coupler.start", model = "ideal" }
joints.C = { type = "revolute", bearing = "coupler.end", journal = "rocker.end", model = "ideal" }
joints.D = { type = "revolute", bearing = "ground.D", journal = "rocker.start", model = "ideal" }
"#;

/// A pose and a sketch that contradict each other are both named, and both places are shown.
#[test]
fn a_pose_that_contradicts_the_sketch_is_named_with_it() {
    // the crank along x, its end drawn above the pivot
    let text = FOUR_BAR.to_owned()
        + r#"
initial.sketch = { B = [0.0, 0.1], C = [0.28, 0.22] }
initial.bodies.crank = { x = 0.05, y = 0.0, theta = 0.0 }
"#;
    let (error, shown) = refused(&text);
    assert_eq!(
        error.to_string(),
        "the sketch draws joint B at (0.0000, 0.1000) m, but the given pose of crank puts it at (0.1000, 0.0000) m"
    );
    assert_eq!(error.underlined(), "[0.0, 0.1]");
    assert!(
        shown.contains("{ x = 0.05, y = 0.0, theta = 0.0 }"),
        "{shown}"
    );

    // the rocker lies so that crank and coupler would have to be 0.42 m long together, and are 0.4 m
    let text = FOUR_BAR.to_owned()
        + r#"
initial.sketch = { B = [0.08, 0.06] }
initial.bodies.rocker = { x = 0.3711875, y = 0.1216340406454953, theta = 1.8033878148327838 }
"#;
    let (error, shown) = refused(&text);
    let expected = "the given pose of rocker contradicts the sketch of joint B: without this pose the mechanism closes there, with it ";
    assert!(error.to_string().starts_with(expected), "{error}");
    assert!(
        error
            .to_string()
            .ends_with(" stays open by 0.02 m at least"),
        "{error}"
    );
    assert_eq!(
        error.underlined(),
        "{ x = 0.3711875, y = 0.1216340406454953, theta = 1.8033878148327838 }"
    );
    assert!(shown.contains("[0.08, 0.06]"), "{shown}");

    // a pose from the command line stands in another text, whose place is reported
    let text = HEAD.to_owned()
        + FOUR_BAR
        + "initial.sketch = { B = [0.0, 0.1], C = [0.28, 0.22] }\ninitial.bodies = {}\n";
    let pose = "initial.bodies.crank={ x = 0.05, y = 0.0, theta = 0.0 }".to_owned();
    let scene = Scene::parse("start", &text, &[pose]).unwrap_or_else(|e| panic!("{e}"));
    let shown = rendered(&Simulation::new(&scene).expect_err("it starts"));
    assert!(
        shown.contains("contradicts the sketch: --set:1:22"),
        "{shown}"
    );

    // two given poses between which a third body does not fit
    let text = FOUR_BAR.to_owned()
        + r#"
initial.bodies.crank = { x = 0.05, y = 0.0, theta = 0.0 }
initial.bodies.rocker = { x = 0.525, y = 0.0, theta = 0.0 }
"#;
    let (error, _) = refused(&text);
    assert_eq!(
        error.to_string(),
        "the given poses hold the ends of coupler 550\u{a0}mm apart, but its length is 300\u{a0}mm"
    );
}

/// A slider whose drive moves it from the start on, with a pose and no velocities.
const PUSHED: &str = r#"
bodies.ground = { type = "ground", points.O = [0.0, 0.0] }
bodies.slider = { type = "rigid_body", mass = 1.0, inertia = 0.1, points.pin = [0.1, 0.0] }
joints.slot = { type = "prismatic", guide = "ground.O", direction = [1.0, 0.0], slider = "slider.pin", rotation = "locked" }
drives.push = { type = "point", point = "slider.pin", x = { type = "polynomial", coefficients = [0.3, 1.0] } }
initial.bodies.slider = { x = 0.2, y = 0.0, theta = 0.0 }
"#;

/// Poses without velocities beside a drive that moves: the velocities were taken as zero, and the error says so.
#[test]
fn velocities_taken_as_zero_are_told() {
    let text = PUSHED;
    let (error, shown) = refused(text);
    assert_eq!(
        error.to_string(),
        "the velocities of the start violate drive push (x), by 1\u{a0}m/s: the scene gives no velocity for slider, so \
         zero was assumed"
    );
    assert!(shown.contains("[initial.sketch]"), "{shown}");
    // a velocity would repeat that of the drive
    assert!(!shown.contains("[initial.velocities]"), "{shown}");
    assert_eq!(error.underlined(), "{ x = 0.2, y = 0.0, theta = 0.0 }");
    // as the advice says
    let sketched = run(&(text.to_owned() + "initial.sketch.slot = [0.3, 0.0]\n"));
    assert!((sketched.get("slider.vx")[0] - 1.0).abs() < 1e-14);
    let typed = text.replace(
        "theta = 0.0 }",
        "theta = 0.0, vx = 1.0, vy = 0.0, omega = 0.0 }",
    );
    assert!((run(&typed).get("slider.vx")[0] - 1.0).abs() < 1e-14);
}

/// A static analysis has no velocities: a drive that moves from the start on, and a pose without velocities, are a load path.
#[test]
fn a_static_start_needs_no_velocities() {
    let text = HEAD.replace("duration = 1e-3", "analysis = \"static\", duration = 1e-3")
        + r#"
bodies.ground = { type = "ground", points.O = [0.0, 0.0] }
bodies.beam = { type = "link", model = "flexible", elements = 2, length = 1.0, section = "bar", material = "steel" }
joints.O = { type = "revolute", bearing = "ground.O", journal = "beam.start", model = "ideal" }
drives.turn = { type = "angle", joint = "O", angle = { type = "polynomial", coefficients = [0.0, 10.0] } }
initial.bodies.beam = { x = 0.5, y = 0.0, theta = 0.0 }
"#;
    let scene = Scene::parse("start", &text, &[]).unwrap_or_else(|e| panic!("{e}"));
    let y = run_scene(&scene).0.get("points.beam.end.y");
    // turned as a whole by 0.01 rad; the last update of Newton's method is rounding, EI = 1.7 N m2 the least stiffness
    assert!(
        y[0].abs() < 1e-12 && (y[1] - 0.01_f64.sin()).abs() < 1e-12,
        "{y:?}"
    );
}

/// A rod that hangs from a driven point has one joint or none: its points are sketched, or known from the drive.
#[test]
fn driven_points_are_sketched() {
    let rod = r#"
bodies.ground = { type = "ground", points.O = [0.0, 0.0] }
bodies.rod = { type = "link", model = "rigid", length = 0.5, section = "bar", material = "steel" }
joints.O = { type = "revolute", bearing = "ground.O", journal = "rod.start", model = "ideal" }
drives.push = { type = "point", point = "rod.end", x = 0.3 }
"#;
    let (error, shown) = refused(rod);
    assert_eq!(error.to_string(), "the scene does not say where rod starts");
    assert!(shown.contains("[initial.sketch]"), "{shown}");
    // the sketch chooses the branch
    for side in [1.0, -1.0] {
        let text = format!("{rod}initial.sketch.rod.end = [0.25, {}]\n", 0.35 * side);
        let run = run(&text);
        let end = [
            run.get("points.rod.end.x")[0],
            run.get("points.rod.end.y")[0],
        ];
        // closed to 1e-12 m
        assert!(
            (end[0] - 0.3).abs() < 1e-12 && (end[1] - 0.4 * side).abs() < 1e-12,
            "{end:?}"
        );
    }
    // a point of which both coordinates are prescribed needs no sketch
    let held = r#"
bodies.ground = { type = "ground", points.O = [0.0, 0.0] }
bodies.rod = { type = "link", model = "flexible", elements = 2, length = 0.5, section = "bar", material = "steel" }
joints.slot = { type = "prismatic", guide = "ground.O", direction = [1.0, 0.0], slider = "rod.end", rotation = "free" }
drives.swing = { type = "point", point = "rod.start", x = 0.0, y = { type = "polynomial", coefficients = [0.3, 0.1] } }
initial.sketch.rod = { end = [0.41, 0.01] }
"#;
    let run = run(held);
    let end = [
        run.get("points.rod.end.x")[0],
        run.get("points.rod.end.vx")[0],
    ];
    // 0.5^2 = 0.3^2 + x^2, and the rate of the start is 0.1 m/s
    assert!(
        (end[0] - 0.4).abs() < 1e-12 && (end[1] + 0.3 * 0.1 / 0.4).abs() < 1e-9,
        "{end:?}"
    );

    let far = rod.to_owned() + "initial.sketch.rod.end = [0.3, 0.1]\n";
    let (error, _) = refused(&far);
    assert!(
        error
            .to_string()
            .starts_with("point rod.end closes at (0.3000, 0.4000) m"),
        "{error}"
    );
    let faults = [
        (
            "sketch.ground.O = [0, 0]",
            "the position of `ground` is known at every time",
        ),
        (
            "sketch.rod = [0, 0]",
            "`rod` is a body: the sketch places its points",
        ),
        (
            "sketch.rod.tip = [0, 0]",
            "there is no point of `rod` called `tip`",
        ),
        ("sketch.rod.ned = [0, 0]", "did you mean `end`?"),
        (
            "sketch.rode.end = [0, 0]",
            "there is no joint or body `rode`; did you mean `rod`?",
        ),
    ];
    for (line, message) in faults {
        let text = format!("{HEAD}{rod}initial.{line}\n");
        let error = Scene::parse("start", &text, &[]).expect_err("it is read");
        assert!(error.to_string().contains(message), "{error}");
    }
}

/// With inverse kinematics a sketched point chooses the branch as a sketched joint does.
#[test]
fn a_sketched_point_chooses_the_branch_of_inverse_kinematics() {
    let arm = r#"
bodies.ground = { type = "ground", points.shoulder = [0.0, 0.0] }
bodies.upper = { type = "link", model = "rigid", length = 0.3, section = "bar", material = "steel" }
bodies.lower = { type = "link", model = "rigid", length = 0.3, section = "bar", material = "steel" }
bodies.hand = { type = "rigid_body", mass = 0.2, inertia = 1e-4, points.wrist = [-0.05, 0.0] }
joints.shoulder = { type = "revolute", bearing = "ground.shoulder", journal = "upper.start", model = "ideal" }
joints.elbow = { type = "revolute", bearing = "upper.end", journal = "lower.start", model = "ideal" }
joints.wrist = { type = "revolute", bearing = "lower.end", journal = "hand.wrist", model = "ideal" }
drives.draw = { type = "inverse_kinematics", joints = ["shoulder", "elbow", "wrist"], body = "hand", path = { type = "circle", center = [0.35, 0.0], radius = 0.05, frequency = 1.0, phase = 0.0, theta = 0.0 } }
"#;
    for side in [1.0, -1.0] {
        let sketches = [
            format!("initial.sketch.elbow = [0.2, {}]\n", 0.25 * side),
            format!("initial.sketch.lower.start = [0.2, {}]\n", 0.25 * side),
        ];
        let [joint, point] =
            sketches.map(|sketch| run(&(arm.to_owned() + &sketch)).get("points.upper.end.y")[0]);
        assert_eq!(joint, point);
        // the wrist is at (0.35, 0), so that the elbow is at half of it
        let height = (0.09_f64 - 0.175 * 0.175).sqrt();
        assert!((point - side * height).abs() < 1e-12, "{point}");
    }
    let far = arm.to_owned() + "initial.sketch.lower.start = [0.2, 0.1]\n";
    let (error, _) = refused(&far);
    assert!(
        error
            .to_string()
            .starts_with("point lower.start closes at (0.1750, 0.24"),
        "{error}"
    );
}

/// A motion that starts at rest because nothing else is said does so with a note; in a static analysis all is at rest.
#[test]
fn a_start_at_rest_that_is_not_asked_for_is_noted() {
    let noted = |scene: &str| {
        let simulation = Simulation::new(&load(scene, &[])).unwrap();
        let notes = simulation.inspect().assumptions;
        notes.iter().any(|note| note.contains("starts at rest"))
    };
    assert!(noted("spin-up.toml"));
    assert!(!noted("cantilever-static.toml"));
    assert!(!noted("bouncing-journal.toml"));
}

/// One point and the angle of a weld, of a drive or of a guide place a link.
#[test]
fn a_link_starts_where_one_point_and_an_angle_put_it() {
    let bodies = r#"
bodies.ground = { type = "ground", points.A = [0.1, 0.2] }
bodies.arm = { type = "link", model = "MODEL", length = 0.3, section = "bar", material = "steel" }
initial = {}
"#;
    let held = [
        r#"joints.w = { type = "weld", first = "ground.A", second = "arm.start", angle = 0.4 }"#,
        r#"joints.w = { type = "weld", first = "arm.start", second = "ground.A", angle = -0.4 }"#,
        r#"
joints.p = { type = "revolute", bearing = "ground.A", journal = "arm.start", model = "ideal" }
drives.turn = { type = "angle", joint = "p", angle = 0.4 }"#,
    ];
    for model in [r#""rigid""#, r#""flexible", elements = 2"#] {
        for joints in held {
            let link = bodies.replace(r#""MODEL""#, model);
            let run = run(&format!("{link}{joints}\n"));
            let [theta, x, y] = ["arm.theta", "arm.x", "arm.y"].map(|name| run.get(name)[0]);
            let (sine, cosine) = 0.4_f64.sin_cos();
            let expected = [0.4, 0.1 + 0.15 * cosine, 0.2 + 0.15 * sine];
            for (found, expected) in [theta, x, y].into_iter().zip(expected) {
                assert!(
                    (found - expected).abs() < 1e-14,
                    "{joints}: {found} {expected}"
                );
            }
        }
    }
}

/// The work of the static solver that finds the equilibrium is counted with that of the motion.
#[test]
fn an_equilibrium_start_and_its_motion_are_counted_together() {
    let settings = [
        "simulation.duration=2e-3",
        "output.interval=1e-3",
        "integrator.step=1e-3",
    ];
    let counted = |start: &str| {
        let all = [&settings[..], &[start]].concat();
        let mut simulation = Simulation::new(&load("cantilever-dynamic.toml", &all)).unwrap();
        simulation.run(&mut ()).unwrap();
        let report = simulation.report();
        assert!(report.newton_iterations > report.stages, "{report:?}");
        report.stages
    };
    let still = counted("initial.equilibrium=true");
    assert!(still > counted("initial.equilibrium=false"));
}

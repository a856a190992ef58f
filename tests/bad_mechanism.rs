//! Scenes that read well and cannot be simulated: the message names joint, body and time, the place is underlined.

use crate::bad_input::{CASE4, check, rendered};
use looselink::scene::{Scene, SceneError};
use looselink::simulate::Simulation;

fn fault(text: &str, overrides: &[&str]) -> SceneError {
    let overrides: Vec<String> = overrides.iter().map(|o| (*o).to_owned()).collect();
    let scene =
        Scene::parse("scene.toml", text, &overrides).unwrap_or_else(|e| panic!("{}", rendered(&e)));
    match Simulation::new(&scene) {
        Ok(_) => panic!("the scene can be simulated: {overrides:?}"),
        Err(error) => error,
    }
}

/// Overrides, parts of the message, the underlined text.
type BadMechanism = (
    &'static [&'static str],
    &'static [&'static str],
    &'static str,
);

const CASES: [BadMechanism; 11] = [
    (
        &[
            "initial.sketch.B1=[-0.228, 0.015]",
            "initial.sketch={ B1 = [-0.228, 0.015], B2 = [0.116, -0.284], B3 = [0.230, 0.316], C1 = [5.0, 5.0] }",
        ],
        &["joint C1 closes at (0.0030, -0.0560) m, far from its sketch"],
        "[5.0, 5.0]",
    ),
    // within reach at the start, out of it some time into the motion
    (
        &[
            "bodies.link1.length=0.14",
            "initial.sketch.B1=[-0.135, -0.075]",
        ],
        &[
            "drive input: crank1 and link1 cannot close: |A1 C1| = 0.385",
            "exceeds 0.245 m + 0.14 m = 0.385000 m at t = 0.0",
        ],
        "{ type = \"circle\", center = [0.0, 0.0], radius = 0.1, frequency = 1.0, phase = 0.0, theta = 0.0 }",
    ),
    (
        &["bodies.link1.length=0.05"],
        &[
            "drive input: crank1 and link1 cannot close: |A1 C1| = 0.377925 m",
            "exceeds 0.245 m + 0.05 m = 0.295000 m at t = 0 s",
        ],
        "[drives.input]",
    ),
    (
        &["bodies.link1.length=0.9"],
        &[
            "drive input: crank1 and link1 cannot close: |A1 C1| = 0.377925 m",
            "is less than |0.245 m - 0.9 m| = 0.655000 m at t = 0 s",
        ],
        "[drives.input]",
    ),
    (
        &["initial.sketch.B1=[-0.16, -0.04]"],
        &[
            "joint B1 closes at (",
            "draw it closer to the branch you mean",
        ],
        "[-0.16, -0.04]",
    ),
    (
        &[
            "bodies.crank2.model=flexible",
            "bodies.crank2.elements=1",
            "bodies.crank2.material=passive",
        ],
        &["drive input cannot actuate joint A2: the body it moves is flexible"],
        "[joints.A2]",
    ),
    (
        &["joints.A3.model=clearance", "joints.A3.contact=pin"],
        &["drive input cannot actuate joint A3: it has clearance"],
        "[joints.A3]",
    ),
    (
        &["drives.input.joints=[\"A1\", \"A2\", \"B1\"]"],
        &["drive input cannot actuate joint B1: the body it moves is flexible"],
        "[joints.B1]",
    ),
    (
        &["initial.bodies={ crank1 = { x = 0.0, y = 0.0, theta = 0.0 } }"],
        &["the motion of crank1 is prescribed, so it cannot be given an initial state"],
        "{ x = 0.0, y = 0.0, theta = 0.0 }",
    ),
    (
        &[
            "initial.bodies={ link1 = { x = 0.0, y = 0.0, theta = 0.0 } }",
            "joints.B1.model=ideal",
        ],
        &["the pose of link1 does not fit the points that its ends are joined to"],
        "{ x = 0.0, y = 0.0, theta = 0.0 }",
    ),
    (
        &["output.channels=[\"platfrm.x\"]"],
        &["no channel of this scene is named \"platfrm.x\"; the nearest is \"platform.x\""],
        "\"platfrm.x\"",
    ),
];

#[test]
fn mechanisms_that_cannot_move_as_asked() {
    for (overrides, messages, underlined) in CASES {
        let error = fault(CASE4, overrides);
        for message in messages {
            check(&error, &format!("{overrides:?}"), message, underlined);
        }
    }
}

/// A body nobody places, and one that is placed where its joint is not.
#[test]
fn starts_that_are_missing_or_wrong() {
    let text = include_str!("../scenes/bouncing-journal.toml");
    let (head, _) = text.split_once("[initial]").unwrap();
    let error = fault(head, &[]);
    check(
        &error,
        "no start",
        "the scene does not say where journal starts",
        "[bodies.journal]",
    );
    let error = fault(
        text,
        &["joints.pin.model=ideal", "initial.bodies.journal.x=0.001"],
    );
    check(
        &error,
        "off the pin",
        "the pose of journal does not fit joint pin: it is open by 1\u{a0}mm",
        "{ x = 0.0, y = 0.0, theta = 0.0, vx = 0.02, vy = 0.0, omega = 0.0 }",
    );
}

/// The path of an arm about a pivot must keep the pivot where it is.
#[test]
fn a_path_that_pulls_a_joint_apart() {
    let arm = |rows: &str| {
        format!(
            r#"
format = 1
title = "an arm on a pivot"
simulation = {{ duration = 1.0 }}
integrator = {{ method = "bathe", step = 1e-3, newton_tolerance = 1e-11 }}
output = {{ interval = 0.1, channels = ["*"] }}
bodies.ground = {{ type = "ground", points.O = [0.0, 0.0] }}
bodies.arm = {{ type = "rigid_body", mass = 1.0, inertia = 0.1, points.pivot = [-0.3, 0.0] }}
joints.O = {{ type = "revolute", bearing = "ground.O", journal = "arm.pivot", model = "ideal" }}
drives.input = {{ type = "inverse_kinematics", joints = ["O"], body = "arm", path = {rows} }}
initial = {{}}
"#
        )
    };
    let still = arm(r#"{ type = "table", rows = [[0.0, 0.3, 0.0, 0.0], [1.0, 0.3, 0.0, 0.0]] }"#);
    let scene = Scene::parse("arm", &still, &[]).unwrap_or_else(|e| panic!("{}", rendered(&e)));
    assert!(Simulation::new(&scene).is_ok());
    let away =
        arm(r#"{ type = "line", from = [0.3, 0.0, 0.0], to = [0.4, 0.0, 0.0], duration = 1.0 }"#);
    check(
        &fault(&away, &[]),
        "line",
        "the path pulls joint O apart, by ",
        r#"{ type = "revolute", bearing = "ground.O", journal = "arm.pivot", model = "ideal" }"#,
    );
    // a body that nothing holds has no pose in the ideal mechanism
    let free = still.replace(
        "joints.O",
        "bodies.free = { type = \"rigid_body\", mass = 1.0, inertia = 0.1 }\njoints.O",
    );
    let error = fault(&free, &[]);
    let message = "does not determine the pose of the ideal mechanism, which has 3 unknown coordinates and 0 constraints";
    assert!(error.to_string().contains(message), "{error}");
    assert!(rendered(&error).contains("some bodies stay free to move"));
    // it comes back before the end
    let away_and_back = arm(
        r#"{ type = "table", rows = [[0.0, 0.3, 0.0, 0.0], [0.5, 0.4, 0.0, 0.0], [1.0, 0.3, 0.0, 0.0]] }"#,
    );
    check(
        &fault(&away_and_back, &[]),
        "table",
        "the path pulls joint O apart, by ",
        r#"{ type = "revolute", bearing = "ground.O", journal = "arm.pivot", model = "ideal" }"#,
    );
}

/// A journal may start pressed into its bearing, but not outside it.
#[test]
fn a_journal_outside_its_bearing() {
    let text = include_str!("../scenes/bouncing-journal.toml");
    let error = fault(text, &["initial.bodies.journal.x=0.05"]);
    check(
        &error,
        "outside",
        "the journal of joint pin starts outside its bearing: the penetration of 50.0\u{a0}mm exceeds the clearance of 20\u{a0}µm",
        "[joints.pin]",
    );
    let pressed = ["initial.bodies.journal.x=2.01e-5".to_owned()];
    let scene = Scene::parse("scene.toml", text, &pressed).unwrap();
    assert!(Simulation::new(&scene).is_ok());
}

/// A joint between the ground and a moving body holds nothing, and nothing keeps it closed.
#[test]
fn a_joint_between_prescribed_bodies() {
    let text = r#"
format = 1
title = "two prescribed bodies"
simulation = { duration = 0.1 }
integrator = { method = "bathe", step = 1e-3, newton_tolerance = 1e-9 }
output = { interval = 1e-2, channels = ["*"] }
bodies.ground = { type = "ground", points.C = [0.1, 0.3] }
bodies.cart = { type = "moving", path = { type = "line", from = [0.2, 0.0, 0.0], to = [0.3, 0.0, 0.0], duration = 1.0 }, points.o = [0.0, 0.0] }
bodies.bob = { type = "point_mass", mass = 1.0 }
joints.K = { type = "revolute", bearing = "ground.C", journal = "cart.o", model = "ideal" }
initial.bodies.bob = { x = 0.0, y = 0.0 }
"#;
    check(
        &fault(text, &[]),
        "joint",
        "joint K is redundant: the motion of both of its bodies is prescribed",
        r#"{ type = "revolute", bearing = "ground.C", journal = "cart.o", model = "ideal" }"#,
    );
}

/// The tool comes too close to the pivot in the middle of its line; at both ends it is within reach.
#[test]
fn a_line_that_leaves_the_reach_on_the_way() {
    let text = r#"
format = 1
title = "an arm and a rod"
simulation = { duration = 0.2 }
integrator = { method = "bathe", step = 1e-3, newton_tolerance = 1e-11 }
output = { interval = 0.1, channels = ["*"] }
materials.steel = { density = 7800.0 }
sections.bar = { width = 0.01, height = 0.01 }
bodies.ground = { type = "ground", points.O = [0.0, 0.0] }
bodies.arm = { type = "link", model = "rigid", length = 0.3, section = "bar", material = "steel" }
bodies.rod = { type = "link", model = "rigid", length = 0.1, section = "bar", material = "steel" }
bodies.tool = { type = "rigid_body", mass = 1.0, inertia = 0.1, points.tip = [0.0, 0.0] }
joints.O = { type = "revolute", bearing = "ground.O", journal = "arm.start", model = "ideal" }
joints.P = { type = "revolute", bearing = "arm.end", journal = "rod.start", model = "ideal" }
joints.Q = { type = "revolute", bearing = "rod.end", journal = "tool.tip", model = "ideal" }
drives.input = { type = "inverse_kinematics", joints = ["O"], body = "tool", path = { type = "line", from = [0.1, -0.3, 0.0], to = [0.1, 0.3, 0.0], duration = 0.2 } }
initial.sketch = { P = [0.2, -0.25] }
"#;
    check(
        &fault(text, &[]),
        "line",
        "cannot close: |O Q| = ",
        r#"{ type = "line", from = [0.1, -0.3, 0.0], to = [0.1, 0.3, 0.0], duration = 0.2 }"#,
    );
}

/// A body that a joint holds in its one coordinate, and whose start does not fit this joint: the joint is named as it would be with
/// constraints. Full turns of a guided body do not matter.
#[test]
fn starts_that_do_not_fit_the_joint_that_holds_a_body() {
    let text = include_str!("../scenes/slider-crank/loose.toml");
    let (head, _) = text.split_once("[initial]").unwrap();
    let start = |rod: &str| {
        let slider = "slider = { x = 0.17, y = 0.0, theta = 0.0, vx = 0.0, vy = 0.0, omega = 0.0 }";
        format!("{head}[initial]\nbodies.{slider}\nbodies.rod = {rod}\n")
    };
    let apart = "{ x = 0.111, y = 0.0, theta = 0.0, vx = 0.0, vy = 0.0, omega = 0.0 }";
    let error = fault(&start(apart), &[]);
    let message = "the pose of rod does not fit joint crank_pin: it is open by 1\u{a0}mm";
    check(&error, apart, message, apart);
    let still = "{ x = 0.11, y = 0.0, theta = 0.0 }";
    let error = fault(&start(still), &[]);
    let message = "the velocities of the start violate joint crank_pin, by 26.2\u{a0}m/s: the scene gives no velocity for rod, so zero was \
                   assumed";
    check(&error, still, message, "{ x = 0.11, y = 0.0, theta = 0.0 }");
    let turned = "initial.bodies.slider.theta=6.283185307179586".to_owned();
    let scene = Scene::parse("turned", text, &[turned]).unwrap();
    assert!(Simulation::new(&scene).is_ok());
}

/// A robot with arms from A and B that meet in a pin, or with a third arm from C, whose hand follows a path.
fn robot(third_arm: bool) -> String {
    // the ends of a rigid link that are both known are refused before
    let arm = |name: &str, length: f64| {
        format!(
            "bodies.{name} = {{ type = \"rigid_body\", mass = 0.1, inertia = 1e-3, points = {{ start = [0.0, 0.0], end = [{length}, 0.0] }} }}\n"
        )
    };
    let joint = |name: &str, bearing: &str, journal: &str| {
        format!(
            "joints.{name} = {{ type = \"revolute\", bearing = \"{bearing}\", journal = \"{journal}\", model = \"ideal\" }}\n"
        )
    };
    let mut text = r#"
format = 1
title = "a robot"
simulation = { duration = 1.0 }
integrator = { method = "bathe", step = 1e-3, newton_tolerance = 1e-9 }
output = { interval = 1e-2, channels = ["hand.*"] }
bodies.ground = { type = "ground", points = { A = [0.0, 0.0], B = [0.4, 0.0], C = [0.2, 0.5] } }
bodies.hand = { type = "rigid_body", mass = 0.5, inertia = 4e-3, points = { near = [-0.15, 0.0], tip = [0.15, 0.0] } }
drives.lead = { type = "inverse_kinematics", joints = ["A"], body = "hand", path = { type = "circle", center = [0.2, 0.3], radius = 0.01, frequency = 1.0, phase = 0.0, theta = 0.5 } }
initial.sketch = { A2 = [0.05, 0.2], B2 = [0.5, 0.25] }
"#
    .to_owned();
    text += &(arm("left", 0.2) + &joint("A", "ground.A", "left.start"));
    text += &joint("A2", "left.end", "hand.near");
    text += &(arm("right", 0.3) + &joint("B", "ground.B", "right.start"));
    match third_arm {
        true => {
            text += &joint("B2", "right.end", "hand.tip");
            text += &(arm("upper", 0.25) + &joint("C", "ground.C", "upper.start"));
            text + &joint("C2", "upper.end", "hand.near")
        }
        false => {
            text += &(arm("fore", 0.3) + &joint("B2", "right.end", "fore.start"));
            text + &joint("tip", "fore.end", "hand.tip")
        }
    }
}

/// The message says one thing, and what to do about it.
#[test]
fn a_path_that_prescribes_too_much() {
    for (third_arm, advice) in [
        (false, "it has 2 of the 3 freedoms x, y and theta"),
        (true, "remove one, perhaps of A2, B2, C2"),
    ] {
        let error = fault(&robot(third_arm), &[]);
        let message = error.to_string();
        assert!(
            message.contains("overdetermines the ideal mechanism"),
            "{message}"
        );
        assert!(!message.contains("does not determine"), "{message}");
        let given = error.advice().unwrap_or_default();
        assert!(given.contains(advice), "{given}");
    }
}

/// A channel that does not exist is answered with those that do.
#[test]
fn unknown_channels_are_answered() {
    for (channel, advice) in [
        (
            "platform.angle",
            "known of platform: platform.x, platform.y, platform.theta, ",
        ),
        (
            "B1.torque",
            "joint B1 has `torque` where a drive turns it, and none does",
        ),
        ("platfrom.x", "nearest of "),
        ("x", "lists all"),
    ] {
        let error = fault(CASE4, &[&format!("output.channels=[\"{channel}\"]")]);
        let given = error.advice().unwrap_or_default();
        assert!(given.contains(advice), "{channel}: {error}: {given}");
    }
}

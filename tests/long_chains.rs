//! Mechanisms so large that sparse algebra assembles them and looks for redundant constraints.

use crate::support::run_scene;
use looselink::scene::Scene;
use looselink::simulate::Simulation;

/// Links of the chains: with 3 unknowns and 2 constraint rows each far more than dense algebra is used for.
const LINKS: usize = 150;

/// A chain of links of 0.1 m that hangs from the ground, drawn as a zigzag that is not closed; its last link turns.
fn chain(more: &str) -> String {
    let mut text = String::from(
        r#"
format = 1
title = "a long chain"
simulation = { duration = 1e-4, gravity = [0.0, -9.81] }
integrator = { method = "bathe", step = 1e-5, newton_tolerance = 1e-10 }
output = { interval = 1e-5, channels = ["*"] }
bodies.ground = { type = "ground", points.O = [0.0, 0.0] }
"#,
    );
    for k in 0..LINKS {
        let before = match k {
            0 => "ground.O".to_owned(),
            _ => format!("link{}.b", k - 1),
        };
        let side = if k % 2 == 0 { 0.0 } else { 0.03 };
        text += &format!(
            "bodies.link{k} = {{ type = \"rigid_body\", mass = 0.1, inertia = 1e-4, points.a = [-0.05, 0.0], points.b = [0.05, 0.0] }}\n\
             joints.j{k} = {{ type = \"revolute\", bearing = \"{before}\", journal = \"link{k}.a\", model = \"ideal\" }}\n\
             initial.sketch.j{k} = [{}, {side}]\n",
            0.096 * k as f64
        );
    }
    let last = LINKS - 1;
    text += &format!(
        "initial.sketch.link{last}.b = [{}, 0.0]\n",
        0.096 * LINKS as f64
    );
    text + &format!("initial.velocities.link{last}.omega = 2.0\n{more}")
}

#[test]
fn a_long_chain_is_assembled_and_moves() {
    let scene = Scene::parse("chain", &chain(""), &[]).unwrap();
    let (recording, report) = run_scene(&scene);
    assert!(report.redundant.is_empty(), "{:?}", report.redundant);
    let first = |name: &str| recording.get(name)[0];
    // the given velocity holds; of least energy is a motion that dies out along the chain
    let last = LINKS - 1;
    assert!((first(&format!("link{last}.omega")) - 2.0).abs() < 1e-12);
    let omega: Vec<f64> = (0..LINKS)
        .map(|k| first(&format!("link{k}.omega")))
        .collect();
    assert!(
        omega[last - 1].abs() > 0.1 && omega[0].abs() < 1e-9,
        "{omega:?}"
    );
    // all joints are closed and stay so
    for k in 1..LINKS {
        let end = |body: usize, along: f64, axis: &str| {
            let theta = first(&format!("link{body}.theta"));
            let arm = if axis == "x" {
                theta.cos()
            } else {
                theta.sin()
            };
            first(&format!("link{body}.{axis}")) + along * arm
        };
        for axis in ["x", "y"] {
            let gap = end(k - 1, 0.05, axis) - end(k, -0.05, axis);
            assert!(gap.abs() < 1e-11, "joint {k}: {gap}");
        }
    }
    assert!((report.t - 1e-4).abs() < 1e-18);
}

/// A drive turns the first link, whose coordinates are then known.
#[test]
fn a_long_chain_follows_a_drive() {
    let drive = "drives.motor = { type = \"angle\", joint = \"j0\", angle = { type = \"polynomial\", coefficients = [0.1, 3.0] } }\n";
    let scene = Scene::parse("chain", &chain(drive), &[]).unwrap();
    let (recording, report) = run_scene(&scene);
    assert!(report.redundant.is_empty(), "{:?}", report.redundant);
    for (name, value) in [
        ("link0.omega", 3.0),
        ("link0.theta", 0.1),
        ("link149.omega", 2.0),
    ] {
        let first = recording.get(name)[0];
        assert!((first - value).abs() < 1e-12, "{name}: {first}");
    }
}

/// The first link turns about its pin, so one component of its velocity gives the others; the joints determine the last one.
#[test]
fn velocities_of_a_long_chain_that_follow_from_others_are_refused_by_name() {
    let last = LINKS - 1;
    for (given, message) in [
        (
            "velocities.link0 = { omega = 1.0, vx = 5.0 }",
            "omega of link0 contradicts the joints",
        ),
        (
            "velocities.link0 = { vx = 0.0, vy = 0.0 }",
            "vy of link0 repeats the joints",
        ),
        (
            "bodies.link0 = { x = 0.047766824456280305, y = 0.014776010333066978, theta = 0.3, vx = -0.029552020666133955, vy = 0.09553364891256061, omega = 3.0 }",
            "the given velocity of link0 contradicts the joints and drives: omega is off by 1\u{a0}rad/s",
        ),
    ] {
        let text = chain("").replace(
            &format!("initial.velocities.link{last}.omega = 2.0"),
            &format!("initial.{given}"),
        );
        let scene = Scene::parse("chain", &text, &[]).unwrap();
        let error = Simulation::new(&scene).unwrap_err().to_string();
        assert!(error.contains(message), "{error}");
    }
}

/// Poses hold every second body; only one of them is wrong.
#[test]
fn a_wrong_pose_in_a_long_chain_is_named() {
    let text = chain("");
    let kept = text.lines().filter(|line| !line.starts_with("initial."));
    let mut text: String = kept.map(|line| format!("{line}\n")).collect();
    for k in 0..LINKS {
        let x = 0.1 * k as f64;
        text += &format!("initial.sketch.j{k} = [{x}, 0.0]\n");
        if k % 2 == 0 {
            let x = x + if k == 74 { 0.07 } else { 0.05 };
            text += &format!("initial.bodies.link{k} = {{ x = {x}, y = 0.0, theta = 0.0 }}\n");
        }
    }
    text += &format!(
        "initial.sketch.link{}.b = [{}, 0.0]\n",
        LINKS - 1,
        0.1 * LINKS as f64
    );
    let scene = Scene::parse("chain", &text, &[]).unwrap();
    let error = Simulation::new(&scene).unwrap_err().to_string();
    assert!(
        error.contains("the given pose of link74 contradicts the sketch"),
        "{error}"
    );
}

/// Second pins between the same points repeat the rows of the first ones, which come before them in the scene.
#[test]
fn redundant_joints_of_a_long_chain_are_named() {
    let places = [20, 21, 70, 140];
    let twin = |k: usize| {
        format!(
            "joints.twin{k} = {{ type = \"revolute\", bearing = \"link{}.b\", journal = \"link{k}.a\", model = \"ideal\" }}\n",
            k - 1
        )
    };
    let twins: String = places.map(twin).concat();
    let scene = Scene::parse("chain", &chain(&twins), &[]).unwrap();
    let redundant = Simulation::new(&scene).unwrap().report().redundant;
    let expected = places
        .iter()
        .flat_map(|k| ["x", "y"].map(|axis| format!("joint twin{k} ({axis})")));
    assert_eq!(redundant, expected.collect::<Vec<_>>());
    // what is redundant changes nothing
    let plain = Scene::parse("chain", &chain(""), &[]).unwrap();
    let [(with, _), (without, _)] = [&scene, &plain].map(run_scene);
    for k in 0..LINKS {
        for axis in ["x", "y", "theta"] {
            let name = format!("link{k}.{axis}");
            let (with, without) = (with.get(&name), without.get(&name));
            let pairs = with.iter().zip(&without);
            let off = pairs.fold(0.0_f64, |m, (x, y)| m.max((x - y).abs()));
            // the poses of both are closed to 1e-12 m in every joint
            assert!(off < 1e-9, "{name}: {off}");
        }
    }
}

/// A robot arm whose drives leave no freedom: the square of the condition number of its velocity equations is beyond ten digits.
#[test]
fn a_long_arm_with_a_drive_in_every_joint_starts_as_it_is_driven() {
    let drive = |k: usize| {
        format!(
            "drives.d{k} = {{ type = \"angle\", joint = \"j{k}\", angle = {{ type = \"polynomial\", coefficients = [0.01, 0.1] }} }}\n"
        )
    };
    let text = chain(&(0..LINKS).map(drive).collect::<String>());
    let given = text.lines().filter(|line| !line.starts_with("initial."));
    // every body is placed by the one before it, which the scene names after it
    let (bodies, others): (Vec<&str>, Vec<&str>) =
        given.partition(|line| line.starts_with("bodies.link"));
    let bodies = bodies.into_iter().rev().collect();
    let text = [others, bodies].concat().join("\n");
    let scene = Scene::parse("arm", &text, &[]).unwrap();
    let simulation = Simulation::new(&scene).unwrap();
    let state = simulation.state();
    let model = simulation.model();
    for (name, v) in model.unknown_names().iter().zip(&state.v) {
        let Some(k) = name
            .strip_suffix(".theta")
            .and_then(|name| name.strip_prefix("link"))
        else {
            continue;
        };
        let rate = 0.1 * (k.parse::<f64>().unwrap() + 1.0);
        // as far as the velocities of a start may be from the constraints
        assert!((v - rate).abs() < 1e-9 * LINKS as f64, "{name}: {v}");
    }
}

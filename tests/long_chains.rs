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

/// A second pin between the same points: dense algebra takes over and names its rows.
#[test]
fn a_redundant_joint_of_a_long_chain_is_named() {
    let twin = "joints.twin = { type = \"revolute\", bearing = \"link70.b\", journal = \"link71.a\", model = \"ideal\" }\n";
    let scene = Scene::parse("chain", &chain(twin), &[]).unwrap();
    let simulation = Simulation::new(&scene).unwrap();
    let redundant = simulation.report().redundant;
    assert_eq!(redundant.len(), 2, "{redundant:?}");
    assert!(
        redundant.iter().all(|name| name.starts_with("joint twin")),
        "{redundant:?}"
    );
}

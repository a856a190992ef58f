//! Newton's law from the outside: the recorded joint forces on every body add up to its mass times its recorded
//! acceleration, whatever the joints are made of.

use crate::support::{TestRecording, load, run_scene};
use ladder::{Rung, Worst};
use looselink::body::RigidBody;
use looselink::scene::Scene;

/// A chain of a rigid link, a flexible link and a rigid body under gravity, with every kind of joint in it: the first
/// fixed to ground by a shared node, two links sharing a node, a constraint, and a second link on the same node. A point mass
/// is a third body on that node, another hangs on an end of a link, a third one on a rigid body, by a constraint.
const CHAIN: &str = r#"
format = 1
title = "a chain"
simulation = { duration = 0.02, gravity = [0.3, -9.81] }
integrator = { method = "bathe", step = 1e-5, newton_tolerance = 1e-11, onset_tolerance = 1e-13 }
output = { interval = 1e-3, channels = ["*"] }
materials.steel = { density = 7800.0, youngs_modulus = 2e9 }
sections.bar = { width = 0.004, height = 0.01 }
bodies.ground = { type = "ground", points.O = [0.1, 0.2] }
bodies.upper = { type = "link", model = "rigid", length = 0.3, section = "bar", material = "steel" }
bodies.lower = { type = "link", model = "flexible", elements = 3, length = 0.2, section = "bar", material = "steel" }
bodies.side = { type = "link", model = "rigid", length = 0.1, section = "bar", material = "steel" }
bodies.bob = { type = "rigid_body", mass = 0.4, inertia = 1e-3, points.top = [0.01, 0.05], points.low = [0.0, -0.05] }
bodies.weight = { type = "point_mass", mass = 0.1 }
bodies.tip = { type = "point_mass", mass = 0.2 }
bodies.drop = { type = "point_mass", mass = 0.3 }
joints.O = { type = "revolute", bearing = "ground.O", journal = "upper.start", model = "ideal" }
joints.P = { type = "revolute", bearing = "lower.start", journal = "upper.end", model = "ideal" }
joints.R = { type = "revolute", bearing = "upper.end", journal = "side.start", model = "ideal" }
joints.Q = { type = "revolute", bearing = "lower.end", journal = "bob.top", model = "ideal" }
joints.W = { type = "revolute", bearing = "upper.end", journal = "weight.center", model = "ideal" }
joints.T = { type = "revolute", bearing = "tip.center", journal = "side.end", model = "ideal" }
joints.D = { type = "revolute", bearing = "bob.low", journal = "drop.center", model = "ideal" }
[initial.bodies]
upper = { x = 0.25, y = 0.2, theta = 0.0, vx = 0.0, vy = 0.0, omega = 0.0 }
lower = { x = 0.4877582561890373, y = 0.2479425538604203, theta = 0.5, vx = 0.0, vy = 0.0, omega = 0.0 }
side = { x = 0.42701511529340697, y = 0.15792645075960518, theta = -1.0, vx = 0.0, vy = 0.0, omega = 0.0 }
bob = { x = 0.5655165123780746, y = 0.24588510772084061, theta = 0.0, vx = 0.0, vy = 0.0, omega = 0.0 }
"#;

/// What is left of Newton's law for every body, and of Euler's about the centre of mass of rigid bodies, relative to the
/// largest forces.
fn check(worst: &Worst, scene: &Scene, run: &TestRecording) {
    let gravity = scene.simulation.gravity.unwrap_or([0.0; 2]);
    for (b, body) in scene.bodies.iter().enumerate() {
        let m = body.kind.mass().unwrap_or(0.0);
        if m == 0.0 {
            continue;
        }
        let joints: Vec<(f64, &looselink::scene::Joint, usize)> = scene
            .joints
            .iter()
            .filter_map(|j| match (j.bearing.body == b, j.journal.body == b) {
                (false, true) => Some((1.0, j, j.journal.point)),
                (true, false) => Some((-1.0, j, j.bearing.point)),
                _ => None,
            })
            .collect();
        worst.at(format!("on {} of {}", body.name, scene.title));
        for k in 0..run.len() {
            let mut scale = 0.0;
            let mut sum = [0.0; 2];
            let mut moment = 0.0;
            for (sign, joint, point) in &joints {
                let force = ["fx", "fy"].map(|q| sign * run.get(&format!("{}.{q}", joint.name))[k]);
                sum = [sum[0] + force[0], sum[1] + force[1]];
                scale += force[0].abs() + force[1].abs();
                if let Some(rigid) = body.kind.get::<RigidBody>() {
                    let (s, c) = run.get(&format!("{}.theta", body.name))[k].sin_cos();
                    let [x, y]: [f64; 2] = rigid.points[*point].at.into();
                    moment += (c * x - s * y) * force[1] - (s * x + c * y) * force[0];
                }
            }
            let a = ["ax", "ay"].map(|q| run.get(&format!("{}.{q}", body.name))[k]);
            let size = scale + m * (a[0].abs() + a[1].abs()) + 1.0;
            for d in 0..2 {
                worst.see((sum[d] + m * (gravity[d] - a[d])) / size);
            }
            if let Some(rigid) = body.kind.get::<RigidBody>() {
                let alpha = run.get(&format!("{}.alpha", body.name))[k];
                worst.see((moment - rigid.inertia * alpha) / size);
            }
        }
    }
}

#[test]
fn forces_on_every_body_are_mass_times_acceleration() {
    let channels = r#"output.channels=["*"]"#;
    let worst = Worst::new();
    for case in [
        "case1",
        "case2",
        "case3",
        "case4",
        "case4-4elements",
        "case4-friction",
    ] {
        let overrides = [
            "simulation.duration=0.012",
            "output.interval=4e-4",
            channels,
        ];
        let scene = load(&format!("3rrr/{case}.toml"), &overrides);
        check(&worst, &scene, &run_scene(&scene).0);
    }
    let scene = Scene::parse("chain", CHAIN, &[]).unwrap_or_else(|e| panic!("{e}"));
    let (run, report) = run_scene(&scene);
    check(&worst, &scene, &run);
    Rung::Balance
        .asks("3-RRR (six scenes) and a chain of links, bodies and point masses: joint forces on every body against its inertia and weight, over the sum of forces + 1")
        .within(&worst,
            1e-12,
            "reactions come from a linear solve of well conditioned poses: rounding of the largest force",
        );
    let ledger = report.ledger.unwrap();
    assert_ne!(ledger.stored.gravity, 0.0);
    Rung::Balance
        .asks("Chain of links falling for 0.02 s: numerical loss of energy over the kinetic energy")
        .within(
            ledger.numerical / ledger.stored.kinetic,
            1e-3,
            "a term missing from the balance would be of the order of the kinetic energy: a thousandth of it tells",
        );
}

/// A uniform rod released from the horizontal: its pivot carries a quarter of its weight, its end falls with 3 g/2.
#[test]
fn a_released_rod_hangs_on_a_quarter_of_its_weight() {
    let rod = |model: &str, bearing: &str, journal: &str| {
        let text = format!(
            r#"
format = 1
title = "a rod"
simulation = {{ duration = 0.001, gravity = [0.0, -9.81] }}
integrator = {{ method = "bathe", step = 1e-5, newton_tolerance = 1e-11 }}
output = {{ interval = 1e-3, channels = ["*"] }}
materials.steel = {{ density = 7800.0, youngs_modulus = 2e11 }}
sections.bar = {{ width = 0.01, height = 0.01 }}
bodies.ground = {{ type = "ground", points.O = [0.0, 0.0] }}
bodies.rod = {model}
joints.O = {{ type = "revolute", bearing = "{bearing}", journal = "{journal}", model = "ideal" }}
initial.bodies.rod = {{ x = 0.5, y = 0.0, theta = 0.0 }}
"#
        );
        let scene = Scene::parse("rod", &text, &[]).unwrap_or_else(|e| panic!("{e}"));
        let run = run_scene(&scene).0;
        (
            run.get("O.fy")[0],
            run.get("rod.ay")[0],
            run.get("rod.alpha")[0],
        )
    };
    let link = |model: &str| {
        format!(
            r#"{{ type = "link", model = "{model}", elements = 4, length = 1.0, section = "bar", material = "steel" }}"#
        )
    };
    let body =
        r#"{ type = "rigid_body", mass = 0.78, inertia = 0.065, points.start = [-0.5, 0.0] }"#;
    let weight = 0.78 * 9.81;
    let closed_form = Worst::new();
    for model in [link("rigid"), body.to_owned()] {
        let (force, ay, alpha) = rod(&model, "ground.O", "rod.start");
        closed_form.see(force / (0.25 * weight) - 1.0);
        closed_form.see(ay / (-0.75 * 9.81) - 1.0);
        closed_form.see(alpha / (-1.5 * 9.81) - 1.0);
    }
    Rung::Balance
        .asks("Rod released from the horizontal: hinge force mg/4, accelerations 3g/4 and 3g/2l, relative error")
        .within(&closed_form,
            1e-12,
            "closed form; the start is at rest and exact",
        );
    // the force is that of the bearing on the journal, whichever carries which
    for model in [link("rigid"), body.to_owned(), link("flexible")] {
        let (force, ..) = rod(&model, "ground.O", "rod.start");
        let (swapped, ..) = rod(&model, "rod.start", "ground.O");
        assert!(
            force > 0.01 * weight && (swapped + force).abs() < 1e-12 * weight,
            "{model}: {swapped} {force}"
        );
    }
}

//! Cases 1 and 2: ideal joints.

use crate::rrr;
use crate::support::{TestRecording, load, rms_difference, run};
use ladder::{Rung, Worst};
use looselink::simulate::Simulation;

#[test]
fn sizes_of_the_compiled_models() {
    for (case, sizes) in [
        (1, [6, 6, 0]),
        (2, [21, 6, 0]),
        (3, [12, 0, 6]),
        (4, [27, 0, 6]),
    ] {
        let inspection = Simulation::new(&load(&format!("3rrr/case{case}.toml"), &[]))
            .unwrap()
            .inspect();
        assert_eq!(
            [
                inspection.unknowns,
                inspection.multipliers,
                inspection.contacts
            ],
            sizes,
            "case {case}"
        );
        assert_eq!(inspection.coordinates.len(), sizes[0]);
        assert_eq!(inspection.constraints.len(), sizes[1]);
    }
}

/// The platform rides on its path to rounding, and everything else equals the inverse dynamics computed another way.
#[test]
fn case_1_is_the_ideal_mechanism() {
    let step = [
        "integrator.step=1e-4",
        "output.interval=1e-3",
        "simulation.duration=2",
    ];
    let channels = r#"output.channels=["*"]"#;
    let (run, _) = run("3rrr/case1.toml", &[&step[..], &[channels]].concat());
    assert_eq!(run.len(), 2001);
    let errors = Worst::new();
    for name in ["error.x", "error.y", "error.theta"] {
        run.get(name).iter().for_each(|e| errors.see(*e));
    }
    Rung::Routes
        .asks("Ideal 3-RRR (case 1): distance of the platform from its path over 2 s [m, rad]")
        .within(&errors, 1e-14, "rounding of coordinates near 0.4 m");
    let t = run.get("t");
    let dynamics = Worst::new();
    let close = |name: &str, expected: &dyn Fn(&rrr::Instant) -> f64| {
        let values = run.get(name);
        let exact: Vec<f64> = t
            .iter()
            .map(|t| expected(&rrr::inverse_dynamics(*t)))
            .collect();
        let size = exact.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        assert!(size > 0.1, "{name} is not tested");
        for (value, exact) in values.iter().zip(&exact) {
            let mut difference = value - exact;
            if name.ends_with("angle") {
                difference -= std::f64::consts::TAU * (difference / std::f64::consts::TAU).round();
            }
            dynamics.at(name);
            dynamics.see(difference / size);
        }
    };
    let w = std::f64::consts::TAU;
    for i in 0..3 {
        let joint = |kind: &str, quantity: &str| format!("{kind}{}.{quantity}", i + 1);
        for (k, quantity) in ["angle", "speed", "torque"].iter().enumerate() {
            close(&joint("A", quantity), &|x| x.drives[i][k]);
        }
        for (d, quantity) in ["fx", "fy"].iter().enumerate() {
            close(&joint("A", quantity), &|x| x.a[i][d]);
            close(&joint("B", quantity), &|x| x.b[i][d]);
            // the bearing is on the platform, the journal on the link
            close(&joint("C", quantity), &|x| x.c[i][d]);
        }
    }
    Rung::Routes
        .asks("Ideal 3-RRR (case 1): angles, speeds, torques and joint forces against Newton-Euler inverse dynamics, relative to the largest")
        .within(&dynamics,
            1e-12,
            "both are direct solves: rounding times the condition of the pose",
        );
    let platform = Worst::new();
    for (name, amplitude, phase) in [
        ("platform.vx", 0.1 * w, 0.25),
        ("platform.ax", 0.1 * w * w, 0.5),
    ] {
        for (t, value) in t.iter().zip(run.get(name)) {
            let exact = amplitude * (w * (t + phase)).cos();
            platform.see((value - exact) / amplitude);
        }
    }
    Rung::Routes
        .asks("Ideal 3-RRR (case 1): velocity and acceleration of the platform against those of its path, over their amplitudes")
        .within(&platform,
            1e-12,
            "a direct solve: rounding times the condition of the pose",
        );
}

/// The compiled inverse kinematics, whatever the elements and the joints, is the closed form.
#[test]
fn the_drive_is_the_closed_form() {
    let (run, _) = run(
        "3rrr/case3.toml",
        &[
            "simulation.duration=0.05",
            "output.interval=1e-3",
            r#"output.channels=["A*"]"#,
        ],
    );
    let worst = Worst::new();
    for (t, speed) in run.get("t").iter().zip(run.get("A2.speed")) {
        let exact = rrr::inverse_dynamics(*t).drives[1][1];
        worst.see((speed - exact) / exact.abs().max(1.0));
    }
    Rung::Routes
        .asks("3-RRR with loose joints (case 3): speed of a drive against closed-form kinematics, relative error (below 1 rad/s: absolute)")
        .within(&worst, 1e-12, "rounding");
}

/// Order 2 in every output; the reference is the same method at 6.25e-8 s. Positions from 2e-5 s on; accelerations and
/// reactions from 2e-6 s on, because the unstrained start rings the axial modes and coarser steps do not resolve them.
/// The error still falls between 5e-7 and 2.5e-7 s: rounding has not taken over.
#[test]
fn case_2_converges_at_order_two() {
    let at = |h: f64| {
        let step = format!("integrator.step={h:e}");
        let channels = r#"output.channels=["platform.*", "B1.fx", "A1.torque"]"#;
        run(
            "3rrr/case2.toml",
            &[
                &step,
                "output.interval=2e-5",
                "simulation.duration=0.02",
                channels,
            ],
        )
        .0
    };
    let reference = at(6.25e-8);
    let steps = [2e-5, 1e-5, 5e-6, 2e-6, 1e-6, 5e-7, 2.5e-7];
    let runs: Vec<_> = steps.iter().map(|&h| at(h)).collect();
    let errors = |name: &str, from: usize| -> Vec<(f64, f64)> {
        let exact = reference.get(name);
        let error = |(h, run): (&f64, &TestRecording)| (*h, rms_difference(&run.get(name), &exact));
        steps.iter().zip(&runs).skip(from).map(error).collect()
    };
    let smooth = "order 2 of Bathe's scheme; against a step of 6.25e-8 s";
    let rings = "order 2 from 2e-6 s on: the unstrained start excites axial modes, which coarser steps do not resolve";
    for (name, quantity, from, reason) in [
        ("platform.x", "position of the platform [m]", 0, smooth),
        ("platform.vx", "velocity of the platform [m/s]", 3, rings),
        (
            "platform.ax",
            "acceleration of the platform [m/s²]",
            3,
            rings,
        ),
        ("B1.fx", "force in a joint [N]", 3, rings),
        ("A1.torque", "torque of a drive [N m]", 3, rings),
    ] {
        Rung::OrderInTime
            .asks(format!(
                "3-RRR with flexible links (case 2): {quantity}, root mean square over 0.02 s"
            ))
            .falls("Step h [s]", &errors(name, from), 1.8..2.2, reason);
    }
}

/// Numerical dissipation over case 2 is of order 2 in h once the axial modes are resolved.
#[test]
fn case_2_numerical_dissipation_has_order_two() {
    let steps = [2e-6, 1e-6, 5e-7];
    let numerical = |h: f64| {
        let step = format!("integrator.step={h:e}");
        let (_, report) = run(
            "3rrr/case2.toml",
            &[&step, "output.interval=1e-3", "simulation.duration=0.02"],
        );
        report.ledger.unwrap().numerical.abs()
    };
    let errors: Vec<_> = steps.iter().map(|&h| (h, numerical(h))).collect();
    Rung::OrderInTime
        .asks("3-RRR with flexible links (case 2): numerical loss of energy over 0.02 s [J]")
        .falls(
            "Step h [s]",
            &errors,
            1.8..2.2,
            "order 2 once the axial modes are resolved",
        );
}

/// A crank described as a rigid body is the same crank: every recorded number agrees to rounding, the work among them.
#[test]
fn a_crank_may_be_a_rigid_body() {
    let mass = 2700.0 * 0.015 * 0.03 * 0.245;
    let inertia = mass * 0.245 * 0.245 / 12.0;
    let cranks: Vec<String> = (1..=3)
        .map(|i| {
            format!(
                "bodies.crank{i}={{ type = \"rigid_body\", mass = {mass:?}, inertia = {inertia:?}, points.start = [-0.1225, 0.0], points.end = [0.1225, 0.0] }}"
            )
        })
        .collect();
    let worst = Worst::new();
    for case in [1, 2, 4] {
        let scene = format!("3rrr/case{case}.toml");
        let channels =
            r#"output.channels=["platform.*", "error.*", "A*", "B*", "C*", "link*", "energy.*"]"#;
        let mut overrides = vec!["simulation.duration=4e-3", "output.interval=4e-4", channels];
        overrides.push("integrator.step=1e-5");
        let (links, _) = run(&scene, &overrides);
        overrides.extend(cranks.iter().map(String::as_str));
        let (bodies, _) = run(&scene, &overrides);
        for name in links.names() {
            let (a, b) = (links.get(name), bodies.get(name));
            let size = a.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
            for (x, y) in a.iter().zip(&b) {
                worst.at(format!("in {name} of case {case}"));
                worst.see((x - y) / size.max(1e-3));
            }
        }
    }
    Rung::Routes
        .asks("3-RRR (cases 1, 2, 4) with cranks as links or as rigid bodies: difference of all channels, over max(largest value, 1e-3)")
        .within(&worst,
            1e-6,
            "different rounding of positions, times EA = 1e6 N: 1e-10 N, and 1e-8 m/s² per step for 0.01 kg",
        );
}

/// Torque times speed of the recorded drives integrates to the recorded work, by Simpson's rule over the rows.
#[test]
fn drive_power_integrates_to_the_work() {
    let worst = Worst::new();
    for case in [1, 2] {
        let scene = format!("3rrr/case{case}.toml");
        let channels = r#"output.channels=["A*", "energy.*"]"#;
        let overrides = [
            "integrator.step=2e-6",
            "output.interval=4e-6",
            "simulation.duration=0.04",
            channels,
        ];
        let (run, _) = run(&scene, &overrides);
        let mut power = vec![0.0; run.len()];
        for i in 1..=3 {
            let (torque, speed) = (
                run.get(&format!("A{i}.torque")),
                run.get(&format!("A{i}.speed")),
            );
            for k in 0..power.len() {
                power[k] += torque[k] * speed[k];
            }
        }
        let last = power.len() - 1;
        let simpson: f64 = (0..=last)
            .map(|k| power[k] * [1.0, 4.0, 2.0][if k == 0 || k == last { 0 } else { 2 - k % 2 }])
            .sum();
        let work = run.get("energy.work")[last];
        let integral = simpson * 4e-6 / 3.0;
        assert!(work.abs() > 1e-3);
        worst.see(integral / work - 1.0);
    }
    Rung::Balance
        .asks("3-RRR (cases 1 and 2): torque times speed of the drives by Simpson's rule against the recorded work, relative error")
        .within(&worst,
            1e-9,
            "order 4 of Simpson's rule; in case 2 the power of the vibration is a hundred times the mean power",
        );
}

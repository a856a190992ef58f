//! Flexible pendulums and a beam that is spun up, in the functional of this element.

use super::{beam, last, listed, run};
use crate::support::{self, TestRecording};
use ladder::{Rung, Worst};
use std::f64::consts::TAU;

const HINGE: &str = r#"
[joints.hinge]
type = "revolute"
bearing = "ground.O"
journal = "beam.start"
model = "ideal"
"#;

fn pendulum(body: &str, step: f64, interval: f64, duration: f64) -> TestRecording {
    let head = format!(
        r#"
format = 1
title = "flexible pendulum"
[simulation]
duration = {duration:?}
gravity = [0.0, -9.81]
[integrator]
method = "bathe"
step = {step:?}
newton_tolerance = 1e-12
[output]
interval = {interval:?}
channels = ["points.beam.end.*"]
"#
    );
    run(&(head + body + HINGE), &[])
}

/// I: section 4.7, L = 1.2 m, A = 0.0018 m2, I = 1.215e-8 m4, rho = 5540 kg/m3, E = 0.7 MPa; tip at 0.3, 0.5, 0.8, 1.1 s
/// from the semi-discrete equations with relative tolerance 1e-12.
#[test]
fn soft_pendulum_at_every_listed_mesh() {
    let listed = [
        (
            1,
            [
                [1.06832384557, -0.39863492107],
                [0.32823528373, -1.29084190963],
                [-0.96221763944, -0.82850950544],
                [-1.09231013466, 0.12170822034],
            ],
        ),
        (
            2,
            [
                [1.08172392799, -0.46472519172],
                [0.36166642455, -1.28355999217],
                [-0.94557612216, -0.78637378766],
                [-1.08587771864, 0.06618092445],
            ],
        ),
        (
            4,
            [
                [1.07644533851, -0.44422552131],
                [0.37238197268, -1.26918743991],
                [-0.96179525811, -0.76087089381],
                [-1.01486341501, 0.08914684648],
            ],
        ),
        (
            8,
            [
                [1.07436522037, -0.44019088913],
                [0.37440255359, -1.22867318529],
                [-0.93198807030, -0.76844417770],
                [-1.01422964674, 0.08671153848],
            ],
        ),
    ];
    for (n, tips) in listed {
        let body = beam(1.2, 0.7e6 * 0.0018, 0.7e6 * 1.215e-8, 5540.0 * 0.0018, n);
        let error = |step: f64| {
            let run = pendulum(&body, step, 0.1, 1.1);
            let (x, y) = (run.get("points.beam.end.x"), run.get("points.beam.end.y"));
            let farthest = Worst::new();
            for (r, tip) in [3, 5, 8, 11].into_iter().zip(tips) {
                farthest.see((x[r] - tip[0]).hypot(y[r] - tip[1]));
            }
            (step, farthest.value())
        };
        let errors = [error(2e-5), error(1e-5)];
        Rung::OrderInTime
            .asks(format!("Soft pendulum, n = {n}: distance of the tip from the listed positions over 1.1 s [m]"))
            .falls(
                "Step h [s]",
                &errors,
                1.8..2.2,
                "order 2 of Bathe's scheme; listed are the equations in time with relative tolerance 1e-12",
            );
    }
}

/// I, E: section 4.8, L = 1 m, EA = 5.25e7, EI = 10937.5, rho A = 10: nearly a rigid rod.
#[test]
fn stiff_pendulum_at_every_listed_mesh() {
    let rigid = [-0.99996658807187, -0.0081745177170758];
    let (from_listed, from_rigid) = (Worst::new(), Worst::new());
    for (n, tip) in [
        (1, [-0.9999666747, -0.0081667077]),
        (2, [-0.9999667322, -0.0081595877]),
        (4, [-0.9999668924, -0.0081396260]),
    ] {
        let body = beam(1.0, 5.25e7, 10937.5, 10.0, n);
        let run = pendulum(&body, 2e-5, 1.0, 1.0);
        let (x, y) = (
            last(&run, "points.beam.end.x"),
            last(&run, "points.beam.end.y"),
        );
        from_listed.see((x - tip[0]).hypot(y - tip[1]));
        from_rigid.see((x - rigid[0]).hypot(y - rigid[1]));
    }
    Rung::Computed
        .asks("Stiff pendulum, n = 1 ... 4, h = 2e-5 s: distance of the tip from the listed positions after 1 s [m]")
        .within(
            &from_listed,
            3e-6,
            "flexibility moves the tip by 3.5e-5 m at most; the first two bending modes, 509 and 1650 rad/s, lag by w (wh)² t/24 = 0.002 and 0.075 rad",
        );
    Rung::ClosedForms
        .asks("Stiff pendulum, n = 1 ... 4: distance of the tip from that of the rigid rod in closed form after 1 s [m]")
        .within(&from_rigid,
            5e-5,
            "flexibility moves the listed tips by 3.5e-5 m at most"
        );
}

/// E: section 4.9 (Simo and Vu-Quoc data): the steady extension of the beam that turns at 6 rad/s. Strain-rate damping
/// lets the bending vibration of the spin-up die; it does not see the steady state.
#[test]
fn spin_up_ends_in_the_steady_extension() {
    let head = r#"
format = 1
title = "spin-up"
[simulation]
duration = 40.0
[integrator]
method = "bathe"
step = 1e-3
newton_tolerance = 1e-10
[output]
interval = 0.5
channels = ["points.beam.end.*"]
[drives.motor]
type = "angle"
joint = "hinge"
angle = { type = "spin_up", start = 0.0, speed = 6.0, duration = 15.0 }
"#;
    let body = beam(10.0, 2.8e7, 1.4e4, 1.2, 8);
    let text = head.to_owned() + &body + "kelvin_voigt = 0.05\n" + HINGE;
    let run = run(&text, &[]);
    let (x, y) = (run.get("points.beam.end.x"), run.get("points.beam.end.y"));
    let extension = |row: usize| x[row].hypot(y[row]) - 10.0;
    let end = extension(x.len() - 1);
    Rung::ClosedForms
        .asks("Spin-up with strain-rate damping: steady extension against the closed form [m]")
        .within(
            end - 5.142698461778e-4,
            2e-8,
            "a rotation by wh = 6e-3 a step has relative errors below (wh)² = 3.6e-5, of half a millimetre"
        );
}

/// I: section 4.9, the manoeuvre itself: displacement of the tip in the frame that turns with the hub.
const SPIN_UP: &str = include_str!("spin_up.csv");

/// Errors of the displacement along and across the hub's direction \[m\] and of the turn of the tip's slope \[rad\] at every
/// listed time of a run, row by row.
fn spin_up(elements: usize, overrides: &[&str]) -> Vec<[f64; 3]> {
    let elements_key = format!("bodies.blade.elements={elements}");
    let mut all = vec!["output.interval=0.5", elements_key.as_str()];
    all.extend(overrides);
    let (run, _) = support::run("spin-up.toml", &all);
    let [x, y, slope_x, slope_y] =
        ["x", "y", "slope_x", "slope_y"].map(|q| run.get(&format!("points.blade.end.{q}")));
    let end = run.get("t")[run.len() - 1];
    let rows = listed(SPIN_UP);
    let of_mesh = rows
        .iter()
        .filter(|r| r[0] == elements as f64 && r[1] <= end);
    let errors = of_mesh.map(|listed| {
        let t = listed[1];
        let row = run.row(t);
        let theta = match t <= 15.0 {
            true => {
                let swing = (15.0 / TAU).powi(2) * ((TAU * t / 15.0).cos() - 1.0);
                6.0 / 15.0 * (0.5 * t * t + swing)
            }
            false => 6.0 * t - 45.0,
        };
        let (s, c) = theta.sin_cos();
        let turned = |x: f64, y: f64| [c * x + s * y, c * y - s * x];
        let [along, across] = turned(x[row], y[row]);
        let [cosine, sine] = turned(slope_x[row], slope_y[row]);
        [
            along - 10.0 - listed[2],
            across - listed[3],
            sine.atan2(cosine) - listed[4],
        ]
    });
    errors.collect()
}

#[test]
fn spin_up_bends_back_as_listed() {
    let worst = Worst::new();
    for (elements, step) in [(2, "1e-4"), (4, "5e-5")] {
        let step = format!("integrator.step={step}");
        let explicit = "integrator.method=dormand_prince";
        let errors = spin_up(elements, &[explicit, &step, "simulation.duration=12"]);
        assert_eq!(errors.len(), 15);
        errors.as_flattened().iter().for_each(|e| worst.see(*e));
    }
    Rung::Computed
        .asks("Spin-up, n = 2 and 4, Dormand and Prince: listed displacement and rotation of the tip over 12 s [m, rad]")
        .within(
            &worst,
            1e-9,
            "ten digits are listed, 1e-10 m; ten times that for the error of the listed integration",
        );

    let farthest = |errors: &[[f64; 3]]| {
        let worst = Worst::new();
        errors.as_flattened().iter().for_each(|e| worst.see(*e));
        worst.value()
    };
    let steps = [2e-3, 1e-3, 5e-4];
    let runs = steps.map(|h| spin_up(8, &[&format!("integrator.step={h:?}")]));
    let errors: Vec<_> = steps
        .iter()
        .zip(&runs)
        .map(|(h, errors)| (*h, farthest(errors)))
        .collect();
    Rung::OrderInTime
        .asks(
            "Spin-up, n = 8, Bathe: listed displacement and rotation of the tip over 20 s [m, rad]",
        )
        .falls("Step h [s]", &errors, 1.9..2.1, "order 2 of Bathe's scheme");
    let pairs = runs[1].as_flattened().iter().zip(runs[2].as_flattened());
    let extrapolated = Worst::new();
    pairs.for_each(|(coarse, fine)| extrapolated.see((4.0 * fine - coarse) / 3.0));
    Rung::Computed
        .asks("Spin-up, n = 8: listed displacement and rotation of the tip over 20 s, extrapolated from h = 1e-3 and 5e-4 s [m, rad]")
        .within(
            &extrapolated,
            1e-8,
            "a hundredth of the error of 1e-6 at h = 5e-4 s is left to the next orders",
        );
}

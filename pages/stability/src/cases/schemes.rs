//! Where schemes differ most: stiff springs.

use super::{Check, apart, column, gain, largest, order, run, try_run};
use crate::outcome::Stopped;

const TRUSS: &str = "hard/stiff-truss.toml";
const PENDULUM: &str = "stiff-spring-pendulum.toml";
/// One swing of the stiff spring pendulum there and back, from the horizontal: 4 K(sin 45 deg) sqrt(L/g) \[s\].
const SWING: f64 = 7.416_298_7;
/// One turn of the truss \[s\].
pub(super) const TURN: f64 = 2.477_689_2;

pub(super) fn stiff_springs() -> Vec<Check> {
    let (_, bathe) = run(TRUSS, &[]);
    let trapezoidal = try_run(TRUSS, &["integrator.method=trapezoidal"]);
    let stopped = match &trapezoidal {
        Err(Stopped::Refused(message, _)) => message.contains("unstable"),
        _ => false,
    };
    let (_, pendulum) = run(PENDULUM, &["integrator.step=0.01"]);
    let (fine, _) = run(
        PENDULUM,
        &["integrator.method=trapezoidal", "integrator.step=5e-5"],
    );
    // two stages a step against one
    let errors = [("bathe", "5e-4"), ("trapezoidal", "2.5e-4")].map(|(method, step)| {
        let method = format!("integrator.method={method}");
        let step = format!("integrator.step={step}");
        let (coarse, _) = run(PENDULUM, &[&method, &step]);
        apart(&coarse, &fine, "points.bob.center.x")
    });
    vec![
        Check::below(
            "Truss, 40 turns of 50 steps: energy gained by Bathe's scheme, relative",
            gain(&bathe),
            1e-12,
        ),
        Check::yes(
            "The same: the trapezoidal rule is stopped as unstable",
            stopped,
        ),
        Check::below(
            "Stiff spring pendulum, step of 1.6 periods of the spring: energy gained by Bathe's scheme, relative",
            gain(&pendulum),
            1e-12,
        ),
        Check::new(
            "Stiff spring pendulum, 25 stages per period of the spring: error of Bathe's scheme over that of the trapezoidal rule",
            errors[0] / errors[1],
            1.2..=4.0,
        ),
    ]
}

pub(super) fn three_springs() -> Vec<Check> {
    const START: &str = "initial.bodies.node2={ x = 0.0, y = 0.0, vx = 1.2, vy = 0.0 }";
    let mut worst = [0.0_f64; 2];
    for stiffness in [1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12] {
        let stiffness = format!("forces.stiff.stiffness={stiffness:e}");
        let (fine, _) = run(
            "three-spring.toml",
            &[START, &stiffness, "integrator.step=2.618e-3"],
        );
        for (worst, method) in worst.iter_mut().zip(["bathe", "trapezoidal"]) {
            let method = format!("integrator.method={method}");
            let (coarse, _) = run("three-spring.toml", &[START, &stiffness, &method]);
            *worst = worst.max(apart(&coarse, &fine, "node2.ax"));
        }
    }
    vec![
        Check::below(
            "Ten stiffnesses, 20 steps per period of the drive: error of the acceleration behind the spring, Bathe's scheme [m/s2]",
            worst[0],
            0.3,
        ),
        Check::new(
            "The same: trapezoidal rule, whose acceleration rings [m/s2]",
            worst[1],
            10.0..=f64::MAX,
        ),
    ]
}

/// Angular momentum and energy after `turns` of the truss, as deviations relative to the start.
pub(super) fn truss(turns: f64, step: f64) -> [f64; 2] {
    let duration = format!(
        "simulation.duration={}",
        (turns * TURN / step).ceil() * step
    );
    let step_set = format!("integrator.step={step}");
    let interval = format!("output.interval={}", 20.0 * step);
    let (recording, report) = run(TRUSS, &[&duration, &step_set, &interval]);
    let [x, y, vx, vy] =
        ["x", "y", "vx", "vy"].map(|q| column(&recording, &format!("points.bob.center.{q}")));
    let momentum = |k: usize| x[k] * vy[k] - y[k] * vx[k];
    let deviations = (0..x.len()).map(|k| momentum(k) / momentum(0) - 1.0);
    [largest(deviations), gain(&report)]
}

/// Energy gained in so many swings of the stiff spring pendulum, relative.
pub(super) fn pendulum(swings: f64) -> f64 {
    let duration = format!("simulation.duration={}", (swings * SWING).ceil());
    let settings = ["integrator.step=0.01", "output.interval=1", &duration];
    gain(&run(PENDULUM, &settings).1)
}

/// Order of the error of position of the truss.
pub(super) fn truss_order() -> f64 {
    let place = |step: &str| {
        let (recording, _) = run(TRUSS, &["simulation.duration=5", step, "output.interval=5"]);
        column(&recording, "points.bob.center.x")[1]
    };
    let fine = place("integrator.step=5e-4");
    let error = |h: f64| (h, (place(&format!("integrator.step={h}")) - fine).abs());
    order(error(2e-2), error(1e-2))
}

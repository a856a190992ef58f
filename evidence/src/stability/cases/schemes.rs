//! Where schemes differ most: stiff springs.

use super::{apart, column, gain, run};
use crate::stability::outcome::largest;

const TRUSS: &str = "hard/stiff-truss.toml";
const PENDULUM: &str = "stiff-spring-pendulum.toml";
/// One swing of the stiff spring pendulum there and back, from the horizontal: 4 K(sin 45 deg) sqrt(L/g) \[s\].
const SWING: f64 = 7.416_298_7;
/// One turn of the truss \[s\].
const TURN: f64 = 2.477_689_2;

pub(super) fn stiff_springs() -> Vec<f64> {
    let bathe = run(PENDULUM, "integrator.step=0.01");
    vec![gain(&run(TRUSS, "").1), gain(&bathe.1)]
}

pub(super) fn three_springs() -> Vec<f64> {
    const START: &str = "initial.bodies.node2={ x = 0.0, y = 0.0, vx = 1.2, vy = 0.0 }";
    let stiffnesses = [1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12];
    let references = stiffnesses.map(|stiffness| {
        let set = format!("{START}; forces.stiff.stiffness={stiffness:e}");
        let (fine, _) = run(
            "three-spring.toml",
            &format!("{set}; integrator.step=2.618e-3"),
        );
        (set, fine)
    });
    let worst = ["bathe", "trapezoidal"].map(|method| {
        largest(references.iter().map(|(set, fine)| {
            let (coarse, _) = run(
                "three-spring.toml",
                &format!("{set}; integrator.method={method}"),
            );
            apart(&coarse, fine, "node2.ax")
        }))
    });
    worst.to_vec()
}

/// Angular momentum and energy after `turns` of the truss, as deviations relative to the start.
pub(super) fn truss(turns: f64, step: f64) -> [f64; 2] {
    let (duration, interval) = ((turns * TURN / step).ceil() * step, 20.0 * step);
    let settings = format!("simulation.duration={duration}; integrator.step={step}");
    let rows = format!("{settings}; output.interval={interval}");
    let (recording, report) = run(TRUSS, &rows);
    let [x, y, vx, vy] =
        ["x", "y", "vx", "vy"].map(|q| column(&recording, &format!("points.bob.center.{q}")));
    let momentum = |k: usize| x[k] * vy[k] - y[k] * vx[k];
    let deviations = (0..x.len()).map(|k| momentum(k) / momentum(0) - 1.0);
    [largest(deviations), gain(&report)]
}

/// Energy gained in so many swings of the stiff spring pendulum, relative.
pub(super) fn pendulum(swings: f64) -> f64 {
    let duration = (swings * SWING).ceil();
    let settings = "integrator.step=0.01; output.interval=1; simulation.duration";
    gain(&run(PENDULUM, &format!("{settings}={duration}")).1)
}

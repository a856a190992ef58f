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
    let errors = [1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12].map(|stiffness: f64| {
        let set = format!("{START}; forces.stiff.stiffness={stiffness:e}");
        let run = |more: &str| run("three-spring.toml", &format!("{set}; {more}")).0;
        let fine = run("integrator.step=2.618e-3");
        let methods = ["integrator.method=bathe", "integrator.method=trapezoidal"];
        methods.map(|method| apart(&run(method), &fine, "node2.ax"))
    });
    [0, 1].map(|k| largest(errors.map(|e| e[k]))).to_vec()
}

/// 10,000 turns of the truss, and 10,000 swings of the pendulum.
pub(super) fn revolutions() -> Vec<f64> {
    let duration = (1e4 * TURN / 0.05).ceil() * 0.05;
    let settings = "integrator.step=0.05; output.interval=1; simulation.duration";
    let (recording, report) = run(TRUSS, &format!("{settings}={duration}"));
    let [x, y, vx, vy] =
        ["x", "y", "vx", "vy"].map(|q| column(&recording, &format!("points.bob.center.{q}")));
    let momentum = |k: usize| x[k] * vy[k] - y[k] * vx[k];
    let deviations = (0..x.len()).map(|k| momentum(k) / momentum(0) - 1.0);
    let duration = (1e4 * SWING).ceil();
    let settings = "integrator.step=0.01; output.interval=1; simulation.duration";
    let (_, swung) = run(PENDULUM, &format!("{settings}={duration}"));
    vec![gain(&report), largest(deviations), gain(&swung)]
}

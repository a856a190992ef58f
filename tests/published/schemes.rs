//! Published tables of time integration schemes: the three-spring model of Bathe and Noh 2012, and spectra (E).

use super::run;
use crate::chain::Chain;
use looselink::newton::Newton;
use looselink::scene::Method;
use looselink::stepper::stepper;
use looselink::system::{State, System};
use std::f64::consts::{PI, SQRT_2, TAU};

/// k1 = 1e7 between the moving point and node 2, k2 = 1 between nodes 2 and 3, u1 = sin 1.2 t: springs without rest
/// length are linear, and nothing moves along y.
const THREE_SPRINGS: &str = r#"
format = 1
title = "three-spring model"
[simulation]
duration = 15.708
[integrator]
method = "bathe"
step = 0.2618
newton_tolerance = 1e-14
[output]
interval = 0.2618
channels = ["node2.*", "node3.*", "stiff.force"]
[bodies.ground]
type = "ground"
[bodies.wall]
type = "moving"
path = { type = "coordinates", x = { type = "harmonic", mean = 0.0, amplitude = 1.0, frequency = 0.1909859317102744, phase = 0.0 }, y = 0.0, theta = 0.0 }
points.P = [0.0, 0.0]
[bodies.node2]
type = "point_mass"
mass = 1.0
[bodies.node3]
type = "point_mass"
mass = 1.0
[forces.stiff]
type = "spring_damper"
from = "wall.P"
to = "node2.center"
stiffness = 1e7
damping = 0.0
rest_length = 0.0
[forces.soft]
type = "spring_damper"
from = "node2.center"
to = "node3.center"
stiffness = 1.0
damping = 0.0
rest_length = 0.0
[initial]
bodies.node2 = { x = 0.0, y = 0.0 }
bodies.node3 = { x = 0.0, y = 0.0 }
"#;

/// Rows (step, [u2, u3, v2, v3, a2, a3]) of each scheme, from a recursion with 40 digits.
mod rows;

#[test]
fn the_three_spring_model_follows_the_tables_step_by_step() {
    let optimal = format!("integrator.gamma={:?}", 2.0 - SQRT_2);
    for (name, overrides, rows) in [
        ("Bathe, gamma 1/2", vec![], rows::BATHE_HALF),
        (
            "Bathe, gamma 2 - sqrt 2",
            vec![optimal],
            rows::BATHE_OPTIMAL,
        ),
        (
            "trapezoidal",
            vec!["integrator.method=\"trapezoidal\"".to_owned()],
            rows::TRAPEZOIDAL,
        ),
    ] {
        let run = run(THREE_SPRINGS, &overrides);
        let channels = ["x", "vx", "ax"].map(|c| [2, 3].map(|n| run.get(&format!("node{n}.{c}"))));
        for (step, listed) in rows {
            for level in 0..3 {
                for node in 0..2 {
                    let (got, want) = (channels[level][node][step], listed[2 * level + node]);
                    // the stiff spring turns the rounding of u into k eps = 1e-9 of a2 at each step
                    let size = if level == 2 && node == 0 {
                        want.abs().max(100.0)
                    } else {
                        want.abs().max(1.0)
                    };
                    assert!(
                        (got - want).abs() < 1e-10 * size,
                        "{name}, step {step}, level {level}, node {}: {got}, listed {want}",
                        node + 2
                    );
                }
            }
        }
        assert!(run.get("node2.y").iter().all(|y| *y == 0.0));
    }
}

/// Spectral radius, period elongation and amplitude decay a period of a scheme at a step of dt/T periods, from its matrix
/// on (q, v/omega), which two steps of length 1 determine.
fn spectrum(method: Method, dt_over_period: f64) -> [f64; 3] {
    let omega = TAU * dt_over_period;
    let oscillator = Chain::new(vec![1.0], vec![omega * omega, 0.0]);
    let column = |q: f64, v: f64| {
        let mut newton = Newton::new(&oscillator, 1e-16);
        let mut work = oscillator.work();
        let mut from = State::zeros(oscillator.shape());
        (from.q[0], from.v[0], from.a[0]) = (q, v * omega, -omega * omega * q);
        let mut to = from.clone();
        stepper(method, &oscillator)
            .step(&oscillator, &from, 1.0, &mut to, &mut newton, &mut work)
            .unwrap();
        [to.q[0], to.v[0] / omega]
    };
    let (a, b) = (column(1.0, 0.0), column(0.0, 1.0));
    let (trace, determinant) = (a[0] + b[1], a[0] * b[1] - a[1] * b[0]);
    let discriminant = 0.25 * trace * trace - determinant;
    if discriminant >= 0.0 {
        let radius = 0.5 * trace.abs() + discriminant.sqrt();
        return [radius, f64::NAN, f64::NAN];
    }
    let radius = determinant.sqrt();
    let angle = (-discriminant).sqrt().atan2(0.5 * trace);
    let decay = 1.0 - radius.powf(TAU / angle);
    [radius, omega / angle - 1.0, decay]
}

#[test]
fn spectra_follow_the_tables() {
    let half = Method::Bathe { gamma: 0.5 };
    let optimal = Method::Bathe {
        gamma: 2.0 - SQRT_2,
    };
    for (method, dt, radius, elongation, decay) in [
        (
            half,
            0.01,
            0.999999945920908,
            0.000164465456734,
            5.40878412014e-06,
        ),
        (
            half,
            0.1,
            0.999493934337159,
            0.0161793743647,
            0.00513062968298,
        ),
        (half, 1.0, 0.648466367708081, f64::NAN, f64::NAN),
        (
            optimal,
            0.01,
            0.999999942689705,
            0.000159625225287,
            5.73192801567e-06,
        ),
        (
            optimal,
            0.1,
            0.999463321935721,
            0.0157144241337,
            0.00543774144911,
        ),
        (optimal, 1.0, 0.635575314210254, f64::NAN, f64::NAN),
        (Method::Trapezoidal, 0.01, 1.0, 0.000328900272245, 0.0),
        (Method::Trapezoidal, 0.1, 1.0, 0.0320749106226, 0.0),
    ] {
        let [r, e, d] = spectrum(method, dt);
        // the listed numbers have twelve digits or more
        assert!(
            (r - radius).abs() < 1e-10,
            "{method:?} {dt}: radius {r}, listed {radius}"
        );
        if elongation.is_finite() {
            assert!(
                (e - elongation).abs() < 1e-10,
                "{method:?} {dt}: elongation {e}, listed {elongation}"
            );
            assert!(
                (d - decay).abs() < 1e-10,
                "{method:?} {dt}: decay {d}, listed {decay}"
            );
        }
    }
    // E: rho^2 = (144 + 25 x^2)/((9 + x^2)(16 + x^2)) at all steps, and zero at infinity
    for dt in [0.02, 0.3, 3.0, 100.0, 1000.0] {
        let x = (2.0 * PI * dt).powi(2);
        let exact = ((144.0 + 25.0 * x) / ((9.0 + x) * (16.0 + x))).sqrt();
        let [r, ..] = spectrum(half, dt);
        assert!(
            (r - exact).abs() < 1e-12 + 1e-10 * exact,
            "{dt}: {r}, exact {exact}"
        );
    }
}

//! Spectra of time integration schemes (E). A kernel test: it needs no scene.

use crate::chain::Chain;
use ladder::{Rung, Worst};
use looselink::newton::Newton;
use looselink::scene::Method;
use looselink::stepper::stepper;
use looselink::system::{State, System};
use std::f64::consts::{PI, SQRT_2, TAU};

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
    let worst = Worst::new();
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
        worst.see(r - radius);
        if elongation.is_finite() {
            worst.see(e - elongation);
            worst.see(d - decay);
        }
    }
    Rung::Published
        .asks("Bathe's scheme and trapezoidal rule: spectral radius, period elongation and amplitude decay against the listed digits")
        .within(&worst,
            1e-10,
            "the listed numbers have twelve digits or more",
        );
    // E: rho^2 = (144 + 25 x^2)/((9 + x^2)(16 + x^2)) at all steps, and zero at infinity
    let worst = Worst::new();
    for dt in [0.02, 0.3, 3.0, 100.0, 1000.0] {
        let x = (2.0 * PI * dt).powi(2);
        let exact = ((144.0 + 25.0 * x) / ((9.0 + x) * (16.0 + x))).sqrt();
        let [r, ..] = spectrum(half, dt);
        worst.see((r - exact) / (1e-2 + exact));
    }
    Rung::Published
        .asks("Bathe's scheme, γ = 1/2, 0.02 ... 1000 periods a step: spectral radius ρ against the closed form, over 0.01 + ρ")
        .within(&worst, 1e-10, "rounding of the amplification matrix, whose entries vanish with ρ");
}

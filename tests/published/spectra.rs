//! Spectra of time integration schemes (E). A kernel test: it needs no scene.

use crate::chain::Chain;
use ladder::{Rung, Worst};
use looselink::newton::Newton;
use looselink::stepper::{Method, bathe, esdirk, generalized_alpha, trapezoidal};
use looselink::system::{State, System};
use nalgebra::{Matrix3, Vector3};
use std::f64::consts::{PI, TAU};

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
        method
            .stepper(oscillator.shape())
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

/// The same of the generalised-alpha method and HHT, which carry a mean acceleration b from step to step: from its matrix on
/// (q, v/omega, b/omega^2), which the second steps of three runs determine. b follows from v_1 = v + h ((1 - gamma) b +
/// gamma b_1).
fn spectrum_with_memory(method: Method, rho: f64, dt_over_period: f64) -> [f64; 3] {
    let omega = TAU * dt_over_period;
    let oscillator = Chain::new(vec![1.0], vec![omega * omega, 0.0]);
    let gamma = 0.5 + (1.0 - rho) / (1.0 + rho);
    let (mut before, mut after) = (Matrix3::zeros(), Matrix3::zeros());
    for (column, start) in [[1.0, 0.0, -1.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]
        .into_iter()
        .enumerate()
    {
        let mut newton = Newton::new(&oscillator, 1e-16);
        let mut work = oscillator.work();
        let mut from = State::zeros(oscillator.shape());
        let [q, v, mut b] = start;
        (from.q[0], from.v[0], from.a[0]) = (q, v * omega, b * omega * omega);
        let mut to = from.clone();
        let mut scheme = method.stepper(oscillator.shape());
        for (t, matrix) in [(1.0, &mut before), (2.0, &mut after)] {
            scheme
                .step(&oscillator, &from, t, &mut to, &mut newton, &mut work)
                .unwrap();
            scheme.accept();
            b = ((to.v[0] - from.v[0]) / (omega * omega) - (1.0 - gamma) * b) / gamma;
            matrix.set_column(column, &Vector3::new(to.q[0], to.v[0] / omega, b));
            from.copy_from(&to);
        }
    }
    let step = after * before.try_inverse().unwrap();
    let roots = step.complex_eigenvalues();
    let radius = roots.iter().fold(0.0_f64, |r, root| r.max(root.norm()));
    let principal = roots.iter().find(|root| root.im > 1e-8 * root.norm());
    match principal {
        Some(root) => [
            radius,
            omega / root.arg() - 1.0,
            1.0 - root.norm().powf(TAU / root.arg()),
        ],
        None => [radius, f64::NAN, f64::NAN],
    }
}

/// Nine schemes at fourteen steps from 0.01 to 1000 periods, computed from their amplification matrices with extended
/// precision, independently of Looselink: spectral radius, period elongation, amplitude decay a period.
const SPECTRA: &str = include_str!("integrator_spectral.csv");

#[test]
fn spectra_follow_the_tables() {
    // the splitting of one stage matrix
    let optimal = |rho: f64| Method::new(&bathe::SCHEME).with("spectral_radius", rho);
    let worst = Worst::new();
    let mut rows = 0;
    for line in SPECTRA.lines().skip(1) {
        let cells: Vec<&str> = line.split(',').collect();
        let number = |i: usize| cells[i].parse().unwrap_or(f64::NAN);
        let dt: f64 = number(1);
        let [radius, elongation, decay] = match cells[0] {
            "trapezoidal" => spectrum(Method::new(&trapezoidal::SCHEME), dt),
            "bathe_g0.5" => spectrum(Method::new(&bathe::SCHEME), dt),
            "bathe_g2-sqrt2" => spectrum(optimal(0.0), dt),
            "rho_inf_bathe_0.5_opt" => spectrum(optimal(0.5), dt),
            "rho_inf_bathe_0.9_opt" => spectrum(optimal(0.9), dt),
            // its three roots come together there: rounding moves them by its cube root
            _ if dt > 5.0 => continue,
            other => {
                let rho = other.strip_prefix("genalpha_").unwrap().parse().unwrap();
                let method = Method::new(&generalized_alpha::SCHEME).with("spectral_radius", rho);
                spectrum_with_memory(method, rho, dt)
            }
        };
        worst.at(format!("with {} at {dt} periods a step", cells[0]));
        // entries of the matrix grow with the step, and their rounding with them
        let rounding = 1.0 + 0.01 * dt;
        worst.see((radius - number(2)) / rounding);
        if number(3).is_finite() && elongation.is_finite() {
            worst.see((elongation - number(3)) / (1.0 + number(3)));
            worst.see((decay - number(4)) / rounding);
        }
        rows += 1;
    }
    assert_eq!(rows, 126 - 4 * 3);
    Rung::ClosedForms
        .asks("Bathe's scheme with spectral radius 0, 0.5, 0.9, trapezoidal rule, generalised-α with 0, 0.5, 0.8, 0.9, at 0.01 ... 1000 periods a step (generalised-α: 5): spectral radius, period elongation and amplitude decay against the listed digits")
        .within(&worst,
            1e-10,
            "the listed numbers have twelve digits or more; radii and decays over 1 + 0.01 periods a step",
        );
    // E: rho^2 = (144 + 25 x^2)/((9 + x^2)(16 + x^2)) at all steps, and zero at infinity
    let worst = Worst::new();
    for dt in [0.02, 0.3, 3.0, 100.0, 1000.0] {
        let x = (2.0 * PI * dt).powi(2);
        let exact = ((144.0 + 25.0 * x) / ((9.0 + x) * (16.0 + x))).sqrt();
        let [r, ..] = spectrum(Method::new(&bathe::SCHEME), dt);
        worst.see((r - exact) / (1e-2 + exact));
    }
    Rung::ClosedForms
        .asks("Bathe's scheme, γ = 1/2, 0.02 ... 1000 periods a step: spectral radius ρ against the closed form, over 0.01 + ρ")
        .within(&worst, 1e-10, "rounding of the amplification matrix, whose entries vanish with ρ");
}

/// L-stability: no step of any length amplifies an oscillation, and an infinitely long one extinguishes it.
#[test]
fn the_methods_of_orders_3_and_5_are_l_stable() {
    for (scheme, far) in [(&esdirk::ORDER_3, 1e-3), (&esdirk::ORDER_5, 1e-2)] {
        let radius = |dt: f64| spectrum(Method::new(scheme), dt)[0];
        for k in -300..=300 {
            let dt = 10.0_f64.powf(f64::from(k) / 100.0);
            // rounding of a matrix with entries of size 1
            assert!(radius(dt) < 1.0 + 1e-13, "{scheme:?}: {dt} periods a step");
        }
        // R decays with the inverse of the step; the next term of the expansion is a thousandth
        let [shorter, longer] = [1e3, 1e4].map(radius);
        assert!(shorter < far, "{scheme:?}");
        assert!((10.0 * longer / shorter - 1.0).abs() < 0.01, "{scheme:?}");
    }
}

/// Steps far longer than the period damp by the spectral radius that was asked for; the table above has no HHT.
#[test]
fn long_steps_of_hht_have_the_spectral_radius_asked_for() {
    // at 1/2 a third root comes to the two
    for rho in [0.6, 0.75, 0.9] {
        let method = Method::new(&generalized_alpha::HHT).with("spectral_radius", rho);
        let [radius, ..] = spectrum_with_memory(method, rho, 1000.0);
        // two roots come together in the limit: they are some 1/(omega h) = 2e-4 away from it, and rounding of entries of size
        // (omega h)^2 moves them by its square root, 1e-4
        assert!((radius - rho).abs() < 1e-3, "{rho}: {radius}");
    }
}

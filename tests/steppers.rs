//! Schemes on linear systems: order, energy. The systems are written against the trait that mechanisms implement.

use crate::chain::Chain;
use ladder::{Rung, Worst};
use looselink::newton::Newton;
use looselink::scene::Method;
use looselink::stepper::stepper;
use looselink::system::{State, System};
use proptest::prelude::*;

/// Steps from (q, v) with the scheme; calls `see` after every step.
fn integrate(
    chain: &Chain,
    method: Method,
    h: f64,
    steps: usize,
    q: &[f64],
    v: &[f64],
    see: &mut dyn FnMut(&State),
) {
    let mut newton = Newton::new(chain, 1e-13);
    let mut work = chain.work();
    let mut from = State::zeros(chain.shape());
    from.q.copy_from_slice(q);
    from.v.copy_from_slice(v);
    newton.make_consistent(chain, &mut from, &mut work).unwrap();
    let mut to = from.clone();
    let mut scheme = stepper(method, chain);
    for k in 1..=steps {
        scheme
            .step(chain, &from, k as f64 * h, &mut to, &mut newton, &mut work)
            .unwrap();
        from.copy_from(&to);
        see(&from);
    }
}

fn energy(chain: &Chain, s: &State) -> f64 {
    let masses = chain.masses.iter().zip(&s.v);
    let springs = chain.springs.iter().enumerate();
    let kinetic: f64 = masses.map(|(m, v)| 0.5 * m * v * v).sum();
    let stored = springs.map(|(i, k)| 0.5 * k * chain.stretch(i, &s.q).powi(2));
    kinetic + stored.sum::<f64>()
}

#[test]
fn order_two_in_everything() {
    let chain = Chain::new(vec![1.0, 2.0], vec![3.0, 1.0, 2.0]);
    let at_end = |method: Method, steps: usize| {
        let mut last = [0.0; 3];
        integrate(
            &chain,
            method,
            2.0 / steps as f64,
            steps,
            &[0.3, -0.1],
            &[0.0, 0.5],
            &mut |s| {
                last = [s.q[0], s.v[1], s.a[0]];
            },
        );
        last
    };
    let bathe = [0.3, 0.5, 2.0 - 2.0_f64.sqrt(), 0.9].map(|gamma| Method::Bathe { gamma });
    for method in bathe.into_iter().chain([Method::Trapezoidal]) {
        let name = match method {
            Method::Bathe { gamma } => format!("Bathe's scheme, γ = {gamma:.3}"),
            Method::Trapezoidal => "The trapezoidal rule".to_owned(),
        };
        // the reference's own error is 1/1024 of the finest one compared
        let exact = at_end(method, 20480);
        for (i, quantity) in ["position", "velocity", "acceleration"].iter().enumerate() {
            let error = |n: usize| (2.0 / n as f64, (at_end(method, n)[i] - exact[i]).abs());
            Rung::OrderInTime
                .asks(format!("{name}, two masses on springs: {quantity}"))
                .falls(
                    "Step h [s]",
                    &[error(160), error(320), error(640)],
                    1.9..2.1,
                    "order 2; against the same scheme at a step 32 times smaller",
                );
        }
    }
}

/// On a linear undamped system no step gains energy beyond rounding, at any step and any splitting.
#[test]
fn energy_is_never_gained() {
    let gain = Worst::new();
    proptest!(|(
        masses in prop::collection::vec(0.1..10.0_f64, 1..5),
        stiff in prop::collection::vec(-3.0..7.0_f64, 6),
        start in prop::collection::vec(-1.0..1.0_f64, 10),
        log_step in -4.0..1.0_f64,
        gamma in 0.2..0.8_f64,
    )| {
        let n = masses.len();
        let chain = Chain::new(masses, stiff[..=n].iter().map(|x| 10.0_f64.powf(*x)).collect());
        let (mut last, mut first) = (f64::NAN, 0.0);
        let method = Method::Bathe { gamma };
        integrate(&chain, method, 10.0_f64.powf(log_step), 200, &start[..n], &start[5..5 + n], &mut |s| {
            let energy = energy(&chain, s);
            if last.is_nan() {
                first = energy;
            } else {
                // written so that what is not a number is seen
                gain.see(if energy <= last { 0.0 } else { (energy - last) / first });
            }
            last = energy;
        });
    });
    Rung::Balance
        .asks("Does Bathe's scheme ever gain energy on a linear chain, at any step and splitting? Gain a step over the initial energy")
        .within(&gain, 1e-12, "rounding: an energy is a sum of terms no larger than the first");
}

/// The trapezoidal rule keeps the energy of a linear undamped system at any step.
#[test]
fn the_trapezoidal_rule_keeps_the_energy() {
    let chain = Chain::new(vec![1.0, 2.0, 0.5], vec![3.0, 1e4, 2.0, 0.7]);
    let (mut first, worst) = (f64::NAN, Worst::new());
    for step in [1e-3, 0.1, 3.0] {
        let (q, v) = ([0.3, -0.1, 0.2], [0.0, 0.5, -0.4]);
        integrate(&chain, Method::Trapezoidal, step, 500, &q, &v, &mut |s| {
            if first.is_nan() {
                first = energy(&chain, s);
            }
            worst.see(energy(&chain, s) / first - 1.0);
        });
    }
    Rung::Balance
        .asks("Does the trapezoidal rule keep the energy of a linear chain over 500 steps? Relative change")
        .within(&worst, 1e-10, "rounding of Newton's method, 1e-13 m/s a step on a spring of 1e4 N/m");
}

/// The ledger is integrated over the stages: by Simpson's rule for γ = ½, for any γ exactly up to t²; by the trapezoidal
/// rule up to t. Clamps are counted stage by stage, and the state between is told.
#[test]
fn stages_are_integrated_and_told() {
    let chain = Chain::new(vec![1.0], vec![2.0, 3.0]);
    let worst = Worst::new();
    for method in [
        Method::Bathe { gamma: 0.5 },
        Method::Bathe { gamma: 0.3 },
        Method::Trapezoidal,
    ] {
        let mut newton = Newton::new(&chain, 1e-13);
        let mut work = chain.work();
        let mut from = State::zeros(chain.shape());
        (from.t, from.q[0]) = (0.7, 0.4);
        chain.powers(&mut from, &mut work);
        from.integrals[0] = 5.0;
        newton
            .make_consistent(&chain, &mut from, &mut work)
            .unwrap();
        let mut to = from.clone();
        let mut scheme = stepper(method, &chain);
        let clamps = scheme
            .step(&chain, &from, 0.9, &mut to, &mut newton, &mut work)
            .unwrap();
        let exact = |power: i32| (0.9_f64.powi(power) - 0.7_f64.powi(power)) / f64::from(power);
        worst.see(to.integrals[0] - 5.0 - exact(1));
        worst.see(to.integrals[1] - exact(2));
        let between: Vec<f64> = scheme.interior().iter().map(|s| s.t).collect();
        match method {
            Method::Bathe { gamma } => {
                worst.see(to.integrals[2] - exact(3));
                assert_eq!(clamps, 2);
                assert!(between.len() == 1 && (between[0] - 0.7 - gamma * 0.2).abs() < 1e-15);
            }
            Method::Trapezoidal => {
                // the error of the rule, h³/12 of the second derivative 2
                worst.see(to.integrals[2] - exact(3) - 0.2_f64.powi(3) / 6.0);
                assert_eq!(clamps, 1);
                assert!(between.is_empty());
            }
        }
    }
    Rung::Identities
        .asks("Are powers integrated over the stages exactly up to the degree of the scheme's quadrature?")
        .within(&worst, 4e-15, "rounding of an integral that begins at five");
}

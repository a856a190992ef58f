//! Schemes on linear systems: order, energy. The systems are written against the trait that mechanisms implement.

use crate::chain::Chain;
use ladder::{Rung, Worst};
use looselink::newton::Newton;
use looselink::scene::Method;
use looselink::stepper::{LocalError, look_ahead, stepper};
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
        scheme.accept();
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

/// Every scheme with its name for reports, its order, and the step of the coarsest run.
fn schemes() -> Vec<(Method, String, f64, f64)> {
    let bathe = [0.3, 0.5, 2.0 - 2.0_f64.sqrt(), 0.9].map(|gamma| {
        let name = format!("Bathe's scheme, γ = {gamma:.3}");
        (Method::bathe(gamma), name, 2.0, 2.0 / 160.0)
    });
    let spectral_radius = 0.6;
    let radius = format!("spectral radius {spectral_radius}");
    let gamma = 0.55;
    let others = [
        (
            Method::Bathe {
                gamma,
                spectral_radius,
            },
            format!("Bathe's scheme, γ = {gamma}, {radius}"),
            2.0,
        ),
        (Method::Trapezoidal, "The trapezoidal rule".to_owned(), 2.0),
        (
            Method::BackwardEuler,
            "The backward Euler rule".to_owned(),
            1.0,
        ),
        (
            Method::GeneralizedAlpha { spectral_radius },
            format!("Generalised-α, {radius}"),
            2.0,
        ),
        (
            Method::Hht { spectral_radius },
            format!("HHT, {radius}"),
            2.0,
        ),
        (Method::VelocityVerlet, "Velocity Verlet".to_owned(), 2.0),
        (
            Method::DormandPrince,
            "Dormand and Prince's pair".to_owned(),
            5.0,
        ),
    ]
    // the higher the order, the longer the steps that stand above rounding
    .map(|(method, name, order)| {
        let steps = if order == 5.0 {
            40.0
        } else {
            160.0 * 2.0 / order
        };
        (method, name, order, 2.0 / steps)
    });
    bathe.into_iter().chain(others).collect()
}

#[test]
fn every_scheme_has_its_order_in_everything() {
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
    // its error at this step is 1e-14
    let exact = at_end(Method::DormandPrince, 2000);
    for (method, name, order, coarse) in schemes() {
        for (i, quantity) in ["position", "velocity", "acceleration"].iter().enumerate() {
            let error = |h: f64| {
                (
                    h,
                    (at_end(method, (2.0 / h).round() as usize)[i] - exact[i]).abs(),
                )
            };
            Rung::OrderInTime
                .asks(format!("{name}, two masses on springs: {quantity}"))
                .falls(
                    "Step h [s]",
                    &[error(coarse), error(coarse / 2.0), error(coarse / 4.0)],
                    order - 0.1..order + 0.1 * order.max(2.0),
                    "the order of the scheme; against Dormand and Prince's at a step where it is right to 1e-14",
                );
        }
    }
}

/// Steps that change all the time keep the order: what a scheme carries from step to step fits the next one.
#[test]
fn the_order_survives_changing_steps() {
    let chain = Chain::new(vec![1.0, 2.0], vec![3.0, 1.0, 2.0]);
    let at_end = |method: Method, steps: usize| {
        let mut newton = Newton::new(&chain, 1e-13);
        let mut work = chain.work();
        let mut from = State::zeros(chain.shape());
        from.q.copy_from_slice(&[0.3, -0.1]);
        from.v.copy_from_slice(&[0.0, 0.5]);
        newton
            .make_consistent(&chain, &mut from, &mut work)
            .unwrap();
        let mut to = from.clone();
        let mut scheme = stepper(method, &chain);
        for k in 1..=steps {
            // every second step three times as long as the others
            let t = (k - k % 2) as f64 + 1.5 * (k % 2) as f64;
            let t = 2.0 / steps as f64 * t;
            // a step that is not kept leaves nothing behind
            for t in [0.5 * (from.t + t), t] {
                scheme
                    .step(&chain, &from, t, &mut to, &mut newton, &mut work)
                    .unwrap();
            }
            scheme.accept();
            from.copy_from(&to);
        }
        [from.q[0], from.v[1], from.a[0]]
    };
    let exact = at_end(Method::DormandPrince, 2000);
    for (method, name, order, coarse) in schemes() {
        let error = |h: f64| {
            let end = at_end(method, (2.0 / h).round() as usize);
            let errors = end.iter().zip(&exact).map(|(x, y)| (x - y).abs());
            (h, errors.fold(0.0, f64::max))
        };
        Rung::OrderInTime
            .asks(format!("{name}, steps in turns of 3 to 1: position, velocity, acceleration"))
            .falls(
                "Mean step h [s]",
                &[error(coarse), error(coarse / 2.0), error(coarse / 4.0)],
                order - 0.2..order + 0.1 * order.max(2.0),
                "the order of the scheme; against Dormand and Prince's at a step where it is right to 1e-14",
            );
    }
}

/// The estimate of the local error tends to the error of a step that Bathe's scheme makes, and falls with its order.
#[test]
fn local_errors_are_estimated() {
    let chain = Chain::new(vec![1.0, 2.0], vec![3.0, 1.0, 2.0]);
    let start = |newton: &mut Newton| {
        let mut from = State::zeros(chain.shape());
        from.q.copy_from_slice(&[0.3, -0.1]);
        from.v.copy_from_slice(&[0.2, 0.5]);
        newton
            .make_consistent(&chain, &mut from, &mut chain.work())
            .unwrap();
        from
    };
    let step = |method: Method, h: f64| {
        let mut newton = Newton::new(&chain, 1e-16);
        let from = start(&mut newton);
        let mut to = from.clone();
        let mut scheme = stepper(method, &chain);
        scheme
            .step(&chain, &from, h, &mut to, &mut newton, &mut chain.work())
            .unwrap();
        let mut error = LocalError::new(2);
        // neither of the schemes looks ahead
        scheme.local_error(&from, &to, &to, &mut error);
        (to, error, scheme.estimate())
    };
    let exact = |h: f64| {
        let mut newton = Newton::new(&chain, 1e-16);
        let mut from = start(&mut newton);
        let mut to = from.clone();
        let mut scheme = stepper(Method::DormandPrince, &chain);
        for k in 1..=20 {
            let t = h * f64::from(k) / 20.0;
            scheme
                .step(&chain, &from, t, &mut to, &mut newton, &mut chain.work())
                .unwrap();
            from.copy_from(&to);
        }
        from
    };
    for (gamma, spectral_radius) in [(0.5, 0.0), (2.0 - 2.0_f64.sqrt(), 0.0), (0.55, 0.6)] {
        let method = Method::Bathe {
            gamma,
            spectral_radius,
        };
        let missed = |h: f64| {
            let (to, estimated, estimate) = step(method, h);
            assert!(estimate.is_error && estimate.order == 3.0);
            let truth = exact(h);
            let mut worst = 0.0_f64;
            for i in 0..2 {
                // the estimate is the better solution less the scheme's
                worst = worst.max((truth.q[i] - to.q[i] - estimated.q[i]).abs());
                worst = worst.max((truth.v[i] - to.v[i] - estimated.v[i]).abs());
            }
            (h, worst)
        };
        Rung::OrderInTime
            .asks(format!(
                "Bathe's scheme, γ = {gamma:.3}, spectral radius {spectral_radius}: what the estimate of the local error misses of it"
            ))
            .falls(
                "Step h [s]",
                &[missed(0.04), missed(0.02), missed(0.01)],
                3.7..4.3,
                "the error is of h³ and its estimate right to leading order",
            );
    }
    let size = |h: f64| {
        let (_, estimated, estimate) = step(Method::DormandPrince, h);
        assert!(!estimate.is_error && estimate.order == 5.0);
        let errors = estimated.q.iter().chain(&estimated.v);
        (h, errors.fold(0.0_f64, |m, e| m.max(e.abs())))
    };
    Rung::OrderInTime
        .asks("Dormand and Prince's pair: the difference of its two solutions after one step")
        .falls(
            "Step h [s]",
            &[size(0.2), size(0.1), size(0.05)],
            4.8..5.3,
            "the solution of order 4 is off by h⁵",
        );
    // the first of two steps, which looks ahead, and the second, which looks back
    let missed = |method: Method, h: f64, share: f64| {
        let mut newton = Newton::new(&chain, 1e-16);
        let mut work = chain.work();
        let mut scheme = stepper(method, &chain);
        let mut error = LocalError::new(2);
        let mut to = start(&mut newton);
        let mut ahead = to.clone();
        let ends = [h * share, h * (1.0 + share)];
        let starts = [to.clone(), exact(ends[0])];
        let mut looks = starts.iter().zip(ends).map(|(from, t)| {
            scheme
                .step(&chain, from, t, &mut to, &mut newton, &mut work)
                .unwrap();
            if scheme.looks_ahead(from) {
                look_ahead(&chain, from, &to, &mut ahead, &mut newton, &mut work).unwrap();
            }
            scheme.local_error(from, &to, &ahead, &mut error);
            scheme.accept();
            let truth = exact(t);
            let missed = (0..2).map(|i| {
                let (q, v) = (truth.q[i] - to.q[i], truth.v[i] - to.v[i]);
                (q - error.q[i]).abs().max((v - error.v[i]).abs())
            });
            (h, missed.fold(0.0, f64::max))
        });
        [looks.next().unwrap(), looks.next().unwrap()]
    };
    let spectral_radius = 0.8;
    // the order of the estimate, and that of what it misses at the start, where the mean acceleration of the
    // generalised-alpha family has an error of h^2 of its own
    let by_the_ends = [
        (Method::Trapezoidal, 3.0, 4.0),
        (Method::GeneralizedAlpha { spectral_radius }, 3.0, 3.0),
        (Method::Hht { spectral_radius }, 3.0, 3.0),
        (Method::VelocityVerlet, 3.0, 4.0),
        (Method::BackwardEuler, 2.0, 3.0),
    ];
    for (method, order, at_start) in by_the_ends {
        let estimate = stepper(method, &chain).estimate();
        assert!(estimate.is_error && estimate.order == order);
        let first = [0.01, 0.005, 0.0025].map(|h| missed(method, h, 1.0)[0]);
        Rung::OrderInTime
            .asks(format!(
                "{} at the start: what the estimate of the local error misses of it",
                method.name()
            ))
            .falls(
                "Step h [s]",
                &first,
                at_start - 0.3..at_start + 0.3,
                "its estimate, by a look ahead, is right to the leading order of the error",
            );
        for share in [1.0, 0.3] {
            let missed = |h| missed(method, h, share)[1];
            Rung::OrderInTime
                .asks(format!(
                    "{} after a step {share} times as long: what the estimate of the local error misses of it",
                    method.name()
                ))
                .falls(
                    "Step h [s]",
                    &[missed(0.04), missed(0.02), missed(0.01)],
                    order + 0.7..order + 1.3,
                    "its estimate is right to the leading order of the error",
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
        let method = Method::bathe(gamma);
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
        Method::bathe(0.5),
        Method::bathe(0.3),
        Method::Trapezoidal,
        Method::BackwardEuler,
        Method::GeneralizedAlpha {
            spectral_radius: 0.8,
        },
        Method::VelocityVerlet,
        Method::DormandPrince,
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
            Method::Bathe { gamma, .. } => {
                worst.see(to.integrals[2] - exact(3));
                assert_eq!(clamps, 2);
                assert!(between.len() == 1 && (between[0] - 0.7 - gamma * 0.2).abs() < 1e-15);
            }
            Method::DormandPrince => {
                worst.see(to.integrals[2] - exact(3));
                assert_eq!(clamps, 5);
                assert!(between.is_empty());
            }
            _ => {
                // the error of the trapezoidal rule, h³/12 of the second derivative 2
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

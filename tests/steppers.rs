//! Schemes on linear systems: order, energy. The systems are written against the trait that mechanisms implement.

use crate::chain::{Chain, bathe};
use ladder::{Rung, Worst};
use looselink::newton::Newton;
use looselink::stepper::bathe::splitting;
use looselink::stepper::{
    Estimate, EstimatedSolution, LocalError, Method, Stepper, Vibration, midpoint,
};
use looselink::stepper::{
    backward_euler, dormand_prince, esdirk, generalized_alpha, trapezoidal, velocity_verlet,
};
use looselink::system::{State, System};
use nalgebra::{DMatrix, DVector, Dyn, SymmetricEigen};
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
    // modes decay by many orders of magnitude, and every amplitude is compared with the one before
    let mut newton = Newton::new(chain, f64::MIN_POSITIVE);
    let mut work = chain.work();
    let mut from = State::zeros(chain.shape());
    from.q.copy_from_slice(q);
    from.v.copy_from_slice(v);
    newton.make_consistent(chain, &mut from, &mut work).unwrap();
    let mut to = from.clone();
    let mut scheme = method.stepper(chain.shape());
    for k in 1..=steps {
        scheme
            .step(chain, &from, k as f64 * h, &mut to, &mut newton, &mut work)
            .unwrap();
        scheme.accept();
        from.copy_from(&to);
        see(&from);
    }
}

fn energy(chain: &Chain, q: &[f64], v: &[f64]) -> f64 {
    let masses = chain.masses.iter().zip(v);
    let springs = chain.springs.iter().enumerate();
    let kinetic: f64 = masses.map(|(m, v)| 0.5 * m * v * v).sum();
    let stored = springs.map(|(i, k)| 0.5 * k * chain.stretch(i, q).powi(2));
    kinetic + stored.sum::<f64>()
}

/// The largest of numbers that are not negative; NaN if one of them is, which `f64::max` would pass over.
fn largest(numbers: impl Iterator<Item = f64>) -> f64 {
    numbers.fold(0.0, |m, x| if m.is_nan() || x <= m { m } else { x })
}

/// Every scheme with its name for reports, its order, and the step of the coarsest run.
fn schemes() -> Vec<(Method, String, f64, f64)> {
    let splittings = [0.3, 0.5, 2.0 - 2.0_f64.sqrt(), 0.9].map(|gamma| {
        let name = format!("Bathe's scheme, γ = {gamma:.3}");
        (bathe(gamma), name, 2.0, 2.0 / 160.0)
    });
    let spectral_radius = 0.6;
    let radius = format!("spectral radius {spectral_radius}");
    let gamma = 0.55;
    let others = [
        (
            bathe(gamma).with("spectral_radius", spectral_radius),
            format!("Bathe's scheme, γ = {gamma}, {radius}"),
            2.0,
        ),
        (
            Method::new(&trapezoidal::SCHEME),
            "The trapezoidal rule".to_owned(),
            2.0,
        ),
        (
            Method::new(&backward_euler::SCHEME),
            "The backward Euler rule".to_owned(),
            1.0,
        ),
        (
            Method::new(&generalized_alpha::SCHEME).with("spectral_radius", spectral_radius),
            format!("Generalised-α, {radius}"),
            2.0,
        ),
        (
            Method::new(&generalized_alpha::HHT).with("spectral_radius", spectral_radius),
            format!("HHT, {radius}"),
            2.0,
        ),
        (
            Method::new(&velocity_verlet::SCHEME),
            "Velocity Verlet".to_owned(),
            2.0,
        ),
        (
            Method::new(&dormand_prince::SCHEME),
            "Dormand-Prince".to_owned(),
            5.0,
        ),
        (
            Method::new(&dormand_prince::ORDER_8),
            "DOP853".to_owned(),
            8.0,
        ),
        (Method::new(&esdirk::ORDER_3), "ESDIRK 3".to_owned(), 3.0),
        (Method::new(&esdirk::ORDER_5), "ESDIRK 5".to_owned(), 5.0),
    ]
    // the higher the order, the longer the steps that stand above rounding
    .map(|(method, name, order)| {
        let steps = match order {
            8.0 => 6.0,
            5.0 => 40.0,
            3.0 => 80.0,
            _ => 160.0 * 2.0 / order,
        };
        (method, name, order, 2.0 / steps)
    });
    splittings.into_iter().chain(others).collect()
}

/// A step that failed may have left numbers in the new state that are not finite.
#[test]
fn a_step_reads_nothing_of_the_state_that_it_overwrites() {
    let chain = Chain::new(vec![2.0, 1.0], vec![30.0, 50.0, 80.0]);
    for (method, name, ..) in schemes() {
        let end = |poison: f64| {
            let mut newton = Newton::new(&chain, 1e-12);
            let mut work = chain.work();
            let mut from = State::zeros(chain.shape());
            from.q.copy_from_slice(&[0.01, -0.02]);
            newton
                .make_consistent(&chain, &mut from, &mut work)
                .unwrap();
            let mut scheme = method.stepper(chain.shape());
            for k in 1..=3 {
                let mut to = from.clone();
                for values in [&mut to.q, &mut to.q_low, &mut to.v, &mut to.a] {
                    values.fill(poison);
                }
                let t = 0.01 * f64::from(k);
                let step = scheme.step(&chain, &from, t, &mut to, &mut newton, &mut work);
                assert!(step.is_ok(), "{name}");
                scheme.accept();
                from.copy_from(&to);
            }
            [from.q, from.v, from.a]
        };
        assert_eq!(end(0.0), end(f64::NAN), "{name}");
    }
}

/// The least order that is measured. The error of ESDIRK 5 is 4.6e-5 z^6 + 7.3e-5 z^7 on an oscillation with z = i omega h: with up
/// to 1.5 times the mean step, z = 0.17 here, the second term lowers the order of the first halving by 0.2. That of DOP853 is
/// 6.4e-8 z^9 + 4.1e-8 z^10: with z up to 1.03 here, the second term changes the order of the first halving by up to 0.32.
fn least(method: Method, order: f64) -> f64 {
    match method.name() {
        "esdirk5" => order.min(4.7),
        "dop853" => order.min(7.6),
        _ => order,
    }
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
    // its error at this step is rounding
    let exact = at_end(Method::new(&dormand_prince::ORDER_8), 200);
    for (method, name, order, coarse) in schemes() {
        for (i, quantity) in ["position", "velocity", "acceleration"].iter().enumerate() {
            let error = |h: f64| {
                (
                    h,
                    (at_end(method, (2.0 / h).round() as usize)[i] - exact[i]).abs(),
                )
            };
            Rung::OrderInTime
                .asks(format!("{name}, two masses: {quantity}"))
                .falls(
                    "Step h [s]",
                    &[error(coarse), error(coarse / 2.0), error(coarse / 4.0)],
                    least(method, order - 0.1)..order + 0.1 * order.max(2.0),
                    "the order of the scheme; against DOP853 at a step where its error is rounding",
                );
        }
    }
}

/// Forces that depend on the velocity keep the order.
#[test]
fn every_scheme_has_its_order_with_damping() {
    let mut chain = Chain::new(vec![1.0, 2.0], vec![3.0, 1.0, 2.0]);
    chain.damping = 0.8;
    let at_end = |method: Method, steps: usize| {
        let (mut last, h) = ([0.0; 3], 2.0 / steps as f64);
        let (q, v) = ([0.3, -0.1], [0.0, 0.5]);
        integrate(&chain, method, h, steps, &q, &v, &mut |s| {
            last = [s.q[0], s.v[1], s.a[0]];
        });
        last
    };
    let exact = at_end(Method::new(&dormand_prince::ORDER_8), 200);
    for (method, name, order, coarse) in schemes() {
        let error = |h: f64| {
            let end = at_end(method, (2.0 / h).round() as usize);
            let errors = end.iter().zip(&exact).map(|(x, y)| (x - y).abs());
            (h, largest(errors))
        };
        Rung::OrderInTime
            .asks(format!(
                "{name}, two damped masses: position, velocity, acceleration"
            ))
            .falls(
                "Step h [s]",
                &[error(coarse), error(coarse / 2.0), error(coarse / 4.0)],
                least(method, order - 0.2)..order + 0.1 * order.max(2.0),
                "the order of the scheme; against DOP853 at a step where its error is rounding",
            );
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
        let mut scheme = method.stepper(chain.shape());
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
    let exact = at_end(Method::new(&dormand_prince::ORDER_8), 200);
    for (method, name, order, coarse) in schemes() {
        let error = |h: f64| {
            let end = at_end(method, (2.0 / h).round() as usize);
            let errors = end.iter().zip(&exact).map(|(x, y)| (x - y).abs());
            (h, largest(errors))
        };
        Rung::OrderInTime
            .asks(format!(
                "{name}, steps in turns of 3 to 1: position, velocity, acceleration"
            ))
            .falls(
                "Mean step h [s]",
                &[error(coarse), error(coarse / 2.0), error(coarse / 4.0)],
                least(method, order - 0.2)..order + 0.1 * order.max(2.0),
                "the order of the scheme; against DOP853 at a step where its error is rounding",
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
        let mut scheme = method.stepper(chain.shape());
        scheme
            .step(&chain, &from, h, &mut to, &mut newton, &mut chain.work())
            .unwrap();
        let mut error = LocalError::new(2);
        // none of the schemes needs a midpoint
        scheme.local_error(&from, &to, &to, &mut error);
        (to, error, scheme.estimate())
    };
    let exact = |h: f64| {
        let mut newton = Newton::new(&chain, 1e-16);
        let mut from = start(&mut newton);
        let mut to = from.clone();
        let mut scheme = Method::new(&dormand_prince::SCHEME).stepper(chain.shape());
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
        let method = bathe(gamma).with("spectral_radius", spectral_radius);
        let missed = |h: f64| {
            let (to, estimated, estimate) = step(method, h);
            assert!(estimate.of == EstimatedSolution::Solution && estimate.order == 3.0);
            let truth = exact(h);
            // the estimate is the better solution less the scheme's
            let missed = (0..2).flat_map(|i| {
                let q = truth.q[i] - to.q[i] - estimated.q[i];
                let v = truth.v[i] - to.v[i] - estimated.v[i];
                [q.abs(), v.abs()]
            });
            (h, largest(missed))
        };
        Rung::OrderInTime
            .asks(format!(
                "Bathe's scheme, γ = {gamma:.3}, spectral radius {spectral_radius}: local error less its estimate"
            ))
            .falls(
                "Step h [s]",
                &[missed(0.04), missed(0.02), missed(0.01)],
                3.7..4.3,
                "the error is of h³ and its estimate right to leading order",
            );
    }
    for (scheme, order, name, reason) in [
        (
            &dormand_prince::SCHEME,
            5.0,
            "Dormand and Prince's pair",
            "the error of the solution of order 4 is of h⁵",
        ),
        (
            &dormand_prince::ORDER_8,
            8.0,
            "DOP853",
            "the square of the error of order 5, of h⁶, over that of order 3, of h⁴",
        ),
        (
            &esdirk::ORDER_3,
            3.0,
            "ESDIRK 3",
            "the error of the solution of order 2 is of h³",
        ),
        (
            &esdirk::ORDER_5,
            5.0,
            "ESDIRK 5",
            "the error of the solution of order 4 is of h⁵",
        ),
    ] {
        let size = |h: f64| {
            let (_, estimated, estimate) = step(Method::new(scheme), h);
            assert!(estimate.of != EstimatedSolution::Solution && estimate.order == order);
            assert_eq!(estimate.implicit, !scheme.is_explicit);
            let errors = estimated.q.iter().chain(&estimated.v);
            (h, largest(errors.map(|e| e.abs())))
        };
        Rung::OrderInTime
            .asks(format!("{name}: the estimate of its error after one step"))
            .falls(
                "Step h [s]",
                &[size(0.1), size(0.05), size(0.025)],
                order - 0.2..order + 0.3,
                reason,
            );
    }
    // the first of two steps, with its midpoint, and the second, with the first
    let missed = |method: Method, h: f64, share: f64| {
        let mut newton = Newton::new(&chain, 1e-16);
        let mut work = chain.work();
        let mut scheme = method.stepper(chain.shape());
        let mut error = LocalError::new(2);
        let mut to = start(&mut newton);
        let mut middle = to.clone();
        let ends = [h * share, h * (1.0 + share)];
        let starts = [to.clone(), exact(ends[0])];
        let mut looks = starts.iter().zip(ends).map(|(from, t)| {
            scheme
                .step(&chain, from, t, &mut to, &mut newton, &mut work)
                .unwrap();
            if scheme.needs_midpoint(from) {
                midpoint(&chain, from, &to, &mut middle, &mut newton, &mut work);
            }
            scheme.local_error(from, &to, &middle, &mut error);
            scheme.accept();
            let truth = exact(t);
            let missed = (0..2).flat_map(|i| {
                let (q, v) = (truth.q[i] - to.q[i], truth.v[i] - to.v[i]);
                [(q - error.q[i]).abs(), (v - error.v[i]).abs()]
            });
            (h, largest(missed))
        });
        [looks.next().unwrap(), looks.next().unwrap()]
    };
    let spectral_radius = 0.8;
    // the order of the estimate, and that of what it misses at the start, where the mean acceleration of the
    // generalised-alpha family has an error of h^2 of its own
    let by_the_ends = [
        (Method::new(&trapezoidal::SCHEME), 3.0, 4.0),
        (
            Method::new(&generalized_alpha::SCHEME).with("spectral_radius", spectral_radius),
            3.0,
            3.0,
        ),
        (
            Method::new(&generalized_alpha::HHT).with("spectral_radius", spectral_radius),
            3.0,
            3.0,
        ),
        (Method::new(&velocity_verlet::SCHEME), 3.0, 4.0),
        (Method::new(&backward_euler::SCHEME), 2.0, 3.0),
    ];
    for (method, order, at_start) in by_the_ends {
        let estimate = method.stepper(chain.shape()).estimate();
        assert!(estimate.of == EstimatedSolution::Solution && estimate.order == order);
        assert_eq!(
            estimate.implicit,
            method != Method::new(&velocity_verlet::SCHEME)
        );
        let first = [0.01, 0.005, 0.0025].map(|h| missed(method, h, 1.0)[0]);
        Rung::OrderInTime
            .asks(format!(
                "{} at the start: local error less its estimate",
                method.name()
            ))
            .falls(
                "Step h [s]",
                &first,
                at_start - 0.3..at_start + 0.3,
                "its estimate, by its midpoint, is right to the leading order of the error",
            );
        for share in [1.0, 0.3] {
            let missed = |h| missed(method, h, share)[1];
            Rung::OrderInTime
                .asks(format!(
                    "{} after a step {share} times as long: local error less its estimate",
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

/// |R(i x)| of Bathe's scheme for y' = i x y/h over one step. Two facts determine R: its poles are those of the trapezoidal
/// sub-step, 2/gamma, and of the last one, and it is of second order with R = rho at infinity. With
/// alpha = gamma/2 and beta = (1 - gamma)/(2 - gamma (1 - rho)),
/// R = (1 + (1 - alpha - beta) z + (1/2 - alpha - beta + alpha beta) z^2)/((1 - alpha z) (1 - beta z)).
fn spectral_radius_of_bathe(gamma: f64, rho: f64, x: f64) -> f64 {
    let (alpha, beta) = (0.5 * gamma, (1.0 - gamma) / (2.0 - gamma * (1.0 - rho)));
    let (sum, product) = (alpha + beta, alpha * beta);
    let numerator = (1.0 - (0.5 - sum + product) * x * x).hypot((1.0 - sum) * x);
    numerator / (1.0_f64.hypot(alpha * x) * 1.0_f64.hypot(beta * x))
}

/// The same for gamma = 1/2 and rho = 0, in closed form.
fn spectral_radius_of_bathe_half(x: f64) -> f64 {
    let x2 = x * x;
    ((144.0 + 25.0 * x2) / ((9.0 + x2) * (16.0 + x2))).sqrt()
}

/// Natural frequencies \[rad/s\] and modes of a chain, in coordinates sqrt(m) q.
fn modes(chain: &Chain) -> SymmetricEigen<f64, Dyn> {
    let n = chain.masses.len();
    let stiffness = |i: usize, j: usize| match i.abs_diff(j) {
        0 => chain.springs[i] + chain.springs[i + 1],
        1 => -chain.springs[i.max(j)],
        _ => 0.0,
    };
    let scaled = |i, j| stiffness(i, j) / (chain.masses[i] * chain.masses[j]).sqrt();
    DMatrix::from_fn(n, n, scaled).symmetric_eigen()
}

/// Steps a chain and looks at every step from the first on: every mode has `radius` of the amplitude that it had before, and
/// the energy has not grown. Returns the largest error of an amplitude and the largest gain, both over what rounding may do.
///
/// With a consistent start Bathe's scheme does to v + i omega q of every mode what it does to y' = i omega y: it multiplies
/// it by R(i omega h). That is the decay from the first step on and whatever the phase; schemes that carry an acceleration of their
/// own from step to step have it in the mean over many steps at best.
///
/// Rounding: the force of the stiffest spring is right to eps omega_max^2 |q|, and |q| is at most sqrt(2 E)/omega_min. A step
/// turns that into a velocity of eps h omega_max^2 sqrt(2 E)/omega_min. Less than a hundred such terms add up.
fn decay_of_modes(
    chain: &Chain,
    method: Method,
    radius: &dyn Fn(f64) -> f64,
    h: f64,
    q: &[f64],
    v: &[f64],
) -> [f64; 2] {
    let modes = modes(chain);
    let omega = modes.eigenvalues.map(f64::sqrt);
    let rounding = 100.0 * f64::EPSILON * (1.0 + h * omega.max() * omega.max() / omega.min());
    let amplitudes = |q: &[f64], v: &[f64]| {
        let modal = |x: &[f64]| {
            let scaled = x.iter().zip(&chain.masses).map(|(x, m)| x * m.sqrt());
            modes
                .eigenvectors
                .tr_mul(&DVector::from_iterator(x.len(), scaled))
        };
        let stretched = modal(q).component_mul(&omega);
        stretched.zip_map(&modal(v), f64::hypot)
    };
    let mut before = amplitudes(q, v);
    let (mut energy_before, error, gain) = (energy(chain, q, v), Worst::new(), Worst::new());
    integrate(chain, method, h, 40, q, v, &mut |s| {
        let after = amplitudes(&s.q, &s.v);
        let allowed = rounding * before.norm();
        for k in 0..after.len() {
            error.see((after[k] - radius(omega[k] * h) * before[k]) / allowed);
        }
        let energy = energy(chain, &s.q, &s.v);
        let gained = (energy - energy_before) / (2.0 * rounding * energy_before);
        // written so that what is not a number is seen
        gain.see(if gained <= 0.0 { 0.0 } else { gained });
        (before, energy_before) = (after, energy);
    });
    [error.value(), gain.value()]
}

#[test]
fn bathe_loses_energy_of_linear_systems_from_the_first_step_as_the_spectral_formula_says() {
    let (error, gain) = (Worst::new(), Worst::new());
    proptest!(|(
        masses in prop::collection::vec(0.1..10.0_f64, 1..5),
        stiff in prop::array::uniform5(-1.0..5.0_f64),
        q in prop::array::uniform4(-1.0..1.0_f64),
        v in prop::array::uniform4(0.1..1.0_f64), // never at rest
        log_step in -1.5..2.0_f64,
        gamma in 0.2..0.8_f64,
        spectral_radius in prop_oneof![Just(0.0), 0.0..1.0_f64],
    )| {
        let n = masses.len();
        let chain = Chain::new(masses, stiff[..=n].iter().map(|x| 10.0_f64.powf(*x)).collect());
        // the highest mode turns by 0.03 to 100 radians a step
        let h = 10.0_f64.powf(log_step) / modes(&chain).eigenvalues.max().sqrt();
        let (q, v) = (&q[..n], &v[..n]);
        let half = decay_of_modes(&chain, bathe(0.5), &spectral_radius_of_bathe_half, h, q, v);
        let formula = |x| spectral_radius_of_bathe(gamma, spectral_radius, x);
        let method = bathe(gamma).with("spectral_radius", spectral_radius);
        let other = decay_of_modes(&chain, method, &formula, h, q, v);
        for [errors, gains] in [half, other] {
            error.see(errors);
            gain.see(gains);
            prop_assert!(errors <= 1.0 && gains <= 1.0, "amplitudes {errors:e}, gain {gains:e}");
        }
    });
    let reason = "in units of 100 eps (1 + h ω²/ω of the highest and the lowest mode): rounding of the stiffest spring's force";
    Rung::Balance
        .asks("Bathe's scheme on random linear chains: does every mode decay by the spectral radius of the closed formula, from the first step on?")
        .within(&error, 1.0, reason);
    Rung::Balance
        .asks("Bathe's scheme on random linear chains: does the energy ever grow, from the first step on?")
        .within(&gain, 1.0, reason);

    // the same check does not take another dissipative scheme, or another member of the family, for this one
    let chain = Chain::new(vec![1.0, 2.0, 0.5], vec![3.0, 7.0, 2.0, 0.7]);
    let half = |method: Method| {
        let (q, v) = ([0.3, -0.1, 0.2], [0.0, 0.5, -0.4]);
        let radius = &spectral_radius_of_bathe_half;
        decay_of_modes(&chain, method, radius, 0.3, &q, &v)[0]
    };
    let same = half(bathe(0.5));
    assert!(same <= 1.0, "{same:e}");
    let bathe =
        |gamma: f64, spectral_radius: f64| bathe(gamma).with("spectral_radius", spectral_radius);
    let generalized = |spectral_radius| {
        Method::new(&generalized_alpha::SCHEME).with("spectral_radius", spectral_radius)
    };
    let others = [
        // TR-BDF2
        bathe(2.0 - 2.0_f64.sqrt(), 0.0),
        bathe(0.5001, 0.0),
        bathe(0.5, 1e-3),
        generalized(0.0),
        generalized(0.5),
        generalized(0.9),
        Method::new(&generalized_alpha::HHT).with("spectral_radius", 0.7),
        Method::new(&generalized_alpha::HHT).with("spectral_radius", 0.95),
        Method::new(&backward_euler::SCHEME),
        Method::new(&trapezoidal::SCHEME),
    ];
    let mistaken = Worst::new();
    for method in others {
        mistaken.at(format!("{method:?}"));
        mistaken.see(1.0 / half(method));
    }
    Rung::Balance
        .asks("Does the same check fail for ten other schemes, TR-BDF2, generalised-α and backward Euler among them? Inverse of the least error")
        .within(&mistaken, 1e-3, "an error a thousand times the bound on rounding is not rounding");
}

/// Schemes that estimate their error from the step before need a midpoint where there is none: at the start, and after a change
/// of memory.
#[test]
fn schemes_need_a_midpoint_where_no_smooth_step_leads() {
    let chain = Chain::new(vec![1.0], vec![2.0, 3.0]);
    let spectral_radius = 0.8;
    for method in [
        Method::new(&trapezoidal::SCHEME),
        Method::new(&backward_euler::SCHEME),
        Method::new(&generalized_alpha::SCHEME).with("spectral_radius", spectral_radius),
        Method::new(&generalized_alpha::HHT).with("spectral_radius", spectral_radius),
        Method::new(&velocity_verlet::SCHEME),
    ] {
        let mut newton = Newton::new(&chain, 1e-13);
        let mut work = chain.work();
        let mut scheme = method.stepper(chain.shape());
        let from = State::zeros(chain.shape());
        let mut to = from.clone();
        let mut step = |scheme: &mut Box<dyn Stepper>, from: &State, t: f64| {
            scheme
                .step(&chain, from, t, &mut to, &mut newton, &mut work)
                .unwrap();
            to.clone()
        };
        let to = step(&mut scheme, &from, 0.1);
        assert!(scheme.needs_midpoint(&from), "{method:?}, at the start");
        scheme.accept();
        step(&mut scheme, &to, 0.2);
        assert!(!scheme.needs_midpoint(&to), "{method:?}, after a step");
        let mut touched = to.clone();
        touched.changes += 1;
        assert!(
            scheme.needs_midpoint(&touched),
            "{method:?}, after an onset"
        );
    }
}

/// The trapezoidal rule keeps the energy of a linear undamped system at any step.
#[test]
fn the_trapezoidal_rule_keeps_the_energy() {
    let chain = Chain::new(vec![1.0, 2.0, 0.5], vec![3.0, 1e4, 2.0, 0.7]);
    let (mut first, worst) = (f64::NAN, Worst::new());
    for step in [1e-3, 0.1, 3.0] {
        let (q, v) = ([0.3, -0.1, 0.2], [0.0, 0.5, -0.4]);
        integrate(
            &chain,
            Method::new(&trapezoidal::SCHEME),
            step,
            500,
            &q,
            &v,
            &mut |s| {
                if first.is_nan() {
                    first = energy(&chain, &s.q, &s.v);
                }
                worst.see(energy(&chain, &s.q, &s.v) / first - 1.0);
            },
        );
    }
    Rung::Balance
        .asks("Does the trapezoidal rule keep the energy of a linear chain over 500 steps? Relative change")
        .within(&worst, 1e-10, "rounding of Newton's method, 1e-13 m/s a step on a spring of 1e4 N/m");
}

/// The ledger is integrated over the stages: by Simpson's rule for γ = ½, for any γ exactly up to t²; by the trapezoidal
/// rule up to t. Clamps are counted stage by stage, and the state between is reported.
#[test]
fn stages_are_integrated_and_told() {
    let chain = Chain::new(vec![1.0], vec![2.0, 3.0]);
    let worst = Worst::new();
    for method in [
        bathe(0.5),
        bathe(0.3),
        Method::new(&trapezoidal::SCHEME),
        Method::new(&backward_euler::SCHEME),
        Method::new(&generalized_alpha::SCHEME).with("spectral_radius", 0.8),
        Method::new(&velocity_verlet::SCHEME),
        Method::new(&dormand_prince::SCHEME),
        Method::new(&dormand_prince::ORDER_8),
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
        let mut scheme = method.stepper(chain.shape());
        let clamps = scheme
            .step(&chain, &from, 0.9, &mut to, &mut newton, &mut work)
            .unwrap();
        let exact = |power: i32| (0.9_f64.powi(power) - 0.7_f64.powi(power)) / f64::from(power);
        worst.see(to.integrals[0] - 5.0 - exact(1));
        worst.see(to.integrals[1] - exact(2));
        let between: Vec<f64> = scheme.interior().iter().map(|s| s.t).collect();
        match method.name() {
            "bathe" => {
                let gamma = splitting(&method);
                worst.see(to.integrals[2] - exact(3));
                assert_eq!(clamps, 2);
                assert!(between.len() == 1 && (between[0] - 0.7 - gamma * 0.2).abs() < 1e-15);
            }
            "dormand_prince" => {
                worst.see(to.integrals[2] - exact(3));
                assert_eq!(clamps, 5);
                assert!(between.is_empty());
            }
            "dop853" => {
                worst.see(to.integrals[2] - exact(3));
                assert_eq!(clamps, 8);
                let inner = [4.0 / 13.0, 0.651_282_051_282_051_3].map(|c| 0.7 + 0.2 * c);
                assert_eq!(between, inner);
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
        .within(&worst, 4e-15, "rounding of an integral that starts at 5");
}

/// A vibration of amplitude 1 that turns by theta a step. The displacement that the estimate of one step stands for is compared with
/// what N steps add up to, N times the error of a step or twice the amplitude.
#[test]
fn the_estimate_of_a_vibration_stands_for_what_its_steps_add_up_to() {
    let chain = Chain::new(vec![1.0], vec![0.5, 0.5]);
    let (least, most) = (Worst::new(), Worst::new());
    for scheme in [
        &dormand_prince::SCHEME,
        &dormand_prince::ORDER_8,
        &esdirk::ORDER_3,
        &esdirk::ORDER_5,
    ] {
        for theta in (1..=35).map(|k| 0.1 * f64::from(k)) {
            let mut newton = Newton::new(&chain, 1e-16);
            let mut work = chain.work();
            let mut from = State::zeros(chain.shape());
            from.q[0] = 1.0;
            newton
                .make_consistent(&chain, &mut from, &mut work)
                .unwrap();
            let mut to = from.clone();
            let mut stepper = Method::new(scheme).stepper(chain.shape());
            stepper
                .step(&chain, &from, theta, &mut to, &mut newton, &mut work)
                .unwrap();
            let mut error = LocalError::new(1);
            stepper.local_error(&from, &to, &to, &mut error);
            let estimate = stepper.estimate();
            let errors = [&mut error.q[..], &mut error.v[..]];
            newton.filter(&chain, estimate.implicit, &to.v, errors);
            let estimated = error.q[0].hypot(error.v[0]);
            let missed = (to.q[0] - theta.cos()).hypot(to.v[0] + theta.sin());
            // an error of a step below rounding is not known
            if to.q[0].hypot(to.v[0]) > 1.0 || missed < 1e-13 {
                continue;
            }
            for steps in [1e3, 1e4, 1e5, 1e6] {
                let terms = estimate.response(steps * theta, theta, steps);
                let parts = terms
                    .map(|term| term.weight / (1.0 + term.tau * term.tau).powi(term.power as i32));
                let counted = estimated * parts.sum::<f64>();
                let place = || format!("{}, {theta:.1} rad, {steps:e} steps", scheme.name);
                least.at(place());
                least.see((steps * missed).min(2.0) / counted);
                if steps * missed < 0.1 {
                    most.at(place());
                    most.see(counted / (steps * missed));
                }
            }
        }
    }
    Rung::Routes
        .asks("Undamped oscillator, 0.1 to 3.5 rad a step, 1e3 to 1e6 steps, four embedded methods: error over the estimate of the control")
        .within(&least, 2.5, "counted is at least 0.4 of the error, see `stepper::Estimate::response`");
    Rung::Routes
        .asks("The same while its error is below a tenth of the amplitude: error that the control counts over the error")
        .within(&most, 2.0, "1 to leading order; higher orders and the part of forced errors come on top");
}

/// An estimate of order p falls with the power p of the step. If it is the error of the solution, its share of an accuracy is that of
/// every step, whatever its length; the number of steps changes with their mean. The estimate of a solution that is not continued has
/// a share that grows with the root of the length of the step.
#[test]
fn shares_of_an_accuracy_follow_the_mean_step_or_the_step() {
    let estimate = |order: f64, of: EstimatedSolution| Estimate {
        order,
        of,
        implicit: false,
    };
    let vibration = Vibration {
        error: 1e-4,
        ratio: 0.3,
    };
    let own = estimate(3.0, EstimatedSolution::Solution);
    assert_eq!(own.typical_step(1e-6, 1e-4), 1e-4);
    assert_eq!((own.order_of_ratio(), own.order_of_sum()), (3.0, 2.0));
    let other = estimate(
        5.0,
        EstimatedSolution::Embedded {
            weight: 1.0,
            vibration,
        },
    );
    assert_eq!(other.typical_step(1e-6, 1e-4), 1e-6);
    assert_eq!((other.order_of_ratio(), other.order_of_sum()), (4.5, 4.5));
}

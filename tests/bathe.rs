//! Bathe's scheme on linear systems: spectral radius, period, order, energy. The systems are written against the trait
//! that mechanisms implement.

use crate::chain::Chain;
use looselink::newton::Newton;
use looselink::scene::Method;
use looselink::stepper::stepper;
use looselink::system::{State, System};
use proptest::prelude::*;

/// Steps from (q, v) with the scheme; calls `see` after every step.
fn integrate(
    chain: &Chain,
    gamma: f64,
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
    let mut scheme = stepper(Method::Bathe { gamma }, chain);
    for k in 1..=steps {
        scheme
            .step(chain, &from, k as f64 * h, &mut to, &mut newton, &mut work)
            .unwrap();
        from.copy_from(&to);
        see(&from);
    }
}

/// Spectral radius and period elongation of one oscillator, from closed-form stability functions evaluated elsewhere.
#[test]
fn spectral_radius_and_period() {
    let optimal = 2.0 - 2.0_f64.sqrt();
    let table = [
        (0.1, 0.5, 0.999493934337159, 0.0161793743647),
        (0.1, optimal, 0.999463321935721, 0.0157144241337),
        (1.0, 0.5, 0.648466367708081, f64::NAN),
        (1.0, optimal, 0.635575314210254, f64::NAN),
    ];
    for (step, gamma, radius, elongation) in table {
        // omega = 2 pi, period 1: two runs give the two columns of the amplification matrix of (q, v/omega)
        let omega = std::f64::consts::TAU;
        let chain = Chain::new(vec![1.0], vec![0.5 * omega * omega; 2]);
        let column = |q: f64, v: f64| {
            let mut out = [0.0; 2];
            integrate(&chain, gamma, step, 1, &[q], &[v * omega], &mut |s| {
                out = [s.q[0], s.v[0] / omega]
            });
            out
        };
        let (first, second) = (column(1.0, 0.0), column(0.0, 1.0));
        let determinant = first[0] * second[1] - second[0] * first[1];
        // complex eigenvalues: the modulus is the root of the determinant
        assert!(
            (determinant.sqrt() - radius).abs() < 1e-12,
            "{step} {gamma}: {}",
            determinant.sqrt()
        );
        if elongation.is_finite() {
            let angle = (0.5 * (first[0] + second[1]) / determinant.sqrt()).acos();
            assert!((omega * step / angle - 1.0 - elongation).abs() < 1e-10);
        }
    }
}

#[test]
fn order_two_in_everything() {
    let chain = Chain::new(vec![1.0, 2.0], vec![3.0, 1.0, 2.0]);
    let at_end = |gamma: f64, steps: usize| {
        let mut last = [0.0; 3];
        integrate(
            &chain,
            gamma,
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
    for gamma in [0.3, 0.5, 2.0 - 2.0_f64.sqrt(), 0.9] {
        // the reference's own error is 1/1024 of the finest one compared
        let exact = at_end(gamma, 20480);
        for i in 0..3 {
            let error = |n: usize| (2.0 / n as f64, (at_end(gamma, n)[i] - exact[i]).abs());
            crate::support::assert_order("chain", &[error(160), error(320), error(640)], 1.9..2.1);
        }
    }
}

proptest! {
    /// On a linear undamped system no step gains energy beyond rounding, at any step and any splitting.
    #[test]
    fn energy_is_never_gained(
        masses in prop::collection::vec(0.1..10.0_f64, 1..5),
        stiff in prop::collection::vec(-3.0..7.0_f64, 6),
        start in prop::collection::vec(-1.0..1.0_f64, 10),
        log_step in -4.0..1.0_f64,
        gamma in 0.2..0.8_f64,
    ) {
        let n = masses.len();
        let chain = Chain::new(masses, stiff[..=n].iter().map(|x| 10.0_f64.powf(*x)).collect());
        let mut last = f64::NAN;
        let mut first = 0.0;
        integrate(&chain, gamma, 10.0_f64.powf(log_step), 200, &start[..n], &start[5..5 + n], &mut |s| {
            let energy = chain.energy(s);
            if last.is_nan() {
                first = energy;
            } else {
                // rounding: energies are sums of terms no larger than the first, each a few roundings
                assert!(energy <= last + 1e-12 * first, "{energy} after {last}");
            }
            last = energy;
        });
    }
}

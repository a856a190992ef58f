//! The state ahead of a step that the estimates of the local error use where there is no step before.

use crate::chain::Chain;
use looselink::newton::Newton;
use looselink::stepper::look_ahead;
use looselink::system::{State, System};

/// From t = 3 s to t = 3.25 s: numbers without rounding, and a start that is not at zero.
const TIMES: [f64; 2] = [3.0, 3.25];

/// The state at the end of the step, and the state ahead of it.
fn ahead(chain: &Chain) -> [State; 2] {
    let mut newton = Newton::new(chain, 1e-13);
    let mut work = chain.work();
    let [from, to] = TIMES.map(|t| {
        let mut state = State::zeros(chain.shape());
        state.t = t;
        state.q = vec![0.5, -0.25];
        state.v = vec![2.0, 4.0 * t];
        state.a = vec![8.0 * t, -1.0];
        state
    });
    let mut ahead = to.clone();
    look_ahead(chain, &from, &to, &mut ahead, &mut newton, &mut work);
    [to, ahead]
}

#[test]
fn a_look_ahead_extrapolates_by_the_length_of_the_step() {
    let chain = Chain::new(vec![2.0, 1.0], vec![1.0, 4.0, 0.5]);
    let [to, ahead] = ahead(&chain);
    let h = TIMES[1] - TIMES[0];
    assert_eq!(ahead.t, to.t + h);
    let mut k_q = [0.0; 2];
    for i in 0..2 {
        assert_eq!(ahead.q[i], to.q[i] + h * to.v[i] + 0.5 * h * h * to.a[i]);
        assert_eq!(ahead.v[i], to.v[i] + h * to.a[i]);
        let [left, right] = [i, i + 1].map(|spring| chain.stretch(spring, &ahead.q));
        k_q[i] = chain.springs[i] * left - chain.springs[i + 1] * right;
        let error = chain.masses[i] * ahead.a[i] + k_q[i];
        // M a = -K q, two springs and a division
        assert!(error.abs() <= 8.0 * f64::EPSILON * k_q[i].abs().max(1.0));
    }
}

#[test]
fn a_look_ahead_beyond_the_prescribed_motion_doubles_the_change_of_the_acceleration() {
    let mut chain = Chain::new(vec![2.0, 1.0], vec![1.0, 4.0, 0.5]);
    chain.prescribed_until = TIMES[1];
    let [to, ahead] = ahead(&chain);
    let before = [8.0 * TIMES[0], -1.0];
    for (i, before) in before.into_iter().enumerate() {
        assert_eq!(ahead.a[i] - to.a[i], 2.0 * (to.a[i] - before));
    }
}

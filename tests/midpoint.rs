//! The state in the middle of a step that the estimates of the local error use where there is no step before.

use crate::chain::Chain;
use looselink::newton::Newton;
use looselink::stepper::midpoint;
use looselink::system::{State, System};

/// From t = 3 s to t = 3.25 s: numbers without rounding, and a start that is not at zero.
const TIMES: [f64; 2] = [3.0, 3.25];

fn chain() -> Chain {
    let mut chain = Chain::new(vec![2.0, 1.0], vec![1.0, 4.0, 0.5]);
    chain.damping = 0.75;
    chain
}

/// The ends of a step along q = t^3 and -t^2 + t, and the state in its middle.
fn states(chain: &Chain) -> [State; 3] {
    let mut newton = Newton::new(chain, 1e-13);
    let mut work = chain.work();
    let [from, to] = TIMES.map(|t| {
        let mut state = State::zeros(chain.shape());
        state.t = t;
        state.q = vec![t * t * t, t - t * t];
        state.v = vec![3.0 * t * t, 1.0 - 2.0 * t];
        state.a = vec![6.0 * t, -2.0];
        state
    });
    let mut middle = to.clone();
    midpoint(chain, &from, &to, &mut middle, &mut newton, &mut work);
    [from, middle, to]
}

#[test]
fn a_midpoint_lies_on_the_cubic_and_has_its_own_acceleration() {
    let chain = chain();
    let [_, middle, _] = states(&chain);
    let t = 0.5 * (TIMES[0] + TIMES[1]);
    assert_eq!(middle.t, t);
    assert_eq!(middle.q, [t * t * t, t - t * t]);
    assert_eq!(middle.v, [3.0 * t * t, 1.0 - 2.0 * t]);
    for i in 0..2 {
        let [left, right] = [i, i + 1].map(|spring| chain.stretch(spring, &middle.q));
        let force = chain.springs[i] * left - chain.springs[i + 1] * right;
        let force = force + chain.damping * middle.v[i];
        let error = chain.masses[i] * middle.a[i] + force;
        // two springs, a damper and a division
        assert!(error.abs() <= 10.0 * f64::EPSILON * force.abs().max(1.0));
    }
}

#[test]
fn without_a_midpoint_the_change_of_the_acceleration_stands_for_its_second_difference() {
    let mut chain = chain();
    chain.prescribed_until = TIMES[0];
    let [from, middle, to] = states(&chain);
    for i in 0..2 {
        let second = 4.0 * (to.a[i] - 2.0 * middle.a[i] + from.a[i]);
        assert_eq!(second, to.a[i] - from.a[i]);
    }
}

//! The battery of friction laws: every law against its definition.

use ladder::{Rung, Worst};
use looselink::contact::friction::{
    Ambrosio, Bristle, CoulombStribeck, ElastoPlastic, FRICTIONS, FrictionLaw, LuGre, Stribeck,
};
use proptest::prelude::*;

const COEFFICIENT: Stribeck = Stribeck {
    kinetic: 0.3,
    static_: 0.45,
    velocity: 0.02,
};
const BRISTLE: Bristle = Bristle {
    coefficient: COEFFICIENT,
    stiffness: 1e4,
    damping: 20.0,
    damping_velocity: f64::INFINITY,
    viscous: 0.4,
};

/// All laws; the velocities are those of [`COEFFICIENT`].
fn laws() -> Vec<Box<dyn FrictionLaw>> {
    let falling = Bristle {
        damping_velocity: 0.03,
        ..BRISTLE
    };
    let laws: Vec<Box<dyn FrictionLaw>> = vec![
        Box::new(Ambrosio {
            coefficient: 0.3,
            v0: 1e-3,
            v1: 1e-2,
        }),
        Box::new(CoulombStribeck {
            coefficient: COEFFICIENT,
            v_r: 1e-3,
            viscous: 0.4,
        }),
        Box::new(LuGre(BRISTLE)),
        Box::new(LuGre(falling)),
        Box::new(ElastoPlastic {
            bristle: BRISTLE,
            elastic_limit: 0.8 * 0.3 / 1e4,
        }),
    ];
    assert!(laws.len() > FRICTIONS.len(), "a law without a test");
    laws
}

/// Away from where a slope jumps.
fn is_smooth(slip: f64, z: f64) -> bool {
    let [g, _] = COEFFICIENT.at(slip);
    let kinks = [1e-3, 1e-2].map(|v| slip.abs() - v);
    let deflections = [0.8 * 0.3e-4, g * 1e-4].map(|limit| z.abs() - limit);
    slip.abs() > 1e-5
        && kinks.iter().all(|x| x.abs() > 1e-5)
        && deflections.iter().all(|x| x.abs() > 1e-7)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn friction_is_odd(slip in -0.1..0.1_f64, normal in 0.0..100.0_f64, z in -6e-5..6e-5_f64) {
        for law in laws() {
            let (there, back) = (law.force(slip, normal, z), law.force(-slip, normal, -z));
            prop_assert_eq!(there.value, -back.value);
            prop_assert_eq!(there.rate.value, -back.rate.value);
            if law.state().is_none() {
                prop_assert!(there.value * slip >= 0.0);
            }
        }
    }

    #[test]
    fn slopes_are_derivatives(slip in -0.1..0.1_f64, normal in 1.0..100.0_f64, z in -6e-5..6e-5_f64) {
        prop_assume!(is_smooth(slip, z));
        for law in laws() {
            let at = law.force(slip, normal, z);
            let (dv, dz) = (1e-8, 1e-11);
            let [low, high] = [-dv, dv].map(|d| law.force(slip + d, normal, z));
            // forces of some ten newtons change by 1e4 N s/m: rounding 1e-7 of that, and truncation below it
            let by_slip = (high.value - low.value) / (2.0 * dv);
            prop_assert!((by_slip - at.by_slip).abs() <= 1e-5 * (1e3 + at.by_slip.abs()), "{law:?}: {by_slip} {at:?}");
            let by_slip = (high.rate.value - low.rate.value) / (2.0 * dv);
            prop_assert!((by_slip - at.rate.by_slip).abs() <= 1e-5 * (1.0 + at.rate.by_slip.abs()), "{law:?}: {by_slip} {at:?}");
            let [low, high] = [-dz, dz].map(|d| law.force(slip, normal, z + d));
            let by_state = (high.value - low.value) / (2.0 * dz);
            prop_assert!((by_state - at.by_state).abs() <= 1e-5 * (1e6 + at.by_state.abs()), "{law:?}: {by_state} {at:?}");
            let by_state = (high.rate.value - low.rate.value) / (2.0 * dz);
            prop_assert!((by_state - at.rate.by_state).abs() <= 1e-5 * (1e3 + at.rate.by_state.abs()), "{law:?}: {by_state} {at:?}");
            // the force is proportional to the normal force
            let doubled = law.force(slip, 2.0 * normal, z).value;
            prop_assert!((doubled - 2.0 * at.value).abs() <= 1e-14 * doubled.abs());
            prop_assert!((at.by_normal * normal - at.value).abs() <= 1e-14 * at.value.abs());
            let [_, slope] = law.stored(z);
            let stored = (law.stored(z + dz)[0] - law.stored(z - dz)[0]) / (2.0 * dz);
            prop_assert!((stored - slope).abs() <= 1e-8);
        }
    }
}

/// What friction takes less what bristles store of it, wherever the law says that it cannot give energy.
#[test]
fn no_law_gives_energy_within_its_bound() {
    let worst = Worst::new();
    let mut outside = 0;
    for k in 0..100_000_u32 {
        // equidistributed numbers (Weyl)
        let [a, b] = [0.618_033_988_7, 0.414_213_562_4]
            .map(|irrational: f64| 2.0 * (irrational * f64::from(k)).fract() - 1.0);
        let slip = a * a * a * 0.3;
        for law in laws() {
            if law.may_give_energy(slip) {
                outside += 1;
                continue;
            }
            let at = law.force(slip, 1.0, b * 5e-5);
            let [_, slope] = law.stored(b * 5e-5);
            let taken = at.value * slip;
            let loss = taken - slope * at.rate.value;
            worst.see(
                (-loss).max(0.0)
                    / (taken.abs() + (slope * at.rate.value).abs() + f64::MIN_POSITIVE),
            );
        }
    }
    assert!(outside > 1000, "nothing is outside of the bound");
    Rung::Balance
        .asks("Friction laws at 1e5 slips and deflections: energy that they give, over the powers that they turn over")
        .within(&worst, 4.0 * f64::EPSILON, "rounding of the difference of two powers");
}

/// Beyond the bound there is a deflection at which a law of bristles gives energy.
#[test]
fn the_bound_of_the_loss_is_sharp() {
    let law = LuGre(BRISTLE);
    let gives = |slip: f64| {
        (0..=1000).any(|k| {
            let z = f64::from(k) * 1e-7;
            let at = law.force(slip, 1.0, z);
            // without viscous friction
            at.value * slip - 0.4 * slip * slip < law.stored(z)[1] * at.rate.value
        })
    };
    // 4 g/s_1 where g has fallen to 0.3
    let limit = 4.0 * 0.3 / 20.0;
    assert!(!law.may_give_energy(0.99 * limit) && !gives(0.99 * limit));
    assert!(law.may_give_energy(1.05 * limit) && gives(1.05 * limit));
}

/// In steady slip the bristles are deflected by g/s_0, and the force is F_n (g + s_2 v).
#[test]
fn steady_slip_has_the_stribeck_force() {
    for law in laws().iter().filter(|law| law.state().is_some()) {
        for slip in [1e-6, 1e-3, 0.02, 0.5] {
            let [g, _] = COEFFICIENT.at(slip);
            let at = law.force(slip, 2.0, g / 1e4);
            assert!(at.rate.value.abs() <= f64::EPSILON * slip);
            let force = 2.0 * (g + 0.4 * slip);
            assert!((at.value - force).abs() <= 4.0 * f64::EPSILON * force);
        }
    }
}

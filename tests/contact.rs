//! The battery of contact laws: every law of the registry against the definitions.

use approx::assert_relative_eq;
use ladder::{Rung, Worst};
use looselink::contact::normal::damped_power::{FLORES, HERTZ, HUNT_CROSSLEY, LANKARANI_NIKRAVESH};
use looselink::contact::normal::{LAWS, NormalLaw, NormalLawKind, NormalParameters};
use looselink::scene::Contact;
use proptest::prelude::*;

const K: f64 = 1.2e11;

fn law(kind: &NormalLawKind, restitution: f64, impact_velocity_floor: f64) -> Box<dyn NormalLaw> {
    (kind.build)(&NormalParameters {
        stiffness: K,
        exponent: 1.5,
        restitution,
        impact_velocity_floor,
        own: &[],
    })
}

fn laws(restitution: f64) -> Vec<Box<dyn NormalLaw>> {
    let other_exponent = NormalParameters {
        stiffness: 3e8,
        exponent: 1.2,
        restitution,
        impact_velocity_floor: 1e-6,
        own: &[],
    };
    let registered = LAWS.iter().map(|kind| law(kind, restitution, 1e-6));
    let others = LAWS.iter().map(|kind| (kind.build)(&other_exponent));
    registered.chain(others).collect()
}

#[test]
fn slopes_are_the_derivatives() {
    let worst = Worst::new();
    proptest!(|(
        delta in 1e-8..1e-5_f64, rate in -0.02..0.05_f64, impact in 0.01..0.1_f64, restitution in 0.5..0.99_f64,
    )| {
        for law in laws(restitution) {
            let at = law.force(delta, rate, impact);
            prop_assume!(!at.clamped);
            let (hd, hr) = (1e-5 * delta, 1e-5 * impact);
            let by_delta = (law.force(delta + hd, rate, impact).value - law.force(delta - hd, rate, impact).value) / (2.0 * hd);
            let by_rate = (law.force(delta, rate + hr, impact).value - law.force(delta, rate - hr, impact).value) / (2.0 * hr);
            // of the elastic force: near the clamp damping takes nearly all of it, and rounding of it stays
            worst.see((by_delta - at.by_delta) * delta / at.elastic);
            worst.see((by_rate - at.by_rate) * impact / at.elastic);
            // the elastic part is the derivative of the energy
            let elastic = (law.energy(delta + hd) - law.energy(delta - hd)) / (2.0 * hd);
            worst.see(elastic / at.elastic - 1.0);
        }
    });
    Rung::Derivatives
        .asks("Do the slopes of every contact law agree with differences, and the elastic force with its energy? Relative error")
        .within(&worst, 1e-9, "a central difference over 1e-5 of each quantity: truncation 1e-10, rounding 1e-11");
}

proptest! {
    #[test]
    fn a_contact_never_pulls(delta in 1e-9..1e-4_f64, rate in -10.0..10.0_f64, impact in 1e-9..1.0_f64) {
        for law in laws(0.3) {
            let force = law.force(delta, rate, impact);
            prop_assert!(force.value >= 0.0 && force.value.is_finite());
            prop_assert!(!force.clamped || force.value == 0.0);
        }
    }
}

#[test]
fn the_clamp_acts_and_is_flagged() {
    let law = law(&LANKARANI_NIKRAVESH, 0.3, 1e-6);
    assert!(!law.force(1e-6, -0.01, 0.01).clamped);
    let pulled = law.force(1e-6, -0.05, 0.01);
    assert!(pulled.clamped && pulled.value == 0.0 && pulled.elastic > 0.0);
}

#[test]
fn a_grazing_onset_is_floored() {
    let law = law(&LANKARANI_NIKRAVESH, 0.9, 1e-4);
    let (grazing, floor) = (law.force(1e-6, 0.01, 1e-300), law.force(1e-6, 0.01, 1e-4));
    assert_eq!(grazing, floor);
}

#[test]
fn hertz_is_the_limit_of_all() {
    let hertz = law(&HERTZ, 1.0, 1.0).force(1e-6, 0.01, 0.02).value;
    for law in LAWS.iter().map(|kind| law(kind, 1.0, 1e-6)) {
        assert_relative_eq!(
            law.force(1e-6, 0.01, 0.02).value,
            hertz,
            max_relative = 1e-15
        );
        assert_eq!(law.delivered_restitution(), 1.0);
    }
}

/// Closed-form map of typed to delivered restitution, chi (1 + e) = ln((1 + chi)/(1 - chi e)), evaluated elsewhere to
/// 15 digits.
#[test]
fn delivered_restitution_follows_the_exact_map() {
    let table = [
        (
            0.95,
            0.953506045142133,
            0.952370152820406,
            0.946828831425267,
        ),
        (0.9, 0.913176677805581, 0.909015741349202, 0.893920692663378),
        (0.7, 0.795972595365329, 0.767999789078476, 0.683184199730684),
        (0.5, 0.725241114010197, 0.662962200001546, 0.47044477932674),
        (0.3, 0.684224605749448, 0.581288041808574, 0.256207906679824),
        (0.1, 0.66526540675515, 0.515832616400396, 0.0694442251515404),
    ];
    let worst = Worst::new();
    for (typed, ln, hc, flores) in table {
        let laws =
            [&LANKARANI_NIKRAVESH, &HUNT_CROSSLEY, &FLORES].map(|kind| law(kind, typed, 1e-6));
        for (law, expected) in laws.iter().zip([ln, hc, flores]) {
            worst.see(law.delivered_restitution() / expected - 1.0);
        }
    }
    Rung::ClosedForms
        .asks("Does a free impact deliver the restitution of the exact map, for three laws? Relative error")
        .within(&worst, 2e-14, "the equation is flat near e = 1: a rounding of chi² becomes 1e-16/chi");
}

/// The law that a contact of a scene names, with its numbers.
#[test]
fn laws_are_built_from_contacts() {
    let contact = |law: &'static NormalLawKind| Contact {
        name: "pin".to_owned(),
        from_materials: false,
        bearing_radius: Some(0.01),
        clearance: 2e-5,
        law,
        stiffness: 3e9,
        exponent: 1.3,
        restitution: 0.6,
        impact_velocity_floor: 0.02,
        own: Vec::new(),
        friction: None,
    };
    let (delta, rate, impact) = (2e-6, 0.03, 0.05);
    let elastic = 3e9 * 2e-6_f64.powf(1.3);
    let factors = [
        ("lankarani_nikravesh", 0.75 * (1.0 - 0.36)),
        ("hertz", 0.0),
        ("hunt_crossley", 1.5 * 0.4),
        ("flores", 8.0 * 0.4 / 3.0),
    ];
    assert_eq!(LAWS.len(), factors.len(), "every law has its chi here");
    for (kind, (name, chi)) in LAWS.into_iter().zip(factors) {
        let law = contact(kind).normal_law();
        assert_eq!(kind.name, name);
        let expected = elastic * (1.0 + chi * rate / impact);
        assert_relative_eq!(
            law.force(delta, rate, impact).value,
            expected,
            max_relative = 1e-14
        );
        // below the floor the impact velocity is the floor
        assert_eq!(law.force(delta, rate, 0.0), law.force(delta, rate, 0.02));
        assert_relative_eq!(
            law.energy(delta),
            elastic * delta / 2.3,
            max_relative = 1e-14
        );
        assert_eq!(law.energy(0.0), 0.0);
        assert_eq!(law.energy(-1e-6), 0.0);
    }
}

/// Where the bracket of the damped law is zero the force vanishes with its slope by the rate, and is not yet clamped.
#[test]
fn the_clamp_begins_where_the_law_would_pull() {
    let law = law(&LANKARANI_NIKRAVESH, 0.5, 1e-9);
    let chi = 0.75 * (1.0 - 0.25);
    // powers of two: the bracket is zero to the last bit
    let (impact, rate) = (0.5625, -1.0);
    assert_eq!(1.0 + chi / impact * rate, 0.0);
    let at = law.force(1e-6, rate, impact);
    assert!(!at.clamped && at.value == 0.0 && at.by_rate > 0.0);
    assert!(law.force(1e-6, rate * (1.0 + 1e-15), impact).clamped);
}

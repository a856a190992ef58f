//! The scalar contact and friction laws on random states.

use super::elements::{STATES, log_uniform};
use crate::check::{Agreement, Worst};
use crate::reference::{Contact, Error, contact_friction, contact_normal};
use looselink::contact::{Ambrosio, LAWS};
use looselink::scene::NormalLawKind;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// Names and numbers of the laws that both sides have.
const NORMAL: [(NormalLawKind, &str, i32); 3] = [
    (NormalLawKind::LankaraniNikravesh, "Lankarani-Nikravesh", 0),
    (NormalLawKind::HuntCrossley, "Hunt-Crossley", 1),
    (NormalLawKind::Flores, "Flores", 2),
];

/// The rows.
///
/// # Errors
/// When the reference refuses a state.
pub fn agreements() -> Result<Vec<Agreement>, Error> {
    let mut rows = NORMAL
        .iter()
        .map(|law| normal(*law))
        .collect::<Result<Vec<_>, _>>()?;
    rows.push(friction()?);
    Ok(rows)
}

/// Force and both slopes in units of the sum of the magnitudes of their terms: near the clamp they cancel.
fn normal((kind, name, number): (NormalLawKind, &str, i32)) -> Result<Agreement, Error> {
    let mut random = ChaCha8Rng::seed_from_u64(2);
    let build = LAWS.iter().find(|(k, _)| *k == kind).map(|(_, b)| b);
    let build = build.expect("every kind of law is in the registry");
    let (mut worst, mut clamps) = (Worst::default(), 0);
    for i in 0..STATES {
        let contact = Contact {
            normal: number,
            bearing_radius: 0.01,
            clearance: 2e-5,
            stiffness: log_uniform(&mut random, 1e8, 1e12),
            exponent: if i % 2 == 0 {
                1.5
            } else {
                random.random_range(1.0..3.0)
            },
            restitution: random.random_range(0.05..1.0),
            impact_velocity_floor: 1e-6,
            ..Contact::default()
        };
        let Contact {
            stiffness,
            exponent,
            restitution,
            impact_velocity_floor: floor,
            ..
        } = contact;
        let law = build(stiffness, exponent, restitution, floor);
        let delta = log_uniform(&mut random, 1e-12, 1e-4);
        let impact_velocity = log_uniform(&mut random, floor, 1.0);
        let rate = impact_velocity * random.random_range(-3.0..3.0);
        let (cpp, clamped) = contact_normal(&contact, delta, rate, impact_velocity)?;
        let rust = law.force(delta, rate, impact_velocity);
        assert_eq!(
            rust.clamped, clamped,
            "{name}: clamped at {delta:e}, {rate:e}, {impact_velocity:e}"
        );
        clamps += usize::from(clamped);
        let elastic = stiffness * delta.powf(exponent);
        let steep = exponent * elastic / delta;
        let damping = law.force(delta, 0.0, impact_velocity).by_rate;
        worst.see(rust.value, cpp[0], elastic + damping * rate.abs());
        worst.see(
            rust.by_delta,
            cpp[1],
            steep * (1.0 + damping / elastic * rate.abs()),
        );
        worst.see(
            rust.by_rate,
            cpp[2],
            if damping > 0.0 { damping } else { 1.0 },
        );
    }
    assert!(clamps > 20, "{name}: {clamps} clamped states");
    let reason = "of the sum of the magnitudes of its terms; rounding";
    Ok(worst.row(
        &format!("{name} force and slopes"),
        &format!("{STATES} random states"),
        1e-12,
        reason,
    ))
}

fn friction() -> Result<Agreement, Error> {
    let mut random = ChaCha8Rng::seed_from_u64(3);
    let (mut worst, mut ramp) = (Worst::default(), 0);
    for _ in 0..STATES {
        let v0 = log_uniform(&mut random, 1e-6, 1e-2);
        let law = Ambrosio {
            coefficient: random.random_range(0.01..1.0),
            v0,
            v1: v0 * random.random_range(1.5..20.0),
        };
        let contact = Contact {
            normal: 0,
            friction: 1,
            bearing_radius: 0.01,
            clearance: 2e-5,
            stiffness: 1e11,
            exponent: 1.5,
            restitution: 0.9,
            impact_velocity_floor: 1e-6,
            friction_coefficient: law.coefficient,
            friction_v0: law.v0,
            friction_v1: law.v1,
            ..Contact::default()
        };
        let slip = law.v1 * random.random_range(-1.5..1.5);
        let normal = log_uniform(&mut random, 1e-3, 1e4);
        let rust = law.force(slip, normal);
        // the reference gives the force along the slip, Looselink the one against it
        let cpp = contact_friction(&contact, slip, normal)?.map(|x| -x);
        ramp += usize::from(rust.by_slip != 0.0);
        let scale = law.coefficient * normal;
        worst.see(rust.value, cpp[0], scale);
        worst.see(rust.by_slip, cpp[1], scale / (law.v1 - law.v0));
        worst.see(rust.by_normal, cpp[2], law.coefficient);
    }
    assert!(ramp > 100, "{ramp} states on the ramp");
    let reason = "of the force of full sliding; rounding";
    Ok(worst.row(
        "Ambrósio friction and slopes",
        &format!("{STATES} random states"),
        1e-12,
        reason,
    ))
}

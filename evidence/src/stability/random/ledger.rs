//! What a scheme loses or gains: the ledger of energies.
//!
//! Nothing bounds the defect of one run: at a step as long as the motion itself a scheme may lose everything, and in nonlinear
//! mechanisms the best of them may gain. What must hold is that the defect is an error of the integration: it goes to zero
//! with the step. A power that the ledger forgets does not.
//!
//! A loss may stay as long as the step does not resolve the vibrations that impacts excite: damping them is what such schemes
//! are for. So where a contact closed, and of the backward Euler rule, which damps a vibration of frequency w within a time T
//! unless the step is far below 1/(w^2 T), only gains are looked at.

use super::newton_law::{extent, mass, stiffness};
use super::run::{Breach, RandomRun, breach, run};
use crate::stability::outcome::limits;
use looselink::scene::{Pace, Scene};

/// Terms of the ledger are sums of a few dozen numbers each, which may cancel each other.
const ROUNDING: f64 = 1024.0 * f64::EPSILON;
/// Defects below this part of the energies that move are not looked into.
const SMALL: f64 = 1e-4;
/// How often the step is divided by four.
const REFINEMENTS: usize = 5;
/// What a quarter of the step must leave of the defect: a half, where order one leaves a quarter and order two a sixteenth.
const SHRINKS: f64 = 0.5;

const STORED: [&str; 6] = [
    "kinetic", "axial", "bending", "contact", "gravity", "springs",
];
const GONE: [&str; 3] = [
    "contact_dissipated",
    "friction_dissipated",
    "damping_dissipated",
];

/// Least and greatest value of an energy.
fn range(run: &RandomRun, name: &str) -> (f64, f64) {
    let values = run.rows.get(&format!("energy.{name}")).unwrap_or(&[]);
    limits(values.iter().copied()).into()
}

/// Largest defect of the ledger \[J\], and what it is measured by.
fn defect(run: &RandomRun) -> (f64, f64) {
    let scene = &run.scene;
    // what moves: the kinetic energy, and changes of all others
    let moving = STORED[1..].iter().chain(&GONE).chain(&["work"]);
    let size = moving.fold(range(run, STORED[0]).1, |size, name| {
        let (low, high) = range(run, name);
        size.max(high - low)
    });
    let (low, high) = range(run, "numerical");
    // rounding of the largest terms, and energies of strains and of ways of 1e-10: what rounding makes of things at rest
    let stored = STORED.iter().map(|name| range(run, name));
    let largest = stored.fold(0.0, |m: f64, (a, b)| b.max(-a).max(m));
    let length = extent(run, 0);
    let pace = length / scene.simulation.duration;
    let masses: f64 = scene.bodies.iter().map(|b| mass(&*b.kind)).sum();
    let noise =
        ROUNDING * largest + 1e-20 * (stiffness(scene, length) * length + masses * pace * pace);
    let lossy = run.report.onsets > 0 || scene.integrator.method.name() == "backward_euler";
    let value = if lossy { -low } else { high.max(-low) };
    (value, size + noise / SMALL)
}

/// The overrides that ask for shorter steps; with an accuracy none is longer than the time between rows.
fn finer(scene: &Scene, divisor: f64) -> Vec<String> {
    match scene.integrator.pace {
        Pace::Step(step) => vec![format!("integrator.step={:?}", step / divisor)],
        Pace::Accuracy(a) => vec![
            format!(
                "integrator.accuracy.position={:?}",
                a.position / divisor.powi(2)
            ),
            format!("output.interval={:?}", scene.output.interval / divisor),
        ],
    }
}

/// Strain beyond which a slope may have come to zero length, where it is -1/2: it has no direction there, and the angle of a
/// spring or a damper at it turns by half a turn within no time.
const NO_DIRECTION: f64 = 0.3;

/// Defects shrink when the step does, wherever they are not small already.
///
/// Not asked of explicit schemes with a step of their own, which are unstable at any step that is too long, nor where an
/// onset is not located: its error then depends on where in the step it falls; nor of links that are pressed or pulled far
/// beyond what the element is made for, which the report tells by their strain.
pub fn closes(text: &str, first: &RandomRun) -> Result<(), Breach> {
    let scene = &first.scene;
    let fixed = matches!(scene.integrator.pace, Pace::Step(_));
    let mut strains = first.report.strain.values();
    if strains.any(|s| s.axial.abs() > NO_DIRECTION)
        || !first.outcome.is_complete()
        || first.rows.rows() == 0
        || (scene.integrator.method.scheme.is_explicit && fixed)
        || !scene.integrator.locate_onsets
    {
        return Ok(());
    }
    let (mut value, mut size) = defect(first);
    let mut divisor = 1.0;
    for _ in 0..REFINEMENTS {
        if value <= SMALL * size {
            return Ok(());
        }
        divisor *= 4.0;
        // a run that stops or is cut short says nothing of the ledger
        let next = match run(text, &finer(scene, divisor))? {
            Ok(next) if next.outcome.is_complete() => defect(&next),
            _ => return Ok(()),
        };
        if next.0 <= SHRINKS * value {
            return Ok(());
        }
        (value, size) = next;
    }
    match value <= SMALL * size {
        true => Ok(()),
        false => breach(
            "the ledger closes with the step",
            format!("{value:e} of {size:e} J are left at 1/{divisor} of the step"),
        ),
    }
}

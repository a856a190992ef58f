//! What a scheme loses or gains: the ledger of energies, and the angular momentum of what flies freely.
//!
//! Nothing bounds the defect of one run: at a step as long as the motion itself a scheme may lose everything, and in nonlinear
//! mechanisms the best of them may gain. What must hold is that the defect is an error of the integration: it goes to zero
//! with the step. A power that the ledger forgets does not.
//!
//! A loss may stay as long as the step does not resolve the vibrations that impacts excite: damping them is what such schemes
//! are for. So where a contact closed, and of the backward Euler rule, which damps a vibration of frequency w within a time T
//! unless the step is far below 1/(w^2 T), only gains are looked at.

use super::newton_law::{at_rest, extent, flies, inertia, mass, stiffness};
use super::outcome::{Breach, ChannelRows, RandomRun, RunOutcome, run};
use looselink::body::Known;
use looselink::contact::Slip;
use looselink::interaction::SpringDamperModel;
use looselink::scene::{NamedBody, Pace, Scene};
use std::time::Duration;

/// Terms of the ledger are sums of a few dozen numbers each, which may cancel each other.
const ROUNDING: f64 = 1024.0 * f64::EPSILON;
/// Defects below this part of the energies that move are not looked into.
const SMALL: f64 = 1e-4;
/// How often the step is divided by four.
const REFINEMENTS: usize = 5;
/// What a quarter of the step must leave of the defect: a half, where order one leaves a quarter and order two a sixteenth.
const SHRINKS: f64 = 0.5;

const STORED: [&str; 6] = [
    "energy.kinetic",
    "energy.axial",
    "energy.bending",
    "energy.contact",
    "energy.gravity",
    "energy.springs",
];
const GONE: [&str; 3] = [
    "energy.contact_dissipated",
    "energy.friction_dissipated",
    "energy.damping_dissipated",
];

/// The ledger's identity: what is stored, was done and has gone adds up to what is called numerical.
pub fn identity(run: &RandomRun) -> Result<(), Breach> {
    let rows = &run.rows;
    let sum = |names: &[&str], row: usize| {
        let each = names.iter().map(|n| rows.get(n, row));
        each.fold((0.0, 0.0), |(s, m), e| (s + e, m + e.abs()))
    };
    if rows.is_empty() {
        return Ok(());
    }
    let (initial, first) = sum(&STORED, 0);
    for row in 0..rows.len() {
        let ((stored, a), (gone, b)) = (sum(&STORED, row), sum(&GONE, row));
        let (work, numerical) = (
            rows.get("energy.work", row),
            rows.get("energy.numerical", row),
        );
        let rest = initial + work - gone - stored - numerical;
        let size = first + a + b + work.abs();
        if rest.abs() > ROUNDING * size {
            let detail = format!("{rest:e} J of {size:e} J are left over in row {row}");
            return Err(Breach::new("the ledger adds up", detail));
        }
    }
    Ok(())
}

/// A quantity that the integration must keep: its largest defect and what it is measured by.
#[derive(Debug, Clone, Copy)]
struct Defect {
    property: &'static str,
    value: f64,
    size: f64,
}

fn energy(scene: &Scene, rows: &ChannelRows, lossy: bool) -> Defect {
    let over = |name: &str| {
        let values = (0..rows.len()).map(|row| rows.get(name, row));
        values.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| {
            (x.min(a), x.max(b))
        })
    };
    // what moves: the kinetic energy, and changes of all others
    let moving = STORED[1..].iter().chain(&GONE).chain(&["energy.work"]);
    let size = moving.fold(over(STORED[0]).1, |s, name| {
        let (low, high) = over(name);
        s.max(high - low)
    });
    let (low, high) = over("energy.numerical");
    // rounding of the largest terms, and energies of strains and of ways of 1e-10: what rounding makes of things at rest
    let largest = STORED
        .iter()
        .map(|n| over(n))
        .fold(0.0, |m, (a, b)| b.max(-a).max(m));
    let length = extent(scene, rows, 0);
    let pace = length / scene.simulation.duration;
    let masses: f64 = scene.bodies.iter().map(|b| mass(&*b.kind)).sum();
    let noise =
        ROUNDING * largest + 1e-20 * (stiffness(scene, length) * length + masses * pace * pace);
    Defect {
        property: "the ledger closes with the step",
        value: if lossy { -low } else { high.max(-low) },
        size: size + noise / SMALL,
    }
}

/// Angular momentum about the origin, of bodies that do not bend and nothing turns from outside.
fn spin(scene: &Scene, rows: &ChannelRows) -> Option<Defect> {
    let still = scene.simulation.gravity.is_none_or(|g| g == [0.0; 2]);
    let bodies = scene.bodies.iter().filter(|b| mass(&*b.kind) > 0.0);
    let known: Option<Vec<_>> = bodies
        .map(|b| inertia(&*b.kind).map(|i| (&b.name, mass(&*b.kind), i)))
        .collect();
    // as printed, friction acts on the centres, apart from each other, without the couples that would balance it; and a point
    // mass takes no couple
    let is_point = |b: usize| !scene.bodies[b].kind.turns();
    let uncoupled = scene.joints.iter().any(|j| {
        let friction = j.contact().and_then(|c| c.friction);
        friction.is_some_and(|f| {
            f.slip == Slip::Paper || is_point(j.bearing.body) || is_point(j.journal.body)
        })
    });
    let known =
        known.filter(|_| still && !uncoupled && flies(scene) && scene.motions.is_empty())?;
    let total = |row: usize| {
        known.iter().fold((0.0, 0.0), |(sum, size), (name, m, i)| {
            let of = |q: &str| rows.get(&format!("{name}.{q}"), row);
            let parts = [
                m * of("x") * of("vy"),
                -m * of("y") * of("vx"),
                i * of("omega"),
            ];
            let own: f64 = parts.iter().map(|p| p.abs()).sum();
            (sum + parts.iter().sum::<f64>(), size + own)
        })
    };
    let first = total(0).0;
    let (value, size) = (0..rows.len()).fold((0.0_f64, 0.0_f64), |(v, s), row| {
        let (now, size) = total(row);
        (v.max((now - first).abs()), s.max(size))
    });
    Some(Defect {
        property: "angular momentum closes with the step",
        value,
        size: size + at_rest(scene, rows) * extent(scene, rows, 0),
    })
}

fn defects(run: &RandomRun) -> Vec<Defect> {
    let Some(scene) = &run.scene else {
        return Vec::new();
    };
    if run.rows.is_empty() {
        return Vec::new();
    }
    let onsets = run.report.as_ref().map_or(0, |r| r.onsets);
    let lossy = onsets > 0 || scene.integrator.method.name() == "backward_euler";
    let energy = energy(scene, &run.rows, lossy);
    std::iter::once(energy)
        .chain(spin(scene, &run.rows))
        .collect()
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
pub fn closes(text: &str, first: &RandomRun, guard: Option<Duration>) -> Result<(), Breach> {
    let Some(scene) = &first.scene else {
        return Ok(());
    };
    let fixed = matches!(scene.integrator.pace, Pace::Step(_));
    let strains = first.report.iter().flat_map(|r| r.strain.values());
    if strains.into_iter().any(|s| s.abs() > NO_DIRECTION) {
        return Ok(());
    }
    let ran = matches!(
        first.outcome,
        RunOutcome::Finished | RunOutcome::Remarked(_)
    );
    if !ran
        || (scene.integrator.method.scheme.is_explicit && fixed)
        || !scene.integrator.locate_onsets
    {
        return Ok(());
    }
    linear(scene, &first.rows)?;
    let mut last = defects(first);
    let mut open = vec![true; last.len()];
    let mut divisor = 1.0;
    for k in 0..=REFINEMENTS {
        for (open, d) in open.iter_mut().zip(&last) {
            *open &= d.value > SMALL * d.size;
        }
        let Some(at) = open.iter().position(|o| *o) else {
            return Ok(());
        };
        if k == REFINEMENTS {
            let d = last[at];
            let detail = format!(
                "the defect does not shrink: {:e} of {:e} is left at 1/{divisor} of the step",
                d.value, d.size
            );
            return Err(Breach::new(d.property, detail));
        }
        divisor *= 4.0;
        let overrides = finer(scene, divisor);
        let next = run(text, &overrides, guard)?;
        if !matches!(next.outcome, RunOutcome::Finished | RunOutcome::Remarked(_)) {
            // a run that stops or is cut short says nothing of the ledger
            return Ok(());
        }
        let now = defects(&next);
        for (open, (now, last)) in open.iter_mut().zip(now.iter().zip(&last)) {
            *open &= now.value > SHRINKS * last.value;
        }
        last = now;
    }
    Ok(())
}

/// Point masses on springs without rest length are linear: one-step schemes that are A-stable gain nothing in any row, since
/// their amplification is a function of a skew-symmetric matrix, and its norm the largest of |R(i omega h)| <= 1.
fn linear(scene: &Scene, rows: &ChannelRows) -> Result<(), Breach> {
    let one_step =
        ["bathe", "trapezoidal", "backward_euler"].contains(&scene.integrator.method.name());
    let at_rest = |b: &NamedBody| matches!(b.kind.known(), Some(Known::Fixed));
    let masses = scene.bodies.iter().all(|b| at_rest(b) || !b.kind.turns());
    let springs = scene.forces.iter().all(|f| {
        let spring = f.kind.get::<SpringDamperModel>();
        spring.is_some_and(|s| s.rest_length == 0.0 && s.damping == 0.0)
    });
    if !one_step
        || !masses
        || !springs
        || !scene.joints.is_empty()
        || scene.simulation.gravity.is_some()
    {
        return Ok(());
    }
    let mut before = 0.0;
    for row in 0..rows.len() {
        let numerical = rows.get("energy.numerical", row);
        let stored: f64 = STORED.iter().map(|n| rows.get(n, row).abs()).sum();
        // a rounding of every step between rows
        if numerical < before - 1e4 * f64::EPSILON * stored.max(rows.get(STORED[0], 0)) {
            let detail = format!("{before:e} J had gone, {numerical:e} J in row {row}");
            return Err(Breach::new("linear systems gain nothing", detail));
        }
        before = numerical;
    }
    Ok(())
}

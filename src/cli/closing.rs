//! The last lines of a run: what was counted, and what the integrator did to the energy.

use looselink::record::Ledger;
use looselink::simulate::{AccuracyReport, Report};

/// Numerical dissipation beyond this part of the physical one is worth a word.
const NOTABLE: f64 = 0.05;

/// Impacts that are shown; summary.json lists more.
const SHOWN: usize = 3;

/// Lines about a finished run, most of them absent when there is nothing to say.
pub fn lines(report: &Report) -> Vec<String> {
    let mut lines = Vec::new();
    if let Some(ledger) = &report.ledger {
        lines.extend(energy(ledger));
    }
    lines.extend(report.accuracy.iter().map(accuracy));
    let first = report.impacts.iter().take(SHOWN).enumerate();
    lines.extend(first.map(|(k, impact)| {
        format!(
            "impact {}: {} at {:.9} s with {:.6e} m/s at {:.4} degrees, {:.6e} m deep",
            k + 1,
            impact.joint,
            impact.t,
            impact.impact_velocity,
            impact.angle.to_degrees(),
            impact.deepest_penetration
        )
    }));
    lines.extend(report.redundant.iter().map(|name| {
        format!(
            "{name} repeats other constraints: the forces in its loop are one choice among many"
        )
    }));
    let counts = [
        (report.clamps, "stages with a contact force clamped at zero"),
        (
            report.rejected_steps,
            "steps halved because a stage had no solution",
        ),
        (
            report.stagnations,
            "stages accepted at rounding, above the Newton tolerance",
        ),
        (
            report.singular_poses,
            "stages in a nearly singular pose, one direction left out",
        ),
        (report.fallbacks, "factorisations with row exchanges"),
        (
            report.unlocated_changes,
            "contact changes kept outside the onset tolerance",
        ),
    ];
    let counted = counts.iter().filter(|(count, _)| *count > 0);
    lines.extend(counted.map(|(count, what)| format!("counted: {count} {what}")));
    lines
}

/// What the steps were that an accuracy asked for.
fn accuracy(control: &AccuracyReport) -> String {
    let [shortest, longest] = control.steps;
    let mut line = format!(
        "accuracy: {} asked for, steps from {shortest:.1e} to {longest:.1e} s",
        control.asked
    );
    let most = control.rejected_by.iter().max_by_key(|(_, count)| **count);
    if let Some((name, count)) = most {
        line += &format!(
            "; {} taken again because their estimated error was too large, {count} of them in {name}",
            control.rejected_steps
        );
    }
    line
}

/// What the integrator did to the energy.
fn energy(ledger: &Ledger) -> Vec<String> {
    let dissipated =
        ledger.contact_dissipated + ledger.friction_dissipated + ledger.damping_dissipated;
    let verb = if ledger.numerical < 0.0 {
        "gained"
    } else {
        "lost"
    };
    let numerical = ledger.numerical.abs();
    if dissipated <= 0.0 {
        return vec![format!(
            "energy: {numerical:.1e} J {verb} by the integrator"
        )];
    }
    let mut lines = vec![format!(
        "energy: {dissipated:.3e} J dissipated, {numerical:.1e} J {verb} by the integrator ({:.1} %)",
        100.0 * numerical / dissipated
    )];
    if numerical > NOTABLE * dissipated {
        lines.push(
            "energy: a smaller integrator.step would make the integrator's part small".to_owned(),
        );
    }
    lines
}

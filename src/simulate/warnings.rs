//! What a user should know of a run before the numbers are used.

use super::Report;
use plot::number;

/// Warn of energy lost or gained by the integrator beyond this part of the energy dissipated ...
const OF_DISSIPATED: f64 = 0.05;
/// ... or beyond this part of the energy in play.
const OF_TURNOVER: f64 = 0.01;
/// Relative change of accelerations from step to step of a vibration with six steps a period.
const UNRESOLVED: f64 = 1.0;
/// At a Green strain of -1/2 the centre line has no length; nothing in the theory prevents further compression.
const CRUSHED: f64 = -0.4;
/// Warn of an estimated error beyond this part of the largest range of motion.
const OF_TRAVEL: f64 = 0.01;

/// A fraction in words.
fn share(part: f64, of: &str) -> String {
    match part {
        part if part < 10.0 => format!("{:.1} % of {of}", 100.0 * part),
        part => format!("{part:.0} times {of}"),
    }
}

/// Warnings of several runs as a part of a page in Markdown; empty where no run warns.
pub(crate) fn warning_list(warnings: &[String]) -> String {
    let lines = warnings.iter().map(|warning| format!("* {warning}\n"));
    match warnings.is_empty() {
        true => String::new(),
        false => format!("\nWarnings:\n\n{}", lines.collect::<String>()),
    }
}

impl Report {
    /// One line for every reason why the results may be less accurate than they look.
    pub fn warnings(&self) -> Vec<String> {
        let mut warnings = Vec::new();
        warnings.extend(self.energy_warning());
        warnings.extend(self.error_warning());
        warnings.extend(self.acceleration_warning());
        warnings.extend(self.chatter.iter().map(|chatter| {
            format!(
                "{} chatters from {} to {} s: {} onsets within a few steps each",
                chatter.joint,
                number(chatter.from, 7),
                number(chatter.to, 7),
                chatter.onsets
            )
        }));
        if self.accuracy.is_none() && self.brief_contacts > 0 {
            warnings.push(format!(
                "{} of {} contacts lasted fewer than four steps: a smaller integrator.step would resolve them",
                self.brief_contacts, self.ended_contacts
            ));
        }
        warnings.extend(self.redundant.iter().map(|name| {
            format!(
                "{name} repeats other constraints: the forces in its loop are one choice among many"
            )
        }));
        let crushed = self.strain.iter().filter(|(_, strain)| **strain < CRUSHED);
        warnings.extend(crushed.map(|(name, strain)| {
            format!(
                "{name} is pressed together to a strain of {strain:.2}: at -0.5 its centre line has no length left"
            )
        }));
        if self.rejected_steps > 0 {
            let most = self.rejected_by.iter().max_by_key(|(_, times)| **times);
            let most = most.map_or(String::new(), |(name, times)| {
                format!(", {times} times that of {name}")
            });
            warnings.push(format!(
                "{} steps failed and were halved{most}",
                self.rejected_steps
            ));
        }
        let counts = [
            (self.clamps, "stages with a contact force clamped at zero"),
            (
                self.stagnations,
                "stages accepted at rounding, above the Newton tolerance",
            ),
            (
                self.singular_poses,
                "stages in a nearly singular pose, one direction left out",
            ),
            (self.fallbacks, "factorisations with row exchanges"),
            (
                self.unlocated_changes,
                "contact changes kept outside the onset tolerance",
            ),
        ];
        let counted = counts.iter().filter(|(count, _)| *count > 0);
        warnings.extend(counted.map(|(count, what)| format!("{count} {what}")));
        warnings
    }

    fn energy_warning(&self) -> Option<String> {
        let ledger = self.ledger.as_ref()?;
        let integration = self.integration.as_ref()?;
        let verb = |lost: f64| match lost < 0.0 {
            true => "gained",
            false => "lost",
        };
        let [least, greatest] = integration.lost;
        let most = if -least > greatest { least } else { greatest };
        let changed = most.abs();
        if changed > OF_TURNOVER * integration.turnover {
            return Some(format!(
                "the integrator {} {} J, {}",
                verb(most),
                number(changed, 2),
                share(changed / integration.turnover, "the energy in play")
            ));
        }
        let (dissipated, numerical) = (ledger.dissipated(), ledger.numerical.abs());
        (dissipated > 0.0 && numerical > OF_DISSIPATED * dissipated).then(|| {
            format!(
                "the integrator {} {} J, {}: a smaller integrator.step would make its part small",
                verb(ledger.numerical),
                number(numerical, 2),
                share(numerical / dissipated, "what was dissipated")
            )
        })
    }

    fn acceleration_warning(&self) -> Option<String> {
        let integration = self.integration.as_ref()?;
        let change = integration.acceleration_change;
        (change > UNRESOLVED).then(|| {
            format!(
                "the acceleration of {} changes by {change:.1} times its size from step to step: a vibration faster than the steps, \
                 in which accelerations and forces are not to be trusted",
                integration.acceleration_change_of
            )
        })
    }

    fn error_warning(&self) -> Option<String> {
        let integration = self.integration.as_ref()?;
        let (error, travel) = (integration.estimated_error, integration.travel);
        (error > OF_TRAVEL * travel).then(|| {
            format!(
                "the estimated error of {} is {} m where the longest way of a point is {} m",
                integration.estimated_error_of,
                number(error, 2),
                number(travel, 2)
            )
        })
    }
}

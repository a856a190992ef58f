//! Facts about a run that a user may want to know; none of them puts a result in doubt.

use super::{FoundRest, Report};
use crate::contact::NORMAL_VARIATION;
use numbers::{share, si};

/// Strains, and curvatures times height, are mentioned from here on: steel yields at a fifth of it.
const NOTABLE: f64 = 0.01;

/// What changes of normal forces do to bristles is mentioned beyond this part of what friction dissipates.
const NOTABLE_VARIATION: f64 = 0.01;

impl Report {
    /// One line for every fact: what is remarkable about the scene, what the start decides, redundant constraints, freedoms that drives
    /// leave, large strains, and how the equations were solved.
    pub fn notes(&self) -> Vec<String> {
        let mut notes = self.scene_notes.clone();
        notes.extend(self.start_notes());
        if self.one_of_many.is_empty() {
            notes.extend(self.redundant.iter().map(|name| {
                format!("{name} is redundant: the constraint forces in its loop are not unique")
            }));
        } else {
            let joints = self.one_of_many.join(", ");
            notes.push(format!(
                "the reactions of {joints} are one of many that balance the forces: those of the least norm"
            ));
        }
        notes.extend(self.restitution.iter().map(ToString::to_string));
        notes.extend(self.freedoms.iter().cloned());
        // the error of a run that ends at the first one has said it
        let said = |point: &String| {
            self.error
                .as_ref()
                .is_some_and(|error| error.contains(point))
        };
        let critical = self.critical_points.iter().map(ToString::to_string);
        notes.extend(critical.filter(|point| !said(point)));
        notes.extend(self.rest.as_ref().and_then(FoundRest::note));
        notes.extend(self.unstable_rest.as_ref().map(|rest| {
            format!(
                "the mechanism rests in an unstable equilibrium: a small push of {} grows",
                rest.moves_most
            )
        }));
        let strained = self.strain.iter();
        let most = strained.max_by(|a, b| a.1.largest().total_cmp(&b.1.largest()));
        if let Some((name, strain)) = most.filter(|(_, strain)| strain.largest() > NOTABLE) {
            notes.push(format!(
                "the most deformed link, {name}, has {}",
                strain.description()
            ));
        }
        notes.extend(self.ledger.as_ref().and_then(|ledger| {
            let varied = *ledger.others.get(NORMAL_VARIATION.name)?;
            let of_friction = varied.abs() / ledger.friction_dissipated;
            (of_friction > NOTABLE_VARIATION).then(|| {
                format!(
                    "changes of normal forces added {} to the energy of bristles, {}",
                    si(varied, "J"),
                    share(of_friction, "what friction dissipates")
                )
            })
        }));
        if self.ended_at_limit {
            return notes;
        }
        if self.rejected_steps > 0 {
            let most = self.rejected_by.iter().max_by_key(|(_, times)| **times);
            let most = most.map_or(String::new(), |(name, times)| {
                format!(" ({times} of them for {name})")
            });
            notes.push(format!(
                "steps that failed and were halved: {}{most}",
                self.rejected_steps
            ));
        }
        let counts = [
            (self.clamps, "stages with a contact force clamped at zero"),
            (
                self.stagnations,
                "stages in which rounding kept Newton's method above newton_tolerance",
            ),
            (
                self.position_level_stages,
                "stages without a solution on the acceleration level, solved on the position level with a lower order",
            ),
            (
                self.singular_poses,
                "stages in a nearly singular pose, solved without the singular direction",
            ),
            (self.fallbacks, "factorisations that needed row exchanges"),
            (
                self.unlocated_changes,
                "contact changes not located to within onset_tolerance",
            ),
        ];
        let counted = counts.iter().filter(|(count, _)| *count > 0);
        notes.extend(counted.map(|(count, what)| format!("{what}: {count}")));
        notes
    }
}

//! What the start of a run decides: largest values that fall into the first impacts.

use super::{Peak, Report};
use numbers::si;

impl Report {
    /// A line for the forces of joints and one for the torques of drives, where the largest falls into the first impact: it depends on
    /// where the journals start in their bearings, not on the motion that follows. Before them a line for journals that nothing presses.
    pub(super) fn start_notes(&self) -> Vec<String> {
        let closing = &self.closing;
        let advice = match self.unpressed {
            Some(_) => "",
            None => ", `initial.journals = \"pressed\"` begins in contact",
        };
        let unpressed = self.unpressed.iter().filter(|joints| !joints.is_empty());
        let unpressed = unpressed.map(|joints| {
            format!(
                "the journals of {} start in the middle of their bearings: at t = 0 no force presses them",
                joints.join(", ")
            )
        });
        let forces = decided(closing.forces.iter(), "force of", "N", advice);
        let torques = closing.drives.iter();
        let torques = torques.map(|(name, load)| (name, &load.torque));
        let torques = decided(torques, "torque in", "N m", advice);
        unpressed.chain(forces).chain(torques).collect()
    }
}

/// The line for quantities of one kind.
fn decided<'a>(
    peaks: impl Iterator<Item = (&'a String, &'a Peak)>,
    what: &str,
    unit: &str,
    advice: &str,
) -> Option<String> {
    let early = peaks.filter_map(|(name, peak)| Some((name, peak, peak.after_first_impact?)));
    let early: Vec<_> = early.collect();
    let most = early.iter();
    let most = most.max_by(|a, b| a.1.largest.total_cmp(&b.1.largest))?;
    let (name, peak, later) = *most;
    let others = match early.len() - 1 {
        0 => String::new(),
        count => format!("; likewise of {count} more"),
    };
    Some(format!(
        "the largest {what} {name}, {} at t = {} s, falls into the first impact, which the start decides: afterwards it is {}{others}; \
         `output.extremes_from` leaves the start out{advice}",
        si(peak.largest, unit),
        numbers::number(peak.t, 4),
        si(later, unit),
    ))
}

//! The quantities that the statements of the paper are decided by, over the last two of three cycles.

use crate::kinematics::MechanismGeometry;
use crate::runs::{CaseRecording, DURATION, FROM};
use crate::signal::{
    coincidence, cycle_distance, fraction, mean, median_frequency, peak, peaks, rms,
};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Peaks that are compared with other events.
pub const PEAKS: usize = 50;
/// Least distance between two of them \[s\].
const PEAKS_APART: f64 = 2e-3;
/// Two events this close count as simultaneous \[s\].
pub const SIMULTANEOUS: f64 = 5e-4;
/// An impact lasts less than this, so its force peak follows its onset within this time \[s\].
pub const AFTER_ONSET: f64 = 1e-3;
/// Joints with clearance.
const JOINTS: [&str; 6] = ["B1", "B2", "B3", "C1", "C2", "C3"];

/// Named numbers of one run, in SI units.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Measures(pub BTreeMap<String, f64>);

impl Measures {
    /// A number of this run.
    ///
    /// # Panics
    /// When the run has no such number: the callers name those that their case has.
    pub fn get(&self, name: &str) -> f64 {
        let found = self.0.get(name);
        *found.unwrap_or_else(|| panic!("no measure {name}"))
    }

    /// Keeps a number to nine digits; one that is none, such as a part of nothing, is left out.
    pub fn put(&mut self, name: &str, value: f64) {
        if value.is_finite() {
            self.0.insert(name.into(), numbers::rounded(value, 9));
        }
    }

    /// Measures a run of [`DURATION`].
    pub fn of(g: &MechanismGeometry, recording: &CaseRecording) -> Measures {
        let mut m = Measures::default();
        let between = |channel: &str| recording.between(channel, FROM, DURATION).1;
        let (error, acceleration) = (between("error.x"), between("platform.ax"));
        let force = between("B1.force");
        let interval = recording.plan.interval;
        let deviated = deviation(g, recording, FROM, DURATION);
        let times = between("t").iter();
        let ideal: Vec<f64> = times.map(|&t| g.acceleration_x(t)).collect();
        let cycle = |from: f64| rms(&deviation(g, recording, from, from + 1.0 / g.frequency));
        let average = mean(force);
        let ripple: Vec<f64> = force.iter().map(|f| f - average).collect();
        let cubes: Vec<f64> = force.iter().map(|f| f.powi(3)).collect();
        // largest |e_x| [m]
        m.put("error_peak", peak(error));
        m.put("error_rms", rms(error));
        m.put("acceleration_peak", peak(acceleration));
        // deviation of the acceleration along x from the ideal one [m/s2]
        m.put("deviation_peak", peak(&deviated));
        m.put("deviation_rms", rms(&deviated));
        m.put("deviation_share", rms(&deviated) / rms(&ideal));
        // the frequency below which half of its power lies [Hz]
        let frequency = median_frequency(&deviated, interval);
        m.put("deviation_frequency", frequency);
        // its rms in the last cycle over that in the first
        m.put("settling", cycle(2.0) / cycle(0.0));
        // rms difference between the accelerations of cycles 2 and 3 over their rms deviation from the mean; the last
        // sample belongs to the next cycle
        let whole = &acceleration[..acceleration.len() - 1];
        m.put("repetition", cycle_distance(whole));
        // force in B1 [N]; its cubic mean is the equivalent load of bearing life
        m.put("force_peak", peak(force));
        m.put("force_mean", average);
        m.put("force_cubic_mean", mean(&cubes).cbrt());
        m.put("force_ripple", rms(&ripple));
        m.put("force_frequency", median_frequency(&ripple, interval));
        m.put("energy_lost", energy_lost(recording));
        if recording.plan.case >= 3 {
            m.contacts(g, recording, &deviated);
        }
        m
    }

    /// What only loose joints have.
    fn contacts(&mut self, g: &MechanismGeometry, recording: &CaseRecording, deviation: &[f64]) {
        let (t, _) = recording.between("t", FROM, DURATION);
        let between = |channel: &str| recording.between(channel, FROM, DURATION).1;
        let contact = |joint| fraction(between(&format!("{joint}.penetration")), |d| d > 0.0);
        let share = JOINTS.map(contact);
        self.put("contact_b1", share[0]);
        self.put("contact_least", share.into_iter().fold(1.0, f64::min));
        // part of the bound of the error that is used at the same instant
        let used = between("error.x").iter().zip(bound(g, recording));
        let used = used.map(|(e, b)| e.abs() / b);
        self.put("bound_used", used.fold(0.0, f64::max));
        let apart = (PEAKS_APART / recording.plan.interval) as usize;
        let times = |y: &[f64]| -> Vec<f64> {
            let chosen = peaks(y, PEAKS, apart);
            chosen.into_iter().map(|i| t[i]).collect()
        };
        let highest = times(deviation);
        let middle = 0.5 * AFTER_ONSET;
        let onsets = recording.onsets();
        let shifted: Vec<f64> = onsets.clone().map(|t| t + middle).collect();
        self.put("peaks_after_onset", coincidence(&highest, &shifted, middle));
        let onsets: Vec<f64> = onsets.filter(|t| *t >= FROM).collect();
        self.put("onsets", onsets.len() as f64);
        let chance = covered(&onsets) / (DURATION - FROM);
        self.put("after_onset_by_chance", chance);
        let forces = ["B1", "B2", "B3"].map(|joint| times(between(&format!("{joint}.force"))));
        let one = coincidence(&highest, &forces[0], SIMULTANEOUS);
        self.put("peaks_with_b1", one);
        let any = coincidence(&highest, &forces.concat(), SIMULTANEOUS);
        self.put("peaks_with_any", any);
        // rows in which there is no force without positive penetration
        let rows = recording.column("B1.penetration").iter();
        let rows = rows.zip(recording.column("B1.force"));
        let none = |(delta, force): (&f64, &f64)| *delta > 0.0 || *force == 0.0;
        let rows: Vec<f64> = rows.map(|row| f64::from(u8::from(none(row)))).collect();
        self.put("force_only_in_contact", mean(&rows));
        let report = &recording.report;
        if let Some(ledger) = &report.ledger {
            self.put("contact_dissipated", ledger.contact_dissipated);
        }
        self.put("unlocated", report.unlocated_changes as f64);
        let changes = (report.onsets + report.ended_contacts) as f64;
        self.put("trials_a_change", report.location_trials as f64 / changes);
        let first = |joint: &str| recording.column(&format!("{joint}.eccentricity"))[0];
        let largest = JOINTS.map(first).into_iter().fold(0.0, f64::max);
        self.put("start_eccentricity", largest);
    }
}

/// Deviation of the platform acceleration along x from the ideal one \[m/s2\].
pub fn deviation(g: &MechanismGeometry, recording: &CaseRecording, from: f64, to: f64) -> Vec<f64> {
    let (t, a) = recording.between("platform.ax", from, to);
    let pairs = t.iter().zip(a);
    pairs.map(|(&t, a)| a - g.acceleration_x(t)).collect()
}

/// Largest energy that the integrator has lost (positive) or gained by any row, over that dissipated in contacts; where
/// nothing dissipates, over the largest elastic energy of the links.
pub fn energy_lost(recording: &CaseRecording) -> f64 {
    let report = &recording.report;
    let (Some(ledger), Some(integration)) = (&report.ledger, &report.integration) else {
        return f64::NAN;
    };
    let [least, greatest] = integration.lost;
    let lost = if -least > greatest { least } else { greatest };
    let of = if recording.plan.case >= 3 {
        ledger.contact_dissipated
    } else {
        let axial = recording.column("energy.axial").iter();
        let bending = recording.column("energy.bending");
        axial.zip(bending).map(|(a, b)| a + b).fold(0.0, f64::max)
    };
    lost / of
}

/// The bound of the error along x over the last two cycles \[m\]: sum_i |J^-1|_{xi} s_i, where the slack s_i of a
/// leg is 2 c, the penetrations of its two joints and, of a flexible link, its length times its strain.
pub fn bound(g: &MechanismGeometry, recording: &CaseRecording) -> Vec<f64> {
    let rows = recording.rows(FROM, DURATION);
    let column = |kind: &str, leg: usize, name: &str| {
        &recording.column(&format!("{kind}{}.{name}", leg + 1))[rows.clone()]
    };
    let flexible = recording.plan.case == 4;
    let legs = [0, 1, 2].map(|leg| {
        let pair = ["B", "C"].map(|joint| column(joint, leg, "penetration"));
        (pair, flexible.then(|| column("link", leg, "strain")))
    });
    let slack = |k: usize| {
        legs.map(|([b, c], strain)| {
            let stretch = strain.map_or(0.0, |strain| g.link * strain[k].abs());
            2.0 * g.clearance + b[k].max(0.0) + c[k].max(0.0) + stretch
        })
    };
    let times = recording.column("t")[rows.clone()].iter().enumerate();
    times.map(|(k, &t)| g.bound_x(t, slack(k))).collect()
}

/// The time that lies within [`AFTER_ONSET`] after one of these instants, which are in order \[s\].
fn covered(onsets: &[f64]) -> f64 {
    let mut end = f64::NEG_INFINITY;
    let mut sum = 0.0;
    for &t in onsets {
        sum += t + AFTER_ONSET - end.max(t);
        end = t + AFTER_ONSET;
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn overlapping_times_after_onsets_count_once() {
        assert!((covered(&[0.0, 0.25e-3, 5e-3]) - 2.25e-3).abs() < 1e-15);
    }
}

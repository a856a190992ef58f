//! Statements about Fig. 6: the acceleration of the platform.

use crate::campaign::{Campaign, DURATION, FROM};
use crate::measures::AllMeasures;
use crate::numbers::Numbers;
use crate::signal::{coincidence, peak, peaks, rms};
use crate::statement::Statement;
use plot::{digits, percent, si};

/// Peaks that are compared with other events.
pub const PEAKS: usize = 50;
/// Least distance between two of them \[s\].
pub const PEAKS_APART: f64 = 2e-3;
/// Two events this close count as simultaneous \[s\].
pub const SIMULTANEOUS: f64 = 5e-4;

/// The statements.
pub fn statements(c: &Campaign, m: &AllMeasures, numbers: &mut Numbers) -> Vec<Statement> {
    vec![
        very_different(c, m, numbers),
        slightly_vibrated(m, c),
        high_frequency(m),
        by_impacts(c, numbers),
        unstable(m),
        larger_in_case_4(m),
        higher_frequency_in_case_4(m),
    ]
}

fn very_different(c: &Campaign, m: &AllMeasures, numbers: &mut Numbers) -> Statement {
    let ideal = numbers.put(
        "case1.acceleration_rms",
        rms(c.ideal.between("platform.ax", FROM, DURATION).1),
    );
    let share =
        [&m.flexible, &m.flexible_coarse, &m.loose, &m.both].map(|m| m.deviation_rms / ideal);
    Statement {
        place: "Sect. 6, Fig. 6",
        says: "The accelerations are very different from their ideal values.",
        measured: format!(
            "Rms deviation over the rms of the ideal acceleration: case 2 {} (h = {}) and {} (h = {}), case 3 {}, case 4 {} (h = {}).",
            digits(share[0]),
            si(m.flexible.step, "s"),
            digits(share[1]),
            si(m.flexible_coarse.step, "s"),
            digits(share[2]),
            digits(share[3]),
            si(m.both.step, "s")
        ),
        criterion: "above 0.25 in cases 2 (finer step), 3 and 4",
        holds: share[0] > 0.25 && share[2] > 0.25 && share[3] > 0.25,
        factor: None,
        why: "Forces go with the second derivative of tiny displacements.".into(),
    }
}

fn slightly_vibrated(m: &AllMeasures, c: &Campaign) -> Statement {
    let ideal = rms(c.ideal.between("platform.ax", FROM, DURATION).1);
    let share = [&m.flexible, &m.flexible_coarse].map(|m| m.deviation_rms / ideal);
    Statement {
        place: "Sect. 6, Fig. 6a",
        says: "Case 2: the acceleration is slightly vibrated.",
        measured: format!("Rms deviation over the rms of the ideal acceleration: {} at h = {}, {} at h = {}.", digits(share[0]), si(m.flexible.step, "s"), digits(share[1]), si(m.flexible_coarse.step, "s")),
        criterion: "between 0.01 and 0.25 at both steps",
        holds: share.iter().all(|s| (0.01..=0.25).contains(s)),
        factor: None,
        why: "The vibration is the ringing of the unstrained start; how much is left after one cycle depends on the step.".into(),
    }
}

fn high_frequency(m: &AllMeasures) -> Statement {
    Statement {
        place: "Sect. 6, 7, Fig. 6b",
        says: "Case 3: the acceleration presents high-frequency vibrations; with clearances the system performs high-frequency responses.",
        measured: format!(
            "Half of the power of the deviation lies above {} in case 3 and {} in case 4 (h = {}).",
            si(m.loose.deviation_frequency, "Hz"),
            si(m.both.deviation_frequency, "Hz"),
            si(m.loose.step, "s")
        ),
        criterion: "above 50 Hz, fifty times the frequency of the motion, in both",
        holds: m.loose.deviation_frequency > 50.0 && m.both.deviation_frequency > 50.0,
        factor: None,
        why: "An impact lasts a fraction of a millisecond.".into(),
    }
}

fn by_impacts(c: &Campaign, numbers: &mut Numbers) -> Statement {
    let deviation = c.acceleration_deviation(&c.loose);
    let interval = c.settings.interval;
    let t = &c.loose.t[c.loose.rows(FROM, DURATION)];
    let at: Vec<f64> = peaks(&deviation, PEAKS, (PEAKS_APART / interval) as usize)
        .into_iter()
        .map(|i| t[i])
        .collect();
    // an impact lasts less than a millisecond, so its force peak follows its onset within that time
    let shifted: Vec<f64> = c.loose.onsets.iter().map(|t| t + 5e-4).collect();
    let share = numbers.put("case3.peaks_after_onset", coincidence(&at, &shifted, 5e-4));
    let count = c.loose.onsets.iter().filter(|t| **t >= FROM).count();
    numbers.put("case3.onsets", count as f64);
    Statement {
        place: "Sect. 6, Fig. 6b",
        says: "The vibrations are caused by the impacts of journal and bearing.",
        measured: format!(
            "{} of the {PEAKS} highest peaks of the deviation follow one of {count} contact onsets within 1 ms (case 3, h = {}).",
            percent(share),
            si(c.loose.plan.step, "s")
        ),
        criterion: "at least 90 %",
        holds: share >= 0.9,
        factor: None,
        why: format!(
            "By chance alone at most {} of the time lies within 1 ms after an onset.",
            percent((count as f64 * 1e-3 / (DURATION - FROM)).min(1.0))
        ),
    }
}

fn unstable(m: &AllMeasures) -> Statement {
    Statement {
        place: "Sect. 6, Fig. 6b",
        says: "These vibrations make the system unstable and difficult to control.",
        measured: format!("Rms deviation of the acceleration in the third cycle over the first: case 3 {}, case 4 {} (h = {}).", digits(m.loose.settling), digits(m.both.settling), si(m.loose.step, "s")),
        criterion: "unstable means growing: above 1.5 in case 3 or 4",
        holds: m.loose.settling > 1.5 || m.both.settling > 1.5,
        factor: None,
        why: "The model has no controller: the cranks follow their motion whatever the forces. Only growth can be decided here.".into(),
    }
}

fn larger_in_case_4(m: &AllMeasures) -> Statement {
    Statement {
        place: "Sect. 6, Fig. 6c",
        says: "Case 4: the vibration amplitude is larger than in case 3.",
        measured: format!("Rms deviation {} against {} m/s², peak {} against {} m/s² (h = {}).", digits(m.both.deviation_rms), digits(m.loose.deviation_rms), digits(peak(&m.both.deviation)), digits(peak(&m.loose.deviation)), si(m.both.step, "s")),
        criterion: "the rms deviation is larger",
        holds: m.both.deviation_rms > m.loose.deviation_rms,
        factor: None,
        why: "A flexible link stores part of an impact and gives it back, which softens the peak and prolongs the ringing.".into(),
    }
}

fn higher_frequency_in_case_4(m: &AllMeasures) -> Statement {
    Statement {
        place: "Sect. 6, Fig. 6c",
        says: "Case 4: the frequency is higher than in case 3.",
        measured: format!("Half of the power of the deviation lies below {} against {} (h = {}).", si(m.both.deviation_frequency, "Hz"), si(m.loose.deviation_frequency, "Hz"), si(m.both.step, "s")),
        criterion: "the median frequency is higher",
        holds: m.both.deviation_frequency > m.loose.deviation_frequency,
        factor: None,
        why: "A link in series with the contact makes it softer, which lowers the frequency of the contact; its own vibrations add higher ones.".into(),
    }
}

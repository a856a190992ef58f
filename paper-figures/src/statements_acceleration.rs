//! Statements about Fig. 6: the acceleration of the platform.

use crate::evidence::{Evidence, statement};
use crate::interval::{CriterionVerdict, Interval};
use crate::measures::{AFTER_ONSET, PEAKS};
use crate::statement::Statement;
use numbers::{digits, percent, si};

/// The statements.
pub fn statements(e: &Evidence) -> Vec<Statement> {
    vec![
        very_different(e),
        slightly_vibrated(e),
        high_frequency(e),
        by_impacts(e),
        unstable(e),
        larger_in_case_4(e),
        higher_frequency_in_case_4(e),
    ]
}

/// A measure of cases 3 and 4.
fn loose(e: &Evidence, name: &str) -> [Interval; 2] {
    [e.loose().mean(name), e.both().mean(name)]
}

fn hertz(value: f64) -> String {
    si(value, "Hz")
}

fn acceleration(value: f64) -> String {
    si(value, "m/s²")
}

fn very_different(e: &Evidence) -> Statement {
    let fine = e.flexible.get("deviation_share");
    let share = loose(e, "deviation_share");
    Statement {
        measured: format!(
            "rms deviation from the ideal acceleration over the rms of the latter: case 2 {} at the finer step and {} at the coarser, case 3 {}, case 4 {}.",
            percent(fine),
            percent(e.flexible_coarse.get("deviation_share")),
            share[0].reported(percent),
            share[1].reported(percent)
        ),
        criterion: "above 25 % in cases 2 (finer step), 3 and 4",
        verdict: CriterionVerdict::of(fine > 0.25).and(share[0].above(0.25)).and(share[1].above(0.25)),
        why: "A displacement of a micrometre at hundreds of hertz is an acceleration of metres per second squared.".into(),
        sources: e.all_cases(),
        ..statement("very different", "Sect. 6, Fig. 6", "The accelerations are very different from their ideal values.")
    }
}

fn slightly_vibrated(e: &Evidence) -> Statement {
    let share = [&e.flexible, &e.flexible_coarse].map(|m| m.get("deviation_share"));
    Statement {
        measured: format!(
            "rms deviation from the ideal acceleration over the rms of the latter: {} at the finer step, {} at the coarser.",
            percent(share[0]),
            percent(share[1])
        ),
        criterion: "between 1 % and 25 % at both steps",
        verdict: CriterionVerdict::of(share.iter().all(|s| (0.01..=0.25).contains(s))),
        why: "The unstrained start excites this vibration; how much of it is left after one cycle depends on the step.".into(),
        sources: e.case_2(),
        ..statement("slightly", "Sect. 6, Fig. 6a", "Case 2: the acceleration is slightly vibrated.")
    }
}

fn high_frequency(e: &Evidence) -> Statement {
    let frequency = loose(e, "deviation_frequency");
    Statement {
        measured: format!(
            "half of the power of the deviation lies above {} in case 3 and {} in case 4.",
            frequency[0].reported(hertz),
            frequency[1].reported(hertz)
        ),
        criterion: "above 50 Hz, fifty times the frequency of the motion, in both",
        verdict: frequency[0].above(50.0).and(frequency[1].above(50.0)),
        why: "An impact lasts a fraction of a millisecond.".into(),
        sources: e.ensembles(),
        ..statement(
            "high frequency",
            "Sect. 6, 7, Fig. 6b",
            "Case 3: the acceleration presents high-frequency vibrations; with clearances the system performs high-frequency responses.",
        )
    }
}

fn by_impacts(e: &Evidence) -> Statement {
    let share = e.loose().mean("peaks_after_onset");
    Statement {
        measured: format!(
            "{} of the {PEAKS} highest peaks of the deviation follow a contact onset within {}. By chance it would be {}.",
            share.reported(percent),
            si(AFTER_ONSET, "s"),
            e.loose().mean("after_onset_by_chance").reported(percent)
        ),
        criterion: "at least 90 % of the peaks",
        verdict: share.above(0.9),
        why: "The other peaks come later after an impact, or from the change of the force at a loss of contact.".into(),
        sources: vec![e.loose().source()],
        ..statement("by impacts", "Sect. 6, Fig. 6b", "The vibrations are caused by the impacts of journal and bearing.")
    }
}

fn unstable(e: &Evidence) -> Statement {
    let growth = loose(e, "settling");
    Statement {
        measured: format!(
            "rms deviation of the acceleration in the third cycle over that in the first: case 3 {}, case 4 {}.",
            growth[0].reported(digits),
            growth[1].reported(digits)
        ),
        criterion: "unstable means that the deviation grows: above 1.5 in case 3 or 4",
        verdict: growth[0].above(1.5).or(growth[1].above(1.5)),
        why: "The model has no controller: the cranks follow their prescribed motion whatever the forces. Only growth can be decided.".into(),
        sources: e.ensembles(),
        ..statement("unstable", "Sect. 6, Fig. 6b", "These vibrations make the system unstable and difficult to control.")
    }
}

fn larger_in_case_4(e: &Evidence) -> Statement {
    let [three, four] = loose(e, "deviation_rms");
    let peaks = loose(e, "deviation_peak");
    let ratio = e.both().mean_with(e.loose(), "deviation_rms", |b, a| b / a);
    Statement {
        measured: format!(
            "rms deviation {} in case 4 and {} in case 3, ratio {}; largest deviation {} and {}.",
            four.reported(acceleration),
            three.reported(acceleration),
            ratio.reported(digits),
            peaks[1].reported(acceleration),
            peaks[0].reported(acceleration)
        ),
        criterion: "the ratio of the rms deviations is above 1",
        verdict: ratio.above(1.0),
        why: "A flexible link stores part of the energy of an impact and returns it, which lowers the peak and prolongs the vibration.".into(),
        sources: e.ensembles(),
        ..statement("larger", "Sect. 6, Fig. 6c", "Case 4: the vibration amplitude is larger than in case 3.")
    }
}

fn higher_frequency_in_case_4(e: &Evidence) -> Statement {
    let [three, four] = loose(e, "deviation_frequency");
    let ratio = e
        .both()
        .mean_with(e.loose(), "deviation_frequency", |b, a| b / a);
    Statement {
        measured: format!(
            "half of the power of the deviation lies below {} in case 4 and {} in case 3; ratio {}.",
            four.reported(hertz),
            three.reported(hertz),
            ratio.reported(digits)
        ),
        criterion: "the ratio of these frequencies is above 1",
        verdict: ratio.above(1.0),
        why: "A flexible link in series with the contact lowers the frequency of the contact, but adds its own, higher frequencies.".into(),
        sources: e.ensembles(),
        ..statement("higher", "Sect. 6, Fig. 6c", "Case 4: the frequency is higher than in case 3.")
    }
}

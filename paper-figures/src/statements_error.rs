//! Statements about Fig. 5: the displacement error of the platform.

use crate::campaign::{Campaign, DURATION, FROM};
use crate::fig05::CLAIMED;
use crate::measures::AllMeasures;
use crate::numbers::Numbers;
use crate::runs::Recording;
use crate::signal::{peak, rms, smooth};
use crate::statement::Statement;
use plot::{digits, percent, si};

/// The statements.
pub fn statements(c: &Campaign, m: &AllMeasures, numbers: &mut Numbers) -> Vec<Statement> {
    vec![
        error_flexible(m),
        stiffness_matters(c, numbers),
        error_loose(c, m),
        clearance_matters(c, m, numbers),
        largest_in_case_4(m),
        composition(c, m, numbers),
        both_matter(m),
    ]
}

/// Within a factor of two of the paper's +-0.2 mm.
fn near_claim(error: f64) -> bool {
    (0.5..=2.0).contains(&(error / CLAIMED))
}

fn error_flexible(m: &AllMeasures) -> Statement {
    Statement {
        place: "Sect. 6, Fig. 5a",
        says: "Case 2: the positioning error along x is around ±0.2 mm.",
        measured: format!(
            "Largest |e_x| {} at h = {}, {} at h = {}.",
            si(m.flexible.error_peak, "m"), si(m.flexible.step, "s"), si(m.flexible_coarse.error_peak, "m"), si(m.flexible_coarse.step, "s")
        ),
        criterion: "between 0.1 and 0.4 mm",
        holds: near_claim(m.flexible.error_peak),
        factor: Some(m.flexible.error_peak / CLAIMED),
        why: "Pin-ended links move the platform only by changing their length, and E A / l2 is millions of newtons per metre: see the second argument below.".into(),
    }
}

fn stiffness_matters(c: &Campaign, numbers: &mut Numbers) -> Statement {
    // means over 20 ms: the answer without the start-up vibration
    let slow = |r: &Recording| {
        let width = (0.02 / r.plan.interval) as usize;
        peak(&smooth(r.between("error.x", FROM, DURATION).1, width))
    };
    let (soft, stiff) = (slow(&c.flexible_coarse), slow(&c.stiffer));
    let ratio = numbers.put("case2.error_ratio_of_ten_moduli", soft / stiff);
    Statement {
        place: "Sect. 6, Fig. 5a",
        says: "These errors are caused by the deformation of the passive links and influenced by their stiffness.",
        measured: format!(
            "With ten times the Young's modulus the error (means over 20 ms) falls from {} to {}, {} times (h = {}).",
            si(soft, "m"),
            si(stiff, "m"),
            digits(ratio),
            si(c.settings.coarse, "s")
        ),
        criterion: "the ratio is between 5 and 20",
        holds: (5.0..=20.0).contains(&ratio),
        factor: None,
        why: "Deformation under a load that hardly changes goes with 1/E.".into(),
    }
}

fn error_loose(c: &Campaign, m: &AllMeasures) -> Statement {
    let bound = c.geometry.largest_bound_x(2.0 * c.geometry.clearance);
    Statement {
        place: "Sect. 6, Fig. 5b",
        says: "Case 3: the errors along x are around ±0.2 mm.",
        measured: format!(
            "Largest |e_x| {} at h = {}; kinematic bound without penetration {}.",
            si(m.loose.error_peak, "m"),
            si(m.loose.step, "s"),
            si(bound, "m")
        ),
        criterion: "between 0.1 and 0.4 mm",
        holds: near_claim(m.loose.error_peak),
        factor: Some(m.loose.error_peak / CLAIMED),
        why: format!(
            "No motion of a mechanism with the printed dimensions can leave the bound, whatever its contact law: see the first argument below. The bound is {} of the claim.",
            digits(bound / CLAIMED)
        ),
    }
}

fn clearance_matters(c: &Campaign, m: &AllMeasures, numbers: &mut Numbers) -> Statement {
    let half = peak(c.tighter.between("error.x", FROM, DURATION).1);
    let ratio = numbers.put(
        "case3.error_ratio_of_half_clearance",
        m.loose.error_peak / half,
    );
    Statement {
        place: "Sect. 6, Fig. 5b",
        says: "These errors are influenced by the clearance size.",
        measured: format!(
            "Half the clearance gives {} instead of {}, {} times less (h = {}).",
            si(half, "m"),
            si(m.loose.error_peak, "m"),
            digits(ratio),
            si(c.tighter.plan.step, "s")
        ),
        criterion: "the ratio is between 1.5 and 2.5",
        holds: (1.5..=2.5).contains(&ratio),
        factor: None,
        why: "The mechanism rides on its bound, which is proportional to the clearance.".into(),
    }
}

fn largest_in_case_4(m: &AllMeasures) -> Statement {
    let others = m.flexible.error_peak.max(m.loose.error_peak);
    Statement {
        place: "Sect. 6, Fig. 5c",
        says: "Case 4 has the largest deviation.",
        measured: format!(
            "Largest |e_x|: case 2 {}, case 3 {}, case 4 {} (h = {}).",
            si(m.flexible.error_peak, "m"),
            si(m.loose.error_peak, "m"),
            si(m.both.error_peak, "m"),
            si(m.both.step, "s")
        ),
        criterion: "case 4 above cases 2 and 3",
        holds: m.both.error_peak > others,
        factor: None,
        why: format!(
            "Case 4 over the larger of the two: {}; the flexibility can only add the stretch of the links to what the clearance allows.",
            percent(m.both.error_peak / others - 1.0)
        ),
    }
}

fn composition(c: &Campaign, m: &AllMeasures, numbers: &mut Numbers) -> Statement {
    let (two, three, four) = (error(&c.flexible), error(&c.loose), error(&c.both));
    let width = (0.02 / c.settings.interval) as usize;
    let rest: Vec<f64> = (0..four.len())
        .map(|i| four[i] - two[i] - three[i])
        .collect();
    let share = numbers.put(
        "case4.error_not_composed",
        rms(&smooth(&rest, width)) / rms(&smooth(four, width)),
    );
    let sum = m.flexible.error_peak + m.loose.error_peak;
    Statement {
        place: "Sect. 6, Fig. 5c",
        says: "The error of case 4 can be seen as the composition of cases 2 and 3.",
        measured: format!("Means over 20 ms: e4 − e2 − e3 is {} of e4 (rms); the largest errors are {} and {} + {} (h = {}).", percent(share), si(m.both.error_peak, "m"), si(m.flexible.error_peak, "m"), si(m.loose.error_peak, "m"), si(m.both.step, "s")),
        criterion: "the rest is below 20 % and the largest error within 20 % of the sum",
        holds: share < 0.2 && (m.both.error_peak / sum - 1.0).abs() < 0.2,
        factor: None,
        why: "Means, because single impacts of two runs do not happen at the same instants. The sum is made up of the part of the clearance almost alone.".into(),
    }
}

fn error(recording: &Recording) -> &[f64] {
    recording.between("error.x", FROM, DURATION).1
}

fn both_matter(m: &AllMeasures) -> Statement {
    let (flexible, loose) = (
        m.flexible.error_peak / m.both.error_peak,
        m.loose.error_peak / m.both.error_peak,
    );
    Statement {
        place: "Sect. 6, 7",
        says: "Both link flexibility and joint clearance are important influence factors of the positioning accuracy.",
        measured: format!(
            "Share of the largest error of case 4: flexibility alone {}, clearance alone {} (h = {}).",
            percent(flexible),
            percent(loose),
            si(m.both.step, "s")
        ),
        criterion: "each above 10 %",
        holds: flexible > 0.1 && loose > 0.1,
        factor: None,
        why: "With the printed stiffness the links hardly stretch under the forces of this motion."
            .into(),
    }
}

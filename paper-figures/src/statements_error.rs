//! Statements about Fig. 5: the displacement error of the platform.

use crate::campaign::{DURATION, FROM};
use crate::evidence::{Evidence, statement};
use crate::fig05::CLAIMED;
use crate::interval::CriterionVerdict;
use crate::record::{BOTH, TIGHTER};
use crate::runs::CaseRecording;
use crate::signal::{peak, smooth};
use crate::statement::Statement;
use numbers::{digits, percent, si};

/// The statements.
pub fn statements(e: &Evidence) -> Vec<Statement> {
    vec![
        error_flexible(e),
        stiffness_matters(e),
        error_loose(e),
        clearance_matters(e),
        largest_in_case_4(e),
        composition(e),
        both_matter(e),
    ]
}

/// Limits within a factor of two of the paper's +-0.2 mm \[m\].
const NEAR: (f64, f64) = (0.5 * CLAIMED, 2.0 * CLAIMED);

fn metres(value: f64) -> String {
    si(value, "m")
}

fn error_flexible(e: &Evidence) -> Statement {
    let [fine, coarse] = [&e.flexible, &e.flexible_coarse].map(|m| m.get("error_peak"));
    Statement {
        measured: format!(
            "largest |e_x| {} at {}, {} at {}.",
            metres(fine),
            e.c.flexible.plan.pace.label(),
            metres(coarse),
            e.c.flexible_coarse.plan.pace.label()
        ),
        criterion: "between 0.1 and 0.4 mm",
        verdict: CriterionVerdict::of((NEAR.0..=NEAR.1).contains(&fine)),
        factor: Some(fine / CLAIMED),
        why: "Pin-ended links move the platform only by changing length, and they are too stiff for that: see the second argument below.".into(),
        sources: e.case_2(),
        ..statement("error 2", "Sect. 6, Fig. 5a", "Case 2: the positioning error along x is around ±0.2 mm.")
    }
}

fn stiffness_matters(e: &Evidence) -> Statement {
    // means over 20 ms: the answer without the start-up vibration
    let slow = |r: &CaseRecording| {
        let width = (0.02 / r.plan.interval) as usize;
        peak(&smooth(r.between("error.x", FROM, DURATION).1, width))
    };
    let (soft, stiff) = (slow(&e.c.flexible_coarse), slow(&e.c.stiffer));
    Statement {
        measured: format!(
            "with ten times the Young's modulus the largest 20 ms mean of e_x falls from {} to {}, by a factor of {}.",
            metres(soft),
            metres(stiff),
            digits(soft / stiff)
        ),
        criterion: "the ratio is between 5 and 20",
        verdict: CriterionVerdict::of((5.0..=20.0).contains(&(soft / stiff))),
        why: "Under a load that hardly changes, the deformation is proportional to 1/E.".into(),
        sources: vec![e.c.flexible_coarse.source(), e.c.stiffer.source()],
        ..statement(
            "stiffness",
            "Sect. 6, Fig. 5a",
            "These errors are caused by the deformation of the passive links and influenced by their stiffness.",
        )
    }
}

fn error_loose(e: &Evidence) -> Statement {
    let bound = e.c.geometry.largest_bound_x(2.0 * e.c.geometry.clearance);
    let error = e.loose().mean("error_peak");
    Statement {
        measured: format!(
            "largest |e_x| {}; the kinematic bound without penetration is {}.",
            error.reported(metres),
            metres(bound)
        ),
        criterion: "between 0.1 and 0.4 mm",
        verdict: error.within(NEAR.0, NEAR.1),
        factor: Some(error.mean / CLAIMED),
        why: format!(
            "No mechanism with the printed dimensions can exceed this bound by more than the penetration allows, whatever its contact law: see the first argument below. The bound is {} times the claimed value.",
            digits(bound / CLAIMED)
        ),
        sources: vec![e.loose().source()],
        ..statement(
            "error 3",
            "Sect. 6, Fig. 5b",
            "Case 3: the errors along x are around ±0.2 mm.",
        )
    }
}

fn clearance_matters(e: &Evidence) -> Statement {
    let half = e.e.ensemble(TIGHTER);
    let ratio = e.loose().mean_with(half, "error_peak", |a, b| a / b);
    Statement {
        measured: format!(
            "largest |e_x| with half the clearance {} instead of {}; the ratio is {}.",
            half.mean("error_peak").reported(metres),
            e.loose().mean("error_peak").reported(metres),
            ratio.reported(digits)
        ),
        criterion: "the ratio is between 1.5 and 2.5",
        verdict: ratio.within(1.5, 2.5),
        why:
            "The largest error reaches the kinematic bound, which is proportional to the clearance."
                .into(),
        sources: vec![e.loose().source(), half.source()],
        ..statement(
            "clearance",
            "Sect. 6, Fig. 5b",
            "These errors are influenced by the clearance size.",
        )
    }
}

fn largest_in_case_4(e: &Evidence) -> Statement {
    let flexible = e.flexible.get("error_peak");
    let ratio = e
        .both()
        .mean_with(e.loose(), "error_peak", |b, a| b / a.max(flexible));
    Statement {
        measured: format!(
            "largest |e_x|: case 2 {}, case 3 {}, case 4 {}; case 4 over the larger of the others {}.",
            metres(flexible),
            e.loose().mean("error_peak").reported(metres),
            e.both().mean("error_peak").reported(metres),
            ratio.reported(digits)
        ),
        criterion: "the ratio is above 1",
        verdict: ratio.above(1.0),
        why: "Flexibility adds the stretch of the links to what the clearance allows.".into(),
        sources: e.all_cases(),
        ..statement(
            "largest",
            "Sect. 6, Fig. 5c",
            "Case 4 has the largest deviation.",
        )
    }
}

fn composition(e: &Evidence) -> Statement {
    let flexible = e.flexible.get("error_peak");
    let rest = e.e.ensemble(BOTH).mean("not_composed");
    let sum = e
        .both()
        .mean_with(e.loose(), "error_peak", |b, a| b / (a + flexible));
    Statement {
        measured: format!(
            "20 ms means: e₄ − e₂ − e₃ is {} of e₄ (rms). The largest error of case 4 is {} times the sum of those of cases 2 and 3.",
            rest.reported(percent),
            sum.reported(digits)
        ),
        criterion: "the remainder is below 20 %, and the largest error is within 20 % of the sum",
        verdict: rest.below(0.2).and(sum.within(0.8, 1.2)),
        why: "Means are compared because the impacts of two runs happen at different instants. Almost all of the sum is due to the clearance.".into(),
        sources: e.all_cases(),
        ..statement("composition", "Sect. 6, Fig. 5c", "The error of case 4 can be seen as the composition of cases 2 and 3.")
    }
}

fn both_matter(e: &Evidence) -> Statement {
    let flexible = e.flexible.get("error_peak");
    let part = e.both().mean_of("error_peak", |b| flexible / b);
    let other = e.both().mean_with(e.loose(), "error_peak", |b, a| a / b);
    Statement {
        measured: format!(
            "largest error over that of case 4: {} with flexibility alone, {} with clearance alone.",
            part.reported(percent),
            other.reported(percent)
        ),
        criterion: "each above 10 %",
        verdict: part.above(0.1).and(other.above(0.1)),
        why: "With the printed stiffness the links hardly stretch under the forces of this motion."
            .into(),
        sources: e.all_cases(),
        ..statement(
            "both matter",
            "Sect. 6, 7",
            "Both link flexibility and joint clearance are important influence factors of the positioning accuracy.",
        )
    }
}

//! Statements of the abstract and of section 1: what flexibility and clearance do, and what methods are good for.

use crate::evidence::{Evidence, statement};
use crate::interval::CriterionVerdict;
use crate::methods::{HORIZON, explicit};
use crate::record::{Long, MethodWork};
use crate::runs::words;
use crate::statement::Statement;
use crate::warned::WarningSource;
use numbers::{digits, percent, si};

/// Errors at which work is compared, as parts of the largest error of the platform.
const LEVELS: [f64; 2] = [1e-2, 1e-4];
/// "Much" more work.
const MUCH: f64 = 2.0;
/// A run whose vibration has grown by this factor is unstable.
const GROWN: f64 = 1.5;

/// The statements.
pub fn statements(e: &Evidence) -> Vec<Statement> {
    vec![
        represents_well(e),
        flexibility_matters(e),
        vibration(e),
        high_modes(e),
        explicit_inefficient(e),
        explicit_fails(e),
        implicit_efficient(e),
        others_unstable(e),
        bathe_stable(e),
    ]
}

fn represents_well(e: &Evidence) -> Statement {
    let lost = [e.loose(), e.both()].map(|m| m.mean_of("energy_lost", f64::abs));
    Statement {
        measured: format!(
            "energy lost or gained by the integrator in three cycles, over the contact dissipation: case 3 {}, case 4 {}; in case 2, where nothing dissipates, over the largest elastic energy: {}. Runs of the figures with Bathe's method: case 3 {}, case 4 {}.",
            lost[0].reported(percent),
            lost[1].reported(percent),
            percent(e.flexible.get("energy_lost").abs()),
            percent(crate::measures::energy_lost(&e.c.loose).abs()),
            percent(crate::measures::energy_lost(&e.c.both).abs())
        ),
        criterion: "below 5 % of the contact dissipation in cases 3 and 4, so that the results are those of the model and not of the integrator",
        verdict: lost[0].below(0.05).and(lost[1].below(0.05)),
        why: "The paper compares with no measurement and no second code. A run can decide only whether the energy balance closes.".into(),
        sources: e.all_cases().into_iter().chain([e.c.loose.source(), e.c.both.source()]).collect(),
        ..statement("represents", "Abstract", "The methodology can represent the dynamic performances of the system with link flexibility and joint clearance well.")
    }
}

fn flexibility_matters(e: &Evidence) -> Statement {
    let share = e.flexible.get("deviation_share");
    let peak = e.both().mean_with(e.loose(), "force_peak", |b, a| b / a);
    Statement {
        measured: format!(
            "flexible links change the acceleration of the ideal mechanism by {} (rms, case 2). With clearance, the peak force with flexible links is {} times that with rigid links.",
            percent(share),
            peak.reported(digits)
        ),
        criterion: "both change by more than 10 %",
        verdict: CriterionVerdict::of(share > 0.1).and(peak.within(0.9, 1.1).not()),
        why: "The change of the acceleration is the undamped vibration of the start.".into(),
        sources: e.all_cases(),
        ..statement(
            "flexibility",
            "Sect. 1",
            "Link flexibility plays an important role in the dynamic performances of the mechanical system.",
        )
    }
}

fn vibration(e: &Evidence) -> Statement {
    let share = [e.loose(), e.both()].map(|m| m.mean("deviation_share"));
    let two = e.flexible.get("deviation_share");
    Statement {
        measured: format!(
            "rms deviation from the ideal acceleration over the rms of the latter: case 2 {}, case 3 {}, case 4 {}.",
            percent(two),
            share[0].reported(percent),
            share[1].reported(percent)
        ),
        criterion: "above 5 % in cases 2, 3 and 4",
        verdict: CriterionVerdict::of(two > 0.05)
            .and(share[0].above(0.05))
            .and(share[1].above(0.05)),
        why: "Noise is not part of the model.".into(),
        sources: e.all_cases(),
        ..statement(
            "vibration",
            "Sect. 1",
            "Joint clearances and link flexibility can cause vibration and noise.",
        )
    }
}

fn high_modes(e: &Evidence) -> Statement {
    let frequency = e.flexible.get("deviation_frequency");
    Statement {
        measured: format!(
            "half of the power of the vibration of case 2 lies above {}.",
            si(frequency, "Hz")
        ),
        criterion: "above 50 Hz, fifty times the frequency of the motion",
        verdict: CriterionVerdict::of(frequency > 50.0),
        why: "The platform vibrates on the stiffness of the links.".into(),
        sources: vec![e.c.flexible.source()],
        ..statement(
            "modes",
            "Sect. 1",
            "The deformation modes of the flexible multibody system with joint clearance are associated with high frequencies.",
        )
    }
}

/// The least work of a class of methods that gives an error below a part of the largest error, with this step and with
/// all shorter ones of the same method: a coarse step can be right by accident.
fn cheapest<'a>(
    e: &'a Evidence,
    case: u32,
    is_explicit: bool,
    level: f64,
) -> Option<&'a MethodWork> {
    let runs: Vec<&MethodWork> = e.e.work.iter().filter(|w| w.case == case).collect();
    let good = |w: &MethodWork| w.error.is_some_and(|error| error <= level * w.size);
    let reached = |w: &&&MethodWork| {
        let finer = runs
            .iter()
            .filter(|f| f.method == w.method && f.step <= w.step);
        explicit(&w.method) == is_explicit && finer.into_iter().all(|f| good(f))
    };
    runs.iter()
        .filter(reached)
        .min_by_key(|w| w.evaluations)
        .copied()
}

/// Explicit over implicit work at every level of both cases, in words, and the runs.
fn work(e: &Evidence) -> (Vec<f64>, String, Vec<WarningSource>) {
    let (mut ratios, mut text, mut sources) = (Vec::new(), Vec::new(), Vec::new());
    for case in [2, 4] {
        for level in LEVELS {
            let pair = [true, false].map(|x| cheapest(e, case, x, level));
            let [Some(one), Some(other)] = pair else {
                text.push(format!(
                    "case {case} at {}: not reached by both kinds of method",
                    percent(level)
                ));
                continue;
            };
            let ratio = one.evaluations as f64 / other.evaluations as f64;
            ratios.push(ratio);
            let reported = |w: &MethodWork| {
                format!(
                    "{} evaluations by {} with h = {}",
                    w.evaluations,
                    words(&w.method),
                    si(w.step, "s")
                )
            };
            text.push(format!(
                "case {case} at {}: {} against {}, ratio {}",
                percent(level),
                reported(one),
                reported(other),
                digits(ratio)
            ));
            sources.extend([one, other].map(source));
        }
    }
    (ratios, text.join("; "), sources)
}

fn source(w: &MethodWork) -> WarningSource {
    WarningSource {
        name: format!(
            "case {}, {} with h = {}",
            w.case,
            words(&w.method),
            si(w.step, "s")
        ),
        warnings: w.warnings.clone(),
    }
}

fn explicit_inefficient(e: &Evidence) -> Statement {
    let (ratios, text, sources) = work(e);
    Statement {
        measured: format!(
            "least number of evaluations of the elastic force with which an explicit and an implicit method keep the error of e_x over {} below the given part of its largest value: {text}.",
            si(HORIZON, "s")
        ),
        criterion: "\"can be\" requires one case and accuracy in which the best explicit method takes more than twice the work of the best implicit one",
        verdict: CriterionVerdict::of(ratios.iter().any(|r| *r > MUCH)),
        why: "The tangents and factorisations of the implicit methods are not counted, so the comparison favours them. ACCURACY.md compares processor times.".into(),
        sources,
        ..statement("explicit", "Sect. 1", "For such a system explicit integration methods can be very inefficient.")
    }
}

fn explicit_fails(e: &Evidence) -> Statement {
    let useless = |w: &MethodWork| w.error.is_none_or(|error| error > w.size);
    let explicit_runs: Vec<&MethodWork> = e.e.work.iter().filter(|w| explicit(&w.method)).collect();
    let steps = explicit_runs.iter().filter(|w| useless(w));
    let bathe_works = |w: &MethodWork| {
        let same = |b: &&MethodWork| b.method == "bathe" && b.case == w.case && b.step == w.step;
        let bathe = e.e.work.iter().find(same);
        bathe.is_some_and(|b| b.error.is_some_and(|error| error < 0.1 * b.size))
    };
    let failed: Vec<&MethodWork> = steps.copied().filter(|w| bathe_works(w)).collect();
    let reported: Vec<String> = failed.iter().map(|w| source(w).name).collect();
    Statement {
        measured: if reported.is_empty() {
            "no run of an explicit method stops or has an error of e_x above its largest value at a step at which the error of Bathe's method is below a tenth of it.".into()
        } else {
            format!(
                "runs that stop, or whose error of e_x exceeds its largest value, at a step at which the error of Bathe's method is below a tenth of it: {}.",
                reported.join("; ")
            )
        },
        criterion: "there is such a run",
        verdict: CriterionVerdict::of(!failed.is_empty()),
        why: "The step of an explicit method is bounded by the highest frequency of the model."
            .into(),
        sources: failed.iter().map(|w| source(w)).collect(),
        ..statement(
            "explicit fails",
            "Sect. 1",
            "Explicit integration methods can even fail.",
        )
    }
}

fn implicit_efficient(e: &Evidence) -> Statement {
    let (ratios, _, sources) = work(e);
    let reported: Vec<String> = ratios.iter().map(|r| digits(*r)).collect();
    Statement {
        measured: format!(
            "work of the best explicit method over that of the best implicit one, as in the statement on explicit methods: {}.",
            reported.join(", ")
        ),
        criterion: "above 2 in both cases at both accuracies",
        verdict: CriterionVerdict::of(ratios.len() == 4 && ratios.iter().all(|r| *r > MUCH)),
        why: "Stiff links and short impacts require steps, for accuracy, at which explicit methods are stable too.".into(),
        sources,
        ..statement("implicit", "Sect. 1", "For such a stiff system implicit integration methods are much more efficient than explicit methods.")
    }
}

/// What became of the vibration in long runs, in words.
fn grown(runs: &[&Long]) -> String {
    let reported: Vec<String> = runs
        .iter()
        .map(|l| {
            let (method, step) = (words(&l.method), si(l.step, "s"));
            format!(
                "{method} in case {} at h = {step}: {}",
                l.case,
                l.reported()
            )
        })
        .collect();
    reported.join("; ")
}

fn others_unstable(e: &Evidence) -> Statement {
    let others: Vec<&Long> = e.e.long.iter().filter(|l| l.method != "bathe").collect();
    let stays = others
        .iter()
        .map(|l| l.stays(GROWN))
        .fold(CriterionVerdict::Holds, CriterionVerdict::and);
    Statement {
        measured: format!(
            "rms deviation of the acceleration in the last cycle over that in the second, in runs of 34 cycles of case 2 and 10 cycles of case 4: {}. The trapezoidal rule is Newmark's method with constant average acceleration; generalised-α and HHT have a spectral radius of 0.8.",
            grown(&others)
        ),
        criterion: "\"may\" requires one run that stops, or whose vibration grows by more than half",
        verdict: stays.not(),
        why: "In case 4 the step is far too long to resolve the contacts; case 2 is nearly linear."
            .into(),
        sources: others.iter().map(|l| l.source()).collect(),
        ..statement(
            "others unstable",
            "Sect. 1",
            "The generalised-α, Newmark and HHT methods may become unstable for long time simulation.",
        )
    }
}

fn bathe_stable(e: &Evidence) -> Statement {
    let bathe: Vec<&Long> = e.e.long.iter().filter(|l| l.method == "bathe").collect();
    Statement {
        measured: format!("the same for Bathe's method: {}.", grown(&bathe)),
        criterion: "no run stops, and no vibration grows by more than half",
        verdict: bathe.iter().map(|l| l.stays(GROWN)).fold(CriterionVerdict::Holds, CriterionVerdict::and),
        why: "A coarse step damps the vibration away and does not resolve the contacts: see the warnings.".into(),
        sources: bathe.iter().map(|l| l.source()).collect(),
        ..statement("bathe stable", "Sect. 1", "Bathe's two-step method overcomes this limitation for long time durations.")
    }
}

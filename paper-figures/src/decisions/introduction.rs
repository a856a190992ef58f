//! Abstract and section 1: what flexibility and clearance do, and what methods are good for.

use super::{Decide, Decision, above, below, holds, within};
use crate::evidence::Evidence;
use crate::methods::{HORIZON, Long, MethodWork, explicit};
use crate::verdict::CriterionVerdict;
use minijinja::context;
use numbers::{digits, percent};

/// Errors at which work is compared, as parts of the largest error of the platform.
const LEVELS: [f64; 2] = [1e-2, 1e-4];
/// "Much" more work.
const MUCH: f64 = 2.0;
/// A run whose vibration has grown by this factor is unstable.
const GROWN: f64 = 1.5;

/// The predicates.
pub const DECISIONS: [Decide; 9] = [
    ("represents", |e| {
        let lost = e.means_of("energy_lost", f64::abs);
        let two = e.run("flexible", "energy_lost").abs();
        let figures = ["loose", "both"].map(|run| e.run(run, "energy_lost").abs());
        (below(&lost, 0.05), context! { lost, two, figures })
    }),
    ("flexibility", |e| {
        let share = e.run("flexible", "deviation_share");
        let peak = e.pairs("force_peak", |both, loose| both / loose);
        let changes = within(&peak, 0.9, 1.1).not();
        (changes.and(holds(share > 0.1)), context! { share, peak })
    }),
    ("vibration", |e| {
        let two = e.run("flexible", "deviation_share");
        let share = e.means("deviation_share");
        let verdict = above(&share, 0.05);
        (verdict.and(holds(two > 0.05)), context! { two, share })
    }),
    ("modes", |e| {
        let frequency = e.run("flexible", "deviation_frequency");
        (holds(frequency > 50.0), context! { frequency })
    }),
    ("explicit", |e| {
        let (ratios, text) = work(e);
        let verdict = holds(ratios.iter().any(|r| *r > MUCH));
        (verdict, context! { ratios, text, horizon => HORIZON })
    }),
    ("explicit fails", explicit_fails),
    ("implicit", |e| {
        let (ratios, _) = work(e);
        let met = ratios.len() == 4 && ratios.iter().all(|r| *r > MUCH);
        (holds(met), context! { ratios })
    }),
    ("others unstable", |e| {
        let (stays, values) = growth(&e.long(|method| method != "bathe"));
        (stays.not(), values)
    }),
    ("bathe stable", |e| {
        growth(&e.long(|method| method == "bathe"))
    }),
];

/// The least work of a class of methods that gives an error below a part of the largest error, with this step and with
/// all shorter ones of the same method: a coarse step can be right by accident.
fn cheapest<'a>(
    e: &'a Evidence,
    case: u32,
    is_explicit: bool,
    level: f64,
) -> Option<&'a MethodWork> {
    let runs: Vec<&MethodWork> = e.work().iter().filter(|w| w.case == case).collect();
    let good = |w: &MethodWork| w.error.is_some_and(|error| error <= level * w.size);
    let reached = |w: &&&MethodWork| {
        let same = runs.iter().filter(|f| f.method == w.method);
        explicit(&w.method) == is_explicit && same.into_iter().all(|f| f.step > w.step || good(f))
    };
    let reached = runs.iter().filter(reached);
    reached.min_by_key(|w| w.evaluations).copied()
}

/// Explicit over implicit work at every level of both cases, and in words.
fn work(e: &Evidence) -> (Vec<f64>, String) {
    let (mut ratios, mut text) = (Vec::new(), Vec::new());
    for (case, level) in [2, 4]
        .map(|case| LEVELS.map(|level| (case, level)))
        .concat()
    {
        let at = percent(level);
        let pair = [true, false].map(|explicit| cheapest(e, case, explicit, level));
        let [Some(one), Some(other)] = pair else {
            text.push(format!(
                "case {case} at {at}: not reached by both kinds of method"
            ));
            continue;
        };
        let ratio = one.evaluations as f64 / other.evaluations as f64;
        let words = |w: &MethodWork| format!("{} ({})", w.evaluations, w.name());
        let (first, second) = (words(one), words(other));
        text.push(format!(
            "at {at} {first} against {second}, ratio {}",
            digits(ratio)
        ));
        ratios.push(ratio);
        e.rests_on(one);
        e.rests_on(other);
    }
    (ratios, text.join("; "))
}

fn explicit_fails(e: &Evidence) -> Decision {
    let useless = |w: &&&MethodWork| w.error.is_none_or(|error| error > w.size);
    let bathe_works = |w: &&&MethodWork| {
        let same = |b: &&MethodWork| b.method == "bathe" && b.case == w.case && b.step == w.step;
        let error = e.work().iter().find(same).and_then(|b| b.error);
        error.is_some_and(|error| error < 0.1 * w.size)
    };
    let runs: Vec<&MethodWork> = e.work().iter().filter(|w| explicit(&w.method)).collect();
    let failed = runs.iter().filter(useless).filter(bathe_works);
    let failed: Vec<&&MethodWork> = failed.inspect(|w| e.rests_on(w)).collect();
    let failed: Vec<String> = failed.into_iter().map(|w| w.name()).collect();
    let verdict = holds(!failed.is_empty());
    (verdict, context! { failed, runs => runs.len() })
}

/// Whether no vibration of long runs grows.
fn growth(all: &[&Long]) -> Decision {
    let two = all.iter().filter(|l| l.case == 2).flat_map(|l| &l.growth);
    let values = context! {
        long => all.iter().map(|l| l.shown()).collect::<Vec<_>>(),
        stopped => all.iter().map(|l| l.stopped).sum::<usize>(),
        runs => all.iter().map(|l| l.runs).sum::<usize>(),
        largest => two.copied().fold(0.0, f64::max),
    };
    let verdict = CriterionVerdict::all(all.iter().map(|l| l.stays(GROWN)));
    (verdict, values)
}

//! Abstract and section 1: what flexibility and clearance do, and what methods are good for.

use super::{Decide, Decision};
use crate::evidence::Evidence;
use crate::methods::{Long, MODELS, MethodWork, explicit, model};
use crate::verdict::{above, all, below, holds, within};
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
        (below(&lost, 0.05), context! { lost })
    }),
    ("flexibility", |e| {
        let two = holds(e.run("flexible", "deviation_share") > 0.1);
        let peak = e.pairs("force_peak", |both, loose| both / loose);
        let changes = within(&peak, 0.9, 1.1).not();
        (changes.min(two), context! { peak })
    }),
    ("vibration", |e| {
        let two = holds(e.run("flexible", "deviation_share") > 0.05);
        above(&e.means("deviation_share"), 0.05).min(two).alone()
    }),
    ("modes", |e| {
        holds(e.run("flexible", "deviation_frequency") > 50.0).alone()
    }),
    ("explicit", |e| {
        let (ratios, text) = work(e);
        let verdict = holds(ratios.iter().any(|r| *r > MUCH));
        (verdict, context! { ratios, text })
    }),
    ("explicit fails", explicit_fails),
    ("implicit", |e| {
        let (ratios, _) = work(e);
        let met = ratios.len() == MODELS.len() * LEVELS.len() && ratios.iter().all(|r| *r > MUCH);
        (holds(met), context! { ratios })
    }),
    ("others unstable", |e| {
        let (stays, values) = growth(e, |method| method != "bathe");
        (stays.not(), values)
    }),
    ("bathe stable", |e| growth(e, |method| method == "bathe")),
];

/// The least work of a class of methods that gives an error below a part of the largest error, with this step and with
/// all shorter ones of the same method: a coarse step can be right by accident.
fn cheapest<'a>(
    e: &'a Evidence,
    (case, elements): (u32, usize),
    is_explicit: bool,
    level: f64,
) -> Option<&'a MethodWork> {
    let work = &e.ensembles().work;
    let runs = || {
        work.iter()
            .filter(|w| (w.case, w.elements) == (case, elements))
    };
    let good = |w: &MethodWork| w.error.is_some_and(|error| error <= level * w.size);
    let reached = |w: &&MethodWork| {
        let mut same = runs().filter(|f| f.method == w.method);
        explicit(&w.method) == is_explicit && same.all(|f| f.step > w.step || good(f))
    };
    runs().filter(reached).min_by_key(|w| w.evaluations)
}

/// Explicit over implicit work at every level of every model, and in words.
fn work(e: &Evidence) -> (Vec<f64>, String) {
    let (mut ratios, mut text) = (Vec::new(), Vec::new());
    for ((case, elements), level) in MODELS
        .map(|model| LEVELS.map(|level| (model, level)))
        .concat()
    {
        let at = percent(level);
        let pair = [true, false].map(|explicit| cheapest(e, (case, elements), explicit, level));
        let [Some(one), Some(other)] = pair else {
            let model = model(case, elements);
            text.push(format!(
                "{model} at {at}: not reached by both kinds of method"
            ));
            continue;
        };
        let ratio = one.evaluations as f64 / other.evaluations as f64;
        let [first, second] = [one, other].map(|w| format!("{} ({})", w.evaluations, w.name()));
        let ratio_at = digits(ratio);
        text.push(format!(
            "at {at} {first} against {second}, ratio {ratio_at}"
        ));
        ratios.push(ratio);
    }
    (ratios, text.join("; "))
}

fn explicit_fails(e: &Evidence) -> Decision {
    let all = &e.ensembles().work;
    let useless = |w: &&&MethodWork| w.error.is_none_or(|error| error > w.size);
    let bathe_works = |w: &&&MethodWork| {
        let same = |b: &&MethodWork| {
            b.method == "bathe" && (b.case, b.elements, b.step) == (w.case, w.elements, w.step)
        };
        let error = all.iter().find(same).and_then(|b| b.error);
        error.is_some_and(|error| error < 0.1 * w.size)
    };
    let runs: Vec<&MethodWork> = all.iter().filter(|w| explicit(&w.method)).collect();
    let failed = runs.iter().filter(useless).filter(bathe_works);
    let failed: Vec<String> = failed.map(|w| w.name()).collect();
    let verdict = holds(!failed.is_empty());
    (verdict, context! { failed, runs => runs.len() })
}

/// Whether no vibration of long runs with some methods grows.
fn growth(e: &Evidence, wanted: fn(&str) -> bool) -> Decision {
    let long = e.ensembles().long.iter().filter(|l| wanted(&l.method));
    let long: Vec<&Long> = long.collect();
    let two = long.iter().filter(|l| l.case == 2).flat_map(|l| &l.growth);
    let values = context! {
        long => long.iter().map(|l| l.shown()).collect::<Vec<_>>(),
        stopped => long.iter().map(|l| l.stopped).sum::<usize>(),
        runs => long.iter().map(|l| l.runs).sum::<usize>(),
        largest => two.copied().fold(0.0, f64::max),
    };
    (all(long.iter().map(|l| l.stays(GROWN))), values)
}

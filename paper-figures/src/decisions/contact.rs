//! Figs. 7 to 9 and the conclusions: forces, contact, periodicity.

use super::{Decide, above, below, holds, within};
use crate::ensembles::{RETARDATIONS, damped_name};
use crate::evidence::Evidence;
use crate::figures::PERIODS;
use crate::measures::{PEAKS, SIMULTANEOUS};
use crate::runs::{DURATION, FROM};
use crate::verdict::CriterionVerdict;
use minijinja::{Value, context};
use std::collections::BTreeMap;

/// Cycles further apart than this fraction of their amplitude do not repeat.
const REPEATS: f64 = 0.01;
/// A motion is chaotic if neighbours part faster than e-fold in a cycle of one second \[1/s\].
const CHAOTIC: f64 = 1.0;

/// The predicates.
pub const DECISIONS: [Decide; 11] = [
    ("same phenomena", |e| {
        let (ripple, first) = grows(e, "force_ripple");
        let (frequency, second) = grows(e, "force_frequency");
        (first.and(second), context! { ripple, frequency })
    }),
    ("simultaneous", |e| {
        let (one, any) = (e.means("peaks_with_b1"), e.means("peaks_with_any"));
        let chance = PEAKS as f64 * 2.0 * SIMULTANEOUS / (DURATION - FROM);
        let values = context! { one, any, chance, peaks => PEAKS, reach => SIMULTANEOUS };
        (above(&any, 0.9), values)
    }),
    ("enlarged", |e| {
        let [one, two] = ["ideal", "flexible"].map(|run| e.run(run, "force_peak"));
        let [rigid, flexible] = [one, two].map(|one| e.means_of("force_peak", |f| f / one));
        let verdict = above(&[rigid, flexible].concat(), 1.5);
        (verdict, context! { one, two, rigid, flexible })
    }),
    ("service life", |e| {
        let [rigid, flexible] = ["ideal", "flexible"].map(|run| {
            let reference = e.run(run, "force_cubic_mean");
            e.means_of("force_cubic_mean", |load| (load / reference).powi(-3))
        });
        let verdict = below(&[rigid, flexible].concat(), 0.9);
        (verdict, context! { rigid, flexible })
    }),
    ("sign", |e| {
        let all = [3, 4].map(|case| e.chaotic(case).values("force_only_in_contact"));
        let all = all.concat();
        let share = all.into_iter().fold(1.0, f64::min);
        (holds(share == 1.0), context! { share })
    }),
    ("mostly in contact", |e| {
        let (first, least) = (e.means("contact_b1"), e.means("contact_least"));
        (above(&least, 0.5), context! { first, least })
    }),
    ("periodic", |e| {
        let repetition = e.steps("repetition");
        let met = repetition.iter().all(|r| *r < REPEATS);
        let values = context! {
            repetition, periods => PERIODS, times => RETARDATIONS,
            spread => ["flexible, many periods", "coarse, many periods"].map(|run| e.run(run, "spread")),
            quiet => e.single("quasi-static start", "repetition"),
            damped => RETARDATIONS.map(|time| e.single(&damped_name(time), "repetition")),
        };
        (holds(met), values)
    }),
    ("not periodic", |e| {
        let distance = e.means("repetition");
        let spread = ["loose, many periods", "both, many periods"].map(|run| e.run(run, "spread"));
        let values = context! { distance, spread, periods => PERIODS };
        (above(&distance, REPEATS), values)
    }),
    ("chaotic", |e| {
        let of = |case: u32| {
            e.exponents(case)
                .into_iter()
                .map(|x| (x.distance, x.mean()))
        };
        let rows = |case: u32| of(case).map(|(d, rate)| context! { distance => d, rate });
        let rates: BTreeMap<u32, Vec<Value>> =
            [2, 3, 4].map(|case| (case, rows(case).collect())).into();
        let means = |case: u32| of(case).map(|(_, rate)| rate).collect::<Vec<_>>();
        let above = above(&[means(3), means(4)].concat(), CHAOTIC);
        (above.and(below(&means(2), CHAOTIC)), context! { rates })
    }),
    ("smoother", |e| {
        let flexible = e.steps("deviation_peak");
        let larger = flexible[0].max(flexible[1]);
        let [ratio, _] = e.means_of("deviation_peak", |peak| larger / peak);
        let values = context! { flexible, ratio, loose => e.chaotic(3).mean("deviation_peak") };
        (below(&[ratio], 0.5), values)
    }),
    ("nonlinear", |e| {
        let two = e.run("flexible", "deviation_rms");
        let ratio = e.pairs("deviation_rms", |both, loose| both / two.hypot(loose));
        let values = context! { two, ratio, rms => e.means("deviation_rms") };
        (within(&ratio, 0.9, 1.1).not(), values)
    }),
];

/// A measure of cases 2, 3 and 4, and whether it grows from each to the next.
fn grows(e: &Evidence, measure: &str) -> (Vec<Value>, CriterionVerdict) {
    let two = e.run("flexible", measure);
    let [three, four] = e.means(measure);
    let ratio = e.pairs(measure, |both, loose| both / loose);
    let shown = vec![
        Value::from(two),
        Value::from_serialize(three),
        Value::from_serialize(four),
    ];
    let larger = above(&[three], two);
    (shown, larger.and(above(&[ratio], 1.0)))
}

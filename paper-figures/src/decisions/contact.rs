//! Figs. 7 to 9 and the conclusions: forces, contact, periodicity.

use super::Decide;
use crate::ensembles::{RETARDATIONS, damped_name};
use crate::evidence::Evidence;
use crate::verdict::{CriterionVerdict, above, below, holds, within};
use minijinja::{Value, context};
use std::collections::BTreeMap;

/// Cycles further apart than this fraction of their amplitude do not repeat.
const REPEATS: f64 = 0.01;
/// A motion is chaotic if neighbours part faster than e-fold in a cycle of one second \[1/s\].
const CHAOTIC: f64 = 1.0;

/// The predicates.
pub const DECISIONS: [Decide; 11] = [
    ("same phenomena", |e| {
        let verdict = grows(e, "force_ripple").min(grows(e, "force_frequency"));
        verdict.alone()
    }),
    ("simultaneous", |e| {
        above(&e.means("peaks_with_any"), 0.9).alone()
    }),
    ("enlarged", |e| {
        let [rigid, flexible] = ["ideal", "flexible"].map(|run| {
            let reference = e.run(run, "force_peak");
            e.means_of("force_peak", |force| force / reference)
        });
        let verdict = above(&[rigid, flexible].concat(), 1.5);
        (verdict, context! { rigid, flexible })
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
        let shares = e.both("force_only_in_contact").into_iter();
        let share = shares.fold(1.0, f64::min);
        (holds(share == 1.0), context! { share })
    }),
    ("mostly in contact", |e| {
        above(&e.means("contact_least"), 0.5).alone()
    }),
    ("periodic", |e| {
        let met = e.steps("repetition").iter().all(|r| *r < REPEATS);
        let damped = RETARDATIONS.map(|time| e.single(&damped_name(time), "repetition"));
        (holds(met), context! { damped, times => RETARDATIONS })
    }),
    ("not periodic", |e| {
        above(&e.means("repetition"), REPEATS).alone()
    }),
    ("chaotic", |e| {
        let of = |case: u32| e.ensembles().exponents(case);
        let rows = |case: u32| {
            let rows = of(case).map(|x| context! { distance => x.distance, rate => x.mean() });
            (case, rows.collect())
        };
        let rates: BTreeMap<u32, Vec<Value>> = [2, 3, 4].map(rows).into();
        let means = |case: u32| of(case).map(|x| x.mean()).collect::<Vec<_>>();
        let above = above(&[means(3), means(4)].concat(), CHAOTIC);
        (above.min(below(&means(2), CHAOTIC)), context! { rates })
    }),
    ("smoother", |e| {
        let [fine, coarse] = e.steps("deviation_peak");
        let [ratio, _] = e.means_of("deviation_peak", |peak| fine.max(coarse) / peak);
        (below(&[ratio], 0.5), context! { ratio })
    }),
    ("nonlinear", |e| {
        let two = e.run("flexible", "deviation_rms");
        let ratio = e.pairs("deviation_rms", |both, loose| both / two.hypot(loose));
        (within(&ratio, 0.9, 1.1).not(), context! { ratio })
    }),
];

/// Whether a measure grows from case 2 to 3 and from 3 to 4.
fn grows(e: &Evidence, measure: &str) -> CriterionVerdict {
    let [three, _] = e.means(measure);
    let ratio = e.pairs(measure, |both, loose| both / loose);
    above(&[three], e.run("flexible", measure)).min(above(&[ratio], 1.0))
}

//! Figs. 5 and 6: displacement error and acceleration of the platform.

use super::{Decide, above, below, between, holds, within};
use crate::ensembles::{BOTH, TIGHTER};
use crate::measures::{AFTER_ONSET, PEAKS};
use crate::pictures::CLAIMED;
use crate::verdict::CriterionVerdict;
use minijinja::context;
use statistics::Interval;

/// Within a factor of two of the paper's +-0.2 mm \[m\].
const NEAR: (f64, f64) = (0.5 * CLAIMED, 2.0 * CLAIMED);

/// The predicates.
pub const DECISIONS: [Decide; 14] = [
    ("error 2", |e| {
        let [fine, coarse] = e.steps("error_peak");
        let values = context! { fine, coarse, claimed => CLAIMED };
        (between(fine, NEAR.0, NEAR.1), values)
    }),
    ("stiffness", |e| {
        let [soft, stiff] = ["slow_error", "slow_error_stiffer"].map(|name| e.number(name));
        let _ = ["coarse", "stiffer"].map(|run| e.run(run, "error_peak"));
        (between(soft / stiff, 5.0, 20.0), context! { soft, stiff })
    }),
    ("error 3", |e| {
        let error = e.chaotic(3).mean("error_peak");
        let values = context! { error, claimed => CLAIMED, bound => e.number("bound") };
        (within(&error, NEAR.0, NEAR.1), values)
    }),
    ("clearance", |e| {
        let (whole, half) = (e.chaotic(3), e.ensemble(TIGHTER));
        let pairs = whole
            .values("error_peak")
            .iter()
            .zip(half.values("error_peak"));
        let ratio = Interval::of(&pairs.map(|(a, b)| a / b).collect::<Vec<f64>>());
        let [whole, half] = [whole, half].map(|ensemble| ensemble.mean("error_peak"));
        (within(&ratio, 1.5, 2.5), context! { whole, half, ratio })
    }),
    ("largest", |e| {
        let two = e.run("flexible", "error_peak");
        let ratio = e.pairs("error_peak", |both, loose| both / loose.max(two));
        let values = context! { two, ratio, error => e.means("error_peak") };
        (above(&[ratio], 1.0), values)
    }),
    ("composition", |e| {
        let two = e.run("flexible", "error_peak");
        let rest = e.ensemble(BOTH).mean("not_composed");
        let sum = e.pairs("error_peak", |both, loose| both / (loose + two));
        let verdict = below(&[rest], 0.2);
        (verdict.and(within(&sum, 0.8, 1.2)), context! { rest, sum })
    }),
    ("both matter", |e| {
        let two = e.run("flexible", "error_peak");
        let [_, part] = e.means_of("error_peak", |both| two / both);
        let other = e.pairs("error_peak", |both, loose| loose / both);
        (above(&[part, other], 0.1), context! { part, other })
    }),
    ("very different", |e| {
        let [fine, coarse] = e.steps("deviation_share");
        let share = e.means("deviation_share");
        let verdict = above(&share, 0.25);
        let values = context! { fine, coarse, share };
        (verdict.and(holds(fine > 0.25)), values)
    }),
    ("slightly", |e| {
        let share = e.steps("deviation_share");
        let verdict = CriterionVerdict::all(share.map(|s| between(s, 0.01, 0.25)));
        (verdict, context! { share })
    }),
    ("high frequency", |e| {
        let frequency = e.means("deviation_frequency");
        (above(&frequency, 50.0), context! { frequency })
    }),
    ("by impacts", |e| {
        let share = e.chaotic(3).mean("peaks_after_onset");
        let chance = e.chaotic(3).mean("after_onset_by_chance");
        let values = context! { share, chance, peaks => PEAKS, after => AFTER_ONSET };
        (above(&[share], 0.9), values)
    }),
    ("unstable", |e| {
        let growth = e.means("settling");
        // one is enough
        let [three, four] = growth.map(|growth| above(&[growth], 1.5));
        (three.not().and(four.not()).not(), context! { growth })
    }),
    ("larger", |e| {
        let ratio = e.pairs("deviation_rms", |both, loose| both / loose);
        let (rms, peaks) = (e.means("deviation_rms"), e.means("deviation_peak"));
        (above(&[ratio], 1.0), context! { ratio, rms, peaks })
    }),
    ("higher", |e| {
        let ratio = e.pairs("deviation_frequency", |both, loose| both / loose);
        let values = context! { ratio, frequency => e.means("deviation_frequency") };
        (above(&[ratio], 1.0), values)
    }),
];

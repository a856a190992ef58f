//! Figs. 5 and 6: displacement error and acceleration of the platform.

use super::Decide;
use crate::ensembles::{BOTH, TIGHTER};
use crate::pictures::CLAIMED;
use crate::verdict::{above, all, below, between, holds, within};
use minijinja::context;

/// Within a factor of two of the paper's +-0.2 mm \[m\].
const NEAR: (f64, f64) = (0.5 * CLAIMED, 2.0 * CLAIMED);

/// The predicates.
pub const DECISIONS: [Decide; 14] = [
    ("error 2", |e| {
        between(e.run("flexible", "error_peak"), NEAR.0, NEAR.1).alone()
    }),
    ("stiffness", |e| {
        let ratio = e.number("slow_error") / e.number("slow_error_stiffer");
        between(ratio, 5.0, 20.0).alone()
    }),
    ("error 3", |e| {
        let error = e.chaotic(3).mean("error_peak");
        within(&error, NEAR.0, NEAR.1).alone()
    }),
    ("clearance", |e| {
        let (whole, half) = (e.chaotic(3), e.ensembles().ensemble(TIGHTER));
        let ratio = whole.pairs(half, "error_peak", |whole, half| whole / half);
        let [whole, half] = [whole, half].map(|ensemble| ensemble.mean("error_peak"));
        (within(&ratio, 1.5, 2.5), context! { whole, half, ratio })
    }),
    ("largest", |e| {
        let two = e.run("flexible", "error_peak");
        let ratio = e.pairs("error_peak", |both, loose| both / loose.max(two));
        (above(&[ratio], 1.0), context! { ratio })
    }),
    ("composition", |e| {
        let two = e.run("flexible", "error_peak");
        let rest = e.ensembles().ensemble(BOTH).mean("not_composed");
        let sum = e.pairs("error_peak", |both, loose| both / (loose + two));
        let verdict = below(&[rest], 0.2);
        (verdict.min(within(&sum, 0.8, 1.2)), context! { rest, sum })
    }),
    ("both matter", |e| {
        let two = e.run("flexible", "error_peak");
        let [_, part] = e.means_of("error_peak", |both| two / both);
        let other = e.pairs("error_peak", |both, loose| loose / both);
        (above(&[part, other], 0.1), context! { part, other })
    }),
    ("very different", |e| {
        let two = holds(e.run("flexible", "deviation_share") > 0.25);
        above(&e.means("deviation_share"), 0.25).min(two).alone()
    }),
    ("slightly", |e| {
        let shares = e.steps("deviation_share");
        all(shares.map(|share| between(share, 0.01, 0.25))).alone()
    }),
    ("high frequency", |e| {
        above(&e.means("deviation_frequency"), 50.0).alone()
    }),
    ("by impacts", |e| {
        above(&[e.chaotic(3).mean("peaks_after_onset")], 0.9).alone()
    }),
    ("unstable", |e| {
        // one is enough
        let [three, four] = e.means("settling").map(|growth| above(&[growth], 1.5));
        three.max(four).alone()
    }),
    ("larger", |e| {
        let ratio = e.pairs("deviation_rms", |both, loose| both / loose);
        (above(&[ratio], 1.0), context! { ratio })
    }),
    ("higher", |e| {
        let ratio = e.pairs("deviation_frequency", |both, loose| both / loose);
        (above(&[ratio], 1.0), context! { ratio })
    }),
];

//! The tangent of a stage, kept while Newton's method converges fast with it.
//!
//! From stage to stage the tangent changes little: bodies turn, contacts stiffen. With an earlier tangent Newton's method
//! converges linearly; the ratio of successive updates is measured and kept with the tangent. Where it is known, the first
//! update already tells the error that it leaves, as in the simplified Newton method of implicit Runge-Kutta codes (Hairer &
//! Wanner 1996, Solving Ordinary Differential Equations II, IV.8). A tangent ages: until it is measured again, the ratio is taken to
//! grow in proportion to the number of stages that the tangent has served.
//!
//! In a stiff mesh rounding can keep updates above the tolerance. The size at which they stop decreasing, relative to a simple estimate
//! of rounding, is kept as well: later stages stop at updates of this size.

use super::factors::Factors;
use crate::checkpoint::{Carried, Checkpoint, carried};
use crate::math::lu::Symbolic;
use crate::system::Weights;

/// A tangent with a larger ratio of updates is renewed before the next stage.
const LARGEST_RATIO: f64 = 0.003;
/// A smaller ratio is rounding.
const LEAST_RATIO: f64 = 1e-3;
/// A smaller curvature is chance: that of links of a tenth of a metre \[1/m\].
const LEAST_CURVATURE: f64 = 10.0;
/// Growth of what is taken for the curvature from stage to stage, until it is measured again.
const AGEING: f64 = 1.1;
/// Updates below this multiple of the remembered rounding count as rounding, too.
const ROUNDING_BAND: f64 = 2.0;
/// The remembered rounding shrinks by this factor with every stage that the tangent serves, until it is met again.
const FADING: f64 = 0.99;
/// Largest relative difference of the weight of q from that of the tangent.
const SAME_WEIGHT: f64 = 0.2;

/// A tangent and how fast Newton's method converges with it.
#[derive(Debug)]
pub(super) struct Tangent {
    pub factors: Factors,
    record: TangentRecord,
}

/// What is known of a tangent.
#[derive(Debug, Clone, Copy, Default)]
struct TangentRecord {
    /// The weight of q in its stage; zero if there is none.
    weight: f64,
    /// Ratio of successive updates, where it is known.
    ratio: Option<f64>,
    /// Its growth with every stage.
    growth: f64,
    /// Stages that it has served.
    age: f64,
    /// What the first update with a new tangent leaves, over w.q/w.v times its square \[1/m\], where it is known.
    curvature: Option<f64>,
    /// Size of updates that no longer decreased, over the estimate of rounding; zero if there were none.
    rounding: f64,
}

carried!(TangentRecord { weight, ratio, growth, age, curvature, rounding } but {});

/// True for a ratio of updates with which a tangent may go on serving.
pub(super) fn is_fast(ratio: f64) -> bool {
    ratio <= LARGEST_RATIO
}

impl Tangent {
    pub fn new(symbolic: &Symbolic) -> Tangent {
        Tangent {
            factors: Factors::new(symbolic),
            record: TangentRecord::default(),
        }
    }

    pub fn carry(&mut self, symbolic: &Symbolic, checkpoint: &mut Checkpoint) {
        self.factors.carry(symbolic, checkpoint);
        self.record.carry(checkpoint);
    }

    /// How far its weight is from that of a stage, relative to the latter.
    pub fn distance(&self, w: Weights) -> f64 {
        (self.record.weight / w.q - 1.0).abs()
    }

    /// True where its weight is close enough to that of a stage.
    pub fn fits(&self, w: Weights) -> bool {
        self.distance(w) <= SAME_WEIGHT
    }

    /// True where it may serve a stage.
    pub fn serves(&self, w: Weights) -> bool {
        self.fits(w) && self.record.ratio.is_none_or(is_fast)
    }

    /// It has been factorised for a stage.
    pub fn renewed(&mut self, w: Weights) {
        self.record = TangentRecord {
            weight: w.q,
            curvature: self.record.curvature,
            rounding: self.record.rounding,
            ..TangentRecord::default()
        };
    }

    /// It must not serve another stage: it failed, or a contact has changed.
    pub fn discard(&mut self) {
        self.record = TangentRecord::default();
    }

    /// The ratio of updates that is expected of a stage. Another weight adds its relative difference at most.
    pub fn ratio(&self, w: Weights) -> Option<f64> {
        let added = self.distance(w);
        self.record.ratio.map(|ratio| ratio + added)
    }

    /// What the first update of this size with a new tangent leaves, where that is known.
    pub fn left(&self, w: Weights, update: f64) -> Option<f64> {
        let square = update * update * w.q / w.v;
        self.record.curvature.map(|curvature| curvature * square)
    }

    /// True for an update of the size at which updates of earlier stages stopped decreasing, given the estimate of rounding.
    pub fn is_known_rounding(&self, update: f64, rounding: f64) -> bool {
        update < ROUNDING_BAND * self.record.rounding * rounding
    }

    /// Updates of this size no longer decrease, although the tangent is new: they are rounding.
    pub fn remember_rounding(&mut self, update: f64, rounding: f64) {
        self.record.rounding = update / rounding;
    }

    /// The first update with a new tangent was followed by a second one.
    pub fn measure(&mut self, w: Weights, [first, second]: [f64; 2]) {
        let curvature = second / (first * first * w.q / w.v);
        self.record.curvature = Some(curvature.max(LEAST_CURVATURE));
    }

    /// A stage has been solved with it; `ratio` is that of its updates, if there were two.
    pub fn served(&mut self, ratio: Option<f64>) {
        let record = &mut self.record;
        record.age += 1.0;
        record.curvature = record.curvature.map(|curvature| AGEING * curvature);
        record.rounding *= FADING;
        match ratio {
            Some(ratio) => {
                let ratio = ratio.max(LEAST_RATIO);
                record.ratio = Some(ratio);
                record.growth = ratio / record.age;
            }
            None => record.ratio = record.ratio.map(|ratio| ratio + record.growth),
        }
    }
}

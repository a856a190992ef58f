//! Constraints Phi(t, q) = 0, one kind a file: values, gradients, multiplier forces, rates.

mod align;
mod clamp_slope;
mod coincide;
mod length;
mod place;
mod slide;

pub use align::Align;
pub use clamp_slope::ClampSlope;
pub use coincide::Coincide;
pub use length::Length;
pub use place::Place;
pub use slide::Slide;

use crate::effect::Effect;
use crate::math::plane::Vec2;
use crate::motion::Knot;
use crate::system::State;

/// Most coordinates that one constraint depends on: a point on a body or a chord, a line through a node along a chord.
pub const WIDTH: usize = 12;

/// Most rows of one constraint.
pub const ROWS: usize = 2;

/// Phi_q in local columns, row by row.
pub type Gradient = [[f64; WIDTH]; ROWS];

/// Takes d(Phi_q^T lambda)/dq, entry by entry, to its place in the tangent.
#[derive(Debug)]
pub struct Curvature<'a> {
    /// Slots of the local matrix, row by row.
    pub slots: &'a [u32],
    /// Number of local columns.
    pub columns: usize,
    /// Weight of q in the tangent.
    pub weight: f64,
    /// The tangent.
    pub tangent: &'a mut [f64],
}

impl Curvature<'_> {
    /// Adds to entry (row, column).
    #[inline]
    pub fn add(&mut self, row: usize, column: usize, value: f64) {
        let slot = self.slots[row * self.columns + column] as usize;
        self.tangent[slot] += self.weight * value;
    }
}

/// One or two equations between coordinates and time.
///
/// Local columns are in the order of [`Constraint::coordinates`], which may name a coordinate twice; what belongs to it
/// is then the sum.
pub trait Constraint: std::fmt::Debug + Send + Sync {
    /// What it is counted as.
    fn effect(&self) -> Effect;
    /// Unit of Phi.
    fn unit(&self) -> &'static str {
        "m"
    }
    /// Number of rows, 1 or 2.
    fn rows(&self) -> usize;
    /// The coordinates in local order: those of its first side, then those of its second.
    fn sides(&self) -> [Vec<usize>; 2];
    /// The coordinates of both sides.
    fn coordinates(&self) -> Vec<usize> {
        self.sides().concat()
    }
    /// Phi, and Phi_q into `gradient`, of which the columns that the constraint has are overwritten.
    fn value_and_gradient(&self, at: &State, gradient: &mut Gradient) -> [f64; ROWS];
    /// Phi.
    fn value(&self, at: &State) -> [f64; ROWS] {
        self.value_and_gradient(at, &mut [[0.0; WIDTH]; ROWS])
    }
    /// Phi_q.
    fn gradient(&self, at: &State) -> Gradient {
        let mut gradient = [[0.0; WIDTH]; ROWS];
        self.value_and_gradient(at, &mut gradient);
        gradient
    }
    /// d(Phi_q^T lambda)/dq.
    fn curvature(&self, at: &State, lambda: [f64; ROWS], out: &mut Curvature);
    /// d(Phi)/dt = Phi_q v + Phi_t.
    fn velocity(&self, at: &State) -> [f64; ROWS];
    /// d2(Phi)/dt2, with the accelerations in `at`.
    fn acceleration(&self, at: &State) -> [f64; ROWS];
    /// Phi_t of its first row, the only one that may depend on time itself.
    fn drift(&self, _at: &State) -> f64 {
        0.0
    }
    /// Where its functions of time are not smooth, up to a time \[s\].
    fn knots(&self, _until: f64) -> Vec<Knot> {
        Vec::new()
    }
    /// True in the second zero of an angle, half a turn off.
    fn half_turn(&self, _at: &State) -> bool {
        false
    }
    /// Force of the first side on the second \[N\]; zero for a constraint of directions.
    fn force(&self, _at: &State, _lambda: [f64; ROWS]) -> Vec2 {
        Vec2::zeros()
    }
    /// Couple of the first side on the second \[N m\]; zero for a constraint of points.
    fn couple(&self, _at: &State, _lambda: [f64; ROWS]) -> f64 {
        0.0
    }
}

//! Statically indeterminate mechanisms: of all multipliers that balance the forces, those whose reactions have the least norm.
//!
//! Rows w with w^T Phi_q = 0 may be added to the multipliers in any amounts. The reactions are linear in the multipliers, so the
//! amounts are a linear least-squares problem in as many unknowns as there are redundant rows.

use crate::compile::assembly::constraint_rows;
use crate::initial::unit_lengths;
use crate::math::independent_rows::IndependentRows;
use crate::math::sparse_rows::SparseRow;
use crate::model::Model;
use crate::system::{State, Work};
use faer::Mat;

/// Changes of reactions below this part of the largest are none, and so are singular values: what makes rows dependent elsewhere.
const RANK: f64 = 1e-9;

/// Gives an equilibrium the multipliers of the least reactions, torques divided by the length of the mechanism \[m\]. Returns the joints
/// whose reactions are not determined by the balance of forces.
pub(super) fn least_reactions(
    model: &Model,
    length: f64,
    at: &mut State,
    work: &mut Work,
) -> Vec<usize> {
    let self_stresses = self_stresses(model, at);
    let given = reactions(model, length, at, work);
    let largest = at.lambda.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    // of the size of the multipliers, for the sake of rounding
    let unit = if largest > 0.0 { largest } else { 1.0 };
    let balanced = at.lambda.clone();
    let mut changes = Mat::zeros(given.len(), self_stresses.len());
    for (k, stress) in self_stresses.iter().enumerate() {
        let shifted = balanced.iter().zip(stress).map(|(x, w)| x + unit * w);
        at.lambda.splice(.., shifted);
        let changed = reactions(model, length, at, work).into_iter().zip(&given);
        for (i, (changed, given)) in changed.enumerate() {
            changes[(i, k)] = (changed - given) / unit;
        }
    }
    at.lambda.copy_from_slice(&balanced);
    // of what is not finite nothing is claimed, and the row says so
    let Some(amounts) = least_squares(&changes, &given) else {
        return Vec::new();
    };
    for (amount, stress) in amounts.iter().zip(&self_stresses) {
        let stressed = at.lambda.iter_mut().zip(stress);
        stressed.for_each(|(x, w)| *x -= amount * w);
    }
    let entries = |joint: usize| (3 * joint..3 * joint + 3).flat_map(|i| changes.row(i).iter());
    let most = |joint: usize| entries(joint).fold(0.0_f64, |m, x| m.max(x.abs()));
    let greatest = (0..model.joints().len()).map(most).fold(0.0, f64::max);
    let changes = |joint: &usize| most(*joint) > RANK * greatest;
    (0..model.joints().len()).filter(changes).collect()
}

/// Independent states of self-stress, multipliers w with w^T Phi_q = 0 (Pellegrino & Calladine 1986, Int. J. Solids Struct. 22:409), one
/// for every row that is left out: the parts of these rows that no balance of forces sees.
fn self_stresses(model: &Model, at: &State) -> Vec<Vec<f64>> {
    let shape = model.shape();
    let lengths = unit_lengths(model);
    let mut balance = vec![SparseRow::new(); shape.unknowns];
    for (row, entries) in constraint_rows(model, at).into_iter().enumerate() {
        for (i, g) in entries {
            balance[i].push((row, g / lengths[i]));
        }
    }
    let balance = IndependentRows::homogeneous(shape.multipliers, &balance);
    let self_stress = |row: usize| {
        let mut unit = vec![0.0; shape.multipliers];
        unit[row] = 1.0;
        balance.free_part(&unit)
    };
    model.left_out().map(self_stress).collect()
}

/// Force \[N\], and torque divided by a length \[N\], of every joint.
fn reactions(model: &Model, length: f64, at: &State, work: &mut Work) -> Vec<f64> {
    let mut reactions = Vec::with_capacity(3 * model.joints().len());
    for j in 0..model.joints().len() {
        let [_, torque] = model.joint_turn(j, at, work);
        let force = model.joint_force(j, at, work);
        reactions.extend([force.x, force.y, torque / length]);
    }
    reactions
}

/// The x of least norm that minimises |A x - b|; none where these are not finite.
fn least_squares(a: &Mat<f64>, b: &[f64]) -> Option<Vec<f64>> {
    let svd = a.thin_svd().ok()?;
    let values = svd.S().column_vector();
    let largest = values.iter().fold(0.0_f64, |m, x| m.max(*x));
    let mut x = vec![0.0; a.ncols()];
    for (k, value) in values
        .iter()
        .enumerate()
        .filter(|(_, s)| **s > RANK * largest)
    {
        let along: f64 = svd.U().col(k).iter().zip(b).map(|(u, b)| u * b).sum();
        let parts = x.iter_mut().zip(svd.V().col(k).iter());
        parts.for_each(|(x, v)| *x += v * along / value);
    }
    Some(x)
}

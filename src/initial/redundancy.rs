//! Redundant constraints: found at the start, left out of the equations, reported by name.

use crate::compile::assembly::{closing_step, constraint_rows};
use crate::math::independent_rows::IndependentRows;
use crate::model::Model;
use crate::newton::Update;
use crate::system::State;

/// Distance to the second pose that distinguishes a singular start from a redundant constraint, in units of the coordinates.
const EXCURSION: f64 = 1e-2;
/// Most steps of Newton's method that close it again.
const CLOSING: usize = 12;
/// A step no larger than this is the last one, in units of the coordinates.
const CLOSED: f64 = 1e-12;

/// The rows that depend on those before them, as (constraint, row of it), and the equations of all rows.
fn dependent(model: &Model, state: &State) -> (Vec<(usize, usize)>, IndependentRows) {
    let constraints = model.constraints.iter().enumerate();
    let all = constraints.flat_map(|(i, placed)| (0..placed.rows).map(move |d| (i, d)));
    let all: Vec<_> = all.collect();
    let zero = vec![0.0; all.len()];
    let rows = constraint_rows(model, state);
    let equations = IndependentRows::new(model.shape().unknowns, &rows, &zero);
    let dependent = equations.dependent.iter().map(|&k| all[k]);
    (dependent.collect(), equations)
}

/// Dependent constraints of a start.
#[derive(Debug, PartialEq)]
pub(crate) enum Redundancy {
    /// Rows that depend on others in every pose, as (constraint, row of it); often none.
    Rows(Vec<(usize, usize)>),
    /// The start is a singular pose: the row of this name depends on others in this pose only.
    SingularStart(String),
}

/// Finds rows that depend on others at the start and in a pose near it.
///
/// The row of a redundant bar of a parallelogram depends on the others in every pose; a row of a mechanism at a dead centre
/// does so in that pose only.
pub(crate) fn find(model: &Model, start: &State) -> Redundancy {
    let n = model.shape().unknowns;
    let (here, independent) = dependent(model, start);
    if here.is_empty() {
        return Redundancy::Rows(here);
    }
    // any direction that the constraints permit and that shares no symmetry with a mechanism
    let direction: Vec<f64> = (0..n).map(|i| (1.0 + 2.4 * i as f64).sin()).collect();
    let free = independent.free_part(&direction);
    let size = free.iter().map(|x| x * x).sum::<f64>().sqrt();
    if size <= 1e-9 * (n as f64).sqrt() {
        // no motion is possible: rows that depend on others here always do
        return Redundancy::Rows(here);
    }
    let mut moved = start.clone();
    for (q, x) in moved.q.iter_mut().zip(&free) {
        *q += EXCURSION * x / size;
    }
    let held = vec![false; n];
    for _ in 0..CLOSING {
        let Update { size, .. } = closing_step(model, &mut moved, &held);
        if size <= CLOSED {
            break;
        }
    }
    let (there, _) = dependent(model, &moved);
    match here.iter().find(|row| there.binary_search(row).is_err()) {
        Some(&(i, d)) if there.len() < here.len() => {
            Redundancy::SingularStart(model.names[n + model.constraints[i].row + d].clone())
        }
        _ => Redundancy::Rows(here),
    }
}

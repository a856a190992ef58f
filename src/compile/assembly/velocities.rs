//! Velocities at the start, from a few given ones.

use super::super::{Compiler, Role};
use super::{AGREEING, opening, row, sparse_rows};
use crate::math::dense::{Added, Equations};
use crate::math::independent_rows::IndependentRows;
use crate::math::sparse_rows::{SparseRow, SparseRows, SymmetricBlock, full_row, times};
use crate::model::Model;
use crate::scene::SceneError;
use crate::system::{State, System};
use faer::Mat;

/// The velocities that a scene can give, with their units.
const RATES: [(&str, &str); 3] = [("vx", "m/s"), ("vy", "m/s"), ("omega", "rad/s")];

/// Velocities of least kinetic energy under the constraints and the given ones.
pub(super) fn velocities(
    c: &Compiler,
    mechanism: &Model,
    state: &mut State,
) -> Result<(), SceneError> {
    let n = mechanism.shape().unknowns;
    state.v[..n].fill(0.0);
    let mut rates = vec![0.0; mechanism.shape().multipliers];
    mechanism.constraint_velocity(state, &mut rates);
    if let Some(v) = sparse_velocities(c, mechanism, state, &rates) {
        state.v[..n].copy_from_slice(&v);
        mechanism.move_driven_nodes(state);
        return Ok(());
    }
    let mut equations = Equations::default();
    for (i, placed) in mechanism.constraints.iter().enumerate() {
        for d in 0..placed.rows {
            let added = equations.add(&row(mechanism, state, i, d), -rates[placed.row + d]);
            if let Added::Dependent(off) = added
                && off.abs() > AGREEING
            {
                let name = &mechanism.names[n + placed.row + d];
                let message = format!(
                    "the prescribed motions contradict each other at t = 0: the rate of {name} is off by {}",
                    opening(&placed.term, off.abs(), "/s")
                );
                return Err(c.scene.error(c.scene.initial.span, message, "this start"));
            }
        }
    }
    for given in c.scene.initial.bodies.values().filter(|g| g.velocity_given) {
        for (component, (key, unit)) in RATES.into_iter().enumerate() {
            let Some((a, known)) = velocity_row(mechanism, state, given.body, component) else {
                continue;
            };
            let added = equations.add(&full_row(n, &a), given.velocity[component] - known);
            if let Added::Dependent(off) = added
                && off.abs() > AGREEING
            {
                let message = format!(
                    "the given velocity of {} contradicts the joints and drives: {key} is off by {}",
                    c.scene.bodies[given.body].name,
                    numbers::si(off.abs(), unit)
                );
                return Err(c.scene.error(given.span, message, "this velocity"));
            }
        }
    }
    for given in &c.scene.initial.velocities {
        let body = &c.scene.bodies[given.body].name;
        let (key, _) = RATES[given.component];
        if c.roles[given.body] != Role::Free {
            let message = format!("the motion of {body} is prescribed, so `{key}` cannot be given");
            return Err(c.scene.error(given.span, message, "remove this"));
        }
        let Some((a, known)) = velocity_row(mechanism, state, given.body, given.component) else {
            continue;
        };
        if let Added::Dependent(off) = equations.add(&full_row(n, &a), given.value - known) {
            let verb = match off.abs() > AGREEING {
                true => "contradicts",
                false => "repeats",
            };
            let implied = given.value - off;
            let message = format!(
                "{key} of {body} {verb} the joints, drives and velocities given before, which make it {implied:.6}"
            );
            return Err(c.scene.error(given.span, message, "leave this out"));
        }
    }
    let (mass, momentum) = mass(mechanism, state);
    let v = equations.least_energy(&mass, &momentum);
    state.v[..n].copy_from_slice(&v);
    mechanism.move_driven_nodes(state);
    Ok(())
}

/// The same of a large mechanism where it is certain which equations are independent, and the solution satisfies all of them.
fn sparse_velocities(
    c: &Compiler,
    mechanism: &Model,
    state: &State,
    rates: &[f64],
) -> Option<Vec<f64>> {
    let n = mechanism.shape().unknowns;
    let mut rows = sparse_rows(mechanism, state)?;
    let constraints = mechanism.constraints.iter();
    let wanted = constraints.flat_map(|p| (p.row..p.row + p.rows).map(|row| -rates[row]));
    let mut wanted: Vec<f64> = wanted.collect();
    let whole = c.scene.initial.bodies.values().filter(|g| g.velocity_given);
    let whole = whole.flat_map(|g| (0..RATES.len()).map(|k| (g.body, k, g.velocity[k])));
    let single = c.scene.initial.velocities.iter();
    // the velocity of a body whose motion is prescribed is refused below
    let free = |body: usize| c.roles[body] == Role::Free;
    if !single.clone().all(|g| free(g.body)) {
        return None;
    }
    let singles = single.len();
    let single = single.map(|g| (g.body, g.component, g.value));
    for (body, component, value) in whole.chain(single) {
        if let Some((row, known)) = velocity_row(mechanism, state, body, component) {
            rows.push(row);
            wanted.push(value - known);
        }
    }
    let independent = IndependentRows::new(n, &rows)?;
    // a single velocity that follows from the others is refused below
    let last = independent.dependent.last();
    if last.is_some_and(|&k| k + singles >= rows.len()) {
        return None;
    }
    let (blocks, momentum) = mass_blocks(mechanism, state);
    // not -p, which would turn a zero into a negative one
    let against: Vec<f64> = momentum.iter().map(|p| 0.0 - p).collect();
    let blocks: Vec<SymmetricBlock> = blocks
        .iter()
        .map(|(own, block)| (&own[..], &block[..]))
        .collect();
    let (chosen, right) = (independent.chosen(&rows), independent.chosen(&wanted));
    let v = SparseRows::factor(n, &chosen, &blocks)?.solve(&against, &right);
    let off = |k: usize| (times(&rows[k], &v) - wanted[k]).abs();
    (0..rows.len()).all(|k| off(k) <= AGREEING).then_some(v)
}

/// A velocity of a body as a linear function of the unknown velocities, and the contribution of known ones. `None` for the
/// angular velocity of a point mass.
fn velocity_row(
    mechanism: &Model,
    state: &State,
    body: usize,
    component: usize,
) -> Option<(SparseRow, f64)> {
    let n = mechanism.shape().unknowns;
    let placed = &mechanism.bodies()[body].placed;
    let entries = placed.kind.velocity(component, &placed.x, &state.q)?;
    let (row, known): (Vec<_>, Vec<_>) = entries.into_iter().partition(|(i, _)| *i < n);
    let known = known.iter().map(|(i, value)| value * state.v[*i]).sum();
    Some((row, known))
}

/// Mass matrix of the unknowns, and the momentum from known velocities.
fn mass(mechanism: &Model, state: &State) -> (Mat<f64>, Vec<f64>) {
    let n = mechanism.shape().unknowns;
    let (blocks, momentum) = mass_blocks(mechanism, state);
    let mut m = Mat::zeros(n, n);
    for (own, block) in &blocks {
        for (&i, row) in own.iter().zip(block.chunks_exact(own.len())) {
            own.iter()
                .zip(row)
                .for_each(|(&j, value)| m[(i, j)] += value);
        }
    }
    (m, momentum)
}

/// Some unknown coordinates, and their mass matrix row by row.
type MassBlock = (Vec<usize>, Vec<f64>);

/// The masses of the unknown coordinates, part by part where there are any, and the momentum that known velocities add to them.
fn mass_blocks(mechanism: &Model, state: &State) -> (Vec<MassBlock>, Vec<f64>) {
    let n = mechanism.shape().unknowns;
    let mut momentum = vec![0.0; n];
    let blocks = mechanism.mass.parts.iter().filter_map(|part| {
        let (mut own, mut block) = (Vec::new(), Vec::new());
        let rows = part.values.chunks_exact(part.coordinates.len());
        for (&i, row) in part.coordinates.iter().zip(rows).filter(|(i, _)| **i < n) {
            own.push(i);
            for (&j, value) in part.coordinates.iter().zip(row) {
                match j < n {
                    true => block.push(*value),
                    false => momentum[i] += value * state.v[j],
                }
            }
        }
        (!own.is_empty()).then_some((own, block))
    });
    (blocks.collect(), momentum)
}

//! Velocities at the start, from a few given ones.

use super::super::{Compiler, Role};
use super::{AGREEING, constraint_rows, opening};
use crate::math::independent_rows::IndependentRows;
use crate::math::sparse_rows::{SparseRow, SymmetricBlock, times};
use crate::model::{Model, PlacedConstraint};
use crate::scene::{GivenVelocity, SceneError};
use crate::system::{State, System};

/// The velocities that a scene can give, with their units.
const RATES: [(&str, &str); 3] = [("vx", "m/s"), ("vy", "m/s"), ("omega", "rad/s")];

/// What demands a linear equation of the velocities.
#[derive(Debug, Clone, Copy)]
enum Demand<'a> {
    /// A row of a constraint.
    Constraint(&'a PlacedConstraint, usize),
    /// A component of the velocity of a given state, which may repeat others.
    OfState(GivenVelocity),
    /// A velocity that is given by itself.
    Single(GivenVelocity),
}

impl Demand<'_> {
    /// The error for an equation that depends on those before it, which give the right side up to `off`. None where the equation may
    /// repeat them, and does so within the tolerance.
    fn refuse(
        self,
        c: &Compiler,
        mechanism: &Model,
        off: f64,
        tolerance: f64,
    ) -> Option<SceneError> {
        let contradicts = off.abs() > tolerance;
        match self {
            Demand::Constraint(placed, d) => contradicts.then(|| {
                let name = &mechanism.names[mechanism.shape().unknowns + placed.row + d];
                let message = format!(
                    "the prescribed motions contradict each other at t = 0: the rate of {name} is off by {}",
                    opening(&placed.term, off.abs(), "/s")
                );
                c.scene.error(c.scene.initial.span, message, "this start")
            }),
            Demand::OfState(given) => contradicts.then(|| {
                let (key, unit) = RATES[given.component];
                let message = format!(
                    "the given velocity of {} contradicts the joints and drives: {key} is off by {}",
                    c.scene.bodies[given.body].name,
                    numbers::si(off.abs(), unit)
                );
                c.scene.error(given.span, message, "this velocity")
            }),
            Demand::Single(given) => {
                let (key, _) = RATES[given.component];
                let body = &c.scene.bodies[given.body].name;
                let verb = match contradicts {
                    true => "contradicts",
                    false => "repeats",
                };
                let implied = given.value - off;
                let message = format!(
                    "{key} of {body} {verb} the joints, drives and velocities given before, which make it {implied:.6}"
                );
                Some(c.scene.error(given.span, message, "leave this out"))
            }
        }
    }
}

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
    let constraints = mechanism.constraints.iter();
    let of_constraints = constraints.flat_map(|p| (0..p.rows).map(move |d| (p, d)));
    let mut rows = constraint_rows(mechanism, state);
    let (mut values, mut demands): (Vec<f64>, Vec<Demand>) = of_constraints
        .map(|(p, d)| (-rates[p.row + d], Demand::Constraint(p, d)))
        .unzip();
    for (given, demand) in given_velocities(c)? {
        if let Some((row, known)) = velocity_row(mechanism, state, given) {
            rows.push(row);
            values.push(given.value - known);
            demands.push(demand);
        }
    }
    let independent = IndependentRows::new(n, &rows, &values);
    let least = independent.least_norm();
    let tolerance = AGREEING * least.iter().fold(1.0_f64, |m, v| m.max(v.abs()));
    for &k in &independent.dependent {
        let off = values[k] - times(&rows[k], &least);
        if let Some(error) = demands[k].refuse(c, mechanism, off, tolerance) {
            return Err(error);
        }
    }
    let (blocks, momentum) = mass_blocks(mechanism, state);
    let blocks: Vec<SymmetricBlock> = blocks
        .iter()
        .map(|(own, block)| (&own[..], &block[..]))
        .collect();
    let v = independent.least_energy(&blocks, &momentum, tolerance);
    state.v[..n].copy_from_slice(&v);
    mechanism.move_driven_nodes(state);
    Ok(())
}

/// The velocities that the scene gives: first those of given states, then single ones.
fn given_velocities<'d>(c: &Compiler) -> Result<Vec<(GivenVelocity, Demand<'d>)>, SceneError> {
    let states = c.scene.initial.bodies.values().filter(|g| g.velocity_given);
    let of_states = states.flat_map(|state| {
        let velocity = |component: usize| GivenVelocity {
            body: state.body,
            component,
            value: state.velocity[component],
            span: state.span,
        };
        (0..RATES.len()).map(velocity)
    });
    let singles = &c.scene.initial.velocities;
    if let Some(given) = singles.iter().find(|g| c.roles[g.body] != Role::Free) {
        let (key, _) = RATES[given.component];
        let body = &c.scene.bodies[given.body].name;
        let message = format!("the motion of {body} is prescribed, so `{key}` cannot be given");
        return Err(c.scene.error(given.span, message, "remove this"));
    }
    let of_states = of_states.map(|given| (given, Demand::OfState(given)));
    let singles = singles.iter().map(|given| (*given, Demand::Single(*given)));
    Ok(of_states.chain(singles).collect())
}

/// A velocity of a body as a linear function of the unknown velocities, and the contribution of known ones. `None` for the
/// angular velocity of a point mass.
fn velocity_row(
    mechanism: &Model,
    state: &State,
    given: GivenVelocity,
) -> Option<(SparseRow, f64)> {
    let n = mechanism.shape().unknowns;
    let placed = &mechanism.bodies()[given.body].placed;
    let entries = placed.kind.velocity(given.component, &placed.x, &state.q)?;
    let (row, known): (Vec<_>, Vec<_>) = entries.into_iter().partition(|(i, _)| *i < n);
    let known = known.iter().map(|(i, value)| value * state.v[*i]).sum();
    Some((row, known))
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

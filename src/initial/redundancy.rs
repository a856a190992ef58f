//! Redundant constraints: found at the start, left out of the equations, reported by name.
//!
//! Rows w of Phi_q that depend on each other, w . Phi_q = 0, permit motions z, Phi_q z = 0, that rows of full rank would not. A motion
//! goes on to second order if Phi_q a + Phi_qq(z, z) = 0 has a solution, that is w . Phi_qq(z, z) = 0 (Connelly and Whiteley 1996, SIAM
//! Journal on Discrete Mathematics 9:453). Where this form in z vanishes the row is redundant; where it has one sign the mechanism is
//! rigid but shaky; where it has two, branches of the motion cross.

use crate::compile::assembly::{closing_step, constraint_rows};
use crate::math::generic;
use crate::math::groups::Groups;
use crate::math::independent_rows::IndependentRows;
use crate::model::Model;
use crate::newton::Update;
use crate::system::State;
use faer::Mat;
use std::collections::{BTreeSet, HashMap};

/// Distance to the second pose that distinguishes a singular start from a redundant constraint, as a part of the mechanism.
const EXCURSION: f64 = 1e-2;
/// Most steps of Newton's method that close it again.
const CLOSING: usize = 12;
/// A step no larger than this part of the mechanism is the last one.
const CLOSED: f64 = 1e-12;
/// A displacement below this part of the largest is none.
const STILL: f64 = 1e-9;
/// Singular values below this part of the largest are zero: what makes rows dependent elsewhere.
const RANK: f64 = 1e-9;
/// Second-order terms below this part of the largest are zero: they are differences of numbers of that size.
const FLAT: f64 = 1e-6;
/// Parts of a mechanism with more rows than this are not looked at to second order.
const LARGE: usize = 300;

/// The ranks of the constraints of a start.
pub(crate) struct Ranks<'m> {
    model: &'m Model,
    start: &'m State,
    /// Length of the mechanism \[m\].
    size: f64,
    /// The rows that depend on those before them, and the equations of all rows.
    dependent: Vec<(usize, usize)>,
    equations: IndependentRows,
}

/// The rows that depend on those before them, as (constraint, row of it), and the equations of all rows.
fn dependent(model: &Model, state: &State) -> (Vec<(usize, usize)>, IndependentRows) {
    let constraints = model.constraints.iter().enumerate();
    let all = constraints.flat_map(|(i, placed)| (0..placed.rows).map(move |d| (i, d)));
    let all: Vec<_> = all.collect();
    // of displacements, so that ranks do not depend on the size of the mechanism
    let lengths = unit_lengths(model);
    let mut rows = constraint_rows(model, state);
    for (i, x) in rows.iter_mut().flatten() {
        *x /= lengths[*i];
    }
    let equations = IndependentRows::homogeneous(model.shape().unknowns, &rows);
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
    /// The mechanism is rigid, but the coordinate of this name can move to first order.
    Shaky(String),
}

impl<'m> Ranks<'m> {
    /// Those of a start of a mechanism of this length \[m\].
    pub fn of(model: &'m Model, start: &'m State, size: f64) -> Ranks<'m> {
        let (dependent, equations) = dependent(model, start);
        Ranks {
            model,
            start,
            size,
            dependent,
            equations,
        }
    }

    /// Rows that depend on others at the start and in a pose near it.
    ///
    /// The row of a redundant bar of a parallelogram depends on the others in every pose; a row of a mechanism at a dead centre
    /// does so in that pose only.
    pub fn redundancy(&self) -> Redundancy {
        let (model, here) = (self.model, &self.dependent);
        let n = model.shape().unknowns;
        if here.is_empty() {
            return Redundancy::Rows(Vec::new());
        }
        if let Some(coordinate) = shaky(model, self.start, here) {
            return Redundancy::Shaky(model.names[coordinate].clone());
        }
        let Some(moved) = self.neighbour() else {
            // no motion is possible: rows that depend on others here always do
            return Redundancy::Rows(here.clone());
        };
        let (there, _) = dependent(model, &moved);
        match here.iter().find(|row| there.binary_search(row).is_err()) {
            Some(&(i, d)) if there.len() < here.len() => {
                Redundancy::SingularStart(model.names[n + model.constraints[i].row + d].clone())
            }
            _ => Redundancy::Rows(here.clone()),
        }
    }

    /// A pose near the start; none where no motion is possible.
    fn neighbour(&self) -> Option<State> {
        let free = free_displacements(self.model, &self.equations)?;
        let mut moved = self.start.clone();
        for ((q, x), length) in moved.q.iter_mut().zip(&free).zip(unit_lengths(self.model)) {
            *q += EXCURSION * self.size * x / length;
        }
        let held = vec![false; free.len()];
        for _ in 0..CLOSING {
            let Update { size, .. } = closing_step(self.model, &mut moved, &held);
            if size <= CLOSED * self.size {
                break;
            }
        }
        Some(moved)
    }

    /// For every unknown coordinate, whether the constraints alone give its velocity, at the start and in a pose near it: in a single pose a
    /// coordinate may be at its dead centre. The errors of such a coordinate do not add up from step to step.
    pub fn determined(&self) -> Vec<bool> {
        let n = self.model.shape().unknowns;
        let still = |equations: &IndependentRows| match free_displacements(self.model, equations) {
            None => vec![true; n],
            Some(free) => free.iter().map(|x| x.abs() <= STILL).collect(),
        };
        let here = still(&self.equations);
        if !here.contains(&true) {
            return here;
        }
        let Some(moved) = self.neighbour() else {
            return here;
        };
        let there = still(&dependent(self.model, &moved).1);
        here.into_iter().zip(there).map(|(a, b)| a && b).collect()
    }
}

/// How far every unknown moves points of its body in a motion that the constraints permit, relative to the largest: of any direction
/// that shares no symmetry with a mechanism. None where no motion is possible.
fn free_displacements(model: &Model, equations: &IndependentRows) -> Option<Vec<f64>> {
    let n = model.shape().unknowns;
    let direction: Vec<f64> = (0..n).map(generic).collect();
    let mut free = equations.free_part(&direction);
    let largest = free.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    free.iter_mut().for_each(|x| *x /= largest);
    (largest > STILL).then_some(free)
}

/// The largest distance by which a unit of each unknown moves a point of its body; one of an internal state.
pub(crate) fn unit_lengths(model: &Model) -> Vec<f64> {
    let lengths = model.lengths().into_iter();
    lengths
        .map(|length| if length > 0.0 { length } else { 1.0 })
        .collect()
}

/// The unknown coordinate that moves most in a motion that is possible to first order only, where dependent rows permit one.
fn shaky(model: &Model, start: &State, dependent: &[(usize, usize)]) -> Option<usize> {
    let n = model.shape().unknowns;
    let own = |k: usize| {
        let coordinates = model.constraints[k].block.coordinates.iter();
        coordinates.copied().filter(|i| *i < n)
    };
    let mut parts = Groups::new(n);
    for k in 0..model.constraints.len() {
        let mut coordinates = own(k);
        if let Some(first) = coordinates.next() {
            coordinates.for_each(|i| parts.unite(i, first));
        }
    }
    let of_dependent = dependent.iter().filter_map(|(k, _)| own(*k).next());
    let roots: BTreeSet<usize> = of_dependent.map(|i| parts.find(i)).collect();
    roots.into_iter().find_map(|root| {
        let constraints = (0..model.constraints.len())
            .filter(|&k| own(k).next().is_some_and(|i| parts.find(i) == root));
        let constraints: Vec<usize> = constraints.collect();
        let coordinates = (0..n).filter(|&i| parts.find(i) == root).collect();
        let part = Part {
            model,
            start,
            constraints,
            coordinates,
        };
        part.shaky()
    })
}

/// Constraints that share coordinates with each other and with no others.
struct Part<'a> {
    model: &'a Model,
    start: &'a State,
    constraints: Vec<usize>,
    coordinates: Vec<usize>,
}

impl Part<'_> {
    fn shaky(&self) -> Option<usize> {
        let placed = self.constraints.iter().map(|&k| &self.model.constraints[k]);
        let (m, n) = (placed.clone().map(|p| p.rows).sum(), self.coordinates.len());
        if m > LARGE {
            return None;
        }
        let local: HashMap<usize, usize> = self.coordinates.iter().copied().zip(0..).collect();
        let mut phi_q: Mat<f64> = Mat::zeros(m, n);
        let mut row = 0;
        for placed in placed {
            let gradient = placed.term.gradient(self.start);
            for gradient in gradient.iter().take(placed.rows) {
                for (i, g) in placed.block.coordinates.iter().zip(gradient) {
                    if let Some(&i) = local.get(i) {
                        phi_q[(row, i)] += g;
                    }
                }
                row += 1;
            }
        }
        let svd = phi_q.svd().ok()?;
        let values = svd.S().column_vector();
        let largest = (0..m.min(n)).fold(0.0_f64, |l, k| l.max(values[k]));
        let rank = (0..m.min(n))
            .filter(|&k| values[k] > RANK * largest)
            .count();
        let free: Vec<Vec<f64>> = (rank..n)
            .map(|k| (0..n).map(|i| svd.V()[(i, k)]).collect())
            .collect();
        if free.is_empty() {
            return None;
        }
        let bends = |z: &[f64]| self.second_order(z);
        let single: Vec<Vec<f64>> = free.iter().map(|z| bends(z)).collect();
        let largest = single.iter().flatten().fold(0.0_f64, |l, x| l.max(x.abs()));
        for k in rank..m {
            let times = |x: &[f64]| -> f64 { (0..m).map(|row| svd.U()[(row, k)] * x[row]).sum() };
            let mut form: Mat<f64> = Mat::zeros(free.len(), free.len());
            for a in 0..free.len() {
                form[(a, a)] = times(&single[a]);
                for b in 0..a {
                    let sum: Vec<f64> = free[a].iter().zip(&free[b]).map(|(x, y)| x + y).collect();
                    let mixed = 0.5 * (times(&bends(&sum)) - times(&single[a]) - times(&single[b]));
                    (form[(a, b)], form[(b, a)]) = (mixed, mixed);
                }
            }
            let eigen = form.self_adjoint_eigen(faer::Side::Lower).ok()?;
            let values: Vec<f64> = eigen.S().column_vector().iter().copied().collect();
            let signs = [1.0, -1.0].map(|sign| values.iter().any(|x| sign * x > FLAT * largest));
            if signs[0] != signs[1] {
                let most = (0..values.len())
                    .max_by(|a, b| values[*a].abs().total_cmp(&values[*b].abs()))?;
                let z = |i: usize| -> f64 {
                    let parts = free.iter().enumerate();
                    parts.map(|(a, z)| eigen.U()[(a, most)] * z[i]).sum()
                };
                let moves = (0..n).max_by(|a, b| z(*a).abs().total_cmp(&z(*b).abs()))?;
                return Some(self.coordinates[moves]);
            }
        }
        None
    }

    /// Phi_qq(z, z), row by row, with what time changes left out.
    fn second_order(&self, z: &[f64]) -> Vec<f64> {
        let mut at = self.start.clone();
        at.v.fill(0.0);
        at.a.fill(0.0);
        let mut all = |sign: f64| -> Vec<f64> {
            for (&i, z) in self.coordinates.iter().zip(z) {
                at.v[i] = sign * z;
            }
            let rows = self.constraints.iter().flat_map(|&k| {
                let placed = &self.model.constraints[k];
                let acceleration = placed.term.acceleration(&at);
                acceleration.into_iter().take(placed.rows)
            });
            rows.collect()
        };
        let [forth, rest, back] = [1.0, 0.0, -1.0].map(&mut all);
        let pairs = forth.iter().zip(&rest).zip(&back);
        pairs
            .map(|((forth, rest), back)| 0.5 * (forth + back) - rest)
            .collect()
    }
}

//! Closing a mechanism, and what keeps a loop open: its least gap and the lengths that would close it.
//!
//! A loop that cannot close has a gap at one joint while all others are closed. The gap is least where its gradient is a sum of those of
//! the other constraints. It is found by steps along the gradient that the constraints leave (Barzilai and Borwein 1988, IMA Journal of
//! Numerical Analysis 8:141, with the line search of Raydan 1997), each followed by Newton's method on the constraints. The same finds
//! the least change of a length that closes the loop: with this length free and the joint closed.

use super::super::extent::FITS;
use super::{Compiler, constraint_rows, name, whole_name};
use crate::body::PointRef;
use crate::constraint::ROWS;
use crate::math::generic;
use crate::math::groups::Groups;
use crate::math::independent_rows::IndependentRows;
use crate::math::plane::pair;
use crate::math::sparse_rows::SparseRow;
use crate::model::{Model, PlacedConstraint, Rule};
use crate::newton::{Update, iterate_interruptibly};
use crate::system::State;
use crate::terms::ConstraintTerm;
use std::collections::HashMap;

/// Largest violation of an assembled constraint as a part of the mechanism: far above rounding, far below anything measurable.
pub(super) const CLOSED: f64 = 1e-12;
/// Steps of Newton's method.
const ITERATIONS: usize = 80;
/// The gradient that is left at a least gap, where that of the gap is 1: the gap is off by its square.
const STATIONARY: f64 = 1e-7;
/// Steps of a minimisation, and steps whose largest value the next one may not exceed.
const STEPS: usize = 400;
const MEMORY: usize = 5;
/// A step must reduce the function by this part of what its slope promises (Armijo 1966).
const ARMIJO: f64 = 1e-4;
/// Minimisations from different starts: the least is taken.
const STARTS: usize = 6;
/// A move by this part of the mechanism changes a length that is not fixed by about its square, 1e-3; a change below the other part is
/// that of a length that is fixed but for errors of others.
const EXCURSION: f64 = 0.05;
const FIXED: f64 = 1e-5;
/// The gap that is left where the length of a driven link closes a loop, as a part of the mechanism: far below printed digits.
const TRACED: f64 = 1e-7;
/// The longest driven link that is tried, as a multiple of the mechanism.
const FARTHEST: f64 = 10.0;
/// Parts of a mechanism with more constraints are not searched: this many take a second.
const LARGE: usize = 40;

/// A mechanism whose loops are closed, coordinate by coordinate.
pub(super) struct Closing<'m> {
    pub model: &'m Model,
    /// Coordinates of given poses.
    pub held: &'m [bool],
    /// The length of the mechanism \[m\].
    pub size: f64,
}

/// A loop that cannot close.
pub(super) struct OpenLoop<'m> {
    /// The constraint that stays open.
    pub constraint: &'m PlacedConstraint,
    /// By how much \[m or rad\].
    pub gap: f64,
    /// The lengths that would close it, body by body.
    pub lengths: Vec<ClosingLength>,
    /// The number of loops that cannot close.
    pub count: usize,
}

/// A length with which a loop closes.
pub(super) struct ClosingLength {
    body: usize,
    /// The one closest to that of the body \[m\].
    length: f64,
    /// What its last digit may be worth at least \[m\].
    resolution: f64,
    /// True where the other constraints leave no other.
    is_fixed: bool,
}

/// What is found of a mechanism that Newton's method does not close.
pub(super) enum Search<'m> {
    /// A pose in which all its loops are closed.
    Closed(Box<State>),
    Open(OpenLoop<'m>),
    /// Too many constraints to search.
    TooLarge,
}

impl<'m> Closing<'m> {
    /// Moves all coordinates that are not held until every constraint is satisfied; returns the one with the largest violation if
    /// that fails.
    pub fn close(&self, state: &mut State) -> Option<&'m PlacedConstraint> {
        let goal = vec![0.0; self.model.shape.multipliers];
        let open = close_to(self.model, state, self.held, &goal, self.size);
        open.map(|(_, placed)| placed)
    }

    /// The constraint with the largest violation, if this is above a tolerance.
    fn open(&self, state: &State, tolerance: f64) -> Option<&'m PlacedConstraint> {
        let goal = vec![0.0; self.model.shape.multipliers];
        let open = open(self.model, state, &goal, tolerance * self.size);
        open.map(|(_, placed)| placed)
    }

    /// The gap of a constraint \[m or rad\] and its gradient, row by row.
    fn gap(&self, k: usize, state: &State) -> [(f64, SparseRow); ROWS] {
        let placed = &self.model.constraints[k];
        let (value, gradient) = (placed.term.value(state), placed.term.gradient(state));
        // Phi = (d^2 - l^2)/(2 l) of a length l: its gap is d - l
        let (factor, value) = match &placed.term {
            ConstraintTerm::Length(link) => {
                let distance = (link.length * (link.length + 2.0 * value[0]))
                    .max(0.0)
                    .sqrt();
                (
                    link.length / distance.max(f64::MIN_POSITIVE),
                    [distance - link.length, 0.0],
                )
            }
            _ => (1.0, value),
        };
        std::array::from_fn(|d| {
            let entries = placed.block.coordinates.iter().copied().zip(gradient[d]);
            let free = entries.filter(|(i, _)| *i < self.held.len() && !self.held[*i]);
            let row = free.map(|(i, g)| (i, factor * g)).collect();
            match d < placed.rows {
                true => (value[d], row),
                false => (0.0, Vec::new()),
            }
        })
    }

    fn size_of_gap(&self, k: usize, state: &State) -> f64 {
        let [(x, _), (y, _)] = self.gap(k, state);
        x.hypot(y)
    }

    /// The equations that close some constraints.
    fn equations(&self, constraints: &[usize], state: &State) -> IndependentRows {
        let (mut rows, mut values) = (Vec::new(), Vec::new());
        for &k in constraints {
            let count = self.model.constraints[k].rows;
            for (value, row) in self.gap(k, state).into_iter().take(count) {
                rows.push(row);
                values.push(-value);
            }
        }
        IndependentRows::new(self.held.len(), &rows, &values)
    }

    /// Closes some constraints by Newton's method with shortened steps.
    fn closes(&self, constraints: &[usize], state: &State) -> Option<State> {
        let violation = |state: &State| {
            let gaps = constraints.iter().map(|&k| self.size_of_gap(k, state));
            gaps.map(|x| x * x).sum::<f64>().sqrt()
        };
        let mut here = state.clone();
        let mut open = violation(&here);
        for _ in 0..ITERATIONS {
            if open <= CLOSED * self.size {
                break;
            }
            let step = self.equations(constraints, &here).least_norm();
            let mut part = 1.0;
            let next = loop {
                let next = self.moved(&here, part, &step);
                let left = violation(&next);
                if left <= (1.0 - ARMIJO * part) * open {
                    break Some((next, left));
                }
                part *= 0.5;
                if part < CLOSED {
                    break None;
                }
            };
            let Some((next, left)) = next else { break };
            (here, open) = (next, left);
        }
        (open <= FITS * self.size).then_some(here)
    }

    fn moved(&self, from: &State, part: f64, step: &[f64]) -> State {
        let mut moved = from.clone();
        let n = self.held.len();
        let steps = moved.q[..n].iter_mut().zip(step);
        steps.for_each(|(q, d)| *q += part * d);
        moved
    }

    /// From a pose in which some constraints are closed, a pose in which they are and the gap of another one is least.
    fn least(&self, k: usize, closed: &[usize], from: &State) -> State {
        let slope = |state: &State| {
            let mut gradient = vec![0.0; self.held.len()];
            for (value, row) in self.gap(k, state) {
                row.iter().for_each(|(i, g)| gradient[*i] += value * g);
            }
            self.equations(closed, state).free_part(&gradient)
        };
        let value = |state: &State| 0.5 * self.size_of_gap(k, state).powi(2);
        let (mut here, mut gradient, mut f) = (from.clone(), slope(from), value(from));
        let mut last = vec![f];
        let mut length = 1.0;
        for _ in 0..STEPS {
            let steepness = dot(&gradient, &gradient);
            if steepness.sqrt() <= STATIONARY * (2.0 * f).sqrt()
                || 2.0 * f <= (CLOSED * self.size).powi(2)
            {
                break;
            }
            let limit = last.iter().copied().fold(0.0, f64::max);
            let mut found = None;
            while found.is_none() && length > CLOSED {
                let next = self.moved(&here, -length, &gradient);
                let next = self.closes(closed, &next).map(|next| (value(&next), next));
                found = next.filter(|(f, _)| *f <= limit - ARMIJO * length * steepness);
                if found.is_none() {
                    length *= 0.5;
                }
            }
            let Some((next_f, next)) = found else { break };
            let next_gradient = slope(&next);
            let step: Vec<f64> = (0..gradient.len()).map(|i| next.q[i] - here.q[i]).collect();
            let change: Vec<f64> = (next_gradient.iter().zip(&gradient))
                .map(|(a, b)| a - b)
                .collect();
            let curvature = dot(&step, &change);
            length = match curvature > 0.0 {
                true => dot(&step, &step) / curvature,
                false => 1.0,
            };
            (here, gradient, f) = (next, next_gradient, next_f);
            last.push(f);
            if last.len() > MEMORY {
                last.remove(0);
            }
        }
        here
    }

    /// The least of the gaps found from several starts.
    fn least_of_all(&self, k: usize, closed: &[usize], from: &State) -> State {
        let lengths = self.model.lengths();
        let starts = (1..STARTS).filter_map(|start| {
            let mut moved = from.clone();
            for (i, length) in lengths.iter().enumerate().filter(|(i, _)| !self.held[*i]) {
                // directions that share no symmetry with a mechanism
                let direction = (start as f64 + 2.4 * i as f64).sin();
                moved.q[i] += 0.5 * self.size * direction / length;
            }
            self.closes(closed, &moved)
        });
        let starts = std::iter::once(from.clone()).chain(starts);
        let found = starts.map(|start| self.least(k, closed, &start));
        let sized = found.map(|state| (self.size_of_gap(k, &state), state));
        let least = sized.min_by(|a, b| a.0.total_cmp(&b.0));
        least.map_or_else(|| from.clone(), |(_, state)| state)
    }

    /// The constraints that free coordinates connect with one constraint: no others decide whether it closes.
    pub fn part(&self, placed: &PlacedConstraint) -> Vec<usize> {
        let n = self.held.len();
        let constraints = &self.model.constraints;
        let free = |i: &&usize| **i < n && !self.held[**i];
        let mut parts = Groups::new(constraints.len());
        let mut first_with = HashMap::new();
        for (k, constraint) in constraints.iter().enumerate() {
            for i in constraint.block.coordinates.iter().filter(free) {
                parts.unite(k, *first_with.entry(*i).or_insert(k));
            }
        }
        let is_placed = |k: &usize| constraints[*k].row == placed.row;
        let mut parts = parts.all().into_iter();
        let part = parts.find(|part| part.iter().any(is_placed));
        part.unwrap_or_default()
    }

    /// Closes from a guess, part by part, what Newton's method alone has left open at a constraint; or the first loop that cannot close.
    pub fn search(&self, guess: &State, mut placed: &'m PlacedConstraint) -> Search<'m> {
        let mut state = guess.clone();
        loop {
            let part = self.part(placed);
            if part.len() > LARGE {
                return Search::TooLarge;
            }
            let open;
            (open, state) = self.open_constraints(&part, &state);
            if !open.is_empty() {
                return self.open_loop(&part, &open, &state);
            }
            let is_of_part = |next: &PlacedConstraint| {
                let rows = part.iter().map(|&k| self.model.constraints[k].row);
                rows.into_iter().any(|row| row == next.row)
            };
            match self.open(&state, FITS) {
                Some(next) if !is_of_part(next) => placed = next,
                _ => return Search::Closed(Box::new(state)),
            }
        }
    }

    /// The first of the open constraints of a part, in a pose in which the others are closed.
    fn open_loop(&self, part: &[usize], open: &[usize], state: &State) -> Search<'m> {
        let first = open[0];
        let closed: Vec<usize> = part.iter().copied().filter(|k| !open.contains(k)).collect();
        let least = self.least_of_all(first, &closed, state);
        Search::Open(OpenLoop {
            constraint: &self.model.constraints[first],
            gap: self.size_of_gap(first, &least),
            lengths: self.lengths(first, &closed, &least),
            count: open.len(),
        })
    }

    /// True where the gap of a constraint is the same in all poses nearby in which others are closed.
    fn is_fixed(&self, k: usize, closed: &[usize], at: &State) -> bool {
        // of its own points
        let mut direction = vec![0.0; self.held.len()];
        for &i in &self.model.constraints[k].block.coordinates {
            if i < direction.len() && !self.held[i] {
                direction[i] = generic(i);
            }
        }
        let free = self.equations(closed, at).free_part(&direction);
        let [moves, all] = [&free, &direction].map(|x| dot(x, x).sqrt());
        if moves <= FITS * all {
            return true;
        }
        let moved = self.moved(at, EXCURSION * self.size / moves, &free);
        let gaps = self.closes(closed, &moved).map(|moved| {
            [&moved, at].map(|state| {
                let [(gap, _), _] = self.gap(k, state);
                gap
            })
        });
        gaps.is_none_or(|[there, here]| (there - here).abs() <= FIXED * self.size)
    }

    /// The constraints of a part that cannot close with the others, and a pose in which the others are closed.
    fn open_constraints(&self, part: &[usize], guess: &State) -> (Vec<usize>, State) {
        let (mut open, mut state) = (Vec::new(), guess.clone());
        // every round closes or opens one more at least
        for _ in 0..2 * part.len() {
            let active: Vec<usize> = part.iter().copied().filter(|k| !open.contains(k)).collect();
            let mut closed = 0;
            // the longest beginning of the list that closes
            let mut not = active.len() + 1;
            while not - closed > 1 {
                let middle = if closed == 0 && not > active.len() {
                    active.len()
                } else {
                    (closed + not).div_ceil(2).min(not - 1)
                };
                match self.closes(&active[..middle], &state) {
                    Some(found) => (closed, state) = (middle, found),
                    None => not = middle,
                }
            }
            if closed == active.len() {
                return (open, state);
            }
            let next = active[closed];
            let before = &active[..closed];
            let least = self.least_of_all(next, before, &state);
            if self.size_of_gap(next, &least) > FITS * self.size {
                open.push(next);
            }
            state = least;
        }
        (open, state)
    }

    /// The lengths with which an open constraint closes, each with all others as they are and closest to its own.
    fn lengths(&self, open: usize, closed: &[usize], from: &State) -> Vec<ClosingLength> {
        let is_length =
            |k: &usize| matches!(self.model.constraints[*k].term, ConstraintTerm::Length(_));
        let all = closed.iter().copied().chain([open]).filter(is_length);
        let length = |k: usize| {
            let placed = &self.model.constraints[k];
            let ConstraintTerm::Length(link) = &placed.term else {
                return None;
            };
            let others = closed.iter().copied().chain([open]);
            let others: Vec<usize> = others.filter(|other| *other != k).collect();
            let start = self.closes(&others, from)?;
            let least = self.least(k, &others, &start);
            let [(change, _), _] = self.gap(k, &least);
            Some(ClosingLength {
                body: placed.owners[0],
                length: link.length + change,
                resolution: FITS * self.size,
                is_fixed: self.is_fixed(k, &others, &least),
            })
        };
        let mut lengths: Vec<ClosingLength> = all.filter_map(length).collect();
        // the length of a driven link is fixed with all others
        let is_fixed = !lengths.is_empty() && lengths.iter().all(|length| length.is_fixed);
        let driven = self.model.rules.iter().filter_map(|rule| {
            let (body, length) = self.driven_length(rule, open, closed, from)?;
            Some(ClosingLength {
                body,
                length,
                // found to the gap that is left
                resolution: 10.0 * TRACED * self.size,
                is_fixed,
            })
        });
        lengths.extend(driven);
        lengths
    }

    /// A link that a drive turns and the length with which a constraint closes: this length is in no constraint. A change of it changes the gap by no more, so a change
    /// by the gap that is left passes no length with which the loop closes (sphere tracing, Hart 1996, The Visual Computer 12:527).
    fn driven_length(
        &self,
        rule: &Rule,
        open: usize,
        closed: &[usize],
        from: &State,
    ) -> Option<(usize, f64)> {
        let Rule::Turn {
            pivot,
            point: (x, at),
            theta: None,
            ..
        } = *rule
        else {
            return None;
        };
        let bodies = self.model.bodies();
        let body = bodies
            .iter()
            .position(|body| [x, pivot].iter().all(|x| body.placed.x.contains(x)))?;
        let direction = (pair(&from.q, x) - pair(&from.q, pivot)).normalize();
        let own = at.norm();
        let first = self.size_of_gap(open, from);
        let search = |sign: f64| {
            let (mut state, mut length, mut gap) = (from.clone(), own, first);
            for _ in 0..STEPS {
                length += sign * gap;
                if !(0.0..FARTHEST * self.size).contains(&length) {
                    return None;
                }
                let end = pair(&state.q, pivot) + length * direction;
                state.q[x..x + 2].copy_from_slice(end.as_slice());
                self.model.move_driven_nodes(&mut state);
                state = self.least(open, closed, &self.closes(closed, &state)?);
                let left = self.size_of_gap(open, &state);
                if left <= TRACED * self.size {
                    return Some(length);
                }
                // a link of another loop changes nothing
                if length == own + sign * first && (left - first).abs() <= TRACED * self.size {
                    return None;
                }
                gap = left;
            }
            None
        };
        let found = [1.0, -1.0].into_iter().filter_map(search);
        let closest = found.min_by(|a, b| (a - own).abs().total_cmp(&(b - own).abs()))?;
        Some((body, closest))
    }
}

/// One step of Newton's method of least norm on Phi = 0 over the coordinates that are not held; returns the largest move.
pub(crate) fn closing_step(model: &Model, state: &mut State, held: &[bool]) -> Update {
    step_to(model, state, held, &vec![0.0; model.shape.multipliers])
}

/// The same on Phi = goal.
fn step_to(model: &Model, state: &mut State, held: &[bool], goal: &[f64]) -> Update {
    let mut rows = constraint_rows(model, state);
    for row in &mut rows {
        row.retain(|(i, _)| !held[*i]);
    }
    let values = model.constraints.iter().flat_map(|placed| {
        let value = placed.term.value(state);
        (0..placed.rows).map(move |d| goal[placed.row + d] - value[d])
    });
    let values: Vec<f64> = values.collect();
    let step = IndependentRows::new(held.len(), &rows, &values).least_norm();
    for (q, dq) in state.q.iter_mut().zip(&step) {
        *q += dq;
    }
    Update::largest(step.iter().copied())
}

/// The largest violation of a constraint Phi = goal above a tolerance, and the constraint.
fn open<'m>(
    model: &'m Model,
    state: &State,
    goal: &[f64],
    tolerance: f64,
) -> Option<(f64, &'m PlacedConstraint)> {
    let constraints = model.constraints.iter();
    let opening = constraints.map(|p| {
        let value = p.term.value(state);
        let rows = (0..p.rows).map(|d| goal[p.row + d] - value[d]);
        (rows.fold(0.0, f64::hypot), p)
    });
    let widest = opening.max_by(|a, b| a.0.total_cmp(&b.0));
    widest.filter(|(x, _)| x.is_nan() || *x > tolerance)
}

/// Moves all coordinates that are not held in a mechanism of this length until every constraint has its value; returns the one with the
/// largest violation if that fails.
pub(crate) fn close_to<'m>(
    model: &'m Model,
    state: &mut State,
    held: &[bool],
    goal: &[f64],
    size: f64,
) -> Option<(f64, &'m PlacedConstraint)> {
    let closed = |state: &State| open(model, state, goal, CLOSED * size).is_none();
    if !closed(state) {
        // how it fails does not matter: what stays open says more
        let _ = iterate_interruptibly(ITERATIONS, |_| {
            let update = step_to(model, state, held, goal);
            Ok((update, closed(state)))
        });
    }
    open(model, state, goal, FITS * size)
}

impl OpenLoop<'_> {
    /// What stays open, and by how much.
    pub fn gap(&self, c: &Compiler, model: &Model) -> [String; 2] {
        let gap = numbers::number(self.gap, 3);
        let gap = format!("{gap} {}", self.constraint.term.unit());
        [self.place(c, model), gap]
    }

    /// What stays open, by how much, and what would close it.
    pub fn in_words(&self, c: &Compiler, model: &Model) -> String {
        let [place, gap] = self.gap(c, model);
        let is_fixed = self.lengths.iter().all(|length| length.is_fixed);
        let open = match is_fixed && !self.lengths.is_empty() {
            true => format!("{place} contradicts the other constraints, by {gap}"),
            false => format!("{place} stays open by {gap} at least, with all others closed"),
        };
        let others = match self.count {
            1 => "",
            2 => " (and another loop cannot close)",
            _ => " (and others cannot close)",
        };
        match self.remedy(c) {
            Some(remedy) => format!("{open}{others}; {remedy}"),
            None => format!("{open}{others}"),
        }
    }

    /// The joint that stays open, or what else does.
    fn place(&self, c: &Compiler, model: &Model) -> String {
        let ConstraintTerm::Length(_) = self.constraint.term else {
            return whole_name(model, self.constraint).to_owned();
        };
        let body = self.constraint.owners[0];
        let joints = [1, 0].into_iter().flat_map(|point| {
            let joints = c.joints_at(PointRef { body, point }).iter();
            joints.map(|(joint, partner)| (c.is_known(*partner), *joint))
        });
        match joints.min_by_key(|(known, _)| *known) {
            Some((_, joint)) => format!("joint {}", c.scene.joints[joint].name),
            None => name(model, self.constraint).to_owned(),
        }
    }

    /// The lengths that would close it, in words.
    fn remedy(&self, c: &Compiler) -> Option<String> {
        let lengths = self.lengths.iter().map(|closing| {
            let (b, length) = (closing.body, closing.length);
            let own = c.bodies[b].length().unwrap_or(length);
            let wanted = match (closing.is_fixed, length > own) {
                (true, _) => format!("{} m", resolved(length, closing.resolution)),
                (false, true) => format!("{} m or longer", directed(length, f64::ceil)),
                (false, false) => format!("{} m or shorter", directed(length, f64::floor)),
            };
            (&c.scene.bodies[b].name, wanted)
        });
        let lengths: Vec<_> = lengths.collect();
        let ((name, wanted), rest) = lengths.split_first()?;
        let rest = rest
            .iter()
            .map(|(name, wanted)| format!(", or {name} {wanted}"));
        Some(format!(
            "{name} would have to be {wanted}{}",
            rest.collect::<String>()
        ))
    }
}

/// A length whose last digit is worth the power of ten at or below a resolution.
fn resolved(length: f64, resolution: f64) -> String {
    let digits = length.abs().log10().floor() - resolution.log10().floor() + 1.0;
    numbers::number(length, digits.max(1.0) as usize)
}

/// A length with four digits, rounded in one direction: what is printed closes the loop.
fn directed(length: f64, round: fn(f64) -> f64) -> String {
    let digit = 10_f64.powi(length.abs().log10().floor() as i32 - 3);
    // a length that has four digits up to rounding has them
    let steps = length / digit;
    let nearest = steps.round();
    let steps = match (steps - nearest).abs() < 1e-6 {
        true => nearest,
        false => round(steps),
    };
    numbers::number(steps * digit, 4)
}

fn dot(x: &[f64], y: &[f64]) -> f64 {
    x.iter().zip(y).map(|(x, y)| x * y).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// No digits of the search, all of the length; rounding is less than the resolution.
    #[test]
    fn lengths_are_printed_to_their_resolution() {
        for (length, resolution, printed) in [
            (0.420_000_000_005, 5e-10, "0.42"),
            (0.419_999_999_995, 5e-10, "0.42"),
            (0.420_000_000_5, 5e-10, "0.4200000005"),
            (1_234.567_890_123, 2e-6, "1234.56789"),
            (4.2e-7, 5e-16, "4.2e-7"),
            (0.123_456_789, 5e-7, "0.1234568"),
        ] {
            assert_eq!(resolved(length, resolution), printed);
            let rounding = printed.parse::<f64>().unwrap() - length;
            assert!(rounding.abs() <= resolution, "{length}");
        }
    }
}

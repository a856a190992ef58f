//! Limits of drives: poses of the ideal mechanism beyond which a drive cannot go.
//!
//! With one parameter p, the value of a drive or the time, the poses Phi(q, p) = 0 form a curve. Where Phi_q is regular the curve is
//! followed by steps of p. At a limit it turns back: Phi_q loses rank, \[Phi_q, Phi_p\] does not, and dp/ds = 0 along the arc length
//! s. Steps of p shrink towards this fold, steps of s pass it (Keller 1977; Allgower and Georg 2003, Introduction to Numerical
//! Continuation Methods, chapters 2 and 6). In a pose where both matrices lose rank, such as that of a flat parallelogram, curves
//! cross and dp/ds does not vanish: a drive passes it.

use crate::math::groups::Groups;
use crate::math::independent_rows::IndependentRows;
use crate::math::larger;
use crate::math::saddle_point::SaddleFactors;
use crate::math::sparse_rows::SparseRow;
use crate::model::{Model, PlacedConstraint};
use crate::system::{State, System};
use faer::Mat;
use std::collections::HashMap;

/// The longest step moves no point farther than this part of the mechanism: a few degrees of a crank.
const LONGEST: f64 = 0.1;
/// A correction is at most this part of a step: what is left of a branch beside is farther away.
const CORRECTION: f64 = 0.1;
/// Newton's method stays on the branch where each update is at most this part of the one before (Deuflhard 2011, Newton Methods for
/// Nonlinear Problems, section 5.1: a contraction of 1/4).
const CONTRACTION: f64 = 0.25;
/// Newton's method has converged after an update below this part of the mechanism: the next one would be its square.
const LAST_UPDATE: f64 = 1e-9;
const ITERATIONS: usize = 8;
/// Growth of a step that succeeds, and part of one that fails which is tried next. No power of one is a power of the other, so that
/// steps do not meet the same singular pose again.
const GROWTH: f64 = 1.5;
const REDUCTION: f64 = 0.4;
/// Steps of p below this part of the longest one give way to steps of the arc length.
const SHORT: f64 = 1e-3;
/// First step of the arc length as a part of the mechanism, and the shortest one.
const ARC: f64 = 0.02;
const SHORTEST_ARC: f64 = 1e-8;
/// Steps along the arc, or towards a fold, before a curve counts as lost.
const ARC_STEPS: usize = 400;
/// A step of the arc length turns the tangent by less than 30 degrees.
const LEAST_COSINE: f64 = 0.87;
/// A dp/ds below this is one that vanishes; that of a fold changes its sign.
const FLAT: f64 = 1e-7;
/// The arc length of a fold as a part of the mechanism: p is stationary there, so its error is the square of this. A motion that ends
/// within this part of the longest step of p ends at the fold.
pub(crate) const LOCATED: f64 = 1e-9;
/// Multiply-adds that a trace may take: about a second.
const WORK: u64 = 400_000_000;
/// Multiply-adds, by their order of magnitude, of the evaluation of a constraint.
const CONSTRAINT: u64 = 100;
/// The same of a step of sparse algebra along the arc, for a coordinate.
const SPARSE: u64 = 50_000;
/// Parts of a null vector below this are rounding.
const TAKES_PART: f64 = 1e-6;

/// How a trace ends.
#[derive(Debug)]
pub(crate) enum End {
    /// At the value that was asked for.
    Reached,
    /// At a limit: the pose there, and the constraints whose forces are in equilibrium by themselves.
    Fold(Box<State>, Vec<usize>),
    /// Before either: the work allowed is spent, or the curve was lost.
    Open,
}

/// Follows the poses of a mechanism whose constraints determine all coordinates that they depend on; p is the time of its states.
pub(crate) struct Tracer<'m> {
    model: &'m Model,
    factors: SaddleFactors,
    phi: Vec<f64>,
    /// Right side, unknowns and multipliers.
    b: Vec<f64>,
    /// The length of the mechanism \[m\].
    size: f64,
    /// The largest change of p in a step at some p, by which no drive moves far.
    longest: &'m dyn Fn(f64) -> f64,
    /// Distance by which a unit change of a coordinate moves a point \[m\], for unknown coordinates.
    weights: Vec<f64>,
    /// Known coordinates that are lengths.
    positions: Vec<usize>,
    work: u64,
}

impl<'m> Tracer<'m> {
    /// Of a mechanism of this length, with changes of p in a step up to `longest` at some p.
    pub fn new(model: &'m Model, size: f64, longest: &'m dyn Fn(f64) -> f64) -> Tracer<'m> {
        let shape = model.shape();
        let (n, rows) = (shape.unknowns, shape.multipliers);
        let angles = model.known_angles();
        Tracer {
            factors: model.acceleration_matrix().factors(),
            phi: vec![0.0; rows],
            b: vec![0.0; n + rows],
            size,
            longest,
            weights: model.lengths(),
            positions: (n..shape.coordinates)
                .filter(|i| !angles.contains(i))
                .collect(),
            work: 0,
            model,
        }
    }

    fn norm(&self, x: &[f64]) -> f64 {
        let terms = x.iter().zip(&self.weights).map(|(x, w)| w * x);
        terms.fold(0.0, larger)
    }

    /// Follows the curve from a pose to p = `target`.
    pub fn trace(&mut self, state: &mut State, target: f64) -> End {
        let direction = (target - state.t).signum();
        if !self.begin(state) {
            return End::Open;
        }
        let mut trial = state.clone();
        let mut h = f64::INFINITY;
        while (target - state.t) * direction > 0.0 {
            if self.work > WORK {
                return End::Open;
            }
            let longest = self.longest_from(state);
            h = h.min(longest);
            let rest = (target - state.t).abs();
            let to = if h < rest {
                state.t + direction * h
            } else {
                target
            };
            if self.step(state, to, &mut trial) {
                std::mem::swap(state, &mut trial);
                h *= GROWTH;
                continue;
            }
            h = REDUCTION * h.min(rest);
            let longest = (self.longest)(state.t);
            if h < SHORT * longest {
                match self.turn(state, direction, target, longest) {
                    Turn::Passed(passed) => {
                        state.copy_from(&passed);
                        if (target - state.t) * direction <= LOCATED * longest {
                            return End::Reached;
                        }
                        if !self.begin(state) {
                            return End::Open;
                        }
                    }
                    Turn::Fold(pose, stressed) => return End::Fold(pose, stressed),
                    Turn::Lost => return End::Open,
                }
            }
        }
        End::Reached
    }

    /// The change of p that moves a point by the longest step.
    fn longest_from(&self, state: &State) -> f64 {
        let known = |x: &[f64]| self.positions.iter().map(|&i| x[i]).fold(0.0, larger);
        let n = self.weights.len();
        let [v, a] = [&state.v, &state.a].map(|x| larger(self.norm(&x[..n]), known(x)));
        let step = LONGEST * self.size;
        // v h + a h^2/2 = step
        let h = 2.0 * step / (v + (v * v + 2.0 * a * step).sqrt());
        h.min((self.longest)(state.t))
    }

    /// Puts known coordinates in place and finds the rates of a pose. False in a singular one.
    fn begin(&mut self, state: &mut State) -> bool {
        self.model.follow_rules(state);
        self.model.move_driven_nodes(state);
        let factored = self.factor(state);
        if factored {
            self.rates(state);
        }
        factored
    }

    fn factor(&mut self, state: &State) -> bool {
        let [factor, solve] = self.model.acceleration_matrix().operations();
        self.work += (factor + solve) as u64 + CONSTRAINT * self.phi.len() as u64;
        let factors = &mut self.factors;
        self.model
            .acceleration_level(state, &mut self.phi, &mut factors.gradient);
        self.model.acceleration_matrix().factor(factors).is_ok()
    }

    /// Solves Phi_q x = -phi for the x of least norm: the first entries of `self.b`.
    fn solve(&mut self) {
        let n = self.weights.len();
        for (b, phi) in self.b[n..].iter_mut().zip(&self.phi) {
            *b = -phi;
        }
        let matrix = self.model.acceleration_matrix();
        matrix.solve_rows(&mut self.factors, &mut self.b);
    }

    /// dq/dp and d2q/dp2 with the factors of the last iteration.
    fn rates(&mut self, state: &mut State) {
        let n = self.weights.len();
        state.v[..n].fill(0.0);
        state.a[..n].fill(0.0);
        self.model.constraint_velocity(state, &mut self.phi);
        self.solve();
        state.v[..n].copy_from_slice(&self.b[..n]);
        self.model.constraint_acceleration(state, &mut self.phi);
        self.solve();
        state.a[..n].copy_from_slice(&self.b[..n]);
    }

    /// A step to p = `to`, into `trial`. False where Newton's method may leave the branch.
    fn step(&mut self, from: &State, to: f64, trial: &mut State) -> bool {
        let n = self.weights.len();
        trial.copy_from(from);
        trial.t = to;
        let h = to - from.t;
        for i in 0..n {
            trial.q[i] += h * (from.v[i] + 0.5 * h * from.a[i]);
        }
        self.model.follow_rules(trial);
        self.model.move_driven_nodes(trial);
        let closed = self.correct(from, trial);
        if closed {
            self.rates(trial);
        }
        closed
    }

    fn correct(&mut self, from: &State, trial: &mut State) -> bool {
        let n = self.weights.len();
        let (mut first, mut last) = (f64::NAN, f64::INFINITY);
        for iteration in 0..ITERATIONS {
            if !self.factor(trial) {
                return false;
            }
            self.solve();
            trial
                .q
                .iter_mut()
                .zip(&self.b[..n])
                .for_each(|(q, d)| *q += d);
            let update = self.norm(&self.b[..n]);
            let converged = update <= LAST_UPDATE * self.size;
            if iteration == 0 {
                first = update;
            } else if !(converged || update <= CONTRACTION * last) {
                return false;
            }
            if converged {
                let moved: Vec<f64> = (0..n).map(|i| trial.q[i] - from.q[i]).collect();
                return first <= CORRECTION * self.norm(&moved) + LAST_UPDATE * self.size;
            }
            last = update;
        }
        false
    }

    /// Goes on along the arc from a pose near which steps of p fail.
    fn turn(&mut self, from: &State, direction: f64, target: f64, longest: f64) -> Turn {
        let n = self.weights.len();
        let speeds = (0..n).map(|i| (self.weights[i] * from.v[i]).abs());
        let fastest = speeds.enumerate().max_by(|a, b| a.1.total_cmp(&b.1));
        let Some((fastest, _)) = fastest else {
            return Turn::Lost;
        };
        let unit_of_p = LONGEST * self.size / longest;
        let arc = Arc::new(self.model, &self.weights, fastest, self.size, unit_of_p);
        let at = arc.tangent_of(from, direction);
        let Some(mut here) = arc.closed(from.clone(), &at) else {
            return Turn::Lost;
        };
        let along = |point: &ArcPoint| direction * point.tangent[arc.coordinates.len()];
        let mut ds = ARC * self.size;
        for _ in 0..ARC_STEPS {
            self.work += arc.work();
            let Some(next) = arc.step(&here, ds) else {
                ds *= REDUCTION;
                if ds < SHORTEST_ARC * self.size || self.work > WORK {
                    return Turn::Lost;
                }
                continue;
            };
            if along(&next) < -FLAT {
                let fold = arc.fold(&here, ds, direction);
                return match fold {
                    // the end of the motion comes first
                    Some(fold) if (target - fold.t) * direction < -LOCATED * longest => {
                        Turn::Passed(Box::new(fold))
                    }
                    Some(fold) => {
                        let stressed = arc.stressed(&fold);
                        Turn::Fold(Box::new(fold), stressed)
                    }
                    None => Turn::Lost,
                };
            }
            let ahead = (next.state.t - from.t) * direction;
            if ahead > 4.0 * SHORT * longest || (target - next.state.t) * direction <= 0.0 {
                return Turn::Passed(Box::new(next.state));
            }
            here = next;
            ds = (GROWTH * ds).min(LONGEST * self.size);
        }
        Turn::Lost
    }
}

/// What steps along the arc have found.
enum Turn {
    /// A limit, and the constraints under stress.
    Fold(Box<State>, Vec<usize>),
    /// The curve goes on in the direction of p.
    Passed(Box<State>),
    Lost,
}

/// The constraints and coordinates of one part of the mechanism, with p as one more coordinate.
struct Arc<'m> {
    model: &'m Model,
    /// Indices of constraints.
    constraints: Vec<usize>,
    coordinates: Vec<usize>,
    local: HashMap<usize, usize>,
    /// Factors by which coordinates, and p last, become lengths.
    weights: Vec<f64>,
    /// The length of the mechanism \[m\].
    size: f64,
}

/// A pose on the arc and the unit tangent there.
struct ArcPoint {
    state: State,
    tangent: Vec<f64>,
}

impl<'m> Arc<'m> {
    /// The part that has the coordinate `of`.
    fn new(model: &'m Model, weights: &[f64], of: usize, size: f64, weight_of_p: f64) -> Arc<'m> {
        let n = model.shape().unknowns;
        let kept = |c: &PlacedConstraint| c.kept[..c.rows].contains(&1.0);
        let own = |k: usize| {
            let coordinates = model.constraints[k].block.coordinates.iter();
            coordinates.copied().filter(|i| *i < n)
        };
        let all: Vec<usize> = (0..model.constraints.len())
            .filter(|&k| kept(&model.constraints[k]))
            .collect();
        let mut parts = Groups::new(n);
        for &k in &all {
            let mut coordinates = own(k);
            if let Some(first) = coordinates.next() {
                coordinates.for_each(|i| parts.unite(i, first));
            }
        }
        let part = parts.find(of);
        let constraints: Vec<usize> = all
            .into_iter()
            .filter(|&k| own(k).next().is_some_and(|i| parts.find(i) == part))
            .collect();
        let coordinates: Vec<usize> = (0..n).filter(|&i| parts.find(i) == part).collect();
        let mut weights: Vec<f64> = coordinates.iter().map(|&i| weights[i]).collect();
        weights.push(weight_of_p);
        Arc {
            model,
            constraints,
            local: coordinates.iter().copied().zip(0..).collect(),
            coordinates,
            weights,
            size,
        }
    }

    /// Multiply-adds of a step, by their order of magnitude.
    fn work(&self) -> u64 {
        let n = self.weights.len() as u64;
        // dense algebra, or sparse
        (4 * n.pow(3)).min(SPARSE * n)
    }

    /// The direction of motion, in lengths.
    fn tangent_of(&self, state: &State, direction: f64) -> Vec<f64> {
        let rates = self.coordinates.iter().map(|&i| state.v[i]);
        let all = rates.chain([1.0]).zip(&self.weights);
        normalised(all.map(|(v, w)| direction * w * v).collect())
    }

    /// Rows of \[Phi_q, Phi_p\] in lengths, and -Phi.
    fn equations(&self, state: &mut State) -> (Vec<SparseRow>, Vec<f64>) {
        let (n, p) = (self.model.shape().unknowns, self.coordinates.len());
        state.v[..n].fill(0.0);
        let (mut rows, mut values) = (Vec::new(), Vec::new());
        for &k in &self.constraints {
            let c = &self.model.constraints[k];
            let (value, gradient) = (c.term.value(state), c.term.gradient(state));
            let rate = c.term.velocity(state);
            for d in (0..c.rows).filter(|&d| c.kept[d] == 1.0) {
                let entries = c.block.coordinates.iter().zip(gradient[d]);
                let local = entries.filter_map(|(i, g)| Some((*self.local.get(i)?, g)));
                let all = local.chain([(p, rate[d])]);
                rows.push(all.map(|(i, g)| (i, g / self.weights[i])).collect());
                values.push(-value[d]);
            }
        }
        (rows, values)
    }

    fn moved(&self, state: &mut State, by: &[f64]) {
        for (&i, (y, w)) in self.coordinates.iter().zip(by.iter().zip(&self.weights)) {
            state.q[i] += y / w;
        }
        let p = self.coordinates.len();
        state.t += by[p] / self.weights[p];
        self.model.follow_rules(state);
        self.model.move_driven_nodes(state);
    }

    /// The point of the arc next to a state, with the tangent that goes on in a direction.
    fn closed(&self, mut state: State, direction: &[f64]) -> Option<ArcPoint> {
        let mut last = f64::INFINITY;
        for _ in 0..ITERATIONS {
            let (rows, values) = self.equations(&mut state);
            let independent = IndependentRows::new(self.weights.len(), &rows, &values);
            let update = independent.least_norm();
            self.moved(&mut state, &update);
            let update = update.iter().copied().fold(0.0, larger);
            if update <= LAST_UPDATE * self.size {
                let (rows, values) = self.equations(&mut state);
                let independent = IndependentRows::new(self.weights.len(), &rows, &values);
                let tangent = normalised(independent.free_part(direction));
                return Some(ArcPoint { state, tangent });
            }
            if update.is_nan() || update > CONTRACTION * last {
                return None;
            }
            last = update;
        }
        None
    }

    fn at(&self, from: &ArcPoint, s: f64) -> Option<ArcPoint> {
        let mut state = from.state.clone();
        let by: Vec<f64> = from.tangent.iter().map(|x| s * x).collect();
        self.moved(&mut state, &by);
        self.closed(state, &from.tangent)
    }

    /// A step of the arc length, unless it may leave the branch.
    fn step(&self, from: &ArcPoint, s: f64) -> Option<ArcPoint> {
        let next = self.at(from, s)?;
        (dot(&next.tangent, &from.tangent) > LEAST_COSINE).then_some(next)
    }

    /// The fold between a point and one that lies `s` farther: dp/ds = 0 by the secant method with a bracket (Illinois).
    fn fold(&self, from: &ArcPoint, s: f64, direction: f64) -> Option<State> {
        let p = self.coordinates.len();
        let slope = |point: &ArcPoint| direction * point.tangent[p];
        let (mut a, mut b) = ((0.0, slope(from)), (s, slope(&self.at(from, s)?)));
        let mut middle = self.at(from, s)?;
        for _ in 0..ARC_STEPS {
            if (b.0 - a.0).abs() <= LOCATED * self.size {
                break;
            }
            let at = (a.0 * b.1 - b.0 * a.1) / (b.1 - a.1);
            middle = self.at(from, at)?;
            let found = slope(&middle);
            if found == 0.0 {
                break;
            }
            if found * b.1 < 0.0 {
                a = b;
            } else {
                a.1 *= 0.5;
            }
            b = (at, found);
        }
        Some(middle.state)
    }

    /// The constraints whose forces are in equilibrium by themselves: Phi_q^T w = 0.
    fn stressed(&self, pose: &State) -> Vec<usize> {
        let (rows, _) = self.equations(&mut pose.clone());
        let p = self.coordinates.len();
        let mut matrix: Mat<f64> = Mat::zeros(rows.len(), p);
        for (k, row) in rows.iter().enumerate() {
            let own = row.iter().filter(|(i, _)| *i < p);
            own.for_each(|(i, g)| matrix[(k, *i)] += g);
        }
        let Ok(svd) = matrix.svd() else {
            return Vec::new();
        };
        let w: Vec<f64> = (0..rows.len())
            .map(|k| svd.U()[(k, rows.len() - 1)].abs())
            .collect();
        let largest = w.iter().copied().fold(0.0, f64::max);
        let mut k = 0;
        let mut stressed = Vec::new();
        for &constraint in &self.constraints {
            let c = &self.model.constraints[constraint];
            let count = (0..c.rows).filter(|&d| c.kept[d] == 1.0).count();
            if w[k..k + count].iter().any(|w| *w > TAKES_PART * largest) {
                stressed.push(constraint);
            }
            k += count;
        }
        stressed
    }
}

fn dot(x: &[f64], y: &[f64]) -> f64 {
    x.iter().zip(y).map(|(x, y)| x * y).sum()
}

fn normalised(mut x: Vec<f64>) -> Vec<f64> {
    let size = dot(&x, &x).sqrt();
    x.iter_mut().for_each(|x| *x /= size);
    x
}

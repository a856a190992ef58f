//! The first guess of a stage: its accelerations and multipliers extrapolated from those at earlier times.
//!
//! Between changes of contacts the motion is smooth, so the polynomial through the last accelerations is closer to those of a
//! stage than the last ones themselves. Newton's method then starts with an error of a higher order in the step. A step that
//! does not resolve the motion makes extrapolation worse than no extrapolation; the errors of both guesses of the last stage
//! decide which one the next stage takes.
//!
//! The accelerations and multipliers of a constrained stage on the position level differ from those of the acceleration level
//! by a term that is proportional to the step. This difference is remembered for the first stages of a step and added to the
//! extrapolated values.

use super::stage::Level;
use crate::checkpoint::carried;
use crate::system::{Shape, State};

/// Number of earlier times.
const NODES: usize = 3;
/// Two times nearly coincide if their distance is below this part of the distance to the time before them.
const COINCIDE: f64 = 1e-3;
/// Number of stages of a step whose shifts are remembered.
const STAGES: usize = 4;

/// The memory of the prediction.
#[derive(Debug)]
pub(super) struct Prediction {
    unknowns: usize,
    /// Earlier times, the latest first.
    nodes: [Earlier; NODES],
    /// How many of them are in use.
    known: usize,
    /// Changes of memory before all of them.
    changes: u64,
    /// True where extrapolation was better than no extrapolation.
    is_better: bool,
    /// How the stages of a step differ from the acceleration level; empty without constraints.
    shifts: Vec<Shift>,
    /// Beginning of the present step \[s\].
    start: f64,
    /// The present stage.
    stage: usize,
    /// The extrapolated values.
    guess: Vec<f64>,
}

carried!(Prediction { nodes, known, changes, is_better, shifts, start } but { unknowns, stage, guess });

/// Accelerations, then multipliers, at a time.
#[derive(Debug, Clone)]
struct Earlier {
    t: f64,
    values: Vec<f64>,
}

carried!(Earlier { t, values } but {});

/// How a stage differs from the acceleration level, in a step of length h; 0 where this is not known.
#[derive(Debug, Clone)]
struct Shift {
    h: f64,
    values: Vec<f64>,
}

carried!(Shift { h, values } but {});

impl Prediction {
    pub fn new(shape: Shape) -> Prediction {
        let size = shape.unknowns + shape.multipliers;
        let node = || Earlier {
            t: f64::NAN,
            values: vec![0.0; size],
        };
        let shift = Shift {
            h: 0.0,
            values: vec![0.0; size],
        };
        let stages = if shape.multipliers > 0 { STAGES } else { 0 };
        Prediction {
            unknowns: shape.unknowns,
            nodes: std::array::from_fn(|_| node()),
            known: 0,
            changes: 0,
            is_better: false,
            shifts: vec![shift; stages],
            start: 0.0,
            stage: 0,
            guess: vec![0.0; size],
        }
    }

    /// A step begins at `from`. Forgets all times if memory has changed, and returns true then. Forgets later times, unless
    /// this repeats a step with another length.
    pub fn begin_step(&mut self, from: &State) -> bool {
        let has_changed = self.changes != from.changes;
        if has_changed {
            self.changes = from.changes;
            self.forget_all();
        }
        if self.start != from.t || self.known == 0 {
            self.forget(|t| t >= from.t);
            self.add(from);
        }
        self.start = from.t;
        self.stage = 0;
        has_changed
    }

    /// Forgets the latest times as long as they are `late`.
    fn forget(&mut self, late: impl Fn(f64) -> bool) {
        while self.known > 0 && late(self.nodes[0].t) {
            self.nodes[..self.known].rotate_left(1);
            self.known -= 1;
        }
    }

    /// The step has failed: forgets what its stages have found.
    pub fn forget_step(&mut self) {
        let start = self.start;
        self.forget(|t| t > start);
        self.shifts.iter_mut().for_each(|shift| shift.h = 0.0);
    }

    /// Forgets everything.
    pub fn forget_all(&mut self) {
        self.known = 0;
        self.shifts.iter_mut().for_each(|shift| shift.h = 0.0);
    }

    /// Adds a later time, in place of the last one if the two nearly coincide.
    fn add(&mut self, at: &State) {
        let [last, before, _] = &self.nodes;
        let nearly_coincide = self.known > 1 && at.t - last.t < COINCIDE * (last.t - before.t);
        if !nearly_coincide {
            self.nodes.rotate_right(1);
            self.known = NODES.min(self.known + 1);
        }
        let (a, lambda) = self.nodes[0].values.split_at_mut(self.unknowns);
        a.copy_from_slice(&at.a[..self.unknowns]);
        lambda.copy_from_slice(&at.lambda);
        self.nodes[0].t = at.t;
    }

    /// Sets the guess of the next stage; false where nothing is known, and the guess remains as it is.
    pub fn guess(&mut self, level: Level, s: &mut State) -> bool {
        let weights = self.weights(s.t);
        self.guess.fill(0.0);
        for (node, weight) in self.nodes.iter().zip(weights).take(self.known) {
            for (x, y) in self.guess.iter_mut().zip(&node.values) {
                *x += weight * y;
            }
        }
        let mut is_changed = self.is_better && self.known > 1;
        if is_changed {
            let (a, lambda) = self.guess.split_at(self.unknowns);
            s.a[..self.unknowns].copy_from_slice(a);
            s.lambda.copy_from_slice(lambda);
        }
        if level == Level::Position
            && let Some(Shift { h, values }) = self.shifts.get(self.stage)
            && *h > 0.0
        {
            is_changed = true;
            let factor = (s.t - self.start) / h;
            let (a, lambda) = values.split_at(self.unknowns);
            let add = |x: &mut [f64], by: &[f64]| {
                x.iter_mut().zip(by).for_each(|(x, d)| *x += factor * d);
            };
            add(&mut s.a, a);
            add(&mut s.lambda, lambda);
        }
        is_changed
    }

    /// Replaces the guess by the values at the beginning of the step, or by the earliest ones that are known.
    pub fn take_back(&mut self, s: &mut State) {
        let known = &self.nodes[..self.known];
        let Some(node) = known.iter().find(|n| n.t <= self.start).or(known.last()) else {
            return;
        };
        let (a, lambda) = node.values.split_at(self.unknowns);
        s.a[..self.unknowns].copy_from_slice(a);
        s.lambda.copy_from_slice(lambda);
    }

    /// The stage is solved on the position level.
    pub fn solved(&mut self, s: &State) {
        if let Some(Shift { h, values }) = self.shifts.get_mut(self.stage) {
            *h = 0.0;
            let (a, lambda) = values.split_at_mut(self.unknowns);
            a.copy_from_slice(&s.a[..self.unknowns]);
            lambda.copy_from_slice(&s.lambda);
        }
    }

    /// The solved stage now has the accelerations and multipliers of the acceleration level.
    pub fn shifted(&mut self, s: &State) {
        if let Some(Shift { h, values }) = self.shifts.get_mut(self.stage) {
            *h = s.t - self.start;
            let (a, lambda) = values.split_at_mut(self.unknowns);
            a.iter_mut().zip(&s.a).for_each(|(d, a)| *d -= a);
            let multipliers = lambda.iter_mut().zip(&s.lambda);
            multipliers.for_each(|(d, lambda)| *d -= lambda);
        }
    }

    /// A stage ends, with the accelerations and multipliers of the acceleration level.
    pub fn finish(&mut self, s: &State) {
        self.stage += 1;
        if self.known > 1 {
            let error = |guess: &[f64]| {
                let errors =
                    s.a.iter()
                        .zip(&guess[..self.unknowns])
                        .map(|(a, g)| (a - g).abs());
                errors.fold(0.0, f64::max)
            };
            self.is_better = error(&self.guess) < error(&self.nodes[0].values);
        }
        if self.known > 0 && s.t > self.nodes[0].t {
            self.add(s);
        }
    }

    /// Weights of the polynomial through the known nodes at time t.
    fn weights(&self, t: f64) -> [f64; NODES] {
        let nodes = &self.nodes[..self.known];
        std::array::from_fn(|i| {
            let Some(own) = nodes.get(i) else { return 0.0 };
            let others = nodes.iter().enumerate().filter(|(j, _)| *j != i);
            others
                .map(|(_, other)| (t - other.t) / (own.t - other.t))
                .product()
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SHAPE: Shape = Shape {
        unknowns: 1,
        coordinates: 1,
        multipliers: 1,
        contacts: 1,
        crossings: 1,
        memory: 1,
        entries: 5,
    };

    /// A state whose acceleration and multiplier are quadratic functions of time.
    fn state(t: f64) -> State {
        let mut s = State::zeros(SHAPE);
        s.t = t;
        s.a[0] = 1.0 + 2.0 * t - 3.0 * t * t;
        s.lambda[0] = -1.0 + t + 5.0 * t * t;
        s
    }

    /// A step from `from` to t with one stage, whose solution on the position level is off by `off`; returns the error of the guess.
    fn step(prediction: &mut Prediction, from: &State, t: f64, off: f64) -> [f64; 2] {
        prediction.begin_step(from);
        let (mut guess, exact) = (from.clone(), state(t));
        guess.t = t;
        prediction.guess(Level::Position, &mut guess);
        let mut solved = exact.clone();
        solved.a[0] += off;
        solved.lambda[0] += off;
        prediction.solved(&solved);
        prediction.shifted(&exact);
        prediction.finish(&exact);
        [
            guess.a[0] - exact.a[0] - off,
            guess.lambda[0] - exact.lambda[0] - off,
        ]
    }

    #[test]
    fn quadratic_functions_are_extrapolated_exactly_until_a_contact_changes() {
        let mut prediction = Prediction::new(SHAPE);
        let times = [0.0, 0.1, 0.25, 0.3, 0.5, 0.6];
        let errors = times.windows(2).map(|t| {
            // off by a tenth of the step
            step(&mut prediction, &state(t[0]), t[1], 0.1 * (t[1] - t[0]))
        });
        let errors: Vec<_> = errors.collect();
        for error in errors.last().unwrap() {
            // a few roundings of numbers of the order of one
            assert!(error.abs() < 1e-14, "{errors:?}");
        }
        // the first step has nothing to extrapolate from
        assert!(errors[0][0].abs() > 0.1);

        // a contact closes: only the last values are known
        let mut closed = state(0.6);
        closed.changes += 1;
        let [error, _] = step(&mut prediction, &closed, 0.7, 0.0);
        assert_eq!(error, closed.a[0] - state(0.7).a[0]);
    }

    #[test]
    fn after_a_failure_the_beginning_of_the_step_is_known() {
        let mut prediction = Prediction::new(SHAPE);
        for t in [0.0, 0.1, 0.2] {
            step(&mut prediction, &state(t), t + 0.1, 0.0);
        }
        let from = state(0.3);
        prediction.begin_step(&from);
        let mut guess = from.clone();
        guess.t = 0.4;
        assert!(prediction.guess(Level::Position, &mut guess));
        assert_ne!(guess.a, from.a);
        prediction.solved(&guess);
        prediction.finish(&guess);
        prediction.forget_step();
        prediction.begin_step(&from);
        prediction.take_back(&mut guess);
        assert_eq!((&guess.a, &guess.lambda), (&from.a, &from.lambda));
    }
}

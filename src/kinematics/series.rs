//! The motion of the ideal mechanism over a span of time as Chebyshev series.
//!
//! Inverse kinematics is evaluated at every stage of every step, far more often than a smooth path requires. On a short span
//! of a smooth path the values of q, v and a at the nodes of a Chebyshev polynomial determine them everywhere to rounding,
//! each by its own series (Trefethen 2013, Approximation Theory and Approximation Practice, chapters 3 and 8). A span is
//! accepted only if its last coefficients are rounding; otherwise it is halved. Where no span is long enough for several
//! steps, at kinks of the path or near singular poses, the kinematics is solved at every time.

use super::{Inner, Kinematics};
use crate::checkpoint::carried;
use crate::math::larger;
use crate::system::State;
use std::f64::consts::PI;

/// Degree of the polynomials.
const DEGREE: usize = 10;
const NODES: usize = DEGREE + 1;
/// Last coefficients that must be rounding, one of an even and one of an odd function; they are left out of the sums.
const TAIL: usize = 2;
const TERMS: usize = NODES - TAIL;
/// What counts as rounding, relative to the largest: of a position and of rates, which solving leaves less exact.
const ROUNDING: [f64; 3] = [2.0 * f64::EPSILON, 16.0 * f64::EPSILON, 16.0 * f64::EPSILON];
/// A span pays if it is this many steps long.
const STEPS: f64 = 32.0;
/// Part of the whole path that is tried first.
const FIRST_SPAN: f64 = 1.0 / 16.0;

/// Series over the present span, and how long the next one may be.
#[derive(Debug, Clone)]
pub(crate) struct Series {
    start: f64,
    end: f64,
    /// The length to try next \[s\].
    span: f64,
    /// Until then the path is too rough \[s\].
    rough_until: f64,
    /// Of q of the moving coordinates, then v, then a, one row for each degree.
    coefficients: Vec<f64>,
    /// Values at the nodes, one row for each node.
    values: Vec<f64>,
    /// The values of the functions at a time.
    sum: Vec<f64>,
}

carried!(Series { start, end, span, rough_until, coefficients } but { values, sum });

/// cos(i pi/n), n the degree, with the symmetries that make the sums over all nodes vanish.
fn cosine(i: usize) -> f64 {
    let angle = |i: usize| i as f64 * PI / DEGREE as f64;
    match i % (2 * DEGREE) {
        i if 2 * i <= DEGREE => angle(i).cos(),
        i if 2 * i <= 3 * DEGREE => -angle(i.abs_diff(DEGREE)).cos(),
        i => angle(2 * DEGREE - i).cos(),
    }
}

impl Series {
    /// Memory for a number of moving coordinates; `period` is the time in which the path shows all its poses.
    pub fn new(moving: usize, period: f64) -> Series {
        Series {
            start: 0.0,
            end: f64::NEG_INFINITY,
            span: FIRST_SPAN * period,
            rough_until: f64::NEG_INFINITY,
            coefficients: vec![0.0; 3 * moving * NODES],
            values: vec![0.0; 3 * moving * NODES],
            sum: vec![0.0; 3 * moving],
        }
    }

    /// From values at the nodes cos(j pi/n), both ends among them, to coefficients, c_k = (2/n) sum_j f_j cos(k j pi/n), half of
    /// the first and the last of either; true if the last ones are rounding.
    fn fit(&mut self) -> bool {
        let width = self.sum.len();
        self.coefficients.fill(0.0);
        for (k, row) in self.coefficients.chunks_exact_mut(width).enumerate() {
            let half = |i: usize| if i.is_multiple_of(DEGREE) { 0.5 } else { 1.0 };
            let weight = 2.0 * half(k) / DEGREE as f64;
            for (j, values) in self.values.chunks_exact(width).enumerate() {
                let factor = weight * half(j) * cosine(k * j);
                for (c, x) in row.iter_mut().zip(values) {
                    *c += factor * x;
                }
            }
        }
        let third = width / 3;
        (0..3).all(|level| {
            let largest = |rows: &[f64]| {
                let rows = rows.chunks_exact(width);
                let level = rows.flat_map(|row| &row[level * third..(level + 1) * third]);
                level.fold(0.0, |m, x| larger(m, *x))
            };
            let size = largest(&self.values);
            let tail = largest(&self.coefficients[TERMS * width..]);
            size.is_finite() && tail <= ROUNDING[level] * size
        })
    }

    /// Sums the series at time t: sum_k c_k T_k(x).
    fn evaluate(&mut self, t: f64) {
        let x = ((t - self.start) - (self.end - t)) / (self.end - self.start);
        let mut polynomials = [1.0; TERMS];
        polynomials[1] = x;
        for k in 2..TERMS {
            polynomials[k] = 2.0 * x * polynomials[k - 1] - polynomials[k - 2];
        }
        let width = self.sum.len();
        // slices of one length, so that the loop over functions needs no checks
        let rows: [&[f64]; TERMS] =
            std::array::from_fn(|k| &self.coefficients[k * width..][..width]);
        for (i, sum) in self.sum.iter_mut().enumerate() {
            let mut value = 0.0;
            for (row, polynomial) in rows.iter().zip(&polynomials) {
                value += row[i] * polynomial;
            }
            *sum = value;
        }
    }
}

impl Kinematics {
    /// Sets the moving coordinates of the ideal mechanism in `to` from the series that holds its time, or from a new one
    /// that begins at `from`. False where none is to be had.
    pub(super) fn follow_series(&self, from: &State, to: &mut State, inner: &mut Inner) -> bool {
        let held = inner.series.start <= to.t && to.t <= inner.series.end;
        if !held && !self.renew_series(from, to.t, inner) {
            return false;
        }
        inner.series.evaluate(to.t);
        let count = self.moving.len();
        let (q, rates) = inner.series.sum.split_at(count);
        let (v, a) = rates.split_at(count);
        for (all, values) in [(&mut to.q, q), (&mut to.v, v), (&mut to.a, a)] {
            let all = &mut all[self.offset..];
            for (&i, value) in self.moving.iter().zip(values) {
                all[i] = *value;
            }
        }
        true
    }

    /// Finds the series of a span from `from` on that holds time t. An earlier time is in no such span.
    fn renew_series(&self, from: &State, t: f64, inner: &mut Inner) -> bool {
        let shortest = STEPS * (t - from.t);
        let rest = self.duration - from.t;
        if t <= from.t || t < inner.series.rough_until || shortest > rest {
            return false;
        }
        let mut span = inner.series.span.min(rest);
        while span >= shortest {
            inner.series.start = from.t;
            inner.series.end = if span < rest {
                from.t + span
            } else {
                self.duration
            };
            if self.solve_nodes(from, inner) && inner.series.fit() {
                inner.series.span = 2.0 * span;
                return true;
            }
            span *= 0.5;
        }
        inner.series.end = f64::NEG_INFINITY;
        inner.series.rough_until = from.t + shortest;
        inner.series.span = shortest;
        false
    }

    /// Solves for the values at all nodes, from the earliest to the latest.
    fn solve_nodes(&self, from: &State, inner: &mut Inner) -> bool {
        let count = self.moving.len();
        let (start, end) = (inner.series.start, inner.series.end);
        let (middle, half) = (0.5 * (start + end), 0.5 * (end - start));
        self.begin(from, inner);
        for j in (0..NODES).rev() {
            let t = middle + half * cosine(j);
            if self.move_to(t, inner).is_err() {
                return false;
            }
            let values = &mut inner.series.values[3 * count * j..3 * count * (j + 1)];
            for (k, &i) in self.moving.iter().enumerate() {
                values[k] = inner.state.q[i];
                values[count + k] = inner.state.v[i];
                values[2 * count + k] = inner.state.a[i];
            }
        }
        true
    }
}

#[cfg(test)]
mod tests {
    use crate::compile::compile;
    use crate::initial;
    use crate::scene::Scene;
    use std::path::Path;

    /// Follows the path of a scene in steps, by series and by solving; returns the part of times that a series gave and the
    /// largest differences in q, v and a, relative to the largest value of each.
    fn compared(overrides: &[&str], step: f64, count: usize) -> (f64, [f64; 3]) {
        let overrides = overrides.iter().map(|s| (*s).to_owned());
        let scene = Scene::load(
            Path::new("scenes/3rrr/case3.toml"),
            &overrides.collect::<Vec<_>>(),
        )
        .unwrap();
        let compiled = compile(&scene).unwrap();
        let kinematics = compiled.kinematics.as_ref().unwrap();
        let [mut inner, mut other] = [kinematics.work(), kinematics.work()];
        let mut from = initial::start(&scene, &compiled).unwrap();
        let (mut to, mut solved) = (from.clone(), from.clone());
        let n = compiled.model.shape().unknowns;
        let (mut differences, mut sizes, mut series) = ([0.0_f64; 3], [0.0_f64; 3], 0);
        for k in 1..=count {
            to.t = k as f64 * step;
            solved.t = to.t;
            kinematics.prescribe(&from, &mut to, &mut inner).unwrap();
            series += usize::from(to.t <= inner.series.end);
            kinematics.solve_at(&from, &mut solved, &mut other).unwrap();
            let levels = [(&to.q, &solved.q), (&to.v, &solved.v), (&to.a, &solved.a)];
            for (l, (x, y)) in levels.into_iter().enumerate() {
                for (x, y) in x[n..].iter().zip(&y[n..]) {
                    differences[l] = differences[l].max((x - y).abs());
                    sizes[l] = sizes[l].max(y.abs());
                }
            }
            from.copy_from(&to);
        }
        let relative = std::array::from_fn(|l| differences[l] / sizes[l]);
        (series as f64 / count as f64, relative)
    }

    // rounding: each is a sum of 13 terms whose data carry the rounding of solving for them, of rates some 16 times as large
    const BOUNDS: [f64; 3] = [8.0 * f64::EPSILON, 64.0 * f64::EPSILON, 64.0 * f64::EPSILON];

    #[test]
    fn series_are_what_solving_gives() {
        let (share, differences) = compared(&[], 1e-4, 10_000);
        assert!(share > 0.99, "{share}");
        for (difference, bound) in differences.iter().zip(BOUNDS) {
            assert!(*difference < bound, "{differences:?}");
        }
    }

    #[test]
    fn a_path_with_kinks_is_solved_for_where_it_bends() {
        let path = "drives.input.path={ type = \"table\", rows = [[0, 0.1, 0, 0], [0.1, 0.09, 0, 0], [0.2, 0.09, 0.02, 0.1], [0.3, 0.1, 0.02, 0], [0.4, 0.1, 0, 0]] }";
        let (share, differences) = compared(&[path, "simulation.duration=0.4"], 1e-5, 40_000);
        assert!(share > 0.8 && share < 1.0, "{share}");
        for (difference, bound) in differences.iter().zip(BOUNDS) {
            assert!(*difference < bound, "{differences:?}");
        }
    }

    /// A scheme may go back to an earlier stage, or repeat a step that was too long.
    #[test]
    fn times_before_a_span_are_solved_for() {
        let scene = Scene::load(Path::new("scenes/3rrr/case3.toml"), &[]).unwrap();
        let compiled = compile(&scene).unwrap();
        let kinematics = compiled.kinematics.as_ref().unwrap();
        let mut inner = kinematics.work();
        let start = initial::start(&scene, &compiled).unwrap();
        let (mut from, mut to, mut solved) = (start.clone(), start.clone(), start);
        from.t = 1e-3;
        kinematics
            .solve_at(&to, &mut from, &mut kinematics.work())
            .unwrap();
        for t in [1.1e-3, 0.9e-3] {
            (to.t, solved.t) = (t, t);
            kinematics.prescribe(&from, &mut to, &mut inner).unwrap();
            assert_eq!(inner.series.start, from.t);
            kinematics
                .solve_at(&from, &mut solved, &mut kinematics.work())
                .unwrap();
            let n = compiled.model.shape().unknowns;
            for (x, y) in to.q[n..].iter().zip(&solved.q[n..]) {
                // coordinates are of the order of a metre
                assert!((x - y).abs() < BOUNDS[0], "{t}: {x} {y}");
            }
        }
    }

    #[test]
    fn steps_too_long_for_a_series_are_solved_for() {
        let (share, differences) = compared(&[], 0.01, 100);
        assert_eq!((share, differences), (0.0, [0.0; 3]));
    }
}

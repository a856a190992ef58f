//! A natural cubic spline through a table.

use super::{Knot, POSES, Path, Pose};

/// Twice continuously differentiable, with zero second derivatives at both ends.
#[derive(Debug, Clone)]
pub struct CubicSpline<const N: usize> {
    times: Vec<f64>,
    values: Vec<[f64; N]>,
    /// Second derivatives at the knots.
    curvatures: Vec<[f64; N]>,
}

impl<const N: usize> CubicSpline<N> {
    /// A spline through values at increasing times, two at least.
    pub fn new(rows: impl Iterator<Item = (f64, [f64; N])>) -> CubicSpline<N> {
        let (times, values): (Vec<_>, Vec<_>) = rows.unzip();
        let n = times.len();
        let mut curvatures = vec![[0.0; N]; n];
        // tridiagonal system h_{k-1} m_{k-1} + 2 (h_{k-1} + h_k) m_k + h_k m_{k+1} = 6 (slope_k - slope_{k-1})
        let mut factor = vec![0.0; n];
        for k in 1..n - 1 {
            let (before, after) = (times[k] - times[k - 1], times[k + 1] - times[k]);
            let pivot = 2.0 * (before + after) - before * factor[k - 1];
            factor[k] = after / pivot;
            for i in 0..N {
                let slopes = (values[k + 1][i] - values[k][i]) / after
                    - (values[k][i] - values[k - 1][i]) / before;
                curvatures[k][i] = (6.0 * slopes - before * curvatures[k - 1][i]) / pivot;
            }
        }
        for k in (1..n - 1).rev() {
            for i in 0..N {
                curvatures[k][i] -= factor[k] * curvatures[k + 1][i];
            }
        }
        CubicSpline {
            times,
            values,
            curvatures,
        }
    }

    /// Its rows, at which its third derivative jumps.
    pub(super) fn rows(&self) -> Vec<Knot> {
        self.times.iter().map(|&t| Knot::at(t, 3)).collect()
    }

    /// The values of its rows.
    pub(crate) fn values(&self) -> &[[f64; N]] {
        &self.values
    }

    /// Values, first and second derivatives at time t.
    pub fn derivatives(&self, t: f64) -> [[f64; N]; 3] {
        let k = self
            .times
            .partition_point(|&x| x <= t)
            .clamp(1, self.times.len() - 1);
        let h = self.times[k] - self.times[k - 1];
        let (a, b) = ((self.times[k] - t) / h, (t - self.times[k - 1]) / h);
        let mut result = [[0.0; N]; 3];
        for i in 0..N {
            let (y0, y1) = (self.values[k - 1][i], self.values[k][i]);
            let (m0, m1) = (self.curvatures[k - 1][i], self.curvatures[k][i]);
            let sixth = h * h / 6.0;
            result[0][i] = a * y0 + b * y1 + sixth * ((a * a * a - a) * m0 + (b * b * b - b) * m1);
            result[1][i] =
                (y1 - y0) / h + h / 6.0 * ((3.0 * b * b - 1.0) * m1 - (3.0 * a * a - 1.0) * m0);
            result[2][i] = a * m0 + b * m1;
        }
        result
    }
}

/// Where a spline leaves the range of the two rows between which it lies.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Overshoot {
    /// When it is farthest outside \[s\].
    pub t: f64,
    /// Its value there.
    pub value: f64,
    /// The values of the two rows.
    pub rows: [f64; 2],
}

/// An overshoot is reported beyond this part of the range of the values. Of runs the same part of a range of motion is warned of.
const REPORTED: f64 = 0.01;

impl<const N: usize> CubicSpline<N> {
    /// The largest overshoot of one of the values, if it is more than a hundredth of their range.
    pub fn overshoot(&self, i: usize) -> Option<Overshoot> {
        let values = || self.values.iter().map(|row| row[i]);
        let range =
            values().fold(f64::NEG_INFINITY, f64::max) - values().fold(f64::INFINITY, f64::min);
        let beyond = |x: &Overshoot| {
            let [least, most] = [x.rows[0].min(x.rows[1]), x.rows[0].max(x.rows[1])];
            (x.value - most).max(least - x.value)
        };
        let turns = (1..self.times.len()).flat_map(|k| self.turns(k, i));
        let largest = turns.max_by(|a, b| beyond(a).total_cmp(&beyond(b)));
        largest.filter(|x| beyond(x) > REPORTED * range)
    }

    /// The extremes inside the interval that ends with a row: the roots of the slope
    /// S + h/6 ((3 b^2 - 1) m_1 - (3 a^2 - 1) m_0) with b between 0 and 1 and a = 1 - b.
    fn turns(&self, k: usize, i: usize) -> impl Iterator<Item = Overshoot> + '_ {
        let rows = [self.values[k - 1][i], self.values[k][i]];
        let (from, h) = (self.times[k - 1], self.times[k] - self.times[k - 1]);
        let (m0, m1) = (self.curvatures[k - 1][i], self.curvatures[k][i]);
        let square = 3.0 * (m1 - m0);
        let constant = 6.0 * (rows[1] - rows[0]) / (h * h) - m1 - 2.0 * m0;
        // half of the linear coefficient is 3 m_0; of the two forms of a root each is used where it does not cancel
        let root = (9.0 * m0 * m0 - square * constant).sqrt();
        let sum = -(3.0 * m0 + root.copysign(m0));
        let roots = [sum / square, constant / sum].into_iter();
        let inside = roots.filter(|b| (0.0..=1.0).contains(b));
        inside.map(move |b| {
            let t = from + b * h;
            let value = self.derivatives(t)[0][i];
            Overshoot { t, value, rows }
        })
    }
}

/// A number of poses on a table: 20 between neighbouring rows, wherever they are closest.
pub(super) fn poses_between(times: &[f64], duration: f64) -> usize {
    let shortest = times.windows(2).map(|w| w[1] - w[0]);
    let shortest = shortest.fold(f64::INFINITY, f64::min);
    POSES.max((20.0 * duration / shortest).ceil() as usize)
}

impl Path for CubicSpline<3> {
    fn at(&self, t: f64) -> Pose {
        Pose::of_derivatives(self.derivatives(t))
    }

    fn sweep(&self, duration: f64) -> (f64, usize) {
        (duration, poses_between(&self.times, duration))
    }

    fn knots(&self, _: f64) -> Vec<Knot> {
        self.rows()
    }
}

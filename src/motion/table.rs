//! A natural cubic spline through a table.

use super::{POSES, Path, Pose};

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

impl Path for CubicSpline<3> {
    fn at(&self, t: f64) -> Pose {
        let [position, velocity, acceleration] = self.derivatives(t);
        Pose {
            position,
            velocity,
            acceleration,
        }
    }

    fn sweep(&self, duration: f64) -> (f64, usize) {
        let shortest = self.times.windows(2).map(|w| w[1] - w[0]);
        let shortest = shortest.fold(f64::INFINITY, f64::min);
        // 20 poses between neighbouring rows, wherever they are closest
        (
            duration,
            POSES.max((20.0 * duration / shortest).ceil() as usize),
        )
    }
}

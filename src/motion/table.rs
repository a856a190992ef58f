//! A natural cubic spline through a table of poses.

use super::{Motion, POSES, Path};

/// Twice continuously differentiable, with zero second derivatives at both ends.
#[derive(Debug, Clone)]
pub struct Table {
    times: Vec<f64>,
    values: Vec<[f64; 3]>,
    /// Second derivatives at the knots.
    curvatures: Vec<[f64; 3]>,
}

impl Table {
    /// A spline through rows (t, x, y, theta) with increasing times, two rows at least.
    pub fn new(rows: &[[f64; 4]]) -> Table {
        let times: Vec<f64> = rows.iter().map(|r| r[0]).collect();
        let values: Vec<[f64; 3]> = rows.iter().map(|r| [r[1], r[2], r[3]]).collect();
        let n = rows.len();
        let mut curvatures = vec![[0.0; 3]; n];
        // tridiagonal system h_{k-1} m_{k-1} + 2 (h_{k-1} + h_k) m_k + h_k m_{k+1} = 6 (slope_k - slope_{k-1})
        let mut factor = vec![0.0; n];
        for k in 1..n - 1 {
            let (before, after) = (times[k] - times[k - 1], times[k + 1] - times[k]);
            let pivot = 2.0 * (before + after) - before * factor[k - 1];
            factor[k] = after / pivot;
            for i in 0..3 {
                let slopes = (values[k + 1][i] - values[k][i]) / after
                    - (values[k][i] - values[k - 1][i]) / before;
                curvatures[k][i] = (6.0 * slopes - before * curvatures[k - 1][i]) / pivot;
            }
        }
        for k in (1..n - 1).rev() {
            for i in 0..3 {
                curvatures[k][i] -= factor[k] * curvatures[k + 1][i];
            }
        }
        Table {
            times,
            values,
            curvatures,
        }
    }
}

impl Path for Table {
    fn at(&self, t: f64) -> Motion {
        let k = self
            .times
            .partition_point(|&x| x <= t)
            .clamp(1, self.times.len() - 1);
        let h = self.times[k] - self.times[k - 1];
        let (a, b) = ((self.times[k] - t) / h, (t - self.times[k - 1]) / h);
        let mut motion = Motion::default();
        for i in 0..3 {
            let (y0, y1) = (self.values[k - 1][i], self.values[k][i]);
            let (m0, m1) = (self.curvatures[k - 1][i], self.curvatures[k][i]);
            let sixth = h * h / 6.0;
            motion.position[i] =
                a * y0 + b * y1 + sixth * ((a * a * a - a) * m0 + (b * b * b - b) * m1);
            motion.velocity[i] =
                (y1 - y0) / h + h / 6.0 * ((3.0 * b * b - 1.0) * m1 - (3.0 * a * a - 1.0) * m0);
            motion.acceleration[i] = a * m0 + b * m1;
        }
        motion
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

//! Scalar functions of time with exact first and second derivatives: prescribed coordinates, angles, loads.

use super::{CubicSpline, Expression, Knot, MonotoneQuintic, line::quintic};
use std::f64::consts::TAU;
use std::fmt::Debug;
use std::sync::Arc;

/// A function of time that the library does not have. Its values must be finite throughout a run.
pub trait FunctionOfTime: Debug + Send + Sync {
    /// Value, first and second derivative at time t \[s\]. Of a load the derivatives are not used.
    fn at(&self, t: f64) -> [f64; 3];
    /// Where it is not smooth, up to a time \[s\]: steps end there.
    fn knots(&self, _until: f64) -> Vec<Knot> {
        Vec::new()
    }
}

/// A function of time.
#[derive(Debug, Clone)]
pub enum Function {
    /// The same value at all times.
    Constant(f64),
    /// c_0 + c_1 t + c_2 t^2 + ...
    Polynomial(Vec<f64>),
    /// mean + amplitude sin(2 pi frequency t + phase).
    Harmonic {
        /// Value it swings about.
        mean: f64,
        /// Largest deviation from it.
        amplitude: f64,
        /// Periods a second \[Hz\].
        frequency: f64,
        /// Phase at t = 0 \[rad\].
        phase: f64,
    },
    /// From one value to another, linear in time, constant before and after; its second derivative is left at zero.
    Ramp(Step),
    /// From one value to another by the quintic 10 u^3 - 15 u^4 + 6 u^5, twice continuously differentiable.
    SmoothStep(Step),
    /// start + speed/T (t^2/2 + (T/2 pi)^2 (cos(2 pi t/T) - 1)) up to T = `duration`, then at constant `speed`
    /// (Simo and Vu-Quoc 1986).
    SpinUp {
        /// Value at t = 0.
        start: f64,
        /// Final rate \[1/s\].
        speed: f64,
        /// T \[s\].
        duration: f64,
    },
    /// A natural cubic spline through (t, value).
    Table(CubicSpline<1>),
    /// A monotone interpolant of (t, value), see [`MonotoneQuintic`].
    MonotoneTable(MonotoneQuintic<1>),
    /// A formula in t.
    Expression(Expression),
    /// Straight lines between rows (t, value), two at least, constant before and after; its second derivative is left at zero.
    Piecewise(Vec<[f64; 2]>),
    /// One of the program that uses the library.
    Own(Arc<dyn FunctionOfTime>),
}

/// From one value to another.
#[derive(Debug, Clone, Copy)]
pub struct Step {
    /// Value before.
    pub from: f64,
    /// Value after.
    pub to: f64,
    /// When it begins \[s\].
    pub start: f64,
    /// How long it takes \[s\].
    pub duration: f64,
}

impl Step {
    fn ends(&self) -> [f64; 2] {
        [self.start, self.start + self.duration]
    }
}

impl Function {
    /// A spline through rows (t, value) with increasing times, two rows at least.
    pub fn table(rows: &[[f64; 2]]) -> Function {
        Function::Table(CubicSpline::new(
            rows.iter().map(|&[t, value]| (t, [value])),
        ))
    }

    /// A monotone interpolant of rows (t, value) with increasing times, two rows at least.
    pub fn monotone_table(rows: &[[f64; 2]]) -> Function {
        let rows = rows.iter().map(|&[t, value]| (t, [value]));
        Function::MonotoneTable(MonotoneQuintic::new(rows))
    }

    /// Where it is not smooth, up to a time \[s\].
    pub fn knots(&self, until: f64) -> Vec<Knot> {
        let at = |times: &[f64], level| times.iter().map(|&t| Knot::at(t, level)).collect();
        match self {
            Function::Constant(_) | Function::Polynomial(_) | Function::Harmonic { .. } => {
                Vec::new()
            }
            Function::Ramp(step) => at(&step.ends(), 1),
            Function::SmoothStep(step) => at(&step.ends(), 3),
            Function::SpinUp { duration, .. } => at(&[*duration], 4),
            Function::Table(table) => table.rows(),
            Function::MonotoneTable(table) => table.rows(),
            Function::Expression(expression) => expression.knots(until),
            Function::Piecewise(rows) => rows.iter().map(|[t, _]| Knot::at(*t, 1)).collect(),
            Function::Own(function) => function.knots(until),
        }
    }

    /// Value, first and second derivative at time t \[s\].
    pub fn at(&self, t: f64) -> [f64; 3] {
        match self {
            Function::Constant(value) => [*value, 0.0, 0.0],
            Function::Polynomial(coefficients) => {
                let mut value = [0.0; 3];
                for c in coefficients.iter().rev() {
                    value[2] = value[2] * t + 2.0 * value[1];
                    value[1] = value[1] * t + value[0];
                    value[0] = value[0] * t + c;
                }
                value
            }
            Function::Harmonic {
                mean,
                amplitude,
                frequency,
                phase,
            } => {
                let omega = TAU * frequency;
                let (sine, cosine) = (omega * t + phase).sin_cos();
                [
                    mean + amplitude * sine,
                    amplitude * omega * cosine,
                    -amplitude * omega * omega * sine,
                ]
            }
            Function::Ramp(step) => {
                let (u, increment) = ((t - step.start) / step.duration, step.to - step.from);
                let inside = (0.0..1.0).contains(&u);
                let slope = if inside {
                    increment / step.duration
                } else {
                    0.0
                };
                [step.from + increment * u.clamp(0.0, 1.0), slope, 0.0]
            }
            Function::SmoothStep(step) => {
                let [s, by_u, by_u2] = quintic((t - step.start) / step.duration);
                let increment = step.to - step.from;
                [
                    step.from + increment * s,
                    increment * by_u / step.duration,
                    increment * by_u2 / (step.duration * step.duration),
                ]
            }
            Function::SpinUp {
                start,
                speed,
                duration,
            } => {
                if t >= *duration {
                    return [start + speed * (t - 0.5 * duration), *speed, 0.0];
                }
                let omega = TAU / duration;
                let (sine, cosine) = (omega * t).sin_cos();
                let rate = speed / duration;
                [
                    start + rate * (0.5 * t * t + (cosine - 1.0) / (omega * omega)),
                    rate * (t - sine / omega),
                    rate * (1.0 - cosine),
                ]
            }
            Function::Table(table) => table.derivatives(t).map(|[x]| x),
            Function::MonotoneTable(table) => table.derivatives(t).map(|[x]| x),
            Function::Expression(expression) => expression.at(t),
            Function::Own(function) => function.at(t),
            Function::Piecewise(rows) => {
                let after = rows.partition_point(|[time, _]| *time <= t);
                match rows.get(after.wrapping_sub(1)..=after) {
                    Some(&[[t_0, from], [t_1, to]]) => {
                        let slope = (to - from) / (t_1 - t_0);
                        [from + slope * (t - t_0), slope, 0.0]
                    }
                    _ if after == 0 => [rows[0][1], 0.0, 0.0],
                    _ => [rows[rows.len() - 1][1], 0.0, 0.0],
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rates_are_the_derivatives() {
        let functions = [
            Function::Polynomial(vec![0.3, -1.2, 0.7, 0.4]),
            Function::Harmonic {
                mean: 0.2,
                amplitude: 1.3,
                frequency: 0.8,
                phase: 0.4,
            },
            Function::SmoothStep(Step {
                from: 0.2,
                to: -1.1,
                start: 0.1,
                duration: 1.7,
            }),
            Function::SpinUp {
                start: 0.1,
                speed: 6.0,
                duration: 1.0,
            },
            Function::table(&[[0.0, 0.1], [0.4, 0.9], [1.1, -0.3], [2.0, 0.5]]),
            Function::monotone_table(&[[0.0, 0.1], [0.4, 0.9], [1.1, -0.3], [2.0, 0.5]]),
        ];
        for f in &functions {
            for t in [0.15, 0.61, 1.3, 1.73] {
                let (low, mid, high) = (f.at(t - 1e-6), f.at(t), f.at(t + 1e-6));
                // central differences: rounding 1e-16/1e-6 times rates up to 30
                assert!(((high[0] - low[0]) / 2e-6 - mid[1]).abs() < 1e-8, "{f:?}");
                assert!(((high[1] - low[1]) / 2e-6 - mid[2]).abs() < 1e-7, "{f:?}");
            }
            assert_ne!(f.at(0.61)[2], 0.0, "nothing was tested");
        }
    }

    #[test]
    fn ramps_begin_and_end_where_they_should() {
        let step = Step {
            from: 1.0,
            to: 3.0,
            start: 0.5,
            duration: 2.0,
        };
        for f in [Function::Ramp(step), Function::SmoothStep(step)] {
            for (t, value) in [(0.0, 1.0), (0.5, 1.0), (1.5, 2.0), (2.5, 3.0), (9.0, 3.0)] {
                // exact in binary
                assert_eq!(f.at(t)[0], value);
            }
        }
    }

    #[test]
    fn pieces_are_straight_lines_between_rows() {
        let f = Function::Piecewise(vec![[0.0, 1.0], [0.5, 3.0], [2.0, 0.0]]);
        for (t, expected) in [
            (-1.0, [1.0, 0.0]),
            (0.0, [1.0, 4.0]),
            (0.25, [2.0, 4.0]),
            (0.5, [3.0, -2.0]),
            (1.5, [1.0, -2.0]),
            (2.0, [0.0, 0.0]),
            (9.0, [0.0, 0.0]),
        ] {
            let [value, rate, second] = f.at(t);
            assert_eq!(([value, rate], second), (expected, 0.0), "{t}");
        }
    }
}

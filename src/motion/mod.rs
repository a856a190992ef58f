//! Prescribed paths in (x, y, theta), and functions of time, with exact first and second derivatives.

mod circle;
mod coordinates;
mod expression;
mod function;
mod kinks;
mod knot;
mod line;
mod monotone;
mod parse_expression;
mod read_function;
mod read_path;
mod rounded;
mod table;

pub use circle::Circle;
pub use expression::Expression;
pub use function::{Function, FunctionOfTime, Step};
pub use knot::Knot;
pub use line::Line;
pub use monotone::MonotoneQuintic;
pub use read_function::{FUNCTIONS, FunctionKind, FunctionReader, Use};
pub(crate) use read_path::read_path;
pub use read_path::{PATHS, PathKind};
pub use table::{CubicSpline, Overshoot};

/// Position, velocity and acceleration of a body: of its centre of mass or reference point, and its angle (of a link: of its
/// chord).
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Pose {
    /// x, y \[m\], theta \[rad\].
    pub position: [f64; 3],
    /// vx, vy, omega.
    pub velocity: [f64; 3],
    /// ax, ay, alpha.
    pub acceleration: [f64; 3],
}

impl Pose {
    /// From (x, y, theta) and its first two derivatives.
    fn of_derivatives([position, velocity, acceleration]: [[f64; 3]; 3]) -> Pose {
        Pose {
            position,
            velocity,
            acceleration,
        }
    }
}

/// A path as a function of time. It can be downcast to its kind.
pub trait Path: std::any::Any + std::fmt::Debug + Send + Sync {
    /// The pose at time t \[s\].
    fn at(&self, t: f64) -> Pose;
    /// How to see all poses of the first `duration` seconds: the time after which none is new, and a number of poses
    /// up to there that lie close together.
    fn sweep(&self, duration: f64) -> (f64, usize);
    /// Where it is not smooth, up to a time \[s\].
    fn knots(&self, _until: f64) -> Vec<Knot> {
        Vec::new()
    }
}

/// Poses tried on one revolution, one line, or one row of a table at least.
const POSES: usize = 720;

#[cfg(test)]
mod tests {
    use super::*;

    const ROWS: [[f64; 4]; 4] = [
        [0.0, 0.0, 1.0, 0.0],
        [0.5, 0.3, 0.2, 0.1],
        [1.2, 0.1, -0.4, 0.5],
        [2.0, 0.8, 0.0, 0.2],
    ];

    fn spline(rows: &[[f64; 4]]) -> CubicSpline<3> {
        CubicSpline::new(rows.iter().map(|&[t, x, y, theta]| (t, [x, y, theta])))
    }

    fn monotone(rows: &[[f64; 4]]) -> MonotoneQuintic<3> {
        MonotoneQuintic::new(rows.iter().map(|&[t, x, y, theta]| (t, [x, y, theta])))
    }

    #[test]
    fn rates_are_the_derivatives() {
        let paths: [Box<dyn Path>; 5] = [
            Box::new(Circle {
                center: [0.1, -0.2],
                radius: 0.3,
                rate: -9.4,
                phase: 0.4,
                theta: 0.2,
            }),
            Box::new(Line {
                from: [0.0, 0.1, 0.0],
                to: [1.0, -0.5, 0.7],
                duration: 2.0,
            }),
            Box::new([
                Function::Polynomial(vec![0.2, 0.1, 0.7]),
                Function::Polynomial(vec![0.1, -0.4, 0.2, 0.3]),
                Function::Constant(0.4),
            ]),
            Box::new(spline(&ROWS)),
            Box::new(monotone(&ROWS)),
        ];
        for path in &paths {
            for t in [0.1, 0.61, 1.3, 1.83] {
                let (low, mid, high) = (path.at(t - 1e-6), path.at(t), path.at(t + 1e-6));
                for i in 0..3 {
                    let v = (high.position[i] - low.position[i]) / 2e-6;
                    let a = (high.velocity[i] - low.velocity[i]) / 2e-6;
                    // central differences: rounding 1e-16/1e-6 times rates up to 30
                    assert!((v - mid.velocity[i]).abs() < 1e-8, "{path:?}");
                    assert!((a - mid.acceleration[i]).abs() < 1e-7, "{path:?}");
                    assert!(i == 2 || mid.acceleration[i] != 0.0, "nothing was tested");
                }
            }
        }
    }

    #[test]
    fn a_table_passes_through_its_rows() {
        let paths: [Box<dyn Path>; 2] = [Box::new(spline(&ROWS)), Box::new(monotone(&ROWS))];
        for (row, path) in ROWS
            .iter()
            .flat_map(|row| paths.iter().map(move |path| (row, path)))
        {
            for i in 0..3 {
                // interpolation is exact but for rounding
                assert!((path.at(row[0]).position[i] - row[i + 1]).abs() < 1e-15);
            }
        }
    }
}

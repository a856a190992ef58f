//! A point or a rotation of a body as a function of the coordinates: what joints and forces act on.

use crate::math::plane::{Vec2, pair, quarter_turn, rotation, unit};

const UNIT: [Vec2; 2] = [Vec2::new(1.0, 0.0), Vec2::new(0.0, 1.0)];

/// Derivatives of a vector by the coordinates it depends on, N at most.
#[derive(Debug, Clone, Copy)]
pub struct Columns<const N: usize = 4> {
    vectors: [Vec2; N],
    count: usize,
}

impl<const N: usize> Columns<N> {
    fn new(columns: &[Vec2]) -> Columns<N> {
        let mut vectors = [Vec2::zeros(); N];
        vectors[..columns.len()].copy_from_slice(columns);
        Columns {
            vectors,
            count: columns.len(),
        }
    }

    /// The columns in local order.
    pub fn iter(&self) -> std::slice::Iter<'_, Vec2> {
        self.vectors[..self.count].iter()
    }

    /// Number of columns.
    pub fn len(&self) -> usize {
        self.count
    }

    /// True of a constant vector.
    pub fn is_empty(&self) -> bool {
        self.count == 0
    }
}

/// A point that moves with a body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Marker {
    /// The coordinates x, x + 1 are the point: an end of a link, a point of the ground.
    Node {
        /// Index of its first coordinate.
        x: usize,
    },
    /// A point of a rigid body with coordinates (x, y, theta): r = (x, y) + A(theta) s.
    OnBody {
        /// Indices of x, y of the reference point of the body and of theta.
        pose: [usize; 3],
        /// The point relative to the reference point at theta = 0 \[m\].
        s: Vec2,
    },
    /// A point between two nodes, r = (1 - share) r_from + share r_to: an inner point of a link that is taken as rigid.
    OnChord {
        /// Index of the first coordinate of one node.
        from: usize,
        /// Index of the first coordinate of the other.
        to: usize,
        /// Where it is between them, 0 to 1.
        share: f64,
    },
}

impl Marker {
    /// Number of coordinates it depends on.
    #[inline]
    pub fn width(&self) -> usize {
        match self {
            Marker::Node { .. } => 2,
            Marker::OnBody { .. } => 3,
            Marker::OnChord { .. } => 4,
        }
    }

    /// The coordinates it depends on, in local order.
    pub fn coordinates(&self) -> Vec<usize> {
        match *self {
            Marker::Node { x } => vec![x, x + 1],
            Marker::OnBody { pose, .. } => pose.to_vec(),
            Marker::OnChord { from, to, .. } => vec![from, from + 1, to, to + 1],
        }
    }

    /// A(theta) s; zero for a node and on a chord.
    #[inline(always)]
    pub fn arm(&self, q: &[f64]) -> Vec2 {
        match *self {
            Marker::Node { .. } | Marker::OnChord { .. } => Vec2::zeros(),
            Marker::OnBody { pose, s } => rotation(q[pose[2]]) * s,
        }
    }

    /// Position \[m\], given the arm.
    #[inline(always)]
    pub fn position(&self, q: &[f64], arm: Vec2) -> Vec2 {
        match *self {
            Marker::Node { x } => pair(q, x),
            Marker::OnBody { pose, .. } => place(q, pose) + arm,
            Marker::OnChord { from, to, share } => between(q, from, to, share),
        }
    }

    /// dr/dq in the order of the coordinates, given the arm.
    #[inline]
    pub fn columns(&self, arm: Vec2) -> Columns {
        let [x, y] = UNIT;
        match self {
            Marker::Node { .. } => Columns::new(&[x, y]),
            Marker::OnBody { .. } => Columns::new(&[x, y, quarter_turn(arm)]),
            Marker::OnChord { share, .. } => {
                let (far, near) = (*share, 1.0 - share);
                Columns::new(&[near * x, near * y, far * x, far * y])
            }
        }
    }

    /// Velocity \[m/s\], given the arm.
    #[inline(always)]
    pub fn velocity(&self, v: &[f64], arm: Vec2) -> Vec2 {
        match *self {
            Marker::Node { x } => pair(v, x),
            Marker::OnBody { pose, .. } => place(v, pose) + v[pose[2]] * quarter_turn(arm),
            Marker::OnChord { from, to, share } => between(v, from, to, share),
        }
    }

    /// Acceleration \[m/s2\], given the arm.
    #[inline(always)]
    pub fn acceleration(&self, v: &[f64], a: &[f64], arm: Vec2) -> Vec2 {
        match *self {
            Marker::Node { x } => pair(a, x),
            Marker::OnBody { pose, .. } => {
                let [.., theta] = pose;
                let turning = a[theta] * quarter_turn(arm) - v[theta] * v[theta] * arm;
                place(a, pose) + turning
            }
            Marker::OnChord { from, to, share } => between(a, from, to, share),
        }
    }
}

/// The vector e from one marker to another. Its local coordinates are those of `from`, then those of `to`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Separation {
    /// Where it begins.
    pub from: Marker,
    /// Where it ends.
    pub to: Marker,
}

impl Separation {
    /// The coordinates of both ends.
    pub fn sides(&self) -> [Vec<usize>; 2] {
        [self.from.coordinates(), self.to.coordinates()]
    }

    /// Number of local coordinates.
    pub fn width(&self) -> usize {
        self.from.width() + self.to.width()
    }

    /// Its ends, each with its sign and its first local index.
    fn ends(&self) -> [(&Marker, f64, usize); 2] {
        [(&self.from, -1.0, 0), (&self.to, 1.0, self.from.width())]
    }

    /// The arms of both ends.
    #[inline]
    pub fn arms(&self, q: &[f64]) -> [Vec2; 2] {
        [self.from.arm(q), self.to.arm(q)]
    }

    /// e \[m\], given the arms.
    #[inline]
    pub fn vector(&self, q: &[f64], arms: [Vec2; 2]) -> Vec2 {
        self.to.position(q, arms[1]) - self.from.position(q, arms[0])
    }

    /// de/dt \[m/s\], given the arms.
    #[inline]
    pub fn rate(&self, v: &[f64], arms: [Vec2; 2]) -> Vec2 {
        self.to.velocity(v, arms[1]) - self.from.velocity(v, arms[0])
    }

    /// d2e/dt2 \[m/s2\], given the arms.
    #[inline]
    pub fn acceleration(&self, v: &[f64], a: &[f64], arms: [Vec2; 2]) -> Vec2 {
        self.to.acceleration(v, a, arms[1]) - self.from.acceleration(v, a, arms[0])
    }

    /// de/dq, given the arms.
    pub fn columns(&self, arms: [Vec2; 2]) -> Columns<8> {
        let mut columns = Columns::new(&[]);
        for ((marker, sign, _), arm) in self.ends().into_iter().zip(arms) {
            for column in marker.columns(arm).iter() {
                columns.vectors[columns.count] = sign * column;
                columns.count += 1;
            }
        }
        columns
    }

    /// d2e/dtheta2 of the angles of rigid bodies, each with the local and the global index of theta, given the arms. All other
    /// second derivatives are zero.
    pub fn bends(&self, arms: [Vec2; 2]) -> impl Iterator<Item = (usize, usize, Vec2)> {
        let ends = self.ends().into_iter().zip(arms);
        ends.filter_map(|((marker, sign, first), arm)| match *marker {
            Marker::OnBody { pose, .. } => Some((first + 2, pose[2], -sign * arm)),
            Marker::Node { .. } | Marker::OnChord { .. } => None,
        })
    }
}

/// The entries of x and y of a reference point.
#[inline(always)]
fn place(x: &[f64], pose: [usize; 3]) -> Vec2 {
    Vec2::new(x[pose[0]], x[pose[1]])
}

/// (1 - share) of one pair of entries, and `share` of another.
#[inline]
fn between(x: &[f64], from: usize, to: usize, share: f64) -> Vec2 {
    (1.0 - share) * pair(x, from) + share * pair(x, to)
}

/// The rotation of the material at a marker: its rate omega = b(q) . v and b itself.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Spin {
    /// Ground: no rotation.
    Fixed,
    /// The angle at this index.
    Angle {
        /// Index of theta.
        theta: usize,
    },
    /// The direction from the node at `from` to the node at `to`: a rigid link.
    Chord {
        /// Index of the first coordinate of one end.
        from: usize,
        /// Index of the first coordinate of the other end.
        to: usize,
    },
    /// The slope vector r' at this index: an end of a flexible link.
    Slope {
        /// Index of its first coordinate.
        x: usize,
    },
}

impl Spin {
    /// The direction vector d whose turning is the spin, and its rate.
    fn direction(&self, q: &[f64], v: &[f64]) -> Option<(Vec2, Vec2)> {
        match *self {
            Spin::Fixed | Spin::Angle { .. } => None,
            Spin::Chord { .. } | Spin::Slope { .. } => Some((self.vector(q), self.vector(v))),
        }
    }

    /// The direction d that turns with the material: (1, 0) of the ground, (cos theta, sin theta), the chord, the slope.
    pub fn vector(&self, q: &[f64]) -> Vec2 {
        match *self {
            Spin::Fixed => Vec2::x(),
            Spin::Angle { theta } => unit(q[theta]),
            Spin::Chord { from, to } => pair(q, to) - pair(q, from),
            Spin::Slope { x } => pair(q, x),
        }
    }

    /// dd/dt, given d.
    pub fn vector_rate(&self, v: &[f64], d: Vec2) -> Vec2 {
        match *self {
            Spin::Fixed => Vec2::zeros(),
            Spin::Angle { theta } => v[theta] * quarter_turn(d),
            Spin::Chord { .. } | Spin::Slope { .. } => self.vector(v),
        }
    }

    /// d2d/dt2, given d.
    pub fn vector_acceleration(&self, v: &[f64], a: &[f64], d: Vec2) -> Vec2 {
        match *self {
            Spin::Fixed => Vec2::zeros(),
            Spin::Angle { theta } => a[theta] * quarter_turn(d) - v[theta] * v[theta] * d,
            Spin::Chord { .. } | Spin::Slope { .. } => self.vector(a),
        }
    }

    /// dd/dq in the order of [`Spin::coordinates`], given d.
    pub fn columns(&self, d: Vec2) -> Columns {
        let [x, y] = UNIT;
        match self {
            Spin::Fixed => Columns::new(&[]),
            Spin::Angle { .. } => Columns::new(&[quarter_turn(d)]),
            Spin::Chord { .. } => Columns::new(&[Vec2::new(-1.0, 0.0), Vec2::new(0.0, -1.0), x, y]),
            Spin::Slope { .. } => Columns::new(&[x, y]),
        }
    }

    /// omega \[rad/s\].
    pub fn rate(&self, q: &[f64], v: &[f64]) -> f64 {
        match (*self, self.direction(q, v)) {
            (Spin::Angle { theta }, _) => v[theta],
            (_, Some((d, d_dot))) => d.perp(&d_dot) / d.dot(&d),
            _ => 0.0,
        }
    }

    /// d(omega)/dt \[rad/s2\].
    pub fn acceleration(&self, q: &[f64], v: &[f64], a: &[f64]) -> f64 {
        match (*self, self.direction(q, v)) {
            (Spin::Angle { theta }, _) => a[theta],
            (_, Some((d, d_dot))) => {
                let square = d.dot(&d);
                let stretching = 2.0 * d.dot(&d_dot) / square;
                d.perp(&self.vector(a)) / square - stretching * d.perp(&d_dot) / square
            }
            _ => 0.0,
        }
    }

    /// Number of coordinates it depends on.
    #[inline]
    pub fn width(&self) -> usize {
        match self {
            Spin::Fixed => 0,
            Spin::Angle { .. } => 1,
            Spin::Slope { .. } => 2,
            Spin::Chord { .. } => 4,
        }
    }

    /// The coordinates it depends on: first index and sign of d for each vector, or the angle.
    pub fn coordinates(&self) -> Vec<usize> {
        match *self {
            Spin::Fixed => vec![],
            Spin::Angle { theta } => vec![theta],
            Spin::Chord { from, to } => vec![from, from + 1, to, to + 1],
            Spin::Slope { x } => vec![x, x + 1],
        }
    }

    /// b = d(omega)/dv, d(omega)/dq and d(b)/dq in the order of [`Spin::coordinates`], four numbers each way at most.
    pub fn derivatives(&self, q: &[f64], v: &[f64]) -> SpinDerivatives {
        let mut out = SpinDerivatives::default();
        match (*self, self.direction(q, v)) {
            (Spin::Angle { .. }, _) => out.b[0] = 1.0,
            (_, Some((d, d_dot))) => {
                let square = d.dot(&d);
                let b = 1.0 / square * quarter_turn(d);
                // d(b_i)/d(d_j) = J_ij/|d|^2 - 2 (J d)_i d_j/|d|^4 with J the quarter turn
                let quarter = [[0.0, -1.0], [1.0, 0.0]];
                let signs: &[f64] = if matches!(self, Spin::Chord { .. }) {
                    &[-1.0, 1.0]
                } else {
                    &[1.0]
                };
                for (m, sm) in signs.iter().enumerate() {
                    for i in 0..2 {
                        out.b[2 * m + i] = sm * b[i];
                        for (n, sn) in signs.iter().enumerate() {
                            for j in 0..2 {
                                let slope = quarter[i][j] / square - 2.0 * b[i] * d[j] / square;
                                out.b_q[2 * m + i][2 * n + j] = sm * sn * slope;
                                out.rate_q[2 * n + j] +=
                                    if m == 0 { sn * d_dot[i] * slope } else { 0.0 };
                            }
                        }
                    }
                }
            }
            _ => {}
        }
        out
    }
}

/// Derivatives of a spin in the order of its coordinates.
#[derive(Debug, Clone, Copy, Default)]
pub struct SpinDerivatives {
    /// b_i = d(omega)/d(v_i).
    pub b: [f64; 4],
    /// d(omega)/d(q_i).
    pub rate_q: [f64; 4],
    /// d(b_i)/d(q_j).
    pub b_q: [[f64; 4]; 4],
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Along q + v t + a t^2/2, on which chords and slopes turn and stretch.
    #[test]
    fn the_acceleration_of_a_spin_is_the_derivative_of_its_rate() {
        let (q, v, a) = (
            [0.3, -0.2, 0.9, 0.4],
            [0.5, 0.1, -0.6, 0.8],
            [-0.4, 0.7, 1.1, 0.2],
        );
        let spins = [
            Spin::Fixed,
            Spin::Angle { theta: 2 },
            Spin::Chord { from: 0, to: 2 },
            Spin::Slope { x: 2 },
        ];
        for spin in spins {
            let rate = |t: f64| {
                let moved: [f64; 4] = std::array::from_fn(|i| q[i] + v[i] * t + a[i] * t * t / 2.0);
                let velocity: [f64; 4] = std::array::from_fn(|i| v[i] + a[i] * t);
                spin.rate(&moved, &velocity)
            };
            let difference = (rate(1e-5) - rate(-1e-5)) / 2e-5;
            // rounding 1e-16/1e-5, and 1e-10 times a third derivative
            assert!(
                (spin.acceleration(&q, &v, &a) - difference).abs() < 1e-8,
                "{spin:?}"
            );
        }
    }
}

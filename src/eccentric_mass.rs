//! The mass of a rigid body whose reference point is not its centre of mass.
//!
//! With x, y of the reference point P, the angle theta and the centre of mass at P + s, s = A(theta) c,
//!
//! ```text
//! T = m v.v/2 + (I + m c.c) omega^2/2 + m omega (J s . v)        V = -m g . (P + s)
//! ```
//!
//! where v is the velocity of P, I the moment of inertia about the centre of mass and J the quarter turn. The first two terms of T
//! and the weight at P belong to the constant mass matrix. The others depend on theta and are here. They couple x, y and theta, so
//! that the mass matrix of the unknowns is constant only where one of the two, the place of P or theta, is known.

use crate::math::plane::{Vec2, quarter_turn, rotation};
use crate::system::State;

/// What a mass m at s adds to that of its body at P.
#[derive(Debug, Clone, Copy)]
pub struct EccentricMass {
    /// Indices of x, y of P and of theta.
    pub pose: [usize; 3],
    /// m \[kg\].
    pub mass: f64,
    /// The centre of mass relative to P at theta = 0 \[m\].
    pub c: Vec2,
    /// g \[m/s2\].
    pub gravity: [f64; 2],
}

impl EccentricMass {
    fn arm(&self, at: &State) -> Vec2 {
        rotation(at.q[self.pose[2]]) * self.c
    }

    /// m (a - w g), a the acceleration of P and w the part of the weight that acts.
    fn load(&self, at: &State) -> Vec2 {
        let [x, y, _] = self.pose;
        self.mass * (Vec2::new(at.a[x], at.a[y]) - at.weight * Vec2::from(self.gravity))
    }

    /// Forces on the left side of the equations of motion: m (alpha J s - omega^2 s) on x, y \[N\] and the couple on theta \[N m\].
    pub fn force(&self, at: &State) -> [f64; 3] {
        let [.., theta] = self.pose;
        let arm = self.arm(at);
        let turning = at.a[theta] * quarter_turn(arm) - at.v[theta] * at.v[theta] * arm;
        let [fx, fy] = (self.mass * turning).into();
        [fx, fy, self.couple(at)]
    }

    /// The force on theta, m J s . (a - w g) \[N m\].
    #[inline]
    pub fn couple(&self, at: &State) -> f64 {
        quarter_turn(self.arm(at)).dot(&self.load(at))
    }

    /// Its derivative by theta, -m s . (a - w g) \[N m\].
    #[inline]
    pub fn stiffness(&self, at: &State) -> f64 {
        -self.arm(at).dot(&self.load(at))
    }

    /// Kinetic energy m omega (J s . v) and potential -m g . s \[J\].
    pub fn energies(&self, at: &State) -> [f64; 2] {
        let [x, y, theta] = self.pose;
        let arm = self.arm(at);
        let velocity = Vec2::new(at.v[x], at.v[y]);
        let kinetic = self.mass * at.v[theta] * quarter_turn(arm).dot(&velocity);
        [kinetic, -self.mass * Vec2::from(self.gravity).dot(&arm)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::system::Shape;

    const MASS: EccentricMass = EccentricMass {
        pose: [0, 1, 2],
        mass: 0.7,
        c: Vec2::new(0.3, -0.2),
        gravity: [0.4, -9.81],
    };

    /// On the path q + v t + a t^2/2.
    fn state(q: [f64; 3], t: f64) -> State {
        let shape = Shape {
            unknowns: 3,
            coordinates: 3,
            multipliers: 0,
            contacts: 0,
            crossings: 0,
            memory: 0,
            entries: 5,
        };
        let (v, a) = ([0.9, -0.4, 2.1], [1.3, 0.8, -1.7]);
        let mut state = State::zeros(shape);
        state.weight = 0.8;
        for i in 0..3 {
            state.q[i] = q[i] + v[i] * t + a[i] * t * t / 2.0;
            state.v[i] = v[i] + a[i] * t;
            state.a[i] = a[i];
        }
        state
    }

    const POSES: [[f64; 3]; 2] = [[0.0; 3], [0.2, -0.1, 1.1]];
    /// A central difference over 1e-5 on either side.
    fn difference(f: impl Fn(f64) -> f64) -> f64 {
        (f(1e-5) - f(-1e-5)) / 2e-5
    }

    /// d/dt (dT/dv) - dT/dq + dV/dq, of which gravity acts in part.
    #[test]
    fn forces_are_those_of_lagrange() {
        for q in POSES {
            let force = MASS.force(&state(q, 0.0));
            for i in 0..3 {
                let momentum = |t: f64| {
                    difference(|by| {
                        let mut moved = state(q, t);
                        moved.v[i] += by;
                        MASS.energies(&moved)[0]
                    })
                };
                let by_place = difference(|by| {
                    let mut moved = state(q, 0.0);
                    moved.q[i] += by;
                    let [kinetic, potential] = MASS.energies(&moved);
                    moved.weight * potential - kinetic
                });
                // differences over 1e-2 and 2e-2, extrapolated: fifth derivatives near 1e3 times 1e-8 over 30, and rounding
                // 1e-11 of the momentum over 1e-2
                let rate = (momentum(1e-2) - momentum(-1e-2)) / 2e-2;
                let coarse = (momentum(2e-2) - momentum(-2e-2)) / 4e-2;
                let rate = rate + (rate - coarse) / 3.0;
                assert!((force[i] - rate - by_place).abs() < 1e-6, "{i} at {q:?}");
            }
        }
    }

    #[test]
    fn the_stiffness_is_the_derivative_of_the_force() {
        for q in POSES {
            let by_angle = difference(|by| {
                let mut moved = state(q, 0.0);
                moved.q[2] += by;
                MASS.force(&moved)[2]
            });
            let stiffness = MASS.stiffness(&state(q, 0.0));
            // third derivatives near 10 times 1e-10, and rounding 1e-15 over 1e-5
            assert!((stiffness - by_angle).abs() < 1e-8, "at {q:?}");
        }
    }
}

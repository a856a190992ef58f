//! Kelvin-Voigt damping of a planar ANCF element: stresses proportional to strain rates.

use super::{Force, LocalMatrix, WIDTH};
use crate::link::shape_derivatives;
use crate::math::plane::{Vec2, add, cross, dot, perp, scale, sub};
use crate::math::quadrature::GAUSS5;
use crate::model::Effect;
use crate::system::{INTEGRALS, Integral, State, Weights};

/// The dissipation 1/2 int EA tau eps_dot^2 + EI tau kappa_dot^2 dx with eps = (r'.r' - 1)/2 and kappa = r' x r''.
///
/// ```text
/// f = EA tau int eps_dot deps/dq dx + EI tau int kappa_dot dkappa/dq dx
/// ```
///
/// Neither rate sees a rigid motion. The elastic bending energy EI/2 r''.r'' has kappa^2 in it, which is all there is
/// while the stretch does not vary along the element; damping r'' itself would resist the rotation of a bent beam.
/// Five Gauss points integrate every term exactly.
#[derive(Debug)]
pub struct ElementDamping {
    coordinates: Vec<usize>,
    axial: f64,
    bending: f64,
    /// Weight times length, s' and s'' at each point.
    points: Vec<(f64, [f64; 4], [f64; 4])>,
}

/// Strain measures at one point.
struct Rates {
    eps: f64,
    kappa: f64,
    r: [Vec2; 2],
    v: [Vec2; 2],
}

impl ElementDamping {
    /// Damping of an element with EA tau \[N s\] and EI tau \[N m2 s\].
    pub fn new(coordinates: Vec<usize>, length: f64, axial: f64, bending: f64) -> ElementDamping {
        let points = GAUSS5.map(|(xi, weight)| {
            let (first, second) = shape_derivatives(xi, length);
            (weight * length, first, second)
        });
        ElementDamping {
            coordinates,
            axial,
            bending,
            points: points.to_vec(),
        }
    }

    /// sum_a s_a x_a over the four local vectors.
    fn combine(&self, s: &[f64; 4], x: &[f64]) -> Vec2 {
        let mut sum = [0.0; 2];
        for (a, s) in s.iter().enumerate() {
            let i = [self.coordinates[2 * a], self.coordinates[2 * a + 1]];
            sum = add(sum, scale(*s, [x[i[0]], x[i[1]]]));
        }
        sum
    }

    fn rates(&self, first: &[f64; 4], second: &[f64; 4], at: &State) -> Rates {
        let r = [self.combine(first, &at.q), self.combine(second, &at.q)];
        let v = [self.combine(first, &at.v), self.combine(second, &at.v)];
        Rates {
            eps: dot(r[0], v[0]),
            kappa: cross(v[0], r[1]) + cross(r[0], v[1]),
            r,
            v,
        }
    }

    /// deps/dq_a and dkappa/dq_a, or their rates where `r` are the rates of r' and r''.
    fn slopes(a: usize, first: &[f64; 4], second: &[f64; 4], r: &[Vec2; 2]) -> [Vec2; 2] {
        [
            scale(first[a], r[0]),
            sub(scale(second[a], perp(r[0])), scale(first[a], perp(r[1]))),
        ]
    }
}

impl Force for ElementDamping {
    fn effect(&self) -> Effect {
        Effect::ElementDamping
    }

    fn coordinates(&self) -> Vec<usize> {
        self.coordinates.clone()
    }

    fn split(&self) -> usize {
        0
    }

    fn force(&self, at: &State, f: &mut [f64; WIDTH]) {
        for (weight, first, second) in &self.points {
            let rates = self.rates(first, second, at);
            for a in 0..4 {
                let [eps, kappa] = Self::slopes(a, first, second, &rates.r);
                for i in 0..2 {
                    f[2 * a + i] += weight
                        * (self.axial * rates.eps * eps[i] + self.bending * rates.kappa * kappa[i]);
                }
            }
        }
    }

    fn force_and_tangent(&self, at: &State, w: Weights, f: &mut [f64; WIDTH], k: &mut LocalMatrix) {
        self.force(at, f);
        for (weight, first, second) in &self.points {
            let rates = self.rates(first, second, at);
            let (axial, bending) = (weight * self.axial, weight * self.bending);
            for a in 0..4 {
                let [eps_a, kappa_a] = Self::slopes(a, first, second, &rates.r);
                for b in 0..4 {
                    let [eps_b, kappa_b] = Self::slopes(b, first, second, &rates.r);
                    let [eps_dot_b, kappa_dot_b] = Self::slopes(b, first, second, &rates.v);
                    let straight = w.q * axial * rates.eps * first[a] * first[b];
                    let turned =
                        w.q * bending * rates.kappa * (first[a] * second[b] - second[a] * first[b]);
                    for i in 0..2 {
                        for j in 0..2 {
                            k[2 * a + i][2 * b + j] += axial
                                * eps_a[i]
                                * (w.v * eps_b[j] + w.q * eps_dot_b[j])
                                + bending * kappa_a[i] * (w.v * kappa_b[j] + w.q * kappa_dot_b[j]);
                        }
                        k[2 * a + i][2 * b + i] += straight;
                    }
                    k[2 * a][2 * b + 1] += turned;
                    k[2 * a + 1][2 * b] -= turned;
                }
            }
        }
    }

    fn powers(&self, at: &State, powers: &mut [f64; INTEGRALS]) {
        for (weight, first, second) in &self.points {
            let rates = self.rates(first, second, at);
            powers[Integral::DampingDissipated as usize] += weight
                * (self.axial * rates.eps * rates.eps + self.bending * rates.kappa * rates.kappa);
        }
    }
}

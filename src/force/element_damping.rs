//! Kelvin-Voigt damping of a planar ANCF element: stresses proportional to strain rates.

use super::{Force, LocalMatrix, WIDTH};
use crate::effect::Effect;
use crate::ledger::{self, Entry, Powers};
use crate::link::shape_derivatives;
use crate::math::plane::{Vec2, pair, quarter_turn};
use crate::math::quadrature::GAUSS5;
use crate::system::{State, Weights};

/// Coordinates of an element.
const NODAL: usize = 8;

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

    /// Local q and v.
    fn gather(&self, at: &State) -> [[f64; NODAL]; 2] {
        [&at.q, &at.v].map(|x| std::array::from_fn(|i| x[self.coordinates[i]]))
    }

    fn rates(first: &[f64; 4], second: &[f64; 4], [q, v]: &[[f64; NODAL]; 2]) -> Rates {
        // sum_a s_a x_a over the four local vectors
        let combine = |s: &[f64; 4], x: &[f64; NODAL]| {
            s[0] * pair(x, 0) + s[1] * pair(x, 2) + s[2] * pair(x, 4) + s[3] * pair(x, 6)
        };
        let r = [combine(first, q), combine(second, q)];
        let v = [combine(first, v), combine(second, v)];
        Rates {
            eps: r[0].dot(&v[0]),
            kappa: v[0].perp(&r[1]) + r[0].perp(&v[1]),
            r,
            v,
        }
    }

    /// deps/dq and dkappa/dq, or their rates where `r` are the rates of r' and r''.
    fn slopes(first: &[f64; 4], second: &[f64; 4], r: &[Vec2; 2]) -> [[f64; NODAL]; 2] {
        let (mut eps, mut kappa) = ([0.0; NODAL], [0.0; NODAL]);
        let turned = r.map(quarter_turn);
        for a in 0..4 {
            for i in 0..2 {
                eps[2 * a + i] = first[a] * r[0][i];
                kappa[2 * a + i] = second[a] * turned[0][i] - first[a] * turned[1][i];
            }
        }
        [eps, kappa]
    }
}

impl Force for ElementDamping {
    fn effect(&self) -> Effect {
        "element_damping"
    }

    fn is_smooth(&self) -> bool {
        true
    }

    fn sides(&self) -> [Vec<usize>; 2] {
        [vec![], self.coordinates.clone()]
    }

    fn force(&self, at: &State, f: &mut [f64; WIDTH]) {
        let local = self.gather(at);
        for (weight, first, second) in &self.points {
            let rates = Self::rates(first, second, &local);
            let [eps, kappa] = Self::slopes(first, second, &rates.r);
            let axial = weight * self.axial * rates.eps;
            let bending = weight * self.bending * rates.kappa;
            for i in 0..NODAL {
                f[i] += axial * eps[i] + bending * kappa[i];
            }
        }
    }

    fn force_and_tangent(&self, at: &State, w: Weights, f: &mut [f64; WIDTH], k: &mut LocalMatrix) {
        let local = self.gather(at);
        for (weight, first, second) in &self.points {
            let rates = Self::rates(first, second, &local);
            let (axial, bending) = (weight * self.axial, weight * self.bending);
            let [eps, kappa] = Self::slopes(first, second, &rates.r);
            let [eps_dot, kappa_dot] = Self::slopes(first, second, &rates.v);
            let by_stage = |slope: &[f64; NODAL], slope_dot: &[f64; NODAL]| -> [f64; NODAL] {
                std::array::from_fn(|i| w.v * slope[i] + w.q * slope_dot[i])
            };
            let eps_stage = by_stage(&eps, &eps_dot);
            let kappa_stage = by_stage(&kappa, &kappa_dot);
            let (pull, moment) = (axial * rates.eps, bending * rates.kappa);
            for r in 0..NODAL {
                let (along, across) = (axial * eps[r], bending * kappa[r]);
                f[r] += pull * eps[r] + moment * kappa[r];
                for c in 0..NODAL {
                    k[r][c] += along * eps_stage[c] + across * kappa_stage[c];
                }
            }
            // second derivatives of eps and kappa
            let (straight, turned) = (w.q * pull, w.q * moment);
            for a in 0..4 {
                for b in 0..4 {
                    let stretch = straight * first[a] * first[b];
                    let turn = turned * (first[a] * second[b] - second[a] * first[b]);
                    k[2 * a][2 * b] += stretch;
                    k[2 * a + 1][2 * b + 1] += stretch;
                    k[2 * a][2 * b + 1] += turn;
                    k[2 * a + 1][2 * b] -= turn;
                }
            }
        }
    }

    fn entries(&self) -> Vec<&'static Entry> {
        vec![&ledger::DAMPING]
    }

    fn powers(&self, at: &State, powers: &mut Powers) {
        let local = self.gather(at);
        for (weight, first, second) in &self.points {
            let rates = Self::rates(first, second, &local);
            powers.add(
                0,
                weight
                    * (self.axial * rates.eps * rates.eps
                        + self.bending * rates.kappa * rates.kappa),
            );
        }
    }
}

//! The elastic force of the ANCF element exactly as eqs. 12-15 print it: 64 constant matrices C_l1^ij of size 8 x 8.
//!
//! Kept to measure what the reduced route gains; simulations never take it.

use super::{ElasticRoute, shape_derivatives};
use crate::math::quadrature::GAUSS5;

type ElementMatrix = [[f64; 8]; 8];

/// An element with the paper's invariant matrices.
#[derive(Debug, Clone)]
pub struct LiteralCable {
    /// K_t, eq. 11.
    bending: ElementMatrix,
    /// K_l2, eq. 12.
    axial: ElementMatrix,
    /// C_l1^ij, eq. 14.
    invariants: Box<[[ElementMatrix; 8]; 8]>,
}

impl LiteralCable {
    /// K_t + K_l2 + K_l1(q), with (K_l1)_ij = q^T C_l1^ij q.
    fn stiffness(&self, q: &[f64; 8]) -> ElementMatrix {
        let mut stiffness = [[0.0; 8]; 8];
        for i in 0..8 {
            for j in 0..8 {
                let c = &self.invariants[i][j];
                let mut quadratic = 0.0;
                for r in 0..8 {
                    for s in 0..8 {
                        quadratic += q[r] * c[r][s] * q[s];
                    }
                }
                stiffness[i][j] = self.bending[i][j] + self.axial[i][j] + quadratic;
            }
        }
        stiffness
    }

    fn add_product(stiffness: &ElementMatrix, q: &[f64; 8], f: &mut [f64; 8]) {
        for i in 0..8 {
            f[i] += (0..8).map(|j| stiffness[i][j] * q[j]).sum::<f64>();
        }
    }
}

impl ElasticRoute for LiteralCable {
    fn new(length: f64, axial_stiffness: f64, bending_stiffness: f64) -> LiteralCable {
        let l = length;
        let mut route = LiteralCable {
            bending: [[0.0; 8]; 8],
            axial: [[0.0; 8]; 8],
            invariants: Box::new([[[[0.0; 8]; 8]; 8]; 8]),
        };
        for (x, weight) in GAUSS5 {
            let w = weight * l;
            let (first, second) = shape_derivatives(x, l);
            let mut s_l = [[0.0; 8]; 8];
            for i in 0..8 {
                for j in (i % 2..8).step_by(2) {
                    s_l[i][j] = first[i / 2] * first[j / 2];
                    route.bending[i][j] += w * bending_stiffness * second[i / 2] * second[j / 2];
                    route.axial[i][j] -= 0.5 * w * axial_stiffness * s_l[i][j];
                }
            }
            for i in 0..8 {
                for j in 0..8 {
                    for r in 0..8 {
                        for s in 0..8 {
                            // (S_l)_{,i} is column i, (S_l)_{j,} is row j
                            route.invariants[i][j][r][s] +=
                                0.5 * w * axial_stiffness * s_l[r][i] * s_l[j][s];
                        }
                    }
                }
            }
        }
        route
    }

    fn force(&self, q: &[f64; 8], f: &mut [f64; 8]) {
        Self::add_product(&self.stiffness(q), q, f);
    }

    fn force_and_tangent(&self, q: &[f64; 8], f: &mut [f64; 8], k: &mut [[f64; 8]; 8]) {
        let stiffness = self.stiffness(q);
        Self::add_product(&stiffness, q, f);
        for i in 0..8 {
            for j in 0..8 {
                // eq. 15: the derivative of q^T C^ik q by q_j, times q_k
                let mut sum = 0.0;
                for m in 0..8 {
                    let c = &self.invariants[i][m];
                    for s in 0..8 {
                        sum += q[s] * (c[s][j] + c[j][s]) * q[m];
                    }
                }
                k[i][j] += stiffness[i][j] + sum;
            }
        }
    }
}

//! The elastic force of the ANCF element by five-point Gauss quadrature of eq. 11.
//!
//! F = EA int eps S_l q dx + EI int S''^T S'' q dx with eps = 1/2 (q^T S_l q - 1), S_l = S'^T S'. The axial integrand has
//! degree 8, the bending integrand degree 2: five points are exact for both.

use super::{ElasticRoute, shape_derivatives};
use crate::math::plane::{Vec2, pair};
use crate::math::quadrature::GAUSS5;

/// An element that integrates numerically.
#[derive(Debug, Clone)]
pub struct GaussCable {
    axial_stiffness: f64,
    bending_stiffness: f64,
    /// Weight w l, s_a' and s_a'' at each point.
    points: [(f64, [f64; 4], [f64; 4]); 5],
}

impl GaussCable {
    fn derivative(s: &[f64; 4], q: &[f64; 8]) -> Vec2 {
        (0..4).map(|a| s[a] * pair(q, 2 * a)).sum()
    }
}

impl ElasticRoute for GaussCable {
    fn new(length: f64, axial_stiffness: f64, bending_stiffness: f64) -> GaussCable {
        let l = length;
        let points = GAUSS5.map(|(x, weight)| {
            let (first, second) = shape_derivatives(x, l);
            (weight * l, first, second)
        });
        GaussCable {
            axial_stiffness,
            bending_stiffness,
            points,
        }
    }

    fn force(&self, q: &[f64; 8], f: &mut [f64; 8]) {
        for (weight, first, second) in &self.points {
            let (slope, bend) = (Self::derivative(first, q), Self::derivative(second, q));
            let tension = weight * self.axial_stiffness * 0.5 * (slope.dot(&slope) - 1.0);
            let moment = weight * self.bending_stiffness;
            for a in 0..4 {
                for i in 0..2 {
                    f[2 * a + i] += tension * first[a] * slope[i] + moment * second[a] * bend[i];
                }
            }
        }
    }

    fn force_and_tangent(&self, q: &[f64; 8], f: &mut [f64; 8], k: &mut [[f64; 8]; 8]) {
        self.force(q, f);
        for (weight, first, second) in &self.points {
            let slope = Self::derivative(first, q);
            let tension = weight * self.axial_stiffness * 0.5 * (slope.dot(&slope) - 1.0);
            let axial = weight * self.axial_stiffness;
            let moment = weight * self.bending_stiffness;
            for a in 0..4 {
                for b in 0..4 {
                    let (ss, bb) = (first[a] * first[b], second[a] * second[b]);
                    for i in 0..2 {
                        k[2 * a + i][2 * b + i] += tension * ss + moment * bb;
                        for j in 0..2 {
                            k[2 * a + i][2 * b + j] += axial * ss * slope[i] * slope[j];
                        }
                    }
                }
            }
        }
    }
}

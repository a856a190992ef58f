//! Planar cubic ANCF element (eqs. 6-15), by the route that simulations take.
//!
//! The slope of the centre line is r' = phi_a(xi) u_a with three vectors u = ((r_j - r_i)/l, r_i', r_j') and
//!
//! ```text
//! phi = (6 xi - 6 xi^2,  1 - 4 xi + 3 xi^2,  -2 xi + 3 xi^2),      phi_1 + phi_2 + phi_3 = 1
//! ```
//!
//! so that eq. 14's invariants are one fully symmetric tensor T_abcd = int_0^1 phi_a phi_b phi_c phi_d dxi with fifteen
//! distinct numbers. Because the phi add up to one, the strain is eps = 1/2 phi_c phi_d (u_c . u_d - 1): K_l1 and K_l2
//! of eq. 12 merge before they are rounded, and an undeformed element has no force to the last digit.
//!
//! ```text
//! W_ab = 1/2 T_abcd (u_c . u_d - 1)                      int eps phi_a phi_b dxi
//! U = EA l/8 (u_a . u_b - 1) T_abcd (u_c . u_d - 1) + EI/(2 l) B_ab u_a . u_b
//! dU/du_a = EA l W_ab u_b + EI/l B_ab u_b
//! d2U/du_a du_b = (EA l W_ab + EI/l B_ab) I_2 + EA l T_abcd u_c u_d^T
//! ```
//!
//! Eq. 11 prints U_l twice; the second is the bending energy EI/2 int r''.r'' dx, which is the energy of curvature only
//! while the axial strain is small.

use super::ElasticRoute;
use crate::math::plane::{Vec2, pair};

/// T_abcd, rows ab and columns cd in the order of [`of_pairs`]; columns with c != d carry the factor 2 of their twin dc.
#[rustfmt::skip]
const T: [[f64; 6]; 6] = [
    [72.0 / 35.0, -18.0 / 35.0,  -18.0 / 35.0,   3.0 / 35.0,          0.0,   3.0 / 35.0],
    [-9.0 / 35.0,   6.0 / 35.0,           0.0,  1.0 / 140.0, -1.0 /  70.0, -1.0 / 140.0],
    [-9.0 / 35.0,          0.0,    6.0 / 35.0, -1.0 / 140.0, -1.0 /  70.0,  1.0 / 140.0],
    [ 3.0 / 35.0,  1.0 /  70.0,  -1.0 /  70.0,   2.0 / 35.0, -1.0 /  70.0,  1.0 / 210.0],
    [        0.0, -1.0 /  70.0,  -1.0 /  70.0, -1.0 / 140.0,  1.0 / 105.0, -1.0 / 140.0],
    [ 3.0 / 35.0, -1.0 /  70.0,   1.0 /  70.0,  1.0 / 210.0, -1.0 /  70.0,   2.0 / 35.0],
];

/// B_ab = int phi_a' phi_b' dxi.
const B: [[f64; 3]; 3] = [[12.0, -6.0, -6.0], [-6.0, 4.0, 2.0], [-6.0, 2.0, 4.0]];

/// 420 m_ab/(rho A l) of eq. 10 for the coordinates (r_i, l r_i', r_j, l r_j'): the upper triangle, row by row.
#[rustfmt::skip]
const MASS: [f64; 10] = [
    156.0, 22.0,  54.0, -13.0,
            4.0,  13.0,  -3.0,
                 156.0, -22.0,
                          4.0,
];

/// Storage position of the pair (a, b).
const PAIR_OF: [[usize; 3]; 3] = [[0, 1, 2], [1, 3, 4], [2, 4, 5]];

/// An element of given length, axial stiffness EA and bending stiffness EI.
#[derive(Debug, Clone, Copy)]
pub struct AncfCable {
    length: f64,
    axial_stiffness: f64,
    bending_stiffness: f64,
}

/// T contracted with N symmetric matrices side by side.
#[inline(always)]
fn contract<const N: usize>(m: &[[f64; N]; 6]) -> [[f64; N]; 6] {
    let mut out = [[0.0; N]; 6];
    for (row, out) in T.iter().zip(&mut out) {
        for (t, m) in row.iter().zip(m) {
            for lane in 0..N {
                out[lane] += t * m[lane];
            }
        }
    }
    out
}

/// A function of the six pairs.
#[inline(always)]
fn of_pairs<T>(f: impl Fn(usize, usize) -> T) -> [T; 6] {
    [f(0, 0), f(0, 1), f(0, 2), f(1, 1), f(1, 2), f(2, 2)]
}

impl AncfCable {
    /// Multiply-adds of a force, and of a force with its tangent: 36 and 144 are contractions with T.
    pub(crate) const OPERATIONS: [u64; 2] = [95, 250];

    /// u = ((r_j - r_i)/l, r_i', r_j').
    #[inline]
    fn slopes(&self, q: &[f64; 8]) -> [Vec2; 3] {
        let chord = 1.0 / self.length * (pair(q, 4) - pair(q, 0));
        [chord, pair(q, 2), pair(q, 6)]
    }

    /// u_a . u_b - 1 for the six pairs: twice the strain that each pair stands for.
    #[inline]
    fn stretches(u: &[Vec2; 3]) -> [f64; 6] {
        of_pairs(|a, b| u[a].dot(&u[b]) - 1.0)
    }

    /// u_2 - u_1 and u_3 - u_1. B annihilates equal vectors, so bending depends on these alone: a straight element has
    /// none to the last digit.
    #[inline]
    fn bends(u: &[Vec2; 3]) -> [Vec2; 2] {
        [u[1] - u[0], u[2] - u[0]]
    }

    /// Adds the force conjugate to u, given the axial coefficients W.
    #[inline]
    fn add_force(&self, u: &[Vec2; 3], w: &[f64; 6], f: &mut [f64; 8]) {
        let axial = self.axial_stiffness * self.length;
        let mut g = [Vec2::zeros(); 3];
        for a in 0..3 {
            for b in 0..3 {
                g[a] += axial * w[PAIR_OF[a][b]] * u[b];
            }
        }
        let [start, end] = Self::bends(u);
        let bending = self.bending_stiffness / self.length;
        let moments = [
            bending * (B[1][1] * start + B[1][2] * end),
            bending * (B[2][1] * start + B[2][2] * end),
        ];
        g[0] -= moments[0] + moments[1];
        g[1] += moments[0];
        g[2] += moments[1];
        let chord = 1.0 / self.length * g[0];
        for i in 0..2 {
            f[i] -= chord[i];
            f[2 + i] += g[1][i];
            f[4 + i] += chord[i];
            f[6 + i] += g[2][i];
        }
    }

    /// Axial and bending strain energy \[J\].
    pub fn energy(&self, q: &[f64; 8]) -> (f64, f64) {
        let u = self.slopes(q);
        let d = Self::stretches(&u);
        let w = contract(&d.map(|d| [d]));
        let weights = [1.0, 2.0, 2.0, 1.0, 2.0, 1.0];
        let axial: f64 = (0..6).map(|p| weights[p] * d[p] * w[p][0]).sum();
        let [start, end] = Self::bends(&u);
        let bending = B[1][1] * start.dot(&start)
            + (B[1][2] + B[2][1]) * start.dot(&end)
            + B[2][2] * end.dot(&end);
        (
            0.125 * self.axial_stiffness * self.length * axial,
            0.5 * self.bending_stiffness / self.length * bending,
        )
    }

    /// Green strain eps = 1/2 (r'.r' - 1) of the centre line at xi in \[0, 1\].
    pub fn strain(&self, q: &[f64; 8], xi: f64) -> f64 {
        let u = self.slopes(q);
        let phi = [
            6.0 * xi * (1.0 - xi),
            (1.0 - xi) * (1.0 - 3.0 * xi),
            xi * (3.0 * xi - 2.0),
        ];
        let d = Self::stretches(&u);
        let mut eps = 0.0;
        for a in 0..3 {
            for b in 0..3 {
                eps += 0.5 * phi[a] * phi[b] * d[PAIR_OF[a][b]];
            }
        }
        eps
    }

    /// |r''| \[1/m\] at xi in \[0, 1\], the curvature of the bending energy.
    pub fn curvature(&self, q: &[f64; 8], xi: f64) -> f64 {
        let [i, j] = Self::bends(&self.slopes(q));
        ((6.0 * xi - 4.0) * i + (6.0 * xi - 2.0) * j).norm() / self.length
    }

    /// Constant mass matrix of eq. 10 for a mass per length rho A, in the scalar form m_ab that stands before I_2.
    pub fn mass(length: f64, mass_per_length: f64) -> [[f64; 4]; 4] {
        let unit = mass_per_length * length / 420.0;
        let size = [1.0, length, 1.0, length];
        let pairs = (0..4).flat_map(|a| (a..4).map(move |b| (a, b)));
        let mut mass = [[0.0; 4]; 4];
        for (entry, (a, b)) in MASS.iter().zip(pairs) {
            mass[a][b] = entry * size[a] * size[b] * unit;
            mass[b][a] = mass[a][b];
        }
        mass
    }
}

impl ElasticRoute for AncfCable {
    fn new(length: f64, axial_stiffness: f64, bending_stiffness: f64) -> AncfCable {
        AncfCable {
            length,
            axial_stiffness,
            bending_stiffness,
        }
    }

    #[inline]
    fn force(&self, q: &[f64; 8], f: &mut [f64; 8]) {
        let u = self.slopes(q);
        let w = contract(&Self::stretches(&u).map(|x| [x])).map(|[x]| 0.5 * x);
        self.add_force(&u, &w, f);
    }

    #[inline]
    fn force_and_tangent(&self, q: &[f64; 8], f: &mut [f64; 8], k: &mut [[f64; 8]; 8]) {
        for (k, tangent) in k.iter_mut().zip(self.linearised(q, f)) {
            k.iter_mut().zip(tangent).for_each(|(k, x)| *k += x);
        }
    }
}

impl AncfCable {
    /// Adds the elastic force to `f`; returns its Jacobian dF/dq, row by row.
    #[inline]
    pub fn linearised(&self, q: &[f64; 8], f: &mut [f64; 8]) -> [[f64; 8]; 8] {
        let u = self.slopes(q);
        let contracted = contract(&of_pairs(|a, b| {
            let (xx, yy) = (u[a][0] * u[b][0], u[a][1] * u[b][1]);
            let xy = 0.5 * (u[a][0] * u[b][1] + u[a][1] * u[b][0]);
            [xx + yy - 1.0, xx, yy, xy]
        }));
        self.add_force(&u, &contracted.map(|[s, ..]| 0.5 * s), f);

        let axial = self.axial_stiffness * self.length;
        let bending = self.bending_stiffness / self.length;
        // second derivatives by u, for the pairs of u: xx, xy, yy
        let bends = [B[0][0], B[0][1], B[0][2], B[1][1], B[1][2], B[2][2]];
        let chord = 1.0 / self.length;
        let sizes = [chord * chord, chord, chord, 1.0, 1.0, 1.0];
        let h: [[f64; 3]; 6] = std::array::from_fn(|p| {
            let [stretch, xx, yy, xy] = contracted[p];
            let straight = 0.5 * axial * stretch + bending * bends[p];
            [
                sizes[p] * (straight + axial * xx),
                sizes[p] * (axial * xy),
                sizes[p] * (straight + axial * yy),
            ]
        });
        // the chord is (r_j - r_i)/l
        let row = |signs: [f64; 4], [a, b, c]: [usize; 3], first: usize| -> [f64; 8] {
            let block = |p: usize| [h[p][first], h[p][first + 1]];
            let [chord, start, end] = [block(a), block(b), block(c)];
            std::array::from_fn(|column| {
                let part = column % 2;
                match column / 2 {
                    0 => signs[0] * chord[part],
                    1 => signs[1] * start[part],
                    2 => signs[2] * chord[part],
                    _ => signs[3] * end[part],
                }
            })
        };
        let (far, near) = ([-1.0, 1.0, 1.0, 1.0], [1.0, -1.0, -1.0, -1.0]);
        [
            row(near, [0, 1, 2], 0),
            row(near, [0, 1, 2], 1),
            row(far, [1, 3, 4], 0),
            row(far, [1, 3, 4], 1),
            row(far, [0, 1, 2], 0),
            row(far, [0, 1, 2], 1),
            row(far, [2, 4, 5], 0),
            row(far, [2, 4, 5], 1),
        ]
    }
}

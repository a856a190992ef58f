//! The smallest eigenvalue of the stiffness on the null space of the constraints,
//!
//! ```text
//! K x + Phi_q^T nu = mu M x        Phi_q x = 0        x^T M x = 1
//! ```
//!
//! by Lanczos' method for (K + w M)^-1 M with complete reorthogonalisation (Parlett 1998, The Symmetric Eigenvalue Problem, chapter 13).
//! Its largest eigenvalue is 1/(mu + w) for the smallest mu, if all mu + w are positive. Where one is not, the method shows a negative
//! eigenvalue; w then grows beyond it. K is made symmetric by forces that have a potential; of others, which follow a body, the method
//! sees the stiffness in the directions that it tries.

use super::{Extent, Failure, Newton};
use crate::math::larger;
use crate::system::{Equilibrium, State, Work};
use nalgebra::DMatrix;

/// The first w \[1/s2\]: a period of ten minutes is slower than mechanisms are. It makes the matrix regular where a mechanism moves
/// without force; there, eigenvalues down to -1e6/s2 are seen beside it.
pub(super) const SLOWEST: f64 = 1e-4;
/// Vectors tried at most with one w; the smallest eigenvalue of a mechanism that bends stands apart from the others.
const VECTORS: usize = 80;
/// An eigenvalue is found where the residual is below this part of it.
const FOUND: f64 = 1e-13;
/// What is below this part of the largest eigenvalue of the inverse is rounding of nearly singular equations: no further direction
/// that moves, no negative eigenvalue.
const ROUNDED: f64 = 1e-10;
/// A permitted direction changes the constraints by less than this part of its displacements, another one by all of it.
const PERMITTED: f64 = 1e-3;
/// w grows at most so often, each time beyond the most negative eigenvalue that was seen.
const SHIFTS: usize = 40;
/// An eigenvalue below so many roundings of its parts is zero.
const ROUNDINGS: f64 = 64.0;

/// The softest direction in which a mechanism can move.
#[derive(Debug, Clone, PartialEq)]
pub struct Softest {
    /// mu \[1/s2\], the square of the lowest angular frequency of small vibrations without damping; zero below rounding.
    pub eigenvalue: f64,
    /// x, of all unknowns.
    pub direction: Vec<f64>,
}

impl Newton {
    /// The softest direction at an equilibrium; none where the constraints leave nothing that moves.
    ///
    /// # Errors
    /// [`Failure::Singular`] where the constraints lose rank.
    pub fn softest(
        &mut self,
        system: &dyn Equilibrium,
        extent: Extent,
        s: &State,
        work: &mut Work,
    ) -> Result<Option<Softest>, Failure> {
        let mut shift = SLOWEST;
        for _ in 0..SHIFTS {
            self.renew_stiffness(system, s, shift, work)?;
            let Some(Ends { least, greatest }) = self.ends(system, extent, s) else {
                return Ok(None);
            };
            if least < -ROUNDED * greatest.0.abs() {
                // mu + w = 1/least
                shift = 2.0 * (shift - 1.0 / least);
                continue;
            }
            let (theta, direction) = greatest;
            let mu = 1.0 / theta - shift;
            let rounding = self.rounding(system, s, &direction, work) + ROUNDED * shift;
            let eigenvalue = match mu.abs() > rounding {
                true => mu,
                false => 0.0,
            };
            return Ok(Some(Softest {
                eigenvalue,
                direction,
            }));
        }
        Err(Failure::Singular { index: 0 })
    }

    /// The error that rounding makes of x^T K x.
    fn rounding(&mut self, system: &dyn Equilibrium, s: &State, x: &[f64], work: &mut Work) -> f64 {
        let k = system.plain_stiffness(s, work);
        let mut magnitude = 0.0;
        system.symbolic().for_each_entry(&k, |i, j, value| {
            if i < x.len() && j < x.len() {
                magnitude += (x[i] * value * x[j]).abs();
            }
        });
        ROUNDINGS * f64::EPSILON * magnitude
    }

    /// x = (K + w M)^-1 M v on the null space of the constraints, with the factors at hand.
    fn soften(&mut self, system: &dyn Equilibrium, v: &[f64], x: &mut [f64]) {
        let n = v.len();
        system.momentum(v, &mut self.b);
        self.b[n..].fill(0.0);
        self.tangents[0]
            .factors
            .solve(system.symbolic(), &mut self.b);
        x.copy_from_slice(&self.b[..n]);
    }

    /// True of a direction that the constraints do not permit: where they permit none, rounding is all that is left of a vector.
    fn violates(&mut self, system: &dyn Equilibrium, extent: Extent, s: &State, x: &[f64]) -> bool {
        let mut at = s.clone();
        at.v.fill(0.0);
        system.constraint_velocity(&at, &mut self.phi);
        let still = self.phi.clone();
        at.v[..x.len()].copy_from_slice(x);
        system.constraint_velocity(&at, &mut self.phi);
        let changes = self.phi.iter().zip(&still).map(|(a, b)| a - b);
        let distances = x.iter().zip(extent.lengths).map(|(x, length)| x * length);
        changes.fold(0.0, larger) > PERMITTED * distances.fold(0.0, larger)
    }

    /// The ends of the spectrum of (K + w M)^-1 M; none without a direction that moves.
    fn ends(&mut self, system: &dyn Equilibrium, extent: Extent, s: &State) -> Option<Ends> {
        let n = system.shape().unknowns;
        let mut momentum = vec![0.0; n];
        let mut form = |x: &[f64], y: &[f64]| {
            system.momentum(y, &mut momentum);
            x.iter().zip(&momentum).map(|(a, b)| a * b).sum::<f64>()
        };
        // no mode of a mechanism is orthogonal to the digits of a sine
        let start: Vec<f64> = (0..n).map(|i| (1.0 + 1.7 * i as f64).sin()).collect();
        let mut v = vec![0.0; n];
        self.soften(system, &start, &mut v);
        let mut norm = form(&v, &v).sqrt();
        let mut basis: Vec<Vec<f64>> = Vec::new();
        let (mut diagonal, mut beside) = (Vec::new(), Vec::new());
        let mut found = None;
        let mut x = vec![0.0; n];
        let mut largest = 0.0_f64;
        if norm <= f64::MIN_POSITIVE || self.violates(system, extent, s, &v) {
            return None;
        }
        for j in 0..n.min(VECTORS) {
            v.iter_mut().for_each(|v| *v /= norm);
            basis.push(v.clone());
            self.soften(system, &v, &mut x);
            let alpha = form(&v, &x);
            diagonal.push(alpha);
            largest = largest.max(alpha.abs());
            for _ in 0..2 {
                for u in &basis {
                    let part = form(u, &x);
                    x.iter_mut().zip(u).for_each(|(x, u)| *x -= part * u);
                }
            }
            norm = form(&x, &x).max(0.0).sqrt();
            let ritz = Ritz::new(&diagonal, &beside);
            let done = norm <= ROUNDED * largest || j + 1 == n.min(VECTORS);
            if done || ritz.is_found(norm) {
                found = Some(ritz);
                break;
            }
            beside.push(norm);
            std::mem::swap(&mut v, &mut x);
        }
        found.map(|ritz| ritz.ends(&basis))
    }
}

/// The least and the greatest eigenvalue, and the vector of the greatest.
struct Ends {
    least: f64,
    greatest: (f64, Vec<f64>),
}

/// Eigenvalues of the tridiagonal matrix of Lanczos' method.
struct Ritz {
    values: Vec<f64>,
    vectors: DMatrix<f64>,
}

impl Ritz {
    fn new(diagonal: &[f64], beside: &[f64]) -> Ritz {
        let size = diagonal.len();
        let matrix = DMatrix::from_fn(size, size, |i, j| match i.abs_diff(j) {
            0 => diagonal[i],
            1 => beside[i.min(j)],
            _ => 0.0,
        });
        let eigen = matrix.symmetric_eigen();
        Ritz {
            values: eigen.eigenvalues.iter().copied().collect(),
            vectors: eigen.eigenvectors,
        }
    }

    /// Places of the least and the greatest value.
    fn places(&self) -> [usize; 2] {
        let places = 0..self.values.len();
        let by = |a: &usize, b: &usize| self.values[*a].total_cmp(&self.values[*b]);
        let [least, greatest] = [places.clone().min_by(by), places.max_by(by)];
        [least.unwrap_or(0), greatest.unwrap_or(0)]
    }

    /// True where the greatest value, or a negative least one, is an eigenvalue; `beyond` couples the next vector.
    fn is_found(&self, beyond: f64) -> bool {
        let last = self.values.len() - 1;
        let [least, greatest] = self.places();
        let found =
            |k: usize| (beyond * self.vectors[(last, k)]).abs() <= FOUND * self.values[k].abs();
        found(greatest) && (self.values[least] >= 0.0 || found(least))
    }

    fn ends(self, basis: &[Vec<f64>]) -> Ends {
        let [least, greatest] = self.places();
        let mut direction = vec![0.0; basis[0].len()];
        for (k, v) in basis.iter().enumerate() {
            let part = self.vectors[(k, greatest)];
            direction
                .iter_mut()
                .zip(v)
                .for_each(|(x, v)| *x += part * v);
        }
        Ends {
            least: self.values[least],
            greatest: (self.values[greatest], direction),
        }
    }
}

//! Natural frequencies and mode shapes of small vibrations about a pose.
//!
//! At rest in a pose, with the multipliers and the contact memory of a state, the equations of motion of a small displacement x
//! are
//!
//! ```text
//! M x'' + C x' + K x + Phi_q^T mu = 0        Phi_q x = 0
//! K = d(f + Phi_q^T lambda)/dq,   C = df/dv
//! ```
//!
//! With an orthonormal basis Z of the displacements that the constraints allow, x = Z y, the modes are the solutions of
//!
//! ```text
//! Z^T (K + K^T)/2 Z y = w^2 Z^T M Z y,    y . Z^T M Z y = 1
//! ```
//!
//! (Shabana 2019, Vibration of Discrete and Continuous Systems, chapter 3). The damping ratio is y . Z^T C Z y/(2 w): that of
//! the mode where C does not couple modes, and to first order in C elsewhere. Velocities do not enter: the frequencies are those
//! of vibrations that are fast compared with the motion through the pose. Where the pose is not an equilibrium, lambda holds the
//! forces of inertia that act in it, and a body that a joint holds at a moving point has those of its acceleration.

use crate::model::Model;
use crate::system::{State, System, Weights, Work};
use faer::{ColRef, Mat, Side};
use nalgebra::DMatrix;
use serde::Serialize;

/// Singular values of the scaled constraints below this part of the largest belong to a singular pose: the constraints lose a
/// direction there, which rounding determines.
const SINGULAR: f64 = 1e-9;

/// A square of a frequency, or a damping, below so many roundings is zero.
const ROUNDING: f64 = 8.0;

/// Stiffness that is not symmetric above this part of the largest is no rounding.
const ASYMMETRIC: f64 = 1e-9;

/// A mode.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct NaturalMode {
    /// w/(2 pi) \[Hz\]; 0 of a mode that moves freely or is unstable.
    pub frequency: f64,
    /// Rate s of the growth e^(s t) of an unstable mode, whose w^2 = -s^2 is negative \[1/s\]; else 0.
    pub growth: f64,
    /// Damping relative to the critical damping, to first order; 0 of a mode that does not vibrate.
    pub damping: f64,
    /// The unknown that moves most.
    pub moves_most: String,
    /// Displacement of every coordinate, scaled so that the unknown that moves most moves a point of its body by 1 m; known
    /// coordinates do not move.
    #[serde(skip)]
    pub shape: Vec<f64>,
}

/// The modes of a mechanism in a pose, the slowest first.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Modes {
    /// All modes; unstable ones come first.
    pub modes: Vec<NaturalMode>,
    /// Largest part of the stiffness that is not symmetric, relative to its largest entry; the modes leave it out.
    pub asymmetry: f64,
}

impl Modes {
    /// What the modes leave out, where it is more than rounding.
    pub fn asymmetry_note(&self) -> Option<String> {
        (self.asymmetry > ASYMMETRIC).then(|| {
            format!(
                "{} of the stiffness is not symmetric, because of forces that have no energy; the modes leave it out",
                numbers::percent(self.asymmetry)
            )
        })
    }
}

/// Why there are no modes.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum ModesError {
    /// Nothing can move.
    #[error(
        "constraints and drives leave nothing that can move: links that bend have `model = \"flexible\"`"
    )]
    Rigid,
    /// The constraints lose rank; the one that depends most on the others.
    #[error("the pose is singular: {0} depends on the other constraints")]
    SingularPose(String),
    /// A displacement that the constraints allow moves no mass; the unknown that moves most.
    #[error("{0} can move without moving any mass")]
    Massless(String),
}

/// Matrices of the linearised equations, of the unknowns that are positions.
struct Linearised {
    /// The unknowns that are positions, not internal states.
    positions: Vec<usize>,
    mass: Mat<f64>,
    damping: Mat<f64>,
    stiffness: Mat<f64>,
    /// The gradient of the constraints, each row of length one, and their multipliers.
    gradient: Mat<f64>,
    rows: Vec<usize>,
}

impl Linearised {
    fn new(model: &Model, at: &State, work: &mut Work) -> Linearised {
        let shape = model.shape();
        let n = shape.unknowns;
        // accelerations do not change the stiffness, but for those of the known points at which bodies are held
        let mut rest = at.clone();
        // the velocity of an internal state is its value
        let states = model.state_indices();
        let is_state = |i: &usize| states.contains(i);
        let moving = (0..shape.coordinates).filter(|i| !is_state(i));
        moving.for_each(|i| rest.v[i] = 0.0);
        let (mut r, mut phi) = (vec![0.0; shape.coordinates], vec![0.0; shape.multipliers]);
        let mut matrix = |q: f64, v: f64| {
            let symbolic = model.symbolic();
            let mut k = vec![0.0; symbolic.len()];
            let weights = Weights { q, v };
            model.linearise(&rest, weights, &mut r, &mut phi, &mut k, work);
            symbolic.to_dense(&k)
        };
        let [alone, with_k, with_c] = [matrix(0.0, 0.0), matrix(1.0, 0.0), matrix(0.0, 1.0)];
        let positions: Vec<usize> = (0..n).filter(|i| !is_state(i)).collect();
        let block = |of: &dyn Fn(usize, usize) -> f64| {
            let size = positions.len();
            Mat::from_fn(size, size, |i, j| of(positions[i], positions[j]))
        };
        // the row of a constraint that was left out has a diagonal, lambda = 0
        let rows = (n..n + shape.multipliers).filter(|&row| alone[(row, row)] == 0.0);
        let rows: Vec<usize> = rows.collect();
        let length = |row: usize| {
            let entries = positions.iter().map(|&j| alone[(row, j)]);
            entries.map(|x| x * x).sum::<f64>().sqrt()
        };
        Linearised {
            mass: block(&|i, j| alone[(i, j)]),
            stiffness: block(&|i, j| with_k[(i, j)] - alone[(i, j)]),
            damping: block(&|i, j| with_c[(i, j)] - alone[(i, j)]),
            gradient: Mat::from_fn(rows.len(), positions.len(), |i, j| {
                alone[(rows[i], positions[j])] / length(rows[i])
            }),
            rows,
            positions,
        }
    }

    /// x . B x of a displacement x; zero where that is rounding in B, which is the difference of M + B and M. Unlike an
    /// eigenvalue it keeps the digits of a slow mode beside fast ones.
    fn form(&self, b: &Mat<f64>, x: ColRef<f64>) -> f64 {
        let n = x.nrows();
        let entry = |i: usize, j: usize| self.mass[(i, j)].abs() + b[(i, j)].abs();
        let row = |i: usize| (0..n).map(move |j| (x[i] * entry(i, j) * x[j]).abs());
        let magnitude: f64 = (0..n).flat_map(row).sum();
        let value = x.transpose() * b * x;
        match value.abs() > ROUNDING * f64::EPSILON * magnitude {
            true => value,
            false => 0.0,
        }
    }

    /// An orthonormal basis of the displacements that the constraints allow, as columns.
    fn allowed(&self, model: &Model) -> Result<Mat<f64>, ModesError> {
        let (n, m) = (self.mass.nrows(), self.gradient.nrows());
        if n <= m {
            return Err(ModesError::Rigid);
        }
        if m == 0 {
            return Ok(Mat::identity(n, n));
        }
        let singular = |row: usize| ModesError::SingularPose(model.unknown_name(self.rows[row]));
        let svd = self.gradient.transpose().svd();
        let svd = svd.map_err(|_| singular(0))?;
        let values = svd.S();
        match values[m - 1] > SINGULAR * values[0] {
            true => Ok(svd.U().subcols(m, n - m).to_owned()),
            false => Err(singular(largest_entry(svd.V().col(m - 1)))),
        }
    }
}

/// The index of the entry of largest magnitude.
fn largest_entry(x: ColRef<f64>) -> usize {
    let indices = (0..x.nrows()).max_by(|i, j| x[*i].abs().total_cmp(&x[*j].abs()));
    indices.unwrap_or_default()
}

/// Eigenvectors of a symmetric matrix in the order of their eigenvalues, by nalgebra. faer's solver gave -6e5 1/s2 for a zero of a
/// free bar of 64 elements, whose largest square of a frequency is 2e13 1/s2.
fn eigenvectors(matrix: &Mat<f64>) -> Mat<f64> {
    let n = matrix.nrows();
    let eigen = DMatrix::from_fn(n, n, |i, j| matrix[(i, j)]).symmetric_eigen();
    let mut order: Vec<usize> = (0..n).collect();
    order.sort_by(|a, b| eigen.eigenvalues[*a].total_cmp(&eigen.eigenvalues[*b]));
    Mat::from_fn(n, n, |i, k| eigen.eigenvectors[(i, order[k])])
}

/// The modes of a mechanism about the pose of a consistent state. With `lengths`, the largest distance by which a unit of each
/// unknown moves a point of its body, the shapes are scaled.
///
/// # Errors
/// See [`ModesError`].
pub fn modes(
    model: &Model,
    at: &State,
    lengths: &[f64],
    work: &mut Work,
) -> Result<Modes, ModesError> {
    let linearised = Linearised::new(model, at, work);
    let z = linearised.allowed(model)?;
    let reduced = |matrix: &Mat<f64>| z.transpose() * matrix * &z;
    let [mass, stiffness] = [&linearised.mass, &linearised.stiffness].map(reduced);
    let size = |m: &Mat<f64>| m.norm_max();
    let odd = Mat::from_fn(z.ncols(), z.ncols(), |i, j| {
        0.5 * (stiffness[(i, j)] - stiffness[(j, i)])
    });
    let asymmetry = match size(&stiffness) {
        0.0 => 0.0,
        largest => size(&odd) / largest,
    };
    let factor = mass.llt(Side::Lower).map_err(|_| {
        let x = &z * eigenvectors(&mass).col(0);
        let most = linearised.positions[largest_entry(x.as_ref())];
        ModesError::Massless(model.unknown_name(most))
    })?;
    let lower = factor.L();
    // L^-1 K L^-T
    let mut half = &stiffness - &odd;
    lower.solve_lower_triangular_in_place(&mut half);
    let mut scaled = half.transpose().to_owned();
    lower.solve_lower_triangular_in_place(&mut scaled);
    let mut y = eigenvectors(&scaled);
    lower.transpose().solve_upper_triangular_in_place(&mut y);
    let x = &z * &y;
    let of = |k: usize| {
        let x = x.col(k);
        let square = linearised.form(&linearised.stiffness, x);
        let frequency = square.max(0.0).sqrt();
        let distances = linearised.positions.iter().enumerate();
        let distances = distances.map(|(j, &i)| (i, lengths[i] * x[j]));
        let largest = distances.max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()));
        let (most, distance) = largest.unwrap_or((0, 1.0));
        let mut shape = vec![0.0; at.q.len()];
        for (j, &i) in linearised.positions.iter().enumerate() {
            shape[i] = x[j] / distance;
        }
        NaturalMode {
            frequency: frequency / std::f64::consts::TAU,
            growth: (-square).max(0.0).sqrt(),
            damping: match frequency > 0.0 {
                true => 0.5 * linearised.form(&linearised.damping, x) / frequency,
                false => 0.0,
            },
            moves_most: model.unknown_names()[most].clone(),
            shape,
        }
    };
    Ok(Modes {
        modes: (0..z.ncols()).map(of).collect(),
        asymmetry,
    })
}

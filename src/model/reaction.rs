//! Forces that are not multipliers: reactions of joints that share or eliminate coordinates, and forces of drives.
//!
//! M a + f + Phi_q^T lambda of a group of terms is the external force on this group. Summed over the terms on one side of a
//! joint it is the force of the joint; summed over all terms at a driven coordinate it is the force of the drive.

use super::measure::contact_state;
use super::{Model, PlacedForce};
use crate::force::WIDTH;
use crate::link::ElasticRoute;
use crate::system::{State, Work};
use crate::terms::ConstraintTerm;

/// What a term contributes to consecutive coordinates of a point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Share {
    pub(crate) source: Source,
    /// Local index of the first coordinate.
    pub(crate) local: usize,
    /// Its index among the coordinates of the point: 0 for x, 1 for y, 2 for theta of a rigid body.
    pub(crate) place: usize,
    /// Number of coordinates.
    pub(crate) count: usize,
}

/// A term of the model, by its index in the list of its kind.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Source {
    Inertia(usize),
    Element(usize),
    Constraint(usize),
    Force(usize),
    Contact(usize),
}

/// A sum of shares, all on the same physical point, times a sign.
#[derive(Debug, Clone)]
pub struct Reaction {
    pub(crate) shares: Vec<Share>,
    pub(crate) sign: f64,
}

/// What acts on the coordinates of a point: x, y of a node, or x, y, theta of a rigid body.
#[derive(Debug, Clone)]
pub(crate) struct Grip {
    /// The first coordinate.
    pub x: usize,
    /// Number of coordinates.
    pub width: usize,
    /// What the terms contribute to the force on them.
    pub shares: Vec<Share>,
}

impl Model {
    /// Adds the force of `share`.
    fn add_share(&self, share: Share, at: &State, work: &mut Work, out: &mut [f64; 3]) {
        let out = &mut out[share.place..share.place + share.count];
        let mut add = |local: &[f64]| {
            for (o, x) in out.iter_mut().zip(&local[share.local..]) {
                *o += x;
            }
        };
        match share.source {
            Source::Inertia(i) => {
                let part = &self.mass.parts[i];
                let n = part.coordinates.len();
                for (o, row) in out.iter_mut().zip(share.local..) {
                    let values = &part.values[row * n..(row + 1) * n];
                    let columns = part.coordinates.iter().zip(&part.field);
                    *o += values
                        .iter()
                        .zip(columns)
                        .map(|(m, (&j, g))| m * (at.a[j] - at.weight * g))
                        .sum::<f64>();
                }
            }
            Source::Element(i) => {
                work.tally[self.elastic_counter] += 1;
                let element = &self.elements[i];
                let mut f = [0.0; 8];
                let q = std::array::from_fn(|j| at.q[element.block.coordinates[j]]);
                element.kernel.force(&q, &mut f);
                add(&f);
            }
            Source::Constraint(i) => {
                let c = &self.constraints[i];
                let gradient = c.term.gradient(at);
                for d in 0..c.rows {
                    add(&gradient[d].map(|g| g * at.lambda[c.row + d]));
                }
            }
            Source::Force(i) => {
                let PlacedForce { term, counter, .. } = &self.forces[i];
                work.tally[*counter] += 1;
                let mut f = [0.0; WIDTH];
                term.force(at, &mut f);
                add(&f);
            }
            Source::Contact(i) => {
                let c = &self.contacts[i];
                let mut f = [0.0; WIDTH];
                if c.pair.force(contact_state(at, i), &mut f) {
                    c.count(work);
                    add(&f);
                }
            }
        }
    }

    /// The sum of shares \[N\], and \[N m\] in the third place where the coordinates are those of rigid bodies.
    pub(crate) fn sum(&self, shares: &[Share], at: &State, work: &mut Work) -> [f64; 3] {
        let mut sum = [0.0; 3];
        for &share in shares {
            self.add_share(share, at, work, &mut sum);
        }
        sum
    }

    /// Power of the forces on known coordinates \[W\].
    pub(crate) fn drive_power(&self, at: &State, work: &mut Work) -> f64 {
        let power = |grip: &Grip| {
            let force = self.sum(&grip.shares, at, work);
            let rates = force.iter().zip(&at.v[grip.x..grip.x + grip.width]);
            rates.map(|(f, v)| f * v).sum::<f64>()
        };
        self.driven.iter().map(power).sum()
    }

    /// Power of the constraints that depend on time, lambda Phi_t \[W\]: Phi_q v = -Phi_t, and -Phi_q^T lambda acts.
    pub(crate) fn drift_power(&self, at: &State) -> f64 {
        let powers = self.constraints.iter().map(|placed| match &placed.term {
            ConstraintTerm::Other(term) => placed.multipliers(at)[0] * term.drift(at),
            ConstraintTerm::Length(_) | ConstraintTerm::Coincide(_) => 0.0,
        });
        powers.sum()
    }
}

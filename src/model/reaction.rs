//! Forces that are not multipliers: reactions of joints that share or eliminate coordinates, and forces of drives.
//!
//! M a + f + Phi_q^T lambda of a group of terms is the external force on this group. Summed over the terms on one side of a
//! joint it is the force of the joint; summed over all terms at a driven coordinate it is the force of the drive.

use super::memory::contact_state;
use super::{Model, PlacedForce};
use crate::constraint::{self, ROWS};
use crate::force::WIDTH;
use crate::link::ElasticRoute;
use crate::system::{State, Work};
use crate::terms::ConstraintTerm;
use indexmap::IndexMap;
use std::collections::HashMap;

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
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) enum Source {
    Inertia(usize),
    Eccentric(usize),
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
    /// The coordinates.
    pub coordinates: Vec<usize>,
    /// What the terms contribute to the force on them; on the unknown coordinate of a held body nothing acts.
    pub shares: Vec<Share>,
}

impl Grip {
    /// The coordinates that are the position of the point.
    pub fn position(&self) -> [usize; 2] {
        [self.coordinates[0], self.coordinates[1]]
    }
}

/// Most coordinates of a term that is not a mass.
const WIDEST: usize = constraint::WIDTH;

/// The forces on known coordinates that move: masses and weights there, and the other terms with their coordinates among these.
#[derive(Debug, Default)]
pub(crate) struct DrivenForces {
    /// Coordinates, with their weight on the left side of the equations of motion \[N\].
    coordinates: Vec<(usize, f64)>,
    terms: Vec<(Source, Vec<LocalPlace>)>,
}

/// A local coordinate of a term and the coordinate that it is.
#[derive(Debug, Clone, Copy)]
struct LocalPlace {
    local: usize,
    coordinate: usize,
}

impl DrivenForces {
    /// Of what acts on some points.
    pub fn new(grips: &[Grip], unknowns: usize, weight: &[(usize, f64)]) -> DrivenForces {
        let coordinates = grips.iter().flat_map(|grip| &grip.coordinates).copied();
        let coordinates = coordinates.filter(|i| *i >= unknowns);
        let weights: HashMap<usize, f64> = weight.iter().copied().collect();
        let mut terms: IndexMap<Source, Vec<LocalPlace>> = IndexMap::new();
        for (grip, share) in grips
            .iter()
            .flat_map(|g| g.shares.iter().map(move |s| (g, s)))
        {
            if matches!(share.source, Source::Inertia(_)) {
                continue;
            }
            let places = (0..share.count).map(|k| LocalPlace {
                local: share.local + k,
                coordinate: grip.coordinates[share.place + k],
            });
            terms.entry(share.source).or_default().extend(places);
        }
        DrivenForces {
            coordinates: coordinates
                .map(|i| (i, weights.get(&i).copied().unwrap_or(0.0)))
                .collect(),
            terms: terms.into_iter().collect(),
        }
    }
}

impl Model {
    /// Adds the force of `share`.
    fn add_share(&self, share: Share, at: &State, work: &mut Work, out: &mut [f64; 3]) {
        let out = &mut out[share.place..share.place + share.count];
        if let Source::Inertia(i) = share.source {
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
            return;
        }
        let local = self.local_force(share.source, at, work);
        for (o, f) in out.iter_mut().zip(&local[share.local..]) {
            *o += f;
        }
    }

    /// The local force of a term; zero for a mass, which is not bounded in its number of coordinates.
    #[inline]
    fn local_force(&self, source: Source, at: &State, work: &mut Work) -> [f64; WIDEST] {
        let mut local = [0.0; WIDEST];
        let narrow = local
            .first_chunk_mut::<WIDTH>()
            .expect("forces are narrower");
        match source {
            Source::Inertia(_) => {}
            Source::Eccentric(i) => {
                local[..3].copy_from_slice(&self.eccentric[i].mass.force(at));
            }
            Source::Element(i) => {
                work.tally[self.elastic_counter] += 1;
                let element = &self.elements[i];
                let q = std::array::from_fn(|j| at.q[element.block.coordinates[j]]);
                let f = local.first_chunk_mut().expect("elements are narrower");
                element.kernel.force(&q, f);
            }
            Source::Constraint(i) => {
                let c = &self.constraints[i];
                let mut gradient = [[0.0; constraint::WIDTH]; ROWS];
                c.term.value_and_gradient(at, &mut gradient);
                for (row, lambda) in gradient.iter().zip(&at.lambda[c.row..c.row + c.rows]) {
                    for (f, g) in local.iter_mut().zip(row) {
                        *f += g * lambda;
                    }
                }
            }
            Source::Force(i) => {
                let PlacedForce { term, counter, .. } = &self.forces[i];
                work.tally[*counter] += 1;
                term.force(at, narrow);
            }
            Source::Contact(i) => {
                let c = &self.contacts[i];
                if c.pair.force(contact_state(at, i), narrow) {
                    c.count(work);
                }
            }
        }
        local
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
        let DrivenForces { coordinates, terms } = &self.driven;
        let mut power = 0.0;
        for &(i, weight) in coordinates {
            let inertia: f64 = self.mass.row(i).map(|(j, m)| m * at.a[j]).sum();
            power += at.v[i] * (inertia + at.weight * weight);
        }
        for (source, places) in terms {
            let local = self.local_force(*source, at, work);
            for place in places {
                power += local[place.local] * at.v[place.coordinate];
            }
        }
        power
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

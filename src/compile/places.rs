//! The places of terms in the equations, in the memory and in the ledger.

use crate::contact::ContactPair;
use crate::eccentric_mass::EccentricMass;
use crate::force::Force;
use crate::ledger::{Entry, STANDARD};
use crate::link::AncfCable;
use crate::math::lu::Symbolic;
use crate::math::saddle_point::SaddlePoint;
use crate::model::{
    Block, Border, PlacedConstraint, PlacedContact, PlacedEccentric, PlacedElement, PlacedEvents,
    PlacedForce,
};
use crate::terms::{ConstraintRows, Terms};

/// Finds the places of terms in the matrices.
pub(super) struct Places<'a> {
    pub tangent: &'a Symbolic,
    pub acceleration_level: &'a SaddlePoint,
    pub unknowns: usize,
    pub ledger: &'a [&'static Entry],
}

impl Places<'_> {
    fn block(&self, coordinates: Vec<usize>) -> Block {
        Block::new(coordinates, self.tangent, self.unknowns)
    }

    /// The indices of entries of the ledger.
    fn booked(&self, own: &[&'static Entry]) -> Vec<usize> {
        let place = |entry| self.ledger.iter().position(|other| *other == entry);
        own.iter().filter_map(|entry| place(*entry)).collect()
    }

    pub fn eccentric(&self, masses: Vec<EccentricMass>) -> Vec<PlacedEccentric> {
        let masses = masses.into_iter().map(|mass| {
            let [x, y, theta] = mass.pose;
            let known = [x.min(y), theta].map(|i| i >= self.unknowns);
            assert!(
                known.contains(&true),
                "the mass matrix would depend on theta"
            );
            let slot = match known[1] {
                true => self.tangent.discarded_slot(),
                false => self.tangent.slot(theta, theta),
            };
            PlacedEccentric { mass, slot }
        });
        masses.collect()
    }

    pub fn elements(&self, elements: Vec<(AncfCable, Vec<usize>)>) -> Vec<PlacedElement> {
        let elements = elements
            .into_iter()
            .map(|(kernel, coordinates)| PlacedElement {
                kernel,
                block: self.block(coordinates),
            });
        elements.collect()
    }

    pub fn constraints(&self, constraints: Vec<ConstraintRows>) -> Vec<PlacedConstraint> {
        let mut row = 0;
        let constraints = constraints.into_iter().map(|r| {
            let sides = r.term.sides();
            let (owners, coordinates) = (owners(&sides, r.sides), sides.concat());
            let rows = r.term.rows();
            let border = |d| Border::new(&coordinates, row + d, self.tangent, self.unknowns);
            let entries = |d| self.entries(&coordinates, row + d);
            let placed = PlacedConstraint {
                border: (0..rows).map(border).collect(),
                entries: (0..rows).map(entries).collect(),
                owners,
                block: self.block(coordinates),
                row,
                rows,
                kept: [1.0; 2],
                term: r.term,
            };
            row += rows;
            placed
        });
        constraints.collect()
    }

    /// The entries of a row of Phi_q in the matrix of the acceleration level.
    fn entries(&self, coordinates: &[usize], row: usize) -> Vec<u32> {
        let mut next = self.acceleration_level.first_entry(row) as u32;
        let entry = coordinates.iter().map(|&i| match i < self.unknowns {
            true => {
                next += 1;
                next - 1
            }
            false => self.acceleration_level.discarded_entry(),
        });
        entry.collect()
    }

    pub fn forces(
        &self,
        forces: Vec<(Box<dyn Force>, [usize; 2])>,
        damping: Vec<(Box<dyn Force>, usize)>,
    ) -> Vec<PlacedForce> {
        let damping = damping.into_iter().map(|(term, body)| (term, [body, body]));
        let forces = forces.into_iter().chain(damping).map(|(term, sides)| {
            let coordinates = term.sides();
            PlacedForce {
                owners: owners(&coordinates, sides),
                block: self.block(coordinates.concat()),
                counter: 0,
                entries: self.booked(&term.entries()),
                term,
            }
        });
        forces.collect()
    }

    pub fn contacts(&self, contacts: Vec<Box<dyn ContactPair>>) -> Vec<PlacedContact> {
        let contacts = contacts.into_iter().map(|pair| PlacedContact {
            block: self.block(pair.coordinates()),
            counters: Vec::new(),
            entries: self.booked(&pair.entries()),
            pair,
        });
        contacts.collect()
    }
}

/// The body of each local coordinate of a term.
fn owners(coordinates: &[Vec<usize>; 2], bodies: [usize; 2]) -> Vec<usize> {
    let sides = coordinates.iter().zip(bodies);
    let owners = sides.flat_map(|(side, body)| vec![body; side.len()]);
    owners.collect()
}

/// The entries of the energy ledger: those of every mechanism, then others of its terms.
pub(super) fn ledger(terms: &Terms) -> Vec<&'static Entry> {
    let contacts = terms.contacts.iter().flat_map(|pair| pair.entries());
    let forces = terms.forces.iter().map(|(term, _)| term);
    let damping = terms.damping.iter().map(|(term, _)| term);
    let forces = forces.chain(damping).flat_map(|term| term.entries());
    let mut ledger = STANDARD.to_vec();
    for entry in contacts.chain(forces) {
        if !ledger.contains(&entry) {
            ledger.push(entry);
        }
    }
    ledger
}

/// The forces that have memory. Their functions follow those of the contacts.
pub(super) fn events(terms: &Terms) -> Vec<PlacedEvents> {
    let mut first = terms.contacts.len();
    let forces = terms.forces.iter().enumerate();
    let events = forces.filter_map(|(force, (term, _))| {
        let crossings = first..first + term.events()?.crossings();
        first = crossings.end;
        Some(PlacedEvents { force, crossings })
    });
    events.collect()
}

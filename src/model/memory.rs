//! Memory: what contacts and forces keep from step to step, and the events at which it changes.

use super::Model;
use crate::contact;
use crate::force::{Events, passes};
use crate::ledger::OF_FRICTION;
use crate::system::{Changed, State};
use std::ops::Range;

/// A force that has memory.
#[derive(Debug)]
pub(crate) struct PlacedEvents {
    pub force: usize,
    /// Its functions among those of the system.
    pub crossings: Range<usize>,
}

/// True of a contact that is closed.
pub(super) fn is_closed(at: &State, contact: usize) -> bool {
    at.memory[contact] > 0.0
}

/// Positions, velocities and memory of a contact.
pub(super) fn contact_state(at: &State, contact: usize) -> contact::ContactState<'_> {
    contact::ContactState {
        q: &at.q,
        v: &at.v,
        a: &at.a,
        impact_velocity: at.memory[contact],
    }
}

impl Model {
    /// The contacts that are closed.
    pub fn closed<'a>(&self, at: &'a State) -> impl Iterator<Item = usize> + 'a {
        (0..self.contacts.len()).filter(|&contact| is_closed(at, contact))
    }

    /// Opens all contacts.
    pub fn open_contacts(&self, at: &mut State) {
        at.memory[..self.shape.contacts].fill(0.0);
    }

    /// The forces that have memory, with their functions among those of the system.
    fn events(&self) -> impl Iterator<Item = (&dyn Events, Range<usize>)> {
        self.events.iter().filter_map(|placed| {
            let events = self.forces[placed.force].term.events()?;
            Some((events, placed.crossings.clone()))
        })
    }

    /// The functions that pass zero from below where memory changes, and their rates.
    pub(super) fn measure_crossings(&self, at: &State, crossings: &mut [[f64; 2]]) {
        for (i, (c, out)) in self.contacts.iter().zip(&mut *crossings).enumerate() {
            let gap = c.pair.gap(&at.q, &at.v);
            let side = if is_closed(at, i) { -1.0 } else { 1.0 };
            *out = [side * gap.delta, side * c.pair.rate(&gap)];
        }
        for (events, range) in self.events() {
            events.cross(at, &mut crossings[range]);
        }
    }

    /// The next instant at which the memory of a force may change.
    pub(super) fn instant_after(&self, at: &State) -> f64 {
        let instants = self.events().map(|(events, _)| events.next_instant(at));
        let to_come = instants.filter(|instant| *instant > at.t);
        to_come.fold(f64::INFINITY, f64::min)
    }

    /// Closes and opens contacts.
    pub(super) fn commit_contacts(
        &self,
        at: &mut State,
        crossings: &[[f64; 2]],
        tolerance: f64,
        changed: &mut dyn FnMut(Changed),
    ) {
        for (i, &[past, rate]) in crossings[..self.contacts.len()].iter().enumerate() {
            let closed = is_closed(at, i);
            // surfaces that are at rest where they part have parted
            let parts = closed && past >= -tolerance && rate == 0.0;
            if !(parts || passes([past, rate], tolerance)) {
                continue;
            }
            at.changes += 1;
            self.relax(i, at);
            if closed {
                at.memory[i] = 0.0;
                changed(Changed::Loss { contact: i });
            } else {
                // a contact that starts penetrated has no impact velocity: the floor of the law replaces it
                at.memory[i] = rate.max(f64::MIN_POSITIVE);
                changed(Changed::Onset {
                    contact: i,
                    velocity: rate,
                    delta: past,
                });
            }
        }
    }

    /// Sets the internal state of a contact to zero; what it stores is lost to friction.
    fn relax(&self, contact: usize, at: &mut State) {
        let pair = &self.contacts[contact].pair;
        let Some(state) = pair.state() else { return };
        let before = pair.energy(contact_state(at, contact));
        (at.v[state], at.a[state]) = (0.0, 0.0);
        let after = pair.energy(contact_state(at, contact));
        at.integrals[OF_FRICTION] += before - after;
    }

    /// Changes the memory of forces.
    pub(super) fn commit_forces(
        &self,
        at: &mut State,
        crossings: &[[f64; 2]],
        tolerance: f64,
        changed: &mut dyn FnMut(Changed),
    ) {
        for (placed, (events, range)) in self.events.iter().zip(self.events()) {
            if events.commit(at, &crossings[range], tolerance) {
                at.changes += 1;
                changed(Changed::Switch {
                    force: placed.force,
                });
            }
        }
    }

    /// Lets forces remember a state that no step has led to.
    pub(crate) fn remember(&self, at: &mut State) {
        let mut crossings = vec![[0.0; 2]; self.shape.crossings];
        self.measure_crossings(at, &mut crossings);
        self.commit_forces(at, &crossings, 0.0, &mut |_| {});
    }

    /// The name of a force, by its index among all forces; empty for a force of structural damping.
    pub(crate) fn force_name(&self, force: usize) -> &str {
        let named = self.named_forces.iter().find(|(_, place)| *place == force);
        named.map_or("", |(name, _)| name)
    }
}

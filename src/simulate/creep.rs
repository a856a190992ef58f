//! Creep: a friction law whose force grows with the slip from zero on cannot hold a body, which slides slowly where it should stick.

use crate::checkpoint::{Carried, Checkpoint, carried};
use crate::model::Model;
use crate::system::State;
use serde::Serialize;
use std::collections::BTreeMap;

/// Creep for less than this part of a run is a passage through small slip.
const SUSTAINED: f64 = 0.1;
/// It takes so many rows to tell it from slip that changes between rows.
const ROWS: u64 = 10;

/// A contact that slid in one direction, more slowly than its friction law needs for its full force.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct Creep {
    /// The first row of it \[s\].
    pub from: f64,
    /// The last \[s\].
    pub to: f64,
    /// How far \[m\].
    pub distance: f64,
    #[serde(skip)]
    slip: f64,
    #[serde(skip)]
    rows: u64,
}

carried!(Creep { from, to, distance, slip, rows } but {});

/// Watches contacts at the recorded rows.
#[derive(Debug)]
pub(super) struct CreepWatch {
    now: Vec<Creep>,
    longest: Vec<Creep>,
}

impl CreepWatch {
    /// For so many contacts.
    pub fn new(contacts: usize) -> CreepWatch {
        CreepWatch {
            now: vec![Creep::default(); contacts],
            longest: vec![Creep::default(); contacts],
        }
    }

    /// A row is recorded.
    pub fn row(&mut self, model: &Model, at: &State) {
        for (contact, (now, longest)) in self.now.iter_mut().zip(&mut self.longest).enumerate() {
            let slip = model.creep(contact, at).unwrap_or(0.0);
            *now = match slip * now.slip > 0.0 {
                true => Creep {
                    to: at.t,
                    distance: now.distance + 0.5 * (slip + now.slip).abs() * (at.t - now.to),
                    slip,
                    rows: now.rows + 1,
                    ..*now
                },
                false => Creep {
                    from: at.t,
                    to: at.t,
                    distance: 0.0,
                    slip,
                    rows: 1,
                },
            };
            if now.to - now.from > longest.to - longest.from {
                *longest = *now;
            }
        }
    }

    /// The longest creep of every joint in a run of this duration that has some.
    pub fn report(&self, model: &Model, duration: f64) -> BTreeMap<String, Creep> {
        let contacts = self.longest.iter().enumerate();
        let lasting = contacts.filter(|(_, creep)| {
            creep.rows >= ROWS && creep.to - creep.from >= SUSTAINED * duration
        });
        let named = lasting.filter_map(|(contact, creep)| {
            let joint = model.contact_joint(contact)?;
            Some((model.joints()[joint].name.clone(), *creep))
        });
        named.collect()
    }
}

impl Carried for CreepWatch {
    fn carry(&mut self, checkpoint: &mut Checkpoint) {
        self.now.carry(checkpoint);
        self.longest.carry(checkpoint);
    }
}

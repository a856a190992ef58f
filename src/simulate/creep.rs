//! Creep: a friction law whose force grows with the slip from zero on cannot hold a body, which slides slowly where it should stick.

use crate::checkpoint::{Carried, Checkpoint, carried};
use crate::initial::left_free;
use crate::model::Model;
use crate::scene::Scene;
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
    /// When a friction law was first at a slip at which it may give energy \[s\].
    giving: Vec<Option<f64>>,
}

impl CreepWatch {
    /// For so many contacts.
    pub fn new(contacts: usize) -> CreepWatch {
        CreepWatch {
            now: vec![Creep::default(); contacts],
            longest: vec![Creep::default(); contacts],
            giving: vec![None; contacts],
        }
    }

    /// A row is recorded.
    pub fn row(&mut self, model: &Model, at: &State) {
        let watched = self.now.iter_mut().zip(&mut self.longest);
        for (contact, ((now, longest), giving)) in watched.zip(&mut self.giving).enumerate() {
            let slip = model.slip(contact, at);
            if slip.is_some_and(|(slip, law)| law.may_give_energy(slip)) {
                giving.get_or_insert(at.t);
            }
            let creep = slip.filter(|(slip, law)| law.creeps(*slip));
            let slip = creep.map_or(0.0, |(slip, _)| slip);
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

    /// The joints whose friction law was at a slip at which it may give energy, and when first \[s\].
    pub fn giving(&self, model: &Model) -> BTreeMap<String, f64> {
        let contacts = self.giving.iter().enumerate();
        let named = contacts.filter_map(|(contact, from)| {
            let joint = model.contact_joint(contact)?;
            Some((model.joints()[joint].name.clone(), (*from)?))
        });
        named.collect()
    }

    /// The longest creep of every joint that has some, in a run of this scene. Where the drives determine both bodies of a joint they
    /// impose its slip, and nothing should stick.
    pub fn report(&self, scene: &Scene, model: &Model) -> BTreeMap<String, Creep> {
        let contacts = self.longest.iter().enumerate();
        let lasting = contacts.filter(|(_, creep)| {
            creep.rows >= ROWS && creep.to - creep.from >= SUSTAINED * scene.simulation.duration
        });
        let joints =
            lasting.filter_map(|(contact, creep)| Some((model.contact_joint(contact)?, creep)));
        let joints: Vec<(usize, &Creep)> = joints.collect();
        let free = (!joints.is_empty()).then(|| left_free(scene)).flatten();
        let is_free = |joint: &usize| {
            let bodies = scene.joints[*joint].points().map(|point| point.body);
            let moves = |free: &Vec<usize>| bodies.iter().any(|body| free.contains(body));
            free.as_ref().is_none_or(moves)
        };
        let creeping = joints.into_iter().filter(|(joint, _)| is_free(joint));
        let named = creeping.map(|(joint, creep)| (scene.joints[joint].name.clone(), *creep));
        named.collect()
    }
}

impl Carried for CreepWatch {
    fn carry(&mut self, checkpoint: &mut Checkpoint) {
        self.now.carry(checkpoint);
        self.longest.carry(checkpoint);
        self.giving.carry(checkpoint);
    }
}

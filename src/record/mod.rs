//! Named channels with units: what a row of output contains.

mod channels;
mod motion;
pub mod patterns;
mod unknown_channel;

use crate::body::Strain;
use crate::checkpoint::carried;
use crate::ledger::{Entry, STANDARD, Side};
use crate::math::plane::full_turns;
use crate::model::{Energies, Model};
use crate::motion::Function;
use crate::scene::{Analysis, Scene, SceneError};
use crate::system::{State, Work};
use channels::{Part, Removed, parts};
use indexmap::IndexMap;
use std::collections::HashMap;
use texts::{described, harmful_in_line};

pub use channels::Channel;
pub use motion::MotionLayout;

/// Fills rows.
#[derive(Debug)]
pub struct Recorder {
    channels: Vec<Channel>,
    /// The parts that have a channel.
    parts: Vec<Part>,
    /// Where the value of each channel stands among those of the parts.
    places: Vec<usize>,
    /// For channels that are angles known only to a full turn.
    turning: Vec<Option<Turning>>,
    /// Values of the parts.
    values: Vec<f64>,
    row: Vec<f64>,
    /// Energy at t = 0 \[J\].
    initial_energy: f64,
    /// Entries of the energy ledger.
    ledger: Vec<&'static Entry>,
    /// What the scene asks for and the mechanism does not have.
    absent: Vec<String>,
}

/// An angle that is followed over full turns.
#[derive(Debug, Default)]
struct Turning {
    /// Where its speed stands among the values of the parts.
    speed: usize,
    /// Last angle, its rate and its time.
    last: Option<[f64; 3]>,
}

carried!(Turning { last } but { speed });

impl Turning {
    /// The angle nearest to where the last recorded one and the speeds since lead.
    fn follow(&mut self, angle: f64, speed: f64, t: f64) -> f64 {
        let angle = match self.last {
            None => angle,
            Some([before, rate, then]) => {
                let expected = before + 0.5 * (rate + speed) * (t - then);
                angle + full_turns(expected - angle)
            }
        };
        self.last = Some([angle, speed, t]);
        angle
    }
}

carried!(Recorder { turning } but { channels, parts, places, values, row, initial_energy, ledger, absent });

/// What is measured at every row, whether a channel shows it or not.
#[derive(Debug, Clone, Default)]
pub struct Record {
    /// Stored energies.
    pub energies: Energies,
    /// Largest strains by body; 0 for bodies that do not deform.
    pub strains: Vec<Strain>,
}

impl Record {
    /// Measures a consistent state.
    pub fn take(&mut self, model: &Model, at: &State) {
        self.energies = model.energies(at);
        let strains = (0..model.bodies().len()).map(|b| model.strain(b, at).unwrap_or_default());
        self.strains.clear();
        self.strains.extend(strains);
    }
}

/// The terms of the energy ledger \[J\].
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
#[expect(missing_docs, reason = "the names are those of the channels")]
pub struct Ledger {
    pub initial: f64,
    #[serde(flatten)]
    pub stored: Energies,
    pub work: f64,
    pub contact_dissipated: f64,
    pub friction_dissipated: f64,
    pub damping_dissipated: f64,
    pub clamp: f64,
    /// Entries that only some mechanisms have.
    #[serde(flatten)]
    pub others: IndexMap<&'static str, f64>,
    /// Those of them that are losses.
    #[serde(skip)]
    pub other_losses: f64,
    pub numerical: f64,
}

impl Ledger {
    /// All energy dissipated \[J\].
    pub fn dissipated(&self) -> f64 {
        self.contact_dissipated
            + self.friction_dissipated
            + self.damping_dissipated
            + self.other_losses
    }
}

impl Recorder {
    /// The channels that the scene asks for, time first, each once, in the order of the scene.
    ///
    /// # Errors
    /// A name that no channel has; a quantity of a force whose name or unit no text may hold.
    pub fn new(scene: &Scene, model: &Model, initial_energy: f64) -> Result<Recorder, SceneError> {
        check_quantities(scene, model)?;
        let all = parts(model, scene.simulation.analysis);
        let mut available = Vec::new();
        for (p, part) in all.iter().enumerate() {
            let channels = part.channels(model).into_iter().enumerate();
            available.extend(channels.map(|(place, channel)| Available {
                channel,
                part: p,
                place,
            }));
        }
        let (chosen, absent) = choose(scene, model, &available)?;
        // where the values of each part begin that has a chosen channel
        let mut firsts = vec![None; all.len()];
        let (mut parts, mut count) = (Vec::new(), 0);
        for entry in &chosen {
            if firsts[entry.part].is_none() {
                firsts[entry.part] = Some(count);
                count += all[entry.part].channels(model).len();
                parts.push(all[entry.part]);
            }
        }
        let angles = scene.prescribed_angles();
        let first = |entry: &Available| firsts[entry.part].unwrap_or_default();
        let turning = |entry: &&Available| {
            let [angle, speed] = all[entry.part].turning()?;
            (entry.place == angle).then(|| Turning {
                speed: first(entry) + speed,
                last: given_angle(scene, &angles, all[entry.part]),
            })
        };
        Ok(Recorder {
            places: chosen.iter().map(|e| first(e) + e.place).collect(),
            turning: chosen.iter().map(turning).collect(),
            row: vec![0.0; chosen.len()],
            channels: chosen.into_iter().map(|e| e.channel.clone()).collect(),
            parts,
            values: Vec::with_capacity(count),
            initial_energy,
            ledger: model.ledger.clone(),
            absent,
        })
    }

    /// Names and units, in the order of a row.
    pub fn channels(&self) -> &[Channel] {
        &self.channels
    }

    /// A line for every entry of `output.channels` that nothing is recorded of.
    pub fn absent(&self) -> &[String] {
        &self.absent
    }

    /// The ledger at a consistent state with these energies.
    pub fn ledger(&self, stored: &Energies, at: &State) -> Ledger {
        let [
            work,
            contact_dissipated,
            friction_dissipated,
            damping_dissipated,
            clamp,
        ] = std::array::from_fn(|entry| at.integrals[entry]);
        let supplied = self.initial_energy + work;
        let others = || self.ledger.iter().zip(&at.integrals).skip(STANDARD.len());
        let on = |side| {
            let own = others().filter(|(entry, _)| entry.side == side);
            own.fold(0.0, |sum, (_, integral)| sum + integral)
        };
        let other_losses = on(Side::Lost);
        Ledger {
            initial: self.initial_energy,
            stored: *stored,
            work,
            contact_dissipated,
            friction_dissipated,
            damping_dissipated,
            clamp,
            others: others()
                .map(|(entry, integral)| (entry.name, *integral))
                .collect(),
            other_losses,
            numerical: supplied
                - contact_dissipated
                - friction_dissipated
                - damping_dissipated
                - stored.total()
                + (on(Side::Supplied) - other_losses),
        }
    }

    /// The row at a consistent state, of which `record` was taken.
    pub fn row(&mut self, model: &Model, at: &State, record: &Record, work: &mut Work) -> &[f64] {
        let ledger = self.ledger(&record.energies, at);
        self.values.clear();
        for part in &self.parts {
            part.measure(model, at, &ledger, &record.strains, work, &mut self.values);
        }
        let angles = self.turning.iter_mut().zip(&self.places);
        for (value, (turning, place)) in self.row.iter_mut().zip(angles) {
            *value = self.values[*place];
            if let Some(turning) = turning {
                *value = turning.follow(*value, self.values[turning.speed], at.t);
            }
        }
        &self.row
    }
}

/// Refuses a force, whose kind may be a user's own, with a quantity that cannot stand above a column.
fn check_quantities(scene: &Scene, model: &Model) -> Result<(), SceneError> {
    for force in model.named_forces() {
        let (name, term) = model.named_force(force);
        let quantities = term.quantities().iter();
        let mut texts = quantities.flat_map(|(name, unit)| [name, unit]);
        let Some(c) = texts.find_map(|text| harmful_in_line(text)) else {
            continue;
        };
        let named = scene.forces.iter().find(|force| force.name == name);
        let span = named.map_or(scene.initial.span, |force| force.span);
        let message = format!("a quantity of `forces.{name}` holds {}", described(c));
        return Err(scene.error(span, message, "of this kind"));
    }
    Ok(())
}

/// A channel that a scene can ask for.
struct Available {
    channel: Channel,
    /// Index of its part, and its place among the values of the part.
    part: usize,
    place: usize,
}

/// The time, and the channels that fit a pattern of the scene, each once; and what the mechanism does not have: patterns without a
/// channel, and channels of flexible links or of joints with clearance.
fn choose<'a>(
    scene: &Scene,
    model: &Model,
    available: &'a [Available],
) -> Result<(Vec<&'a Available>, Vec<String>), SceneError> {
    let names: Vec<&str> = available.iter().map(|e| &*e.channel.name).collect();
    let wanted = &scene.output.channels;
    let time = std::iter::once(names[0]);
    let patterns = time.chain(wanted.iter().map(|wanted| &*wanted.pattern));
    let choice = patterns::choose(patterns, names.iter().copied());
    let removed = Removed::of(model);
    let mut absent = Vec::new();
    for k in choice.unmatched {
        // the first pattern is the time, which is there
        let wanted = &wanted[k - 1];
        let name = &*wanted.pattern;
        absent.push(if name.contains(patterns::WILDCARD) {
            format!("the pattern {name:?} of `output.channels` matches no channel")
        } else if let Some(reason) = removed.reason(name) {
            format!("the channel {name:?} is not recorded: {reason}")
        } else {
            return Err(unknown_channel::fault(scene, wanted, &names));
        });
    }
    let chosen = choice.names.into_iter().map(|k| &available[k]);
    Ok((chosen.collect(), absent))
}

/// What an angle is nearest to at t = 0, with its rate and that time: the angle that a state of the body or the drive of the
/// joint gives, and zero of a joint that follows inverse kinematics.
fn given_angle(scene: &Scene, driven: &HashMap<usize, &Function>, part: Part) -> Option<[f64; 3]> {
    match part {
        Part::Pose(b) => {
            // a body with a coordinate for its angle knows how far it has turned on the way to an equilibrium
            let comes_to_rest = scene.initial.equilibrium.is_some()
                || scene.simulation.analysis == Analysis::Static;
            let slots = scene.bodies[b].kind.slots();
            if comes_to_rest && slots.iter().any(|slot| slot.content.angle().is_some()) {
                return None;
            }
            let given = scene.initial.state_of(b)?;
            Some([given.position[2], given.velocity[2], 0.0])
        }
        Part::Turned(j) | Part::Actuator(j) => {
            let angle = driven.get(&j).map(|angle| angle.at(0.0));
            let [angle, rate, _] = angle.unwrap_or_default();
            Some([angle, rate, 0.0])
        }
        _ => None,
    }
}

//! Named channels with units: what a row of output contains.

mod channels;

use crate::model::{Energies, Model, Pose};
use crate::scene::{MotionKind, Scene, SceneError};
use crate::system::{State, Work};
use channels::{Energy, JointQuantity, Quantity, available, matches};
use std::f64::consts::TAU;

pub use channels::Channel;

/// Fills rows.
#[derive(Debug)]
pub struct Recorder {
    channels: Vec<Channel>,
    quantities: Vec<Quantity>,
    /// For channels that are angles known only to a full turn: last value, its rate and its time.
    last: Vec<Option<(f64, f64, f64)>>,
    row: Vec<f64>,
    /// Energy at t = 0 \[J\].
    initial_energy: f64,
}

/// The terms of the energy ledger \[J\].
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
#[expect(missing_docs, reason = "the names are those of the channels")]
pub struct Ledger {
    pub initial: f64,
    pub kinetic: f64,
    pub axial: f64,
    pub bending: f64,
    pub contact: f64,
    pub gravity: f64,
    pub springs: f64,
    pub work: f64,
    pub contact_dissipated: f64,
    pub friction_dissipated: f64,
    pub damping_dissipated: f64,
    pub clamp: f64,
    pub numerical: f64,
}

impl Ledger {
    /// Energy dissipated in contacts, by friction and by damping \[J\].
    pub fn dissipated(&self) -> f64 {
        self.contact_dissipated + self.friction_dissipated + self.damping_dissipated
    }
}

impl Recorder {
    /// The channels that the scene asks for, time first, each once, in the order of the scene.
    ///
    /// # Errors
    /// A pattern that no channel has.
    pub fn new(scene: &Scene, model: &Model, initial_energy: f64) -> Result<Recorder, SceneError> {
        let available = available(model, scene.simulation.analysis);
        let mut chosen: Vec<&(Channel, Quantity)> = vec![&available[0]];
        for wanted in &scene.output.channels {
            let before = chosen.len();
            let mut known = false;
            for entry in available
                .iter()
                .filter(|(c, _)| matches(&wanted.pattern, &c.name))
            {
                known = true;
                if !chosen.iter().any(|(c, _)| c.name == entry.0.name) {
                    chosen.push(entry);
                }
            }
            if !known && chosen.len() == before {
                let likeness = |name: &str| strsim::jaro_winkler(name, &wanted.pattern);
                let nearest = available.iter().map(|(c, _)| c.name.as_str());
                let nearest = nearest
                    .max_by(|a, b| likeness(a).total_cmp(&likeness(b)))
                    .unwrap_or_default();
                let message = format!(
                    "no channel of this scene is named {:?}; the nearest is {nearest:?}",
                    wanted.pattern
                );
                return Err(scene.error(wanted.span, message, "unknown channel"));
            }
        }
        let (channels, quantities): (Vec<_>, Vec<_>) = chosen.into_iter().cloned().unzip();
        Ok(Recorder {
            last: quantities.iter().map(|q| given_angle(scene, q)).collect(),
            row: vec![0.0; channels.len()],
            channels,
            quantities,
            initial_energy,
        })
    }

    /// Names and units, in the order of a row.
    pub fn channels(&self) -> &[Channel] {
        &self.channels
    }

    /// The ledger at a consistent state.
    pub fn ledger(&self, model: &Model, at: &State) -> Ledger {
        let e = model.energies(at);
        let [
            work,
            contact_dissipated,
            friction_dissipated,
            damping_dissipated,
            clamp,
        ] = at.integrals;
        Ledger {
            initial: self.initial_energy,
            kinetic: e.kinetic,
            axial: e.axial,
            bending: e.bending,
            contact: e.contact,
            gravity: e.gravity,
            springs: e.springs,
            work,
            contact_dissipated,
            friction_dissipated,
            damping_dissipated,
            clamp,
            numerical: self.initial_energy + work - at.dissipated() - e.total(),
        }
    }

    /// The row at a consistent state.
    pub fn row(&mut self, model: &Model, at: &State, work: &mut Work) -> &[f64] {
        let mut cache = Cache::default();
        for c in 0..self.quantities.len() {
            let value = match self.quantities[c] {
                Quantity::Time => at.t,
                Quantity::Pose(b, level, i) => {
                    let pose = cache.pose(model, b, at);
                    let value = [pose.position, pose.velocity, pose.acceleration][level][i];
                    if level == 0 && i == 2 {
                        self.unwrap(c, value, pose.velocity[2], at.t)
                    } else {
                        value
                    }
                }
                Quantity::Joint(j, quantity) => {
                    let value = joint_value(model, j, quantity, at, work, &mut cache);
                    match quantity {
                        JointQuantity::Angle => self.unwrap(c, value, model.turned(j, at)[1], at.t),
                        _ => value,
                    }
                }
                Quantity::Actuator(j, k) => {
                    let values = cache.actuator(model, j, at, work);
                    if k == 0 {
                        self.unwrap(c, values[0], values[1], at.t)
                    } else {
                        values[k]
                    }
                }
                Quantity::Strain(b) => model.strain(b, at).unwrap_or_default(),
                Quantity::Error(b, i) => {
                    let prescribed = model.prescribed(b, at).unwrap_or_default();
                    cache.pose(model, b, at).position[i] - prescribed.position[i]
                }
                Quantity::Point(b, p, level, i) => model.point(b, p, at)[level][i],
                Quantity::Slope(b, p, i) => model.bodies()[b].points[p]
                    .slope
                    .map_or(0.0, |x| at.q[x + i]),
                Quantity::Force(f, k) => model.named_force(f, at)[k],
                Quantity::Energy(energy) => self.energy_value(model, energy, at, &mut cache),
            };
            self.row[c] = value;
        }
        &self.row
    }

    fn energy_value(&self, model: &Model, energy: Energy, at: &State, cache: &mut Cache) -> f64 {
        let e = *cache.energies.get_or_insert_with(|| model.energies(at));
        match energy {
            Energy::Kinetic => e.kinetic,
            Energy::Axial => e.axial,
            Energy::Bending => e.bending,
            Energy::Contact => e.contact,
            Energy::Gravity => e.gravity,
            Energy::Springs => e.springs,
            Energy::Integral(integral) => at.integrals[integral as usize],
            Energy::Numerical => {
                let [work, contact, friction, damping, _] = at.integrals;
                self.initial_energy + work - contact - friction - damping - e.total()
            }
        }
    }

    /// The angle nearest to where the last recorded one and the speeds since lead.
    fn unwrap(&mut self, channel: usize, angle: f64, speed: f64, t: f64) -> f64 {
        let value = match self.last[channel] {
            None => angle,
            Some((before, rate, then)) => {
                let expected = before + 0.5 * (rate + speed) * (t - then);
                angle + TAU * ((expected - angle) / TAU).round()
            }
        };
        self.last[channel] = Some((value, speed, t));
        value
    }
}

/// What the angle of a channel is nearest to at t = 0, with its rate and that time: the angle that a state of the body or the
/// drive of the joint gives, and zero of a joint that follows inverse kinematics.
fn given_angle(scene: &Scene, quantity: &Quantity) -> Option<(f64, f64, f64)> {
    match *quantity {
        Quantity::Pose(b, 0, 2) => {
            let given = scene.initial.bodies.iter().find(|s| s.body == b)?;
            Some((given.position[2], given.velocity[2], 0.0))
        }
        Quantity::Joint(j, JointQuantity::Angle) | Quantity::Actuator(j, 0) => {
            let driven = scene.motions.iter().find_map(|motion| match &motion.kind {
                MotionKind::Angle { joint, angle } if *joint == j => Some(angle.at(0.0)),
                _ => None,
            });
            let [angle, rate, _] = driven.unwrap_or_default();
            Some((angle, rate, 0.0))
        }
        _ => None,
    }
}

/// Measurements of one instant, each taken once.
#[derive(Default)]
struct Cache {
    pose: Option<(usize, Pose)>,
    force: Option<(usize, [f64; 2])>,
    actuator: Option<(usize, [f64; 3])>,
    energies: Option<Energies>,
}

impl Cache {
    fn pose(&mut self, model: &Model, b: usize, at: &State) -> Pose {
        match self.pose {
            Some((body, pose)) if body == b => pose,
            _ => self.pose.insert((b, model.pose(b, at))).1,
        }
    }

    fn force(&mut self, model: &Model, j: usize, at: &State, work: &mut Work) -> [f64; 2] {
        match self.force {
            Some((joint, force)) if joint == j => force,
            _ => self.force.insert((j, model.joint_force(j, at, work))).1,
        }
    }

    fn actuator(&mut self, model: &Model, j: usize, at: &State, work: &mut Work) -> [f64; 3] {
        match (self.actuator, &model.joints()[j].actuator) {
            (Some((joint, values)), _) if joint == j => values,
            (_, Some(actuator)) => {
                self.actuator
                    .insert((j, model.actuator(actuator, at, work)))
                    .1
            }
            (_, None) => [0.0; 3],
        }
    }
}

fn joint_value(
    model: &Model,
    j: usize,
    quantity: JointQuantity,
    at: &State,
    work: &mut Work,
    cache: &mut Cache,
) -> f64 {
    let contact = || model.gap(j, at).unwrap_or_default();
    let gap = || contact().0;
    match quantity {
        JointQuantity::Fx => cache.force(model, j, at, work)[0],
        JointQuantity::Fy => cache.force(model, j, at, work)[1],
        JointQuantity::Force => crate::math::plane::norm(cache.force(model, j, at, work)),
        JointQuantity::Ex => gap().e[0],
        JointQuantity::Ey => gap().e[1],
        JointQuantity::Eccentricity => gap().eccentricity,
        JointQuantity::ExRate => gap().e_dot[0],
        JointQuantity::EyRate => gap().e_dot[1],
        JointQuantity::EccentricityRate => contact().1,
        JointQuantity::Penetration => gap().delta,
        JointQuantity::Contact => {
            let (gap, _, closed) = contact();
            f64::from(u8::from(closed && gap.delta > 0.0))
        }
        JointQuantity::Couple => model.joint_couple(j, at),
        JointQuantity::Angle => model.turned(j, at)[0],
        JointQuantity::Speed => model.turned(j, at)[1],
        JointQuantity::Travel => model.travel(j, at)[0],
        JointQuantity::TravelRate => model.travel(j, at)[1],
    }
}

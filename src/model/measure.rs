//! Measured quantities of a model: poses, strains, energies, joint forces, drive torques.

use super::memory::{contact_state, is_closed};
use super::{Actuator, Model, PlacedEccentric, PlacedJoint, Reaction};
use crate::body::{Pose, Strain};
use crate::contact::friction::FrictionLaw;
use crate::contact::geometry::Gap;
use crate::force::Force;
use crate::ledger::Side;
use crate::marker::Marker;
use crate::math::plane::{Vec2, pair};
use crate::system::{State, Work};
use crate::terms::{CoupleTerm, ForceTerm};
use std::f64::consts::PI;
use std::ops::Range;

/// Stored energies \[J\].
#[derive(Debug, Clone, Copy, Default, PartialEq, serde::Serialize)]
pub struct Energies {
    /// 1/2 v^T M v, driven bodies included.
    pub kinetic: f64,
    /// EA/2 int eps^2 dx.
    pub axial: f64,
    /// EI/2 int r''.r'' dx.
    pub bending: f64,
    /// Conservative part of the contact laws.
    pub contact: f64,
    /// Potential of the weight.
    pub gravity: f64,
    /// Potential of springs.
    pub springs: f64,
}

impl Energies {
    /// The sum.
    pub fn total(&self) -> f64 {
        self.kinetic + self.axial + self.bending + self.contact + self.gravity + self.springs
    }

    /// Stored plus dissipated energy minus the work done \[J\], which is constant up to the error of the integration; and the sum
    /// of the magnitudes of the three, to which its rounding is relative. `at` is the state of these energies.
    pub fn balance(&self, model: &Model, at: &State) -> (f64, f64) {
        let (stored, gone) = (self.total(), model.booked(at, Side::Lost));
        let work = model.booked(at, Side::Supplied);
        (stored + gone - work, stored.abs() + gone.abs() + work.abs())
    }
}

impl Model {
    /// l_i: the largest distance \[m\] by which a unit change of each unknown moves a point of its body.
    pub fn lengths(&self) -> Vec<f64> {
        let mut lengths = vec![1.0; self.shape().coordinates];
        for place in self.bodies() {
            for (x, lever) in place.placed.levers(place.contents.iter().copied()) {
                lengths[x] = lever;
            }
        }
        lengths[self.state_indices()].fill(0.0);
        lengths.truncate(self.shape().unknowns);
        lengths
    }

    /// Pose of body `index` of the scene; angles of links in (-pi, pi].
    pub fn pose(&self, index: usize, at: &State) -> Pose {
        let placed = &self.bodies[index].placed;
        placed.kind.pose(&placed.x, [&at.q, &at.v, &at.a])
    }

    /// Position, velocity and acceleration of point `point` of body `body`.
    pub fn point(&self, body: usize, point: usize, at: &State) -> [Vec2; 3] {
        let marker = self.bodies[body].points[point].marker;
        let arm = marker.arm(&at.q);
        [
            marker.position(&at.q, arm),
            marker.velocity(&at.v, arm),
            marker.acceleration(&at.v, &at.a, arm),
        ]
    }

    /// Pose that the drive prescribes for body `index`, if it does.
    pub fn prescribed(&self, index: usize, at: &State) -> Option<Pose> {
        let x = self.bodies[index].prescribed?;
        Some(Pose::of([x, x + 1, x + 2], [&at.q, &at.v, &at.a]))
    }

    /// The largest strains along a flexible link.
    pub fn strain(&self, index: usize, at: &State) -> Option<Strain> {
        let placed = &self.bodies[index].placed;
        placed.kind.strain(&placed.x, &at.q)
    }

    /// Stored energies.
    pub fn energies(&self, at: &State) -> Energies {
        let mut energies = Energies {
            kinetic: 0.5 * self.mass.kinetic.quadratic_form(&at.v),
            ..Energies::default()
        };
        for PlacedEccentric { mass, .. } in &self.eccentric {
            let [kinetic, gravity] = mass.energies(at);
            energies.kinetic += kinetic;
            energies.gravity += gravity;
        }
        for element in &self.elements {
            let q = std::array::from_fn(|i| at.q[element.block.coordinates[i]]);
            let (axial, bending) = element.kernel.energy(&q);
            energies.axial += axial;
            energies.bending += bending;
        }
        for i in 0..self.contacts.len() {
            energies.contact += self.contacts[i].pair.energy(contact_state(at, i));
        }
        for acting in &self.forces {
            energies.springs += acting.term.energy(at);
        }
        for &(i, weight) in &self.weight {
            energies.gravity += weight * at.q[i];
        }
        energies
    }

    /// Force of the bearing side on the journal side of joint `index` \[N\].
    pub fn joint_force(&self, index: usize, at: &State, work: &mut Work) -> Vec2 {
        let joint = &self.joints[index];
        match joint.terms.force {
            ForceTerm::Constraint(i) => {
                let c = &self.constraints[i];
                c.term.force(at, c.multipliers(at))
            }
            ForceTerm::Contact(i) => self.contact_force(i, at),
            ForceTerm::Eliminated => pair(&self.reaction(joint, at, work), 0),
        }
    }

    /// What the bearing side of a joint without multipliers exerts on the journal side: a force \[N\], and a couple \[N m\] where
    /// the joint holds an angle.
    fn reaction(&self, joint: &PlacedJoint, at: &State, work: &mut Work) -> [f64; 3] {
        let of = |reaction: &Reaction| {
            let sum = self.sum(&reaction.shares, at, work);
            sum.map(|x| reaction.sign * x)
        };
        joint.reaction.as_ref().map_or([0.0; 3], of)
    }

    /// Force of the bearing side on the journal side of contact `index` \[N\].
    pub fn contact_force(&self, index: usize, at: &State) -> Vec2 {
        self.contacts[index].pair.reaction(contact_state(at, index))
    }

    /// The slip \[m/s\] of a closed contact with friction, and its law.
    pub fn slip(&self, contact: usize, at: &State) -> Option<(f64, &dyn FrictionLaw)> {
        let closed = is_closed(at, contact);
        let state = closed.then(|| contact_state(at, contact))?;
        self.contacts[contact].pair.slip(state)
    }

    /// Couple of the first side on the second of a joint that holds an angle \[N m\].
    pub fn joint_couple(&self, index: usize, at: &State, work: &mut Work) -> f64 {
        let joint = &self.joints[index];
        match joint.terms.couple {
            None => 0.0,
            Some(CoupleTerm::Constraint(i)) => {
                let c = &self.constraints[i];
                c.term.couple(at, c.multipliers(at))
            }
            Some(CoupleTerm::Eliminated) => self.reaction(joint, at, work)[2],
        }
    }

    /// Speed of a joint that a drive turns \[rad/s\], and the torque of the drive or of what holds the angle \[N m\].
    pub fn joint_turn(&self, index: usize, at: &State, work: &mut Work) -> [f64; 2] {
        match &self.joints[index].actuator {
            Some(actuator) => {
                let [_, speed, _, torque] = self.actuator(actuator, at, work);
                [speed, torque]
            }
            None => [
                self.turned(index, at)[1],
                self.joint_couple(index, at, work),
            ],
        }
    }

    /// Angle (up to full turns), speed and acceleration of the second side of a joint relative to the first, if a motion
    /// prescribes them by a constraint.
    pub fn turned(&self, index: usize, at: &State) -> [f64; 3] {
        let turned = self.joints[index].terms.turned;
        turned.map_or([0.0; 3], |[first, second]| {
            let (a, b) = (first.vector(&at.q), second.vector(&at.q));
            let speed = second.rate(&at.q, &at.v) - first.rate(&at.q, &at.v);
            let [before, after] =
                [first, second].map(|spin| spin.acceleration(&at.q, &at.v, &at.a));
            [a.perp(&b).atan2(a.dot(&b)), speed, after - before]
        })
    }

    /// Indices of the forces of the scene.
    pub fn named_forces(&self) -> Range<usize> {
        0..self.named_forces.len()
    }

    /// A force of the scene and its name.
    pub fn named_force(&self, index: usize) -> (&str, &dyn Force) {
        let (name, place) = &self.named_forces[index];
        (name, &*self.forces[*place].term)
    }

    /// True for a joint with clearance.
    pub fn is_loose(&self, index: usize) -> bool {
        matches!(self.joints[index].terms.force, ForceTerm::Contact(_))
    }

    /// Where the surfaces of a joint with clearance are, the rate of its penetration \[m/s\], and whether the contact is closed.
    pub fn gap(&self, index: usize, at: &State) -> Option<(Gap, f64, bool)> {
        let ForceTerm::Contact(i) = self.joints[index].terms.force else {
            return None;
        };
        let pair = &self.contacts[i].pair;
        let gap = pair.gap(&at.q, &at.v);
        let rate = pair.rate(&gap);
        Some((gap, rate, is_closed(at, i)))
    }

    /// Angle (up to full turns), speed, acceleration and torque of an actuated joint.
    pub fn actuator(&self, actuator: &Actuator, at: &State, work: &mut Work) -> [f64; 4] {
        let [bearing, journal] = actuator.bodies.map(|b| self.pose(b, at));
        let centre = actuator.centre.position(&at.q, actuator.centre.arm(&at.q));
        let mut torque = 0.0;
        for grip in &actuator.outboard {
            let [fx, fy, couple] = self.sum(&grip.shares, at, work);
            let [x, y] = grip.position();
            let arm = Vec2::new(at.q[x], at.q[y]) - centre;
            torque += arm.perp(&Vec2::new(fx, fy)) + couple;
        }
        torque *= actuator.sign;
        [
            journal.position[2] - bearing.position[2],
            journal.velocity[2] - bearing.velocity[2],
            journal.acceleration[2] - bearing.acceleration[2],
            torque,
        ]
    }

    /// Index of the joint that owns contact memory `contact`.
    pub fn contact_joint(&self, contact: usize) -> Option<usize> {
        self.contact_joints[contact]
    }

    /// Largest |Phi| \[m\], the joint or link it belongs to, and the largest |Phi_q v|.
    pub fn worst_constraint(&self, at: &State) -> Option<(f64, f64, String)> {
        let mut worst: Option<(f64, f64, String)> = None;
        let mut see = |value: f64, rate: f64, row: usize| {
            let name = || self.names[self.shape.unknowns + row].clone();
            match &mut worst {
                Some(w) => {
                    if value > w.0 {
                        w.2 = name();
                    }
                    w.0 = w.0.max(value);
                    w.1 = w.1.max(rate);
                }
                None => worst = Some((value, rate, name())),
            }
        };
        for c in &self.constraints {
            let [value, rate] = [c.term.value(at), c.term.velocity(at)].map(Vec2::from);
            see(value.norm(), rate.norm(), c.row);
        }
        worst
    }

    /// The multiplier, as an index of an unknown, of a prescribed angle that is in its second zero, half a turn off, if there is
    /// one. A slope that is compressed through zero length gets there continuously.
    pub fn half_turned(&self, at: &State) -> Option<usize> {
        let turned = self.constraints.iter().find(|c| c.term.half_turn(at));
        turned.map(|c| self.shape.unknowns + c.row)
    }

    /// The unknown angle of a rigid body that differs by more than half a turn between two states, if there is one. Joints
    /// determine angles only up to full turns, so without this check a step could add one.
    pub fn full_turn(&self, from: &State, to: &State) -> Option<usize> {
        let turned = |angle: &&usize| (to.q[**angle] - from.q[**angle]).abs() > PI;
        self.angles.iter().find(turned).copied()
    }

    /// The redundant constraint left out with the largest violation: the index of its multiplier among the unknowns, and the
    /// violation with its unit.
    pub fn widest_left_out(&self, at: &State) -> Option<(usize, f64, &'static str)> {
        let left_out = self.constraints.iter().filter(|c| c.kept.contains(&0.0));
        let open = left_out.flat_map(|c| {
            let value = c.term.value(at);
            let rows = (0..c.rows).filter(|&d| c.kept[d] == 0.0);
            let unit = c.term.unit();
            rows.map(move |d| (self.shape.unknowns + c.row + d, value[d].abs(), unit))
        });
        open.max_by(|a, b| a.1.total_cmp(&b.1))
    }

    /// Position of a marker.
    pub fn position(&self, marker: &Marker, at: &State) -> Vec2 {
        marker.position(&at.q, marker.arm(&at.q))
    }
}

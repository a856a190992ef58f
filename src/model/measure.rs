//! Measured quantities of a model: poses, strains, energies, joint forces, drive torques.

use super::{Actuator, BodyCoordinates, JointKind, Model, PlacedJoint};
use crate::contact;
use crate::contact::geometry::Gap;
use crate::marker::Marker;
use crate::math::plane::{Vec2, add, cross, dot, norm, scale, sub};
use crate::system::{Integral, State, Work};
use std::f64::consts::PI;

/// Position, velocity and acceleration of a body: centre of mass, and angle (of a link: of its chord).
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Pose {
    /// x, y \[m\], theta \[rad\].
    pub position: [f64; 3],
    /// vx, vy, omega.
    pub velocity: [f64; 3],
    /// ax, ay, alpha.
    pub acceleration: [f64; 3],
}

/// Stored energies \[J\].
#[derive(Debug, Clone, Copy, Default, PartialEq)]
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
    pub fn balance(&self, at: &State) -> (f64, f64) {
        let (stored, gone) = (self.total(), at.dissipated());
        let work = at.integrals[Integral::Work as usize];
        (stored + gone - work, stored.abs() + gone.abs() + work.abs())
    }
}

/// Two entries of an array.
#[inline]
fn pair(x: &[f64], i: usize) -> Vec2 {
    [x[i], x[i + 1]]
}

/// Sum over the nodes of a flexible link of the integral of the shape functions over the length, per length.
fn mean(x: &[f64], nodes: &[usize], slopes: &[usize], element_length: f64) -> Vec2 {
    let mut sum = [0.0; 2];
    for (n, s) in nodes.windows(2).zip(slopes.windows(2)) {
        sum = add(sum, scale(0.5, add(pair(x, n[0]), pair(x, n[1]))));
        sum = add(
            sum,
            scale(element_length / 12.0, sub(pair(x, s[0]), pair(x, s[1]))),
        );
    }
    scale(1.0 / (nodes.len() - 1) as f64, sum)
}

/// Pose of a link from its centre and its chord, each as (position, velocity, acceleration).
fn link_pose(centre: [Vec2; 3], chord: [Vec2; 3]) -> Pose {
    let [d, d_dot, d_ddot] = chord;
    let square = dot(d, d);
    let omega = cross(d, d_dot) / square;
    let alpha = (cross(d, d_ddot) - 2.0 * omega * dot(d, d_dot)) / square;
    Pose {
        position: [centre[0][0], centre[0][1], d[1].atan2(d[0])],
        velocity: [centre[1][0], centre[1][1], omega],
        acceleration: [centre[2][0], centre[2][1], alpha],
    }
}

impl Model {
    /// Pose of body `index` of the scene; angles of links in (-pi, pi].
    pub fn pose(&self, index: usize, at: &State) -> Pose {
        let levels = [&at.q, &at.v, &at.a];
        match &self.bodies[index].coordinates {
            BodyCoordinates::Ground { .. } => Pose::default(),
            BodyCoordinates::Rigid { x } => {
                let [position, velocity, acceleration] =
                    levels.map(|l| [l[*x], l[x + 1], l[x + 2]]);
                Pose {
                    position,
                    velocity,
                    acceleration,
                }
            }
            BodyCoordinates::PointMass { x } => {
                let [position, velocity, acceleration] = levels.map(|l| [l[*x], l[x + 1], 0.0]);
                Pose {
                    position,
                    velocity,
                    acceleration,
                }
            }
            BodyCoordinates::RigidLink { ends: [i, j] } => link_pose(
                levels.map(|l| scale(0.5, add(pair(l, *i), pair(l, *j)))),
                levels.map(|l| sub(pair(l, *j), pair(l, *i))),
            ),
            BodyCoordinates::FlexibleLink {
                nodes,
                slopes,
                element_length,
                ..
            } => link_pose(
                levels.map(|l| mean(l, nodes, slopes, *element_length)),
                levels.map(|l| sub(pair(l, nodes[nodes.len() - 1]), pair(l, nodes[0]))),
            ),
        }
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
        self.bodies[index].prescribed.map(|x| {
            let [position, velocity, acceleration] =
                [&at.q, &at.v, &at.a].map(|l| [l[x], l[x + 1], l[x + 2]]);
            Pose {
                position,
                velocity,
                acceleration,
            }
        })
    }

    /// The axial strain of largest magnitude along a flexible link, sampled at eleven points of every element.
    pub fn strain(&self, index: usize, at: &State) -> Option<f64> {
        let BodyCoordinates::FlexibleLink { elements, .. } = &self.bodies[index].coordinates else {
            return None;
        };
        let mut largest: f64 = 0.0;
        for element in &self.elements[elements.clone()] {
            let q = std::array::from_fn(|i| at.q[element.block.coordinates[i]]);
            for k in 0..=10 {
                let strain = element.kernel.strain(&q, f64::from(k) / 10.0);
                if strain.abs() > largest.abs() {
                    largest = strain;
                }
            }
        }
        Some(largest)
    }

    /// Stored energies.
    pub fn energies(&self, at: &State) -> Energies {
        let mut energies = Energies::default();
        for (i, v) in at.v.iter().enumerate() {
            let row = self.mass.row(i);
            energies.kinetic += 0.5 * v * row.map(|(&j, m)| m * at.v[j]).sum::<f64>();
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
        match &self.joints[index].kind {
            JointKind::Constraint(i) => {
                let c = &self.constraints[*i];
                c.term.force(at, c.multipliers(at))
            }
            JointKind::Contact(i) => self.contacts[*i].pair.reaction(contact_state(at, *i)),
            JointKind::Eliminated(reaction) => {
                let force = self.reaction(reaction, at, work);
                [force[0], force[1]]
            }
        }
    }

    /// Couple of the first side on the second of a joint that holds an angle \[N m\].
    pub fn joint_couple(&self, index: usize, at: &State) -> f64 {
        self.joints[index].couple.map_or(0.0, |i| {
            let c = &self.constraints[i];
            c.term.couple(at, c.multipliers(at))
        })
    }

    /// Angle (up to full turns) and speed of the second side of a joint relative to the first, if a motion prescribes them by a
    /// constraint.
    pub fn turned(&self, index: usize, at: &State) -> [f64; 2] {
        self.joints[index]
            .turned
            .map_or([0.0; 2], |[first, second]| {
                let (a, b) = (first.vector(&at.q), second.vector(&at.q));
                let speed = second.rate(&at.q, &at.v) - first.rate(&at.q, &at.v);
                [cross(a, b).atan2(dot(a, b)), speed]
            })
    }

    /// Distance along the line of a prismatic joint \[m\] and its rate \[m/s\].
    pub fn travel(&self, index: usize, at: &State) -> [f64; 2] {
        self.joints[index]
            .slide
            .map_or([0.0; 2], |slide| slide.travel(at))
    }

    /// Names of the forces of the scene and of their measured quantities.
    pub fn named_forces(
        &self,
    ) -> impl Iterator<Item = (&str, &'static [(&'static str, &'static str)])> {
        let forces = self.named_forces.iter();
        forces.map(|(name, i)| (name.as_str(), self.forces[*i].term.quantities()))
    }

    /// Measured quantities of the force `index` of the scene.
    pub fn named_force(&self, index: usize, at: &State) -> [f64; 3] {
        self.forces[self.named_forces[index].1].term.measure(at)
    }

    /// True for a joint with clearance.
    pub fn is_loose(&self, index: usize) -> bool {
        matches!(self.joints[index].kind, JointKind::Contact(_))
    }

    /// Where the surfaces of a joint with clearance are, the rate of its penetration \[m/s\], and whether the contact is closed.
    pub fn gap(&self, index: usize, at: &State) -> Option<(Gap, f64, bool)> {
        let JointKind::Contact(i) = self.joints[index].kind else {
            return None;
        };
        let pair = &self.contacts[i].pair;
        let gap = pair.gap(&at.q, &at.v);
        let rate = pair.rate(&gap);
        Some((gap, rate, at.z[i] > 0.0))
    }

    /// Angle (up to full turns), speed and torque of an actuated joint.
    pub fn actuator(&self, actuator: &Actuator, at: &State, work: &mut Work) -> [f64; 3] {
        let [bearing, journal] = actuator.bodies.map(|b| self.pose(b, at));
        let centre = actuator.centre.position(&at.q, actuator.centre.arm(&at.q));
        let mut torque = 0.0;
        for driven in &actuator.outboard {
            let force = self.reaction(&driven.reaction, at, work);
            torque += cross(sub(pair(&at.q, driven.x), centre), [force[0], force[1]]) + force[2];
        }
        torque *= actuator.sign;
        [
            journal.position[2] - bearing.position[2],
            journal.velocity[2] - bearing.velocity[2],
            torque,
        ]
    }

    /// Index of the joint that owns contact memory `contact`.
    pub fn contact_joint(&self, contact: usize) -> Option<usize> {
        let owns =
            |joint: &PlacedJoint| matches!(joint.kind, JointKind::Contact(i) if i == contact);
        self.joints.iter().position(owns)
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
            see(norm(c.term.value(at)), norm(c.term.velocity(at)), c.row);
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
        self.bodies.iter().find_map(|body| match body.coordinates {
            BodyCoordinates::Rigid { x } => {
                let angle = x + 2;
                let turned = (to.q[angle] - from.q[angle]).abs();
                (angle < self.shape.unknowns && turned > PI).then_some(angle)
            }
            _ => None,
        })
    }

    /// The redundant constraint left out with the largest violation: the index of its multiplier among the unknowns, and the
    /// violation \[m or rad\].
    pub fn widest_left_out(&self, at: &State) -> Option<(usize, f64)> {
        let left_out = self.constraints.iter().filter(|c| c.kept.contains(&0.0));
        let open = left_out.flat_map(|c| {
            let value = c.term.value(at);
            let rows = (0..c.rows).filter(|&d| c.kept[d] == 0.0);
            rows.map(move |d| (self.shape.unknowns + c.row + d, value[d].abs()))
        });
        open.max_by(|a, b| a.1.total_cmp(&b.1))
    }

    /// Position of a marker.
    pub fn position(&self, marker: &Marker, at: &State) -> Vec2 {
        marker.position(&at.q, marker.arm(&at.q))
    }
}

/// Positions, velocities and memory of a contact.
pub(super) fn contact_state(at: &State, contact: usize) -> contact::At<'_> {
    let (q, v, z) = (&at.q, &at.v, at.z[contact]);
    contact::At { q, v, z }
}

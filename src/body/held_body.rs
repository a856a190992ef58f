//! A rigid body that one ideal joint holds on a point or a line of known place, in the coordinate that the joint leaves: the angle
//! about a pin, or the distance along a guide.
//!
//! Its pose is that of the point P at which it is held: x, y of P and theta, of which one is unknown. The force of the joint is the
//! sum of what acts on the other two.

use super::{Body, Content, Frame, HeldSlot, Levels, Link, Point, Pose, Slot};
use crate::eccentric_mass::EccentricMass;
use crate::marker::{Marker, Spin};
use crate::math::plane::{Vec2, full_turns};
use crate::terms::{Inertia, Owner, Terms};
use std::sync::Arc;

/// How an ideal joint holds a body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hold {
    /// Index of the joint.
    pub joint: usize,
    /// The point at which it is held.
    pub point: usize,
    /// The line on which this point moves; none if it stays on the point of the other body.
    pub line: Option<HoldingLine>,
}

/// A fixed line along x or y on which a body slides without turning.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HoldingLine {
    /// The axis of the unknown coordinate: 0 for x, 1 for y.
    pub along: usize,
    /// The other coordinate of the line \[m\].
    pub across: f64,
    /// The angle of the body \[rad\].
    pub angle: f64,
}

/// What the joints of a body tell about the coordinates that fit it.
#[derive(Debug, Clone, Default)]
pub struct Ties {
    /// The ideal joints that hold it on what is known.
    pub holds: Vec<Hold>,
    /// Whether a joint makes a node of it one with that of another free body.
    pub shares: bool,
    /// The number of joints that make a node of it known.
    pub anchored: usize,
}

/// A rigid body in the coordinate that its joint leaves.
#[derive(Debug)]
pub struct HeldBody {
    /// Its points and dimensions.
    body: Arc<dyn Body>,
    /// Mass \[kg\].
    mass: f64,
    /// Moment of inertia about P \[kg m2\].
    inertia: f64,
    /// The centre of mass relative to P at theta = 0 \[m\].
    center: Vec2,
    hold: Hold,
}

impl HeldBody {
    /// A body of this mass \[kg\], with this moment of inertia \[kg m2\] about its centre of mass, which is at `center` in its frame
    /// \[m\].
    pub fn new(body: Arc<dyn Body>, mass: f64, inertia: f64, center: Vec2, hold: Hold) -> Self {
        let center = center - body.points()[hold.point].at;
        HeldBody {
            mass,
            inertia: inertia + mass * center.norm_squared(),
            center,
            hold,
            body,
        }
    }

    /// A point relative to P at theta = 0 \[m\].
    fn about_held(&self, at: Vec2) -> Vec2 {
        at - self.points()[self.hold.point].at
    }

    /// Indices of x, y of P and theta.
    fn held_pose(&self, x: &[usize]) -> [usize; 3] {
        match self.hold.line {
            None => [x[0], x[0] + 1, x[1]],
            Some(_) => [x[0], x[1], x[2]],
        }
    }
}

impl Body for HeldBody {
    fn points(&self) -> &[Point] {
        self.body.points()
    }

    fn slots(&self) -> Vec<Slot> {
        let own = |content| Slot::own(String::new(), content);
        let Some(line) = self.hold.line else {
            let name = &self.points()[self.hold.point].name;
            let mut pin = Slot::own(format!(".{name}"), Content::Position);
            pin.held = Some(HeldSlot::Partner);
            return vec![pin, own(Content::Angle)];
        };
        let mut slots = [Content::X, Content::Y, Content::Angle].map(own);
        slots[1 - line.along].held = Some(HeldSlot::At(line.across));
        slots[2].held = Some(HeldSlot::At(line.angle));
        slots.into()
    }

    fn mass(&self) -> Option<f64> {
        Some(self.mass)
    }

    fn link(&self) -> Option<&Link> {
        self.body.link()
    }

    fn size(&self) -> f64 {
        self.body.size()
    }

    fn radius(&self) -> Option<f64> {
        self.body.radius()
    }

    fn marker(&self, point: usize, x: &[usize]) -> Marker {
        let s = self.about_held(self.points()[point].at);
        let pose = self.held_pose(x);
        Marker::OnBody { pose, s }
    }

    fn spin(&self, _: usize, x: &[usize]) -> Spin {
        let [.., theta] = self.held_pose(x);
        Spin::Angle { theta }
    }

    fn hold(&self) -> Option<Hold> {
        Some(self.hold)
    }

    fn carrier(&self, _: usize) -> usize {
        self.hold.point
    }

    fn lever(&self, _: usize) -> f64 {
        let points = self.points().iter();
        let arms = points.map(|p| self.about_held(p.at).norm());
        arms.fold((self.inertia / self.mass).sqrt(), f64::max)
    }

    fn terms(&self, x: &[usize], _: Owner, terms: &mut Terms) {
        let pose = self.held_pose(x);
        let gravity = terms.gravity;
        let inertia = Inertia::of_pose(pose, self.mass, self.inertia, gravity);
        terms.inertia.push(inertia);
        if self.center != Vec2::zeros() {
            terms.eccentric.push(EccentricMass {
                pose,
                mass: self.mass,
                c: self.center,
                gravity,
            });
        }
    }

    fn pose(&self, x: &[usize], levels: Levels) -> Pose {
        let pose = self.held_pose(x);
        let center = Marker::OnBody {
            pose,
            s: self.center,
        };
        let [q, v, a] = levels;
        let arm = center.arm(q);
        let mut pose = Pose::of(pose, levels);
        pose.position[..2].copy_from_slice(center.position(q, arm).as_slice());
        pose.velocity[..2].copy_from_slice(center.velocity(v, arm).as_slice());
        pose.acceleration[..2].copy_from_slice(center.acceleration(v, a, arm).as_slice());
        if self.link().is_some() {
            let theta = &mut pose.position[2];
            *theta -= full_turns(*theta);
        }
        pose
    }

    fn frame(&self, position: [f64; 3], velocity: [f64; 3]) -> Frame {
        self.body.frame(position, velocity)
    }

    fn place(&self, frame: &Frame) -> Vec<[[f64; 3]; 2]> {
        let ([.., theta], [.., omega]) = (frame.position, frame.velocity);
        let held = Marker::OnBody {
            pose: [0, 1, 2],
            s: self.points()[self.hold.point].at,
        };
        let arm = held.arm(&frame.position);
        let position = held.position(&frame.position, arm);
        let velocity = held.velocity(&frame.velocity, arm);
        match self.hold.line {
            None => vec![
                [position, velocity].map(|x| x.push(0.0).into()),
                [theta, omega].map(|x| [x, 0.0, 0.0]),
            ],
            Some(line) => {
                // joints determine angles up to full turns
                let turns = full_turns(theta - line.angle);
                let levels = [
                    [position.x, velocity.x],
                    [position.y, velocity.y],
                    [theta - turns, omega],
                ];
                levels.map(|level| level.map(|x| [x, 0.0, 0.0])).into()
            }
        }
    }

    /// Velocities are assembled in the ideal mechanism, where no body has these coordinates.
    fn velocity(&self, _: usize, _: &[usize], _: &[f64]) -> Option<Vec<(usize, f64)>> {
        None
    }
}

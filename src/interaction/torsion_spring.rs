//! A torsional spring and damper between two bodies.

use super::spring_damper::rates;
use super::{Ends, ForceKind, ForceModel};
use crate::body::PointRef;
use crate::document::Key;
use crate::effect::Effect;
use crate::force::{Events, Force, LocalMatrix, WIDTH};
use crate::ledger::{self, Entry, Powers};
use crate::marker::{Spin, SpinDerivatives};
use crate::math::plane::full_turns;
use crate::system::{State, Weights};
use std::sync::Arc;

pub(super) static KIND: ForceKind = ForceKind {
    name: "torsion_spring",
    keys: &[
        Key::name_in(
            "joint",
            "joints",
            "the name of a revolute joint, ideal or with clearance",
        ),
        Key::non_negative("stiffness", "N m/rad", "the stiffness k, 0 for a damper"),
        Key::non_negative("damping", "N m s/rad", "the damping c, 0 for a spring"),
        Key::number("rest_angle", "rad", "the angle phi_0 without torque"),
    ],
    read: |table, names| {
        let name = table.field("joint")?;
        let joint = names.revolute(&name, "")?;
        for side in names.joints[joint].points() {
            names.check_turns(&name, side)?;
        }
        let (stiffness, damping) = rates(table)?;
        Ok(Arc::new(TorsionSpringModel {
            joint,
            stiffness,
            damping,
            rest_angle: table.number("rest_angle")?,
        }))
    },
};

/// A torsional spring and damper as a scene describes them.
#[derive(Debug, Clone, Copy)]
pub struct TorsionSpringModel {
    /// Index of the joint.
    pub joint: usize,
    /// Stiffness \[N m/rad\].
    pub stiffness: f64,
    /// Damping \[N m s/rad\].
    pub damping: f64,
    /// Rest angle of the journal's body relative to the bearing's \[rad\].
    pub rest_angle: f64,
}

impl ForceModel for TorsionSpringModel {
    fn points(&self) -> Vec<PointRef> {
        vec![]
    }

    fn turning_joint(&self) -> Option<usize> {
        Some(self.joint)
    }

    fn slots(&self) -> usize {
        1
    }

    fn term(&self, ends: &Ends) -> (Box<dyn Force>, [usize; 2]) {
        let points = ends.joints[self.joint].points();
        let [first, second] = points.map(|p| ends.spin(p));
        let term = TorsionSpring {
            first,
            second,
            stiffness: self.stiffness,
            damping: self.damping,
            rest_angle: self.rest_angle,
            memory: ends.memory,
        };
        (Box::new(term), points.map(|p| p.body))
    }
}

/// Torque M = k (phi - phi_0) + c phi_dot that turns the second body back to the first; phi is the angle from the first
/// direction to the second, full turns counted from the start: as the start says them, or else within half a turn of phi_0.
#[derive(Debug, Clone, Copy)]
pub struct TorsionSpring {
    /// The first direction.
    pub first: Spin,
    /// The second.
    pub second: Spin,
    /// k \[N m/rad\].
    pub stiffness: f64,
    /// c \[N m s/rad\].
    pub damping: f64,
    /// phi_0 \[rad\].
    pub rest_angle: f64,
    /// Index of the angle of the last accepted step in the memory.
    pub memory: usize,
}

impl TorsionSpring {
    /// phi \[rad\]: the one nearest to the memory.
    fn angle(&self, at: &State) -> f64 {
        let (a, b) = (self.first.vector(&at.q), self.second.vector(&at.q));
        let last = at.memory[self.memory];
        let change = a.perp(&b).atan2(a.dot(&b)) - last;
        last + change - full_turns(change)
    }

    fn rate(&self, at: &State) -> f64 {
        self.second.rate(&at.q, &at.v) - self.first.rate(&at.q, &at.v)
    }

    /// M \[N m\], phi and its rate.
    fn state(&self, at: &State) -> [f64; 3] {
        let (angle, rate) = (self.angle(at), self.rate(at));
        let torque = self.stiffness * (angle - self.rest_angle) + self.damping * rate;
        [torque, angle, rate]
    }

    /// Each side: sign, derivatives of its spin, its first local index and its number of coordinates.
    fn ends(&self, at: &State) -> [(f64, SpinDerivatives, usize, usize); 2] {
        let derivatives = |s: &Spin| s.derivatives(&at.q, &at.v);
        let (m, n) = (self.first.width(), self.second.width());
        [
            (-1.0, derivatives(&self.first), 0, m),
            (1.0, derivatives(&self.second), m, n),
        ]
    }
}

impl Force for TorsionSpring {
    fn effect(&self) -> Effect {
        "torsion_spring"
    }

    fn sides(&self) -> [Vec<usize>; 2] {
        [self.first.coordinates(), self.second.coordinates()]
    }

    fn force(&self, at: &State, f: &mut [f64; WIDTH]) {
        let [torque, ..] = self.state(at);
        for (sign, d, first, count) in self.ends(at) {
            for i in 0..count {
                f[first + i] += torque * sign * d.b[i];
            }
        }
    }

    fn force_and_tangent(&self, at: &State, w: Weights, f: &mut [f64; WIDTH], k: &mut LocalMatrix) {
        let [torque, ..] = self.state(at);
        let sides = self.ends(at);
        let (mut lever, mut by_stage) = ([0.0; WIDTH], [0.0; WIDTH]);
        for (sign, d, first, count) in &sides {
            for i in 0..*count {
                let b = sign * d.b[i];
                lever[first + i] = b;
                by_stage[first + i] = (w.q * self.stiffness + w.v * self.damping) * b
                    + w.q * self.damping * sign * d.rate_q[i];
                for j in 0..*count {
                    k[first + i][first + j] += w.q * torque * sign * d.b_q[i][j];
                }
            }
        }
        let columns = sides[1].2 + sides[1].3;
        for r in 0..columns {
            f[r] += torque * lever[r];
            for c in 0..columns {
                k[r][c] += lever[r] * by_stage[c];
            }
        }
    }

    fn stores_energy(&self) -> bool {
        true
    }

    fn energy(&self, at: &State) -> f64 {
        let turn = self.angle(at) - self.rest_angle;
        0.5 * self.stiffness * turn * turn
    }

    fn entries(&self) -> Vec<&'static Entry> {
        vec![&ledger::DAMPING]
    }

    fn powers(&self, at: &State, powers: &mut Powers) {
        let rate = self.rate(at);
        powers.add(0, self.damping * rate * rate);
    }

    fn begin(&self, at: &mut State) {
        at.memory[self.memory] = self.rest_angle;
    }

    fn wind(&self, at: &mut State, angle: f64) {
        at.memory[self.memory] = angle;
    }

    fn events(&self) -> Option<&dyn Events> {
        Some(self)
    }

    fn quantities(&self) -> &'static [(&'static str, &'static str)] {
        &[("torque", "N m"), ("angle", "rad"), ("speed", "rad/s")]
    }

    /// The torque on the second body, the angle and its rate.
    fn measure(&self, at: &State) -> [f64; 3] {
        let [torque, angle, rate] = self.state(at);
        [-torque, angle, rate]
    }
}

impl Events for TorsionSpring {
    fn commit(&self, at: &mut State, _: &[[f64; 2]], _: f64) -> bool {
        at.memory[self.memory] = self.angle(at);
        false
    }
}

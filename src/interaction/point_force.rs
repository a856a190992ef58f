//! An applied force at a point, fixed in direction or turning with the body.

use super::{Ends, ForceKind, ForceModel};
use crate::body::PointRef;
use crate::document::Key;
use crate::effect::Effect;
use crate::force::{Force, LocalMatrix, WIDTH};
use crate::ledger::{self, Entry, Powers};
use crate::marker::{Marker, Spin};
use crate::math::plane::{Vec2, quarter_turn};
use crate::motion::{Function, Knot, Use};
use crate::system::{State, Weights};
use std::sync::Arc;

pub(super) static KIND: ForceKind = ForceKind {
    name: "force",
    keys: &[
        Key::point("point", "where it acts"),
        Key::function("x", "N", "the first component"),
        Key::function("y", "N", "the second component"),
        Key::word(
            "frame",
            &["ground", "body"],
            "the frame of its components: a dead load, or a follower, which turns with the body",
        ),
    ],
    read: |table, names| {
        let field = table.field("point")?;
        let point = names.point(&field)?;
        let component = |key| names.functions.read(&table.field(key)?, Use::Load);
        let components = [component("x")?, component("y")?];
        let follower = table.word("frame")? == 1;
        if follower {
            names.check_turns(&field, point)?;
        }
        Ok(Arc::new(PointForceModel {
            point,
            components,
            follower,
        }))
    },
};

/// An applied force as a scene describes it.
#[derive(Debug, Clone)]
pub struct PointForceModel {
    /// Where it acts.
    pub point: PointRef,
    /// Components \[N\].
    pub components: [Function; 2],
    /// True where the direction turns with the body.
    pub follower: bool,
}

impl ForceModel for PointForceModel {
    fn points(&self) -> Vec<PointRef> {
        vec![self.point]
    }

    fn term(&self, ends: &Ends) -> (Box<dyn Force>, [usize; 2]) {
        let term = PointForce {
            marker: ends.marker(self.point),
            spin: match self.follower {
                true => ends.spin(self.point),
                false => Spin::Fixed,
            },
            components: self.components.each_ref().map(|f| ends.load(f)),
        };
        (Box::new(term), [self.point.body; 2])
    }
}

/// F = (F_x(t), F_y(t)) in the frame of the ground (dead) or of the material (follower): there F = F_x d/|d| + F_y
/// J d/|d| with the direction d of the body and the quarter turn J.
#[derive(Debug)]
pub struct PointForce {
    /// Where it acts.
    pub marker: Marker,
    /// What its direction turns with: the ground, or the body.
    pub spin: Spin,
    /// F_x and F_y \[N\].
    pub components: [Function; 2],
}

impl PointForce {
    /// F \[N\].
    fn value(&self, at: &State) -> Vec2 {
        let [along, across] = self.components.each_ref().map(|f| f.at(at.t)[0]);
        let d = self.spin.vector(&at.q);
        let unit = 1.0 / d.norm() * d;
        along * unit + across * quarter_turn(unit)
    }
}

impl Force for PointForce {
    fn effect(&self) -> Effect {
        "applied_force"
    }

    fn sides(&self) -> [Vec<usize>; 2] {
        let coordinates = [self.marker.coordinates(), self.spin.coordinates()];
        [vec![], coordinates.concat()]
    }

    fn force(&self, at: &State, f: &mut [f64; WIDTH]) {
        let value = self.value(at);
        for (f, column) in f
            .iter_mut()
            .zip(self.marker.columns(self.marker.arm(&at.q)).iter())
        {
            *f -= value.dot(column);
        }
    }

    fn force_and_tangent(&self, at: &State, w: Weights, f: &mut [f64; WIDTH], k: &mut LocalMatrix) {
        self.force(at, f);
        let value = self.value(at);
        if let Marker::OnBody { .. } = self.marker {
            k[2][2] += w.q * value.dot(&self.marker.arm(&at.q));
        }
        // F turns with the body: dF = J F d(angle)
        let spin = self.spin.derivatives(&at.q, &at.v);
        let first = self.marker.width();
        for (r, column) in self
            .marker
            .columns(self.marker.arm(&at.q))
            .iter()
            .enumerate()
        {
            for c in 0..self.spin.width() {
                k[r][first + c] -= w.q * quarter_turn(value).dot(column) * spin.b[c];
            }
        }
    }

    fn entries(&self) -> Vec<&'static Entry> {
        vec![&ledger::WORK]
    }

    fn powers(&self, at: &State, powers: &mut Powers) {
        let velocity = self.marker.velocity(&at.v, self.marker.arm(&at.q));
        powers.add(0, self.value(at).dot(&velocity));
    }

    fn knots(&self, until: f64) -> Vec<Knot> {
        self.components
            .iter()
            .flat_map(|f| f.knots(until))
            .collect()
    }

    fn quantities(&self) -> &'static [(&'static str, &'static str)] {
        &[("fx", "N"), ("fy", "N")]
    }

    fn measure(&self, at: &State) -> [f64; 3] {
        let value = self.value(at);
        [value.x, value.y, 0.0]
    }
}

//! An applied torque on one body, or between two.

use super::{Ends, ForceKind, ForceModel};
use crate::body::{Ground, PointRef};
use crate::document::Key;
use crate::effect::Effect;
use crate::force::{Force, LocalMatrix, WIDTH};
use crate::ledger::{self, Entry, Powers};
use crate::marker::Spin;
use crate::motion::{Function, Knot, Use};
use crate::system::{State, Weights};
use std::sync::Arc;

pub(super) static KIND: ForceKind = ForceKind {
    name: "torque",
    keys: &[
        Key::point(
            "point",
            "a point of the body it turns; on a flexible link it acts at that point",
        ),
        Key::point(
            "reaction",
            "a point of the body that takes the opposite torque",
        )
        .or("the ground"),
        Key::function("value", "N m", "the torque"),
    ],
    read: |table, names| {
        let field = table.field("point")?;
        let point = names.turning_point(&field)?;
        let reaction = table.optional("reaction");
        let reaction = reaction
            .map(|field| names.turning_point(&field))
            .transpose()?;
        let fixed = |p: PointRef| names.bodies[p.body].get::<Ground>().is_some();
        if fixed(point) && reaction.is_none_or(fixed) {
            let message = format!("`{}` acts on the ground, which does not move", table.path());
            return Err(field.fault(message, "does nothing"));
        }
        Ok(Arc::new(TorqueModel {
            point,
            reaction,
            value: names.functions.read(&table.field("value")?, Use::Load)?,
        }))
    },
};

/// An applied torque as a scene describes it.
#[derive(Debug, Clone)]
pub struct TorqueModel {
    /// The point at whose material it acts.
    pub point: PointRef,
    /// The point whose body takes the reaction; the ground when absent.
    pub reaction: Option<PointRef>,
    /// Torque \[N m\].
    pub value: Function,
}

impl ForceModel for TorqueModel {
    fn points(&self) -> Vec<PointRef> {
        std::iter::once(self.point).chain(self.reaction).collect()
    }

    fn term(&self, ends: &Ends) -> (Box<dyn Force>, [usize; 2]) {
        let term = Torque {
            first: self.reaction.map_or(Spin::Fixed, |p| ends.spin(p)),
            second: ends.spin(self.point),
            value: ends.load(&self.value),
        };
        let first = self.reaction.map_or(self.point.body, |p| p.body);
        (Box::new(term), [first, self.point.body])
    }
}

/// M(t) on the second body, -M(t) on the first (the ground, where there is none): conjugate to the relative angle. On a
/// slope r' it is the force M (-r'_y, r'_x)/|r'|^2.
#[derive(Debug)]
pub struct Torque {
    /// The body that takes the reaction.
    pub first: Spin,
    /// The body it turns.
    pub second: Spin,
    /// M \[N m\].
    pub value: Function,
}

impl Torque {
    fn ends(&self) -> [(f64, Spin, usize); 2] {
        [
            (-1.0, self.first, 0),
            (1.0, self.second, self.first.width()),
        ]
    }
}

impl Force for Torque {
    fn effect(&self) -> Effect {
        "applied_torque"
    }

    fn sides(&self) -> [Vec<usize>; 2] {
        [self.first.coordinates(), self.second.coordinates()]
    }

    fn force(&self, at: &State, f: &mut [f64; WIDTH]) {
        let torque = self.value.at(at.t)[0];
        for (sign, spin, first) in self.ends() {
            let d = spin.derivatives(&at.q, &at.v);
            for i in 0..spin.width() {
                f[first + i] -= sign * torque * d.b[i];
            }
        }
    }

    fn force_and_tangent(&self, at: &State, w: Weights, f: &mut [f64; WIDTH], k: &mut LocalMatrix) {
        self.force(at, f);
        let torque = self.value.at(at.t)[0];
        for (sign, spin, first) in self.ends() {
            let d = spin.derivatives(&at.q, &at.v);
            for i in 0..spin.width() {
                for j in 0..spin.width() {
                    k[first + i][first + j] -= w.q * sign * torque * d.b_q[i][j];
                }
            }
        }
    }

    fn entries(&self) -> Vec<&'static Entry> {
        vec![&ledger::WORK]
    }

    fn powers(&self, at: &State, powers: &mut Powers) {
        let rates = [self.first, self.second].map(|s| s.rate(&at.q, &at.v));
        powers.add(0, self.value.at(at.t)[0] * (rates[1] - rates[0]));
    }

    fn knots(&self, until: f64) -> Vec<Knot> {
        self.value.knots(until)
    }

    fn quantities(&self) -> &'static [(&'static str, &'static str)] {
        &[("torque", "N m")]
    }

    fn measure(&self, at: &State) -> [f64; 3] {
        [self.value.at(at.t)[0], 0.0, 0.0]
    }
}

//! `type = "loose_guide"`: a pin between two straight, parallel walls, with play on both sides.
//!
//! With e from the guide's point to the pin, u the unit direction of the guide, which turns with its body, and m = u turned by
//! 90 degrees: s = m . e is the distance of the pin from the centre line, p = u . e its travel, delta = |s| - c the
//! penetration. The normal is sign(s) m, the slip dp/dt. Forces act on both bodies at the pin, so that they do the work
//! N d(delta) and T dp.

use super::prismatic::{DIRECTION, Prismatic, direction};
use super::{Contact, JointEnds, JointKind, JointModel};
use crate::constraint::Slide;
use crate::contact::geometry::{Gap, Geometry, Touch};
use crate::contact::{ContactState, Slip, local_indices};
use crate::document::{Key, Takes};
use crate::force::{LocalMatrix, WIDTH};
use crate::marker::{Separation, Spin};
use crate::math::plane::{Rotation, Vec2, quarter_turn};
use crate::terms::{ForceTerm, JointTerms, Terms};
use std::sync::Arc;

pub(super) static KIND: JointKind = JointKind {
    name: "loose_guide",
    keys: &[
        Key::point(
            "guide",
            "the point on the centre line, of the body that carries the guide",
        ),
        Key::point("slider", "the pin, the point that slides"),
        DIRECTION,
        Key::new(
            "contact",
            Takes::Name("contacts"),
            "the name of a contact, whose clearance is the play on either side",
        ),
    ],
    read: |table, contacts| {
        let name = table.field("contact")?;
        let (_, contact) = name.lookup("contact", contacts)?;
        if contact
            .friction
            .as_ref()
            .is_some_and(|friction| friction.slip == Slip::Paper)
        {
            let message = format!(
                "the friction of {} has slip \"paper\", which only a bearing can have",
                name.written()
            );
            return Err(name.fault(message, "its slip is that of eqs. 22-23, for a bearing"));
        }
        Ok(Arc::new(LooseGuide {
            direction: direction(table)?,
            contact: contact.clone(),
        }))
    },
};

/// A prismatic joint with free rotation and play.
#[derive(Debug, Clone)]
pub struct LooseGuide {
    /// Direction of the centre line in the frame of the first body \[rad\].
    pub direction: f64,
    /// Play and laws.
    pub contact: Contact,
}

impl JointModel for LooseGuide {
    fn line(&self) -> Option<f64> {
        Some(self.direction)
    }

    fn contact(&self) -> Option<&Contact> {
        Some(&self.contact)
    }

    fn with_contact(&self, contact: Option<Contact>) -> Option<Arc<dyn JointModel>> {
        let direction = self.direction;
        Some(match contact {
            Some(contact) => Arc::new(LooseGuide { direction, contact }),
            None => Arc::new(Prismatic {
                direction,
                locked: None,
            }),
        })
    }

    fn terms(&self, ends: &JointEnds, terms: &mut Terms) -> JointTerms {
        let slide = ends.slide(self.direction);
        let Slide {
            ends: pin, spin, ..
        } = slide;
        let walls = Walls::new(pin, spin, self.direction, self.contact.clearance);
        let pair = self.contact.pair(walls, ends.spins, ends.states);
        terms.contacts.push(pair);
        JointTerms {
            slide: Some(slide),
            ..JointTerms::of(ForceTerm::Contact(terms.contacts.len() - 1))
        }
    }
}

/// A pin between two walls.
#[derive(Debug)]
pub struct Walls {
    /// From the guide's point to the pin.
    ends: Separation,
    spin: Spin,
    turn: Rotation,
    clearance: f64,
    coordinates: Vec<usize>,
    /// Local indices of the coordinates of both ends, and of the spin.
    places: [Vec<usize>; 2],
}

/// Everything about a pin in a state, in local coordinates.
struct Pin {
    u: Vec2,
    m: Vec2,
    s: f64,
    p: f64,
    /// Rates of s and p.
    rates: [f64; 2],
    omega: f64,
    /// Of the ends of e.
    arms: [Vec2; 2],
    /// de/dq.
    e_q: [Vec2; WIDTH],
    /// d(omega)/dv.
    b: [f64; WIDTH],
}

impl Walls {
    /// Walls along a direction \[rad\] from that of the spin, through the point where `ends` begins and at the distance
    /// `clearance` \[m\] on either side of the one where it ends.
    pub fn new(ends: Separation, spin: Spin, direction: f64, clearance: f64) -> Walls {
        let mut coordinates = Vec::new();
        let places = [ends.sides().concat(), spin.coordinates()];
        let places = places.map(|own| local_indices(own, &mut coordinates));
        Walls {
            ends,
            spin,
            turn: Rotation::new(direction),
            clearance,
            coordinates,
            places,
        }
    }

    fn pin(&self, q: &[f64], v: &[f64]) -> Pin {
        let arms = self.ends.arms(q);
        let (e, e_dot) = (self.ends.vector(q, arms), self.ends.rate(v, arms));
        let along = self.turn * self.spin.vector(q);
        let u = 1.0 / along.norm() * along;
        let m = quarter_turn(u);
        let (s, p) = (m.dot(&e), u.dot(&e));
        let omega = self.spin.rate(q, v);
        let mut pin = Pin {
            u,
            m,
            s,
            p,
            rates: [m.dot(&e_dot) - omega * p, u.dot(&e_dot) + omega * s],
            omega,
            arms,
            e_q: [Vec2::zeros(); WIDTH],
            b: [0.0; WIDTH],
        };
        for (&c, column) in self.places[0].iter().zip(self.ends.columns(arms).iter()) {
            pin.e_q[c] += column;
        }
        for (&c, b) in self.places[1].iter().zip(self.spin.derivatives(q, v).b) {
            pin.b[c] = b;
        }
        pin
    }

    /// d2s/dq2 and d2p/dq2. With phi the angle of the spin, du = m dphi and dm = -u dphi.
    fn second(&self, at: ContactState, pin: &Pin) -> [LocalMatrix; 2] {
        let Pin {
            u, m, s, p, e_q, b, ..
        } = pin;
        let mut second = [[[0.0; WIDTH]; WIDTH]; 2];
        let count = self.coordinates.len();
        for i in 0..count {
            for j in 0..count {
                let mixed = |x: &Vec2| x.dot(&e_q[i]) * b[j] + x.dot(&e_q[j]) * b[i];
                second[0][i][j] = -mixed(u) - s * b[i] * b[j];
                second[1][i][j] = mixed(m) - p * b[i] * b[j];
            }
        }
        let turning = self.spin.derivatives(at.q, at.v).b_q;
        for (&i, row) in self.places[1].iter().zip(turning) {
            for (&j, bend) in self.places[1].iter().zip(row) {
                second[0][i][j] -= p * bend;
                second[1][i][j] += s * bend;
            }
        }
        for (theta, _, bend) in self.ends.bends(pin.arms) {
            let theta = self.places[0][theta];
            second[0][theta][theta] += m.dot(&bend);
            second[1][theta][theta] += u.dot(&bend);
        }
        second
    }
}

impl Pin {
    /// ds/dq and dp/dq.
    fn first(&self) -> [[f64; WIDTH]; 2] {
        let s_q = std::array::from_fn(|c| self.m.dot(&self.e_q[c]) - self.p * self.b[c]);
        let p_q = std::array::from_fn(|c| self.u.dot(&self.e_q[c]) + self.s * self.b[c]);
        [s_q, p_q]
    }
}

impl Geometry for Walls {
    fn coordinates(&self) -> Vec<usize> {
        self.coordinates.clone()
    }

    fn columns(&self) -> usize {
        self.coordinates.len()
    }

    fn gap(&self, q: &[f64], v: &[f64]) -> Gap {
        let Pin {
            u,
            m,
            s,
            rates,
            omega,
            ..
        } = self.pin(q, v);
        Gap {
            e: s * m,
            e_dot: rates[0] * m - s * omega * u,
            eccentricity: s.abs(),
            delta: s.abs() - self.clearance,
            ..Gap::default()
        }
    }

    fn push(&self, at: ContactState, _: &Gap, force: f64, f: &mut [f64; WIDTH]) {
        let pin = self.pin(at.q, at.v);
        let [s_q, _] = pin.first();
        for (f, s_q) in f.iter_mut().zip(s_q) {
            *f += force * pin.s.signum() * s_q;
        }
    }

    fn touch(&self, at: ContactState, _: &Gap) -> Touch {
        let pin = self.pin(at.q, at.v);
        let side = pin.s.signum();
        let [s_q, p_q] = pin.first();
        let [s_qq, p_qq] = self.second(at, &pin);
        let rate = |second: &LocalMatrix, sign: f64| -> [f64; WIDTH] {
            std::array::from_fn(|i| {
                let row = second[i].iter().zip(&self.coordinates);
                sign * row.map(|(x, &j)| x * at.v[j]).sum::<f64>()
            })
        };
        Touch {
            n: side * pin.m,
            t: pin.u,
            slip: pin.rates[1],
            normal: s_q.map(|x| side * x),
            tangent: p_q,
            rate_q: rate(&s_qq, side),
            slip_q: rate(&p_qq, 1.0),
            ..Touch::default()
        }
    }

    fn curve(
        &self,
        at: ContactState,
        _: &Gap,
        _: &Touch,
        normal: f64,
        tangential: f64,
        k: &mut LocalMatrix,
    ) {
        let pin = self.pin(at.q, at.v);
        let side = pin.s.signum();
        let [s_qq, p_qq] = self.second(at, &pin);
        for i in 0..WIDTH {
            for j in 0..WIDTH {
                k[i][j] += side * normal * s_qq[i][j] + tangential * p_qq[i][j];
            }
        }
    }
}

//! A joint with a contact geometry of its own: a pin between two walls that keep their direction in space.

use looselink::contact::ContactState;
use looselink::contact::geometry::{Gap, Geometry, Touch};
use looselink::document::Key;
use looselink::force::{LocalMatrix, WIDTH};
use looselink::interaction::{Contact, JointEnds, JointKind, JointModel, Prismatic};
use looselink::marker::Separation;
use looselink::math::plane::{Vec2, quarter_turn, unit};
use looselink::terms::{ForceTerm, JointTerms, Terms};
use std::sync::Arc;

/// The joint as a scene names it: the first two keys are its points.
pub static KIND: JointKind = JointKind {
    name: "slot",
    keys: &[
        Key::point(
            "middle",
            "a point on the middle line, of a body that does not turn",
        ),
        Key::point("pin", "the pin"),
        Key::vector("direction", "", "[dx, dy]", "the direction of the walls"),
        Key::name_in("contact", "contacts", "the name of a contact"),
    ],
    read: |table, contacts| {
        let [dx, dy] = table.vector("direction")?;
        let (_, contact) = table.field("contact")?.lookup("contact", contacts)?;
        Ok(Arc::new(StraightSlot {
            direction: dy.atan2(dx),
            contact: contact.clone(),
        }))
    },
};

#[derive(Debug)]
struct StraightSlot {
    direction: f64,
    contact: Contact,
}

impl JointModel for StraightSlot {
    fn line(&self) -> Option<f64> {
        Some(self.direction)
    }

    fn contact(&self) -> Option<&Contact> {
        Some(&self.contact)
    }

    /// Without play it is a prismatic joint, in which the mechanism is assembled.
    fn with_contact(&self, contact: Option<Contact>) -> Option<Arc<dyn JointModel>> {
        let direction = self.direction;
        Some(match contact {
            Some(contact) => Arc::new(StraightSlot { direction, contact }),
            None => Arc::new(Prismatic {
                direction,
                locked: None,
            }),
        })
    }

    fn terms(&self, ends: &JointEnds, terms: &mut Terms) -> JointTerms {
        let slide = ends.slide(self.direction);
        let walls = SlotWalls {
            ends: slide.ends,
            u: unit(self.direction),
            play: self.contact.clearance,
        };
        terms
            .contacts
            .push(self.contact.pair(walls, ends.spins, ends.states));
        JointTerms {
            slide: Some(slide),
            ..JointTerms::of(ForceTerm::Contact(terms.contacts.len() - 1))
        }
    }
}

/// The distance s = m . e of the pin from the middle line is a function of e alone, so every derivative is that of e.
#[derive(Debug)]
struct SlotWalls {
    /// From the middle line to the pin.
    ends: Separation,
    u: Vec2,
    play: f64,
}

impl SlotWalls {
    /// x . de/dq for every local coordinate.
    fn along(&self, x: Vec2, gap: &Gap) -> [f64; WIDTH] {
        let mut values = [0.0; WIDTH];
        for (value, column) in values.iter_mut().zip(self.ends.columns(gap.arms).iter()) {
            *value = x.dot(column);
        }
        values
    }
}

impl Geometry for SlotWalls {
    fn coordinates(&self) -> Vec<usize> {
        self.ends.sides().concat()
    }

    fn columns(&self) -> usize {
        self.ends.width()
    }

    fn gap(&self, q: &[f64], v: &[f64]) -> Gap {
        let m = quarter_turn(self.u);
        let arms = self.ends.arms(q);
        let s = m.dot(&self.ends.vector(q, arms));
        Gap {
            e: s * m,
            e_dot: m.dot(&self.ends.rate(v, arms)) * m,
            eccentricity: s.abs(),
            delta: s.abs() - self.play,
            arms,
        }
    }

    fn push(&self, _: ContactState, gap: &Gap, force: f64, f: &mut [f64; WIDTH]) {
        let along = self.along(self.along_normal(gap, force), gap);
        f.iter_mut().zip(along).for_each(|(f, push)| *f += push);
    }

    fn touch(&self, at: ContactState, gap: &Gap) -> Touch {
        let n = self.along_normal(gap, 1.0);
        let t = quarter_turn(n);
        let mut touch = Touch {
            n,
            t,
            slip: t.dot(&self.ends.rate(at.v, gap.arms)),
            normal: self.along(n, gap),
            tangent: self.along(t, gap),
            ..Touch::default()
        };
        for (local, theta, bend) in self.ends.bends(gap.arms) {
            touch.rate_q[local] = at.v[theta] * n.dot(&bend);
            touch.slip_q[local] = at.v[theta] * t.dot(&bend);
        }
        touch
    }

    fn curve(
        &self,
        _: ContactState,
        gap: &Gap,
        touch: &Touch,
        normal: f64,
        tangential: f64,
        k: &mut LocalMatrix,
    ) {
        for (local, _, bend) in self.ends.bends(gap.arms) {
            k[local][local] += normal * touch.n.dot(&bend) + tangential * touch.t.dot(&bend);
        }
    }
}

/// A block on a spring that drags a pin along a slot.
pub const SCENE: &str = r#"
format = 1
title = "a pin in a slot"
simulation = { duration = 0.5, gravity = [0.0, -9.81] }
integrator = { method = "bathe", step = 1e-5, newton_tolerance = 1e-10, onset_tolerance = 1e-12 }
output = { interval = 1e-3, channels = ["block.*", "slot.*", "energy.*"] }
contacts.steel = { law = "hunt_crossley", clearance = 1e-4, stiffness = 1e9, exponent = 1.5, restitution = 0.6, impact_velocity_floor = 1e-6, friction = { law = "ambrosio", coefficient = 0.1, v0 = 1e-4, v1 = 1e-3 } }
bodies.ground = { type = "ground", points.wall = [0.0, 0.0] }
bodies.block = { type = "rigid_body", mass = 0.3, inertia = 2e-4, points.pin = [0.0, 0.02] }
joints.slot = { type = "slot", middle = "ground.wall", pin = "block.pin", direction = [1.0, 0.0], contact = "steel" }
forces.spring = { type = "spring_damper", from = "ground.wall", to = "block.pin", stiffness = 200.0, damping = 0.0, rest_length = 0.1 }
initial.bodies.block = { x = 0.15, y = -0.02, theta = 0.0, vx = 0.0, vy = 0.0, omega = 1.0 }
"#;

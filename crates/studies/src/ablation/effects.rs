//! What a scene may have beyond the rigid ideal mechanism, and the scene without it.
//!
//! Taking an effect out changes the data of the scene and sets no flag: what is left is what a user would have written who
//! never heard of the effect, and compiles to the same model.

use looselink::body::FlexibleLink;
use looselink::contact::normal::damped_power::HERTZ;
use looselink::scene::{Contact, MotionKind, PointRef, Scene, SceneError, Sketched, Span};
use serde::{Serialize, Serializer};
use std::sync::Arc;

/// An effect that can be added to the rigid ideal mechanism and removed from the full scene.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SceneEffect {
    /// Links that bend and stretch; without it they are rigid.
    Flexibility,
    /// More than one element in a flexible link; without it there is one.
    Elements,
    /// Structural damping of flexible links.
    StructuralDamping,
    /// Play in joints; without it they are ideal.
    Clearance,
    /// Damping of the normal contact law; without it the law is that of Hertz, of the same stiffness and exponent.
    ContactDamping,
    /// Friction in loose joints.
    Friction,
    /// Weight.
    Gravity,
}

impl SceneEffect {
    /// All effects; each stands behind the one it needs.
    pub const ALL: [SceneEffect; 7] = [
        SceneEffect::Flexibility,
        SceneEffect::Elements,
        SceneEffect::StructuralDamping,
        SceneEffect::Clearance,
        SceneEffect::ContactDamping,
        SceneEffect::Friction,
        SceneEffect::Gravity,
    ];

    /// Its name in reports.
    pub fn name(self) -> &'static str {
        match self {
            SceneEffect::Flexibility => "flexibility",
            SceneEffect::Elements => "more elements",
            SceneEffect::StructuralDamping => "structural damping",
            SceneEffect::Clearance => "clearance",
            SceneEffect::ContactDamping => "contact damping",
            SceneEffect::Friction => "friction",
            SceneEffect::Gravity => "gravity",
        }
    }

    /// The effect without which this one has nothing to act on.
    pub fn needs(self) -> Option<SceneEffect> {
        match self {
            SceneEffect::Elements | SceneEffect::StructuralDamping => {
                Some(SceneEffect::Flexibility)
            }
            SceneEffect::ContactDamping | SceneEffect::Friction => Some(SceneEffect::Clearance),
            SceneEffect::Flexibility | SceneEffect::Clearance | SceneEffect::Gravity => None,
        }
    }

    /// True of a scene that has the effect in one of its links or joints at least.
    pub fn is_in(self, scene: &Scene) -> bool {
        let a_link = |has: fn(&FlexibleLink) -> bool| links(scene).any(|(_, link)| has(link));
        let a_contact = |has: fn(&Contact) -> bool| {
            let contacts = scene.joints.iter().filter_map(|joint| joint.contact());
            contacts.into_iter().any(has)
        };
        match self {
            SceneEffect::Flexibility => a_link(|_| true),
            SceneEffect::Elements => a_link(|link| link.elements > 1),
            SceneEffect::StructuralDamping => a_link(|link| link.damping.is_some()),
            SceneEffect::Clearance => a_contact(|_| true),
            SceneEffect::ContactDamping => a_contact(|c| c.law.is_damped && c.restitution < 1.0),
            SceneEffect::Friction => a_contact(|contact| contact.friction.is_some()),
            SceneEffect::Gravity => scene.simulation.gravity.is_some_and(|g| g != [0.0; 2]),
        }
    }

    /// The scene without the effect in any link or joint, and so without the effects that need it.
    ///
    /// # Errors
    /// Something is fastened to an inner node of a link that would lose its inner nodes.
    pub fn removed_from(self, scene: &Scene) -> Result<Scene, SceneError> {
        let mut scene = scene.clone();
        if self == SceneEffect::Elements {
            drop_inner_points(&mut scene)?;
        }
        for body in &mut scene.bodies {
            let Some(link) = body.kind.get::<FlexibleLink>() else {
                continue;
            };
            let mut link = link.clone();
            match self {
                SceneEffect::Flexibility => {
                    body.kind = Arc::new(link.rigid_link());
                    continue;
                }
                SceneEffect::Elements => (link.elements, link.nodes) = (1, vec![0, 1]),
                SceneEffect::StructuralDamping => link.damping = None,
                _ => continue,
            }
            body.kind = Arc::new(link);
        }
        for joint in &mut scene.joints {
            let Some(contact) = joint.contact() else {
                continue;
            };
            let mut contact = contact.clone();
            match self {
                SceneEffect::Clearance => {}
                SceneEffect::ContactDamping => {
                    (contact.law, contact.restitution) = (&HERTZ, 1.0);
                    contact.own.clear();
                }
                SceneEffect::Friction => contact.friction = None,
                _ => continue,
            }
            let changed = (self != SceneEffect::Clearance).then_some(contact);
            if let Some(model) = joint.model.with_contact(changed) {
                joint.model = model;
            }
        }
        if self == SceneEffect::Gravity {
            scene.simulation.gravity = None;
        }
        Ok(scene)
    }
}

impl Serialize for SceneEffect {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.name())
    }
}

/// The effects that a scene has, in the order of [`SceneEffect::ALL`].
pub fn effects(scene: &Scene) -> Vec<SceneEffect> {
    let all = SceneEffect::ALL.into_iter();
    all.filter(|effect| effect.is_in(scene)).collect()
}

fn links(scene: &Scene) -> impl Iterator<Item = (usize, &FlexibleLink)> {
    let bodies = scene.bodies.iter().enumerate();
    bodies.filter_map(|(b, body)| Some((b, body.kind.get()?)))
}

/// Takes the inner points from all links, unless one of them carries something.
fn drop_inner_points(scene: &mut Scene) -> Result<(), SceneError> {
    for (b, link) in links(scene) {
        let inner = |point: &PointRef| point.body == b && point.point > 1;
        let mut users = fastenings(scene).into_iter();
        if let Some((name, span, point)) = users.find(|(.., point)| inner(point)) {
            let message = format!(
                "{name} uses the inner node {}.{}, but one element has none",
                scene.bodies[b].name, link.link.points[point.point].name
            );
            return Err(scene.error(span, message, "uses an inner node"));
        }
    }
    for body in &mut scene.bodies {
        if let Some(link) = body.kind.get::<FlexibleLink>() {
            body.kind = Arc::new(link.without_inner_points());
        }
    }
    Ok(())
}

/// Everything that is fastened to a point of a body: its name, its place in the scene, and the point.
fn fastenings(scene: &Scene) -> Vec<(String, Span, PointRef)> {
    let mut list = Vec::new();
    let mut add = |name: String, span, point| list.push((name, span, point));
    for joint in &scene.joints {
        for point in [joint.bearing, joint.journal] {
            add(format!("joint {}", joint.name), joint.span, point);
        }
    }
    for force in &scene.forces {
        for point in force.kind.points() {
            add(format!("force {}", force.name), force.span, point);
        }
    }
    for motion in &scene.motions {
        if let MotionKind::Point { point, .. } = motion.kind {
            add(format!("drive {}", motion.name), motion.span, point);
        }
    }
    for sketch in &scene.initial.sketch {
        if let Sketched::Point(point) = sketch.what {
            add("the sketch".into(), sketch.span, point);
        }
    }
    list
}

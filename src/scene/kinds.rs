//! `[bodies]`, `[contacts]`, `[joints]` and `[forces]`: tables of named things. Which kind a thing is, its `type` says.

use super::NamedBody;
use crate::body::{Body, Known, Materials};
use crate::document::{Field, Fields, Kind, RESERVED, SceneError, Span, check_name, named};
use crate::interaction::{Contact, Joint, NO_DIRECTION, NamedForce, Names};
use crate::registry::Registry;
use indexmap::IndexMap;
use std::sync::Arc;

/// Everything in a scene that has a name and a kind.
pub(super) struct Things {
    pub bodies: IndexMap<String, Arc<dyn Body>>,
    spans: Vec<Span>,
    pub joints: IndexMap<String, Joint>,
    pub forces: Vec<NamedForce>,
    pub duration: f64,
}

impl Things {
    pub fn names(&self) -> Names<'_> {
        Names {
            bodies: &self.bodies,
            joints: &self.joints,
            duration: self.duration,
        }
    }

    /// The bodies with their names and places.
    pub fn named_bodies(&self) -> Vec<NamedBody> {
        let bodies = self.bodies.iter().zip(&self.spans);
        let bodies = bodies.map(|((name, kind), span)| NamedBody {
            name: name.clone(),
            span: *span,
            kind: kind.clone(),
        });
        bodies.collect()
    }
}

/// Channels are called `name.quantity`, so names must differ.
fn check_unique(field: &Field, what: &str, taken: bool) -> Result<(), SceneError> {
    check_name(field, &RESERVED)?;
    if !taken {
        return Ok(());
    }
    let message = format!("`{}` names both {what}", field.name);
    let help = "channels are called `name.quantity`, so names must differ";
    Err(field.key_fault(message, "taken").with_help(help))
}

pub(super) fn read(
    root: &Fields,
    duration: f64,
    registry: &Registry,
) -> Result<Things, SceneError> {
    let materials = Materials::read(root, duration)?;
    let mut things = Things {
        bodies: IndexMap::new(),
        spans: Vec::new(),
        joints: IndexMap::new(),
        forces: Vec::new(),
        duration,
    };
    let table = root.field("bodies")?;
    things.bodies = named(Some(table.clone()), |field| {
        check_name(field, &RESERVED)?;
        let mut fields = field.fields()?;
        let kind = Kind::of(&mut fields, "body", &registry.bodies)?;
        things.spans.push(field.span());
        (kind.read)(&fields, &materials)
    })?;
    check_ground(&table, &things)?;
    let laws = &registry.laws;
    let contacts = named(root.optional("contacts"), |field| {
        Contact::read(field, &materials, laws)
    })?;
    things.joints = named(root.optional("joints"), |field| {
        let taken = things.bodies.contains_key(&field.name);
        check_unique(field, "a body and a joint", taken)?;
        joint(field, &things.names(), registry, &contacts)
    })?;
    let forces = named(root.optional("forces"), |field| {
        let taken =
            things.bodies.contains_key(&field.name) || things.joints.contains_key(&field.name);
        check_unique(field, "a force and a body or joint", taken)?;
        let mut fields = field.fields()?;
        let kind = Kind::of(&mut fields, "force", &registry.forces)?;
        Ok(NamedForce {
            name: field.name.clone(),
            span: field.span(),
            kind: (kind.read)(&fields, &things.names())?,
        })
    })?;
    things.forces = forces.into_values().collect();
    Ok(things)
}

/// There is one ground.
fn check_ground(table: &Field, things: &Things) -> Result<(), SceneError> {
    let grounds = things.bodies.iter().zip(&things.spans);
    let mut grounds = grounds.filter(|((_, body), _)| matches!(body.known(), Some(Known::Fixed)));
    let Some(((ground, _), _)) = grounds.next() else {
        let error = table.key_fault("the scene has no body of type \"ground\"", "no ground here");
        return Err(error.with_help("add `[bodies.ground]` with `type = \"ground\"`"));
    };
    match grounds.next() {
        None => Ok(()),
        Some(((second, _), span)) => {
            let message = format!("`{ground}` and `{second}` are both ground");
            Err(table.fault_at(*span, message, "a second ground"))
        }
    }
}

fn joint(
    field: &Field,
    names: &Names,
    registry: &Registry,
    contacts: &IndexMap<String, Contact>,
) -> Result<Joint, SceneError> {
    let mut table = field.fields()?;
    let kind = Kind::of(&mut table, "joint", &registry.joints)?;
    let sides = [kind.keys[0].name, kind.keys[1].name];
    let bearing = names.point(&table.field(sides[0])?)?;
    let second = table.field(sides[1])?;
    let journal = names.point(&second)?;
    if bearing.body == journal.body {
        let message = format!("`{}` connects a body to itself", field.path);
        let label = format!("on the same body as the {}", sides[0]);
        return Err(second.fault(message, label));
    }
    let model = (kind.read)(&table, contacts)?;
    let sides = model.needs_direction().into_iter().zip([bearing, journal]);
    let mut turning = sides.filter(|(needs, _)| *needs);
    if let Some(message) = turning.find_map(|(_, p)| names.directionless(field, p)) {
        return Err(field.key_fault(message, NO_DIRECTION));
    }
    Ok(Joint {
        name: field.name.clone(),
        span: field.span(),
        bearing,
        journal,
        model,
    })
}

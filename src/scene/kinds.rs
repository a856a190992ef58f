//! `[bodies]`, `[contacts]`, `[joints]` and `[forces]`: tables of named things. Which kind a thing is, its `type` says.

use super::NamedBody;
use crate::body::{Known, Materials};
use crate::document::{Field, Fields, Kind, RESERVED, SceneError, check_name, named};
use crate::interaction::{Contact, Joint, NO_DIRECTION, NamedForce, Names};
use crate::registry::Registry;
use indexmap::IndexMap;

/// `[bodies]`: one of them is the ground.
pub(super) fn bodies(
    root: &Fields,
    materials: &Materials,
    registry: &Registry,
) -> Result<Vec<NamedBody>, SceneError> {
    let table = root.field("bodies")?;
    let bodies = named(Some(table.clone()), |field| {
        check_name(field, &RESERVED)?;
        let (kind, fields) = Kind::of(field, "body", &registry.bodies)?;
        Ok(NamedBody {
            name: field.name.clone(),
            span: field.span(),
            kind: (kind.read)(&fields, materials)?,
        })
    })?;
    let bodies: Vec<_> = bodies.into_values().collect();
    let is_ground = |body: &&NamedBody| matches!(body.kind.known(), Some(Known::Fixed));
    let mut grounds = bodies.iter().filter(is_ground);
    match (grounds.next(), grounds.next()) {
        (Some(_), None) => Ok(bodies),
        (Some(first), Some(second)) => {
            let message = format!("`{}` and `{}` are both ground", first.name, second.name);
            let sources = table.sources;
            Err(SceneError::new(
                sources,
                second.span,
                message,
                "a second ground",
            ))
        }
        (None, _) => {
            let message = "the scene has no body of type \"ground\"";
            let error = table.key_fault(message, "no ground here");
            Err(error.with_help("add `[bodies.ground]` with `type = \"ground\"`"))
        }
    }
}

/// `[joints]`, with the `[contacts]` that they name.
pub(super) fn joints(
    root: &Fields,
    names: &Names,
    materials: &Materials,
    registry: &Registry,
) -> Result<IndexMap<String, Joint>, SceneError> {
    let contacts = named(root.optional("contacts"), |field| {
        Contact::read(field, materials, &registry.laws, &registry.frictions)
    })?;
    named(root.optional("joints"), |field| {
        let taken = names.bodies.contains_key(&field.name);
        check_unique(field, "a body and a joint", taken)?;
        joint(field, names, registry, &contacts)
    })
}

/// `[forces]`
pub(super) fn forces(
    root: &Fields,
    names: &Names,
    registry: &Registry,
) -> Result<Vec<NamedForce>, SceneError> {
    let forces = named(root.optional("forces"), |field| {
        let name = &field.name;
        let taken = names.bodies.contains_key(name) || names.joints.contains_key(name);
        check_unique(field, "a force and a body or joint", taken)?;
        let (kind, fields) = Kind::of(field, "force", &registry.forces)?;
        Ok(NamedForce {
            name: name.clone(),
            span: field.span(),
            kind: (kind.read)(&fields, names)?,
        })
    })?;
    Ok(forces.into_values().collect())
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

fn joint(
    field: &Field,
    names: &Names,
    registry: &Registry,
    contacts: &IndexMap<String, Contact>,
) -> Result<Joint, SceneError> {
    let (kind, table) = Kind::of(field, "joint", &registry.joints)?;
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

//! The tables of the scene language as data, for references and for editors that check a scene.

use super::{integrator, motion, reader};
use crate::body::{MATERIAL, PLATES, POLAR, RAYLEIGH, SECTION};
use crate::document::{Key, Kind};
use crate::interaction::contact;
use crate::motion::PATHS;
use crate::registry::Registry;

/// A table of the language.
#[derive(Debug, Clone, PartialEq)]
pub struct Sheet {
    /// What it describes, such as `joints.NAME`; empty for the scene itself.
    pub table: &'static str,
    /// Its kind, and the key that says so.
    pub kind: Option<[&'static str; 2]>,
    /// Its other keys.
    pub keys: Vec<Key>,
}

/// All tables of the language, with the kinds of a registry.
pub fn language(registry: &Registry) -> Vec<Sheet> {
    let mut sheets = Vec::new();
    let mut plain = |table, keys: &[Key]| {
        sheets.push(Sheet {
            table,
            kind: None,
            keys: keys.to_vec(),
        });
    };
    let schemes = &registry.schemes;
    let mut settings = integrator::INTEGRATOR.to_vec();
    let parameters = integrator::parameters(schemes).into_values();
    let parameters = parameters.map(|(p, _)| Key {
        default: p.default,
        ..Key::number(p.name, "", p.purpose)
    });
    settings.splice(1..1, parameters);
    plain("", &reader::SCENE);
    plain("simulation", &reader::SIMULATION);
    plain("integrator", &settings);
    plain("integrator.accuracy", &integrator::ACCURACY);
    plain("output", &reader::OUTPUT);
    plain("materials.NAME", &MATERIAL);
    plain("sections.NAME", &SECTION);
    let own = registry.laws.iter().flat_map(|law| law.keys);
    let own = own.map(|key| key.or("required by its law"));
    let contact: Vec<Key> = contact::KEYS.into_iter().chain(own).collect();
    plain("contacts.NAME", &contact);
    plain("bodies.NAME.points.NAME", &POLAR);
    plain("bodies.NAME.rayleigh", &RAYLEIGH);
    plain("initial", &motion::INITIAL);
    plain("initial.bodies.NAME", &motion::STATE);
    let of_flexible_link = [&motion::STATE[..], &motion::DEFORMED].concat();
    plain("initial.bodies.NAME of a flexible link", &of_flexible_link);
    plain("initial.bodies.NAME of a point mass", &motion::POINT_STATE);
    plain("initial.velocities.NAME", &motion::VELOCITIES);
    let frictions = &registry.frictions;
    add_by("law", &mut sheets, "contacts.NAME.friction", frictions);
    add_by("shape", &mut sheets, "bodies.NAME.plate", &PLATES);
    add(&mut sheets, "bodies.NAME", &registry.bodies);
    add(&mut sheets, "joints.NAME", &registry.joints);
    add(&mut sheets, "drives.NAME", &motion::KINDS);
    add(&mut sheets, "forces.NAME", &registry.forces);
    add(&mut sheets, "path", &PATHS);
    add(&mut sheets, "function of time", &registry.functions);
    sheets
}

fn add<F>(sheets: &mut Vec<Sheet>, table: &'static str, kinds: &[&'static Kind<F>]) {
    add_by("type", sheets, table, kinds);
}

/// Adds kinds that `key` tells apart.
fn add_by<F>(
    key: &'static str,
    sheets: &mut Vec<Sheet>,
    table: &'static str,
    kinds: &[&'static Kind<F>],
) {
    sheets.extend(kinds.iter().map(|kind| Sheet {
        table,
        kind: Some([key, kind.name]),
        keys: kind.keys.to_vec(),
    }));
}

//! What a picture of the mechanism needs of a row: where its bodies are, and what happens in its loose joints.

use crate::model::Model;
use crate::system::State;
use crate::terms::ForceTerm;

/// Which quantities a row of the motion has: the time \[s\], the coordinates of all bodies that move \[m, rad; slopes 1\], and of
/// every joint with clearance its eccentricity \[m\] and the force on its journal \[N\].
#[derive(Debug, Clone)]
pub struct MotionLayout {
    names: Vec<String>,
    coordinates: Vec<usize>,
    contacts: Vec<usize>,
}

impl MotionLayout {
    /// That of a mechanism.
    pub fn new(model: &Model) -> MotionLayout {
        let mut layout = MotionLayout {
            names: vec!["t".to_owned()],
            coordinates: Vec::new(),
            contacts: Vec::new(),
        };
        for body in model.bodies().iter().filter(|body| body.moves) {
            for (slot, x) in body.placed.kind.slots().iter().zip(&body.placed.x) {
                for (i, name) in slot.content.names().iter().enumerate() {
                    layout
                        .names
                        .push(format!("{}{}.{name}", body.name, slot.label));
                    layout.coordinates.push(x + i);
                }
            }
        }
        for joint in model.joints() {
            if let ForceTerm::Contact(contact) = joint.terms.force {
                let names = ["ex", "ey", "fx", "fy"];
                layout
                    .names
                    .extend(names.map(|name| format!("{}.{name}", joint.name)));
                layout.contacts.push(contact);
            }
        }
        layout
    }

    /// Names of the columns.
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// Index of the first of the four columns of every joint with clearance, in the order of the joints.
    pub fn loose(&self) -> impl Iterator<Item = usize> {
        let first = 1 + self.coordinates.len();
        (0..self.contacts.len()).map(move |k| first + 4 * k)
    }

    /// Appends the values of a consistent state.
    pub fn measure(&self, model: &Model, at: &State, values: &mut Vec<f64>) {
        values.push(at.t);
        values.extend(self.coordinates.iter().map(|&i| at.q[i]));
        for &contact in &self.contacts {
            let gap = model.contacts[contact].pair.gap(&at.q, &at.v);
            let force = model.contact_force(contact, at);
            values.extend([gap.e.x, gap.e.y, force.x, force.y]);
        }
    }

    /// Puts the coordinates of a row into `q`.
    pub fn restore(&self, row: &[f64], q: &mut [f64]) {
        for (&i, value) in self.coordinates.iter().zip(&row[1..]) {
            q[i] = *value;
        }
    }
}

//! How Looselink's shared coordinates appear among the full ones of the reference.
//!
//! Every full coordinate is a copy of one of Looselink's, q_full = B q with one 1 a row of B. Then M = B^T M_full B, and
//! forces are B^T f_full: what the reference computes body by body is summed where Looselink shares a node.

use crate::reference::ReferenceScene;
use looselink::body::CentredLink;
use looselink::model::Model;
use looselink::system::State;

/// Both sides' numbering of one scene, matched through names.
#[derive(Debug)]
pub struct Embedding {
    /// The matrix B as a list: the coordinate of Looselink that each full coordinate copies.
    source: Vec<usize>,
    /// Coordinates of Looselink.
    count: usize,
    /// For each multiplier of Looselink the row of the reference, unless it is redundant.
    pub rows: Vec<Option<usize>>,
    /// For each contact of Looselink the joint of the reference.
    contacts: Vec<usize>,
    joints: usize,
}

/// Looselink's index of the coordinate that the reference calls `name`.
fn coordinate(model: &Model, name: &str) -> Option<usize> {
    let mut parts = name.split('.');
    let (body, part, last) = (parts.next()?, parts.next()?, parts.next());
    let body = model.bodies().iter().find(|b| b.name == body)?;
    let place = |quantity: &str| ["x", "y", "theta"].iter().position(|q| *q == quantity);
    let x = &body.placed.x;
    match (part, last) {
        (quantity, None) => Some(x[0] + place(quantity)?),
        ("start", Some(quantity)) => Some(x[0] + place(quantity)?),
        ("end", Some(quantity)) => Some(x[1] + place(quantity)?),
        (node, Some(last)) => {
            let node: usize = node.strip_prefix("node")?.parse().ok()?;
            match last.strip_prefix("slope_") {
                Some(quantity) => Some(x.get(2 * node + 1)? + place(quantity)?),
                None => Some(x.get(2 * node)? + place(last)?),
            }
        }
    }
}

/// Position and velocity of the full coordinates of the reference in a state of Looselink, where a link may have the coordinates
/// of its centre, and a body that of its joint.
pub fn full(reference: &ReferenceScene, model: &Model, at: &State) -> [Vec<f64>; 2] {
    let other = |name: &str| {
        let mut parts = name.split('.');
        let (body, part) = (parts.next()?, parts.next()?);
        let body = model.bodies().iter().position(|b| b.name == body)?;
        let kind = &model.bodies()[body].placed.kind;
        let is_held = kind.hold().is_some();
        if !is_held && kind.get::<CentredLink>().is_none() {
            return None;
        }
        let Some(axis) = parts.next() else {
            let place = ["x", "y", "theta"].iter().position(|x| *x == part)?;
            let pose = model.pose(body, at);
            return Some((pose.position[place], pose.velocity[place]));
        };
        let point = ["start", "end"].iter().position(|p| *p == part)?;
        let axis = ["x", "y"].iter().position(|a| *a == axis)?;
        let [position, velocity, _] = model.point(body, point, at);
        Some((position[axis], velocity[axis]))
    };
    let both = reference.coordinates.iter().map(|name| {
        let copy = || coordinate(model, name).map(|i| (at.q[i], at.v[i]));
        let found = other(name).or_else(copy);
        found.unwrap_or_else(|| panic!("Looselink has no coordinate {name}"))
    });
    let (q, v) = both.unzip();
    [q, v]
}

/// What the reference calls the row that Looselink calls `name`.
fn row_name(name: &str) -> String {
    if let Some(link) = name.strip_prefix("length of ") {
        return format!("{link}.length");
    }
    let name = name.strip_prefix("joint ").or(name.strip_prefix("drive "));
    let (owner, part) = name.and_then(|n| n.split_once(" (")).unwrap_or_default();
    format!("{owner}.{}", part.trim_end_matches(')').replace(' ', "_"))
}

impl Embedding {
    /// The way between the coordinates, rows and contacts of a scene.
    pub fn new(reference: &ReferenceScene, model: &Model) -> Embedding {
        let source = reference.coordinates.iter().map(|name| {
            coordinate(model, name).unwrap_or_else(|| panic!("Looselink has no coordinate {name}"))
        });
        let place = |name: &str| {
            let of = |kind: &str| {
                let name = row_name(name).replace(".angle", kind);
                reference.rows.iter().position(|row| *row == name)
            };
            // a held angle is called the rotation of its joint, the angle of its drive
            of(".angle").or_else(|| of(".rotation"))
        };
        let redundant = model.redundant();
        let row = |name: &String| {
            let place = place(name);
            let known = place.is_some() != redundant.contains(name);
            assert!(known, "one side leaves {name} out");
            place
        };
        let contact = |c| {
            let name = &model.joints()[model.contact_joint(c)?].name;
            reference.joints.iter().position(|joint| joint == name)
        };
        let contacts = (0..model.shape().contacts).map(contact);
        Embedding {
            source: source.collect(),
            count: model.shape().coordinates,
            rows: model.unknown_names()[model.shape().unknowns..]
                .iter()
                .map(row)
                .collect(),
            contacts: contacts
                .collect::<Option<_>>()
                .expect("joints of both sides"),
            joints: reference.joints.len(),
        }
    }

    /// B x.
    pub fn spread(&self, x: &[f64]) -> Vec<f64> {
        self.source.iter().map(|&i| x[i]).collect()
    }

    /// The contact memory of the reference.
    pub fn memory(&self, z: &[f64]) -> Vec<f64> {
        let mut memory = vec![0.0; self.joints];
        for (&joint, z) in self.contacts.iter().zip(z) {
            memory[joint] = *z;
        }
        memory
    }

    /// B^T f.
    pub fn gather(&self, f: &[f64]) -> Vec<f64> {
        let mut sum = vec![0.0; self.count];
        for (&i, f) in self.source.iter().zip(f) {
            sum[i] += f;
        }
        sum
    }

    /// B^T K B, row by row.
    pub fn congruence(&self, k: &[f64]) -> Vec<f64> {
        let mut sum = vec![0.0; self.count * self.count];
        for (row, &i) in k.chunks_exact(self.source.len()).zip(&self.source) {
            for (value, &j) in row.iter().zip(&self.source) {
                sum[i * self.count + j] += value;
            }
        }
        sum
    }

    /// Sets the coordinates that have a copy; copies of one coordinate agree on the manifold.
    pub fn take(&self, full: &[f64], x: &mut [f64]) {
        for (&i, value) in self.source.iter().zip(full) {
            x[i] = *value;
        }
    }
}

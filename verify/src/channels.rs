//! Looselink's channels from the states of the reference.

use crate::description::Description;
use crate::ffi::ENERGIES;
use crate::reference::{Body, Row, System, body_kind, joint_kind, motion_kind};
use miette::{IntoDiagnostic, Result};
use std::collections::BTreeMap;
use std::f64::consts::TAU;

/// Names of the energies of a row, in its order.
const NAMES: [&str; ENERGIES] = [
    "kinetic",
    "axial",
    "bending",
    "contact",
    "gravity",
    "springs",
    "work",
    "contact_dissipated",
    "clamp",
    "friction_dissipated",
    "damping_dissipated",
];
/// What the levels of a pose are called.
const LEVELS: [[&str; 3]; 3] = [
    ["x", "y", "theta"],
    ["vx", "vy", "omega"],
    ["ax", "ay", "alpha"],
];

/// Columns that grow by a row at a time.
#[derive(Debug)]
pub struct Channels<'a> {
    description: &'a Description,
    /// First coordinate of every body.
    places: Vec<usize>,
    initial_energy: Option<f64>,
    /// The columns so far.
    pub columns: BTreeMap<String, Vec<f64>>,
}

impl<'a> Channels<'a> {
    /// No rows yet.
    pub fn new(description: &'a Description) -> Channels<'a> {
        Channels {
            description,
            places: places(&description.mechanism.bodies),
            initial_energy: None,
            columns: BTreeMap::new(),
        }
    }

    fn put(&mut self, name: String, value: f64) {
        self.columns.entry(name).or_default().push(value);
    }

    /// Adds a row.
    ///
    /// # Errors
    /// When the cranks have no angle, which they have where the run has come.
    pub fn add(&mut self, system: &System, row: &Row) -> Result<()> {
        for b in 0..self.places.len() {
            self.body(b, row);
        }
        self.joints(row);
        if !self.description.mechanism.legs.is_empty() {
            self.drive(system, row)?;
        }
        self.motions(row);
        self.energies(row);
        Ok(())
    }

    fn body(&mut self, b: usize, row: &Row) {
        let body = self.description.mechanism.bodies[b];
        let name = &self.description.bodies[b].clone();
        let range = self.places[b]..self.places[b] + coordinates(&body);
        let levels = [&row.q, &row.v, &row.a].map(|level| &level[range.clone()]);
        match body.kind {
            body_kind::RIGID_BODY | body_kind::MOVING_BODY => {
                for (names, level) in LEVELS.iter().zip(levels) {
                    for (quantity, value) in names.iter().zip(level) {
                        self.put(format!("{name}.{quantity}"), *value);
                    }
                }
                self.points_of_rigid(b, levels);
            }
            body_kind::POINT_MASS => {
                for owner in [name.clone(), format!("points.{name}.center")] {
                    self.place(&owner, levels, 0);
                }
            }
            body_kind::RIGID_LINK => {
                self.link(name, levels, |u| [0.5 * (u[0] + u[2]), 0.5 * (u[1] + u[3])]);
                for (point, first) in [("start", 0), ("end", 2)] {
                    self.place(&format!("points.{name}.{point}"), levels, first);
                }
            }
            body_kind::FLEXIBLE_LINK => {
                let n = body.elements as usize;
                let length = body.length / n as f64;
                self.link(name, levels, |u| centre(u, n, length));
                self.put(format!("{name}.strain"), strain(levels[0], n, length));
                for (body, point, [x, _]) in self.description.points.clone() {
                    if body != b {
                        continue;
                    }
                    let first = 4 * (x / length).round() as usize;
                    let owner = format!("points.{name}.{point}");
                    self.place(&owner, levels, first);
                    for (i, quantity) in ["slope_x", "slope_y"].into_iter().enumerate() {
                        self.put(format!("{owner}.{quantity}"), levels[0][first + 2 + i]);
                    }
                }
            }
            _ => {}
        }
    }

    /// A position among the coordinates, and its rates.
    fn place(&mut self, owner: &str, levels: [&[f64]; 3], first: usize) {
        for (names, level) in LEVELS.iter().zip(levels) {
            for (i, quantity) in names[..2].iter().enumerate() {
                self.put(format!("{owner}.{quantity}"), level[first + i]);
            }
        }
    }

    /// r + A s of every named point of a rigid body, and its rates.
    fn points_of_rigid(&mut self, b: usize, levels: [&[f64]; 3]) {
        let name = &self.description.bodies[b].clone();
        let [q, v, a] = levels;
        let (sine, cosine) = q[2].sin_cos();
        for (body, point, [x, y]) in self.description.points.clone() {
            if body != b {
                continue;
            }
            let arm = [x * cosine - y * sine, x * sine + y * cosine];
            let values = [
                [q[0] + arm[0], q[1] + arm[1]],
                [v[0] - v[2] * arm[1], v[1] + v[2] * arm[0]],
                [
                    a[0] - a[2] * arm[1] - v[2] * v[2] * arm[0],
                    a[1] + a[2] * arm[0] - v[2] * v[2] * arm[1],
                ],
            ];
            for (names, value) in LEVELS.iter().zip(values) {
                for (quantity, value) in names.iter().zip(value) {
                    self.put(format!("points.{name}.{point}.{quantity}"), value);
                }
            }
        }
    }

    /// Centre of mass and the turning of the chord; the angle itself is known to a full turn only and is left out.
    fn link(&mut self, name: &str, levels: [&[f64]; 3], centre: impl Fn(&[f64]) -> [f64; 2]) {
        for (names, level) in LEVELS.iter().zip(levels) {
            for (quantity, value) in names.iter().zip(centre(level)) {
                self.put(format!("{name}.{quantity}"), value);
            }
        }
        let last = if levels[0].len() == 4 {
            2
        } else {
            levels[0].len() - 4
        };
        let [d, d_dot, d_ddot] = levels.map(|u| [u[last] - u[0], u[last + 1] - u[1]]);
        let square = dot(d, d);
        let omega = cross(d, d_dot) / square;
        let alpha = cross(d, d_ddot) / square - 2.0 * omega * dot(d, d_dot) / square;
        self.put(format!("{name}.omega"), omega);
        self.put(format!("{name}.alpha"), alpha);
    }

    fn joints(&mut self, row: &Row) {
        for (j, name) in self.description.joints.iter().enumerate() {
            let [fx, fy] = [row.joint_force[2 * j], row.joint_force[2 * j + 1]];
            self.put(format!("{name}.fx"), fx);
            self.put(format!("{name}.fy"), fy);
            self.put(format!("{name}.force"), fx.hypot(fy));
            let joint = self.description.mechanism.joints[j];
            if joint.kind == joint_kind::WELD || joint.hold_rotation != 0 {
                self.put(format!("{name}.torque"), row.joint_couple[j]);
            }
            if let Ok(contact) = usize::try_from(joint.contact) {
                let clearance = self.description.mechanism.contacts[contact].clearance;
                let closed = row.impact_velocity[j] > 0.0 && row.penetration[j] > 0.0;
                self.put(format!("{name}.penetration"), row.penetration[j]);
                self.put(
                    format!("{name}.eccentricity"),
                    row.penetration[j] + clearance,
                );
                self.put(format!("{name}.contact"), f64::from(closed));
            }
        }
    }

    fn drive(&mut self, system: &System, row: &Row) -> Result<()> {
        let path = self.description.mechanism.path;
        let x = self.places[path.body as usize];
        let angle = TAU * path.frequency * row.t + path.phase;
        let pose = [
            path.centre_x + path.radius * angle.cos(),
            path.centre_y + path.radius * angle.sin(),
            path.theta,
        ];
        for (i, quantity) in LEVELS[0].iter().enumerate() {
            self.put(format!("error.{quantity}"), row.q[x + i] - pose[i]);
        }
        let cranks = system.cranks(row.t).into_diagnostic()?;
        let description = self.description;
        for (leg, (crank, torque)) in cranks.iter().zip(&row.torque).enumerate() {
            let joint = description.mechanism.legs[leg].joint_a as usize;
            let name = &description.joints[joint];
            self.put(format!("{name}.angle"), crank[0]);
            self.put(format!("{name}.speed"), crank[1]);
            self.put(format!("{name}.torque"), *torque);
        }
        Ok(())
    }

    /// Torques of driven joints; what drives a point has no channel.
    fn motions(&mut self, row: &Row) {
        let motions = &self.description.mechanism.motions;
        for ((motion, [name, ..]), force) in motions
            .iter()
            .zip(&self.description.motions)
            .zip(&row.motion_force)
        {
            if motion.kind == motion_kind::ANGLE {
                self.put(format!("{name}.torque"), *force);
            }
        }
    }

    fn energies(&mut self, row: &Row) {
        let mechanism = &self.description.mechanism;
        let sprung = mechanism.springs.len() + mechanism.torsion_springs.len() > 0;
        for (name, value) in NAMES.iter().zip(row.energies) {
            if *name == "springs" && !sprung {
                continue;
            }
            self.put(format!("energy.{name}"), value);
        }
        let [
            kinetic,
            axial,
            bending,
            contact,
            gravity,
            springs,
            rest @ ..,
        ] = row.energies;
        let [work, lost, _, friction, damping] = rest;
        let stored = kinetic + axial + bending + contact + gravity + springs;
        let initial = *self.initial_energy.get_or_insert(stored);
        self.put(
            "energy.numerical".into(),
            initial + work - lost - friction - damping - stored,
        );
    }
}

/// Coordinates of a body.
pub fn coordinates(body: &Body) -> usize {
    match body.kind {
        body_kind::RIGID_LINK => 4,
        body_kind::FLEXIBLE_LINK => 4 * (body.elements as usize + 1),
        body_kind::RIGID_BODY | body_kind::MOVING_BODY => 3,
        body_kind::POINT_MASS => 2,
        _ => 0,
    }
}

/// First coordinate of every body.
pub fn places(bodies: &[Body]) -> Vec<usize> {
    let mut next = 0;
    let place = |body| {
        next += coordinates(body);
        next - coordinates(body)
    };
    bodies.iter().map(place).collect()
}

/// Mean of the cubic r over the link, element by element: (r_i + r_j)/2 + l (r'_i - r'_j)/12.
fn centre(u: &[f64], elements: usize, length: f64) -> [f64; 2] {
    let mean = |e: usize, i: usize| {
        let (low, high) = (&u[4 * e..], &u[4 * e + 4..]);
        0.5 * (low[i] + high[i]) + length / 12.0 * (low[i + 2] - high[i + 2])
    };
    [0, 1].map(|i| (0..elements).map(|e| mean(e, i)).sum::<f64>() / elements as f64)
}

/// The Green strain of largest magnitude at eleven points of every element.
fn strain(u: &[f64], elements: usize, length: f64) -> f64 {
    let mut largest = 0.0_f64;
    for e in 0..elements {
        let (low, high) = (&u[4 * e..], &u[4 * e + 4..]);
        for k in 0..=10 {
            let s = f64::from(k) / 10.0;
            // Hermite polynomials differentiated by x = s length
            let chord = 6.0 * s * (1.0 - s) / length;
            let (start, end) = (1.0 - 4.0 * s + 3.0 * s * s, 3.0 * s * s - 2.0 * s);
            let slope =
                [0, 1].map(|i| chord * (high[i] - low[i]) + start * low[i + 2] + end * high[i + 2]);
            let strain = 0.5 * (dot(slope, slope) - 1.0);
            if strain.abs() > largest.abs() {
                largest = strain;
            }
        }
    }
    largest
}

fn dot(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

fn cross(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

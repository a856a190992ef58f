//! What a run comes to: largest values and root mean squares over its recorded rows, whatever channels the scene asks for, and what
//! was counted of its contacts.
//!
//! The force of a joint with clearance counts at the end of every step: rows may miss the peaks of short contacts.

use super::impacts::{ContactCount, Impacts};
use crate::checkpoint::carried;
use crate::model::Model;
use crate::scene::{Analysis, Scene};
use crate::system::{State, System, Work};
use crate::terms::ForceTerm;
use serde::Serialize;
use std::collections::BTreeMap;

/// The largest magnitude of a quantity, and its root mean square over the recorded rows.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Peak {
    /// Largest magnitude.
    pub largest: f64,
    /// When: the time of a row, or of the end of a step in a contact \[s\].
    pub t: f64,
    /// Root mean square over the rows.
    pub rms: f64,
    /// Where the largest falls into the first impact, or before it: the largest afterwards.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub after_first_impact: Option<f64>,
}

/// How far a driven body is from its prescribed pose.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct PoseError {
    /// Distance of its reference point \[m\].
    pub position: Peak,
    /// Its angle \[rad\].
    pub angle: Peak,
}

/// What a drive does in a joint.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct DriveLoad {
    /// Torque \[N m\].
    pub torque: Peak,
    /// Power \[W\]; absent in a static analysis.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub power: Option<Peak>,
}

/// The contacts of a joint with clearance.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct ContactTime {
    /// Contacts that began after the start.
    pub impacts: u64,
    /// Time in contact \[s\].
    pub closed: f64,
}

/// What a run comes to.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Closing {
    /// From when on it counts \[s\].
    pub from: f64,
    /// Errors of driven bodies.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub errors: BTreeMap<String, PoseError>,
    /// Forces of joints \[N\].
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub forces: BTreeMap<String, Peak>,
    /// Drives by the joints that they turn.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub drives: BTreeMap<String, DriveLoad>,
    /// Contacts.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub contacts: BTreeMap<String, ContactTime>,
}

/// Sums over the rows so far.
#[derive(Debug, Clone, Copy, Default)]
struct Sums {
    /// Largest magnitude and its time.
    largest: [f64; 2],
    /// Largest magnitude after the first impact.
    later: f64,
    /// Sum of squares.
    squares: f64,
}

carried!(Sums { largest, later, squares } but {});

impl Sums {
    fn see(&mut self, value: f64, t: f64, has_settled: bool) {
        let size = value.abs();
        self.squares += size * size;
        if size > self.largest[0] {
            self.largest = [size, t];
        }
        if has_settled {
            self.later = self.later.max(size);
        }
    }
}

/// A joint and what acts in it.
#[derive(Debug)]
struct JointSums {
    joint: usize,
    /// Its contact.
    contact: Option<usize>,
    force: Sums,
    drive: Option<[Sums; 2]>,
}

carried!(JointSums { force, drive } but { joint, contact });

/// A driven body, the distance from its prescribed pose, and the angle.
#[derive(Debug)]
struct BodySums {
    body: usize,
    errors: [Sums; 2],
}

carried!(BodySums { errors } but { body });

/// Measures at every row.
#[derive(Debug)]
pub(super) struct ClosingSums {
    from: f64,
    is_dynamic: bool,
    bodies: Vec<BodySums>,
    joints: Vec<JointSums>,
    rows: u64,
    /// Evaluations made here are no work of the run.
    work: Work,
}

carried!(ClosingSums { bodies, joints, rows } but { from, is_dynamic, work });

impl ClosingSums {
    /// Of a run that has not begun.
    pub fn new(scene: &Scene, model: &Model) -> ClosingSums {
        let driven = model.bodies().iter().enumerate();
        let driven = driven.filter(|(_, body)| body.prescribed.is_some());
        let joints = model.joints().iter().enumerate();
        let joints = joints.map(|(j, joint)| {
            let terms = &joint.terms;
            let is_driven = joint.actuator.is_some() || terms.turned.is_some();
            JointSums {
                joint: j,
                contact: match terms.force {
                    ForceTerm::Contact(contact) => Some(contact),
                    ForceTerm::Constraint(_) | ForceTerm::Eliminated => None,
                },
                force: Sums::default(),
                drive: is_driven.then(<[Sums; 2]>::default),
            }
        });
        ClosingSums {
            from: scene.output.extremes_from,
            is_dynamic: scene.simulation.analysis == Analysis::Dynamic,
            bodies: driven
                .map(|(body, _)| BodySums {
                    body,
                    errors: Default::default(),
                })
                .collect(),
            joints: joints.collect(),
            rows: 0,
            work: model.work(),
        }
    }

    /// True of a row that counts.
    pub fn counts(&self, t: f64) -> bool {
        t >= self.from
    }

    /// A row that counts is recorded, of a consistent state.
    pub fn row(&mut self, model: &Model, at: &State, impacts: &Impacts) {
        let (t, work) = (at.t, &mut self.work);
        self.rows += 1;
        let have_settled = impacts.have_settled();
        for BodySums { body, errors } in &mut self.bodies {
            let Some(prescribed) = model.prescribed(*body, at) else {
                continue;
            };
            let pose = model.pose(*body, at).position;
            let [x, y, theta] = std::array::from_fn(|i| pose[i] - prescribed.position[i]);
            for (sums, error) in errors.iter_mut().zip([f64::hypot(x, y), theta]) {
                sums.see(error, t, have_settled);
            }
        }
        for sums in &mut self.joints {
            let force = model.joint_force(sums.joint, at, work).norm();
            let has_settled = sums.contact.map(|contact| impacts.has_settled(contact));
            let has_settled = has_settled.unwrap_or(have_settled);
            sums.force.see(force, t, has_settled);
            let Some([torques, powers]) = &mut sums.drive else {
                continue;
            };
            let [speed, torque] = model.joint_turn(sums.joint, at, work);
            torques.see(torque, t, have_settled);
            powers.see(torque * speed, t, have_settled);
        }
    }

    /// What the run has come to at time t.
    pub fn report(&self, model: &Model, impacts: &Impacts, t: f64) -> Closing {
        let mut closing = Closing {
            from: self.from,
            errors: BTreeMap::new(),
            forces: BTreeMap::new(),
            drives: BTreeMap::new(),
            contacts: BTreeMap::new(),
        };
        if self.rows == 0 {
            return closing;
        }
        for BodySums { body, errors } in &self.bodies {
            let [position, angle] = errors.map(|sums| self.peak(sums));
            let name = model.bodies()[*body].name.clone();
            closing.errors.insert(name, PoseError { position, angle });
        }
        for sums in &self.joints {
            let name = || model.joints()[sums.joint].name.clone();
            let mut force = sums.force;
            if let Some(contact) = sums.contact {
                let count = impacts.count(contact, t);
                let ContactCount {
                    impacts, closed, ..
                } = count;
                if count.largest[0] > force.largest[0] {
                    force.largest = count.largest;
                }
                force.later = force.later.max(count.later);
                closing
                    .contacts
                    .insert(name(), ContactTime { impacts, closed });
            }
            closing.forces.insert(name(), self.peak(force));
            if let Some([torque, power]) = sums.drive.map(|sums| sums.map(|s| self.peak(s))) {
                let power = self.is_dynamic.then_some(power);
                closing.drives.insert(name(), DriveLoad { torque, power });
            }
        }
        closing
    }

    fn peak(&self, sums: Sums) -> Peak {
        let [largest, t] = sums.largest;
        let falls_into_start = sums.later > 0.0 && sums.later < largest;
        Peak {
            largest,
            t,
            rms: (sums.squares / self.rows as f64).sqrt(),
            after_first_impact: falls_into_start.then_some(sums.later),
        }
    }
}

//! How the full coordinates of the reference follow from Looselink's.
//!
//! In Looselink bodies share nodes, and rigid bodies may have the coordinates of their centre or of the joint that holds them
//! (docs/scene.md, "Coordinates of rigid bodies"). Every full coordinate is a copy of one of Looselink's, plus a component of an arm
//! that turns with its body:
//!
//! ```text
//! Q = q_i + c cos q_k + s sin q_k        V = J v        A = J a + J' v        J = dQ/dq
//! ```
//!
//! With W = M A + f of the full coordinates, the equations in q are r = J^T W, and dr/dq contains W dJ/dq.

use crate::reference::ReferenceScene;
use looselink::body::CentredLink;
use looselink::interaction::{SlopeClamp, Weld};
use looselink::model::{Model, PlacedBody};
use looselink::scene::{PointRef, Scene};
use looselink::system::State;
use nalgebra::{DMatrix, DVector};

/// A full coordinate.
#[derive(Debug)]
struct Placement {
    /// i.
    copy: usize,
    /// k, c and s.
    arm: Option<(usize, [f64; 2])>,
}

/// The full coordinates of a scene in the order of the reference, matched through names.
#[derive(Debug)]
pub struct Embedding {
    placements: Vec<Placement>,
    unknowns: usize,
}

/// A state of Looselink in full coordinates; derivatives are those by its unknowns.
#[derive(Debug)]
pub struct FullState {
    pub q: DVector<f64>,
    pub v: DVector<f64>,
    pub a: DVector<f64>,
    /// J: dQ/dq, dV/dv and dA/da.
    pub jacobian: DMatrix<f64>,
    v_by_q: DMatrix<f64>,
    a_by_q: DMatrix<f64>,
    a_by_v: DMatrix<f64>,
    /// d2Q/dq_k2: the full coordinate, k, the value.
    curvature: Vec<(usize, usize, f64)>,
}

/// True of a body whose points follow from a place and an angle, where the reference may have coordinates of these points.
pub fn is_rooted(body: &PlacedBody) -> bool {
    let kind = &body.placed.kind;
    kind.hold().is_some() || kind.get::<CentredLink>().is_some()
}

/// The coordinate that the reference calls `name`.
fn placement(model: &Model, name: &str) -> Option<Placement> {
    let mut parts = name.split('.');
    let (owner, part, last) = (parts.next()?, parts.next()?, parts.next());
    let copied = |copy| Some(Placement { copy, arm: None });
    let Some(body) = model.bodies().iter().find(|body| body.name == owner) else {
        // an internal state of a force
        return copied(model.unknown_names().iter().position(|n| n == name)?);
    };
    let coordinate = |quantity: &str, from: usize| {
        let mut slots = body.placed.x.iter().zip(&body.contents).skip(from);
        slots.find_map(|(x, content)| {
            let names = content.names();
            Some(x + names.iter().position(|n| *n == quantity)?)
        })
    };
    let axis = last.unwrap_or(part);
    let kind = &body.placed.kind;
    if is_rooted(body) && axis != "theta" {
        // in the frame of the points: a link starts at its origin, other bodies have their centre of mass there
        let length = kind.length().unwrap_or(0.0);
        let at = if part == "end" { length } else { 0.0 };
        let held = kind.hold().map(|hold| kind.points()[hold.point].at.into());
        let [root_x, root_y] = held.unwrap_or([0.5 * length, 0.0]);
        let [x, y] = [at - root_x, -root_y];
        let arm = match axis {
            "x" => [x, -y],
            _ => [y, x],
        };
        let arm = Some((coordinate("theta", 0)?, arm));
        let copy = coordinate(axis, 0)?;
        return Some(Placement { copy, arm });
    }
    copied(match (part, axis.strip_prefix("slope_")) {
        ("start", _) => coordinate(axis, 0)?,
        ("end", _) => coordinate(axis, 1)?,
        (_, _) if last.is_none() => coordinate(axis, 0)?,
        (node, slope) => {
            let node: usize = node.strip_prefix("node")?.parse().ok()?;
            let slot = 2 * node + usize::from(slope.is_some());
            coordinate(slope.unwrap_or(axis), slot)?
        }
    })
}

/// True where the coordinate of the reference is a copy of this unknown, or turns with it.
pub fn depends(model: &Model, coordinate: &str, unknown: &str) -> bool {
    let index = model
        .unknown_names()
        .iter()
        .position(|name| name == unknown);
    let placement = placement(model, coordinate);
    placement.zip(index).is_some_and(|(placement, index)| {
        placement.copy == index || placement.arm.is_some_and(|(angle, _)| angle == index)
    })
}

impl Embedding {
    /// The coordinates of a scene.
    pub fn new(reference: &ReferenceScene, model: &Model) -> Embedding {
        let placements = reference.coordinates.iter().map(|name| {
            let found = placement(model, name);
            found.unwrap_or_else(|| panic!("Looselink has no coordinate {name}"))
        });
        Embedding {
            placements: placements.collect(),
            unknowns: model.shape().unknowns,
        }
    }

    /// A state in full coordinates.
    pub fn at(&self, at: &State) -> FullState {
        let (full, n) = (self.placements.len(), self.unknowns);
        let copy =
            |x: &[f64]| DVector::from_iterator(full, self.placements.iter().map(|p| x[p.copy]));
        let zeros = || DMatrix::zeros(full, n);
        let mut state = FullState {
            q: copy(&at.q),
            v: copy(&at.v),
            a: copy(&at.a),
            jacobian: zeros(),
            v_by_q: zeros(),
            a_by_q: zeros(),
            a_by_v: zeros(),
            curvature: Vec::new(),
        };
        for (i, Placement { copy, arm }) in self.placements.iter().enumerate() {
            if *copy < n {
                state.jacobian[(i, *copy)] = 1.0;
            }
            let Some((k, [c, s])) = *arm else { continue };
            let ((sin, cos), omega, alpha) = (at.q[k].sin_cos(), at.v[k], at.a[k]);
            // and its derivatives by the angle; the third is the negative of the first
            let (turned, first) = (c * cos + s * sin, s * cos - c * sin);
            let second = -turned;
            state.q[i] += turned;
            state.v[i] += first * omega;
            state.a[i] += first * alpha + second * omega * omega;
            if k < n {
                state.jacobian[(i, k)] += first;
                state.v_by_q[(i, k)] = second * omega;
                state.a_by_q[(i, k)] = second * alpha - first * omega * omega;
                state.a_by_v[(i, k)] = 2.0 * second * omega;
                state.curvature.push((i, k, second));
            }
        }
        state
    }
}

impl FullState {
    /// J^T W.
    pub fn gather(&self, w: &DVector<f64>) -> DVector<f64> {
        self.jacobian.tr_mul(w)
    }

    /// dr/dq and dr/dv.
    pub fn tangents(
        &self,
        mass: &DMatrix<f64>,
        (f, by_q, by_v): &(DVector<f64>, DMatrix<f64>, DMatrix<f64>),
    ) -> [DMatrix<f64>; 2] {
        let j = &self.jacobian;
        let mut stiffness = j.tr_mul(&(mass * &self.a_by_q + by_q * j + by_v * &self.v_by_q));
        let w = mass * &self.a + f;
        for &(i, k, second) in &self.curvature {
            stiffness[(k, k)] += second * w[i];
        }
        [stiffness, j.tr_mul(&(mass * &self.a_by_v + by_v * j))]
    }

    /// The accelerations of the unknowns that add what is missing to these full accelerations.
    pub fn missing(&self, a: &DVector<f64>) -> DVector<f64> {
        let normal = self.jacobian.tr_mul(&self.jacobian).cholesky();
        let normal = normal.expect("every unknown moves a body");
        normal.solve(&self.gather(&(a - &self.a)))
    }
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

/// The matrix that makes Looselink's constraint rows of those of the reference: mostly the row of the same name. It is orthogonal, so
/// it does the same with multipliers. Rows that Looselink leaves out as redundant are zero.
pub fn rows(reference: &ReferenceScene, model: &Model, scene: &Scene) -> DMatrix<f64> {
    let place = |name: &str| reference.rows.iter().position(|row| row == name);
    let redundant = model.redundant();
    let names = &model.unknown_names()[model.shape().unknowns..];
    let mut rows = DMatrix::zeros(names.len(), reference.rows.len());
    for (row, looselink) in names.iter().enumerate() {
        let name = row_name(looselink);
        // a held angle is called the rotation of its joint, the angle of its drive
        let found = place(&name).or_else(|| place(&name.replace(".angle", ".rotation")));
        let known = found.is_some() != redundant.contains(looselink);
        assert!(known, "one side leaves {looselink} out");
        let Some(found) = found else { continue };
        let (owner, part) = name.split_once('.').expect("made above");
        match (part, slope_of_first_side(scene, owner)) {
            // -R(-angle) of d_2 - R(angle) r'
            ("slope_x", Some((sin, cos))) => {
                (rows[(row, found)], rows[(row, found + 1)]) = (-cos, -sin);
            }
            ("slope_y", Some((sin, cos))) => {
                (rows[(row, found - 1)], rows[(row, found)]) = (sin, -cos);
            }
            _ => rows[(row, found)] = 1.0,
        }
    }
    rows
}

/// Sine and cosine of the angle of a weld that holds the slope vector of its first side alone: Looselink turns the direction of the
/// second side to compare it with the slope, the reference turns the slope.
fn slope_of_first_side(scene: &Scene, joint: &str) -> Option<(f64, f64)> {
    let joint = scene.joints.iter().find(|j| j.name == joint)?;
    let weld = joint.model.get::<Weld>()?;
    let is_flexible = |side: PointRef| !scene.bodies[side.body].kind.is_rigid();
    let first = is_flexible(joint.bearing) && !is_flexible(joint.journal);
    (weld.slope == SlopeClamp::Vector && first).then(|| weld.angle.sin_cos())
}

/// The joint of the reference that has the memory of each contact.
pub fn contacts(reference: &ReferenceScene, model: &Model) -> Vec<usize> {
    let joint = |contact| {
        let name = &model.joints()[model.contact_joint(contact)?].name;
        reference.joints.iter().position(|joint| joint == name)
    };
    let joints = (0..model.shape().contacts).map(joint);
    let joints: Option<_> = joints.collect();
    joints.expect("joints of both sides")
}

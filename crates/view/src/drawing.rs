//! What bodies and joints look like, and where they are over time.
//!
//! A rigid body is its hull in its own frame, with the pose of the frame as a track. A flexible link is the chord between its ends,
//! as a pose and a length, and the deviation of every node and slope from the straight link in the frame of the chord: so a viewer
//! can magnify deformations that are much smaller than a pixel. The eccentricity of a loose joint, which is as small, is stored
//! apart from the poses, too.

use super::moved::{BodyShape, Moved, bounds};
use super::pack::{Pack, Packed};
use super::stored::StoredRun;
use super::tracks::{Group, Signal};
use looselink::body::{FlexibleLink, PointRef};
use looselink::interaction::{ForceModel, Joint, TorsionSpringModel};
use looselink::scene::{Analysis, NamedBody, Scene};
use serde::Serialize;
use std::f64::consts::SQRT_2;

/// Error of a point of a rigid body or of a chord, relative to the size of the mechanism: a twentieth of a pixel where it fills a
/// thousand pixels. Position, angle and length of the chord have a third each.
const POSE_ERROR: f64 = 5e-5;
/// Error of an eccentricity between kept rows, relative to the clearance c. Rounding to 16 bits adds at most
/// 2 (c + penetration)/131070 a component. The sum is below a thousandth of c as long as the penetration is below 10 c.
const ECCENTRICITY_ERROR: f64 = 5e-4;
/// Error of a deformation or contact force, relative to the largest.
const RELATIVE_ERROR: f64 = 1e-3;
/// Poses on the path of a drive.
const PATH_POSES: usize = 400;

/// A run as the viewer draws it.
#[derive(Debug, Serialize)]
pub struct RunDrawing {
    title: String,
    folder: String,
    method: String,
    status: String,
    error: Option<String>,
    overrides: Vec<String>,
    warnings: Vec<String>,
    is_static: bool,
    times: Packed,
    /// Least x and y, greatest x and y of all points over all rows \[m\].
    bounds: [f64; 4],
    bodies: Vec<DrawnBody>,
    joints: Vec<DrawnJoint>,
    forces: Vec<DrawnForce>,
    /// Where the drive leads its body, and the body.
    path: Vec<[f64; 2]>,
    driven: Option<usize>,
    channels: Vec<DrawnChannel>,
}

/// A body.
#[derive(Debug, Serialize)]
pub struct DrawnBody {
    name: String,
    /// Named points in the frame of the body \[m\].
    points: Vec<DrawnPoint>,
    shape: BodyShape,
    /// Of its frame: x, y, theta. Of a flexible link: that of the chord, and its length. None of the ground.
    pose: Option<Group>,
    /// Of a flexible link: the deviations of each node, u and w of the position, then of the slope.
    deformation: Option<Group>,
}

/// A named point.
#[derive(Debug, Serialize)]
struct DrawnPoint {
    name: String,
    at: [f64; 2],
    /// Its node, on a flexible link.
    node: Option<usize>,
}

/// A joint.
#[derive(Debug, Serialize)]
struct DrawnJoint {
    name: String,
    /// Body and point of its two sides.
    ends: [[usize; 2]; 2],
    /// How it is drawn.
    glyph: Glyph,
    clearance: Option<Clearance>,
}

/// How a joint is drawn.
#[derive(Debug, Clone, Copy, Serialize)]
#[serde(rename_all = "snake_case")]
enum Glyph {
    /// A ring.
    Revolute,
    /// A square.
    Weld,
    /// A slot in this direction, in the frame of the first body \[rad\].
    Slide(f64),
    /// A bar between two points.
    Rod,
}

/// What is known of a loose joint.
#[derive(Debug, Serialize)]
struct Clearance {
    clearance: f64,
    /// x and y \[m\].
    eccentricity: Group,
    /// Force of the bearing on the journal, x and y \[N\].
    force: Group,
}

/// A spring or a load.
#[derive(Debug, Serialize)]
struct DrawnForce {
    name: String,
    ends: Vec<[usize; 2]>,
}

/// A channel for charts.
#[derive(Debug, Serialize)]
struct DrawnChannel {
    name: String,
    unit: String,
    /// The first value; the data are differences from it.
    offset: f64,
    data: Packed,
}

impl RunDrawing {
    /// That of a run; its arrays go into the pack.
    pub fn new(run: &StoredRun, pack: &mut Pack) -> RunDrawing {
        let StoredRun { result, .. } = run;
        let scene = &result.scene;
        let bounds = bounds(run);
        let size = (bounds[2] - bounds[0]).max(bounds[3] - bounds[1]);
        let bodies = scene
            .bodies
            .iter()
            .zip(Moved::all(run))
            .map(|(named, moved)| {
                let points = named.kind.points().iter().enumerate();
                let beam = named.kind.get::<FlexibleLink>();
                DrawnBody {
                    name: named.name.clone(),
                    points: points
                        .map(|(i, point)| DrawnPoint {
                            name: point.name.clone(),
                            at: point.at.into(),
                            node: beam.map(|link| link.nodes[i]),
                        })
                        .collect(),
                    pose: pose(&moved, named, &result.times, size, pack),
                    deformation: deformation(&moved, &result.times, pack),
                    shape: moved.shape,
                }
            });
        let bodies = bodies.collect();
        let mut loose = run.layout.loose();
        let model = run.simulation.model();
        let joints = scene.joints.iter().enumerate().map(|(j, joint)| {
            let contact = joint.contact().filter(|_| model.is_loose(j));
            DrawnJoint {
                name: joint.name.clone(),
                ends: joint.points().map(end),
                glyph: glyph(joint),
                clearance: contact.and_then(|contact| {
                    let first = loose.next()?;
                    Some(Clearance::new(run, contact.clearance, first, pack))
                }),
            }
        });
        let joints = joints.collect();
        let forces = scene.forces.iter().map(|force| DrawnForce {
            name: force.name.clone(),
            ends: ends(&*force.kind, &scene.joints),
        });
        RunDrawing {
            title: scene.title.clone(),
            folder: result.name.clone(),
            method: result.method(),
            status: result.summary.status.clone(),
            error: result.summary.error.clone(),
            overrides: result.summary.overrides.clone(),
            warnings: result.summary.warnings.clone(),
            is_static: scene.simulation.analysis == Analysis::Static,
            times: pack.add(result.times.iter().copied()),
            bounds,
            bodies,
            joints,
            forces: forces.collect(),
            path: path(scene),
            driven: scene.drives.first().map(|drive| drive.body),
            channels: result
                .channels
                .iter()
                .map(|channel| DrawnChannel {
                    name: channel.name.clone(),
                    unit: channel.unit.clone(),
                    offset: channel.values[0],
                    data: pack.add(
                        channel
                            .values
                            .iter()
                            .map(|x| (x - channel.values[0]) as f32),
                    ),
                })
                .collect(),
        }
    }
}

fn end(point: PointRef) -> [usize; 2] {
    [point.body, point.point]
}

/// Where a force acts: a torsion spring at its joint.
fn ends(force: &dyn ForceModel, joints: &[Joint]) -> Vec<[usize; 2]> {
    let points = match force.get::<TorsionSpringModel>() {
        Some(spring) => joints[spring.joint].points().to_vec(),
        None => force.points(),
    };
    points.into_iter().map(end).collect()
}

fn glyph(joint: &Joint) -> Glyph {
    match (joint.model.line(), joint.model.angle()) {
        (Some(direction), _) => Glyph::Slide(direction),
        (None, Some(_)) => Glyph::Weld,
        (None, None) if joint.model.is_revolute() => Glyph::Revolute,
        (None, None) => Glyph::Rod,
    }
}

/// Positions along the path of the first drive.
fn path(scene: &Scene) -> Vec<[f64; 2]> {
    let drives = scene.drives.iter().take(1);
    let poses = drives.flat_map(|drive| {
        let (time, count) = drive.path.sweep(scene.simulation.duration);
        let count = count.clamp(1, PATH_POSES);
        (0..=count).map(move |k| drive.path.at(time * k as f64 / count as f64).position)
    });
    poses.map(|[x, y, _]| [x, y]).collect()
}

/// The poses of a body as tracks; none of what does not move.
fn pose(
    moved: &Moved,
    body: &NamedBody,
    times: &[f64],
    size: f64,
    pack: &mut Pack,
) -> Option<Group> {
    let share = POSE_ERROR * size / 3.0;
    // a named point may lie outside of the shape
    let points = body.kind.points().iter().map(|point| point.at.norm());
    let reach = points.fold(moved.shape.reach(), f64::max);
    let angle = share / reach.max(f64::MIN_POSITIVE);
    let tolerances = [share / SQRT_2, share / SQRT_2, angle, share];
    let signals = moved.pose.iter().zip(tolerances);
    let signals = signals.map(|(values, tolerance)| signal(values, tolerance));
    let signals: Vec<Signal> = signals.collect();
    (!moved.pose[0].is_empty()).then(|| Group::exact(times, &signals, pack))
}

/// The deformation of a flexible link as tracks.
fn deformation(moved: &Moved, times: &[f64], pack: &mut Pack) -> Option<Group> {
    let BodyShape::Beam { length, .. } = moved.shape else {
        return None;
    };
    // a slope moves points by a part of the length
    let lever = |i: usize| if i % 4 < 2 { 1.0 } else { length };
    let tracks = || moved.deviations.iter().enumerate();
    let sizes = tracks().map(|(i, values)| lever(i) * largest(values));
    let error = RELATIVE_ERROR / SQRT_2 * sizes.fold(0.0, f64::max);
    let signals = tracks().map(|(i, values)| signal(values, error / lever(i)));
    Some(Group::single(times, &signals.collect::<Vec<_>>(), pack))
}

fn signal(values: &[f64], tolerance: f64) -> Signal {
    Signal {
        values: values.to_vec(),
        tolerance,
    }
}

fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |m: f64, x| m.max(x.abs()))
}

impl Clearance {
    /// The four columns from `first` on.
    fn new(run: &StoredRun, clearance: f64, first: usize, pack: &mut Pack) -> Clearance {
        let column = |i: usize| -> Vec<f64> {
            let rows = run.motion.iter();
            rows.map(|row| row[first + i]).collect()
        };
        let columns = [0, 1, 2, 3].map(column);
        let strongest = largest(&columns[2]).max(largest(&columns[3]));
        let mut group = |pair: &[Vec<f64>], tolerance| {
            let signals = [0, 1].map(|i| signal(&pair[i], tolerance));
            Group::quantised(&run.result.times, &signals, pack)
        };
        Clearance {
            clearance,
            eccentricity: group(&columns[..2], ECCENTRICITY_ERROR / SQRT_2 * clearance),
            force: group(&columns[2..], RELATIVE_ERROR / SQRT_2 * strongest),
        }
    }
}

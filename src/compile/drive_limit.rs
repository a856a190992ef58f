//! Limits of drives, in words: what is in line where a drive cannot go on, and when.

use super::actuation::{Actuation, Control};
pub use super::actuation::{LossOfControl, Uncontrolled};
use super::assembly::{closed_mechanism, constraint_rows};
use super::extent::extent;
use super::locked::Locked;
use super::{Compiler, Mode, Role, is_ideal, known_roles};
use crate::body::PointRef;
use crate::kinematics::limit::{End, LOCATED, Tracer};
use crate::math::bisection::bisected;
use crate::math::generic;
use crate::math::independent_rows::IndependentRows;
use crate::model::Model;
use crate::motion::Function;
use crate::scene::{MotionKind, PrescribedMotion, Scene, SceneError};
use crate::system::State;
use numbers::number;
use std::collections::BTreeSet;
use std::f64::consts::TAU;
use std::fmt::{self, Display, Formatter};

/// A part of a generic motion below this is zero: the coordinate is determined by the drives.
const DETERMINED: f64 = 1e-9;
/// Instants at which the values of a drive are looked at, and the least number of steps of a trace in time.
const INSTANTS: usize = 10_000;
const STEPS: f64 = 100.0;
/// Largest change of a drive in a step: of an angle \[rad\], and of a coordinate as a part of the mechanism.
const CHANGE: f64 = 0.1;
/// A drive is followed by this part of its largest step beyond its end: far enough for a limit at the end to stand out from rounding.
const BEYOND: f64 = 1e-3;
/// A mechanism is back at its pose after a turn up to this part of its length.
const BACK: f64 = 1e-6;
/// Significant digits of instants and values.
const DIGITS: usize = 8;

/// The pose that a drive of the ideal rigid mechanism reaches and cannot pass.
#[derive(Debug, Clone, PartialEq)]
pub struct DriveLimit {
    /// When it is reached \[s\].
    pub t: f64,
    /// The drive: index into [`Scene::motions`].
    pub drive: usize,
    /// What the drive prescribes there: an angle \[rad\] and nothing else, or x and y \[m\].
    pub values: [Option<f64>; 2],
    /// Which bodies are in line at which joints.
    pub cause: String,
    /// What the drive prescribes, in words.
    what: String,
    /// False where links are flexible or joints have clearance: the mechanism of the scene may differ a little.
    is_exact: bool,
    /// True where the drive leads no farther than to the limit.
    is_end: bool,
}

impl Display for DriveLimit {
    fn fmt(&self, f: &mut Formatter) -> fmt::Result {
        let t = number(self.t, DIGITS);
        let DriveLimit { what, cause, .. } = self;
        let mechanism = match self.is_exact {
            true => "",
            false => " in the ideal rigid mechanism",
        };
        write!(f, "{what} at t = {t} s{mechanism}: {cause}")
    }
}

impl DriveLimit {
    /// True where the drive leads farther and the mechanism of the scene, which is the ideal rigid one, cannot follow.
    pub fn stops_the_motion(&self) -> bool {
        self.is_exact && !self.is_end
    }

    /// The limit as a fault of a scene, at its drive.
    pub fn fault(&self, scene: &Scene) -> SceneError {
        let span = scene.motions[self.drive].span;
        let error = scene.error(span, self.to_string(), "leads beyond the reach");
        error.with_help("change the lengths, or end the motion before")
    }
}

/// How far the drives of a scene lead the ideal rigid mechanism.
#[derive(Debug, Clone, PartialEq)]
pub enum DriveCourse {
    /// They determine no motion, or joints of inverse kinematics repeat others.
    Undetermined,
    /// Through the whole duration.
    Complete,
    /// To a limit. Inverse kinematics has none: its path is checked when the scene is compiled.
    Limited(Box<DriveLimit>),
    /// To an instant \[s\] after which it takes too much work to follow them.
    Cut(f64),
    /// The joints of inverse kinematics do not move the driven body along its path.
    Uncontrolled(Box<Uncontrolled>),
    /// Inverse kinematics passes a pose in which its joints do not hold the mechanism.
    LosesControl(Box<LossOfControl>),
}

impl DriveCourse {
    /// What is in doubt of a motion that comes to time t \[s\].
    pub fn doubt(&self, t: f64) -> Option<String> {
        match self {
            DriveCourse::Undetermined | DriveCourse::Complete | DriveCourse::Cut(_) => None,
            DriveCourse::Limited(limit) => (t > limit.t).then(|| limit.to_string()),
            DriveCourse::Uncontrolled(found) => Some(found.to_string()),
            DriveCourse::LosesControl(found) => found.up_to(t).map(|found| found.to_string()),
        }
    }
}

/// Follows the drives of a scene through the whole duration, in the ideal rigid mechanism, as far as they determine it.
pub fn follow(scene: &Scene) -> DriveCourse {
    if !scene.drives.is_empty() {
        let control = Actuation::of(scene).and_then(Actuation::control);
        return match control {
            None => DriveCourse::Undetermined,
            Some(Control::Kept) => DriveCourse::Complete,
            Some(Control::Missing(found)) => DriveCourse::Uncontrolled(Box::new(found)),
            Some(Control::Lost(found)) => DriveCourse::LosesControl(Box::new(found)),
        };
    }
    if scene.motions.is_empty() {
        return DriveCourse::Undetermined;
    }
    let course = match single_function(&scene.motions) {
        Some((component, function)) => by_value(scene, component, &function),
        None => by_time(scene),
    };
    course.unwrap_or(DriveCourse::Undetermined)
}

/// The function of the only drive, if it has one that changes: the pose depends on its value alone.
fn single_function(motions: &[PrescribedMotion]) -> Option<(usize, Function)> {
    let [motion] = motions else {
        return None;
    };
    match &motion.kind {
        MotionKind::Angle { angle, .. } => Some((0, angle.clone())),
        MotionKind::Point { coordinates, .. } => {
            let functions = coordinates.iter().enumerate();
            let mut changing = functions.filter_map(|(i, f)| match f.as_ref()? {
                Function::Constant(_) => None,
                f => Some((i, f.clone())),
            });
            changing.next().filter(|_| changing.next().is_none())
        }
    }
}

/// The instants at which a function has its values, turning points among them.
fn values(function: &Function, duration: f64) -> Vec<(f64, f64)> {
    let instant = |k: usize| duration * k as f64 / INSTANTS as f64;
    let mut values = vec![(0.0, function.at(0.0)[0])];
    for k in 1..=INSTANTS {
        let (from, to) = (instant(k - 1), instant(k));
        let rates = [from, to].map(|t| function.at(t)[1]);
        if rates[0] * rates[1] < 0.0 {
            let turn = bisected(from, to, |t| function.at(t)[1] * rates[0] > 0.0);
            values.push((turn, function.at(turn)[0]));
        }
        values.push((to, function.at(to)[0]));
    }
    values
}

/// With one drive the pose depends on its value alone: it is traced over the range of its values, once.
fn by_value(scene: &Scene, component: usize, function: &Function) -> Option<DriveCourse> {
    let values = values(function, scene.simulation.duration);
    let start = values[0].1;
    let [low, high] = [f64::min, f64::max].map(|pick| {
        let all = values.iter().map(|(_, value)| value - start);
        all.fold(0.0, pick)
    });
    let mut by_value = scene.clone();
    let identity = Function::Polynomial(vec![start, 1.0]);
    let is_angle = match &mut by_value.motions[0].kind {
        MotionKind::Angle { angle, .. } => {
            *angle = identity;
            true
        }
        MotionKind::Point { coordinates, .. } => {
            coordinates[component] = Some(identity);
            false
        }
    };
    let c = Compiler::new(&by_value, Mode::Ideal, known_roles(&by_value));
    let (mechanism, pose) = determined(&c)?;
    let size = extent(c.scene);
    let longest = |_: f64| if is_angle { CHANGE } else { CHANGE * size };
    let mut tracer = Tracer::new(&mechanism, size, &longest);
    let mut ends = Vec::new();
    'ends: for end in [high, low].into_iter().filter(|end| *end != 0.0) {
        let mut state = pose.clone();
        let direction = end.signum();
        // a limit at the end itself is seen from beyond
        let end = end + direction * BEYOND * longest(0.0);
        while state.t != end {
            let turns = is_angle && (end - state.t).abs() > TAU;
            let to = if turns {
                state.t + direction * TAU
            } else {
                end
            };
            match tracer.trace(&mut state, to) {
                End::Reached => state.t = to,
                End::Fold(fold, stressed) => {
                    ends.push((direction, fold.t, Some((fold, stressed))));
                    break;
                }
                End::Open => {
                    ends.push((direction, state.t, None));
                    break;
                }
            }
            if turns && is_back(&mechanism, &pose, &state, size) {
                // every value has been seen
                break 'ends;
            }
        }
    }
    // when the drive leads to a value and beyond, or no farther
    let crossing = |direction: f64, value: f64| {
        let ahead = |x: f64| (x - start - value) * direction;
        let all = values.iter().map(|(_, x)| ahead(*x));
        let farthest = all.fold(f64::NEG_INFINITY, f64::max);
        if farthest <= LOCATED * longest(0.0) {
            let is_there = |x: f64| ahead(x) >= farthest - f64::EPSILON * longest(0.0);
            let (t, _) = values.iter().find(|(_, x)| is_there(*x))?;
            return (farthest >= -LOCATED * longest(0.0)).then_some((*t, true));
        }
        let k = values.iter().position(|(_, x)| ahead(*x) > 0.0)?;
        let (from, to) = (values[k - 1].0, values[k].0);
        let t = bisected(from, to, |t| ahead(function.at(t)[0]) <= 0.0);
        Some((t, false))
    };
    let ends = ends
        .into_iter()
        .filter_map(|(direction, value, fold)| Some((crossing(direction, value)?, fold)));
    let (t, is_end, fold, stressed) = match ends.min_by(|a, b| a.0.0.total_cmp(&b.0.0)) {
        None => return Some(DriveCourse::Complete),
        Some(((t, _), None)) => return Some(DriveCourse::Cut(t)),
        Some(((t, is_end), Some((fold, stressed)))) => (t, is_end, fold, stressed),
    };
    let mut at = [None; 2];
    match &by_value.motions[0].kind {
        MotionKind::Angle { .. } => at[0] = Some(start + fold.t),
        MotionKind::Point { coordinates, .. } => {
            for (at, f) in at.iter_mut().zip(coordinates) {
                *at = f.as_ref().map(|f| f.at(fold.t)[0]);
            }
        }
    }
    let limit = limit(&c, &mechanism, &fold, &stressed, (t, 0, at));
    let limit = DriveLimit { is_end, ..limit };
    Some(DriveCourse::Limited(Box::new(limit)))
}

/// True of a pose that differs from another by full turns only.
fn is_back(mechanism: &Model, from: &State, to: &State, size: f64) -> bool {
    let lengths = mechanism.lengths();
    let mut moved = from.q.iter().zip(&to.q).zip(&lengths).enumerate();
    moved.all(|(i, ((a, b), length))| {
        let turns = mechanism.angles.contains(&i);
        let off = if turns {
            (b - a + 0.5 * TAU).rem_euclid(TAU) - 0.5 * TAU
        } else {
            b - a
        };
        (off * length).abs() <= BACK * size
    })
}

/// Several drives are followed in time.
fn by_time(scene: &Scene) -> Option<DriveCourse> {
    let duration = scene.simulation.duration;
    let c = Compiler::new(scene, Mode::Ideal, known_roles(scene));
    let (mechanism, mut state) = determined(&c)?;
    let size = extent(c.scene);
    let functions: Vec<(&Function, f64)> = (scene.motions.iter())
        .flat_map(|motion| match &motion.kind {
            MotionKind::Angle { angle, .. } => vec![(angle, CHANGE)],
            MotionKind::Point { coordinates, .. } => coordinates
                .iter()
                .flatten()
                .map(|f| (f, CHANGE * size))
                .collect(),
        })
        .collect();
    let longest = |t: f64| {
        let steps = functions.iter().map(|(f, change)| {
            let [_, rate, growth] = f.at(t).map(f64::abs);
            2.0 * change / (rate + (rate * rate + 2.0 * growth * change).sqrt())
        });
        steps.fold(duration / STEPS, f64::min)
    };
    let mut tracer = Tracer::new(&mechanism, size, &longest);
    let (fold, stressed) = match tracer.trace(&mut state, duration) {
        End::Reached => return Some(DriveCourse::Complete),
        End::Open => return Some(DriveCourse::Cut(state.t)),
        End::Fold(fold, stressed) => (fold, stressed),
    };
    let moved: BTreeSet<usize> = (stressed.iter())
        .flat_map(|&k| mechanism.constraints[k].owners.iter().copied())
        .collect();
    let touches = |p: PointRef| {
        let partners = (0..c.bodies[p.body].points().len()).flat_map(|point| {
            let point = PointRef {
                body: p.body,
                point,
            };
            c.joints_at(point).iter().map(|(_, partner)| partner.body)
        });
        moved.contains(&p.body) || partners.into_iter().any(|body| moved.contains(&body))
    };
    let is_near = |motion: &PrescribedMotion| match motion.kind {
        MotionKind::Angle { joint, .. } => {
            let points = c.scene.joints[joint].points().into_iter();
            let mut moving = points.filter(|p| c.roles[p.body] != Role::Ground);
            moving.any(touches)
        }
        MotionKind::Point { point, .. } => touches(point),
    };
    let drive = scene.motions.iter().position(is_near).unwrap_or(0);
    let at = match &scene.motions[drive].kind {
        MotionKind::Angle { angle, .. } => [Some(angle.at(fold.t)[0]), None],
        MotionKind::Point { coordinates, .. } => [0, 1].map(|i| {
            let f = coordinates[i].as_ref()?;
            Some(f.at(fold.t)[0])
        }),
    };
    let t = fold.t;
    let limit = DriveLimit {
        is_end: duration - t <= LOCATED * longest(duration),
        ..limit(&c, &mechanism, &fold, &stressed, (t, drive, at))
    };
    Some(DriveCourse::Limited(Box::new(limit)))
}

/// The ideal mechanism at t = 0, without the constraints of what moves freely and without redundant ones; `None` where the drives
/// determine nothing, or where the mechanism does not close.
fn determined(c: &Compiler) -> Option<(Model, State)> {
    let (mut mechanism, state) = closed_mechanism(c).ok()?;
    let n = mechanism.shape().unknowns;
    let rows = constraint_rows(&mechanism, &state);
    let independent = IndependentRows::homogeneous(n, &rows);
    let direction: Vec<f64> = (0..n).map(generic).collect();
    let moves: Vec<bool> = (independent.free_part(&direction).iter())
        .map(|x| x.abs() > DETERMINED)
        .collect();
    let places = mechanism.constraints.iter().enumerate();
    let places: Vec<_> = places
        .flat_map(|(k, placed)| (0..placed.rows).map(move |d| (k, d)))
        .collect();
    let is_left_out = |k: &usize| {
        let is_redundant = independent.dependent.binary_search(k).is_ok();
        // a body that turns freely about its pin has no part in it
        is_redundant || rows[*k].iter().any(|(i, g)| *g != 0.0 && moves[*i])
    };
    let left_out: Vec<_> = (0..rows.len())
        .filter(is_left_out)
        .map(|k| places[k])
        .collect();
    let determined = moves.iter().filter(|moves| !**moves).count();
    if determined == 0 || rows.len() - left_out.len() != determined {
        return None;
    }
    mechanism.drop_rows(&left_out);
    Some((mechanism, state))
}

/// A limit in words.
fn limit(
    c: &Compiler,
    mechanism: &Model,
    pose: &State,
    stressed: &[usize],
    (t, drive, values): (f64, usize, [Option<f64>; 2]),
) -> DriveLimit {
    let name = &c.scene.motions[drive].name;
    let what = match &c.scene.motions[drive].kind {
        MotionKind::Angle { joint, .. } => {
            let joint = &c.scene.joints[*joint].name;
            let angle = values[0].unwrap_or_default();
            format!(
                "drive {name} cannot turn joint {joint} beyond {} rad ({} degrees), which it reaches",
                number(angle, DIGITS),
                number(angle.to_degrees(), DIGITS - 2)
            )
        }
        MotionKind::Point { point, .. } => {
            let at = ["x", "y"]
                .iter()
                .zip(values)
                .filter_map(|(axis, value)| Some(format!("{axis} = {} m", number(value?, DIGITS))));
            format!(
                "drive {name} cannot move {} beyond {}, which it reaches",
                c.point_name(*point),
                at.collect::<Vec<_>>().join(", ")
            )
        }
    };
    let owners = stressed
        .iter()
        .flat_map(|&k| mechanism.constraints[k].owners.iter().copied());
    DriveLimit {
        t,
        drive,
        values,
        cause: Locked::at(c, mechanism, pose, owners).in_words(),
        what,
        is_exact: is_ideal(c.scene),
        is_end: false,
    }
}

//! `[drives]` and `[initial]`.

use super::{
    BodyState, Drive, GivenVelocity, Initial, Journals, MotionKind, PrescribedMotion, Rest,
    SketchPoint, Sketched,
};
use crate::body::{Body, Deformation, Known, PointRef, RigidBody};
use crate::document::{Field, Fields, Key, Kind, NumberRange, SceneError, Takes, named};
use crate::interaction::Names;
use crate::math::plane::{Vec2, pair, quarter_turn, unit};
use crate::motion::{Use, read_path};
use indexmap::IndexMap;
use std::collections::HashMap;

/// What drives prescribe.
#[derive(Default)]
pub(super) struct Drives {
    /// By inverse kinematics.
    pub kinematics: Vec<Drive>,
    /// Directly.
    pub motions: Vec<PrescribedMotion>,
    /// The joints that are driven already, and the keys that say so.
    joints: HashMap<usize, String>,
}

/// A kind of drive. `read` adds the drive to those read before.
pub(super) type DriveKind = Kind<fn(&Fields, &Names, &mut Drives) -> Result<(), SceneError>>;

/// The kinds of drive that a scene can name.
pub(super) static KINDS: [&DriveKind; 3] = [&INVERSE_KINEMATICS, &ANGLE, &POINT];

static INVERSE_KINEMATICS: DriveKind = DriveKind {
    name: "inverse_kinematics",
    keys: &[
        Key::new(
            "joints",
            Takes::List,
            "the list of the actuated joints, all of them revolute",
        ),
        Key::name_in(
            "body",
            "bodies",
            "the driven body, of type `\"rigid_body\"`",
        ),
        Key::new(
            "path",
            Takes::Path,
            "the path of its centre of mass and its angle, see [Paths](#paths)",
        ),
    ],
    read: inverse_kinematics,
};

static ANGLE: DriveKind = DriveKind {
    name: "angle",
    keys: &[
        Key::name_in("joint", "joints", "the name of a revolute joint"),
        Key::function("angle", "rad", "the angle, without kinks"),
    ],
    read: |table, names, drives| {
        let name = table.field("joint")?;
        let joint = actuated(&name, names, &mut drives.joints)?;
        for side in names.joints[joint].points() {
            names.check_turns(&name, side)?;
        }
        let angle = names.functions.read(&table.field("angle")?, Use::Motion)?;
        drives.prescribe(table, MotionKind::Angle { joint, angle });
        Ok(())
    },
};

static POINT: DriveKind = DriveKind {
    name: "point",
    keys: &[
        Key::point("point", "the point"),
        Key::function("x", "m", "x, without kinks").or("free"),
        Key::function("y", "m", "y, without kinks").or("free; one of the two is needed"),
    ],
    read: |table, names, drives| {
        let point_field = table.field("point")?;
        let point = names.point(&point_field)?;
        let (name, body) = names.bodies.get_index(point.body).expect("it is there");
        if body.known().is_some() {
            let message = format!(
                "the motion of {name} is known at every time, so its points cannot be driven"
            );
            return Err(point_field.fault(message, "not a free body"));
        }
        let coordinate = |key| {
            let field = table.optional(key);
            let read = field.map(|f| names.functions.read(&f, Use::Motion));
            read.transpose()
        };
        let coordinates = [coordinate("x")?, coordinate("y")?];
        if coordinates.iter().all(Option::is_none) {
            let message = format!("`{}` prescribes neither x nor y", table.path());
            return Err(table.fault(message, "needs `x`, `y` or both"));
        }
        drives.prescribe(table, MotionKind::Point { point, coordinates });
        Ok(())
    },
};

impl Drives {
    /// `[drives]`
    pub fn read(root: &Fields, names: &Names) -> Result<Drives, SceneError> {
        let mut drives = Drives::default();
        named(root.optional("drives"), |field| {
            let (kind, table) = Kind::of(field, "drive", &KINDS)?;
            (kind.read)(&table, names, &mut drives)
        })?;
        Ok(drives)
    }

    /// Adds a motion that is prescribed directly.
    fn prescribe(&mut self, drive: &Fields, kind: MotionKind) {
        self.motions.push(PrescribedMotion {
            name: drive.whole.name.clone(),
            span: drive.whole.span(),
            kind,
        });
    }
}

/// The revolute joint that a field names, driven for the first time.
fn actuated(
    field: &Field,
    names: &Names,
    driven: &mut HashMap<usize, String>,
) -> Result<usize, SceneError> {
    let index = names.revolute(field, ", so a drive cannot turn it")?;
    if let Some(first) = driven.insert(index, field.path.clone()) {
        let message = format!(
            "the joint `{}` is driven twice, by `{first}` and `{}`",
            names.joints[index].name, field.path
        );
        let error = field.fault(message, "a second time");
        return Err(error.with_help("remove one of the two"));
    }
    Ok(index)
}

fn inverse_kinematics(
    table: &Fields,
    names: &Names,
    drives: &mut Drives,
) -> Result<(), SceneError> {
    let list = table.field("joints")?;
    let mut joints = Vec::new();
    for item in list.items()? {
        joints.push(actuated(&item, names, &mut drives.joints)?);
    }
    if joints.is_empty() {
        return Err(list.fault(format!("`{}` names no joint", list.path), "empty"));
    }
    let body_field = table.field("body")?;
    let (body, found) = body_field.lookup("body", names.bodies)?;
    if found.get::<RigidBody>().is_none() {
        let path = &body_field.path;
        let message = format!("`{path}` must be a body of type \"rigid_body\"");
        return Err(body_field.fault(message, "not a rigid body"));
    }
    let path_field = table.field("path")?;
    drives.kinematics.push(Drive {
        name: table.whole.name.clone(),
        span: table.whole.span(),
        joints,
        body,
        path: read_path(&path_field, names.functions)?,
        path_span: path_field.span(),
    });
    Ok(())
}

/// The keys of `[initial]`.
pub(super) static INITIAL: [Key; 5] = [
    Key::table(
        "sketch",
        "approximate positions of joints, `JOINT = [x, y]`, and of points, `BODY = { POINT = [x, y] }`: they choose the branch [m]",
    )
    .or("none"),
    Key::table("bodies", "states of bodies, `BODY = { ... }`").or("none"),
    Key::table("velocities", "single velocities, `BODY = { ... }`").or("none"),
    Key::new(
        "equilibrium",
        Takes::BooleanOr(&["nearest"]),
        "true: the motion starts at rest in the equilibrium that is reached downhill, under the loads at t = 0; `\"nearest\"`: in the nearest one, stable or not",
    )
    .or("false"),
    Key::word(
        "journals",
        &["centred", "pressed"],
        "where the assembly puts the journals of joints with clearance: in the middle of their bearings, or against them",
    )
    .or("`\"centred\"`"),
];

const POSE: [&str; 3] = ["x", "y", "theta"];
const RATES: [&str; 3] = ["vx", "vy", "omega"];
const WITH_ONE: &str = "required with one of them";
const VELOCITY: &str = "a velocity of the centre of mass";
const ALL_THREE: &str = "a velocity of the centre of mass; give all three or none";

/// The keys of a state of a body.
pub(super) static STATE: [Key; 7] = [
    Key::new(
        "point",
        Takes::Text,
        "the point of the body that `x`, `y`, `vx` and `vy` are those of",
    )
    .or("the centre of mass"),
    Key::number("x", "m", "x of the centre of mass"),
    Key::number("y", "m", "y of the centre of mass"),
    Key::number(
        "theta",
        "rad",
        "the angle; of a link the direction from `start` to `end`",
    ),
    Key::number("vx", "m/s", ALL_THREE).or(WITH_ONE),
    Key::number("vy", "m/s", ALL_THREE).or(WITH_ONE),
    Key::number(
        "omega",
        "rad/s",
        "the angular velocity; give all three or none",
    )
    .or(WITH_ONE),
];

/// The keys that a state of a link has beside those.
pub(super) static DEFORMED: [Key; 2] = [
    Key::within(
        "strain",
        NumberRange::Within(-0.5, 1.0),
        "the axial strain (r'.r' - 1)/2 along the whole link; a rigid link ignores it",
    )
    .or("0"),
    Key::number(
        "bending_rate",
        "1/(m s)",
        "the rate of r'' across the link, equal along it; a rigid link ignores it",
    )
    .or("0"),
];

/// The keys of a state of a point mass, which has no angle.
pub(super) static POINT_STATE: [Key; 4] = [
    Key::number("x", "m", "x of the point mass"),
    Key::number("y", "m", "y of the point mass"),
    Key::number("vx", "m/s", "a velocity; give both or none").or(WITH_ONE),
    Key::number("vy", "m/s", "a velocity; give both or none").or(WITH_ONE),
];

/// The keys of an entry of `[initial.velocities]`.
pub(super) static VELOCITIES: [Key; 3] = [
    Key::number("vx", "m/s", VELOCITY).or("not given"),
    Key::number("vy", "m/s", VELOCITY).or("not given"),
    Key::number(
        "omega",
        "rad/s",
        "the angular velocity, which a point mass does not have",
    )
    .or("not given"),
];

pub(super) fn initial(root: &Fields, names: &Names) -> Result<Initial, SceneError> {
    let Some(field) = root.optional("initial") else {
        return Ok(Initial {
            sketch: Vec::new(),
            bodies: IndexMap::new(),
            velocities: Vec::new(),
            equilibrium: None,
            journals: Journals::default(),
            span: root.whole.span(),
        });
    };
    let mut table = field.fields()?;
    table.declare(&[], &INITIAL)?;
    let sketch = named(table.optional("sketch"), |field| sketched(field, names))?;
    let states = named(table.optional("bodies"), |field| state(field, names))?;
    let velocities = named(table.optional("velocities"), |field| {
        velocities(field, names)
    })?;
    Ok(Initial {
        sketch: sketch.into_values().flatten().collect(),
        bodies: states
            .into_values()
            .map(|state| (state.body, state))
            .collect(),
        velocities: velocities.into_values().flatten().collect(),
        equilibrium: match table.optional("equilibrium") {
            None => None,
            Some(field) => match field.boolean_or_word()? {
                Ok(true) => Some(Rest::Stable),
                Ok(false) => None,
                Err(_) => Some(Rest::Nearest),
            },
        },
        journals: match table.optional_word("journals")? {
            Some(1) => Journals::Pressed,
            _ => Journals::Centred,
        },
        span: field.span(),
    })
}

/// `sketch.JOINT = [x, y]` or `sketch.BODY = { POINT = [x, y], ... }`
fn sketched(field: &Field, names: &Names) -> Result<Vec<SketchPoint>, SceneError> {
    let sketch = |field: &Field, what| {
        let (at, span) = (field.numbers::<2>("[x, y]")?.into(), field.span());
        Ok(SketchPoint { what, at, span })
    };
    if let Some(joint) = names.joints.get_index_of(&field.name) {
        return Ok(vec![sketch(field, Sketched::Joint(joint))?]);
    }
    let Some((body, _, found)) = names.bodies.get_full(&field.name) else {
        let known = names.joints.keys().chain(names.bodies.keys());
        let known = known.map(String::as_str);
        return Err(field.dangling_key("joint or body", known));
    };
    if found.known().is_some() {
        let message = format!(
            "the position of `{}` is known at every time; a sketch cannot change it",
            field.name
        );
        return Err(field.key_fault(message, "remove this"));
    }
    if !field.is_table() {
        let message = format!("`{}` is a body: the sketch places its points", field.name);
        let help = format!("write `{} = {{ POINT = [x, y] }}`", field.name);
        return Err(field.fault(message, "of which point?").with_help(help));
    }
    let own = || found.points().iter().map(|p| p.name.as_str());
    let points = named(Some(field.clone()), |point| {
        let Some(index) = own().position(|name| name == point.name) else {
            let kind = format!("point of `{}` called", field.name);
            return Err(point.dangling_key(&kind, own()));
        };
        sketch(point, Sketched::Point(PointRef { body, point: index }))
    })?;
    Ok(points.into_values().collect())
}

/// `velocities.BODY = { vx, vy, omega }`, any of them.
fn velocities(field: &Field, names: &Names) -> Result<Vec<GivenVelocity>, SceneError> {
    let body = moving_body(field, names)?;
    let mut table = field.fields()?;
    table.declare(&[], &VELOCITIES)?;
    let mut given = Vec::new();
    for (component, key) in RATES.into_iter().enumerate() {
        if let Some(value) = table.optional(key) {
            if component == 2 && !names.bodies[body].turns() {
                let message = format!("`{}` is a point mass and does not turn", field.name);
                return Err(value.key_fault(message, "remove this"));
            }
            given.push(GivenVelocity {
                body,
                component,
                value: value.number()?,
                span: value.span(),
            });
        }
    }
    if given.is_empty() {
        let path = &field.path;
        let message = format!("`{path}` gives none of the velocities vx, vy and omega");
        return Err(field.key_fault(message, "empty"));
    }
    Ok(given)
}

/// The body that a key names, one that has a state of its own.
fn moving_body(field: &Field, names: &Names) -> Result<usize, SceneError> {
    let Some((body, name, found)) = names.bodies.get_full(&field.name) else {
        let known = names.bodies.keys().map(String::as_str);
        return Err(field.dangling_key("body", known));
    };
    let (message, label) = match found.known() {
        None => return Ok(body),
        Some(Known::Fixed) => (
            format!("`{name}` is the ground and has no initial state"),
            "does not move",
        ),
        Some(Known::Path(_)) => (
            format!("`{name}` follows its path, so it cannot be given an initial state"),
            "prescribed",
        ),
    };
    Err(field.key_fault(message, label))
}

fn state(field: &Field, names: &Names) -> Result<BodyState, SceneError> {
    let body = moving_body(field, names)?;
    let kind = &names.bodies[body];
    let turns = kind.turns();
    let mut table = field.fields()?;
    let keys: &[Key] = if turns { &STATE } else { &POINT_STATE };
    let deformed: &[Key] = if kind.link().is_some() {
        &DEFORMED
    } else {
        &[]
    };
    table.declare(&[], keys.iter().chain(deformed))?;
    let components = if turns { 3 } else { 2 };
    let velocity_given = RATES[..components]
        .iter()
        .any(|key| table.optional(key).is_some());
    let (mut position, mut velocity) = ([0.0; 3], [0.0; 3]);
    for component in 0..components {
        position[component] = table.number(POSE[component])?;
    }
    for component in (0..components).filter(|_| velocity_given) {
        velocity[component] = table.number(RATES[component])?;
    }
    let or_zero = |key| table.optional_number(key).map(Option::unwrap_or_default);
    let deformation = match kind.is_rigid() {
        true => Deformation::default(),
        false => Deformation {
            strain: or_zero("strain")?,
            bending_rate: or_zero("bending_rate")?,
        },
    };
    if turns && let Some(named) = table.optional("point") {
        let [from_centre, rate] = off_centre(&named, &**kind, &deformation, position, velocity)?;
        for i in 0..2 {
            position[i] -= from_centre[i];
            velocity[i] -= rate[i];
        }
    }
    Ok(BodyState {
        body,
        position,
        velocity,
        velocity_given,
        deformation,
        span: field.span(),
    })
}

/// The vector from the centre of mass of a body to the point that a field names, and its rate.
fn off_centre(
    named: &Field,
    kind: &dyn Body,
    deformation: &Deformation,
    [.., theta]: [f64; 3],
    [.., omega]: [f64; 3],
) -> Result<[Vec2; 2], SceneError> {
    let name = named.text()?;
    let own = || kind.points().iter().map(|p| p.name.as_str());
    let Some(point) = kind.points().iter().find(|p| p.name == name) else {
        return Err(named.dangling("point of the body called", name, own()));
    };
    // in the axes of the body
    let origin = pair(&kind.frame([0.0; 3], [0.0; 3]).position, 0);
    let undeformed = origin + point.at;
    let along = deformation.stretch() * undeformed;
    let length = kind.link().map_or(0.0, |link| link.length);
    let [bending, _] = deformation.bending(length, undeformed.x);
    let (e, n) = (unit(theta), quarter_turn(unit(theta)));
    let arm = along.x * e + along.y * n;
    Ok([arm, omega * quarter_turn(arm) + bending * n])
}

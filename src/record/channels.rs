//! The names of all channels of a mechanism, and the parts of it that they are measured from.

use super::Ledger;
use crate::body::Strain;
use crate::model::Model;
use crate::scene::Analysis;
use crate::system::{State, Work};
use std::collections::HashSet;

/// A recorded quantity.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Channel {
    /// The name in the scene and in the header.
    pub name: String,
    /// The unit.
    pub unit: &'static str,
}

/// Names and units of quantities.
pub(super) type Quantities = [(&'static str, &'static str)];

const POSE: [(&str, &str); 9] = [
    ("x", "m"),
    ("y", "m"),
    ("theta", "rad"),
    ("vx", "m/s"),
    ("vy", "m/s"),
    ("omega", "rad/s"),
    ("ax", "m/s2"),
    ("ay", "m/s2"),
    ("alpha", "rad/s2"),
];
/// Indices of the quantities of a pose that a point has.
const POINT: [usize; 6] = [0, 1, 3, 4, 6, 7];
const FORCE: &Quantities = &[("fx", "N"), ("fy", "N"), ("force", "N")];
const GAP: &Quantities = &[
    ("ex", "m"),
    ("ey", "m"),
    ("eccentricity", "m"),
    ("penetration", "m"),
    ("ex_rate", "m/s"),
    ("ey_rate", "m/s"),
    ("eccentricity_rate", "m/s"),
    ("contact", "1"),
];
const STRAIN: &Quantities = &[("strain", "1")];
const SLOPE: &Quantities = &[("slope_x", "1"), ("slope_y", "1")];
const TURNED: &Quantities = &[
    ("angle", "rad"),
    ("speed", "rad/s"),
    ("acceleration", "rad/s2"),
];
const TRAVEL: &Quantities = &[("travel", "m"), ("travel_rate", "m/s")];
pub(super) const ACTUATOR: &Quantities = &[
    ("angle", "rad"),
    ("speed", "rad/s"),
    ("acceleration", "rad/s2"),
    ("torque", "N m"),
];

/// How an energy is read from a ledger.
type Term = fn(&Ledger) -> f64;
/// Energies that a state has.
const STORED: [(&str, Term); 6] = [
    ("kinetic", |l| l.stored.kinetic),
    ("axial", |l| l.stored.axial),
    ("bending", |l| l.stored.bending),
    ("contact", |l| l.stored.contact),
    ("gravity", |l| l.stored.gravity),
    ("springs", |l| l.stored.springs),
];
/// Energies that a motion has: a load path has no balance of powers. Entries that only some mechanisms have stand before the last one.
const BALANCE: [(&str, Term); 5] = [
    ("work", |l| l.work),
    ("contact_dissipated", |l| l.contact_dissipated),
    ("friction_dissipated", |l| l.friction_dissipated),
    ("damping_dissipated", |l| l.damping_dissipated),
    ("clamp", |l| l.clamp),
];

/// What is measured together.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Part {
    Time,
    /// Of a body.
    Pose(usize),
    Strain(usize),
    /// Of a driven body: the distance from its prescribed pose.
    Error(usize),
    /// Of a joint.
    Force(usize),
    Gap(usize),
    Turned(usize),
    Couple(usize),
    States(usize),
    Travel(usize),
    Actuator(usize),
    /// Of a point of a body.
    Point(usize, usize),
    Slope(usize, usize),
    /// A named force.
    Applied(usize),
    Stored,
    Balance,
}

/// All parts of a mechanism, in the order of their channels.
pub(super) fn parts(model: &Model, analysis: Analysis) -> Vec<Part> {
    let mut parts = vec![Part::Time];
    let mut add = |present: bool, part: Part| parts.extend(present.then_some(part));
    for (b, body) in model.bodies().iter().enumerate() {
        add(body.moves, Part::Pose(b));
        add(!body.placed.kind.is_rigid(), Part::Strain(b));
        add(body.prescribed.is_some(), Part::Error(b));
    }
    for (j, joint) in model.joints().iter().enumerate() {
        let couple = joint.terms.couple.is_some();
        add(true, Part::Force(j));
        add(model.is_loose(j), Part::Gap(j));
        add(!model.joints()[j].states.is_empty(), Part::States(j));
        add(couple && joint.terms.turned.is_some(), Part::Turned(j));
        add(couple, Part::Couple(j));
        add(joint.terms.slide.is_some(), Part::Travel(j));
        add(joint.actuator.is_some(), Part::Actuator(j));
    }
    for (b, body) in model.bodies().iter().enumerate() {
        for (p, point) in body.points.iter().enumerate() {
            add(true, Part::Point(b, p));
            add(point.slope.is_some(), Part::Slope(b, p));
        }
    }
    for f in model.named_forces() {
        add(true, Part::Applied(f));
    }
    add(true, Part::Stored);
    add(analysis == Analysis::Dynamic, Part::Balance);
    parts
}

/// The channels that a mechanism would have if a rigid body of it were flexible, or an ideal joint loose: another model of these must not
/// ask for other channels.
pub(super) struct Removed<'m> {
    /// The bodies that move, their points by the names of both, and the joints.
    bodies: HashSet<&'m str>,
    points: HashSet<(&'m str, &'m str)>,
    joints: HashSet<&'m str>,
}

impl Removed<'_> {
    pub fn of(model: &Model) -> Removed<'_> {
        let bodies = || model.bodies().iter().filter(|body| body.moves);
        let points = bodies().flat_map(|body| {
            let points = body.points.iter();
            points.map(|point| (&*body.name, &*point.name))
        });
        Removed {
            bodies: bodies().map(|body| &*body.name).collect(),
            points: points.collect(),
            joints: model.joints().iter().map(|joint| &*joint.name).collect(),
        }
    }

    /// Why the mechanism does not have a channel of this name; none where no model of it has.
    pub fn reason(&self, name: &str) -> Option<String> {
        let (owner, quantity) = name.rsplit_once('.')?;
        let is_one_of =
            |quantities: &Quantities| quantities.iter().any(|(name, _)| *name == quantity);
        let point = owner.strip_prefix("points.");
        let (body, is_removed) = match point.and_then(|point| point.split_once('.')) {
            Some(point) => (point.0, self.points.contains(&point) && is_one_of(SLOPE)),
            None => (owner, self.bodies.contains(owner) && is_one_of(STRAIN)),
        };
        if is_removed {
            return Some(format!("{body} is rigid"));
        }
        (self.joints.contains(owner) && is_one_of(GAP))
            .then(|| format!("the joint {owner} has no clearance"))
    }
}

/// Energies that a mechanism stores.
fn stored(model: &Model) -> &'static [(&'static str, Term)] {
    match model.has_springs() {
        true => &STORED,
        false => &STORED[..5],
    }
}

impl Part {
    /// Its channels.
    pub fn channels(self, model: &Model) -> Vec<Channel> {
        let named = |owner: &str, quantities: &Quantities| {
            let channels = quantities.iter().map(|(name, unit)| Channel {
                name: format!("{owner}.{name}"),
                unit,
            });
            channels.collect()
        };
        let body = |b: usize, quantities| named(&model.bodies()[b].name, quantities);
        let joint = |j: usize, quantities| named(&model.joints()[j].name, quantities);
        let point = |b: usize, p: usize, quantities: &Quantities| {
            let body = &model.bodies()[b];
            let owner = format!("points.{}.{}", body.name, body.points[p].name);
            named(&owner, quantities)
        };
        let energies = |terms: &[(&'static str, Term)]| {
            let quantities: Vec<_> = terms.iter().map(|(name, _)| (*name, "J")).collect();
            named("energy", &quantities)
        };
        match self {
            Part::Time => vec![Channel {
                name: "t".to_owned(),
                unit: "s",
            }],
            Part::Pose(b) => body(b, &POSE),
            Part::Strain(b) => body(b, STRAIN),
            Part::Error(_) => named("error", &POSE[..3]),
            Part::Force(j) => joint(j, FORCE),
            Part::Gap(j) => joint(j, GAP),
            Part::Turned(j) => joint(j, TURNED),
            Part::Couple(j) => joint(j, &[("torque", "N m")]),
            Part::States(j) => {
                let states = model.joints()[j].states.iter();
                let states = states.map(|x| &model.states[x - model.state_indices().start]);
                let named = states.map(|state| (state.name, state.unit));
                joint(j, &named.collect::<Vec<_>>())
            }
            Part::Travel(j) => joint(j, TRAVEL),
            Part::Actuator(j) => joint(j, ACTUATOR),
            Part::Point(b, p) => point(b, p, &POINT.map(|i| POSE[i])),
            Part::Slope(b, p) => point(b, p, SLOPE),
            Part::Applied(f) => {
                let (name, force) = model.named_force(f);
                named(name, force.quantities())
            }
            Part::Stored => energies(stored(model)),
            Part::Balance => {
                let names = BALANCE.iter().map(|(name, _)| *name);
                let others = model.ledger[BALANCE.len()..].iter().map(|entry| entry.name);
                let all = names.chain(others).chain(["numerical"]);
                named("energy", &all.map(|name| (name, "J")).collect::<Vec<_>>())
            }
        }
    }

    /// Places of its angle, which is known up to full turns, and of its speed.
    pub fn turning(self) -> Option<[usize; 2]> {
        match self {
            Part::Pose(_) => Some([2, 5]),
            Part::Turned(_) | Part::Actuator(_) => Some([0, 1]),
            _ => None,
        }
    }

    /// Appends its values at a consistent state, in the order of its channels.
    pub fn measure(
        self,
        model: &Model,
        at: &State,
        ledger: &Ledger,
        strains: &[Strain],
        work: &mut Work,
        values: &mut Vec<f64>,
    ) {
        let joint = |j: usize| &model.joints()[j];
        match self {
            Part::Time => values.push(at.t),
            Part::Pose(b) => {
                let pose = model.pose(b, at);
                let levels = [pose.position, pose.velocity, pose.acceleration];
                values.extend(levels.as_flattened());
            }
            Part::Strain(b) => values.push(strains[b].axial),
            Part::Error(b) => {
                let prescribed = model.prescribed(b, at).unwrap_or_default().position;
                let position = model.pose(b, at).position.into_iter();
                values.extend(position.zip(prescribed).map(|(x, expected)| x - expected));
            }
            Part::Force(j) => {
                let force = model.joint_force(j, at, work);
                values.extend([force.x, force.y, force.norm()]);
            }
            Part::Gap(j) => {
                let (gap, rate, closed) = model.gap(j, at).unwrap_or_default();
                let touches = f64::from(u8::from(closed && gap.delta > 0.0));
                values.extend(&gap.e);
                values.extend([gap.eccentricity, gap.delta]);
                values.extend(&gap.e_dot);
                values.extend([rate, touches]);
            }
            Part::Turned(j) => values.extend(model.turned(j, at)),
            Part::Couple(j) => values.push(model.joint_couple(j, at, work)),
            Part::States(j) => values.extend(joint(j).states.iter().map(|x| at.v[*x])),
            Part::Travel(j) => {
                let slide = joint(j).terms.slide.iter();
                values.extend(slide.flat_map(|slide| slide.travel(at)));
            }
            Part::Actuator(j) => {
                let actuator = joint(j).actuator.iter();
                values.extend(actuator.flat_map(|actuator| model.actuator(actuator, at, work)));
            }
            Part::Point(b, p) => values.extend(model.point(b, p, at).iter().flatten()),
            Part::Slope(b, p) => {
                let slope = model.bodies()[b].points[p].slope;
                values.extend(slope.iter().flat_map(|x| [at.q[*x], at.q[x + 1]]));
            }
            Part::Applied(f) => {
                let (_, force) = model.named_force(f);
                values.extend(&force.measure(at)[..force.quantities().len()]);
            }
            Part::Stored => values.extend(stored(model).iter().map(|(_, term)| term(ledger))),
            Part::Balance => {
                values.extend(BALANCE.iter().map(|(_, term)| term(ledger)));
                values.extend(ledger.others.values());
                values.push(ledger.numerical);
            }
        }
    }
}

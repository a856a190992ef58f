//! Newton's law from the outside: recorded forces on every body against its mass and recorded acceleration, and the momentum
//! of what flies freely. Rows are consistent at the acceleration level, whatever the scheme.

use super::run::{Breach, RandomRun, breach};
use looselink::body::{Body, FlexibleLink, Known, RigidBody, RigidLink};
use looselink::interaction::{PointForceModel, SpringDamperModel, TorqueModel, TorsionSpringModel};
use looselink::math::plane::Vec2;
use looselink::scene::{PointRef, Scene};

/// Error of a sum of forces over the largest force of the row: a linear solve of equations whose masses differ by up to six
/// decades, without row exchanges as long as no pivot is weak.
const FORCES: f64 = 1e-8;
/// Change of the momentum over the sum of its parts: every stage conserves it to the rounding of such a solve.
const MOMENTUM: f64 = 1e-9;

/// Mass of a body \[kg\].
pub fn mass(kind: &dyn Body) -> f64 {
    kind.mass().unwrap_or(0.0)
}

/// Moment of inertia about the centre of mass \[kg m2\] of a body that does not bend.
pub fn inertia(kind: &dyn Body) -> Option<f64> {
    if let Some(rigid) = kind.get::<RigidBody>() {
        return Some(rigid.inertia);
    }
    match kind.get::<RigidLink>() {
        Some(RigidLink { link, .. }) => Some(mass(kind) * link.length.powi(2) / 12.0),
        None => (!kind.turns()).then_some(0.0),
    }
}

/// Sum of the axial stiffnesses of flexible links, and of stiffness times `extent` \[m\] of springs \[N\]: their forces are
/// rounded relative to it.
pub fn stiffness(scene: &Scene, extent: f64) -> f64 {
    let links = scene.bodies.iter().filter_map(|b| b.kind.get());
    let links = links.map(|link: &FlexibleLink| link.youngs_modulus * link.link.area);
    let springs = scene.forces.iter().map(|f| {
        let straight = f.kind.get::<SpringDamperModel>();
        let torsion = f.kind.get::<TorsionSpringModel>();
        straight.map_or(0.0, |s| s.stiffness * extent)
            + torsion.map_or(0.0, |s| s.stiffness / extent)
    });
    links.sum::<f64>() + springs.sum::<f64>()
}

/// Damping proportional to mass \[1/s\].
fn mass_damping(kind: &dyn Body) -> f64 {
    let damping = kind.get::<FlexibleLink>().and_then(|link| link.damping);
    damping.map_or(0.0, |damping| damping.mass)
}

/// The channels `<name>.<x>` and `<name>.<y>` in a row.
fn vector(run: &RandomRun, name: &str, [x, y]: [&str; 2], row: usize) -> Vec2 {
    let of = |q: &str| run.get(&format!("{name}.{q}"), row);
    Vec2::new(of(x), of(y))
}

/// Position of a point in a row.
pub fn point(run: &RandomRun, at: PointRef, row: usize) -> Vec2 {
    let body = &run.scene.bodies[at.body];
    let own = &body.kind.points()[at.point];
    match body.kind.known() {
        Some(Known::Fixed) => own.at,
        _ => vector(
            run,
            &format!("points.{}.{}", body.name, own.name),
            ["x", "y"],
            row,
        ),
    }
}

/// Force and moment about the centre of mass, gathered body by body.
struct Loads {
    force: Vec<Vec2>,
    moment: Vec<f64>,
    /// Largest magnitude, to which rounding is relative.
    largest: f64,
}

/// What acts on every body in a row; couples count as forces at the lever `extent` \[m\].
fn loads(run: &RandomRun, row: usize, extent: f64) -> Loads {
    let scene = &run.scene;
    let mut loads = Loads {
        force: vec![Vec2::zeros(); scene.bodies.len()],
        moment: vec![0.0; scene.bodies.len()],
        largest: 0.0,
    };
    let mut act = |body: usize, at: Vec2, force: Vec2| {
        let centre = vector(run, &scene.bodies[body].name, ["x", "y"], row);
        loads.force[body] += force;
        loads.moment[body] += (at - centre).perp(&force);
        loads.largest = loads.largest.max(force.norm());
    };
    let mut couples = Vec::new();
    for joint in &scene.joints {
        let force = vector(run, &joint.name, ["fx", "fy"], row);
        let [bearing, journal] = joint.points().map(|p| point(run, p, row));
        // the force of a guide acts where the slider is
        let slides = joint.model.line().is_some();
        act(joint.journal.body, journal, force);
        act(
            joint.bearing.body,
            if slides { journal } else { bearing },
            -force,
        );
        couples.push((joint.journal.body, joint.bearing.body, &joint.name));
    }
    for force in &scene.forces {
        if let Some(TorsionSpringModel { joint, .. }) = force.kind.get() {
            let joint = &scene.joints[*joint];
            couples.push((joint.journal.body, joint.bearing.body, &force.name));
        } else if let Some(TorqueModel { point, .. }) = force.kind.get() {
            couples.push((point.body, 0, &force.name));
        } else if let Some(PointForceModel { point: on, .. }) = force.kind.get() {
            let applied = vector(run, &force.name, ["fx", "fy"], row);
            act(on.body, point(run, *on, row), applied);
        } else if let [from, to] = force.kind.points()[..] {
            let [a, b] = [from, to].map(|p| point(run, p, row));
            let pull = run.get(&format!("{}.force", force.name), row);
            let pull = pull / (b - a).norm().max(f64::MIN_POSITIVE) * (b - a);
            act(from.body, a, pull);
            act(to.body, b, -pull);
        }
    }
    for (on, by, name) in couples {
        let couple = run.get(&format!("{name}.torque"), row);
        loads.moment[on] += couple;
        loads.moment[by] -= couple;
        loads.largest = loads.largest.max(couple.abs() / extent);
    }
    loads
}

/// What is left of Newton's law for every body, and of Euler's where it can be evaluated from outside.
pub fn forces(run: &RandomRun) -> Result<(), Breach> {
    let scene = &run.scene;
    let gravity: Vec2 = scene.simulation.gravity.unwrap_or([0.0; 2]).into();
    // couples of friction are no channel
    let has_couple = |b: usize| {
        let mut joints = scene.joints.iter();
        joints.any(|j| {
            let rubs = j.contact().is_some_and(|c| c.friction.is_some());
            rubs && (j.bearing.body == b || j.journal.body == b)
        })
    };
    let still = at_rest(run) / scene.simulation.duration;
    for row in 0..run.rows.rows() {
        let extent = extent(run, row);
        let rounding = stiffness(scene, extent) * f64::EPSILON / FORCES;
        let loads = loads(run, row, extent);
        let mut size = loads.largest.max(rounding).max(still);
        let mut parts = Vec::new();
        for (b, body) in scene.bodies.iter().enumerate() {
            let (m, damped) = (mass(&*body.kind), mass_damping(&*body.kind));
            let a = vector(run, &body.name, ["ax", "ay"], row);
            let v = vector(run, &body.name, ["vx", "vy"], row);
            size = size.max(m * a.amax()).max(m * gravity.amax());
            let rest = loads.force[b] - m * (a - gravity + damped * v);
            let euler = inertia(&*body.kind).filter(|_| !has_couple(b) && b > 0);
            let alpha = run.get(&format!("{}.alpha", body.name), row);
            let moment = euler.map_or(0.0, |i| loads.moment[b] - i * alpha);
            // what carries the ground and moving bodies is no channel
            if body.kind.known().is_none() {
                parts.push((&body.name, rest.norm(), moment));
            }
        }
        for (name, rest, moment) in parts {
            if rest.max(moment.abs() / extent) > FORCES * size {
                return breach(
                    "forces are mass times acceleration",
                    format!(
                        "{name} in row {row}: {rest:e} N and {moment:e} N m are left of {size:e} N"
                    ),
                );
            }
        }
    }
    Ok(())
}

/// Largest distance of a point of a body from the origin \[m\]: coordinates are rounded relative to it.
pub fn extent(run: &RandomRun, row: usize) -> f64 {
    let mut extent = f64::MIN_POSITIVE;
    for (body, named) in run.scene.bodies.iter().enumerate() {
        extent = extent.max(vector(run, &named.name, ["x", "y"], row).amax());
        for k in 0..named.kind.points().len() {
            extent = extent.max(point(run, PointRef { body, point: k }, row).amax());
        }
    }
    extent
}

/// The momentum \[kg m/s\] of everything moving by 1e-6 of the extent in the duration: what changes by less is at rest but
/// for rounding.
pub fn at_rest(run: &RandomRun) -> f64 {
    let masses: f64 = run.scene.bodies.iter().map(|b| mass(&*b.kind)).sum();
    1e-6 * masses * extent(run, 0) / run.scene.simulation.duration
}

/// True where nothing but weight acts from outside.
pub fn flies(scene: &Scene) -> bool {
    let grounded = |p: &PointRef| mass(&*scene.bodies[p.body].kind) == 0.0;
    let joined = scene.joints.iter().any(|j| j.points().iter().any(grounded));
    let pulled = scene.forces.iter().any(|f| {
        let outside = f.kind.get::<PointForceModel>().is_some();
        let turned = f.kind.get::<TorqueModel>().is_some();
        outside || turned || f.kind.points().iter().any(grounded)
    });
    let damped = scene.bodies.iter().any(|b| mass_damping(&*b.kind) > 0.0);
    !(joined || pulled || damped)
}

/// The momentum of what flies freely changes by its weight only.
pub fn momentum(run: &RandomRun) -> Result<(), Breach> {
    let scene = &run.scene;
    if !flies(scene) || run.rows.rows() == 0 {
        return Ok(());
    }
    let gravity: Vec2 = scene.simulation.gravity.unwrap_or([0.0; 2]).into();
    let total = |row: usize| {
        let (mut sum, mut size) = (Vec2::zeros(), 0.0);
        for body in &scene.bodies {
            let m = mass(&*body.kind);
            let own = m * vector(run, &body.name, ["vx", "vy"], row);
            let weight = m * run.get("t", row) * gravity;
            sum += own - weight;
            size += own.abs().sum() + weight.abs().sum();
        }
        (sum, size)
    };
    let (first, mut size) = total(0);
    for row in 1..run.rows.rows() {
        let (now, own) = total(row);
        size = own.max(size).max(at_rest(run));
        let change = (now - first).norm();
        if change > MOMENTUM * size {
            let detail = format!("it changes by {change:e} of {size:e} kg m/s to row {row}");
            return breach("momentum is kept", detail);
        }
    }
    Ok(())
}

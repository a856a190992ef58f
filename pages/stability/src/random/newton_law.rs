//! Newton's law from the outside: recorded forces on every body against its mass and recorded acceleration, and the momentum
//! of what flies freely. Rows are consistent at the acceleration level, whatever the scheme.

use super::outcome::{Breach, ChannelRows, RandomRun};
use looselink::body::{Body, FlexibleLink, Known, RigidBody, RigidLink};
use looselink::interaction::{
    ForceModel, PointForceModel, SpringDamperModel, TorqueModel, TorsionSpringModel,
};
use looselink::scene::{PointRef, Scene};

/// Error of a sum of forces over the largest force of the row: a linear solve of equations whose masses differ by up to six
/// decades, without row exchanges as long as no pivot is weak.
const FORCES: f64 = 1e-8;
/// Change of the momentum over the sum of its parts: every stage conserves it to the rounding of such a solve.
const MOMENTUM: f64 = 1e-9;

/// Mass of a body \[kg\].
pub(super) fn mass(kind: &dyn Body) -> f64 {
    kind.mass().unwrap_or(0.0)
}

/// Moment of inertia about the centre of mass \[kg m2\] of a body that does not bend.
pub(super) fn inertia(kind: &dyn Body) -> Option<f64> {
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
pub(super) fn stiffness(scene: &Scene, extent: f64) -> f64 {
    let links = scene.bodies.iter().filter_map(|b| b.kind.get());
    let links = links.map(|link: &FlexibleLink| link.youngs_modulus * link.link.area);
    let spring = |kind: &dyn ForceModel| {
        let straight = kind
            .get::<SpringDamperModel>()
            .map(|s| s.stiffness * extent);
        let torsion = || {
            kind.get::<TorsionSpringModel>()
                .map(|s| s.stiffness / extent)
        };
        straight.or_else(torsion).unwrap_or(0.0)
    };
    links.sum::<f64>() + scene.forces.iter().map(|f| spring(&*f.kind)).sum::<f64>()
}

/// Damping proportional to mass \[1/s\].
fn mass_damping(kind: &dyn Body) -> f64 {
    let damping = kind.get::<FlexibleLink>().and_then(|link| link.damping);
    damping.map_or(0.0, |damping| damping.mass)
}

fn cross(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

/// Position of a point in a row.
pub(super) fn point(scene: &Scene, rows: &ChannelRows, at: PointRef, row: usize) -> [f64; 2] {
    let body = &scene.bodies[at.body];
    let own = &body.kind.points()[at.point];
    if let Some(Known::Fixed) = body.kind.known() {
        return own.at.into();
    }
    let name = &own.name;
    let of = |axis: &str| rows.get(&format!("points.{}.{name}.{axis}", body.name), row);
    [of("x"), of("y")]
}

/// Force and moment about the centre of mass, gathered body by body.
struct Loads {
    force: Vec<[f64; 2]>,
    moment: Vec<f64>,
    /// Sums of magnitudes, to which rounding is relative.
    largest: f64,
}

/// What acts on every body in a row; couples count as forces at the lever `extent` \[m\].
fn loads(scene: &Scene, rows: &ChannelRows, row: usize, extent: f64) -> Loads {
    let count = scene.bodies.len();
    let mut loads = Loads {
        force: vec![[0.0; 2]; count],
        moment: vec![0.0; count],
        largest: 0.0,
    };
    let centre = |b: usize| {
        let of = |axis: &str| rows.get(&format!("{}.{axis}", scene.bodies[b].name), row);
        [of("x"), of("y")]
    };
    let mut act = |b: usize, at: [f64; 2], force: [f64; 2]| {
        let c = centre(b);
        loads.force[b] = [loads.force[b][0] + force[0], loads.force[b][1] + force[1]];
        loads.moment[b] += cross([at[0] - c[0], at[1] - c[1]], force);
        loads.largest = loads.largest.max(force[0].hypot(force[1]));
    };
    let mut couples = Vec::new();
    for joint in &scene.joints {
        let of = |q: &str| rows.get(&format!("{}.{q}", joint.name), row);
        let force = [of("fx"), of("fy")];
        let at = match joint.model.line() {
            // the force of a guide acts where the slider is
            Some(_) => [point(scene, rows, joint.journal, row); 2],
            None => joint.points().map(|p| point(scene, rows, p, row)),
        };
        act(joint.journal.body, at[1], force);
        act(joint.bearing.body, at[0], force.map(|f| -f));
        couples.push((joint.journal.body, joint.bearing.body, of("torque")));
    }
    for force in &scene.forces {
        let of = |q: &str| rows.get(&format!("{}.{q}", force.name), row);
        if let [from, to] = force.kind.points()[..]
            && force.kind.get::<TorqueModel>().is_none()
        {
            let [a, b] = [from, to].map(|p| point(scene, rows, p, row));
            let way = [b[0] - a[0], b[1] - a[1]];
            let pull = of("force") / way[0].hypot(way[1]).max(f64::MIN_POSITIVE);
            act(from.body, a, way.map(|w| pull * w));
            act(to.body, b, way.map(|w| -pull * w));
        }
        if let Some(PointForceModel { point: p, .. }) = force.kind.get() {
            act(p.body, point(scene, rows, *p, row), [of("fx"), of("fy")]);
        }
        if let Some(TorsionSpringModel { joint, .. }) = force.kind.get() {
            let joint = &scene.joints[*joint];
            couples.push((joint.journal.body, joint.bearing.body, of("torque")));
        }
        if let Some(TorqueModel { point, .. }) = force.kind.get() {
            couples.push((point.body, 0, of("torque")));
        }
    }
    for (on, by, couple) in couples {
        loads.moment[on] += couple;
        loads.moment[by] -= couple;
        loads.largest = loads.largest.max(couple.abs() / extent);
    }
    loads
}

/// What is left of Newton's law for every body, and of Euler's where it can be evaluated from outside.
pub fn forces(run: &RandomRun) -> Result<(), Breach> {
    let (Some(scene), rows) = (&run.scene, &run.rows) else {
        return Ok(());
    };
    let gravity = scene.simulation.gravity.unwrap_or([0.0; 2]);
    // couples of friction are no channel
    let has_couple = |b: usize| {
        scene.joints.iter().any(|j| {
            (j.bearing.body == b || j.journal.body == b)
                && j.contact().is_some_and(|c| c.friction.is_some())
        })
    };
    let still = at_rest(scene, rows) / scene.simulation.duration;
    for row in 0..rows.len() {
        let extent = extent(scene, rows, row);
        let rounding = stiffness(scene, extent) * f64::EPSILON / FORCES;
        let loads = loads(scene, rows, row, extent);
        let mut size = loads.largest.max(rounding).max(still);
        let mut parts = Vec::new();
        for (b, body) in scene.bodies.iter().enumerate() {
            let m = mass(&*body.kind);
            let of = |q: &str| rows.get(&format!("{}.{q}", body.name), row);
            let damped = mass_damping(&*body.kind);
            let (a, v) = ([of("ax"), of("ay")], [of("vx"), of("vy")]);
            let rest = [0, 1].map(|d| {
                let asked = m * (a[d] - gravity[d] + damped * v[d]);
                size = size.max(m * a[d].abs()).max(m * gravity[d].abs());
                loads.force[b][d] - asked
            });
            let euler = inertia(&*body.kind).filter(|_| !has_couple(b) && b > 0);
            let moment = euler.map_or(0.0, |i| loads.moment[b] - i * of("alpha"));
            parts.push((b, rest[0].hypot(rest[1]), moment));
        }
        for (b, rest, moment) in parts {
            // what carries the ground and moving bodies is no channel
            if scene.bodies[b].kind.known().is_some() {
                continue;
            }
            let worst = rest.max(moment.abs() / extent);
            if worst > FORCES * size {
                return Err(Breach::new(
                    "forces are mass times acceleration",
                    format!(
                        "{} in row {row}: {rest:e} N and {moment:e} N m are left of {size:e} N",
                        scene.bodies[b].name
                    ),
                ));
            }
        }
    }
    Ok(())
}

/// Largest distance of a point of a body from the origin \[m\]: coordinates are rounded relative to it.
pub(super) fn extent(scene: &Scene, rows: &ChannelRows, row: usize) -> f64 {
    let of = |b: &str, q: &str| rows.get(&format!("{b}.{q}"), row).abs();
    let mut extent = f64::MIN_POSITIVE;
    for (index, body) in scene.bodies.iter().enumerate() {
        extent = extent.max(of(&body.name, "x")).max(of(&body.name, "y"));
        for k in 0..body.kind.points().len() {
            let at = PointRef {
                body: index,
                point: k,
            };
            let [x, y] = point(scene, rows, at, row);
            extent = extent.max(x.abs()).max(y.abs());
        }
    }
    extent
}

/// The momentum \[kg m/s\] of everything moving by 1e-6 of the extent in the duration: what changes by less is at rest but
/// for rounding.
pub(super) fn at_rest(scene: &Scene, rows: &ChannelRows) -> f64 {
    let masses: f64 = scene.bodies.iter().map(|b| mass(&*b.kind)).sum();
    1e-6 * masses * extent(scene, rows, 0) / scene.simulation.duration
}

/// True where nothing but weight acts from outside.
pub(super) fn flies(scene: &Scene) -> bool {
    let grounded = |b: usize| mass(&*scene.bodies[b].kind) == 0.0;
    let joined = scene
        .joints
        .iter()
        .any(|j| grounded(j.bearing.body) || grounded(j.journal.body));
    let pulled = scene.forces.iter().any(|f| {
        let outside = f.kind.get::<PointForceModel>().is_some();
        let turned = f.kind.get::<TorqueModel>().is_some();
        outside || turned || f.kind.points().iter().any(|p| grounded(p.body))
    });
    let damped = scene.bodies.iter().any(|b| mass_damping(&*b.kind) > 0.0);
    !(joined || pulled || damped)
}

/// The momentum of what flies freely changes by its weight only.
pub fn momentum(run: &RandomRun) -> Result<(), Breach> {
    let (Some(scene), rows) = (&run.scene, &run.rows) else {
        return Ok(());
    };
    if !flies(scene) || rows.is_empty() {
        return Ok(());
    }
    let gravity = scene.simulation.gravity.unwrap_or([0.0; 2]);
    let total = |row: usize| {
        let (mut sum, mut size) = ([0.0; 2], 0.0);
        let t = rows.get("t", row);
        for body in &scene.bodies {
            let m = mass(&*body.kind);
            for (d, q) in ["vx", "vy"].iter().enumerate() {
                let own = m * rows.get(&format!("{}.{q}", body.name), row);
                sum[d] += own - m * gravity[d] * t;
                size += own.abs() + (m * gravity[d] * t).abs();
            }
        }
        (sum, size)
    };
    let (first, mut size) = total(0);
    for row in 1..rows.len() {
        let (now, own) = total(row);
        size = own.max(size);
        size = size.max(at_rest(scene, rows));
        let change = (now[0] - first[0]).hypot(now[1] - first[1]);
        if change > MOMENTUM * size {
            let detail = format!("it changes by {change:e} of {size:e} kg m/s to row {row}");
            return Err(Breach::new("momentum is kept", detail));
        }
    }
    Ok(())
}

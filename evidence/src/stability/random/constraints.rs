//! Constraints kept: joints stay closed and links keep their lengths, in every row.

use super::newton_law::{extent, point};
use super::run::{Breach, RandomRun, breach};
use looselink::body::RigidLink;
use looselink::math::plane::unit;
use looselink::scene::{Pace, PointRef};

/// Roundings of a coordinate that add up in a constraint: those of the points, of a length, and of Newton's last solve.
const ROUNDINGS: f64 = 200.0;
/// Updates that Newton's method may leave where they have come down to rounding, in tolerances (`ROUNDING_BAND`).
const STAGNATION: f64 = 1e4;

/// Newton's method leaves less than its tolerance in every velocity, hence less than tolerance times step in a coordinate;
/// explicit schemes project to rounding. Angles and slopes move points by less than the extent of the mechanism.
fn allowed(run: &RandomRun, extent: f64) -> f64 {
    let step = match run.scene.integrator.pace {
        Pace::Step(step) => step,
        Pace::Accuracy(_) => run.scene.output.interval,
    };
    let band = match run.report.stagnations {
        0 => 1.0,
        _ => STAGNATION,
    };
    let newton = run.scene.integrator.newton_tolerance_for(1.0) * step * extent.max(1.0);
    band * (newton + ROUNDINGS * f64::EPSILON * extent)
}

/// What is open in the rows, and at the end of the run.
pub fn kept(run: &RandomRun) -> Result<(), Breach> {
    // where a scheme has blown up, bodies are so far away that their links are rounding
    if run.blown_up() {
        return Ok(());
    }
    let scene = &run.scene;
    let closed = |name: &str, open: f64, allowed: f64, row: usize| match open <= allowed {
        true => Ok(()),
        false => breach(
            "constraints are kept",
            format!("{name} is open by {open:e} m in row {row}, allowed {allowed:e} m"),
        ),
    };
    let mut largest: f64 = 0.0;
    for row in 0..run.rows.rows() {
        // angles and slopes, which are about one, set the rounding of all coordinates too
        largest = largest.max(extent(run, row)).max(run.reach.min(10.0));
        // a start may miss a joint by what positions are typed to
        let allowed = allowed(run, largest).max(if row == 0 { 1e-9 } else { 0.0 });
        for joint in &scene.joints {
            let way = point(run, joint.journal, row) - point(run, joint.bearing, row);
            let guide = &scene.bodies[joint.bearing.body];
            let open = match joint.model.line() {
                None if joint.model.coincides() => way.norm(),
                // a bent guide has its direction where the joint is
                Some(direction) if joint.contact().is_none() && guide.kind.is_rigid() => {
                    let theta = run.get(&format!("{}.theta", guide.name), row);
                    unit(theta + direction).perp(&way).abs()
                }
                _ => continue,
            };
            closed(&joint.name, open, allowed, row)?;
        }
        for (body, named) in scene.bodies.iter().enumerate() {
            if let Some(RigidLink { link, .. }) = named.kind.get() {
                let [start, end] = [0, 1].map(|k| point(run, PointRef { body, point: k }, row));
                let open = ((end - start).norm() - link.length).abs();
                closed(&named.name, open, allowed, row)?;
            }
        }
    }
    match &run.open {
        Some((open, _, name)) if run.outcome.is_complete() => {
            let allowed = allowed(run, largest.max(run.reach));
            closed(name, *open, allowed, run.rows.rows())
        }
        _ => Ok(()),
    }
}

//! Constraints kept: joints stay closed and links keep their lengths, in every row.

use super::newton_law::{extent, point};
use super::outcome::{Breach, RandomRun, RunOutcome};
use looselink::body::RigidLink;
use looselink::scene::Pace;

/// Roundings of a coordinate that add up in a constraint: those of the points, of a length, and of Newton's last solve.
const ROUNDINGS: f64 = 200.0;
/// Updates that Newton's method may leave where they have come down to rounding, in tolerances (`ROUNDING_BAND`).
const STAGNATION: f64 = 1e4;

/// Newton's method leaves less than its tolerance in every velocity, hence less than tolerance times step in a coordinate;
/// explicit schemes project to rounding. Angles and slopes move points by less than the extent of the mechanism.
fn allowed(run: &RandomRun, extent: f64) -> f64 {
    let Some(scene) = &run.scene else { return 0.0 };
    let step = match scene.integrator.pace {
        Pace::Step(step) => step,
        Pace::Accuracy(_) => scene.output.interval,
    };
    let band = match run.report.as_ref().map_or(0, |r| r.stagnations) {
        0 => 1.0,
        _ => STAGNATION,
    };
    let newton = scene.integrator.newton_tolerance * step * extent.max(1.0);
    band * (newton + ROUNDINGS * f64::EPSILON * extent)
}

/// What is open in the rows, and at the end of the run.
pub fn kept(run: &RandomRun) -> Result<(), Breach> {
    let (Some(scene), rows) = (&run.scene, &run.rows) else {
        return Ok(());
    };
    // where a scheme has blown up, bodies are so far away that their links are rounding
    if run.blown_up() {
        return Ok(());
    }
    let breach = |name: &str, open: f64, allowed: f64, row: usize| {
        Err(Breach::new(
            "constraints are kept",
            format!("{name} is open by {open:e} m in row {row}, allowed {allowed:e} m"),
        ))
    };
    let mut largest: f64 = 0.0;
    for row in 0..rows.len() {
        // angles and slopes, which are about one, set the rounding of all coordinates too
        largest = largest
            .max(extent(scene, rows, row))
            .max(run.reach.min(10.0));
        // a start may miss a joint by what positions are typed to
        let allowed = allowed(run, largest).max(if row == 0 { 1e-9 } else { 0.0 });
        for joint in &scene.joints {
            let [a, b] = [joint.bearing, joint.journal].map(|p| point(scene, rows, p, row));
            let way = [b[0] - a[0], b[1] - a[1]];
            let open = match joint.model.line() {
                None if joint.model.coincides() => way[0].hypot(way[1]),
                Some(direction) if joint.contact().is_none() => {
                    let body = &scene.bodies[joint.bearing.body];
                    // a bent guide has its direction where the joint is
                    if !body.kind.is_rigid() {
                        continue;
                    }
                    let theta = rows.get(&format!("{}.theta", body.name), row) + direction;
                    (theta.cos() * way[1] - theta.sin() * way[0]).abs()
                }
                _ => continue,
            };
            if open.is_nan() || open > allowed {
                return breach(&joint.name, open, allowed, row);
            }
        }
        for (b, body) in scene.bodies.iter().enumerate() {
            let Some(RigidLink { link, .. }) = body.kind.get() else {
                continue;
            };
            let end = |point| looselink::scene::PointRef { body: b, point };
            let [a, c] = [0, 1].map(|k| point(scene, rows, end(k), row));
            let open = ((c[0] - a[0]).hypot(c[1] - a[1]) - link.length).abs();
            if open.is_nan() || open > allowed {
                return breach(&body.name, open, allowed, row);
            }
        }
    }
    let ran = matches!(run.outcome, RunOutcome::Finished | RunOutcome::Remarked(_));
    if let (true, Some((open, _, name))) = (ran, &run.open) {
        let allowed = allowed(run, largest.max(run.reach));
        if open.is_nan() || *open > allowed {
            return breach(name, *open, allowed, rows.len());
        }
    }
    Ok(())
}

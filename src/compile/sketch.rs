//! Closing the ideal mechanism at t = 0: the sketch chooses the branch.

use super::Compiler;
use crate::body::{Content, PointRef};
use crate::kinematics::Kinematics;
use crate::marker::Marker;
use crate::math::plane::{Rotation, Vec2, pair};
use crate::model::Model;
use crate::scene::{Drive, SceneError, Sketched};
use crate::system::State;

/// Closes the mechanism at t = 0 from the sketch.
pub(super) fn close(
    c: &Compiler,
    drive: &Drive,
    kinematics: &Kinematics,
) -> Result<State, SceneError> {
    let mechanism = &*kinematics.mechanism;
    let mut inner = kinematics.work();
    mechanism.follow_rules(&mut inner.state);
    mechanism.move_driven_nodes(&mut inner.state);
    let guessed = guess(c, mechanism, &mut inner.state)?;
    kinematics.solve(&mut inner, 60).map_err(|e| {
        c.scene.error(
            drive.span,
            format!("drive {}: {e}", drive.name),
            "the mechanism of this drive",
        )
    })?;
    for (x, sketch) in guessed {
        let found = pair(&inner.state.q, x);
        let drawn = &c.scene.initial.sketch[sketch];
        let points = c.sketched_points(drawn).into_iter();
        let lengths = points.map(|p| c.bodies[p.body].length().unwrap_or(f64::INFINITY));
        if (found - drawn.at).norm() > 0.25 * lengths.fold(f64::INFINITY, f64::min) {
            return Err(c.far_from_sketch(drawn, found));
        }
    }
    Ok(inner.state)
}

pub(super) fn marker(mechanism: &Model, point: PointRef) -> Marker {
    mechanism.bodies()[point.body].placed.marker(point.point)
}

/// Puts the sketched positions into the unknown nodes and fits the unknown rigid bodies to them; returns all sketched
/// nodes with the index of their sketch.
fn guess(
    c: &Compiler,
    mechanism: &Model,
    state: &mut State,
) -> Result<Vec<(usize, usize)>, SceneError> {
    let n = mechanism.shape().unknowns;
    let mut known = vec![false; state.q.len()];
    known[n..].fill(true);
    let mut guessed = Vec::new();
    for (k, sketch) in c.scene.initial.sketch.iter().enumerate() {
        for point in c.sketched_points(sketch) {
            if let Marker::Node { x } = marker(mechanism, point) {
                if x < n {
                    state.q[x..x + 2].copy_from_slice(sketch.at.as_slice());
                }
                guessed.push((x, k));
                known[x] = true;
            }
        }
    }
    for (b, body) in c.scene.bodies.iter().enumerate() {
        let x = &mechanism.bodies()[b].placed.x;
        match c.slots[b].first().map(|slot| slot.content) {
            Some(Content::Position) if body.kind.length().is_some() => {
                if let Some(end) = (0..2).find(|&e| !known[x[e]]) {
                    let name = c.point_name(PointRef {
                        body: b,
                        point: end,
                    });
                    let message = format!("the sketch does not say where {name} is");
                    let error = c.scene.error(body.span, message, "this body");
                    return Err(error.with_help(
                        "give the approximate position of this point, or of a joint there, in `[initial.sketch]`",
                    ));
                }
            }
            Some(Content::Pose) if x[0] < n => {
                let pairs: Vec<_> = (0..body.kind.points().len())
                    .filter_map(|point| sketch_of(c, mechanism, state, PointRef { body: b, point }))
                    .collect();
                if pairs.len() < 2 {
                    let message = format!(
                        "the sketch does not say where {} is: it must place two of its joints or points",
                        body.name
                    );
                    return Err(c.scene.error(body.span, message, "this body"));
                }
                let pose = fit(&pairs);
                state.q[x[0]..x[0] + 3].copy_from_slice(&pose);
            }
            _ => {}
        }
    }
    Ok(guessed)
}

/// (point in the body, approximate position) of a point of a rigid body, from a sketch or from a known partner.
fn sketch_of(c: &Compiler, mechanism: &Model, state: &State, point: PointRef) -> Option<PointPair> {
    let local = c.bodies[point.body].points()[point.point].at;
    let of_joint = c.joints_at(point).iter().find_map(|&(j, partner)| {
        let known = || {
            c.is_known(partner)
                .then(|| mechanism.position(&marker(mechanism, partner), state))
        };
        c.drawn(Sketched::Joint(j)).or_else(known)
    });
    let at = of_joint.or_else(|| c.drawn(Sketched::Point(point)));
    at.map(|at| (local, at))
}

/// A point in the frame of its body and its approximate position.
pub(super) type PointPair = (Vec2, Vec2);

/// The pose (x, y, theta) that carries points of a body closest to given positions.
pub(super) fn fit(pairs: &[PointPair]) -> [f64; 3] {
    let count = pairs.len() as f64;
    let mean = |pick: fn(&PointPair) -> Vec2| pairs.iter().map(pick).sum::<Vec2>() / count;
    let (local, global) = (mean(|p| p.0), mean(|p| p.1));
    let (mut sine, mut cosine) = (0.0, 0.0);
    for (s, r) in pairs {
        let (s, r) = (s - local, r - global);
        sine += s.perp(&r);
        cosine += s.dot(&r);
    }
    let theta = f64::atan2(sine, cosine);
    let origin = global - Rotation::new(theta) * local;
    origin.push(theta).into()
}

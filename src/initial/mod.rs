//! Where the motion starts: poses of the ideal mechanism or of the scene, then consistent rates.

mod freedoms;
mod pressed;
pub(crate) mod redundancy;
pub(crate) mod turns;

pub use freedoms::Freedoms;
pub(crate) use freedoms::left_free;
pub(crate) use redundancy::unit_lengths;

use crate::body::{Content, Deformation, Frame};
use crate::compile::Compiled;
use crate::compile::assembly::{CENTRE, assemble, name, opening, whole_name};
use crate::compile::extent::{FITS, extent};
use crate::math::plane::{Vec2, full_turns};
use crate::model::{Model, PlacedBody, PlacedConstraint};
use crate::scene::{Analysis, BodyState, Journals, NamedBody, Scene, SceneError};
use crate::system::State;

/// A start gathers the errors of a few constraints.
const START: f64 = 10.0 * FITS;

/// The state at t = 0, accelerations and multipliers still to be found.
///
/// # Errors
/// A body without a start, or a start that violates a constraint.
pub fn start(scene: &Scene, compiled: &Compiled) -> Result<State, SceneError> {
    let model = &compiled.model;
    let mut state = known(scene, compiled)?;
    let mut starts = starts(scene, compiled, &state)?;
    if scene.initial.journals == Journals::Pressed {
        pressed::press(scene, &mut starts)?;
    }

    let size = extent(scene);
    let mut written = vec![false; state.q.len()];
    written[model.shape().unknowns..].fill(true);
    for (b, start) in starts.iter().enumerate() {
        let Some(start) = start else { continue };
        let body = &scene.bodies[b];
        let given = scene.initial.state_of(b);
        let deformation = given.map_or(Deformation::default(), |given| given.deformation);
        let placed = &model.bodies()[b];
        let values = placed.placed.kind.place_deformed(start, &deformation);
        let misfits = place(placed, values, size, &mut state, &mut written);
        // nothing moves in a static analysis, whatever its drives prescribe
        let moves = scene.simulation.analysis == Analysis::Dynamic;
        let [position, rate] = misfits;
        if let Some(misfit) = position.or(rate.filter(|_| moves)) {
            return Err(match placed.placed.kind.hold() {
                Some(hold) => misfit.at_joint(scene, model, b, hold.joint),
                None => {
                    let message = format!(
                        "the pose of {} does not fit the points that its ends are joined to",
                        body.name
                    );
                    let span = given.map_or(body.span, |g| g.span);
                    let error = scene.error(span, message, "does not fit its joints");
                    error.with_help(CENTRE)
                }
            });
        }
    }
    for (j, joint) in scene.joints.iter().enumerate() {
        let Some(contact) = joint.contact() else {
            continue;
        };
        let delta = model.gap(j, &state).map_or(0.0, |(gap, ..)| gap.delta);
        if delta > contact.clearance {
            let message = format!(
                "the journal of joint {} starts outside its bearing: the penetration of {} exceeds the clearance of {}",
                joint.name,
                numbers::si(delta, "m"),
                numbers::si(contact.clearance, "m")
            );
            return Err(scene.error(joint.span, message, "this joint"));
        }
    }
    for (f, force) in scene.forces.iter().enumerate() {
        if let Some(fault) = model.named_force(f).1.fault(&state) {
            let message = format!("force {} is not defined at the start: {fault}", force.name);
            return Err(scene.error(force.span, message, "this force"));
        }
    }
    satisfied(scene, model, &state)?;
    if let Some(index) = model.half_turned(&state) {
        let name = &model.unknown_names()[index];
        let message = format!("{name} starts half a turn away from the angle it holds");
        return Err(scene.error(scene.initial.span, message, "this start"));
    }
    for (f, force) in scene.forces.iter().enumerate() {
        let joint = force.kind.turning_joint();
        if let Some(angle) = joint.and_then(|joint| turns::given_angle(scene, joint)) {
            model.named_force(f).1.wind(&mut state, angle);
        }
    }
    model.remember(&mut state);
    Ok(state)
}

/// A state with what is known at t = 0: the ground, paths, driven bodies.
fn known(scene: &Scene, Compiled { model, kinematics }: &Compiled) -> Result<State, SceneError> {
    let mut state = model.blank_state();
    model.follow_rules(&mut state);
    if let Some(kinematics) = kinematics {
        let mut inner = kinematics.work();
        inner.state.q.copy_from_slice(&kinematics.start);
        let solved = kinematics.solve(&mut inner, 20);
        solved.map_err(|e| scene.error(scene.initial.span, e.to_string(), "the start"))?;
        kinematics.hand_over(&inner, &mut state);
    }
    model.move_driven_nodes(&mut state);
    Ok(state)
}

/// Checks that a start satisfies the constraints and their rates.
fn satisfied(scene: &Scene, model: &Model, state: &State) -> Result<(), SceneError> {
    let size = extent(scene);
    let worst = |of: fn(&PlacedConstraint, &State) -> f64, scale: f64| {
        let all = model.constraints.iter().map(|p| (of(p, state), p));
        let worst = all.max_by(|a, b| a.0.total_cmp(&b.0));
        worst.filter(|(x, _)| x.is_nan() || *x > START * scale)
    };
    // the violation is measured over all rows together, so no single row can be named
    let name = |p: &PlacedConstraint| match p.rows {
        1 => name(model, p),
        _ => whole_name(model, p),
    };
    if let Some((open, placed)) = worst(|p, at| Vec2::from(p.term.value(at)).norm(), size) {
        let message = format!(
            "the start violates {}: it is open by {}",
            name(placed),
            opening(&placed.term, open, "")
        );
        let error = scene.error(scene.initial.span, message, "this start");
        return Err(error.with_help(CENTRE));
    }
    // nothing moves in a static analysis, whatever its drives prescribe
    if scene.simulation.analysis == Analysis::Static {
        return Ok(());
    }
    // a mechanism at rest has no other scale than its length in a second
    let speed = state.v.iter().fold(size, |m, v| m.max(v.abs()));
    let Some((off, placed)) = worst(|p, at| Vec2::from(p.term.velocity(at)).norm(), speed) else {
        return Ok(());
    };
    let by = opening(&placed.term, off, "/s");
    Err(wrong_rates(scene, model, name(placed), &by))
}

/// The error of a start whose velocities violate a joint or a constraint.
fn wrong_rates(scene: &Scene, model: &Model, what: &str, by: &str) -> SceneError {
    let message = format!("the velocities of the start violate {what}, by {by}");
    let silent = scene.initial.bodies.values().filter(|s| !s.velocity_given);
    let silent: Vec<&BodyState> = silent.collect();
    let Some(first) = silent.first() else {
        return scene.error(scene.initial.span, message, "this start");
    };
    let names = silent.iter().map(|s| scene.bodies[s.body].name.as_str());
    let message = format!(
        "{message}: the scene gives no velocity for {}, so zero was assumed",
        names.collect::<Vec<_>>().join(", ")
    );
    let error = scene.error(first.span, message, "no velocity here");
    error.with_help(if !model.prescribed.is_empty() {
        "give `vx`, `vy` and `omega` beside the pose"
    } else if !scene.motions.is_empty() {
        "add a joint to `[initial.sketch]`, and what the drives determine is computed; or give `vx`, `vy` and `omega` of every \
         body"
    } else {
        "add a joint to `[initial.sketch]` or a velocity to `[initial.velocities]`, and the others are computed; or give `vx`, \
         `vy` and `omega` of every body"
    })
}

/// The start of every body that moves freely.
fn starts(
    scene: &Scene,
    compiled: &Compiled,
    state: &State,
) -> Result<Vec<Option<Frame>>, SceneError> {
    let Compiled { model, kinematics } = compiled;
    let bodies = model.bodies().iter();
    let free: Vec<bool> = bodies.map(|body| model.is_free(body)).collect();
    let given = |b: usize| scene.initial.state_of(b);
    let size = extent(scene);
    for (b, NamedBody { name, .. }) in scene.bodies.iter().enumerate() {
        let differs = |given: &&BodyState| !free[b] && !is_prescribed(given, model, state, size);
        if let Some(given) = given(b).filter(differs) {
            let message = format!(
                "the motion of {name} is prescribed, so it cannot be given an initial state that differs from it"
            );
            return Err(scene.error(given.span, message, "remove this"));
        }
    }
    if let (Some(kinematics), Some(given)) = (kinematics, scene.initial.velocities.first()) {
        let message = format!(
            "the velocity of {} cannot be given: with inverse kinematics all velocities are those of the ideal mechanism",
            kinematics.mechanism.bodies()[given.body].name
        );
        return Err(scene.error(given.span, message, "remove this"));
    }
    let exact = |b: usize| given(b).map(|g| scene.bodies[b].kind.frame(g.position, g.velocity));
    let assembles = is_assembled(scene, model);
    let deformed = scene.initial.bodies.values();
    let mut deformed = deformed.filter(|given| given.deformation != Deformation::default());
    if let (true, Some(given)) = (assembles, deformed.next()) {
        let name = &scene.bodies[given.body].name;
        let message = format!("{name} cannot be assembled: it starts stretched or bending");
        let error = scene.error(given.span, message, "deformed");
        return Err(error.with_help(
            "give every body a state, and leave out `initial.sketch` and `initial.velocities`",
        ));
    }
    let assembly = assembles.then(|| assemble(scene)).transpose()?;
    let start = |b: usize| match (&assembly, kinematics) {
        _ if !free[b] => None,
        (Some((mechanism, state)), _) => ideal_start(mechanism, b, state, 0),
        (None, Some(kinematics)) => {
            let ideal = || ideal_start(&kinematics.mechanism, b, state, kinematics.offset);
            exact(b).or_else(ideal)
        }
        (None, None) => exact(b),
    };
    Ok((0..free.len()).map(start).collect())
}

/// True of a given state that is the one of a prescribed motion; a velocity that is not given may have any value.
fn is_prescribed(given: &BodyState, model: &Model, known: &State, size: f64) -> bool {
    let pose = model.pose(given.body, known);
    let differences = |a: [f64; 3], b: [f64; 3]| std::array::from_fn(|i| a[i] - b[i]);
    let [x, y, theta]: [f64; 3] = differences(given.position, pose.position);
    let rates: [f64; 3] = differences(given.velocity, pose.velocity);
    let position = [x / size, y / size, theta - full_turns(theta)];
    let fastest = given.velocity.iter().fold(size, |m, v| m.max(v.abs()));
    let rates = rates.map(|rate| rate / fastest);
    let rates = rates.iter().filter(|_| given.velocity_given);
    let mut all = position.iter().chain(rates);
    all.all(|difference| difference.abs() <= START)
}

/// True of a scene that gives a sketch or single velocities, or not the state of every body that moves freely; the ideal mechanism of a
/// drive is closed another way.
pub(crate) fn is_assembled(scene: &Scene, model: &Model) -> bool {
    let initial = &scene.initial;
    let asked = !initial.sketch.is_empty() || !initial.velocities.is_empty();
    let mut bodies = model.bodies().iter().enumerate();
    let silent = |(b, body)| model.is_free(body) && initial.state_of(b).is_none();
    scene.drives.is_empty() && (asked || bodies.any(silent))
}

/// Frame of a body in the ideal mechanism, whose coordinates begin at `offset` in `state`.
fn ideal_start(mechanism: &Model, b: usize, state: &State, offset: usize) -> Option<Frame> {
    let placed = &mechanism.bodies()[b].placed;
    let (q, v) = (&state.q[offset..], &state.v[offset..]);
    placed.kind.frame_at(&placed.x, q, v)
}

/// By how much a coordinate of a body differs from what is known of it.
#[derive(Debug, Clone, Copy)]
struct PlaceError {
    by: f64,
    unit: &'static str,
    /// Whether it is a velocity.
    is_rate: bool,
}

impl PlaceError {
    /// The error for a body that a joint holds.
    fn at_joint(&self, scene: &Scene, model: &Model, body: usize, joint: usize) -> SceneError {
        let what = format!("joint {}", scene.joints[joint].name);
        let by = numbers::si(self.by, self.unit);
        if self.is_rate {
            return wrong_rates(scene, model, &what, &format!("{by}/s"));
        }
        let name = &scene.bodies[body].name;
        let message = format!("the pose of {name} does not fit {what}: it is open by {by}");
        let given = scene.initial.state_of(body);
        let span = given.map_or(scene.initial.span, |given| given.span);
        scene.error(span, message, "this pose").with_help(CENTRE)
    }
}

/// Writes the coordinates of a body, and remembers which were written. Returns the first position and the first velocity that is
/// known or written already and differs in a mechanism of this length: bodies that share a node must agree on it.
fn place(
    body: &PlacedBody,
    values: Vec<[[f64; 3]; 2]>,
    size: f64,
    state: &mut State,
    written: &mut [bool],
) -> [Option<PlaceError>; 2] {
    let mut misfits = [None; 2];
    for ((&x, values), content) in body.placed.x.iter().zip(values).zip(&body.contents) {
        let here = x..x + content.names().len();
        let levels = [&mut state.q[here.clone()], &mut state.v[here]];
        let places = levels.into_iter().zip(values).zip(&mut misfits);
        for (((level, values), misfit), is_rate) in places.zip([false, true]) {
            if written[x] {
                let differences = level.iter().zip(values).map(|(a, b)| a - b);
                let by = differences.map(|d| d * d).sum::<f64>().sqrt();
                let unit = match content {
                    Content::Angle => "rad",
                    _ => "m",
                };
                let rates = values.iter().map(|x| x.abs());
                let scale = if is_rate {
                    rates.fold(size, f64::max)
                } else {
                    size
                };
                let fits = by <= START * scale;
                *misfit = misfit.or((!fits).then_some(PlaceError { by, unit, is_rate }));
            } else {
                level.copy_from_slice(&values[..level.len()]);
            }
        }
        written[x] = true;
    }
    misfits
}

//! Assembly of a mechanism without inverse kinematics: positions from a sketch, velocities from a few given ones.
//!
//! Both are computed for the ideal rigid mechanism. Positions: Newton's method with steps of least norm, from a guess by
//! the sketch and the given poses. Velocities: those of least kinetic energy that satisfy the constraints and the given
//! velocities.

mod closing;
mod contradictions;
mod guess;
mod velocities;

use super::extent::{extent, sizes};
use super::sketch::marker;
use super::{Compiler, Mode, build, known_roles, numbering};
use crate::body::PointRef;
use crate::math::plane::Vec2;
use crate::math::sparse_rows::SparseRow;
use crate::model::{Model, PlacedConstraint};
use crate::scene::{Scene, SceneError, SketchPoint, Sketched};
use crate::system::State;
use crate::terms::ConstraintTerm;
use closing::{Closing, Search};
pub(crate) use closing::{close_to, closing_step};
use contradictions::{blame, check_given};
use guess::guess;
use numbers::number;
use velocities::velocities;

/// Help for a pose that does not fit: its meaning.
pub(crate) const CENTRE: &str = "`x` and `y` locate the point that `point` names, or the centre of mass; `theta` is the angle of the \
     body, of a link the direction from `start` to `end`";

/// Largest distance between a joint and its sketch, relative to the smaller body.
const SKETCH: f64 = 0.25;
/// Largest difference between velocities that count as equal \[m/s, rad/s\], also as a part of the largest velocity: the digits of typed
/// numbers.
const AGREEING: f64 = 1e-9;

/// Assembles the ideal mechanism of a scene: the mechanism and its state at t = 0.
///
/// # Errors
/// A body without a place, a mechanism that cannot close, velocities that contradict or repeat each other.
pub(crate) fn assemble(scene: &Scene) -> Result<(Model, State), SceneError> {
    let c = Compiler::new(scene, Mode::Ideal, known_roles(scene));
    let (mechanism, mut state) = closed_mechanism(&c)?;
    velocities(&c, &mechanism, &mut state)?;
    Ok((mechanism, state))
}

/// The ideal mechanism of a scene, closed at t = 0, and its pose.
///
/// # Errors
/// A body without a place, a mechanism that cannot close.
pub(crate) fn closed(scene: &Scene) -> Result<(Model, State), SceneError> {
    closed_mechanism(&Compiler::new(scene, Mode::Ideal, known_roles(scene)))
}

/// The mechanism of a compiler, closed at t = 0, and its pose.
pub(super) fn closed_mechanism(c: &Compiler) -> Result<(Model, State), SceneError> {
    let numbering = numbering::number(c, None)?;
    let mechanism = build::build(c, numbering, None)?;
    let mut state = mechanism.blank_state();
    mechanism.follow_rules(&mut state);
    mechanism.move_driven_nodes(&mut state);
    let held = guess(c, &mechanism, &mut state)?;
    check_given(c, &mechanism, &state, &held)?;
    let guessed = state.clone();
    let closing = Closing {
        model: &mechanism,
        held: &held,
        size: extent(c.scene),
    };
    if let Some(placed) = closing.close(&mut state) {
        if let Some(error) = blame(c, &closing, &guessed, placed) {
            return Err(error);
        }
        state = close_or_explain(c, &closing, &guessed, placed)?;
    }
    check_turns(c, &mechanism, &state)?;
    check_sketch(c, &mechanism, &state)?;
    Ok((mechanism, state))
}

/// The gradients of all constraint rows with respect to the unknown coordinates.
pub(crate) fn constraint_rows(model: &Model, state: &State) -> Vec<SparseRow> {
    let n = model.shape().unknowns;
    let constraints = model.constraints.iter();
    let rows = constraints.flat_map(|placed| {
        let gradient = placed.term.gradient(state);
        gradient.into_iter().take(placed.rows).map(|gradient| {
            let entries = placed.block.coordinates.iter().copied().zip(gradient);
            entries.filter(|(i, _)| *i < n).collect()
        })
    });
    rows.collect()
}

/// Checks that no prescribed angle was closed half a turn off.
fn check_turns(c: &Compiler, model: &Model, state: &State) -> Result<(), SceneError> {
    let turned = |placed: &&PlacedConstraint| placed.term.half_turn(state);
    let Some(placed) = model.constraints.iter().find(turned) else {
        return Ok(());
    };
    let name = name(model, placed);
    let message = format!("{name} closes half a turn away from the angle it holds");
    let start = c.scene.initial.span;
    let error = c.scene.error(start, message, "from this start");
    Err(error.with_help("draw the mechanism closer to the pose you mean"))
}

/// The violation of a constraint in words, or that of its rate with `per` = "/s".
pub(crate) fn opening(term: &ConstraintTerm, value: f64, per: &str) -> String {
    numbers::si(value, &format!("{}{per}", term.unit()))
}

/// A pose of a mechanism that Newton's method alone does not close, or an error. This names the body that is larger than all others
/// together, if there is one and neither a guide nor a given pose explains the violation; otherwise the loop that stays open, its least
/// gap and the lengths that would close it.
fn close_or_explain(
    c: &Compiler,
    closing: &Closing,
    guessed: &State,
    placed: &PlacedConstraint,
) -> Result<State, SceneError> {
    let sizes = sizes(c.scene);
    let total: f64 = sizes.iter().sum();
    let holds = closing.held.contains(&true);
    let pinned = !holds && c.joints.iter().all(|joint| joint.coincides());
    if let Some(b) = sizes.iter().position(|s| pinned && *s > total - s) {
        let body = &c.scene.bodies[b];
        let message = format!(
            "the mechanism cannot be assembled: {} is {} m long, more than all other bodies together ({} m)",
            body.name,
            numbers::exact(sizes[b]),
            number(total - sizes[b], 4)
        );
        let label = "too large, or its unit is not the metre";
        return Err(c.scene.error(body.span, message, label));
    }
    let message = match closing.search(guessed, placed) {
        Search::Closed(state) => return Ok(*state),
        Search::Open(open) => open.in_words(c, closing.model),
        Search::TooLarge => format!(
            "{} stays open, in a part of the mechanism that is too large to search for its least gap",
            name(closing.model, placed)
        ),
    };
    let message = format!("the mechanism cannot be assembled: {message}");
    let start = c.scene.initial.span;
    let error = c.scene.error(start, message, "from this start");
    Err(error.with_help(format!(
        "check the given poses, the lengths{}, and that the sketch draws a mechanism that is closed",
        c.longest()
    )))
}

/// Name of a constraint: that of its first row.
pub(crate) fn name<'m>(model: &'m Model, placed: &PlacedConstraint) -> &'m str {
    &model.names[model.shape().unknowns + placed.row]
}

/// Name of a constraint without that of the row.
pub(crate) fn whole_name<'m>(model: &'m Model, placed: &PlacedConstraint) -> &'m str {
    let name = name(model, placed);
    name.split(" (").next().unwrap_or(name)
}

/// Position of a point of a body.
pub(super) fn position(model: &Model, state: &State, point: PointRef) -> Vec2 {
    model.position(&marker(model, point), state)
}

/// Largest permitted distance of a joint or point from its sketch \[m\].
fn reach(c: &Compiler, drawn: &SketchPoint) -> f64 {
    let size = |p: PointRef| {
        let body = &c.bodies[p.body];
        let points = body.points();
        let far = points.iter().map(|q| (q.at - points[p.point].at).norm());
        match (body.known(), body.length()) {
            (Some(_), _) => f64::INFINITY,
            (None, Some(length)) => length,
            (None, None) => match far.fold(0.0, f64::max) {
                0.0 => f64::INFINITY,
                far => far,
            },
        }
    };
    let sizes = c.sketched_points(drawn).into_iter().map(size);
    SKETCH * sizes.fold(f64::INFINITY, f64::min)
}

/// Sketched points that are too far from their sketch, and where they are. The guide's point of a prismatic joint is not the
/// position of the joint.
fn strays<'c>(
    c: &'c Compiler,
    model: &Model,
    state: &State,
) -> Vec<(&'c SketchPoint, PointRef, Vec2)> {
    let mut strays = Vec::new();
    for drawn in &c.scene.initial.sketch {
        for point in c.sketched_points(drawn) {
            let is_guide = match drawn.what {
                Sketched::Joint(j) => {
                    c.joints[j].line().is_some() && c.scene.joints[j].bearing == point
                }
                Sketched::Point(_) => false,
            };
            let at = position(model, state, point);
            // a distance that is no number strays too
            let near = (at - drawn.at).norm() <= reach(c, drawn);
            if !is_guide && !near {
                strays.push((drawn, point, at));
            }
        }
    }
    strays
}

/// Checks that sketched joints and points are near their sketch.
fn check_sketch(c: &Compiler, model: &Model, state: &State) -> Result<(), SceneError> {
    match strays(c, model, state).first() {
        Some((drawn, _, at)) => Err(c.far_from_sketch(drawn, *at)),
        None => Ok(()),
    }
}

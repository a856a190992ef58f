//! Degrees of freedom of the ideal mechanism, and how many of them are driven.

use super::redundancy::{Ranks, Redundancy};
use crate::compile::actuation::Actuation;
use crate::compile::assembly::closed;
use crate::compile::extent::extent;
use crate::model::Rule;
use crate::scene::{MotionKind, Scene};
use serde::Serialize;
use std::fmt::{Display, Formatter};

/// Degrees of freedom with rigid links and ideal joints.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub struct Freedoms {
    /// Those that drives prescribe.
    pub driven: usize,
    /// Those that they leave.
    pub left: usize,
    /// Prescribed coordinates that other constraints determine already.
    pub repeated: usize,
}

impl Freedoms {
    /// Those of a scene; none where the start is a singular pose, in which they cannot be counted, where no ideal mechanism fits
    /// the given states, or where a joint holds the body that follows a path on what is known.
    pub fn of(scene: &Scene) -> Option<Freedoms> {
        let prescribed = scene.motions.iter().map(|motion| match &motion.kind {
            MotionKind::Angle { .. } => 1,
            MotionKind::Point { coordinates, .. } => coordinates.iter().flatten().count(),
        });
        let driven = prescribed.sum::<usize>();
        if let Some(drive) = scene.drives.first() {
            // a path that does not determine the mechanism is refused, so what other drives prescribe repeats nothing
            let [followed, left] = Actuation::of(scene)?.freedoms()?;
            return Some(Freedoms {
                driven: driven + followed,
                left,
                repeated: drive.joints.len() - followed,
            });
        }
        let (model, state) = closed(scene).ok()?;
        let ranks = Ranks::of(&model, &state, extent(scene));
        let Redundancy::Rows(dependent) = ranks.redundancy() else {
            return None;
        };
        let shape = model.shape();
        let independent = shape.multipliers - dependent.len();
        let left = shape.unknowns.checked_sub(independent)?;
        // the rows of drives stand last, and a drive that turns a known body has none
        let turns = model
            .rules
            .iter()
            .filter(|r| matches!(r, Rule::Turn { .. }));
        let first = shape.multipliers - (driven - turns.count());
        let rows = dependent.iter().map(|(i, d)| model.constraints[*i].row + d);
        let repeated = rows.filter(|row| *row >= first).count();
        Some(Freedoms {
            driven: driven - repeated,
            left,
            repeated,
        })
    }
}

/// The bodies that the drives of a scene leave free to move, with rigid links and ideal joints; none where there is no drive or where
/// it is not known.
pub(crate) fn left_free(scene: &Scene) -> Option<Vec<usize>> {
    if !scene.drives.is_empty() {
        return Actuation::of(scene)?.left_free();
    }
    if scene.motions.is_empty() {
        return None;
    }
    let (model, state) = closed(scene).ok()?;
    let determined = Ranks::of(&model, &state, extent(scene)).determined();
    let bodies = model.bodies().iter().enumerate();
    let free = bodies.filter(|(_, body)| {
        let is_free = |i| {
            determined
                .get(i)
                .is_some_and(|is_determined| !is_determined)
        };
        body.coordinates().any(is_free)
    });
    Some(free.map(|(b, _)| b).collect())
}

impl Display for Freedoms {
    fn fmt(&self, f: &mut Formatter) -> std::fmt::Result {
        let Freedoms {
            driven,
            left,
            repeated,
        } = *self;
        let count = match driven + left {
            1 => "1 degree of freedom".to_owned(),
            all => format!("{all} degrees of freedom"),
        };
        match (driven, left) {
            (0, 0) => write!(f, "{count}"),
            (0, 1) => write!(f, "{count}, not driven"),
            (0, _) => write!(f, "{count}, none of them driven"),
            (1, 0) => write!(f, "{count}, driven"),
            (_, 0) => write!(f, "{count}, all of them driven"),
            (1, _) => write!(f, "1 of {count} is driven"),
            (_, _) => write!(f, "{driven} of {count} are driven"),
        }?;
        match repeated {
            0 => Ok(()),
            1 => write!(f, "; 1 prescribed coordinate repeats other constraints"),
            _ => write!(
                f,
                "; {repeated} prescribed coordinates repeat other constraints"
            ),
        }
    }
}

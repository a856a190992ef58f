//! Length of the next step: a grid of equal steps, or a controller with an error estimate.

use super::GRID_ROUNDING;
use super::control::Controller;
use crate::checkpoint::{Carried, Checkpoint, carried};
use crate::model::Model;
use crate::system::{Changed, State};

/// Equal steps from an anchor.
///
/// The grid restarts where a step is cut by a contact. The first step after an onset is half as long as the others. The force
/// grows as t^1.5 there, so this step alone has an error of h^2.5; with full length it would be as large as the error h^2 of
/// all other steps together. Measured on the instant of the fourth impact of case 3, h from 4e-6 to 5e-7 s: orders 2.4, 2.1, 2.2
/// with the half step, 1.7, 1.2, 1.8 without.
#[derive(Debug)]
pub(super) struct Grid {
    step: f64,
    anchor: f64,
    count: f64,
}

carried!(Grid { anchor, count } but { step });

/// Rule for the length of the next step.
#[derive(Debug)]
pub(super) enum Pacer {
    /// A grid.
    Grid(Grid),
    /// Control by the estimated error.
    Controller(Box<Controller>),
}

impl Pacer {
    /// Equal steps.
    pub fn grid(step: f64) -> Pacer {
        Pacer::Grid(Grid {
            step,
            anchor: 0.0,
            count: 0.0,
        })
    }

    /// Carries what later steps depend on.
    pub fn carry(&mut self, model: &Model, checkpoint: &mut Checkpoint) {
        match self {
            Pacer::Grid(grid) => grid.carry(checkpoint),
            Pacer::Controller(controller) => controller.carry(model, checkpoint),
        }
    }

    /// Multiply-adds that it has taken to judge steps, by their order of magnitude.
    pub fn operations(&self) -> u64 {
        match self {
            Pacer::Grid(_) => 0,
            Pacer::Controller(controller) => controller.operations(),
        }
    }

    /// Time \[s\] against which a step counts as short.
    pub fn scale(&self) -> f64 {
        match self {
            Pacer::Grid(grid) => grid.step,
            Pacer::Controller(controller) => controller.longest(),
        }
    }

    /// Begins a sequence of steps at t.
    pub fn begin(&mut self, t: f64) {
        if let Pacer::Grid(grid) = self {
            (grid.anchor, grid.count) = (t, 0.0);
        }
    }

    /// The end of the next step from t towards `target`.
    pub fn goal(&mut self, t: f64, target: f64) -> f64 {
        match self {
            Pacer::Grid(grid) => {
                grid.count += 1.0;
                let next = grid.anchor + grid.count * grid.step;
                if target - next < GRID_ROUNDING * grid.step {
                    target
                } else {
                    next
                }
            }
            Pacer::Controller(controller) => controller.goal(t, target),
        }
    }

    /// The motion goes on from a state that no step has led to.
    pub fn start(&mut self, at: &State) {
        if let Pacer::Controller(controller) = self {
            controller.start(at);
        }
    }

    /// The motion changes at an instant.
    pub fn forget(&mut self) {
        if let Pacer::Controller(controller) = self {
            controller.forget_last_step();
        }
    }

    /// Records an accepted step that was planned to end at `goal` and ends with these changes.
    pub fn kept(&mut self, at: &State, goal: f64, changed: &[Changed]) {
        match self {
            Pacer::Grid(grid) => {
                if changed.iter().any(|change| change.closed().is_some()) {
                    (grid.anchor, grid.count) = (at.t, -0.5);
                } else if at.t != goal {
                    (grid.anchor, grid.count) = (at.t, 0.0);
                }
            }
            Pacer::Controller(controller) => controller.kept(changed),
        }
    }
}

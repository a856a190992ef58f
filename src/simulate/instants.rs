//! Ends steps at instants: where functions of time are not smooth, and where the memory of a force may change.

use super::{Observer, RunError, Simulation};
use crate::model::{Instant, InstantKind, Model};
use crate::scene::Integrator;
use crate::system::System;

/// Up to this order a method keeps its order across a jump of a third derivative, which changes a position by h^4 at most.
const SMOOTH_ORDER: u32 = 3;

/// The instants at which steps of a method end, in their order.
pub(super) fn of_method(model: &Model, integrator: &Integrator) -> Vec<Instant> {
    let sees_knots = integrator.ends_at_knots && integrator.method.scheme.order > SMOOTH_ORDER;
    let all = model.instants.iter().copied();
    all.filter(|instant| sees_knots || instant.kind != InstantKind::Knot)
        .collect()
}

impl Simulation {
    /// The end of the steps from the present state towards `target`, and the instant of a function of time there.
    pub(super) fn stop(&self, target: f64) -> (f64, Option<Instant>) {
        let t = self.state.t;
        let next = self
            .instants
            .partition_point(|instant| instant.sides[1] <= t);
        let of_memory = target.min(self.model.next_instant(&self.state));
        match self.instants.get(next) {
            Some(instant) if instant.end() <= of_memory => (instant.end(), Some(*instant)),
            _ => (of_memory, None),
        }
    }

    /// Passes an instant of a function of time.
    ///
    /// # Errors
    /// When no accelerations follow it.
    pub(super) fn pass(
        &mut self,
        instant: Instant,
        observer: &mut dyn Observer,
    ) -> Result<(), RunError> {
        let Simulation {
            model,
            state,
            output,
            work,
            ..
        } = self;
        state.t = instant.sides[1];
        if instant.kind == InstantKind::Knot {
            return Ok(());
        }
        state.changes += 1;
        self.pacer.forget();
        if instant.kind == InstantKind::Kink {
            return Ok(());
        }
        output.copy_from(state);
        let followed = model.prescribe(output, state, work);
        followed.map_err(|error| self.failed(error.into(), 0.0))?;
        self.make_consistent()?;
        // what changes at this very instant
        self.model.crossings(&self.state, &mut self.crossings);
        self.commit(observer)?;
        self.model.crossings(&self.state, &mut self.first_crossings);
        Ok(())
    }

    /// Accelerations and powers follow a change of the forces.
    ///
    /// # Errors
    /// When there are no accelerations.
    pub(super) fn make_consistent(&mut self) -> Result<(), RunError> {
        let Simulation {
            model,
            state,
            newton,
            work,
            ..
        } = self;
        if let Err(failure) = newton.make_consistent(&**model, state, work) {
            return Err(self.failed(failure.into(), 0.0));
        }
        model.powers(state, work);
        Ok(())
    }
}

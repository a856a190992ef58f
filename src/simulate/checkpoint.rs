//! A run that is interrupted and goes on bit for bit.

use super::Simulation;
use crate::checkpoint::{Carried, Checkpoint, Misfit};
use crate::model::Model;
use crate::system::State;

impl Simulation {
    /// What the rest of the run depends on, beside the scene.
    pub(super) fn checkpoint(&mut self) -> Vec<u8> {
        Checkpoint::written(|checkpoint| self.carry(checkpoint))
    }

    /// Goes on from the bytes that a run of the same scene by the same program gave to [`super::Observer::checkpoint`].
    /// [`Simulation::run`] then records the rest of its rows.
    ///
    /// # Errors
    /// When the bytes are those of another scene or another program.
    pub fn restore(&mut self, bytes: Vec<u8>) -> Result<(), Misfit> {
        Checkpoint::read(bytes, |checkpoint| self.carry(checkpoint))
    }

    fn carry(&mut self, checkpoint: &mut Checkpoint) {
        let mut has_chosen = self.choice.is_some();
        has_chosen.carry(checkpoint);
        if has_chosen {
            // the trial runs start from the scene again and choose the same
            self.choose();
        }
        let Simulation {
            scene: _,
            model,
            start: _,
            stepper,
            pacer,
            instants: _,
            locates: _,
            leaves_out: _,
            newton,
            is_between_rows,
            stays_in_singular_pose,
            passes_singular_pose: _,
            work,
            state,
            // the length of the last step is reported
            trial: State { t: last, .. },
            output: _,
            recorder,
            measured: _,
            extremes,
            closing,
            strains,
            plausibility,
            impacts,
            closures,
            creep,
            meter,
            is_trial_run: _,
            choice: _,
            local_error: _,
            stall,
            counters,
            halved,
            crossings: _,
            first_crossings: _,
            last_crossings: _,
            inner_crossings: _,
            changed: _,
            // that of the start, which a fresh simulation has found
            rest: _,
            freedoms: _,
            course: _,
            // a static analysis has no checkpoints
            indeterminate: _,
            heading: _,
            critical_points: _,
            status: _,
            error: _,
            ended_at_limit: _,
        } = self;
        let model: &Model = model;
        pacer.carry(model, checkpoint);
        newton.carry(model, checkpoint);
        let parts: [&mut dyn Carried; 16] = [
            stepper,
            is_between_rows,
            stays_in_singular_pose,
            work,
            state,
            recorder,
            extremes,
            closing,
            strains,
            plausibility,
            impacts,
            closures,
            creep,
            meter,
            stall,
            counters,
        ];
        for part in parts {
            part.carry(checkpoint);
        }
        halved.carry(checkpoint);
        last.carry(checkpoint);
    }
}

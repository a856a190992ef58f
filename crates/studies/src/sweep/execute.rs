//! Makes the runs of a sweep on several threads.

use super::{RunStatus, Shard, Store, Sweep, SweepError, SweepRow};
use std::num::NonZeroUsize;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::thread;

/// A run has ended.
#[derive(Debug, Clone, Copy)]
pub struct SweepProgress<'a> {
    /// Runs of this part of the sweep that are made.
    pub done: usize,
    /// Runs of this part of the sweep that are still to be made, as far as that is known.
    pub left: usize,
    /// The run.
    pub row: &'a SweepRow,
}

impl SweepProgress<'_> {
    /// A line about a run that did not come to its end.
    pub fn fault(&self) -> Option<String> {
        let error = self.row.error.as_deref()?;
        let verb = match self.row.status {
            RunStatus::Refused => "cannot start",
            _ => "has failed",
        };
        Some(format!("run {} {verb}: {error}", self.row.run))
    }
}

/// Makes all runs of a shard that the store does not have. `told` is called after every run, by one thread at a time.
///
/// # Errors
/// [`SweepError::Interrupted`] after `stop` was raised; a row that cannot be written, or that somebody else has changed. Rows made
/// before stay in the store.
pub fn execute(
    sweep: &Sweep,
    store: &mut Store,
    shard: Shard,
    threads: NonZeroUsize,
    stop: &AtomicBool,
    told: &mut (dyn FnMut(SweepProgress) + Send),
) -> Result<(), SweepError> {
    loop {
        let pending = sweep.pending(store, shard)?;
        if pending.is_empty() {
            return store.refuse_changed();
        }
        let shared = Shared {
            done: store.made(shard),
            left: pending.len(),
            store,
            told,
            error: None,
        };
        round(sweep, shared, &pending, threads, stop)?;
        if stop.load(Ordering::Relaxed) && pending.iter().any(|run| !store.has(*run)) {
            return Err(SweepError::Interrupted {
                done: store.len(),
                total: sweep
                    .runs()
                    .map_or("the".to_owned(), |runs| runs.to_string()),
            });
        }
    }
}

/// What the threads share.
struct Shared<'a> {
    store: &'a mut Store,
    told: &'a mut (dyn FnMut(SweepProgress) + Send),
    done: usize,
    left: usize,
    /// The first error ends all threads.
    error: Option<SweepError>,
}

/// Makes some runs, the next one on the first thread that is free.
fn round(
    sweep: &Sweep,
    shared: Shared,
    pending: &[usize],
    threads: NonZeroUsize,
    stop: &AtomicBool,
) -> Result<(), SweepError> {
    let next = AtomicUsize::new(0);
    let shared = Mutex::new(shared);
    let work = || {
        while !stop.load(Ordering::Relaxed) {
            let Some(run) = pending.get(next.fetch_add(1, Ordering::Relaxed)) else {
                return;
            };
            let task = {
                let shared = shared.lock().expect("no thread panics");
                if shared.error.is_some() {
                    return;
                }
                sweep.task(shared.store, *run)
            };
            let made = task.map(|task| sweep.run(&task, stop));
            let mut shared = shared.lock().expect("no thread panics");
            // a row behind one that could not be written is not tried
            if shared.error.is_some() {
                return;
            }
            let kept = made.and_then(|made| match made {
                Some((row, timing)) => shared.store.append(&row, &timing).map(|()| Some(row)),
                None => Ok(None),
            });
            match kept {
                Ok(None) => {}
                Ok(Some(row)) => {
                    shared.done += 1;
                    shared.left -= 1;
                    let (done, left) = (shared.done, shared.left);
                    let row = &row;
                    (shared.told)(SweepProgress { done, left, row });
                }
                Err(error) => shared.error = Some(error),
            }
        }
    };
    thread::scope(|scope| {
        for _ in 1..threads.get().min(pending.len()) {
            // fewer threads do where the system allows no more
            if thread::Builder::new().spawn_scoped(scope, work).is_err() {
                break;
            }
        }
        work();
    });
    let shared = shared.into_inner().expect("no thread panics");
    shared.error.map_or(Ok(()), Err)
}

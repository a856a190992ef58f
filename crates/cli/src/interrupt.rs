//! Signals that end the program: Ctrl-C, a request to end, the end of the terminal.

use super::failure::{CommandFailure, INTERRUPTED};
use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
use signal_hook::flag;
use std::fs;
use std::io;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Whether a signal has come.
#[derive(Debug, Clone)]
pub struct Interrupt {
    has_come: Arc<AtomicBool>,
    /// The next signal ends the program at once.
    at_once: Arc<AtomicBool>,
}

impl Interrupt {
    /// Watches for signals. Before [`Interrupt::begin`] the first one ends the program: nothing is written yet. Later it is the
    /// second one.
    pub fn watch() -> Result<Interrupt, CommandFailure> {
        let interrupt = Interrupt {
            has_come: Arc::new(AtomicBool::new(false)),
            at_once: Arc::new(AtomicBool::new(true)),
        };
        for signal in [SIGINT, SIGTERM, SIGHUP] {
            if !is_ignored(signal) {
                interrupt.register(signal).map_err(|e| {
                    CommandFailure::system(format!("cannot watch for signal {signal}: {e}"))
                })?;
            }
        }
        Ok(interrupt)
    }

    fn register(&self, signal: i32) -> io::Result<()> {
        // in the order in which they are called
        flag::register_conditional_shutdown(signal, INTERRUPTED.into(), self.at_once.clone())?;
        flag::register(signal, self.has_come.clone())?;
        flag::register(signal, self.at_once.clone())?;
        Ok(())
    }

    /// From now on there is something to close.
    pub fn begin(&self) {
        self.at_once.store(false, Ordering::SeqCst);
    }

    /// True once a signal has come.
    pub fn has_come(&self) -> bool {
        self.flag().load(Ordering::Relaxed)
    }

    /// Raised by a signal.
    pub fn flag(&self) -> &AtomicBool {
        &self.has_come
    }
}

/// Sees that a file which grows beyond what the system allows it is an error of the call, which names the file: without this the signal
/// that comes with it ends the program.
pub fn survive_limits() -> Result<(), CommandFailure> {
    #[cfg(unix)]
    flag::register(libc::SIGXFSZ, Arc::default()).map_err(|e| {
        CommandFailure::system(format!("cannot watch for signal {}: {e}", libc::SIGXFSZ))
    })?;
    Ok(())
}

/// True of a signal that the surroundings have told the program not to hear, as `nohup` does; Linux alone says so.
fn is_ignored(signal: i32) -> bool {
    let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mut lines = status.lines();
    let mask = lines.find_map(|line| line.strip_prefix("SigIgn:"));
    let mask = mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok());
    mask.is_some_and(|mask| mask >> (signal - 1) & 1 == 1)
}

//! Counts of instructions, where the machine has them.

/// Counts the instructions of this thread from its start; nothing where the system or the processor gives no counts.
#[derive(Debug)]
pub struct Instructions {
    #[cfg(target_os = "linux")]
    counter: Option<perf_event::Counter>,
}

#[cfg(target_os = "linux")]
impl Instructions {
    /// Begins to count.
    pub fn start() -> Instructions {
        let begin = || {
            let mut counter = perf_event::Builder::new().build()?;
            counter.enable()?;
            Ok::<_, std::io::Error>(counter)
        };
        Instructions {
            counter: begin().ok(),
        }
    }

    /// Instructions so far. Virtual machines may have a counter that stays at zero.
    pub fn count(&mut self) -> Option<u64> {
        let count = self.counter.as_mut()?.read().ok()?;
        (count > 0).then_some(count)
    }
}

#[cfg(not(target_os = "linux"))]
impl Instructions {
    /// Nothing to count with.
    pub fn start() -> Instructions {
        Instructions {}
    }

    /// None.
    pub fn count(&mut self) -> Option<u64> {
        None
    }
}

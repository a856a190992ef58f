//! Processor times of repeated runs: where they were measured, with what, and their middle; counts of instructions, where the
//! machine has them.

use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use std::fmt;
use std::path::Path;
use std::process::Command;

/// What a time depends on beside the program's own text.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Machine {
    /// Processor, threads, system.
    pub processor: String,
    /// Compiler that this program was built with.
    pub compiler: &'static str,
    /// Commit of the source, `+` behind it where files differ from it; absent outside a repository.
    pub commit: Option<String>,
    /// SHA-256 of Cargo.lock, the first sixteen digits; absent where the file is.
    pub lock: Option<String>,
}

impl fmt::Display for Machine {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let [commit, lock] = [&self.commit, &self.lock].map(|x| x.as_deref().unwrap_or("unknown"));
        let (processor, compiler) = (&self.processor, self.compiler);
        write!(
            f,
            "{processor}; {compiler}; commit {commit}, Cargo.lock {lock}"
        )
    }
}

/// This machine and this program.
pub fn machine() -> Machine {
    let own = Path::new(env!("CARGO_MANIFEST_DIR"));
    // the lock of the workspace stands above this package
    let root = own
        .ancestors()
        .find(|folder| folder.join("Cargo.lock").exists());
    let root = root.unwrap_or(own);
    let describe = [
        "describe",
        "--always",
        "--abbrev=12",
        "--dirty=+",
        "--exclude=*",
    ];
    let commit = Command::new("git")
        .arg("-C")
        .arg(root)
        .args(describe)
        .output();
    let commit = commit.ok().filter(|output| output.status.success());
    let digest = |bytes: Vec<u8>| Sha256::digest(&bytes);
    let digest = std::fs::read(root.join("Cargo.lock")).ok().map(digest);
    Machine {
        processor: looselink::output::machine(),
        compiler: env!("LOOSELINK_COMPILER"),
        commit: commit.map(|output| String::from_utf8_lossy(&output.stdout).trim().to_owned()),
        lock: digest.map(|digest| numbers::hexadecimal(&digest[..8])),
    }
}

/// Counts the instructions of this thread from now on. What is returned gives their number so far; nothing where the system or
/// the processor gives no counts.
#[cfg(target_os = "linux")]
pub fn count_instructions() -> impl FnMut() -> Option<u64> {
    let begin = || {
        let mut counter = perf_event::Builder::new().build()?;
        counter.enable()?;
        Ok::<_, std::io::Error>(counter)
    };
    let mut counter = begin().ok();
    move || {
        let count = counter.as_mut()?.read().ok()?;
        // virtual machines may have a counter that stays at zero
        (count > 0).then_some(count)
    }
}

/// There is nothing to count with.
#[cfg(not(target_os = "linux"))]
pub fn count_instructions() -> impl FnMut() -> Option<u64> {
    || None
}

/// Processor time of a run that was made several times \[s\].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RunTiming {
    /// See [`median`]; of a single run its time.
    pub median: f64,
    /// Shortest.
    pub least: f64,
    /// Every time, in the order of the runs.
    pub seconds: Vec<f64>,
    /// Least number of instructions, where the machine counts them.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub instructions: Option<u64>,
}

impl RunTiming {
    /// Of at least one measured time \[s\].
    pub fn of(seconds: Vec<f64>) -> RunTiming {
        RunTiming {
            median: median(&seconds),
            least: seconds.iter().copied().fold(f64::INFINITY, f64::min),
            seconds,
            instructions: None,
        }
    }

    /// With the numbers of instructions of the same runs.
    pub fn with_instructions(self, counts: &[Option<u64>]) -> RunTiming {
        RunTiming {
            instructions: counts.iter().flatten().min().copied(),
            ..self
        }
    }
}

/// The value in the middle of at least one; of an even number of values the mean of the two in the middle.
pub fn median(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let n = sorted.len();
    0.5 * (sorted[(n - 1) / 2] + sorted[n / 2])
}

#[cfg(test)]
mod tests {
    use super::{RunTiming, median};

    #[test]
    fn medians() {
        let timing = RunTiming::of(vec![9.0, 1.0, 2.0]);
        assert_eq!((timing.median, timing.least), (2.0, 1.0));
        assert_eq!(timing.seconds, [9.0, 1.0, 2.0]);
        let counted = timing.with_instructions(&[Some(70), None, Some(50)]);
        assert_eq!((counted.median, counted.instructions), (2.0, Some(50)));
        assert_eq!(median(&[3.0]), 3.0);
        assert_eq!(median(&[9.0, 1.0, 2.0]), 2.0);
        assert_eq!(median(&[4.0, 1.0, 9.0, 2.0]), 3.0);
    }
}

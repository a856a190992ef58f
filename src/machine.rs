//! Processor times of repeated runs: where they were measured, with what, and their middle.

use serde::Serialize;
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
        let Machine {
            processor,
            compiler,
            ..
        } = self;
        write!(
            f,
            "{processor}; {compiler}; commit {commit}, Cargo.lock {lock}"
        )
    }
}

/// This machine and this program.
pub fn machine() -> Machine {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let git = |arguments: &[&str]| {
        let output = Command::new("git")
            .arg("-C")
            .arg(root)
            .args(arguments)
            .output()
            .ok()?;
        let text = String::from_utf8(output.stdout).ok()?;
        output.status.success().then(|| text.trim().to_owned())
    };
    let commit = git(&["rev-parse", "--short=12", "HEAD"]).map(|commit| {
        let changed = git(&["status", "--porcelain", "--untracked-files=no"]);
        let mark = if changed.is_some_and(|c| !c.is_empty()) {
            "+"
        } else {
            ""
        };
        commit + mark
    });
    let lock = std::fs::read(root.join("Cargo.lock")).ok().map(|bytes| {
        let digest = Sha256::digest(&bytes);
        digest[..8]
            .iter()
            .map(|byte| format!("{byte:02x}"))
            .collect()
    });
    Machine {
        processor: crate::output::machine(),
        compiler: env!("LOOSELINK_COMPILER"),
        commit,
        lock,
    }
}

/// Processor time of a run \[s\].
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Timing {
    /// Median of the repeats; of an even number of them the mean of the two in the middle.
    pub median: f64,
    /// Shortest.
    pub least: f64,
    /// Number of repeats.
    pub repeats: usize,
    /// Least number of instructions, where the machine counts them.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub instructions: Option<u64>,
}

impl Timing {
    /// Of at least one measured time \[s\].
    pub fn of(mut seconds: Vec<f64>) -> Timing {
        seconds.sort_by(f64::total_cmp);
        let n = seconds.len();
        Timing {
            median: 0.5 * (seconds[(n - 1) / 2] + seconds[n / 2]),
            least: seconds[0],
            repeats: n,
            instructions: None,
        }
    }

    /// With the numbers of instructions of the same runs.
    pub fn with_instructions(self, counts: &[Option<u64>]) -> Timing {
        Timing {
            instructions: counts.iter().flatten().min().copied(),
            ..self
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Timing;

    #[test]
    fn medians() {
        let median = |seconds: &[f64]| Timing::of(seconds.to_vec()).median;
        assert_eq!(median(&[3.0]), 3.0);
        assert_eq!(median(&[9.0, 1.0, 2.0]), 2.0);
        assert_eq!(median(&[4.0, 1.0, 9.0, 2.0]), 3.0);
    }
}

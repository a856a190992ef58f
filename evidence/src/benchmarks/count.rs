//! Instructions, counted by Valgrind's callgrind in a program.

use crate::benchmarks::steps::{STEP, StepRow};
use miette::{IntoDiagnostic, Result, WrapErr, ensure, miette};
use std::path::Path;
use std::process::Command;

/// Ends of the two runs whose difference is counted, or timed \[s\].
pub const ENDS: [f64; 2] = [0.002, 0.012];

/// The function that a run is inside of from its first row to its last.
pub const RUN: &str = "*Simulation*run_to_end*";

/// Longer than any run \[s\]: a checkpoint, which a slow run writes, takes a digest of the program: more instructions than the run.
const NEVER: &str = "1e6";

/// Instructions of one step of the program `looselink`, without what it does before and after the motion.
///
/// # Errors
/// When Valgrind is missing or a run fails.
pub fn per_step(program: &Path, root: &Path, row: &StepRow) -> Result<u64> {
    let [short, long] = ENDS.map(|end| {
        let folder = tempfile::tempdir().into_diagnostic()?;
        let mut command = Command::new(program);
        command.current_dir(root).arg("run").arg(&row.scene);
        for change in row.overrides(end) {
            command.args(["--set", &change]);
        }
        command.args(["--checkpoint", NEVER, "--out"]);
        instructions_inside(RUN, command.arg(folder.path().join("out")))
    });
    let steps = ((ENDS[1] - ENDS[0]) / STEP).round() as u64;
    let taken = long.and_then(|long| Ok(long - short?));
    Ok(taken.wrap_err_with(|| row.name.clone())? / steps)
}

/// Instructions of a command while it is inside a function, whose name may have `*` for anything.
///
/// # Errors
/// When Valgrind is missing or the command fails.
pub fn instructions_inside(function: &str, run: &Command) -> Result<u64> {
    let toggle = format!("--toggle-collect={function}");
    instructions(&["--collect-atstart=no", &toggle], run).wrap_err_with(|| function.to_owned())
}

fn instructions(options: &[&str], run: &Command) -> Result<u64> {
    let folder = tempfile::tempdir().into_diagnostic()?;
    let profile = folder.path().join("callgrind.out");
    let mut valgrind = Command::new("valgrind");
    if let Some(folder) = run.get_current_dir() {
        valgrind.current_dir(folder);
    }
    valgrind.arg("--tool=callgrind").args(options);
    valgrind.arg(format!("--callgrind-out-file={}", profile.display()));
    let output = valgrind
        .arg(run.get_program())
        .args(run.get_args())
        .output();
    let output = output
        .into_diagnostic()
        .wrap_err("cannot start valgrind, which counts instructions")?;
    let said = String::from_utf8_lossy(&output.stderr);
    ensure!(
        output.status.success(),
        "the run under Valgrind failed:\n{said}"
    );
    let text = std::fs::read_to_string(&profile).into_diagnostic()?;
    let total = text.lines().find_map(|line| line.strip_prefix("totals: "));
    let total = total.and_then(|total| total.trim().parse().ok());
    total.ok_or_else(|| miette!("Valgrind gave no count"))
}

//! Steps of today and of the baseline, side by side.

use crate::baseline;
use crate::count::{OperationTable, STEP, StepCount, command, per_step};
use crate::gate::StepCounts;
use crate::list::{StepList, StepRow};
use miette::{IntoDiagnostic, Result, WrapErr, miette};
use serde::{Deserialize, Serialize};
use std::path::Path;
use studies::machine::median;

/// Ends of the two runs whose difference is timed \[s\].
const ENDS: [f64; 2] = [0.002, 0.052];

/// A step, counted and timed.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct StepCost {
    /// Its name.
    pub name: String,
    /// Present counts.
    pub now: StepCount,
    /// Counts of the baseline; absent where it does not know the method.
    pub before: Option<StepCount>,
    /// Present processor time over that of the baseline.
    pub time_ratio: Option<f64>,
    /// Present processor time \[s\].
    pub seconds: f64,
}

/// Times all steps of the list and counts those of the baseline; programs take turns in each of the timed runs.
///
/// # Errors
/// When a program cannot be built or run.
pub fn measure(
    root: &Path,
    program: &Path,
    counts: &StepCounts,
    repeats: usize,
) -> Result<Vec<StepCost>> {
    let list = StepList::read(root)?;
    let earlier = baseline::program(root, &list.baseline)?;
    let earlier_costs = OperationTable::of(&earlier)?;
    let mut all = Vec::new();
    for row in &list.steps {
        eprintln!("{}", row.name);
        let known = seconds(&earlier, root, row, ENDS[0])?.is_some();
        let mut times = [Vec::new(), Vec::new()];
        for _ in 0..repeats {
            times[0].push(per_step_seconds(program, root, row)?);
            if known {
                times[1].push(per_step_seconds(&earlier, root, row)?);
            }
        }
        let before = || per_step(&earlier, root, row, &earlier_costs);
        let now = median(&times[0]);
        all.push(StepCost {
            name: row.name.clone(),
            now: counts[&row.name],
            before: known.then(before).transpose()?,
            time_ratio: known.then(|| now / median(&times[1])),
            seconds: now,
        });
    }
    match all.iter().any(|step: &StepCost| step.before.is_some()) {
        true => Ok(all),
        false => Err(miette!(
            "the baseline {} refuses every scene",
            list.baseline
        )),
    }
}

/// Processor time of a step \[s\].
fn per_step_seconds(program: &Path, root: &Path, row: &StepRow) -> Result<f64> {
    let run = |end| {
        let seconds = seconds(program, root, row, end)?;
        seconds.ok_or_else(|| miette!("{}: the run failed", row.name))
    };
    let steps = (ENDS[1] - ENDS[0]) / STEP;
    Ok((run(ENDS[1])? - run(ENDS[0])?) / steps)
}

/// Processor time of a run \[s\], as it reports it; nothing if the program refuses the scene.
fn seconds(program: &Path, root: &Path, row: &StepRow, end: f64) -> Result<Option<f64>> {
    #[derive(Deserialize)]
    struct ProcessorSeconds {
        cpu_seconds: f64,
    }
    let folder = tempfile::tempdir().into_diagnostic()?;
    let out = folder.path().join("out");
    let output = command(program, root, row, end, &out).output();
    let output = output.into_diagnostic()?;
    if output.status.code() == Some(2) {
        return Ok(None);
    }
    if !output.status.success() {
        let said = String::from_utf8_lossy(&output.stderr);
        return Err(miette!("{}: {said}", row.name));
    }
    let text = std::fs::read_to_string(out.join("timing.json")).into_diagnostic()?;
    let timing: ProcessorSeconds = serde_json::from_str(&text)
        .into_diagnostic()
        .wrap_err("timing.json has no processor time")?;
    Ok(Some(timing.cpu_seconds))
}

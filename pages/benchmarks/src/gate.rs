//! The recorded numbers of instructions of every step, and whether the present program still has them. They are those of the
//! profile of the tests, which have compiled the program already.

use crate::count::{OperationTable, StepCount, per_step};
use crate::list::StepList;
use miette::{IntoDiagnostic, Result, WrapErr, ensure, miette};
use numbers::percent;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use studies::machine::machine;

/// Relative difference of two numbers of instructions that counts as a change: the sizes of addresses and environments move
/// counts by a few per mille.
const CHANGE: f64 = 0.02;

/// What is recorded.
#[derive(Serialize, Deserialize)]
struct RecordedCounts {
    /// The compiler decides on instructions.
    compiler: String,
    steps: StepCounts,
}

/// Counts of all steps by name.
pub type StepCounts = BTreeMap<String, StepCount>;

/// Counts all steps and records them.
///
/// # Errors
/// When Valgrind or the program is missing.
pub fn record(root: &Path) -> Result<()> {
    let counts = RecordedCounts {
        compiler: machine().compiler.to_owned(),
        steps: count(root, &program()?)?,
    };
    let text = serde_json::to_string_pretty(&counts).into_diagnostic()?;
    std::fs::write(path(root), text + "\n").into_diagnostic()
}

/// Counts all steps and compares them with those recorded by the same compiler.
///
/// # Errors
/// When Valgrind or the program is missing, and where a count differs.
pub fn check(root: &Path) -> Result<()> {
    let path = path(root);
    let text = std::fs::read_to_string(&path)
        .into_diagnostic()
        .wrap_err_with(|| format!("cannot read {}", path.display()))?;
    let recorded: RecordedCounts = serde_json::from_str(&text).into_diagnostic()?;
    let compiler = machine().compiler;
    if recorded.compiler != compiler {
        let before = &recorded.compiler;
        eprintln!("instructions were not compared: recorded with {before}, this is {compiler}");
        return Ok(());
    }
    let changed = changes(&recorded.steps, &count(root, &program()?)?);
    match changed.is_empty() {
        true => Ok(()),
        false => Err(miette!(
            help = "`cargo run -p benchmarks -- count` records the present counts",
            "the instructions of a step have changed:\n{}",
            changed.join("\n")
        )),
    }
}

fn path(root: &Path) -> PathBuf {
    root.join("pages/benchmarks/counts.json")
}

/// The program that the tests have compiled.
fn program() -> Result<PathBuf> {
    ensure!(
        cfg!(debug_assertions),
        help = "without --release",
        "counts are recorded and compared with the profile of the tests"
    );
    let own = std::env::current_exe().into_diagnostic()?;
    let path = own.with_file_name("looselink").canonicalize();
    path.map_err(|_| {
        miette!(
            help = "`cargo build --workspace` makes it",
            "there is no program looselink beside {}",
            own.display()
        )
    })
}

/// Counts all steps of a program.
///
/// # Errors
/// When Valgrind is missing.
pub fn count(root: &Path, program: &Path) -> Result<StepCounts> {
    let costs = OperationTable::of(program)?;
    let mut steps = BTreeMap::new();
    for row in StepList::read(root)?.steps {
        let count = per_step(program, root, &row, &costs)?;
        println!(
            "{:40} {:>9} instructions a step",
            row.name, count.instructions
        );
        steps.insert(row.name, count);
    }
    Ok(steps)
}

/// Steps whose counts differ by more than [`CHANGE`], in either direction, or that only one side has.
fn changes(recorded: &StepCounts, counted: &StepCounts) -> Vec<String> {
    let mut changes = Vec::new();
    for (name, count) in counted {
        let Some(earlier) = recorded.get(name) else {
            changes.push(format!("{name}: not recorded"));
            continue;
        };
        let (now, before) = (count.instructions as f64, earlier.instructions as f64);
        let change = now / before - 1.0;
        if change.abs() > CHANGE {
            changes.push(format!(
                "{name}: {} instead of {} instructions, {}{}",
                count.instructions,
                earlier.instructions,
                if change > 0.0 { "+" } else { "" },
                percent(change)
            ));
        }
    }
    let gone = recorded.keys().filter(|name| !counted.contains_key(*name));
    changes.extend(gone.map(|name| format!("{name}: recorded, but not in the list")));
    changes
}

#[cfg(test)]
mod tests {
    use super::changes;
    use crate::count::StepCount;

    #[test]
    fn a_count_may_differ_by_two_per_cent() {
        let counts = |instructions: &[u64]| {
            let names = ["a", "b", "c"].map(str::to_owned).into_iter();
            let counts = instructions.iter().map(|n| StepCount {
                instructions: *n,
                operations: 0,
            });
            names.zip(counts).collect()
        };
        assert!(changes(&counts(&[1000, 500]), &counts(&[1019, 491])).is_empty());
        let changed = changes(&counts(&[1000, 500]), &counts(&[1021, 489]));
        assert_eq!(changed.len(), 2, "{changed:?}");
        assert!(
            changed[0].starts_with("a: 1021 instead of 1000"),
            "{changed:?}"
        );
        assert_eq!(
            changes(&counts(&[1000]), &counts(&[1000, 5])),
            ["b: not recorded"]
        );
        assert_eq!(
            changes(&counts(&[1000, 5]), &counts(&[1000])),
            ["b: recorded, but not in the list"]
        );
    }
}

//! The recorded numbers of instructions of every step, and whether the present program still has them. They are those of the
//! profile of the tests, which have compiled the program already.

use crate::benchmarks::{count, program, steps};
use miette::{IntoDiagnostic, Result, WrapErr, ensure};
use numbers::percent;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::fs::OpenOptions;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use studies::machine::machine;

/// Relative difference of two numbers of instructions that counts as a change: the sizes of addresses and environments move
/// counts by a few per mille.
const CHANGE: f64 = 0.02;

/// Instructions of all steps by name.
type StepCounts = BTreeMap<String, u64>;

/// `evidence/counts.json`
#[derive(Serialize, Deserialize)]
struct RecordedCounts {
    /// The compiler decides on instructions.
    compiler: String,
    steps: StepCounts,
}

/// Counts all steps and records them.
///
/// # Errors
/// When Valgrind or the program is missing.
pub fn record(root: &Path) -> Result<()> {
    let counts = RecordedCounts {
        compiler: machine().compiler.to_owned(),
        steps: count(root)?,
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
    let (compiler, before) = (machine().compiler, &recorded.compiler);
    if before != compiler {
        return skip(&format!(
            "the instructions of a step (recorded with {before}, this is {compiler})"
        ));
    }
    let changed = changes(&recorded.steps, &count(root)?);
    ensure!(
        changed.is_empty(),
        help = "`cargo run -p evidence -- count` records the present counts",
        "the instructions of a step have changed:\n{}",
        changed.join("\n")
    );
    Ok(())
}

/// Names what is skipped, in the list of the gate where there is one.
fn skip(what: &str) -> Result<()> {
    println!("skipped: {what}");
    let Some(list) = std::env::var_os("LOOSELINK_SKIPPED") else {
        return Ok(());
    };
    let list = OpenOptions::new().append(true).create(true).open(list);
    writeln!(list.into_diagnostic()?, "{what}").into_diagnostic()
}

fn path(root: &Path) -> PathBuf {
    root.join("evidence/counts.json")
}

fn count(root: &Path) -> Result<StepCounts> {
    ensure!(
        cfg!(debug_assertions),
        help = "without --release",
        "counts are recorded and compared with the profile of the tests"
    );
    let program = program()?;
    let counted = steps::read(root)?.into_iter().map(|row| {
        let instructions = count::per_step(&program, root, &row)?;
        println!("{:40} {instructions:>9} instructions a step", row.name);
        Ok((row.name, instructions))
    });
    counted.collect()
}

/// Steps whose counts differ by more than [`CHANGE`], in either direction, or that only one side has.
fn changes(recorded: &StepCounts, counted: &StepCounts) -> Vec<String> {
    let compare = |(name, now): (&String, &u64)| {
        let Some(before) = recorded.get(name) else {
            return Some(format!("{name}: not recorded"));
        };
        let change = *now as f64 / *before as f64 - 1.0;
        let sign = if change > 0.0 { "+" } else { "" };
        let said = format!(
            "{name}: {now} instead of {before} instructions, {sign}{}",
            percent(change)
        );
        (change.abs() > CHANGE).then_some(said)
    };
    let gone = recorded.keys().filter(|name| !counted.contains_key(*name));
    let gone = gone.map(|name| format!("{name}: recorded, but not in the list"));
    counted.iter().filter_map(compare).chain(gone).collect()
}

#[cfg(test)]
mod tests {
    use super::changes;

    #[test]
    fn a_count_may_differ_by_two_per_cent() {
        let counts = |instructions: &[u64]| {
            let names = ["a", "b", "c"].map(str::to_owned).into_iter();
            names.zip(instructions.iter().copied()).collect()
        };
        assert!(changes(&counts(&[1000, 500]), &counts(&[1019, 491])).is_empty());
        let changed = changes(&counts(&[1000, 500]), &counts(&[1021, 489]));
        assert_eq!(changed.len(), 2, "{changed:?}");
        assert!(
            changed[0].starts_with("a: 1021 instead of 1000"),
            "{changed:?}"
        );
        let one_more = changes(&counts(&[1000]), &counts(&[1000, 5]));
        assert_eq!(one_more, ["b: not recorded"]);
        let one_less = changes(&counts(&[1000, 5]), &counts(&[1000]));
        assert_eq!(one_less, ["b: recorded, but not in the list"]);
    }
}

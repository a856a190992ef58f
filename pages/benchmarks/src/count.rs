//! Instructions and floating-point operations of a step, counted by Valgrind's callgrind in the program `looselink`.

use crate::list::StepRow;
use miette::{IntoDiagnostic, Result, WrapErr, miette};
use serde::{Deserialize, Serialize};
use std::collections::HashMap;
use std::path::Path;
use std::process::Command;

/// Step of all rows \[s\].
pub const STEP: f64 = 1e-5;
/// Ends of the two runs whose difference is counted \[s\].
const ENDS: [f64; 2] = [0.002, 0.012];

/// What a step takes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct StepCount {
    /// Instructions.
    pub instructions: u64,
    /// Additions, subtractions, multiplications, divisions and roots of floating-point numbers, one for every number of a
    /// vector; outside the program, in the mathematical library, they are not counted.
    pub operations: u64,
}

/// Counts one step.
///
/// # Errors
/// When Valgrind or objdump is missing, or a run fails.
pub fn per_step(
    program: &Path,
    root: &Path,
    row: &StepRow,
    costs: &OperationTable,
) -> Result<StepCount> {
    let [short, long] = ENDS.map(|end| of_run(program, root, row, end, costs));
    let (short, long) = (short?, long?);
    let steps = ((ENDS[1] - ENDS[0]) / STEP).round() as u64;
    Ok(StepCount {
        instructions: (long.instructions - short.instructions) / steps,
        operations: (long.operations - short.operations) / steps,
    })
}

/// Longer than any run \[s\].
const NEVER: &str = "1e6";

/// The command line of a run that records almost nothing. A checkpoint, which a slow run writes, takes a digest of the program: more
/// instructions than the run.
pub fn command(program: &Path, root: &Path, row: &StepRow, end: f64, out: &Path) -> Command {
    let mut command = Command::new(program);
    command.current_dir(root).arg("run").arg(&row.scene);
    let own = [
        format!("simulation.duration={end}"),
        format!("integrator.step={STEP}"),
        "output.interval=1e-3".to_owned(),
    ];
    for change in own.iter().chain(&row.set) {
        command.args(["--set", change]);
    }
    command.args(["--checkpoint", NEVER]).arg("--out").arg(out);
    command
}

/// Counts of a whole run.
fn of_run(
    program: &Path,
    root: &Path,
    row: &StepRow,
    end: f64,
    costs: &OperationTable,
) -> Result<StepCount> {
    let folder = tempfile::tempdir().into_diagnostic()?;
    let run = command(program, root, row, end, &folder.path().join("out"));
    let options = [
        "--dump-instr=yes",
        "--compress-pos=no",
        "--compress-strings=no",
    ];
    let text = profile(&options, &run, &row.name)?;
    let program = program.display().to_string();
    let count = read(&text, &program, costs);
    count.ok_or_else(|| miette!("{}: Valgrind gave no count", row.name))
}

/// Instructions of a command while it is inside a function, whose name may have `*` for anything.
///
/// # Errors
/// When Valgrind is missing or the command fails.
pub fn instructions_inside(function: &str, run: &Command) -> Result<u64> {
    let options = [
        "--collect-atstart=no".to_owned(),
        format!("--toggle-collect={function}"),
    ];
    let text = profile(&options.each_ref().map(String::as_str), run, function)?;
    total(&text).ok_or_else(|| miette!("{function}: Valgrind gave no count"))
}

/// All instructions of a profile.
fn total(profile: &str) -> Option<u64> {
    let mut lines = profile.lines();
    let total = lines.find_map(|line| line.strip_prefix("totals: "));
    total?.trim().parse().ok()
}

/// What callgrind writes of a command.
fn profile(options: &[&str], run: &Command, what: &str) -> Result<String> {
    let folder = tempfile::tempdir().into_diagnostic()?;
    let profile = folder.path().join("callgrind.out");
    let mut valgrind = Command::new("valgrind");
    if let Some(folder) = run.get_current_dir() {
        valgrind.current_dir(folder);
    }
    let output = valgrind
        .arg("--tool=callgrind")
        .args(options)
        .arg(format!("--callgrind-out-file={}", profile.display()))
        .arg(run.get_program())
        .args(run.get_args())
        .output()
        .into_diagnostic()
        .wrap_err("cannot start valgrind, which counts instructions")?;
    if !output.status.success() {
        let said = String::from_utf8_lossy(&output.stderr);
        return Err(miette!("{what}: the run under Valgrind failed:\n{said}"));
    }
    std::fs::read_to_string(&profile).into_diagnostic()
}

/// The numbers of floating-point operations of the instructions of a program, by their addresses.
pub struct OperationTable(HashMap<u64, u64>);

impl OperationTable {
    /// From what objdump says of a program.
    ///
    /// # Errors
    /// When objdump is missing or fails.
    pub fn of(program: &Path) -> Result<OperationTable> {
        let output = Command::new("objdump")
            .args(["--disassemble", "--no-show-raw-insn"])
            .arg(program)
            .output()
            .into_diagnostic()
            .wrap_err("cannot start objdump, which reads the instructions of a program")?;
        if !output.status.success() {
            let said = String::from_utf8_lossy(&output.stderr);
            return Err(miette!("objdump failed: {said}"));
        }
        let said = String::from_utf8_lossy(&output.stdout);
        Ok(OperationTable(
            said.lines().filter_map(operations).collect(),
        ))
    }
}

/// Address and number of floating-point operations of a line such as `  4f3a:  mulpd  %xmm1,%xmm0`, where there are any.
fn operations(line: &str) -> Option<(u64, u64)> {
    let (address, instruction) = line.split_once(":\t")?;
    let address = u64::from_str_radix(address.trim(), 16).ok()?;
    let mnemonic = instruction.split_whitespace().next()?;
    let fused = mnemonic.starts_with("vfm") || mnemonic.starts_with("vfnm");
    let plain = mnemonic.strip_prefix('v').unwrap_or(mnemonic);
    let arithmetic = ["add", "sub", "mul", "div", "sqrt", "hadd"];
    let known = arithmetic.iter().any(|name| {
        let rest = plain.strip_prefix(name);
        rest.is_some_and(|rest| rest == "sd" || rest == "pd")
    });
    if !known && !fused {
        return None;
    }
    let lanes = match (mnemonic.ends_with("pd"), instruction.contains("%ymm")) {
        (false, _) => 1,
        (true, false) => 2,
        (true, true) => 4,
    };
    Some((address, lanes * if fused { 2 } else { 1 }))
}

/// Counts in a profile whose lines of cost are `0xaddress line count`. The line after `calls=` repeats costs of the function called.
fn read(profile: &str, program: &str, costs: &OperationTable) -> Option<StepCount> {
    let mut operations = 0;
    let (mut own, mut skip) = (false, false);
    for line in profile.lines() {
        if let Some(object) = line.strip_prefix("ob=") {
            own = object == program;
        } else if line.starts_with("calls=") {
            skip = true;
        } else if let Some(cost) = line.strip_prefix("0x") {
            if own && !skip {
                let mut words = cost.split_whitespace();
                let address = u64::from_str_radix(words.next()?, 16).ok()?;
                let count: u64 = words.nth(1)?.parse().ok()?;
                operations += count * costs.0.get(&address).copied().unwrap_or(0);
            }
            skip = false;
        }
    }
    Some(StepCount {
        instructions: total(profile)?,
        operations,
    })
}

#[cfg(test)]
mod tests {
    use super::{OperationTable, StepCount, operations, read};

    #[test]
    fn lanes_of_vectors_count_one_by_one() {
        let count = |text: &str| operations(&format!("  4f3a:\t{text}")).map(|(_, count)| count);
        assert_eq!(count("addsd  %xmm1,%xmm0"), Some(1));
        assert_eq!(count("mulpd  0x10(%rdi),%xmm0"), Some(2));
        assert_eq!(count("vmulpd %ymm1,%ymm2,%ymm0"), Some(4));
        assert_eq!(count("vfmadd231sd %xmm1,%xmm2,%xmm0"), Some(2));
        assert_eq!(count("movapd %xmm1,%xmm0"), None);
        assert_eq!(count("addq   $0x8,%rsp"), None);
    }

    #[test]
    fn a_profile_counts_the_program_and_not_what_it_calls() {
        let costs = OperationTable([(0x10, 1), (0x14, 2)].into());
        let profile = "ob=/bin/p\nfl=???\nfn=f\n0x10 0 5\n0x14 3 7\ncalls=1 0x99 0\n0x14 0 400\n0x18 0 9\n\
                       ob=/lib/m\nfn=g\n0x10 0 50\n\ntotals: 1000\n";
        let expected = StepCount {
            instructions: 1000,
            operations: 5 + 2 * 7,
        };
        assert_eq!(read(profile, "/bin/p", &costs), Some(expected));
        assert_eq!(read("ob=/bin/p\n", "/bin/p", &costs), None);
    }
}

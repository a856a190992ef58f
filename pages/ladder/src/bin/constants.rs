//! Changes every number of the element and of Bathe's scheme by a millionth of the largest in its table, one at a time in a
//! copy of the workspace, and records in `constants.json` which property tests fail. It fails when a number can be changed
//! without any of them noticing.

use clap::Parser;
use ladder::constants::{ConstantsRecord, Number, path};
use ladder::seeded::WorkspaceCopy;
use miette::{IntoDiagnostic, Result, WrapErr, miette};
use records::RunningCampaign;
use std::fs;

/// The property tests.
const TESTS: [&str; 3] = [
    "mass_is_symmetric_positive_definite_with_total_first_moment_and_inertia_about_both_ends",
    "jacobian_of_every_route_is_the_derivative_of_its_force_and_both_are_those_of_gauss_quadrature",
    "bathe_loses_energy_of_linear_systems_from_the_first_step_as_the_spectral_formula_says",
];

/// By which part of the largest number of its table a number is changed.
const CHANGE: f64 = 1e-6;

/// Numbers that stand between two texts of a file, with commas between them.
struct NumberTable {
    name: &'static str,
    file: &'static str,
    begins: &'static str,
    ends: &'static str,
    count: usize,
    largest: f64,
}

/// The literal route has no numbers of its own: its 64 matrices come from the points and weights of quadrature.
const TABLES: [NumberTable; 5] = [
    NumberTable {
        name: "tensor",
        file: "src/link/ancf_cable.rs",
        begins: "const T: [[f64; 6]; 6] = [",
        ends: "];",
        count: 36,
        largest: 72.0 / 35.0,
    },
    NumberTable {
        name: "bending",
        file: "src/link/ancf_cable.rs",
        begins: "const B: [[f64; 3]; 3] = [",
        ends: "];",
        count: 9,
        largest: 12.0,
    },
    NumberTable {
        name: "mass",
        file: "src/link/ancf_cable.rs",
        begins: "const MASS: [f64; 10] = [",
        ends: "];",
        count: 10,
        largest: 156.0,
    },
    NumberTable {
        name: "weights of Bathe's scheme",
        file: "src/stepper/bathe.rs",
        begins: "let weights = [",
        ends: "];",
        count: 3,
        // all three, for gamma = 1/2
        largest: 1.0 / 3.0,
    },
    NumberTable {
        name: "quadrature of the Gauss and the literal route",
        file: "src/math/quadrature.rs",
        begins: "pub const GAUSS5: [(f64, f64); 5] = [",
        ends: "];",
        count: 10,
        largest: 0.953_089_922_969_332,
    },
];

impl NumberTable {
    /// Every number as the file has it, and the text of the file with that number changed.
    fn changed(&self, text: &str) -> Result<Vec<(String, String)>> {
        let begin = text.find(self.begins).map(|at| at + self.begins.len());
        let length = begin.and_then(|at| text[at..].find(self.ends));
        let (Some(begin), Some(length)) = (begin, length) else {
            return Err(miette!("{}: no `{}`", self.file, self.begins));
        };
        let mut at = begin;
        let mut changed = Vec::new();
        for cell in text[begin..begin + length].split(',') {
            let number = cell.trim_end_matches([' ', '\n', ']', ')']);
            let (before, after) = text.split_at(at + number.len());
            at += cell.len() + 1;
            if number.is_empty() {
                continue;
            }
            let with = format!("{before} + {:e}{after}", CHANGE * self.largest);
            let bare = number.trim_start_matches([' ', '\n', '[']);
            // a parenthesis that opens a pair
            let bare = if bare.contains(')') {
                bare
            } else {
                bare.trim_start_matches('(')
            };
            changed.push((bare.to_owned(), with));
        }
        match changed.len() == self.count {
            true => Ok(changed),
            false => Err(miette!("{} numbers in `{}`", changed.len(), self.name)),
        }
    }
}

/// Changes the numbers of the kernels one at a time and records which property tests notice.
#[derive(Parser)]
struct Arguments {
    /// Only tables whose name contains this; what is known of the others stays.
    #[arg(long)]
    only: Option<String>,
}

fn main() -> Result<()> {
    let only = Arguments::parse().only.unwrap_or_default();
    let campaign = RunningCampaign::begin("constants")?;
    let copy = WorkspaceCopy::new("constants")?;
    let tests = || copy.failing(&["--profile", "mutants", "--test", "kernels"], &TESTS);
    let sound = tests()?;
    if !sound.is_empty() {
        return Err(miette!("with the right numbers {} fails", sound.join(", ")));
    }
    let mut changed = Vec::new();
    for table in &TABLES {
        let text = fs::read_to_string(copy.tree().join(table.file)).into_diagnostic()?;
        // all tables first: a table that is not found fails at once
        changed.push((table, table.changed(&text)?));
    }
    let known = ConstantsRecord::load().map_or(Vec::new(), |record| record.numbers);
    let mut numbers = Vec::new();
    for (table, changed) in changed {
        if !table.name.contains(&only) {
            numbers.extend(known.iter().filter(|n| n.table == table.name).cloned());
            continue;
        }
        for (index, (number, text)) in changed.into_iter().enumerate() {
            let place = index + 1;
            let caught_by = copy
                .with(table.file, &text, tests)
                .wrap_err_with(|| format!("{place} of {}", table.name))?;
            let verdict = match caught_by.len() {
                0 => "NOT CAUGHT".to_owned(),
                _ => caught_by.join(", "),
            };
            println!("{} {place}: {number}: {verdict}", table.name);
            numbers.push(Number {
                table: table.name.to_owned(),
                file: table.file.to_owned(),
                place,
                number,
                caught_by,
            });
        }
    }
    let survived = numbers.iter().filter(|n| n.caught_by.is_empty()).count();
    let all = numbers.len();
    let record = ConstantsRecord {
        change: CHANGE,
        tests: TESTS.map(str::to_owned).to_vec(),
        numbers,
    };
    let text = serde_json::to_string_pretty(&record).into_diagnostic()?;
    fs::write(path(), text + "\n").into_diagnostic()?;
    if only.is_empty() {
        campaign.finish()?;
    }
    println!("{} of {all} numbers caught", all - survived);
    match survived {
        0 => Ok(()),
        n => Err(miette!("{n} numbers can be changed and no test fails")),
    }
}

#[cfg(test)]
mod tests {
    use super::{CHANGE, ConstantsRecord, TABLES, TESTS};
    use records::root;
    use std::fs;

    /// The record is that of the numbers in the code, by the tests of today, and every one was caught.
    #[test]
    fn every_number_is_on_record_as_caught() {
        let record = ConstantsRecord::load().unwrap();
        assert_eq!((record.change, record.tests.len()), (CHANGE, TESTS.len()));
        assert!(
            TESTS
                .iter()
                .all(|test| record.tests.iter().any(|t| t == test))
        );
        let mut recorded = record.numbers.iter();
        for table in &TABLES {
            let source = fs::read_to_string(root().join(table.file)).unwrap();
            for (number, changed) in table.changed(&source).unwrap() {
                let entry = recorded.next().unwrap();
                assert_eq!((entry.table.as_str(), &entry.number), (table.name, &number));
                assert!(!entry.caught_by.is_empty(), "{} {number}", table.name);
                assert_ne!(changed, source);
            }
        }
        assert!(recorded.next().is_none());
    }
}

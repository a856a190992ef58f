//! Every number of the element and of Bathe's scheme is changed by a millionth of the largest in its table, one at a time in a
//! copy of the workspace, and the property tests have to notice.

use crate::campaign::results;
use crate::verification::copy::WorkspaceCopy;
use miette::{IntoDiagnostic, Result, WrapErr, ensure, miette};
use records::Journal;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::fs;

/// The property tests.
const TESTS: [&str; 3] = [
    "mass_is_symmetric_positive_definite_with_total_first_moment_and_inertia_about_both_ends",
    "jacobian_of_every_route_is_the_derivative_of_its_force_and_both_are_those_of_gauss_quadrature",
    "bathe_loses_energy_of_linear_systems_from_the_first_step_as_the_spectral_formula_says",
];

/// By which part of the largest number of its table a number is changed.
pub const CHANGE: f64 = 1e-6;

/// A number that was changed.
#[derive(Clone, Serialize, Deserialize)]
pub struct Number {
    /// The table that it stands in.
    pub table: String,
    /// The file of the table.
    pub file: String,
    /// What the file has there.
    pub number: String,
    /// The tests that failed.
    pub caught_by: Vec<String>,
}

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
        ensure!(
            changed.len() == self.count,
            "{} numbers in `{}`",
            changed.len(),
            self.name
        );
        Ok(changed)
    }
}

/// Changes the numbers and asks the property tests.
///
/// # Errors
/// Tests that fail with the right numbers; a number whose change no test notices.
pub fn measure(journal: &Journal) -> Result<Value> {
    let copy = WorkspaceCopy::new("constants")?;
    let tests = || copy.failing(&["--profile", "mutants", "--test", "kernels"], &TESTS);
    let sound = tests()?;
    ensure!(
        sound.is_empty(),
        "with the right numbers {} fails",
        sound.join(", ")
    );
    let mut numbers = Vec::new();
    for table in &TABLES {
        let text = fs::read_to_string(copy.tree().join(table.file)).into_diagnostic()?;
        for (index, (number, text)) in table.changed(&text)?.into_iter().enumerate() {
            let name = format!("number {} of {}", index + 1, table.name);
            let caught_by = journal.item(&name, || {
                copy.with(table.file, &text, tests)
                    .wrap_err_with(|| name.clone())
            })?;
            ensure!(!caught_by.is_empty(), "{name}: no test fails");
            numbers.push(Number {
                table: table.name.to_owned(),
                file: table.file.to_owned(),
                number,
                caught_by,
            });
        }
    }
    results(numbers)
}

#[cfg(test)]
mod tests {
    use super::TABLES;
    use records::root;
    use std::fs;

    #[test]
    fn every_number_of_a_table_is_found_and_changed() {
        for table in &TABLES {
            let source = fs::read_to_string(root().join(table.file)).unwrap();
            for (number, changed) in table.changed(&source).unwrap() {
                assert_ne!(changed, source, "{number}");
            }
        }
    }
}

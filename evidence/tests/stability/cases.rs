//! The criteria of the fifteen hard cases, but for those of long runs.

use evidence::stability::cases::{Check, cases, checks};
use rayon::prelude::*;

#[test]
fn hard_cases_meet_their_criteria() {
    let numbers: Vec<usize> = (1..=cases().unwrap().len()).collect();
    let made = numbers.par_iter().map(|case| checks(*case, false).unwrap());
    let made: Vec<Vec<Check>> = made.collect();
    assert!(made.iter().all(|checks| !checks.is_empty()));
    let failed: Vec<&Check> = made
        .iter()
        .flatten()
        .filter(|check| !check.holds())
        .collect();
    assert!(failed.is_empty(), "{failed:#?}");
}

//! Whether means of runs tell programs and cases apart.

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use verify::check::Agreement;
use verify::compare::statistics::{CONTACT, ChaoticRun, QUANTITIES, agreements, runs};

/// Runs with the scatter that the contact share has, of some tenths of a per cent; `shift` is added to it where `shifted` says.
fn made(shift: f64, shifted: impl Fn(&ChaoticRun) -> bool) -> Vec<Agreement> {
    let (runs, mut random) = (runs(), ChaCha8Rng::seed_from_u64(1));
    let mut measured = |run: &ChaoticRun| {
        let mut values: Vec<f64> = QUANTITIES.iter().map(|_| random.random::<f64>()).collect();
        values[CONTACT] = 0.95 + 0.01 * values[CONTACT];
        values[CONTACT] += if shifted(run) { shift } else { 0.0 };
        values
    };
    let measured: Vec<Vec<f64>> = runs.iter().map(&mut measured).collect();
    agreements(&runs, &measured)
}

fn failed(rows: &[Agreement]) -> Vec<usize> {
    let indices = 0..rows.len();
    indices.filter(|i| !rows[*i].holds()).collect()
}

#[test]
fn programs_that_differ_by_three_per_cent_of_the_contact_share_are_told_apart() {
    // by as much as cases 3 and 4 differ, in case 4 of the reference alone
    let rows = made(0.03, |run| run.case == 4 && run.reference);
    let contact = QUANTITIES.len() + CONTACT;
    // nothing but this, and that Looselink does not tell the cases apart
    assert_eq!(failed(&rows), [contact, 2 * QUANTITIES.len()]);
}

#[test]
fn programs_that_tell_the_cases_apart_agree() {
    let rows = made(-0.03, |run| run.case == 4);
    assert_eq!(failed(&rows), [] as [usize; 0]);
    assert_eq!(rows.len(), 2 * QUANTITIES.len() + 2);
    // sixteen runs see a tenth of that
    let rows = made(-0.006, |run| run.case == 4);
    assert_eq!(failed(&rows), [] as [usize; 0]);
}

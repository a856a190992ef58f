//! Whether three groups of runs differ in their means: a permutation test that keeps each run whole.
//!
//! For every quantity and every pair of groups of n runs
//!
//! ```text
//! t = |mean_i - mean_j| / sqrt((s_i^2 + s_j^2) / n)
//! ```
//!
//! with the standard deviations s. If it does not matter in which group a run is, every assignment of the runs to groups
//! is as likely as the actual one. Over random assignments, the p-value of a statistic is the share of those that have at
//! least the actual value; the actual assignment counts as one of them (Phipson and Smyth 2010, DOI
//! 10.2202/1544-6115.1585). A run keeps all its quantities, so that the test is right however these depend on each other.
//!
//! The p-value of a single t is corrected for all others: it is the share of assignments whose *largest* t of all
//! quantities and pairs is at least this one (Westfall and Young 1993, *Resampling-Based Multiple Testing*, single step).

use crate::interval::{Interval, OF_THREE, STARTS};
use rand::SeedableRng;
use rand::seq::SliceRandom;
use rand_chacha::ChaCha8Rng;

/// Random assignments: p-values of 0.05 have a standard error of 0.002.
pub const SHUFFLES: usize = 9_999;
/// Seed of the assignments.
const SEED: u64 = 1;
/// Pairs of the three groups.
pub const PAIRS: [(usize, usize); 3] = [(0, 1), (0, 2), (1, 2)];

/// What the test finds.
pub struct Test {
    /// t of every quantity and pair.
    pub apart: Vec<[f64; 3]>,
    /// p-values of each t, corrected for all others.
    pub p: Vec<[f64; 3]>,
    /// How many means differ at the 95 % level.
    pub differing: usize,
    /// The same, on average over the random assignments.
    pub by_chance: f64,
    /// p-value of [`Test::differing`].
    pub p_differing: f64,
}

impl Test {
    /// Of quantities that have a value for each run, in the order of the groups.
    ///
    /// # Panics
    /// When the groups are not three of [`STARTS`] runs.
    pub fn of(quantities: &[Vec<f64>]) -> Test {
        Test::with(quantities, SHUFFLES)
    }

    fn with(quantities: &[Vec<f64>], shuffles: usize) -> Test {
        assert!(quantities.iter().all(|values| values.len() == OF_THREE));
        let mut order: Vec<usize> = (0..OF_THREE).collect();
        let (apart, differing) = compare(quantities, &order);
        let mut random = ChaCha8Rng::seed_from_u64(SEED);
        let mut at_least = vec![[1_usize; 3]; quantities.len()];
        let (mut as_many, mut sum) = (1_usize, 0);
        for _ in 0..shuffles {
            order.shuffle(&mut random);
            let (other, count) = compare(quantities, &order);
            let largest = other.iter().flatten().fold(0.0_f64, |m, t| m.max(*t));
            for (n, t) in at_least.iter_mut().flatten().zip(apart.iter().flatten()) {
                *n += usize::from(largest >= *t);
            }
            as_many += usize::from(count >= differing);
            sum += count;
        }
        let share = |n: usize| n as f64 / (shuffles + 1) as f64;
        Test {
            apart,
            p: at_least.iter().map(|n| n.map(share)).collect(),
            differing,
            by_chance: sum as f64 / shuffles as f64,
            p_differing: share(as_many),
        }
    }

    /// Quantity and pair of the largest t.
    pub fn largest(&self) -> (usize, usize) {
        let all = (0..self.apart.len()).flat_map(|q| [0, 1, 2].map(|pair| (q, pair)));
        let t = |&(q, pair): &(usize, usize)| self.apart[q][pair];
        all.max_by(|a, b| t(a).total_cmp(&t(b))).unwrap_or_default()
    }

    /// The least p-value of a quantity, or of its pairs.
    pub fn least(&self, quantity: usize) -> f64 {
        self.p[quantity].into_iter().fold(1.0, f64::min)
    }
}

/// t of every quantity and pair, and how many means differ, when the runs stand in this order.
fn compare(quantities: &[Vec<f64>], order: &[usize]) -> (Vec<[f64; 3]>, usize) {
    let mut differing = 0;
    let of = |values: &Vec<f64>| {
        let means: [Interval; 3] = std::array::from_fn(|group| {
            let runs = &order[group * STARTS..(group + 1) * STARTS];
            let group: [f64; STARTS] = std::array::from_fn(|k| values[runs[k]]);
            Interval::of(&group)
        });
        PAIRS.map(|(i, j)| {
            differing += usize::from(means[i].differs(&means[j]));
            means[i].apart(&means[j])
        })
    };
    let apart = quantities.iter().map(of).collect();
    (apart, differing)
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::Rng;

    /// Runs whose quantities depend on each other: each is the sum of one that all have in common and one of its own.
    fn runs(random: &mut ChaCha8Rng, quantities: usize) -> Vec<Vec<f64>> {
        let common: Vec<f64> = (0..OF_THREE).map(|_| random.random()).collect();
        (0..quantities)
            .map(|_| common.iter().map(|c| c + random.random::<f64>()).collect())
            .collect()
    }

    /// Standard deviation of these quantities: each of the two parts has a variance of 1/12.
    const SCATTER: f64 = 0.408;

    #[test]
    fn p_values_of_groups_that_do_not_differ_are_uniform() {
        const SAMPLES: usize = 400;
        let mut random = ChaCha8Rng::seed_from_u64(2);
        let tests: Vec<Test> = (0..SAMPLES)
            .map(|_| Test::with(&runs(&mut random, 4), 199))
            .collect();
        let mut p: Vec<f64> = tests
            .iter()
            .map(|t| t.p.iter().flatten().fold(1.0, |m: f64, p| m.min(*p)))
            .collect();
        p.sort_by(f64::total_cmp);
        // Kolmogorov and Smirnov: 1.95 / sqrt(n) is exceeded by one sample in a thousand; p has steps of 1/200
        let bound = 1.95 / (SAMPLES as f64).sqrt() + 1.0 / 200.0;
        for (i, p) in p.iter().enumerate() {
            let expected = (i as f64 + 0.5) / SAMPLES as f64;
            assert!((p - expected).abs() < bound, "{p} at {expected}");
        }
        // a count is often the same, so that its p-values are above uniform ones; 0.05 three standard errors of 400 wide
        let small = tests.iter().filter(|t| t.p_differing <= 0.05).count() as f64;
        assert!((1.0..400.0 * 0.05 + 3.0 * 4.4).contains(&small), "{small}");
    }

    #[test]
    fn a_shift_of_one_quantity_is_found_there() {
        let mut random = ChaCha8Rng::seed_from_u64(3);
        let mut quantities = runs(&mut random, 12);
        // t is 2 sqrt(16 / 2) = 5.7 on average; less than 4 has a chance of one in twenty
        for value in &mut quantities[5][2 * STARTS..] {
            *value += 2.0 * SCATTER;
        }
        let test = Test::of(&quantities);
        let (quantity, pair) = test.largest();
        assert!(quantity == 5 && pair > 0);
        assert!(test.least(5) < 0.01);
        let others = (0..12).filter(|q| *q != 5);
        assert!(others.into_iter().all(|q| test.least(q) > 0.05));
    }

    #[test]
    fn a_shift_of_all_quantities_makes_more_means_differ_than_chance() {
        let mut random = ChaCha8Rng::seed_from_u64(4);
        let mut quantities = runs(&mut random, 12);
        assert!(Test::of(&quantities).p_differing > 0.05);
        for value in quantities.iter_mut().flat_map(|q| &mut q[2 * STARTS..]) {
            *value += 1.5 * SCATTER;
        }
        assert!(Test::of(&quantities).p_differing < 0.01);
    }

    #[test]
    fn the_order_of_the_runs_of_a_group_does_not_matter() {
        let mut random = ChaCha8Rng::seed_from_u64(5);
        let mut quantities = runs(&mut random, 3);
        let before = Test::with(&quantities, 1);
        for values in &mut quantities {
            values[..STARTS].reverse();
        }
        let after = Test::with(&quantities, 1);
        // rounding of sums of sixteen numbers of order one
        let pairs = before
            .apart
            .iter()
            .flatten()
            .zip(after.apart.iter().flatten());
        assert!(pairs.into_iter().all(|(a, b)| (a - b).abs() < 1e-12));
    }
}

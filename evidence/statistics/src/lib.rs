//! Means of runs that a tiny change of the start makes different, and whether two groups of runs differ.
#![forbid(unsafe_code)]

use serde::{Deserialize, Serialize};

/// Probability with which any difference at all is found among quantities that do not differ.
pub const FAMILY_WISE: f64 = 0.01;

/// A mean and the half width of its 95 % interval by Student's t distribution, from independent values.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Interval {
    /// The mean.
    pub mean: f64,
    /// t s/sqrt(n).
    pub half: f64,
}

impl Interval {
    /// Of two values at least.
    pub fn of(values: &[f64]) -> Interval {
        let (mean, variance, n) = moments(values);
        let half = quantile(0.05, n - 1.0) * (variance / n).sqrt();
        Interval { mean, half }
    }
}

/// Welch's comparison of the means of two groups whose variances may differ (Biometrika 34, 1947, 28).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Welch {
    /// Mean of the first group minus that of the second.
    pub difference: f64,
    /// Standard error of the difference, sqrt(s1^2/n1 + s2^2/n2).
    pub error: f64,
    /// Degrees of freedom after Satterthwaite.
    pub freedom: f64,
    /// Probability of a difference at least as large if the means do not differ.
    pub p: f64,
}

impl Welch {
    /// Of two values at least in each group.
    pub fn of(one: &[f64], other: &[f64]) -> Welch {
        let ((a, s, n), (b, r, m)) = (moments(one), moments(other));
        let (first, second) = (s / n, r / m);
        let error = (first + second).sqrt();
        let shares = first.powi(2) / (n - 1.0) + second.powi(2) / (m - 1.0);
        let freedom = (first + second).powi(2) / shares;
        let difference = a - b;
        // groups without scatter differ or are the same
        let p = match (error > 0.0, difference == 0.0) {
            (true, _) => beyond(difference / error, freedom),
            (false, same) => f64::from(u8::from(same)),
        };
        Welch {
            difference,
            error,
            freedom,
            p,
        }
    }

    /// The difference that has this p.
    pub fn critical(&self, p: f64) -> f64 {
        match self.error > 0.0 {
            true => quantile(p, self.freedom) * self.error,
            false => 0.0,
        }
    }
}

/// Holm's adjusted p-values (Scand. J. Statist. 6, 1979, 65): quantities with one below a level differ, and the probability that
/// any of them does not is at most this level, however the quantities depend on each other.
pub fn holm(p: &[f64]) -> Vec<f64> {
    let mut order: Vec<usize> = (0..p.len()).collect();
    order.sort_by(|a, b| p[*a].total_cmp(&p[*b]));
    let (mut adjusted, mut largest) = (vec![1.0; p.len()], 0.0_f64);
    for (rank, index) in order.into_iter().enumerate() {
        largest = largest.max((p.len() - rank) as f64 * p[index]).min(1.0);
        adjusted[index] = largest;
    }
    adjusted
}

/// Mean, variance and number.
fn moments(values: &[f64]) -> (f64, f64, f64) {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    let squares: f64 = values.iter().map(|x| (x - mean).powi(2)).sum();
    (mean, squares / (n - 1.0), n)
}

/// The probability that Student's t with nu degrees of freedom lies beyond +-t: the regularised incomplete beta function
/// I_x(nu/2, 1/2) at x = nu/(nu + t^2) (Abramowitz and Stegun, 26.7.1).
fn beyond(t: f64, nu: f64) -> f64 {
    puruspe::betai(0.5 * nu, 0.5, nu / (nu + t * t))
}

/// The t with this probability beyond +-t.
fn quantile(p: f64, nu: f64) -> f64 {
    let x = puruspe::invbetai(p, 0.5 * nu, 0.5);
    (nu * (1.0 / x - 1.0)).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Additional hours of sleep with two drugs (Student, Biometrika 6, 1908, 1).
    const SLEEP: [[f64; 10]; 2] = [
        [0.7, -1.6, -0.2, -1.2, -0.1, 3.4, 3.7, 0.8, 0.0, 2.0],
        [1.9, 0.8, 1.1, 0.1, -0.1, 4.4, 5.5, 1.6, 4.6, 3.4],
    ];

    #[test]
    fn welch_of_the_hours_of_sleep() {
        // the example of R's t.test: t = -1.8608, df = 17.776, p = 0.07939, interval -3.3654832 to 0.2054832
        let found = Welch::of(&SLEEP[0], &SLEEP[1]);
        assert!((found.difference / found.error + 1.8608).abs() < 5e-5);
        assert!((found.freedom - 17.776).abs() < 5e-4);
        assert!((found.p - 0.07939).abs() < 5e-6);
        let half = 0.5 * (0.205_483_2 + 3.365_483_2);
        assert!((found.critical(0.05) - half).abs() < 1e-7);
        assert!((Welch::of(&SLEEP[1], &SLEEP[0]).p - found.p).abs() < 1e-15);
    }

    #[test]
    fn quantiles_of_the_tables() {
        // Abramowitz and Stegun, table 26.10, three decimals: two-sided 5 %, 1 % and 0.1 %
        for (p, nu, t) in [
            (0.05, 15.0, 2.131),
            (0.05, 30.0, 2.042),
            (0.01, 15.0, 2.947),
            (0.001, 30.0, 3.646),
            (0.05, 1.0, 12.706),
        ] {
            assert!(
                (quantile(p, nu) - t).abs() < 5.1e-4,
                "{p} {nu}: {}",
                quantile(p, nu)
            );
            assert!((beyond(quantile(p, nu), nu) / p - 1.0).abs() < 1e-9);
        }
    }

    #[test]
    fn interval_of_ranks() {
        // variance of 0..15: n (n + 1)/12; t of 15 degrees of freedom
        let values: Vec<f64> = (0..16).map(f64::from).collect();
        let interval = Interval::of(&values);
        let half = 2.131_449_546 * (272.0 / 12.0 / 16.0_f64).sqrt();
        assert!((interval.mean - 7.5).abs() < 1e-12 && (interval.half - half).abs() < 1e-8);
    }

    #[test]
    fn holm_by_hand() {
        // 4 x 0.005, 3 x 0.01, 2 x 0.03, and 0.04, which may not be below the one before it
        let found = holm(&[0.01, 0.04, 0.03, 0.005]);
        for (found, expected) in found.iter().zip([0.03, 0.06, 0.06, 0.02]) {
            assert!((found - expected).abs() < 1e-15, "{found}");
        }
        assert_eq!(holm(&[0.9, 0.8]), [1.0, 1.0]);
        assert_eq!(holm(&[]), [] as [f64; 0]);
    }

    #[test]
    fn groups_without_scatter_are_the_same_or_differ() {
        assert_eq!(Welch::of(&[1.0, 1.0], &[1.0, 1.0]).p, 1.0);
        assert_eq!(Welch::of(&[1.0, 1.0], &[2.0, 2.0]).p, 0.0);
    }
}

//! Statistics of several runs.

/// The value of sorted numbers, one at least, below which a fraction of them lies: linear between neighbours, the first at 0,
/// the last at 1.
pub fn quantile(sorted: &[f64], fraction: f64) -> f64 {
    let place = fraction * (sorted.len() - 1) as f64;
    let below = (place as usize).min(sorted.len() - 1);
    let above = (below + 1).min(sorted.len() - 1);
    sorted[below] + (place - below as f64) * (sorted[above] - sorted[below])
}

/// The mean of some runs, and the interval in which it lies.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EnsembleMean {
    /// Number of runs.
    pub count: usize,
    /// Mean.
    pub mean: f64,
    /// Standard deviation of a run, sqrt(sum (x - mean)^2/(n - 1)); none of a single run.
    pub deviation: Option<f64>,
    /// Half of the 95 % confidence interval of the mean by Student's t distribution, t s/sqrt(n); none of a single run.
    pub half_width: Option<f64>,
}

impl EnsembleMean {
    /// Of some numbers; none of no number.
    pub fn of(values: &[f64]) -> Option<EnsembleMean> {
        let n = values.len() as f64;
        let mean = values.iter().sum::<f64>() / n;
        let squares = values.iter().map(|x| (x - mean).powi(2)).sum::<f64>();
        let deviation = (values.len() > 1).then(|| (squares / (n - 1.0)).sqrt());
        (!values.is_empty()).then_some(EnsembleMean {
            count: values.len(),
            mean,
            deviation,
            half_width: deviation.map(|s| student(n - 1.0) * s / n.sqrt()),
        })
    }

    /// Ends of the interval; of a single run its value.
    pub fn interval(&self) -> (f64, f64) {
        let half = self.half_width.unwrap_or(0.0);
        (self.mean - half, self.mean + half)
    }
}

/// The 97.5 % quantile of Student's t distribution with nu degrees of freedom. With x = nu/(nu + t^2) the probability
/// beyond +-t is the regularised incomplete beta function I_x(nu/2, 1/2) (Abramowitz and Stegun, 26.7.1).
fn student(nu: f64) -> f64 {
    let x = puruspe::invbetai(0.05, 0.5 * nu, 0.5);
    (nu * (1.0 / x - 1.0)).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_of_ranks() {
        let x = [1.0, 2.0, 4.0];
        let at = [(0.0, 1.0), (0.25, 1.5), (0.5, 2.0), (0.75, 3.0), (1.0, 4.0)];
        for (fraction, value) in at {
            assert_eq!(quantile(&x, fraction), value);
        }
        assert_eq!(quantile(&[3.0], 0.3), 3.0);
    }

    #[test]
    fn students_t_has_the_values_of_the_tables() {
        // Abramowitz and Stegun, table 26.10, three decimals
        let table = [
            (1.0, 12.706),
            (2.0, 4.303),
            (4.0, 2.776),
            (15.0, 2.131),
            (120.0, 1.980),
        ];
        for (nu, t) in table {
            assert!((student(nu) - t).abs() < 5.1e-4, "{nu}: {}", student(nu));
        }
    }

    #[test]
    fn a_mean_has_an_interval_from_two_runs_on() {
        assert_eq!(EnsembleMean::of(&[]), None);
        let one = EnsembleMean::of(&[2.0]).unwrap();
        assert_eq!((one.interval(), one.deviation), ((2.0, 2.0), None));
        let two = EnsembleMean::of(&[1.0, 3.0]).unwrap();
        // s = sqrt 2, so the half width is t: 12.706 of the tables
        let (low, high) = two.interval();
        assert!((low - (2.0 - 12.706)).abs() < 5.1e-4 && (high - (2.0 + 12.706)).abs() < 5.1e-4);
    }
}

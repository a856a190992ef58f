//! Sobol indices: the share of the variance of a measure that each parameter explains.
//!
//! With a sample A, a sample B and A with parameter i of B, of which f are the values of a measure,
//!
//! first order  S_i = mean(f_B (f_ABi - f_A)) / V        (Saltelli et al. 2010, table 2 b)
//! total        T_i = mean((f_A - f_ABi)^2) / (2 V)      (Jansen 1999)
//!
//! with V the variance of all f_A and f_B, and f taken from its mean, which makes the estimate of S_i less noisy. S_i is the part
//! of V that parameter i explains alone, T_i that in which it takes part. Intervals hold the middle 95 % of the estimates from
//! samples drawn with replacement (bootstrap).

use super::design::SensitivityDesign;
use super::starts::below;
use super::statistics::quantile;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use serde::Serialize;

/// Samples drawn for the intervals.
const DRAWN: usize = 1000;

/// An estimate and its 95 % interval.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Estimated {
    /// From all samples.
    pub value: f64,
    /// Lower end.
    pub low: f64,
    /// Upper end.
    pub high: f64,
}

/// The indices of one parameter.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SobolIndices {
    /// S_i.
    pub first_order: Estimated,
    /// T_i.
    pub total: Estimated,
}

/// The indices of every parameter, and the number of samples they are from. `values` are those of all points; a sample of which
/// one is missing is left out.
///
/// None with fewer than two samples, or where the measure has no variance.
pub fn sobol_indices(
    values: &[Option<f64>],
    parameters: usize,
    seed: u64,
) -> Option<(Vec<SobolIndices>, usize)> {
    let blocks = values.chunks_exact(SensitivityDesign::block(parameters));
    let whole: Vec<Vec<f64>> = blocks
        .filter_map(|block| block.iter().copied().collect())
        .collect();
    let all: Vec<usize> = (0..whole.len()).collect();
    let estimate = estimate(&whole, &all, parameters)?;
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let drawn: Vec<_> = (0..DRAWN)
        .filter_map(|_| {
            let draw: Vec<usize> = all
                .iter()
                .map(|_| below(&mut random, whole.len()))
                .collect();
            self::estimate(&whole, &draw, parameters)
        })
        .collect();
    let interval = |i: usize, order: usize| {
        let mut sorted: Vec<f64> = drawn.iter().map(|drawn| drawn[i][order]).collect();
        sorted.sort_by(f64::total_cmp);
        Estimated {
            value: estimate[i][order],
            low: quantile(&sorted, 0.025),
            high: quantile(&sorted, 0.975),
        }
    };
    let indices = (0..parameters).map(|i| SobolIndices {
        first_order: interval(i, 0),
        total: interval(i, 1),
    });
    Some((indices.collect(), whole.len()))
}

/// S and T of every parameter from some of the samples.
fn estimate(whole: &[Vec<f64>], chosen: &[usize], parameters: usize) -> Option<Vec<[f64; 2]>> {
    let n = chosen.len() as f64;
    let both = || chosen.iter().flat_map(|k| &whole[*k][..2]);
    let mean = both().sum::<f64>() / (2.0 * n);
    let variance = both().map(|f| (f - mean).powi(2)).sum::<f64>() / (2.0 * n);
    if chosen.len() < 2 || !(variance > 0.0 && variance.is_finite()) {
        return None;
    }
    let of = |i: usize| {
        let (mut first, mut total) = (0.0, 0.0);
        for k in chosen {
            let [a, b, mixed] = [0, 1, i + 2].map(|place| whole[*k][place] - mean);
            first += b * (mixed - a);
            total += (a - mixed).powi(2);
        }
        [first / (n * variance), total / (2.0 * n * variance)]
    };
    Some((0..parameters).map(of).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use ladder::{Rung, Worst};
    use std::f64::consts::PI;

    /// sin x1 + 7 sin^2 x2 + 0.1 x3^4 sin x1 for x in [-pi, pi] (Ishigami and Homma 1990).
    fn ishigami(u: &[f64]) -> f64 {
        let x: Vec<f64> = u.iter().map(|u| PI * (2.0 * u - 1.0)).collect();
        x[0].sin() + 7.0 * x[1].sin().powi(2) + 0.1 * x[2].powi(4) * x[0].sin()
    }

    #[test]
    fn the_function_of_ishigami_has_its_analytic_indices() {
        let (a, b) = (7.0, 0.1);
        let first = 0.5 * (1.0 + b * PI.powi(4) / 5.0_f64).powi(2);
        let second = a * a / 8.0;
        let together = 8.0 * b * b * PI.powi(8) / 225.0;
        let variance = first + second + together;
        let exact = [[first, first + together], [second, second], [0.0, together]];
        let design = SensitivityDesign::new(3, 4096, 1).unwrap();
        let values: Vec<Option<f64>> = design.places().iter().map(|u| Some(ishigami(u))).collect();
        let (found, samples) = sobol_indices(&values, 3, 1).unwrap();
        assert_eq!(samples, 4096);
        let worst = Worst::new();
        for (i, indices) in found.iter().enumerate() {
            for (order, estimated) in [indices.first_order, indices.total].iter().enumerate() {
                let wanted = exact[i][order] / variance;
                let side = match wanted < estimated.value {
                    true => estimated.value - estimated.low,
                    false => estimated.high - estimated.value,
                };
                worst.at(format!("x{}, {}", i + 1, ["alone", "total"][order]));
                worst.see((wanted - estimated.value) / side);
                assert!(estimated.high - estimated.low < 0.2, "{estimated:?}");
            }
        }
        Rung::Routes
            .asks("Sobol indices of Ishigami's function from 4096 samples: distance from the analytic values, relative to the 95 % interval on their side")
            .within(&worst, 1.0, "the interval is that of random samples; those of a Sobol sequence lie closer");
    }

    /// Samples with f_A = 1, f_B = -1 and f_AB of 1 or -1 have the mean 0 and the variance 1. Those with f_AB = -1, a part p of them,
    /// have a T of 2 p and an S of 2 p. In a drawn sample this part is binomial, with the standard deviation sqrt(p (1 - p)/n).
    #[test]
    fn both_ends_of_an_interval_are_quantiles_of_the_draws() {
        const SAMPLES: usize = 1600;
        let wide = 1.959_964; // 97.5 % quantile of the normal distribution
        for one_in in [4, 2] {
            let values: Vec<Option<f64>> = (0..SAMPLES)
                .flat_map(|k| [1.0, -1.0, if k % one_in == 0 { -1.0 } else { 1.0 }])
                .map(Some)
                .collect();
            let (found, _) = sobol_indices(&values, 1, 1).unwrap();
            let p = 1.0 / one_in as f64;
            let deviation = 2.0 * (p * (1.0 - p) / SAMPLES as f64).sqrt();
            for estimated in [found[0].first_order, found[0].total] {
                assert!((estimated.value - 2.0 * p).abs() < 1e-12, "{estimated:?}");
                for (end, side) in [(estimated.low, -1.0), (estimated.high, 1.0)] {
                    let distance = side * (end - 2.0 * p) / deviation;
                    // three standard errors of a quantile of a thousand draws, 0.085 deviations each; that of 5 % is 0.32 away
                    assert!((distance - wide).abs() < 0.26, "{end}: {distance}");
                }
            }
        }
    }

    #[test]
    fn samples_with_a_gap_are_left_out() {
        let design = SensitivityDesign::new(2, 64, 1).unwrap();
        let mut values: Vec<Option<f64>> = design.places().iter().map(|u| Some(u[0])).collect();
        values[5] = None;
        let (found, samples) = sobol_indices(&values, 2, 1).unwrap();
        assert_eq!(samples, 63);
        // f = x1: parameter 1 explains everything, parameter 2 nothing
        assert!((found[0].total.value - 1.0).abs() < 0.1, "{found:?}");
        assert_eq!(found[1].total.value, 0.0);
        assert_eq!(sobol_indices(&[Some(1.0); 8], 2, 1), None, "no variance");
    }
}

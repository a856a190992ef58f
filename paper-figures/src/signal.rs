//! Numbers from recorded signals: every verdict of the reproduction rests on one of these.

use rustfft::FftPlanner;
use rustfft::num_complex::Complex;

/// Largest absolute value.
pub fn peak(y: &[f64]) -> f64 {
    y.iter().fold(0.0, |m, v| m.max(v.abs()))
}

/// Root of the mean square.
pub fn rms(y: &[f64]) -> f64 {
    (y.iter().map(|v| v * v).sum::<f64>() / y.len() as f64).sqrt()
}

/// Arithmetic mean.
pub fn mean(y: &[f64]) -> f64 {
    y.iter().sum::<f64>() / y.len() as f64
}

/// The fraction of values that satisfy a condition.
pub fn fraction(y: &[f64], condition: impl Fn(f64) -> bool) -> f64 {
    y.iter().filter(|v| condition(**v)).count() as f64 / y.len() as f64
}

/// The frequency below which half of the power lies \[Hz\], of a uniformly sampled signal without its mean.
/// Hann window, so that the ends of the record make no broad band of their own.
pub fn median_frequency(y: &[f64], interval: f64) -> f64 {
    let n = y.len();
    let mean = mean(y);
    let mut spectrum: Vec<Complex<f64>> = y
        .iter()
        .enumerate()
        .map(|(i, v)| (v - mean) * (std::f64::consts::PI * i as f64 / n as f64).sin().powi(2))
        .map(|v| Complex::new(v, 0.0))
        .collect();
    FftPlanner::new().plan_fft_forward(n).process(&mut spectrum);
    let power: Vec<f64> = spectrum[..n / 2].iter().map(Complex::norm_sqr).collect();
    let half = 0.5 * power.iter().sum::<f64>();
    let mut sum = 0.0;
    let index = power.iter().position(|p| {
        sum += p;
        sum >= half
    });
    index.unwrap_or(0) as f64 / (n as f64 * interval)
}

/// Moving mean over `width` samples, centred; shorter at the ends.
pub fn smooth(y: &[f64], width: usize) -> Vec<f64> {
    let mut sums = vec![0.0];
    sums.extend(y.iter().scan(0.0, |s, v| {
        *s += v;
        Some(*s)
    }));
    let half = width / 2;
    (0..y.len())
        .map(|i| {
            let (a, b) = (i.saturating_sub(half), (i + half + 1).min(y.len()));
            (sums[b] - sums[a]) / (b - a) as f64
        })
        .collect()
}

/// Indices of the `count` highest samples of |y| that are at least `apart` samples from each other, highest first.
pub fn peaks(y: &[f64], count: usize, apart: usize) -> Vec<usize> {
    let mut order: Vec<usize> = (1..y.len().saturating_sub(1))
        .filter(|&i| y[i].abs() >= y[i - 1].abs() && y[i].abs() > y[i + 1].abs())
        .collect();
    order.sort_by(|&a, &b| y[b].abs().total_cmp(&y[a].abs()));
    let mut chosen: Vec<usize> = Vec::new();
    for i in order {
        if chosen.len() == count {
            break;
        }
        if chosen.iter().all(|&j| i.abs_diff(j) >= apart) {
            chosen.push(i);
        }
    }
    chosen
}

/// The fraction of `of` that have a member of `with` within `reach`.
pub fn coincidence(of: &[f64], with: &[f64], reach: f64) -> f64 {
    fraction(of, |t| with.iter().any(|w| (w - t).abs() <= reach))
}

/// How far the second half of a closed record is from repeating the first: the rms difference of the halves over the
/// rms of the deviation of both from their mean.
pub fn cycle_distance(y: &[f64]) -> f64 {
    let half = y.len() / 2;
    let (first, second) = (&y[..half], &y[half..2 * half]);
    let difference: Vec<f64> = first.iter().zip(second).map(|(a, b)| a - b).collect();
    let mean = mean(y);
    let deviation: Vec<f64> = y.iter().map(|v| v - mean).collect();
    rms(&difference) / rms(&deviation)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    fn wave(frequency: f64, n: usize, interval: f64) -> Vec<f64> {
        (0..n)
            .map(|i| (TAU * frequency * i as f64 * interval).sin())
            .collect()
    }

    #[test]
    fn median_frequency_of_a_sine_is_its_frequency() {
        // resolution of the record: 1 / (20000 * 1e-4 s)
        assert!((median_frequency(&wave(440.0, 20_000, 1e-4), 1e-4) - 440.0).abs() <= 0.5);
    }

    #[test]
    fn whole_periods_repeat_and_others_do_not() {
        assert!(cycle_distance(&wave(3.0, 20_000, 1e-4)) < 1e-9);
        // half a period between the halves: they are opposite, so their difference is twice the signal
        assert!((cycle_distance(&wave(3.5, 20_000, 1e-4)) - 2.0).abs() < 1e-3);
    }

    #[test]
    fn smoothing_keeps_the_mean_and_removes_the_ripple() {
        let y: Vec<f64> = wave(1000.0, 20_000, 1e-5).iter().map(|v| v + 7.0).collect();
        let smooth = smooth(&y, 1000);
        assert!(smooth[1000..19_000].iter().all(|v| (v - 7.0).abs() < 1e-2));
    }

    #[test]
    fn peaks_are_the_highest_and_apart() {
        let mut y = vec![0.0; 100];
        (y[10], y[11], y[12], y[50], y[90]) = (5.0, -6.0, 5.5, 3.0, -4.0);
        assert_eq!(peaks(&y, 2, 5), [11, 90]);
        assert_eq!(peaks(&y, 9, 5), [11, 90, 50]);
    }

    #[test]
    fn coincidence_counts_neighbours_on_both_sides() {
        assert_eq!(
            coincidence(&[1.0, 2.0, 3.0, 4.0], &[0.95, 3.05, 8.0], 0.1),
            0.5
        );
    }
}

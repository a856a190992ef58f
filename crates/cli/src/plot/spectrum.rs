//! The amplitude spectrum of a channel.

use super::axis;
use crate::failure::CommandFailure;
use plot::palette::BLUE;
use plot::{Axis, Mark, Panel};
use realfft::RealFftPlanner;
use std::f64::consts::TAU;
use view::StoredChannel;

/// Times are evenly spaced if their differences agree up to this part.
const ROUNDING: f64 = 1e-6;

/// The panel of a channel.
pub fn panel(times: &[f64], channel: &StoredChannel) -> Result<Panel, CommandFailure> {
    let interval = times[1] - times[0];
    let even = |pair: &[f64]| (pair[1] - pair[0] - interval).abs() <= ROUNDING * interval;
    if !times.windows(2).all(even) {
        let message = "the rows are not evenly spaced in time";
        return Err(CommandFailure::bad_input(message));
    }
    let count = times.len();
    let amplitudes = amplitudes(&channel.values);
    let step = 1.0 / (interval * count as f64);
    let frequencies: Vec<f64> = (0..amplitudes.len()).map(|k| k as f64 * step).collect();
    let label = format!("Amplitude of {}", channel.name);
    let mut panel = super::panel(
        Axis::new("Frequency", "Hz", 1.0),
        axis(&label, channel).log(),
    );
    // the mean is gone
    let (frequencies, amplitudes) = (&frequencies[1..], &amplitudes[1..]);
    let highest = 0.5 / interval;
    let peak = peak(frequencies, amplitudes);
    let peak = peak.map_or(String::new(), |f| format!(", largest peak at {f:.4} Hz"));
    panel.note = format!(
        "Hann window over {count} rows, mean removed, frequencies {step:.4} Hz apart{peak}; \
         vibrations faster than {highest:.4} Hz, half the rate of the rows, appear folded below it"
    );
    panel
        .marks
        .push(Mark::series("", BLUE, frequencies, amplitudes));
    Ok(panel)
}

/// Frequency of the largest amplitude that is larger than its neighbours: a slow motion falls off from the lowest frequency on and
/// has no peak.
fn peak(frequencies: &[f64], amplitudes: &[f64]) -> Option<f64> {
    let peaks = (1..amplitudes.len().saturating_sub(1))
        .filter(|&k| amplitudes[k] > amplitudes[k - 1] && amplitudes[k] > amplitudes[k + 1]);
    let largest = peaks.max_by(|&a, &b| amplitudes[a].total_cmp(&amplitudes[b]));
    largest.map(|k| frequencies[k])
}

/// Amplitudes at multiples of 1/(n dt): with the window w and its sum W, 2 |sum w_k (x_k - mean) exp(-i omega t_k)|/W, which is A
/// for A cos(omega t). At half the rate of the rows, the last frequency of an even number of rows, the factor 2 is 1: there the two
/// sides of the spectrum are one.
fn amplitudes(values: &[f64]) -> Vec<f64> {
    let n = values.len();
    let mean = values.iter().sum::<f64>() / n as f64;
    let window = |k: usize| 0.5 - 0.5 * (TAU * k as f64 / n as f64).cos();
    let total: f64 = (0..n).map(window).sum();
    let weighted = values
        .iter()
        .enumerate()
        .map(|(k, x)| window(k) * (x - mean));
    let mut weighted: Vec<f64> = weighted.collect();
    let transform = RealFftPlanner::new().plan_fft_forward(n);
    let mut spectrum = transform.make_output_vec();
    transform
        .process(&mut weighted, &mut spectrum)
        .expect("both vectors have the lengths of the plan");
    let factor = |k: usize| if 2 * k == n { 1.0 } else { 2.0 };
    let amplitudes = spectrum.iter().enumerate();
    amplitudes
        .map(|(k, x)| factor(k) * x.norm() / total)
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_peak_is_larger_than_its_neighbours() {
        let frequencies = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0];
        let of = |amplitudes: &[f64]| peak(&frequencies[..amplitudes.len()], amplitudes);
        assert_eq!(of(&[9.0, 5.0, 2.0, 3.0, 1.0, 4.0, 1.0]), Some(6.0));
        assert_eq!(of(&[9.0, 5.0, 3.0, 2.0]), None);
        assert_eq!(of(&[1.0, 2.0, 3.0]), None);
        assert_eq!(of(&[1.0]), None);
        assert_eq!(of(&[]), None);
    }

    /// Two oscillations in whole periods on a mean: their amplitudes come out, whatever their phases.
    #[test]
    fn amplitudes_are_those_of_the_oscillations() {
        let n = 1000;
        let at = |k: usize| {
            let turn = TAU * k as f64 / n as f64;
            let fastest = 0.5 * f64::from(1 - 2 * (k as i32 % 2));
            7.0 + 3.0 * (20.0 * turn + 0.3).cos() + 1e-3 * (150.0 * turn).sin() + fastest
        };
        let found = amplitudes(&(0..n).map(at).collect::<Vec<_>>());
        // rounding of a sum of n numbers of size 10
        let close = |k: usize, expected: f64| (found[k] - expected).abs() < 1e-11;
        assert!(
            close(20, 3.0) && close(150, 1e-3) && close(80, 0.0) && close(500, 0.5),
            "{found:?}"
        );
    }
}

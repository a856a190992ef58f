//! The amplitude spectrum of a channel.

use super::axis;
use crate::failure::CommandFailure;
use numbers::{number, rounded};
use plot::palette::BLUE;
use plot::{Axis, Mark, Panel};
use realfft::RealFftPlanner;
use std::f64::consts::TAU;
use view::StoredChannel;

/// Times are evenly spaced if their differences agree up to this part.
const ROUNDING: f64 = 1e-6;

/// The panel of a channel, up to the frequency `shown` \[Hz\].
pub fn panel(times: &[f64], channel: &StoredChannel, shown: f64) -> Result<Panel, CommandFailure> {
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
    // the mean is gone
    let end = frequencies.partition_point(|f| *f <= shown);
    if end < 3 {
        return Err(CommandFailure::bad_input(format!(
            "fewer than two frequencies lie below --max-frequency; the spectrum has one every {} Hz",
            number(step, 2)
        )));
    }
    let (frequencies, amplitudes) = (&frequencies[1..end], &amplitudes[1..end]);
    let label = format!("Amplitude of {}", channel.name);
    let mut panel = super::panel(
        Axis::new("Frequency", "Hz", 1.0),
        axis(&label, channel).log(),
    );
    panel.note = format!(
        "Hann window over {count} rows, mean removed, resolution {} Hz; {}; vibrations faster than {} Hz, half the rate of the \
         rows, appear folded below it",
        number(step, 2),
        largest(frequencies, amplitudes, step),
        number(0.5 / interval, 4)
    );
    panel
        .marks
        .push(Mark::series("", BLUE, frequencies, amplitudes));
    Ok(panel)
}

/// Where the amplitude is largest. Of a slow motion it falls off from the lowest frequency on; then also the largest amplitude that
/// exceeds its neighbours.
fn largest(frequencies: &[f64], amplitudes: &[f64], step: f64) -> String {
    let highest = |among: &mut dyn Iterator<Item = usize>| {
        among.max_by(|&a, &b| amplitudes[a].total_cmp(&amplitudes[b]))
    };
    let at = |k: usize| in_resolution(frequencies[k], step);
    let first = highest(&mut (0..amplitudes.len())).unwrap_or_default();
    if first > 0 {
        return format!("largest peak at {} Hz", at(first));
    }
    let mut inner = (1..amplitudes.len() - 1)
        .filter(|&k| amplitudes[k] > amplitudes[k - 1] && amplitudes[k] > amplitudes[k + 1]);
    let peak = highest(&mut inner).map_or(String::new(), |k| {
        format!(", largest of the others at {} Hz", at(k))
    });
    format!("largest peak at {} Hz, the lowest frequency{peak}", at(0))
}

/// A frequency down to the first decimal of the resolution, but with two digits at least.
fn in_resolution(frequency: f64, resolution: f64) -> String {
    let magnitude = |x: f64| x.log10().floor() as i32;
    let digits = magnitude(frequency) - magnitude(resolution) + 1;
    let digits = digits.max(2) as usize;
    number(rounded(frequency, digits), digits)
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
    fn the_largest_peak_is_the_largest_of_the_picture() {
        let of = |amplitudes: &[f64]| {
            let frequencies: Vec<f64> = (1..=amplitudes.len())
                .map(|k| 2.499375 * k as f64)
                .collect();
            largest(&frequencies, amplitudes, 2.499375)
        };
        assert_eq!(of(&[1.0, 5.0, 2.0, 3.0]), "largest peak at 5 Hz");
        assert_eq!(of(&[1.0, 2.0, 3.0]), "largest peak at 7.5 Hz");
        assert_eq!(
            of(&[9.0, 5.0, 2.0, 3.0, 1.0, 4.0, 1.0]),
            "largest peak at 2.5 Hz, the lowest frequency, largest of the others at 15 Hz"
        );
        assert_eq!(
            of(&[9.0, 5.0, 3.0]),
            "largest peak at 2.5 Hz, the lowest frequency"
        );
    }

    #[test]
    fn a_frequency_has_the_digits_of_the_resolution() {
        for (frequency, resolution, text) in [
            (179.955, 2.499375, "180"),
            (2.499375, 2.499375, "2.5"),
            (12.4969, 2.499375, "12"),
            (179.955, 0.26, "180"),
            (179.855, 0.26, "179.9"),
            (1234.56, 50.0, "1230"),
        ] {
            assert_eq!(in_resolution(frequency, resolution), text);
        }
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

//! The quantities that the statements of the paper are decided by, over the last two of three cycles.

use crate::campaign::{Campaign, DURATION, FROM};
use crate::numbers::Numbers;
use crate::runs::Recording;
use crate::signal::{cycle_distance, fraction, mean, median_frequency, peak, rms};

/// What is measured on one run.
pub struct Measures {
    /// Step \[s\].
    pub step: f64,
    /// Largest |e_x| \[m\].
    pub error_peak: f64,
    /// Deviation of the acceleration along x from the ideal one \[m/s2\].
    pub deviation: Vec<f64>,
    /// Its root mean square.
    pub deviation_rms: f64,
    /// The frequency below which half of its power lies \[Hz\].
    pub deviation_frequency: f64,
    /// Root mean square of the deviation in the last cycle over that in the first.
    pub settling: f64,
    /// Rms difference between the accelerations of cycles 2 and 3 over their rms deviation from the mean.
    pub repetition: f64,
    /// Largest force in B1 \[N\].
    pub force_peak: f64,
    /// Cubic mean of the force in B1 \[N\], the equivalent load of bearing life.
    pub force_cubic_mean: f64,
    /// Root mean square of the difference between the force in B1 and its mean \[N\].
    pub force_ripple: f64,
    /// The frequency below which half of the power of that difference lies \[Hz\].
    pub force_frequency: f64,
    /// Fraction of the time in contact of B1, and the least over the six joints; none for ideal joints.
    pub contact: Option<(f64, f64)>,
}

impl Measures {
    /// Measures a run and keeps the numbers under `name`.
    pub fn of(c: &Campaign, recording: &Recording, name: &str, numbers: &mut Numbers) -> Measures {
        let between = |channel: &str| recording.between(channel, FROM, DURATION).1;
        let (error, acceleration, force) = (
            between("error.x"),
            between("platform.ax"),
            between("B1.force"),
        );
        let interval = recording.plan.interval;
        let deviation = c.acceleration_deviation(recording);
        let cycle = |from: f64| {
            let (t, a) = recording.between("platform.ax", from, from + 1.0 / c.geometry.frequency);
            rms(&t
                .iter()
                .zip(a)
                .map(|(&t, a)| a - c.geometry.acceleration_x(t))
                .collect::<Vec<_>>())
        };
        let average = mean(force);
        let ripple: Vec<f64> = force.iter().map(|f| f - average).collect();
        let contact = (recording.plan.case >= 3).then(|| {
            let of = |joint: &str| fraction(between(&format!("{joint}.penetration")), |d| d > 0.0);
            let all = ["B1", "B2", "B3", "C1", "C2", "C3"].map(of);
            (all[0], all.into_iter().fold(1.0, f64::min))
        });
        let mut put = |what: &str, value: f64| numbers.put(format!("{name}.{what}"), value);
        if let Some((first, least)) = contact {
            put("contact_fraction_b1", first);
            put("contact_fraction_least", least);
        }
        Measures {
            step: recording.plan.step,
            error_peak: put("error_x_peak", peak(error)),
            deviation_rms: put("acceleration_deviation_rms", rms(&deviation)),
            deviation_frequency: put(
                "acceleration_deviation_frequency",
                median_frequency(&deviation, interval),
            ),
            settling: put(
                "acceleration_deviation_last_over_first_cycle",
                cycle(2.0) / cycle(0.0),
            ),
            // the last sample belongs to the next cycle
            repetition: put(
                "cycle_distance",
                cycle_distance(&acceleration[..acceleration.len() - 1]),
            ),
            force_peak: put("force_b1_peak", peak(force)),
            force_cubic_mean: put(
                "force_b1_cubic_mean",
                mean(&force.iter().map(|f| f.powi(3)).collect::<Vec<_>>()).cbrt(),
            ),
            force_ripple: put("force_b1_ripple_rms", rms(&ripple)),
            force_frequency: put(
                "force_b1_ripple_frequency",
                median_frequency(&ripple, interval),
            ),
            deviation,
            contact,
        }
    }
}

/// The measures of the runs of the figures.
pub struct AllMeasures {
    /// Case 1.
    pub ideal: Measures,
    /// Case 2, fine step.
    pub flexible: Measures,
    /// Case 2, coarse step.
    pub flexible_coarse: Measures,
    /// Case 3.
    pub loose: Measures,
    /// Case 4.
    pub both: Measures,
}

impl AllMeasures {
    /// Measures all runs.
    pub fn of(c: &Campaign, numbers: &mut Numbers) -> AllMeasures {
        AllMeasures {
            ideal: Measures::of(c, &c.ideal, "case1", numbers),
            flexible: Measures::of(c, &c.flexible, "case2", numbers),
            flexible_coarse: Measures::of(c, &c.flexible_coarse, "case2_coarse", numbers),
            loose: Measures::of(c, &c.loose, "case3", numbers),
            both: Measures::of(c, &c.both, "case4", numbers),
        }
    }
}

//! How long a run took, where and when: all that differs when it is repeated.

use cpu_time::ProcessTime;
use serde::{Deserialize, Serialize};
use std::time::{Instant, SystemTime, UNIX_EPOCH};

#[derive(Debug)]
pub(super) struct Stopwatch {
    wall: Instant,
    cpu: Option<ProcessTime>,
    date: String,
    before: Elapsed,
}

/// Time that a run has taken \[s\].
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
pub(super) struct Elapsed {
    wall_seconds: f64,
    /// Processor time of the process in user and system mode; absent where the system has no such clock.
    cpu_seconds: Option<f64>,
}

impl Elapsed {
    /// That of a run that begins.
    pub(super) const NONE: Elapsed = Elapsed {
        wall_seconds: 0.0,
        cpu_seconds: Some(0.0),
    };
}

#[derive(Debug, Serialize)]
pub(super) struct Timing {
    /// Start of the run or, of one that was interrupted, of its last part, UTC.
    date: String,
    machine: String,
    #[serde(flatten)]
    elapsed: Elapsed,
    /// Simulated time over wall time.
    real_time_factor: f64,
}

impl Stopwatch {
    /// Starts; a run that was interrupted has taken some time `before`.
    pub(super) fn start(before: Elapsed) -> Stopwatch {
        let since = SystemTime::now().duration_since(UNIX_EPOCH);
        Stopwatch {
            wall: Instant::now(),
            cpu: ProcessTime::try_now().ok(),
            date: date(since.map_or(0, |s| s.as_secs())),
            before,
        }
    }

    /// The time so far.
    pub(super) fn elapsed(&self) -> Elapsed {
        let cpu = self.cpu.and_then(|started| started.try_elapsed().ok());
        let before = self.before;
        Elapsed {
            wall_seconds: before.wall_seconds + self.wall.elapsed().as_secs_f64(),
            cpu_seconds: cpu
                .zip(before.cpu_seconds)
                .map(|(cpu, before)| before + cpu.as_secs_f64()),
        }
    }

    pub(super) fn stop(&self, simulated: f64) -> Timing {
        let elapsed = self.elapsed();
        Timing {
            date: self.date.clone(),
            machine: machine(),
            elapsed,
            real_time_factor: simulated / elapsed.wall_seconds,
        }
    }
}

/// Processor, threads and system.
pub fn machine() -> String {
    let info = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let model = info.lines().find(|line| line.starts_with("model name"));
    let model = model
        .and_then(|line| line.split_once(": "))
        .map_or("unknown processor", |m| m.1);
    let (os, arch) = (std::env::consts::OS, std::env::consts::ARCH);
    let threads = std::thread::available_parallelism().map_or(1, |n| n.get());
    format!("{model}, {threads} threads, {os} {arch}")
}

/// RFC 3339 date and time of `seconds` after 1970, UTC.
fn date(seconds: u64) -> String {
    let (days, rest) = (seconds / 86_400, seconds % 86_400);
    // Days since 1 March of the year 0; a 400-year era has 146 097 days. The year begins in March, so that a leap day
    // is its last day.
    let shifted = days + 719_468;
    let (era, day_of_era) = (shifted / 146_097, shifted % 146_097);
    let year_of_era =
        (day_of_era - day_of_era / 1_460 + day_of_era / 36_524 - day_of_era / 146_096) / 365;
    let day_of_year = day_of_era - (365 * year_of_era + year_of_era / 4 - year_of_era / 100);
    let from_march = (5 * day_of_year + 2) / 153;
    let day = day_of_year - (153 * from_march + 2) / 5 + 1;
    let month = if from_march < 10 {
        from_march + 3
    } else {
        from_march - 9
    };
    let year = 400 * era + year_of_era + u64::from(month <= 2);
    let (hour, minute, second) = (rest / 3_600, rest / 60 % 60, rest % 60);
    format!("{year:04}-{month:02}-{day:02}T{hour:02}:{minute:02}:{second:02}Z")
}

#[cfg(test)]
mod tests {
    use super::{Elapsed, Stopwatch, date, machine};

    #[test]
    fn a_machine_has_a_processor_and_a_system() {
        let machine = machine();
        assert!(machine.contains(std::env::consts::OS) && machine.contains(" threads, "));
    }

    /// Work of some milliseconds at most takes a processor time between nothing and a hundredth of a second, again and again:
    /// a clock that ticks every 10 ms says nothing most of the time.
    #[test]
    fn short_runs_have_a_processor_time() {
        let times = (1..=20).map(|n| {
            let stopwatch = Stopwatch::start(Elapsed::NONE);
            let sum: f64 = (0..n * 1000).map(|k| f64::from(k).sqrt()).sum();
            assert!(std::hint::black_box(sum) > 0.0);
            stopwatch.elapsed().cpu_seconds.unwrap()
        });
        let times: Vec<f64> = times.collect();
        assert!(times.iter().all(|t| *t > 0.0), "{times:?}");
        assert!(times.iter().any(|t| *t < 1e-3), "{times:?}");
    }

    #[test]
    fn dates() {
        assert_eq!(date(0), "1970-01-01T00:00:00Z");
        assert_eq!(date(951_782_400), "2000-02-29T00:00:00Z");
        assert_eq!(date(1_000_000_000), "2001-09-09T01:46:40Z");
        assert_eq!(date(4_107_542_399), "2100-02-28T23:59:59Z");
        assert_eq!(date(4_107_542_400), "2100-03-01T00:00:00Z");
    }
}

//! How long a run took, where and when: all that differs when it is repeated.

use serde::Serialize;
use std::time::{Instant, SystemTime, UNIX_EPOCH};

/// Clock ticks a second of `/proc`, fixed by Linux for all machines.
const TICKS: f64 = 100.0;

#[derive(Debug)]
pub(super) struct Stopwatch {
    wall: Instant,
    cpu: Option<f64>,
    date: String,
}

#[derive(Debug, Serialize)]
pub(super) struct Timing {
    /// Start of the run, UTC.
    date: String,
    machine: String,
    wall_seconds: f64,
    /// Absent where the system does not tell.
    cpu_seconds: Option<f64>,
    /// Simulated time over wall time.
    real_time_factor: f64,
}

impl Stopwatch {
    pub(super) fn start() -> Stopwatch {
        let since = SystemTime::now().duration_since(UNIX_EPOCH);
        Stopwatch {
            wall: Instant::now(),
            cpu: cpu_seconds(),
            date: date(since.map_or(0, |s| s.as_secs())),
        }
    }

    pub(super) fn stop(&self, simulated: f64) -> Timing {
        let wall_seconds = self.wall.elapsed().as_secs_f64();
        let cpu = cpu_seconds().zip(self.cpu);
        Timing {
            date: self.date.clone(),
            machine: machine(),
            wall_seconds,
            cpu_seconds: cpu.map(|(now, then)| now - then),
            real_time_factor: simulated / wall_seconds,
        }
    }
}

/// Processor time of this process in user and system mode \[s\].
fn cpu_seconds() -> Option<f64> {
    let stat = std::fs::read_to_string("/proc/self/stat").ok()?;
    // The second field is the program's name in parentheses, which may contain anything.
    let fields: Vec<&str> = stat.rsplit_once(')')?.1.split_whitespace().collect();
    let ticks = |index: usize| fields.get(index)?.parse::<f64>().ok();
    Some((ticks(11)? + ticks(12)?) / TICKS)
}

/// Processor, threads and system.
pub(crate) fn machine() -> String {
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
    use super::date;

    #[test]
    fn dates() {
        assert_eq!(date(0), "1970-01-01T00:00:00Z");
        assert_eq!(date(951_782_400), "2000-02-29T00:00:00Z");
        assert_eq!(date(1_000_000_000), "2001-09-09T01:46:40Z");
        assert_eq!(date(4_107_542_399), "2100-02-28T23:59:59Z");
        assert_eq!(date(4_107_542_400), "2100-03-01T00:00:00Z");
    }
}

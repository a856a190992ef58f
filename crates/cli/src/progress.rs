//! How far a run is: a bar on a terminal, a line at every tenth elsewhere and when none has come for a while.

use indicatif::{ProgressBar, ProgressStyle};
use looselink::simulate::{Notice, Progress};
use messages::Start;
use std::io::{IsTerminal, Write};
use std::time::{Duration, Instant};

/// Steps of the bar.
const FINE: f64 = 1000.0;
/// Lines of a run that is fast: one after every tenth of its duration.
const LINES: f64 = 10.0;
/// A slow run has a line after this time without one.
const SILENCE: Duration = Duration::from_secs(10);

/// Where progress is shown.
pub enum Display {
    /// Nowhere.
    None,
    /// On a terminal.
    Bar(ProgressBar, Start),
    /// On standard error that is no terminal: the part of the duration at which the next line is due, known from the first step
    /// on, and the time of the last one.
    Lines(Option<f64>, Instant, Start),
}

impl Display {
    /// A display on standard error of a run from a simulated time on.
    pub fn new(quiet: bool, from: f64) -> Display {
        let start = Start::at(from);
        if quiet {
            return Display::None;
        }
        if !std::io::stderr().is_terminal() {
            return Display::Lines(None, Instant::now(), start);
        }
        let style = ProgressStyle::with_template("{bar:30} {percent:>3} %  {msg}")
            .expect("the template is valid");
        Display::Bar(ProgressBar::new(FINE as u64).with_style(style), start)
    }

    /// Called after every step; `tick` is true a few times a second.
    pub fn show(&mut self, progress: &Progress, tick: bool) {
        let part = progress.t / progress.duration;
        match self {
            Display::Bar(bar, started) if tick => {
                bar.set_position((part * FINE) as u64);
                bar.set_message(started.line(progress));
            }
            Display::Lines(next, last, started)
                if next.is_none_or(|next| part >= next) || (tick && last.elapsed() > SILENCE) =>
            {
                let following = ((part * LINES).floor() + 1.0) / LINES;
                if next.replace(following).is_some() && part < 1.0 {
                    say(&started.line(progress));
                    *last = Instant::now();
                }
            }
            _ => {}
        }
    }

    /// The last word; the bar disappears.
    pub fn finish(&self, message: &str) {
        match self {
            Display::None => return,
            Display::Bar(bar, _) => bar.finish_and_clear(),
            Display::Lines(..) => {}
        }
        if !message.is_empty() {
            say(message);
        }
    }
}

/// A warning, shown with `--quiet` too.
pub fn warn(warning: &str) {
    say(&format!("warning: {warning}"));
}

/// Shows what is reported of many runs; with `quiet` the warnings alone.
pub fn show(notice: Notice, quiet: bool) {
    match notice {
        Notice::Begun(name) if !quiet => say(name),
        Notice::Begun(_) => {}
        Notice::Warned { run, warning } => warn(&format!("{run}: {warning}")),
    }
}

/// A line on standard error.
pub fn say(line: &str) {
    // A run does not fail because nobody listens.
    let _ = writeln!(std::io::stderr(), "{line}");
}

//! How far a run is: a bar on a terminal, a line at every tenth elsewhere and when none has come for a while.

use super::terminal::{is_shown_to_people, say};
use indicatif::{ProgressBar, ProgressStyle};
use looselink::simulate::{Notice, Progress};
use messages::Start;
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
        if !is_shown_to_people() {
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

/// How far a number of runs is: a bar on a terminal, a line after every tenth elsewhere and when none has come for a while.
pub enum RunsDisplay {
    /// Nowhere.
    Quiet,
    /// On a terminal.
    Bar(ProgressBar),
    /// On standard error that is no terminal: the number of runs at which the next line is due, and the time of the last one.
    Lines(Option<usize>, Instant),
}

impl RunsDisplay {
    /// A display on standard error.
    pub fn new(quiet: bool) -> RunsDisplay {
        if quiet {
            return RunsDisplay::Quiet;
        }
        if !is_shown_to_people() {
            return RunsDisplay::Lines(None, Instant::now());
        }
        let style = ProgressStyle::with_template("{bar:30} {pos} of {len} runs, {eta} left")
            .expect("the template is valid");
        RunsDisplay::Bar(ProgressBar::new(0).with_style(style))
    }

    /// Called after every run with the number of runs that are made and to be made.
    pub fn show(&mut self, done: usize, left: usize) {
        let all = done + left;
        match self {
            RunsDisplay::Quiet => {}
            RunsDisplay::Bar(bar) => {
                if bar.length() != Some(all as u64) {
                    // runs that were there when the sweep went on take no time
                    bar.set_length(all as u64);
                    bar.set_position(done as u64 - 1);
                    bar.reset_eta();
                }
                bar.set_position(done as u64);
            }
            RunsDisplay::Lines(due, last) => {
                let tenth = all.div_ceil(LINES as usize);
                let line = done >= *due.get_or_insert((done / tenth + 1) * tenth);
                if (line && left > 0) || last.elapsed() > SILENCE {
                    say(&format!("{done} of {all} runs"));
                    (*due, *last) = (Some((done / tenth + 1) * tenth), Instant::now());
                }
            }
        }
    }

    /// A line beside the display, with `--quiet` too.
    pub fn say(&self, line: &str) {
        match self {
            RunsDisplay::Bar(bar) => bar.suspend(|| say(line)),
            _ => say(line),
        }
    }

    /// The bar disappears.
    pub fn finish(&self) {
        if let RunsDisplay::Bar(bar) = self {
            bar.finish_and_clear();
        }
    }
}

/// A warning, shown with `--quiet` too.
pub fn warn(warning: &str) {
    say(&format!("warning: {warning}"));
}

/// A fact about a run.
pub fn remark(note: &str) {
    say(&format!("note: {note}"));
}

/// Shows what is reported of many runs; with `quiet` the warnings alone.
pub fn show(notice: Notice, quiet: bool) {
    match notice {
        Notice::Begun(name) if !quiet => say(name),
        Notice::Begun(_) => {}
        Notice::Warned { run, warning } => warn(&format!("{run}: {warning}")),
    }
}

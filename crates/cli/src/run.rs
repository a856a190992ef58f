//! `looselink run`

use super::SceneArguments;
use super::closing;
use super::failure::CommandFailure;
use super::interrupt::Interrupt;
use super::progress::{Display, remark, warn};
use super::terminal::word;
use clap::Args;
use folder::{Folder, OutputError, earlier_result};
use looselink::model::Model;
use looselink::output::{Results, StoredCheckpoint};
use looselink::scene::Scene;
use looselink::simulate::{ContactEvent, Control, Observer, Progress, RunError, Simulation};
use looselink::system::State;
use messages::Ticker;
use std::io;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};
use view::{has_page, keep_page};

#[derive(Debug, Args)]
pub struct Arguments {
    #[command(flatten)]
    scene: SceneArguments,
    /// The folder that receives the results; it is created.
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    /// Replace an existing result; it is kept in `previous-result` inside the folder until the new one is complete.
    #[arg(long)]
    force: bool,
    #[command(flatten)]
    options: RunOptions,
}

/// How a run is shown and kept.
#[derive(Debug, Clone, Args)]
pub struct RunOptions {
    /// Write `view.html` into the folder, in which the mechanism moves.
    #[arg(long)]
    pub view: bool,
    /// Show warnings and errors alone, no progress, no closing table and no notes.
    #[arg(long)]
    pub quiet: bool,
    /// Time between two checkpoints, from which `looselink resume` goes on if the program is killed.
    #[arg(long, value_name = "SECONDS", default_value = "10", value_parser = seconds, allow_negative_numbers = true)]
    checkpoint: f64,
}

impl RunOptions {
    /// Refuses a page of a run without motion.
    pub fn check(&self, scene: &Scene) -> Result<(), CommandFailure> {
        let message = "--view shows the motion, which `output.motion = false` leaves out";
        match self.view && !scene.output.motion {
            true => Err(CommandFailure::bad_input(message)),
            false => Ok(()),
        }
    }
}

/// A time of a clock, a century at most.
fn seconds(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(seconds) if (0.0..=3.2e9).contains(&seconds) => Ok(seconds),
        _ => Err("not a number of seconds".to_owned()),
    }
}

/// Rows reach the disk at least this often.
const FLUSH: Duration = Duration::from_secs(1);

/// Passes results on to the disk and to the user.
struct RunObserver {
    results: Results,
    display: Display,
    ticker: Ticker,
    flushed: Instant,
    /// When the last checkpoint was kept, and the time between two.
    kept: Instant,
    every: Duration,
    interrupt: Interrupt,
}

impl Observer for RunObserver {
    fn row(&mut self, values: &[f64]) -> io::Result<()> {
        self.results.row(values)
    }

    fn state(&mut self, model: &Model, at: &State) -> io::Result<()> {
        self.results.state(model, at)
    }

    fn contact(&mut self, contact: &ContactEvent) -> io::Result<()> {
        self.results.contact(contact)
    }

    fn step(&mut self, progress: &Progress) -> io::Result<Control> {
        let tick = self.ticker.tick();
        if tick && self.flushed.elapsed() >= FLUSH {
            self.results.flush()?;
            self.flushed = Instant::now();
        }
        self.display.show(progress, tick);
        if self.interrupt.has_come() {
            return Ok(Control::Stop);
        }
        if tick && self.kept.elapsed() >= self.every {
            self.kept = Instant::now();
            return Ok(Control::Checkpoint);
        }
        Ok(Control::Continue)
    }

    fn checkpoint(&mut self, t: f64, bytes: &[u8]) -> io::Result<()> {
        let stored = self.results.checkpoint(t, bytes);
        stored.map_err(io::Error::other)
    }
}

/// Simulates the scene; whatever ends the run, what was recorded up to there stands.
pub fn run(arguments: &Arguments) -> Result<(), CommandFailure> {
    let interrupt = Interrupt::watch()?;
    let Arguments { out, force, .. } = arguments;
    let folder = Folder::claim(out, view::kind(), *force).map_err(|error| match error {
        OutputError::Occupied { .. } if StoredCheckpoint::is_in(out) => {
            let out = word(out);
            CommandFailure::from(error)
                .and(&format!("; `looselink resume {out}` goes on with the run"))
        }
        error => error.into(),
    })?;
    let (scene, simulation) = arguments.scene.load()?;
    arguments.options.check(&scene)?;
    interrupt.begin();
    let results = Results::begin(folder, &scene, &simulation);
    let results = results.map_err(|error| not_stored(error, out, *force))?;
    let options = &arguments.options;
    to_the_end(simulation, results, out, *force, options, interrupt)
}

/// Simulates what is left of a run.
pub fn to_the_end(
    mut simulation: Simulation,
    results: Results,
    out: &Path,
    replaces: bool,
    options: &RunOptions,
    interrupt: Interrupt,
) -> Result<(), CommandFailure> {
    // a unit is best mended before the run has taken its time
    let told = simulation.implausible();
    told.iter().for_each(|warning| warn(warning));
    let started = Instant::now();
    let before = simulation.report().steps;
    let mut observer = RunObserver {
        results,
        display: Display::new(options.quiet, simulation.state().t),
        ticker: Ticker::new(),
        flushed: started,
        kept: started,
        every: Duration::from_secs_f64(options.checkpoint),
        interrupt,
    };
    let ended = simulation.run(&mut observer);
    let report = simulation.report();
    let stored = observer.results.finish(&report);
    let warn_of_all = || {
        let warnings = report.warnings().into_iter();
        let new = warnings.filter(|warning| !told.contains(warning));
        new.for_each(|warning| warn(&warning));
        if !options.quiet {
            report.notes().iter().for_each(|note| remark(note));
        }
    };
    observer.display.finish("");
    let folder = out.display();
    // a page of the part so far would be out of date
    let shows = options.view || (stored.is_ok() && has_page(out));
    if let Err(error) = ended {
        warn_of_all();
        // a run that cannot go on would stop there again
        let resumable = matches!(error, RunError::Interrupted { .. } | RunError::Output(_));
        let go_on = match resumable && StoredCheckpoint::is_in(out) {
            true => format!(
                "; `looselink resume {}` goes on from its last checkpoint",
                word(out)
            ),
            false => String::new(),
        };
        let kept = match stored {
            Ok(()) if shows => match keep_page(out, None).map_err(CommandFailure::from) {
                Ok(page) => format!("; the motion up to that time is in `{}`", page.display()),
                Err(second) => second.after("the page could not be written"),
            },
            Ok(()) => format!("; the results up to that time are in `{folder}`"),
            // what has stopped the run
            Err(second) if error.to_string() == second.to_string() => {
                return Err(CommandFailure::run(&error).and(&earlier(out, replaces)));
            }
            Err(second) => {
                format!("; the result in `{folder}` could not be completed: {second}")
            }
        };
        return Err(CommandFailure::run(&error)
            .and(&kept)
            .and(&go_on)
            .and(&earlier(out, replaces)));
    }
    stored.map_err(|error| not_stored(error, out, replaces))?;
    let (steps, wall) = (report.steps - before, started.elapsed().as_secs_f64());
    let reached = numbers::exact(report.t);
    let done = format!("t = {reached} s after {steps} steps in {wall:.2} s, results in `{folder}`");
    observer.display.finish(&done);
    for line in closing::lines(&report) {
        observer.display.finish(&line);
    }
    warn_of_all();
    if shows {
        let page = keep_page(out, None)?;
        observer
            .display
            .finish(&format!("open `{}` in a browser", page.display()));
    }
    Ok(())
}

/// A result that could not be stored.
pub fn not_stored(error: OutputError, out: &Path, replaces: bool) -> CommandFailure {
    CommandFailure::from(error).and(&earlier(out, replaces))
}

/// Where a result is that the run was to replace.
fn earlier(out: &Path, replaces: bool) -> String {
    let aside = earlier_result(out).filter(|_| replaces);
    aside.map_or(String::new(), |aside| {
        format!("; the earlier result is in `{}`", aside.display())
    })
}

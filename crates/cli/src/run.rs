//! `looselink run`

use super::SceneArguments;
use super::closing;
use super::failure::{CommandFailure, INTERRUPTED};
use super::progress::{Display, Ticker, warn};
use super::view;
use clap::Args;
use looselink::model::Model;
use looselink::output::{Folder, OutputError, Results, earlier_result, files};
use looselink::registry::Registry;
use looselink::simulate::{ContactEvent, Control, Observer, Progress};
use looselink::system::State;
use std::io;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

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
    /// Write `view.html` into the folder, in which the mechanism moves.
    #[arg(long)]
    view: bool,
    /// Show no progress; warnings are still shown.
    #[arg(long)]
    quiet: bool,
}

/// Rows reach the disk at least this often.
const FLUSH: Duration = Duration::from_secs(1);

/// Passes results on to the disk and to the user.
struct RunObserver {
    results: Results,
    display: Display,
    ticker: Ticker,
    flushed: Instant,
    stop: Arc<AtomicBool>,
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
        Ok(match self.stop.load(Ordering::Relaxed) {
            true => Control::Stop,
            false => Control::Continue,
        })
    }
}

/// Simulates the scene; whatever ends the run, what was recorded up to there stands.
pub fn run(arguments: &Arguments) -> Result<(), CommandFailure> {
    let stop = stop_on_interrupt()?;
    let mut files = files(&Registry::standard().formats);
    files.push(view::PAGE.to_owned());
    let folder = Folder::new(&arguments.out, &files, arguments.force)?;
    let (scene, mut simulation) = arguments.scene.load()?;
    if arguments.view && !scene.output.motion {
        let message = "--view shows the motion, which `output.motion = false` leaves out";
        return Err(CommandFailure::bad_input(message));
    }
    let started = Instant::now();
    let not_stored = |error: OutputError| CommandFailure::from(error).and(&earlier(arguments));
    let results = Results::begin(folder, &scene, &simulation);
    let mut observer = RunObserver {
        results: results.map_err(not_stored)?,
        display: Display::new(arguments.quiet),
        ticker: Ticker::new(),
        flushed: started,
        stop,
    };
    let ended = simulation.run(&mut observer);
    let report = simulation.report();
    let out = arguments.out.display();
    let stored = observer.results.finish(&report);
    let warn_of_all = || report.warnings().iter().for_each(|warning| warn(warning));
    observer.display.finish("");
    if let Err(error) = ended {
        warn_of_all();
        let kept = match stored {
            Ok(()) if arguments.view => {
                let page = view::beside(&arguments.out)?;
                format!("; the motion up to that time is in `{}`", page.display())
            }
            Ok(()) => format!("; the results up to that time are in `{out}`"),
            Err(second) => format!("; the result in `{out}` could not be completed: {second}"),
        };
        return Err(CommandFailure::run(&error)
            .and(&kept)
            .and(&earlier(arguments)));
    }
    stored.map_err(not_stored)?;
    let (steps, wall) = (report.steps, started.elapsed().as_secs_f64());
    let done = format!("{steps} steps in {wall:.2} s, results in `{out}`");
    observer.display.finish(&done);
    for line in closing::lines(&report) {
        observer.display.finish(&line);
    }
    warn_of_all();
    if arguments.view {
        let page = view::beside(&arguments.out)?;
        observer
            .display
            .finish(&format!("open `{}` in a browser", page.display()));
    }
    Ok(())
}

/// Where a result is that the run was to replace.
fn earlier(arguments: &Arguments) -> String {
    let aside = earlier_result(&arguments.out).filter(|_| arguments.force);
    aside.map_or(String::new(), |aside| {
        format!("; the earlier result is in `{}`", aside.display())
    })
}

/// The flag is raised by the first Ctrl-C; the second ends the program at once.
fn stop_on_interrupt() -> Result<Arc<AtomicBool>, CommandFailure> {
    let stop = Arc::new(AtomicBool::new(false));
    let raised = stop.clone();
    ctrlc::set_handler(move || {
        if raised.swap(true, Ordering::Relaxed) {
            std::process::exit(INTERRUPTED.into());
        }
    })
    .map_err(|e| CommandFailure::system(format!("cannot watch for Ctrl-C: {e}")))?;
    Ok(stop)
}

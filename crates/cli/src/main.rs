//! The command line of Looselink: arguments, commands and exit codes.

mod ablate;
mod closing;
mod completions;
mod failure;
mod inspect;
mod interrupt;
mod modes;
mod new;
mod plot;
mod precision;
mod progress;
mod resume;
mod run;
mod schema;
mod suggestion;
mod sweep;
mod templates;
mod terminal;
mod view;

use clap::{Args, CommandFactory, Parser, Subcommand};
use failure::CommandFailure;
use looselink::compile::drive_limit::DriveCourse;
use looselink::document::did_you_mean;
use looselink::initial::Freedoms;
use looselink::scene::{Scene, SceneError};
use looselink::simulate::Simulation;
use progress::remark;
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use terminal::print;
use texts::harmless_line;

/// Simulates planar mechanisms with flexible links and loose joints.
#[derive(Debug, Parser)]
#[command(
    version,
    after_help = "Exit codes: 0 done, 1 input or output failed, 2 bad input, 3 the run cannot go on, \
    130 interrupted.\n\nExample:\n  looselink run scenes/3rrr/case4.toml --out out/case4"
)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Write a commented scene to start from, and the schema that editors check it with.
    #[command(after_help = "Example:\n  looselink new four-bar my.toml")]
    New(new::Arguments),
    /// Simulate a scene and write its channels.
    #[command(
        after_help = "Example:\n  looselink run scenes/3rrr/case4.toml --out out/case4 --set integrator.step=5e-6"
    )]
    Run(run::Arguments),
    /// Go on with a run that was interrupted or killed, from its last checkpoint.
    #[command(after_help = "Example:\n  looselink resume out/case4")]
    Resume(resume::Arguments),
    /// Show the motion of a result: one HTML file for a browser, or SVG pictures.
    #[command(after_help = "Example:\n  looselink view out/case4 --ghost out/case1")]
    View(view::Arguments),
    /// Draw channels of a result: over time, over each other, their spectrum, a Poincare section.
    #[command(
        after_help = "Example:\n  looselink plot out/case4 --channels 'error.*' -o error.svg\n  \
        looselink plot out/case4 --phase B1.ex B1.ey -o orbit.svg"
    )]
    Plot(plot::Arguments),
    /// Find natural frequencies and mode shapes about a pose.
    #[command(
        after_help = "Example:\n  looselink modes scenes/3rrr/case4.toml --at 0.01 --contacts ideal"
    )]
    Modes(modes::Arguments),
    /// Show the compiled scene without running it.
    #[command(after_help = "Example:\n  looselink inspect scenes/3rrr/case4.toml --json")]
    Inspect(inspect::Arguments),
    /// Read a scene, assemble its mechanism and report the first error.
    #[command(
        after_help = "Example:\n  looselink check scenes/3rrr/case4.toml --set bodies.link1.elements=4"
    )]
    Check(SceneArguments),
    /// Measure error against processor time for several methods and steps.
    #[command(after_help = "Example:\n  looselink precision studies/case3.toml --out out/case3")]
    Precision(precision::Arguments),
    /// Measure the influence and cost of each effect: added to the rigid ideal mechanism, and removed from the full scene.
    #[command(
        after_help = "Example:\n  looselink ablate scenes/3rrr/case4.toml --set simulation.duration=0.05 --out out/ablation"
    )]
    Ablate(ablate::Arguments),
    /// Run a scene at many values of its fields: tables, pictures, and the value at which a measure reaches a target.
    #[command(
        after_help = "Examples:\n  looselink sweep studies/sweeps/clearance-speed.toml --out out/sweep\n  \
        looselink sweep studies/sweeps/clearance-speed.toml --out out/sweep --shard 3/16\n  \
        looselink sweep studies/sweeps/clearance-speed.toml --out out/sweep --merge"
    )]
    Sweep(sweep::Arguments),
    /// Show the scene language as a JSON schema, for editors.
    #[command(after_help = "Example:\n  looselink schema > looselink.schema.json")]
    Schema,
    /// Print a script by which a shell completes commands and options.
    #[command(
        after_help = "Example:\n  looselink completions bash > ~/.local/share/bash-completion/completions/looselink"
    )]
    Completions(completions::Arguments),
}

/// A scene and changes to it.
#[derive(Debug, Args)]
struct SceneArguments {
    /// The scene file.
    scene: PathBuf,
    /// Replace a field of the scene, for example `integrator.step=1e-6`; may be repeated.
    #[arg(long = "set", value_name = "PATH=VALUE")]
    overrides: Vec<String>,
    /// Choose the steps by their estimated error: the allowed error of positions (m) and of the energy balance (J), and the
    /// time (s) over which errors may accumulate, for example `position=1e-9,horizon=0.01`; a number without a key is the position.
    #[arg(long, value_name = "position=M[,energy=J][,horizon=S]", value_parser = accuracy, allow_hyphen_values = true)]
    accuracy: Option<String>,
}

/// Checks the keys and numbers of an accuracy. A number without a key, at the beginning, is the position.
fn accuracy(text: &str) -> Result<String, String> {
    const EXAMPLE: &str = "for example `position=1e-9,horizon=0.01`";
    const KEYS: [&str; 3] = ["position", "energy", "horizon"];
    let first = text.split(',').next().unwrap_or_default();
    let text = match first.trim().parse::<f64>() {
        Ok(_) => format!("position={text}"),
        Err(_) => text.to_owned(),
    };
    for part in text.split(',') {
        let Some((key, number)) = part.split_once('=') else {
            return Err(format!(
                "`{part}` lacks a key; commas separate the keys, numbers have a decimal point: {EXAMPLE}"
            ));
        };
        if !KEYS.contains(&key.trim()) {
            let hint = did_you_mean(key.trim(), KEYS);
            return Err(format!(
                "unknown key `{key}`; the keys are `position` [m], `energy` [J] and `horizon` [s]: {EXAMPLE}{hint}"
            ));
        }
        if number.trim().parse::<f64>().is_err() {
            return Err(format!(
                "`{number}` is not a number; units are not written, all are SI units: {EXAMPLE}"
            ));
        }
    }
    Ok(text)
}

impl SceneArguments {
    /// The scene of a file with some overrides, and those of the command line after them.
    fn scene_with(&self, file: &Path, mut overrides: Vec<String>) -> Result<Scene, SceneError> {
        overrides.extend(self.overrides.iter().cloned());
        let accuracy = self.accuracy.as_ref();
        overrides.extend(accuracy.map(|a| format!("integrator.accuracy={{ {a} }}")));
        Scene::load(file, &overrides)
    }

    fn load(&self) -> Result<(Scene, Simulation), SceneError> {
        let scene = self.scene_with(&self.scene, Vec::new())?;
        let simulation = Simulation::new(&scene)?;
        Ok((scene, simulation))
    }
}

fn main() -> ExitCode {
    let arguments = Arguments::try_parse().unwrap_or_else(|error| refused(error).exit());
    let result = interrupt::survive_limits().and_then(|()| match &arguments.command {
        Command::New(arguments) => new::new(arguments),
        Command::Run(arguments) => run::run(arguments),
        Command::Plot(arguments) => plot::plot(arguments),
        Command::Resume(arguments) => resume::resume(arguments),
        Command::View(arguments) => view::view(arguments),
        Command::Modes(arguments) => modes::modes(arguments),
        Command::Inspect(arguments) => inspect::inspect(arguments),
        Command::Check(arguments) => check(arguments),
        Command::Precision(arguments) => precision::precision(arguments),
        Command::Ablate(arguments) => ablate::ablate(arguments),
        Command::Sweep(arguments) => sweep::sweep(arguments),
        Command::Schema => schema::show(),
        Command::Completions(arguments) => completions::completions(arguments),
    });
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => failure.show(),
    }
}

/// The error of a command line. It quotes arguments, so it is made of arguments that can be shown.
fn refused(error: clap::Error) -> clap::Error {
    let shown = |argument: OsString| harmless_line(&argument.to_string_lossy()).into_owned();
    let arguments = Arguments::try_parse_from(std::env::args_os().map(shown));
    // what is wrong may be that an argument is not UTF-8
    let error = arguments.err().unwrap_or(error);
    suggestion::added(error, &Arguments::command())
}

fn check(arguments: &SceneArguments) -> Result<(), CommandFailure> {
    let (scene, simulation) = arguments.load()?;
    let notes = simulation.scene_notes();
    notes.iter().for_each(|note| remark(note));
    let course = simulation.drive_course();
    match course {
        DriveCourse::Limited(limit) if limit.stops_the_motion() => {
            return Err(limit.fault(&scene).into());
        }
        DriveCourse::Cut(t) => progress::warn(&format!(
            "the drives are followed up to t = {} s only: whether they meet a limit later was not checked",
            numbers::number(*t, 6)
        )),
        _ => {}
    }
    let doubt = course.doubt(scene.simulation.duration);
    doubt.iter().for_each(|told| progress::warn(told));
    let implausible = simulation.implausible();
    implausible.iter().for_each(|told| progress::warn(told));
    let freedoms = Freedoms::of(&scene).map_or(String::new(), |found| format!("; {found}"));
    print(format!("{}: no error found{freedoms}\n", scene.title))
}

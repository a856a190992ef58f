//! `looselink plot`: figures of the channels of a result.

mod phase;
mod spectrum;

use super::failure::CommandFailure;
use super::print;
use clap::{ArgGroup, Args};
use folder::replace;
use looselink::document::did_you_mean;
use looselink::record::patterns;
use plot::palette::SERIES;
use plot::{Axis, Figure, Mark, Panel, png, svg};
use std::path::PathBuf;
use view::{StoredChannel, StoredResult};

const NO_PNG: &str = "this program was compiled without PNG; a name that ends in .svg makes an SVG picture, and \
    `cargo install --locked --path crates/cli --features png` makes a program that has PNG";

/// Highest PNG in pixels. Firefox decodes no higher one; it has 275 MB of pixels.
const HIGHEST_PNG: i32 = 32_767;

#[derive(Debug, Args)]
#[command(group(ArgGroup::new("what").required(true)))]
pub struct Arguments {
    /// The folder of a result.
    dir: PathBuf,
    /// Channels over time, a panel for each unit; `*` stands for any characters.
    #[arg(long, value_name = "NAME", num_args = 1.., group = "what")]
    channels: Vec<String>,
    /// One channel over another.
    #[arg(long, value_names = ["X", "Y"], num_args = 2, group = "what")]
    phase: Vec<String>,
    /// Amplitude spectrum of a channel.
    #[arg(long, value_name = "NAME", group = "what")]
    spectrum: Option<String>,
    /// With --spectrum: leave out frequencies above this one (Hz).
    #[arg(long, value_name = "HZ", requires = "spectrum", conflicts_with_all = ["channels", "phase"], allow_negative_numbers = true)]
    max_frequency: Option<f64>,
    /// With --phase: a point at every multiple of this period (s) instead of a curve, a Poincare section.
    #[arg(long, value_name = "PERIOD", requires = "phase", conflicts_with_all = ["channels", "spectrum"], allow_negative_numbers = true)]
    poincare: Option<f64>,
    /// Leave out what comes before this time (s).
    #[arg(long, value_name = "T", allow_negative_numbers = true)]
    from: Option<f64>,
    /// Leave out what comes after this time (s).
    #[arg(long, value_name = "T", allow_negative_numbers = true)]
    to: Option<f64>,
    /// The figure, an SVG file or, with the feature `png`, a PNG file.
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,
}

/// Writes the figure.
pub fn plot(arguments: &Arguments) -> Result<(), CommandFailure> {
    let extension = arguments.output.extension().unwrap_or_default();
    if extension != "svg" && extension != "png" {
        let path = arguments.output.display();
        return Err(CommandFailure::bad_input(format!(
            "`{path}` must end in .svg or .png"
        )));
    }
    let mut result = StoredResult::load(&arguments.dir)?;
    cut(&mut result, arguments)?;
    let panels = match (&arguments.phase[..], &arguments.spectrum) {
        ([x, y], _) => {
            let [x, y] = [x, y].map(|name| find(&result, name));
            vec![phase::panel(&result, x?, y?, arguments.poincare)?]
        }
        (_, Some(name)) => {
            let highest = arguments.max_frequency.unwrap_or(f64::INFINITY);
            vec![spectrum::panel(
                &result.times,
                find(&result, name)?,
                highest,
            )?]
        }
        _ => over_time(&result, &arguments.channels)?,
    };
    let figure = Figure::grid(panels, 1, caption(&result));
    if extension == "png" {
        check_height(&figure)?;
    }
    let text = svg(&figure);
    let bytes = match extension.to_str() {
        Some("png") => png(&text)
            .map_err(CommandFailure::system)?
            .ok_or_else(|| CommandFailure::bad_input(NO_PNG))?,
        _ => text.into_bytes(),
    };
    replace(&arguments.output, &bytes)?;
    print(format!("wrote `{}`\n", arguments.output.display()))
}

/// A legend that names many channels is high.
fn check_height(figure: &Figure) -> Result<(), CommandFailure> {
    let height = figure.height();
    if height <= HIGHEST_PNG {
        return Ok(());
    }
    let marks = figure.rows.iter().flatten().map(|panel| panel.marks.len());
    Err(CommandFailure::bad_input(format!(
        "a PNG that names {} channels would be {height} pixels high, and browsers show at most {HIGHEST_PNG}; choose fewer channels, \
         or a name that ends in .svg",
        marks.sum::<usize>()
    )))
}

/// Which run a figure shows, and what it warned of.
fn caption(result: &StoredResult) -> String {
    let StoredResult { scene, summary, .. } = result;
    let mut caption = format!("{}; {}", scene.title, result.method());
    for change in &summary.overrides {
        caption += &format!(", {change}");
    }
    if summary.status != "complete" {
        caption += &format!("; the run is {}", summary.status);
    }
    caption
        + &match &summary.warnings[..] {
            [] => ". The run gave no warning.".to_owned(),
            [warning] => format!(". The run warned: {warning}."),
            all => format!(
                ". The run gave {} warnings, which summary.json lists.",
                all.len()
            ),
        }
}

/// Keeps the rows between `--from` and `--to`.
fn cut(result: &mut StoredResult, arguments: &Arguments) -> Result<(), CommandFailure> {
    let [from, to] = [
        arguments.from.unwrap_or(f64::NEG_INFINITY),
        arguments.to.unwrap_or(f64::INFINITY),
    ];
    let first = result.times.partition_point(|t| *t < from);
    let end = result.times.partition_point(|t| *t <= to);
    if end < first + 2 {
        let [begin, last] = [result.times[0], result.times[result.times.len() - 1]];
        return Err(CommandFailure::bad_input(format!(
            "fewer than two rows lie between --from and --to; the result has {begin} s to {last} s"
        )));
    }
    result.times = result.times[first..end].to_vec();
    for channel in &mut result.channels {
        channel.values = channel.values[first..end].to_vec();
    }
    Ok(())
}

/// The channel of a name; the error names the nearest ones.
fn find<'a>(result: &'a StoredResult, name: &str) -> Result<&'a StoredChannel, CommandFailure> {
    let names = || result.channels.iter().map(|c| c.name.as_str());
    let channel = result.channels.iter().find(|c| c.name == name);
    channel.ok_or_else(|| {
        let hint = did_you_mean(name, names());
        let recorded: Vec<&str> = names().collect();
        CommandFailure::bad_input(format!(
            "the result has no channel `{name}`{hint}; its channels: {}",
            recorded.join(", ")
        ))
    })
}

/// A panel for each unit of the channels that patterns name.
fn over_time(result: &StoredResult, wanted: &[String]) -> Result<Vec<Panel>, CommandFailure> {
    let names = result.channels.iter().map(|c| &*c.name);
    let choice = patterns::choose(wanted.iter().map(|text| &**text), names);
    if let Some(&unmatched) = choice.unmatched.first() {
        find(result, &wanted[unmatched])?;
    }
    let mut panels: Vec<(&str, Panel)> = Vec::new();
    for channel in choice.names.into_iter().map(|k| &result.channels[k]) {
        let place = panels.iter().position(|(unit, _)| *unit == channel.unit);
        let place = place.unwrap_or_else(|| {
            panels.push((
                &channel.unit,
                panel(Axis::new("Time", "s", 1.0), axis("", channel)),
            ));
            panels.len() - 1
        });
        let marks = &mut panels[place].1.marks;
        let color = SERIES[marks.len() % SERIES.len()];
        marks.push(Mark::series(
            &channel.name,
            color,
            &result.times,
            &channel.values,
        ));
    }
    Ok(panels.into_iter().map(|(_, panel)| panel).collect())
}

/// Axes without marks.
fn panel(x: Axis, y: Axis) -> Panel {
    Panel {
        title: String::new(),
        note: String::new(),
        x,
        y,
        marks: Vec::new(),
    }
}

/// An axis in the unit of a channel.
fn axis(label: &str, channel: &StoredChannel) -> Axis {
    let unit = match channel.unit.as_str() {
        "1" => "",
        unit => unit,
    };
    Axis::new(label, unit, 1.0)
}

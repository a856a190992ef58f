//! Runs every study in `studies/`, adds the second implementation with IDA as a rival, takes the paper's case 4 apart effect
//! by effect, and writes ACCURACY.md.

mod amplification;
mod asked;
mod effects;
mod guarantee;
mod guarantee_page;
mod page;
mod timings;

use accuracy::ida;
use accuracy::settings::{ORDERS, SettingsSweep};
use asked::AccurateRuns;
use clap::{Parser, Subcommand};
use looselink::simulate::Notice;
use miette::{IntoDiagnostic, Result, WrapErr, miette};
use records::RunningCampaign;
use std::path::{Path, PathBuf};
use std::time::Instant;
use studies::ablation::figure as figure_of_effects;
use studies::machine::machine;
use studies::precision::{
    Compared, Effort, MotionReference, StatisticsReference, Study, StudyOutcome, Survey,
};

/// Runs all studies of precision against time and writes ACCURACY.md.
#[derive(Debug, Parser)]
struct Arguments {
    /// Timed runs of every point, after one that is not timed.
    #[arg(long, default_value_t = 5, value_parser = clap::value_parser!(u16).range(1..))]
    repeats: u16,
    #[command(subcommand)]
    command: Option<Command>,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Runs every dynamic scene with every method and seven accuracies and writes pages/accuracy/GUARANTEE.md; an interrupted
    /// campaign goes on where it stopped.
    Guarantee {
        /// Scenes such as `pendulum,3rrr/case4`, instead of all.
        #[arg(long, value_delimiter = ',')]
        only: Vec<String>,
        /// Threads.
        #[arg(long, default_value_t = 3, value_parser = clap::value_parser!(u16).range(1..))]
        jobs: u16,
        /// Writes the page from the record and runs nothing.
        #[arg(long, conflicts_with_all = ["only", "jobs"])]
        page: bool,
    },
}

/// A study and what came of it.
pub struct MadeStudy {
    /// Name of its file without the extension.
    pub name: String,
    /// What was asked.
    pub study: Study,
    /// What was found.
    pub outcome: StudyOutcome,
    /// How the settings of IDA were found.
    pub ida: Vec<SettingsSweep>,
}

/// A study of statistics and what came of it.
pub struct Surveyed {
    /// Name of its file without the extension.
    pub name: String,
    /// What was asked.
    pub study: Study,
    /// What was found.
    pub survey: Survey,
}

/// IDA takes minutes for the seconds of a study of statistics: one tolerance and ratio, timed once.
const LONG: (&[f64], usize) = (&[1e-6], 1);

fn main() -> Result<()> {
    let arguments = Arguments::parse();
    match arguments.command {
        Some(Command::Guarantee { only, jobs, page }) => guarantee(&only, jobs.into(), page),
        None => studied(arguments.repeats),
    }
}

/// The measured guarantee.
fn guarantee(only: &[String], threads: usize, page: bool) -> Result<()> {
    if page {
        guarantee_page::write(&guarantee::read()?.1)?;
        return records::write_notes(&records::root());
    }
    let campaign = RunningCampaign::begin("guarantee")?;
    let (entries, all) = guarantee::run(only, threads)?;
    guarantee_page::write(&entries)?;
    match all {
        true => campaign.finish(),
        false => records::write_notes(&records::root()),
    }
}

/// The studies of precision against time.
fn studied(repeats: u16) -> Result<()> {
    let campaign = RunningCampaign::begin("accuracy")?;
    let root = records::root();
    let started = Instant::now();
    let (mut made, mut surveyed) = (Vec::new(), Vec::new());
    let pictures = root.join("pages/accuracy/figures");
    for path in studies(&root.join("studies"))? {
        let name = path.file_stem().unwrap_or_default();
        let name = name.to_string_lossy().into_owned();
        let study = Study::load(&path).map_err(|e| miette!("{e}"))?;
        let repeats = repeats.into();
        let effort = Effort {
            repeats,
            smoke: false,
        };
        let mut tell = |notice: Notice| show(&name, notice);
        if study.statistics.is_some() {
            let survey = Survey::run(&study, effort, &mut tell);
            let mut survey = survey.map_err(|e| miette!("{e}"))?;
            let (tolerances, repeats) = LONG;
            for max_order in ORDERS {
                let settings = ida::usual_settings(&study, max_order)?;
                let curve = ida::name(max_order);
                ida::points(
                    &study,
                    settings,
                    tolerances,
                    repeats,
                    &mut tell,
                    &mut |pace, made| survey.add(&study, &curve, pace, made),
                )?;
            }
            plot::save(
                &StatisticsReference::figure(&survey, &study),
                &pictures,
                &name,
            )?;
            surveyed.push(Surveyed {
                name,
                study,
                survey,
            });
            continue;
        }
        let outcome = StudyOutcome::run(&study, effort, &mut tell);
        let mut outcome = outcome.map_err(|e| miette!("{e}"))?;
        // IDA is a rival to methods; a mesh has none
        let ida = match study.compares_elements() {
            true => Vec::new(),
            false => ida::add_curves(&study, &name, &mut outcome, repeats, &mut tell)?,
        };
        plot::save(&MotionReference::figure(&outcome, &study), &pictures, &name)?;
        made.push(MadeStudy {
            name,
            study,
            outcome,
            ida,
        });
    }
    let ablation = effects::ablation(&root.join("scenes/3rrr/case4.toml"))?;
    plot::save(&figure_of_effects(&ablation), &pictures, "ablation")?;
    let accurate = AccurateRuns::new(&made);
    plot::save(&accurate.figure(), &pictures, asked::FIGURE)?;
    timings::write(
        &root.join("pages/accuracy/timings.json"),
        &made,
        &surveyed,
        &ablation,
    )?;
    let page = page::page(
        &made,
        &surveyed,
        &accurate,
        &ablation,
        &machine(),
        started.elapsed().as_secs_f64(),
    );
    let path = root.join("ACCURACY.md");
    std::fs::write(&path, page)
        .into_diagnostic()
        .wrap_err_with(|| format!("cannot write {}", path.display()))?;
    campaign.finish()
}

/// Shows what is reported of the runs of a study.
fn show(study: &str, notice: Notice) {
    match notice {
        Notice::Begun(run) => eprintln!("{study}: {run}"),
        Notice::Warned { run, warning } => eprintln!("{study}: {run}: warning: {warning}"),
    }
}

/// Files of the folder, in the order of their names.
fn studies(folder: &Path) -> Result<Vec<PathBuf>> {
    let entries = std::fs::read_dir(folder)
        .into_diagnostic()
        .wrap_err_with(|| format!("cannot read {}", folder.display()))?;
    let mut paths = Vec::new();
    for entry in entries {
        let path = entry.into_diagnostic()?.path();
        if path.extension().is_some_and(|e| e == "toml") {
            paths.push(path);
        }
    }
    paths.sort();
    Ok(paths)
}

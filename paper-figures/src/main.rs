//! Makes the runs of Figs. 5 to 9 and writes the figures with REPRODUCTION.md into `out/paper`.

use miette::{IntoDiagnostic, Result, WrapErr};
use minijinja::context;
use paper_figures::ensembles::EnsembleRecord;
use paper_figures::figures::FigureRecord;
use paper_figures::{environment, figures, reproduction};
use records::{Journal, Record, root};
use std::fs;
use std::path::Path;

/// The template that the tracked page has, too.
const TEMPLATE: &str = include_str!("../../evidence/templates/reproduction.md");

fn main() -> Result<()> {
    let root = root();
    // before the runs, so that a missing record is reported at once
    let ensembles: Record<EnsembleRecord> =
        Record::read(&root.join("evidence/data/ensembles.json"))
            .wrap_err("the verdicts on the chaotic cases rest on this record")?;
    let journal = Journal::unkept();
    let results = serde_json::from_value(figures::measure(&journal)?).into_diagnostic()?;
    let seconds = journal.seconds().round();
    let mut origin = ensembles.origin.clone();
    origin.commit = "these runs".into();
    let figures: Record<FigureRecord> = Record { origin, results };
    let page = context! {
        stamp => format!("The runs of the figures were made with the present sources in {seconds} s."),
        pictures => ".",
        ..reproduction::values(&figures, &ensembles)?
    };
    let page = environment().render_str(TEMPLATE, page).into_diagnostic()?;
    let folder = root.join("out/paper");
    for (name, figure) in &figures.results.pictures {
        write(&folder.join(format!("{name}.svg")), &plot::svg(figure))?;
    }
    write(&folder.join("REPRODUCTION.md"), &page)?;
    println!("{}", folder.join("REPRODUCTION.md").display());
    Ok(())
}

fn write(path: &Path, text: &str) -> Result<()> {
    let folder = path.parent().map_or(Ok(()), fs::create_dir_all);
    let written = folder.and_then(|()| fs::write(path, text));
    written
        .into_diagnostic()
        .wrap_err_with(|| format!("cannot write {}", path.display()))
}

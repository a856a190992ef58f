//! Makes the runs of Figs. 5 to 9 and writes the figures with REPRODUCTION.md into `out/paper`.

use miette::{IntoDiagnostic, Result, WrapErr};
use minijinja::context;
use paper_figures::ensembles::EnsembleRecord;
use paper_figures::figures::{self, FigureRecord};
use paper_figures::{environment, statement};
use records::{Journal, Record, root};
use std::fs;

/// The template that the tracked page has, too.
const TEMPLATE: &str = include_str!("../../evidence/templates/reproduction.md");

fn main() -> Result<()> {
    let root = root();
    // before the runs, so that a missing record is reported at once
    let ensembles: Record<EnsembleRecord> =
        Record::read(&root.join("evidence/data/ensembles.json"))
            .wrap_err("the verdicts on the chaotic cases rest on this record")?;
    let journal = Journal::unkept();
    let figures = figures::measure(&journal)?;
    let figures: FigureRecord = serde_json::from_value(figures).into_diagnostic()?;
    let seconds = journal.seconds().round();
    let page = page(&figures, &ensembles, seconds)?;
    let folder = root.join("out/paper");
    fs::create_dir_all(&folder).into_diagnostic()?;
    let pictures = figures.pictures.iter();
    let pictures = pictures.map(|(name, figure)| (format!("{name}.svg"), plot::svg(figure)));
    for (name, text) in pictures.chain([("REPRODUCTION.md".to_owned(), page)]) {
        let written = fs::write(folder.join(&name), text).into_diagnostic();
        written.wrap_err_with(|| format!("cannot write {name}"))?;
    }
    println!("{}", folder.join("REPRODUCTION.md").display());
    Ok(())
}

/// REPRODUCTION.md of runs that took so many seconds.
fn page(
    figures: &FigureRecord,
    ensembles: &Record<EnsembleRecord>,
    seconds: f64,
) -> Result<String> {
    let commit = &ensembles.origin.commit;
    let page = context! {
        stamp => format!("The runs of the figures were made with the present sources in {seconds} s."),
        stamp_ensembles => format!("The ensembles were made at commit {commit}."),
        commit => "the present sources", commit_ensembles => commit, pictures => ".",
        ..statement::values(figures, &ensembles.results)?
    };
    environment().render_str(TEMPLATE, page).into_diagnostic()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_page_of_new_runs_has_the_statements_and_the_commit_of_the_ensembles() {
        let data = root().join("evidence/data");
        let figures: Record<FigureRecord> = Record::read(&data.join("figures.json")).unwrap();
        let ensembles = Record::read(&data.join("ensembles.json")).unwrap();
        let page = page(&figures.results, &ensembles, 60.0).unwrap();
        assert!(page.contains("| 54 | Sect. 7 |"), "{page}");
        assert!(page.contains(&format!("(ensembles of {})", ensembles.origin.commit)));
    }
}

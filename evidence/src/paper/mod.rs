//! The paper: its figures and statements, the scans of its parameters, the ensembles of its chaotic cases.

use crate::campaign::{Campaign, Renderer};
use crate::output::{Data, Output, stamp};
use miette::Result;
use minijinja::context;
use paper_figures::ensembles::{self, EnsembleRecord};
use paper_figures::figures::{self, FigureRecord};
use paper_figures::scans::{self, Scan};
use paper_figures::{ensembles_page, statement};

/// The campaigns.
pub const CAMPAIGNS: [Campaign; 3] = [
    Campaign {
        name: "figures",
        minutes: 5,
        seeds: "none",
        measure: figures::measure,
    },
    Campaign {
        name: "scans",
        minutes: 10,
        seeds: "none",
        measure: scans::measure,
    },
    Campaign {
        name: "ensembles",
        minutes: 40,
        seeds: "none; the directions of the starts are equally spaced",
        measure: ensembles::measure,
    },
];

/// The pages and their pictures.
pub const RENDERER: Renderer = Renderer {
    records: &["figures", "scans", "ensembles"],
    render,
};

/// paper-figures/REPRODUCTION.md, its pictures, and the pages of the statements, scans and ensembles.
///
/// # Errors
/// A record that is missing.
fn render(data: &Data, out: &mut Output) -> Result<()> {
    let figures = data.read::<FigureRecord>("figures")?;
    let ensembles = data.read::<EnsembleRecord>("ensembles")?;
    let scans = data.read::<Vec<Scan>>("scans")?;
    for (name, figure) in &figures.results.pictures {
        out.picture(&format!("paper/{name}"), figure)?;
    }
    let stamp_ensembles = format!("Ensembles: {}", stamp(&ensembles.origin));
    let values = statement::values(&figures.results, &ensembles.results)?;
    let page = context! {
        commit => figures.origin.commit, commit_ensembles => ensembles.origin.commit,
        stamp => stamp(&figures.origin), stamp_ensembles, pictures => "../evidence/pictures/paper", ..values
    };
    out.page("paper-figures/REPRODUCTION.md", "reproduction.md", &page)?;
    out.site_page("reproduction.md", "site/reproduction.md", &page)?;
    let values = ensembles_page::values(&ensembles.results);
    let page = context! { stamp => stamp(&ensembles.origin), ..values };
    out.site_page("ensembles.md", "site/ensembles.md", &page)?;
    let values = scans::values(&scans.results, &ensembles.results);
    let page = context! { stamp => stamp(&scans.origin), stamp_ensembles, ..values };
    out.site_page("scans.md", "site/scans.md", &page)
}

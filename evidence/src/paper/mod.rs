//! The paper: its figures and statements, the scans of its parameters, the ensembles of its chaotic cases.

use crate::campaign::{Campaign, Renderer};
use crate::output::{Data, Output, stamp};
use miette::Result;
use minijinja::{Value, context};
use paper_figures::ensembles::{self, EnsembleRecord};
use paper_figures::figures::{self, FigureRecord};
use paper_figures::scans::{self, Scan};
use paper_figures::{ensembles_page, reproduction, scans_page};

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
        minutes: 15,
        seeds: "none",
        measure: scans::measure,
    },
    Campaign {
        name: "ensembles",
        minutes: 50,
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
    let methods = ensembles_page::figure(&ensembles.results);
    out.picture("paper/methods", &methods)?;
    for scan in &scans.results {
        out.picture(
            &format!("paper/scans-{}", scan.slug),
            &scans_page::figure(scan),
        )?;
    }
    let stamp_ensembles = format!("Ensembles: {}", stamp(&ensembles.origin));
    let values = reproduction::values(&figures, &ensembles)?;
    let page = context! {
        stamp => stamp(&figures.origin), stamp_ensembles, pictures => "../evidence/pictures/paper", ..values
    };
    out.page("paper-figures/REPRODUCTION.md", "reproduction.md", &page)?;
    out.site_page("reproduction.md", "site/reproduction.md", &page)?;
    // as the other pages of the site, from the root of the workspace
    let pictures = "evidence/pictures/paper";
    let values = ensembles_page::values(&ensembles.results);
    let page = context! { stamp => stamp(&ensembles.origin), pictures, ..values };
    out.site_page("ensembles.md", "site/ensembles.md", &page)?;
    let values = scans_page::values(&scans.results, &ensembles.results);
    let page = context! { stamp => stamp(&scans.origin), stamp_ensembles, pictures, ..values };
    out.site_page("scans.md", "site/scans.md", &page)
}

/// What README.md says of the energy that Bathe's method gains: for every case and step size the mean, least and largest part of the
/// contact dissipation, in the whole run and in cycles 2 and 3 alone.
///
/// # Errors
/// A record that is missing.
pub fn energy(data: &Data) -> Result<Vec<Value>> {
    let ensembles = data.read::<EnsembleRecord>("ensembles")?;
    Ok(ensembles_page::energy(&ensembles.results))
}

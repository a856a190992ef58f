//! Looselink against the second implementation: every row of `verify`, its pictures, and the seeded faults.

use crate::campaign::{Campaign, Renderer, results};
use crate::output::{Data, Output, stamp};
use crate::verification::faults::FaultOutcome;
use looselink::scene::Analysis;
use miette::Result;
use minijinja::{Value, context};
use numbers::number;
use plot::Figure;
use records::{Journal, threads};
use serde::{Deserialize, Serialize};
use verify::check::{Agreement, Standing};
use verify::compare::statistics::ChaoticRun;
use verify::compare::{equations, flexible, impacts, machines, rigid, scenes, statistics};
use verify::figures::{self, overlay};
use verify::reference;
use verify::trajectory::ComparisonPlan;

/// The campaign.
pub const CAMPAIGN: Campaign = Campaign {
    name: "comparison",
    minutes: 30,
    seeds: "those of verify/src/compare",
    measure,
};

/// The page and its pictures.
pub const RENDERER: Renderer = Renderer {
    records: &["comparison", "faults"],
    render,
};

/// What both programs found.
#[derive(Serialize, Deserialize)]
struct Comparison {
    /// Versions of the libraries of the reference.
    versions: String,
    sections: Vec<Section>,
    pictures: Vec<(String, Figure)>,
}

/// Rows of one kind.
#[derive(Serialize, Deserialize)]
struct Section {
    title: String,
    rows: Vec<Agreement>,
}

const HORIZON: &str = "The difference starts at rounding level, grows with every impact and reaches the size of the motion; a \
    smaller step delays this.";
const SMOOTH: &str = "Without impacts the difference grows with time only.";
/// The overlays of cases 2, 3 and 4: duration, interval, steps \[s\], what to look at.
const OVERLAYS: [(&str, f64, f64, [f64; 2], &str); 3] = [
    ("case2", 0.1, 1e-4, [1e-6, 2.5e-7], SMOOTH),
    ("case3", 0.05, 2e-5, [1e-6, 1e-7], HORIZON),
    ("case4", 0.03, 2e-5, [1e-6, 1e-7], HORIZON),
];

type Rows = Result<Vec<Agreement>>;

fn starts() -> Rows {
    all(scenes::all()?, scenes::start)
}

fn terms() -> Rows {
    all(equations::plans()?, equations::agreements)
}

fn ideal() -> Rows {
    let mut rows = rigid::agreements()?;
    for run in convergence()? {
        rows.extend(run.agreements());
    }
    Ok(rows)
}

fn first_impacts() -> Rows {
    all(impacts::all(), impacts::ImpactSeries::agreements)
}

fn others() -> Rows {
    let mut rows = machines::smooth()?;
    rows.extend(all(scenes::of(Analysis::Static)?, scenes::equilibrium)?);
    rows.extend(all(machines::plans()?, machines::first_rows)?);
    rows.extend(all(machines::fine_meshes(), machines::first_rows)?);
    Ok(rows)
}

/// Title of a section, and its rows.
type Part = (&'static str, fn() -> Rows);

const SECTIONS: [Part; 5] = [
    ("Every scene: its start", starts),
    ("Equations", terms),
    ("Cases 1 and 2: ideal joints", ideal),
    ("The first impacts", first_impacts),
    ("Other mechanisms", others),
];

/// Case 2 with one and with four elements a link.
fn convergence() -> Result<Vec<flexible::Convergence>> {
    [1, 4].into_iter().map(flexible::convergence).collect()
}

/// The rows of all things to compare.
fn all<T>(things: Vec<T>, rows: impl Fn(&T) -> Rows) -> Rows {
    let each = things.iter().map(rows).collect::<Result<Vec<_>>>()?;
    Ok(each.concat())
}

fn measure(journal: &Journal) -> Result<serde_json::Value> {
    let section = |(title, rows): Part| {
        let rows = journal.item(title, rows)?;
        let title = title.to_owned();
        Ok(Section { title, rows })
    };
    let picture = |name: &str, figure: &dyn Fn() -> Result<Figure>| {
        let figure = journal.item(&format!("picture {name}"), || Ok(figure()?.thinned()))?;
        Ok::<_, miette::Report>((name.to_owned(), figure))
    };
    let mut pictures = vec![picture("convergence", &|| {
        Ok(figures::convergence(&convergence()?))
    })?];
    for (name, duration, interval, steps, remark) in OVERLAYS {
        pictures.push(picture(name, &|| {
            let plan = ComparisonPlan::new(format!("3rrr/{name}"), duration, interval);
            Ok(overlay(plan, steps, 1e-12)?.figure(remark))
        })?);
    }
    let mut sections = SECTIONS
        .into_iter()
        .map(section)
        .collect::<Result<Vec<_>>>()?;
    let runs = statistics::runs();
    let measured = journal.items(&runs, threads(), ChaoticRun::name, ChaoticRun::measure)?;
    sections.push(Section {
        title: "Cases 3 and 4: means of many runs".into(),
        rows: statistics::agreements(&runs, &measured),
    });
    results(Comparison {
        versions: reference::versions(),
        sections,
        pictures,
    })
}

/// verify/REPORT.md, its pictures, and the tables of all rows.
///
/// # Errors
/// A record that is missing.
fn render(data: &Data, out: &mut Output) -> Result<()> {
    let record = data.read::<Comparison>("comparison")?;
    let faults = data.read::<Vec<FaultOutcome>>("faults")?;
    let found = &record.results;
    for (name, figure) in &found.pictures {
        out.picture(&format!("comparison/{name}"), figure)?;
    }
    let rows = || found.sections.iter().flat_map(|section| &section.rows);
    let counted = || rows().filter(|row| row.counts());
    let of = |standing| rows().filter(move |row| row.standing == standing);
    let (variants, mistakes): (Vec<_>, Vec<_>) =
        faults.results.iter().partition(|f| f.fault.is_variant());
    let page = context! {
        stamp => stamp(&record.origin),
        versions => found.versions,
        count => counted().count(),
        held => counted().filter(|row| row.holds()).count(),
        apart => of(Standing::Apart).map(row).collect::<Vec<_>>(),
        zeros => of(Standing::Zero).count(),
        sections => found.sections.iter().map(section).collect::<Vec<_>>(),
        faults => context! { stamp => stamp(&faults.origin), mistakes, variants },
    };
    out.page("verify/REPORT.md", "comparison.md", &page)?;
    out.site_page("comparison.md", "site/comparison.md", &page)
}

/// A row as it is printed, with enough digits to see the agreement.
fn row(row: &Agreement) -> Value {
    let [rust, cpp] = [row.rust, row.cpp].map(|x| number(x, 10));
    context! {
        holds => row.holds(), quantity => row.quantity, scene => row.scene, rust, cpp, reason => row.reason,
        difference => number(row.difference, 2), tolerance => number(row.tolerance, 1),
    }
}

/// A section with the rows that count and the row that comes nearest to its tolerance.
fn section(section: &Section) -> Value {
    let counted = || section.rows.iter().filter(|row| row.counts());
    let used = |row: &&Agreement| row.difference / row.tolerance;
    // rows that agree to the last bit use nothing of their tolerance
    let differing = counted().filter(|row| row.difference > 0.0);
    let nearest = differing.max_by(|a, b| used(a).total_cmp(&used(b)));
    context! {
        title => section.title,
        held => counted().filter(|row| row.holds()).count(),
        nearest => nearest.map(row),
        rows => counted().map(row).collect::<Vec<_>>(),
    }
}

//! Looselink against the second implementation: every row of `verify`, its pictures, and the seeded faults.

use crate::campaign::{Campaign, Renderer, results};
use crate::output::{Data, Output, stamp};
use crate::verification::faults::FaultOutcome;
use looselink::scene::Analysis;
use miette::Result;
use minijinja::{Value, context};
use plot::Figure;
use records::{Journal, threads};
use serde::{Deserialize, Serialize};
use verify::check::{Agreement, Standing};
use verify::compare::flexible::{self, Convergence, ConvergencePlan};
use verify::compare::impacts::{self, ImpactSeries};
use verify::compare::statistics::{self, ChaoticRun};
use verify::compare::{equations, machines, rigid, scenes};
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
    /// Comparisons of nothing but zeros, which have no row.
    zeros: usize,
}

impl Section {
    fn new(title: &str, rows: Vec<Agreement>) -> Section {
        let (zeros, rows): (Vec<_>, Vec<_>) = rows
            .into_iter()
            .partition(|row| row.standing == Standing::Zero);
        Section {
            title: title.to_owned(),
            rows,
            zeros: zeros.len(),
        }
    }
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
/// Its title, and what compares.
type Compared = (&'static str, fn() -> Rows);

fn others() -> Rows {
    let static_scenes = scenes::of(Analysis::Static)?;
    let motions = [machines::others(), machines::smooth()?].concat();
    let rows = [
        all(static_scenes, scenes::equilibrium)?,
        all(motions, machines::motion)?,
    ];
    Ok(rows.concat())
}

/// Title of the section with the means of chaotic motions.
const MEANS: &str = "Cases 3 and 4: means of many runs";
/// Titles of the other sections but that of cases 1 and 2, and their rows.
const SECTIONS: [Compared; 4] = [
    ("Every scene: its start", || {
        all(scenes::all()?, scenes::start)
    }),
    ("Equations", || {
        all(equations::plans()?, equations::agreements)
    }),
    ("The first impacts", || {
        all(impacts::all(), ImpactSeries::agreements)
    }),
    ("Other mechanisms", others),
];

/// Case 1, case 2 with one and with four elements a link, and its picture.
fn ideal() -> Result<(Vec<Agreement>, Figure)> {
    let runs = flexible::all().into_iter().map(ConvergencePlan::run);
    let runs = runs.collect::<Result<Vec<_>>>()?;
    let flexible = runs.iter().flat_map(Convergence::agreements);
    let rows = rigid::agreements()?.into_iter().chain(flexible).collect();
    Ok((rows, figures::convergence(&runs).thinned()))
}

/// The rows of all things to compare.
fn all<T>(things: Vec<T>, rows: impl Fn(&T) -> Rows) -> Rows {
    let each = things.iter().map(rows).collect::<Result<Vec<_>>>()?;
    Ok(each.concat())
}

fn measure(journal: &Journal) -> Result<serde_json::Value> {
    let title = "Cases 1 and 2: ideal joints";
    let (rows, figure) = journal.item(title, ideal)?;
    let ideal = Section::new(title, rows);
    let mut pictures = vec![("convergence".to_owned(), figure)];
    for (name, duration, interval, steps, remark) in OVERLAYS {
        let plan = ComparisonPlan::new(format!("3rrr/{name}"), duration, interval);
        let figure = || Ok(overlay(&plan, steps, 1e-12, remark)?.thinned());
        let figure = journal.item(&format!("picture {name}"), figure)?;
        pictures.push((name.to_owned(), figure));
    }
    let mut sections = Vec::new();
    for (title, rows) in SECTIONS {
        sections.push(Section::new(title, journal.item(title, rows)?));
    }
    // after the equations
    sections.insert(2, ideal);
    let runs = statistics::runs();
    let measured = journal.items(&runs, threads(), ChaoticRun::name, ChaoticRun::measure)?;
    let rows = statistics::agreements(&runs, &measured);
    sections.push(Section::new(MEANS, rows));
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
    // means that scatter agree more easily: they have a table of their own
    let (means, sections): (Vec<&Section>, Vec<_>) = found
        .sections
        .iter()
        .partition(|section| section.title == MEANS);
    let rows = || sections.iter().flat_map(|section| &section.rows);
    let (compared, told_apart): (Vec<_>, Vec<_>) = means
        .iter()
        .flat_map(|section| &section.rows)
        .partition(|row| row.standing == Standing::Apart);
    let counted = || rows().filter(|row| row.counts());
    let (variants, mistakes): (Vec<_>, Vec<_>) =
        faults.results.iter().partition(|f| f.fault.is_variant());
    let page = context! {
        stamp => stamp(&record.origin),
        versions => found.versions,
        count => counted().count(),
        held => counted().filter(|row| row.holds()).count(),
        apart => rows().filter(|row| !row.counts()).collect::<Vec<_>>(),
        differing => compared.iter().filter(|row| !row.holds()).count(),
        means => compared, told_apart,
        zeros => sections.iter().map(|one| one.zeros).sum::<usize>(),
        sections => sections.iter().map(|one| section(one)).collect::<Vec<_>>(),
        faults => context! { stamp => stamp(&faults.origin), mistakes, variants },
    };
    out.page("verify/REPORT.md", "comparison.md", &page)?;
    out.site_page("comparison.md", "site/comparison.md", &page)
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
        nearest,
        rows => counted().collect::<Vec<_>>(),
    }
}

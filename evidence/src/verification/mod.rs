//! What the tests ask, which changes of the code they notice, and the page about both.

mod answers;
pub mod faults;
mod figures;
mod mutation;

use crate::campaign::{Campaign, Renderer};
use crate::output::{Data, Output, stamp};
use ladder::answer::short;
use ladder::{Answer, Rung};
use miette::{IntoDiagnostic, Result, miette};
use minijinja::{Value, context};
use mutation::{KERNELS, MutantCounts, Mutants, SOLVER, Scope};
use serde::Deserialize;
use serde::de::DeserializeOwned;
use std::collections::BTreeMap;

/// The campaigns.
pub const CAMPAIGNS: [Campaign; 4] = [
    Campaign {
        name: "tests",
        minutes: 15,
        seeds: "those of the tests",
        measure: answers::measure,
    },
    Campaign {
        name: "faults",
        minutes: 60,
        seeds: "none",
        measure: faults::measure,
    },
    Campaign {
        name: KERNELS.name,
        minutes: 20,
        seeds: "4",
        measure: |journal| mutation::measure(&KERNELS, journal),
    },
    Campaign {
        name: SOLVER.name,
        minutes: 20,
        seeds: "4",
        measure: |journal| mutation::measure(&SOLVER, journal),
    },
];

/// The page and its pictures.
pub const RENDERER: Renderer = Renderer {
    records: &["tests", KERNELS.name, SOLVER.name],
    render,
};

/// The words of a rung, in `evidence/rungs.toml`.
#[derive(Deserialize)]
struct RungWords {
    title: String,
    asks: String,
}

/// VERIFICATION.md, its picture, and the tables of all questions and survivors.
///
/// # Errors
/// A record that is missing, a surviving mutant without a reason.
fn render(data: &Data, out: &mut Output) -> Result<()> {
    let answers = data.read::<Vec<Answer>>("tests")?;
    let rungs: BTreeMap<Rung, RungWords> = table(data, "rungs")?;
    let ordered = [Rung::OrderInTime, Rung::OrderInElements].map(|rung| {
        let of_rung = answers.results.iter().filter(|a| a.rung == rung);
        (rungs[&rung].title.as_str(), of_rung.collect())
    });
    out.picture("verification/orders", &figures::orders(ordered.into_iter()))?;
    let rung = |(rung, words): (&Rung, &RungWords)| {
        let of_rung = || answers.results.iter().filter(|a| a.rung == *rung);
        let nearest = of_rung().max_by(|a, b| a.used().total_cmp(&b.used()));
        context! {
            rung, title => words.title, asks => words.asks, nearest => nearest.map(row),
            held => of_rung().filter(|a| a.holds()).count(),
            rows => of_rung().map(row).collect::<Vec<_>>(),
        }
    };
    let mutation = [&KERNELS, &SOLVER].map(|scope| mutants(scope, data));
    let page = context! {
        stamp => stamp(&answers.origin),
        count => answers.results.len(),
        held => answers.results.iter().filter(|a| a.holds()).count(),
        rungs => rungs.iter().map(rung).collect::<Vec<_>>(),
        mutation => mutation.into_iter().collect::<Result<Vec<Value>>>()?,
    };
    out.page("VERIFICATION.md", "verification.md", &page)?;
    out.site_page("questions.md", "site/questions.md", &page)
}

/// An answer as the tables have it.
fn row(answer: &Answer) -> Value {
    context! {
        holds => answer.holds(), question => answer.question, number => short(answer.number),
        allowed => answer.allowed.to_string(), reason => answer.reason, source => answer.source, path => answer.file, curve => answer.curve,
    }
}

/// The file `evidence/<name>.toml`.
fn table<T: DeserializeOwned>(data: &Data, name: &str) -> Result<T> {
    let path = data.root().join(format!("evidence/{name}.toml"));
    let text = std::fs::read_to_string(path).into_diagnostic()?;
    toml::from_str(&text).into_diagnostic()
}

fn mutants(scope: &Scope, data: &Data) -> Result<Value> {
    let record = data.read::<Mutants>(scope.name)?;
    let found = &record.results;
    // why no test detects each survivor, by its name
    let reasons: BTreeMap<String, String> = table(data, "survivors")?;
    let survivors = found.survivors.iter().map(|name| match reasons.get(name) {
        Some(reason) => Ok(context! { name, reason }),
        None => Err(miette!("evidence/survivors.toml has no reason for {name}")),
    });
    let (mut folders, mut total) = (BTreeMap::new(), MutantCounts::default());
    for (file, counts) in &found.files {
        let folder: Vec<&str> = file.split('/').take(2).collect();
        *folders.entry(folder.join("/")).or_default() += *counts;
        total += *counts;
    }
    let counts = |name: &str, c: MutantCounts| {
        context! {
            name, drawn => c.viable() + c.unviable, unviable => c.unviable, caught => c.caught,
            timeout => c.timeout, survived => c.survived, viable => c.viable(),
            // never rounded up to all of them
            share => (1e3 * c.caught()).floor() / 1e3
        }
    };
    Ok(context! {
        name => scope.name,
        stamp => stamp(&record.origin),
        possible => found.possible,
        total => counts("all", total),
        folders => folders.iter().map(|(name, c)| counts(name, *c)).collect::<Vec<_>>(),
        survivors => survivors.collect::<Result<Vec<_>>>()?,
    })
}

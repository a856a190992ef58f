//! What the tests ask, which changes of the code they notice, and the page about both.

mod answers;
mod constants;
mod copy;
pub mod faults;
mod figures;
mod mutation;

use crate::campaign::{Campaign, Renderer};
use crate::output::{Data, Output, stamp};
use constants::Number;
use ladder::answer::short;
use ladder::{Answer, Rung};
use miette::{Result, miette};
use minijinja::{Value, context};
use mutation::{KERNELS, MutantCounts, Mutants, SOLVER, Scope};

/// The campaigns.
pub const CAMPAIGNS: [Campaign; 5] = [
    Campaign {
        name: "tests",
        minutes: 15,
        seeds: "those of the tests",
        measure: answers::measure,
    },
    Campaign {
        name: "faults",
        minutes: 30,
        seeds: "none",
        measure: faults::measure,
    },
    Campaign {
        name: "constants",
        minutes: 15,
        seeds: "none",
        measure: constants::measure,
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
    records: &["tests", "constants", KERNELS.name, SOLVER.name],
    render,
};

/// VERIFICATION.md, its pictures, and the tables of all questions and survivors.
///
/// # Errors
/// A record that is missing, a surviving mutant without a reason.
fn render(data: &Data, out: &mut Output) -> Result<()> {
    let answers = data.read::<Vec<Answer>>("tests")?;
    let constants = data.read::<Vec<Number>>("constants")?;
    for rung in [Rung::OrderInTime, Rung::OrderInElements] {
        if let Some(figure) = figures::convergence(rung, &answers.results) {
            out.picture(&format!("verification/{}", slug(rung)), &figure)?;
        }
    }
    let rungs: Vec<Value> = Rung::ALL
        .iter()
        .map(|rung| summary(*rung, &answers.results))
        .collect();
    let tables = constants.results.chunk_by(|a, b| a.table == b.table);
    let tables: Vec<Value> = tables
        .map(|table| {
            let caught = table.iter().filter(|n| !n.caught_by.is_empty()).count();
            context! { name => table[0].table, file => table[0].file, count => table.len(), caught }
        })
        .collect();
    let mutation = [&KERNELS, &SOLVER].map(|scope| mutants(scope, data));
    let mutation = mutation.into_iter().collect::<Result<Vec<Value>>>()?;
    let page = context! {
        stamp => stamp(&answers.origin),
        count => answers.results.len(),
        held => answers.results.iter().filter(|a| a.holds()).count(),
        rungs,
        change => constants::CHANGE,
        constants => context! { stamp => stamp(&constants.origin), tables },
        mutation,
    };
    out.page("VERIFICATION.md", "verification.md", &page)?;
    out.site_page("questions.md", "site/questions.md", &page)
}

/// File name of the picture of a rung.
fn slug(rung: Rung) -> String {
    rung.title().0.to_lowercase().replace(' ', "-")
}

/// A rung with its rows and the row that comes nearest to its bound.
fn summary(rung: Rung, answers: &[Answer]) -> Value {
    let row = |answer: &Answer| {
        let file = answer.file.rsplit('/').next().unwrap_or(&answer.file);
        context! {
            holds => answer.holds(), question => answer.question, number => short(answer.number),
            allowed => answer.allowed.to_string(), reason => answer.reason, path => answer.file, file
        }
    };
    let of_rung = || answers.iter().filter(|a| a.rung == rung);
    let nearest = of_rung().max_by(|a, b| a.used().total_cmp(&b.used()));
    let (title, asks) = rung.title();
    context! {
        title, asks, slug => slug(rung),
        held => of_rung().filter(|a| a.holds()).count(),
        nearest => nearest.map(row),
        rows => of_rung().map(row).collect::<Vec<_>>(),
    }
}

fn mutants(scope: &Scope, data: &Data) -> Result<Value> {
    let record = data.read::<Mutants>(scope.name)?;
    let (found, reasons) = (&record.results, mutation::reasons(data.root())?);
    let survivors = found.survivors.iter().map(|name| {
        let reason = reasons.get(name);
        let reason =
            reason.ok_or_else(|| miette!("evidence/survivors.toml has no reason for {name}"))?;
        Ok(context! { name, reason })
    });
    let counts = |name: &str, c: MutantCounts| {
        context! {
            name, drawn => c.viable() + c.unviable, unviable => c.unviable, caught => c.caught,
            timeout => c.timeout, survived => c.survived, viable => c.viable(),
            // never rounded up to all of them
            share => (1e3 * c.caught()).floor() / 1e3
        }
    };
    let folders = found.folders();
    Ok(context! {
        name => scope.name,
        stamp => stamp(&record.origin),
        tool => found.tool,
        possible => found.possible,
        total => counts("all", found.total()),
        folders => folders.iter().map(|(name, c)| counts(name, *c)).collect::<Vec<_>>(),
        survivors => survivors.collect::<Result<Vec<_>>>()?,
    })
}

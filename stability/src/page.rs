//! STABILITY.md.

use crate::cases::{CASES, Check};
use crate::map::Made;
use crate::outcome::Outcome;
use crate::records::Records;
use records::place;
use std::fmt::Write;

const WRITES: &str = "a string takes any text";

/// What the page says.
pub fn page(made: &[Made], checks: &[Vec<Check>], records: &Records, minutes: f64) -> String {
    let mut out = format!(
        "# Hard cases\n\n{}\n\
         Where methods come to their limits: what becomes of a run, and whether it says so. Written by `cargo run --release -p \
         stability` in {:.0} minutes. Every run ends in one of these ways:\n\n\
         | outcome | what it means |\n|---|---|\n\
         | accurate | every compared row is within the tolerance of the map |\n\
         | coarse | bounded and off by more; by more than a twentieth of what moves only with a warning in the report |\n\
         | damped | the same, with energy lost |\n\
         | refused | an error that names the joint or coordinate, the time and the cause, and exit code 2 or 3 |\n\
         | failed | the scheme has put energy into the motion; the report warns, or the run is stopped by that name |\n\
         | silent | a wrong answer without a word, or no end: **there must be none** |\n\n\
         A report warns of the energy that the integrator has lost or gained, of the error that its steps are estimated to \
         make, of accelerations that the steps do not resolve, of contacts that last a few steps only, of chatter, halved \
         steps, clamped forces and singular poses (`src/simulate/warnings.rs`).\n\n",
        place("maps"),
        minutes.ceil()
    );
    out += &in_short(made, checks, records);
    out += &cases(checks, records);
    out += &random(records);
    out += FAULTS;
    out += "## Maps\n\n";
    for one in made {
        out += &map(one);
    }
    out
}

fn line(out: &mut String, text: &str) {
    writeln!(out, "{text}").expect(WRITES);
}

/// Counts of outcomes of a method over all maps that have it.
fn counts(made: &[Made], method: &str) -> [usize; Outcome::ALL.len()] {
    Outcome::ALL.map(|outcome| {
        let per_map = made.iter().filter_map(|one| {
            let index = one.map.methods.iter().position(|m| m == method)?;
            Some(one.count(index, outcome))
        });
        per_map.sum()
    })
}

fn heads() -> String {
    let names = Outcome::ALL.map(Outcome::name);
    format!(
        "| method | {} |\n|---|{}",
        names.join(" | "),
        "--:|".repeat(names.len())
    )
}

fn row(name: &str, counts: [usize; Outcome::ALL.len()]) -> String {
    format!("| {name} | {} |", counts.map(|n| n.to_string()).join(" | "))
}

fn in_short(made: &[Made], checks: &[Vec<Check>], records: &Records) -> String {
    let runs: usize = made.iter().map(|one| one.cells.len()).sum();
    let mut out = format!("## In short\n\n{runs} runs in {} maps:\n\n", made.len());
    line(&mut out, &heads());
    let mut methods: Vec<&str> = Vec::new();
    for name in made.iter().flat_map(|one| &one.map.methods) {
        if !methods.contains(&name.as_str()) {
            methods.push(name);
        }
    }
    for method in &methods {
        line(&mut out, &row(method, counts(made, method)));
    }
    line(&mut out, "");
    let all = checks
        .iter()
        .flatten()
        .chain(records.long.iter().flat_map(|(_, c)| c));
    let (held, count) = all.fold((0, 0), |(held, count), check| {
        (held + usize::from(check.holds()), count + 1)
    });
    line(
        &mut out,
        &format!("* {held} of {count} criteria of the fifteen cases hold."),
    );
    line(&mut out, &rivalry(made));
    out + "\n"
}

/// Where Bathe's scheme and the trapezoidal rule differ, at equal steps.
fn rivalry(made: &[Made]) -> String {
    let (mut saved, mut lost) = (Vec::new(), Vec::new());
    for one in made {
        let index = |name: &str| one.map.methods.iter().position(|m| m == name);
        let (Some(bathe), Some(rival)) = (index("Bathe"), index("trapezoidal")) else {
            continue;
        };
        let of = |method: usize| one.cells.iter().filter(move |c| c.at[0] == method);
        let pairs: Vec<_> = of(bathe)
            .zip(of(rival))
            .map(|(b, t)| (b.outcome, t.outcome))
            .collect();
        let gone = |o: Outcome| matches!(o, Outcome::Failed | Outcome::Refused);
        let count = |accept: &dyn Fn(Outcome, Outcome) -> bool| {
            pairs.iter().filter(|(b, t)| accept(*b, *t)).count()
        };
        let saves = count(&|b, t| gone(t) && !gone(b));
        let loses = count(&|b, t| b != Outcome::Accurate && t == Outcome::Accurate);
        if saves > 0 {
            saved.push(format!("{saves} in {}", one.name));
        }
        if loses > 0 {
            lost.push(format!("{loses} in {}", one.name));
        }
    }
    let told = |list: Vec<String>| match list.is_empty() {
        true => "none".to_owned(),
        false => list.join(", "),
    };
    format!(
        "* Runs in which the trapezoidal rule fails or stops and Bathe's scheme with the same step does neither: {}.\n\
         * Runs in which the trapezoidal rule is accurate and Bathe's scheme with the same step is not: {}. At the same number \
         of stages it has twice its step, and four times its error where everything is resolved (case 1).",
        told(saved),
        told(lost)
    )
}

fn cases(checks: &[Vec<Check>], records: &Records) -> String {
    let mut out = format!(
        "## The fifteen cases\n\n{}\nEach criterion is a test (`cargo test --test tests stability::cases`) or, where it says so, a \
         long run (`cargo run --release -p stability -- long`).\n\n\
         | case | criterion | found | bound | verdict |\n|---|---|--:|--:|---|\n",
        place("long")
    );
    for (case, short) in CASES.iter().zip(checks) {
        let long = records
            .long
            .iter()
            .filter(|(number, _)| *number == case.number);
        let long = long
            .flat_map(|(_, checks)| checks)
            .map(|check| (check, " (long run)"));
        let mut head = format!("{}. {}", case.number, case.title);
        for (check, how) in short.iter().map(|check| (check, "")).chain(long) {
            let verdict = if check.holds() {
                "holds"
            } else {
                "**does not hold**"
            };
            line(
                &mut out,
                &format!(
                    "| {} | {}{how} | {} | {} | {verdict} |",
                    std::mem::take(&mut head),
                    check.criterion,
                    check.number(),
                    check.bound()
                ),
            );
        }
    }
    out + "\n"
}

/// Process faults are tests; the page says which.
const FAULTS: &str = "## Process faults\n\n`tests/stability/process/` kills runs with SIGKILL at 200 random instants, 200 more while they replace an earlier \
    result and 40 while one stands in their way, `precision` and `ablate` 32 times; limits the size of files; fills the disk behind \
    single files; and tries folders where nobody can write, files, links and the result of another scene. What is on disk is \
    readable up to its last row, equal to the rows of the uninterrupted run byte for byte, and marked `incomplete`; an earlier \
    result is whole, in its place or in `previous-result`.\n\n";

fn random(records: &Records) -> String {
    let soak = &records.soak;
    let mut out = format!(
        "## Random mechanisms\n\n{}\n\
         Chains, loops and parallel mechanisms that nobody drew, with play, friction, flexible links, springs, loads and drives, \
         masses over six decades and steps over five, every method. Of every run it is asked that it ends in one of the ways \
         above, that its rows are finite, that constraints are kept, that forces are mass times acceleration, that momentum \
         changes by forces only, that the ledger closes, that work has a reason, and that a second run gives the same bytes \
         (`stability/src/random`). Runs that take thirty times the steps asked for are cut short. Some hundred are among the tests; `cargo run --release -p stability -- soak` has run {} with \
         seed {}:\n\n| outcome | scenes |\n|---|--:|\n",
        place("soak"),
        soak.scenes,
        soak.seed
    );
    for (outcome, count) in &soak.outcomes {
        line(&mut out, &format!("| {outcome} | {count} |"));
    }
    line(&mut out, "");
    for failure in &soak.failures {
        line(
            &mut out,
            &format!(
                "* Open: scene {}, {}: {}.",
                failure.scene, failure.property, failure.detail
            ),
        );
    }
    let fuzz = &records.fuzz;
    out += &format!(
        "\nWhat every soak and test has found is a named scene or test: `tests/stability/regressions.rs`, `scenes/hard`.\n\n\
         ## Random input\n\n{}\n{}, {}: `{}`.\n\n\
         | target | inputs | seconds | edges covered | open failures |\n|---|--:|--:|--:|--:|\n",
        place("fuzz"),
        fuzz.engine,
        fuzz.limits,
        fuzz.command
    );
    for one in &fuzz.targets {
        line(
            &mut out,
            &format!(
                "| {} | {} | {} | {} | {} |",
                one.target, one.inputs, one.seconds, one.edges_covered, one.open_failures
            ),
        );
    }
    line(&mut out, "\nFound and fixed on the way:\n");
    for found in &fuzz.found_and_fixed {
        line(&mut out, &format!("* {found}."));
    }
    out + "\n"
}

fn map(one: &Made) -> String {
    let mut out = format!(
        "### {}\n\n![{}](stability/figures/{}.png)\n\n{}\n",
        one.map.title,
        one.map.title,
        one.name,
        heads()
    );
    for (index, method) in one.map.methods.iter().enumerate() {
        line(
            &mut out,
            &row(method, Outcome::ALL.map(|o| one.count(index, o))),
        );
    }
    out + "\n"
}

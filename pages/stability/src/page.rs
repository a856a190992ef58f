//! STABILITY.md.

use crate::cases::{CASES, Check};
use crate::map::MadeMap;
use crate::outcome::OutcomeClass;
use crate::records::Records;
use records::place;
use std::fmt::Write;

const WRITES: &str = "a string takes any text";

/// What the page says.
pub fn page(made: &[MadeMap], checks: &[Vec<Check>], records: &Records, minutes: f64) -> String {
    let mut out = format!(
        "# Hard cases\n\n{}\n\
         This page takes each method to its limits and classifies every run. `cargo run --release -p stability` writes it in \
         {:.0} min. A run ends in one of these ways:\n\n\
         | outcome | meaning |\n|---|---|\n\
         | accurate | the error is within the tolerance of the map in every compared row |\n\
         | coarse | the error is larger but bounded; if it is large (see below), the report warns |\n\
         | damped | as coarse, and the integrator has lost more than 1 % of the energy of the motion |\n\
         | refused | the scene was rejected or the run was stopped with an error message |\n\
         | failed | the integrator has added more than half of the energy of the motion; the report warns, or the run was \
         stopped |\n\
         | silent | a large error without a warning, or a run that does not end: **this must not happen** |\n\n\
         An error is large above 5 % of the range of the compared channel (20 % in map 02, whose channel is an acceleration; \
         10 % in maps 05a and 05b, where every impact amplifies the error). The report warns of energy that the integrator has \
         lost or gained, of a large estimated error, of accelerations that the steps do not resolve, of contacts shorter than \
         four steps, of chatter, halved steps, clamped forces and singular poses (`src/simulate/warnings.rs`).\n\n",
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
fn counts(made: &[MadeMap], method: &str) -> [usize; OutcomeClass::ALL.len()] {
    OutcomeClass::ALL.map(|outcome| {
        let per_map = made.iter().filter_map(|one| {
            let index = one.map.methods.iter().position(|m| m == method)?;
            Some(one.count(index, outcome))
        });
        per_map.sum()
    })
}

fn heads() -> String {
    let names = OutcomeClass::ALL.map(OutcomeClass::name);
    format!(
        "| method | {} |\n|---|{}",
        names.join(" | "),
        "--:|".repeat(names.len())
    )
}

fn row(name: &str, counts: [usize; OutcomeClass::ALL.len()]) -> String {
    format!("| {name} | {} |", counts.map(|n| n.to_string()).join(" | "))
}

fn in_short(made: &[MadeMap], checks: &[Vec<Check>], records: &Records) -> String {
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
fn rivalry(made: &[MadeMap]) -> String {
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
        let gone = |o: OutcomeClass| matches!(o, OutcomeClass::Failed | OutcomeClass::Refused);
        let count = |accept: &dyn Fn(OutcomeClass, OutcomeClass) -> bool| {
            pairs.iter().filter(|(b, t)| accept(*b, *t)).count()
        };
        let saves = count(&|b, t| gone(t) && !gone(b));
        let loses = count(&|b, t| b != OutcomeClass::Accurate && t == OutcomeClass::Accurate);
        if saves > 0 {
            saved.push(format!("{saves} in {}", one.name));
        }
        if loses > 0 {
            lost.push(format!("{loses} in {}", one.name));
        }
    }
    let reported = |list: Vec<String>| match list.is_empty() {
        true => "none".to_owned(),
        false => list.join(", "),
    };
    format!(
        "* Runs in which the trapezoidal rule fails or is refused and Bathe's scheme with the same step does neither: {}.\n\
         * Runs in which the trapezoidal rule is accurate and Bathe's scheme with the same step is not: {}. For the same \
         number of stages its step is twice as long; case 1 has the ratio of the errors where the steps resolve the motion.",
        reported(saved),
        reported(lost)
    )
}

fn cases(checks: &[Vec<Check>], records: &Records) -> String {
    let mut out = format!(
        "## The fifteen cases\n\n{}\nEach criterion is a test (`cargo test -p stability cases`) or, where marked, part \
         of a long run (`cargo run --release -p stability -- long`).\n\n\
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
const FAULTS: &str = "## Process faults\n\nThe tests in `crates/cli/tests/process/` kill runs with SIGKILL: at 200 random instants, at 200 more while an earlier result \
    is being replaced, at 40 while an earlier result blocks the folder, and 32 times in `precision` and `ablate`. They also limit the \
    size of files, fill the disk for single files, and write to read-only folders, to files, to links and to the result of another \
    scene. What is then on disk can be read up to its last row, equals the rows of the uninterrupted run byte for byte, and is marked \
    `incomplete`. An earlier result is complete, in its place or in `previous-result`.\n\n";

fn random(records: &Records) -> String {
    let soak = &records.soak;
    let mut out = format!(
        "## Random mechanisms\n\n{}\n\
         The generator draws chains, loops and parallel mechanisms with clearance, friction, flexible links, springs, loads and \
         drives, for every method, with masses over six decades and steps over five. Every run is checked (`pages/stability/src/random`): \
         it finishes, is refused or stops with an error that names a part of the scene; its rows are finite; constraints hold; \
         forces equal mass times acceleration; momentum changes only through forces; the energy ledger closes; the numbers of steps \
         and stages are accounted for; and a second run gives the same bytes. A run that needs thirty times its nominal number of \
         steps is cut short. Some hundred mechanisms are among the tests; `cargo run --release -p stability -- soak` has run {} with \
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
        "\nEvery fault found in this way is kept as a regression test (`tests/stability/regressions.rs`) or as a scene (`scenes/hard`).\n\n\
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
    line(&mut out, "\nFaults found and fixed:\n");
    for found in &fuzz.found_and_fixed {
        line(&mut out, &format!("* {found}."));
    }
    out + "\n"
}

fn map(one: &MadeMap) -> String {
    let mut out = format!(
        "### {}\n\n![{}](pages/stability/figures/{}.png)\n\n{}\n",
        one.map.title,
        one.map.title,
        one.name,
        heads()
    );
    for (index, method) in one.map.methods.iter().enumerate() {
        line(
            &mut out,
            &row(method, OutcomeClass::ALL.map(|o| one.count(index, o))),
        );
    }
    out + "\n"
}

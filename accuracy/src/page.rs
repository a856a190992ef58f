//! The page.

use crate::{Made, effects};
use looselink::ablation::Ablation;
use looselink::machine::Machine;
use looselink::precision::{Outcome, Pace};
use std::fmt::Write;

/// Errors of position at which curves are compared \[m\].
const LEVELS: [f64; 5] = [1e-6, 1e-7, 1e-8, 1e-9, 1e-10];

/// What ACCURACY.md says.
pub fn page(made: &[Made], ablation: &Ablation, machine: &Machine, seconds: f64) -> String {
    let mut out = format!(
        "# What accuracy costs\n\n\
         Every method on every study of [studies](studies), error against processor time. Written by `cargo run --release -p \
         accuracy` in {:.0} minutes; one study alone: `cargo run --release -- precision studies/case3.toml --out out/case3` \
         ([docs/study.md](docs/study.md)). Times: median of five runs after one that is not timed, one core, {machine}.\n\n",
        (seconds / 60.0).ceil()
    );
    out += &asked(made);
    out += &fastest(made);
    for one in made {
        out += &format!(
            "## {}\n\n![{}](accuracy/figures/{}.png)\n\n{}\n",
            one.study.title,
            one.study.title,
            one.name,
            looselink::precision::table(&one.outcome)
        );
    }
    out += &effects::section(ablation);
    out += &omissions(made);
    out
}

fn line(out: &mut String, text: &str) {
    writeln!(out, "{text}").expect("a string takes any text");
}

/// Error achieved over error asked for, over all studies.
fn asked(made: &[Made]) -> String {
    let mut rows: Vec<(f64, f64, String)> = Vec::new();
    for one in made {
        for run in &one.outcome.runs {
            if let (Pace::Accuracy { position, .. }, Ok(measured)) = (run.pace, &run.result)
                && measured.errors.position > 2.0 * one.outcome.floor.position
            {
                let name = format!("{}, {}", one.name, run.curve);
                rows.push((position, measured.errors.position / position, name));
            }
        }
    }
    let within = |bound: f64| rows.iter().filter(|(_, ratio, _)| *ratio <= bound).count();
    let worst = rows.iter().max_by(|a, b| a.1.total_cmp(&b.1));
    let mut out = String::from("## Is what was asked for achieved?\n\n");
    if let Some((position, ratio, name)) = worst {
        line(
            &mut out,
            &format!(
                "Of {} runs with an accuracy {} achieve it, {} within ten times of it, {} within a hundred. The largest ratio of \
                 error achieved to error asked for is {} ({name}, {}). The table shows the ratio; below one, accuracy was given \
                 away. Errors below twice the floor of a reference are not counted.\n",
                rows.len(),
                within(1.0),
                within(10.0),
                within(100.0),
                plot::digits(*ratio),
                plot::si(*position, "m")
            ),
        );
    }
    let mut asked: Vec<f64> = rows.iter().map(|r| r.0).collect();
    asked.sort_by(|a, b| b.total_cmp(a));
    asked.dedup();
    let mut names: Vec<&str> = Vec::new();
    for (_, _, name) in &rows {
        if !names.contains(&name.as_str()) {
            names.push(name);
        }
    }
    let heads: Vec<String> = asked.iter().map(|p| plot::si(*p, "m")).collect();
    line(
        &mut out,
        &format!("| study, method | {} |", heads.join(" | ")),
    );
    line(&mut out, &format!("|---|{}", "---|".repeat(asked.len())));
    for name in names {
        let cells = asked.iter().map(|p| {
            let found = rows.iter().find(|r| r.0 == *p && r.2 == name);
            found.map_or(String::new(), |r| plot::digits(r.1))
        });
        let cells: Vec<String> = cells.collect();
        line(&mut out, &format!("| {name} | {} |", cells.join(" | ")));
    }
    out + "\n"
}

/// Least processor time at which a curve comes below an error, on the line between neighbours in the log-log plane.
fn time_at(outcome: &Outcome, curve: &str, error: f64) -> Option<f64> {
    let points: Vec<(f64, f64)> = outcome
        .runs
        .iter()
        .zip(&outcome.timings)
        .filter(|(run, _)| run.curve == curve)
        .filter_map(|(run, timing)| {
            Some((run.result.as_ref().ok()?.errors.position, (*timing)?.median))
        })
        .collect();
    let reached = points.iter().filter(|p| p.0 <= error).map(|p| p.1);
    let crossed = points.windows(2).filter_map(|pair| {
        let [(e0, t0), (e1, t1)] = [pair[0], pair[1]];
        (e0 > error && e1 <= error).then(|| {
            let share = (e0 / error).ln() / (e0 / e1).ln();
            t0 * (t1 / t0).powf(share)
        })
    });
    reached.chain(crossed).reduce(f64::min)
}

/// Which method for which scene and error.
fn fastest(made: &[Made]) -> String {
    let mut out = String::from(
        "## Which method for which error?\n\n\
         The curve that comes below an error of position first, its processor time, and how many times as long the scheme of \
         the paper, Bathe's with a fixed step, takes for it. Times between points are interpolated; a dash: no curve came so \
         far; no brackets: Bathe's did not.\n\n",
    );
    let heads: Vec<String> = LEVELS.iter().map(|e| plot::si(*e, "m")).collect();
    line(&mut out, &format!("| study | {} |", heads.join(" | ")));
    line(&mut out, &format!("|---|{}", "---|".repeat(LEVELS.len())));
    for one in made.iter().filter(|one| !one.study.compares_elements()) {
        let cells = LEVELS.iter().map(|error| {
            let curves = one.outcome.curves().into_iter();
            let times = curves.filter_map(|c| Some((c, time_at(&one.outcome, c, *error)?)));
            let Some((curve, time)) = times.min_by(|a, b| a.1.total_cmp(&b.1)) else {
                return "–".to_owned();
            };
            let bathe = time_at(&one.outcome, "Bathe", *error);
            let bathe = bathe.map_or(String::new(), |b| {
                format!(" (Bathe {} times)", plot::digits(b / time))
            });
            format!("{curve}: {}{bathe}", plot::si(time, "s"))
        });
        let cells: Vec<String> = cells.collect();
        line(
            &mut out,
            &format!("| {} | {} |", one.name, cells.join(" | ")),
        );
    }
    out + "\n"
}

/// What diverged.
fn omissions(made: &[Made]) -> String {
    let mut out = String::from("## Omissions\n\n");
    let mut none = true;
    for one in made {
        for run in &one.outcome.runs {
            if let Err(error) = &run.result {
                none = false;
                let first = error.lines().next().unwrap_or_default();
                line(
                    &mut out,
                    &format!(
                        "* {}: {} with {} failed: {first}",
                        one.name, run.curve, run.pace
                    ),
                );
            }
        }
    }
    if none {
        line(&mut out, "* No run failed.");
    }
    line(
        &mut out,
        "* Velocity Verlet runs only where there are no constraint rows. Bathe's scheme with an accuracy was not run where it \
         would take more than some seconds a point. Counts of instructions are not shown: the machine has none.\n\
         * Beyond the first impacts runs with loose joints go different ways; here each study ends before that.",
    );
    out
}

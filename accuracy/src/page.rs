//! The page.

use crate::{Made, Surveyed, effects};
use looselink::ablation::Ablation;
use looselink::machine::{Machine, median};
use looselink::precision::{Outcome, Pace};
use std::fmt::Write;

/// Errors of position at which curves are compared \[m\].
const LEVELS: [f64; 5] = [1e-6, 1e-7, 1e-8, 1e-9, 1e-10];

/// What ACCURACY.md says.
pub fn page(
    made: &[Made],
    surveyed: &[Surveyed],
    ablation: &Ablation,
    machine: &Machine,
    seconds: f64,
) -> String {
    let mut out = format!(
        "# What accuracy costs\n\n{}\n\
         Every method on every study of [studies](studies), error against processor time. Written by `cargo run --release -p \
         accuracy` in {:.0} min; one study alone: `cargo run --release -- precision studies/case3.toml --out out/case3` \
         ([docs/study.md](docs/study.md)). Processor times are those of one core, {machine}: the \
         median of as many runs as the column `runs` says, after one that is not timed. Every single time is in \
         [accuracy/timings.json](accuracy/timings.json).\n\n",
        records::place("accuracy"),
        (seconds / 60.0).ceil()
    );
    out += &conclusions(made, surveyed);
    out += &asked(made);
    out += &fastest(made);
    for one in made {
        out += &format!(
            "## {}\n\n![{}](accuracy/figures/{}.png)\n\n{}\n{}",
            one.study.title,
            one.study.title,
            one.name,
            looselink::precision::table(&one.outcome),
            folded(&one.outcome.warnings())
        );
    }
    for one in surveyed {
        out += &format!(
            "## {}\n\n![{}](accuracy/figures/{}.png)\n\n{}\n\n{}\n{}",
            one.study.title,
            one.study.title,
            one.name,
            long_runs(one),
            one.survey.table(one.study.duration),
            folded(&one.survey.warnings())
        );
    }
    out += &effects::section(ablation);
    out += &folded(&ablation.warnings());
    out += &omissions(made);
    out
}

fn line(out: &mut String, text: &str) {
    writeln!(out, "{text}").expect("a string takes any text");
}

/// The warnings of the runs of a table, folded up: coarse runs have many.
fn folded(warnings: &[String]) -> String {
    if warnings.is_empty() {
        return "No run warns.\n\n".to_owned();
    }
    let list: String = warnings.iter().map(|w| format!("* {w}\n")).collect();
    let count = warnings.len();
    format!("<details><summary>Warnings of these runs: {count}</summary>\n\n{list}\n</details>\n\n")
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

/// Least processor time at which a curve comes below an error, on the line between neighbours in the log-log plane, and the
/// step or accuracy there.
fn time_at(outcome: &Outcome, curve: &str, error: f64) -> Option<(f64, Pace)> {
    let points: Vec<(f64, f64, Pace)> = outcome
        .runs
        .iter()
        .zip(&outcome.timings)
        .filter(|(run, _)| run.curve == curve)
        .filter_map(|(run, timing)| {
            let error = run.result.as_ref().ok()?.errors.position;
            Some((error, timing.as_ref()?.median, run.pace))
        })
        .collect();
    let reached = points.iter().filter(|p| p.0 <= error).map(|p| (p.1, p.2));
    let crossed = points.windows(2).filter_map(|pair| {
        let [(e0, t0, from), (e1, t1, to)] = [pair[0], pair[1]];
        (e0 > error && e1 <= error).then(|| {
            let share = (e0 / error).ln() / (e0 / e1).ln();
            let between = |a: f64, b: f64| a * (b / a).powf(share);
            (between(t0, t1), between_paces(from, to, between))
        })
    });
    reached.chain(crossed).min_by(|a, b| a.0.total_cmp(&b.0))
}

/// The pace between two of a curve.
fn between_paces(from: Pace, to: Pace, between: impl Fn(f64, f64) -> f64) -> Pace {
    match (from, to) {
        (Pace::Step(a), Pace::Step(b)) => Pace::Step(between(a, b)),
        (
            Pace::Accuracy { position: a, .. },
            Pace::Accuracy {
                position: b,
                energy,
                horizon,
            },
        ) => Pace::Accuracy {
            position: between(a, b),
            energy,
            horizon,
        },
        (Pace::Tolerance(a), Pace::Tolerance(b)) => Pace::Tolerance(between(a, b)),
        _ => to,
    }
}

/// The curve of a study that comes below an error first, among those whose names are accepted.
fn winner(one: &Made, error: f64, accept: impl Fn(&str) -> bool) -> Option<(&str, f64, Pace)> {
    let curves = one.outcome.curves().into_iter().filter(|c| accept(c));
    let times = curves.filter_map(|c| {
        let (time, pace) = time_at(&one.outcome, c, error)?;
        Some((c, time, pace))
    });
    times.min_by(|a, b| a.1.total_cmp(&b.1))
}

/// Studies that compare methods.
fn of_methods(made: &[Made]) -> impl Iterator<Item = &Made> {
    made.iter().filter(|one| !one.study.compares_elements())
}

/// The scheme of the paper.
const PAPER: &str = "Bathe";

fn is_explicit(curve: &str) -> bool {
    curve.starts_with("Dormand-Prince") || curve.starts_with("velocity Verlet")
}

/// What the diagrams say, counted.
fn conclusions(made: &[Made], surveyed: &[Surveyed]) -> String {
    let mut wins: Vec<(&str, usize)> = Vec::new();
    let (mut cells, mut ratios) = (0, Vec::new());
    for one in of_methods(made) {
        for error in LEVELS {
            let Some((curve, time, _)) = winner(one, error, |_| true) else {
                continue;
            };
            cells += 1;
            match wins.iter_mut().find(|w| w.0 == curve) {
                Some(win) => win.1 += 1,
                None => wins.push((curve, 1)),
            }
            if let Some((paper, _)) = time_at(&one.outcome, PAPER, error) {
                ratios.push(paper / time);
            }
        }
    }
    wins.sort_by_key(|w| std::cmp::Reverse(w.1));
    let wins: Vec<String> = wins.iter().map(|(c, n)| format!("{c} {n}")).collect();
    ratios.sort_by(f64::total_cmp);
    let mut out = String::from("## In short\n\n");
    line(
        &mut out,
        &format!(
            "* Over {cells} pairs of a study and an error from {} to {}, the fastest curve is, so many times: {}.",
            plot::si(LEVELS[0], "m"),
            plot::si(LEVELS[LEVELS.len() - 1], "m"),
            wins.join(", ")
        ),
    );
    if let [least, .., most] = ratios[..] {
        line(
            &mut out,
            &format!(
                "* The scheme of the paper, Bathe's with a fixed step, takes {} to {} times as long as the fastest, in the median \
                 {}; in {} of the {cells} pairs it does not come so far with the steps tried.",
                plot::digits(least),
                plot::digits(most),
                plot::digits(median(&ratios)),
                cells - ratios.len()
            ),
        );
    }
    let level = 1e-9;
    let explicit: Vec<String> = of_methods(made)
        .filter_map(|one| {
            let (_, explicit, _) = winner(one, level, is_explicit)?;
            let (_, implicit, _) = winner(one, level, |c| !is_explicit(c))?;
            let ratio = plot::digits(explicit / implicit);
            Some(format!("{ratio} ({})", one.name))
        })
        .collect();
    line(
        &mut out,
        &format!(
            "* Explicit methods against implicit ones: for an error of {} the fastest explicit curve takes, of the time of the \
             fastest implicit one, {}. Their steps shrink with the length of an element, so compare `case2` and `case2-4elements`.",
            plot::si(level, "m"),
            explicit.join(", ")
        ),
    );
    for one in surveyed {
        line(
            &mut out,
            &format!("* {}: {}", one.study.title, long_runs(one)),
        );
    }
    out + "\n"
}

/// Bounds within which the statistics of a long run count as converged: envelopes and rms, share of contact, energy lost over
/// that dissipated in contact.
const CONVERGED: [f64; 3] = [0.01, 0.03, 0.05];

/// Which run is the fastest whose statistics are converged.
fn long_runs(one: &Surveyed) -> String {
    let [_, exact] = &one.survey.reference;
    let runs = one.survey.runs.iter().zip(&one.survey.timings);
    let good = runs.filter_map(|(run, timing)| {
        let (measures, _) = run.result.as_ref().ok()?;
        let [deviation, contact, loss] = CONVERGED;
        let converged = measures.deviation(exact) < deviation
            && (measures.contact - exact.contact).abs() < contact
            && measures.loss().abs() < loss;
        Some((run, timing.as_ref()?.median)).filter(|_| converged)
    });
    let mut good: Vec<_> = good.collect();
    good.sort_by(|a, b| a.1.total_cmp(&b.1));
    let told = |(run, time): &(&looselink::precision::Sampled, f64)| {
        format!(
            "{} with {} ({} times as fast as the mechanism moves)",
            run.curve,
            run.pace,
            plot::digits(one.study.duration / time)
        )
    };
    let [deviation, contact, loss] = CONVERGED.map(plot::percent);
    let mut text = format!(
        "{} of {} runs have envelopes and rms within {deviation}, the share of contact within {contact} and an energy lost below \
         {loss} of that of contacts.",
        good.len(),
        one.survey.runs.len()
    );
    if let Some(first) = good.first() {
        text += &format!(" The fastest of them is {}", told(first));
        let controlled = |(run, _): &&(&looselink::precision::Sampled, f64)| {
            matches!(run.pace, Pace::Accuracy { .. })
        };
        text += &match good.iter().find(controlled) {
            Some(other) if other.1 > first.1 => {
                format!(", the fastest with an accuracy {}.", told(other))
            }
            _ => ".".to_owned(),
        };
    }
    text
}

/// Which method for which scene and error.
fn fastest(made: &[Made]) -> String {
    let mut out = String::from(
        "## Which method for which error?\n\n\
         The curve that comes below an error of position first, with its step or accuracy and its processor time, and how many \
         times as long the scheme of the paper, Bathe's with a fixed step, takes for it. Between points both are interpolated; a dash: no curve came so \
         far; no brackets: Bathe's did not.\n\n",
    );
    let heads: Vec<String> = LEVELS.iter().map(|e| plot::si(*e, "m")).collect();
    line(&mut out, &format!("| study | {} |", heads.join(" | ")));
    line(&mut out, &format!("|---|{}", "---|".repeat(LEVELS.len())));
    for one in of_methods(made) {
        let cells = LEVELS.iter().map(|error| {
            let Some((curve, time, pace)) = winner(one, *error, |_| true) else {
                return "–".to_owned();
            };
            let paper = time_at(&one.outcome, PAPER, *error);
            let paper = paper.map_or(String::new(), |(t, pace)| {
                format!(" (Bathe, {pace}: {} times)", plot::digits(t / time))
            });
            format!("{curve}, {pace}: {}{paper}", plot::si(time, "s"))
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
    let mut timings = made.iter().flat_map(|one| &one.outcome.timings).flatten();
    let counts = match timings.all(|timing| timing.instructions.is_none()) {
        true => " Counts of instructions are not shown: the machine has none.",
        false => "",
    };
    line(
        &mut out,
        &format!(
            "* Velocity Verlet runs only where there are no constraint rows. Bathe's scheme with an accuracy was not run where \
             it would take more than some seconds a point.{counts}\n\
             * Beyond the first impacts runs with loose joints go different ways; studies of errors end before that, those of \
             two seconds compare statistics."
        ),
    );
    out
}

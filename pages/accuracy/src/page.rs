//! The page.

use crate::asked::AccurateRuns;
use crate::{MadeStudy, Surveyed, effects};
use std::fmt::Write;
use studies::ablation::Ablation;
use studies::machine::{Machine, median};
use studies::precision::{
    Compared, CurvePoint, CurveTime, MotionReference, RunStatistics, StatisticsReference,
    StudyPace, Times, WorkCounts,
};

/// Errors of position at which curves are compared \[m\].
const LEVELS: [f64; 5] = [1e-6, 1e-7, 1e-8, 1e-9, 1e-10];

/// What ACCURACY.md says.
pub fn page(
    made: &[MadeStudy],
    surveyed: &[Surveyed],
    accurate: &AccurateRuns,
    ablation: &Ablation,
    machine: &Machine,
    seconds: f64,
) -> String {
    let mut out = format!(
        "# What accuracy costs\n\n{}\n\
         Error against processor time for every method in every study of [studies](studies). `cargo run --release -p accuracy` \
         writes this page in {:.0} min; `cargo run --release -- precision studies/case3.toml --out out/case3` runs one study \
         ([docs/study.md](docs/study.md)). A processor time is the median over the number of runs in column `runs`, after one \
         run that is not timed, on one core: {machine}. [pages/accuracy/timings.json](pages/accuracy/timings.json) has every single \
         time.\n\n",
        records::place("accuracy"),
        (seconds / 60.0).ceil()
    );
    out += &conclusions(made, surveyed);
    out += &accurate.section();
    out += &fastest(made);
    for one in made {
        out += &format!(
            "## {}\n\n![{}](pages/accuracy/figures/{}.png)\n\n{}\n{}",
            one.study.title,
            one.study.title,
            one.name,
            MotionReference::table(&one.outcome, &one.study),
            folded(&one.outcome.warnings())
        );
    }
    for one in surveyed {
        out += &format!(
            "## {}\n\n![{}](pages/accuracy/figures/{}.png)\n\n{}\n\n{}\n{}",
            one.study.title,
            one.study.title,
            one.name,
            long_runs(one),
            StatisticsReference::table(&one.survey, &one.study),
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
        return "No run has a warning.\n\n".to_owned();
    }
    let list: String = warnings.iter().map(|w| format!("* {w}\n")).collect();
    let count = warnings.len();
    format!("<details><summary>Warnings of these runs: {count}</summary>\n\n{list}\n</details>\n\n")
}

/// The curve of a study that comes below an error first, among those whose names are accepted.
fn winner(
    one: &MadeStudy,
    error: f64,
    times: Times,
    accept: impl Fn(&str) -> bool,
) -> Option<(&str, CurveTime)> {
    let curves = one.outcome.curves().into_iter().filter(|c| accept(c));
    let times = curves.filter_map(|c| Some((c, one.outcome.time_at(c, error, times)?)));
    times.min_by(|a, b| a.1.seconds.total_cmp(&b.1.seconds))
}

/// As [`winner`], from runs that were made alone.
fn fastest_run(one: &MadeStudy, error: f64, accept: impl Fn(&str) -> bool) -> Option<(&str, f64)> {
    let (curve, time) = winner(one, error, Times::Measured, accept)?;
    Some((curve, time.seconds))
}

/// Time of the fastest run of a curve below an error \[s\].
fn run_of(one: &MadeStudy, curve: &str, error: f64) -> Option<f64> {
    Some(fastest_run(one, error, |name| name == curve)?.1)
}

/// Studies that compare methods.
fn of_methods(made: &[MadeStudy]) -> impl Iterator<Item = &MadeStudy> {
    made.iter().filter(|one| !one.study.compares_elements())
}

/// The scheme of the paper.
const PAPER: &str = "Bathe";

fn is_explicit(curve: &str) -> bool {
    ["Dormand-Prince", "DOP853", "velocity Verlet"]
        .iter()
        .any(|explicit| curve.starts_with(explicit))
}

/// What the diagrams say, counted.
fn conclusions(made: &[MadeStudy], surveyed: &[Surveyed]) -> String {
    let mut wins: Vec<(&str, usize)> = Vec::new();
    let (mut cells, mut ratios) = (0, Vec::new());
    for one in of_methods(made) {
        for error in LEVELS {
            let Some((curve, time)) = fastest_run(one, error, |_| true) else {
                continue;
            };
            cells += 1;
            match wins.iter_mut().find(|w| w.0 == curve) {
                Some(win) => win.1 += 1,
                None => wins.push((curve, 1)),
            }
            if let Some(paper) = run_of(one, PAPER, error) {
                ratios.push(paper / time);
            }
        }
    }
    wins.sort_by_key(|w| std::cmp::Reverse(w.1));
    let wins: Vec<String> = wins.iter().map(|(c, n)| format!("{c} ({n})")).collect();
    ratios.sort_by(f64::total_cmp);
    let mut out = String::from("## In short\n\n");
    line(
        &mut out,
        &format!(
            "* Times count of runs that were made, the fastest whose error is not above the one asked for and stays there with finer \
             steps. Fastest method, counted over {cells} pairs of a study and an error between {} and {}: {}.",
            numbers::si(LEVELS[0], "m"),
            numbers::si(LEVELS[LEVELS.len() - 1], "m"),
            wins.join(", ")
        ),
    );
    if let [least, .., most] = ratios[..] {
        line(
            &mut out,
            &format!(
                "* The scheme of the paper, Bathe's with a fixed step, takes {} to {} times as long as the fastest method (median \
                 {}). In {} of the {cells} pairs it does not reach the error with the steps tried.",
                numbers::digits(least),
                numbers::digits(most),
                numbers::digits(median(&ratios)),
                cells - ratios.len()
            ),
        );
    }
    out += &automatic(made);
    out += &choices(made);
    let level = 1e-9;
    let explicit: Vec<String> = of_methods(made)
        .filter_map(|one| {
            let (_, explicit) = fastest_run(one, level, is_explicit)?;
            let (_, implicit) = fastest_run(one, level, |c| !is_explicit(c))?;
            let ratio = numbers::digits(explicit / implicit);
            Some(format!("{ratio} ({})", one.name))
        })
        .collect();
    line(
        &mut out,
        &format!(
            "* Time of the fastest explicit method over that of the fastest implicit one, for an error of {}: {}. The stable \
             step of explicit methods shrinks with the element length: compare `case2` with `case2-4elements`.",
            numbers::si(level, "m"),
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

/// The schemes among which `method = "auto"` chooses, as their curves are called, and its own curve.
const CANDIDATES: [&str; 4] = [
    "ESDIRK of order 5, error controlled",
    "Dormand-Prince, error controlled",
    "DOP853, error controlled",
    "ESDIRK of order 3, error controlled",
];
const AUTOMATIC: &str = "auto, error controlled";

/// What the choice of `method = "auto"` costs, the trial runs included.
fn automatic(made: &[MadeStudy]) -> String {
    let cells = of_methods(made).flat_map(|one| LEVELS.map(|error| (one, error)));
    let ratios = cells.filter_map(|(one, error)| {
        let time = run_of(one, AUTOMATIC, error)?;
        let (_, best) = fastest_run(one, error, |curve| CANDIDATES.contains(&curve))?;
        let (_, any) = fastest_run(one, error, |_| true)?;
        Some((one, error, [time / best, time / any]))
    });
    let ratios: Vec<_> = ratios.collect();
    let of = |k: usize| {
        let values: Vec<f64> = ratios.iter().map(|(.., ratios)| ratios[k]).collect();
        let within = values.iter().filter(|ratio| **ratio <= 1.5).count();
        let worst = ratios.iter().max_by(|a, b| a.2[k].total_cmp(&b.2[k]))?;
        let (one, error, ratios) = worst;
        Some(format!(
            "{} in the median, {} at most ({}, {}), at most 1.5 in {within} of {} pairs",
            numbers::digits(median(&values)),
            numbers::digits(ratios[k]),
            one.name,
            numbers::si(*error, "m"),
            values.len()
        ))
    };
    let (Some(best), Some(any)) = (of(0), of(1)) else {
        return String::new();
    };
    let count = CANDIDATES.len();
    format!(
        "* The time of `method = \"auto\"`, trial runs included, over that of the fastest of its {count} candidates: {best}. Over that of \
         the fastest curve of any kind: {any}.\n"
    )
}

/// How good the choice of `method = "auto"` is, and what it costs: its runs beside those of the candidates with the same accuracy.
/// A run is that of its candidate from the first step on, so it has the same errors.
fn choices(made: &[MadeStudy]) -> String {
    let (mut of_best, mut of_own) = (Vec::new(), Vec::new());
    for one in of_methods(made) {
        let timed = one.outcome.runs.iter().zip(&one.outcome.timings);
        let timed = timed.filter_map(|(run, timing)| {
            let errors = &run.result.as_ref().ok()?.errors;
            Some((&*run.curve, run.pace, errors, timing.as_ref()?.median))
        });
        let timed: Vec<_> = timed.collect();
        for (_, pace, errors, time) in timed.iter().filter(|run| run.0 == AUTOMATIC) {
            let candidates = || {
                let all = timed.iter().filter(|run| CANDIDATES.contains(&run.0));
                all.filter(|run| run.1 == *pace)
            };
            let best = candidates().map(|run| run.3).reduce(f64::min);
            let own = candidates().find(|run| run.2 == *errors);
            if let (Some(best), Some((.., own))) = (best, own) {
                of_best.push(own / best);
                of_own.push(time / own);
            }
        }
    }
    if of_best.is_empty() {
        return String::new();
    }
    format!(
        "* The scheme that `method = \"auto\"` chooses takes at most {} times as long as the fastest candidate for the same requested \
         accuracy, in {} runs. The trial runs of the other candidates are part of the time of the run, which is {} times that of the \
         scheme alone in the median, and {} times at most: these runs are short.\n",
        numbers::digits(of_best.iter().copied().fold(0.0, f64::max)),
        of_best.len(),
        numbers::digits(median(&of_own)),
        numbers::digits(of_own.iter().copied().fold(0.0, f64::max))
    )
}

/// Bounds within which the statistics of a long run count as converged: envelopes and rms, share of contact, energy lost over
/// that dissipated in contact.
const CONVERGED: [f64; 3] = [0.01, 0.03, 0.05];

/// Which run is the fastest whose statistics are converged.
fn long_runs(one: &Surveyed) -> String {
    let [_, exact] = &one.survey.reference.runs;
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
    let reported = |(run, time): &(&CurvePoint<(RunStatistics, WorkCounts)>, f64)| {
        format!(
            "{} with {} ({} times real time)",
            run.curve,
            run.pace,
            numbers::digits(one.study.duration / time)
        )
    };
    let [deviation, contact, loss] = CONVERGED.map(numbers::percent);
    let mut text = format!(
        "{} of {} runs count as converged: envelopes and rms within {deviation} of the reference, the share of contact within \
         {contact}, and an energy lost or gained by the integrator below {loss} of the contact dissipation.",
        good.len(),
        one.survey.runs.len()
    );
    if let Some(first) = good.first() {
        text += &format!(" The fastest of these is {}", reported(first));
        let controlled = |(run, _): &&(&CurvePoint<(RunStatistics, WorkCounts)>, f64)| {
            matches!(run.pace, StudyPace::Accuracy { .. })
        };
        text += &match good.iter().find(controlled) {
            Some(other) if other.1 > first.1 => {
                format!(
                    "; the fastest with a requested accuracy is {}.",
                    reported(other)
                )
            }
            _ => ".".to_owned(),
        };
    }
    text
}

/// Which method for which scene and error.
fn fastest(made: &[MadeStudy]) -> String {
    let mut out = String::from(
        "## Which method for which error?\n\n\
         The fastest method for an error of position, with its step or accuracy and its processor time. In brackets: how many \
         times as long the scheme of the paper takes, Bathe's with a fixed step; no brackets where it did not reach the error. \
         Times with ~ are interpolated between two runs of a curve, and so are their steps and accuracies; nothing is extrapolated: \
         where the coarsest run is already below the error, its time counts. A dash: no method reached the error.\n\n",
    );
    let heads: Vec<String> = LEVELS.iter().map(|e| numbers::si(*e, "m")).collect();
    line(&mut out, &format!("| study | {} |", heads.join(" | ")));
    line(&mut out, &format!("|---|{}", "---|".repeat(LEVELS.len())));
    for one in of_methods(made) {
        let cells = LEVELS.iter().map(|error| {
            let Some((curve, time)) = winner(one, *error, Times::Interpolated, |_| true) else {
                return "–".to_owned();
            };
            let mark = |time: CurveTime| if time.is_interpolated { "~" } else { "" };
            let paper = one.outcome.time_at(PAPER, *error, Times::Interpolated);
            let paper = paper.map_or(String::new(), |paper| {
                let ratio = numbers::digits(paper.seconds / time.seconds);
                format!(" (Bathe, {}: {}{ratio} times)", paper.pace, mark(paper))
            });
            let (own, seconds) = (mark(time), numbers::si(time.seconds, "s"));
            format!("{curve}, {}: {own}{seconds}{paper}", time.pace)
        });
        let cells: Vec<String> = cells.collect();
        line(
            &mut out,
            &format!("| {} | {} |", one.name, cells.join(" | ")),
        );
    }
    out + "\n"
}

/// What failed or was left out.
fn omissions(made: &[MadeStudy]) -> String {
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
        true => " Instruction counts are missing: the machine has no counter.",
        false => "",
    };
    line(
        &mut out,
        &format!(
            "* Velocity Verlet runs only on scenes without constraints. Bathe's scheme with a requested accuracy was not run where \
             a point would take more than some seconds.{counts}\n\
             * Loose joints are chaotic: after the first impacts two runs diverge. Studies of errors end before that; the studies \
             of two seconds compare statistics."
        ),
    );
    out
}

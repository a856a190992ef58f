//! The page of the measured guarantee, from the record alone.

use crate::amplification::NEIGHBOURS;
use crate::guarantee::{
    ACCURACIES, AMPLIFIES, Asked, GIVEN_UP, GOAL, GOOD, GuaranteeEntry, LOOSE_HORIZON, METHODS,
    REFERENCE_STEPS, ROWS, RunEnd, STEPS,
};
use miette::{IntoDiagnostic, Result, WrapErr};
use numbers::{digits, percent, si};
use plot::{Axis, Figure, Mark, Panel, palette};
use std::collections::BTreeMap;
use std::fmt::Write;

/// Share of the runs that are to reach their accuracy, and the largest ratio of any of them.
const SHARE: f64 = 0.95;
const LARGEST: f64 = 3.0;
/// Steps of a looser accuracy over those of a tighter one.
const MORE_STEPS: f64 = 1.1;
/// Rows of the table of the largest ratios.
const LISTED: usize = 20;

/// A run that is judged.
struct Judged<'a> {
    entry: &'a GuaranteeEntry,
    run: &'a Asked,
    ratio: f64,
}

impl Judged<'_> {
    /// The ratio over the amplification of the motion.
    fn divided(&self) -> f64 {
        self.ratio / self.entry.facts.amplification.unwrap_or(1.0).max(1.0)
    }
}

/// Counts of some runs.
#[derive(Debug, Default, PartialEq)]
struct RatioTally {
    runs: usize,
    within: usize,
    largest: f64,
    /// Scene with the largest ratio.
    scene: String,
}

impl RatioTally {
    fn of<'a>(ratios: impl Iterator<Item = (f64, &'a str)>) -> RatioTally {
        let mut tally = RatioTally::default();
        for (ratio, scene) in ratios {
            tally.runs += 1;
            tally.within += usize::from(ratio <= 1.0);
            if ratio.is_nan() || ratio > tally.largest {
                (tally.largest, tally.scene) = (ratio, scene.to_owned());
            }
        }
        tally
    }

    fn reported(&self) -> String {
        if self.runs == 0 {
            return "no run was judged".to_owned();
        }
        let share = percent(self.within as f64 / self.runs as f64);
        let RatioTally {
            runs,
            within,
            largest,
            scene,
        } = self;
        let kept = *within as f64 >= SHARE * *runs as f64 && *largest <= LARGEST;
        format!(
            "{within} of {runs} ({share}) have a ratio of at most 1; the largest ratio is {} ({scene}). The criterion is \
             {}",
            digits(*largest),
            if kept { "met" } else { "**not met**" }
        )
    }

    fn cell(&self) -> String {
        match self.runs {
            0 => "–".to_owned(),
            runs => format!(
                "{} of {runs}; {} ({})",
                self.within,
                digits(self.largest),
                self.scene
            ),
        }
    }
}

/// The runs that are judged. Runs of a motion that is prescribed altogether have nothing to integrate, and those whose steps
/// the clearance or the interval of the rows limits are one run for several accuracies: the tightest of these counts.
fn judged(entries: &[GuaranteeEntry]) -> Vec<Judged<'_>> {
    let moves = |entry: &&GuaranteeEntry| !is_prescribed(entry);
    let runs = entries.iter().filter(moves).flat_map(|entry| {
        let tighter = entry.runs.iter().skip(1).map(Some).chain([None]);
        let runs = entry.runs.iter().zip(tighter);
        runs.filter(|(run, tighter)| !tighter.is_some_and(|tighter| is_same(run, tighter)))
            .map(move |(run, _)| (entry, run))
    });
    runs.filter_map(|(entry, run)| {
        Some(Judged {
            entry,
            run,
            ratio: entry.ratio(run)?,
        })
    })
    .collect()
}

/// True of a motion without freedom, to which no error of a step does anything.
fn is_prescribed(entry: &GuaranteeEntry) -> bool {
    entry.facts.amplification == Some(0.0)
}

/// True of two runs that took the same steps.
fn is_same(one: &Asked, other: &Asked) -> bool {
    match (&one.end, &other.end) {
        (RunEnd::Complete(a), RunEnd::Complete(b)) => a == b && one.steps == other.steps,
        _ => false,
    }
}

/// Pairs of runs of which the looser accuracy takes more steps: the two, and the factor.
fn dearer(entry: &GuaranteeEntry) -> Vec<(f64, f64, f64)> {
    let complete: Vec<&Asked> = entry
        .runs
        .iter()
        .filter(|r| matches!(r.end, RunEnd::Complete(_)))
        .collect();
    let pairs = complete.windows(2).map(|pair| {
        let factor = pair[0].steps as f64 / pair[1].steps as f64;
        (pair[0].position, pair[1].position, factor)
    });
    pairs.filter(|(.., factor)| *factor > MORE_STEPS).collect()
}

/// Messages that differ in numbers and coordinates alone, as one: how many runs have it, and the first of them with its run.
fn kinds<'a>(messages: impl Iterator<Item = (&'a str, String)>) -> Vec<(usize, String, String)> {
    let mut found: BTreeMap<String, (usize, String, String)> = BTreeMap::new();
    for (message, run) in messages {
        let common = |word: &&str| {
            let word = word.trim_end_matches([',', ':', ';', ')', '.']);
            word.parse::<f64>().is_err() && !word.contains('.')
        };
        let words: Vec<&str> = message.split(' ').filter(common).collect();
        let kind = found
            .entry(words.join(" "))
            .or_insert((0, message.to_owned(), run));
        kind.0 += 1;
    }
    found.into_values().collect()
}

fn run(entry: &GuaranteeEntry, asked: &Asked) -> String {
    format!(
        "{}, {}, {}",
        entry.scene,
        entry.method,
        si(asked.position, "m")
    )
}

fn list<'a>(messages: impl Iterator<Item = (&'a str, String)>, nothing: &str) -> String {
    let kinds = kinds(messages);
    let lines = kinds.iter().map(|(count, message, run)| match count {
        1 => format!("* {run}: {message}\n"),
        _ => format!("* {count} runs, such as {run}: {message}\n"),
    });
    let text: String = lines.collect();
    if text.is_empty() {
        format!("{nothing}\n")
    } else {
        text
    }
}

/// A table with a row a method and a column an accuracy.
fn table(rows: impl Fn(&str, f64) -> String) -> String {
    let mut out = String::from("| method |");
    ACCURACIES
        .iter()
        .for_each(|p| out += &format!(" {} |", si(*p, "m")));
    out += &format!("\n|---|{}\n", "---|".repeat(ACCURACIES.len()));
    for (name, _) in METHODS {
        let cells = ACCURACIES.map(|p| rows(name, p)).join(" | ");
        out += &format!("| {} | {cells} |\n", name);
    }
    out
}

fn tallied<'a>(
    all: &[&Judged<'a>],
    of: fn(&Judged<'a>) -> f64,
    method: &str,
    position: f64,
) -> RatioTally {
    let runs = all
        .iter()
        .filter(|j| j.entry.method == method && j.run.position == position);
    RatioTally::of(runs.map(|j| (of(j), j.entry.scene.as_str())))
}

/// What the page says.
fn page(entries: &[GuaranteeEntry]) -> Result<String> {
    let all = judged(entries);
    let (loud, calm): (Vec<&Judged>, Vec<&Judged>) =
        all.iter().partition(|j| j.entry.facts.amplifies());
    let tally = |runs: &[&Judged], of: fn(&Judged) -> f64| {
        RatioTally::of(runs.iter().map(|j| (of(j), j.entry.scene.as_str())))
    };
    let mut scenes: Vec<&GuaranteeEntry> = entries.iter().collect();
    scenes.dedup_by_key(|entry| &entry.scene);
    let planned = scenes.len() * METHODS.len() * ACCURACIES.len();
    let with_ratio = entries.iter().map(|entry| {
        let ratios = entry.runs.iter().filter_map(|run| entry.ratio(run));
        ratios.count()
    });
    let set_aside = with_ratio.sum::<usize>() - all.len();
    let prescribed = scenes.iter().filter(|entry| is_prescribed(entry)).count();
    let not_taken = entries.iter().filter(|e| e.refused.is_some()).count() * ACCURACIES.len();
    let mut out = format!(
        "# Is the accuracy reached that was asked for?\n\n{}\n\
         Each of the {} dynamic scenes in [scenes](../../scenes) is run with every method that takes it and \
         `--accuracy position=P,horizon=H`, for P from 1 mm to 1 nm as far as {STEPS} steps go. The ratio of a run is the error achieved over P. Written by `cargo run --release -p accuracy -- \
         guarantee`; every number is in [guarantee.jsonl](guarantee.jsonl).\n\n\
         ## The criterion\n\n\
         With `accuracy` the steps are chosen so that their estimated errors add up to about P within a horizon. Of the runs \
         below we require that **{} have a ratio of at most 1, and that no ratio is above {LARGEST}**: an estimate that misses a \
         factor of three now and then is still of use to whoever chooses P.\n\n\
         * Motions that amplify errors less than {AMPLIFIES} times: {}.\n\
         * Motions that amplify errors more, ratio divided by the amplification: {}.\n\
         * The same motions, ratio as it is: {}. No control of steps can undo what a chaotic motion makes of an error.\n\n\
         {} runs were planned: {} methods, {} accuracies. {} of them are judged above. {} more belong to {prescribed} scenes whose \
         motion is prescribed, or repeat the steps of a tighter accuracy, because the clearance or the interval of the rows limits \
         them. {not_taken} are of scenes that a method does not take. The others took too many steps, had no reference that is \
         good enough, or stopped; they are at the end.\n\n",
        records::place("guarantee"),
        scenes.len(),
        percent(SHARE),
        tally(&calm, |j| j.ratio).reported(),
        tally(&loud, |j| j.divided()).reported(),
        tally(&loud, |j| j.ratio).reported(),
        planned,
        METHODS.len(),
        ACCURACIES.len(),
        all.len(),
        set_aside,
    );
    let missing = scenes.len() * METHODS.len() - entries.len();
    if missing > 0 {
        out += &format!(
            "**The record is not complete: {missing} pairs of a scene and a method are missing.**\n\n"
        );
    }
    let [others, loose] = NEIGHBOURS;
    out += &format!(
        "![Error achieved over accuracy asked for](figures/guarantee.png)\n\n\
         ## What is measured\n\n\
         * **Horizon H**: {} where a joint has clearance, else the duration of the scene. Runs end at the horizon.\n\
         * **Error**: the largest difference from a reference of every recorded coordinate x, y in {ROWS} rows.\n\
         * **Reference**: Dormand and Prince's method, P tightened tenfold from 10 nm until the floor is {}, a run takes more \
         than {REFERENCE_STEPS} steps, or it refuses. The floor is the distance of the last two runs, and at least the P of the \
         last. A run counts where the floor is at most a tenth of its P.\n\
         * **Amplification**: how many times a tiny disturbance of the start grows within H. A second run starts with slightly \
         different velocities (by dv) or positions (by dq). The amplification is the largest later distance between the positions \
         of the two runs, over H·max|dv| or over max|dq|. In free flight it is 1; where the whole motion is prescribed it is 0. \
         The largest of {loose} disturbances counts where a joint has clearance, of {others} elsewhere. When the distance is no \
         longer tiny, the second run is moved back towards the first and the factor is kept (Benettin et al. 1980).\n\
         * Points that are not recorded, instants between the rows and times after the first horizon are not tested. A fault \
         that is common to a run and its reference is not seen here; [REPORT.md](../../verify/REPORT.md) compares with another \
         implementation.\n\
         * A run of more than {STEPS} steps is given up and not judged. After {GIVEN_UP} of them in a row a method is not asked \
         for still tighter accuracies of that scene.\n\n",
        si(LOOSE_HORIZON, "s"),
        si(GOOD, "m"),
    );
    out += "## Motions that do not amplify errors\n\nRuns with a ratio of at most 1; the largest ratio (its scene).\n\n";
    out += &table(|m, p| tallied(&calm, |j| j.ratio, m, p).cell());
    out += "\n## Motions that amplify errors\n\nThe same with ratios divided by the amplification.\n\n";
    out += &table(|m, p| tallied(&loud, Judged::divided, m, p).cell());
    out += "\nThe same with the ratios as they are.\n\n";
    out += &table(|m, p| tallied(&loud, |j| j.ratio, m, p).cell());
    out += &advice(entries);
    out += &largest(&all);
    out += &steps(entries);
    out += &not_judged(entries);
    out += &warnings(entries);
    out += &every(entries);
    Ok(out)
}

/// How P is chosen for a motion that amplifies errors.
fn advice(entries: &[GuaranteeEntry]) -> String {
    let mut out = format!(
        "\n## How to choose P for a motion that amplifies errors\n\n\
         Run your scene with P and with P/10. The largest difference of positions between the two runs is about the error of the \
         first, as long as it is far below the clearances. Reduce P until this difference is small enough.\n\n\
         An error over the amplification is a safe P, and often a much smaller one than necessary. The table has P for an error of \
         {}, with Dormand and Prince's method.\n\n\
         | scene | amplification | asked: P | error achieved | error over {} | floor of the reference | steps |\n\
         |---|---|---|---|---|---|---|\n",
        si(GOAL, "m"),
        si(GOAL, "m"),
    );
    for entry in entries {
        let (Some(asked), Some(amplification)) = (&entry.advised, entry.facts.amplification) else {
            continue;
        };
        let [_, floor] = entry.facts.reference.unwrap_or([f64::NAN; 2]);
        let (error, ratio) = match &asked.end {
            RunEnd::Complete(Some(error)) if floor <= 0.1 * GOAL => {
                let below = if *error < floor {
                    "below the floor: "
                } else {
                    ""
                };
                (format!("{below}{}", si(*error, "m")), digits(error / GOAL))
            }
            RunEnd::Complete(_) => ("no reference good enough".to_owned(), "–".to_owned()),
            other => (ending(other), "–".to_owned()),
        };
        out += &format!(
            "| {} | {} | {} | {error} | {ratio} | {} | {} |\n",
            entry.scene,
            digits(amplification),
            si(asked.position, "m"),
            si(floor, "m"),
            asked.steps,
        );
    }
    out
}

fn ending(end: &RunEnd) -> String {
    match end {
        RunEnd::Complete(_) => "no reference".to_owned(),
        RunEnd::Stopped(_) => "stopped".to_owned(),
        RunEnd::TooLong => format!("> {STEPS} steps"),
        RunEnd::Skipped => "not asked".to_owned(),
    }
}

fn largest(all: &[Judged]) -> String {
    let mut sorted: Vec<&Judged> = all.iter().collect();
    sorted.sort_by(|a, b| b.ratio.total_cmp(&a.ratio));
    let mut out = String::from(
        "\n## The largest ratios\n\n| ratio | amplification | ratio / amplification | scene | method | P | steps | warnings of the \
         run |\n|---|---|---|---|---|---|---|---|\n",
    );
    for one in sorted.into_iter().take(LISTED) {
        let warnings = match one.run.warnings.as_slice() {
            [] => "none".to_owned(),
            some => some.join("; "),
        };
        out += &format!(
            "| {} | {} | {} | {} | {} | {} | {} | {warnings} |\n",
            digits(one.ratio),
            amplification(one.entry),
            digits(one.divided()),
            one.entry.scene,
            one.entry.method,
            si(one.run.position, "m"),
            one.run.steps,
        );
    }
    out
}

fn amplification(entry: &GuaranteeEntry) -> String {
    entry
        .facts
        .amplification
        .map_or("not measured".to_owned(), digits)
}

fn steps(entries: &[GuaranteeEntry]) -> String {
    let mut out = String::new();
    let (mut pairs, mut count) = (0, 0);
    for entry in entries {
        let complete = entry
            .runs
            .iter()
            .filter(|r| matches!(r.end, RunEnd::Complete(_)))
            .count();
        pairs += complete.saturating_sub(1);
        for (looser, tighter, factor) in dearer(entry) {
            count += 1;
            let _ = writeln!(
                out,
                "* {}, {}: {} takes {} times the steps of {}",
                entry.scene,
                entry.method,
                si(looser, "m"),
                digits(factor),
                si(tighter, "m")
            );
        }
    }
    format!(
        "\n## Does a looser accuracy cost less?\n\nOf {pairs} pairs of accuracies next to each other, the looser one takes more \
         than {MORE_STEPS} times the steps of the tighter one in {count}.\n\n{out}"
    )
}

fn not_judged(entries: &[GuaranteeEntry]) -> String {
    let runs = || {
        entries
            .iter()
            .flat_map(|entry| entry.runs.iter().map(move |r| (entry, r)))
    };
    let count =
        |wanted: fn(&GuaranteeEntry, &Asked) -> bool| runs().filter(|(e, r)| wanted(e, r)).count();
    let stopped = runs().filter_map(|(e, r)| match &r.end {
        RunEnd::Stopped(message) => Some((message.as_str(), run(e, r))),
        _ => None,
    });
    let mut out = format!(
        "\n## Runs that are not judged\n\n\
         * At the end, without a reference that is good enough: {}.\n\
         * Given up after {STEPS} steps: {}; not asked for after them: {}.\n\
         * Stopped with an error (exit status 3 of the program, or 2 before the first step): {}.\n\nThe errors:\n\n",
        count(|e, r| matches!(r.end, RunEnd::Complete(_)) && e.ratio(r).is_none()),
        count(|_, r| r.end == RunEnd::TooLong),
        count(|_, r| r.end == RunEnd::Skipped),
        count(|_, r| matches!(r.end, RunEnd::Stopped(_))),
    );
    out += &list(stopped, "No run stopped.");
    // what follows a semicolon names the constraint, the part before it the reason
    let reason = |message: &str| message.split(';').next().unwrap_or_default().to_owned();
    let mut refused: BTreeMap<String, Vec<&str>> = BTreeMap::new();
    for entry in entries {
        if let Some(message) = &entry.refused {
            let scenes = refused.entry(reason(message)).or_default();
            scenes.push(&entry.scene);
        }
    }
    out += "\nScenes that a method does not take:\n\n";
    for (reason, scenes) in refused {
        out += &format!(
            "* {reason}, {} scenes: {}\n",
            scenes.len(),
            scenes.join(", ")
        );
    }
    out
}

fn warnings(entries: &[GuaranteeEntry]) -> String {
    let runs = entries
        .iter()
        .flat_map(|e| e.runs.iter().chain(&e.advised).map(move |r| (e, r)));
    let all = runs.flat_map(|(e, r)| r.warnings.iter().map(move |w| (w.as_str(), run(e, r))));
    format!(
        "\n## What the runs warn of\n\n{}",
        list(all, "No run warns.")
    )
}

/// Every ratio.
fn every(entries: &[GuaranteeEntry]) -> String {
    let mut out = String::from(
        "\n## Every run\n\nError achieved over accuracy asked for. In brackets: the floor of the reference is above a tenth of the \
         accuracy, so that the ratio is not judged.\n\n| scene | H | floor | amplification | method |",
    );
    ACCURACIES
        .iter()
        .for_each(|p| out += &format!(" {} |", si(*p, "m")));
    out += &format!(
        "\n|---|---|---|---|---|{}\n",
        "---|".repeat(ACCURACIES.len())
    );
    for entry in entries.iter().filter(|e| e.refused.is_none()) {
        let cells = entry.runs.iter().map(|r| match (&r.end, entry.ratio(r)) {
            (_, Some(ratio)) => digits(ratio),
            (RunEnd::Complete(Some(error)), None) => format!("({})", digits(error / r.position)),
            (end, _) => ending(end),
        });
        let cells: Vec<String> = cells.collect();
        let floor = entry
            .facts
            .reference
            .map_or("none".to_owned(), |[_, floor]| si(floor, "m"));
        out += &format!(
            "| {} | {} | {floor} | {} | {} | {} |\n",
            entry.scene,
            si(entry.facts.horizon, "s"),
            amplification(entry),
            entry.method,
            cells.join(" | ")
        );
    }
    out
}

/// One panel a method.
fn figure(entries: &[GuaranteeEntry]) -> Figure {
    let all = judged(entries);
    let panels = METHODS.iter().map(|(name, _)| {
        let dots = |color, amplifies: bool| {
            let runs = all
                .iter()
                .filter(|j| j.entry.method == *name && j.entry.facts.amplifies() == amplifies);
            let (x, y): (Vec<f64>, Vec<f64>) = runs.map(|j| (j.run.position, j.ratio)).unzip();
            Mark::points("", color, &x, &y, 5)
        };
        Panel {
            title: (*name).to_owned(),
            note: String::new(),
            x: Axis::new("accuracy asked for", "m", 1.0)
                .log()
                .over(3e-10, 3e-3),
            y: Axis::new("error achieved / asked for", "", 1.0)
                .log()
                .over(1e-6, 1e5),
            marks: vec![
                Mark::level("", palette::BLACK, 1.0),
                dots(palette::BLUE, false),
                dots(palette::VERMILION, true),
            ],
        }
    });
    let caption = format!(
        "Error achieved over accuracy asked for, a dot a run of a dynamic scene. Blue: the motion amplifies errors less than \
         {AMPLIFIES} times; red: more. Dashed: ratio 1. Ratios below 10⁻⁶ are not shown."
    );
    Figure::grid(panels.collect(), 4, caption)
}

/// Writes figure and page.
///
/// # Errors
/// A file that cannot be written.
pub fn write(entries: &[GuaranteeEntry]) -> Result<()> {
    let folder = records::root().join("pages/accuracy");
    plot::save(&figure(entries), &folder.join("figures"), "guarantee")?;
    let path = folder.join("GUARANTEE.md");
    std::fs::write(&path, page(entries)?)
        .into_diagnostic()
        .wrap_err_with(|| format!("cannot write {}", path.display()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::guarantee::Facts;

    fn entry(amplification: f64, floor: f64, runs: Vec<(f64, RunEnd, u64)>) -> GuaranteeEntry {
        let run = |(position, end, steps)| Asked {
            position,
            end,
            steps,
            warnings: Vec::new(),
        };
        GuaranteeEntry {
            scene: "s".to_owned(),
            method: "bathe".to_owned(),
            facts: Facts {
                horizon: 1.0,
                reference: Some([1e-11, floor]),
                amplification: Some(amplification),
            },
            refused: None,
            runs: runs.into_iter().map(run).collect(),
            advised: None,
        }
    }

    #[test]
    fn runs_are_judged_where_the_reference_is_good_enough_and_failures_are_counted_as_such() {
        let runs = vec![
            (1e-3, RunEnd::Complete(Some(5e-4)), 120),
            (1e-4, RunEnd::Complete(Some(4e-4)), 100),
            (1e-5, RunEnd::Stopped("at t = 1 s".to_owned()), 50),
            (1e-6, RunEnd::TooLong, 9),
            (1e-9, RunEnd::Complete(Some(1e-9)), 400),
        ];
        let one = [entry(1.0, 1e-8, runs)];
        let all = judged(&one);
        let tally = RatioTally::of(all.iter().map(|j| (j.ratio, "s")));
        assert_eq!((tally.runs, tally.within), (2, 1));
        assert!(
            (tally.largest - 4.0).abs() < 1e-12,
            "4e-4 over 1e-4, but for rounding"
        );
        assert!(tally.reported().contains("not met"));
        assert_eq!(dearer(&one[0]).len(), 1, "1e-3 takes more steps than 1e-4");
        let text = not_judged(&one);
        assert!(text.contains("reference that is good enough: 1."));
        assert!(text.contains("first step): 1.") && text.contains("at t = 1 s"));
    }

    #[test]
    fn equal_runs_count_once_and_prescribed_motions_do_not() {
        let same = |position| (position, RunEnd::Complete(Some(2e-6)), 100);
        let tighter = (1e-6, RunEnd::Complete(Some(1e-7)), 300);
        let runs = vec![same(1e-4), same(1e-5), tighter];
        let one = [entry(1.0, 1e-9, runs.clone())];
        let positions: Vec<f64> = judged(&one).iter().map(|j| j.run.position).collect();
        assert_eq!(positions, [1e-5, 1e-6]);
        assert!(judged(&[entry(0.0, 1e-9, runs)]).is_empty());
    }

    #[test]
    fn an_error_that_is_no_number_is_the_largest_and_not_within() {
        let tally = RatioTally::of([(0.5, "a"), (f64::NAN, "b"), (0.7, "c")].into_iter());
        assert_eq!(
            (tally.runs, tally.within, tally.scene.as_str()),
            (3, 2, "b")
        );
    }

    #[test]
    fn ratios_of_motions_that_amplify_are_divided() {
        let one = [entry(
            50.0,
            1e-12,
            vec![(1e-6, RunEnd::Complete(Some(1e-5)), 1)],
        )];
        let all = judged(&one);
        assert!(
            (all[0].divided() - 0.2).abs() < 1e-12,
            "1e-5/1e-6/50, but for rounding"
        );
        assert!(one[0].facts.amplifies());
    }

    #[test]
    fn messages_that_differ_in_numbers_are_one() {
        let messages = ["lost 1e-3 J of a.x", "lost 2e-3 J of b.y", "gained 1 J"];
        let kinds = kinds(messages.into_iter().zip(["a", "b", "c"].map(String::from)));
        let counts: Vec<usize> = kinds.iter().map(|(count, ..)| *count).collect();
        assert_eq!(counts, [1, 2]);
    }
}

//! Whether accuracies are reached, in numbers: the section of ACCURACY.md, its picture and the tables of all runs.

use crate::accuracy::amplification::NEIGHBOURS;
use crate::accuracy::guarantee::{
    ACCURACIES, AMPLIFIES, Asked, GOOD, GuaranteeEntry, LOOSE_HORIZON, MISS, REFERENCE_STEPS, ROWS,
    RunEnd, SPECTRAL_RADIUS, STEPS, methods,
};
use minijinja::{Value, context};
use numbers::{digits, percent, si};
use plot::{Axis, Figure, Mark, Panel, palette};

/// A run that is judged.
struct Judged<'a> {
    entry: &'a GuaranteeEntry,
    run: &'a Asked,
    /// Error achieved over accuracy asked for.
    ratio: f64,
}

impl Judged<'_> {
    fn context(&self) -> Value {
        context! {
            scene => self.entry.scene, method => self.entry.method, position => si(self.run.position, "m"),
            ratio => digits(self.ratio), amplification => amplification(self.entry), steps => self.run.steps,
            warnings => self.run.warnings,
        }
    }
}

/// The runs that are judged. Runs of a motion that is prescribed altogether have nothing to integrate, and those whose steps
/// the clearance or the interval of the rows limits are one run for several accuracies: the tightest of these counts.
fn judged(entries: &[GuaranteeEntry]) -> Vec<Judged<'_>> {
    let is_same = |one: &Asked, other: &Asked| match (&one.end, &other.end) {
        (RunEnd::Complete(a), RunEnd::Complete(b)) => a == b && one.steps == other.steps,
        _ => false,
    };
    let moves = entries
        .iter()
        .filter(|entry| entry.facts.amplification != Some(0.0));
    let runs = moves.flat_map(|entry| {
        let tighter = entry.runs.iter().skip(1).map(Some).chain([None]);
        let runs = entry.runs.iter().zip(tighter);
        let last = runs.filter(move |(run, next)| !next.is_some_and(|next| is_same(run, next)));
        last.map(move |(run, _)| (entry, run))
    });
    runs.filter_map(|(entry, run)| {
        let ratio = entry.ratio(run)?;
        Some(Judged { entry, run, ratio })
    })
    .collect()
}

/// One panel a method.
pub fn figure(entries: &[GuaranteeEntry]) -> Figure {
    let all = judged(entries);
    let panels = methods().into_iter().enumerate().map(|(k, method)| {
        let dots = |label: &str, color, amplifies: bool| {
            let own = all.iter().filter(|j| j.entry.method == method);
            let own = own.filter(|j| j.entry.facts.amplifies() == amplifies);
            let (x, y): (Vec<f64>, Vec<f64>) = own.map(|j| (j.run.position, j.ratio)).unzip();
            Mark::points(if k == 0 { label } else { "" }, color, &x, &y, 5)
        };
        Panel {
            title: method.to_owned(),
            note: String::new(),
            x: Axis::new("Accuracy", "m", 1.0).log().over(3e-10, 3e-3),
            y: Axis::new("Error / accuracy", "", 1.0).log().over(1e-6, 1e5),
            marks: vec![
                Mark::level("", palette::BLACK, 1.0),
                dots(&format!("< {AMPLIFIES} times"), palette::BLUE, false),
                dots(&format!("≥ {AMPLIFIES} times"), palette::VERMILION, true),
            ],
        }
    });
    let caption = "Error achieved over accuracy asked for, a dot a run of a dynamic scene; colours: how many times the motion amplifies \
                   errors. Dashed: as asked for. Ratios below 10⁻⁶ are not shown.";
    Figure::grid(panels.collect(), 4, caption.to_owned())
}

/// How many runs there are, reach their accuracy, miss it more than threefold, and miss it without a warning of an error; the largest
/// ratio and its scene.
fn tally<'a>(runs: impl Iterator<Item = &'a Judged<'a>>) -> Value {
    let runs: Vec<&Judged> = runs.collect();
    let within = runs.iter().filter(|j| j.ratio <= 1.0).count();
    let missed: Vec<_> = runs.iter().filter(|j| j.ratio > MISS).collect();
    let silent = missed.iter().filter(|j| j.run.warnings.is_empty());
    let largest = runs.iter().max_by(|a, b| a.ratio.total_cmp(&b.ratio));
    context! {
        runs => runs.len(), within, missed => missed.len(), silent => silent.count(),
        share => percent(within as f64 / runs.len().max(1) as f64),
        largest => largest.map(|j| digits(j.ratio)), scene => largest.map(|j| &j.entry.scene),
    }
}

fn amplification(entry: &GuaranteeEntry) -> String {
    let known = entry.facts.amplification;
    known.map_or("not measured".to_owned(), digits)
}

/// What the pages say.
pub fn context(entries: &[GuaranteeEntry], stamp: String) -> Value {
    let all = judged(entries);
    let of_kind = |amplifies: bool| {
        all.iter()
            .filter(move |j| j.entry.facts.amplifies() == amplifies)
    };
    let rows = methods().into_iter().map(|method| {
        let own = |amplifies| of_kind(amplifies).filter(move |j| j.entry.method == method);
        context! { method, calm => tally(own(false)), loud => tally(own(true)) }
    });
    let mut misses: Vec<&Judged> = all.iter().filter(|j| j.ratio > MISS).collect();
    misses.sort_by(|a, b| b.ratio.total_cmp(&a.ratio));
    let runs = || {
        entries
            .iter()
            .flat_map(|entry| entry.runs.iter().map(move |run| (entry, run)))
    };
    let count =
        |wanted: fn(&GuaranteeEntry, &Asked) -> bool| runs().filter(|(e, r)| wanted(e, r)).count();
    let stopped = runs().filter_map(|(entry, run)| match &run.end {
        RunEnd::Stopped(said) => {
            let position = si(run.position, "m");
            Some(context! { scene => entry.scene, method => entry.method, position, said })
        }
        _ => None,
    });
    let mut scenes: Vec<&str> = entries.iter().map(|entry| entry.scene.as_str()).collect();
    scenes.dedup();
    let [others, loose] = NEIGHBOURS;
    context! {
        stamp, others, loose, scenes => scenes.len(), methods => methods().len(),
        accuracies => ACCURACIES.map(|p| si(p, "m")), radius => SPECTRAL_RADIUS,
        judged => all.len(), amplifies => digits(AMPLIFIES), most_steps => STEPS, recorded => ROWS,
        horizon => si(LOOSE_HORIZON, "s"), good => si(GOOD, "m"), reference_steps => digits(REFERENCE_STEPS as f64),
        miss => digits(MISS),
        calm => tally(of_kind(false)), loud => tally(of_kind(true)),
        unexcused => unexcused(&misses),
        misses => misses.iter().map(|j| j.context()).collect::<Vec<_>>(),
        by_method => rows.collect::<Vec<_>>(),
        refused => entries.iter().filter(|e| e.refused.is_some()).count(),
        given_up => count(|_, run| run.end == RunEnd::TooLong),
        skipped => count(|_, run| run.end == RunEnd::Skipped),
        unjudged => count(|e, run| matches!(run.end, RunEnd::Complete(_)) && e.ratio(run).is_none()),
        stopped => stopped.collect::<Vec<_>>(),
        stopped_pairs => stopped_pairs(entries),
        rows => entries.iter().map(row).collect::<Vec<_>>(),
    }
}

/// Scenes and methods that have stopped, with the number of their accuracies.
fn stopped_pairs(entries: &[GuaranteeEntry]) -> Vec<String> {
    let pairs = entries.iter().filter_map(|entry| {
        let stopped = |run: &&Asked| matches!(run.end, RunEnd::Stopped(_));
        let count = entry.runs.iter().filter(stopped).count();
        (count > 0).then(|| format!("{} by {}: {count}", entry.scene, entry.method))
    });
    pairs.collect()
}

/// Scenes and methods of the misses whose motions do not amplify errors; of misses in falling order the first of each is its worst.
fn unexcused(misses: &[&Judged]) -> Vec<String> {
    let mut worst: Vec<(&Judged, usize)> = Vec::new();
    for miss in misses.iter().filter(|j| !j.entry.facts.amplifies()) {
        let mut known = worst.iter_mut();
        match known.find(|(other, _)| std::ptr::eq(other.entry, miss.entry)) {
            Some((_, count)) => *count += 1,
            None => worst.push((miss, 1)),
        }
    }
    let said = worst
        .into_iter()
        .map(|(Judged { entry, ratio, .. }, count)| {
            let runs = if count == 1 { "run" } else { "runs" };
            let (scene, method, most) = (&entry.scene, &entry.method, digits(*ratio));
            format!("{scene} by {method} ({count} {runs}, up to {most} times)")
        });
    said.collect()
}

fn row(entry: &GuaranteeEntry) -> Value {
    context! {
        scene => entry.scene, method => entry.method, refused => entry.refused,
        horizon => si(entry.facts.horizon, "s"), amplification => amplification(entry),
        floor => entry.facts.reference.map(|[_, floor]| si(floor, "m")),
        cells => entry.runs.iter().map(|run| cell(entry, run)).collect::<Vec<_>>(),
    }
}

/// Ratio and steps of a run, in brackets where it is not judged, or how it ended.
fn cell(entry: &GuaranteeEntry, run: &Asked) -> String {
    match (&run.end, entry.ratio(run)) {
        (_, Some(ratio)) => format!("{}; {}", digits(ratio), run.steps),
        (RunEnd::Complete(Some(error)), None) => {
            format!("({}; {})", digits(error / run.position), run.steps)
        }
        (RunEnd::Complete(None), None) => format!("no reference; {}", run.steps),
        (RunEnd::Stopped(_), None) => "stopped".to_owned(),
        (RunEnd::TooLong, None) => format!("> {STEPS} steps"),
        (RunEnd::Skipped, None) => "not asked".to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::{context, judged};
    use crate::accuracy::guarantee::{Asked, Facts, GuaranteeEntry, RunEnd};
    use serde_json::{Value, to_value};

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
        }
    }

    fn said(entry: GuaranteeEntry) -> Value {
        to_value(context(&[entry], String::new())).unwrap()
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
        let said = said(entry(1.0, 1e-8, runs));
        let calm = &said["calm"];
        assert_eq!((&calm["runs"], &calm["within"]), (&2.into(), &1.into()));
        assert_eq!(
            (&calm["missed"], &calm["largest"]),
            (&1.into(), &"4".into())
        );
        assert_eq!(
            (&said["unjudged"], &said["given_up"]),
            (&1.into(), &1.into())
        );
        assert_eq!(said["stopped"][0]["said"], "at t = 1 s");
        assert_eq!(said["misses"][0]["steps"], 100);
        assert_eq!(said["unexcused"][0], "s by bathe (1 run, up to 4 times)");
    }

    #[test]
    fn a_miss_is_more_than_three_times_the_accuracy() {
        let runs = [3.1e-6, 2.9e-6].map(|error| (1e-6, RunEnd::Complete(Some(error)), 1));
        let said = said(entry(50.0, 1e-12, runs.to_vec()));
        assert_eq!(said["misses"].as_array().map(Vec::len), Some(1));
        assert_eq!(said["unexcused"].as_array().map(Vec::len), Some(0));
    }

    #[test]
    fn misses_without_a_warning_are_counted() {
        let runs = [4e-6, 5e-6].map(|error| (1e-6, RunEnd::Complete(Some(error)), 1));
        let mut one = entry(1.0, 1e-12, runs.to_vec());
        one.runs[1].position = 1e-7;
        one.runs[0].warnings.push("the integrator lost".to_owned());
        let calm = &said(one)["calm"];
        assert_eq!((&calm["missed"], &calm["silent"]), (&2.into(), &1.into()));
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
    fn motions_that_amplify_are_told_apart() {
        let run = (1e-6, RunEnd::Complete(Some(1e-5)), 9);
        let said = said(entry(50.0, 1e-12, vec![run]));
        assert_eq!(said["loud"]["missed"], 1);
        assert_eq!(said["calm"]["runs"], 0);
    }

    #[test]
    fn pairs_that_stopped_are_named() {
        let stopped = || RunEnd::Stopped("at t = 1 s".to_owned());
        let said = said(entry(
            1.0,
            1e-8,
            vec![(1e-3, stopped(), 1), (1e-4, stopped(), 1)],
        ));
        assert_eq!(said["stopped_pairs"][0], "s by bathe: 2");
    }
}

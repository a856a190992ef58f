//! ACCURACY.md: what it says of the studies, and the tables with all of their runs. Only times of runs that were made count.

use crate::accuracy::diagram::work_and_precision;
use crate::accuracy::guarantee::GuaranteeEntry;
use crate::accuracy::{Accuracy, MadeStudy, guarantee_page, study};
use crate::gallery::caption_of;
use crate::output::{Data, Output, stamp};
use miette::Result;
use minijinja::{Value, context};
use numbers::{digits, percent, si};
use studies::machine::median;
use studies::precision::{
    Compared, CurveTime, MotionReference, RunStatistics, StatisticsReference, StudyPace, Times,
};

/// A study of errors of motion.
pub(crate) type Motion = MadeStudy<MotionReference>;

/// Errors of position at which methods are compared \[m\].
const LEVELS: [f64; 5] = [1e-6, 1e-7, 1e-8, 1e-9, 1e-10];
/// The error at which explicit and implicit methods are compared \[m\].
const LEVEL: f64 = 1e-9;
/// The scheme of the paper, as its curves are called.
pub const PAPER: &str = "Bathe";
/// The choice.
pub const AUTOMATIC: &str = "auto, error controlled";
/// The schemes among which it chooses.
const CANDIDATES: [&str; 4] = [
    "ESDIRK of order 5, error controlled",
    "Dormand-Prince, error controlled",
    "DOP853, error controlled",
    "ESDIRK of order 3, error controlled",
];
const EXPLICIT: [&str; 3] = ["Dormand-Prince", "DOP853", "velocity Verlet"];

/// The curve that comes below an error first, to stay there, among those whose names are accepted.
pub(super) fn winner(
    one: &Motion,
    error: f64,
    times: Times,
    accept: impl Fn(&str) -> bool,
) -> Option<(&str, CurveTime)> {
    let curves = one.found.curves().into_iter().filter(|c| accept(c));
    let times = curves.filter_map(|c| Some((c, one.found.time_at(c, error, times)?)));
    times.min_by(|a, b| a.1.seconds.total_cmp(&b.1.seconds))
}

/// The fastest curves with the numbers of studies and errors in which they are the fastest, most of them first.
pub(super) fn winners<'a>(studies: &[&'a Motion]) -> Vec<(&'a str, usize)> {
    let mut wins: Vec<(&str, usize)> = Vec::new();
    for (one, error) in cells(studies) {
        let found = winner(one, error, Times::Measured, |_| true);
        let Some((curve, _)) = found else { continue };
        match wins.iter_mut().find(|w| w.0 == curve) {
            Some(win) => win.1 += 1,
            None => wins.push((curve, 1)),
        }
    }
    wins.sort_by_key(|w| std::cmp::Reverse(w.1));
    wins
}

/// Every study with every error.
fn cells<'a>(studies: &[&'a Motion]) -> impl Iterator<Item = (&'a Motion, f64)> {
    let pairs = studies
        .iter()
        .flat_map(|one| LEVELS.map(|error| (*one, error)));
    pairs.collect::<Vec<_>>().into_iter()
}

/// Median, ends and number of ratios, and where the largest is.
fn spread(ratios: &[(f64, String)]) -> Value {
    let values: Vec<f64> = ratios.iter().map(|r| r.0).collect();
    let least = ratios.iter().min_by(|a, b| a.0.total_cmp(&b.0));
    let most = ratios.iter().max_by(|a, b| a.0.total_cmp(&b.0));
    let (Some(least), Some(most)) = (least, most) else {
        return context! { count => 0 };
    };
    context! {
        count => ratios.len(), median => digits(median(&values)), least => digits(least.0),
        most => digits(most.0), at => most.1,
        near => values.iter().filter(|ratio| **ratio <= 1.5).count(),
    }
}

/// ACCURACY.md, its pictures, and the tables of all runs.
///
/// # Errors
/// A record or a study that is missing.
pub fn render(data: &Data, out: &mut Output) -> Result<()> {
    let record = data.read::<Accuracy>("accuracy")?;
    let guarantee = data.read::<Vec<GuaranteeEntry>>("guarantee")?;
    let found = record.results;
    let effects = found.effects;
    let studies: Vec<Motion> = found.studies.into_iter().map(MadeStudy::restored).collect();
    let surveys = found.surveys.into_iter().map(MadeStudy::restored);
    let surveys: Vec<MadeStudy<StatisticsReference>> = surveys.collect();
    let durations = surveys
        .iter()
        .map(|s| Ok(study(data.root(), &s.name)?.duration));
    let durations = durations.collect::<Result<Vec<f64>>>()?;
    let surveyed: Vec<_> = surveys.iter().zip(durations).collect();
    let (mut methods, mut tables) = (Vec::new(), Vec::new());
    for one in &studies {
        let asked = study(data.root(), &one.name)?;
        tables.push(table(one, MotionReference::table(&one.found, &asked)));
        match asked.compares_elements() {
            // a mesh is no method: curves are numbers of elements
            true => {
                let mut figure = MotionReference::figure(&one.found, &asked);
                figure.rows.truncate(1);
                out.picture("accuracy/elements", &figure)?;
            }
            false => methods.push(one),
        }
    }
    for one in &surveys {
        let asked = study(data.root(), &one.name)?;
        tables.push(table(one, StatisticsReference::table(&one.found, &asked)));
    }
    let (paper, others): (Vec<&Motion>, Vec<&Motion>) =
        methods.iter().partition(|one| one.name.starts_with("case"));
    out.picture("accuracy/3rrr", &work_and_precision(&paper))?;
    out.picture("accuracy/others", &work_and_precision(&others))?;
    let mut figure = effects.figure;
    figure.caption += &format!(" {}", caption_of(data.root(), "3rrr/case4")?);
    out.picture("accuracy/effects", &figure)?;
    out.picture(
        "accuracy/guarantee",
        &guarantee_page::figure(&guarantee.results),
    )?;
    let guarantee_of_all = guarantee_page::context(&guarantee.results, stamp(&guarantee.origin));
    let page = context! {
        stamp => stamp(&record.origin),
        levels => LEVELS.map(|e| si(e, "m")),
        level => si(LEVEL, "m"),
        lost => percent(LOST),
        runs => methods.iter().map(|one| one.found.runs.len()).sum::<usize>(),
        studies => methods.len(),
        wins => winners(&methods).iter().map(|(curve, count)| context! { curve, count }).collect::<Vec<_>>(),
        pairs => cells(&methods).filter(|(one, e)| winner(one, *e, Times::Measured, |_| true).is_some()).count(),
        paper => against(&methods, PAPER, |_| true),
        automatic => context! {
            candidates => against(&methods, AUTOMATIC, |curve| CANDIDATES.contains(&curve)),
            all => against(&methods, AUTOMATIC, |_| true),
        },
        explicit => explicit(&methods),
        long => surveyed.iter().map(|(one, duration)| long_run(one, *duration)).collect::<Vec<_>>(),
        fastest => methods.iter().map(|one| fastest(one)).collect::<Vec<_>>(),
        failed => studies.iter().flat_map(failures).collect::<Vec<_>>(),
        guarantee => guarantee_of_all, effect_warnings => &effects.warnings,
    };
    out.page("ACCURACY.md", "accuracy.md", &page)?;
    let tables = context! {
        stamp => stamp(&record.origin), tables, effects => effects.summary, warnings => effects.warnings,
    };
    out.site_page("studies.md", "site/studies.md", tables)?;
    out.site_page("guarantee.md", "site/guarantee.md", &page)
}

/// The studies of motions.
///
/// # Errors
/// A record that is missing.
pub(crate) fn motions(data: &Data) -> Result<Vec<Motion>> {
    let studies = data.read::<Accuracy>("accuracy")?.results.studies;
    Ok(studies.into_iter().map(MadeStudy::restored).collect())
}

fn table<C: Compared>(one: &MadeStudy<C>, table: String) -> Value {
    context! { name => one.name, title => one.found.title, table, warnings => one.found.warnings() }
}

/// The times of a curve over those of the fastest accepted one, over all studies and errors that it reaches.
fn against(studies: &[&Motion], curve: &str, accept: impl Fn(&str) -> bool) -> Value {
    let ratios = cells(studies).filter_map(|(one, error)| {
        let own = one.found.time_at(curve, error, Times::Measured)?;
        let (_, best) = winner(one, error, Times::Measured, &accept)?;
        let at = format!("{}, {}", one.name, si(error, "m"));
        Some((own.seconds / best.seconds, at))
    });
    spread(&ratios.collect::<Vec<_>>())
}

/// Times of the fastest explicit method over those of the fastest implicit one.
fn explicit(studies: &[&Motion]) -> Vec<Value> {
    let is_explicit = |curve: &str| EXPLICIT.iter().any(|name| curve.starts_with(name));
    let is_implicit = |curve: &str| !is_explicit(curve) && curve != AUTOMATIC;
    let ratio = |one: &&Motion| {
        let (_, explicit) = winner(one, LEVEL, Times::Measured, is_explicit)?;
        let (_, implicit) = winner(one, LEVEL, Times::Measured, is_implicit)?;
        let ratio = digits(explicit.seconds / implicit.seconds);
        Some(context! { study => one.name, ratio })
    };
    studies.iter().filter_map(ratio).collect()
}

/// Largest energy that the integrator of a sound run loses or gains, over that dissipated in contact: from this share on a run warns.
const LOST: f64 = 0.05;

/// How many runs are sound, they and all finer ones of their method, and the fastest of these.
fn long_run(one: &MadeStudy<StatisticsReference>, duration: f64) -> Value {
    let [coarse, exact] = &one.found.reference.runs;
    let mut good = Vec::new();
    for curve in one.found.curves() {
        let runs = one.found.runs.iter().zip(&one.found.timings);
        let own = runs.filter(|(run, _)| run.curve == curve).rev();
        good.extend(own.map_while(|(run, timing)| {
            let (found, _) = run.result.as_ref().ok()?;
            (found.loss().abs() < LOST).then_some((run, found, timing.as_ref()?.median))
        }));
    }
    good.sort_by(|a, b| a.2.total_cmp(&b.2));
    let cells = |found: &RunStatistics| {
        context! {
            motion => percent(found.deviation(exact)), contact => percent((found.contact - exact.contact).abs()),
            loss => percent(found.loss().abs()),
        }
    };
    let first = |accept: fn(StudyPace) -> bool| {
        let (run, found, time) = good.iter().find(|(run, ..)| accept(run.pace))?;
        let factor = digits(duration / time);
        let pace = run.pace.to_string();
        Some(context! { curve => run.curve, pace, factor, ..cells(found) })
    };
    context! {
        title => one.found.title, good => good.len(), runs => one.found.runs.len(), reference => cells(coarse),
        rows => [first(|_| true), first(|pace| matches!(pace, StudyPace::Step(_)))],
    }
}

/// The fastest method for every error, and what the scheme of the paper and the choice take there.
fn fastest(one: &Motion) -> Value {
    let cells = LEVELS.map(|error| {
        let (curve, time) = winner(one, error, Times::Measured, |_| true)?;
        let of = |name: &str| {
            let own = one.found.time_at(name, error, Times::Measured)?;
            Some(digits(own.seconds / time.seconds))
        };
        // an accuracy says it
        let curve = curve.trim_end_matches(", error controlled");
        let (pace, seconds) = (time.pace.to_string(), si(time.seconds, "s"));
        Some(context! { curve, pace, seconds, paper => of(PAPER), automatic => of(AUTOMATIC) })
    });
    context! { study => one.name, cells }
}

/// Runs that failed, with the first line of what they say.
fn failures(one: &Motion) -> Vec<String> {
    let failed = one.found.runs.iter().filter_map(|run| {
        let said = run.result.as_ref().err()?.lines().next()?;
        Some(format!("{}, {}, {}: {said}", one.name, run.curve, run.pace))
    });
    failed.collect()
}

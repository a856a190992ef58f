//! BENCHMARKS.md. Only times of runs that were made count.

use crate::accuracy::page::{AUTOMATIC, Motion, motions};
use crate::accuracy::study;
use crate::benchmarks::Measured;
use crate::benchmarks::family::Family;
use crate::benchmarks::figures::{self, sizes};
use crate::benchmarks::growth::{self, SizeCost, SizeOf, exponent};
use crate::benchmarks::rivals::{Code, RivalCurve, Rivals, STUDIES, best, is_known};
use crate::benchmarks::settings::{LONGEST, ORDERS, RATIOS, SettingsSweep, TOLERANCES};
use crate::benchmarks::standings::{LEVELS, Standing, TimeRatio};
use crate::output::{Data, Output, stamp};
use indexmap::IndexSet;
use miette::Result;
use minijinja::{Value, context};
use numbers::{digits, rounded, si};
use std::path::Path;
use studies::precision::Times;
use verify::ida_of_system::{NEWTON, POSITION};

/// BENCHMARKS.md, its pictures, and the tables of all times.
///
/// # Errors
/// A record or a study that is missing.
pub fn render(data: &Data, out: &mut Output) -> Result<()> {
    let record = data.read::<Measured>("benchmarks")?;
    let measured = &record.results;
    out.picture("benchmarks/growth", &figures::growth(measured))?;
    out.picture("benchmarks/rivals", &figures::rivals(measured))?;
    let steps = measured.steps.iter().map(|step| {
        let seconds = si(step.seconds, "s");
        context! { name => step.name, instructions => step.instructions, seconds }
    });
    let seconds = measured.steps.iter().map(|step| step.seconds);
    let [shortest, longest] = range(seconds).map(|t| si(t, "s"));
    let most = measured.sizes.iter().map(|cost| cost.bodies).max();
    let repeated = repeated(&measured.rivals, &motions(data)?);
    let scatter = [1, 9].map(|tenth| {
        let ratio = repeated.get(tenth * repeated.len() / 10);
        ratio.copied().unwrap_or(f64::NAN)
    });
    let [shorter, longer] = scatter.map(two_digits);
    let page = context! {
        stamp => stamp(&record.origin),
        steps => steps.collect::<Vec<_>>(), shortest, longest,
        most_bodies => most, decade => most.unwrap_or(0) / 10, growth_steps => growth::STEPS,
        largest => Family::ALL.iter().filter_map(|family| largest(measured, *family)).collect::<Vec<_>>(),
        exponents => exponents(measured),
        rivals => rivals(data.root(), &measured.rivals, scatter[1])?,
        repeated => context! { runs => repeated.len(), least => shorter, most => longer, inverse => two_digits(1.0 / scatter[1]) },
    };
    out.page("BENCHMARKS.md", "benchmarks.md", &page)?;
    out.site_page("rivals.md", "site/rivals.md", &page)
}

/// The least and the greatest.
fn range(values: impl Iterator<Item = f64> + Clone) -> [f64; 2] {
    [f64::min, f64::max].map(|of| values.clone().reduce(of).unwrap_or(f64::NAN))
}

/// The exponent of a cost of a kind, where it has been measured.
fn growth_of(measured: &Measured, family: Family, cost: &SizeOf) -> Option<f64> {
    let (bodies, costs) = sizes(measured, family, cost);
    (bodies.len() > 1).then(|| exponent(&bodies, &costs))
}

/// Costs of a mechanism: name, unit, value.
const COSTS: [(&str, &str, &SizeOf); 4] = [
    ("compilation", "s", &|cost| Some(cost.compile)),
    ("step", "s", &|cost| Some(cost.step)),
    ("instructions", "", &|cost| Some(cost.instructions? as f64)),
    ("memory", "B", &|cost| Some(cost.memory? as f64)),
];

/// Least and greatest exponent of every cost over the kinds of mechanism.
fn exponents(measured: &Measured) -> Vec<Value> {
    let exponents = COSTS.iter().map(|(name, _, cost)| {
        let all = Family::ALL
            .iter()
            .filter_map(|family| growth_of(measured, *family, cost));
        let [least, most] = range(all).map(digits);
        context! { name, least, most }
    });
    exponents.collect()
}

/// The largest mechanism of a kind: its costs, with the exponents of their growth.
fn largest(measured: &Measured, family: Family) -> Option<Value> {
    let own = measured.sizes.iter().filter(|cost| cost.family == family);
    let largest: &SizeCost = own.max_by_key(|cost| cost.bodies)?;
    let cells = COSTS.iter().map(|(_, unit, cost)| {
        let value = cost(largest)?;
        let exponent = growth_of(measured, family, cost).map(digits);
        let text = if unit.is_empty() {
            value.to_string()
        } else {
            si(value, unit)
        };
        Some(context! { text, exponent })
    });
    let cells: Vec<_> = cells.collect();
    Some(context! { name => family.name(), bodies => largest.bodies, cells })
}

/// Other codes; times that differ by less than the factor `scatter` do not tell which is faster.
fn rivals(root: &Path, rivals: &Rivals, scatter: f64) -> Result<Value> {
    let curves = &rivals.all_curves();
    let durations = STUDIES.iter().map(|name| {
        let duration = si(study(root, name)?.duration, "s");
        Ok(format!("{name} {duration}"))
    });
    // `auto` stands below the fastest of all methods
    let mut methods: Vec<Option<&str>> = vec![None, Some(AUTOMATIC)];
    for curve in curves {
        let method = Some(curve.method.as_str());
        if curve.code == Code::Looselink && !methods.contains(&method) {
            methods.push(method);
        }
    }
    let methods = methods.iter().map(|method| {
        let cells = Code::ALL[1..].iter().map(|rival| {
            let found = Standing::new(curves, *rival, *method);
            context! { rival => rival.name(), ..standing(&found, scatter) }
        });
        let name = method.unwrap_or("the fastest of all methods");
        context! { name, cells => cells.collect::<Vec<_>>() }
    });
    let solutions = rivals.solutions.iter().filter_map(|solution| {
        let difference = si(solution.difference_from_looselink?, "m");
        Some(context! { study => solution.study, method => solution.method, difference })
    });
    let exudyn_methods = curves.iter().filter(|c| c.code == Code::Exudyn);
    let exudyn_methods: IndexSet<&str> = exudyn_methods.map(|c| c.method.as_str()).collect();
    Ok(context! {
        exudyn => Code::Exudyn.name(), exudyn_methods, durations => durations.collect::<Result<Vec<_>>>()?.join(", "),
        loosest => si(POSITION * TOLERANCES[0], "m"), longest => si(LONGEST, "s"), newton => NEWTON, ratios => RATIOS, orders => ORDERS,
        errors => LEVELS.map(|error| si(error, "m")),
        methods => methods.collect::<Vec<_>>(),
        solutions => solutions.collect::<Vec<_>>(),
        times => times(curves),
        settings => rivals.sweeps.iter().map(settings).collect::<Vec<_>>(),
    })
}

/// A ratio of times, of which a third digit does not repeat.
fn two_digits(ratio: f64) -> String {
    digits(rounded(ratio, 2))
}

/// How times repeat: of every run of Looselink that the studies of accuracy have too its time over theirs, the least first.
fn repeated(rivals: &Rivals, studies: &[Motion]) -> Vec<f64> {
    let own = rivals.curves.iter().filter(|c| c.code == Code::Looselink);
    let points = own.flat_map(|curve| curve.points.iter().map(move |point| (curve, point)));
    let ratios = points.filter_map(|(curve, [error, seconds])| {
        let one = studies.iter().find(|one| one.name == curve.study)?;
        let other = one
            .found
            .runs
            .iter()
            .zip(&one.found.timings)
            .find(|(run, _)| {
                // records keep five digits
                let is_same = |other: f64| (other - error).abs() <= 1e-4 * error;
                run.curve == curve.method
                    && run
                        .result
                        .as_ref()
                        .is_ok_and(|r| is_same(r.errors.position))
            });
        Some(seconds / other?.1.as_ref()?.median)
    });
    let mut ratios: Vec<f64> = ratios.collect();
    ratios.sort_by(f64::total_cmp);
    ratios
}

/// How one of our methods stands against another code.
fn standing(standing: &Standing, scatter: f64) -> Value {
    let [ours, other] = standing.reached_alone;
    let summary = standing.summary().map(|summary| summary.map(two_digits));
    let most = range(standing.ratios.iter().map(|r| r.ratio))[1];
    let faster = standing.ratios.iter().filter(|r| r.ratio < 1.0);
    let faster = faster.map(|r| {
        let (error, ratio) = (si(r.error, "m"), two_digits(r.ratio));
        format!("{} at {error} ({ratio} times)", r.study)
    });
    let near = |r: &&TimeRatio| (1.0 / scatter..scatter).contains(&r.ratio);
    context! {
        near => standing.ratios.iter().filter(near).count(),
        pairs => standing.ratios.len(), ours, other,
        median => summary.as_ref().map(|s| &s[0]), least => summary.as_ref().map(|s| &s[1]),
        most => two_digits(most), faster => faster.collect::<Vec<_>>(),
    }
}

/// The fastest run of every code for every study and error.
fn times(curves: &[RivalCurve]) -> Vec<Value> {
    let pairs = STUDIES
        .iter()
        .flat_map(|study| LEVELS.map(|error| (study, error)));
    let rows = pairs.filter_map(|(study, error)| {
        let of = |code| best(curves, study, code, error, Times::Measured);
        let (_, own) = of(Code::Looselink)?;
        let cells = Code::ALL.map(|code| {
            let Some((method, seconds)) = of(code) else {
                let known = is_known(curves, study, code, error);
                return if known { "–" } else { "not known" }.to_owned();
            };
            let (time, ratio) = (si(seconds, "s"), digits(seconds / own));
            format!("{time} ({ratio}): {method}")
        });
        Some(context! { study, error => si(error, "m"), cells })
    });
    rows.collect()
}

/// The best settings of IDA in a study.
fn settings(sweep: &SettingsSweep) -> Value {
    let settings = sweep.settings();
    let solver = format!("{:?}", settings.linear_solver);
    let failures = sweep
        .tried
        .iter()
        .map(|tried| tried.failures.len())
        .sum::<usize>();
    context! {
        study => sweep.study, curve => sweep.curve, ratio => settings.ratio, newton => settings.newton, solver,
        tried => sweep.tried.len(), failures,
    }
}

//! The page of a sweep.

use super::design::DesignKind;
use super::merge::{Merged, Points};
use super::{EnsembleMean, Sweep};
use numbers::number;
use texts::markdown::{cell, code, text};

/// Starts have parted when their values differ by this part of the differences between points.
const PARTED: f64 = 0.01;
/// Runs without results that a page lists.
const LISTED: usize = 20;

/// Pictures, extremes, indices, faults and warnings in Markdown.
pub fn page(sweep: &Sweep, merged: &Merged, points: &Points) -> String {
    let title = text(&merged.title);
    let mut page = format!("# {title}\n\n![{title}](sweep.svg)\n\n");
    page += &format!("{} runs of {}", merged.runs, code(&merged.scene));
    let others = ["failed", "refused"].map(|name| (name, merged.status[name]));
    for (name, count) in others.iter().filter(|(_, count)| *count > 0) {
        page += &format!(", {count} {name}");
    }
    page += &format!(", {} with warnings.\n", merged.warned);
    if !merged.programs.is_empty() {
        let made = merged.programs.iter();
        let made = made.map(|(program, rows)| format!("{rows} by {program}"));
        page += &format!(
            "\nSeveral programs of version {} have made the rows, named by the first digits of their SHA-256: {}. Their digits may \
             differ.\n",
            merged.version,
            made.collect::<Vec<_>>().join(", ")
        );
    }
    if let Some(answer) = answer(sweep, merged) {
        page += &format!("\n{}\n", text(&answer));
    }
    page += "\n| measure | unit | least | at (least) | largest | at (largest) |\n| --- | --- | ---: | --- | ---: | --- |\n";
    for (name, extremes) in &merged.extremes {
        let unit = cell(merged.units.get(name).map_or("", String::as_str));
        let [(least, at_least), (largest, at_largest)] = [extremes.least, extremes.largest];
        let [least, largest] = [least, largest].map(|x| number(x, 4));
        let [at_least, at_largest] =
            [at_least, at_largest].map(|run| cell(&place(sweep, points, run)));
        let name = cell(name);
        page += &format!("| {name} | {unit} | {least} | {at_least} | {largest} | {at_largest} |\n");
    }
    if sweep.study.design == DesignKind::Sensitivity {
        let measures = sweep.study.measures.keys();
        for name in measures.filter(|name| !merged.indices.contains_key(*name)) {
            page += &format!(
                "\n{} has no Sobol indices: fewer than two samples have a value, or all values are equal.\n",
                code(name)
            );
        }
    }
    for (measure, indices) in &merged.indices {
        page += &format!(
            "\nShare of the variance of {} that each parameter explains alone, and in which it takes part (Sobol indices, \
             {} samples; in brackets the 95 % interval):\n\n| parameter | alone | takes part |\n| --- | ---: | ---: |\n",
            code(measure),
            indices.samples
        );
        for (name, of) in &indices.parameters {
            let [alone, total] = [of.first_order, of.total].map(|e| {
                // no minus in front of zero
                let [value, low, high] =
                    [e.value, e.low, e.high].map(|x| (x * 100.0).round() / 100.0 + 0.0);
                format!("{value:.2} ({low:.2} to {high:.2})")
            });
            page += &format!("| {} | {alone} | {total} |\n", cell(name));
        }
    }
    let (alike, all) = (alike_points(sweep, points), points.values.len());
    // at single points all starts may give the same value, such as contact all the time
    if 2 * alike > all {
        page += &format!(
            "\nAt {alike} of {all} points no measure depends on the start by more than {} % of its differences between points. If the \
             motion is chaotic, these starts have not parted, and the intervals are too short: take a larger `starts.velocity` or a \
             later `from`.\n",
            100.0 * PARTED
        );
    }
    if !points.faults.is_empty() {
        page += "\nRuns without results:\n\n";
        for (run, error) in points.faults.iter().take(LISTED) {
            page += &format!("* run {run}: {}\n", text(error));
        }
        if points.faults.len() > LISTED {
            page += &format!(
                "* and {} more, see `sweep.csv`\n",
                points.faults.len() - LISTED
            );
        }
    }
    if !points.warnings.is_empty() {
        page += "\nWarnings, each with the number of runs that have it and an example:\n\n";
        for (count, example) in points.warnings.values() {
            page += &format!("* {count}: {}\n", text(example));
        }
    }
    page
}

/// Number of points at which the values of no measure depend on the start; 0 in a sweep of a single start or without contacts.
fn alike_points(sweep: &Sweep, points: &Points) -> usize {
    if !points.contacts || sweep.study.starts_of_a_point() == 1 {
        return 0;
    }
    let limits = points.means.iter().map(|means| {
        let means: Vec<f64> = means.iter().flatten().map(|mean| mean.mean).collect();
        let between = EnsembleMean::of(&means).and_then(|all| all.deviation);
        PARTED * between.unwrap_or(0.0)
    });
    let limits: Vec<f64> = limits.collect();
    let is_alike = |point: &usize| {
        let mut measures = points.means.iter().zip(&limits);
        measures.all(|(means, limit)| {
            let deviation = means[*point].and_then(|mean| mean.deviation);
            deviation.is_some_and(|deviation| deviation < *limit)
        })
    };
    (0..points.values.len()).filter(is_alike).count()
}

/// A run and the values of the parameters there.
fn place(sweep: &Sweep, points: &Points, run: usize) -> String {
    let values = &points.values[run / sweep.study.starts_of_a_point()];
    let values = sweep.study.parameters.iter().zip(values);
    let values = values.map(|((name, parameter), value)| {
        let value = value.number().map_or(value.to_string(), |x| number(x, 4));
        let text = format!("{name} = {value} {}", parameter.unit);
        text.trim_end().to_owned()
    });
    let values = values.collect::<Vec<_>>().join(", ");
    format!("{values} (run {run})")
}

/// The answer of a bisection in words, or why it has none.
pub fn answer(sweep: &Sweep, merged: &Merged) -> Option<String> {
    if let Some(why) = &merged.no_answer {
        return Some(format!("The bisection has no answer: {why}."));
    }
    let crossing = merged.crossing.as_ref()?;
    let target = &crossing.target;
    let unit = &sweep.units()[sweep.study.measures.get_index_of(&target.measure)?];
    let unit = if unit == "1" {
        String::new()
    } else {
        format!(" {unit}")
    };
    let sides = crossing.between.iter().zip(&crossing.means);
    let sides = sides.zip(&crossing.half_widths);
    let sides = sides.map(|((value, mean), half)| {
        let value = value.number().map_or(value.to_string(), |x| number(x, 4));
        let half = half.map_or(String::new(), |half| format!(" ± {}", number(half, 2)));
        format!(
            "{value} {} ({}{half}{unit})",
            crossing.unit,
            number(*mean, 4)
        )
    });
    let sides = sides.collect::<Vec<_>>().join(" and ");
    let doubt = match crossing.is_certain() {
        _ if !crossing.monotone => {
            " The values at the points that were visited rise and fall: there may be several crossings, which a grid shows."
        }
        _ if crossing.half_widths == [None; 2] => {
            " Each mean is of a single start: where the motion is chaotic, use `starts`."
        }
        true => "",
        false => {
            " The interval of one of these means includes the target: more starts are needed to be sure."
        }
    };
    Some(format!(
        "`{}` reaches {}{unit} between `{}` = {sides}.{doubt}",
        target.measure,
        number(target.value, 4),
        crossing.parameter,
    ))
}

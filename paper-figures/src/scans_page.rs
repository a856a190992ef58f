//! What the page of the scans shows: one figure a scan, and the values of the template.

use crate::ensembles::{Ensemble, EnsembleRecord};
use crate::pictures::{CLAIMED, case_color};
use crate::runs::{DURATION, FROM};
use crate::scans::{Scan, ScanEntry};
use minijinja::{Value, context};
use plot::{Axis, Figure, Mark, Panel, palette};

/// The figure of a scan.
pub fn figure(scan: &Scan) -> Figure {
    let error = Axis::new("|eₓ|: largest, rms", "µm", 1e6).log();
    let acceleration = Axis::new("ẍ: peak, rms deviation", "m/s²", 1.0).log();
    let force = Axis::new("Force: peak, mean", "N", 1.0).log();
    let contact = Axis::new("Time in contact", "%", 100.0).over(0.0, 1.0);
    let quantities = ["acceleration_peak", "deviation_rms"];
    let panels = vec![
        panel(scan, "a) Displacement", error, ["error_peak", "error_rms"]),
        panel(scan, "b) Acceleration", acceleration, quantities),
        panel(scan, "c) Force in B1", force, ["force_peak", "force_mean"]),
        panel(scan, "d) Contact of B1", contact, ["contact_b1", ""]),
    ];
    let how = match scan.slug.as_str() {
        "step" => "Bathe's method, step sizes as given",
        _ => "Trapezoidal rule, requested accuracy 1 µm and 100 nJ over 10 ms",
    };
    let mut caption = format!(
        "{}. {how}; {FROM} s to {DURATION} s. Large dots and thick lines: first quantity of the axis; small dots and thin lines: \
         second quantity. Each dot of the chaotic cases 3 and 4 is one run.",
        scan.title,
    );
    if scan.slug == "reading" {
        let first = scan.entries[0].case;
        for entry in scan.entries.iter().filter(|e| e.case == first) {
            caption += &format!(" {}: {}.", entry.at, entry.label);
        }
    }
    let all = scan.entries.len();
    let failed = scan.entries.iter().filter(|e| e.values.is_none()).count();
    if failed > 0 {
        caption += &format!(" Failed runs, which have no dot: {failed} of {all}.");
    }
    Figure::grid(panels, 2, caption)
}

/// The main quantity and another, which may have no name.
fn panel(scan: &Scan, title: &str, y: Axis, [main, second]: [&str; 2]) -> Panel {
    let mut marks = Vec::new();
    for case in [2, 3, 4] {
        // marks of case 3 are larger, so that they show where those of case 4 lie on them
        let size = if case == 3 { 9 } else { 6 };
        let mut draw = |label: &str, name: &str, width, radius| {
            let entries = scan.entries.iter().filter(|e| e.case == case);
            let points = entries.filter_map(|e| Some((e.at, *e.values.as_ref()?.0.get(name)?)));
            let (x, y): (Vec<f64>, Vec<f64>) = points.unzip();
            if !x.is_empty() {
                // readings have no order, so no line joins them: only the legend entry is drawn
                let joined = if scan.slug == "reading" { 1 } else { x.len() };
                let line = Mark::curve(label, case_color(case), &x[..joined], &y[..joined]);
                marks.push(line.width(width));
                marks.push(Mark::points("", case_color(case), &x, &y, radius));
            }
        };
        draw(&format!("Case {case}"), main, 2 * size / 3, size + 2);
        draw("", second, size / 3, size - 2);
    }
    if main == "error_peak" {
        marks.push(Mark::level("paper: 200 µm", palette::BLACK, CLAIMED));
    }
    Panel {
        title: title.into(),
        note: String::new(),
        x: scan.axis.clone(),
        y,
        marks,
    }
}

/// The values of the template.
pub fn values(scans: &[Scan], record: &EnsembleRecord) -> Value {
    let scan = |scan: &Scan| {
        let near = |e: &&ScanEntry| {
            let values = e.values.as_ref();
            values.is_some_and(|v| (0.5..=2.0).contains(&(v.get("error_peak") / CLAIMED)))
        };
        let near = scan.entries.iter().filter(near);
        let near = near.map(|e| format!("{} (case {})", e.label, e.case));
        let near: Vec<String> = near.collect();
        context! { slug => scan.slug, title => scan.title, entries => scan.entries, near }
    };
    context! {
        scans => scans.iter().map(scan).collect::<Vec<_>>(),
        scatter => [3, 4].map(|case| scatter(record, case)),
        duration => DURATION, from => FROM,
    }
}

/// By how much two single runs of a case differ at the most with a probability of 95 %, over the mean, from all starts together:
/// t s sqrt(2), of which the half width of the mean is t s/sqrt(n).
fn scatter(record: &EnsembleRecord, case: u32) -> Value {
    let ensemble = Ensemble::together(&record.sizes(case));
    let runs = ensemble.values("error_peak").len();
    let limit = |name: &str| {
        let mean = ensemble.mean(name);
        mean.half * (2.0 * runs as f64).sqrt() / mean.mean.abs()
    };
    let error = ["error_peak", "error_rms"].map(limit);
    let other = ["deviation_rms", "force_peak", "contact_b1"].map(limit);
    context! { case, runs, limits => [&error[..], &other].concat() }
}

#[cfg(test)]
mod tests {
    #[test]
    fn failed_runs_are_counted_in_the_caption() {
        // runs that are not made have no values either
        for (scan, plans) in crate::scans::all().unwrap() {
            let (caption, n) = (super::figure(&scan).caption, plans.len());
            let counted = format!("which have no dot: {n} of {n}.");
            assert!(caption.contains(&counted), "{caption}");
        }
    }
}

//! Writes what the scans gave: one figure a scan and SCANS.md.

use crate::campaign::{DURATION, FROM};
use crate::fig05::CLAIMED;
use crate::figures::case_color;
use crate::interval::OF_THREE;
use crate::numbers::Numbers;
use crate::record::EnsembleRecord;
use crate::scans::{Scan, ScanEntry, Values};
use crate::warned::reported;
use numbers::{digits, percent, si};
use plot::{Axis, Color, Figure, Mark, Panel, palette};
use std::collections::BTreeSet;
use std::fmt::Write;

/// What a panel shows: title, axis, main and secondary value.
struct ScanQuantity {
    title: &'static str,
    label: &'static str,
    unit: &'static str,
    factor: f64,
    main: fn(&Values) -> Option<f64>,
    second: fn(&Values) -> Option<f64>,
}

const QUANTITIES: [ScanQuantity; 4] = [
    ScanQuantity {
        title: "Displacement error",
        label: "|eₓ|: largest, rms",
        unit: "mm",
        factor: 1e3,
        main: |v| Some(v.error_peak),
        second: |v| Some(v.error_rms),
    },
    ScanQuantity {
        title: "Acceleration",
        label: "ẍ: peak, rms deviation",
        unit: "m/s²",
        factor: 1.0,
        main: |v| Some(v.acceleration_peak),
        second: |v| Some(v.deviation_rms),
    },
    ScanQuantity {
        title: "Force in joint B1",
        label: "Force: peak, mean",
        unit: "N",
        factor: 1.0,
        main: |v| Some(v.force_peak),
        second: |v| Some(v.force_mean),
    },
    ScanQuantity {
        title: "Contact of joint B1",
        label: "Time in contact",
        unit: "%",
        factor: 100.0,
        main: |v| v.contact,
        second: |_| None,
    },
];

/// The figure of a scan.
pub fn figure(scan: &Scan) -> Figure {
    let panels: Vec<Panel> = QUANTITIES
        .iter()
        .zip(["a", "b", "c", "d"])
        .map(|(q, letter)| panel(scan, q, letter))
        .collect();
    let mut rows = panels.into_iter();
    let rows = vec![rows.by_ref().take(2).collect(), rows.collect()];
    let mut caption = format!(
        "{}. {}; {FROM} s to {DURATION} s. Large dots and thick lines: first quantity of the axis; small dots and thin lines: second quantity.",
        scan.title,
        how(scan)
    );
    if scan.slug == "reading" {
        let first = scan.entries[0].plan.case;
        for entry in scan.entries.iter().filter(|e| e.plan.case == first) {
            let _ = write!(caption, " {}: {}.", entry.at, entry.label);
        }
    }
    caption += &made_with(scan);
    let warned = scan.entries.iter().filter(|e| warns(e)).count();
    if warned > 0 {
        let _ = write!(
            caption,
            " Runs with warnings: {warned} of {}; see the table.",
            scan.entries.len()
        );
    }
    let failed = scan.entries.iter().filter(|e| e.outcome.is_err()).count();
    if failed > 0 {
        let _ = write!(
            caption,
            " Failed runs, which have no dot: {failed} of {}; see the table.",
            scan.entries.len()
        );
    }
    Figure { rows, caption }
}

/// Method and step of a scan.
fn how(scan: &Scan) -> String {
    if scan.slug == "step" {
        "Bathe's method, steps as given".into()
    } else {
        "Trapezoidal rule, requested accuracy 1 µm and 100 nJ over 10 ms".into()
    }
}

/// The scenes, and what a single run of a chaotic case is worth.
fn made_with(scan: &Scan) -> String {
    let scenes: BTreeSet<String> = scan.entries.iter().map(|e| e.plan.scene_name()).collect();
    let scenes: Vec<String> = scenes.into_iter().collect();
    format!(
        " Scenes: {}. Each dot of the chaotic cases 3 and 4 is one run.",
        scenes.join(", ")
    )
}

/// How far one run of a chaotic case scatters, from the ensembles of the record.
fn scatter(record: &EnsembleRecord) -> String {
    let mut text = format!(
        "No verdict of the reproduction rests on these single runs. By how much they scatter at the printed and assumed values \
         is known from the ensembles, {OF_THREE} runs a case that differ in the start by at most 1e-10 m. Two runs of the same \
         scene differ by less than these limits with a probability of 95 % (Student's t); a smaller difference between two \
         rows says nothing about the parameter. Elsewhere the scatter may be another.\n\n\
         | | largest \\|e_x\\| | rms e_x | rms a | peak F | B1 in contact |\n|---|---|---|---|---|---|\n"
    );
    for case in [3, 4] {
        let ensemble = record.together(case);
        let limit = |name: &str| percent(ensemble.mean(name).two_apart());
        let names = [
            "error_peak",
            "error_rms",
            "deviation_rms",
            "force_peak",
            "contact_b1",
        ];
        let cells = names.map(limit).join(" | ");
        let _ = writeln!(text, "| case {case}, of the mean | {cells} |");
    }
    text + "\n"
}

fn panel(scan: &Scan, quantity: &ScanQuantity, letter: &str) -> Panel {
    let mut marks = Vec::new();
    for case in [2, 3, 4] {
        let of = |read: fn(&Values) -> Option<f64>| -> (Vec<f64>, Vec<f64>) {
            let entries = scan.entries.iter().filter(|e| e.plan.case == case);
            entries
                .filter_map(|e| Some((e.at, read(e.outcome.as_ref().ok()?)?)))
                .unzip()
        };
        let (x, y) = of(quantity.main);
        if !x.is_empty() {
            marks.push(line(
                scan,
                &format!("Case {case}"),
                case_color(case),
                &x,
                &y,
                2 * size(case) / 3,
            ));
            marks.push(Mark::points("", case_color(case), &x, &y, size(case) + 2));
        }
        let (x, y) = of(quantity.second);
        if !x.is_empty() {
            marks.push(line(scan, "", case_color(case), &x, &y, size(case) / 3));
            marks.push(Mark::points("", case_color(case), &x, &y, size(case) - 2));
        }
    }
    let mut y = Axis::new(quantity.label, quantity.unit, quantity.factor);
    if quantity.unit == "%" {
        y = y.over(0.0, 1.0);
    } else {
        y = y.log();
    }
    if quantity.unit == "mm" {
        marks.push(Mark::level("paper: 0.2 mm", palette::BLACK, CLAIMED));
    }
    Panel {
        title: format!("{letter}) {}", quantity.title),
        note: String::new(),
        x: scan.axis.clone(),
        y,
        marks,
    }
}

/// Readings have no order, so no line joins them: only the legend entry is drawn.
fn line(scan: &Scan, label: &str, color: Color, x: &[f64], y: &[f64], width: u32) -> Mark {
    let joined = if scan.slug == "reading" { 1 } else { x.len() };
    Mark::curve(label, color, &x[..joined], &y[..joined]).width(width)
}

/// Marks of case 3 are larger, so that they show where those of case 4 lie on them.
fn size(case: u32) -> u32 {
    if case == 3 { 9 } else { 6 }
}

fn warns(entry: &ScanEntry) -> bool {
    entry.outcome.as_ref().is_ok_and(|v| !v.warnings.is_empty())
}

/// The page.
pub fn page(scans: &[Scan], record: &EnsembleRecord, numbers: &mut Numbers) -> String {
    let mut page = format!(
        "# Parameter scans\n\n{}\n\
         `cargo run --release -p paper-figures -- scans` writes this page. One parameter at a time is varied about its printed \
         or assumed value (bold rows). All runs last {DURATION} s; values are taken from {FROM} s on. The runs use the \
         trapezoidal rule with a requested accuracy of 1 µm and 100 nJ over 10 ms, except in the scan of the step of Bathe's \
         method.\n\n\
         Cases 3 and 4 are chaotic, and each value comes from one run. A difference between rows is significant only where \
         it exceeds the spread of an ensemble; [ENSEMBLES.md](ENSEMBLES.md) has those spreads.\n\n\
         e_x is the displacement error and a the acceleration of the platform along x; rms a is the rms deviation of a from \
         the ideal acceleration; F is the force in B1. \"Energy lost\" is the largest energy that the integrator has \
         lost (negative: gained) by any row, over the contact dissipation or, in case 2, over the largest elastic energy; a dash where nothing is \
         dissipated. The last column has the warnings of the run. The dashed lines of the pictures are the ±0.2 mm that the \
         paper gives for Fig. 5.\n\n",
        records::place("scans"),
    );
    page += &scatter(record);
    for scan in scans {
        let _ = write!(
            page,
            "## {}\n\n![{}](figures/scans-{}.png)\n\n",
            scan.title, scan.title, scan.slug
        );
        page += &near_claim(scan);
        page += "| value | case | largest \\|e_x\\| | rms e_x | peak a (m/s²) | rms a (m/s²) | peak F (N) | mean F (N) | B1 in contact | energy lost | warnings |\n";
        page += "|---|---|---|---|---|---|---|---|---|---|---|\n";
        for entry in &scan.entries {
            let emphasis = if entry.baseline { "**" } else { "" };
            let _ = write!(
                page,
                "| {emphasis}{}{emphasis} | {} |",
                entry.label, entry.plan.case
            );
            match &entry.outcome {
                Ok(values) => page += &cells(values),
                Err(message) => {
                    let _ = write!(
                        page,
                        " failed: {} | | | | | | | | |",
                        message.replace('|', "\\|").replace('\n', " ")
                    );
                }
            }
            page.push('\n');
            keep(scan, entry, numbers);
        }
        page.push('\n');
    }
    page
}

fn cells(v: &Values) -> String {
    let contact = v.contact.map_or("–".into(), percent);
    let warnings = reported(&v.warnings);
    format!(
        " {} | {} | {} | {} | {} | {} | {contact} | {} | {warnings} |",
        si(v.error_peak, "m"),
        si(v.error_rms, "m"),
        digits(v.acceleration_peak),
        digits(v.deviation_rms),
        digits(v.force_peak),
        digits(v.force_mean),
        match v.energy_lost.is_finite() {
            true => percent(v.energy_lost),
            false => "–".into(),
        }
    )
}

fn keep(scan: &Scan, entry: &ScanEntry, numbers: &mut Numbers) {
    let name = format!("{}.case{}.{}", scan.slug, entry.plan.case, entry.label);
    match &entry.outcome {
        Err(message) => numbers.put_value(format!("{name}.failed"), message.as_str().into()),
        Ok(v) => {
            let values = [
                ("error_x_peak", v.error_peak),
                ("error_x_rms", v.error_rms),
                ("acceleration_peak", v.acceleration_peak),
                ("acceleration_deviation_rms", v.deviation_rms),
                ("force_b1_peak", v.force_peak),
                ("force_b1_mean", v.force_mean),
                ("energy_lost", v.energy_lost),
            ];
            for (what, value) in values
                .into_iter()
                .chain(v.contact.map(|f| ("contact_fraction_b1", f)))
            {
                numbers.put(format!("{name}.{what}"), value);
            }
            numbers.put_value(format!("{name}.warnings"), v.warnings.clone().into());
        }
    }
}

/// Which runs come within a factor of two of the paper's error.
fn near_claim(scan: &Scan) -> String {
    let near = |v: &Values| (0.5..=2.0).contains(&(v.error_peak / CLAIMED));
    let hits: Vec<String> = scan
        .entries
        .iter()
        .filter(|e| e.outcome.as_ref().is_ok_and(near))
        .map(|e| format!("{} (case {})", e.label, e.plan.case))
        .collect();
    let found = if hits.is_empty() {
        "none".into()
    } else {
        hits.join(", ")
    };
    format!("Values for which the largest |e_x| is within a factor of two of 0.2 mm: {found}.\n\n")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::controlled;
    use crate::record;

    #[test]
    fn a_failed_run_is_shown_with_its_message() {
        let outcome = Err("no convergence | t = 0.1 s".into());
        let entries = vec![ScanEntry {
            label: "1".into(),
            at: 1.0,
            baseline: false,
            plan: controlled(3, 1e-5),
            outcome,
        }];
        let scan = Scan {
            slug: "x",
            title: "X",
            axis: Axis::new("x", "", 1.0),
            entries,
        };
        let (record, mut numbers) = (
            record::load("ensembles.json").expect("a record"),
            Numbers::default(),
        );
        let page = page(std::slice::from_ref(&scan), &record, &mut numbers);
        assert!(page.contains("failed: no convergence \\| t = 0.1 s"));
        // two single runs of case 3 differ by a tenth of their force peaks and more, but hardly in the largest error
        let row = page
            .split("| case 3, of the mean | ")
            .nth(1)
            .unwrap_or_default();
        let number = |cell: &str| cell.trim().trim_end_matches('%').trim_end().parse();
        let limits = row.split('|').map(number);
        let limits: Vec<f64> = limits.map_while(Result::ok).collect();
        assert!(
            limits.len() == 5 && limits[0] < 1.0 && limits[3] > 10.0,
            "{limits:?}"
        );
        assert!(
            figure(&scan)
                .caption
                .contains("Failed runs, which have no dot: 1 of 1")
        );
    }
}

//! The closing table of a run: what it came to.

use looselink::simulate::{ContactTime, DriveLoad, Peak, PoseError, Report};
use numbers::{number, percent, si};
use std::collections::BTreeMap;

/// Rows of one kind: the table of a large mechanism stays on a screen, and `summary.json` has all.
const SHOWN: usize = 10;

/// The table, line by line: only what the scene has.
pub fn closing_table(report: &Report) -> Vec<String> {
    let closing = &report.closing;
    let mut rows = peaks(&closing.errors, |error: &PoseError| {
        vec![
            ("error of", error.position, "m"),
            ("angle error of", error.angle, "rad"),
        ]
    });
    rows.extend(peaks(&closing.forces, |force| {
        vec![("force of", *force, "N")]
    }));
    rows.extend(peaks(&closing.drives, |load: &DriveLoad| {
        let power = load.power.map(|power| ("power in", power, "W"));
        let torque = ("torque in", load.torque, "N m");
        std::iter::once(torque).chain(power).collect()
    }));
    let mut lines = match rows.is_empty() {
        true => Vec::new(),
        false => aligned(closing.from, &rows),
    };
    lines.extend(contacts(&closing.contacts, report.t - closing.from));
    lines.extend(energy(report));
    lines
}

/// Cells of a row: what, the largest value, when, the root mean square.
type Row = [String; 4];

/// The rows of quantities that some things have, those of the largest first.
fn peaks<T>(
    of: &BTreeMap<String, T>,
    quantities: impl Fn(&T) -> Vec<(&'static str, Peak, &'static str)>,
) -> Vec<Row> {
    let mut named: Vec<_> = of.iter().map(|(name, x)| (name, quantities(x))).collect();
    named.sort_by(|a, b| b.1[0].1.largest.total_cmp(&a.1[0].1.largest));
    let shown = named.iter().take(SHOWN).flat_map(|(name, quantities)| {
        let row = move |(what, peak, unit): &(&str, Peak, &str)| {
            let when = number(peak.t, 4);
            [
                format!("{what} {name}"),
                si(peak.largest, unit),
                when,
                si(peak.rms, unit),
            ]
        };
        quantities.iter().map(row)
    });
    let mut rows: Vec<Row> = shown.collect();
    if let Some(left) = named.len().checked_sub(SHOWN).filter(|left| *left > 0) {
        let what = named[0].1[0].0;
        let more = format!("{what} {left} more: `closing` in summary.json");
        rows.push([more, String::new(), String::new(), String::new()]);
    }
    rows
}

/// Lines with their cells below each other.
fn aligned(from: f64, rows: &[Row]) -> Vec<String> {
    let when = match from > 0.0 {
        true => format!("from t = {} s on", number(from, 4)),
        false => String::new(),
    };
    let head = [
        when,
        "largest".to_owned(),
        "at t [s]".to_owned(),
        "rms".to_owned(),
    ];
    let full = |row: &&Row| !row[1].is_empty();
    let width = |column: usize| {
        let cells = std::iter::once(&head).chain(rows.iter().filter(full));
        cells
            .map(|row| row[column].chars().count())
            .max()
            .unwrap_or(0)
    };
    let widths: [usize; 4] = std::array::from_fn(width);
    let line = |row: &Row| {
        let cells = row.iter().zip(widths);
        let cells = cells.map(|(cell, width)| format!("{cell:<width$}"));
        cells.collect::<Vec<_>>().join("  ").trim_end().to_owned()
    };
    std::iter::once(&head).chain(rows).map(line).collect()
}

/// Impacts and time in contact, joints with the longest time first.
fn contacts(of: &BTreeMap<String, ContactTime>, duration: f64) -> Vec<String> {
    let mut named: Vec<_> = of.iter().collect();
    named.sort_by(|a, b| b.1.closed.total_cmp(&a.1.closed));
    let shown = named.iter().take(SHOWN).map(|(name, contact)| {
        let part = percent(contact.closed / duration);
        let impacts = match contact.impacts {
            1 => "1 impact".to_owned(),
            count => format!("{count} impacts"),
        };
        format!("contact of {name}: {impacts}, {part} of the time in contact")
    });
    let mut lines: Vec<String> = shown.collect();
    if let Some(left) = named.len().checked_sub(SHOWN).filter(|left| *left > 0) {
        lines.push(format!("contact of {left} more: `closing` in summary.json"));
    }
    lines
}

/// What was supplied and dissipated, and what the integrator did to it.
fn energy(report: &Report) -> Option<String> {
    let (ledger, error) = (report.ledger.as_ref()?, report.energy_error()?);
    let parts = [
        ("supplied", ledger.work),
        ("dissipated", ledger.dissipated()),
    ];
    let parts = parts.into_iter().filter(|(_, joule)| *joule != 0.0);
    let parts = parts.map(|(what, joule)| format!("{} {what}, ", si(joule, "J")));
    let parts: String = parts.collect();
    Some(format!("energy: {parts}the integrator {}", error.text()))
}

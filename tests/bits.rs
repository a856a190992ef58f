//! Every number on disk reads back to the bits that were recorded, through the writer of runs.

use crate::support::load;
use looselink::output::folder::Folder;
use looselink::output::{Results, kind};
use looselink::scene::Scene;
use looselink::simulate::{
    ContactEvent, Control, Observer, Onset, Progress, Recording, Simulation,
};
use looselink::table::FORMATS;
use proptest::prelude::*;
use serde_json::Value;
use std::io;
use std::path::Path;

fn begin(scene: &Scene, folder: &Path) -> (Simulation, Results) {
    let simulation = Simulation::new(scene).unwrap();
    let folder = Folder::claim(folder, kind(&FORMATS, &[]), false).unwrap();
    let results = Results::begin(folder, scene, &simulation).unwrap();
    (simulation, results)
}

/// The cells of a file below its header.
fn cells(folder: &Path, file: &str) -> Vec<Vec<String>> {
    let text = std::fs::read_to_string(folder.join(file)).unwrap();
    let rows = text.lines().skip(1);
    rows.map(|row| row.split(',').map(str::to_owned).collect())
        .collect()
}

fn bits(cell: &str) -> u64 {
    cell.parse::<f64>()
        .unwrap_or_else(|e| panic!("{cell}: {e}"))
        .to_bits()
}

/// Writes the numbers, one a row, and compares what stands in `channels.csv` with them.
fn check(numbers: &[f64]) {
    let folder = tempfile::tempdir().unwrap();
    let scene = load("bouncing-journal.toml", &[]);
    let (_, mut results) = begin(&scene, folder.path());
    for number in numbers {
        results.row(&[*number]).unwrap();
    }
    results.flush().unwrap();
    let rows = cells(folder.path(), "channels.csv");
    assert_eq!(rows.len(), numbers.len());
    for (row, number) in rows.iter().zip(numbers) {
        assert_eq!(row.len(), 1);
        assert_eq!(bits(&row[0]), number.to_bits(), "{number:?} as {}", row[0]);
    }
}

#[test]
fn special_numbers_read_back_to_the_same_bits() {
    let mut numbers = vec![
        0.0,
        f64::MAX,
        f64::MIN_POSITIVE,
        5e-324,
        1e308,
        0.1,
        1.0 / 3.0,
    ];
    // the greatest number below the normal ones
    numbers.push(f64::MIN_POSITIVE.next_down());
    let integers = [
        1,
        3,
        17,
        1_000_000,
        999_999_999_999_999,
        (1 << 53) - 1,
        1 << 53,
        1 << 62,
    ];
    numbers.extend(integers.map(|n: i64| n as f64));
    numbers.extend((-324..=308).map(|k| format!("1e{k}").parse::<f64>().unwrap()));
    numbers.extend((-1074..=1023).map(|k| 2.0_f64.powi(k)));
    let neighbours = numbers.clone().into_iter();
    numbers.extend(neighbours.flat_map(|x| [x.next_up(), x.next_down()]));
    let negative: Vec<f64> = numbers.iter().map(|x| -x).collect();
    numbers.extend(negative);
    numbers.retain(|x| x.is_finite());
    assert!(numbers.iter().any(|x| x.to_bits() == (-0.0_f64).to_bits()));
    assert!(numbers.iter().filter(|x| x.is_subnormal()).count() > 100);
    check(&numbers);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]
    #[test]
    fn numbers_of_any_bits_read_back(words in prop::collection::vec(any::<u64>(), 500)) {
        let numbers: Vec<f64> = words.into_iter().map(f64::from_bits).collect();
        // a run stops before it records what is not finite
        check(&numbers.into_iter().filter(|x| x.is_finite()).collect::<Vec<_>>());
    }
}

/// Writes a run to disk and keeps it in memory.
struct StoredRecording {
    results: Results,
    recording: Recording,
}

impl Observer for StoredRecording {
    fn row(&mut self, values: &[f64]) -> io::Result<()> {
        self.recording.row(values)?;
        self.results.row(values)
    }
    fn onset(&mut self, onset: &Onset) -> io::Result<()> {
        self.recording.onset(onset)
    }
    fn contact(&mut self, contact: &ContactEvent) -> io::Result<()> {
        self.recording.contact(contact)?;
        self.results.contact(contact)
    }
    fn step(&mut self, _: &Progress) -> io::Result<Control> {
        Ok(Control::Continue)
    }
}

#[test]
fn every_number_of_a_run_reads_back_to_the_same_bits() {
    let folder = tempfile::tempdir().unwrap();
    let overrides = [
        "simulation.duration=0.01",
        "integrator.step=1e-5",
        "output.interval=1e-5",
        "output.channels=[\"*\"]",
    ];
    let (mut simulation, results) = begin(&load("3rrr/case4.toml", &overrides), folder.path());
    let recording = Recording::new(&simulation);
    let mut stored = StoredRecording { results, recording };
    simulation.run(&mut stored).unwrap();
    stored.results.finish(&simulation.report()).unwrap();

    let rows = cells(folder.path(), "channels.csv");
    let recording = stored.recording;
    assert_eq!((rows.len(), recording.rows()), (1001, 1001));
    assert!(rows.iter().all(|row| row.len() == recording.names().len()));
    let contacts = cells(folder.path(), "onsets.csv");
    assert_eq!(contacts.len(), recording.onsets.len());
    for kept in &recording.onsets {
        let numbers = [
            Some(kept.t),
            Some(kept.impact_velocity),
            Some(kept.delta),
            Some(kept.angle),
            Some(kept.deepest_penetration),
            Some(kept.largest_force),
            kept.end,
            kept.exit_velocity,
        ];
        let numbers = numbers.map(|x| x.map(f64::to_bits));
        let same = |row: &&Vec<String>| {
            let cells = row.iter().enumerate().filter(|(k, _)| *k != 1);
            let cells = cells.map(|(_, cell)| (!cell.is_empty()).then(|| bits(cell)));
            row[1] == kept.joint && cells.eq(numbers)
        };
        assert!(contacts.iter().any(|row| same(&row)), "{kept:?}");
    }
    for (k, (name, column)) in recording.into_columns().enumerate() {
        for (row, value) in rows.iter().zip(column) {
            assert_eq!(
                bits(&row[k]),
                value.to_bits(),
                "{name}: {value:?} as {}",
                row[k]
            );
        }
    }
}

/// Rows of JSON have the cells of the table between commas.
#[test]
fn lines_of_json_hold_the_same_numbers() {
    let [commas, lines] = ["csv", "json_lines"].map(|format| {
        let folder = tempfile::tempdir().unwrap();
        let scene = load(
            "bouncing-journal.toml",
            &[&format!("output.format={format:?}")],
        );
        let (mut simulation, results) = begin(&scene, folder.path());
        let recording = Recording::new(&simulation);
        let mut stored = StoredRecording { results, recording };
        simulation.run(&mut stored).unwrap();
        stored.results.finish(&simulation.report()).unwrap();
        folder
    });
    for table in ["channels", "onsets"] {
        let text = std::fs::read_to_string(commas.path().join(format!("{table}.csv"))).unwrap();
        let names: Vec<&str> = text.lines().next().unwrap().split(',').collect();
        let rows = cells(commas.path(), &format!("{table}.csv"));
        let text = std::fs::read_to_string(lines.path().join(format!("{table}.jsonl"))).unwrap();
        assert_eq!(text.lines().count(), rows.len());
        for (line, row) in text.lines().zip(&rows) {
            let object: serde_json::Map<String, Value> = serde_json::from_str(line).unwrap();
            assert_eq!(object.len(), names.len());
            for (name, cell) in names.iter().zip(row) {
                let written = match &object[*name] {
                    Value::Null => "null".to_owned(),
                    Value::String(word) => format!("{word:?}"),
                    // the digits of the cell, which read back to the bits of the run
                    _ => cell.clone(),
                };
                assert!(cell.is_empty() || written.contains(cell.as_str()), "{line}");
                assert!(line.contains(&format!("{name:?}:{written}")), "{line}");
            }
        }
        assert!(rows.len() > 3, "{table}");
    }
}

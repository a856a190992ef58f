//! The report of an ablation: what repeats in one form, processor times in another, and both as tables.

use super::effects::Effect;
use super::measure::{Cost, Counts, Physics};
use super::table::Table;
use super::variants::Role;
use super::{Ablation, Header, Outcome, Row};
use crate::machine::{Machine, machine};
use crate::warning_list;
use numbers::{digits, si};
use serde::Serialize;
use std::collections::BTreeMap;

/// What stands where a variant does not have a quantity.
const NONE: &str = "–";
/// Where the joint with the largest force stands among the quantities.
const JOINT: usize = 5;
/// Lengths, forces and accelerations below this are written with a power of ten.
const SMALLEST: f64 = 1e-12;

/// What of an ablation repeats: `ablation.json`.
#[derive(Debug, Serialize)]
pub struct Repeatable<'a> {
    #[serde(flatten)]
    header: &'a Header,
    units: BTreeMap<&'static str, &'static str>,
    variants: Vec<RepeatableRow<'a>>,
}

#[derive(Debug, Serialize)]
struct RepeatableRow<'a> {
    variant: String,
    effects: &'a [Effect],
    removed: &'a [Effect],
    #[serde(skip_serializing_if = "Option::is_none")]
    error: Option<&'a str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    physics: Option<&'a Physics>,
    #[serde(skip_serializing_if = "Option::is_none")]
    peak_joint: Option<&'a str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    less_rigid_ideal_mechanism: Option<Physics>,
    #[serde(skip_serializing_if = "Option::is_none")]
    less_full_scene: Option<Physics>,
    #[serde(skip_serializing_if = "Option::is_none")]
    counts: Option<&'a Counts>,
    #[serde(skip_serializing_if = "Option::is_none")]
    warnings: Option<&'a [String]>,
}

impl<'a> RepeatableRow<'a> {
    fn new(row: &'a Row, ideal: Option<&Outcome>, full: Option<&Outcome>) -> RepeatableRow<'a> {
        let outcome = row.outcome.as_ref().ok();
        let less = |other: Option<&Outcome>| Some(outcome?.physics.less(&other?.physics));
        RepeatableRow {
            variant: row.variant.name(),
            effects: &row.variant.effects,
            removed: &row.variant.removed,
            error: row.outcome.as_ref().err().map(String::as_str),
            physics: outcome.map(|o| &o.physics),
            peak_joint: outcome.and_then(|o| o.peak_joint.as_deref()),
            less_rigid_ideal_mechanism: less(ideal),
            less_full_scene: less(full),
            counts: outcome.map(|o| &o.counts),
            warnings: outcome.map(|o| &*o.warnings),
        }
    }
}

/// What of an ablation differs when it is repeated: `timing.json`.
#[derive(Debug, Serialize)]
pub struct Timing {
    machine: Machine,
    variants: Vec<TimingRow>,
}

#[derive(Debug, Serialize)]
struct TimingRow {
    variant: String,
    #[serde(flatten)]
    cost: Cost,
}

impl Ablation {
    /// What repeats.
    pub fn repeatable(&self) -> Repeatable<'_> {
        let [ideal, full] = [Role::Ideal, Role::Full].map(|role| self.outcome(role));
        let rows = self.rows.iter();
        Repeatable {
            header: &self.header,
            units: BTreeMap::from([
                ("acceleration", "m/s2"),
                ("contact_fraction", "1"),
                ("error", "m"),
                ("force", "N"),
                ("time", "s"),
            ]),
            variants: rows
                .map(|row| RepeatableRow::new(row, ideal, full))
                .collect(),
        }
    }

    /// What does not repeat.
    pub fn timing(&self) -> Timing {
        let row = |row: &Row| {
            Some(TimingRow {
                variant: row.variant.name(),
                cost: row.outcome.as_ref().ok()?.cost.clone(),
            })
        };
        Timing {
            machine: machine(),
            variants: self.rows.iter().filter_map(row).collect(),
        }
    }

    /// Everything as aligned text.
    pub fn text(&self) -> String {
        let mut text = format!("{}\n\n", self.header.title);
        for line in self.about() {
            text += &format!("  {line}\n");
        }
        let costs = ("Processor time", self.costs());
        for (title, table) in self.tables().into_iter().chain([costs]) {
            text += &format!("\n{title}\n{}", table.text());
        }
        // a no-break space is of no use where nothing is broken
        text.replace('\u{a0}', " ")
    }

    /// What repeats as a page.
    pub fn markdown(&self) -> String {
        let title = &self.header.title;
        let about = self.about().join(" ");
        let mut page =
            format!("# {title}, effect by effect\n\n{about}\n\n![{title}](ablation.png)\n\n");
        for (title, table) in self.tables() {
            page += &format!("## {title}\n\n{}\n", table.markdown());
        }
        page += "Processor times are in the picture and in `timing.json`.\n";
        page + &warning_list(&self.warnings())
    }

    /// All warnings, each after the name of its variant.
    pub fn warnings(&self) -> Vec<String> {
        let warnings = self.measured().flat_map(|(row, outcome)| {
            let name = row.variant.name();
            let warnings = outcome.warnings.iter();
            warnings.map(move |warning| format!("{name}: {warning}"))
        });
        warnings.collect()
    }

    /// What every variant does and what it costs as Markdown without headings, for a page of more than this.
    pub fn summary(&self) -> String {
        let (about, physics) = (self.about().join(" "), self.physics().markdown());
        format!("{about}\n\n{physics}\n{}", self.costs().markdown())
    }

    /// What is compared, sentence by sentence.
    pub(super) fn about(&self) -> [String; 3] {
        let header = &self.header;
        let (body, from) = (&header.body.name, header.body.error_from.name());
        let names: Vec<&str> = header.effects.iter().map(|e| e.name()).collect();
        let effects = match names.is_empty() {
            true => "The scene has no effect to remove: it is a rigid ideal mechanism.".to_owned(),
            false => format!("Effects of the scene: {}.", names.join(", ")),
        };
        let [interval, duration] = [header.interval, header.duration].map(|t| si(t, "s"));
        [
            effects,
            format!(
                "Errors are distances of {body} from {from}; accelerations are those of its centre."
            ),
            format!(
                "All values are taken from {} rows, one every {interval}, over {duration}.",
                header.rows
            ),
        ]
    }

    /// The tables of what repeats, with their titles.
    fn tables(&self) -> Vec<(&'static str, Table)> {
        let mut tables = vec![("Results of each variant", self.physics())];
        for (title, role) in [
            ("Difference from the rigid ideal mechanism", Role::Ideal),
            ("Difference from the full scene", Role::Full),
        ] {
            if let Some(reference) = self.outcome(role) {
                tables.push((title, self.less(role, &reference.physics)));
            }
        }
        tables.push(("Size and work", self.work()));
        tables
    }

    fn physics(&self) -> Table {
        let mut head = quantity_names();
        head.insert(JOINT + 1, "in joint");
        let mut table = Table::new(&head);
        for row in &self.rows {
            let numbers = row.outcome.clone().map(|outcome| {
                let mut cells = quantities(&outcome.physics, "");
                cells.insert(JOINT, outcome.peak_joint.unwrap_or_else(|| NONE.to_owned()));
                cells
            });
            table.row(row.variant.name(), numbers);
        }
        table
    }

    fn less(&self, role: Role, reference: &Physics) -> Table {
        let mut table = Table::new(&quantity_names());
        let others = self.measured().filter(|(row, _)| row.variant.role != role);
        for (row, outcome) in others {
            let less = outcome.physics.less(reference);
            table.row(row.variant.name(), Ok(quantities(&less, "+")));
        }
        table
    }

    fn work(&self) -> Table {
        let mut table = Table::new(&[
            "variant",
            "unknowns",
            "multipliers",
            "contacts",
            "steps",
            "Newton iterations",
        ]);
        for (row, outcome) in self.measured() {
            let c = &outcome.counts;
            let cells = [
                c.unknowns as u64,
                c.multipliers as u64,
                c.contacts as u64,
                c.steps,
                c.newton_iterations,
            ];
            table.row(
                row.variant.name(),
                Ok(cells.map(|n| n.to_string()).to_vec()),
            );
        }
        table
    }

    fn costs(&self) -> Table {
        let mut table = Table::new(&[
            "variant",
            "a step",
            "a simulated second",
            "real-time factor",
            "runs",
        ]);
        for (row, outcome) in self.measured() {
            let cost = &outcome.cost;
            let cells = vec![
                si(1e-6 * cost.microseconds_a_step, "s"),
                si(cost.cpu_seconds_a_simulated_second, "s"),
                digits(cost.real_time_factor),
                cost.runs.to_string(),
            ];
            table.row(row.variant.name(), Ok(cells));
        }
        table
    }

    fn measured(&self) -> impl Iterator<Item = (&Row, &Outcome)> {
        let rows = self.rows.iter();
        rows.filter_map(|row| Some((row, row.outcome.as_ref().ok()?)))
    }
}

fn quantity_names() -> Vec<&'static str> {
    let names = Physics::QUANTITIES.map(|(name, _)| name);
    std::iter::once("variant").chain(names).collect()
}

/// The quantities with their units; `plus` stands before those that are not negative.
fn quantities(physics: &Physics, plus: &str) -> Vec<String> {
    let cell = |(value, (_, unit)): (Option<f64>, (&str, &str))| match value {
        None => NONE.to_owned(),
        Some(value) => {
            let text = match unit {
                "" => digits(value),
                _ if value != 0.0 && value.abs() < SMALLEST => {
                    format!("{}\u{a0}{unit}", digits(value))
                }
                _ => si(value, unit),
            };
            match text.strip_prefix('-') {
                Some(size) => format!("−{size}"),
                None => plus.to_owned() + &text,
            }
        }
    };
    let values = physics.values().into_iter();
    values.zip(Physics::QUANTITIES).map(cell).collect()
}

//! The report of an ablation: what repeats in one form, processor times in another, and both as tables.

use super::effects::SceneEffect;
use super::measure::{Cost, Physics, PhysicsQuantity, VariantCounts};
use super::table::TextTable;
use super::variants::VariantRole;
use super::{Ablation, AblationHeader, AblationRow, VariantOutcome};
use crate::machine::{Machine, machine};
use crate::warning_list;
use numbers::{digits, si};
use serde::Serialize;
use std::collections::BTreeMap;
use texts::markdown::text;

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
    header: &'a AblationHeader,
    units: BTreeMap<&'static str, &'static str>,
    variants: Vec<RepeatableRow<'a>>,
}

#[derive(Debug, Serialize)]
struct RepeatableRow<'a> {
    variant: String,
    effects: &'a [SceneEffect],
    removed: &'a [SceneEffect],
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
    counts: Option<&'a VariantCounts>,
    #[serde(skip_serializing_if = "Option::is_none")]
    warnings: Option<&'a [String]>,
}

/// What of an ablation differs when it is repeated: `timing.json`.
#[derive(Debug, Serialize)]
pub struct AblationTiming {
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
        let [ideal, full] = [VariantRole::Ideal, VariantRole::Full].map(|role| self.outcome(role));
        let variants = self.rows.iter().map(|row| {
            let outcome = row.outcome.as_ref().ok();
            let less =
                |other: Option<&VariantOutcome>| Some(outcome?.physics.less(&other?.physics));
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
        });
        Repeatable {
            header: &self.header,
            units: BTreeMap::from([
                ("acceleration", "m/s2"),
                ("contact_fraction", "1"),
                ("error", "m"),
                ("force", "N"),
                ("time", "s"),
            ]),
            variants: variants.collect(),
        }
    }

    /// What does not repeat.
    pub fn timing(&self) -> AblationTiming {
        let row = |row: &AblationRow| {
            Some(TimingRow {
                variant: row.variant.name(),
                cost: row.outcome.as_ref().ok()?.cost.clone(),
            })
        };
        AblationTiming {
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
        let title = text(&self.header.title);
        let about = self.about().join(" ");
        let mut page =
            format!("# {title}, effect by effect\n\n{about}\n\n![{title}](ablation.svg)\n\n");
        for (title, table) in self.tables() {
            page += &format!("## {title}\n\n{}\n", table.markdown());
        }
        page += "Processor times are in the picture and in `timing.json`.\n";
        page + &warning_list(&self.warnings())
    }

    /// All warnings, each after the name of its variant.
    pub fn warnings(&self) -> Vec<String> {
        let named = |row: &AblationRow| {
            let name = row.variant.name();
            let warnings = row.outcome.iter().flat_map(|outcome| &outcome.warnings);
            warnings.map(|w| format!("{name}: {w}")).collect::<Vec<_>>()
        };
        self.rows.iter().flat_map(named).collect()
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
                "All values are taken from {} rows, one every {interval}, over {duration}, and the forces of joints with clearance from all steps.",
                header.rows
            ),
        ]
    }

    /// The tables of what repeats, with their titles.
    fn tables(&self) -> Vec<(&'static str, TextTable)> {
        let mut tables = vec![("Results of each variant", self.physics())];
        for (title, role) in [
            (
                "Difference from the rigid ideal mechanism",
                VariantRole::Ideal,
            ),
            ("Difference from the full scene", VariantRole::Full),
        ] {
            if let Some(reference) = self.outcome(role) {
                tables.push((title, self.less(role, &reference.physics)));
            }
        }
        tables.push(("Size and work", self.work()));
        tables
    }

    fn physics(&self) -> TextTable {
        let mut heads = Physics::QUANTITIES.map(|(name, ..)| name).to_vec();
        heads.insert(JOINT, "in joint");
        let cells = |outcome: &VariantOutcome| {
            let mut cells = quantities(&outcome.physics, "");
            let joint = outcome.peak_joint.as_deref();
            cells.insert(JOINT, joint.unwrap_or(NONE).to_owned());
            cells
        };
        self.table(&heads, |_| true, cells)
    }

    fn less(&self, role: VariantRole, reference: &Physics) -> TextTable {
        let heads = Physics::QUANTITIES.map(|(name, ..)| name);
        let other = |row: &AblationRow| row.outcome.is_ok() && row.variant.role != role;
        let cells = |outcome: &VariantOutcome| quantities(&outcome.physics.less(reference), "+");
        self.table(&heads, other, cells)
    }

    fn work(&self) -> TextTable {
        let heads = [
            "unknowns",
            "multipliers",
            "contacts",
            "steps",
            "Newton iterations",
        ];
        let cells = |outcome: &VariantOutcome| {
            let c = &outcome.counts;
            vec![
                c.unknowns.to_string(),
                c.multipliers.to_string(),
                c.contacts.to_string(),
                c.steps.to_string(),
                c.newton_iterations.to_string(),
            ]
        };
        self.table(&heads, |row| row.outcome.is_ok(), cells)
    }

    fn costs(&self) -> TextTable {
        let heads = ["a step", "a simulated second", "real-time factor", "runs"];
        let cells = |outcome: &VariantOutcome| {
            let cost = &outcome.cost;
            vec![
                si(1e-6 * cost.microseconds_a_step, "s"),
                si(cost.cpu_seconds_a_simulated_second, "s"),
                digits(cost.real_time_factor),
                cost.runs.to_string(),
            ]
        };
        self.table(&heads, |row| row.outcome.is_ok(), cells)
    }

    /// A table of some of the rows.
    fn table(
        &self,
        heads: &[&str],
        shown: impl Fn(&AblationRow) -> bool,
        cells: impl Fn(&VariantOutcome) -> Vec<String>,
    ) -> TextTable {
        let mut table = TextTable::new(&[&["variant"], heads].concat());
        for row in self.rows.iter().filter(|row| shown(row)) {
            let numbers = row.outcome.as_ref().map(&cells);
            table.row(row.variant.name(), numbers.map_err(String::clone));
        }
        table
    }
}

/// The quantities with their units; `plus` stands before those that are not negative.
fn quantities(physics: &Physics, plus: &str) -> Vec<String> {
    let cell = |(_, unit, value): PhysicsQuantity| match value(physics) {
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
    Physics::QUANTITIES.map(cell).to_vec()
}

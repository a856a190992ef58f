//! The page: tables of agreements, pictures, costs, seeded faults, and what is not cross-checked.

use crate::check::Agreement;
use crate::compare::cost::{Curves, ERRORS, time_at};
use crate::compare::statistics::{QUANTITIES, RELATIVE, STEPS, Spread};
use crate::faults::{Fault, Outcome};
use crate::reference;
use plot::{digits, number, si};
use std::fmt::Write;

/// Everything the page is made of.
pub struct Report {
    /// Title of a table, a sentence about it, its rows.
    pub sections: Vec<(&'static str, String, Vec<Agreement>)>,
    /// File name and title of the pictures of trajectories.
    pub overlays: Vec<(&'static str, String)>,
    pub spreads: Vec<Spread>,
    pub costs: Vec<Curves>,
    pub faults: Vec<(Fault, Outcome)>,
    /// Channels of Looselink without a counterpart.
    pub missing: Vec<String>,
}

/// What no row of the report confirms.
const NOT_CHECKED: [(&str, &str); 10] = [
    (
        "Hertz's law",
        "the reference has the laws of Lankarani-Nikravesh, Hunt-Crossley and Flores, whose limit without damping it is",
    ),
    (
        "The floor of the impact velocity",
        "all compared impacts are far above it",
    ),
    (
        "Clamped contact forces in motion",
        "clamping is compared in the law itself; none of the compared impacts reaches it",
    ),
    (
        "Paths and functions of time from a table; inverse kinematics along paths other than a circle",
        "the reference has the circle of eq. 27 for the inverse kinematics, and closed-form functions otherwise",
    ),
    (
        "Redundant constraints, singular poses, full turns of torsional springs, equilibria",
        "the reference refuses dependent constraints, counts no turns and has no static analysis; tests/published, \
         tests/mechanisms.rs and tests/library.rs compare them with published and exact solutions",
    ),
    (
        "The initial state of scenes without inverse kinematics",
        "the reference takes it from Looselink, and checks that it satisfies its own constraints",
    ),
    (
        "Angles of links, eccentricity vectors and their rates, lengths and forces of springs, applied loads",
        "these channels have no counterpart (some are listed below); their effect on the motion is compared",
    ),
    (
        "What both programs take from EQUATIONS.md",
        "a misreading of the paper in it would be in both: sign conventions, the choice of the branch, values that the paper \
         does not give",
    ),
    (
        "The TOML syntax of the scene",
        "both programs use the same TOML library",
    ),
    (
        "The command line and the files that it writes",
        "they have their own tests",
    ),
];

impl Report {
    /// The page in Markdown.
    pub fn page(&self) -> String {
        let mut page = String::new();
        self.head(&mut page);
        for (title, text, rows) in &self.sections {
            table(&mut page, title, text, rows);
        }
        self.pictures(&mut page);
        self.chaos(&mut page);
        self.cost(&mut page);
        self.seeded(&mut page);
        self.unchecked(&mut page);
        page
    }

    fn head(&self, page: &mut String) {
        let rows = self.sections.iter().flat_map(|s| &s.2);
        let (mut all, mut held) = (0, 0);
        for row in rows {
            all += 1;
            held += usize::from(row.holds());
        }
        put(
            page,
            format!(
                "# Looselink against a second implementation\n\n{}\n\
                 [reference-cpp](../reference-cpp/README.md) is a C++ program, written from the paper and \
                 [EQUATIONS.md](../EQUATIONS.md) with other methods: Gauss quadrature, automatic differentiation, constraint \
                 equations for every ideal joint, a stabilised index-2 formulation, and IDA's variable-order BDF with root \
                 finding. It shares the scene file with Looselink but no code of the mechanics. The last section lists what is \
                 not cross-checked.\n\n\
                 **{held} of {all} comparisons agree within their tolerance.** `cargo run --release -p verify` writes this \
                 page; `cargo test -p verify` asserts the same rows. {}.\n",
                records::place("comparison"),
                reference::versions()
            ),
        );
    }

    fn pictures(&self, page: &mut String) {
        put(page, "## Pictures\n".into());
        put(
            page,
            "![Case 2: difference from IDA against the step](figures/convergence.png)\n".into(),
        );
        for (name, title) in &self.overlays {
            put(page, format!("![{title}](figures/{name}.png)\n"));
        }
    }

    fn chaos(&self, page: &mut String) {
        put(
            page,
            "## Statistics of chaotic motion\n\n\
             Loose joints are chaotic: after some tens of milliseconds two runs have no impact in common, even two runs of the \
             same program. The tables compare statistics of cycles 2 and 3 instead, at three steps of Looselink and three \
             tolerances of IDA.\n"
                .into(),
        );
        for spread in &self.spreads {
            let steps = STEPS.map(|h| format!("h = {}", si(h, "s"))).join(" | ");
            let tolerances = RELATIVE.map(|r| format!("IDA {r:.0e}")).join(" | ");
            put(
                page,
                format!(
                    "| case {} | {steps} | {tolerances} |\n|---|---|---|---|---|---|---|",
                    spread.case
                ),
            );
            for (i, (name, unit, ..)) in QUANTITIES.iter().enumerate() {
                let both = spread.rust.iter().chain(&spread.cpp);
                let cells: Vec<String> = both.map(|m| number(m.values[i], 4)).collect();
                let name = name.replace('|', "\\|");
                put(page, format!("| {name} [{unit}] | {} |", cells.join(" | ")));
            }
            let both = spread.rust.iter().chain(&spread.cpp);
            let cells: Vec<String> = both.map(|m| digits(m.seconds)).collect();
            put(
                page,
                format!(
                    "| processor time of the whole run [s] | {} |",
                    cells.join(" | ")
                ),
            );
            put(page, String::new());
        }
    }

    fn cost(&self, page: &mut String) {
        put(
            page,
            "## Cost at the same error\n\n\
             ![Processor time against achieved error](figures/cost.png)\n\n\
             Processor time of the integration on one core, interpolated on the curves of the picture; an empty cell lies \
             outside a curve. Bathe's scheme is of order 2 and IDA of order up to 5, so the ratio falls as the error shrinks.\n\n\
             | scene | error of the platform | Looselink | reference | reference / Looselink |\n|---|---|---|---|---|"
                .into(),
        );
        for curves in &self.costs {
            for error in ERRORS {
                let (rust, cpp) = (time_at(&curves.rust, error), time_at(&curves.cpp, error));
                if rust.is_none() && cpp.is_none() {
                    continue;
                }
                let time = |t: Option<f64>| t.map_or(String::new(), |t| si(t, "s"));
                let ratio = rust.zip(cpp).map_or(String::new(), |(r, c)| digits(c / r));
                let scene = format!("{}, {}", curves.plan.name(), si(curves.plan.duration, "s"));
                put(
                    page,
                    format!(
                        "| {scene} | {} | {} | {} | {ratio} |",
                        si(error, "m"),
                        time(rust),
                        time(cpp)
                    ),
                );
            }
        }
        put(page, String::new());
    }

    fn seeded(&self, page: &mut String) {
        put(
            page,
            format!(
                "## Seeded faults\n\n{}\n\
                 `cargo run --release -p verify --bin faults` makes {} mistakes, one at a time, and records the tests that \
                 fail ([faults.toml](faults.toml) has the changed lines). Tests that take a minute run only when no quick test \
                 fails.\n\n\
                 | in | mistake | caught by |\n|---|---|---|",
                records::place("faults"),
                self.faults.len()
            ),
        );
        for (fault, outcome) in &self.faults {
            let side = if fault.is_in_reference() {
                "C++"
            } else {
                "Rust"
            };
            let tests: Vec<String> = outcome.caught_by.iter().map(|t| format!("`{t}`")).collect();
            put(
                page,
                format!(
                    "| {side} `{}` | {} | {} |",
                    fault.file,
                    fault.name,
                    tests.join(", ")
                ),
            );
        }
        put(page, String::new());
    }

    fn unchecked(&self, page: &mut String) {
        put(page, "## What is not cross-checked\n".into());
        for (what, why) in NOT_CHECKED {
            put(page, format!("* {what}: {why}."));
        }
        let names: Vec<String> = self.missing.iter().map(|n| format!("`{n}`")).collect();
        put(
            page,
            format!(
                "\nChannels of case 4 with friction that have no counterpart in the reference: {}.",
                names.join(", ")
            ),
        );
    }
}

fn put(page: &mut String, line: String) {
    writeln!(page, "{line}").expect("a string can be written to");
}

fn table(page: &mut String, title: &str, text: &str, rows: &[Agreement]) {
    put(
        page,
        format!(
            "## {title}\n\n{text}\n\n\
             | | quantity | scene | Looselink | reference | difference | allowed | measure and reason |\n\
             |---|---|---|---|---|---|---|---|"
        ),
    );
    for row in rows {
        let verdict = if row.holds() { "✓" } else { "✗" };
        let cells = [
            row.quantity.clone(),
            row.scene.clone(),
            // enough digits to see the agreement
            number(row.rust, 10),
            number(row.cpp, 10),
            number(row.difference, 2),
            number(row.tolerance, 1),
            row.reason.clone(),
        ];
        let cells = cells.map(|cell| cell.replace('|', "\\|"));
        put(page, format!("| {verdict} | {} |", cells.join(" | ")));
    }
    put(page, String::new());
}

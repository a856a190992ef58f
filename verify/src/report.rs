//! The page: what crosses the interface, tables of agreements, pictures, seeded faults, and what is not cross-checked.

use crate::check::{Agreement, Standing};
use crate::crossing::{INPUTS, TOLERANCES, functions};
use crate::reference;
use ladder::faults::{Fault, FaultOutcome};
use numbers::number;
use std::fmt::{self, Write};

/// Everything the page is made of.
pub struct ComparisonReport {
    /// Title of a table, a sentence about it, its rows.
    pub sections: Vec<(&'static str, String, Vec<Agreement>)>,
    /// Seeded faults and variants, with what became of them.
    pub faults: Vec<(Fault, FaultOutcome)>,
}

const APART: &str = "Channels for which the errors of the two programs, estimated by runs of each with ten times the tolerance, are \
    more than 1e-4 of the range of the channel.";

impl ComparisonReport {
    fn rows(&self) -> impl Iterator<Item = &Agreement> {
        self.sections.iter().flat_map(|section| &section.2)
    }

    /// The page in Markdown.
    pub fn page(&self) -> Result<String, fmt::Error> {
        let mut page = String::new();
        self.head(&mut page)?;
        crossing(&mut page)?;
        for (title, text, rows) in &self.sections {
            table(
                &mut page,
                title,
                text,
                rows.iter().filter(|row| row.counts()),
            )?;
        }
        let apart = self.rows().filter(|row| row.standing == Standing::Apart);
        table(&mut page, "Compared, not counted", APART, apart)?;
        pictures(&mut page)?;
        self.seeded(&mut page)?;
        self.shared(&mut page)?;
        page += include_str!("../page/not-checked.md");
        Ok(page)
    }

    fn head(&self, page: &mut String) -> fmt::Result {
        let counted = || self.rows().filter(|row| row.counts());
        let (all, held) = (
            counted().count(),
            counted().filter(|row| row.holds()).count(),
        );
        let of = |standing| self.rows().filter(|row| row.standing == standing).count();
        let (apart, zeros) = (of(Standing::Apart), of(Standing::Zero));
        let (place, versions) = (records::place("comparison"), reference::versions());
        writeln!(
            page,
            "# Looselink against a second implementation\n\n{place}\n\
             [reference-cpp](../reference-cpp/README.md) is a C++ program, written from the paper and \
             [EQUATIONS.md](../EQUATIONS.md) with other methods: Gauss quadrature, automatic differentiation, constraint \
             equations for every ideal joint, a stabilised index-2 formulation, and IDA's variable-order BDF with root \
             finding. It reads the scene file itself and shares no code with Looselink. The last sections list what both take \
             from the same page, and what is not cross-checked.\n\n\
             **{held} of {all} comparisons agree within their tolerance.** {apart} more are compared and do not count, because \
             the runs are not accurate enough to say anything sharp; {zeros} find nothing but zeros on both sides and do not \
             count either. `cargo run --release -p verify` writes this \
             page; `cargo test -p verify` asserts the same rows. {versions}.\n",
        )
    }

    fn seeded(&self, page: &mut String) -> fmt::Result {
        let faults = || self.faults.iter().filter(|(f, _)| !f.is_variant());
        writeln!(
            page,
            "## Seeded faults\n\n{}\n\
             `cargo run --release -p ladder --bin faults` makes {} mistakes, one at a time, and records which of the faster \
             tests fail ([faults.toml](faults.toml) has the changed lines). The slower tests run only if no faster one \
             fails.\n\n| in | mistake | caught by |\n|---|---|---|",
            records::place("faults"),
            faults().count()
        )?;
        for (fault, outcome) in faults() {
            let language = ["Rust", "C++"][usize::from(fault.is_in_reference())];
            let (file, name) = (&fault.file, &fault.name);
            let (name, tests) = (cell(name), code(&outcome.caught_by));
            writeln!(page, "| {language} `{file}` | {name} | {tests} |")?;
        }
        writeln!(page)
    }

    fn shared(&self, page: &mut String) -> fmt::Result {
        *page += include_str!("../page/shared.md");
        for (variant, _) in self.faults.iter().filter(|(f, _)| f.is_variant()) {
            writeln!(
                page,
                "| {} | {} |",
                cell(&variant.name),
                code(&variant.tests)
            )?;
        }
        writeln!(page)
    }
}

fn pictures(page: &mut String) -> fmt::Result {
    writeln!(
        page,
        "## Pictures\n\n![Case 2: difference from IDA against the step](figures/convergence.png)\n"
    )?;
    let each = |case| {
        writeln!(
            page,
            "![Case {case}: Looselink and IDA, and their difference](figures/case{case}.png)\n"
        )
    };
    (2..=4).try_for_each(each)
}

/// The table of what goes into the reference and what comes out.
fn crossing(page: &mut String) -> fmt::Result {
    writeln!(
        page,
        "## What crosses the interface\n\n\
         Everything that the functions of [reference.h](../reference-cpp/include/reference.h) take. A test asserts that there is \
         nothing else. The only numbers among it that Looselink has computed are the states at which equations are compared.\n\n\
         | in | | meaning |\n|---|---|---|"
    )?;
    for (kind, name, meaning) in INPUTS {
        writeln!(page, "| `{name}` | `{kind}` | {meaning} |")?;
    }
    let fields = code(&TOLERANCES.map(String::from));
    writeln!(
        page,
        "\nFields of the tolerances: {fields}.\n\n| function | results |\n|---|---|"
    )?;
    for function in functions() {
        let results = function.results.into_iter().filter(|r| !r.is_empty());
        let results: Vec<String> = results.collect();
        if !results.is_empty() {
            writeln!(page, "| `{}` | {} |", function.name, code(&results))?;
        }
    }
    writeln!(page)
}

/// Text in a cell of a table.
fn cell(text: &str) -> String {
    text.replace('|', "\\|")
}

/// Names in the style of code.
fn code(names: &[String]) -> String {
    let names: Vec<String> = names.iter().map(|name| format!("`{name}`")).collect();
    names.join(", ")
}

fn table<'a>(
    page: &mut String,
    title: &str,
    text: &str,
    rows: impl Iterator<Item = &'a Agreement>,
) -> fmt::Result {
    writeln!(
        page,
        "## {title}\n\n{text}\n\n\
         | | quantity | scene | Looselink | reference | difference | allowed | measure and reason |\n\
         |---|---|---|---|---|---|---|---|"
    )?;
    for row in rows {
        let verdict = if row.holds() { "✓" } else { "✗" };
        // enough digits to see the agreement
        let [rust, cpp] = [row.rust, row.cpp].map(|x| number(x, 10));
        let (difference, allowed) = (number(row.difference, 2), number(row.tolerance, 1));
        let [quantity, scene, reason] =
            [&row.quantity, &row.scene, &row.reason].map(|text| cell(text));
        writeln!(
            page,
            "| {verdict} | {quantity} | {scene} | {rust} | {cpp} | {difference} | {allowed} | {reason} |"
        )?;
    }
    writeln!(page)
}

//! VERIFICATION.md.

use crate::answer::short;
use crate::compare::{cell, link};
use crate::mutants::{MutantCounts, MutationRecord, Scope};
use crate::{Answer, Rung, constants};
use miette::{Result, miette};
use std::collections::BTreeMap;
use std::fmt::Write;

/// The page in Markdown. `pictures` are the rungs with a figure.
///
/// # Errors
/// A surviving mutant without a reason.
pub fn page(
    answers: &[Answer],
    pictures: &[Rung],
    constants: &constants::ConstantsRecord,
    mutants: &[(Scope, MutationRecord)],
    reasons: &BTreeMap<String, String>,
) -> Result<String> {
    let mut page = String::new();
    head(&mut page, answers);
    for rung in Rung::ALL {
        let (title, asks) = rung.title();
        put(&mut page, format!("## {title}\n\n{asks}\n"));
        if pictures.contains(&rung) {
            put(
                &mut page,
                format!("![{title}](pages/ladder/figures/{}.png)\n", slug(rung)),
            );
        }
        put(
            &mut page,
            "| | question | number | allowed | reason | test |\n|---|---|---|---|---|---|".into(),
        );
        for answer in answers.iter().filter(|a| a.rung == rung) {
            put(&mut page, row(answer));
        }
        put(&mut page, String::new());
    }
    numbers(&mut page, constants);
    mutation(&mut page, mutants, reasons)?;
    Ok(page)
}

/// File name of the figure of a rung.
pub fn slug(rung: Rung) -> String {
    rung.title().0.to_lowercase().replace(' ', "-")
}

fn row(answer: &Answer) -> String {
    let verdict = if answer.holds() { "✓" } else { "✗" };
    let cells = [
        verdict.to_owned(),
        cell(&answer.question),
        short(answer.number),
        answer.allowed.to_string(),
        cell(&answer.reason),
        link(answer),
    ];
    format!("| {} |", cells.join(" | "))
}

fn head(page: &mut String, answers: &[Answer]) {
    let held = answers.iter().filter(|a| a.holds()).count();
    put(
        page,
        format!(
            "# Verification\n\n\
             The questions form a ladder: each rung rests on those before it. Every row is a test with its number, the allowed \
             range and the reason for that range. **{held} of {} rows hold.** `cargo run --release -p ladder` runs the tests \
             and writes this page. `./test.sh --all` fails when a row fails, when the page lacks the row of a test or has a row \
             without a test, and when bound, reason or number of a row differ from those of the test. A number may differ by \
             5 % between machines, an order by 5 % of the width of its range. A number below 1e-9, or whose reason names \
             rounding, random draws or chaos, may differ by a factor of ten; one of random mechanisms by a factor of 1000 \
             ([pages/ladder/src/compare.rs](pages/ladder/src/compare.rs)).\n\n\
             | rung | rows | hold | closest to its bound |\n|---|---|---|---|",
            answers.len()
        ),
    );
    for rung in Rung::ALL {
        let rows: Vec<&Answer> = answers.iter().filter(|a| a.rung == rung).collect();
        let held = rows.iter().filter(|a| a.holds()).count();
        let nearest = rows.iter().max_by(|a, b| a.used().total_cmp(&b.used()));
        let nearest = nearest.map_or(String::new(), |a| {
            format!(
                "{} of {}: {}",
                short(a.number),
                a.allowed,
                cell(&a.question)
            )
        });
        let (title, _) = rung.title();
        put(
            page,
            format!(
                "| [{title}](#{}) | {} | {held} | {nearest} |",
                slug(rung),
                rows.len()
            ),
        );
    }
    put(page, String::new());
}

/// Which numbers of the kernels the property tests notice a change of.
fn numbers(page: &mut String, record: &constants::ConstantsRecord) {
    put(
        page,
        format!(
            "## Numbers of the kernels\n\n{}\n\
             `cargo run --release -p ladder --bin constants` changes every number of the element and of Bathe's scheme, one at a \
             time, by {} of the largest number in its table, and runs the property tests of mass, tangent and decay. A change is \
             caught when a test fails.\n\n| table | file | numbers | caught |\n|---|---|---|---|",
            records::place("constants"),
            numbers::number(record.change, 1),
        ),
    );
    for table in record.numbers.chunk_by(|a, b| a.table == b.table) {
        let caught = table.iter().filter(|n| !n.caught_by.is_empty()).count();
        let (name, file) = (&table[0].table, &table[0].file);
        put(
            page,
            format!("| {name} | `{file}` | {} | {caught} |", table.len()),
        );
    }
    put(page, String::new());
}

fn mutation(
    page: &mut String,
    records: &[(Scope, MutationRecord)],
    reasons: &BTreeMap<String, String>,
) -> Result<()> {
    put(
        page,
        format!(
            "## Mutation testing\n\n\
             [{}](https://mutants.rs) changes one operator, sign or return value at a time, and the tests run. \
             `cargo run --release -p ladder --bin mutate kernels` and `... mutate solver` repeat this; they need \
             `cargo install cargo-mutants cargo-nextest`.\n",
            records[0].1.tool
        ),
    );
    for (scope, record) in records {
        mutants(page, *scope, record, reasons)?;
    }
    Ok(())
}

fn mutants(
    page: &mut String,
    scope: Scope,
    record: &MutationRecord,
    reasons: &BTreeMap<String, String>,
) -> Result<()> {
    let total = record.total();
    put(
        page,
        format!(
            "### {}\n\n{}\n\
             Mutants {}. Of {} possible ones {} were drawn with seed {}; {} of them compile, and **{} of those are \
             caught**.\n\n\
             | folder | drawn | do not compile | caught | time out | survive |\n|---|---|---|---|---|---|",
            scope.title(),
            records::place(scope.name()),
            scope.describe(),
            record.possible,
            total.viable() + total.unviable,
            record.seed,
            total.viable(),
            numbers::percent((1e3 * record.caught()).floor() / 1e3),
        ),
    );
    let mut line = |name: &str, c: &MutantCounts| {
        let numbers = [
            c.viable() + c.unviable,
            c.unviable,
            c.caught,
            c.timeout,
            c.survived,
        ];
        let numbers = numbers.map(|n| n.to_string()).join(" | ");
        put(page, format!("| {name} | {numbers} |"));
    };
    for (folder, counts) in record.folders() {
        line(&format!("`{folder}`"), &counts);
    }
    line("all", &total);
    put(
        page,
        "\nSurviving mutants:\n\n| mutant | why no test fails |\n|---|---|".into(),
    );
    for survivor in &record.survivors {
        let reason = reasons
            .get(survivor)
            .ok_or_else(|| miette!("pages/ladder/survivors.toml has no reason for {survivor}"))?;
        put(page, format!("| `{}` | {} |", cell(survivor), cell(reason)));
    }
    put(page, String::new());
    Ok(())
}

fn put(page: &mut String, line: String) {
    writeln!(page, "{line}").expect("a string can be written to");
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Allowed;
    use crate::compare::stale;

    fn answer(question: &str, number: f64) -> Answer {
        Answer {
            rung: Rung::Routes,
            question: question.into(),
            number,
            allowed: Allowed::AtMost(1.0),
            reason: "a | b".into(),
            file: "tests/link.rs".into(),
            line: 1,
            curve: None,
        }
    }

    fn record() -> MutationRecord {
        MutationRecord {
            seed: 4,
            possible: 10,
            tool: "cargo-mutants".into(),
            files: [(
                "a.rs".to_owned(),
                MutantCounts {
                    caught: 3,
                    survived: 1,
                    ..MutantCounts::default()
                },
            )]
            .into(),
            survivors: vec!["a.rs:1:2: replace + with -".into()],
        }
    }

    #[test]
    fn a_page_has_the_rows_that_it_is_made_of() {
        let rows = [answer("one?", 0.1), answer("two?", 0.2)];
        let reasons = [(record().survivors[0].clone(), "equal".to_owned())].into();
        let page = page(
            &rows,
            &[],
            &constants::ConstantsRecord::load().unwrap(),
            &[(Scope::Kernels, record())],
            &reasons,
        )
        .unwrap();
        assert!(page.contains("75"), "the share of caught mutants");
        assert_eq!(stale(&page, &rows), [""; 0]);
    }

    #[test]
    fn a_survivor_needs_a_reason() {
        assert!(
            page(
                &[answer("one?", 0.1)],
                &[],
                &constants::ConstantsRecord::load().unwrap(),
                &[(Scope::Kernels, record())],
                &BTreeMap::new()
            )
            .is_err()
        );
    }
}

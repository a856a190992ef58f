//! One statement of the paper and what decides it.

use crate::decisions;
use crate::evidence::{Evidence, ReadSource};
use crate::shown::environment;
use crate::verdict::CriterionVerdict;
use miette::{IntoDiagnostic, Result, miette};
use serde::{Deserialize, Serialize};
use std::collections::HashMap;

/// All statements, without what was measured.
const STATEMENTS: &str = include_str!("../statements.toml");

/// What a verdict rests on.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Basis {
    /// A quantity of runs, which could have come out otherwise.
    #[default]
    Measurement,
    /// The equations or the scene: it could not have come out otherwise.
    Construction,
    /// A value that the paper does not give and the scene assumes.
    Assumption,
}

/// A statement as the paper has it; the texts are templates in statements.toml.
#[derive(Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct PrintedStatement {
    /// By which other parts of the report refer to it.
    pub key: String,
    /// Where the paper says it.
    pub place: String,
    /// What the paper says.
    pub says: String,
    /// What the runs give.
    pub measured: String,
    /// More of it.
    #[serde(default)]
    pub details: String,
    /// The condition under which the statement counts as holding.
    pub criterion: String,
    /// What the verdict rests on.
    #[serde(default)]
    pub basis: Basis,
    /// What is behind it.
    pub why: String,
}

/// The statements as printed.
fn printed() -> Result<Vec<PrintedStatement>> {
    let mut list: HashMap<String, Vec<PrintedStatement>> =
        toml::from_str(STATEMENTS).into_diagnostic()?;
    Ok(list.remove("statement").unwrap_or_default())
}

/// A statement that is decided.
#[derive(Debug, Serialize)]
pub struct Statement {
    /// Its number in the report.
    pub number: usize,
    /// The statement, its texts filled in.
    #[serde(flatten)]
    pub listed: PrintedStatement,
    /// How its criterion comes out.
    pub verdict: CriterionVerdict,
    /// The runs that it rests on, with their warnings.
    pub sources: Vec<ReadSource>,
    /// The commit of the data, where it is another than that of the figures.
    pub commit: Option<String>,
}

/// All statements, decided. `commit` is that of the ensembles, where it is another than that of the figures.
///
/// # Errors
/// An entry of statements.toml without a predicate or with a name that the predicate does not give.
pub fn all(evidence: &Evidence, commit: Option<&str>) -> Result<Vec<Statement>> {
    let templates = environment();
    let decided = |(mut listed, number): (PrintedStatement, usize)| {
        let key = listed.key.clone();
        let decide = decisions::find(&key).ok_or_else(|| miette!("nothing decides \"{key}\""))?;
        let (verdict, values) = decide(evidence);
        for text in [&mut listed.measured, &mut listed.details, &mut listed.why] {
            let filled = templates.render_str(text, &values);
            *text = filled.map_err(|e| miette!("statements.toml, \"{key}\": {e:#}"))?;
        }
        let sources = evidence.take_sources();
        let of_ensembles = sources.iter().any(|s| s.of_ensembles);
        Ok(Statement {
            number,
            listed,
            verdict,
            sources,
            commit: commit.filter(|_| of_ensembles).map(str::to_owned),
        })
    };
    printed()?.into_iter().zip(1..).map(decided).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashSet;

    #[test]
    fn every_statement_has_one_predicate_and_no_predicate_is_left() {
        let list = printed().unwrap();
        let keys: HashSet<&str> = list.iter().map(|s| s.key.as_str()).collect();
        assert_eq!(keys.len(), list.len());
        let predicates: HashSet<&str> = decisions::all().map(|(key, _)| key).collect();
        assert_eq!(keys, predicates);
    }
}

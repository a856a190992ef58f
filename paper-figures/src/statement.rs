//! The statements of the paper and what decides them: the values of REPRODUCTION.md and its page of the site.

use crate::decisions;
use crate::ensembles::EnsembleRecord;
use crate::evidence::Evidence;
use crate::figures::FigureRecord;
use crate::shown::environment;
use crate::timings::LINK;
use crate::variants::STARTS;
use crate::verdict::CriterionVerdict;
use miette::{IntoDiagnostic, Result, miette};
use minijinja::{Value, context};
use serde::{Deserialize, Serialize};
use std::collections::HashMap;

/// All statements, without what was measured.
const STATEMENTS: &str = include_str!("../statements.toml");

/// What a verdict rests on.
#[derive(Debug, Default, Deserialize, Serialize)]
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

/// A statement of the paper; the texts of statements.toml are templates, which are filled in when it is decided.
#[derive(Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Statement {
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
    /// How its criterion comes out; none before it is decided.
    #[serde(skip_deserializing)]
    pub verdict: Option<CriterionVerdict>,
    /// Whether it rests on the ensembles.
    #[serde(skip_deserializing)]
    pub of_ensembles: bool,
}

/// The statements as listed.
fn listed() -> Result<Vec<Statement>> {
    let mut list: HashMap<String, Vec<Statement>> = toml::from_str(STATEMENTS).into_diagnostic()?;
    Ok(list.remove("statement").unwrap_or_default())
}

/// The values of the templates.
///
/// # Errors
/// An entry of statements.toml without a predicate, or with a name that neither this nor all statements have.
pub fn values(figures: &FigureRecord, ensembles: &EnsembleRecord) -> Result<Value> {
    let evidence = Evidence::of(figures, ensembles);
    let (templates, of_all) = (environment(), evidence.values());
    let decided = |mut statement: Statement| {
        let key = statement.key.clone();
        let decide = decisions::all().find(|(known, _)| *known == key);
        let (_, decide) = decide.ok_or_else(|| miette!("nothing decides \"{key}\""))?;
        let (verdict, own) = decide(&evidence);
        statement.of_ensembles = evidence.asked();
        let values = context! { ..own, ..of_all.clone() };
        let Statement {
            measured,
            details,
            why,
            ..
        } = &mut statement;
        for text in [measured, details, why] {
            let filled = templates.render_str(text, &values);
            *text = filled.map_err(|e| miette!("statements.toml, \"{key}\": {e:#}"))?;
        }
        statement.verdict = Some(verdict);
        Ok(statement)
    };
    let statements: Vec<Statement> = listed()?.into_iter().map(decided).collect::<Result<_>>()?;
    let (length, axial, _) = LINK;
    let link = context! { length, axial };
    Ok(context! { statements, starts => STARTS, runs => figures.runs, link, ..of_all })
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashSet;

    #[test]
    fn every_statement_has_one_predicate_and_no_predicate_is_left() {
        let list = listed().unwrap();
        let keys: HashSet<&str> = list.iter().map(|s| s.key.as_str()).collect();
        assert_eq!(keys.len(), list.len());
        let predicates: HashSet<&str> = decisions::all().map(|(key, _)| key).collect();
        assert_eq!(keys, predicates);
    }
}

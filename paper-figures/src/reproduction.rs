//! What REPRODUCTION.md and its page of the site show.

use crate::ensembles::{EnsembleRecord, STARTS};
use crate::evidence::Evidence;
use crate::figures::FigureRecord;
use crate::pictures::CLAIMED;
use crate::statement::{self, Basis};
use crate::timings::LINK;
use crate::verdict::CriterionVerdict;
use miette::Result;
use minijinja::{Value, context};
use records::Record;

/// The values of the templates.
///
/// # Errors
/// A statement whose text asks for what its predicate does not give.
pub fn values(figures: &Record<FigureRecord>, ensembles: &Record<EnsembleRecord>) -> Result<Value> {
    let (of_figures, of_ensembles) = (&figures.origin.commit, &ensembles.origin.commit);
    let commit = (of_figures != of_ensembles).then_some(of_ensembles.as_str());
    let evidence = Evidence::of(figures, ensembles);
    let statements = statement::all(&evidence, commit)?;
    let count = |basis: Basis, verdict: CriterionVerdict| {
        let found = statements
            .iter()
            .filter(|s| s.listed.basis == basis && s.verdict == verdict);
        found.count()
    };
    let bases = [Basis::Measurement, Basis::Construction, Basis::Assumption];
    let counts = bases.map(|basis| {
        let [hold, fail] =
            [CriterionVerdict::Holds, CriterionVerdict::Fails].map(|v| count(basis, v));
        context! { basis, hold, fail }
    });
    let undecided = statements
        .iter()
        .filter(|s| s.verdict == CriterionVerdict::Undecided);
    let used = [3, 4].map(|case| evidence.chaotic(case).mean("bound_used"));
    let (length, axial, _) = LINK;
    Ok(context! {
        undecided => undecided.count(),
        statements, counts, used,
        starts => STARTS,
        runs => figures.results.runs,
        numbers => figures.results.numbers,
        claimed => CLAIMED,
        link => context! { length, axial },
        other_commit => commit,
    })
}

//! One statement of the paper and what decides it.

use crate::interval::CriterionVerdict;
use crate::warned::WarningSource;
use std::fmt::Write;

/// What a verdict rests on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Basis {
    /// A quantity of runs, which could have come out otherwise.
    Measurement,
    /// The equations or the scene: it could not have come out otherwise.
    Construction,
    /// A value that the paper does not give and the scene assumes.
    Assumption,
}

impl Basis {
    /// In words, after "decided".
    pub fn words(self) -> &'static str {
        match self {
            Basis::Measurement => "by measurement",
            Basis::Construction => "by construction",
            Basis::Assumption => "by an assumed value",
        }
    }
}

/// A statement.
pub struct Statement {
    /// By which other parts of the report refer to it.
    pub key: &'static str,
    /// Where the paper says it.
    pub place: &'static str,
    /// What the paper says.
    pub says: &'static str,
    /// What the runs give.
    pub measured: String,
    /// The condition under which the statement counts as holding.
    pub criterion: &'static str,
    /// How that condition comes out.
    pub verdict: CriterionVerdict,
    /// What the verdict rests on.
    pub basis: Basis,
    /// Measured over claimed, where the paper gives a number.
    pub factor: Option<f64>,
    /// What is behind it.
    pub why: String,
    /// The runs it comes from, with their warnings.
    pub sources: Vec<WarningSource>,
}

impl Statement {
    /// The verdict in words.
    pub fn verdict(&self) -> &'static str {
        match self.verdict {
            CriterionVerdict::Holds => "holds",
            CriterionVerdict::Fails => "**does not hold**",
            CriterionVerdict::Undecided => "undecided",
        }
    }

    /// The verdict and what it rests on.
    pub fn decided(&self) -> String {
        match self.verdict {
            CriterionVerdict::Undecided => "undecided".into(),
            _ => format!("{}, {}", self.verdict(), self.basis.words()),
        }
    }

    /// The row of the list of all statements.
    pub fn row(&self, number: usize) -> String {
        let says = self.says.replace('|', "\\|");
        format!(
            "| {number} | {} | {says} | {} |\n",
            self.place,
            self.decided()
        )
    }

    /// The paragraph with what decides it.
    pub fn paragraph(&self, number: usize) -> String {
        let mut text = format!(
            "### {number}. {}\n\n*{}* Verdict: {}.\n\n* Measured: {}",
            self.place,
            self.says,
            self.decided(),
            self.measured
        );
        if let Some(factor) = self.factor {
            let _ = write!(
                text,
                " The paper's number is {} times as large.",
                numbers::digits(1.0 / factor)
            );
        }
        let _ = write!(text, "\n* Criterion: {}.\n* {}\n", self.criterion, self.why);
        text += &from(&self.sources);
        text + "\n"
    }
}

/// The runs, each once, those without warnings together.
fn from(sources: &[WarningSource]) -> String {
    let mut reported: Vec<String> = Vec::new();
    let silent = sources.iter().filter(|s| s.warnings.is_empty());
    let mut names: Vec<&str> = silent.map(|s| s.name.as_str()).collect();
    names.sort_unstable();
    names.dedup();
    if !names.is_empty() {
        reported.push(format!("* Runs without warnings: {}.\n", names.join("; ")));
    }
    for source in sources.iter().filter(|s| !s.warnings.is_empty()) {
        let line = format!(
            "* Warnings of {}: {}.\n",
            source.name,
            source.warnings.join("; ")
        );
        if !reported.contains(&line) {
            reported.push(line);
        }
    }
    reported.concat()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn statement() -> Statement {
        Statement {
            key: "small",
            place: "Sect. 6",
            says: "|e| is small",
            measured: "|e| = 1.".into(),
            criterion: "|e| < 2",
            verdict: CriterionVerdict::Fails,
            basis: Basis::Measurement,
            factor: Some(0.5),
            why: "Because.".into(),
            sources: vec![WarningSource {
                name: "run 4".into(),
                warnings: vec!["clamps: 2".into()],
            }],
        }
    }

    #[test]
    fn bars_inside_a_cell_do_not_split_it() {
        let row = statement().row(7);
        assert_eq!(row.replace("\\|", "").matches('|').count(), 5);
        assert!(row.contains("**does not hold**, by measurement"));
    }

    #[test]
    fn warnings_stand_beside_the_verdict() {
        let text = statement().paragraph(7);
        assert!(text.contains("* Warnings of run 4: clamps: 2."));
        assert!(text.contains("The paper's number is 2 times as large."));
    }
}

//! One statement of the paper and what decides it.

/// A row of the reproduction table.
pub struct Statement {
    /// Where the paper says it.
    pub place: &'static str,
    /// What the paper says.
    pub says: &'static str,
    /// What the runs give, with the step.
    pub measured: String,
    /// The condition under which the statement counts as holding.
    pub criterion: &'static str,
    /// Whether the condition is met.
    pub holds: bool,
    /// Measured over claimed, where the paper gives a number.
    pub factor: Option<f64>,
    /// What is behind it.
    pub why: String,
}

impl Statement {
    /// The verdict in words.
    pub fn verdict(&self) -> String {
        let words = if self.holds {
            "holds"
        } else {
            "**does not hold**"
        };
        match self.factor {
            Some(factor) => format!(
                "{words}; measured is {} of the paper's value",
                plot::digits(factor)
            ),
            None => words.into(),
        }
    }

    /// The row in Markdown.
    pub fn row(&self) -> String {
        let cell = |text: &str| text.replace('|', "\\|");
        let measured = format!("{} *Criterion: {}*", self.measured, self.criterion);
        let cells = [self.place, self.says, &measured, &self.verdict(), &self.why].map(cell);
        format!("| {} |\n", cells.join(" | "))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bars_inside_a_cell_do_not_split_it() {
        let statement = Statement {
            place: "Sect. 6",
            says: "|e| is small",
            measured: "|e| = 1.".into(),
            criterion: "|e| < 2",
            holds: false,
            factor: Some(0.5),
            why: String::new(),
        };
        assert_eq!(statement.row().replace("\\|", "").matches('|').count(), 6);
        assert!(
            statement
                .row()
                .contains("**does not hold**; measured is 0.5 of")
        );
    }
}

//! One row of the ladder, and the folder that rows are kept in between the tests and the page.

use crate::Rung;
use miette::{IntoDiagnostic, Result, WrapErr, ensure};
use serde::{Deserialize, Serialize};
use std::fmt;
use std::fs::{self, File};
use std::path::Path;

/// What is allowed of a number.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Allowed {
    /// No more than this.
    AtMost(f64),
    /// Between these two.
    Between(f64, f64),
}

/// Errors that fall.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ErrorCurve {
    /// What the abscissa is, with its unit in brackets.
    pub abscissa: String,
    /// Abscissa and error.
    pub errors: Vec<(f64, f64)>,
}

/// A question with its answer.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Answer {
    /// Where it stands.
    pub rung: Rung,
    /// The question.
    pub question: String,
    /// Where published digits stand.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub source: Option<String>,
    /// The number obtained. Not a number is written as null.
    #[serde(deserialize_with = "number")]
    pub number: f64,
    /// What is allowed.
    pub allowed: Allowed,
    /// Why that.
    pub reason: String,
    /// Source file of the test.
    pub file: String,
    /// Line in it.
    pub line: u32,
    /// What an order was read from.
    pub curve: Option<ErrorCurve>,
}

fn number<'d, D: serde::Deserializer<'d>>(from: D) -> Result<f64, D::Error> {
    Ok(Option::<f64>::deserialize(from)?.unwrap_or(f64::NAN))
}

impl fmt::Display for Allowed {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Allowed::AtMost(tolerance) => write!(f, "≤ {}", short(*tolerance)),
            Allowed::Between(low, high) => write!(f, "{} … {}", short(*low), short(*high)),
        }
    }
}

/// Plain for numbers of ordinary size, powers of ten for others.
pub fn short(x: f64) -> String {
    if x == 0.0 || (1e-2..1e4).contains(&x.abs()) {
        return numbers::digits(x);
    }
    format!("{x:.1e}").replace(".0e", "e")
}

impl Answer {
    /// True when the number is allowed.
    pub fn holds(&self) -> bool {
        match self.allowed {
            Allowed::AtMost(tolerance) => self.number <= tolerance,
            Allowed::Between(low, high) => (low..=high).contains(&self.number),
        }
    }

    /// How much of what is allowed is used: 0 in the middle or at no error, 1 at the bound.
    pub fn used(&self) -> f64 {
        match self.allowed {
            Allowed::AtMost(tolerance) if tolerance > 0.0 => self.number / tolerance,
            Allowed::AtMost(_) => f64::from(u8::from(self.number > 0.0)),
            Allowed::Between(low, high) => {
                (self.number - 0.5 * (low + high)).abs() / (0.5 * (high - low))
            }
        }
    }

    /// Keeps the answer in a folder.
    ///
    /// # Errors
    /// A folder that cannot be written to, or a question that has been asked there before.
    pub fn write(&self, folder: &Path) -> Result<()> {
        fs::create_dir_all(folder).into_diagnostic()?;
        let slug = |c: char| {
            if c.is_ascii_alphanumeric() { c } else { '-' }
        };
        let name: String = self.question.chars().map(slug).collect();
        let name = format!("{:?}-{name}.json", self.rung);
        // a file that is there is an error: the question has been asked before
        let file = File::create_new(folder.join(name)).into_diagnostic();
        let file =
            file.wrap_err_with(|| format!("cannot keep the answer to: {}", self.question))?;
        serde_json::to_writer(file, self).into_diagnostic()
    }

    /// The answers of a folder, rung by rung and in the order of the tests' files.
    ///
    /// # Errors
    /// A folder that cannot be read or has no answers.
    pub fn read_all(folder: &Path) -> Result<Vec<Answer>> {
        let mut answers: Vec<Answer> = Vec::new();
        for entry in fs::read_dir(folder).into_diagnostic()? {
            let path = entry.into_diagnostic()?.path();
            let text = fs::read_to_string(&path).into_diagnostic()?;
            let answer = serde_json::from_str(&text).into_diagnostic();
            answers.push(answer.wrap_err_with(|| path.display().to_string())?);
        }
        ensure!(!answers.is_empty(), "no answers in {}", folder.display());
        answers.sort_by_cached_key(|x| (x.rung, x.file.clone(), x.line, x.question.clone()));
        Ok(answers)
    }
}

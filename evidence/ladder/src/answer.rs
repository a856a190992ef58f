//! One row of the ladder, and the folder that rows are kept in between the tests and the page.

use crate::Rung;
use miette::{IntoDiagnostic, Result, WrapErr, miette};
use serde::{Deserialize, Serialize};
use std::fmt;
use std::fs;
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

impl ErrorCurve {
    /// The first abscissa and the error there.
    pub fn start(&self) -> Option<(f64, f64)> {
        self.errors.first().copied()
    }
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
        let path = folder.join(format!("{:?}-{name}.json", self.rung));
        if path.exists() {
            return Err(miette!("asked twice: {}", self.question));
        }
        let text = serde_json::to_string_pretty(self).into_diagnostic()?;
        // under another name first: another program never sees half an answer
        let draft = path.with_extension("draft");
        fs::write(&draft, text)
            .and_then(|()| fs::rename(&draft, &path))
            .into_diagnostic()
            .wrap_err_with(|| format!("cannot write {}", path.display()))
    }

    /// The answers of a folder, rung by rung and in the order of the tests' files.
    ///
    /// # Errors
    /// A folder that cannot be read or has no answers.
    pub fn read_all(folder: &Path) -> Result<Vec<Answer>> {
        let mut answers: Vec<Answer> = Vec::new();
        let entries = fs::read_dir(folder)
            .into_diagnostic()
            .wrap_err_with(|| format!("cannot read {}", folder.display()))?;
        for entry in entries {
            let path = entry.into_diagnostic()?.path();
            if path.extension().is_some_and(|e| e == "json") {
                let text = fs::read_to_string(&path).into_diagnostic()?;
                let answer = serde_json::from_str(&text).into_diagnostic();
                answers.push(answer.wrap_err_with(|| path.display().to_string())?);
            }
        }
        if answers.is_empty() {
            return Err(miette!("no answers in {}", folder.display()));
        }
        answers.sort_by(|a, b| {
            let key = |x: &Answer| (x.rung, x.file.clone(), x.line, x.question.clone());
            key(a).cmp(&key(b))
        });
        Ok(answers)
    }
}

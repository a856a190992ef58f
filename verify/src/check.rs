//! One agreement: two numbers, their difference, what is allowed and why.

use ladder::Rung;
use serde::{Deserialize, Serialize};

/// What a row is worth.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Standing {
    /// It counts.
    Counted,
    /// The runs are not accurate enough to say anything sharp: it is compared, and does not count.
    Apart,
    /// Both sides have nothing but zeros.
    Zero,
}

/// A row of the table.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Agreement {
    /// What is compared.
    pub quantity: String,
    /// Where.
    pub scene: String,
    /// Looselink's number, at the place of the largest difference.
    pub rust: f64,
    /// The reference's number there.
    pub cpp: f64,
    /// The difference, in the measure of the tolerance.
    pub difference: f64,
    /// The largest difference that passes.
    pub tolerance: f64,
    /// The measure of the difference and the reason of the tolerance.
    pub reason: String,
    /// Whether it counts.
    pub standing: Standing,
}

impl Agreement {
    /// True when the difference is a number within the tolerance.
    pub fn holds(&self) -> bool {
        self.difference <= self.tolerance
    }

    /// True of a row that counts.
    pub fn counts(&self) -> bool {
        self.standing == Standing::Counted
    }
}

/// Asserts every row and names those that fail; on the ladder the one that comes nearest to its tolerance stands for those that count.
#[track_caller]
pub fn assert_all(what: &str, rows: &[Agreement]) {
    let failed = rows.iter().filter(|row| !row.holds()).map(|r| {
        format!(
            "{} of {}: {:e} and {:e} differ by {:e}, allowed {:e} ({})\n",
            r.quantity, r.scene, r.rust, r.cpp, r.difference, r.tolerance, r.reason
        )
    });
    let failed: String = failed.collect();
    // a difference of exactly nothing uses nothing of a tolerance of nothing
    let used = |row: &Agreement| match row.difference {
        0.0 => 0.0,
        difference => difference / row.tolerance,
    };
    let counted = || rows.iter().filter(|row| row.counts());
    let nearest = counted().max_by(|a, b| used(a).total_cmp(&used(b)));
    let nearest = nearest.expect("something was compared");
    let (quantity, scene) = (&nearest.quantity, &nearest.scene);
    Rung::Codes
        .asks(format!("{what}: {} agreements", counted().count()))
        .within(
            nearest.difference,
            nearest.tolerance,
            &format!("{quantity} of {scene}; {}", nearest.reason),
        );
    assert!(failed.is_empty(), "{failed}");
}

/// The largest of many differences, with the two numbers at its place.
#[derive(Debug, Clone, Copy, Default)]
pub struct LargestDifference {
    pub rust: f64,
    pub cpp: f64,
    pub difference: f64,
    /// The largest magnitude of all numbers.
    pub size: f64,
    /// True once something was compared.
    pub is_seen: bool,
}

impl LargestDifference {
    /// Looks at two numbers whose difference is measured in units of `scale`. A difference that is not a number stays;
    /// among equal ones the larger numbers are kept.
    pub fn see(&mut self, rust: f64, cpp: f64, scale: f64) {
        let difference = (rust - cpp).abs() / scale;
        let larger = difference == self.difference && cpp.abs() > self.cpp.abs();
        let size = self.size.max(rust.abs()).max(cpp.abs());
        if difference.is_nan() || difference > self.difference || larger {
            *self = LargestDifference {
                rust,
                cpp,
                difference,
                ..*self
            };
        }
        (self.size, self.is_seen) = (size, true);
    }

    /// Looks at two vectors, measured in units of `scale`.
    pub fn see_scaled(&mut self, rust: &[f64], cpp: &[f64], scale: f64) {
        assert_eq!(rust.len(), cpp.len(), "vectors of one length are compared");
        for (r, c) in rust.iter().zip(cpp) {
            self.see(*r, *c, scale);
        }
    }

    /// The row. It does not count if all numbers are zero.
    pub fn row(self, quantity: &str, scene: &str, tolerance: f64, reason: &str) -> Agreement {
        assert!(self.is_seen, "{quantity} of {scene}: nothing was compared");
        Agreement {
            quantity: quantity.into(),
            scene: scene.into(),
            rust: self.rust,
            cpp: self.cpp,
            difference: self.difference,
            tolerance,
            reason: reason.into(),
            standing: match self.size {
                0.0 => Standing::Zero,
                _ => Standing::Counted,
            },
        }
    }
}

/// The largest magnitude of a vector.
pub fn largest(x: &[f64]) -> f64 {
    x.iter().fold(0.0, |m, x| m.max(x.abs()))
}

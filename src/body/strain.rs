//! How much a body deforms.

use crate::checkpoint::carried;
use numbers::number;
use serde::Serialize;

/// The largest strains of a body: over its length, or over its length and time.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct Strain {
    /// Green strain eps = (r'.r' - 1)/2 of the centre line, of largest magnitude and with its sign.
    pub axial: f64,
    /// |r''| h with the height h of the section in the plane; half of it is the strain of the outermost fibres.
    pub bending: f64,
}

carried!(Strain { axial, bending } but {});

impl Strain {
    /// Keeps the larger of two strains.
    pub fn see(&mut self, other: &Strain) {
        if other.axial.abs() > self.axial.abs() {
            self.axial = other.axial;
        }
        self.bending = self.bending.max(other.bending);
    }

    /// The magnitude of the larger of the two.
    pub fn largest(&self) -> f64 {
        self.axial.abs().max(self.bending)
    }

    /// The larger of the two in words.
    pub fn description(&self) -> String {
        match self.bending > self.axial.abs() {
            true => format!("a curvature times height of {}", number(self.bending, 2)),
            false => format!("a strain of {}", number(self.axial, 2)),
        }
    }
}

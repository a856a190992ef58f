//! The hard cases: of each what must hold, with the number that was found.
//!
//! Every check is made by a test in `pages/stability/tests/cases.rs`; those that take minutes are made by `stability long`.

mod clearance;
mod contact;
mod flexible;
mod long;
mod rigid;
mod schemes;
mod shipped;

use crate::outcome::{Stopped, record};
use looselink::scene::Scene;
use looselink::simulate::{Recording, Report};
use serde::{Deserialize, Serialize};
use std::ops::RangeInclusive;
use std::path::Path;

/// One criterion with its number.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Check {
    /// What was asked, with the unit.
    pub criterion: String,
    /// What was found.
    pub value: f64,
    /// Least value that is right ...
    pub least: f64,
    /// ... and greatest.
    pub greatest: f64,
}

impl Check {
    fn new(criterion: impl Into<String>, value: f64, right: RangeInclusive<f64>) -> Check {
        Check {
            criterion: criterion.into(),
            value,
            least: *right.start(),
            greatest: *right.end(),
        }
    }

    /// A number that must be small.
    fn below(criterion: impl Into<String>, value: f64, greatest: f64) -> Check {
        // numbers without sign come as such, and an energy gained may be negative
        Check::new(criterion, value, f64::MIN..=greatest)
    }

    /// Something that happened or did not.
    fn yes(criterion: impl Into<String>, happened: bool) -> Check {
        Check::new(criterion, f64::from(u8::from(happened)), 1.0..=1.0)
    }

    /// Whether the number is right.
    pub fn holds(&self) -> bool {
        (self.least..=self.greatest).contains(&self.value)
    }

    /// The bound in words.
    pub fn bound(&self) -> String {
        match (self.least, self.greatest) {
            (1.0, 1.0) => "yes".to_owned(),
            (f64::MIN, greatest) => format!("at most {}", numbers::number(greatest, 4)),
            (least, f64::MAX) => format!("at least {}", numbers::number(least, 4)),
            (least, greatest) => format!("{least} to {greatest}"),
        }
    }

    /// The number in words.
    pub fn number(&self) -> String {
        match (self.least, self.greatest, self.value) {
            (1.0, 1.0, 1.0) => "yes".to_owned(),
            (1.0, 1.0, _) => "no".to_owned(),
            (_, _, value) => numbers::number(value, 4),
        }
    }
}

/// A hard case.
#[derive(Debug, Clone, Copy)]
pub struct HardCase {
    /// Its number on the page.
    pub number: usize,
    /// What is hard about it.
    pub title: &'static str,
    /// Makes its checks.
    pub checks: fn() -> Vec<Check>,
    /// Makes those that take long.
    pub long: Option<fn() -> Vec<Check>>,
}

/// All of them.
pub const CASES: [HardCase; 15] = [
    HardCase::new(1, "Stiff springs and trusses", schemes::stiff_springs).with(long::revolutions),
    HardCase::new(2, "Spring from 1e3 to 1e12 N/m", schemes::three_springs),
    HardCase::new(3, "Flexible link spinning free", flexible::spinning_link)
        .with(long::spinning_link),
    HardCase::new(4, "Clearance from 1 mm to 1 nm", clearance::limit),
    HardCase::new(5, "Restitution and contact stiffness", contact::restitution),
    HardCase::new(
        6,
        "Young's modulus to the rigid limit",
        flexible::rigid_limit,
    ),
    HardCase::new(7, "Platform from 1 g to 10 t", flexible::platform_mass),
    HardCase::new(
        8,
        "Grazing, resting, chattering, six at once",
        contact::onsets,
    ),
    HardCase::new(9, "Stick and slip", contact::stick_slip),
    HardCase::new(10, "Singular poses", rigid::singular_poses),
    HardCase::new(11, "50,000 rpm", contact::speed),
    HardCase::new(12, "256 elements, slenderness 1e4", flexible::elements),
    HardCase::new(13, "Steps 10 and 100 times too long", shipped::long_steps),
    HardCase::new(14, "Redundant constraints", rigid::redundant),
    HardCase::new(15, "Ten million steps", long::shorter).with(long::ten_million_steps),
];

impl HardCase {
    const fn new(number: usize, title: &'static str, checks: fn() -> Vec<Check>) -> HardCase {
        HardCase {
            number,
            title,
            checks,
            long: None,
        }
    }

    const fn with(self, long: fn() -> Vec<Check>) -> HardCase {
        HardCase {
            long: Some(long),
            ..self
        }
    }
}

/// A scene below `scenes/` with overrides.
fn load(scene: &str, overrides: &[&str]) -> Scene {
    let path = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../../scenes")
        .join(scene);
    let overrides: Vec<String> = overrides.iter().map(|s| (*s).to_owned()).collect();
    Scene::load(&path, &overrides).unwrap_or_else(|e| panic!("{scene}: {e}"))
}

/// Runs a scene, which may stop.
fn try_run(scene: &str, overrides: &[&str]) -> Result<(Recording, Report), Stopped> {
    record(&load(scene, overrides))
}

/// Runs a scene that must reach its end.
fn run(scene: &str, overrides: &[&str]) -> (Recording, Report) {
    try_run(scene, overrides).unwrap_or_else(|e| panic!("{scene} {overrides:?}: {e}"))
}

/// A channel over time.
fn column<'a>(recording: &'a Recording, name: &str) -> &'a [f64] {
    let column = recording.get(name);
    column.unwrap_or_else(|| panic!("no channel {name}"))
}

/// Largest magnitude.
fn largest(values: impl IntoIterator<Item = f64>) -> f64 {
    values.into_iter().fold(0.0, |m, x| x.abs().max(m))
}

/// Largest difference of a channel of two runs.
fn apart(a: &Recording, b: &Recording, name: &str) -> f64 {
    let pairs = column(a, name).iter().zip(column(b, name));
    largest(pairs.map(|(a, b)| a - b))
}

/// Least and greatest energy lost by the integrator over the energy in play; a negative loss is a gain.
fn lost(report: &Report) -> [f64; 2] {
    let integration = report.integration.as_ref().expect("a dynamic run");
    integration.lost.map(|lost| lost / integration.turnover)
}

/// Energy gained by the integrator over the energy in play.
fn gain(report: &Report) -> f64 {
    -lost(report)[0]
}

/// Energy lost or gained by the integrator over the energy in play, whichever is more.
fn imbalance(report: &Report) -> f64 {
    largest(lost(report))
}

/// Order of y in x between two points.
fn order(coarse: (f64, f64), fine: (f64, f64)) -> f64 {
    (coarse.1 / fine.1).ln() / (coarse.0 / fine.0).ln()
}

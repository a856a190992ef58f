//! The hard cases: of each what must hold, with the number that was found. The criteria are in `evidence/cases.toml`.

mod clearance;
mod contact;
mod flexible;
mod long;
mod rigid;
mod schemes;
mod shipped;

use crate::stability::outcome::{Stopped, largest, record};
use looselink::scene::Scene;
use looselink::simulate::{Recording, Report};
use miette::{IntoDiagnostic, Result, ensure};
use records::root;
use serde::{Deserialize, Serialize};

/// What is asked of a number.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Criterion {
    /// The question, with the unit.
    pub asks: String,
    /// Least value that is right ...
    pub least: Option<f64>,
    /// ... and greatest.
    pub most: Option<f64>,
}

/// A hard case.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct HardCase {
    /// What is hard about it.
    pub title: String,
    /// What is asked by tests,
    pub checks: Vec<Criterion>,
    /// and by the campaign `long`.
    #[serde(default)]
    pub long: Vec<Criterion>,
}

/// A criterion with the number that was found.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Check {
    /// Number of its case, from 1.
    pub case: usize,
    /// What is asked.
    pub criterion: Criterion,
    /// What was found; none where it is no number.
    pub value: Option<f64>,
}

impl Check {
    /// Whether the number is right.
    pub fn holds(&self) -> bool {
        let Criterion { least, most, .. } = self.criterion;
        let right = |x| least.is_none_or(|least| least <= x) && most.is_none_or(|most| x <= most);
        self.value.is_some_and(right)
    }
}

/// What computes the numbers of a case.
type Numbers = fn() -> Vec<f64>;

/// In the order of the cases: the numbers of tests, and those that take minutes.
const NUMBERS: [(Numbers, Option<Numbers>); 15] = [
    (schemes::stiff_springs, Some(schemes::revolutions)),
    (schemes::three_springs, None),
    (flexible::spinning_link, Some(long::spinning_link)),
    (clearance::limit, None),
    (contact::restitution, None),
    (flexible::rigid_limit, None),
    (flexible::platform_mass, None),
    (contact::onsets, None),
    (contact::stick_slip, None),
    (rigid::singular_poses, None),
    (contact::speed, None),
    (flexible::elements, None),
    (shipped::long_steps, None),
    (rigid::redundant, None),
    (long::shorter, Some(long::ten_million_steps)),
];

/// The cases.
///
/// # Errors
/// A file that is no list of them.
pub fn cases() -> Result<Vec<HardCase>> {
    #[derive(Deserialize)]
    struct File {
        case: Vec<HardCase>,
    }
    let text = std::fs::read_to_string(root().join("evidence/cases.toml")).into_diagnostic()?;
    let file: File = toml::from_str(&text).into_diagnostic()?;
    let count = file.case.len();
    ensure!(count == NUMBERS.len(), "{count} cases");
    Ok(file.case)
}

/// Makes the checks of a case, or those that take minutes.
///
/// # Errors
/// Criteria that are not as many as the numbers.
pub fn checks(case: usize, long: bool) -> Result<Vec<Check>> {
    let asked = cases()?.swap_remove(case - 1);
    let (criteria, numbers) = match (long, NUMBERS[case - 1]) {
        (false, (numbers, _)) => (asked.checks, numbers()),
        (true, (_, numbers)) => (asked.long, numbers.map_or(Vec::new(), |numbers| numbers())),
    };
    let (asked, found) = (criteria.len(), numbers.len());
    ensure!(
        asked == found,
        "case {case}: {found} numbers for {asked} criteria"
    );
    let check = |(criterion, value): (Criterion, f64)| Check {
        case,
        criterion,
        value: value.is_finite().then_some(value),
    };
    Ok(criteria.into_iter().zip(numbers).map(check).collect())
}

/// 1 for yes.
fn yes(happened: bool) -> f64 {
    f64::from(u8::from(happened))
}

/// A scene below `scenes/` with overrides, separated by semicolons.
fn load(scene: &str, overrides: &str) -> Scene {
    let overrides = overrides.split("; ").filter(|set| !set.is_empty());
    let overrides: Vec<String> = overrides.map(str::to_owned).collect();
    let loaded = Scene::load(&root().join("scenes").join(scene), &overrides);
    loaded.unwrap_or_else(|e| panic!("{scene}: {e}"))
}

/// Runs a scene, which may stop.
fn try_run(scene: &str, overrides: &str) -> Result<(Recording, Report), Stopped> {
    record(&load(scene, overrides))
}

/// Runs a scene that must reach its end.
fn run(scene: &str, overrides: &str) -> (Recording, Report) {
    try_run(scene, overrides).unwrap_or_else(|e| panic!("{scene} {overrides}: {e}"))
}

/// A channel over time.
fn column<'a>(recording: &'a Recording, name: &str) -> &'a [f64] {
    let column = recording.get(name);
    column.unwrap_or_else(|| panic!("no channel {name}"))
}

/// Largest magnitude of a channel.
fn amplitude(recording: &Recording, name: &str) -> f64 {
    largest(column(recording, name).iter().copied())
}

/// Largest difference of a channel of two runs.
fn apart(a: &Recording, b: &Recording, name: &str) -> f64 {
    let pairs = column(a, name).iter().zip(column(b, name));
    largest(pairs.map(|(a, b)| a - b))
}

/// Over several overrides: the largest difference of a channel from a run with a finer step, and the largest imbalance.
fn refined<const N: usize>(
    scene: &str,
    channel: &str,
    settings: [String; N],
    steps: [&str; 2],
) -> Vec<f64> {
    let found = settings.map(|set| {
        let runs = steps.map(|step| run(scene, &format!("{set}; integrator.step={step}")));
        let [(coarse, report), (fine, _)] = runs;
        (apart(&coarse, &fine, channel), imbalance(&report))
    });
    vec![largest(found.map(|f| f.0)), largest(found.map(|f| f.1))]
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

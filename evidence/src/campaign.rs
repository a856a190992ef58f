//! What can be measured, and what is made of it.

use crate::output::{Data, Output};
use crate::{accuracy, benchmarks, comparison, gallery, paper, stability, verification};
use miette::{IntoDiagnostic, Result, miette};
use records::Journal;
use serde::Serialize;
use serde_json::Value;

/// Something that no test repeats: one file in `evidence/data`.
pub struct Campaign {
    /// Name of its file, and of the argument of `record`.
    pub name: &'static str,
    /// Budget on two cores \[min\].
    pub minutes: u32,
    /// Seeds of what is drawn at random.
    pub seeds: &'static str,
    /// Measures; what is finished is kept in the journal.
    pub measure: fn(&Journal) -> Result<Value>,
}

/// All campaigns, in the order in which `record` runs them.
pub fn all() -> impl Iterator<Item = &'static Campaign> {
    const LISTS: [&[Campaign]; 7] = [
        &accuracy::CAMPAIGNS,
        &[benchmarks::CAMPAIGN],
        &[comparison::CAMPAIGN],
        &paper::CAMPAIGNS,
        &stability::CAMPAIGNS,
        &verification::CAMPAIGNS,
        &[gallery::CAMPAIGN],
    ];
    LISTS.into_iter().flatten()
}

/// What makes pages and pictures of records.
pub struct Renderer {
    /// Campaigns whose records it reads.
    pub records: &'static [&'static str],
    /// Makes them.
    pub render: fn(&Data, &mut Output) -> Result<()>,
}

/// All renderers.
pub const RENDERERS: [&Renderer; 7] = [
    &accuracy::RENDERER,
    &benchmarks::RENDERER,
    &comparison::RENDERER,
    &paper::RENDERER,
    &stability::RENDERER,
    &verification::RENDERER,
    &gallery::RENDERER,
];

/// Results as they are kept.
///
/// # Errors
/// Results that JSON cannot express.
pub fn results(results: impl Serialize) -> Result<Value> {
    serde_json::to_value(results).into_diagnostic()
}

/// The campaign of this name.
///
/// # Errors
/// Another name, with a list of those that there are.
pub fn find(name: &str) -> Result<&'static Campaign> {
    let names: Vec<&str> = all().map(|c| c.name).collect();
    let found = all().find(|c| c.name == name);
    found.ok_or_else(|| {
        miette!(
            "no campaign is called {name}; there are {}",
            names.join(", ")
        )
    })
}

#[cfg(test)]
mod tests {
    use super::all;

    /// Six hours on two cores for all of them.
    const MINUTES: u32 = 360;

    #[test]
    fn campaigns_fit_in_their_budget() {
        let minutes: u32 = all().map(|c| c.minutes).sum();
        assert!(minutes <= MINUTES, "{minutes} min");
    }

    #[test]
    fn every_record_names_its_commit() {
        let folder = records::root().join("evidence/data");
        for file in std::fs::read_dir(folder).unwrap() {
            let path = file.unwrap().path();
            let record: records::Record<serde_json::Value> = records::Record::read(&path).unwrap();
            let commit = record.origin.commit;
            let is_commit = commit.len() == 12 && commit.chars().all(|c| c.is_ascii_hexdigit());
            assert!(is_commit, "{}: {commit:?}", path.display());
        }
    }
}

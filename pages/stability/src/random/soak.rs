//! Many random scenes, one after the other, and a tally of what became of them.

use super::{RunOutcome, draw, genes, judge};
use proptest::strategy::{Strategy, ValueTree};
use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::io;
use std::path::Path;
use std::time::Duration;

/// No scene takes a hundredth of this, however busy the machine.
const GUARD: Duration = Duration::from_secs(600);

/// What became of the scenes; nothing in it differs when the soak is repeated.
#[derive(Debug, Default, Serialize, Deserialize)]
pub struct SoakTally {
    /// Seed of the soak.
    pub seed: u64,
    /// Scenes run.
    pub scenes: u64,
    /// How they ended.
    pub outcomes: BTreeMap<String, u64>,
    /// Remarks on runs that came to their end: a run can have several.
    pub remarks: BTreeMap<String, u64>,
    /// Causes of errors and of refusals, numbers and names left out.
    pub causes: BTreeMap<String, u64>,
    /// How they ended, by what is in them: kind of mechanism, method, parts.
    pub features: BTreeMap<String, BTreeMap<String, u64>>,
    /// Scenes of which a property does not hold: their number and the property.
    pub failures: Vec<SoakFailure>,
}

/// A scene of which a property does not hold.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct SoakFailure {
    /// Its number.
    pub scene: u64,
    /// The property.
    pub property: String,
    /// How it does not hold.
    pub detail: String,
}

/// Scene `index` of a seed.
pub fn scene(seed: u64, index: u64) -> super::RandomScene {
    let mut bytes = [0; 32];
    bytes[..8].copy_from_slice(&seed.to_le_bytes());
    bytes[8..16].copy_from_slice(&index.to_le_bytes());
    let rng = TestRng::from_seed(RngAlgorithm::ChaCha, &bytes);
    let mut runner = TestRunner::new_with_rng(Config::default(), rng);
    let tree = genes()
        .new_tree(&mut runner)
        .expect("genes are not filtered");
    draw(&tree.current())
}

/// The cause of an error: what stands between its colons, without numbers and names of the scene.
fn cause(text: &str) -> String {
    let plain = |word: &str| !word.chars().any(|c| c.is_ascii_digit());
    let words = text.split([' ', '\n']).filter(|w| plain(w));
    words.collect::<Vec<_>>().join(" ")
}

impl SoakTally {
    /// An empty tally.
    pub fn new(seed: u64) -> SoakTally {
        SoakTally {
            seed,
            ..SoakTally::default()
        }
    }

    /// Runs scene `index`; a failing one is written to the folder.
    ///
    /// # Errors
    /// A file that cannot be written.
    pub fn run(&mut self, index: u64, folder: &Path) -> io::Result<()> {
        let drawn = scene(self.seed, index);
        self.scenes += 1;
        let class = match judge(&drawn.text, Some(GUARD)) {
            Ok(outcome) => {
                match &outcome {
                    RunOutcome::Remarked(remarks) => {
                        for remark in remarks {
                            *self.remarks.entry((*remark).to_owned()).or_default() += 1;
                        }
                    }
                    RunOutcome::Stopped(text) | RunOutcome::Refused(text) => {
                        *self.causes.entry(cause(text)).or_default() += 1;
                    }
                    RunOutcome::Finished | RunOutcome::CutShort => {}
                }
                outcome.class()
            }
            Err(breach) => {
                std::fs::create_dir_all(folder)?;
                let path = folder.join(format!("seed{}-{index}.toml", self.seed));
                let text = format!("# {}: {}\n{}", breach.property, breach.detail, drawn.text);
                std::fs::write(path, text)?;
                self.failures.push(SoakFailure {
                    scene: index,
                    property: breach.property.to_owned(),
                    detail: breach.detail,
                });
                "failed"
            }
        };
        *self.outcomes.entry(class.to_owned()).or_default() += 1;
        for feature in drawn.features {
            let of = self.features.entry(feature.to_owned()).or_default();
            *of.entry(class.to_owned()).or_default() += 1;
        }
        Ok(())
    }
}

//! Many random scenes, one after the other, and a tally of what became of them.

use super::run::breach;
use super::{Breach, RunOutcome, draw, genes, judge};
use crate::stability::outcome::gist;
use miette::Result;
use proptest::strategy::{Strategy, ValueTree};
use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};
use records::{Journal, threads};
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::time::{Duration, Instant};

/// Seed of the campaign.
const SEED: u64 = 1;
/// Scenes of the campaign ...
const SCENES: u64 = 10_000;
/// ... and of one item of its journal.
const PART: u64 = 250;
/// A scene that takes so long hangs: none takes a hundredth of it, however busy the machine.
const GUARD: Duration = Duration::from_secs(600);

/// Genes of scene `index` of the soak.
fn genes_of(index: u64) -> Vec<f64> {
    let mut bytes = [0; 32];
    bytes[..8].copy_from_slice(&SEED.to_le_bytes());
    bytes[8..16].copy_from_slice(&index.to_le_bytes());
    let rng = TestRng::from_seed(RngAlgorithm::ChaCha, &bytes);
    let mut runner = TestRunner::new_with_rng(Config::default(), rng);
    let tree = genes().new_tree(&mut runner);
    tree.expect("genes are not filtered").current()
}

/// What became of a scene: tables of the tally with the names that count in them, and its failure.
type SoakedScene = (Vec<(String, String)>, Option<Value>);

/// Runs the scenes of the campaign: how they ended; remarks on complete runs, of which one can have several; causes of errors
/// and of refusals; and the scenes of which a property does not hold. Nothing in it differs when the soak is repeated.
///
/// # Errors
/// A journal that cannot be written.
pub fn measure(journal: &Journal) -> Result<Value> {
    // a panic is a failure that is written down; its message is not for the terminal
    std::panic::set_hook(Box::new(|_| {}));
    let parts: Vec<u64> = (0..SCENES).step_by(PART as usize).collect();
    let run = |first: &u64| Ok((*first..*first + PART).map(soak).collect::<Vec<_>>());
    let soaked = journal.items(
        &parts,
        threads(),
        |first| format!("scenes from {first}"),
        run,
    );
    let _ = std::panic::take_hook();
    let mut tallies: BTreeMap<String, BTreeMap<String, u64>> = BTreeMap::new();
    let mut failures = Vec::new();
    for (counts, failure) in soaked?.into_iter().flatten() {
        for (table, name) in counts {
            let table = tallies.entry(table).or_default();
            *table.entry(name).or_default() += 1;
        }
        failures.extend(failure);
    }
    Ok(json!({ "seed": SEED, "scenes": SCENES, "tallies": tallies, "failures": failures }))
}

fn soak(index: u64) -> SoakedScene {
    let text = draw(&genes_of(index));
    let begun = Instant::now();
    let judged = match judge(&text) {
        Ok(_) if begun.elapsed() > GUARD => breach("no hang", format!("{:?}", begun.elapsed())),
        judged => judged,
    };
    let count = |table: &str, name: &str| (table.to_owned(), name.to_owned());
    let outcome = match judged {
        Ok(outcome) => outcome,
        Err(Breach { property, detail }) => {
            let failure = json!({
                "scene": index, "property": property, "detail": detail, "text": text
            });
            return (vec![count("outcomes", "failed")], Some(failure));
        }
    };
    let mut counts = vec![count("outcomes", outcome.name())];
    match &outcome {
        RunOutcome::Remarked(remarks) => {
            counts.extend(remarks.iter().map(|remark| count("remarks", &gist(remark))));
        }
        RunOutcome::Stopped(text) | RunOutcome::Refused(text) => {
            counts.push(count("causes", &gist(text)));
        }
        RunOutcome::Finished | RunOutcome::CutShort => {}
    }
    (counts, None)
}

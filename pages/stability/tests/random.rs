//! Random mechanisms: what must hold of every run.

use proptest::test_runner::{Config, RngAlgorithm, TestCaseError, TestRng, TestRunner};
use stability::random::{draw, genes, judge};
use std::path::Path;

/// Scenes of a run of the tests: about half a minute.
const CASES: u32 = 300;

/// A few hundred scenes, the same ones every time; `cargo run --release -p stability -- soak` runs as many others as one likes.
#[test]
fn random_mechanisms_keep_their_promises() {
    let config = Config {
        cases: CASES,
        failure_persistence: None,
        // a failing scene is run a few hundred times to make it plain
        max_shrink_iters: 400,
        ..Config::default()
    };
    let rng = TestRng::deterministic_rng(RngAlgorithm::ChaCha);
    let run = TestRunner::new_with_rng(config, rng).run(&genes(), |genes| {
        let drawn = draw(&genes);
        match judge(&drawn.text, None) {
            Ok(_) => Ok(()),
            Err(breach) => Err(TestCaseError::fail(format!(
                "{}: {}\n{}",
                breach.property, breach.detail, drawn.text
            ))),
        }
    });
    if let Err(proptest::test_runner::TestError::Fail(reason, _)) = run {
        panic!("{reason}");
    }
}

/// Every scene of the folder keeps what is asked of random ones.
#[test]
fn hard_scenes_keep_their_promises() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/hard");
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let text = std::fs::read_to_string(&path).unwrap();
        let text = text.lines().map(|line| match line.starts_with("channels") {
            true => "channels = [\"*\"]",
            false => line,
        });
        let text = text.collect::<Vec<_>>().join("\n");
        judge(&text, None).unwrap_or_else(|b| panic!("{path:?}: {}: {}", b.property, b.detail));
    }
}

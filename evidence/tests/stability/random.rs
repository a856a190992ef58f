//! Random mechanisms: what must hold of every run.

use evidence::stability::random::{draw, genes, judge};
use proptest::test_runner::{Config, RngAlgorithm, TestCaseError, TestError, TestRng, TestRunner};
use records::root;

/// Scenes of a run of the tests: about half a minute.
const CASES: u32 = 300;

/// A few hundred scenes, the same ones every time; the campaign `soak` runs ten thousand others.
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
        let text = draw(&genes);
        judge(&text).map(drop).map_err(|breach| {
            let text = format!("{}: {}\n{text}", breach.property, breach.detail);
            TestCaseError::fail(text)
        })
    });
    if let Err(TestError::Fail(reason, _)) = run {
        panic!("{reason}");
    }
}

/// Every scene of the folder keeps what is asked of random ones.
#[test]
fn hard_scenes_keep_their_promises() {
    for entry in std::fs::read_dir(root().join("scenes/hard")).unwrap() {
        let path = entry.unwrap().path();
        let text = std::fs::read_to_string(&path).unwrap();
        let text = text.lines().map(|line| match line.starts_with("channels") {
            true => "channels = [\"*\"]",
            false => line,
        });
        let text = text.collect::<Vec<_>>().join("\n");
        judge(&text).unwrap_or_else(|b| panic!("{path:?}: {}: {}", b.property, b.detail));
    }
}

//! Text → study → the scenes of its runs.
#![no_main]

use fuzz::{Pool, is_toml, mutate, show, studies};
use libfuzzer_sys::{Corpus, fuzz_mutator, fuzz_target};
use std::path::Path;
use std::sync::LazyLock;
use studies::StudyError;
use studies::precision::Study;

static POOL: LazyLock<Pool> = LazyLock::new(studies);

const STUDY: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../studies/fuzzed.toml");
const SCENE: &str = concat!(
    env!("CARGO_MANIFEST_DIR"),
    "/../scenes/slider-crank/both.toml"
);

fuzz_target!(
    init: { POOL.write("study") },
    |data: &[u8]| -> Corpus {
        let Ok(text) = std::str::from_utf8(data) else {
            return Corpus::Reject;
        };
        match check(text) {
            Err(StudyError::Plain(message)) => assert!(message.len() > 10),
            Err(StudyError::Scene(error)) => show(error),
            Ok(()) => {}
        }
        if is_toml(text) { Corpus::Keep } else { Corpus::Reject }
    }
);

fuzz_mutator!(|data: &mut [u8], size: usize, max_size: usize, seed: u32| {
    mutate(data, size, max_size, seed, 4, &POOL)
});

fn check(text: &str) -> Result<(), StudyError> {
    let mut study = Study::parse(STUDY.as_ref(), text)?;
    // the scenes of the project only: a fuzzer must not read whatever file it names
    let studied = study.scene.file_name();
    let known = [
        "pendulum.toml",
        "bouncing-journal.toml",
        "soft-pendulum.toml",
    ];
    study.scene = match known.iter().find(|name| studied == Some(name.as_ref())) {
        Some(name) => Path::new(SCENE).with_file_name("..").join(name),
        None => SCENE.into(),
    };
    let reference = &study.reference;
    for pace in reference.paces() {
        study.scene(&reference.set, reference.elements, pace)?;
    }
    for curve in study.curves.iter().take(4) {
        for pace in curve.paces().into_iter().take(2) {
            let _ = pace.to_string();
            study.scene(&curve.set, curve.elements, pace)?;
        }
    }
    Ok(())
}

//! What the targets do with an input. Each returns whether changed inputs may go on from it.

use crate::OVERRIDE;
use looselink::body::FlexibleLink;
use looselink::scene::{Scene, SceneError};
use looselink::simulate::Simulation;
use std::path::Path;
use studies::StudyError;
use studies::precision::Study;

/// A link with more elements is not compiled: what is looked for here is no matter of size.
const ELEMENTS: usize = 64;

const STUDY: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../studies/fuzzed.toml");
const SCENE: &str = concat!(
    env!("CARGO_MANIFEST_DIR"),
    "/../scenes/slider-crank/both.toml"
);

/// Text and overrides → scene, or a fault that can be shown.
pub fn scene(text: &str) -> bool {
    if let Err(error) = read(text) {
        show(error);
    }
    is_toml(text)
}

/// Scene → compiled mechanism, or a fault that can be shown.
pub fn mechanism(text: &str) -> bool {
    let small = read(text).ok().filter(is_small);
    if let Some(scene) = &small {
        match Simulation::new(scene) {
            Ok(simulation) => assert!(!simulation.channels().is_empty()),
            Err(error) => show(error),
        }
    }
    small.is_some()
}

/// Text → study → the scenes of its runs.
pub fn study(text: &str) -> bool {
    match scenes_of(text) {
        Err(StudyError::Plain(message)) => assert!(message.len() > 10),
        Err(StudyError::Scene(error)) => show(error),
        Ok(()) => {}
    }
    is_toml(text)
}

/// Reads a scene whose overrides stand in its comments.
fn read(text: &str) -> Result<Scene, SceneError> {
    let overrides = text.lines().filter_map(|line| line.strip_prefix(OVERRIDE));
    let overrides: Vec<String> = overrides.map(str::to_owned).collect();
    Scene::parse("scene.toml", text, &overrides)
}

/// Shows a fault as the command line does; it has a place and something to say.
fn show(error: SceneError) {
    assert!(!error.to_string().is_empty());
    assert!(
        error
            .place()
            .is_some_and(|(_, line, column)| line > 0 && column > 0)
    );
    assert!(!format!("{:?}", miette::Report::new(error)).is_empty());
}

/// True of a text that a changed seed may go on from: faults of the syntax are mostly ends, and far more of them than of
/// anything else are found, each new to the parser.
fn is_toml(text: &str) -> bool {
    text.parse::<toml::Table>().is_ok()
}

fn is_small(scene: &Scene) -> bool {
    let links = scene
        .bodies
        .iter()
        .filter_map(|body| body.kind.get::<FlexibleLink>());
    links.map(|link| link.elements).all(|n| n <= ELEMENTS)
}

fn scenes_of(text: &str) -> Result<(), StudyError> {
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Pool, mutate, scenes, studies};

    /// A target goes on from every seed, and from some that are changed.
    fn takes(check: fn(&str) -> bool, pool: &Pool) {
        let changed_is_kept = |(n, seed): (usize, &String)| {
            assert!(check(seed), "{seed}");
            let mut data = seed.clone().into_bytes();
            data.resize(2 * seed.len(), 0);
            let most = data.len();
            let same = |_: &mut [u8], size, _| size;
            let size = mutate(&mut data, seed.len(), most, n as u32, u32::MAX, pool, same);
            check(std::str::from_utf8(&data[..size]).unwrap())
        };
        let kept = pool.seeds.iter().enumerate().map(changed_is_kept);
        assert!(kept.filter(|kept| *kept).count() > 1);
    }

    #[test]
    fn targets_take_their_seeds() {
        let pool = scenes();
        takes(scene, &pool);
        takes(mechanism, &pool);
        takes(study, &studies());
    }
}

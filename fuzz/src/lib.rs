//! Random input under a coverage-guided fuzzer. The seeds are the scenes and studies of the project and the examples of
//! docs/scene.md, the dictionary is the words of the two documents; nothing is copied.
//!
//! | target | what it does | what it goes on from |
//! |---|---|---|
//! | `scene` | reads a scene with overrides, shows its fault | whatever is TOML |
//! | `mechanism` | compiles a scene | whatever is a scene |
//! | `study` | reads a study and the scenes of its runs | whatever is TOML |
//!
//! On a new machine, from the root of the project (stable Rust will do):
//!
//! ```text
//! cargo install cargo-fuzz
//! fuzz/run.sh 1200 1800 600   # seconds of each; writes evidence/data/fuzz.json
//! ```
//!
//! An input that fails is left in `fuzz/artifacts`. What is fixed stands, made small, in tests/stability/input.rs.

mod mutate;
mod seeds;

pub use mutate::mutate;
pub use seeds::{Pool, scenes, studies};

use looselink::scene::{Scene, SceneError};

/// Overrides are comments of this form, so that a seed with overrides stays a scene.
const OVERRIDE: &str = "#set ";

/// Reads a scene whose overrides stand in its comments.
pub fn scene(text: &str) -> Result<Scene, SceneError> {
    let overrides = text.lines().filter_map(|line| line.strip_prefix(OVERRIDE));
    let overrides: Vec<String> = overrides.map(str::to_owned).collect();
    Scene::parse("scene.toml", text, &overrides)
}

/// Shows a fault as the command line does; it has a place and something to say.
pub fn show(error: SceneError) {
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
pub fn is_toml(text: &str) -> bool {
    text.parse::<toml::Table>().is_ok()
}

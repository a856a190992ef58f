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
mod targets;

pub use mutate::mutate;
pub use seeds::{Pool, scenes, studies};
pub use targets::{mechanism, scene, study};

/// Overrides are comments of this form, so that a seed with overrides stays a scene.
const OVERRIDE: &str = "#set ";

/// The entry points of a target that libFuzzer calls: its name, what it goes on from, what it does with an input, and one in
/// how many changes is one of bytes.
#[cfg(fuzzing)]
#[macro_export]
macro_rules! target {
    ($name:literal, $pool:path, $check:path, $bytes_in:literal) => {
        use libfuzzer_sys::Corpus;

        static POOL: std::sync::LazyLock<$crate::Pool> = std::sync::LazyLock::new($pool);

        libfuzzer_sys::fuzz_target!(
            init: { POOL.write($name) },
            |data: &[u8]| -> Corpus {
                match std::str::from_utf8(data).is_ok_and($check) {
                    true => Corpus::Keep,
                    false => Corpus::Reject,
                }
            }
        );

        libfuzzer_sys::fuzz_mutator!(|data: &mut [u8], size: usize, most: usize, seed: u32| {
            let bytes = libfuzzer_sys::fuzzer_mutate;
            $crate::mutate(data, size, most, seed, $bytes_in, &POOL, bytes)
        });
    };
}

/// Without the instrumentation of cargo-fuzz a target is a program that says how to run it.
#[cfg(not(fuzzing))]
#[macro_export]
macro_rules! target {
    ($name:literal, $pool:path, $check:path, $bytes_in:literal) => {
        fn main() {
            println!(
                "cargo fuzz run {} checks {} seeds",
                $name,
                $pool().seeds.len()
            );
        }
    };
}

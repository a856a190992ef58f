//! Text and overrides → scene, or a fault that can be shown.
#![no_main]

use fuzz::{Pool, is_toml, mutate, scene, scenes, show};
use libfuzzer_sys::{Corpus, fuzz_mutator, fuzz_target, fuzzer_mutate};
use std::sync::LazyLock;

static POOL: LazyLock<Pool> = LazyLock::new(scenes);

fuzz_target!(
    init: { POOL.write("scene") },
    |data: &[u8]| -> Corpus {
        let Ok(text) = std::str::from_utf8(data) else {
            return Corpus::Reject;
        };
        if let Err(error) = scene(text) {
            show(error);
        }
        if is_toml(text) { Corpus::Keep } else { Corpus::Reject }
    }
);

fuzz_mutator!(|data: &mut [u8], size: usize, max_size: usize, seed: u32| {
    // bytes at random in one case of four
    let by_line = (seed % 4 != 0).then(|| mutate(data, size, max_size, seed, &POOL));
    by_line
        .flatten()
        .unwrap_or_else(|| fuzzer_mutate(data, size, max_size))
});

//! Text and overrides → scene, or a fault that can be shown.
#![no_main]

use fuzz::{Pool, is_toml, mutate, scene, scenes, show};
use libfuzzer_sys::{Corpus, fuzz_mutator, fuzz_target};
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
    mutate(data, size, max_size, seed, 4, &POOL)
});

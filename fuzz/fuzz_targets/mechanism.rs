//! Scene → compiled mechanism, or a fault that can be shown.
#![no_main]

use fuzz::{Pool, mutate, scene, scenes, show};
use libfuzzer_sys::{Corpus, fuzz_mutator, fuzz_target};
use looselink::body::FlexibleLink;
use looselink::scene::Scene;
use looselink::simulate::Simulation;
use std::sync::LazyLock;

/// A link with more elements is not compiled: what is looked for here is no matter of size.
const ELEMENTS: usize = 64;

static POOL: LazyLock<Pool> = LazyLock::new(scenes);

fuzz_target!(
    init: { POOL.write("mechanism") },
    |data: &[u8]| -> Corpus {
        let text = std::str::from_utf8(data).unwrap_or_default();
        match scene(text) {
            Ok(scene) if is_small(&scene) => {
                match Simulation::new(&scene) {
                    Ok(simulation) => assert!(!simulation.channels().is_empty()),
                    Err(error) => show(error),
                }
                Corpus::Keep
            }
            _ => Corpus::Reject,
        }
    }
);

fuzz_mutator!(|data: &mut [u8], size: usize, max_size: usize, seed: u32| {
    mutate(data, size, max_size, seed, 8, &POOL)
});

fn is_small(scene: &Scene) -> bool {
    let links = scene
        .bodies
        .iter()
        .filter_map(|body| body.kind.get::<FlexibleLink>());
    links.map(|link| link.elements).all(|n| n <= ELEMENTS)
}

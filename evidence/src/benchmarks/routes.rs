//! The elastic force and tangent of an element, by three routes that give the same numbers (tests/kernels.rs).

use cpu_time::ThreadTime;
use looselink::link::{AncfCable, ElasticRoute, GaussCable, LiteralCable};
use serde::{Deserialize, Serialize};
use std::hint::black_box;
use studies::machine::median;

/// Length \[m\] and rigidities \[N, N m2\] of the paper's passive link.
const LINK: [f64; 3] = [0.242, 1.05e6, 2.1875];
/// Evaluations that are timed together.
const COUNT: u32 = 100_000;
/// Times of which the median counts; the routes take turns.
const TURNS: usize = 9;

/// A route.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct RouteCost {
    /// Its name.
    pub name: String,
    /// Processor time of an evaluation of force and tangent \[s\].
    pub seconds: f64,
}

/// Times all routes.
pub fn measure() -> Vec<RouteCost> {
    let [length, ea, ei] = LINK;
    let (reduced, gauss, literal) = (
        AncfCable::new(length, ea, ei),
        GaussCable::new(length, ea, ei),
        LiteralCable::new(length, ea, ei),
    );
    let mut seconds = [(); 3].map(|()| Vec::new());
    for _ in 0..TURNS {
        seconds[0].push(time(&reduced));
        seconds[1].push(time(&gauss));
        seconds[2].push(time(&literal));
    }
    let names = ["reduced tensor", "five-point Gauss", "literal invariants"];
    let routes = names.into_iter().zip(seconds);
    let routes = routes.map(|(name, seconds)| RouteCost {
        name: name.to_owned(),
        seconds: median(&seconds),
    });
    routes.collect()
}

/// An element turned, stretched and bent a little.
fn time(route: &impl ElasticRoute) -> f64 {
    let (s, c) = 0.7_f64.sin_cos();
    let end = [0.1 + LINK[0] * c * 1.0001, -0.2 + LINK[0] * s];
    let q = [0.1, -0.2, c + 1e-4, s, end[0], end[1], c, s - 1e-3];
    let clock = ThreadTime::now();
    for _ in 0..COUNT {
        let (mut force, mut tangent) = ([0.0; 8], [[0.0; 8]; 8]);
        route.force_and_tangent(black_box(&q), &mut force, &mut tangent);
        black_box((force, tangent));
    }
    clock.elapsed().as_secs_f64() / f64::from(COUNT)
}

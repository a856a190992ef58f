//! What an elastic force and its Jacobian cost, route by route.

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use looselink::link::{AncfCable, ElasticRoute, GaussCable, LiteralCable};
use std::hint::black_box;

const LENGTH: f64 = 0.242;
const EA: f64 = 1.05e6;
const EI: f64 = 2.1875;

/// An element of the paper's passive link, turned, stretched and bent a little.
fn state() -> [f64; 8] {
    let (s, c) = 0.7_f64.sin_cos();
    [
        0.1,
        -0.2,
        c + 1e-4,
        s,
        0.1 + LENGTH * c * 1.0001,
        -0.2 + LENGTH * s,
        c,
        s - 1e-3,
    ]
}

fn evaluate(route: &impl ElasticRoute, q: &[f64; 8]) -> ([f64; 8], [[f64; 8]; 8]) {
    let (mut f, mut k) = ([0.0; 8], [[0.0; 8]; 8]);
    route.force_and_tangent(q, &mut f, &mut k);
    (f, k)
}

/// The routes agree before any is timed: forces to the rounding of EA, tangents to that of their largest entry.
fn agree(a: &impl ElasticRoute, b: &impl ElasticRoute) {
    let q = state();
    let ((f, k), (g, l)) = (evaluate(a, &q), evaluate(b, &q));
    for i in 0..8 {
        assert!((f[i] - g[i]).abs() < 1e-12 * EA, "{} {}", f[i], g[i]);
        for j in 0..8 {
            assert!((k[i][j] - l[i][j]).abs() < 1e-12 * EA / LENGTH);
        }
    }
}

fn route(criterion: &mut Criterion, name: &str, kernel: impl ElasticRoute) {
    let q = state();
    let mut group = criterion.benchmark_group("elastic");
    group.bench_function(BenchmarkId::new("force", name), |b| {
        b.iter(|| {
            let mut f = [0.0; 8];
            kernel.force(black_box(&q), &mut f);
            f
        });
    });
    group.bench_function(BenchmarkId::new("force_and_tangent", name), |b| {
        b.iter(|| evaluate(&kernel, black_box(&q)));
    });
    group.finish();
}

fn routes(criterion: &mut Criterion) {
    let (reduced, gauss, literal) = (
        AncfCable::new(LENGTH, EA, EI),
        GaussCable::new(LENGTH, EA, EI),
        LiteralCable::new(LENGTH, EA, EI),
    );
    agree(&reduced, &gauss);
    agree(&reduced, &literal);
    route(criterion, "reduced tensor", reduced);
    route(criterion, "five-point Gauss", gauss);
    route(criterion, "literal invariants", literal);
}

criterion_group!(benches, routes);
criterion_main!(benches);

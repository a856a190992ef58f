//! What one Bathe step of the paper's four cases costs, in the middle of its motion.

use criterion::{Criterion, criterion_group, criterion_main};
use looselink::newton::Newton;
use looselink::scene::Scene;
use looselink::simulate::Simulation;
use looselink::system::System;
use std::path::Path;

const STEP: f64 = 1e-5;

fn steps(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("bathe_step");
    for case in 1..=4 {
        let path =
            Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../scenes/3rrr/case{case}.toml"));
        let simulation = |duration: &str| {
            let overrides = [duration, "integrator.step=1e-5", "output.interval=1e-2"];
            let scene = Scene::load(&path, &overrides.map(str::to_owned))
                .expect("a scene of the project is valid");
            let simulation = Simulation::new(&scene).expect("a scene of the project compiles");
            (scene, simulation)
        };
        // a quarter of a cycle in, past the first impacts
        let (_, mut first) = simulation("simulation.duration=0.25");
        first.run(&mut ()).expect("a scene of the project runs");
        let (from, mut to) = (first.state().clone(), first.state().clone());
        // the same mechanism with time left, as it has in the middle of a run
        let (scene, simulation) = simulation("simulation.duration=0.5");
        let model = simulation.model();
        let mut newton = Newton::new(model, scene.integrator.newton_tolerance_for(1.0));
        let mut work = model.work();
        let mut stepper = scene.integrator.method.stepper(model.shape());
        group.bench_function(format!("case{case}"), |b| {
            b.iter(|| stepper.step(model, &from, from.t + STEP, &mut to, &mut newton, &mut work));
        });
    }
    group.finish();
}

criterion_group!(benches, steps);
criterion_main!(benches);

//! Links that bend, from chains to bars.

use super::{apart, column, gain, imbalance, load, lost, order, refined, run};
use crate::stability::outcome::largest;
use looselink::simulate::{Recording, Simulation};
use looselink::system::System;

/// Angular momentum about the origin \[kg m2/s\]: a turn changes every pair of coordinates, of nodes and of slopes, as a vector.
fn spin(simulation: &Simulation) -> f64 {
    let at = simulation.state();
    let mut momentum = vec![0.0; at.q.len()];
    simulation.model().momentum(&at.v, &mut momentum);
    let pairs = at.q.chunks(2).zip(momentum.chunks(2));
    pairs.map(|(q, p)| q[0] * p[1] - q[1] * p[0]).sum()
}

/// What a free flight of the link changes, relative: the velocity of the centre of mass, by its largest deviation; the energy
/// gained, and lost; the angular momentum.
pub(super) fn fly(step: f64, duration: f64, rows: usize) -> [f64; 4] {
    let settings = format!("integrator.step={step}; simulation.duration={duration}");
    let rows = format!("{settings}; output.interval={}", duration / rows as f64);
    let scene = load("hard/spinning-link.toml", &rows);
    let mut simulation = Simulation::new(&scene).expect("a shipped scene");
    let before = spin(&simulation);
    let mut recording = Recording::new(&simulation);
    simulation.run(&mut recording).expect("a flight to its end");
    let after = spin(&simulation);
    let report = simulation.report();
    let [vx, vy] = ["rod.vx", "rod.vy"].map(|name| column(&recording, name));
    let drift = [vx, vy].map(|v| largest(v.iter().map(|x| x - v[0])));
    let linear = largest(drift) / vx[0].hypot(vy[0]);
    let angular = (after / before - 1.0).abs();
    [linear, gain(&report), lost(&report)[1], angular]
}

pub(super) fn spinning_link() -> Vec<f64> {
    fly(5e-4, 50.0, 100).to_vec()
}

pub(super) fn rigid_limit() -> Vec<f64> {
    let settings = "simulation.duration=0.02; output.interval=1e-3; integrator.step=1e-5";
    let (rigid, _) = run("3rrr/case1.toml", settings);
    let [soft, stiff, stiffest] = [7e9, 7e11, 7e13].map(|modulus| {
        let set = format!("{settings}; materials.passive.youngs_modulus={modulus:e}");
        let (flexible, _) = run("3rrr/case2.toml", &set);
        (modulus, apart(&flexible, &rigid, "platform.x"))
    });
    vec![order(soft, stiff), stiffest.1]
}

pub(super) fn platform_mass() -> Vec<f64> {
    let masses = [5e-4, 5e-3, 5e-2, 5e-1, 5.0, 5e1, 5e2, 5e3].map(|mass: f64| {
        format!("simulation.duration=0.006; output.interval=2e-4; bodies.platform.mass={mass}")
    });
    refined("3rrr/case4.toml", "platform.x", masses, ["2e-6", "2.5e-7"])
}

pub(super) fn elements() -> Vec<f64> {
    let settings = "simulation.duration=0.2; output.interval=0.02; integrator.step=1e-3";
    let run = |more: &str| run("soft-pendulum.toml", &format!("{settings}; {more}"));
    let tip = |n: usize| {
        let (rows, _) = run(&format!("bodies.rod.elements={n}"));
        ["points.rod.end.x", "points.rod.end.y"].map(|name| column(&rows, name)[rows.rows() - 1])
    };
    let exact = tip(256);
    let error = |n: usize| {
        let [x, y] = tip(n);
        (1.0 / n as f64, (x - exact[0]).hypot(y - exact[1]))
    };
    vec![
        order(error(4), error(16)),
        error(128).1,
        imbalance(&run("sections.rod.width=1.2e-4").1),
        imbalance(&run("sections.rod.width=0.12").1),
    ]
}

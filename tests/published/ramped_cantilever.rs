//! A cantilever under a load at its tip that grows within two seconds, data of García-Vallejo et al. (2004), in the
//! functional of this element (I).

use super::listed;
use crate::support::{TestRecording, run};
use ladder::{Rung, Worst};
use std::f64::consts::PI;

const SCENE: &str = "ramped-cantilever.toml";
const LISTED: &str = include_str!("ramped_cantilever.csv");

/// The load in the direction of y \[N\].
fn load(t: f64) -> f64 {
    if t < 2.0 {
        -250.0 * (1.0 - (0.5 * PI * t).cos())
    } else {
        -500.0
    }
}

/// An override with a spline through the load at `intervals` equal intervals of its growth. Rows that lie close together
/// before and after let its second derivative jump there.
fn spline(intervals: u32) -> String {
    let outside = [1e-9, 1e-7, 1e-5, 1e-3, 1e-1];
    let before = [-1.0]
        .into_iter()
        .chain(outside.iter().rev().map(|t| -t))
        .map(|t| (t, 0.0));
    let growth = (0..=intervals).map(|k| 2.0 * f64::from(k) / f64::from(intervals));
    let after = outside.iter().map(|t| 2.0 + t).chain([10.0]);
    let rows: Vec<String> = before
        .chain(growth.chain(after).map(|t| (t, load(t))))
        .map(|(t, load)| format!("[{t:?}, {load:?}]"))
        .collect();
    let rows = rows.join(", ");
    format!("forces.tip.y={{ type = \"table\", rows = [{rows}] }}")
}

/// Largest errors of place \[m\], velocity \[m/s\] and energies \[J\] of the listed times.
fn errors(run: &TestRecording, elements: usize) -> [f64; 3] {
    let of = |q: &str| run.get(&format!("points.beam.end.{q}"));
    let [x, y, vx, vy] = ["x", "y", "vx", "vy"].map(of);
    let [axial, bending, kinetic] =
        ["axial", "bending", "kinetic"].map(|e| run.get(&format!("energy.{e}")));
    let worst = [Worst::new(), Worst::new(), Worst::new()];
    let listed = listed(LISTED);
    let of_mesh: Vec<_> = listed.iter().filter(|r| r[0] == elements as f64).collect();
    assert_eq!(of_mesh.len(), 41);
    for listed in of_mesh {
        let row = run.row(listed[1]);
        worst[0].see((x[row] - listed[2]).hypot(y[row] - listed[3]));
        worst[1].see((vx[row] - listed[4]).hypot(vy[row] - listed[5]));
        worst[2].see(axial[row] + bending[row] - listed[6]);
        worst[2].see(kinetic[row] - listed[7]);
    }
    worst.each_ref().map(Worst::value)
}

#[test]
fn the_cantilever_follows_the_listed_motion() {
    let spline = spline(400);
    let [places, velocities, energies] = [Worst::new(), Worst::new(), Worst::new()];
    for (elements, step) in [(1, 5e-4), (2, 5e-4), (4, 5e-4), (8, 2.5e-4)] {
        let step = format!("integrator.step={step:?}");
        let elements_key = format!("bodies.beam.elements={elements}");
        let (run, _) = run(
            SCENE,
            &["output.interval=0.25", &step, &elements_key, &spline],
        );
        let [place, velocity, energy] = errors(&run, elements);
        places.at(format!("with {elements} elements"));
        places.see(place);
        velocities.see(velocity);
        energies.see(energy);
    }
    const DIGITS: &str = "relative tolerance of 1e-10 of the reference integration";
    Rung::Computed
        .asks("Ramped cantilever, n = 1 ... 8: listed positions of the tip over 10 s [m]")
        .within(&places, 1e-9, &format!("{DIGITS}, on 5 m"));
    Rung::Computed
        .asks("Ramped cantilever, n = 1 ... 8: listed velocities of the tip over 10 s [m/s]")
        .within(
            &velocities,
            1e-7,
            &format!("{DIGITS} on 5 m, times 1000 rad/s of the vibrations"),
        );
    Rung::Computed
        .asks("Ramped cantilever, n = 1 ... 8: listed strain and kinetic energies over 10 s [J]")
        .within(&energies, 1e-6, &format!("{DIGITS}, on 2000 J"));
}

/// The scene has a spline through fewer points.
#[test]
fn the_scene_has_the_load_of_the_paper() {
    let (run, _) = run(SCENE, &[]);
    let worst = Worst::new();
    for (t, force) in run.get("t").iter().zip(run.get("tip.fy")) {
        worst.see(force - load(*t));
    }
    // 5/384 h^4 |f''''| bounds cubic splines
    Rung::Routes
        .asks("Scene of the ramped cantilever: load against 250 (1 - cos(pi t/2)) N [N]")
        .within(
            &worst,
            5.0 / 384.0 * 0.02_f64.powi(4) * 250.0 * (0.5 * PI).powi(4),
            "error bound of a cubic spline through points 0.02 s apart",
        );
    Rung::Computed
        .asks("Scene of the ramped cantilever: listed positions of the tip over 10 s [m]")
        .within(
            errors(&run, 4)[0],
            3e-8,
            "the error bound of the load, relative to 500 N, is 6e-9; times a displacement of 5 m",
        );
}

//! Closed forms, computed and published digits, one family a file.
//!
//! Status of every number: E closed form, P published in a source that the row names, I computed once by another way than this
//! program's, with quadrature, collocation, DOP853 or extended precision.

mod andrews;
mod cantilever;
mod car_axis;
mod first_contact;
mod four_bar;
mod impact;
mod large_bending;
mod pendulum;
mod ramped_cantilever;
mod rotating_beam;
mod schemes;
mod spring_pendulum;

use crate::support::{TestRecording, run_scene};
use looselink::scene::Scene;

/// A scene from text.
fn scene(text: &str, overrides: &[String]) -> Scene {
    Scene::parse("published", text, overrides).unwrap_or_else(|e| panic!("{e} at {:?}", e.place()))
}

/// Runs a scene to its end.
fn run(text: &str, overrides: &[String]) -> TestRecording {
    run_scene(&scene(text, overrides)).0
}

/// The last value of a channel.
fn last(run: &TestRecording, channel: &str) -> f64 {
    run.get(channel).last().copied().unwrap_or(f64::NAN)
}

/// The numbers of a file of listed values, row by row: comments behind `#`, then a row of names.
fn listed(text: &str) -> Vec<Vec<f64>> {
    let rows = text.lines().filter(|line| !line.starts_with('#')).skip(1);
    let number = |cell: &str| cell.parse().unwrap_or_else(|e| panic!("`{cell}`: {e}"));
    rows.map(|row| row.split(',').map(number).collect())
        .collect()
}

/// A flexible link that starts along x from the origin, from EA, EI and rho A: a section of unit height and the width that gives EI/EA = width^2/12.
fn beam(length: f64, axial: f64, bending: f64, mass_per_length: f64, elements: usize) -> String {
    let width = (12.0 * bending / axial).sqrt();
    format!(
        r#"
[materials.beam]
density = {:?}
youngs_modulus = {:?}
[sections.beam]
width = {width:?}
height = 1.0
[initial.bodies]
beam = {{ x = {:?}, y = 0.0, theta = 0.0 }}
[bodies.ground]
type = "ground"
points.O = [0.0, 0.0]
[bodies.beam]
type = "link"
model = "flexible"
length = {length:?}
section = "beam"
material = "beam"
elements = {elements}
"#,
        mass_per_length / width,
        axial / width,
        0.5 * length,
    )
}

/// Head of a static scene with one row at the full load, reached in `steps` steps.
fn statics(steps: usize) -> String {
    format!(
        r#"
format = 1
title = "equilibrium"
[simulation]
analysis = "static"
duration = 1.0
[integrator]
method = "bathe"
step = {:?}
newton_tolerance = 1e-11
[output]
interval = 1.0
channels = ["points.*", "beam.strain", "energy.axial", "energy.bending"]
"#,
        1.0 / steps as f64
    )
}

const CLAMP: &str = r#"
[joints.clamp]
type = "weld"
first = "ground.O"
second = "beam.start"
"#;

//! Motions and loads given as formulas, and the accelerations of driven joints.

use crate::support::{difference, run};
use ladder::{Rung, Worst};
use std::f64::consts::{PI, TAU};

const SLIDER: &str = "harmonic-slider.toml";

/// The crank angle of the scene is an arc cosine of a quotient of squares of sines; the slider then moves harmonically.
#[test]
fn a_slider_moves_as_the_formula_of_its_crank_says() {
    let (recording, _) = run(SLIDER, &[]);
    let (t, w, a) = (recording.get("t"), 4.0 * PI, 0.05);
    let worst = Worst::new();
    let [x, v, acceleration] = ["x", "vx", "ax"].map(|q| recording.get(&format!("slider.{q}")));
    for (i, t) in t.iter().enumerate() {
        let (sine, cosine) = (w * t).sin_cos();
        worst.see((x[i] - 0.3) / a - sine);
        worst.see(v[i] / (a * w) - cosine);
        worst.see(acceleration[i] / (a * w * w) + sine);
    }
    assert!(t.len() > 100);
    Rung::Routes
        .asks("Slider-crank with a formula for its crank: relative difference of position, velocity and acceleration of the slider from the harmonic motion it stands for")
        .within(&worst, 1e-12, "rounding of twenty operations, and of second derivatives of an arc cosine 1/(1 - u²)² times that, 2e-15 each for u up to 0.61");
}

/// The second derivative of the prescribed angle, for drives that are constraints and drives that are eliminated, of rigid and
/// flexible links; with inverse kinematics differences of the speed.
#[test]
fn the_acceleration_of_a_driven_joint_is_the_rate_of_its_speed() {
    let spin_up = [
        "simulation.duration=2.0",
        "output.interval=0.1",
        "output.channels=[\"hub.*\"]",
    ];
    let (recording, _) = run("spin-up.toml", &spin_up);
    let worst = Worst::new();
    for (t, x) in recording
        .get("t")
        .iter()
        .zip(recording.get("hub.acceleration"))
    {
        worst.see((x - 6.0 / 15.0 * (1.0 - (TAU * t / 15.0).cos())) / 0.4);
    }
    Rung::Routes
        .asks("Flexible beam that spins up: relative difference of the acceleration of its hub from that of its drive")
        .within(&worst, 1e-7, "the accelerations of the beam satisfy their constraint but for the tolerance of Newton's method over the step");

    for (scene, joint) in [(SLIDER, "main"), ("3rrr/case1.toml", "A2")] {
        let channels = format!("output.channels=[\"{joint}.*\"]");
        let short = [
            "simulation.duration=0.1",
            "output.interval=1e-3",
            channels.as_str(),
        ];
        let (recording, _) = run(scene, &short);
        let speed = recording.get(&format!("{joint}.speed"));
        let acceleration = recording.get(&format!("{joint}.acceleration"));
        let size = acceleration.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        let worst = Worst::new();
        for i in 2..speed.len() - 2 {
            let near = speed[i + 1] - speed[i - 1];
            let far = speed[i + 2] - speed[i - 2];
            worst.see(((8.0 * near - far) / 12e-3 - acceleration[i]) / size);
        }
        Rung::Routes
            .asks(format!("Acceleration of joint {joint} of {scene}: relative difference from a difference of fourth order of its speed"))
            .within(&worst, 1e-5, "(h w)^4/30 with h = 1 ms and the fourth overtone of the motion, w = 60/s: 4e-7; fifth derivatives of angles near a singular pose are ten times larger");
    }
}

/// A load as a formula is the load of the kinds that say the same.
#[test]
fn formulas_are_loads_as_tables_are() {
    let formula = "forces.resistance.x=\"1 - 20 * sin(2 * pi * 3 * t + 0.4)\"";
    let table =
        "forces.resistance.x={type=\"harmonic\",mean=1.0,amplitude=-20.0,frequency=3.0,phase=0.4}";
    let [a, b] = [formula, table].map(|load| run(SLIDER, &[load]).0);
    let worst = difference(
        [&a, &b],
        ["resistance.fx", "main.torque", "energy.work"],
        0.0,
    );
    Rung::Routes
        .asks("A harmonic load as a formula: relative difference of load, torque and work from the kind \"harmonic\"")
        .within(&worst, 1e-13, "rounding of an argument up to 20, 4e-15");
}

/// In a static analysis a plain number grows with t by itself, a formula does not.
#[test]
fn formulas_of_a_static_analysis_are_used_as_they_are_written() {
    let loads = ["-1293750.0", "\"-1293750 * t / 2\"", "\"-1293750\""];
    let [number, growing, full] = loads.map(|load| {
        let load = format!("forces.load.y={load}");
        run(
            "cantilever-static.toml",
            &["simulation.duration=2.0", &load],
        )
        .0
    });
    let names: Vec<_> = number.names().to_vec();
    let worst = difference([&number, &growing], &names, 1e-9);
    let tip = "points.beam.end.y";
    assert!(full.get(tip)[1] < 10.0 * number.get(tip)[1]);
    Rung::Routes
        .asks("Cantilever under a growing load: relative difference of all channels between a number and the formula of the same load")
        .within(&worst, 1e-10, "the tolerance of the equilibrium, 1e-12 of the forces, times the number of elements");
}

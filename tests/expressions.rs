//! Motions and loads given as formulas, and the accelerations of driven joints.

use crate::support::{TestRecording, difference, run, run_scene};
use ladder::{Rung, Worst};
use looselink::scene::Scene;
use std::f64::consts::{PI, TAU};

const SLIDER: &str = "harmonic-slider.toml";

/// A double pendulum of a link and a body, whose elbow is driven.
const ELBOW: &str = r#"
format = 1
title = "driven elbow"
simulation = { duration = 0.5, gravity = [0.0, -9.81] }
integrator = { method = "bathe", step = 1e-3, newton_tolerance = 1e-11 }
output = { interval = 1e-2, channels = ["elbow.*"] }
materials.steel = { density = 7800.0, youngs_modulus = 2e11 }
sections.bar = { width = 0.01, height = 0.01 }
bodies.ground = { type = "ground", points.O = [0.0, 0.0] }
bodies.upper = { type = "link", model = "rigid", length = 0.3, section = "bar", material = "steel" }
bodies.lower = { type = "rigid_body", mass = 0.4, inertia = 1e-3, points.top = [0.1, 0.0] }
joints.shoulder = { type = "revolute", bearing = "ground.O", journal = "upper.start", model = "ideal" }
joints.elbow = { type = "revolute", bearing = "upper.end", journal = "lower.top", model = "ideal" }
drives.bend = { type = "angle", joint = "elbow", angle = "0.3 * sin(7 * t)" }
initial.velocities.upper = { omega = 0.5 }
initial.bodies.upper = { x = 0.15, y = 0.0, theta = 0.0 }
initial.bodies.lower = { x = 0.2, y = 0.0, theta = 0.0 }
"#;

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
        .within(&worst, 1e-12, "the loop of crank, rod and slider is closed to rounding by one more step of Newton's method than its tolerance of 1e-10 asks; the rest is rounding of twenty operations and of second derivatives of an arc cosine");
}

/// Of drives that are constraints, between a link that bends and the ground and between two bodies that both turn, and of one
/// that is eliminated: the second derivative of the prescribed angle. With inverse kinematics: differences of the speed.
#[test]
fn the_acceleration_of_a_driven_joint_is_the_rate_of_its_speed() {
    let accelerations = |recording: &TestRecording, joint: &str, exact: &dyn Fn(f64) -> f64| {
        let worst = Worst::new();
        let exact: Vec<f64> = recording.get("t").into_iter().map(exact).collect();
        let size = exact.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        let name = format!("{joint}.acceleration");
        for (x, exact) in recording.get(&name).iter().zip(&exact) {
            worst.see((x - exact) / size);
        }
        worst
    };
    let spin_up = [
        "simulation.duration=2.0",
        "output.interval=0.1",
        "output.channels=[\"hub.*\"]",
    ];
    let (recording, _) = run("spin-up.toml", &spin_up);
    let exact = |t: f64| 6.0 / 15.0 * (1.0 - (TAU * t / 15.0).cos());
    Rung::Routes
        .asks("Flexible beam that spins up: relative difference of the acceleration of its hub from that of its drive")
        .within(&accelerations(&recording, "hub", &exact), 1e-9, "accelerations solve the constraint at the acceleration level: rounding of bending accelerations, 1e4 times those of the hub, and of positions that satisfy it to 1e-12");

    let scene = Scene::parse("elbow", ELBOW, &[]).unwrap_or_else(|e| panic!("{e}"));
    let (recording, _) = run_scene(&scene);
    let exact = |t: f64| -0.3 * 49.0 * (7.0 * t).sin();
    Rung::Routes
        .asks("Double pendulum with a driven elbow: relative difference of its acceleration from that of its drive")
        .within(&accelerations(&recording, "elbow", &exact), 1e-10, "accelerations solve the constraint at the acceleration level: rounding, and positions and velocities that satisfy it to 1e-12");

    let (recording, _) = run(SLIDER, &[]);
    let differences = difference_of_speed(&recording, "main", 5e-3);
    Rung::Routes
        .asks("Harmonic slider: relative difference of the acceleration of its motor from differences of the speed")
        .within(&differences, 1e-4, "(h w)^4/30 with h = 5 ms and the second overtone of the motion, w = 38/s: 4e-5");

    let short = [
        "simulation.duration=0.1",
        "output.interval=1e-3",
        "output.channels=[\"A2.*\"]",
    ];
    let (recording, _) = run("3rrr/case1.toml", &short);
    Rung::Routes
        .asks("Case 1: relative difference of the acceleration of joint A2 from differences of the speed")
        .within(&difference_of_speed(&recording, "A2", 1e-3), 1e-7, "(h w)^4/30 with h = 1 ms and the fifth overtone of the motion, w = 38/s: 7e-8");
}

/// Relative difference of an acceleration from a central difference of fourth order.
fn difference_of_speed(recording: &TestRecording, joint: &str, h: f64) -> Worst {
    let speed = recording.get(&format!("{joint}.speed"));
    let acceleration = recording.get(&format!("{joint}.acceleration"));
    let size = acceleration.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    let worst = Worst::new();
    for i in 2..speed.len() - 2 {
        let near = speed[i + 1] - speed[i - 1];
        let far = speed[i + 2] - speed[i - 2];
        worst.see(((8.0 * near - far) / (12.0 * h) - acceleration[i]) / size);
    }
    worst
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

/// A follower that rises, dwells and returns.
const DWELL: &str = r#"
format = 1
title = "a follower with dwells"
simulation = { duration = 1.0 }
integrator = { method = "bathe", step = 1e-3, newton_tolerance = 1e-9 }
output = { interval = 1e-3, channels = ["follower.*"] }
bodies.ground = { type = "ground", points.O = [0.0, 0.0] }
bodies.follower = { type = "point_mass", mass = 0.4 }
joints.rail = { type = "prismatic", guide = "ground.O", slider = "follower.center", direction = [0.0, 1.0], rotation = "free" }
drives.cam = { type = "point", point = "follower.center", y = { type = "table", rows = [[0.0, 0.0], [0.2, 0.0], [0.4, 0.03], [0.6, 0.03], [0.8, 0.0], [1.0, 0.0]] } }
initial.sketch = { rail = [0.0, 0.0] }
"#;

fn dwell(overrides: &[&str]) -> (TestRecording, Vec<String>) {
    let overrides: Vec<String> = overrides.iter().map(|s| (*s).to_owned()).collect();
    let scene = Scene::parse("dwell", DWELL, &overrides).unwrap_or_else(|e| panic!("{e}"));
    let (recording, report) = run_scene(&scene);
    (recording, report.notes())
}

/// The six corners of a rise, a dwell and a return: a monotone table and a sum of smooth steps keep the dwells, a natural spline swings
/// through them and says so.
#[test]
fn dwells_are_kept_or_their_overshoot_is_told() {
    let (_, notes) = dwell(&[]);
    assert_eq!(
        notes,
        [
            "the table of `drives.cam.y` overshoots: between its rows of 0.03 m and 0.03 m it reaches 0.03592 m at t = 0.5 s; \
             `shape = \"monotone\"` stays between them and keeps flats flat"
        ]
    );
    let sum =
        "drives.cam.y=\"0.03 * (smooth_step((t - 0.2) / 0.2) - smooth_step((t - 0.6) / 0.2))\"";
    let max = "drives.cam.y=\"0.03 * smooth_step(max(0, 1 - abs(t - 0.5) / 0.2) + 0.5)\"";
    let monotone = "drives.cam.y.shape=monotone";
    for change in [monotone, sum] {
        let (recording, notes) = dwell(&[change]);
        assert!(notes.is_empty(), "{change}: {notes:?}");
        let worst = Worst::new();
        for (t, y) in recording.get("t").iter().zip(recording.get("follower.y")) {
            match t {
                0.4..=0.6 => worst.see(y - 0.03),
                t if *t <= 0.2 || *t >= 0.8 => worst.see(y),
                _ => assert!((0.0..=0.03).contains(&y)),
            }
        }
        Rung::ClosedForms
            .asks(format!(
                "Follower with dwells, {change}: distance from 0 and 30 mm in its dwells [m]"
            ))
            .within(
                &worst,
                1e-15,
                "rounding of a prescribed coordinate of 0.03 m",
            );
    }
    let overrides = [max.to_owned()];
    let error = Scene::parse("dwell", DWELL, &overrides)
        .unwrap_err()
        .to_string();
    assert!(error.contains("its velocity jumps by"), "{error}");
}

/// What switches at the start, at the end, at a touch, or together with another function is what the motion is without it; with
/// its velocity and its acceleration in every row, the first and the last among them.
#[test]
fn switches_without_a_kink_leave_the_motion_as_it_is() {
    let motion = |text: &str| {
        let (recording, notes) = dwell(&[&format!("drives.cam.y=\"{text}\"")]);
        assert!(notes.is_empty(), "{text}: {notes:?}");
        recording
    };
    for (text, plain) in [
        ("max(0, t)", "t"),
        ("min(t, 1)^2", "t^2"),
        ("abs(t - 1) + min(0, t)", "1 - t"),
        ("max(0, 1 - cos(t))", "1 - cos(t)"),
        ("max(0, 1 - cos(t - 0.5))", "1 - cos(t - 0.5)"),
        ("max(t, 0.5) + min(t, 0.5)", "t + 0.5"),
        ("max(t, 1 - t) + min(t, 1 - t)", "1"),
    ] {
        let [a, b] = [text, plain].map(motion);
        let worst = difference([&a, &b], ["follower.vy", "follower.ay"], 1.0);
        Rung::Routes
            .asks(format!(
                "Follower driven by {text}: difference of velocity and acceleration from {plain} [m/s, m/s2]"
            ))
            .within(&worst, 1e-15, "rounding of sums of two numbers up to 1");
    }
}

/// The acceleration of u^2.5 is 3.75 u^0.5: continuous, from zero.
#[test]
fn powers_of_a_switch_may_begin_with_a_vertical_tangent() {
    let (recording, _) = dwell(&["drives.cam.y=\"100 + max(0, t - 0.5)^2.5\""]);
    let worst = Worst::new();
    for (t, a) in (recording.get("t").iter()).zip(recording.get("follower.ay")) {
        worst.see(a - 3.75 * (t - 0.5).max(0.0).sqrt());
    }
    Rung::ClosedForms
        .asks(
            "Follower driven by max(0, u)^2.5: distance of its acceleration from 3.75 u^0.5 [m/s2]",
        )
        .within(
            &worst,
            1e-7,
            "the root of the rounding of u, 1e-16, times 3.75 at the switch",
        );
}

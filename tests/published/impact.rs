//! One free impact in units delta* = (m v0^2/K)^(2/5), t* = delta*/v0, F* = K delta*^(3/2) (E): restitution, deepest
//! penetration and its instant, contact time, largest force.

use super::run;
use ladder::{Rung, Worst};

const MASS: f64 = 0.05;
const SPEED: f64 = 0.02;
const STIFFNESS: f64 = 1e11;
const CLEARANCE: f64 = 2e-5;

/// A free journal in a fixed bearing.
fn scene(law: &str, step: f64, rows: usize) -> String {
    format!(
        r#"
format = 1
title = "one impact"
[simulation]
duration = {:?}
[integrator]
method = "bathe"
step = {step:?}
newton_tolerance = 1e-13
onset_tolerance = 1e-15
[output]
interval = {step:?}
channels = ["journal.x", "journal.vx", "pin.force", "pin.penetration"]
[contacts.pin]
{law}
bearing_radius = 0.01
clearance = {CLEARANCE:?}
stiffness = {STIFFNESS:?}
exponent = 1.5
impact_velocity_floor = 1e-6
[bodies.ground]
type = "ground"
points.O = [0.0, 0.0]
[bodies.journal]
type = "point_mass"
mass = {MASS:?}
[joints.pin]
type = "revolute"
bearing = "ground.O"
journal = "journal.center"
model = "clearance"
contact = "pin"
[initial]
bodies.journal = {{ x = 0.0, y = 0.0, vx = {SPEED:?}, vy = 0.0 }}
"#,
        step * rows as f64,
    )
}

/// Place and height of the top of the parabola through three rows around the largest.
fn top(t: &[f64], y: &[f64]) -> (f64, f64) {
    let k = (0..y.len())
        .max_by(|a, b| y[*a].total_cmp(&y[*b]))
        .unwrap_or(0);
    let (low, mid, high) = (y[k - 1], y[k], y[k + 1]);
    let bend = low - 2.0 * mid + high;
    let shift = 0.5 * (low - high) / bend;
    let step = t[k + 1] - t[k];
    (
        t[k] + shift * step,
        mid - 0.125 * (high - low).powi(2) / bend,
    )
}

#[test]
fn single_impacts_follow_the_table() {
    let scale = (MASS * SPEED * SPEED / STIFFNESS).powf(0.4);
    let time = scale / SPEED;
    let force = STIFFNESS * scale.powf(1.5);
    let typed = |e: f64| format!("law = \"lankarani_nikravesh\"\nrestitution = {e:?}");
    let worst = Worst::new();
    for (law, listed) in [
        (
            "law = \"hertz\"".to_owned(),
            [
                1.0,
                1.09336207394,
                1.60903272986,
                3.21806545972,
                1.14326262982,
            ],
        ),
        (
            typed(0.9),
            [
                0.913176677806,
                1.05478742843,
                1.5748097574,
                3.24988334739,
                1.0916120794,
            ],
        ),
        (
            typed(0.7),
            [
                0.795972595365,
                1.00057420242,
                1.52599644945,
                3.30808649998,
                1.04768190965,
            ],
        ),
        (
            typed(0.5),
            [
                0.72524111401,
                0.966450719291,
                1.49479781666,
                3.35467618653,
                1.03527625043,
            ],
        ),
    ] {
        let step = time / 1500.0;
        let rows = ((CLEARANCE / SPEED + 4.0 * time) / step).ceil() as usize;
        let run = run(&scene(&law, step, rows), &[]);
        let onset = run.onsets[0].t;
        assert!((onset - CLEARANCE / SPEED).abs() < 1e-12);
        let [t, x, v, f, depth] = [
            "t",
            "journal.x",
            "journal.vx",
            "pin.force",
            "pin.penetration",
        ]
        .map(|c| run.get(c));
        let end = t.len() - 1;
        // free flight since the loss of contact
        let loss = t[end] - (x[end] - CLEARANCE) / v[end];
        let (deepest_at, deepest) = top(&t, &depth);
        let (_, strongest) = top(&t, &f);
        let got = [
            -v[end] / SPEED,
            deepest / scale,
            (deepest_at - onset) / time,
            (loss - onset) / time,
            strongest / force,
        ];
        for (g, l) in got.iter().zip(listed) {
            worst.see(g / l - 1.0);
        }
    }
    Rung::ClosedForms
        .asks("One impact, Hertz and Lankarani-Nikravesh: restitution, depth, instants and largest force against the table, relative error")
        .within(&worst,
            1e-6,
            "the error of 1500 steps per unit of time, and of the parabola through the force, whose initial slope is infinite",
        );
}

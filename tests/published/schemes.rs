//! Published tables of time integration schemes: the three-spring model of Bathe and Noh 2012.

use super::run;
use ladder::{Rung, Worst};
use std::f64::consts::SQRT_2;

/// k1 = 1e7 between the moving point and node 2, k2 = 1 between nodes 2 and 3, u1 = sin 1.2 t: springs without rest
/// length are linear, and nothing moves along y.
const THREE_SPRINGS: &str = r#"
format = 1
title = "three-spring model"
[simulation]
duration = 15.708
[integrator]
method = "bathe"
step = 0.2618
newton_tolerance = 1e-14
[output]
interval = 0.2618
channels = ["node2.*", "node3.*", "stiff.force"]
[bodies.ground]
type = "ground"
[bodies.wall]
type = "moving"
path = { type = "coordinates", x = { type = "harmonic", mean = 0.0, amplitude = 1.0, frequency = 0.1909859317102744, phase = 0.0 }, y = 0.0, theta = 0.0 }
points.P = [0.0, 0.0]
[bodies.node2]
type = "point_mass"
mass = 1.0
[bodies.node3]
type = "point_mass"
mass = 1.0
[forces.stiff]
type = "spring_damper"
from = "wall.P"
to = "node2.center"
stiffness = 1e7
damping = 0.0
rest_length = 0.0
[forces.soft]
type = "spring_damper"
from = "node2.center"
to = "node3.center"
stiffness = 1.0
damping = 0.0
rest_length = 0.0
[initial]
bodies.node2 = { x = 0.0, y = 0.0 }
bodies.node3 = { x = 0.0, y = 0.0 }
"#;

/// Rows (step, [u2, u3, v2, v3, a2, a3]) of each scheme, from a recursion with 40 digits.
mod rows;

#[test]
fn the_three_spring_model_follows_the_tables_step_by_step() {
    let optimal = format!("integrator.gamma={:?}", 2.0 - SQRT_2);
    let worst = Worst::new();
    for (overrides, rows) in [
        (vec![], rows::BATHE_HALF),
        (vec![optimal], rows::BATHE_OPTIMAL),
        (
            vec!["integrator.method=\"trapezoidal\"".to_owned()],
            rows::TRAPEZOIDAL,
        ),
    ] {
        let run = run(THREE_SPRINGS, &overrides);
        let channels = ["x", "vx", "ax"].map(|c| [2, 3].map(|n| run.get(&format!("node{n}.{c}"))));
        for (step, listed) in rows {
            for level in 0..3 {
                for node in 0..2 {
                    let (got, want) = (channels[level][node][step], listed[2 * level + node]);
                    let least = if level == 2 && node == 0 { 100.0 } else { 1.0 };
                    worst.see((got - want) / want.abs().max(least));
                }
            }
        }
        assert!(run.get("node2.y").iter().all(|y| *y == 0.0));
    }
    Rung::Computed
        .asks("Three-spring model, Bathe's scheme and trapezoidal rule: all listed steps, relative error")
        .within(&worst,
            1e-10,
            "rounding, absolute for numbers below 1; for a2 the rounding of u times the stiffness, k eps = 1e-9, absolute below 100",
        );
}

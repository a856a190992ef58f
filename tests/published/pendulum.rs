//! A01 of the IFToMM library (González et al. 2006): a simple pendulum of 1 m, released horizontally, in closed form (E).

use super::run;
use ladder::{Rung, Worst};

/// A physical pendulum whose equivalent length (I + m d^2)/(m d) is 1 m; its point `bob` is the published mass.
const SCENE: &str = r#"
format = 1
title = "pendulum of equivalent length 1 m"
[simulation]
duration = 10.0
gravity = [0.0, -9.81]
[integrator]
method = "bathe"
step = 1e-3
newton_tolerance = 1e-12
[output]
interval = 0.1
channels = ["points.rod.bob.x", "points.rod.bob.y"]
[bodies.ground]
type = "ground"
points.O = [0.0, 0.0]
[bodies.rod]
type = "rigid_body"
mass = 1.0
inertia = 0.25
points.pivot = [-0.5, 0.0]
points.bob = [0.5, 0.0]
[joints.pivot]
type = "revolute"
bearing = "ground.O"
journal = "rod.pivot"
model = "ideal"
[initial]
bodies.rod = { x = -0.5, y = 0.0, theta = 3.141592653589793 }
"#;

const LISTED: [(f64, f64, f64); 4] = [
    (1.0, 0.9862917511318753, -0.1650108531255412),
    (2.0, -0.7935661953433217, -0.6084839304437915),
    (5.0, -0.9423054350437573, -0.3347543384140006),
    (10.0, -0.2750874625761169, -0.9614192050991251),
];

#[test]
fn the_pendulum_converges_to_the_closed_form() {
    let mut errors = Vec::new();
    for step in [4e-4, 2e-4, 1e-4, 5e-5] {
        let run = run(SCENE, &[format!("integrator.step={step:?}")]);
        let (x, y) = (run.get("points.rod.bob.x"), run.get("points.rod.bob.y"));
        let worst = Worst::new();
        for (t, ex, ey) in LISTED {
            let row = (t / 0.1_f64).round() as usize;
            worst.see((x[row] - ex).hypot(y[row] - ey));
        }
        errors.push((step, worst.value()));
    }
    Rung::OrderInTime
        .asks("Rigid pendulum: distance from the closed form over 10 s [m]")
        .falls("Step h [s]", &errors, 1.9..2.1, "order 2 of Bathe's scheme");
}

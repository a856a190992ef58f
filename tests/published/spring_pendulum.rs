//! The stiff spring pendulum of the drivers of MEBDF (J. R. Cash; I): x'' = -x lambda, y'' = -y lambda - 1, 1e-6 lambda = (r - 1)/r, from
//! (1, 0) at rest, at t = 10. A point mass of 1 kg on a spring of 1e6 N/m and 1 m, gravity 1 m/s2.

use super::{last, run};
use ladder::{Rung, Worst};

const SCENE: &str = r#"
format = 1
title = "stiff spring pendulum"
[simulation]
duration = 10.0
gravity = [0.0, -1.0]
[integrator]
method = "bathe"
step = 1e-3
newton_tolerance = 1e-13
[output]
interval = 10.0
channels = ["bob.*", "spring.force", "spring.length"]
[bodies.ground]
type = "ground"
points.O = [0.0, 0.0]
[bodies.bob]
type = "point_mass"
mass = 1.0
[forces.spring]
type = "spring_damper"
from = "ground.O"
to = "bob.center"
stiffness = 1e6
damping = 0.0
rest_length = 1.0
[initial]
bodies.bob = { x = 1.0, y = 0.0 }
"#;

const LISTED: [f64; 5] = [
    -0.8115763676573986,
    -0.5842493516781946,
    -0.6315526595574175,
    0.8772895105102342,
    1.7527335718042552,
];

#[test]
fn bathe_converges_to_the_listed_digits() {
    let mut errors = Vec::new();
    let (rates, forces) = (Worst::new(), Worst::new());
    for step in [1e-3, 5e-4, 2.5e-4] {
        let run = run(SCENE, &[format!("integrator.step={step:?}")]);
        let [x, y, vx, vy] = ["x", "y", "vx", "vy"].map(|c| last(&run, &format!("bob.{c}")));
        let error = (x - LISTED[0]).hypot(y - LISTED[1]);
        errors.push((step, error));
        rates.see((vx - LISTED[2]).hypot(vy - LISTED[3]));
        let lambda = last(&run, "spring.force") / last(&run, "spring.length");
        forces.see(lambda - LISTED[4]);
    }
    Rung::OrderInTime
        .asks("Stiff spring pendulum: distance from the listed position after 10 s [m]")
        .falls(
            "Step h [s]",
            &errors,
            1.8..2.2,
            "order 2 of Bathe's scheme; the reference is known to 7e-9 only, so no finer steps",
        );
    Rung::Computed
        .asks("Stiff spring pendulum, h = 2.5e-4 ... 1e-3 s: listed velocity after 10 s [m/s]")
        .within(
            &rates,
            3e-3,
            "the fast mode of 1000 rad/s has an amplitude of 1e-6 m, that is 1e-3 m/s",
        );
    Rung::Computed
        .asks("Stiff spring pendulum, h = 2.5e-4 ... 1e-3 s: listed force over length after 10 s [N/m]")
        .within(&forces,
            2.0,
            "the fast mode's amplitude of 1e-6 m times the stiffness of 1e6 N/m",
        );
}

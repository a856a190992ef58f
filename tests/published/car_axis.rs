//! The car axis of the Test Set for IVP Solvers (P): two masses at a fixed distance on springs, one of them on a line that
//! turns as the road says, at t = 3 s.

use crate::support::{TestRecording, run};
use ladder::{Rung, Worst};

const SOURCE: &str =
    "Test Set for IVP Solvers, problem Car axis, https://github.com/cran/deTestSet, src/Ex_car.f";
const SCENE: &str = "car-axis.toml";

/// x and y of the left and of the right end, their rates, and both multipliers, to the digits of a double.
const PUBLISHED: [f64; 10] = [
    0.04934557842754028,
    0.49698946023017115,
    1.0417425248854215,
    0.37391102726536124,
    -0.07705836840409723,
    0.007446866587237785,
    0.017556815753723223,
    0.7703410437792519,
    -0.004736886590848933,
    -0.0011046803312573436,
];

fn ends(run: &TestRecording, quantities: [&str; 2]) -> [f64; 4] {
    let of = |end: &str, q: &str| *run.get(&format!("points.axle.{end}.{q}")).last().unwrap();
    let [x, y] = quantities;
    [of("left", x), of("left", y), of("right", x), of("right", y)]
}

/// The force of the line on the left end is lambda_1 (x_b, y_b). The distance of the ends is kept by the body itself:
/// 2 lambda_2 (left - right) is the force at the right end that its acceleration, its spring and its weight leave over.
fn multipliers(run: &TestRecording) -> [f64; 2] {
    let last = |name: &str| *run.get(name).last().unwrap();
    let [xb, yb] = ["x", "y"].map(|q| last(&format!("points.road.right_wheel.{q}")));
    let [fx, fy] = ["fx", "fy"].map(|q| last(&format!("line.{q}")));
    let [xl, yl, xr, yr] = ends(run, ["x", "y"]);
    let [_, _, ax, ay] = ends(run, ["ax", "ay"]);
    let k = 5e-4;
    let length = (xr - xb).hypot(yr - yb);
    let pull = (0.5 - length) / length;
    let rest = [pull * (xr - xb) - k * ax, pull * (yr - yb) - k - k * ay];
    let bar = [xl - xr, yl - yr];
    [
        fx * xb + fy * yb,
        0.5 * (rest[0] * bar[0] + rest[1] * bar[1]),
    ]
}

#[test]
fn the_car_axis_meets_the_published_digits() {
    let (run, _) = run(SCENE, &[]);
    let (places, rates, forces) = (Worst::new(), Worst::new(), Worst::new());
    for (got, published) in ends(&run, ["x", "y"]).iter().zip(&PUBLISHED[..4]) {
        places.see(got - published);
    }
    for (got, published) in ends(&run, ["vx", "vy"]).iter().zip(&PUBLISHED[4..8]) {
        rates.see(got - published);
    }
    for (got, published) in multipliers(&run).iter().zip(&PUBLISHED[8..]) {
        forces.see(got - published);
    }
    const OTHERS: &str = "another independent integration differs from the published values by 4e-13 m in position and up to \
        6e-10 elsewhere; the scheme's error at this step is smaller";
    Rung::Published
        .asks("Car axis: published positions after 3 s [m]")
        .from(SOURCE)
        .within(&places, 1e-12, OTHERS);
    Rung::Published
        .asks("Car axis: published rates after 3 s [m/s]")
        .from(SOURCE)
        .within(&rates, 1e-9, OTHERS);
    Rung::Published
        .asks("Car axis: published multipliers after 3 s [N]")
        .from(SOURCE)
        .within(&forces, 1e-9, OTHERS);
}

fn errors(method: &[&str], steps: [f64; 3]) -> Vec<(f64, f64)> {
    let error = |step: f64| {
        let step_key = format!("integrator.step={step:?}");
        let mut overrides = vec!["output.interval=1.0", &step_key];
        overrides.extend(method);
        let [_, _, x, y] = ends(&run(SCENE, &overrides).0, ["x", "y"]);
        (step, (x - PUBLISHED[2]).hypot(y - PUBLISHED[3]))
    };
    steps.map(error).to_vec()
}

#[test]
fn methods_converge_to_the_car_axis() {
    Rung::OrderInTime
        .asks(
            "Car axis, Dormand and Prince: right end after 3 s against the published position [m]",
        )
        .falls(
            "Step h [s]",
            &errors(&[], [4e-3, 2e-3, 1e-3]),
            4.7..5.3,
            "order 5",
        );
    let bathe = [
        "integrator.method=bathe",
        "integrator.newton_tolerance=1e-12",
    ];
    Rung::OrderInTime
        .asks("Car axis, Bathe: right end after 3 s against the published position [m]")
        .falls(
            "Step h [s]",
            &errors(&bathe, [1e-3, 5e-4, 2.5e-4]),
            1.9..2.1,
            "order 2",
        );
}

//! Steps end where functions of time are not smooth, so that a method keeps its order.

use crate::support::run_scene;
use looselink::document::{Key, Kind};
use looselink::motion::{Function, FunctionKind, FunctionOfTime, Knot};
use looselink::registry::Registry;
use looselink::scene::Scene;
use std::sync::Arc;

const OMEGA: f64 = 20.0;
/// The ends of the ramp, off every grid of steps.
const RAMP: [f64; 2] = [0.137_4, 0.731_7];

/// A block of 1 kg on a spring along x, under a load of the given function.
fn block(load: &str, integrator: &str) -> Scene {
    let text = format!(
        "format = 1\ntitle = \"loaded block\"\n\
         [simulation]\nduration = 1.0\n\
         [integrator]\n{integrator}\n\
         [output]\ninterval = 0.25\nchannels = [\"block.*\"]\n\
         [bodies.frame]\ntype = \"ground\"\npoints = {{ anchor = [-1.0, 0.0] }}\n\
         [bodies.block]\ntype = \"point_mass\"\nmass = 1.0\n\
         [forces.spring]\ntype = \"spring_damper\"\nfrom = \"frame.anchor\"\nto = \"block.center\"\n\
         stiffness = {}\ndamping = 0.0\nrest_length = 1.0\n\
         [forces.load]\ntype = \"force\"\npoint = \"block.center\"\nx = {load}\ny = 0.0\nframe = \"ground\"\n\
         [initial.bodies]\nblock = {{ x = 0.0, y = 0.0 }}\n",
        OMEGA * OMEGA
    );
    let registry = Registry::standard().with_function(&SQUARE);
    Scene::parse_with(&registry, "block.toml", &text, &[]).unwrap_or_else(|e| panic!("{e}"))
}

/// x(t) of the block under a load that grows by one newton a second from t = 0 on.
fn drawn(t: f64) -> f64 {
    match t > 0.0 {
        true => (t - (OMEGA * t).sin() / OMEGA) / (OMEGA * OMEGA),
        false => 0.0,
    }
}

/// x(t) of the block under a load of one newton from t = 0 on.
fn pushed(t: f64) -> f64 {
    match t > 0.0 {
        true => (1.0 - (OMEGA * t).cos()) / (OMEGA * OMEGA),
        false => 0.0,
    }
}

/// The largest error of x at the rows.
fn error(scene: &Scene, exact: impl Fn(f64) -> f64) -> f64 {
    let (run, _) = run_scene(scene);
    let rows = run.get("t").into_iter().zip(run.get("block.x"));
    rows.map(|(t, x)| (x - exact(t)).abs()).fold(0.0, f64::max)
}

fn step(method: &str, step: f64) -> String {
    let parameter = match method {
        "generalized_alpha" => "spectral_radius = 0.8\n",
        _ => "",
    };
    format!("method = \"{method}\"\nstep = {step:e}\n{parameter}")
}

/// The order over a factor of eight of the step.
fn order(load: &str, method: &str, steps: [f64; 2], exact: impl Fn(f64) -> f64) -> f64 {
    let [coarse, fine] = steps.map(|h| error(&block(load, &step(method, h)), &exact));
    (coarse / fine).ln() / (steps[0] / steps[1]).ln()
}

#[test]
fn a_ramp_off_the_grid_of_steps_leaves_a_method_its_order() {
    let exact = |t: f64| drawn(t - RAMP[0]) - drawn(t - RAMP[1]);
    let [from, to] = RAMP;
    let rise = to - from;
    for load in [
        format!(
            "{{ type = \"ramp\", from = 0.0, to = {rise}, start = {from}, duration = {rise} }}"
        ),
        format!(
            "{{ type = \"piecewise\", rows = [[0.0, 0.0], [{from}, 0.0], [{to}, {rise}], [1.0, {rise}]] }}"
        ),
        format!("\"max(0, t - {from}) - max(0, t - {to})\""),
        format!("\"0.5 * (abs(t - {from}) - abs(t - {to}) + {rise})\""),
    ] {
        let found = order(&load, "dop853", [0.125, 0.015_625], exact);
        assert!((7.5..8.7).contains(&found), "{load}: {found}");
        let found = order(&load, "esdirk5", [0.05, 0.006_25], exact);
        assert!((4.7..5.5).contains(&found), "{load}: {found}");
    }
}

/// One newton from an instant on.
#[derive(Debug)]
struct Square(f64);

impl FunctionOfTime for Square {
    fn at(&self, t: f64) -> [f64; 3] {
        [if t >= self.0 { 1.0 } else { 0.0 }, 0.0, 0.0]
    }

    fn knots(&self, _: f64) -> Vec<Knot> {
        vec![Knot::at(self.0, 0)]
    }
}

static SQUARE: FunctionKind = Kind {
    name: "square",
    keys: &[Key::number("start", "s", "when the load begins")],
    read: |table, _, _| Ok(Function::Own(Arc::new(Square(table.number("start")?)))),
};

/// The step that ends at a jump sees the load of before, the next one that of after: also where a row is recorded at the jump.
#[test]
fn loads_may_jump_at_an_instant_that_they_name() {
    for start in [0.137_4, 0.25] {
        let load = format!("{{ type = \"square\", start = {start} }}");
        for (method, steps, range) in [
            ("dop853", [0.125, 0.015_625], 7.5..8.7),
            ("trapezoidal", [0.025, 0.003_125], 1.9..2.1),
            ("bathe", [0.025, 0.003_125], 1.9..2.1),
            ("generalized_alpha", [0.025, 0.003_125], 1.9..2.1),
            ("velocity_verlet", [0.025, 0.003_125], 1.9..2.1),
            ("backward_euler", [0.0025, 0.000_312_5], 0.9..1.1),
        ] {
            let found = order(&load, method, steps, |t| pushed(t - start));
            assert!(range.contains(&found), "{method} at {start}: {found}");
        }
    }
}

/// Steps of a method of high order end at the knots of a spline, unless the scene says otherwise; they need not where the order is low.
#[test]
fn methods_of_high_order_step_to_the_knots_of_splines() {
    let load = "{ type = \"table\", rows = [[0.0, 0.0], [0.137, 0.4], [0.391, -0.2], [1.0, 0.3]] }";
    let steps = |integrator: &str| run_scene(&block(load, integrator)).1.steps;
    let coarse =
        |method: &str, knots: &str| steps(&format!("{}knots = \"{knots}\"\n", step(method, 0.05)));
    assert_eq!(coarse("dop853", "ignore"), 20);
    assert_eq!(coarse("dop853", "stop"), 22);
    assert_eq!(coarse("trapezoidal", "stop"), 20);
}

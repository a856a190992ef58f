//! Maxwell elements: closed forms, order, energy, and where they are refused.

use crate::support::{load, path, run, run_scene};
use ladder::{Rung, Worst};
use looselink::scene::Scene;
use looselink::simulate::Simulation;

const SCENE: &str = "maxwell.toml";
const M: f64 = 0.5;
const K: f64 = 200.0;
const C: f64 = 20.0;

/// The pull of the element on the block of the scene: N'' + (k/c) N' + (k/m) N = 0 with N = k (x - L_0 - z) and
/// N' = k v - (k/c) N at the start.
fn pull(t: f64) -> f64 {
    let decay = 0.5 * K / C;
    let frequency = (K / M - decay * decay).sqrt();
    let (start, rate) = (
        K * (0.4 - 0.3 - 0.01),
        K * 0.5 - K / C * K * (0.4 - 0.3 - 0.01),
    );
    let (sine, cosine) = (frequency * t).sin_cos();
    (-decay * t).exp() * (start * cosine + (rate + decay * start) / frequency * sine)
}

fn error(method: &str, step: f64) -> f64 {
    let tolerance = if method == "dormand_prince" {
        ""
    } else {
        ",newton_tolerance=1e-13"
    };
    let method = format!("integrator={{method=\"{method}\",step={step:e}{tolerance}}}");
    let (recording, _) = run(SCENE, &[&method, "simulation.duration=1.0"]);
    let pairs = recording
        .get("t")
        .into_iter()
        .zip(recording.get("element.force"));
    pairs.map(|(t, n)| (n - pull(t)).abs()).fold(0.0, f64::max)
}

/// Every kind of method gives the internal state the order that it gives positions.
#[test]
fn a_block_on_a_maxwell_element_vibrates_and_creeps() {
    for (method, order) in [
        ("bathe", 2.0),
        ("trapezoidal", 2.0),
        ("esdirk3", 3.0),
        ("esdirk5", 5.0),
        ("backward_euler", 1.0),
    ] {
        let measured = (error(method, 2e-3) / error(method, 1e-3)).log2();
        // halving a step of 1/150 of a period changes the order by a few per cent
        assert!(
            (measured - order).abs() < 0.15,
            "{method}: order {measured}"
        );
    }
    let worst = Worst::new();
    worst.see(error("dormand_prince", 1e-3) / pull(0.0));
    Rung::Routes
        .asks("Block on a Maxwell element: pull against the closed form, relative to its start")
        .within(
            &worst,
            1e-9,
            "steps of 1/300 of a period, order 5: (2 pi/300)^5/100 = 4e-11",
        );
}

/// Ends that part at constant speed v: N = c v (1 - exp(-k t/c)); all work is stored or dissipated.
#[test]
fn a_maxwell_element_is_drawn_at_constant_speed() {
    let moving = [
        "bodies.block={type=\"moving\",path={type=\"coordinates\",x={type=\"polynomial\",coefficients=[0.3,0.2]},y=0.0,theta=0.0},points={hook=[0.0,0.0]}}",
        "forces.element.elongation=0.0",
        "integrator={method=\"bathe\",step=1e-3,newton_tolerance=1e-13}",
        "output.channels=[\"element.*\",\"energy.*\"]",
    ];
    let text = std::fs::read_to_string(path(SCENE)).unwrap();
    let text: String = text
        .split("\n\n")
        .filter(|part| !part.starts_with("[joints.rail]") && !part.starts_with("[initial.bodies]"))
        .map(|part| format!("{part}\n\n"))
        .collect();
    let anchor = "\n[bodies.bob]\ntype = \"point_mass\"\nmass = 1.0\n[initial.bodies]\nbob = { x = 1.0, y = 1.0 }\n";
    let overrides: Vec<String> = moving.iter().map(|o| (*o).to_owned()).collect();
    let scene = Scene::parse(SCENE, &format!("{text}{anchor}"), &overrides)
        .unwrap_or_else(|e| panic!("{e}"));
    let (run, _) = run_scene(&scene);
    let [pulls, balance] = [Worst::new(), Worst::new()];
    for (t, n) in run.get("t").into_iter().zip(run.get("element.force")) {
        pulls.see(n / (C * 0.2) - (1.0 - (-K * t / C).exp()));
    }
    let work = run.get("energy.work");
    let last = work[work.len() - 1];
    run.get("energy.numerical")
        .iter()
        .for_each(|lost| balance.see(lost / last));
    Rung::Routes
        .asks("Maxwell element drawn at constant speed: pull against c v (1 - exp(-k t/c)), relative to c v")
        .within(&pulls, 1e-5, "Bathe's scheme with steps of 1/100 of c/k: h^2/24 of the rate of change, 4e-6");
    Rung::Balance
        .asks("Maxwell element drawn at constant speed: work that is neither stored nor dissipated, relative")
        .within(&balance, 1e-6, "h^2 (k/c)^2/100 = 1e-6 with steps of 1/100 of c/k");
}

/// The accuracy that a run asks for holds the elongation, too.
#[test]
fn an_accuracy_holds_the_internal_state() {
    for position in [1e-5, 1e-8] {
        let pace =
            format!("integrator={{method=\"dormand_prince\",accuracy={{position={position:e}}}}}");
        let (recording, _) = run(SCENE, &[&pace]);
        let pairs = recording
            .get("t")
            .into_iter()
            .zip(recording.get("element.force"));
        let worst = pairs
            .map(|(t, n)| (n - pull(t)).abs() / K)
            .fold(0.0, f64::max);
        // N/k is a difference of two lengths; three times the accuracy is what every run must hold
        assert!(worst < 6.0 * position, "{worst:e} for {position:e}");
    }
}

#[test]
fn an_internal_state_has_no_equilibrium() {
    for change in ["simulation.analysis=\"static\"", "initial.equilibrium=true"] {
        let at_rest = "initial.bodies={block={x=0.4,y=0.0,theta=0.0}}";
        let error = Simulation::new(&load(SCENE, &[at_rest, change])).unwrap_err();
        assert!(error.to_string().contains("internal state"), "{error}");
    }
    let text = std::fs::read_to_string(path(SCENE)).unwrap();
    for (change, told) in [
        (
            "forces.element.damping=0.0",
            "`forces.element.damping` must be",
        ),
        (
            "forces.element.stiffness=-1.0",
            "`forces.element.stiffness` must be",
        ),
        (
            "forces.element.to=\"ground.wall\"",
            "joins a point to itself",
        ),
    ] {
        let error = Scene::parse(SCENE, &text, &[change.to_owned()]).unwrap_err();
        assert!(error.to_string().contains(told), "{change}: {error}");
    }
}

//! Every method on mechanisms: its order in positions, accelerations and forces, and the scenes it refuses.

use crate::bad_input::check;
use crate::support::{NATURAL, TestRecording, load, run, run_scene};
use ladder::{Rung, Worst};
use looselink::scene::Scene;
use looselink::simulate::Simulation;

/// Overrides that choose a method, its name for reports and its order.
const METHODS: [(&[&str], &str, f64); 10] = [
    (&[], "Bathe's scheme", 2.0),
    (
        &["integrator.spectral_radius=0.8"],
        "Bathe's scheme, spectral radius 0.8",
        2.0,
    ),
    (
        &["integrator.method=trapezoidal"],
        "the trapezoidal rule",
        2.0,
    ),
    (
        &["integrator.method=backward_euler"],
        "the backward Euler rule",
        1.0,
    ),
    (
        &[
            "integrator.method=generalized_alpha",
            "integrator.spectral_radius=0.8",
        ],
        "generalised-α, spectral radius 0.8",
        2.0,
    ),
    (
        &["integrator.method=hht", "integrator.spectral_radius=0.8"],
        "HHT, spectral radius 0.8",
        2.0,
    ),
    (&["integrator.method=dormand_prince"], "Dormand-Prince", 5.0),
    (&["integrator.method=esdirk3"], "ESDIRK 3", 3.0),
    (&["integrator.method=esdirk5"], "ESDIRK 5", 5.0),
    (&["integrator.method=dop853"], "DOP853", 8.0),
];

/// A name, a scene and what is changed in it, its duration, the time between rows, the coarsest step of methods of order 1, 2, 3, 5 and 8,
/// and channels that are compared.
struct SmoothScene {
    name: &'static str,
    scene: &'static str,
    changes: &'static [&'static str],
    duration: f64,
    interval: f64,
    coarse: [f64; 5],
    channels: &'static [&'static str],
}

const SMOOTH: [SmoothScene; 5] = [
    SmoothScene {
        name: "pendulum",
        scene: "pendulum",
        changes: &[],
        duration: 0.96,
        interval: 0.12,
        coarse: [1e-3, 4e-3, 8e-3, 0.02, 0.12],
        channels: &["points.rod.bob.y", "points.rod.bob.ay", "pivot.force"],
    },
    SmoothScene {
        name: "soft-pendulum",
        scene: "soft-pendulum",
        changes: &[],
        duration: 0.2,
        interval: 4e-3,
        coarse: [1e-4, 4e-4, 8e-4, 2e-3, 4e-3],
        channels: &["points.rod.end.y", "points.rod.end.vy"],
    },
    SmoothScene {
        name: "3rrr/case2",
        scene: "3rrr/case2",
        changes: &[],
        duration: 8e-4,
        interval: 8e-5,
        coarse: [1e-7, 1e-6, 2e-6, 1.6e-5, 8e-5],
        channels: &["platform.ax", "B1.force"],
    },
    // a journal lies in its bearing, rocks, and swings in the stiffness of the contact, which stays closed
    SmoothScene {
        name: "bouncing-journal",
        scene: "bouncing-journal",
        changes: &[
            "simulation.gravity=[0.0,-9.81]",
            "contacts.aluminium.restitution=1.0",
            "initial.bodies.journal={ x = 4e-7, y = -2.0016e-5, theta = 0.0, vx = 0.0, vy = 0.0, omega = 0.0 }",
        ],
        duration: 8e-4,
        interval: 4e-5,
        coarse: [1e-7, 2e-6, 1e-5, 2e-5, 4e-5],
        channels: &["journal.y", "journal.ay", "pin.force"],
    },
    // the same with a restitution of one half, after an impact at 0.3 mm/s: a third of the critical damping
    SmoothScene {
        name: "bouncing-journal, restitution 0.5",
        scene: "bouncing-journal",
        changes: &[
            "simulation.gravity=[0.0,-9.81]",
            "contacts.aluminium.restitution=0.5",
            "integrator.newton_tolerance=1e-17",
            "initial.bodies.journal={ x = 4e-7, y = -2.0016e-5, theta = 0.0, vx = 0.0, vy = -3e-4, omega = 0.0 }",
        ],
        duration: 8e-4,
        interval: 4e-5,
        coarse: [1e-7, 2e-6, 1e-5, 5e-6, 4e-5],
        channels: &["journal.y", "journal.ay", "pin.force"],
    },
];

impl SmoothScene {
    fn run(&self, method: &[&str], step: f64) -> TestRecording {
        let settings = [
            format!("simulation.duration={}", self.duration),
            format!("output.interval={:e}", self.interval),
            format!("integrator.step={step:e}"),
            "integrator.newton_tolerance=1e-14".to_owned(),
            "output.channels=[\"*\"]".to_owned(),
        ];
        let settings = settings.iter().map(String::as_str);
        let changes = self.changes.iter().chain(method).copied();
        let all: Vec<&str> = settings.chain(changes).collect();
        run(&format!("{}.toml", self.scene), &all).0
    }

    fn error(&self, run: &TestRecording, exact: &TestRecording, channel: &str) -> f64 {
        let worst = Worst::new();
        for (a, b) in run.get(channel).iter().zip(&exact.get(channel)) {
            worst.see(a - b);
        }
        worst.value()
    }
}

#[test]
fn every_method_has_its_order_on_mechanisms() {
    for smooth in &SMOOTH {
        let exact = smooth.run(METHODS[9].0, smooth.coarse[4] / 16.0);
        for (method, name, order) in METHODS {
            let coarse = smooth.coarse[[1.0, 2.0, 3.0, 5.0, 8.0]
                .iter()
                .position(|o| *o == order)
                .unwrap()];
            let steps = [coarse, coarse / 2.0, coarse / 4.0];
            let runs = steps.map(|h| smooth.run(method, h));
            for channel in smooth.channels {
                let values = exact.get(channel);
                let size = values.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
                let errors = steps.iter().zip(&runs);
                let errors: Vec<(f64, f64)> = errors
                    .map(|(h, run)| (*h, smooth.error(run, &exact, channel)))
                    .filter(|(_, error)| *error > 4.0 * f64::EPSILON * size) // below is rounding
                    .collect();
                let question =
                    Rung::OrderInTime.asks(format!("{}: {name}, error of {channel}", smooth.name));
                let reason = "the order of the method; reference: DOP853 with a sixteenth of its coarsest step";
                if order >= 5.0 {
                    // at steps whose error stands above rounding the next terms are not small beside the leading one
                    let bounds = order - 0.5..1.12 * order;
                    question.falls_on_average("Step h [s]", &errors, bounds, reason);
                } else {
                    let bounds = order - 0.2..order + 0.2;
                    question.falls("Step h [s]", &errors, bounds, reason);
                }
            }
        }
    }
}

/// Velocity Verlet, on a mechanism without constraint rows; with them it is refused by name.
#[test]
fn velocity_verlet_takes_what_it_can() {
    for (place, coarse) in [(1, 4e-4), (3, 1e-6), (4, 2.5e-7)] {
        let smooth = &SMOOTH[place];
        let exact = smooth.run(METHODS[9].0, smooth.coarse[4] / 16.0);
        let steps = [coarse, 0.5 * coarse, 0.25 * coarse];
        let runs = steps.map(|h| smooth.run(&["integrator.method=velocity_verlet"], h));
        for channel in smooth.channels {
            let errors = [0, 1, 2].map(|i| (steps[i], smooth.error(&runs[i], &exact, channel)));
            Rung::OrderInTime
                .asks(format!(
                    "{}: velocity Verlet, error of {channel}",
                    smooth.name
                ))
                .falls(
                    "Step h [s]",
                    &errors,
                    1.9..2.1,
                    "the order of the method; reference: DOP853 with a sixteenth of its coarsest step",
                );
        }
    }
    let constrained = [
        "integrator.method=velocity_verlet",
        "bodies.rod.coordinates=\"center\"",
    ];
    let constrained = load("pendulum.toml", &constrained);
    let error = Simulation::new(&constrained).unwrap_err();
    let message = "method \"velocity_verlet\" cannot enforce constraints; the first of the 2 constraints here is joint pivot (x)";
    check(&error, "a pendulum", message, "velocity_verlet");
}

/// Fifteen impacts: with located onsets Bathe's scheme keeps its order; without, errors are several times as large and
/// scatter with the place of the impacts in their steps.
#[test]
fn located_impacts_keep_the_order() {
    let impacts = |step: f64, more: &[&str]| {
        let settings = [
            "simulation.duration=0.006".to_owned(),
            "output.interval=1e-4".to_owned(),
            format!("integrator.step={step:e}"),
        ];
        let settings = settings.iter().map(String::as_str);
        let all: Vec<&str> = settings.chain(more.iter().copied()).collect();
        let (recording, report) = run("3rrr/case3.toml", &all);
        assert_eq!(report.onsets, 15);
        recording
    };
    let exact = impacts(5e-7, &["integrator.method=dormand_prince"]);
    let error = |step: f64, more: &[&str]| {
        let found = impacts(step, more);
        let worst = Worst::new();
        for channel in ["error.x", "error.y"] {
            for (a, b) in found.get(channel).iter().zip(&exact.get(channel)) {
                worst.see(a - b);
            }
        }
        (step, worst.value())
    };
    let steps = [4e-6, 2e-6, 1e-6, 5e-7];
    let located = steps.map(|h| error(h, &[]));
    Rung::OrderInTime
        .asks("3rrr/case3, 15 impacts, located onsets: error of the platform's position [m]")
        .falls(
            "Step h [s]",
            &located,
            1.8..2.2,
            "order 2 of Bathe's scheme; against Dormand and Prince's at 5e-7 s",
        );
    let without = steps.map(|h| error(h, &["integrator.locate_onsets=false"]));
    let share = Worst::new();
    for (located, without) in located.iter().zip(&without) {
        share.see(located.1 / without.1);
    }
    Rung::Routes
        .asks("3rrr/case3, 15 impacts: largest ratio of the error with located onsets to the error without")
        .within(&share, 0.5, "an onset that is not located is late by a random part of h");
}

/// Methods with explicit steps on constraint rows keep them.
#[test]
fn explicit_runge_kutta_methods_keep_constraints() {
    let worst = Worst::new();
    for method in ["dormand_prince", "dop853"] {
        for name in ["pendulum.toml", "n-four-bar.toml", "3rrr/case3.toml"] {
            let method = format!("integrator.method={method}");
            let settings = [
                &method,
                "integrator.step=1e-3",
                "output.interval=1e-3",
                "simulation.duration=1.0",
            ];
            let short = ["integrator.step=1e-5", "simulation.duration=0.01"];
            let settings = match name {
                "3rrr/case3.toml" => [&settings[..], &short, &NATURAL].concat(),
                "pendulum.toml" => [&settings[..], &["bodies.rod.coordinates=\"center\""]].concat(),
                _ => settings.to_vec(),
            };
            let mut simulation = Simulation::new(&load(name, &settings)).unwrap();
            simulation.run(&mut ()).unwrap();
            let (distance, rate, _) = simulation
                .model()
                .worst_constraint(simulation.state())
                .unwrap();
            worst.at(format!("in {name}"));
            worst.see(distance);
            worst.see(rate);
        }
    }
    Rung::Identities
        .asks("Pendulum and four-bar windows after 1 s, case 3 after 10 ms, with Dormand and Prince's methods of orders 5 and 8: largest violation of a constraint [m, m/s]")
        .within(&worst, 1e-14, "rounding of positions and velocities near 1");
}

/// Every fault that a choice of the method can have.
#[test]
fn faults_of_the_method_are_named() {
    let loose = include_str!("../scenes/3rrr/case4.toml");
    let roll_up = include_str!("../scenes/roll-up.toml");
    for (text, overrides, message, underlined) in [
        (
            loose,
            &["integrator.method=leapfrog"] as &[&str],
            "`integrator.method` cannot be \"leapfrog\"",
            "leapfrog",
        ),
        (
            loose,
            &["integrator.method=hht"],
            "missing key `spectral_radius` in integrator",
            "[integrator]",
        ),
        (
            loose,
            &["integrator.method=hht", "integrator.spectral_radius=0.4"],
            "`integrator.spectral_radius` must lie between 0.5 and 1, not 0.4",
            "0.4",
        ),
        (
            loose,
            &["integrator.spectral_radius=1.1"],
            "`integrator.spectral_radius` must lie between 0 and 1, not 1.1",
            "1.1",
        ),
        (
            loose,
            &[
                "integrator.method=trapezoidal",
                "integrator.spectral_radius=1",
            ],
            "`integrator.spectral_radius` is a parameter of \"bathe\", \"generalized_alpha\", \"hht\" only",
            "spectral_radius",
        ),
        (
            loose,
            &["integrator.accuracy={ position = 1e-9 }"],
            "missing key `horizon` in integrator.accuracy",
            "{ position = 1e-9 }",
        ),
        (
            loose,
            &["integrator.accuracy={ position = 0.0, horizon = 0.01 }"],
            "`integrator.accuracy.position` must be greater than zero, not 0.0",
            "0.0",
        ),
        (
            loose,
            &["integrator.accuracy={ position = 1e-9, horizon = 0.01, force = 1.0 }"],
            "unknown key `force` in integrator.accuracy",
            "force",
        ),
        (
            roll_up,
            &["integrator.accuracy={ position = 1e-9 }"],
            "a static analysis takes a `step`, not an `accuracy`",
            "accuracy",
        ),
    ] {
        let owned: Vec<String> = overrides.iter().map(|o| (*o).to_owned()).collect();
        let error = Scene::parse("scene.toml", text, &owned).unwrap_err();
        check(&error, &overrides.join(" "), message, underlined);
    }
    // two rules for the step in one file; an override replaces the one of the file
    let both = loose.replace(
        "method = \"bathe\"",
        "method = \"bathe\"\naccuracy = { position = 1e-9, horizon = 0.01 }",
    );
    let error = Scene::parse("scene.toml", &both, &[]).unwrap_err();
    let message = "`integrator` has both `step` and `accuracy`";
    check(&error, "both", message, "accuracy");
    let only = both.replace("step = 1.25e-6", "");
    let again = Scene::parse("scene.toml", &only, &["integrator.step=1e-5".to_owned()]);
    assert_eq!(again.unwrap().integrator.step(), Some(1e-5));
}

/// Axial forces of short elements are stiff: their rounding moves velocities by 1e-8 m/s, a thousand times the tolerance. Once a
/// stage has met this rounding, the next ones stop at it, and their tangent may serve more than one of them.
#[test]
fn stages_do_not_iterate_on_rounding() {
    let settings = [
        "bodies.link1.elements=64",
        "bodies.link2.elements=64",
        "bodies.link3.elements=64",
        "simulation.duration=1e-3",
        "output.interval=5e-4",
        "integrator.method=esdirk5",
        "integrator.accuracy={ position = 1e-11, horizon = 0.02 }",
    ];
    let (_, report) = run_scene(&load("3rrr/case2.toml", &settings));
    let [iterations, factorisations] = [report.newton_iterations, report.factorisations]
        .map(|count| count as f64 / report.stages as f64);
    assert!(report.stagnations > 0, "rounding is not met");
    // an update that reaches the rounding and one that is rounding
    assert!(iterations < 2.5, "{iterations} iterations a stage");
    assert!(
        factorisations < 1.0,
        "{factorisations} factorisations a stage"
    );
}

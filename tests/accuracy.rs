//! Steps that follow an accuracy: what is achieved, what is counted, what is refused.

use crate::support::{TestRecording, load, run, run_scene};
use ladder::{Rung, Worst};
use looselink::newton::Response;
use looselink::scene::Scene;
use looselink::simulate::{Control, Observer, Progress, Recording, RunError, Simulation};
use looselink::stepper::{Estimate, EstimatedSolution};
use looselink::system::System;
use std::f64::consts::{PI, TAU};

/// A scene, its duration, the time between rows, the step of the reference, channels of position.
const SCENES: [(&str, f64, f64, f64, &[&str]); 5] = [
    ("3rrr/case2", 4e-3, 1e-4, 1e-6, &["error.x", "error.y"]),
    ("3rrr/case3", 6e-3, 1e-4, 5e-7, &["error.x", "error.y"]),
    ("3rrr/case4", 3e-3, 1e-4, 5e-7, &["error.x", "error.y"]),
    ("bouncing-journal", 8e-3, 1e-4, 1e-7, &["journal.x"]),
    (
        "pendulum",
        2.0,
        0.01,
        1e-3,
        &["points.rod.bob.x", "points.rod.bob.y"],
    ),
];

fn settings(duration: f64, interval: f64, method: &str, pace: &str) -> Vec<String> {
    vec![
        format!("simulation.duration={duration}"),
        format!("output.interval={interval:e}"),
        format!("integrator.method={method}"),
        format!("integrator.{pace}"),
        "output.channels=[\"*\"]".to_owned(),
    ]
}

fn runs(scene: &str, settings: &[String]) -> TestRecording {
    let settings: Vec<&str> = settings.iter().map(String::as_str).collect();
    run(&format!("{scene}.toml"), &settings).0
}

/// Errors of all rows of some channels, over the accuracy asked for.
fn see_errors(
    worst: &Worst,
    found: &TestRecording,
    exact: &TestRecording,
    channels: &[&str],
    accuracy: f64,
) {
    for channel in channels {
        for (a, b) in found.get(channel).iter().zip(&exact.get(channel)) {
            worst.see((a - b) / accuracy);
        }
    }
}

#[test]
fn the_accuracy_asked_for_is_achieved() {
    let worst = Worst::new();
    for (scene, duration, interval, fine, channels) in SCENES {
        let reference = settings(
            duration,
            interval,
            "dormand_prince",
            &format!("step={fine:e}"),
        );
        let exact = runs(scene, &reference);
        for (method, accuracies) in [
            ("bathe", &[1e-6, 1e-7] as &[f64]),
            ("trapezoidal", &[1e-6, 1e-7]),
            ("dormand_prince", &[1e-6, 1e-8, 1e-10]),
            ("dop853", &[1e-6, 1e-8, 1e-10]),
        ] {
            for accuracy in accuracies {
                let pace = format!("accuracy={{ position = {accuracy:e}, horizon = {duration} }}");
                let found = runs(scene, &settings(duration, interval, method, &pace));
                worst.at(format!("in {scene} with {method} and {accuracy:e} m"));
                see_errors(&worst, &found, &exact, channels, *accuracy);
            }
        }
    }
    Rung::HardCases
        .asks("Error-controlled Bathe, trapezoidal, Dormand-Prince and DOP853, 1e-6 to 1e-10 m, with and without impacts: achieved error over requested accuracy")
        .within(&worst, 10.0, "the estimate does not include the growth of errors from impact to impact");
}

/// Methods of order 2 on stiff beams, at a start from rest and under a sudden load, and with constraint rows: what the stage
/// matrix holds down, what Newton's method leaves and what rounding puts into accelerations is no error to follow.
#[test]
fn stiff_modes_and_rounding_do_not_stop_a_run() {
    let scenes = [
        ("cantilever-dynamic", 2.0, 0.02, 1e-4, "points.beam.end"),
        ("spin-up", 1.0, 0.02, 1e-6, "points.blade.end"),
        ("pendulum", 1.0, 0.01, 1e-7, "points.rod.bob"),
        ("slider-crank/both", 2e-3, 1e-4, 1e-7, "points.rod.end"),
    ];
    for (scene, duration, interval, accuracy, point) in scenes {
        let positions = |method: &str, accuracy: f64| {
            let pace = format!("accuracy={{ position = {accuracy:e}, horizon = {duration} }}");
            let mut settings = settings(duration, interval, method, &pace);
            if ["generalized_alpha", "hht"].contains(&method) {
                settings.push("integrator.spectral_radius=0.8".to_owned());
            }
            runs(scene, &settings)
        };
        let exact = positions("bathe", 0.1 * accuracy);
        for method in ["bathe", "trapezoidal", "generalized_alpha", "hht"] {
            let found = positions(method, accuracy);
            for channel in ["x", "y"].map(|c| format!("{point}.{c}")) {
                for (a, b) in found.get(&channel).iter().zip(&exact.get(&channel)) {
                    // the error asked for, and that of the run it is compared with
                    assert!(
                        (a - b).abs() < 1.1 * accuracy,
                        "{scene}, {method}: {channel}"
                    );
                }
            }
        }
    }
}

/// Error achieved falls in proportion to the error asked for.
#[test]
fn accuracy_is_proportional() {
    for ((scene, duration, interval, fine, channels), asked) in [
        (SCENES[0], [1e-7, 1e-8, 1e-9]),
        (SCENES[4], [1e-5, 1e-6, 1e-7]),
    ] {
        let reference = settings(
            duration,
            interval,
            "dormand_prince",
            &format!("step={fine:e}"),
        );
        let exact = runs(scene, &reference);
        let error = |accuracy: f64| {
            let pace = format!("accuracy={{ position = {accuracy:e}, horizon = {duration} }}");
            let found = runs(scene, &settings(duration, interval, "bathe", &pace));
            let worst = Worst::new();
            for channel in channels {
                for (a, b) in found.get(channel).iter().zip(&exact.get(channel)) {
                    worst.see(a - b);
                }
            }
            (accuracy, worst.value())
        };
        Rung::OrderInTime
            .asks(format!("{scene}: error of error-controlled Bathe against the requested accuracy [m]"))
            .falls(
                "Requested accuracy [m]",
                &asked.map(error),
                0.8..1.2,
                "proportional: the errors of the steps within a horizon add up to the requested accuracy",
            );
    }
}

/// An explicit method does not damp a closed contact: with the accuracy asked for, contacts would open at random, and the
/// integrator would gain or lose ten times the energy that they dissipate.
#[test]
fn an_explicit_method_tells_contact_from_flight() {
    let pace = "accuracy={ position = 1e-5, horizon = 0.01 }";
    for method in ["dormand_prince", "dop853"] {
        let settings = settings(0.1, 5e-4, method, pace);
        let settings: Vec<&str> = settings.iter().map(String::as_str).collect();
        let report = run("3rrr/case3.toml", &settings).1;
        // a hundredth of the clearance
        assert_eq!(report.accuracy.unwrap().followed, 0.01 * 2e-5, "{method}");
        let ledger = report.ledger.unwrap();
        let share = ledger.numerical.abs() / ledger.dissipated();
        // beyond which a run warns
        assert!((0.0..0.05).contains(&share), "{method}: {share}");
    }
}

/// The report counts what the control did; a run repeated does the same.
#[test]
fn rejections_are_counted_and_repeatable() {
    let pace = "accuracy={ position = 1e-8, horizon = 0.008 }";
    let settings = settings(0.008, 1e-4, "dormand_prince", pace);
    let settings: Vec<&str> = settings.iter().map(String::as_str).collect();
    let scene = load("bouncing-journal.toml", &settings);
    let (first, report) = run_scene(&scene);
    let (second, again) = run_scene(&scene);
    assert_eq!(report, again);
    for name in first.names() {
        let bits = |r: &TestRecording| r.get(name).iter().map(|x| x.to_bits()).collect::<Vec<_>>();
        assert_eq!(bits(&first), bits(&second), "{name}");
    }
    let control = report.accuracy.unwrap();
    assert_eq!(
        (control.asked.position, control.asked.horizon),
        (1e-8, 0.008)
    );
    assert!(control.rejected_steps > 0);
    assert_eq!(
        control.rejected_by.values().sum::<u64>(),
        control.rejected_steps
    );
    // only x moves
    assert_eq!(
        control.rejected_by.keys().collect::<Vec<_>>(),
        ["journal.x"]
    );
    let [shortest, longest] = control.steps;
    // a contact lasts 8e-5 s, a flight 2 ms; no step is longer than a row
    assert!(
        shortest < 5e-6 && (longest - 1e-4).abs() < 1e-12,
        "{shortest} {longest}"
    );
    assert_eq!(report.onsets, 3);
    // with a fixed step there is nothing to tell
    assert!(
        run("bouncing-journal.toml", &["simulation.duration=0.001"])
            .1
            .accuracy
            .is_none()
    );
}

/// Within the horizon no more energy is lost or gained than was asked for; without that, far more.
#[test]
fn an_accuracy_of_energy_holds_the_balance() {
    let worst = Worst::new();
    for (method, energy) in [("dormand_prince", 3e-9), ("bathe", 3e-7)] {
        let gathered = |pace: String| {
            let settings = settings(0.06, 5e-4, method, &pace);
            let settings: Vec<&str> = settings.iter().map(String::as_str).collect();
            let (recording, report) = run("3rrr/case3.toml", &settings);
            let balance = recording.get("energy.numerical");
            // windows of the horizon, 20 rows
            let windows = balance.windows(21).map(|w| (w[20] - w[0]).abs());
            (windows.fold(0.0, f64::max), report.accuracy.unwrap())
        };
        let (free, _) = gathered("accuracy={ position = 1e-5, horizon = 0.01 }".into());
        let (held, control) = gathered(format!(
            "accuracy={{ position = 1e-5, energy = {energy:e}, horizon = 0.01 }}"
        ));
        assert!(free > 3.0 * energy, "{method}: {free:e} J without");
        assert!(control.rejected_by["the energy balance"] > 0);
        worst.see(held / energy);
    }
    Rung::HardCases
        .asks("3-RRR with loose joints, requested accuracy of energy: energy lost or gained within a horizon over the requested accuracy")
        .within(&worst, 1.0, "the change of the energy balance in every step is measured, and their sum is kept below the requested accuracy");
}

/// Long after two runs have gone different ways their statistics agree, whatever the method: over the second of two seconds
/// the envelopes and the rms of the displacement error within a hundredth, the share of contact within 0.03; and the
/// integrator loses less than a twentieth of what the contacts dissipate.
#[test]
fn statistics_of_two_seconds_are_those_of_any_method() {
    let [envelopes, shares, losses] = [Worst::new(), Worst::new(), Worst::new()];
    let controlled = |method: &str, accuracy: &str| {
        let pace = format!("accuracy={{ {accuracy}, horizon = 0.01 }}");
        settings(2.0, 5e-4, method, &pace)
    };
    for (scene, accuracy, fixed) in [
        ("3rrr/case3", "position = 1e-6, energy = 1e-7", "step=5e-6"),
        (
            "3rrr/case4",
            "position = 3e-6, energy = 5e-8",
            "step=2.5e-6",
        ),
    ] {
        let all = [
            settings(2.0, 5e-4, "bathe", fixed),
            controlled("trapezoidal", accuracy),
            controlled("dormand_prince", "position = 1e-6, energy = 1e-8"),
        ];
        let measures = all.map(|settings| {
            let run = runs(scene, &settings);
            let part = |name: &str| run.get(name)[2000..].to_vec();
            let [x, y] = ["error.x", "error.y"].map(part);
            let largest = |x: &[f64]| x.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
            let squares = x.iter().zip(&y).map(|(x, y)| x * x + y * y).sum::<f64>();
            let joints = ["B1", "B2", "B3", "C1", "C2", "C3"];
            let contact = joints.iter().flat_map(|j| part(&format!("{j}.contact")));
            let share = contact.sum::<f64>() / (x.len() * joints.len()) as f64;
            let gained = |name: &str| part(name).last().unwrap() - part(name)[0];
            let loss = gained("energy.numerical") / gained("energy.contact_dissipated");
            let rms = (squares / x.len() as f64).sqrt();
            ([largest(&x), largest(&y), rms], share, loss)
        });
        let (exact, share, _) = measures[0];
        for (sizes, contact, loss) in &measures[1..] {
            for (size, exact) in sizes.iter().zip(exact) {
                envelopes.see(size / exact - 1.0);
            }
            shares.see(contact - share);
            losses.see(*loss);
        }
    }
    let name = "Cases 3 and 4, the second of two seconds, error-controlled trapezoidal and Dormand-Prince against Bathe with a \
                short step";
    Rung::HardCases
        .asks(format!("{name}: envelopes and rms of the displacement error, relative"))
        .within(&envelopes, 0.01, "chaotic runs: one second is a finite sample, and two runs of one method differ by half of this bound");
    Rung::HardCases
        .asks(format!("{name}: share of time in contact"))
        .within(&shares, 0.03, "chaotic runs: one second is a finite sample");
    Rung::HardCases
        .asks(format!(
            "{name}: energy lost by the integrator over energy dissipated in contact"
        ))
        .within(
            &losses,
            0.05,
            "the requested accuracy of energy over the contact dissipation of 2e-5 J per second",
        );
}

/// An accuracy below rounding is not ground through: the run ends with the coordinate and the time.
#[test]
fn an_accuracy_out_of_reach_is_an_error() {
    let pace = "accuracy={ position = 1e-18, horizon = 0.01 }";
    let settings = settings(0.01, 1e-4, "bathe", pace);
    let settings: Vec<&str> = settings.iter().map(String::as_str).collect();
    let mut simulation = Simulation::new(&load("3rrr/case4.toml", &settings)).unwrap();
    let error = simulation.run(&mut ()).unwrap_err();
    let RunError::Accuracy { name, t, step, .. } = &error else {
        panic!("{error}");
    };
    assert!(
        name.starts_with("link") || name.starts_with("platform"),
        "{name}"
    );
    assert!((0.0..0.01).contains(t) && *step < 1e-10);
    assert!(
        error
            .to_string()
            .starts_with("the accuracy of 1e-18 m over 0.01 s cannot be reached at t =")
    );
}

/// Backward Euler, of order 1, would take 5e10 steps for a nanometre: the run is refused before its first step, with an
/// accuracy that it then begins with.
#[test]
fn an_accuracy_that_takes_too_many_steps_is_refused() {
    let settings = |position: f64| {
        let pace = format!("integrator.accuracy={{ position = {position:e}, horizon = 1.0 }}");
        ["integrator.method=backward_euler".to_owned(), pace]
    };
    let simulation = |position| {
        let settings = settings(position);
        let settings: Vec<&str> = settings.iter().map(String::as_str).collect();
        Simulation::new(&load("pendulum.toml", &settings)).unwrap()
    };
    let mut refused = simulation(1e-9);
    let error = refused.run(&mut ()).unwrap_err();
    let RunError::Unaffordable {
        steps,
        affordable: Some(affordable),
        ..
    } = error
    else {
        panic!("{error}");
    };
    assert_eq!(refused.state().t, 0.0);
    assert_eq!(refused.report().steps, 0);

    let mut coarse = simulation(1e-3);
    coarse.run(&mut ()).unwrap();
    let taken = coarse.report().steps as f64;
    let worst = Worst::new();
    worst.see((steps / taken / 1e6).ln());
    Rung::HardCases
        .asks("Backward Euler: steps foreseen for 1 nm over a million times those taken for 1 mm")
        .within(
            &worst,
            4.0_f64.ln(),
            "a factor of 4: the step is inverse to the rate of the acceleration, which varies along a swing",
        );

    struct Begun;
    impl Observer for Begun {
        fn row(&mut self, _: &[f64]) -> std::io::Result<()> {
            Ok(())
        }
        fn step(&mut self, _: &Progress) -> std::io::Result<Control> {
            Ok(Control::Stop)
        }
    }
    let begun = simulation(affordable.position).run(&mut Begun).unwrap_err();
    assert!(matches!(begun, RunError::Interrupted { .. }), "{begun}");
}

/// A position looser than the play of a joint would let stiff links shake contacts open and closed, which takes more steps
/// than a tight accuracy does.
#[test]
fn an_accuracy_looser_than_the_clearance_takes_no_more_steps() {
    let steps = |method: &str, position: f64| {
        let pace = format!("accuracy={{ position = {position:e}, horizon = 0.01 }}");
        let settings = settings(0.01, 5e-4, method, &pace);
        let settings: Vec<&str> = settings.iter().map(String::as_str).collect();
        let mut simulation =
            Simulation::new(&load("3rrr/case4-4elements.toml", &settings)).unwrap();
        simulation.run(&mut ()).unwrap();
        simulation.report().steps
    };
    let clearance = 2e-5;
    for (method, part) in [("trapezoidal", 0.5), ("dormand_prince", 0.01)] {
        let largest = part * clearance;
        let fewest = steps(method, largest);
        assert_eq!(steps(method, 1e-3), fewest, "{method}");
        assert_ne!(steps(method, 0.1 * largest), fewest, "{method}");
    }
}

/// Near a singular pose rounding may exceed an accuracy in steps of any length. A run that no step takes further ends.
#[test]
fn rejections_in_a_singular_pose_come_to_an_end() {
    let settings = [
        "simulation.duration=2.0",
        "integrator.method=trapezoidal",
        "integrator.accuracy={ position = 1e-8, horizon = 10.0 }",
    ];
    let mut simulation = Simulation::new(&load("n-four-bar.toml", &settings)).unwrap();
    match simulation.run(&mut ()) {
        Ok(()) => {}
        Err(error @ RunError::Accuracy { .. }) => {
            assert!(error.to_string().contains("in a singular pose"), "{error}");
        }
        Err(error) => panic!("{error}"),
    }
}

/// An explicit method at its limit of stability shakes a stiff blade by less than the accuracy allows. That is more energy
/// than the slow start has supplied, and no reason to stop the run.
#[test]
fn a_gain_within_the_accuracy_does_not_stop_a_run() {
    let settings = [
        "simulation.duration=0.15",
        "integrator.method=dormand_prince",
        "integrator.accuracy={ position = 1e-4, horizon = 15.0 }",
    ];
    let mut simulation = Simulation::new(&load("spin-up.toml", &settings)).unwrap();
    simulation.run(&mut ()).unwrap();
}

/// A journal that is thrown up and falls again touches the bearing between the ends of one long step; the contact is found
/// and located where the parabola meets the wall.
#[test]
fn a_touch_within_one_step_is_found() {
    const TOSS: &str = r#"
format = 1
title = "a toss"
simulation = { duration = 0.1, gravity = [0.0, -10.0] }
integrator = { newton_tolerance = 1e-11, onset_tolerance = 1e-13 }
output = { interval = 0.02, channels = ["journal.*"] }
contacts.steel = { law = "hunt_crossley", bearing_radius = 0.1, clearance = 0.02, stiffness = 1e9, exponent = 1.5, restitution = 0.8, impact_velocity_floor = 1e-6 }
bodies.ground = { type = "ground", points.bearing = [0, 0] }
bodies.journal = { type = "rigid_body", mass = 0.05, inertia = 2.5e-6, points.centre = [0, 0] }
joints.pin = { type = "revolute", bearing = "ground.bearing", journal = "journal.centre", model = "clearance", contact = "steel" }
initial.bodies.journal = { x = 0, y = 0, theta = 0, vx = 0, vy = 0.633, omega = 0 }
"#;
    // the top of the parabola, at 0.0633 s, is 3.4e-5 m behind the wall; the steps end at 0.06 and 0.08 s, inside
    let onset = (0.633 - (0.633_f64 * 0.633 - 20.0 * 0.02).sqrt()) / 10.0;
    let worst = Worst::new();
    // long steps of DOP853 are unstable after the onset
    for (method, pace) in [
        ("dormand_prince", "step=0.02"),
        ("dop853", "accuracy={position=1e-9,horizon=0.1}"),
        ("velocity_verlet", "step=0.02"),
        ("trapezoidal", "step=0.02"),
    ] {
        let overrides = [
            format!("integrator.method={method}"),
            format!("integrator.{pace}"),
        ];
        let scene = Scene::parse("toss.toml", TOSS, &overrides);
        let (recording, report) = run_scene(&scene.unwrap());
        assert_eq!(report.unlocated_changes, 0, "{method}");
        worst.see(recording.onsets[0].t - onset);
    }
    Rung::ClosedForms
        .asks("Journal that touches its bearing and leaves within one step, four methods: instant of contact against the closed form [s]")
        .within(&worst, 1e-11, "the onset tolerance of 1e-13 m over 0.026 m/s");
}

/// The step loop allocates nothing with an accuracy either: a run twice as long allocates as often.
#[test]
fn controlled_steps_do_not_allocate() {
    let count = |duration: f64, method: &str| {
        let pace = "accuracy={ position = 1e-7, horizon = 0.01 }";
        let settings = settings(duration, 1e-3, method, pace);
        let settings: Vec<&str> = settings.iter().map(String::as_str).collect();
        let mut simulation = Simulation::new(&load("3rrr/case2.toml", &settings)).unwrap();
        let info = allocation_counter::measure(|| simulation.run(&mut ()).unwrap());
        assert!(simulation.report().steps > 20);
        info.count_total
    };
    for method in ["bathe", "dormand_prince", "dop853"] {
        assert_eq!(count(0.01, method), count(0.02, method), "{method}");
    }
}

/// Every method follows an accuracy; that of order one needs many steps for a coarse one.
#[test]
fn every_method_follows_an_accuracy() {
    let channels = ["points.bob.center.x", "points.bob.center.y"];
    let scene = "stiff-spring-pendulum";
    // a soft spring, so that its vibration is part of the motion
    let soft = "forces.spring.stiffness=100.0".to_owned();
    let with = |method: &str, pace: &str| {
        let mut settings = settings(2.0, 0.02, method, pace);
        settings.push(soft.clone());
        if matches!(method, "generalized_alpha" | "hht") {
            settings.push("integrator.spectral_radius=0.8".to_owned());
        }
        runs(scene, &settings)
    };
    let exact = with("dormand_prince", "step=5e-4");
    let worst = Worst::new();
    for (method, accuracy) in [
        ("generalized_alpha", 1e-5),
        ("hht", 1e-5),
        ("velocity_verlet", 1e-5),
        ("backward_euler", 1e-3),
    ] {
        let found = with(method, &format!("accuracy={{ position = {accuracy:e} }}"));
        worst.at(format!("with {method}"));
        see_errors(&worst, &found, &exact, &channels, accuracy);
    }
    Rung::OrderInTime
        .asks("Generalised-alpha, HHT, velocity Verlet and backward Euler: achieved error over requested accuracy")
        .within(&worst, 1.0, "the requested accuracy is reached");
}

/// A point mass on a spring of angular frequency w, with a displacement and a velocity at the start.
fn mass_on_a_spring(w: f64, [x, v]: [f64; 2], integrator: &str) -> Scene {
    let text = format!(
        r#"
format = 1
title = "a mass on a spring"
simulation = {{ duration = 1.0 }}
integrator = {{ {integrator} }}
output = {{ interval = 0.1, channels = ["bob.x"] }}
bodies.ground = {{ type = "ground", points.left = [-1.0, 0.0] }}
bodies.bob = {{ type = "point_mass", mass = 1.0 }}
forces.spring = {{ type = "spring_damper", from = "ground.left", to = "bob.center", stiffness = {:?}, damping = 0.0, rest_length = 1.0 }}
initial.bodies.bob = {{ x = {x:?}, y = 0.0, vx = {v:?}, vy = 0.0 }}
"#,
        w * w
    );
    Scene::parse("mass", &text, &[]).unwrap_or_else(|e| panic!("{e}"))
}

/// A point mass on a spring: an error of velocity e moves it by (w^2 + 1/H^2)^(-1/2) e within the horizon H, which the sum over
/// times tau finds between 1.0 and 1.5 times min(H, 1/w) e.
#[test]
fn the_response_to_an_error_of_velocity_is_that_of_its_vibration() {
    const HORIZON: f64 = 0.5;
    let estimate = Estimate {
        order: 3.0,
        of: EstimatedSolution::Solution,
        implicit: true,
    };
    for w in [1e-5, 5e-3, 0.1, 0.5, 9.0, 160.0, 9e3] {
        let integrator = r#"method = "trapezoidal", step = 1e-3, newton_tolerance = 1e-10"#;
        let simulation = Simulation::new(&mass_on_a_spring(w, [0.0; 2], integrator)).unwrap();
        let model = simulation.model();
        let mut work = model.work();
        let mut moved_by = |response: &mut Response, h: f64| {
            let terms = estimate.response(HORIZON, h, 1.0);
            let error = [0.01, 0.0];
            response.displacement(model, simulation.state(), terms, &error, &mut work)[0]
        };
        let mut response = Response::new(model, HORIZON);
        let ratio = moved_by(&mut response, 1e-9) / (0.01 * HORIZON.min(1.0 / w));
        assert!((1.0..1.5).contains(&ratio), "{w} rad/s: {ratio}");
        // vibrations that a longer step does not resolve do not count, whatever shorter steps came before
        let coarsely = moved_by(&mut Response::new(model, HORIZON), 0.02);
        assert_eq!(moved_by(&mut response, 0.02), coarsely);
    }
}

/// The error of a vibration of amplitude A and angular frequency w is w^3 h^2 A/12 times the time for the trapezoidal rule, in
/// position and, through the velocity, once more. The horizon allows position P/H a time. The number of steps that follows is
/// far below that of a motion that would drift with its errors of velocity.
#[test]
fn errors_of_velocity_in_a_vibration_do_not_count_as_drift() {
    const W: f64 = 1000.0;
    const A: f64 = 0.01;
    let (horizon, position) = (1.0, 1e-3);
    let integrator = format!(
        r#"method = "trapezoidal", accuracy = {{ position = {position:?}, horizon = {horizon:?} }}, newton_tolerance = 1e-10"#
    );
    let mut simulation = Simulation::new(&mass_on_a_spring(W, [A, 0.0], &integrator)).unwrap();
    simulation.run(&mut ()).unwrap();
    let steps = simulation.report().steps as f64;
    let expected = (12.0 * position / (horizon * W.powi(3) * A)).sqrt().recip();
    // as drift the errors of velocity would weigh w H = 1000 times as much, and take 30 times the steps
    let ratio = steps / expected;
    assert!((0.3..5.0).contains(&ratio), "{steps} steps, not {expected}");
}

/// A method that estimates the error of an embedded solution achieves in a vibration what is asked for, and not far more: the
/// error is that of the solution, whatever the order of the estimate and the steps a period. A first step from row to row would
/// cover five periods, and an implicit method would damp them, whether the vibration starts with a displacement or a velocity.
#[test]
fn the_error_of_a_vibration_is_that_asked_for() {
    const W: f64 = 300.0;
    const A: f64 = 0.01;
    let (most, least) = (Worst::new(), Worst::new());
    for (method, accuracies, tolerance) in [
        ("dormand_prince", &[1e-3, 1e-4, 1e-6, 1e-8] as &[f64], ""),
        ("dop853", &[1e-3, 1e-4, 1e-6, 1e-8], ""),
        // at 1e-8 m it would take a million steps
        ("esdirk3", &[1e-3, 1e-4, 1e-6], ", newton_tolerance = 1e-12"),
        (
            "esdirk5",
            &[1e-3, 1e-4, 1e-6, 1e-8],
            ", newton_tolerance = 1e-12",
        ),
    ] {
        for position in accuracies {
            for (start, phase) in [([A, 0.0], 0.0), ([0.0, A * W], -0.5 * PI)] {
                let integrator = format!(
                    r#"method = "{method}", accuracy = {{ position = {position:?}, horizon = 1.0 }}{tolerance}"#
                );
                let found = run_scene(&mass_on_a_spring(W, start, &integrator)).0;
                let (times, places) = (found.get("t"), found.get("bob.x"));
                let errors = times.iter().zip(&places);
                let error = errors
                    .map(|(t, x)| (x - A * (W * t + phase).cos()).abs())
                    .fold(0.0, f64::max);
                most.at(format!("{method}, {position} m, start {start:?}"));
                most.see(error / position);
                least.at(format!("{method}, {position} m, start {start:?}"));
                least.see(position / error);
            }
        }
    }
    Rung::OrderInTime
        .asks("Mass on a spring, 48 periods, four embedded methods, started by a displacement or a velocity: achieved error over requested accuracy")
        .within(&most, 1.0, "the requested accuracy is reached");
    Rung::OrderInTime
        .asks("Mass on a spring, 48 periods, four embedded methods, started by a displacement or a velocity: requested accuracy over achieved error")
        .within(&least, 20.0, "steps aim at a third of the accuracy; the errors of q and v both count; within a period they vary");
}

/// A motion that goes on from another state begins with a step that sees its vibrations, as a run does.
#[test]
fn a_vibration_is_seen_where_a_run_goes_on_from_another_state() {
    const W: f64 = 300.0;
    const A: f64 = 0.01;
    const ACCURACY: f64 = 1e-3;
    let integrator = format!(
        r#"method = "esdirk5", accuracy = {{ position = {ACCURACY:?}, horizon = 1.0 }}, newton_tolerance = 1e-12"#
    );
    let start = |v: f64| Simulation::new(&mass_on_a_spring(W, [0.0, v], &integrator)).unwrap();
    let mut simulation = start(0.0);
    simulation.continue_from(start(A * W).state()).unwrap();
    let mut found = Recording::new(&simulation);
    simulation.run(&mut found).unwrap();
    let [times, places] = ["t", "bob.x"].map(|name| found.get(name).unwrap());
    for (t, x) in times.iter().zip(places) {
        assert!((x - A * (W * t).sin()).abs() < ACCURACY, "{t} s: {x} m");
    }
}

/// Times at which steps end.
#[derive(Default)]
struct StepEnds(Vec<f64>);

impl Observer for StepEnds {
    fn row(&mut self, _: &[f64]) -> std::io::Result<()> {
        Ok(())
    }

    fn step(&mut self, progress: &Progress) -> std::io::Result<Control> {
        self.0.push(progress.t);
        Ok(Control::Continue)
    }
}

/// A force of constant frequency w and of amplitude A turns about a point mass. A step of the trapezoidal rule has the error
/// h^3 w^2 A/12 of velocity, so steps of equal errors are proportional to A^(-1/3). With equal errors in equal times they would be
/// proportional to A^(-1/2). A varies a hundredfold, some times within the horizon.
#[test]
fn all_steps_have_the_same_error() {
    const RATE: f64 = 20.0;
    let amplitude = format!("10^sin({RATE}*t)");
    let text = format!(
        r#"
format = 1
title = "a turning force"
simulation = {{ duration = 1.2 }}
integrator = {{ method = "trapezoidal", accuracy = {{ position = 1e-7 }}, newton_tolerance = 1e-10 }}
output = {{ interval = 0.6, channels = ["mass.x"] }}
bodies.ground = {{ type = "ground" }}
bodies.mass = {{ type = "point_mass", mass = 1.0 }}
forces.push = {{ type = "force", point = "mass.center", x = "{amplitude}*cos(500*t)", y = "{amplitude}*sin(500*t)", frame = "ground" }}
initial.bodies.mass = {{ x = 0, y = 0 }}
"#
    );
    let scene = Scene::parse("turning", &text, &[]).unwrap_or_else(|e| panic!("{e}"));
    let mut times = StepEnds::default();
    Simulation::new(&scene).unwrap().run(&mut times).unwrap();
    // within 0.01 s of an extremum of A it differs from its extreme by less than 5 %
    let steps_at_phase = |phase: f64| {
        let is_near = |t: &&f64| {
            let turns = (RATE * **t - phase) / TAU;
            **t > 0.3 && (turns - turns.round()).abs() < 0.01 * RATE / TAU
        };
        times.0.iter().filter(is_near).count() as f64
    };
    let (strong, weak) = (steps_at_phase(0.5 * PI), steps_at_phase(-0.5 * PI));
    let power = (strong / weak).log10() / 2.0;
    // a third, and half of the way to a half
    assert!((0.25..0.42).contains(&power), "{strong}, {weak}: {power}");
}

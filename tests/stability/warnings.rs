//! What a report warns of, and what stops a run.

use crate::support::{load, run};
use ladder::{Rung, Worst};
use looselink::body::Strain;
use looselink::scene::Scene;
use looselink::simulate::{Integration, Recording, Report, RunError, Simulation};

/// The report of a run, however it ends.
fn end(scene: &str, overrides: &[&str]) -> (Result<(), RunError>, Report) {
    let mut simulation = Simulation::new(&load(scene, overrides)).unwrap_or_else(|e| panic!("{e}"));
    let ended = simulation.run(&mut ());
    (ended, simulation.report())
}

fn warned(report: &Report, words: &str) -> bool {
    report
        .warnings()
        .iter()
        .any(|warning| warning.contains(words))
}

#[test]
fn a_run_that_can_be_trusted_has_no_warnings() {
    for scene in ["pendulum.toml", "soft-pendulum.toml", "quick-return.toml"] {
        let (_, report) = run(scene, &["simulation.duration=0.5", "output.interval=0.01"]);
        assert_eq!(report.warnings(), Vec::<String>::new(), "{scene}");
    }
}

/// A warning puts a result in doubt: that a force was clamped, a step halved or a pose singular does not.
#[test]
fn warnings_are_told_from_notes() {
    let settings = ["simulation.duration=0.5", "output.interval=0.01"];
    let (_, sound) = run("pendulum.toml", &settings);
    let changed = |change: fn(&mut Report)| {
        let mut report = sound.clone();
        change(&mut report);
        report
    };
    let facts: [fn(&mut Report); 7] = [
        |report| report.clamps = 1,
        |report| report.stagnations = 1,
        |report| report.singular_poses = 1,
        |report| report.position_level_stages = 1,
        |report| report.unlocated_changes = 1,
        |report| report.fallbacks = 1,
        |report| report.rejected_steps = 1,
    ];
    for report in facts.map(changed) {
        assert_eq!(report.notes().len(), 1);
        assert_eq!(report.warnings(), Vec::<String>::new());
    }
    fn of_motion(report: &mut Report, change: impl Fn(&mut Integration)) {
        change(report.integration.as_mut().unwrap());
    }
    let errors: [fn(&mut Report); 5] = [
        |report| report.brief_contacts = 1,
        |report| of_motion(report, |i| i.lost[1] = 1.01e-2 * i.turnover),
        |report| of_motion(report, |i| i.lost[0] = -1.01e-2 * i.turnover),
        |report| of_motion(report, |i| i.estimated_error = 1.01e-2 * i.travel),
        |report| of_motion(report, |i| i.acceleration_change = 1.01),
    ];
    for report in errors.map(changed) {
        assert_eq!(report.error_warnings().len(), 1);
        assert_eq!(report.error_warnings(), report.warnings());
    }
    let below: [fn(&mut Report); 4] = [
        |report| of_motion(report, |i| i.lost[1] = 0.99e-2 * i.turnover),
        |report| of_motion(report, |i| i.lost[0] = -0.99e-2 * i.turnover),
        |report| of_motion(report, |i| i.estimated_error = 0.99e-2 * i.travel),
        |report| of_motion(report, |i| i.acceleration_change = 0.99),
    ];
    for report in below.map(changed) {
        assert_eq!(report.warnings(), Vec::<String>::new());
    }
}

/// A modulus in GPa where the scene expects Pa: the contact is too soft to stop the slider.
#[test]
fn a_journal_that_passes_through_its_bearing_is_reported() {
    let soft = [
        "materials.steel.youngs_modulus=207",
        "simulation.duration=0.02",
    ];
    let (_, report) = end("slider-crank/loose.toml", &soft);
    let overrun = report.overrun["slider_pin"];
    assert_eq!(overrun.bearing_radius, 0.01);
    assert!(overrun.penetration > overrun.bearing_radius);
    let words = "deep into a bearing of radius 0.01 m";
    assert!(warned(&report, words), "{:?}", report.warnings());
    let (_, sound) = end("slider-crank/loose.toml", &soft[1..]);
    assert!(sound.overrun.is_empty(), "{:?}", sound.warnings());
}

/// The truss rings at 1.8e4 rad/s; the trapezoidal rule with 1/50 of a turn a step makes that grow.
#[test]
fn an_unstable_method_is_stopped_by_name() {
    let (ended, report) = end("hard/stiff-truss.toml", &["integrator.method=trapezoidal"]);
    let Err(RunError::Unstable {
        name,
        t,
        gained,
        supplied,
    }) = &ended
    else {
        panic!("{ended:?}");
    };
    assert!(name.starts_with("bob.center"), "{name}");
    assert!(*t > 0.0 && *t < 100.0 && *gained > 10.0 * supplied);
    assert!(report.error.is_some_and(|e| e.contains("unstable")));
}

/// A gain is measured against a plain motion through the mechanism where nothing is supplied: the lighter the mechanism, the
/// less it takes to stop a run, in proportion.
#[test]
fn a_runaway_from_rest_is_stopped_at_an_energy_of_its_size() {
    // a spring that is stretched by rounding, and steps beyond the limit of stability, with twice the energy in each
    let gained = [1e-9, 1e-3, 1e3].map(|mass| {
        let text = format!(
            r#"
format = 1
title = "a runaway"
simulation = {{ duration = 1e5 }}
integrator = {{ method = "velocity_verlet", step = 2.03 }}
output = {{ interval = 2.03, channels = ["bob.x"] }}
bodies.ground = {{ type = "ground", points.left = [-1.0, 0.0] }}
bodies.bob = {{ type = "point_mass", mass = {mass:?} }}
forces.spring = {{ type = "spring_damper", from = "ground.left", to = "bob.center", stiffness = {mass:?}, damping = 0.0, rest_length = 2.0 }}
initial.bodies.bob = {{ x = {}, y = 0.0 }}
"#,
            1.0 + 1e-12
        );
        let scene = Scene::parse("runaway", &text, &[]).unwrap_or_else(|e| panic!("{e}"));
        let ended = Simulation::new(&scene).unwrap().run(&mut ());
        let Err(RunError::Unstable { gained, .. }) = ended else {
            panic!("{ended:?}");
        };
        gained / mass
    });
    // 10 times m/2 (size/duration)^2 with a size of about 1 m, and at most the growth of a step beyond
    for gained in gained {
        assert!((4e-10..4e-9).contains(&gained), "{gained:e} J/kg");
    }
}

/// The first steps of a motion that begins at rest have errors as large as the energy there is: no sign of instability.
#[test]
fn a_smooth_start_from_rest_is_not_stopped() {
    let methods = [
        "integrator.method=bathe",
        "integrator.method=trapezoidal",
        "integrator.method=backward_euler",
        "integrator={ method = \"generalized_alpha\", spectral_radius = 0.8, step = 1e-3, newton_tolerance = 1e-10 }",
        "integrator={ method = \"hht\", spectral_radius = 0.8, step = 1e-3, newton_tolerance = 1e-10 }",
    ];
    for method in methods {
        for step in [1e-4, 3e-4, 1e-3, 1e-2] {
            for rows in [1.0, 2.0, 3.0, 5.0, 10.0, 30.0] {
                let interval = step * rows;
                let settings = [
                    method.to_owned(),
                    format!("integrator.step={step:e}"),
                    format!("output.interval={interval:e}"),
                    format!("simulation.duration={:e}", 10.0 * interval),
                ];
                let settings = settings.each_ref().map(String::as_str);
                let (ended, _) = end("spin-up.toml", &settings);
                assert!(ended.is_ok(), "{settings:?}: {ended:?}");
            }
        }
    }
}

/// Steps that are halved on and on end in an error, not in a wait.
#[test]
fn a_run_that_comes_to_a_halt_says_where() {
    let (ended, report) = end(
        "hard/stick-slip.toml",
        &[
            "contacts.dry.friction={ law = \"ambrosio\", coefficient = 0.5, v0 = 0.0, v1 = 1e-7, slip = \"material\" }",
            "integrator.step=2e-4",
        ],
    );
    let Err(RunError::Stalled { t, cause, steps }) = &ended else {
        panic!("{ended:?}");
    };
    assert!(*t < 0.1 && *steps < 20_000, "{t} {steps}");
    assert!(
        cause.contains("journal.theta") && cause.contains("step failed"),
        "{cause}"
    );
    assert!(report.rejected_steps > 1000 && !report.rejected_by.is_empty());
}

/// An oscillation of n steps a period changes its acceleration from step to step by 2 sin(pi/n) of its size, rms.
#[test]
fn the_change_of_an_acceleration_is_that_of_its_vibration() {
    for n in [8.0, 20.0, 100.0] {
        let step = 2.0 * std::f64::consts::PI / n;
        let text = format!(
            r#"
format = 1
title = "an oscillation"
simulation = {{ duration = 200.0 }}
integrator = {{ method = "dormand_prince", step = {step:?} }}
output = {{ interval = {step:?}, channels = ["bob.x"] }}
bodies.ground = {{ type = "ground", points.left = [-1.0, 0.0] }}
bodies.bob = {{ type = "point_mass", mass = 2.0 }}
forces.spring = {{ type = "spring_damper", from = "ground.left", to = "bob.center", stiffness = 2.0, damping = 0.0, rest_length = 1.0 }}
initial.bodies.bob = {{ x = 0.1, y = 0.0 }}
"#
        );
        let scene = Scene::parse("oscillation", &text, &[]).unwrap_or_else(|e| panic!("{e}"));
        let mut simulation = Simulation::new(&scene).unwrap();
        simulation.run(&mut ()).unwrap();
        let measured = simulation.report().integration.unwrap().acceleration_change;
        let expected = 2.0 * (std::f64::consts::PI / n).sin();
        // the run ends within a period, of more than thirty
        assert!((measured / expected - 1.0).abs() < 0.03, "{n}: {measured}");
    }
}

/// The second mass follows the first; the trapezoidal rule leaves vibrations in its acceleration.
#[test]
fn unresolved_accelerations_are_told() {
    let start = "initial.bodies.node2={ x = 0.0, y = 0.0, vx = 1.2, vy = 0.0 }";
    let words = "do not resolve a vibration";
    let (_, rings) = run(
        "three-spring.toml",
        &[start, "integrator.method=trapezoidal"],
    );
    assert!(warned(&rings, words), "{:?}", rings.warnings());
    let (_, damped) = run("three-spring.toml", &[start]);
    assert!(!warned(&damped, words), "{:?}", damped.warnings());
}

#[test]
fn lost_energy_is_told() {
    let (_, report) = run(
        "hard/stiff-truss.toml",
        &["integrator.method=backward_euler"],
    );
    assert!(
        warned(&report, "the integrator lost"),
        "{:?}",
        report.warnings()
    );
}

/// E A is 1e4 N: a hundredth of it strains the rod by 1 % and, applied at once, by twice that; a fifth goes beyond the theory.
#[test]
fn a_link_beyond_the_theory_is_told() {
    for (load, reported) in [(-1e2, false), (1e2, false), (-2e3, true), (2e3, true)] {
        let text = format!(
            r#"
format = 1
title = "a soft rod is pressed"
simulation = {{ duration = 0.02 }}
integrator = {{ method = "bathe", step = 1e-5, newton_tolerance = 1e-9 }}
output = {{ interval = 1e-3, channels = ["*"] }}
materials.soft = {{ density = 1000.0, youngs_modulus = 1e6 }}
sections.bar = {{ width = 0.1, height = 0.1 }}
bodies.ground = {{ type = "ground", points.O = [0.0, 0.0] }}
bodies.rod = {{ type = "link", model = "flexible", elements = 1, length = 1.0, section = "bar", material = "soft" }}
joints.O = {{ type = "revolute", bearing = "ground.O", journal = "rod.start", model = "ideal" }}
forces.press = {{ type = "force", point = "rod.end", x = {load:e}, y = 0.0, frame = "ground" }}
initial.bodies.rod = {{ x = 0.5, y = 0.0, theta = 0.0 }}
"#
        );
        let scene = Scene::parse("rod", &text, &[]).unwrap();
        let mut simulation = Simulation::new(&scene).unwrap();
        simulation.run(&mut ()).unwrap();
        let report = simulation.report();
        assert_eq!(
            warned(&report, "rod has a strain of"),
            reported,
            "{:?}",
            report.strain
        );
    }
}

#[test]
fn chatter_is_named_and_brief_contacts_are_counted() {
    let (recording, report) = run("hard/chatter.toml", &["integrator.step=1e-4"]);
    assert!(
        warned(&report, "pin chatters from"),
        "{:?}",
        report.warnings()
    );
    assert!(warned(&report, "contacts lasted fewer than four steps"));
    let chatter = &report.chatter[0];
    let within = |t: f64| t >= chatter.from && t <= chatter.to;
    let onsets = recording.onsets.iter().filter(|o| within(o.t)).count() as u64;
    assert_eq!(chatter.onsets, onsets);
    let (_, resolved) = run("hard/chatter.toml", &[]);
    assert!(resolved.chatter.is_empty() && resolved.brief_contacts == 0);
}

/// The estimated error of a run against the true one: of the size of it, rather too large than too small.
#[test]
fn errors_are_estimated() {
    let cases = [
        (
            "pendulum.toml",
            ["points.rod.bob.x", "points.rod.bob.y"],
            "2.0",
            2e-2,
            1e-3,
        ),
        (
            "soft-pendulum.toml",
            ["points.rod.end.x", "points.rod.end.y"],
            "0.5",
            2.5e-3,
            1e-4,
        ),
        (
            "n-four-bar.toml",
            ["points.crank0.end.x", "points.crank0.end.y"],
            "1.0",
            2e-2,
            2e-3,
        ),
    ];
    let methods = [
        "integrator.method=bathe",
        "integrator.method=trapezoidal",
        "integrator={ method = \"generalized_alpha\", spectral_radius = 0.8, newton_tolerance = 1e-10 }",
        "integrator={ method = \"hht\", spectral_radius = 0.8, newton_tolerance = 1e-10 }",
        "integrator.method=backward_euler",
    ];
    let worst = Worst::new();
    for (scene, channels, duration, coarse, fine) in cases {
        let made = |method: &str, step: f64| -> (Recording, Integration) {
            let duration = format!("simulation.duration={duration}");
            let step = format!("integrator.step={step}");
            let settings = [method, &duration, &step, "output.interval=0.1"];
            let mut simulation = Simulation::new(&load(scene, &settings)).unwrap();
            let mut recording = Recording::new(&simulation);
            simulation
                .run(&mut recording)
                .unwrap_or_else(|e| panic!("{scene} {method}: {e}"));
            (recording, simulation.report().integration.unwrap())
        };
        let (exact, _) = made(methods[1], 0.1 * fine);
        for method in methods {
            for step in [coarse, fine] {
                let (recording, integration) = made(method, step);
                let mut error = 0.0_f64;
                for name in channels {
                    let pairs = exact
                        .get(name)
                        .unwrap()
                        .iter()
                        .zip(recording.get(name).unwrap());
                    error = pairs.fold(error, |m, (a, b)| (a - b).abs().max(m));
                }
                let ratio = integration.estimated_error / error;
                worst.at(format!("{scene} with {method} and {step} s"));
                worst.see(ratio.max(1.0 / ratio));
            }
        }
    }
    Rung::HardCases
        .asks("Estimated error of runs with equal steps, five methods, three scenes: larger of its ratios to the true error and back")
        .within(&worst, 5.0, "the estimate is a sum of local errors, which the motion may amplify or reduce");
}

/// docs/scene.md gives the thresholds: a run just below them has no warning or note, one just above them has one. What is counted is told
/// from one on.
#[test]
fn warnings_begin_at_their_thresholds() {
    let (_, sound) = run(
        "pendulum.toml",
        &["simulation.duration=0.5", "output.interval=0.01"],
    );
    fn strain(report: &mut Report, axial: f64, bending: f64) {
        let strain = Strain { axial, bending };
        report.strain.insert("link".to_owned(), strain);
    }
    type Change = dyn Fn(&mut Report, f64);
    fn of(report: &mut Report) -> &mut Integration {
        report.integration.as_mut().unwrap()
    }
    let doubts: [(&str, &Change); 8] = [
        ("the energy of the motion", &|r, part| {
            of(r).lost[1] = part * 0.01 * of(r).turnover;
        }),
        ("the energy of the motion", &|r, part| {
            of(r).lost[0] = -part * 0.01 * of(r).turnover;
        }),
        ("the dissipated energy", &|r, part| {
            let ledger = r.ledger.as_mut().unwrap();
            ledger.damping_dissipated = 1e-4;
            ledger.numerical = part * 0.05 * ledger.dissipated();
        }),
        ("the largest range of motion", &|r, part| {
            of(r).estimated_error = part * 0.01 * of(r).travel;
        }),
        ("do not resolve a vibration", &|r, part| {
            of(r).acceleration_change = part;
        }),
        ("link has a strain of", &|r, part| {
            strain(r, -0.2 * part, 0.0);
        }),
        ("link has a curvature", &|r, part| {
            strain(r, 0.0, 0.2 * part);
        }),
        ("fewer than four steps", &|r, part| {
            r.brief_contacts = part as u64;
        }),
    ];
    let facts: [(&str, &Change); 9] = [
        (
            "the most deformed link, link, has a strain of",
            &|r, part| {
                strain(r, 0.01 * part, 0.0);
            },
        ),
        (
            "the most deformed link, link, has a curvature",
            &|r, part| {
                strain(r, 0.0, 0.01 * part);
            },
        ),
        ("steps that failed and were halved", &|r, part| {
            r.rejected_steps = part as u64;
        }),
        ("a contact force clamped at zero", &|r, part| {
            r.clamps = part as u64;
        }),
        ("rounding kept Newton's method", &|r, part| {
            r.stagnations = part as u64;
        }),
        ("solved on the position level", &|r, part| {
            r.position_level_stages = part as u64;
        }),
        ("nearly singular pose", &|r, part| {
            r.singular_poses = part as u64;
        }),
        ("needed row exchanges", &|r, part| {
            r.fallbacks = part as u64;
        }),
        ("not located to within onset_tolerance", &|r, part| {
            r.unlocated_changes = part as u64;
        }),
    ];
    type Told = fn(&Report) -> Vec<String>;
    let kinds: [(&[(&str, &Change)], Told); 2] =
        [(&doubts, Report::warnings), (&facts, Report::notes)];
    for (cases, told) in kinds {
        for (words, change) in cases {
            let [below, above] = [0.99, 1.01].map(|part| {
                let mut report = sound.clone();
                change(&mut report, part);
                told(&report)
            });
            assert!(below.is_empty(), "{words}: {below:?}");
            assert!(above.len() == 1 && above[0].contains(words), "{above:?}");
        }
    }
}

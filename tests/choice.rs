//! `method = "auto"`: which scheme it chooses, what it costs, and that the run is that of the scheme.

use crate::support::load;
use looselink::scene::Scene;
use looselink::simulate::{Recording, Report, Simulation};
use looselink::stepper::CANDIDATES;

/// A scene, changes to it, and the accuracy.
type Case = (&'static str, &'static [&'static str], &'static str);

const MESH: &[&str] = &[
    "bodies.link1.elements=16",
    "bodies.link2.elements=16",
    "bodies.link3.elements=16",
];
const VIBRATION: Case = ("3rrr/case2.toml", &[], "position=1e-6,horizon=0.02");
const FINE_MESH: Case = ("3rrr/case2.toml", MESH, "position=1e-9,horizon=0.02");
const IMPACTS: Case = ("3rrr/case4.toml", &[], "position=1e-8,horizon=0.02");
const RIGID_IMPACTS: Case = ("3rrr/case3.toml", &[], "position=1e-9,horizon=0.02");

/// The first contact closes after 4 ms, a third of the horizon.
const LATE_IMPACTS: Case = ("3rrr/case3.toml", &[], "position=1e-9,horizon=0.012");

/// The first 20 ms of a case.
fn scene((name, set, accuracy): Case, method: &str) -> Scene {
    let integrator = format!(
        "integrator={{method={method:?},newton_tolerance=1e-11,onset_tolerance=1e-13,accuracy={{{accuracy}}}}}"
    );
    let own = [
        integrator.as_str(),
        "assumptions={}",
        "simulation.duration=0.02",
        "output.interval=1e-4",
    ];
    load(name, &[set, &own].concat())
}

fn run(scene: &Scene) -> (Vec<u64>, Report) {
    let mut simulation = Simulation::new(scene).unwrap();
    let mut recording = Recording::new(&simulation);
    simulation.run(&mut recording).unwrap();
    let names = simulation.channels().iter().map(|c| c.name.clone());
    let columns = names.map(|name| recording.get(&name).unwrap().to_vec());
    let bits = columns.flatten().map(f64::to_bits).collect();
    (bits, simulation.report())
}

/// A fifth more than the least work of any candidate tells apart what differs by more than the estimate of operations.
#[test]
fn the_choice_takes_little_more_work_than_the_best() {
    for case in [VIBRATION, FINE_MESH, IMPACTS, RIGID_IMPACTS, LATE_IMPACTS] {
        let candidates = CANDIDATES.map(|scheme| run(&scene(case, scheme.name)).1.operations);
        let least = candidates.into_iter().min().unwrap();
        let (_, report) = run(&scene(case, "auto"));
        let choice = report.choice.unwrap();
        assert!(
            report.operations as f64 <= 1.2 * least as f64,
            "{case:?}: {} takes {} of {candidates:?}",
            choice.method,
            report.operations
        );
        let trials: u64 = choice.trial_runs.iter().map(|run| run.operations).sum();
        assert!(
            (trials as f64) < least as f64,
            "{case:?}: {trials} of {least}"
        );
    }
}

#[test]
fn a_fine_mesh_is_left_to_an_implicit_scheme_and_impacts_to_an_explicit_one() {
    let chosen = |case| run(&scene(case, "auto")).1.choice.unwrap().method;
    assert_eq!(chosen(FINE_MESH), "esdirk5");
    assert_eq!(chosen(RIGID_IMPACTS), "dormand_prince");
}

#[test]
fn the_run_is_that_of_the_scheme_chosen() {
    for case in [VIBRATION, IMPACTS] {
        let (rows, report) = run(&scene(case, "auto"));
        let choice = report.choice.clone().unwrap();
        assert_eq!(choice.method, choice.trial_runs[0].method);
        assert_eq!(choice.trial_runs.len(), CANDIDATES.len());
        let (named, of_named) = run(&scene(case, choice.method));
        assert!(rows == named, "{case:?}");
        let without = Report {
            choice: None,
            ..report
        };
        assert_eq!(without, of_named, "{case:?}");
    }
}

/// The error of a load with some changes.
fn refused(scene: &str, overrides: &[&str]) -> String {
    let overrides: Vec<String> = overrides.iter().map(|&s| s.to_owned()).collect();
    let error = Scene::load(&crate::support::path(scene), &overrides).unwrap_err();
    let help = miette::Diagnostic::help(&error).map(|help| help.to_string());
    format!("{error}; {}", help.unwrap_or_default())
}

#[test]
fn a_step_leaves_nothing_to_choose() {
    let auto = "integrator.method=auto";
    let said = refused("3rrr/case2.toml", &[auto]);
    assert!(
        said.contains("chooses the scheme for an accuracy"),
        "{said}"
    );
    assert!(said.contains("`--accuracy position=1e-8`"), "{said}");
    let said = refused("3rrr/case3.toml", &[auto]);
    assert!(
        said.contains("`--accuracy position=1e-8,horizon=0.01`"),
        "{said}"
    );
    let bare = "integrator={method=\"auto\",newton_tolerance=1e-11,onset_tolerance=1e-13}";
    let said = refused("3rrr/case3.toml", &["assumptions={}", bare]);
    assert!(
        said.contains("missing key `accuracy` in integrator"),
        "{said}"
    );
}

/// No trial run sees an impact here, or a 64th of the run, in a time that anybody would wait.
#[test]
fn an_accuracy_out_of_reach_is_refused() {
    let mut simulation = Simulation::new(&scene(
        ("3rrr/case3.toml", &[], "position=1e-20,horizon=0.01"),
        "auto",
    ))
    .unwrap();
    let mut recording = Recording::new(&simulation);
    let error = simulation.run(&mut recording).unwrap_err().to_string();
    assert!(error.contains("1e-20"), "{error}");
    assert!(simulation.report().choice.is_some());
}

//! Studies of precision against time: those of the project work, faults are reported, failures are part of the outcome.

use std::path::{Path, PathBuf};
use studies::precision::{
    Compared, Effort, MotionReference, StatisticsReference, Study, StudyOutcome, StudyPace, Survey,
};

const SMOKE: Effort = Effort {
    repeats: 1,
    smoke: true,
};

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../studies")
}

fn outcome(study: &Study) -> StudyOutcome {
    StudyOutcome::run(study, SMOKE, &mut |_| {}).unwrap_or_else(|e| panic!("{}: {e}", study.title))
}

/// Every study of the project, the coarsest point of every curve: none fails, the reference is far finer than what is
/// compared with it, unless that is right to rounding, 1e-16 m in each of ten thousand steps; what an accuracy asks for is
/// achieved within a factor of ten.
#[test]
fn studies_of_the_project_work() {
    let mut count = 0;
    for entry in std::fs::read_dir(folder()).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            continue;
        }
        let study = Study::load(&path).unwrap_or_else(|e| panic!("{e}"));
        if study.statistics.is_some() {
            continue;
        }
        let outcome = outcome(&study);
        assert_eq!(outcome.runs.len(), study.curves.len());
        for run in &outcome.runs {
            let name = format!("{}: {} with {}", study.title, run.curve, run.pace);
            let measured = run
                .result
                .as_ref()
                .unwrap_or_else(|e| panic!("{name}: {e}"));
            let errors = measured.errors;
            let floor = outcome.reference.floor.position;
            let is_rounding = errors.position < 1e-12;
            assert!(errors.position > 100.0 * floor || is_rounding, "{name}");
            // every row ends a step
            let rows = (study.duration / study.interval).round() as u64;
            assert!(
                errors.energy.is_finite() && measured.work.steps >= rows,
                "{name}"
            );
            if let StudyPace::Accuracy { position, .. } = run.pace {
                assert!(errors.position < 10.0 * position, "{name}: {errors:?}");
            }
        }
        assert!(outcome.timings.iter().flatten().all(|t| t.least > 0.0));
        assert_eq!(
            MotionReference::figure(&outcome, &study).rows.len(),
            3,
            "{}",
            study.title
        );
        count += 1;
    }
    assert_eq!(count, 11);
}

/// Studies of statistics, a fiftieth of their time: every first point gives finite statistics, near those of the reference.
#[test]
fn studies_of_statistics_work() {
    for name in ["case3-statistics.toml", "case4-statistics.toml"] {
        let study = Study::load(&folder().join(name)).unwrap_or_else(|e| panic!("{e}"));
        let survey = Survey::run(&study, SMOKE, &mut |_| {}).unwrap_or_else(|e| panic!("{e}"));
        assert_eq!(survey.runs.len(), study.curves.len());
        let [_, exact] = &survey.reference.runs;
        let mut sound = 0;
        for run in &survey.runs {
            let (measures, work) = run.result.as_ref().unwrap_or_else(|e| panic!("{e}"));
            // 20 ms of impacts, each run a sample of its own; a coarse run may gain more energy than the contacts dissipate
            let balanced = measures.loss().abs() < 1.0;
            assert!(
                !balanced || measures.deviation(exact) < 0.5,
                "{name}: {measures:?}"
            );
            sound += usize::from(balanced);
            let envelope = measures.envelope.iter().map(|x| x * x).sum::<f64>().sqrt();
            assert!(measures.rms > 0.0 && measures.rms <= envelope, "{name}");
            assert_eq!(measures.loss(), measures.numerical / measures.dissipated);
            assert!(measures.loss().is_finite() && work.steps > 100);
        }
        assert!(2 * sound > survey.runs.len(), "{name}: {sound}");
        assert!(
            StatisticsReference::table(&survey, &study).lines().count() > study.curves.len() + 3
        );
        assert_eq!(StatisticsReference::figure(&survey, &study).rows.len(), 2);
    }
    let wrong = "[statistics]\nfrom = 1.0\ncontact = [\"B1.contact\"]\n[[curves]]\nname = \"x\"\nsteps = [1e-3]\n";
    let error = study(wrong).unwrap_err();
    assert!(
        error.contains("`statistics` needs a `from` within the duration"),
        "{error}"
    );
}

fn study(curves: &str) -> Result<Study, String> {
    let text = format!(
        r#"
title = "a pendulum, briefly"
scene = "pendulum.toml"
duration = 0.5
interval = 0.02
position = ["points.rod.bob.x"]
[reference]
set = ["integrator.method=dormand_prince"]
steps = [2e-3, 1e-3]
{curves}
"#
    );
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("study.toml");
    std::fs::write(&path, text).unwrap();
    std::fs::copy(
        folder_of_scenes().join("pendulum.toml"),
        folder.path().join("pendulum.toml"),
    )
    .unwrap();
    let mut study = Study::load(&path).map_err(|e| e.to_string())?;
    study.scene = folder_of_scenes().join("pendulum.toml");
    Ok(study)
}

fn folder_of_scenes() -> PathBuf {
    folder().join("../scenes")
}

/// A method that does not take the scene, and an accuracy out of reach, are points of the outcome with their reasons.
#[test]
fn failures_are_part_of_the_outcome() {
    let study = study(
        r#"
[[curves]]
name = "Verlet"
set = ["integrator.method=velocity_verlet", "bodies.rod.coordinates='center'"]
steps = [1e-3]
[[curves]]
name = "too much"
accuracies = [1e-20]
[[curves]]
name = "Bathe"
steps = [1e-3]
"#,
    )
    .unwrap();
    let first = outcome(&study);
    let failed = |i: usize| first.runs[i].result.as_ref().unwrap_err().as_str();
    assert!(failed(0).starts_with("method \"velocity_verlet\" cannot enforce constraints"));
    assert!(failed(1).starts_with("the accuracy of 1e-20 m over 0.5 s cannot be reached at t = "));
    assert!(first.runs[2].result.is_ok());
    assert_eq!(first.timings.iter().flatten().count(), 1);
    assert!(
        MotionReference::table(&first, &study)
            .contains("| Verlet | step 1\u{a0}ms | failed: method")
    );
    let caption = MotionReference::figure(&first, &study).caption;
    assert!(
        caption.contains("Failed: Verlet at step 1\u{a0}ms; too much at accuracy"),
        "{caption}"
    );
    // all but times is the same when it is made again
    assert_eq!(outcome(&study).runs, first.runs);
}

#[test]
fn faults_of_a_study_are_told() {
    for (curves, message) in [
        ("", "missing field `curves`"),
        (
            "[[curves]]\nname = \"x\"\n",
            "`curves.0` (x) needs either `steps` or `accuracies`",
        ),
        (
            "[[curves]]\nname = \"x\"\nsteps = [1e-3]\naccuracies = [1e-3]\n",
            "`curves.0` (x) needs either `steps` or `accuracies`",
        ),
        (
            "[[curves]]\nname = \"x\"\nstep = [1e-3]\n",
            "unknown field `step`",
        ),
    ] {
        let error = study(curves).unwrap_err();
        assert!(error.contains(message), "{error}");
        assert!(error.contains("study.toml"), "{error}");
    }
    let mut wrong = study("[[curves]]\nname = \"x\"\nsteps = [1e-3]\n").unwrap();
    wrong.position = vec!["bob.x".into()];
    let error = StudyOutcome::run(&wrong, SMOKE, &mut |_| {});
    let error = error.unwrap_err().to_string();
    assert!(
        error.starts_with("no channel of this scene is named \"bob.x\""),
        "{error}"
    );
}

#[test]
fn an_endless_study_is_refused() {
    let message = Study::load("/dev/zero".as_ref()).unwrap_err().to_string();
    assert_eq!(message, "cannot read `/dev/zero`: it is larger than 8 MiB");
}

//! The boundary: what crosses it, and errors that come back typed and with their text.

use looselink::simulate::Simulation;
use std::collections::BTreeSet;
use verify::compare::scenes;
use verify::crossing::{INPUTS, TOLERANCES, fields, functions};
use verify::reference::ReferenceScene;
use verify::trajectory::{ComparisonPlan, tolerances};

/// Codes of errors, as in the header: the scene makes no sense, the path is out of reach, IDA failed.
const BAD_INPUT: i32 = 1;
const UNREACHABLE: i32 = 2;
const IDA: i32 = 3;

/// The scene, overrides, tolerances and states at which equations are compared: no number that Looselink has computed
/// besides these states reaches the reference.
#[test]
fn interface_takes_only_the_listed_inputs() {
    let functions = functions();
    let declared = include_str!("../src/ffi.rs").matches("pub fn ls_").count();
    assert!(functions.len() >= declared, "{} functions", functions.len());
    let mut seen = BTreeSet::new();
    for function in &functions {
        for (kind, name) in &function.inputs {
            let known = INPUTS.iter().any(|(k, n, _)| k == kind && n == name);
            assert!(known, "{} takes {kind} {name}", function.name);
            seen.insert(name.as_str());
        }
    }
    assert_eq!(seen, INPUTS.iter().map(|(_, name, _)| *name).collect());
    assert_eq!(fields("ls_tolerances"), TOLERANCES);
}

#[test]
fn reference_has_the_expected_coordinates_and_rows() {
    for (scene, unknowns, constraints) in [
        ("3rrr/case1", 27, 3 + 3 + 6 + 6 + 6 + 3),
        ("3rrr/case2", 39, 3 + 6 + 6 + 6 + 3),
        ("3rrr/case3", 27, 3 + 3 + 6 + 3),
        ("3rrr/case4", 39, 3 + 6 + 3),
    ] {
        let scene = ComparisonPlan::new(scene, 0.01, 1e-3).reference().unwrap();
        let sizes = [scene.coordinates.len(), scene.rows.len()];
        assert_eq!(sizes, [unknowns, constraints], "{:?}", scene.rows);
    }
}

/// A scene that makes no sense is refused with the place in the file.
#[test]
fn bad_scenes_are_refused_with_their_place() {
    let text = std::fs::read_to_string(ComparisonPlan::new("3rrr/case4", 1.0, 1.0).path).unwrap();
    for (damage, place) in [
        ("joints.B1.journal=\"link1.middle\"", "joints.B1"),
        ("materials.steel.density=-1.0", "materials.steel.density"),
        ("bodies.link1.elements=0", "bodies.link1.elements"),
        ("contacts.pin.clearance=nan", "contacts.pin.clearance"),
        ("drives.input.path.radius=inf", "drives.input.path.radius"),
        ("bodies.link1.lenght=0.1", "bodies.link1.lenght"),
    ] {
        match ReferenceScene::read(&text, &[damage.to_owned()]) {
            Err(e) if e.code == BAD_INPUT => assert!(e.field.starts_with(place), "{e}"),
            other => panic!("{damage}: {other:?}"),
        }
    }
    let damaged = text.replace("\"lankarani_nikravesh\"", "\"lankarani\"");
    let line = damaged.lines().position(|l| l.contains("lankarani"));
    match ReferenceScene::read(&damaged, &[]) {
        Err(e) if e.code == BAD_INPUT => {
            assert_eq!(usize::try_from(e.line), Ok(line.unwrap() + 1));
        }
        other => panic!("{other:?}"),
    }
}

#[test]
fn a_path_out_of_reach_is_refused_with_its_time() {
    let path = "drives.input.path={type=\"line\",from=[0.1,0.0,0.0],to=[0.6,0.0,0.0],duration=1.0}";
    let plan = ComparisonPlan::new("3rrr/case1", 1.0, 1e-2).with("", &[path]);
    let scene = plan.reference().unwrap();
    let mut run = scene.run(&tolerances(1e-6)).unwrap();
    let end = (0..100).find_map(|k| run.advance(0.01 * f64::from(k)).err());
    match end {
        Some(e) if e.code == UNREACHABLE => {
            assert!(e.t > 0.1 && e.t < 1.0 && e.message.contains("B1"), "{e}");
        }
        other => panic!("{other:?}"),
    }
}

/// What IDA says arrives word by word, with its flag and the time, and the run is dead afterwards.
#[test]
fn a_failure_of_ida_is_an_error_with_its_message() {
    let scene = ComparisonPlan::new("3rrr/case2", 0.1, 1e-3)
        .reference()
        .unwrap();
    let mut run = scene.run(&tolerances(1e-30)).unwrap();
    let first = run.advance(0.01).unwrap_err();
    // IDA_TOO_MUCH_ACC
    assert_eq!((first.code, first.flag), (IDA, -2), "{first}");
    assert!(first.message.contains("too much accuracy"), "{first}");
    assert_eq!(run.advance(0.02).unwrap_err(), first);
}

/// So does a budget of steps that is used up.
#[test]
fn too_many_steps_are_an_error() {
    let scene = ComparisonPlan::new("3rrr/case2", 0.1, 1e-3)
        .reference()
        .unwrap();
    let mut few = tolerances(1e-10);
    few.max_steps = 10;
    match scene.run(&few).unwrap().advance(0.01) {
        Err(e) if e.code == IDA => {
            assert!(e.message.contains("max_steps"), "{e}");
            assert!(e.t > 0.0 && e.t < 0.01, "{e}");
        }
        other => panic!("{other:?}"),
    }
}

#[test]
fn the_same_run_gives_the_same_bytes() {
    let bits = || {
        let run = ComparisonPlan::new("3rrr/case4", 0.006, 1e-3).cpp(&tolerances(1e-8));
        let columns = run.unwrap().columns.into_values().flatten();
        columns.map(f64::to_bits).collect::<Vec<_>>()
    };
    assert_eq!(bits(), bits());
}

/// Both sides derive the same channels from every scene.
#[test]
fn every_channel_has_a_counterpart() {
    for plan in scenes::all().unwrap() {
        let simulation = Simulation::new(&plan.scene(None).unwrap()).unwrap();
        let rust: BTreeSet<_> = simulation
            .channels()
            .iter()
            .map(|c| c.name.clone())
            .collect();
        let cpp = plan.reference().unwrap().channels.iter().cloned().collect();
        assert_eq!(rust, cpp, "{}", plan.name());
    }
}

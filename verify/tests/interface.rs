//! The boundary: what crosses it, and errors that come back typed and with their text.

use looselink::simulate::Simulation;
use std::collections::BTreeSet;
use verify::compare::scenes;
use verify::reference::{LIMIT, ReferenceError, ReferenceScene};
use verify::trajectory::{ComparisonPlan, tolerances};

/// Codes of errors, as in the header: the scene makes no sense, the path is out of reach, IDA failed.
const BAD_INPUT: i32 = 1;
const UNREACHABLE: i32 = 2;
const IDA: i32 = 3;

/// What may go in: the scene with overrides, tolerances, and states at which equations are compared. No number that Looselink has
/// computed besides these states reaches the reference.
const INPUTS: [&str; 14] = [
    "const char *const *overrides",
    "const char *text",
    "const double *q",
    "const double *states",
    "const double *v",
    "const double *z",
    "const ls_run *run",
    "const ls_scene *scene",
    "const ls_tolerances *tolerances",
    "double t",
    "int32_t list",
    "size_t count",
    "size_t index",
    "void",
];
const TOLERANCES: &str = "typedef struct { double relative; double position; double velocity; double max_step; double newton; \
                          int32_t max_order; int32_t linear_solver; int64_t max_steps; } ls_tolerances;";

#[test]
fn interface_takes_only_the_listed_inputs() {
    let header = include_str!("../../reference-cpp/include/reference.h");
    let parts = header.split("/*");
    let code = parts.map(|part| part.split_once("*/").map_or(part, |(_, code)| code));
    let words: Vec<&str> = code.flat_map(str::split_whitespace).collect();
    let text = words.join(" ");
    assert!(text.contains(TOLERANCES), "{text}");
    let declarations = text.split(';');
    let functions = declarations.filter_map(|d| d.strip_suffix(')')?.split_once('('));
    let arguments = functions.flat_map(|(_, arguments)| arguments.split(','));
    // the library writes to what is not constant
    let is_input = |argument: &&str| argument.starts_with("const") || !argument.contains('*');
    let inputs: BTreeSet<&str> = arguments.map(str::trim).filter(is_input).collect();
    assert_eq!(inputs, BTreeSet::from(INPUTS));
}

/// A failure with this code.
fn failure<T>(result: Result<T, ReferenceError>, code: i32) -> ReferenceError {
    let error = result.err().expect("it cannot go on");
    assert_eq!(error.code, code, "{error}");
    error
}

/// A scene that makes no sense is refused with the place in the file.
#[test]
fn bad_scenes_are_refused_with_their_place() {
    let path = ComparisonPlan::new("3rrr/case4", 1.0, 1.0).path();
    let text = std::fs::read_to_string(path).unwrap();
    for (damage, place) in [
        ("joints.B1.journal=\"link1.middle\"", "joints.B1"),
        ("materials.steel.density=-1.0", "materials.steel.density"),
        ("bodies.link1.elements=0", "bodies.link1.elements"),
        ("contacts.pin.clearance=nan", "contacts.pin.clearance"),
        ("drives.input.path.radius=inf", "drives.input.path.radius"),
        ("bodies.link1.lenght=0.1", "bodies.link1.lenght"),
    ] {
        let read = ReferenceScene::read(&text, &[damage.to_owned()]);
        let error = failure(read, BAD_INPUT);
        assert!(error.field.starts_with(place), "{error}");
    }
    let damaged = text.replace("\"lankarani_nikravesh\"", "\"lankarani\"");
    let line = damaged.lines().position(|l| l.contains("lankarani"));
    let error = failure(ReferenceScene::read(&damaged, &[]), BAD_INPUT);
    assert_eq!(usize::try_from(error.line), Ok(line.unwrap() + 1));
}

#[test]
fn a_path_out_of_reach_is_refused_with_its_time() {
    let path = "drives.input.path={type=\"line\",from=[0.1,0.0,0.0],to=[0.6,0.0,0.0],duration=1.0}";
    let plan = ComparisonPlan::new("3rrr/case1", 1.0, 1e-2).with(&[path.to_owned()]);
    let scene = plan.reference().unwrap();
    let mut run = scene.run(&tolerances(1e-6)).unwrap();
    let mut rows = (0..100).map(|k| run.advance(0.01 * f64::from(k)));
    let e = failure(rows.find(Result::is_err).unwrap(), UNREACHABLE);
    assert!(e.t > 0.1 && e.t < 1.0 && e.message.contains("B1"), "{e}");
}

/// So is a load that cannot grow.
#[test]
fn a_limit_point_ends_a_static_analysis_with_its_load() {
    let stop = "simulation.at_limit='stop'".to_owned();
    let plan = ComparisonPlan::new("../verify/scenes/frame", 1.0, 0.1).with(&[stop]);
    let scene = plan.reference().unwrap();
    let mut run = scene.run(&tolerances(1e-6)).unwrap();
    let mut rows = (0..=10).map(|k| run.advance(0.1 * f64::from(k)));
    let e = failure(rows.find(Result::is_err).unwrap(), LIMIT);
    assert!(e.t > 0.7 && e.t < 0.8 && e.message.contains("rod"), "{e}");
}

/// What IDA says arrives word by word, with its flag and the time, and the run is dead afterwards.
#[test]
fn a_failure_of_ida_is_an_error_with_its_message() {
    let plan = ComparisonPlan::new("3rrr/case2", 0.1, 1e-3);
    let scene = plan.reference().unwrap();
    let mut run = scene.run(&tolerances(1e-30)).unwrap();
    let first = failure(run.advance(0.01), IDA);
    // IDA_TOO_MUCH_ACC
    assert_eq!(first.flag, -2, "{first}");
    assert!(first.message.contains("too much accuracy"), "{first}");
    assert_eq!(run.advance(0.02).unwrap_err(), first);
}

/// So does a budget of steps that is used up.
#[test]
fn too_many_steps_are_an_error() {
    let plan = ComparisonPlan::new("3rrr/case2", 0.1, 1e-3);
    let scene = plan.reference().unwrap();
    let mut few = tolerances(1e-10);
    few.max_steps = 10;
    let e = failure(scene.run(&few).unwrap().advance(0.01), IDA);
    assert!(e.message.contains("max_steps"), "{e}");
    assert!(e.t > 0.0 && e.t < 0.01, "{e}");
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
        let rust: BTreeSet<&String> = simulation.channels().iter().map(|c| &c.name).collect();
        let reference = plan.reference().unwrap();
        let cpp = reference.channels.iter().collect();
        assert_eq!(rust, cpp, "{}", plan.name());
    }
}

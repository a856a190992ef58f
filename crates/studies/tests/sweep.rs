//! Sweeps: points, measures, rows, tables.

use folder::{line_of, value_of};
use std::collections::BTreeMap;
use std::fs;
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;
use studies::sweep::{
    FILES, FieldValue, Merged, RunStatus, Shard, Store, Sweep, SweepError, SweepRow, SweepSource,
    SweepTarget, Task, execute, merge,
};

/// A body that moves at 2 m/s along x for a second, and a spring that does nothing at first.
const GLIDER: &str = r#"
format = 1
title = "a body glides"
simulation = { duration = 1.0 }
integrator = { method = "velocity_verlet", step = 0.01, newton_tolerance = 1e-11, onset_tolerance = 1e-13 }
output = { interval = 0.01, channels = ["body.x"] }
bodies.ground = { type = "ground", points.origin = [0, 0] }
bodies.body = { type = "point_mass", mass = 0.5 }
initial.bodies.body = { x = 0, y = 0, vx = 2.0, vy = 0 }
"#;

fn source(study: &str, scene: &str) -> SweepSource {
    SweepSource {
        path: PathBuf::from("study.toml"),
        study: study.to_owned(),
        scene: scene.to_owned(),
        target: None,
    }
}

fn sweep(study: &str, scene: &str) -> Sweep {
    Sweep::new(source(study, scene)).unwrap()
}

/// The first fault of a study.
#[track_caller]
fn refused(study: &str) -> String {
    match Sweep::new(source(study, GLIDER)) {
        Err(error) => error.to_string(),
        Ok(_) => panic!("accepted"),
    }
}

fn threads(n: usize) -> NonZeroUsize {
    NonZeroUsize::new(n).unwrap()
}

/// Makes the runs of a shard on two threads.
fn executed(sweep: &Sweep, store: &mut Store, shard: Shard) -> Result<(), SweepError> {
    let stop = AtomicBool::new(false);
    execute(sweep, store, shard, threads(2), &stop, &mut |_| {})
}

/// Makes all runs of a sweep in a folder.
fn made(sweep: &Sweep, folder: &Path) -> Store {
    let mut store = Store::open(folder, sweep, Shard::WHOLE, false).unwrap();
    executed(sweep, &mut store, Shard::WHOLE).unwrap();
    store
}

/// The values of all parameters at every point.
fn points(study: &str) -> Vec<Vec<FieldValue>> {
    let sweep = sweep(study, GLIDER);
    let folder = tempfile::tempdir().unwrap();
    let store = Store::open(folder.path(), &sweep, Shard::WHOLE, false).unwrap();
    let runs = 0..sweep.runs().unwrap();
    runs.map(|run| sweep.task(&store, run).unwrap().values)
        .collect()
}

const HEAD: &str = "title = \"t\"\nscene = \"scene.toml\"\n";
const MASS: &str = "[parameters.mass]\nfields = [\"bodies.body.mass\"]\n";
const SPEED: &str = "[parameters.speed]\nfields = [\"initial.bodies.body.vx\"]\n";
const LAST: &str = "[measures.path]\nof = \"last\"\nchannels = [\"body.x\"]\n";

fn numbers(values: &[Vec<FieldValue>]) -> Vec<Vec<f64>> {
    let rows = values.iter();
    rows.map(|row| row.iter().map(|v| v.number().unwrap()).collect())
        .collect()
}

#[test]
fn a_grid_has_every_combination_and_a_list_has_pairs() {
    let two = format!(
        "{MASS}values = [1.0, 2.0]\n{SPEED}from = 1.0\nto = 100.0\ncount = 3\nspacing = \"log\"\n{LAST}"
    );
    let grid = points(&format!("{HEAD}{two}"));
    let expected = [
        [1.0, 1.0],
        [1.0, 10.0],
        [1.0, 100.0],
        [2.0, 1.0],
        [2.0, 10.0],
        [2.0, 100.0],
    ];
    for (found, wanted) in numbers(&grid).iter().zip(expected) {
        // the ends are exact, 100^(1/2) is rounded
        assert!((found[1] / wanted[1] - 1.0).abs() < 1e-15 && found[0] == wanted[0]);
    }
    let paired = two.replace("values = [1.0, 2.0]", "values = [1.0, 2.0, 3.0]");
    let list = points(&format!("{HEAD}design = \"list\"\n{paired}"));
    assert_eq!(numbers(&list)[2], [3.0, 100.0]);
    assert_eq!(list.len(), 3);
    let message = refused(&format!("{HEAD}design = \"list\"\n{two}"));
    assert!(
        message.contains("as many values of every parameter, not [2, 3]"),
        "{message}"
    );
}

#[test]
fn sampled_designs_stay_within_ranges_and_depend_on_the_seed() {
    for (design, count) in [("latin_hypercube", 16), ("sobol", 16), ("sensitivity", 64)] {
        let study = |seed| {
            format!(
                "{HEAD}design = \"{design}\"\nsamples = 16\nseed = {seed}\n{MASS}from = 1.0\nto = 2.0\n{SPEED}values = [1, 2, 3]\n{LAST}"
            )
        };
        let values = points(&study(1));
        assert_eq!(values.len(), count, "{design}");
        for row in &values {
            assert!((1.0..2.0).contains(&row[0].number().unwrap()), "{design}");
            assert!(matches!(row[1], FieldValue::Whole(1..=3)), "{design}");
        }
        assert_eq!(values, points(&study(1)), "{design}");
        assert_ne!(values, points(&study(2)), "{design}");
    }
}

#[test]
fn whole_numbers_words_and_scaled_fields_are_set() {
    let study = format!(
        "{HEAD}{MASS}from = 1\nto = 4\ncount = 4\nwhole = true\n[parameters.method]\nfields = [\"integrator.method\"]\nvalues = [\"velocity_verlet\", \"bathe\"]\n\
         [parameters.rate]\nfields = [{{ path = \"simulation.duration\", factor = 2.0, power = -1.0 }}]\nvalues = [4.0]\n{LAST}"
    );
    let sweep = sweep(&study, GLIDER);
    let values = [
        FieldValue::Whole(3),
        FieldValue::Word("bathe".into()),
        FieldValue::Number(4.0),
    ];
    let overrides = sweep.study.overrides(&values);
    let wanted = [
        "bodies.body.mass=3",
        "integrator.method=\"bathe\"",
        "simulation.duration=0.5",
    ];
    assert_eq!(overrides[..3], wanted);
    let folder = tempfile::tempdir().unwrap();
    let store = made(&sweep, folder.path());
    for run in 0..8 {
        let row = store.row(run).unwrap();
        // 2 m/s for half a second; sums of 50 rounded steps
        assert!((row.measures[0].unwrap() - 1.0).abs() < 1e-13);
        assert_eq!((row.status, row.t), (RunStatus::Complete, 0.5));
    }
}

#[test]
fn measures_of_a_uniform_motion() {
    let kinds: [(&str, &str, f64, &str); 11] = [
        ("least", "", 0.0, "m"),
        ("largest", "", 2.0, "m"),
        ("largest_magnitude", "", 2.0, "m"),
        ("mean", "", 1.0, "m"),
        // sqrt(4/101 sum (k/100)^2) = sqrt(4 x 0.335)
        ("rms", "", (4.0 * 0.335_f64).sqrt(), "m"),
        ("quantile", "quantile = 0.25", 0.5, "m"),
        // the trapezoidal rule is exact
        ("integral", "", 1.0, "m s"),
        ("last", "", 2.0, "m"),
        ("mean", "from = 0.5", 1.5, "m"),
        ("largest", "to = 0.25", 0.5, "m"),
        ("integral", "from = 0.5\nto = 0.75", 0.3125, "m s"),
    ];
    let tables = kinds.iter().enumerate().map(|(k, (of, more, ..))| {
        format!("[measures.m{k}]\nof = \"{of}\"\nchannels = [\"body.x\"]\n{more}\n")
    });
    let magnitude = "[measures.size]\nof = \"largest\"\nchannels = [\"body.x\", \"body.y\"]\n";
    let study = format!(
        "{HEAD}{MASS}values = [1.0]\n{}{magnitude}",
        tables.collect::<String>()
    );
    let sweep = sweep(&study, GLIDER);
    let folder = tempfile::tempdir().unwrap();
    let row = made(&sweep, folder.path()).row(0).unwrap();
    for (k, (of, more, wanted, unit)) in kinds.iter().enumerate() {
        let found = row.measures[k].unwrap();
        // sums of a hundred rounded steps
        assert!((found - wanted).abs() < 1e-13, "{of} {more}: {found}");
        assert_eq!(sweep.units()[k], *unit);
    }
    assert!((row.measures[kinds.len()].unwrap() - 2.0).abs() < 1e-13);
    assert_eq!(row.energies.and_then(|energies| energies[0]), Some(0.0));
}

#[test]
fn measures_of_contacts_are_those_of_the_table_of_onsets() {
    let scene = fs::read_to_string("../../scenes/bouncing-journal.toml").unwrap();
    let joints = "joints = [\"pin\"]\n";
    let measure = |of: &str| format!("[measures.{of}]\nof = \"{of}\"\n{joints}");
    let kinds = [
        "contacts",
        "contact_share",
        "largest_impact_velocity",
        "deepest_penetration",
        "largest_contact_force",
    ];
    let tables: String = kinds.iter().map(|of| measure(of)).collect();
    let rows = "[measures.rows]\nof = \"mean\"\nchannels = [\"pin.contact\"]\n";
    let study = format!(
        "{HEAD}[parameters.e]\nfields = [\"contacts.aluminium.restitution\"]\nvalues = [0.9]\n{tables}{rows}"
    );
    let folder = tempfile::tempdir().unwrap();
    let sweep = sweep(&study, &scene);
    let row = made(&sweep, folder.path()).row(0).unwrap();
    let found: Vec<f64> = row.measures.iter().map(|m| m.unwrap()).collect();
    assert_eq!(found[0], row.onsets as f64);
    // it starts at 0.02 m/s and never gets faster
    assert!((found[2] - 0.02).abs() < 1e-9, "{found:?}");
    // a row every 50th of a contact: the two shares differ by a row at each end of each contact at most
    let rows = 0.02 / 1.6e-6;
    assert!(
        (found[1] - found[5]).abs() <= 2.0 * found[0] / rows,
        "{found:?}"
    );
    assert!(found[1] > 0.01, "{found:?}");
    // the same peak from rows at every step, and from contacts where rows are a millisecond apart
    let sparse = study.replace(
        "[parameters.e]",
        "set = [\"output.interval=1e-3\"]\n[parameters.e]",
    );
    let sparse = self::sweep(&sparse, &scene);
    let other = tempfile::tempdir().unwrap();
    let peak = made(&sparse, other.path()).row(0).unwrap().measures[4].unwrap();
    // fifty steps a contact: the first after the onset has another length
    assert!((peak / found[4] - 1.0).abs() < 2e-3, "{peak} {found:?}");
}

/// Three masses, of which one is refused.
const FAULTY: &str =
    "[parameters.mass]\nfields = [\"bodies.body.mass\"]\nvalues = [1.0, 2.0, -1.0]\n";

#[test]
fn runs_that_cannot_be_made_are_rows() {
    // both ends of the list are read when the study is checked, the middle is not
    let faulty = FAULTY.replace("2.0, -1.0", "-1.0, 2.0");
    let sweep = sweep(&format!("{HEAD}{faulty}{LAST}"), GLIDER);
    let folder = tempfile::tempdir().unwrap();
    let store = made(&sweep, folder.path());
    let row = store.row(1).unwrap();
    assert_eq!((row.status, row.measures[0]), (RunStatus::Refused, None));
    let error = row.error.unwrap();
    assert!(error.contains("bodies.body.mass"), "{error}");
    let merged = merge(&sweep, &store, folder.path()).unwrap();
    assert_eq!(
        merged.status,
        BTreeMap::from([("complete", 2), ("failed", 0), ("refused", 1)])
    );
    let page = fs::read_to_string(folder.path().join("sweep.md")).unwrap();
    assert!(page.contains(&format!("* run 1: {error}")), "{page}");
    let message = refused(&format!("{HEAD}{FAULTY}{LAST}"));
    assert!(message.contains("bodies.body.mass"), "{message}");
}

#[test]
fn faults_of_a_study_name_the_place() {
    let parameter = format!("{MASS}values = [1.0]\n");
    let cases = [
        (format!("{HEAD}{parameter}"), "missing field `measures`"),
        (
            format!("{HEAD}desing = \"grid\"\n{parameter}{LAST}"),
            "did you mean `design`?",
        ),
        (
            format!("{HEAD}design = \"grit\"\n{parameter}{LAST}"),
            "did you mean `grid`?",
        ),
        (
            format!("{HEAD}samples = 4\n{parameter}{LAST}"),
            "`samples` belongs to the designs",
        ),
        (
            format!("{HEAD}design = \"sobol\"\n{parameter}{LAST}"),
            "needs `samples`",
        ),
        (
            format!("{HEAD}{MASS}from = 1.0\nto = 2.0\n{LAST}"),
            "`parameters.mass` needs a `count`",
        ),
        (
            format!("{HEAD}{MASS}from = 2.0\nto = 1.0\ncount = 2\n{LAST}"),
            "needs `from` below `to`, not 2 and 1",
        ),
        (
            format!("{HEAD}{MASS}{LAST}"),
            "needs either `values` or `from` and `to`",
        ),
        (
            format!("{HEAD}[parameters.steps]\nfields = [\"a\"]\nvalues = [1]\n{LAST}"),
            "`parameters.steps` needs another name",
        ),
        (
            format!("{HEAD}{parameter}{}", LAST.replace("last", "lsat")),
            "did you mean `last`?",
        ),
        (
            format!("{HEAD}{parameter}{}", LAST.replace("body.x", "body.*")),
            "names of single channels",
        ),
        (
            format!("{HEAD}{parameter}{}", LAST.replace("body.x", "bdy.x")),
            "bdy.x",
        ),
        (
            format!("{HEAD}{MASS}from = 1\nto = 3\ncount = 4\nwhole = true\n{LAST}"),
            "`count` above the number of whole numbers",
        ),
        (
            format!("{HEAD}{}{LAST}", parameter.replace("1.0", "1.0, nan, 2.0")),
            "`parameters.mass` has a number that is not finite",
        ),
        (
            format!(
                "{HEAD}{parameter}{}{LAST}",
                parameter.replace("mass]", "again]")
            ),
            "`parameters.again` sets `bodies.body.mass`, which",
        ),
        (
            format!(
                "{HEAD}design = \"latin_hypercube\"\nsamples = 1000000000000000000\n{parameter}{LAST}"
            ),
            "more than 100000000 runs",
        ),
        (
            format!(
                "{HEAD}{parameter}{}",
                LAST.replace("[\"body.x\"]", "[\"body.x\", \"body.x\"]")
            ),
            "`measures.path` names `body.x` twice",
        ),
        (
            format!("{HEAD}{parameter}{LAST}from = 50.0\n"),
            "`measures.path` begins at 50 s, and the runs end at 1 s",
        ),
        (
            format!(
                "{HEAD}{parameter}{}",
                LAST.replace("[\"body.x\"]", "[\"body.x\", \"body.vx\"]")
            ),
            "channels with different units: m and m/s",
        ),
        (
            format!("{HEAD}{parameter}{LAST}quantile = 0.5\n"),
            "has no `quantile`",
        ),
        (
            format!("{HEAD}{parameter}[measures.n]\nof = \"contacts\"\njoints = [\"pin\"]\n"),
            "unknown joint `pin`",
        ),
        (
            format!("{HEAD}{parameter}{LAST}[target]\nmeasure = \"path\"\nvalue = 1.0\n"),
            "`target` belongs to a bisection",
        ),
        (
            format!("{HEAD}[parameters.m]\nfields = [\"bodies.bdy.mass\"]\nvalues = [1.0]\n{LAST}"),
            "bdy",
        ),
        (
            format!("{HEAD}{parameter}{LAST}[starts]\ncount = 0\nvelocity = 1.0\n"),
            "`starts` needs",
        ),
    ];
    for (study, wanted) in cases {
        let message = refused(&study);
        assert!(message.contains(wanted), "{wanted}: {message}");
    }
    // faults of the scene that the study makes are its own; the line of their key is named
    let changed = [
        (
            format!("{HEAD}{MASS}values = [1.0, -1.0]\n{LAST}"),
            "`study.toml`, line 3: `parameters.mass`: `bodies.body.mass` must be",
        ),
        (
            format!("{HEAD}{parameter}{}", LAST.replace("body.x", "bdy.x")),
            "`study.toml`, line 6: `measures.path`: ",
        ),
        (
            format!("{HEAD}set = [\"simulation.duratoin=1\"]\n{parameter}{LAST}"),
            "`study.toml`, line 3: `set`: unknown key `duratoin`",
        ),
        (
            format!("{HEAD}{MASS}from = 2.0\nto = 1.0\ncount = 2\n{LAST}"),
            "`study.toml`, line 3: `parameters.mass` needs `from` below `to`",
        ),
        (
            format!("{HEAD}{parameter}{LAST}[envelopes.e]\nchannels = [\"bdy.x\"]\n"),
            "`study.toml`, line 9: `envelopes.e`: ",
        ),
        (
            format!("{HEAD}set = [\"bodies.body.mass=-1\"]\n{parameter}{LAST}"),
            "`study.toml`, line 3: `set`: `bodies.body.mass` must be",
        ),
        (GLIDER.to_owned(), "`study.toml`: this is a scene"),
    ];
    for (study, wanted) in changed {
        let message = refused(&study);
        assert!(message.starts_with(wanted), "{wanted}: {message}");
    }
}

/// Each of 729 points of a Latin hypercube lies in a part of its own of the range.
#[test]
fn whole_numbers_have_equal_parts_of_a_range() {
    for spacing in ["linear", "log"] {
        let range = format!("from = 2\nto = 4\nwhole = true\nspacing = \"{spacing}\"\n");
        let study =
            format!("{HEAD}design = \"latin_hypercube\"\nsamples = 729\n{MASS}{range}{LAST}");
        let drawn = numbers(&points(&study));
        let count = |n: f64| drawn.iter().filter(|row| row[0] == n).count();
        let counts = [2.0, 3.0, 4.0].map(count);
        assert_eq!(counts.iter().sum::<usize>(), 729);
        match spacing {
            "linear" => assert_eq!(counts, [243; 3]),
            // equal ratios from 2 to 5; a part may lie on both sides of a bound
            _ => {
                let parts =
                    [1.5_f64, 4.0 / 3.0, 1.25].map(|ratio| 729.0 * ratio.ln() / 2.5_f64.ln());
                for (count, part) in counts.iter().zip(parts) {
                    assert!((*count as f64 - part).abs() < 2.0, "{counts:?}");
                }
            }
        }
    }
}

/// A loose pin that is thrown against its bearing again and again: its motion depends on the start.
fn loose() -> (String, String) {
    let scene = fs::read_to_string("../../scenes/slider-crank/loose.toml").unwrap();
    let study = format!(
        "{HEAD}set = [\"simulation.duration=0.02\"]\n[starts]\ncount = 3\nvelocity = 1e-3\n\
         [parameters.clearance]\nfields = [\"contacts.pin.clearance\"]\nvalues = [1e-4, 2e-4]\nunit = \"m\"\n"
    );
    (study, scene)
}

#[test]
fn starts_differ_and_start_0_is_that_of_the_scene() {
    let (study, scene) = loose();
    let joint = "[measures.impacts]\nof = \"largest_impact_velocity\"\njoints = [\"slider_pin\"]\n";
    let sweep = sweep(&format!("{study}{joint}"), &scene);
    let folder = tempfile::tempdir().unwrap();
    let store = made(&sweep, folder.path());
    let value = |run| store.row(run).unwrap().measures[0].unwrap();
    assert!(value(0) != value(1) && value(1) != value(2));
    let once = study.replace("count = 3", "count = 1");
    let alone = self::sweep(&format!("{once}{joint}"), &scene);
    let stop = AtomicBool::new(false);
    let values = vec![FieldValue::Number(1e-4)];
    let (row, _) = alone
        .run(
            &Task {
                run: 0,
                start: 0,
                values,
            },
            &stop,
        )
        .unwrap();
    assert_eq!(row.measures[0].unwrap().to_bits(), value(0).to_bits());
    // the table of points has the mean of the three
    merge(&sweep, &store, folder.path()).unwrap();
    let table = fs::read_to_string(folder.path().join("points.csv")).unwrap();
    let row: Vec<&str> = table.lines().nth(1).unwrap().split(',').collect();
    let mean = (value(0) + value(1) + value(2)) / 3.0;
    assert_eq!(row[..3], ["0", "0.0001", "3"]);
    assert_eq!(row[3].parse::<f64>().unwrap(), mean);
}

#[test]
fn starts_that_have_not_parted_are_named() {
    let (study, scene) = loose();
    let share =
        "[measures.share]\nof = \"contact_share\"\njoints = [\"slider_pin\"]\nfrom = 0.01\n";
    for (velocity, parted) in [("1e-12", false), ("0.1", true)] {
        let study = study.replace("1e-3", velocity);
        let sweep = sweep(&format!("{study}{share}"), &scene);
        let folder = tempfile::tempdir().unwrap();
        let merged = merge(&sweep, &made(&sweep, folder.path()), folder.path());
        let page = merged.unwrap().page;
        assert_eq!(!page.contains("have not parted"), parted, "{page}");
    }
}

#[cfg(feature = "parquet")]
#[test]
fn parquet_and_csv_hold_the_same_table() {
    use parquet::file::reader::{FileReader, SerializedFileReader};
    let study = format!(
        "{HEAD}{MASS}values = [1.0, 2.0]\nunit = \"kg\"\n[parameters.method]\nfields = [\"integrator.method\"]\nvalues = [\"bathe\"]\n{LAST}"
    );
    let sweep = sweep(&study, GLIDER);
    let folder = tempfile::tempdir().unwrap();
    let store = made(&sweep, folder.path());
    merge(&sweep, &store, folder.path()).unwrap();
    let file = fs::File::open(folder.path().join("sweep.parquet")).unwrap();
    let reader = SerializedFileReader::new(file).unwrap();
    let metadata = reader.metadata().file_metadata();
    let notes = metadata.key_value_metadata().unwrap();
    let units = notes.iter().find(|note| note.key == "units").unwrap();
    let units: BTreeMap<String, String> =
        serde_json::from_str(units.value.as_ref().unwrap()).unwrap();
    assert_eq!(
        (units["mass"].as_str(), units["path"].as_str()),
        ("kg", "m")
    );
    let csv = fs::read_to_string(folder.path().join("sweep.csv")).unwrap();
    let mut lines = csv.lines();
    let heads: Vec<&str> = lines.next().unwrap().split(',').collect();
    let mut rows = 0;
    for (row, line) in reader.get_row_iter(None).unwrap().zip(lines) {
        let row = row.unwrap();
        let cells: Vec<&str> = line.split(',').collect();
        for (k, (name, field)) in row.get_column_iter().enumerate() {
            let head = units
                .get(name)
                .map_or(name.clone(), |unit| format!("{name} [{unit}]"));
            assert_eq!(heads[k], head);
            let same = match field {
                parquet::record::Field::Double(x) => cells[k].parse::<f64>().unwrap() == *x,
                parquet::record::Field::Long(n) => cells[k].parse::<i64>().unwrap() == *n,
                parquet::record::Field::Str(text) => cells[k] == text,
                parquet::record::Field::Null => cells[k].is_empty(),
                other => panic!("{other:?}"),
            };
            assert!(same, "{name}: {field:?} {}", cells[k]);
        }
        rows += 1;
    }
    assert_eq!(rows, 2);
}

/// Files of the result, without the times.
fn result(folder: &Path) -> BTreeMap<&'static str, Vec<u8>> {
    let files = FILES.into_iter().filter(|name| *name != "times.csv");
    files
        .filter_map(|name| Some((name, fs::read(folder.join(name)).ok()?)))
        .collect()
}

#[test]
fn rows_of_shards_make_the_same_bytes() {
    let (study, scene) = loose();
    let envelope = "[envelopes.force]\nchannels = [\"slider_pin.force\"]\nparts = 20\n";
    let measure = "[measures.force]\nof = \"rms\"\nchannels = [\"slider_pin.force\"]\n";
    let study = format!("{study}{measure}{envelope}");
    let sweep = sweep(&study, &scene);
    let [whole, parts] = [(); 2].map(|()| tempfile::tempdir().unwrap());
    merge(&sweep, &made(&sweep, whole.path()), whole.path()).unwrap();
    for shard in ["3/4", "1/4", "4/4"] {
        let shard: Shard = shard.parse().unwrap();
        let mut store = Store::open(parts.path(), &sweep, shard, false).unwrap();
        executed(&sweep, &mut store, shard).unwrap();
    }
    let store = Store::read(parts.path(), &sweep).unwrap();
    let missing = merge(&sweep, &store, parts.path()).unwrap_err().to_string();
    assert!(
        missing.starts_with("2 runs have not been made: 1, 5;"),
        "{missing}"
    );
    // whatever is missing is made without a shard too
    made(&sweep, parts.path());
    let store = Store::read(parts.path(), &sweep).unwrap();
    merge(&sweep, &store, parts.path()).unwrap();
    let (whole, parts) = (result(whole.path()), result(parts.path()));
    let features = [cfg!(feature = "png"), cfg!(feature = "parquet")];
    assert_eq!(whole.len(), 6 + features.iter().filter(|on| **on).count());
    assert!(whole == parts);
}

#[test]
fn torn_lines_are_made_again_and_other_sweeps_are_refused() {
    let study = format!("{HEAD}{MASS}values = [1.0, 2.0, 3.0]\n{LAST}");
    let sweep = sweep(&study, GLIDER);
    let folder = tempfile::tempdir().unwrap();
    merge(&sweep, &made(&sweep, folder.path()), folder.path()).unwrap();
    let before = result(folder.path());
    let path = folder.path().join("runs.jsonl");
    let bytes = fs::read(&path).unwrap();
    // cut anywhere, the head of the file included
    for length in [0, 10, bytes.len() / 2, bytes.len() - 1] {
        fs::write(&path, &bytes[..length]).unwrap();
        let store = made(&sweep, folder.path());
        assert_eq!(store.len(), 3);
        merge(&sweep, &store, folder.path()).unwrap();
        assert!(result(folder.path()) == before, "{length}");
    }
    let other = self::sweep(&study.replace("3.0", "4.0"), GLIDER);
    let error = Store::open(folder.path(), &other, Shard::WHOLE, false).unwrap_err();
    assert!(
        error
            .to_string()
            .contains("another study, scene or target (\"t\")"),
        "{error}"
    );
    // a title may be corrected, and a comment added
    let same = self::sweep(
        &study.replace("title = \"t\"", "# new\ntitle = \"u\""),
        GLIDER,
    );
    assert!(same.study.title == "u" && same.digest() == sweep.digest());
    let (first, rest) = bytes.split_at(bytes.iter().position(|b| *b == b'\n').unwrap());
    let mut head: serde_json::Value = value_of(first).unwrap();
    head["version"] = "0.0.0".into();
    let other_version = [&line_of(&head).unwrap(), &rest[1..]].concat();
    fs::write(&path, other_version).unwrap();
    let error = Store::open(folder.path(), &sweep, Shard::WHOLE, false).unwrap_err();
    assert!(
        error.to_string().contains("rows of version 0.0.0"),
        "{error}"
    );
    let anew = Store::open(folder.path(), &sweep, Shard::WHOLE, true).unwrap();
    assert!(anew.is_empty());
    let busy = Store::open(folder.path(), &sweep, Shard::WHOLE, false).unwrap_err();
    assert!(
        busy.to_string().contains("another looselink is writing"),
        "{busy}"
    );
}

/// A bisection for the mass or speed of the glider.
fn bisection(target: f64) -> (Result<Merged, SweepError>, Vec<SweepRow>) {
    let study = format!("{HEAD}{SPEED}from = 1.0\nto = 9.0\nunit = \"m/s\"\n{LAST}");
    let source = SweepSource {
        target: Some(SweepTarget::new("path", target)),
        ..source(&study, GLIDER)
    };
    let sweep = Sweep::new(source).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let mut store = Store::open(folder.path(), &sweep, Shard::WHOLE, false).unwrap();
    let ended = executed(&sweep, &mut store, Shard::WHOLE);
    let merged = ended.and_then(|()| merge(&sweep, &store, folder.path()));
    let rows = store.numbers().map(|run| store.row(run).unwrap());
    (merged, rows.collect())
}

#[test]
fn a_bisection_encloses_its_target() {
    // x = v t: the path of a second is the speed
    let (merged, rows) = bisection(4.4);
    let crossing = merged.unwrap().crossing.unwrap();
    let [low, high] = crossing.between.each_ref().map(|v| v.number().unwrap());
    // eight metres a second, halved until a hundredth is left
    assert!(
        low < 4.4 && 4.4 < high && high - low == 8.0 / 128.0,
        "{crossing:?}"
    );
    assert_eq!(rows.len(), 9);
    let (merged, rows) = bisection(10.0);
    let message = merged.unwrap_err().to_string();
    let wanted = "`path` does not cross 10 m: it is 1 m with `speed` = 1 and 9 m with 9";
    assert!(message.contains(wanted), "{message}");
    assert_eq!(rows.len(), 2);
}

/// What was visited is drawn all the same.
#[test]
fn a_bisection_without_an_answer_leaves_its_picture() {
    let study = format!(
        "{HEAD}design = \"bisection\"\n{SPEED}from = 1.0\nto = 9.0\n{LAST}[target]\nmeasure = \"path\"\nvalue = 10.0\n"
    );
    let sweep = sweep(&study, GLIDER);
    let folder = tempfile::tempdir().unwrap();
    let store = made(&sweep, folder.path());
    let error = merge(&sweep, &store, folder.path()).unwrap_err();
    assert!(matches!(error, SweepError::NoAnswer(_)), "{error}");
    let text = |name: &str| fs::read_to_string(folder.path().join(name)).unwrap();
    assert!(text("sweep.md").contains("The bisection has no answer: `path` does not cross 10 m"));
    assert!(text("sweep.svg").contains("<svg"));
    assert_eq!(text("sweep.csv").lines().count(), 1 + 2);
    assert!(text("sweep.json").contains("\"no_answer\""));
}

#[test]
fn studies_of_the_project_can_be_made() {
    let entries = fs::read_dir("../../studies/sweeps").unwrap();
    let sweeps = entries.map(|entry| Sweep::load(&entry.unwrap().path(), None).unwrap());
    let mut runs: Vec<Option<usize>> = sweeps.map(|sweep| sweep.runs()).collect();
    runs.sort();
    assert_eq!(runs, [None, Some(120), Some(384)]);
}

#[test]
fn maps_are_drawn_of_any_grid() {
    for (rows, columns) in [("[1.0]", 7), ("[1.0, 1.0]", 7), ("[1.0, 2.0, 4.0]", 8)] {
        let study = format!(
            "{HEAD}{MASS}values = {rows}\n{SPEED}from = 1.0\nto = 4.0\ncount = {columns}\n{LAST}"
        );
        let sweep = sweep(&study, GLIDER);
        let folder = tempfile::tempdir().unwrap();
        merge(&sweep, &made(&sweep, folder.path()), folder.path()).unwrap();
        let picture = fs::read_to_string(folder.path().join("sweep.svg")).unwrap();
        // a rectangle for each point, and five in the legend, which are also drawn as points of no size
        let cells = picture.matches("<polygon").count();
        let wanted = if rows.contains('4') { 3 * 8 + 2 * 5 } else { 0 };
        assert_eq!(cells, wanted, "{rows}");
    }
}

/// A grid is drawn over its first parameter with numbers, wherever that stands; one without numbers has a line for each word.
#[test]
fn words_are_told_apart() {
    const LAWS: &str = "[parameters.method]\nfields = [\"integrator.method\"]\nvalues = [\"velocity_verlet\", \"bathe\"]\n";
    for (parameters, wanted) in [
        (
            format!("{LAWS}{SPEED}values = [1.0, 2.0, 4.0]\n"),
            ["method velocity_verlet", "method bathe"],
        ),
        (LAWS.to_owned(), ["method velocity_verlet", "method bathe"]),
    ] {
        let sweep = sweep(&format!("{HEAD}{parameters}{LAST}"), GLIDER);
        let folder = tempfile::tempdir().unwrap();
        merge(&sweep, &made(&sweep, folder.path()), folder.path()).unwrap();
        let picture = fs::read_to_string(folder.path().join("sweep.svg")).unwrap();
        for label in wanted {
            assert!(picture.contains(label), "{label}");
        }
        let page = fs::read_to_string(folder.path().join("sweep.md")).unwrap();
        assert!(page.contains("| method = velocity_verlet"), "{page}");
    }
}

/// Of many points some are drawn, and the caption says so; no value of a grid is passed over.
#[test]
fn pictures_of_many_points_stay_small() {
    let study = format!(
        "{HEAD}set = [\"simulation.duration=0.01\"]\ndesign = \"sobol\"\nsamples = 8192\n{SPEED}from = 1.0\nto = 4.0\n{LAST}"
    );
    let sweep = sweep(&study, GLIDER);
    let folder = tempfile::tempdir().unwrap();
    merge(&sweep, &made(&sweep, folder.path()), folder.path()).unwrap();
    let picture = fs::read_to_string(folder.path().join("sweep.svg")).unwrap();
    assert!(picture.contains("some are drawn"));
    let dots = picture.matches("<circle").count();
    // the least odd stride that leaves at most 5000
    assert_eq!(dots, 8192_usize.div_ceil(3));
}

#[test]
fn a_new_beginning_waits_for_other_shards_and_leaves_no_old_table() {
    let study = format!("{HEAD}{MASS}values = [1.0, 2.0, 3.0]\n{LAST}");
    let sweep = sweep(&study, GLIDER);
    let folder = tempfile::tempdir().unwrap();
    merge(&sweep, &made(&sweep, folder.path()), folder.path()).unwrap();
    let other = Store::open(folder.path(), &sweep, "1/2".parse().unwrap(), false).unwrap();
    let busy = Store::open(folder.path(), &sweep, Shard::WHOLE, true).unwrap_err();
    assert!(
        busy.to_string().contains("another looselink is writing"),
        "{busy}"
    );
    assert_eq!(Store::read(folder.path(), &sweep).unwrap().len(), 3);
    drop(other);
    let anew = Store::open(folder.path(), &sweep, Shard::WHOLE, true).unwrap();
    assert!(anew.is_empty() && result(folder.path()).is_empty());
}

#[test]
fn a_sweep_that_is_stopped_keeps_its_rows() {
    let study = format!("{HEAD}{MASS}from = 1.0\nto = 2.0\ncount = 10\n{LAST}");
    let sweep = sweep(&study, GLIDER);
    let folder = tempfile::tempdir().unwrap();
    let mut store = Store::open(folder.path(), &sweep, Shard::WHOLE, false).unwrap();
    let stop = AtomicBool::new(false);
    let ended = execute(
        &sweep,
        &mut store,
        Shard::WHOLE,
        threads(1),
        &stop,
        &mut |progress| {
            stop.store(progress.done == 4, std::sync::atomic::Ordering::Relaxed);
        },
    );
    let message = ended.unwrap_err().to_string();
    assert_eq!(
        message,
        "interrupted: 4 of 10 runs are made; the same command goes on"
    );
    assert_eq!(Store::read(folder.path(), &sweep).unwrap().len(), 4);
}

//! A force of a user whose quantities have names and units that tables must write with care, or must not hold.

use looselink::effect::Effect;
use looselink::force::{Force, LocalMatrix, WIDTH};
use looselink::interaction::{Ends, ForceKind, ForceModel};
use looselink::ledger::{Entry, Powers};
use looselink::output::folder::Folder;
use looselink::output::{Results, kind};
use looselink::registry::Registry;
use looselink::scene::{PointRef, Scene};
use looselink::simulate::Simulation;
use looselink::system::{State, Weights};
use serde_json::Value;
use std::sync::Arc;

/// Names and units.
type Quantities = &'static [(&'static str, &'static str)];

/// Nothing acts.
#[derive(Debug)]
struct Measured(Quantities);

impl ForceModel for Measured {
    fn points(&self) -> Vec<PointRef> {
        Vec::new()
    }

    fn term(&self, _: &Ends) -> (Box<dyn Force>, [usize; 2]) {
        (Box::new(Measured(self.0)), [0, 0])
    }
}

impl Force for Measured {
    fn effect(&self) -> Effect {
        "nothing"
    }

    fn sides(&self) -> [Vec<usize>; 2] {
        [Vec::new(), Vec::new()]
    }

    fn force(&self, _: &State, _: &mut [f64; WIDTH]) {}

    fn force_and_tangent(&self, _: &State, _: Weights, _: &mut [f64; WIDTH], _: &mut LocalMatrix) {}

    fn entries(&self) -> Vec<&'static Entry> {
        Vec::new()
    }

    fn powers(&self, _: &State, _: &mut Powers) {}

    fn quantities(&self) -> Quantities {
        self.0
    }
}

static AWKWARD: ForceKind = ForceKind {
    name: "awkward",
    keys: &[],
    read: |_, _| Ok(Arc::new(Measured(&[("a,b", "\"in\""), ("=c\\", "N|m")]))),
};

static ESCAPE: ForceKind = ForceKind {
    name: "escape",
    keys: &[],
    read: |_, _| Ok(Arc::new(Measured(&[("x", "N\u{1b}[2J")]))),
};

static LINES: ForceKind = ForceKind {
    name: "lines",
    keys: &[],
    read: |_, _| Ok(Arc::new(Measured(&[("x\ny", "N")]))),
};

fn scene(kind: &'static ForceKind, format: &str) -> Scene {
    let registry = Registry::standard().with_force(kind);
    let text = include_str!("../../scenes/bouncing-journal.toml");
    let own = format!("forces={{ -f = {{ type = \"{}\" }} }}", kind.name);
    let changes = [
        own,
        "output.channels=[\"-f.*\"]".to_owned(),
        format!("output.format={format}"),
    ];
    Scene::parse_with(&registry, "scene.toml", text, &changes).unwrap()
}

#[test]
fn names_and_units_of_quantities_are_read_back() {
    let folder = tempfile::tempdir().unwrap();
    for format in ["csv", "json_lines"] {
        let scene = scene(&AWKWARD, format);
        let simulation = Simulation::new(&scene).unwrap();
        let path = folder.path().join(format);
        let out = Folder::claim(&path, kind(&Registry::standard().formats, &[]), false).unwrap();
        let mut results = Results::begin(out, &scene, &simulation).unwrap();
        results.row(&[0.0, 1.0, 2.0]).unwrap();
        results.flush().unwrap();
        let table =
            std::fs::read_to_string(path.join(scene.output.format.file("channels"))).unwrap();
        match format {
            "csv" => assert_eq!(
                table,
                "t [s],\"'-f.a,b [\"\"in\"\"]\",'-f.=c\\ [N|m]\n0.0,1.0,2.0\n"
            ),
            _ => {
                let row: Value = serde_json::from_str(&table).unwrap();
                assert_eq!(row["-f.a,b [\"in\"]"], 1.0);
                assert_eq!(row["-f.=c\\ [N|m]"], 2.0);
            }
        }
    }
}

#[test]
fn quantities_that_break_a_line_are_refused() {
    for (kind, told) in [
        (
            &ESCAPE,
            "a quantity of `forces.-f` holds U+001B, a control character",
        ),
        (
            &LINES,
            "a quantity of `forces.-f` holds U+000A, a line feed",
        ),
    ] {
        let error = Simulation::new(&scene(kind, "csv")).unwrap_err();
        assert_eq!(error.to_string(), told);
        assert_eq!(
            error.change().map(|change| change.starts_with("forces=")),
            Some(true)
        );
    }
}

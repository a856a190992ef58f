//! The corners of every map: which runs are wrong in silence.

use evidence::stability::map::{Map, files, known_silent};
use evidence::stability::outcome::OutcomeClass;

/// First and last of a list.
fn ends(list: &[f64]) -> Vec<f64> {
    vec![list[0], list[list.len() - 1]]
}

/// A run that is silent fails, unless evidence/silent.toml says why it is; so does one that is listed there and is not.
#[test]
fn silent_corners_of_maps_are_the_known_ones() {
    let files = files().unwrap();
    assert!(files.len() >= 12, "only {} maps", files.len());
    let known = known_silent().unwrap();
    for path in files {
        let mut map = Map::load(&path).unwrap();
        if map.reference.steps.len() > 1 {
            map.reference.steps = ends(&map.reference.steps);
        }
        map.parameter.values = ends(&map.parameter.values);
        map.steps = ends(&map.steps);
        let name = path.file_stem().unwrap().to_string_lossy();
        let made = map.make(&name).unwrap();
        let of = |class| made.runs().filter(move |run| run.3.0 == class);
        for (method, value, column, cell) in made.runs() {
            let listed = known.iter().any(|run| run.is(&name, method, value, column));
            let silent = cell.0 == OutcomeClass::Silent;
            assert_eq!(
                silent, listed,
                "{name}: {method}, {value}, {column}: {cell:?}"
            );
        }
        assert!(
            of(OutcomeClass::Accurate).count() > 0,
            "{name}: nothing is accurate"
        );
    }
}

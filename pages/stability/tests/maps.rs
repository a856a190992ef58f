//! The corners of every map: no run is wrong in silence.

use stability::map::{Map, files};
use stability::outcome::OutcomeClass;

/// First and last of a list.
fn ends(list: &[f64]) -> Vec<f64> {
    vec![list[0], list[list.len() - 1]]
}

#[test]
fn corners_of_maps_are_never_silent() {
    let files = files().unwrap();
    assert!(files.len() >= 12, "only {} maps", files.len());
    for path in files {
        let mut map = Map::load(&path).unwrap_or_else(|e| panic!("{e}"));
        if map.reference.steps.len() > 1 {
            map.reference.steps = ends(&map.reference.steps);
        }
        map.parameter.values = ends(&map.parameter.values);
        map.steps = ends(&map.steps);
        let methods = map.methods.len();
        let made = map.make("corners").unwrap_or_else(|e| panic!("{e}"));
        assert_eq!(made.cells.len(), 4 * methods);
        for cell in &made.cells {
            assert_ne!(
                cell.outcome,
                OutcomeClass::Silent,
                "{}: {cell:?}",
                path.display()
            );
        }
        let accurate = made
            .cells
            .iter()
            .any(|c| c.outcome == OutcomeClass::Accurate);
        assert!(accurate, "{}: nothing is accurate", path.display());
    }
}

//! The corners of every map, and its runs that are wrong in silence: which are.

use evidence::stability::map::{Map, files, known_silent, listed};
use evidence::stability::outcome::OutcomeClass;

/// First and last of a list, and others.
fn some(list: &[f64], mut others: Vec<f64>) -> Vec<f64> {
    others.extend([list[0], list[list.len() - 1]]);
    others.sort_by(f64::total_cmp);
    others.dedup();
    others
}

/// A run that is silent fails, unless evidence/silent.toml says why it is; so does one that is listed there and is not.
#[test]
fn silent_corners_of_maps_are_the_known_ones() {
    let files = files().unwrap();
    assert!(files.len() >= 12, "only {} maps", files.len());
    let known = known_silent().unwrap();
    for path in files {
        let mut map = Map::load(&path).unwrap();
        let name = path.file_stem().unwrap().to_string_lossy().into_owned();
        let (values, columns) = listed(&known, &name);
        if map.reference.steps.len() > 1 {
            assert!(
                values.is_empty(),
                "{name}: its reference has a step for each value"
            );
            map.reference.steps = some(&map.reference.steps, Vec::new());
        }
        let all = map.steps.clone();
        let steps = columns.into_iter().filter(|column| all.contains(column));
        map.parameter.values = some(&map.parameter.values, values);
        map.steps = some(&map.steps, steps.collect());
        let made = map.make(&name).unwrap();
        for run in made.runs() {
            let listed = known.iter().any(|known| known.has(&name, &run));
            assert_eq!(run.is(OutcomeClass::Silent), listed, "{name}: {run:?}");
        }
        assert!(
            made.runs().any(|run| run.is(OutcomeClass::Accurate)),
            "{name}: nothing is accurate"
        );
    }
}

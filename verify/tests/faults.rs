//! The list of seeded faults fits the code, and every one of them was caught.

use ladder::seeded::root;
use verify::faults::{list, outcomes};

/// The comparison is worth what it catches; fewer faults than these would say little.
const FEWEST: usize = 15;

#[test]
fn seeded_faults_are_current_and_caught() {
    let (faults, outcomes) = (list().unwrap(), outcomes().unwrap());
    assert!(faults.len() >= FEWEST, "{} faults", faults.len());
    for reference in [false, true] {
        let side = faults.iter().filter(|f| f.is_in_reference() == reference);
        assert!(side.count() >= FEWEST / 3, "both sides have faults");
    }
    assert_eq!(faults.len(), outcomes.len(), "every fault was run");
    for fault in &faults {
        let changed = fault.applied(&root()).unwrap();
        assert!(changed.contains(&fault.replace), "{}", fault.name);
        let outcome = outcomes.iter().find(|o| o.name == fault.name);
        let outcome = outcome.unwrap_or_else(|| panic!("{} was not run", fault.name));
        assert!(
            !outcome.caught_by.is_empty(),
            "{} was not caught",
            fault.name
        );
    }
}

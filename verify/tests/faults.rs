//! The list of seeded faults fits the code, and every one of them was caught.

use ladder::faults::{judged, outcomes};
use records::root;

/// The comparison is worth what it catches; fewer faults than these would say little.
const FEWEST: usize = 50;

#[test]
fn seeded_faults_are_current_and_caught() {
    let judged = judged().unwrap();
    assert_eq!(judged.len(), outcomes().unwrap().len(), "all of the list");
    for reference in [false, true] {
        let mistakes = judged.iter().filter(|(f, _)| !f.is_variant());
        let side = mistakes.filter(|(f, _)| f.is_in_reference() == reference);
        assert!(side.count() >= FEWEST / 3, "both sides have faults");
    }
    for (fault, outcome) in &judged {
        let changed = fault.applied(&root()).unwrap();
        assert!(changed.contains(&fault.replace), "{}", fault.name);
        let (name, caught_by) = (&fault.name, &outcome.caught_by);
        assert_eq!(
            caught_by.is_empty(),
            fault.is_variant(),
            "{name}: {caught_by:?}"
        );
    }
    let mistakes = judged.iter().filter(|(f, _)| !f.is_variant()).count();
    assert!(mistakes >= FEWEST, "{mistakes} faults");
}

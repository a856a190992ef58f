//! Whole motions on both sides.

use verify::check::{Agreement, assert_all};
use verify::compare::{classes, impacts::Series};
use verify::compare::{flexible, impacts, rigid, statistics};

#[test]
fn rigid_mechanisms_agree() {
    let rows = rigid::agreements().unwrap();
    // nothing deforms and nothing touches: neither slopes nor those energies
    assert_eq!(
        rows.len(),
        classes::CLASSES.len() - 2,
        "every other kind of channel"
    );
    assert_all(&rows);
}

#[test]
fn flexible_links_of_one_element_agree() {
    assert_all(&flexible::convergence(1).unwrap().agreements());
}

#[test]
fn flexible_links_of_four_elements_agree() {
    assert_all(&flexible::convergence(4).unwrap().agreements());
}

fn impacts_agree(choose: impl Fn(&Series) -> bool) {
    let series = impacts::all();
    let rows: Vec<Agreement> = series
        .iter()
        .filter(|s| choose(s))
        .flat_map(|s| s.agreements().unwrap())
        .collect();
    assert_all(&rows);
}

#[test]
fn impacts_of_rigid_links_agree() {
    impacts_agree(|s| s.plan.scene == "3rrr/case3");
}

#[test]
fn impacts_of_flexible_links_agree() {
    impacts_agree(|s| s.plan.scene != "3rrr/case3");
}

#[test]
fn statistics_of_rigid_loose_joints_agree() {
    assert_all(&statistics::agreements(3).unwrap());
}

#[test]
fn statistics_of_flexible_loose_joints_agree() {
    assert_all(&statistics::agreements(4).unwrap());
}

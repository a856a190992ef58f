//! Whole motions on both sides.

use verify::check::{Agreement, assert_all};
use verify::compare::impacts::ImpactSeries;
use verify::compare::{flexible, impacts, machines, rigid};

#[test]
fn motion_of_case_1_agrees() {
    let rows = rigid::agreements().unwrap();
    assert_all("Case 1 in motion", &rows);
}

#[test]
fn flexible_links_of_one_element_agree() {
    let rows = flexible::convergence(1).unwrap().agreements();
    assert_all("Case 2 in motion", &rows);
}

#[test]
fn flexible_links_of_four_elements_agree() {
    let rows = flexible::convergence(4).unwrap().agreements();
    assert_all("Case 2 with four elements a link in motion", &rows);
}

fn impacts_agree(what: &str, choose: impl Fn(&ImpactSeries) -> bool) {
    let series = impacts::all();
    let rows: Vec<Agreement> = series
        .iter()
        .filter(|s| choose(s))
        .flat_map(|s| s.agreements().unwrap())
        .collect();
    assert_all(what, &rows);
}

#[test]
fn impacts_of_rigid_links_agree() {
    impacts_agree("First impacts of case 3", |s| s.plan.scene == "3rrr/case3");
}

#[test]
fn impacts_of_flexible_links_agree() {
    impacts_agree("First impacts of case 4", |s| {
        s.plan.scene.contains("case4")
    });
}

#[test]
fn first_impacts_of_other_mechanisms_agree() {
    let what = "First impacts of a slider-crank and of a body that hangs in a frame";
    impacts_agree(what, |s| !s.plan.scene.contains("case"));
}

#[test]
fn motion_of_scene_everything_agrees() {
    let rows = machines::smooth().unwrap();
    assert_all(
        "Every element but clearance and inverse kinematics in motion",
        &rows,
    );
}

#[test]
fn first_rows_without_clearance_agree() {
    for plan in machines::plans().unwrap() {
        let what = format!("First rows of {}", plan.name());
        assert_all(&what, &machines::first_rows(&plan).unwrap());
    }
}

#[test]
fn fine_meshes_agree() {
    for plan in machines::fine_meshes() {
        let what = format!("First rows of {}", plan.name());
        assert_all(&what, &machines::first_rows(&plan).unwrap());
    }
}

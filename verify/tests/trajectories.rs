//! Whole motions on both sides.

use verify::check::{Agreement, assert_all};
use verify::compare::impacts::ImpactSeries;
use verify::compare::{flexible, impacts, machines, rigid};
use verify::trajectory::ComparisonPlan;

#[test]
fn motion_of_case_1_agrees() {
    let rows = rigid::agreements().unwrap();
    assert_all("Case 1 in motion", &rows);
}

fn flexible_links_agree(name: &str) {
    let plan = flexible::all().into_iter().find(|plan| plan.name == name);
    let rows = plan.unwrap().run().unwrap().agreements();
    assert_all(&format!("Case 2 in motion, {name}"), &rows);
}

#[test]
fn flexible_links_of_one_element_agree() {
    flexible_links_agree("1 element per link");
}

#[test]
fn flexible_links_of_four_elements_agree() {
    flexible_links_agree("4 elements per link");
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

fn motions_agree(plans: &[ComparisonPlan]) {
    for plan in plans {
        let what = format!("Motion of {}", plan.name());
        assert_all(&what, &machines::motion(plan).unwrap());
    }
}

#[test]
fn motion_of_scene_everything_agrees() {
    motions_agree(&machines::others()[..1]);
}

#[test]
fn motion_of_pressed_journals_agrees() {
    motions_agree(&machines::others()[1..2]);
}

#[test]
fn first_rows_without_clearance_agree() {
    motions_agree(&machines::smooth().unwrap());
}

#[test]
fn fine_meshes_agree() {
    motions_agree(&machines::others()[2..]);
}

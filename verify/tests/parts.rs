//! Elements, laws and assembled equations at random states.

use verify::check::assert_all;
use verify::compare::{elements, equations, laws};
use verify::trajectory::Plan;

#[test]
fn elements_agree() {
    assert_all("Cable element", &elements::agreements().unwrap());
}

#[test]
fn contact_and_friction_laws_agree() {
    assert_all("Laws of contact and friction", &laws::agreements().unwrap());
}

fn equations_agree(choose: impl Fn(&Plan) -> bool) {
    let plans: Vec<Plan> = equations::plans().into_iter().filter(choose).collect();
    assert!(!plans.is_empty());
    for plan in plans {
        let what = format!("Assembled equations of {}", plan.name());
        assert_all(&what, &equations::agreements(&plan).unwrap());
    }
}

#[test]
fn equations_of_ideal_joints_agree() {
    equations_agree(|p| p.scene == "3rrr/case1" || p.scene == "3rrr/case2");
}

#[test]
fn equations_of_loose_joints_agree() {
    equations_agree(|p| {
        p.overrides.is_empty() && ["3rrr/case3", "3rrr/case4"].contains(&&*p.scene)
    });
}

#[test]
fn equations_with_friction_agree() {
    equations_agree(|p| p.name().contains("friction"));
}

#[test]
fn equations_of_other_mechanisms_agree() {
    equations_agree(|p| !p.scene.starts_with("3rrr/"));
}

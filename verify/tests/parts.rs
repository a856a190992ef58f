//! Starts, equilibria, and equations at random states.

use looselink::scene::Analysis;
use verify::check::assert_all;
use verify::compare::{equations, scenes};
use verify::trajectory::ComparisonPlan;

#[test]
fn starts_of_all_scenes_agree() {
    for plan in scenes::all().unwrap() {
        let what = format!("Start of {}", plan.name());
        assert_all(&what, &scenes::start(&plan).unwrap());
    }
}

#[test]
fn equilibria_agree() {
    for plan in scenes::of(Analysis::Static).unwrap() {
        let what = format!("Equilibria of {}", plan.name());
        assert_all(&what, &scenes::equilibrium(&plan).unwrap());
    }
}

fn equations_agree(choose: impl Fn(&ComparisonPlan) -> bool) {
    let plans = equations::plans().unwrap().into_iter().filter(choose);
    let plans: Vec<ComparisonPlan> = plans.collect();
    assert!(!plans.is_empty());
    for plan in plans {
        let what = format!("Assembled equations of {}", plan.name());
        assert_all(&what, &equations::agreements(&plan).unwrap());
    }
}

#[test]
fn equations_of_the_paper_cases_agree() {
    equations_agree(|p| p.name().contains("case"));
}

#[test]
fn equations_of_other_mechanisms_agree() {
    equations_agree(|p| !p.name().contains("case"));
}

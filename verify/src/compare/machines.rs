//! Motions without impacts: of every scene without clearance, and of one with every other element.

use super::classes::{self, KINDS};
use super::scenes;
use crate::check::{Agreement, LargestDifference, Standing};
use crate::trajectory::{ComparisonPlan, Trajectory, tolerances};
use looselink::scene::Analysis;
use miette::Result;

/// Steps of Looselink without clearance \[s\], each half of the one before.
const STEPS: [f64; 2] = [2e-5, 1e-5];
/// Relative tolerance of IDA for it; positions are held to 1e-3 m of that, velocities to 0.1 m/s.
const RELATIVE: f64 = 1e-10;
/// Accuracies of Looselink's error control \[m\], so tight that stability does not bound the steps, and relative tolerances of IDA.
/// The tightest ones are for scenes with channels that would not count otherwise.
const LEVELS: [f64; 3] = [1e-9, 1e-10, 1e-11];
/// How far an order may be from the 2 of Bathe's scheme.
const ORDER_BAND: f64 = 0.1;

/// Every element but clearance and legs in one motion of half a second: each kind of channel, and the order at which the
/// difference falls.
pub fn smooth() -> Result<Vec<Agreement>> {
    let plan = ComparisonPlan::new("../verify/scenes/everything", 0.5, 1e-2);
    let tolerances = tolerances(RELATIVE);
    let (cpp, rust) = rayon::join(|| plan.cpp(&tolerances), || STEPS.map(|h| plan.rust(h)));
    let cpp = cpp?;
    let [coarse, fine] = rust;
    let scene = format!("{}, {} s", plan.name(), plan.duration);
    let reason = format!(
        "relative to the largest value of its kind; h = {:.0e} s, IDA relative {RELATIVE:.0e}",
        STEPS[1]
    );
    let [coarse, mut rows] = [coarse?, fine?]
        .map(|run| classes::agreements([0.0; KINDS], &scene, &run, &cpp, 1e-6, &reason));
    let orders = coarse.iter().zip(&rows).map(|(coarse, fine)| {
        let order = (coarse.difference / fine.difference).log2();
        LargestDifference::of(order, 2.0, 1.0).row(
            &format!("order of {}", fine.quantity),
            &scene,
            ORDER_BAND,
            &format!("Bathe's scheme, from h = {:.0e} s to the half", STEPS[0]),
        )
    });
    let orders: Vec<Agreement> = orders.collect();
    rows.extend(orders);
    Ok(rows)
}

/// The scenes without clearance.
pub fn plans() -> Result<Vec<ComparisonPlan>> {
    let mut plans = Vec::new();
    for plan in scenes::of(Analysis::Dynamic)? {
        if plan.scene(None)?.smallest_clearance().is_none() {
            plans.push(plan);
        }
    }
    Ok(plans)
}

/// Fine meshes, whose Newton matrix the reference factorises as a sparse one.
pub fn fine_meshes() -> Vec<ComparisonPlan> {
    let links = ["link1", "link2", "link3"].map(|link| format!("bodies.{link}.elements=16"));
    let links = links.each_ref().map(String::as_str);
    let machine = ComparisonPlan::new("3rrr/case2", 1e-3, 1e-4);
    let pendulum = ComparisonPlan::new("soft-pendulum", 0.1, 5e-3);
    vec![
        machine.with(", 16 elements a link", &links),
        pendulum.with(", 64 elements", &["bodies.rod.elements=64"]),
    ]
}

/// The first rows of a scene, by Dormand and Prince's pair with growing accuracies and by IDA with falling tolerances.
pub fn first_rows(plan: &ComparisonPlan) -> Result<Vec<Agreement>> {
    let rust = |position: f64| {
        let accuracy = format!("{{position={position:e},horizon={:?}}}", plan.duration);
        let integrator = format!("integrator={{method=\"dormand_prince\",accuracy={accuracy}}}");
        let accurate = plan.clone().with("", &[&integrator, "assumptions={}"]);
        accurate.run(None, usize::MAX)
    };
    let both = |level: f64| -> Result<[Trajectory; 2]> {
        let (rust, cpp) = rayon::join(|| rust(level), || plan.cpp(&tolerances(level)));
        Ok([rust?, cpp?])
    };
    let rounding = scenes::rounding(&mut plan.reference()?)?;
    let name = format!("{}, {} s", plan.name(), numbers::number(plan.duration, 3));
    let [first, others @ ..] = LEVELS;
    let (mut coarse, mut rows) = (both(first)?, Vec::new());
    for level in others {
        let fine = both(level)?;
        rows = classes::converged(rounding, &name, &coarse, &fine);
        if rows.iter().all(|row| row.standing != Standing::Apart) {
            break;
        }
        coarse = fine;
    }
    Ok(rows)
}

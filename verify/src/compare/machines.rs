//! Motions without impacts: of every scene without clearance, and of one with every other element.

use super::classes::{self, KINDS};
use super::scenes;
use crate::check::Agreement;
use crate::trajectory::{ComparisonPlan, tolerances};
use looselink::scene::Analysis;
use miette::Result;

/// Steps of Looselink without clearance \[s\], each half of the one before.
const STEPS: [f64; 2] = [2e-5, 1e-5];
/// Relative tolerance of IDA for it; positions are held to 1e-3 m of that, velocities to 0.1 m/s.
const RELATIVE: f64 = 1e-10;
/// Accuracies of Looselink's error control \[m\], so tight that stability does not bound the steps, and relative tolerances of IDA.
const ACCURACIES: [f64; 2] = [1e-9, 1e-10];
const TOLERANCES: [f64; 2] = [1e-9, 1e-10];
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
        Agreement {
            quantity: format!("order of {}", fine.quantity),
            scene: scene.clone(),
            rust: order,
            cpp: 2.0,
            difference: (order - 2.0).abs(),
            tolerance: ORDER_BAND,
            reason: format!("Bathe's scheme, from h = {:.0e} s to the half", STEPS[0]),
        }
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

/// The first rows of a scene, by Dormand and Prince's pair with two accuracies and by IDA with two tolerances. The sides may
/// differ by what each of them differs from its coarser run, which is about ten times the error of the finer one.
pub fn first_rows(plan: &ComparisonPlan) -> Result<Vec<Agreement>> {
    let rust = |position: f64| {
        let accuracy = format!("{{position={position:e},horizon={:?}}}", plan.duration);
        let integrator = format!("integrator={{method=\"dormand_prince\",accuracy={accuracy}}}");
        let accurate = plan.clone().with("", &[&integrator, "assumptions={}"]);
        accurate.run(None, usize::MAX)
    };
    let cpp = |relative: f64| plan.cpp(&tolerances(relative));
    let (cpp, rust) = rayon::join(|| TOLERANCES.map(cpp), || ACCURACIES.map(rust));
    let ([coarse_cpp, cpp], [coarse_rust, rust]) = (cpp, rust);
    let (cpp, rust) = (cpp?, rust?);
    let floors = scenes::rounding(&plan.reference()?)?;
    let name = format!("{}, {} s", plan.name(), numbers::number(plan.duration, 3));
    let reason = "relative to the largest value of its kind; allowed: the differences of each program from its own run with ten times the tolerance";
    let compare = |a: &_, b: &_| classes::agreements(floors, &name, a, b, 0.0, reason);
    let own = compare(&coarse_rust?, &rust)
        .into_iter()
        .zip(compare(&coarse_cpp?, &cpp));
    let mut rows = compare(&rust, &cpp);
    for (row, (rust, cpp)) in rows.iter_mut().zip(own) {
        let kinds = [&rust.quantity, &cpp.quantity];
        assert_eq!(kinds, [&row.quantity; 2]);
        row.tolerance = rust.difference + cpp.difference + scenes::CHANNELS;
    }
    Ok(rows)
}

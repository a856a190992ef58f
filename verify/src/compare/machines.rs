//! Motions without impacts: of every scene without clearance, of one with every other element, and of fine meshes.

use super::{classes, plans, scenes};
use crate::check::{Agreement, Standing};
use crate::trajectory::{ComparisonPlan, Trajectory, tolerances};
use looselink::scene::Analysis;
use miette::Result;

/// Accuracies of Looselink's error control \[m\], so tight that stability does not bound the steps, and relative tolerances of IDA.
/// The tightest ones are for scenes with channels that would not count otherwise.
const LEVELS: [f64; 3] = [1e-9, 1e-10, 1e-11];

/// The scenes without clearance.
pub fn smooth() -> Result<Vec<ComparisonPlan>> {
    scenes::chosen(|scene| {
        scene.simulation.analysis == Analysis::Dynamic && scene.smallest_clearance().is_none()
    })
}

/// A scene with every element but clearance and inverse kinematics, one whose contacts stay closed, and fine meshes.
pub fn others() -> Vec<ComparisonPlan> {
    plans().motions
}

/// All rows of a plan, by Dormand and Prince's pair with growing accuracies and by IDA with falling tolerances.
pub fn motion(plan: &ComparisonPlan) -> Result<Vec<Agreement>> {
    let rust = |position: f64| {
        let accuracy = format!("{{position={position:e},horizon={:?}}}", plan.duration);
        let integrator = format!("integrator={{method=\"dormand_prince\",accuracy={accuracy}}}");
        let accurate = plan.clone().with(&[integrator, "assumptions={}".into()]);
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

//! Case 2 over up to 0.1 s: the difference falls at Bathe's order until IDA's own error.

use super::plans;
use crate::check::{Agreement, LargestDifference, largest};
use crate::trajectory::{ComparisonPlan, Trajectory, tolerances};
use miette::Result;
use rayon::prelude::*;
use serde::Deserialize;

/// What thousands of steps make of the rounding of a position of some decimetres \[m\].
const ROUNDING: f64 = 1e-13;
/// How far an order may be from the 2 of Bathe's scheme.
const ORDER_BAND: f64 = 0.2;

/// The only quantity whose difference is not relative.
const POSITION: &str = "platform position [m]";
/// What is compared: name, channels, the largest difference at the smallest step in units of the largest value (of the
/// position in m), and what determines it.
pub const QUANTITIES: [(&str, &[&str], f64, &str); 4] = [
    (POSITION, &["error.x", "error.y"], 1e-10, "m"),
    (
        "platform acceleration",
        &["platform.ax", "platform.ay"],
        1e-4,
        "of the largest",
    ),
    (
        "platform angular acceleration",
        &["platform.alpha"],
        5e-4,
        "of the largest; the rotation has the highest frequencies",
    ),
    ("B1 force", &["B1.fx", "B1.fy"], 1e-4, "of the largest"),
];

/// Runs with one number of elements.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ConvergencePlan {
    /// How reports name it.
    pub name: String,
    /// What both programs compute.
    pub plan: ComparisonPlan,
    /// Relative tolerances of IDA, the tightest last; positions are held to 1e-3 m of that, velocities to 0.1 m/s.
    relative: [f64; 2],
    /// Steps \[s\], each half of the one before.
    pub steps: Vec<f64>,
    /// The largest step that resolves the highest modes \[s\].
    resolving: f64,
}

/// All runs with one number of elements.
#[derive(Debug)]
pub struct Convergence {
    pub plan: ConvergencePlan,
    /// One for each quantity.
    pub curves: Vec<StepDifferences>,
}

/// A quantity over all runs.
#[derive(Debug)]
pub struct StepDifferences {
    /// Differences from the tightest run of IDA, one for each step.
    pub by_step: Vec<f64>,
    /// The two numbers that differ most at the smallest step.
    finest: LargestDifference,
    /// Difference of the two runs of IDA: the error of the looser one.
    own: f64,
    /// Largest value.
    pub size: f64,
}

/// Largest difference over the channels and rows.
fn distance(a: &Trajectory, b: &Trajectory, channels: &[&str]) -> LargestDifference {
    let mut worst = LargestDifference::default();
    for name in channels {
        worst.see_scaled(a.get(name), b.get(name), 1.0);
    }
    worst
}

/// One and four elements a link.
pub fn all() -> Vec<ConvergencePlan> {
    plans().convergence
}

impl ConvergencePlan {
    /// Runs both sides.
    pub fn run(self) -> Result<Convergence> {
        let ida = |relative: &f64| self.plan.cpp(&tolerances(*relative));
        let own = |step: &f64| self.plan.rust(*step);
        let (cpp, rust): (Result<Vec<_>>, Result<Vec<_>>) = rayon::join(
            || self.relative.par_iter().with_max_len(1).map(ida).collect(),
            || self.steps.par_iter().with_max_len(1).map(own).collect(),
        );
        let (cpp, rust) = (cpp?, rust?);
        let curves = QUANTITIES.iter().map(|(_, channels, ..)| {
            let each = rust.iter().map(|run| distance(run, &cpp[1], channels));
            let each: Vec<LargestDifference> = each.collect();
            let sizes = channels.iter().map(|c| largest(cpp[1].get(c)));
            StepDifferences {
                by_step: each.iter().map(|worst| worst.difference).collect(),
                finest: each[each.len() - 1],
                own: distance(&cpp[0], &cpp[1], channels).difference,
                size: sizes.fold(0.0, f64::max),
            }
        });
        Ok(Convergence {
            curves: curves.collect(),
            plan: self,
        })
    }
}

impl Convergence {
    /// The rows.
    pub fn agreements(&self) -> Vec<Agreement> {
        let plan = &self.plan;
        let scene = format!("case2, {}, {} s", plan.name, plan.plan.duration);
        let mut rows = Vec::new();
        for ((name, _, allowed, measure), curve) in QUANTITIES.into_iter().zip(&self.curves) {
            let (first, floor, unit) = match name {
                POSITION => (plan.steps[0], ROUNDING, 1.0),
                _ => (plan.resolving, 0.0, curve.size),
            };
            // steps that resolve the motion, while the difference stands above twice the error of the looser run of IDA
            let pairs = plan.steps.iter().zip(curve.by_step.windows(2));
            let above =
                pairs.filter(|(h, d)| **h <= first * 1.001 && d[1] > 2.0 * curve.own + floor);
            let orders = above.map(|(h, d)| (*h, (d[0] / d[1]).log2()));
            let mut orders: Vec<(f64, f64)> = orders.collect();
            if orders.is_empty() {
                // without one there is nothing to show: a row that fails
                orders.push((first, f64::NAN));
            }
            rows.extend(orders.into_iter().map(|(h, order)| {
                let quantity = format!("order of the difference in {name}");
                let reason = format!("Bathe's scheme is of order 2; from h = {h:e} s to the half");
                let mut worst = LargestDifference::default();
                worst.see(order, 2.0, 1.0);
                worst.row(&quantity, &scene, ORDER_BAND, &reason)
            }));
            let step = numbers::number(plan.steps[plan.steps.len() - 1], 3);
            let quantity = format!("{name}, h = {step} s");
            let reason = format!("{measure}; the error of Bathe's scheme at this step");
            let mut finest = curve.finest;
            finest.difference /= unit;
            rows.push(finest.row(&quantity, &scene, allowed, &reason));
        }
        rows
    }
}

//! Case 2 over up to 0.1 s: the difference falls at Bathe's order until IDA's own error.

use crate::check::{Agreement, LargestDifference, largest};
use crate::trajectory::{ComparisonPlan, Trajectory, tolerances};
use miette::Result;
use rayon::prelude::*;

/// Time between rows \[s\].
const INTERVAL: f64 = 1e-3;
/// What thousands of steps make of the rounding of a position of some decimetres \[m\].
const ROUNDING: f64 = 1e-13;
/// How far an order may be from the 2 of Bathe's scheme.
const ORDER_BAND: f64 = 0.2;

/// What is compared: name, channels, the largest difference at the smallest step in units of the largest value (of the
/// position in m), and what determines it.
pub const QUANTITIES: [(&str, &[&str], f64, &str); 4] = [
    ("platform position [m]", &["error.x", "error.y"], 1e-10, "m"),
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

/// All runs with one number of elements.
#[derive(Debug)]
pub struct Convergence {
    /// Elements a link.
    pub elements: usize,
    /// Relative tolerances of IDA, the tightest last; positions are held to 1e-3 m of that, velocities to 0.1 m/s.
    pub relative: [f64; 2],
    /// Steps \[s\], each half of the one before.
    pub steps: Vec<f64>,
    /// The largest step that resolves the highest modes \[s\]: from here on the order of accelerations and forces is that
    /// of the scheme; positions hardly feel those modes.
    resolving: f64,
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
    pub own: f64,
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

/// Simulated time \[s\]. Four elements need eight times as many steps, so half the time has to do.
fn duration(elements: usize) -> f64 {
    if elements == 1 { 0.1 } else { 0.05 }
}

/// Runs both sides with 1 or 4 elements per link.
pub fn convergence(elements: usize) -> Result<Convergence> {
    let mut plan = ComparisonPlan::new("3rrr/case2", duration(elements), INTERVAL);
    let links = (1..=3).map(|link| format!("bodies.link{link}.elements={elements}"));
    plan.overrides = links.collect();
    // the highest mode of four elements is some eight times as fast, and costs IDA as many steps
    let (first, count, resolving, relative) = match elements {
        1 => (2e-6, 5, 1e-6, [1e-11, 1e-12]),
        _ => (1e-6, 6, 1.25e-7, [1e-10, 1e-11]),
    };
    let steps: Vec<f64> = (0..count).map(|k| first / f64::from(1 << k)).collect();
    let ida = |relative: &f64| plan.cpp(&tolerances(*relative));
    let (cpp, rust): (Result<Vec<_>>, Result<Vec<_>>) = rayon::join(
        || relative.par_iter().with_max_len(1).map(ida).collect(),
        || {
            let runs = steps.par_iter().with_max_len(1).map(|&h| plan.rust(h));
            runs.collect()
        },
    );
    let (cpp, rust) = (cpp?, rust?);
    let curve = |(_, channels, ..): &(&str, &[&str], f64, &str)| {
        let each: Vec<LargestDifference> = rust
            .iter()
            .map(|r| distance(r, &cpp[1], channels))
            .collect();
        let sizes = channels.iter().map(|c| largest(cpp[1].get(c)));
        StepDifferences {
            by_step: each.iter().map(|worst| worst.difference).collect(),
            finest: each[each.len() - 1],
            own: distance(&cpp[0], &cpp[1], channels).difference,
            size: sizes.fold(0.0, f64::max),
        }
    };
    Ok(Convergence {
        elements,
        relative,
        curves: QUANTITIES.iter().map(curve).collect(),
        steps,
        resolving,
    })
}

impl Convergence {
    /// How reports name it.
    pub fn name(&self) -> String {
        let plural = if self.elements == 1 { "" } else { "s" };
        format!("{} element{plural} per link", self.elements)
    }

    /// The rows.
    pub fn agreements(&self) -> Vec<Agreement> {
        let scene = format!("case2, {}, {} s", self.name(), duration(self.elements));
        let mut rows = Vec::new();
        for ((name, _, allowed, measure), curve) in QUANTITIES.into_iter().zip(&self.curves) {
            let is_position = name.contains("position");
            // steps that resolve the motion, while the difference stands above twice the error of the looser run of IDA
            let first = if is_position {
                self.steps[0]
            } else {
                self.resolving
            };
            let floor = if is_position { ROUNDING } else { 0.0 };
            let pairs = self.steps.iter().zip(curve.by_step.windows(2));
            let above =
                pairs.filter(|(h, d)| **h <= first * 1.001 && d[1] > 2.0 * curve.own + floor);
            let mut orders: Vec<(f64, f64)> =
                above.map(|(h, d)| (*h, (d[0] / d[1]).log2())).collect();
            if orders.is_empty() {
                // without one there is nothing to show: a row that fails
                orders.push((first, f64::NAN));
            }
            rows.extend(orders.into_iter().map(|(h, order)| {
                LargestDifference::of(order, 2.0, 1.0).row(
                    &format!("order of the difference in {name}"),
                    &scene,
                    ORDER_BAND,
                    &format!("Bathe's scheme is of order 2; from h = {h:e} s to the half"),
                )
            }));
            let step = numbers::number(self.steps[self.steps.len() - 1], 3);
            let unit = if is_position { 1.0 } else { curve.size };
            rows.push(Agreement {
                difference: curve.finest.difference / unit,
                ..curve.finest.row(
                    &format!("{name}, h = {step} s"),
                    &scene,
                    allowed,
                    &format!("{measure}; the error of Bathe's scheme at this step"),
                )
            });
        }
        rows
    }
}

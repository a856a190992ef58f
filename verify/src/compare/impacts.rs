//! The first impacts one by one: of cases 3 and 4 up to the chaos horizon, and of mechanisms with one loose joint.

use super::classes::{self, NO_ROUNDING};
use super::plans;
use crate::check::{Agreement, LargestDifference};
use crate::reference::LsTolerances;
use crate::trajectory::{ComparisonPlan, tolerances};
use miette::Result;
use numbers::number;
use serde::Deserialize;

/// A scene with the number of impacts that are compared, and Looselink's step.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ImpactSeries {
    pub plan: ComparisonPlan,
    pub impacts: usize,
    /// Step of Looselink \[s\].
    pub step: f64,
    /// Relative tolerance of IDA; positions are held to 1e-3 m of that.
    pub relative: f64,
    /// What IDA holds velocities to, in units of the relative tolerance \[m/s\].
    pub velocity: f64,
    /// Relative differences that are allowed: of instants, and of everything else.
    pub allowed: [f64; 2],
}

/// Everything that is compared impact by impact.
pub fn all() -> Vec<ImpactSeries> {
    plans().impacts
}

impl ImpactSeries {
    /// The rows.
    pub fn agreements(&self) -> Result<Vec<Agreement>> {
        let velocity = self.velocity * self.relative;
        let tolerances = LsTolerances {
            velocity,
            ..tolerances(self.relative)
        };
        let (rust, cpp) = rayon::join(
            || self.plan.run(Some(self.step), self.impacts),
            || self.plan.cpp_until(&tolerances, self.impacts),
        );
        let (rust, cpp) = (&rust?, &cpp?);
        let pairs = rust.impacts.iter().zip(&cpp.impacts).take(self.impacts);
        let matching = pairs.clone().filter(|(r, c)| r.joint == c.joint).count();
        let [mut joints, mut instant, mut velocity, mut first] = [LargestDifference::default(); 4];
        for (i, (r, c)) in pairs.enumerate() {
            instant.see(r.t, c.t, c.t);
            velocity.see(r.velocity, c.velocity, c.velocity);
            if i == 0 {
                first = velocity;
            }
        }
        joints.see(matching as f64, self.impacts as f64, 1.0);

        let (step, tolerance) = (number(self.step, 3), number(self.relative, 1));
        let how = format!("h = {step} s, IDA relative {tolerance}");
        let relative = format!("relative; {how}");
        let early = format!("relative; no impact has amplified the difference yet; {how}");
        let missing = "number of impacts that are missing or occur in another joint";
        let [instants, others] = self.allowed;
        let quantities = [
            (joints, "joints in the order of their impacts", 0.0, missing),
            (instant, "instants of the impacts [s]", instants, &relative),
            (velocity, "impact velocities [m/s]", others, &relative),
            (first, "velocity of the first impact [m/s]", 1e-8, &early),
        ];
        let scene = format!("{}, first {} impacts", self.plan.name(), self.impacts);
        let rows = quantities
            .map(|(worst, quantity, allowed, reason)| worst.row(quantity, &scene, allowed, reason));
        let reason = format!("relative to the largest value of its kind; {how}");
        let kinds = classes::agreements(NO_ROUNDING, &scene, [rust, cpp], others, &reason);
        Ok([rows.to_vec(), kinds].concat())
    }
}

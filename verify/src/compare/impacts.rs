//! The first impacts one by one: of cases 3 and 4 up to the chaos horizon, and of mechanisms with one loose joint.

use super::classes::{self, KINDS};
use crate::check::{Agreement, LargestDifference};
use crate::reference::LsTolerances;
use crate::trajectory::{ComparedImpact, ComparisonPlan, Trajectory, tolerances};
use miette::Result;

/// Time between rows \[s\].
const INTERVAL: f64 = 1e-4;

/// A scene with the number of impacts that are compared, and Looselink's step.
#[derive(Debug, Clone)]
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
    // every impact amplifies differences: some thousandfold over all those of the six joints
    let joints = |plan: ComparisonPlan, impacts, step| ImpactSeries {
        plan,
        impacts,
        step,
        relative: 1e-12,
        velocity: 0.1,
        allowed: [1e-6, 1e-4],
    };
    let one = |plan: ComparisonPlan, impacts, step, relative| ImpactSeries {
        plan,
        impacts,
        step,
        relative,
        velocity: 1.0,
        allowed: [1e-7, 1e-6],
    };
    let plan = |scene| ComparisonPlan::new(scene, 0.02, INTERVAL);
    let hanging = ComparisonPlan::new("frame-with-hanging-body", 0.02, 1e-3);
    vec![
        joints(plan("3rrr/case3"), 15, 5e-8),
        // the seventh impact follows the sixth after 60 µs at 3 mm/s and needs the small step
        joints(plan("3rrr/case4"), 8, 1.25e-8),
        joints(plan("3rrr/case4-friction"), 8, 1.25e-8),
        joints(plan("3rrr/case3").with_friction(), 15, 5e-8),
        one(plan("slider-crank/loose"), 4, 1e-8, 1e-12),
        one(hanging, 3, 2.5e-8, 1e-11),
    ]
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
        Ok(self.rows(&rust?, &cpp?))
    }

    /// The rows of two runs.
    fn rows(&self, rust: &Trajectory, cpp: &Trajectory) -> Vec<Agreement> {
        let scene = format!("{}, first {} impacts", self.plan.name(), self.impacts);
        let [mut instant, mut velocity, mut first, mut angle, mut depth] =
            [LargestDifference::default(); 5];
        let mut mismatches = 0_u32;
        for i in 0..self.impacts {
            let (Some(r), Some(c)) = (rust.impacts.get(i), cpp.impacts.get(i)) else {
                mismatches += 1;
                continue;
            };
            mismatches += u32::from(r.joint != c.joint);
            instant.see(r.t, c.t, c.t);
            velocity.see(r.velocity, c.velocity, c.velocity);
            if i == 0 {
                first = velocity;
            }
            if let Some((r, c)) = r.course.zip(c.course) {
                angle.see(r[0], c[0], 1.0);
                depth.see(r[1], c[1], c[1]);
            }
        }
        let how = format!(
            "h = {} s, IDA relative {}",
            numbers::number(self.step, 3),
            numbers::number(self.relative, 1)
        );
        let relative = format!("relative; {how}");
        let [instants, others] = self.allowed;
        let last = |impacts: &[ComparedImpact]| impacts.len().min(self.impacts) as f64;
        let mut rows = vec![
            LargestDifference {
                rust: last(&rust.impacts),
                cpp: last(&cpp.impacts),
                difference: f64::from(mismatches),
                size: self.impacts as f64,
            }
            .row(
                "joints in the order of their impacts",
                &scene,
                0.0,
                "number of impacts that are missing or occur in another joint",
            ),
            instant.row("instants of the impacts [s]", &scene, instants, &relative),
            velocity.row("impact velocities [m/s]", &scene, others, &relative),
            angle.row(
                "directions of the eccentricity at the impacts [rad]",
                &scene,
                others,
                &format!("rad; {how}"),
            ),
            depth.row("deepest penetrations [m]", &scene, others, &relative),
            first.row(
                "velocity of the first impact [m/s]",
                &scene,
                1e-8,
                &format!("relative; no impact has amplified the difference yet; {how}"),
            ),
        ];
        let reason = format!("relative to the largest value of its kind; {how}");
        rows.extend(classes::agreements(
            [0.0; KINDS],
            &scene,
            rust,
            cpp,
            others,
            &reason,
        ));
        rows
    }
}

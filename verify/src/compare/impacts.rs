//! Cases 3 and 4 up to the chaos horizon: the first impacts one by one.

use super::classes;
use crate::check::{Agreement, Worst};
use crate::trajectory::{Impact, Plan, Trajectory, tolerances};
use miette::Result;

/// Time between rows \[s\].
const INTERVAL: f64 = 1e-4;

/// A scene with the number of impacts that are compared, and Looselink's step.
#[derive(Debug, Clone)]
pub struct Series {
    pub plan: Plan,
    pub impacts: usize,
    /// Step of Looselink \[s\].
    pub step: f64,
    /// Relative tolerance of IDA; positions are held to 1e-3 m of that, velocities to 0.1 m/s.
    pub relative: f64,
}

/// Everything that is compared impact by impact.
pub fn all() -> Vec<Series> {
    let series = |plan: Plan, impacts, step| Series {
        plan,
        impacts,
        step,
        relative: 1e-12,
    };
    let plan = |scene| Plan::new(scene, 0.02, INTERVAL);
    vec![
        series(plan("3rrr/case3"), 15, 5e-8),
        // the seventh impact follows the sixth after 60 µs at 3 mm/s and needs the small step
        series(plan("3rrr/case4"), 8, 1.25e-8),
        series(plan("3rrr/case4-friction"), 8, 1.25e-8),
        series(plan("3rrr/case3").with_friction(), 15, 5e-8),
    ]
}

impl Series {
    /// Looselink's trajectory to the last of the impacts.
    ///
    /// # Errors
    /// A run that fails.
    pub fn rust(&self) -> Result<Trajectory> {
        self.plan.rust_until(self.step, self.impacts)
    }

    /// The reference's trajectory to the last of the impacts.
    ///
    /// # Errors
    /// A run that fails.
    pub fn cpp(&self) -> Result<Trajectory> {
        let (position, velocity) = (1e-3 * self.relative, 0.1 * self.relative);
        let tolerances = tolerances(self.relative, position, velocity);
        self.plan.cpp_until(&tolerances, self.impacts)
    }

    /// The rows.
    ///
    /// # Errors
    /// A run that fails.
    pub fn agreements(&self) -> Result<Vec<Agreement>> {
        let (rust, cpp) = rayon::join(|| self.rust(), || self.cpp());
        Ok(self.rows(&rust?, &cpp?))
    }

    /// The rows of two runs.
    pub fn rows(&self, rust: &Trajectory, cpp: &Trajectory) -> Vec<Agreement> {
        let scene = format!("{}, first {} impacts", self.plan.name(), self.impacts);
        let [mut instant, mut velocity, mut position, mut first] = [Worst::default(); 4];
        let mut mismatches = 0;
        for i in 0..self.impacts {
            let (Some(r), Some(c)) = (rust.impacts.get(i), cpp.impacts.get(i)) else {
                mismatches += 1;
                continue;
            };
            mismatches += usize::from(r.joint != c.joint);
            instant.see(r.t, c.t, 1.0);
            velocity.see(r.velocity, c.velocity, c.velocity);
            if i == 0 {
                first.see(r.velocity, c.velocity, c.velocity);
            }
        }
        for channel in ["platform.x", "platform.y"] {
            let rows = rust.get(channel).iter().zip(cpp.get(channel));
            rows.for_each(|(r, c)| position.see(*r, *c, 1.0));
        }
        let how = format!(
            "h = {} s, IDA relative {}",
            plot::number(self.step, 3),
            plot::number(self.relative, 1)
        );
        let last = |impacts: &[Impact]| impacts.len().min(self.impacts) as f64;
        let mut rows = vec![
            Agreement {
                quantity: "joints in the order of their impacts".into(),
                scene: scene.clone(),
                rust: last(&rust.impacts),
                cpp: last(&cpp.impacts),
                difference: f64::from(u32::try_from(mismatches).unwrap_or(u32::MAX)),
                tolerance: 0.0,
                reason: "number of impacts that are missing or of another joint".into(),
            },
            instant.row("instants of the impacts [s]", &scene, 1e-8, &how),
            velocity.row(
                "impact velocities [m/s]",
                &scene,
                1e-4,
                &format!("relative; {how}"),
            ),
            position.row("platform position up to the last impact [m]", &scene, 1e-8, &how),
            first.row(
                "velocity of the first impact [m/s]",
                &scene,
                1e-8,
                &format!("relative; the motion is smooth until then, so that the error is rounding; {how}"),
            ),
        ];
        let reason = format!("of the largest of its kind; {how}");
        rows.extend(classes::agreements(&scene, rust, cpp, 1e-4, &reason));
        rows
    }
}

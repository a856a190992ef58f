//! The runs behind Figs. 5 to 9 and the reproduction report.

use crate::kinematics::Geometry;
use crate::runs::{Plan, Recording, run_all};
use looselink::scene::{BodyKind, LinkModel};
use miette::{Result, miette};

/// How finely and how long the mechanism is run.
#[derive(Debug, Clone, clap::Args)]
pub struct Settings {
    /// Fine step (s): cases 2, 3 and 4.
    #[arg(long, default_value_t = 1.25e-6)]
    pub fine: f64,
    /// Coarse step (s): case 2 again, and case 1.
    #[arg(long, default_value_t = 1e-4)]
    pub coarse: f64,
    /// Time between recorded rows of the fine runs (s).
    #[arg(long, default_value_t = 1e-5)]
    pub interval: f64,
    /// Step of the many-period runs of the stroboscopic sections and of the comparisons (s).
    #[arg(long, default_value_t = 2e-5)]
    pub section_step: f64,
    /// Periods of the stroboscopic sections, after those that are left out.
    #[arg(long, default_value_t = 32)]
    pub periods: u32,
    /// Periods left out at the start of the stroboscopic sections.
    #[arg(long, default_value_t = 2)]
    pub skipped: u32,
}

/// Three cycles are run and the last two are looked at, as in the paper.
pub const DURATION: f64 = 3.0;
/// First instant looked at \[s\].
pub const FROM: f64 = 1.0;
/// Relative change of one parameter between twin runs.
pub const TWIN_CHANGE: f64 = 1e-6;
/// Simulated time of twin runs \[s\].
pub const TWIN_DURATION: f64 = 1.0;
/// Step of twin runs \[s\].
pub const TWIN_STEP: f64 = 1e-5;

/// All recordings.
pub struct Campaign {
    /// How they were made.
    pub settings: Settings,
    /// Geometry of the scene of case 3.
    pub geometry: Geometry,
    /// Case 1, coarse.
    pub ideal: Recording,
    /// Case 2, fine.
    pub flexible: Recording,
    /// Case 2, coarse.
    pub flexible_coarse: Recording,
    /// Case 3, fine.
    pub loose: Recording,
    /// Case 4, fine.
    pub both: Recording,
    /// Many periods, one row a period: case 2 coarse, then cases 2, 3 and 4 at the section step.
    pub sections: [Recording; 4],
    /// Case 2 with ten times the Young's modulus, coarse.
    pub stiffer: Recording,
    /// Case 3 with half the clearance at the section step.
    pub tighter: Recording,
    /// Cases 2, 3 and 4, each twice, the second time with one parameter changed by [`TWIN_CHANGE`].
    pub twins: [(Recording, Recording); 3],
}

impl Campaign {
    /// Makes all runs.
    ///
    /// # Errors
    /// The first run that fails.
    pub fn run(settings: Settings) -> Result<Campaign> {
        let s = &settings;
        let plan = |case, step, interval, duration| Plan {
            case,
            step,
            interval,
            duration,
            overrides: Vec::new(),
        };
        let short = |case, step: f64| plan(case, step, s.interval.max(step), DURATION);
        let geometry = Geometry::of(&short(3, s.fine).scene()?)?;
        let modulus = youngs_modulus(&short(2, s.fine))?;
        let period = 1.0 / geometry.frequency;
        let long = |case, step| {
            plan(
                case,
                step,
                period,
                f64::from(s.periods + s.skipped) * period,
            )
        };
        let twin = |case| plan(case, TWIN_STEP, TWIN_STEP, TWIN_DURATION);
        let (clearance, passive) = ("contacts.pin.clearance", "materials.passive.youngs_modulus");
        let nudged = |value: f64| format!("{:e}", value * (1.0 + TWIN_CHANGE));
        // the longest first, so that no core is left with one of them at the end
        let plans = [
            long(4, s.section_step),
            long(3, s.section_step),
            long(2, s.section_step),
            short(4, s.fine),
            short(3, s.fine),
            short(2, s.fine),
            long(2, s.coarse),
            plan(3, s.section_step, s.section_step, DURATION)
                .with(clearance, format!("{:e}", 0.5 * geometry.clearance)),
            twin(2),
            twin(2).with(passive, nudged(modulus)),
            twin(3),
            twin(3).with(clearance, nudged(geometry.clearance)),
            twin(4),
            twin(4).with(clearance, nudged(geometry.clearance)),
            short(1, s.coarse),
            short(2, s.coarse),
            short(2, s.coarse).with(passive, format!("{:e}", 10.0 * modulus)),
        ];
        let done: Result<Vec<Recording>> = run_all(&plans).into_iter().collect();
        let done: [Recording; 17] = done?.try_into().map_err(|_| miette!("a run is missing"))?;
        let [
            l4,
            l3,
            l2,
            both,
            loose,
            flexible,
            l2c,
            tighter,
            t2,
            u2,
            t3,
            u3,
            t4,
            u4,
            ideal,
            flexible_coarse,
            stiffer,
        ] = done;
        let sections = [l2c, l2, l3, l4];
        let twins = [(t2, u2), (t3, u3), (t4, u4)];
        Ok(Campaign {
            settings,
            geometry,
            ideal,
            flexible,
            flexible_coarse,
            loose,
            both,
            sections,
            stiffer,
            tighter,
            twins,
        })
    }

    /// Deviation of the platform acceleration along x from the ideal one over the last two cycles \[m/s2\].
    pub fn acceleration_deviation(&self, recording: &Recording) -> Vec<f64> {
        let (t, a) = recording.between("platform.ax", FROM, DURATION);
        t.iter()
            .zip(a)
            .map(|(&t, a)| a - self.geometry.acceleration_x(t))
            .collect()
    }

    /// The bound of the error along x over the last two cycles \[m\]: sum_i |J^-1|_{xi} s_i, where the slack s_i of a
    /// leg is 2 c, the penetrations of its two joints and, of a flexible link, its length times its strain.
    pub fn bound(&self, recording: &Recording) -> Vec<f64> {
        let rows = recording.rows(FROM, DURATION);
        let column = |kind: &str, leg: usize, name: &str| {
            &recording.column(&format!("{kind}{}.{name}", leg + 1))[rows.clone()]
        };
        let penetrations: [_; 3] =
            std::array::from_fn(|i| (column("B", i, "penetration"), column("C", i, "penetration")));
        let strains: Option<[_; 3]> = (recording.plan.case == 4)
            .then(|| std::array::from_fn(|i| column("link", i, "strain")));
        let g = &self.geometry;
        recording.t[rows.clone()]
            .iter()
            .enumerate()
            .map(|(k, &t)| {
                let slack = std::array::from_fn(|i| {
                    let stretch = strains.map_or(0.0, |s| g.link * s[i][k].abs());
                    2.0 * g.clearance
                        + penetrations[i].0[k].max(0.0)
                        + penetrations[i].1[k].max(0.0)
                        + stretch
                });
                g.bound_x(t, slack)
            })
            .collect()
    }
}

/// Young's modulus of the passive links of a scene \[Pa\].
fn youngs_modulus(plan: &Plan) -> Result<f64> {
    let scene = plan.scene()?;
    match scene.body("link1").map(|b| &scene.bodies[b].kind) {
        Some(BodyKind::Link(looselink::scene::Link {
            model: LinkModel::Flexible { youngs_modulus, .. },
            ..
        })) => Ok(*youngs_modulus),
        _ => Err(miette!("{} has no flexible link1", plan.scene_name())),
    }
}

//! The runs behind Figs. 5 to 9 and the reproduction report.

use crate::kinematics::MechanismGeometry;
use crate::runs::{CaseRecording, RunPace, RunPlan, each};
use looselink::body::FlexibleLink;
use miette::{Result, miette};

/// How finely and how long the mechanism is run.
#[derive(Debug, Clone, clap::Args)]
pub struct Settings {
    /// Fine step (s): cases 2, 3 and 4.
    #[arg(long, default_value_t = 1.25e-6)]
    pub fine: f64,
    /// Coarse step (s): case 2 again, and case 1. With 100 us the integrator changes the energy of case 2 by up to 18 % of the
    /// elastic energy, with 40 us by less than 5 %.
    #[arg(long, default_value_t = 4e-5)]
    pub coarse: f64,
    /// Time between recorded rows of the fine runs (s).
    #[arg(long, default_value_t = 1e-5)]
    pub interval: f64,
    /// Step of the finer of the two many-period runs of case 2 (s); the coarser has twice the step.
    #[arg(long, default_value_t = 2e-5)]
    pub section_step: f64,
    /// Step of the run of case 2 with stiffer links (s).
    #[arg(long, default_value_t = 5e-6)]
    pub stiffer_step: f64,
    /// Periods of the stroboscopic sections, after those that are left out.
    #[arg(long, default_value_t = 32)]
    pub periods: u32,
    /// Periods left out at the start of the stroboscopic sections.
    #[arg(long, default_value_t = 2)]
    pub skipped: u32,
}

/// Three cycles are run and the last two are looked at, as in the paper.
pub const DURATION: f64 = 3.0;
/// Rows a period of the runs over many periods: the library judges the errors of a run by the ways in its rows.
pub const ROWS_A_PERIOD: u32 = 100;
/// First instant looked at \[s\].
pub const FROM: f64 = 1.0;

/// Three cycles of a case with controlled steps.
pub fn controlled(case: u32, interval: f64) -> RunPlan {
    RunPlan::new(case, RunPace::Controlled, interval, DURATION)
}

/// All recordings; their numbers are those of the table of runs.
pub struct Campaign {
    /// How they were made.
    pub settings: Settings,
    /// Geometry of the scene of case 3.
    pub geometry: MechanismGeometry,
    /// Case 1, coarse.
    pub ideal: CaseRecording,
    /// Case 2, fine.
    pub flexible: CaseRecording,
    /// Case 2, coarse.
    pub flexible_coarse: CaseRecording,
    /// Case 3, fine.
    pub loose: CaseRecording,
    /// Case 4, fine.
    pub both: CaseRecording,
    /// Case 2 with ten times the Young's modulus. With 100 us the integrator gains up to nine times the largest elastic
    /// energy, with 20 us it changes it by up to 24 %, with 5 us by 1.6 %.
    pub stiffer: CaseRecording,
    /// Many periods: case 2 with twice the step, then cases 2, 3 and 4.
    pub sections: [CaseRecording; 4],
}

impl Campaign {
    /// Makes all runs.
    ///
    /// # Errors
    /// The first run that fails.
    pub fn run(settings: Settings) -> Result<Campaign> {
        let s = &settings;
        let short = |case, step: f64| {
            let interval = s.interval.max(step);
            RunPlan::new(case, RunPace::bathe(step), interval, DURATION)
        };
        let geometry = MechanismGeometry::of(&short(3, s.fine).scene()?)?;
        let modulus = youngs_modulus(&short(2, s.fine))?;
        let period = 1.0 / geometry.frequency;
        let periods = f64::from(s.periods + s.skipped) * period;
        let rows = period / f64::from(ROWS_A_PERIOD);
        let long = |case, pace| RunPlan::new(case, pace, rows, periods);
        let passive = "materials.passive.youngs_modulus";
        let plans = [
            short(1, s.coarse),
            short(2, s.fine),
            short(2, s.coarse),
            short(3, s.fine),
            short(4, s.fine),
            short(2, s.stiffer_step).with(passive, format!("{:e}", 10.0 * modulus)),
            long(2, RunPace::bathe(2.0 * s.section_step)),
            long(2, RunPace::bathe(s.section_step)),
            long(3, RunPace::Controlled),
            long(4, RunPace::Controlled),
        ];
        // the longest first, so that no core is left with one of them at the end
        let backwards: Vec<RunPlan> = plans.iter().rev().cloned().collect();
        let done = each(&backwards, RunPlan::run).into_iter().rev();
        let done: Result<Vec<CaseRecording>> = done.collect();
        let mut done = done?;
        for (run, number) in done.iter_mut().zip(1..) {
            run.number = number;
        }
        let done: [CaseRecording; 10] = done.try_into().map_err(|_| miette!("a run is missing"))?;
        let [
            ideal,
            flexible,
            flexible_coarse,
            loose,
            both,
            stiffer,
            long2_coarse,
            long2,
            long3,
            long4,
        ] = done;
        Ok(Campaign {
            settings,
            geometry,
            ideal,
            flexible,
            flexible_coarse,
            loose,
            both,
            stiffer,
            sections: [long2_coarse, long2, long3, long4],
        })
    }

    /// All of them in the order of their numbers.
    pub fn runs(&self) -> impl Iterator<Item = &CaseRecording> {
        [
            &self.ideal,
            &self.flexible,
            &self.flexible_coarse,
            &self.loose,
            &self.both,
            &self.stiffer,
        ]
        .into_iter()
        .chain(&self.sections)
    }
}

/// Young's modulus of the passive links of a scene \[Pa\].
fn youngs_modulus(plan: &RunPlan) -> Result<f64> {
    let scene = plan.scene()?;
    let link = scene.body("link1").and_then(|b| scene.bodies[b].kind.get());
    let link: Option<&FlexibleLink> = link;
    link.map(|link| link.youngs_modulus)
        .ok_or_else(|| miette!("{} has no flexible link1", plan.scene_name()))
}

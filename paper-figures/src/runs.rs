//! Runs scenes through the library, one a thread, and keeps their channels in memory.

use looselink::scene::Scene;
use looselink::simulate::{Recording, Report, Simulation};
use miette::{IntoDiagnostic, Result, WrapErr};
use numbers::si;
use std::ops::Range;

/// Three cycles are run and the last two are looked at, as in the paper \[s\].
pub const DURATION: f64 = 3.0;
/// First instant looked at \[s\].
pub const FROM: f64 = 1.0;

/// How a run integrates.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum RunPace {
    /// A method with equal steps \[s\].
    Steps(&'static str, f64),
    /// The trapezoidal rule with steps that keep what its errors add up to within 10 ms below 1 µm and 100 nJ: the
    /// cheapest way to an energy ledger that closes to a few per cent of the contact dissipation.
    Controlled,
}

impl RunPace {
    /// The paper's method.
    pub fn bathe(step: f64) -> RunPace {
        RunPace::Steps("bathe", step)
    }

    /// Legend entry.
    pub fn label(self) -> String {
        match self {
            RunPace::Steps("bathe", step) => format!("h = {}", si(step, "s")),
            RunPace::Steps(method, step) => format!("{}, h = {}", words(method), si(step, "s")),
            RunPace::Controlled => "trapezoidal, controlled".into(),
        }
    }

    fn overrides(self) -> Vec<String> {
        match self {
            RunPace::Steps(method, step) => vec![
                format!("integrator.method={method}"),
                format!("integrator.step={step:e}"),
            ],
            RunPace::Controlled => vec![
                "integrator.method=trapezoidal".into(),
                "integrator.accuracy={ position = 1e-6, energy = 1e-7, horizon = 0.01 }".into(),
            ],
        }
    }
}

/// The name of a method in running text.
pub fn words(method: &str) -> &str {
    match method {
        "bathe" => "Bathe",
        "generalized_alpha" => "generalised-α",
        "hht" => "HHT",
        "velocity_verlet" => "velocity Verlet",
        "dormand_prince" => "Dormand-Prince",
        other => other,
    }
}

/// One run to make: a case of the paper and what is changed in its scene.
#[derive(Debug, Clone)]
pub struct RunPlan {
    /// Case 1 to 4 of Table 2.
    pub case: u32,
    /// Method and step.
    pub pace: RunPace,
    /// Time between recorded rows \[s\].
    pub interval: f64,
    /// Simulated time \[s\].
    pub duration: f64,
    /// Further overrides `path=value` of the scene.
    pub overrides: Vec<String>,
}

/// What a run left behind.
pub struct CaseRecording {
    /// The run.
    pub plan: RunPlan,
    /// The scene with the overrides applied.
    pub scene: Scene,
    /// The library's own account of the run.
    pub report: Report,
    /// Its warnings.
    pub warnings: Vec<String>,
    recording: Recording,
}

/// Channels that the figures and the tables read; a rigid link has no strain and an ideal joint no penetration.
fn channels(case: u32) -> String {
    let mut names = vec!["platform.*", "error.*", "*.force", "energy.*"];
    if case == 2 || case == 4 {
        names.push("*.strain");
    }
    if case >= 3 {
        names.extend(["*.penetration", "*.eccentricity"]);
    }
    format!("output.channels={names:?}")
}

impl RunPlan {
    /// A case as its scene has it.
    pub fn new(case: u32, pace: RunPace, interval: f64, duration: f64) -> RunPlan {
        RunPlan {
            case,
            pace,
            interval,
            duration,
            overrides: Vec::new(),
        }
    }

    /// Three cycles of a case with controlled steps.
    pub fn controlled(case: u32, interval: f64) -> RunPlan {
        RunPlan::new(case, RunPace::Controlled, interval, DURATION)
    }

    /// Path of the scene relative to the workspace.
    pub fn scene_name(&self) -> String {
        format!("scenes/3rrr/case{}.toml", self.case)
    }

    /// The same plan with one more override `path=value`.
    pub fn with(mut self, change: String) -> RunPlan {
        self.overrides.push(change);
        self
    }

    /// Reads the scene with all overrides.
    ///
    /// # Errors
    /// What the library says about the scene.
    pub fn scene(&self) -> Result<Scene> {
        let mut overrides = self.pace.overrides();
        overrides.extend([
            format!("output.interval={:e}", self.interval),
            format!("simulation.duration={:?}", self.duration),
            channels(self.case),
        ]);
        overrides.extend_from_slice(&self.overrides);
        let path = records::root().join(self.scene_name());
        Ok(Scene::load(&path, &overrides)?)
    }

    /// Runs to the end.
    ///
    /// # Errors
    /// What the library says about the scene or the run.
    pub fn run(&self) -> Result<CaseRecording> {
        let scene = self.scene()?;
        let mut simulation = Simulation::new(&scene)?;
        let mut recording = Recording::new(&simulation);
        simulation
            .run(&mut recording)
            .into_diagnostic()
            .wrap_err_with(|| self.scene_name())?;
        let report = simulation.report();
        Ok(CaseRecording {
            plan: self.clone(),
            scene,
            warnings: report.warnings(),
            report,
            recording,
        })
    }
}

impl CaseRecording {
    /// A channel.
    ///
    /// # Panics
    /// When the run has no such channel: the callers name channels that their case has.
    pub fn column(&self, name: &str) -> &[f64] {
        let column = self.recording.get(name);
        column.unwrap_or_else(|| panic!("{} records no channel {name}", self.plan.scene_name()))
    }

    /// Instants of contact onset \[s\].
    pub fn onsets(&self) -> impl Iterator<Item = f64> + Clone {
        self.recording.onsets.iter().map(|onset| onset.t)
    }

    /// Rows with from <= t <= to, a rounding error wider at both ends.
    pub fn rows(&self, from: f64, to: f64) -> Range<usize> {
        let (t, slack) = (self.column("t"), 0.01 * self.plan.interval);
        t.partition_point(|&t| t < from - slack)..t.partition_point(|&t| t <= to + slack)
    }

    /// Time and a channel between two instants.
    pub fn between(&self, name: &str, from: f64, to: f64) -> (&[f64], &[f64]) {
        let rows = self.rows(from, to);
        (&self.column("t")[rows.clone()], &self.column(name)[rows])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn number_of_threads_changes_no_bit() {
        // both chaotic cases over their first impacts, of which the least difference would grow
        let plan = |case| RunPlan::new(case, RunPace::Controlled, 1e-4, 0.02);
        let plans = [3, 4, 3, 4].map(plan);
        let bits = |plan: &RunPlan| -> Vec<u64> {
            let done = plan.run().unwrap();
            let columns = [done.column("B1.force"), done.column("error.x")].concat();
            done.onsets().chain(columns).map(f64::to_bits).collect()
        };
        let [one, three] = [1, 3].map(|threads| records::each(&plans, threads, bits));
        assert_eq!(one, three);
        // the runs are no trivial ones, and they are in their order
        assert!(one[0] != one[1] && one[0] == one[2] && one[1] == one[3]);
    }
}

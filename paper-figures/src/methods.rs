//! Explicit and implicit methods in counted work, and what they do over many cycles.

use crate::kinematics::MechanismGeometry;
use crate::measures::deviation;
use crate::runs::{CaseRecording, RunPace, RunPlan, words};
use crate::shown::mean;
use crate::signal::{peak, rms};
use crate::variants::{MOVED, STARTS, mesh, mesh_name, moved};
use crate::verdict::{CriterionVerdict, below, holds};
use crate::warned::merged;
use miette::Result;
use minijinja::{Value, context};
use numbers::{rounded, si};
use records::{Journal, threads};
use serde::{Deserialize, Serialize};
use statistics::Interval;

/// Methods that are compared, the explicit ones last. Implicit Euler, of order one, is none of the paper's.
const METHODS: [&str; 9] = [
    "bathe",
    "trapezoidal",
    "generalized_alpha",
    "hht",
    "esdirk3",
    "esdirk5",
    "dormand_prince",
    "dop853",
    "velocity_verlet",
];
/// The implicit methods of the statements about long runs.
const OF_LONG_RUNS: [&str; 4] = ["bathe", "trapezoidal", "generalized_alpha", "hht"];
/// Spectral radius at infinite frequency of generalised-alpha and HHT.
const RADIUS: f64 = 0.8;
/// Cases and elements a link in which methods are compared: the paper's meshes, and a finer one, which is stiffer.
pub const MODELS: [(u32, usize); 3] = [(2, 1), (2, 16), (4, 1)];
/// Compared over this time \[s\], which the first impacts of case 4 fall into.
pub const HORIZON: f64 = 6e-3;
/// Time between compared rows \[s\]; no step is longer.
const ROWS: f64 = 1e-4;
/// Steps, as parts of the time between rows.
const PARTS: [u32; 18] = [
    1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 48, 64, 96, 128, 192, 256, 384, 512,
];
/// Step of the reference, Dormand and Prince's pair of order 5 \[s\].
const REFERENCE: f64 = 5e-8;
/// Cases, steps \[s\], cycles and starts of the long runs; case 4 is chaotic.
const LONG: [(u32, f64, f64, usize); 3] = [
    (2, 1e-3, 34.0, 1),
    (2, 1e-4, 34.0, 1),
    (4, 1e-4, 10.0, STARTS),
];

/// One run of a comparison of methods.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct MethodWork {
    /// Case of Table 2.
    pub case: u32,
    /// Elements a link.
    pub elements: usize,
    /// Method as in the scene.
    pub method: String,
    /// Step \[s\].
    pub step: f64,
    /// Evaluations of the elastic force of an element.
    pub evaluations: u64,
    /// Largest difference of e_x from the reference \[m\]; none where the run stopped.
    pub error: Option<f64>,
    /// Largest |e_x| of the reference \[m\].
    pub size: f64,
    /// What the run warns of, or why it stopped.
    pub warnings: Vec<String>,
}

/// Runs over many cycles that differ in the start: one of case 2, an ensemble of case 4.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Long {
    /// Case of Table 2.
    pub case: u32,
    /// Method as in the scene.
    pub method: String,
    /// Step \[s\].
    pub step: f64,
    /// Cycles of a run.
    pub cycles: f64,
    /// How many there are.
    pub runs: usize,
    /// How many of them stopped.
    pub stopped: usize,
    /// Rms deviation of the acceleration in the last cycle over that in the second, of every run that did not stop.
    pub growth: Vec<f64>,
    /// What the runs warn of, or why they stopped.
    pub warnings: Vec<String>,
}

impl MethodWork {
    /// What a run of a model gave, compared with e_x of the reference.
    fn of(
        (case, elements): (u32, usize),
        method: &str,
        step: f64,
        run: Result<CaseRecording>,
        reference: &[f64],
    ) -> MethodWork {
        let (evaluations, error, warnings) = match run {
            Err(error) => (0, None, vec![format!("stopped: {error:#}")]),
            Ok(done) => {
                let pairs = done.column("error.x").iter().zip(reference);
                let apart: Vec<f64> = pairs.map(|(a, b)| a - b).collect();
                (
                    evaluations(&done),
                    Some(rounded(peak(&apart), 6)),
                    done.warnings,
                )
            }
        };
        MethodWork {
            case,
            elements,
            method: method.into(),
            step: rounded(step, 9),
            evaluations,
            error,
            size: rounded(peak(reference), 6),
            warnings,
        }
    }

    /// The run in words.
    pub fn name(&self) -> String {
        named(&model(self.case, self.elements), &self.method, self.step)
    }
}

/// A case and its mesh in words.
pub fn model(case: u32, elements: usize) -> String {
    match elements {
        1 => format!("case {case}"),
        _ => format!("case {case} with {}", mesh_name(elements)),
    }
}

fn named(model: &str, method: &str, step: f64) -> String {
    format!("{model}, {} with h = {}", words(method), si(step, "s"))
}

impl Long {
    /// The runs in words.
    pub fn name(&self) -> String {
        let name = named(&model(self.case, 1), &self.method, self.step);
        format!("{name} over {} cycles", self.cycles)
    }

    /// The runs with their name and mean growth, for templates.
    pub fn shown(&self) -> Value {
        let mean = (self.stopped == 0).then(|| mean(&self.growth));
        context! { name => self.name(), mean, ..Value::from_serialize(self) }
    }

    /// Whether the motion has not grown by more than a factor.
    pub fn stays(&self, factor: f64) -> CriterionVerdict {
        match self.growth.as_slice() {
            _ if self.stopped > 0 => CriterionVerdict::Fails,
            [one] => holds(*one <= factor),
            all => below(&[Interval::of(all)], factor),
        }
    }
}

/// Whether a method is explicit.
pub fn explicit(method: &str) -> bool {
    ["dormand_prince", "dop853", "velocity_verlet"].contains(&method)
}

fn plan(case: u32, method: &'static str, step: f64, interval: f64, duration: f64) -> RunPlan {
    let plan = RunPlan::new(case, RunPace::Steps(method, step), interval, duration);
    match method {
        "generalized_alpha" | "hht" => plan.with(format!("integrator.spectral_radius={RADIUS}")),
        _ => plan,
    }
}

/// Error and counted work of every method over a ladder of steps, in every model.
///
/// # Errors
/// When the reference fails; a run that stops is a result.
pub fn work(journal: &Journal) -> Result<Vec<MethodWork>> {
    let mut all = Vec::new();
    for (case, elements) in MODELS {
        let meshed = |method, step| {
            let plan = plan(case, method, step, ROWS, HORIZON);
            mesh(elements).into_iter().fold(plan, RunPlan::with)
        };
        let model = model(case, elements);
        let reference: Vec<f64> = journal.item(&format!("reference {model}"), || {
            let run = meshed("dormand_prince", REFERENCE).run()?;
            Ok(run.column("error.x").to_vec())
        })?;
        // velocity Verlet keeps no constraints, and case 2 has those of its ideal joints
        let methods = METHODS
            .iter()
            .filter(|m| case > 2 || **m != "velocity_verlet");
        let keys: Vec<(&'static str, u32)> = methods
            .flat_map(|m| PARTS.map(|parts| (*m, parts)))
            .collect();
        let name = |(method, parts): &(&str, u32)| format!("work {model} {method} {parts}");
        let run = |(method, parts): &(&'static str, u32)| {
            let step = ROWS / f64::from(*parts);
            let done = meshed(method, step).run();
            Ok(MethodWork::of(
                (case, elements),
                method,
                step,
                done,
                &reference,
            ))
        };
        all.extend(journal.items(&keys, threads(), name, run)?);
    }
    Ok(all)
}

/// How often the elastic force of an element was evaluated; implicit methods evaluate its tangent with it.
pub fn evaluations(recording: &CaseRecording) -> u64 {
    let effects = &recording.report.effects;
    effects.get("ancf_elastic_force").copied().unwrap_or(0)
}

/// The implicit methods over many cycles. A run that stops is a result.
///
/// # Errors
/// A journal that cannot be written.
pub fn long(g: &MechanismGeometry, journal: &Journal) -> Result<Vec<Long>> {
    let groups = OF_LONG_RUNS
        .iter()
        .flat_map(|m| LONG.map(|long| (*m, long)));
    let made = groups.map(|(method, (case, step, cycles, starts))| {
        let keys: Vec<usize> = (0..starts).collect();
        let name = |k: &usize| format!("long {case} {method} {step:e} {k}");
        let run = |k: &usize| {
            let mut plan = plan(case, method, step, step, cycles / g.frequency);
            if case > 2 {
                plan.overrides.push(moved(g, MOVED, *k));
            }
            let cycle = |done: &CaseRecording, last: f64| {
                let end = last / g.frequency;
                rms(&deviation(g, done, end - 1.0 / g.frequency, end))
            };
            Ok(match plan.run() {
                Err(error) => (None, vec![format!("stopped: {error:#}")]),
                Ok(done) => {
                    let growth = cycle(&done, cycles) / cycle(&done, 2.0);
                    (Some(rounded(growth, 9)), done.warnings)
                }
            })
        };
        let done: Vec<(Option<f64>, Vec<String>)> = journal.items(&keys, threads(), name, run)?;
        let growth: Vec<f64> = done.iter().filter_map(|(growth, _)| *growth).collect();
        Ok(Long {
            case,
            method: method.into(),
            step,
            cycles,
            runs: starts,
            stopped: starts - growth.len(),
            growth,
            warnings: match done.as_slice() {
                [(_, one)] => one.clone(),
                all => merged(all.iter().map(|(_, warnings)| warnings)),
            },
        })
    });
    made.collect()
}

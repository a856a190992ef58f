//! Cases 3 and 4 beyond the chaos horizon: what does not depend on the instant of each impact.
//!
//! Two runs part after some tens of milliseconds, whoever computes them. What is compared are means over runs whose platforms start a
//! little apart: of sizes, forces, contact and energies of one cycle. Means are compared by Welch's t-test, all of them together by
//! Holm's method: the two programs must not differ, and cases 3 and 4 must.

use crate::check::{Agreement, Standing, largest};
use crate::trajectory::{ComparisonPlan, Trajectory, tolerances};
use miette::Result;
use statistics::{FAMILY_WISE, Welch, holm};
use std::f64::consts::TAU;

/// Runs of each program in each case.
const STARTS: usize = 16;
/// Displacement of the platform between the starts \[m\]: neighbours part by a factor of e in 20 ms, so that at [`FROM`] it has grown to
/// the clearance.
const MOVED: f64 = 1e-9;
/// Time from which the motion counts \[s\]: the bouncing of the start is over.
const FROM: f64 = 0.5;
/// Time that counts \[s\]: one cycle, with some two hundred impacts. Two cycles would take the reference twice its
/// quarter of an hour.
const COUNTED: f64 = 1.0;
/// Time between rows \[s\].
const INTERVAL: f64 = 2e-5;
/// Step of Looselink \[s\], that of the scenes.
const STEP: f64 = 1.25e-6;
/// Relative tolerances of IDA in cases 3 and 4, with which it changes the energy by less than a hundredth of what contacts dissipate;
/// positions are held to 1e-3 m of that, velocities to 0.1 m/s.
const RELATIVE: [f64; 2] = [1e-9, 1e-7];

/// What is measured: name and unit.
pub const QUANTITIES: [(&str, &str); 6] = [
    ("largest |eₓ| of the platform", "m"),
    ("largest |e_y| of the platform", "m"),
    ("rms of the platform's error", "m"),
    ("mean force in B1", "N"),
    ("share of time in contact, mean of B and C", "1"),
    ("energy dissipated in contact", "J"),
];
/// Place of the share of time in contact.
pub const CONTACT: usize = 4;

/// A run of one of the programs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ChaoticRun {
    /// 3 or 4.
    pub case: u32,
    /// Whether the reference makes it.
    pub reference: bool,
    /// Number of its start.
    pub start: usize,
}

/// All runs: cases 3 and 4, each by Looselink and by the reference.
pub fn runs() -> Vec<ChaoticRun> {
    let run = |i| ChaoticRun {
        case: [3, 4][i / (2 * STARTS)],
        reference: i / STARTS % 2 == 1,
        start: i % STARTS,
    };
    (0..4 * STARTS).map(run).collect()
}

/// Name of a program.
fn program(reference: bool) -> &'static str {
    if reference { "reference" } else { "Looselink" }
}

impl ChaoticRun {
    /// In words.
    pub fn name(&self) -> String {
        let program = program(self.reference);
        format!("case {}, {program}, start {}", self.case, self.start)
    }

    /// The numbers of `QUANTITIES`.
    ///
    /// # Errors
    /// Those of the run.
    pub fn measure(&self) -> Result<Vec<f64>> {
        let (sin, cos) = (TAU * self.start as f64 / STARTS as f64).sin_cos();
        let (x, y) = (0.1 + MOVED * cos, MOVED * sin);
        // the velocity of the ideal mechanism: 1 Hz on a circle of 0.1 m
        let start = format!(
            "initial.bodies={{platform={{x={x:?},y={y:?},theta=0.0,vx=0.0,vy={:?},omega=0.0}}}}",
            TAU * 0.1
        );
        let scene = format!("3rrr/case{}", self.case);
        let plan = ComparisonPlan::new(scene, FROM + COUNTED, INTERVAL).with(&[start]);
        let run = match self.reference {
            true => plan.cpp(&tolerances(RELATIVE[usize::from(self.case == 4)]))?,
            false => plan.rust(STEP)?,
        };
        Ok(measures(&run))
    }
}

fn measures(run: &Trajectory) -> Vec<f64> {
    let first = run.get("t").partition_point(|&t| t < FROM - 0.5 * INTERVAL);
    let part = |name: &str| &run.get(name)[first..];
    let (x, y) = (part("error.x"), part("error.y"));
    let count = x.len() as f64;
    let mean = |values: &[f64]| values.iter().sum::<f64>() / count;
    let square = x.iter().zip(y).map(|(x, y)| x * x + y * y).sum::<f64>();
    let joints = ["B1", "B2", "B3", "C1", "C2", "C3"];
    let contact = joints.map(|j| mean(part(&format!("{j}.contact"))));
    let dissipated = part("energy.contact_dissipated");
    vec![
        largest(x),
        largest(y),
        (square / count).sqrt(),
        mean(part("B1.force")),
        contact.iter().sum::<f64>() / joints.len() as f64,
        dissipated[dissipated.len() - 1] - dissipated[0],
    ]
}

/// The rows: the two programs in both cases, and the two cases by both programs.
pub fn agreements(runs: &[ChaoticRun], measured: &[Vec<f64>]) -> Vec<Agreement> {
    let values = |case: u32, reference: bool, quantity: usize| -> Vec<f64> {
        let all = runs.iter().zip(measured);
        let all = all.filter(|(run, _)| (run.case, run.reference) == (case, reference));
        all.map(|(_, measured)| measured[quantity]).collect()
    };
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    let all = 2 * QUANTITIES.len();
    let mut rows = Vec::new();
    for case in [3, 4] {
        for (quantity, (name, unit)) in QUANTITIES.iter().enumerate() {
            let [rust, cpp] = [false, true].map(|reference| values(case, reference, quantity));
            let found = Welch::of(&rust, &cpp);
            let p = numbers::number(found.p, 2);
            rows.push(Agreement {
                quantity: format!("{name} [{unit}]"),
                scene: format!("case{case}, mean of one cycle"),
                rust: mean(&rust),
                cpp: mean(&cpp),
                difference: found.difference.abs(),
                // Holm's method finds a difference if and only if its first step does, at the level over the number of means
                tolerance: found.critical(FAMILY_WISE / all as f64),
                reason: format!(
                    "absolute; Welch's test of {STARTS} and {STARTS} runs, 1 % for all {all} means together (Holm); p = {p}"
                ),
                // means that scatter agree more easily
                standing: Standing::Apart,
            });
        }
    }
    for reference in [false, true] {
        let pair = |quantity: usize| [3, 4].map(|case| values(case, reference, quantity));
        let p = (0..QUANTITIES.len()).map(|quantity| {
            let [three, four] = pair(quantity);
            Welch::of(&three, &four).p
        });
        let [three, four] = pair(CONTACT).map(|values| mean(&values));
        rows.push(Agreement {
            quantity: format!("{} [1]: cases 3 and 4 differ", QUANTITIES[CONTACT].0),
            scene: program(reference).into(),
            rust: three,
            cpp: four,
            difference: holm(&p.collect::<Vec<f64>>())[CONTACT],
            tolerance: FAMILY_WISE,
            reason: "p by the same test, which has to see what flexible links change; the two means are of cases 3 and 4".into(),
            standing: Standing::Counted,
        });
    }
    rows
}

//! Errors and processor times of other codes beside ours, in the studies of the project.

use crate::accuracy::study;
use crate::benchmarks::ida;
use crate::benchmarks::settings::SettingsSweep;
use miette::{IntoDiagnostic, Result, WrapErr, miette};
use records::Journal;
use serde::{Deserialize, Serialize};
use std::path::Path;
use std::process::Command;
use studies::machine::median;
use studies::precision::{Effort, StudyOutcome, StudyPace, Times, reached};
use verify::ida_of_system::IdaSettings;

/// Studies that all codes run.
pub const STUDIES: [&str; 6] = [
    "case2",
    "case2-16elements",
    "case2-64elements",
    "case3",
    "case4",
    "slider-crank",
];
/// A virtual environment that has Exudyn.
const ENVIRONMENT: &str = "target/tools/exudyn";
const EXUDYN: &str = "exudyn==1.13.6";

/// Whose curves they are.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Code {
    /// This program.
    Looselink,
    /// IDA on our residual and tangent.
    IdaOnOurs,
    /// Exudyn.
    Exudyn,
}

impl Code {
    /// All, in the order of legends.
    pub const ALL: [Code; 3] = [Code::Looselink, Code::Exudyn, Code::IdaOnOurs];

    /// In a legend.
    pub fn name(self) -> &'static str {
        match self {
            Code::Looselink => "Looselink",
            Code::IdaOnOurs => "IDA on Looselink's equations",
            Code::Exudyn => "Exudyn 1.13.6",
        }
    }
}

/// The curve of a method.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct RivalCurve {
    /// Study.
    pub study: String,
    /// Code.
    pub code: Code,
    /// Method.
    pub method: String,
    /// Settings of IDA.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub settings: Option<IdaSettings>,
    /// Error of position \[m\] and median processor time \[s\], coarse steps first.
    pub points: Vec<[f64; 2]>,
    /// Difference of the two runs of the reference, below which errors have no meaning \[m\].
    pub floor: f64,
}

/// The converged solution of another code, from which its errors are measured in a study.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct ConvergedSolution {
    /// Study.
    pub study: String,
    /// Its method and step or tolerance.
    pub method: String,
    /// Largest difference of a position from Looselink's converged solution \[m\], from which the errors of all others are measured.
    pub difference_from_looselink: Option<f64>,
}

/// What is measured.
#[derive(Debug, Default, Serialize, Deserialize)]
pub struct Rivals {
    /// Curves of ours and of other codes.
    pub curves: Vec<RivalCurve>,
    /// What the errors of Exudyn are measured from.
    pub solutions: Vec<ConvergedSolution>,
    /// How the settings of IDA were found.
    pub sweeps: Vec<SettingsSweep>,
}

/// Whether a code has a converged solution that can tell this error.
pub fn is_known(curves: &[RivalCurve], study: &str, code: Code, error: f64) -> bool {
    let mut own = curves.iter().filter(|c| c.study == study && c.code == code);
    own.any(|curve| curve.floor <= error)
}

/// The method of a code that comes below an error first, to stay there, and its time \[s\]; never where the error is below the floor.
pub fn best<'a>(
    curves: &'a [RivalCurve],
    study: &str,
    code: Code,
    error: f64,
    times: Times,
) -> Option<(&'a str, f64)> {
    let own = curves.iter().filter(|c| c.study == study && c.code == code);
    let known = own.filter(|curve| curve.floor <= error);
    known
        .filter_map(|c| Some((&*c.method, reached(&c.points, error, times)?.seconds)))
        .min_by(|a, b| a.1.total_cmp(&b.1))
}

/// Runs all codes in all studies.
///
/// # Errors
/// When one of them cannot run.
pub fn measure(root: &Path, program: &Path, repeats: usize, journal: &Journal) -> Result<Rivals> {
    let mut all = Rivals::default();
    for name in STUDIES {
        let found = journal.item(&format!("rivals in {name}"), || {
            let (python, mut rivals) = (environment(root)?, Rivals::default());
            let study = study(root, name)?;
            let effort = Effort {
                repeats,
                smoke: false,
            };
            let outcome = StudyOutcome::run(&study, effort, &mut |_| ()).into_diagnostic()?;
            rivals.own(name, &outcome);
            ida::on_ours(&mut rivals, name, &study, repeats)?;
            rivals.exudyn(root, &python, program, name, repeats)?;
            Ok(rivals)
        })?;
        all.curves.extend(found.curves);
        all.solutions.extend(found.solutions);
        all.sweeps.extend(found.sweeps);
    }
    Ok(all)
}

impl Rivals {
    /// All curves, IDA with every setting that was tried: each error has the fastest.
    pub fn all_curves(&self) -> Vec<RivalCurve> {
        let tried = self.sweeps.iter().flat_map(|sweep| {
            let mut curves = self.curves.iter();
            let best = curves.find(|c| c.study == sweep.study && c.method == sweep.curve);
            sweep.tried.iter().filter_map(move |tried| {
                let points = tried.trials.iter().map(|run| [run.error, run.seconds]);
                Some(RivalCurve {
                    settings: Some(tried.settings),
                    points: points.collect(),
                    ..best?.clone()
                })
            })
        });
        self.curves.iter().cloned().chain(tried).collect()
    }

    /// Our curves.
    fn own(&mut self, name: &str, outcome: &StudyOutcome) {
        for curve in outcome.curves() {
            let runs = outcome.runs.iter().zip(&outcome.timings);
            let own = runs.filter(|(run, _)| run.curve == curve);
            let points = own.filter_map(|(run, timing)| {
                let error = run.result.as_ref().ok()?.errors.position;
                Some([error, timing.as_ref()?.median])
            });
            self.curves.push(RivalCurve {
                study: name.to_owned(),
                code: Code::Looselink,
                method: curve.to_owned(),
                settings: None,
                points: points.collect(),
                floor: outcome.reference.floor.position,
            });
        }
    }

    /// The curves of Exudyn, against its own reference.
    fn exudyn(
        &mut self,
        root: &Path,
        python: &Path,
        program: &Path,
        name: &str,
        repeats: usize,
    ) -> Result<()> {
        let folder = tempfile::tempdir().into_diagnostic()?;
        let out = folder.path().join("exudyn.json");
        let output = Command::new(python)
            .arg(root.join("benches/peers/exudyn/measure.py"))
            .args(["--only", name, "--repeats", &repeats.to_string(), "--out"])
            .arg(&out)
            .arg("--looselink")
            .arg(program)
            .output()
            .into_diagnostic()?;
        if !output.status.success() {
            let said = String::from_utf8_lossy(&output.stderr);
            return Err(miette!("Exudyn failed in {name}:\n{said}"));
        }
        let text = std::fs::read_to_string(&out).into_diagnostic()?;
        let result: PeerResult = serde_json::from_str(&text).into_diagnostic()?;
        for model in result.models {
            let distance = model.difference_from_looselink.unwrap_or(0.0);
            self.solutions.push(ConvergedSolution {
                study: name.to_owned(),
                method: model.reference.name(),
                difference_from_looselink: model.difference_from_looselink,
            });
            for PeerCurve { solver, points } in model.curves {
                let timed = points.iter().filter(|point| !point.seconds.is_empty());
                let points = timed.filter_map(|p| Some([p.error?, median(&p.seconds)]));
                self.curves.push(RivalCurve {
                    study: name.to_owned(),
                    code: Code::Exudyn,
                    method: solver,
                    settings: None,
                    points: points.collect(),
                    // below the distance of its solution from ours the two are not of one problem
                    floor: distance.max(model.reference.floor),
                });
            }
        }
        Ok(())
    }
}

/// What `measure.py` writes.
#[derive(Deserialize)]
struct PeerResult {
    models: Vec<PeerModel>,
}

#[derive(Deserialize)]
struct PeerModel {
    reference: PeerReference,
    difference_from_looselink: Option<f64>,
    curves: Vec<PeerCurve>,
}

#[derive(Deserialize)]
struct PeerReference {
    method: String,
    step: Option<f64>,
    tolerance: Option<f64>,
    floor: f64,
}

impl PeerReference {
    /// Method and step or tolerance.
    fn name(&self) -> String {
        let step = self.step.map(StudyPace::Step);
        let pace = step.or(self.tolerance.map(StudyPace::Tolerance));
        let pace = pace.map_or(String::new(), |pace| format!(", {pace}"));
        format!("{}{pace}", self.method)
    }
}

#[derive(Deserialize)]
struct PeerCurve {
    solver: String,
    points: Vec<PeerPoint>,
}

#[derive(Deserialize)]
struct PeerPoint {
    error: Option<f64>,
    seconds: Vec<f64>,
}

/// The Python that has Exudyn, installed where it is not there yet.
fn environment(root: &Path) -> Result<std::path::PathBuf> {
    let folder = root.join(ENVIRONMENT);
    let python = folder.join("bin/python");
    let run = |command: &mut Command| -> Result<()> {
        let status = command.status().into_diagnostic()?;
        match status.success() {
            true => Ok(()),
            false => Err(miette!(
                "{EXUDYN} cannot be installed in {}",
                folder.display()
            )),
        }
    };
    if !python.exists() {
        run(Command::new("python3").args(["-m", "venv"]).arg(&folder))
            .wrap_err("Python 3.11 with the module venv is needed")?;
    }
    run(Command::new(&python).args(["-m", "pip", "install", "--quiet", EXUDYN, "numpy"]))?;
    Ok(python)
}

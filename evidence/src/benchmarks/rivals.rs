//! Errors and processor times of other codes beside ours, in the studies of the project.

use crate::accuracy::settings::{ORDERS, RATIOS, SettingsSweep, TOLERANCES, Trial};
use crate::accuracy::{ida, study};
use looselink::model::Model;
use looselink::scene::Scene;
use looselink::simulate::{Control, Observer, Progress, Simulation};
use looselink::system::State;
use miette::{IntoDiagnostic, Result, WrapErr, miette};
use records::Journal;
use serde::{Deserialize, Serialize};
use std::path::Path;
use std::process::Command;
use studies::machine::median;
use studies::precision::{Effort, Study, StudyOutcome, StudyPace, Times, reached};
use verify::ida_of_system::{self, IdaSettings, LinearSolver, NEWTON};

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

/// Unknowns and multipliers up to which IDA is also tried with a dense matrix: the time of its factorisation grows with the third
/// power of their number, that of KLU about in proportion.
const DENSE: usize = 200;

/// Whose curves they are.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Code {
    /// This program.
    Looselink,
    /// The second implementation: IDA on full coordinates.
    Ida,
    /// IDA on our residual and tangent.
    IdaOnOurs,
    /// Exudyn.
    Exudyn,
}

impl Code {
    /// All, in the order of legends.
    pub const ALL: [Code; 4] = [Code::Looselink, Code::Exudyn, Code::IdaOnOurs, Code::Ida];

    /// In a legend.
    pub fn name(self) -> &'static str {
        match self {
            Code::Looselink => "Looselink",
            Code::Ida => "IDA (second implementation)",
            Code::IdaOnOurs => "IDA on Looselink's residual and tangent",
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

/// The converged solution from which the errors of a code are measured in a study.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct ConvergedSolution {
    /// Study.
    pub study: String,
    /// Whose errors.
    pub code: Code,
    /// Whose solution.
    pub of: Code,
    /// Its method and step or tolerance.
    pub method: String,
    /// Largest difference of a position from Looselink's converged solution \[m\], where it is another one.
    pub difference_from_looselink: Option<f64>,
}

/// What is measured.
#[derive(Debug, Default, Serialize, Deserialize)]
pub struct Rivals {
    /// Curves of ours and of other codes.
    pub curves: Vec<RivalCurve>,
    /// What their errors are measured from.
    pub solutions: Vec<ConvergedSolution>,
    /// How the settings of IDA were found.
    pub sweeps: Vec<SettingsSweep>,
}

/// The time that an error takes.
#[derive(Debug, Clone, PartialEq)]
pub struct ErrorTime {
    /// Method.
    pub method: String,
    /// Processor time \[s\].
    pub seconds: f64,
    /// True where it is on the line between two runs.
    pub is_interpolated: bool,
}

impl RivalCurve {
    /// When it comes below an error to stay there; never where the error is below the floor.
    pub fn time_at(&self, error: f64, times: Times) -> Option<ErrorTime> {
        let found = reached(&self.points, error, times).filter(|_| self.floor <= error)?;
        Some(ErrorTime {
            method: self.method.clone(),
            seconds: found.seconds,
            is_interpolated: found.is_interpolated(),
        })
    }
}

/// The method of a code that comes below an error first.
pub fn best(
    curves: &[RivalCurve],
    study: &str,
    code: Code,
    error: f64,
    times: Times,
) -> Option<ErrorTime> {
    let own = curves.iter().filter(|c| c.study == study && c.code == code);
    own.filter_map(|curve| curve.time_at(error, times))
        .min_by(|a, b| a.seconds.total_cmp(&b.seconds))
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
            rivals.own(root, name, repeats)?;
            rivals.ida_on_ours(root, name, repeats)?;
            rivals.exudyn(root, &python, program, name, repeats)?;
            Ok(rivals)
        })?;
        all.curves.extend(found.curves);
        all.solutions.extend(found.solutions);
        all.sweeps.extend(found.sweeps);
    }
    Ok(all)
}

/// The unknown coordinates at every row.
#[derive(Default)]
struct CoordinateRows(Vec<Vec<f64>>);

impl Observer for CoordinateRows {
    fn row(&mut self, _: &[f64]) -> std::io::Result<()> {
        Ok(())
    }

    fn state(&mut self, model: &Model, at: &State) -> std::io::Result<()> {
        self.0.push(at.q[..model.shape().unknowns].to_vec());
        Ok(())
    }

    fn step(&mut self, _: &Progress) -> std::io::Result<Control> {
        Ok(Control::Continue)
    }
}

/// Our two reference runs of a study, to compare other solutions of our equations with them.
struct OurReference {
    scene: Scene,
    /// Indices of the studied positions among the unknowns.
    studied: Vec<usize>,
    coarse: Vec<Vec<f64>>,
    fine: Vec<Vec<f64>>,
}

impl OurReference {
    fn new(study: &Study) -> Result<OurReference> {
        let [coarse, fine] = study.reference.paces().map(|pace| -> Result<_> {
            let scene = study.scene(&study.reference.set, study.reference.elements, pace);
            let scene = scene.map_err(|e| miette!("{e}"))?;
            let mut simulation = Simulation::new(&scene).map_err(|e| miette!("{e}"))?;
            let mut rows = CoordinateRows::default();
            simulation.run(&mut rows).map_err(|e| miette!("{e}"))?;
            Ok((rows.0, scene, simulation.model().unknown_names().to_vec()))
        });
        let ((coarse, ..), (fine, scene, names)) = (coarse?, fine?);
        let studied = study.position.iter().map(|channel| {
            // the path of the platform is known: its error is that of its position
            let coordinate = channel.replace("error.", "platform.");
            let place = names.iter().position(|name| *name == coordinate);
            place.ok_or_else(|| miette!("{}: {channel} is no unknown coordinate", study.title))
        });
        Ok(OurReference {
            studied: studied.collect::<Result<_>>()?,
            scene,
            coarse,
            fine,
        })
    }

    /// Largest difference of a studied position from the fine run \[m\].
    fn distance(&self, rows: &[Vec<f64>]) -> f64 {
        let pairs = rows.iter().zip(&self.fine);
        let errors = pairs.flat_map(|(a, b)| self.studied.iter().map(|&i| (a[i] - b[i]).abs()));
        errors.fold(0.0, f64::max)
    }

    /// A run of IDA.
    fn trial(&self, settings: IdaSettings, tolerance: f64) -> Result<Trial, String> {
        let run = ida_of_system::integrate(&self.scene, settings, tolerance)?;
        let count = |n: i64| u64::try_from(n).unwrap_or(0);
        Ok(Trial {
            tolerance,
            error: self.distance(&run.rows),
            seconds: run.seconds,
            residuals: count(run.counts.residuals),
            jacobians: count(run.counts.jacobians),
        })
    }
}

impl Rivals {
    /// Our curves and those of the second implementation, against our reference.
    fn own(&mut self, root: &Path, name: &str, repeats: usize) -> Result<()> {
        let study = study(root, name)?;
        let effort = Effort {
            repeats,
            smoke: false,
        };
        let outcome = StudyOutcome::run(&study, effort, &mut |_| ());
        let mut outcome = outcome.map_err(|e| miette!("{e}"))?;
        let sweeps = ida::add_curves(&study, name, &mut outcome, repeats, &mut |_| ())?;
        for curve in outcome.curves() {
            let runs = outcome.runs.iter().zip(&outcome.timings);
            let own = runs.filter(|(run, _)| run.curve == curve);
            let points = own.filter_map(|(run, timing)| {
                let error = run.result.as_ref().ok()?.errors.position;
                Some([error, timing.as_ref()?.median])
            });
            let sweep = sweeps.iter().find(|sweep| sweep.curve == curve);
            self.curves.push(RivalCurve {
                study: name.to_owned(),
                code: sweep.map_or(Code::Looselink, |_| Code::Ida),
                method: curve.to_owned(),
                settings: sweep.map(SettingsSweep::settings),
                points: points.collect(),
                floor: outcome.reference.floor.position,
            });
        }
        self.sweeps.extend(sweeps);
        let [_, finest] = study.reference.paces();
        for code in [Code::Looselink, Code::Ida, Code::IdaOnOurs] {
            self.solutions.push(ConvergedSolution {
                study: name.to_owned(),
                code,
                of: Code::Looselink,
                method: format!("{}, {finest}", study.reference.set.join(", ")),
                difference_from_looselink: None,
            });
        }
        Ok(())
    }

    /// The curves of IDA on our equations, one for each largest order, against our reference.
    fn ida_on_ours(&mut self, root: &Path, name: &str, repeats: usize) -> Result<()> {
        let reference = OurReference::new(&study(root, name)?)?;
        let size = ida_of_system::matrix_size(&reference.scene);
        let size = size.map_err(|e| miette!("{name}: {e}"))?;
        let mut solvers = vec![LinearSolver::Klu];
        if size <= DENSE {
            solvers.push(LinearSolver::Dense);
        }
        for max_order in ORDERS {
            let candidates = solvers.iter().flat_map(|&linear_solver| {
                RATIOS.map(|ratio| IdaSettings {
                    max_order,
                    ratio,
                    linear_solver,
                    newton: NEWTON[0],
                })
            });
            let candidates: Vec<IdaSettings> = candidates.collect();
            let method = format!("BDF, order up to {max_order}");
            let trial = |settings, tolerance| reference.trial(settings, tolerance);
            let sweep = SettingsSweep::new(name, &method, &candidates, trial);
            let settings = sweep.settings();
            self.curves.push(RivalCurve {
                study: name.to_owned(),
                code: Code::IdaOnOurs,
                method,
                settings: Some(settings),
                points: ida_points(name, &reference, settings, repeats)?,
                floor: reference.distance(&reference.coarse),
            });
            self.sweeps.push(sweep);
        }
        Ok(())
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
            self.solutions.push(ConvergedSolution {
                study: name.to_owned(),
                code: Code::Exudyn,
                of: Code::Exudyn,
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
                    floor: model.reference.floor,
                });
            }
        }
        Ok(())
    }
}

/// The points of IDA on our equations with its best settings.
fn ida_points(
    name: &str,
    reference: &OurReference,
    settings: IdaSettings,
    repeats: usize,
) -> Result<Vec<[f64; 2]>> {
    let mut points = Vec::new();
    for tolerance in TOLERANCES {
        let run = || reference.trial(settings, tolerance);
        // a loose tolerance may lead where no step converges: the sweep has what it says
        let Ok(first) = run() else { continue };
        let seconds = ida::times(first.seconds, repeats, || {
            Ok(run().map_err(|e| miette!("{name}: {e}"))?.seconds)
        })?;
        points.push([first.error, median(&seconds)]);
        if first.seconds > ida::LAST_RUN {
            break;
        }
    }
    Ok(points)
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

//! Errors and processor times of other codes beside ours, in the studies of the project.

use accuracy::ida;
use looselink::model::Model;
use looselink::simulate::{Control, Observer, Progress, Simulation};
use looselink::system::State;
use miette::{IntoDiagnostic, Result, WrapErr, miette};
use serde::{Deserialize, Serialize};
use std::path::Path;
use std::process::Command;
use studies::machine::median;
use studies::precision::{Effort, Study, StudyOutcome, reached};
use verify::ida_of_system;

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

/// One of the studies.
///
/// # Errors
/// When it cannot be read.
pub fn study(root: &Path, name: &str) -> Result<Study> {
    let path = root.join("studies").join(name).with_extension("toml");
    Study::load(&path).map_err(|e| miette!("{e}"))
}

/// Whose curves they are.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Code {
    /// This program.
    Looselink,
    /// The second implementation: IDA with KLU.
    Ida,
    /// IDA with KLU on our residual and tangent.
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
    /// Error of position \[m\] and median processor time \[s\], coarse steps first.
    pub points: Vec<[f64; 2]>,
    /// Difference of two fine runs of the code, below which its errors have no meaning \[m\].
    pub floor: f64,
}

/// Levels of errors \[m\], four a decade.
pub fn levels() -> impl Iterator<Item = f64> {
    (0..=28).map(|k| 1e-5 * 10_f64.powf(-0.25 * f64::from(k)))
}

/// The method of a code that comes below an error first, to stay there, and its time \[s\]; none where the error is below the floor.
pub fn best(curves: &[RivalCurve], study: &str, code: Code, error: f64) -> Option<(String, f64)> {
    let own = curves.iter().filter(|c| c.study == study && c.code == code);
    let times = own.filter(|c| c.floor <= error).filter_map(|curve| {
        let (time, ..) = reached(&curve.points, error)?;
        Some((curve.method.clone(), time))
    });
    times.min_by(|a, b| a.1.total_cmp(&b.1))
}

/// Runs all codes in all studies.
///
/// # Errors
/// When one of them cannot run.
pub fn measure(root: &Path, program: &Path, repeats: usize) -> Result<Vec<RivalCurve>> {
    let python = environment(root)?;
    let mut curves = Vec::new();
    for name in STUDIES {
        eprintln!("rivals: {name}");
        curves.extend(own(root, name, repeats)?);
        curves.push(ida_on_ours(root, name, repeats)?);
        curves.extend(exudyn(root, &python, program, name, repeats)?);
    }
    Ok(curves)
}

/// Our curves and those of IDA, against our reference.
fn own(root: &Path, name: &str, repeats: usize) -> Result<Vec<RivalCurve>> {
    let study = study(root, name)?;
    let effort = Effort {
        repeats,
        smoke: false,
    };
    let outcome = StudyOutcome::run(&study, effort, &mut |_| ());
    let mut outcome = outcome.map_err(|e| miette!("{e}"))?;
    ida::points(
        &study,
        &ida::RELATIVE,
        repeats,
        &mut |_| (),
        &mut |pace, made| outcome.add(&study, ida::NAME, pace, made),
    )?;
    let curves = outcome.curves().into_iter().map(|curve| {
        let runs = outcome.runs.iter().zip(&outcome.timings);
        let own = runs.filter(|(run, _)| run.curve == curve);
        let points = own.filter_map(|(run, timing)| {
            let error = run.result.as_ref().ok()?.errors.position;
            Some([error, timing.as_ref()?.median])
        });
        RivalCurve {
            study: name.to_owned(),
            code: match curve == ida::NAME {
                true => Code::Ida,
                false => Code::Looselink,
            },
            method: curve.to_owned(),
            points: points.collect(),
            floor: outcome.reference.floor.position,
        }
    });
    Ok(curves.collect())
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

/// The curve of IDA on our equations, against our reference.
fn ida_on_ours(root: &Path, name: &str, repeats: usize) -> Result<RivalCurve> {
    let study = study(root, name)?;
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
        place.ok_or_else(|| miette!("{name}: {channel} is no unknown coordinate"))
    });
    let studied: Vec<usize> = studied.collect::<Result<_>>()?;
    let distance = |rows: &[Vec<f64>]| {
        let pairs = rows.iter().zip(&fine);
        let errors = pairs.flat_map(|(a, b)| studied.iter().map(|&i| (a[i] - b[i]).abs()));
        errors.fold(0.0, f64::max)
    };
    let mut points = Vec::new();
    for relative in ida::RELATIVE {
        let run = || ida_of_system::integrate(&scene, relative).map_err(|e| miette!("{name}: {e}"));
        let first = match run() {
            Ok(first) => first,
            // a loose tolerance may lead where no step converges
            Err(error) => {
                eprintln!("IDA on our equations, tolerance {relative:e}: {error}");
                continue;
            }
        };
        let seconds = ida::times(first.seconds, repeats, || Ok(run()?.seconds))?;
        points.push([distance(&first.rows), median(&seconds)]);
        if first.seconds > ida::LAST_RUN {
            break;
        }
    }
    Ok(RivalCurve {
        study: name.to_owned(),
        code: Code::IdaOnOurs,
        method: "BDF".to_owned(),
        points,
        floor: distance(&coarse),
    })
}

/// What `measure.py` writes.
#[derive(Deserialize)]
struct PeerResult {
    models: Vec<PeerModel>,
}

#[derive(Deserialize)]
struct PeerModel {
    reference: PeerReference,
    curves: Vec<PeerCurve>,
}

#[derive(Deserialize)]
struct PeerReference {
    floor: f64,
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

/// The curves of Exudyn, against its own reference.
fn exudyn(
    root: &Path,
    python: &Path,
    program: &Path,
    name: &str,
    repeats: usize,
) -> Result<Vec<RivalCurve>> {
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
    let models = result.models.into_iter();
    let curves = models.flat_map(|PeerModel { reference, curves }| {
        curves
            .into_iter()
            .map(move |curve| (reference.floor, curve))
    });
    let curves = curves.map(|(floor, PeerCurve { solver, points })| RivalCurve {
        study: name.to_owned(),
        code: Code::Exudyn,
        method: solver,
        points: points
            .iter()
            .filter(|point| !point.seconds.is_empty())
            .filter_map(|point| Some([point.error?, median(&point.seconds)]))
            .collect(),
        floor,
    });
    Ok(curves.collect())
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

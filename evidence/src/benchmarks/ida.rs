//! IDA as a rival on our equations, against our reference by the unknown coordinates. The second implementation is none: after every
//! step it integrates all powers with more evaluations than the step has.

use crate::benchmarks::rivals::{Code, RivalCurve, Rivals};
use crate::benchmarks::settings::{LONGEST, ORDERS, RATIOS, SettingsSweep, Trial};
use looselink::model::Model;
use looselink::scene::Scene;
use looselink::simulate::{Control, Observer, Progress, Simulation};
use looselink::system::State;
use miette::{IntoDiagnostic, Result, miette};
use studies::machine::median;
use studies::precision::Study;
use verify::ida_of_system::{self, IdaError, IdaSettings, LinearSolver, NEWTON};

/// Unknowns and multipliers up to which IDA on our equations is also tried with a dense matrix: the time of its factorisation grows
/// with the third power of their number, that of KLU about in proportion.
const DENSE: usize = 200;
/// A run that takes longer is not repeated: its time has no jitter that matters \[s\].
const LONG_RUN: f64 = 5.0;
/// IDA on our equations.
///
/// # Errors
/// A fault of the scene, a run that fails when it is repeated.
pub fn on_ours(rivals: &mut Rivals, name: &str, study: &Study, repeats: usize) -> Result<()> {
    let reference = OurReference::new(study)?;
    let size = ida_of_system::matrix_size(&reference.scene);
    let solvers = match size.map_err(|e| miette!("{name}: {e}"))? {
        ..=DENSE => &[LinearSolver::Klu, LinearSolver::Dense][..],
        _ => &[LinearSolver::Klu],
    };
    let trial = |settings, tolerance| {
        let run = ida_of_system::integrate(&reference.scene, settings, tolerance, LONGEST)?;
        Ok(Trial {
            tolerance,
            error: reference.distance(&run.rows),
            seconds: run.seconds,
        })
    };
    let curve = RivalCurve {
        study: name.to_owned(),
        code: Code::IdaOnOurs,
        method: "BDF".to_owned(),
        settings: None,
        points: Vec::new(),
        floor: reference.distance(&reference.coarse),
    };
    add_curves(rivals, &curve, solvers, repeats, trial)
}

/// Adds a curve for each largest order with the settings that are the fastest, and how they were found.
fn add_curves(
    rivals: &mut Rivals,
    curve: &RivalCurve,
    solvers: &[LinearSolver],
    repeats: usize,
    trial: impl Fn(IdaSettings, f64) -> Result<Trial, IdaError>,
) -> Result<()> {
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
        let method = format!("{}, order up to {max_order}", curve.method);
        let sweep = SettingsSweep::new(&curve.study, &method, &candidates, &trial);
        let settings = sweep.settings();
        let again = |first: &Trial| -> Result<[f64; 2]> {
            let seconds = match first.seconds > LONG_RUN {
                true => vec![first.seconds],
                false => (0..repeats)
                    .map(|_| Ok(trial(settings, first.tolerance)?.seconds))
                    .collect::<Result<_, IdaError>>()
                    .map_err(|e| miette!("{}, {method}: {e}", curve.study))?,
            };
            Ok([first.error, median(&seconds)])
        };
        let points = sweep
            .best()
            .trials
            .iter()
            .map(again)
            .collect::<Result<_>>()?;
        rivals.sweeps.push(sweep);
        rivals.curves.push(RivalCurve {
            method,
            settings: Some(settings),
            points,
            ..curve.clone()
        });
    }
    Ok(())
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
            let scene = scene.into_diagnostic()?;
            let mut simulation = Simulation::new(&scene)?;
            let mut rows = CoordinateRows::default();
            simulation.run(&mut rows).into_diagnostic()?;
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
}

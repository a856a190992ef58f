//! The runs behind Figs. 5 to 9, and what the record keeps of them.

use crate::kinematics::MechanismGeometry;
use crate::measures::{Measures, energy_lost};
use crate::pictures::{self, section, spread};
use crate::runs::{CaseRecording, DURATION, FROM, RunPace, RunPlan};
use crate::signal::{peak, smooth};
use crate::timings::invariants_apart;
use looselink::body::{FlexibleLink, RigidBody};
use looselink::scene::Scene;
use looselink::simulate::Simulation;
use looselink::stepper::bathe::splitting;
use miette::{IntoDiagnostic, Result, miette};
use plot::Figure;
use records::{Journal, each, threads};
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::f64::consts::TAU;

/// Steps of cases 2, 3 and 4 \[s\].
const FINE: f64 = 1.25e-6;
/// Step of case 1, and of case 2 again \[s\]. With 100 us the integrator changes the energy of case 2 by up to 18 % of the elastic
/// energy, with 40 us by less than 5 %.
const COARSE: f64 = 4e-5;
/// Time between rows of the fine runs \[s\].
const INTERVAL: f64 = 1e-5;
/// Step of case 2 with ten times the Young's modulus \[s\]. With 100 us the integrator gains up to nine times the largest elastic
/// energy, with 20 us it changes it by up to 24 %, with 5 us by 1.6 %.
const STIFFER: f64 = 5e-6;
/// Steps of the runs of case 2 over many periods \[s\].
const LONG: [f64; 2] = [4e-5, 2e-5];
/// Periods of the stroboscopic sections.
pub const PERIODS: u32 = 32;
/// Periods left out before them.
pub const SKIPPED: u32 = 2;
/// Rows a period of these runs: the library judges the errors of a run by the ways in its rows.
pub const ROWS_A_PERIOD: u32 = 100;

/// All recordings.
pub struct FigureRuns {
    /// Geometry of the scene of case 3.
    pub geometry: MechanismGeometry,
    runs: Vec<(&'static str, CaseRecording)>,
}

/// What is kept.
#[derive(Debug, Serialize, Deserialize)]
pub struct FigureRecord {
    /// Every run.
    pub runs: Vec<RunRecord>,
    /// Numbers of the scenes and of several runs, in SI units.
    pub numbers: Measures,
    /// The figures.
    pub pictures: Vec<(String, Figure)>,
}

/// A run of the figures.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct RunRecord {
    /// By which statements refer to it.
    pub name: String,
    /// Case of Table 2.
    pub case: u32,
    /// Changes of the scene.
    pub changed: Vec<String>,
    /// Simulated time \[s\].
    pub duration: f64,
    /// Method and step.
    pub how: String,
    /// Accepted steps.
    pub steps: u64,
    /// Newton iterations.
    pub newton_iterations: u64,
    /// Contacts closed.
    pub onsets: u64,
    /// What was measured.
    pub measures: Measures,
    /// What it warns of.
    pub warnings: Vec<String>,
}

/// The campaign `figures`.
///
/// # Errors
/// The first run that fails.
pub fn measure(journal: &Journal) -> Result<Value> {
    // two minutes: an interrupted campaign begins anew
    let record: FigureRecord = journal.item("figures", || FigureRuns::make()?.record())?;
    serde_json::to_value(record).into_diagnostic()
}

impl FigureRuns {
    fn make() -> Result<FigureRuns> {
        let short = |case, step: f64| {
            let interval = INTERVAL.max(step);
            RunPlan::new(case, RunPace::bathe(step), interval, DURATION)
        };
        let geometry = MechanismGeometry::of(&short(3, FINE).scene()?)?;
        let period = 1.0 / geometry.frequency;
        let duration = f64::from(PERIODS + SKIPPED) * period;
        let long =
            |case, pace| RunPlan::new(case, pace, period / f64::from(ROWS_A_PERIOD), duration);
        let modulus = 10.0 * youngs_modulus(&short(2, FINE).scene()?)?;
        let stiffer = format!("materials.passive.youngs_modulus={modulus:e}");
        // the longest first, so that no core is left with one of them at the end
        let plans = [
            ("both, many periods", long(4, RunPace::Controlled)),
            ("loose, many periods", long(3, RunPace::Controlled)),
            ("both", short(4, FINE)),
            ("loose", short(3, FINE)),
            ("flexible, many periods", long(2, RunPace::bathe(LONG[1]))),
            ("coarse, many periods", long(2, RunPace::bathe(LONG[0]))),
            ("flexible", short(2, FINE)),
            ("stiffer", short(2, STIFFER).with(stiffer)),
            ("coarse", short(2, COARSE)),
            ("ideal", short(1, COARSE)),
        ];
        let run = |(name, plan): &(&'static str, RunPlan)| Ok((*name, plan.run()?));
        let runs = each(&plans, threads(), run);
        let runs = runs.into_iter().collect::<Result<_>>()?;
        Ok(FigureRuns { geometry, runs })
    }

    /// A run: `ideal` (case 1), `flexible` and `coarse` (case 2 with two steps), `loose` (case 3), `both` (case 4), `stiffer` (case 2
    /// with ten times the Young's modulus), and those over many periods.
    ///
    /// # Panics
    /// When there is none of this name.
    pub fn get(&self, name: &str) -> &CaseRecording {
        let found = self.runs.iter().find(|(known, _)| *known == name);
        found.map_or_else(|| panic!("no run {name}"), |(_, run)| run)
    }

    fn record(&self) -> Result<FigureRecord> {
        let kept = |(name, run): &(&str, CaseRecording)| {
            let (plan, report) = (&run.plan, &run.report);
            let mut measures = Measures::default();
            if plan.duration == DURATION {
                measures = Measures::of(&self.geometry, run);
            } else {
                measures.put("energy_lost", energy_lost(run));
                measures.put("spread", spread(&section(&self.geometry, run).1));
            }
            RunRecord {
                name: (*name).into(),
                case: plan.case,
                changed: plan.overrides.clone(),
                duration: plan.duration,
                how: plan.pace.label(),
                steps: report.steps,
                newton_iterations: report.newton_iterations,
                onsets: report.onsets,
                measures,
                warnings: run.warnings.clone(),
            }
        };
        let mut numbers = Measures::default();
        self.geometry_numbers(&mut numbers);
        self.scene_numbers(&mut numbers)?;
        self.run_numbers(&mut numbers);
        numbers.put("invariants_worst", invariants_apart());
        Ok(FigureRecord {
            runs: self.runs.iter().map(kept).collect(),
            numbers,
            pictures: pictures::all(self),
        })
    }

    fn geometry_numbers(&self, m: &mut Measures) {
        let g = &self.geometry;
        // the bound of e_x by the clearances of both joints of a leg, for three readings of the printed dimensions
        let slack = 2.0 * g.clearance;
        let side = MechanismGeometry {
            base: g.base.map(|p| p / 3f64.sqrt()),
            ..g.clone()
        };
        let one_leg = |leg: usize, sign: f64| {
            let elbow = std::array::from_fn(|i| if i == leg { -sign } else { sign });
            MechanismGeometry { elbow, ..g.clone() }.largest_bound_x(slack)
        };
        let mixed = (0..3).flat_map(|leg| [1.0, -1.0].map(|sign| one_leg(leg, sign)));
        let mixed: Vec<f64> = mixed.collect();
        let least = mixed.iter().copied().fold(f64::INFINITY, f64::min);
        m.put("crank", g.crank);
        m.put("link", g.link);
        m.put("moving", g.platform[0].norm());
        m.put("fixed", g.base[0].norm());
        m.put("clearance", g.clearance);
        m.put("path", g.radius);
        m.put("bound", g.largest_bound_x(slack));
        m.put("bound_side", side.largest_bound_x(slack));
        m.put("bound_mixed_least", least);
        m.put("bound_mixed_largest", peak(&mixed));
    }

    fn scene_numbers(&self, m: &mut Measures) -> Result<()> {
        for run in ["ideal", "flexible", "loose", "both"].map(|name| self.get(name)) {
            let (scene, case) = (&run.scene, run.plan.case);
            let bodies = scene.bodies.iter();
            let links = bodies.filter(|b| b.kind.get::<FlexibleLink>().is_some());
            let loose = scene.joints.iter().filter(|j| j.contact().is_some());
            m.put(&format!("flexible_links_{case}"), links.count() as f64);
            m.put(&format!("loose_joints_{case}"), loose.count() as f64);
        }
        let scene = &self.get("both").scene;
        let section = |name: &str| {
            let link = scene.body(name).and_then(|b| scene.bodies[b].kind.link());
            link.ok_or_else(|| miette!("case 4 has no link {name}"))
        };
        let (driving, passive) = (section("crank1")?, section("link1")?);
        m.put("driving_area", driving.area);
        m.put("passive_area", passive.area);
        m.put("second_moment", passive.second_moment);
        m.put("modulus", youngs_modulus(scene)?);
        let contact = scene.joint("B1").and_then(|j| scene.joints[j].contact());
        let contact = contact.ok_or_else(|| miette!("case 4 has no loose joint B1"))?;
        m.put("bearing_radius", contact.bearing_radius.unwrap_or(0.0));
        m.put("restitution", contact.restitution);
        m.put("delivered", contact.normal_law().delivered_restitution());
        m.put("onset_tolerance", scene.integrator.onset_tolerance);
        m.put("first_substep", splitting(&scene.integrator.method));
        let (mut coordinates, mut elements) = (0, 0);
        for body in &scene.bodies {
            if let Some(link) = body.kind.get::<FlexibleLink>() {
                elements += link.elements;
                coordinates += 4 * (link.elements + 1);
            }
            coordinates += 3 * usize::from(body.kind.get::<RigidBody>().is_some());
        }
        m.put("coordinates", coordinates as f64);
        m.put("elements", elements as f64);
        let compiled = Simulation::new(scene)?.inspect();
        m.put("unknowns", compiled.unknowns as f64);
        m.put("multipliers", compiled.multipliers as f64);
        Ok(())
    }

    fn run_numbers(&self, m: &mut Measures) {
        let g = &self.geometry;
        let reached = ["flexible", "loose", "both"];
        let reached = reached.map(|name| self.get(name).column("t").last().copied().unwrap_or(0.0));
        m.put("reached", reached.into_iter().fold(DURATION, f64::min));
        let axes = ["error.x", "error.y"].map(|name| peak(self.get("ideal").column(name)));
        m.put("path_error", peak(&axes));
        let first = |name: &str| self.get("both").column(name)[0];
        let speed = TAU * g.frequency * g.radius;
        let apart = first("platform.vx").hypot(first("platform.vy") - speed);
        m.put("start_speed_error", apart);
        // means over 20 ms: the answer without the start-up vibration
        let slow = |run: &CaseRecording| {
            let width = (0.02 / run.plan.interval) as usize;
            peak(&smooth(run.between("error.x", FROM, DURATION).1, width))
        };
        m.put("slow_error", slow(self.get("coarse")));
        m.put("slow_error_stiffer", slow(self.get("stiffer")));
        let strain = |leg: usize| {
            let name = format!("link{leg}.strain");
            peak(self.get("flexible").between(&name, FROM, DURATION).1)
        };
        m.put("largest_strain", peak(&[1, 2, 3].map(strain)));
    }
}

/// Young's modulus of the passive links of a scene \[Pa\].
fn youngs_modulus(scene: &Scene) -> Result<f64> {
    let link = scene.bodies.iter().find_map(|b| b.kind.get());
    let link: &FlexibleLink = link.ok_or_else(|| miette!("no link is flexible"))?;
    Ok(link.youngs_modulus)
}

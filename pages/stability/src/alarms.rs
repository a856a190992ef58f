//! Whether runs are stopped as unstable that are not: every dynamic scene, every method, six steps, twelve intervals of rows.
//!
//! The energy E in play is kinetic, elastic, dissipated, and that of weights lifted above the start; of a reference the largest
//! so far. The stopped run is continued with one row at its end, to four times the longest run of the scan or to the duration
//! of the scene. The stop is true when
//!
//! * it claims a gain that is not finite, or E of the run is more than twice that of the reference at the time of the stop: most
//!   of the energy is the integrator's. At the start of a motion from rest no reference may resolve E; and
//! * the run does not outgrow it: at its end it has broken off, or E is still more than twice that of the reference. A smooth
//!   start from rest outgrows its first errors: they stay, and the energy of the motion grows at least as t^2.
//!
//! Otherwise it is false; without a reference it is undecided. Of the stops of one scene, method and step the first one is
//! shown, or the first false or undecided one.

use looselink::scene::{Analysis, Scene};
use looselink::simulate::{Recording, RunError, Simulation};
use looselink::system::State;
use miette::{Result, miette};
use rayon::prelude::*;
use stability::map::METHODS;
use std::cmp::Reverse;
use std::path::Path;
use std::time::Instant;

/// Channels of the energy in play, beside the weights.
const IN_PLAY: [&str; 8] = [
    "kinetic",
    "axial",
    "bending",
    "contact",
    "springs",
    "contact_dissipated",
    "friction_dissipated",
    "damping_dissipated",
];
/// Steps, over that of the scene.
const STEPS: [f64; 6] = [0.1, 0.3, 1.0, 3.0, 10.0, 30.0];
/// Intervals of rows, over the step.
const INTERVALS: [u64; 12] = [1, 2, 3, 5, 8, 10, 20, 30, 50, 80, 100, 200];
/// Rows of a run.
const ROWS: u64 = 40;
/// More than half of the energy in play is not that of the motion.
const WRONG: f64 = 2.0;
/// Steps to which a stopped run is continued.
const LATER: f64 = 4.0 * (ROWS * INTERVALS[INTERVALS.len() - 1]) as f64;
/// A reference may take this many steps,
const REFERENCE_STEPS: u64 = 100_000;
/// and its integrator may gain or lose this part of the energy in play, which is compared by a factor of 2.
const REFERENCE_LOSS: f64 = 0.1;
/// Newton's tolerance for scenes of an explicit method, which have none \[m/s\].
const NEWTON_TOLERANCE: f64 = 1e-10;

/// A run that was stopped as unstable.
struct UnstableStop {
    /// Steps a row.
    every: u64,
    /// When \[s\].
    t: f64,
    /// Energy that the integrator is said to have added \[J\],
    gained: f64,
    /// and the scene.
    supplied: f64,
    /// Energy in play \[J\].
    in_play: f64,
}

/// Whether a stop is right.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum StopVerdict {
    True,
    Undecided,
    False,
}

/// The stops of one scene, method and step: how many there are, the verdict, and a line with the reason.
struct Alarm {
    stops: usize,
    verdict: StopVerdict,
    line: String,
}

/// A run that has ended.
struct EndedRun {
    simulation: Simulation,
    start: State,
    rows: Recording,
    end: Result<(), RunError>,
}

impl EndedRun {
    /// Energy in play at the end \[J\].
    fn in_play(&self) -> f64 {
        let energies = |state| self.simulation.model().energies(state);
        let (state, start) = (self.simulation.state(), energies(&self.start).gravity);
        let at = energies(state);
        at.total() - at.gravity + state.dissipated() + (at.gravity - start).max(0.0)
    }

    /// Largest energy in play of the rows, and of the energy that the integrator has gained or lost \[J\].
    fn largest(&self) -> [f64; 2] {
        // a scene without springs has no energy of springs
        let column = |name: &str| self.rows.get(&format!("energy.{name}")).unwrap_or(&[]);
        let at = |name: &str, row: usize| column(name).get(row).copied().unwrap_or(0.0);
        let sum = |row: usize| IN_PLAY.iter().map(|name| at(name, row)).sum::<f64>();
        let lifted = |row: usize| (at("gravity", row) - at("gravity", 0)).max(0.0);
        let energies = (0..self.rows.rows()).map(|row| sum(row) + lifted(row));
        let gains = column("numerical").iter().map(|gain| gain.abs());
        [energies.fold(0.0, f64::max), gains.fold(0.0, f64::max)]
    }
}

/// Judges the energy in play of a run by that of a reference.
fn compare(run: f64, reference: f64) -> (StopVerdict, String) {
    let verdict = match run <= WRONG * reference {
        true => StopVerdict::False,
        false => StopVerdict::True,
    };
    (verdict, numbers::number(run / reference, 2))
}

/// A scene with one method and step.
struct Combination<'a> {
    name: &'a str,
    path: &'a Path,
    scene: &'a Scene,
    method: (&'static str, &'static [&'static str]),
    step: f64,
}

impl Combination<'_> {
    /// Overrides for a method, with what it needs of a scene that had another one.
    fn overrides(&self, method: &[&str], pace: String, interval: f64) -> Vec<String> {
        let mut all: Vec<String> = method.iter().map(|set| (*set).to_owned()).collect();
        all.push(pace);
        all.push(format!("output.interval={interval:e}"));
        all.push("output.channels=[\"energy.*\"]".to_owned());
        if self.scene.integrator.newton_tolerance == 0.0 {
            all.push(format!("integrator.newton_tolerance={NEWTON_TOLERANCE:e}"));
        }
        all
    }

    fn own(&self, interval: f64) -> Vec<String> {
        let interval = interval.min(self.scene.simulation.duration);
        let pace = format!("integrator.step={:e}", self.step);
        self.overrides(self.method.1, pace, interval)
    }

    /// Makes a run; none where the method does not take the scene.
    fn run(&self, overrides: &[String], steps: u64) -> Option<EndedRun> {
        let scene = Scene::load(self.path, overrides).ok()?;
        let mut simulation = Simulation::new(&scene).ok()?;
        let start = simulation.state().clone();
        let mut rows = Recording::new(&simulation);
        rows.most_steps = steps;
        let end = simulation.run(&mut rows);
        Some(EndedRun {
            simulation,
            start,
            rows,
            end,
        })
    }

    /// Whether the run with so many steps a row is stopped; none where the method does not take the scene.
    fn stop(&self, every: u64) -> Option<Option<UnstableStop>> {
        let run = self.run(&self.own(every as f64 * self.step), ROWS * every)?;
        Some(match run.end {
            Err(RunError::Unstable {
                t,
                gained,
                supplied,
                ..
            }) => Some(UnstableStop {
                every,
                t,
                gained,
                supplied,
                in_play: run.in_play(),
            }),
            _ => None,
        })
    }

    /// Largest energy in play of the first reference to this time whose energy balance closes \[J\].
    fn reference(&self, until: f64) -> Option<f64> {
        let accuracy = format!("integrator.accuracy={{ position = 1e-8, horizon = {until:e} }}");
        let fine = format!("integrator.step={:e}", 2.0 * until / REFERENCE_STEPS as f64);
        let tried = [
            (["integrator.method=dormand_prince"], &accuracy),
            (["integrator.method=bathe"], &accuracy),
            (["integrator.method=bathe"], &fine),
        ];
        tried.into_iter().find_map(|(method, pace)| {
            let mut overrides = self.overrides(&method, pace.clone(), until / ROWS as f64);
            overrides.push(format!("simulation.duration={until:e}"));
            let run = self.run(&overrides, REFERENCE_STEPS)?;
            let [energy, gain] = run.largest();
            let holds = run.end.is_ok() && gain <= REFERENCE_LOSS * energy;
            holds.then_some(energy)
        })
    }

    /// What becomes of the run when it goes on.
    fn continued(&self) -> (StopVerdict, String) {
        let whole = (self.scene.simulation.duration / self.step).floor();
        let until = self.step * whole.min(LATER);
        let mut overrides = self.own(until);
        overrides.push(format!("simulation.duration={until:e}"));
        let Some(run) = self.run(&overrides, u64::MAX) else {
            return (StopVerdict::Undecided, "not repeated".to_owned());
        };
        // half a step: rounding of the times
        if run.simulation.state().t < until - 0.5 * self.step {
            return (StopVerdict::True, "the run breaks off".to_owned());
        }
        match self.reference(until) {
            Some(energy) => compare(run.in_play(), energy),
            None => (StopVerdict::Undecided, "no reference".to_owned()),
        }
    }

    fn judge(
        &self,
        stop: &UnstableStop,
        continued: &(StopVerdict, String),
    ) -> (StopVerdict, String) {
        if !stop.gained.is_finite() {
            return (StopVerdict::True, "the gain is not finite".to_owned());
        }
        let (now, claim) = match self.reference(stop.t) {
            Some(energy) => compare(stop.in_play, energy),
            None => (StopVerdict::Undecided, "no reference".to_owned()),
        };
        let said = format!("{claim}, later {}", continued.1);
        match now {
            StopVerdict::False => (now, said),
            _ => (continued.0, said),
        }
    }

    /// Judges the stops of this combination; none where there are none.
    fn alarm(&self, stops: &[UnstableStop]) -> Option<Alarm> {
        if stops.is_empty() {
            return None;
        }
        let continued = self.continued();
        let judged = stops
            .par_iter()
            .map(|stop| (stop, self.judge(stop, &continued)));
        let judged: Vec<(&UnstableStop, (StopVerdict, String))> = judged.collect();
        let (stop, (verdict, mut reason)) =
            judged.into_iter().min_by_key(|(_, (v, _))| Reverse(*v))?;
        if verdict == StopVerdict::False {
            let shown = self.own(stop.every as f64 * self.step).join(" --set ");
            reason += &format!("; shown by --set {shown}");
        }
        let numbers = [stop.t, stop.gained, stop.supplied].map(|x| numbers::number(x, 2));
        Some(Alarm {
            stops: stops.len(),
            verdict,
            line: format!(
                "| {} | {} | {:.3e} | {} of {} | {} | {} | {verdict:?} | {reason} |",
                self.name,
                self.method.0,
                self.step,
                stops.len(),
                INTERVALS.len(),
                stop.every,
                numbers.join(" | ")
            ),
        })
    }
}

/// The runs that a scene takes, and its alarms.
fn scan(name: &str, path: &Path) -> Result<(usize, Vec<Alarm>)> {
    let scene = Scene::load(path, &[]).map_err(|e| miette!("{e}"))?;
    if scene.simulation.analysis != Analysis::Dynamic {
        return Ok((0, Vec::new()));
    }
    let usual = scene.integrator.step().unwrap_or(scene.output.interval);
    let combination = |method, factor: f64| Combination {
        name,
        path,
        scene: &scene,
        method,
        step: factor * usual,
    };
    let combinations = METHODS
        .iter()
        .flat_map(|m| STEPS.map(|f| combination(*m, f)));
    let found = combinations
        .collect::<Vec<Combination>>()
        .into_par_iter()
        .map(|combination| {
            let ends = INTERVALS
                .par_iter()
                .filter_map(|every| combination.stop(*every));
            let ends: Vec<Option<UnstableStop>> = ends.collect();
            let runs = ends.len();
            let stops: Vec<UnstableStop> = ends.into_iter().flatten().collect();
            (runs, combination.alarm(&stops))
        });
    let (runs, alarms): (Vec<usize>, Vec<Option<Alarm>>) = found.collect();
    Ok((runs.iter().sum(), alarms.into_iter().flatten().collect()))
}

/// Scans the scenes with these names, all where there are none, and prints what is stopped; a false stop is an error.
pub fn alarms(root: &Path, only: &[String]) -> Result<()> {
    let started = Instant::now();
    let sources = records::digests(root, "long")?;
    let files = sources
        .keys()
        .filter_map(|file| file.strip_prefix("scenes/"));
    let names: Vec<&str> = files.filter_map(|f| f.strip_suffix(".toml")).collect();
    if let Some(unknown) = only.iter().find(|name| !names.contains(&name.as_str())) {
        return Err(miette!("there is no scene {unknown}"));
    }
    println!(
        "| scene | method | step s | stopped | steps a row | t s | added J | supplied J | stop | E over that of the reference |\n\
         |---|---|--:|--:|--:|--:|--:|--:|---|---|"
    );
    let (mut runs, mut stops, mut verdicts) = (0, 0, Vec::new());
    for name in names {
        if !only.is_empty() && !only.iter().any(|wanted| wanted == name) {
            continue;
        }
        let (made, found) = scan(name, &root.join(format!("scenes/{name}.toml")))?;
        runs += made;
        for alarm in found {
            println!("{}", alarm.line);
            stops += alarm.stops;
            verdicts.push(alarm.verdict);
        }
        let seconds = started.elapsed().as_secs_f64();
        eprintln!("{name}: {made} runs, {seconds:.0} s so far");
    }
    let count = |verdict| verdicts.iter().filter(|v| **v == verdict).count();
    let [right, undecided, wrong] = [
        StopVerdict::True,
        StopVerdict::Undecided,
        StopVerdict::False,
    ]
    .map(count);
    println!(
        "\n{runs} runs; {stops} are stopped as unstable, in {} scenes with a method and step: \
         {right} true, {undecided} undecided, {wrong} false",
        verdicts.len()
    );
    match wrong {
        0 => Ok(()),
        _ => Err(miette!("runs are stopped that are not unstable")),
    }
}

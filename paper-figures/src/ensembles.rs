//! Runs that no single realisation decides: ensembles of starts, Lyapunov exponents, meshes, other methods.

use crate::campaign::{DURATION, FROM};
use crate::interval::STARTS;
use crate::kinematics::Geometry;
use crate::measures::Measures;
use crate::record::{Ensemble, Member, Record, Single};
use crate::runs::{Pace, Plan, Recording, run_all};
use crate::signal::{rms, smooth};
use crate::{exponents, methods};
use miette::Result;
use rayon::prelude::*;
use std::f64::consts::TAU;
use std::fmt::Write;

/// Time between recorded rows \[s\].
const INTERVAL: f64 = 1e-5;
/// Displacement of the platform between the starts of an ensemble \[m\].
pub const MOVED: f64 = 1e-12;
/// Others, which must make no difference \[m\].
const MOVED_OTHERWISE: [f64; 2] = [1e-10, 1e-14];
/// Meshes: elements a link.
pub const MESHES: [usize; 4] = [1, 2, 4, 8];
/// Means over this time \[s\] are compared where single impacts do not happen at the same instants.
const AVERAGED: f64 = 0.02;
/// Time in which the platform gets up to speed in the run that starts without deformation at rest \[s\].
const SPIN_UP: f64 = 0.8;
/// Knots of that path \[s\].
const KNOTS: f64 = 1e-3;
/// Retardation times of the passive links \[s\].
pub const RETARDATIONS: [f64; 2] = [1e-6, 1e-5];

/// Makes all runs.
///
/// # Errors
/// The first run that fails.
pub fn run() -> Result<Record> {
    let geometry = Geometry::of(&plan(3).scene()?)?;
    let work = methods::work()?;
    let long = methods::long(&geometry);
    let singles = singles(&geometry)?;
    let exponents = exponents::run(&geometry)?;
    let mut ensembles = list(&geometry);
    fill(&mut ensembles, &geometry)?;
    Ok(Record {
        ensembles,
        exponents,
        singles,
        work,
        long,
    })
}

fn plan(case: u32) -> Plan {
    Plan {
        case,
        pace: Pace::Controlled,
        interval: INTERVAL,
        duration: DURATION,
        overrides: Vec::new(),
    }
}

/// The ensembles, their runs not yet made.
fn list(g: &Geometry) -> Vec<Ensemble> {
    let mut wanted: Vec<(u32, f64, String)> = Vec::new();
    for moved in [MOVED].into_iter().chain(MOVED_OTHERWISE) {
        wanted.extend([3, 4].map(|case| (case, moved, String::new())));
    }
    let half = format!("contacts.pin.clearance={:e}", 0.5 * g.clearance);
    wanted.push((3, MOVED, half));
    wanted.extend(MESHES[1..].iter().map(|n| (4, MOVED, mesh(*n).join(" "))));
    let letters = 'A'..;
    wanted
        .into_iter()
        .zip(letters)
        .map(|((case, moved, changed), letter)| Ensemble {
            name: letter.to_string(),
            case,
            moved,
            changed,
            how: Pace::Controlled.label(),
            members: Vec::new(),
        })
        .collect()
}

fn mesh(elements: usize) -> [String; 3] {
    [1, 2, 3].map(|i| format!("bodies.link{i}.elements={elements}"))
}

/// The start of case 3 or 4 with the platform moved by `moved` \[m\], in one of [`STARTS`] directions.
///
/// The velocity is that of the ideal mechanism, which the scene has without this override.
pub fn moved(g: &Geometry, moved: f64, start: usize) -> String {
    let (sin, cos) = (TAU * start as f64 / STARTS as f64).sin_cos();
    let [x, y, theta] = g.pose(0.0);
    let speed = TAU * g.frequency * g.radius;
    format!(
        "initial.bodies={{ platform = {{ x = {:?}, y = {:?}, theta = {theta:?}, vx = 0.0, vy = {speed:?}, omega = 0.0 }} }}",
        x + moved * cos,
        y + moved * sin
    )
}

/// A run of an ensemble and the means of its error over [`AVERAGED`], one a millisecond.
struct Done {
    member: Member,
    slow_error: Vec<f64>,
}

impl Done {
    fn of(g: &Geometry, recording: &Recording) -> Done {
        Done {
            member: Member {
                measures: Measures::of(g, recording),
                warnings: recording.warnings.clone(),
            },
            slow_error: slow_error(recording),
        }
    }
}

fn slow_error(recording: &Recording) -> Vec<f64> {
    let width = (AVERAGED / recording.plan.interval) as usize;
    let every = (1e-3 / recording.plan.interval) as usize;
    let error = smooth(recording.between("error.x", FROM, DURATION).1, width);
    error.into_iter().step_by(every).collect()
}

/// Makes the runs of all ensembles, one a thread.
fn fill(ensembles: &mut [Ensemble], geometry: &Geometry) -> Result<()> {
    // the longest first, so that no core is left with one of them at the end
    let jobs: Vec<(usize, usize)> = (0..ensembles.len())
        .rev()
        .flat_map(|e| (0..STARTS).map(move |k| (e, k)))
        .collect();
    let done: Result<Vec<Done>> = jobs
        .par_iter()
        .with_max_len(1)
        .map(|&(e, k)| {
            let ensemble = &ensembles[e];
            let mut plan = plan(ensemble.case);
            plan.overrides.push(moved(geometry, ensemble.moved, k));
            let changed = ensemble.changed.split_whitespace();
            plan.overrides.extend(changed.map(String::from));
            let recording = plan.run()?;
            // a changed clearance changes the bound
            Ok(Done::of(&Geometry::of(&recording.scene)?, &recording))
        })
        .collect();
    let mut done = done?;
    let flexible = slow_error(&plan(2).run()?);
    // case 3 is the first ensemble and case 4 the second, and jobs run backwards
    let at = |e: usize, k: usize| (ensembles.len() - 1 - e) * STARTS + k;
    for k in 0..STARTS {
        let (loose, both) = (&done[at(0, k)].slow_error, &done[at(1, k)].slow_error);
        let rest: Vec<f64> = (0..both.len())
            .map(|i| both[i] - flexible[i] - loose[i])
            .collect();
        let share = rms(&rest) / rms(both);
        let measures = &mut done[at(1, k)].member.measures;
        measures.0.insert("not_composed".into(), share);
    }
    for ((e, _), done) in jobs.iter().zip(done) {
        ensembles[*e].members.push(done.member);
    }
    Ok(())
}

/// Case 2 with finer meshes, with a start that leaves no vibration, and with damping.
fn singles(g: &Geometry) -> Result<Vec<Single>> {
    let mut wanted: Vec<(String, Plan)> = MESHES
        .iter()
        .map(|n| {
            let mut plan = plan(2);
            plan.overrides.extend(mesh(*n));
            (format!("{n} elements a link"), plan)
        })
        .collect();
    wanted.push(("quasi-static start".into(), spun_up(g)));
    for time in RETARDATIONS {
        let mut plan = plan(2);
        let damped = [1, 2, 3].map(|i| format!("bodies.link{i}.kelvin_voigt={time:e}"));
        plan.overrides.extend(damped);
        wanted.push((damped_name(time), plan));
    }
    let plans: Vec<Plan> = wanted.iter().map(|(_, plan)| plan.clone()).collect();
    wanted
        .into_iter()
        .zip(run_all(&plans))
        .map(|((name, plan), recording)| {
            let recording = recording?;
            Ok(Single {
                name,
                how: plan.pace.label(),
                measures: Measures::of(g, &recording),
                warnings: recording.warnings,
            })
        })
        .collect()
}

/// The name of a run with structural damping.
pub fn damped_name(time: f64) -> String {
    format!("retardation time {}", plot::si(time, "s"))
}

/// Case 2 from rest: the platform gets up to speed on the circle so smoothly that the links follow in their quasi-static
/// deformation, and is where the printed motion is from [`SPIN_UP`] on.
///
/// The angle is phi = pi T + 2 pi T R(t/T), its rate a polynomial with three vanishing derivatives at both ends.
fn spun_up(g: &Geometry) -> Plan {
    let angle = |t: f64| {
        let u = (t / SPIN_UP).min(1.0);
        let ramp = u.powi(5) * (7.0 - u * (14.0 - u * (10.0 - 2.5 * u)));
        g.frequency * TAU * (0.5 * SPIN_UP + SPIN_UP * ramp + (t - SPIN_UP).max(0.0))
    };
    let mut rows = String::new();
    // beyond the end, where the spline has no curvature
    for k in 0..=((DURATION + 0.05) / KNOTS) as usize {
        let t = k as f64 * KNOTS;
        let (sin, cos) = angle(t).sin_cos();
        let _ = write!(
            rows,
            "[{t:?}, {:?}, {:?}, 0.0], ",
            g.radius * cos,
            g.radius * sin
        );
    }
    let mut plan = plan(2);
    let path = format!("drives.input.path={{ type = \"table\", rows = [{rows}] }}");
    plan.overrides.push(path);
    let (sin, cos) = angle(0.0).sin_cos();
    let start = [g.radius * cos, g.radius * sin, 0.0];
    for leg in 0..3 {
        let [x, y] = g.pin(leg, start);
        let sketch = format!("initial.sketch.B{}=[{x:?}, {y:?}]", leg + 1);
        plan.overrides.push(sketch);
    }
    plan
}

#[cfg(test)]
mod tests {
    use super::*;
    use miette::miette;

    #[test]
    fn starts_of_an_ensemble_differ() -> Result<()> {
        let geometry = Geometry::of(&plan(3).scene()?)?;
        for size in [MOVED].into_iter().chain(MOVED_OTHERWISE) {
            let mut starts: Vec<String> = (0..STARTS).map(|k| moved(&geometry, size, k)).collect();
            starts.sort();
            starts.dedup();
            if starts.len() != STARTS {
                return Err(miette!("{size:e} m is lost in rounding"));
            }
        }
        Ok(())
    }

    #[test]
    fn spun_up_path_ends_on_the_printed_one() -> Result<()> {
        let geometry = Geometry::of(&plan(3).scene()?)?;
        let path = spun_up(&geometry).overrides[0].clone();
        let row = path.split("[1.0, ").nth(1).unwrap_or_default();
        let x: f64 = row
            .split(',')
            .next()
            .unwrap_or_default()
            .parse()
            .unwrap_or(f64::NAN);
        // one turn after one second, to the rounding of an angle of 6
        assert!((x - geometry.radius).abs() < 1e-15);
        Ok(())
    }
}

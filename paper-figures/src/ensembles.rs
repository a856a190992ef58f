//! Runs that no single realisation decides: ensembles of starts, Lyapunov exponents, meshes, other methods.

use crate::campaign::{DURATION, FROM, controlled};
use crate::interval::STARTS;
use crate::kinematics::MechanismGeometry;
use crate::measures::Measures;
use crate::record::{Ensemble, EnsembleMember, EnsembleRecord, Single};
use crate::runs::{CaseRecording, RunPace, RunPlan, each};
use crate::signal::{rms, smooth};
use crate::{exponents, methods};
use miette::Result;
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
pub fn run() -> Result<EnsembleRecord> {
    let geometry = MechanismGeometry::of(&controlled(3, INTERVAL).scene()?)?;
    let work = methods::work()?;
    let long = methods::long(&geometry);
    let singles = singles(&geometry)?;
    let exponents = exponents::run(&geometry)?;
    let mut ensembles = list(&geometry);
    fill(&mut ensembles, &geometry)?;
    Ok(EnsembleRecord {
        ensembles,
        exponents,
        singles,
        work,
        long,
    })
}

/// The ensembles, their runs not yet made.
fn list(g: &MechanismGeometry) -> Vec<Ensemble> {
    let sizes = [MOVED].into_iter().chain(MOVED_OTHERWISE);
    let sizes = sizes.flat_map(|moved| [3, 4].map(|case| (case, moved, String::new())));
    let mut wanted: Vec<(u32, f64, String)> = sizes.clone().collect();
    let half = format!("contacts.pin.clearance={:e}", 0.5 * g.clearance);
    wanted.push((3, MOVED, half));
    wanted.extend(MESHES[1..].iter().map(|n| (4, MOVED, mesh(*n).join(" "))));
    let wanted = wanted.into_iter().map(|e| (e, 0));
    let letters = 'A'..;
    wanted
        .chain(sizes.map(|e| (e, STARTS)))
        .zip(letters)
        .map(|(((case, moved, changed), first), letter)| Ensemble {
            name: letter.to_string(),
            case,
            moved,
            first,
            changed,
            how: RunPace::Controlled.label(),
            members: Vec::new(),
        })
        .collect()
}

fn mesh(elements: usize) -> [String; 3] {
    [1, 2, 3].map(|i| format!("bodies.link{i}.elements={elements}"))
}

/// The start of case 3 or 4 with the platform moved by `moved` \[m\], in one of [`STARTS`] directions; the next [`STARTS`]
/// lie between those.
///
/// The velocity is that of the ideal mechanism, which the scene has without this override.
pub fn moved(g: &MechanismGeometry, moved: f64, start: usize) -> String {
    let direction = (start % STARTS) as f64 + 0.5 * (start / STARTS) as f64;
    let (sin, cos) = (TAU * direction / STARTS as f64).sin_cos();
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
    member: EnsembleMember,
    slow_error: Vec<f64>,
}

impl Done {
    fn of(g: &MechanismGeometry, recording: &CaseRecording) -> Done {
        Done {
            member: EnsembleMember {
                measures: Measures::of(g, recording),
                warnings: recording.warnings.clone(),
            },
            slow_error: slow_error(recording),
        }
    }
}

fn slow_error(recording: &CaseRecording) -> Vec<f64> {
    let width = (AVERAGED / recording.plan.interval) as usize;
    let every = (1e-3 / recording.plan.interval) as usize;
    let error = smooth(recording.between("error.x", FROM, DURATION).1, width);
    error.into_iter().step_by(every).collect()
}

/// Makes the runs of all ensembles, one a thread.
fn fill(ensembles: &mut [Ensemble], geometry: &MechanismGeometry) -> Result<()> {
    // the longest first, so that no core is left with one of them at the end
    let jobs: Vec<(usize, usize)> = (0..ensembles.len())
        .rev()
        .flat_map(|e| (0..STARTS).map(move |k| (e, k)))
        .collect();
    let run = |&(e, k): &(usize, usize)| {
        let ensemble = &ensembles[e];
        let mut plan = controlled(ensemble.case, INTERVAL);
        let start = moved(geometry, ensemble.moved, ensemble.first + k);
        plan.overrides.push(start);
        let changed = ensemble.changed.split_whitespace();
        plan.overrides.extend(changed.map(String::from));
        let recording = plan.run()?;
        // a changed clearance changes the bound
        Ok(Done::of(
            &MechanismGeometry::of(&recording.scene)?,
            &recording,
        ))
    };
    let done = each(&jobs, run)
        .into_iter()
        .collect::<Result<Vec<Done>>>()?;
    let mut made: Vec<Vec<Done>> = ensembles.iter().map(|_| Vec::new()).collect();
    for ((e, _), done) in jobs.iter().zip(done) {
        made[*e].push(done);
    }
    let flexible = slow_error(&controlled(2, INTERVAL).run()?);
    // case 3 is the first ensemble and case 4 the second
    let (loose, both) = made.split_at_mut(1);
    for (loose, both) in loose[0].iter().zip(&mut both[0]) {
        let slow = &both.slow_error;
        let rest: Vec<f64> = (0..slow.len())
            .map(|i| slow[i] - flexible[i] - loose.slow_error[i])
            .collect();
        let share = rms(&rest) / rms(slow);
        let measures = &mut both.member.measures;
        measures.0.insert("not_composed".into(), share);
    }
    for (ensemble, made) in ensembles.iter_mut().zip(made) {
        ensemble.members = made.into_iter().map(|done| done.member).collect();
    }
    Ok(())
}

/// Case 2 with finer meshes, with a start that leaves no vibration, and with damping.
fn singles(g: &MechanismGeometry) -> Result<Vec<Single>> {
    let mut wanted: Vec<(String, RunPlan)> = MESHES
        .iter()
        .map(|n| {
            let mut plan = controlled(2, INTERVAL);
            plan.overrides.extend(mesh(*n));
            (format!("{n} elements a link"), plan)
        })
        .collect();
    wanted.push(("quasi-static start".into(), spun_up(g)));
    for time in RETARDATIONS {
        let mut plan = controlled(2, INTERVAL);
        let damped = [1, 2, 3].map(|i| format!("bodies.link{i}.kelvin_voigt={time:e}"));
        plan.overrides.extend(damped);
        wanted.push((damped_name(time), plan));
    }
    let plans: Vec<RunPlan> = wanted.iter().map(|(_, plan)| plan.clone()).collect();
    wanted
        .into_iter()
        .zip(each(&plans, RunPlan::run))
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
    format!("retardation time {}", numbers::si(time, "s"))
}

/// Case 2 from rest: the platform gets up to speed on the circle so smoothly that the links follow in their quasi-static
/// deformation, and is where the printed motion is from [`SPIN_UP`] on.
///
/// The angle is phi = pi T + 2 pi T R(t/T), its rate a polynomial with three vanishing derivatives at both ends.
fn spun_up(g: &MechanismGeometry) -> RunPlan {
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
    let mut plan = controlled(2, INTERVAL);
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
    use std::collections::HashSet;

    #[test]
    fn starts_of_an_ensemble_differ() -> Result<()> {
        let geometry = MechanismGeometry::of(&controlled(3, INTERVAL).scene()?)?;
        for size in [MOVED].into_iter().chain(MOVED_OTHERWISE) {
            let all = (0..2 * STARTS).map(|k| moved(&geometry, size, k));
            let starts: HashSet<String> = all.collect();
            if starts.len() != 2 * STARTS {
                return Err(miette!("{size:e} m is lost in rounding"));
            }
        }
        Ok(())
    }

    #[test]
    fn spun_up_path_ends_on_the_printed_one() -> Result<()> {
        let geometry = MechanismGeometry::of(&controlled(3, INTERVAL).scene()?)?;
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

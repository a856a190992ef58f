//! A run that is stopped and restored goes on as if it had never stopped: the same rows, contacts and report, to the bit.

use crate::support::{all_scenes, load};
use looselink::checkpoint::Misfit;
use looselink::scene::{Analysis, Scene};
use looselink::simulate::{ContactEvent, Control, Impact, Observer, Progress, Report, Simulation};
use looselink::stepper::SCHEMES;
use std::io;

/// Everything that a run gives to its observer, and what it goes on from.
#[derive(Debug, Default)]
struct Parts {
    rows: Vec<u64>,
    contacts: Vec<Impact>,
    steps: u64,
    /// The run is stopped after so many steps.
    stop: u64,
    /// Instead of stopping there, it hands over a checkpoint and goes on.
    goes_on: bool,
    /// Numbers and contacts that belong to the checkpoint, and the checkpoint.
    kept: (usize, usize, Vec<u8>),
}

impl Observer for Parts {
    fn row(&mut self, values: &[f64]) -> io::Result<()> {
        self.rows.extend(values.iter().map(|x| x.to_bits()));
        Ok(())
    }

    fn contact(&mut self, contact: &ContactEvent) -> io::Result<()> {
        self.contacts.push(Impact::from(contact));
        Ok(())
    }

    fn checkpoint(&mut self, _: f64, bytes: &[u8]) -> io::Result<()> {
        self.kept = (self.rows.len(), self.contacts.len(), bytes.to_vec());
        Ok(())
    }

    fn step(&mut self, _: &Progress) -> io::Result<Control> {
        self.steps += 1;
        Ok(match (self.steps == self.stop, self.goes_on) {
            (true, true) => Control::Checkpoint,
            (true, false) => Control::Stop,
            (false, _) => Control::Continue,
        })
    }
}

fn whole(scene: &Scene) -> (Parts, Report) {
    let mut simulation = Simulation::new(scene).unwrap();
    let mut parts = Parts::default();
    simulation.run(&mut parts).unwrap();
    (parts, simulation.report())
}

/// Runs a scene with stops after these numbers of steps, each part in a simulation of its own.
fn in_parts(scene: &Scene, stops: &[u64]) -> (Parts, Report) {
    let mut parts = Parts::default();
    for stop in stops {
        let mut simulation = Simulation::new(scene).unwrap();
        if parts.steps > 0 {
            restore(&mut simulation, &mut parts);
        }
        parts.stop = *stop;
        simulation.run(&mut parts).unwrap_err();
    }
    let mut simulation = Simulation::new(scene).unwrap();
    restore(&mut simulation, &mut parts);
    simulation.run(&mut parts).unwrap();
    (parts, simulation.report())
}

fn restore(simulation: &mut Simulation, parts: &mut Parts) {
    let (rows, contacts, bytes) = &parts.kept;
    parts.rows.truncate(*rows);
    parts.contacts.truncate(*contacts);
    simulation.restore(bytes.clone()).unwrap();
}

/// Stops a scene after its first step, somewhere in each third, and after its last step; returns the report.
fn check(name: &str, scene: &Scene, seed: u64) -> Report {
    let (parts, report) = whole(scene);
    let third = parts.steps / 3;
    let somewhere =
        |k: u64| third * k + (seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 32) % third.max(1);
    let mut stops: Vec<u64> = [1, somewhere(0), somewhere(1), somewhere(2), parts.steps].into();
    stops.retain(|stop| *stop > 0);
    stops.sort_unstable();
    stops.dedup();
    let (resumed, of_resumed) = in_parts(scene, &stops);
    assert_eq!(parts.steps, resumed.steps, "{name} {stops:?}");
    assert!(parts.rows == resumed.rows, "{name} {stops:?}");
    assert_eq!(parts.contacts, resumed.contacts, "{name} {stops:?}");
    assert_eq!(report, of_resumed, "{name} {stops:?}");
    report
}

/// The first rows of a motion, 10 ms at most.
fn short(name: &str) -> Option<Scene> {
    let scene = load(name, &[]);
    if scene.simulation.analysis == Analysis::Static {
        return None;
    }
    let interval = scene.output.interval.min(0.001);
    let step = scene.integrator.step().unwrap_or_default();
    let duration = (30.0 * interval).min(0.01).max(4.0 * step);
    let duration = duration.min(scene.simulation.duration);
    let overrides = [
        format!("simulation.duration={duration:e}"),
        format!("output.interval={:e}", interval.max(step)),
    ];
    Some(load(name, &overrides.each_ref().map(String::as_str)))
}

#[test]
fn every_scene_goes_on_from_any_step() {
    let mut count = 0;
    for name in all_scenes() {
        if let Some(scene) = short(&name) {
            check(&name, &scene, count);
            count += 1;
        }
    }
    assert!(count >= 40, "{count}");
}

/// Stops every method on loose joints with flexible links, with rigid ones, and without constraints.
fn check_methods(pace: &str) {
    const CONSTRAINED: [&str; 2] = ["3rrr/case4.toml", "four-bar-three-loose.toml"];
    const FREE: [&str; 1] = ["bouncing-journal.toml"];
    for (seed, scheme) in SCHEMES.iter().enumerate() {
        let required = scheme.parameters.iter().filter(|p| p.default.is_none());
        let mut keys: String = required.map(|p| format!("{}=0.8,", p.name)).collect();
        if !scheme.is_explicit {
            keys += "newton_tolerance=1e-11,";
        }
        let constrained = CONSTRAINED.iter().filter(|_| scheme.keeps_constraints);
        for name in constrained.chain(&FREE) {
            let method = format!("method={:?},onset_tolerance=1e-13", scheme.name);
            let integrator = format!("integrator={{{keys}{method},{pace}}}");
            let overrides = [
                integrator.as_str(),
                "assumptions={}",
                "simulation.duration=0.004",
                "output.interval=1e-3",
            ];
            let report = check(
                &format!("{name} {integrator}"),
                &load(name, &overrides),
                seed as u64,
            );
            assert!(report.onsets > 0, "{name}");
        }
    }
}

#[test]
fn every_method_goes_on_from_any_step_with_equal_steps() {
    check_methods("step=4e-6");
}

#[test]
fn every_method_goes_on_from_any_step_with_an_accuracy() {
    check_methods("accuracy={position=1e-6,energy=1e-6,horizon=0.01}");
}

/// A run that chooses its method.
fn undecided(name: &str) -> Scene {
    let overrides = [
        "integrator={method=\"auto\",newton_tolerance=1e-11,onset_tolerance=1e-13,accuracy={position=1e-6,horizon=0.01}}",
        "assumptions={}",
        "simulation.duration=0.004",
        "output.interval=1e-3",
    ];
    load(name, &overrides)
}

#[test]
fn a_chosen_method_goes_on_from_any_step() {
    for (seed, name) in ["3rrr/case2.toml", "3rrr/case4.toml"].iter().enumerate() {
        let report = check(name, &undecided(name), seed as u64);
        assert!(report.choice.is_some(), "{name}");
    }
}

/// The trial run has come further when its reports reach the observer.
#[test]
fn a_checkpoint_of_a_trial_run_is_that_of_the_step_reported() {
    let scene = undecided("3rrr/case4.toml");
    let (whole, report) = whole(&scene);
    let mut parts = Parts {
        stop: 40,
        goes_on: true,
        ..Parts::default()
    };
    let mut simulation = Simulation::new(&scene).unwrap();
    simulation.run(&mut parts).unwrap();
    let runs = report.choice.as_ref().unwrap().trial_runs.iter();
    assert!(runs.map(|run| run.steps).max() > Some(parts.stop));
    assert!(parts.rows == whole.rows);
    assert_eq!(simulation.report(), report);
    let mut resumed = Simulation::new(&scene).unwrap();
    restore(&mut resumed, &mut parts);
    assert!(parts.rows.len() < whole.rows.len());
    resumed.run(&mut parts).unwrap();
    assert!(parts.rows == whole.rows);
    assert_eq!(parts.contacts, whole.contacts);
    assert_eq!(resumed.report(), report);
}

#[test]
fn a_checkpoint_of_another_scene_is_refused() {
    let mut parts = Parts {
        stop: 5,
        ..Parts::default()
    };
    let case3 = short("3rrr/case3.toml").unwrap();
    Simulation::new(&case3)
        .unwrap()
        .run(&mut parts)
        .unwrap_err();
    let case4 = short("3rrr/case4.toml").unwrap();
    let mut other = Simulation::new(&case4).unwrap();
    assert_eq!(other.restore(parts.kept.2), Err(Misfit));
}

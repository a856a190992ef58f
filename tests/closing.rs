//! What a run comes to: largest values, root mean squares, contacts, the energy of the integrator.

use crate::support::{TestRecording, load, run, run_scene};
use looselink::simulate::{Peak, Report};

const FROM: f64 = 0.004;

/// Compares a peak with the rows of a channel, as magnitudes.
#[track_caller]
fn check(peak: &Peak, t: &[f64], values: &[f64], from: f64) {
    let rows = t.iter().zip(values).filter(|(t, _)| **t >= from);
    let (mut largest, mut at, mut squares, mut count) = (0.0, 0.0, 0.0, 0);
    for (t, value) in rows {
        squares += value * value;
        count += 1;
        if value.abs() > largest {
            (largest, at) = (value.abs(), *t);
        }
    }
    assert_eq!((peak.largest, peak.t), (largest, at));
    let rms = (squares / f64::from(count)).sqrt();
    assert!((peak.rms - rms).abs() <= 1e-12 * rms, "{} {rms}", peak.rms);
}

fn product(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a * b).collect()
}

fn case4(from: f64) -> (TestRecording, Report) {
    run(
        "3rrr/case4.toml",
        &[
            "simulation.duration=0.01",
            "output.channels=[\"*\"]",
            &format!("output.extremes_from={from}"),
        ],
    )
}

/// Rows from a time on, of a body that is driven, of actuated joints and of ideal ones; extremes of channels likewise.
#[test]
fn a_run_comes_to_what_its_rows_say() {
    for from in [0.0, FROM] {
        let (run, report) = case4(from);
        let t = run.get("t");
        let closing = &report.closing;
        let [x, y] = ["error.x", "error.y"].map(|c| run.get(c));
        let distances = x.iter().zip(&y).map(|(x, y)| x.hypot(*y));
        let distances: Vec<f64> = distances.collect();
        let platform = &closing.errors["platform"];
        check(&platform.position, &t, &distances, from);
        check(&platform.angle, &t, &run.get("error.theta"), from);
        for joint in ["A1", "A2", "A3"] {
            check(
                &closing.forces[joint],
                &t,
                &run.get(&format!("{joint}.force")),
                from,
            );
            let drive = &closing.drives[joint];
            let [torque, speed] = ["torque", "speed"].map(|c| run.get(&format!("{joint}.{c}")));
            check(&drive.torque, &t, &torque, from);
            check(&drive.power.unwrap(), &t, &product(&torque, &speed), from);
        }
        for (name, extreme) in &report.extremes {
            let rows = t.iter().zip(run.get(name)).filter(|(t, _)| **t >= from);
            let least = rows.clone().map(|(_, x)| x).fold(f64::INFINITY, f64::min);
            let greatest = rows.map(|(_, x)| x).fold(f64::NEG_INFINITY, f64::max);
            assert_eq!((extreme.min, extreme.max), (least, greatest), "{name}");
        }
    }
}

/// Forces of loose joints count at the end of every step, and contacts from their onset to their end.
#[test]
fn contacts_count_whole() {
    for from in [0.0, FROM] {
        let (run, report) = case4(from);
        let end = report.t;
        for (joint, found) in &report.closing.contacts {
            let own: Vec<_> = run.onsets.iter().filter(|c| c.joint == *joint).collect();
            let late = own.iter().filter(|c| c.t >= from);
            assert_eq!(found.impacts, late.clone().count() as u64);
            let closed: f64 = own
                .iter()
                .map(|c| (c.end.unwrap_or(end) - c.t.max(from)).max(0.0))
                .sum();
            assert!((found.closed - closed).abs() < 1e-15, "{joint}");
            let largest = late.map(|c| c.largest_force).fold(0.0, f64::max);
            let force = &report.closing.forces[joint];
            assert!(force.largest >= largest && largest > 0.0, "{joint}");
            if let Some(later) = force.after_first_impact {
                let first = own
                    .iter()
                    .map(|c| c.end.unwrap())
                    .fold(f64::INFINITY, f64::min);
                assert!(later < force.largest && force.t < first, "{joint}");
            }
        }
        assert_eq!(report.closing.contacts.len(), 6);
    }
}

/// The largest force of a contact that lasts as long as the run has the time at which it acts, not that of the onset.
#[test]
fn the_peak_of_a_long_contact_has_its_own_time() {
    let (run, report) = run(
        "slider-crank/loose.toml",
        &[
            "initial.journals=pressed",
            "simulation.gravity=[0.0, -9.81]",
            "simulation.duration=0.004",
            "output.interval=1e-5",
            "integrator.step=1e-5",
            "output.channels=[\"*\"]",
        ],
    );
    let lasting = |joint: &str| run.onsets.iter().filter(|c| c.joint == joint).count() == 1;
    let contacts = report.closing.contacts.iter();
    let joints: Vec<_> = contacts
        .filter(|(joint, c)| lasting(joint) && c.closed == report.t)
        .collect();
    assert!(!joints.is_empty(), "{:?}", report.closing.contacts);
    for (joint, _) in joints {
        let peak = &report.closing.forces[joint];
        let forces = run.get(&format!("{joint}.force"));
        assert!(
            peak.t > 0.0 && peak.largest > 1.01 * forces[0],
            "{joint} {peak:?}"
        );
        check(peak, &run.get("t"), &forces, 0.0);
    }
}

/// The journal of the slider pin starts in the middle and falls on its bearing: the start decides the largest force.
#[test]
fn a_peak_of_the_first_impact_is_told() {
    let changes = ["simulation.duration=0.01", "output.channels=[\"*\"]"];
    let (run, report) = run("slider-crank/loose.toml", &changes);
    let first = &run.onsets[0];
    let force = &report.closing.forces["slider_pin"];
    assert_eq!(force.largest, first.largest_force);
    let later = run.onsets[1..].iter().map(|c| c.largest_force);
    let later = later.fold(0.0, f64::max);
    assert_eq!(force.after_first_impact, Some(later));
    let told = |report: &Report| {
        let notes = report.notes();
        notes
            .iter()
            .any(|note| note.contains("falls into the first impact"))
    };
    assert!(told(&report));
    let late = [&changes[..], &["output.extremes_from=0.004"]].concat();
    let late = run_scene(&load("slider-crank/loose.toml", &late)).1;
    assert!(!told(&late));
    let pressed = [&changes[..], &["initial.journals=\"pressed\""]].concat();
    let pressed = run_scene(&load("slider-crank/loose.toml", &pressed)).1;
    assert!(!told(&pressed));
}

/// One percentage: of the impacts where there are any, of what else is dissipated, of the motion.
#[test]
fn the_energy_of_the_integrator_is_one_part_of_the_whole() {
    let (_, sound) = run(
        "pendulum.toml",
        &["simulation.duration=0.5", "output.interval=0.01"],
    );
    let with = |contacts: f64, damping: f64, ended: u64| {
        let mut report = sound.clone();
        let ledger = report.ledger.as_mut().unwrap();
        (ledger.contact_dissipated, ledger.damping_dissipated) = (contacts, damping);
        ledger.numerical = -0.5;
        report.integration.as_mut().unwrap().turnover = 100.0;
        report.ended_contacts = ended;
        let error = report.energy_error().unwrap();
        assert_eq!(error.lost, -0.5);
        let warnings = report.error_warnings();
        let told = warnings
            .iter()
            .filter(|w| w.contains(&error.text()))
            .count();
        assert_eq!(told, usize::from(error.part > 0.05), "{warnings:?}");
        (error.part, error.of)
    };
    assert_eq!(with(5.0, 45.0, 1), (0.1, "what the contacts dissipate"));
    assert_eq!(with(5.0, 45.0, 0), (0.01, "the dissipated energy"));
    assert_eq!(with(0.0, 50.0, 1), (0.01, "the dissipated energy"));
    assert_eq!(with(5.0, 0.0, 0), (0.005, "the energy of the motion"));
}

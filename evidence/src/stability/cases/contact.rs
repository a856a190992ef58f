//! Contacts and friction at their limits.

use super::{amplitude, apart, column, imbalance, order, refined, run, try_run, yes};
use crate::stability::outcome::{largest, limits};

const JOURNAL: &str = "bouncing-journal.toml";
const GRAZING: &str = "hard/grazing.toml";
const SLIDING: &str = "hard/stick-slip.toml";

pub(super) fn restitution() -> Vec<f64> {
    let flores = [1e-3, 3e-3, 1e-2, 3e-2, 1e-1, 3e-1, 1.0].map(|restitution| {
        let law = "contacts.aluminium.law=flores; contacts.aluminium.restitution";
        let rows = "output.interval=2e-4; integrator.step=4e-7";
        imbalance(&run(JOURNAL, &format!("{law}={restitution}; {rows}")).1)
    });
    let stiff = [1e8, 1e10, 1e12, 1e14, 1e16, 1e17].map(|stiffness: f64| {
        // a step of 1/60 of the first contact, which lasts as K^-0.4
        let step = 2e-4 / (2e-4 / (8e-7 * (1.1e11 / stiffness).powf(0.4))).ceil();
        let contact = format!(
            "contacts.aluminium={{ law = \"lankarani_nikravesh\", bearing_radius = 0.010, \
             clearance = 2e-5, stiffness = {stiffness:e}, exponent = 1.5, restitution = 0.9, \
             impact_velocity_floor = 1e-6 }}"
        );
        let rows = "output.interval=2e-4; integrator.step";
        imbalance(&run(JOURNAL, &format!("{contact}; {rows}={step:e}")).1)
    });
    vec![largest(flores), largest(stiff)]
}

/// Six journals in bearings of their own that hit within one step, each at an instant of its own: the time from the first to the
/// last over the step, the largest error of these instants \[s\], and by how much their ratios of rebound differ.
fn six_at_once() -> [f64; 3] {
    let speeds: [f64; 6] = std::array::from_fn(|k| 0.02 * (1.0 + 1e-4 * k as f64));
    let mut settings = "simulation.duration=1.2e-3; output.channels=[\"*.vx\"]".to_owned();
    for (k, speed) in speeds.iter().enumerate().skip(1) {
        settings += &format!(
            "; bodies.journal{k}={{ type = \"rigid_body\", mass = 0.05, inertia = 2.49e-6, points.center = [0.0, 0.0] }}\
             ; joints.pin{k}={{ type = \"revolute\", bearing = \"ground.bearing\", journal = \"journal{k}.center\", \
             model = \"clearance\", contact = \"aluminium\" }}\
             ; initial.bodies.journal{k}={{ x = 0.0, y = 0.0, theta = 0.0, vx = {speed}, vy = 0.0, omega = 0.0 }}"
        );
    }
    let (recording, _) = run(JOURNAL, &settings);
    let onsets = &recording.onsets;
    assert_eq!(onsets.len(), speeds.len(), "one impact each");
    // the fastest is the last of the scene
    let arrivals = speeds.iter().rev().map(|speed| 2e-5 / speed);
    let errors = onsets.iter().zip(arrivals).map(|(onset, t)| onset.t - t);
    let [least, greatest] = limits(speeds.iter().enumerate().map(|(k, speed)| {
        let name = format!("journal{k}.vx").replace('0', "");
        column(&recording, &name).last().expect("rows") / speed
    }));
    [
        (onsets[5].t - onsets[0].t) / 1.6e-6,
        largest(errors),
        greatest - least,
    ]
}

pub(super) fn onsets() -> Vec<f64> {
    let deepest = ["1e-12", "1e-9", "1e-6"].map(|velocity| {
        let settings = format!(
            "contacts.steel.impact_velocity_floor=1e-12; simulation.duration=0.05; output.interval=1e-3; \
             initial.bodies.journal={{ x = 0.0, y = -2e-5, theta = 0.0, vx = 0.0, vy = -{velocity}, omega = 0.0 }}"
        );
        amplitude(&run(GRAZING, &settings).0, "pin.penetration")
    });
    let weight = (0.05_f64 * 9.81 / 1.7e11).powf(2.0 / 3.0);
    // all legs alike: the three joints at the cranks close together, and so do those at the platform
    let turning = "drives.input.path={ type = \"coordinates\", x = 0.0, y = 0.0, theta = \
                   { type = \"harmonic\", mean = 0.0, amplitude = 0.3, frequency = 1.0, phase = 0.0 } }; \
                   initial.sketch={ B1 = [-0.3177, 0.0433], B2 = [0.1213, -0.2968], B3 = [0.1963, 0.2535] }; \
                   simulation.duration=0.05; output.interval=1e-3";
    let (together, report) = run("3rrr/case3.toml", turning);
    let spreads = together.onsets.chunks(3).take(4).map(|group| {
        let [first, last] = limits(group.iter().map(|onset| onset.t));
        last - first
    });
    let [within, instants, rebounds] = six_at_once();
    vec![
        largest(deepest) / weight,
        largest(spreads),
        largest(["platform.x", "platform.y"].map(|name| amplitude(&together, name))),
        report.onsets as f64,
        within,
        instants,
        rebounds,
    ]
}

pub(super) fn stick_slip() -> Vec<f64> {
    let settings = |v1: f64, coefficient: f64| {
        format!(
            "simulation.duration=0.2; output.interval=1e-2; output.channels=[\"arm.*\", \"energy.*\"]; \
             contacts.dry.friction={{ law = \"ambrosio\", coefficient = {coefficient}, v0 = 0.0, v1 = {v1:e}, \
             slip = \"material\" }}"
        )
    };
    let rows = |v1, coefficient| run(SLIDING, &settings(v1, coefficient)).0;
    let sharp = rows(1e-5, 0.5);
    let error = |v1| (v1, apart(&rows(v1, 0.5), &sharp, "arm.y"));
    let least = [0.1, 0.5, 1.0, 2.0].map(|coefficient| {
        let rows = rows(1e-4, coefficient);
        let losses = column(&rows, "energy.friction_dissipated").windows(2);
        limits(losses.map(|pair| pair[1] - pair[0]))[0]
    });
    let named = match try_run(SLIDING, &settings(1e-9, 0.5)) {
        Ok((_, report)) => !(report.warnings().is_empty() && report.notes().is_empty()),
        Err(stopped) => stopped.to_string().contains("journal"),
    };
    vec![
        order(error(1e-2), error(1e-3)),
        limits(least)[0],
        yes(named),
    ]
}

pub(super) fn speed() -> Vec<f64> {
    let speeds = [5e3, 1e4, 2e4, 5e4].map(|rpm| {
        let speed = rpm * std::f64::consts::PI / 30.0;
        format!(
            "drives.motor.angle={{ type = \"polynomial\", coefficients = [0.0, {speed}] }}; \
             simulation.duration=1.2e-3; output.interval=1e-4"
        )
    });
    refined(
        "slider-crank/both.toml",
        "slider.x",
        speeds,
        ["2e-7", "5e-8"],
    )
}

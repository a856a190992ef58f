//! Clearance to nothing.

use super::{amplitude, apart, order, run};
use crate::stability::outcome::{largest, limits};

pub(super) fn limit() -> Vec<f64> {
    let settings = "simulation.duration=0.25; output.interval=1e-3; integrator.step=2e-6";
    let (ideal, _) = run("3rrr/case1.toml", settings);
    let runs = [1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9].map(|clearance: f64| {
        let loose = "integrator.onset_tolerance=1e-14; output.channels=[\"platform.x\", \"*.eccentricity\"]; contacts.pin.clearance";
        let (rows, report) = run("3rrr/case3.toml", &format!("{settings}; {loose}={clearance:e}"));
        // pins press into their bearings: at 1 nm by more than the clearance
        let names = rows.names().iter().filter(|name| name.ends_with(".eccentricity"));
        let play = largest(names.map(|name| amplitude(&rows, name)));
        let error = (play, apart(&rows, &ideal, "platform.x"));
        (error, report.newton_iterations as f64)
    });
    let [least, greatest] = limits(runs.windows(2).map(|pair| order(pair[0].0, pair[1].0)));
    let [cheapest, dearest] = limits(runs.map(|run| run.1));
    vec![least, greatest, dearest / cheapest]
}

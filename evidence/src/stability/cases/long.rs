//! Runs of millions of steps.

use super::{column, flexible::fly, imbalance, run};
use crate::stability::outcome::largest;
use looselink::simulate::Report;

pub(super) fn spinning_link() -> Vec<f64> {
    let [linear, gain, _, angular] = fly(5e-4, 500.0, 500);
    vec![linear, gain, angular]
}

/// Case 3: largest change of the length of a passive link \[m\], and the report.
fn case3(duration: f64) -> (f64, Report) {
    let natural = [1, 2, 3].map(|i| format!("; bodies.link{i}.coordinates=natural"));
    let settings = format!(
        "simulation.duration={duration}; output.interval=1e-2; output.channels=[\"points.*\"]{}",
        natural.concat()
    );
    let (recording, report) = run("3rrr/case3.toml", &settings);
    let lengths = [1, 2, 3].map(|i| {
        let [x0, y0, x1, y1] = ["start.x", "start.y", "end.x", "end.y"]
            .map(|point| column(&recording, &format!("points.link{i}.{point}")));
        largest((0..x0.len()).map(|k| (x1[k] - x0[k]).hypot(y1[k] - y0[k]) - 0.242))
    });
    (largest(lengths), report)
}

/// Energy lost by the integrator over that dissipated in contact.
fn share(report: &Report) -> f64 {
    let ledger = report.ledger.as_ref().expect("a dynamic run");
    ledger.numerical / ledger.contact_dissipated
}

pub(super) fn shorter() -> Vec<f64> {
    vec![case3(0.125).0]
}

pub(super) fn ten_million_steps() -> Vec<f64> {
    let (length, rigid) = case3(12.5);
    let (_, flexible) = run(
        "3rrr/case4.toml",
        "simulation.duration=12.5; output.interval=1e-2",
    );
    vec![
        length,
        share(&rigid),
        share(&flexible),
        imbalance(&flexible),
    ]
}

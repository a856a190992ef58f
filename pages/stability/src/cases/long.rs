//! Runs of millions of steps.

use super::schemes::{pendulum, truss, truss_order};
use super::{Check, column, flexible::fly, imbalance, largest, run};
use crate::memory;

pub(super) fn revolutions() -> Vec<Check> {
    let [momentum, gain] = truss(10_000.0, 0.05);
    vec![
        Check::below(
            "Truss, 10,000 turns, 500,000 steps of Bathe's scheme: energy gained, relative",
            gain,
            1e-12,
        ),
        // a period takes 2 pi W^3/288 off an amplitude, W = 2 pi/50: 0.35 in 10,000
        Check::new(
            "The same: angular momentum lost, relative; an oscillator of that period loses 0.35 of its amplitude",
            momentum,
            0.2..=0.6,
        ),
        Check::new(
            "Order in time of the position of its mass",
            truss_order(),
            1.8..=2.2,
        ),
        Check::below(
            "Stiff spring pendulum, 10,000 swings, 7,400,000 steps of Bathe's scheme of 1.6 periods of the spring: energy gained, \
             relative",
            pendulum(10_000.0),
            1e-12,
        ),
    ]
}

pub(super) fn spinning_link() -> Vec<Check> {
    let flight = fly(5e-4, 500.0, 500);
    vec![
        Check::below(
            "1,000,000 steps: change of the velocity of the centre of mass, relative",
            flight.linear,
            1e-9,
        ),
        Check::below("The same: energy gained, relative", flight.gain, 1e-12),
        Check::below(
            "The same: change of angular momentum, relative",
            flight.angular.abs(),
            1e-2,
        ),
    ]
}

/// Largest change of the length of a passive link \[m\], the defect of the ledger \[J\] and what its contacts dissipated \[J\].
fn case3(duration: f64) -> [f64; 3] {
    let duration = format!("simulation.duration={duration}");
    let channels = "output.channels=[\"points.link1.*\", \"points.link2.*\", \"points.link3.*\", \"energy.*\"]";
    let (recording, report) = run(
        "3rrr/case3.toml",
        &[
            &duration,
            "output.interval=1e-2",
            channels,
            "bodies.link1.coordinates=natural",
            "bodies.link2.coordinates=natural",
            "bodies.link3.coordinates=natural",
        ],
    );
    let lengths = [1, 2, 3].map(|i| {
        let [x0, y0, x1, y1] = ["start.x", "start.y", "end.x", "end.y"]
            .map(|point| column(&recording, &format!("points.link{i}.{point}")));
        largest((0..x0.len()).map(|k| (x1[k] - x0[k]).hypot(y1[k] - y0[k]) - 0.242))
    });
    let ledger = report.ledger.expect("a dynamic run");
    [
        largest(lengths),
        ledger.numerical,
        ledger.contact_dissipated,
    ]
}

pub(super) fn shorter() -> Vec<Check> {
    let [length, ..] = case3(0.125);
    vec![Check::below(
        "Case 3, 100,000 steps: largest change of the length of a link [m]",
        length,
        1e-12,
    )]
}

pub(super) fn ten_million_steps() -> Vec<Check> {
    let [length, numerical, dissipated] = case3(12.5);
    let first = memory::resident();
    let (_, report) = run(
        "3rrr/case4.toml",
        &["simulation.duration=12.5", "output.interval=1e-2"],
    );
    let second = memory::resident();
    let ledger = report.ledger.as_ref().expect("a dynamic run");
    vec![
        Check::below(
            "Case 3, 10,000,000 steps: largest change of the length of a link [m]",
            length,
            1e-12,
        ),
        Check::new(
            "The same: energy lost by the integrator over that dissipated in contact",
            numerical / dissipated,
            -0.05..=0.05, // what a warning is given for
        ),
        Check::new(
            "Case 4, 10,000,000 steps: energy lost by the integrator over that dissipated in contact",
            ledger.numerical / ledger.contact_dissipated,
            -0.05..=0.05, // what a warning is given for
        ),
        Check::below(
            "The same: energy lost or gained over the largest kinetic and elastic energy",
            imbalance(&report),
            0.1,
        ),
        Check::below(
            "The same: growth of the memory of the program [MB]",
            (second - first) / 1e6,
            10.0,
        ),
    ]
}

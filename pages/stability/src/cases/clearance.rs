//! Clearance to nothing.

use super::{Check, apart, column, order, run};
use looselink::math::plane::Vec2;
use looselink::simulate::Recording;

const SETTINGS: [&str; 5] = [
    "simulation.duration=0.25",
    "output.interval=1e-3",
    "integrator.step=2e-6",
    "integrator.onset_tolerance=1e-14",
    "output.channels=[\"platform.*\", \"*.theta\", \"*.x\", \"*.y\", \"*.penetration\", \"*.eccentricity\", \"points.*\"]",
];

/// Largest distance over its bound sum_j |J^-1_xj| 2 (c + penetration): J the rates of the lengths of the three passive
/// links by (x, y, theta) of the platform.
fn over_bound(loose: &Recording, ideal: &Recording, clearance: f64) -> f64 {
    let rows = loose.rows();
    let mut worst = 0.0_f64;
    for k in 0..rows {
        let at = |r: &Recording, name: &str| column(r, name)[k];
        let point = |name: &str| {
            let of = |axis: &str| at(ideal, &format!("points.{name}.{axis}"));
            Vec2::new(of("x"), of("y"))
        };
        let centre = Vec2::new(at(ideal, "platform.x"), at(ideal, "platform.y"));
        let rows = [1, 2, 3].map(|i| {
            let (b, c) = (
                point(&format!("link{i}.start")),
                point(&format!("link{i}.end")),
            );
            let along = c - b;
            let u = 1.0 / along.norm() * along;
            [u.x, u.y, (c - centre).perp(&u)]
        });
        // x of the inverse by Cramer's rule: cofactors of the first column
        let cofactor = |i: usize| {
            let [a, b] = [(i + 1) % 3, (i + 2) % 3].map(|j| [rows[j][1], rows[j][2]]);
            a[0] * b[1] - a[1] * b[0]
        };
        let cofactors = [0, 1, 2].map(cofactor);
        let first = [rows[0][0], rows[1][0], rows[2][0]];
        let determinant: f64 = first.iter().zip(cofactors).map(|(x, c)| x * c).sum();
        let penetration = ["B1", "B2", "B3", "C1", "C2", "C3"]
            .map(|joint| at(loose, &format!("{joint}.eccentricity")))
            .into_iter()
            .fold(clearance, f64::max);
        let bound: f64 = cofactors
            .iter()
            .map(|c| (c / determinant).abs() * 2.0 * penetration)
            .sum();
        let error = at(loose, "platform.x") - at(ideal, "platform.x");
        worst = worst.max(error.abs() / bound);
    }
    worst
}

pub(super) fn limit() -> Vec<Check> {
    let (ideal, _) = run(
        "3rrr/case1.toml",
        &SETTINGS[..3]
            .iter()
            .copied()
            .chain(["output.channels=[\"platform.*\", \"points.*\"]"])
            .collect::<Vec<_>>(),
    );
    let loose = |clearance: f64| {
        let set = format!("contacts.pin.clearance={clearance:e}");
        let (recording, report) = run("3rrr/case3.toml", &[&SETTINGS[..], &[&set]].concat());
        let error = apart(&recording, &ideal, "platform.x");
        (
            clearance,
            error,
            over_bound(&recording, &ideal, clearance),
            report,
        )
    };
    let runs = [1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9].map(loose);
    let orders = runs[..4]
        .windows(2)
        .map(|pair| order((pair[0].0, pair[0].1), (pair[1].0, pair[1].1)));
    let orders: Vec<f64> = orders.collect();
    let over = runs.iter().fold(0.0_f64, |m, run| m.max(run.2));
    let cost = runs.iter().map(|run| run.3.newton_iterations as f64);
    let (least, most) = cost.fold((f64::MAX, 0.0_f64), |(a, b), c| (a.min(c), b.max(c)));
    vec![
        Check::new(
            "Order of the difference from the ideal mechanism in the clearance, 1 mm to 1 um: least",
            orders.iter().copied().fold(f64::MAX, f64::min),
            0.9..=1.1,
        ),
        Check::new(
            "The same: greatest",
            orders.iter().copied().fold(0.0, f64::max),
            0.9..=1.1,
        ),
        Check::below(
            "1 mm to 1 nm: difference from the ideal mechanism over the kinematic bound sum abs(J^-1) 2 (c + penetration)",
            over,
            1.0,
        ),
        Check::below(
            "Largest over smallest number of Newton iterations",
            most / least,
            10.0,
        ),
    ]
}

//! Case 2 over 0.1 s: the difference falls at Bathe's order until IDA's own error.

use crate::check::{Agreement, Worst, largest};
use crate::trajectory::{Plan, Trajectory, tolerances};
use miette::Result;
use rayon::prelude::*;

/// Simulated time \[s\].
const DURATION: f64 = 0.1;
/// Time between rows \[s\].
const INTERVAL: f64 = 1e-3;
/// How far an order may be from the 2 of Bathe's scheme.
const ORDER_BAND: f64 = 0.2;

/// What is compared: name, channels, and the size in whose units the difference is given.
pub const QUANTITIES: [(&str, &[&str], bool); 4] = [
    ("platform position [m]", &["error.x", "error.y"], false),
    (
        "platform acceleration",
        &["platform.ax", "platform.ay"],
        true,
    ),
    ("platform angular acceleration", &["platform.alpha"], true),
    ("B1 force", &["B1.fx", "B1.fy"], true),
];

/// Index of the position among them.
const POSITION: usize = 0;
/// Index of the angular acceleration.
const TURNING: usize = 2;

/// All runs with one number of elements.
#[derive(Debug)]
pub struct Convergence {
    /// Elements a link.
    pub elements: usize,
    /// Relative tolerances of IDA, the tightest last; positions are held to 1e-3 m of that, velocities to 0.1 m/s.
    pub relative: [f64; 2],
    /// Steps \[s\], each half of the one before.
    pub steps: Vec<f64>,
    /// The largest step that resolves the highest modes \[s\]: from here on the order of accelerations and forces is that
    /// of the scheme; positions hardly feel those modes.
    pub resolving: f64,
    /// For each quantity, the difference from the tightest run of IDA at each step.
    pub differences: Vec<Vec<f64>>,
    /// For each quantity, the two numbers that differ most at the smallest step.
    pub finest: Vec<Worst>,
    /// For each quantity, the difference of the two runs of IDA.
    pub own: Vec<f64>,
    /// For each quantity, its size.
    pub sizes: Vec<f64>,
}

/// Largest difference over the channels and rows.
fn distance(a: &Trajectory, b: &Trajectory, channels: &[&str]) -> Worst {
    let mut worst = Worst::default();
    for name in channels {
        worst.see_scaled(a.get(name), b.get(name), 1.0);
    }
    worst
}

/// A number of elements, in words.
pub fn elements(n: usize) -> String {
    match n {
        1 => "1 element".to_owned(),
        n => format!("{n} elements"),
    }
}

/// Runs both sides with 1 or 4 elements per link.
///
/// # Errors
/// A run that fails.
pub fn convergence(elements: usize) -> Result<Convergence> {
    let overrides: Vec<String> = (1..=3)
        .map(|link| format!("bodies.link{link}.elements={elements}"))
        .collect();
    let plan = Plan::new("3rrr/case2", DURATION, INTERVAL).with("", &overrides);
    // the highest mode of four elements is some eight times as fast, and costs IDA as many steps
    let (count, resolving, relative) = match elements {
        1 => (5, 1e-6, [1e-11, 1e-12]),
        _ => (6, 1.25e-7, [1e-10, 1e-11]),
    };
    let first = if elements == 1 { 2e-6 } else { 1e-6 };
    let steps: Vec<f64> = (0..count).map(|k| first / f64::from(1 << k)).collect();
    let ida = |relative: f64| plan.cpp(&tolerances(relative, 1e-3 * relative, 0.1 * relative));
    let (cpp, rust): (Result<Vec<_>>, Result<Vec<_>>) = rayon::join(
        || {
            relative
                .par_iter()
                .with_max_len(1)
                .map(|&r| ida(r))
                .collect()
        },
        || {
            steps
                .par_iter()
                .with_max_len(1)
                .map(|&h| plan.rust(h))
                .collect()
        },
    );
    let (cpp, rust) = (cpp?, rust?);
    let tight = &cpp[1];
    let mut result = Convergence {
        elements,
        relative,
        steps,
        resolving,
        differences: Vec::new(),
        finest: Vec::new(),
        own: Vec::new(),
        sizes: Vec::new(),
    };
    for (_, channels, _) in QUANTITIES {
        let each: Vec<Worst> = rust
            .iter()
            .map(|run| distance(run, tight, channels))
            .collect();
        result.finest.extend(each.last());
        result
            .differences
            .push(each.iter().map(|w| w.difference).collect());
        result
            .own
            .push(distance(&cpp[0], tight, channels).difference);
        let size = channels.iter().map(|c| largest(tight.get(c)));
        result.sizes.push(size.fold(0.0, f64::max));
    }
    Ok(result)
}

impl Convergence {
    /// Orders between neighbouring steps that resolve the motion, while the difference stands above IDA's error: twice the
    /// difference of its two runs, which is the error of the looser one; what is compared is the tighter.
    pub fn orders(&self, quantity: usize) -> Vec<f64> {
        let floor = 2.0 * self.own[quantity];
        let first = if quantity == POSITION {
            self.steps[0]
        } else {
            self.resolving
        };
        let steps = self.steps.windows(2);
        let pairs = steps.zip(self.differences[quantity].windows(2));
        pairs
            .filter(|(h, d)| h[0] <= first * 1.001 && d[1] > floor)
            .map(|(_, d)| (d[0] / d[1]).log2())
            .collect()
    }

    /// The rows.
    pub fn agreements(&self) -> Vec<Agreement> {
        let scene = format!("case2, {} per link, {DURATION} s", elements(self.elements));
        let mut rows = Vec::new();
        for (q, (name, _, relative)) in QUANTITIES.into_iter().enumerate() {
            let orders = self.orders(q);
            // without one there is nothing to show: a row that fails
            let orders = if orders.is_empty() {
                vec![f64::NAN]
            } else {
                orders
            };
            for order in orders {
                rows.push(Agreement {
                    quantity: format!("order of the difference in {name}"),
                    scene: scene.clone(),
                    rust: order,
                    cpp: 2.0,
                    difference: (order - 2.0).abs(),
                    tolerance: ORDER_BAND,
                    reason: "Bathe's scheme is of order 2".into(),
                });
            }
            let finest = self.finest[q];
            let (unit, tolerance, measure) = match (relative, q) {
                (false, _) => (1.0, 1e-10, "m"),
                (true, TURNING) => (
                    self.sizes[q],
                    5e-4,
                    "of the largest; the rotation has the highest frequencies",
                ),
                (true, _) => (self.sizes[q], 1e-4, "of the largest"),
            };
            rows.push(Agreement {
                quantity: format!(
                    "{name}, h = {} s",
                    plot::number(self.steps[self.steps.len() - 1], 3)
                ),
                scene: scene.clone(),
                rust: finest.rust,
                cpp: finest.cpp,
                difference: finest.difference / unit,
                tolerance,
                reason: format!("{measure}; the error of Bathe's scheme at this step"),
            });
        }
        rows
    }
}

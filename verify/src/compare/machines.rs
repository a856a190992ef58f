//! Other mechanisms than the 3-RRR in motion.

use super::classes;
use crate::check::{Agreement, Worst};
use crate::trajectory::{Plan, tolerances};
use miette::{Result, miette};

/// Steps of Looselink without clearance \[s\], each half of the one before.
const STEPS: [f64; 2] = [2e-5, 1e-5];
/// Relative tolerance of IDA for it; positions are held to 1e-3 m of that, velocities to 0.1 m/s.
const RELATIVE: f64 = 1e-11;
/// How far an order may be from the 2 of Bathe's scheme.
const ORDER_BAND: f64 = 0.1;

/// Every element but clearance and legs in one motion of half a second: each kind of channel, and the order at which the
/// difference falls.
///
/// # Errors
/// A run that fails.
pub fn smooth() -> Result<Vec<Agreement>> {
    let plan = Plan::new("../verify/scenes/everything", 0.5, 1e-2);
    let tolerances = tolerances(RELATIVE, 1e-3 * RELATIVE, 0.1 * RELATIVE);
    let (cpp, rust) = rayon::join(|| plan.cpp(&tolerances), || STEPS.map(|h| plan.rust(h)));
    let cpp = cpp?;
    let [coarse, fine] = rust;
    let scene = format!("{}, {} s", plan.name(), plan.duration);
    let reason = format!(
        "of the largest of its kind; h = {:.0e} s, IDA relative {RELATIVE:.0e}",
        STEPS[1]
    );
    let [coarse, mut rows] =
        [coarse?, fine?].map(|run| classes::agreements(&scene, &run, &cpp, 1e-6, &reason));
    let orders = coarse.iter().zip(&rows).map(|(coarse, fine)| {
        let order = (coarse.difference / fine.difference).log2();
        Agreement {
            quantity: format!("order of {}", fine.quantity),
            scene: scene.clone(),
            rust: order,
            cpp: 2.0,
            difference: (order - 2.0).abs(),
            tolerance: ORDER_BAND,
            reason: format!("Bathe's scheme, from h = {:.0e} s to the half", STEPS[0]),
        }
    });
    let orders: Vec<Agreement> = orders.collect();
    rows.extend(orders);
    Ok(rows)
}

/// The first impacts of a scene with one loose joint, each to its end.
#[derive(Debug)]
struct Impacts {
    plan: Plan,
    count: usize,
    /// Step of Looselink \[s\].
    step: f64,
    /// Relative tolerance of IDA; positions are held to 1e-3 m of that, velocities to 1 m/s.
    relative: f64,
}

/// Instant, impact velocity, direction of the eccentricity and largest penetration of the first impacts: of the loose
/// slider-crank, and of the body that hangs loosely on a link welded into a frame.
///
/// # Errors
/// A run that fails, or one with fewer impacts.
pub fn impacts() -> Result<Vec<Agreement>> {
    let all = [
        Impacts {
            plan: Plan::new("slider-crank/loose", 1e-3, 1e-4),
            count: 3,
            step: 1e-8,
            relative: 1e-12,
        },
        Impacts {
            plan: Plan::new("frame-with-hanging-body", 0.01, 1e-3),
            count: 2,
            step: 2.5e-8,
            relative: 1e-11,
        },
    ];
    let mut rows = Vec::new();
    for impacts in all {
        rows.extend(impacts.agreements()?);
    }
    Ok(rows)
}

impl Impacts {
    fn agreements(&self) -> Result<Vec<Agreement>> {
        let Impacts {
            plan,
            count,
            step,
            relative,
        } = self;
        let tolerances = tolerances(*relative, 1e-3 * relative, *relative);
        let (cpp, rust) = rayon::join(|| plan.cpp(&tolerances), || plan.rust(*step));
        let (cpp, rust) = (cpp?, rust?);
        let [mut instant, mut velocity, mut angle, mut depth] = [Worst::default(); 4];
        for i in 0..*count {
            let (Some(r), Some(c)) = (rust.impacts.get(i), cpp.impacts.get(i)) else {
                return Err(miette!("{} has fewer than {count} impacts", plan.name()));
            };
            instant.see(r.t, c.t, c.t);
            velocity.see(r.velocity, c.velocity, c.velocity);
            let Some((r, c)) = r.course.zip(c.course) else {
                return Err(miette!("impact {i} of {} does not end", plan.name()));
            };
            angle.see(r[0], c[0], c[0]);
            depth.see(r[1], c[1], c[1]);
        }
        let scene = format!("{}, first {count} impacts", plan.name());
        let reason = format!("relative; h = {step:e} s, IDA relative {relative:.0e}");
        let row = |worst: Worst, quantity: &str| worst.row(quantity, &scene, 1e-7, &reason);
        Ok(vec![
            row(instant, "instants of the impacts [s]"),
            row(velocity, "impact velocities [m/s]"),
            row(angle, "directions of the eccentricity [rad]"),
            row(depth, "deepest penetrations [m]"),
        ])
    }
}

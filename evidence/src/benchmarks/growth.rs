//! How compilation, a step and memory grow with the number of bodies of a mechanism.

use crate::benchmarks::count;
use crate::benchmarks::family::Family;
use clap::ValueEnum;
use cpu_time::ThreadTime;
use looselink::scene::Scene;
use looselink::simulate::Simulation;
use miette::{IntoDiagnostic, Result, WrapErr, miette};
use records::Journal;
use serde::{Deserialize, Serialize};
use std::process::Command;
use studies::machine::median;

/// Numbers of bodies.
pub const SIZES: [usize; 6] = [20, 200, 2_000, 5_000, 10_000, 20_000];
/// Numbers of bodies for which instructions are counted: the ends of the largest decade.
const COUNTED: [usize; 2] = [2_000, 20_000];
/// Step \[s\].
pub const STEP: f64 = 1e-5;
/// Steps that are timed.
pub const STEPS: usize = 20;
/// Runs whose times have the median that counts.
const REPEATS: u16 = 3;

/// A mechanism and what it costs.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct SizeCost {
    /// Its kind.
    pub family: Family,
    /// Number of bodies.
    pub bodies: usize,
    /// Processor time from the scene as text to the start of the run \[s\].
    pub compile: f64,
    /// Processor time of a step \[s\].
    pub step: f64,
    /// Instructions of a step, where they are counted.
    pub instructions: Option<u64>,
    /// Largest memory of the process \[bytes\]; absent where the system does not tell.
    pub memory: Option<u64>,
}

/// A cost of a mechanism, where it is known.
pub type SizeOf = dyn Fn(&SizeCost) -> Option<f64>;

/// Measures mechanisms of all kinds and sizes.
///
/// # Errors
/// When one of them fails.
pub fn all(journal: &Journal) -> Result<Vec<SizeCost>> {
    let sizes = Family::ALL
        .iter()
        .flat_map(|family| SIZES.map(|bodies| (*family, bodies)));
    let costs = sizes.map(|(family, bodies)| {
        journal.item(&format!("{}, {bodies} bodies", family.name()), || {
            let mut cost = apart(family, bodies)?;
            if COUNTED.contains(&bodies) {
                let inside = count::instructions_inside(count::RUN, &command(family, bodies, 1)?)?;
                cost.instructions = Some(inside / STEPS as u64);
            }
            Ok(cost)
        })
    });
    costs.collect()
}

/// Measures a mechanism in a process of its own, so that its memory is that of this mechanism.
///
/// # Errors
/// When the process fails.
fn apart(family: Family, bodies: usize) -> Result<SizeCost> {
    let output = command(family, bodies, REPEATS)?
        .output()
        .into_diagnostic()?;
    if !output.status.success() {
        let said = String::from_utf8_lossy(&output.stderr);
        let name = family.name();
        return Err(miette!("{name}, {bodies} bodies, failed:\n{said}"));
    }
    serde_json::from_slice(&output.stdout)
        .into_diagnostic()
        .wrap_err("the cost of a mechanism cannot be read")
}

/// This program, measuring one mechanism.
fn command(family: Family, bodies: usize, repeats: u16) -> Result<Command> {
    let mut command = Command::new(std::env::current_exe().into_diagnostic()?);
    let family = family.to_possible_value().expect("no kind is skipped");
    command.args(["size", family.get_name()]);
    command.args([bodies.to_string(), repeats.to_string()]);
    Ok(command)
}

/// Measures a mechanism in this process and prints what it costs.
///
/// # Errors
/// When its run fails.
pub fn print(family: Family, bodies: usize, repeats: u16) -> Result<()> {
    let cost = measure(family, bodies, repeats)?;
    println!("{}", serde_json::to_string(&cost).into_diagnostic()?);
    Ok(())
}

/// Medians of some runs.
fn measure(family: Family, bodies: usize, repeats: u16) -> Result<SizeCost> {
    let text = family.scene(bodies);
    let (mut compile, mut step) = (Vec::new(), Vec::new());
    for _ in 0..repeats {
        let clock = ThreadTime::now();
        let scene = Scene::parse("mechanism.toml", &text, &[])?;
        let mut simulation = Simulation::new(&scene)?;
        compile.push(clock.elapsed().as_secs_f64());
        let clock = ThreadTime::now();
        simulation.run(&mut ()).into_diagnostic()?;
        step.push(clock.elapsed().as_secs_f64() / STEPS as f64);
    }
    Ok(SizeCost {
        family,
        bodies,
        compile: median(&compile),
        step: median(&step),
        instructions: None,
        memory: largest_memory(),
    })
}

/// The largest memory that this process has had, where Linux tells it \[bytes\].
fn largest_memory() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|line| line.starts_with("VmHWM:"))?;
    let kibibytes: u64 = line.split_whitespace().nth(1)?.parse().ok()?;
    Some(1024 * kibibytes)
}

/// Exponent of a cost over the largest decade of sizes: the slope of the straight line through the logarithms.
pub fn exponent(sizes: &[f64], costs: &[f64]) -> f64 {
    let from = 0.1 * sizes.iter().copied().fold(0.0, f64::max);
    let points = sizes.iter().zip(costs).filter(|(size, _)| **size >= from);
    let points: Vec<(f64, f64)> = points.map(|(x, y)| (x.ln(), y.ln())).collect();
    let mean =
        |of: &dyn Fn(&(f64, f64)) -> f64| points.iter().map(of).sum::<f64>() / points.len() as f64;
    let (x, y) = (mean(&|p| p.0), mean(&|p| p.1));
    mean(&|p| (p.0 - x) * (p.1 - y)) / mean(&|p| (p.0 - x) * (p.0 - x))
}

#[cfg(test)]
mod tests {
    use super::{Family, exponent, measure};

    #[test]
    fn the_exponent_is_that_of_a_power() {
        let sizes = [1.0, 10.0, 30.0, 100.0];
        let costs = sizes.map(|n| {
            if n < 10.0 {
                7.0
            } else {
                2.0 * f64::powf(n, 1.25)
            }
        });
        assert!((exponent(&sizes, &costs) - 1.25).abs() < 1e-12);
    }

    #[test]
    fn mechanisms_of_all_kinds_run() {
        for family in Family::ALL {
            let cost = measure(family, 20, 1).expect("a small mechanism runs");
            assert!(cost.compile > 0.0 && cost.step > 0.0);
        }
    }
}

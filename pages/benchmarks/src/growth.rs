//! How compilation, a step and memory grow with the number of links of a hanging chain.

use crate::count;
use cpu_time::ThreadTime;
use looselink::scene::Scene;
use looselink::simulate::Simulation;
use miette::{IntoDiagnostic, Result, WrapErr, miette};
use serde::{Deserialize, Serialize};
use std::fmt::Write;
use std::process::Command;
use studies::machine::median;

/// Numbers of links.
pub const SIZES: [usize; 6] = [20, 200, 2_000, 5_000, 10_000, 20_000];
/// Numbers of links for which instructions are counted: the ends of the largest decade.
const COUNTED: [usize; 2] = [2_000, 20_000];
/// Step \[s\], and how many are timed.
pub const STEP: f64 = 1e-5;
pub const STEPS: usize = 20;
/// Runs of a chain whose times have the median that counts.
const REPEATS: u16 = 3;
/// The function that a run is inside of from its first row to its last.
const RUN: &str = "*Simulation*run_to_end*";

/// A chain and what it costs.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct ChainCost {
    /// Number of links.
    pub links: usize,
    /// True with play in every joint.
    pub loose: bool,
    /// Processor time from the scene as text to the start of the run \[s\].
    pub compile: f64,
    /// Processor time of a step \[s\].
    pub step: f64,
    /// Instructions of a step, where they are counted.
    pub instructions: Option<u64>,
    /// Largest memory of the process \[bytes\]; absent where the system does not tell.
    pub memory: Option<u64>,
}

/// The kind of chain, in words.
pub fn name(loose: bool) -> &'static str {
    match loose {
        true => "with play",
        false => "ideal joints",
    }
}

/// Measures chains of all sizes.
///
/// # Errors
/// When one of them fails.
pub fn all() -> Result<Vec<ChainCost>> {
    let mut chains = Vec::new();
    for loose in [false, true] {
        for links in SIZES {
            eprintln!("chain of {links} links, {}", name(loose));
            let mut cost = apart(links, loose)?;
            if COUNTED.contains(&links) {
                let inside = count::instructions_inside(RUN, &command(links, loose, 1)?)?;
                cost.instructions = Some(inside / STEPS as u64);
            }
            chains.push(cost);
        }
    }
    Ok(chains)
}

/// Measures a chain in a process of its own, so that its memory is that of this chain.
///
/// # Errors
/// When the process fails.
pub fn apart(links: usize, loose: bool) -> Result<ChainCost> {
    let output = command(links, loose, REPEATS)?.output().into_diagnostic()?;
    if !output.status.success() {
        let said = String::from_utf8_lossy(&output.stderr);
        return Err(miette!("the chain of {links} links failed:\n{said}"));
    }
    serde_json::from_slice(&output.stdout)
        .into_diagnostic()
        .wrap_err("the cost of a chain cannot be read")
}

/// This program, measuring one chain.
fn command(links: usize, loose: bool, repeats: u16) -> Result<Command> {
    let mut command = Command::new(std::env::current_exe().into_diagnostic()?);
    command.args(["chain", &links.to_string()]);
    command.args(["--repeats", &repeats.to_string()]);
    if loose {
        command.arg("--loose");
    }
    Ok(command)
}

/// Measures a chain in this process: medians of some runs.
///
/// # Errors
/// When its run fails.
pub fn measure(links: usize, loose: bool, repeats: u16) -> Result<ChainCost> {
    let text = scene(links, loose);
    let (mut compile, mut step) = (Vec::new(), Vec::new());
    for _ in 0..repeats {
        let clock = ThreadTime::now();
        let scene = Scene::parse("chain.toml", &text, &[]).map_err(|e| miette!("{e}"))?;
        let mut simulation = Simulation::new(&scene).map_err(|e| miette!("{e}"))?;
        compile.push(clock.elapsed().as_secs_f64());
        let clock = ThreadTime::now();
        simulation.run(&mut ()).map_err(|e| miette!("{e}"))?;
        step.push(clock.elapsed().as_secs_f64() / STEPS as f64);
    }
    Ok(ChainCost {
        links,
        loose,
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

/// A chain of rigid links that starts horizontally, at rest.
fn scene(links: usize, loose: bool) -> String {
    let mut text = format!(
        r#"format = 1
title = "chain"
simulation = {{ duration = {}, gravity = [0.0, -9.81] }}
integrator = {{ method = "bathe", step = {STEP}, newton_tolerance = 1e-10, onset_tolerance = 1e-12 }}
output = {{ interval = {}, channels = ["energy.*"] }}
bodies.ground = {{ type = "ground", points.O = [0.0, 0.0] }}
materials.steel = {{ density = 7850.0, youngs_modulus = 2e11, poissons_ratio = 0.3 }}
contacts.pin = {{ law = "lankarani_nikravesh", bearing_radius = 0.01, clearance = 1e-5, bearing_material = "steel", journal_material = "steel", exponent = 1.5, restitution = 0.9, impact_velocity_floor = 1e-6 }}
"#,
        STEP * STEPS as f64,
        STEP * STEPS as f64,
    );
    let model = match loose {
        true => r#"model = "clearance", contact = "pin""#,
        false => r#"model = "ideal""#,
    };
    for k in 0..links {
        let bearing = match k {
            0 => "ground.O".to_owned(),
            _ => format!("link{}.b", k - 1),
        };
        writeln!(
            text,
            r#"bodies.link{k} = {{ type = "rigid_body", mass = 0.1, inertia = 1e-4, points.a = [-0.05, 0.0], points.b = [0.05, 0.0] }}
joints.j{k} = {{ type = "revolute", bearing = "{bearing}", journal = "link{k}.a", {model} }}
initial.bodies.link{k} = {{ x = {}, y = 0.0, theta = 0.0 }}"#,
            0.05 + 0.1 * k as f64
        )
        .expect("a string takes any text");
    }
    text
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
    use super::{exponent, measure};

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
    fn chains_run() {
        for loose in [false, true] {
            let cost = measure(3, loose, 1).expect("a chain runs");
            assert!(cost.compile > 0.0 && cost.step > 0.0);
        }
    }
}

//! Compares both programs on a scene of your own.

use clap::Parser;
use looselink::scene::{Analysis, Scene};
use looselink::simulate::Simulation;
use miette::{Result, WrapErr};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use verify::check::{Agreement, Standing};
use verify::compare::{equations, machines, scenes};

/// Prints how both programs agree on a scene. Exit codes: 0 all agree, 1 some differ, 2 not compared.
#[derive(Parser)]
struct Arguments {
    /// The scene.
    scene: PathBuf,
}

fn main() -> ExitCode {
    own(&Arguments::parse().scene).unwrap_or_else(|error| {
        eprintln!("{error:?}");
        ExitCode::from(2)
    })
}

/// Compares a scene as its user wrote it: start, equations and first rows, or equilibria.
fn own(path: &Path) -> Result<ExitCode> {
    let scene = Scene::load(path, &[])?;
    Simulation::new(&scene)?;
    let plan = scenes::as_written(path.display().to_string(), &scene);
    plan.reference()
        .wrap_err("Looselink accepts this scene, but the reference refuses it")?;
    let mut rows = show("Start", scenes::start(&plan)?);
    if !rows[0].holds() {
        println!(
            "\nThe starts differ, and the remaining comparisons are skipped. A sketch that leaves the mechanism free to move \
             determines the start only roughly: give an angle or a state."
        );
    } else if scene.simulation.analysis == Analysis::Static {
        rows.extend(show("Equilibria at all loads", scenes::equilibrium(&plan)?));
    } else {
        let equations = equations::agreements(&plan)?;
        rows.extend(show(
            "Equations at 50 random states near the motion",
            equations,
        ));
        let motion = format!(
            "Motion up to {} s of {} s",
            plan.duration, scene.simulation.duration
        );
        match scene.smallest_clearance() {
            None => rows.extend(show(&motion, machines::motion(&plan)?)),
            Some(_) => println!("\nMotion and impacts: not compared, since a joint has clearance"),
        }
    }
    let failed = rows.iter().any(|row| !row.holds());
    rows.retain(Agreement::counts);
    let (hold, count) = (rows.iter().filter(|row| row.holds()).count(), rows.len());
    println!(
        "\n{hold} of {count} comparisons agree; those marked ~ do not count. They check the model, not the accuracy of the time step of your scene."
    );
    Ok(ExitCode::from(u8::from(failed)))
}

/// Prints rows below a title.
fn show(title: &str, rows: Vec<Agreement>) -> Vec<Agreement> {
    println!("\n{title}\n  difference  allowed");
    let shown = |row: &&Agreement| row.standing != Standing::Zero || !row.holds();
    for row in rows.iter().filter(shown) {
        let [difference, allowed] = [row.difference, row.tolerance].map(|x| numbers::number(x, 2));
        let (mark, values) = match (row.holds(), row.counts()) {
            (true, true) => (' ', String::new()),
            (true, false) => ('~', String::new()),
            (false, _) => ('!', format!(": {:e} and {:e}", row.rust, row.cpp)),
        };
        let Agreement {
            quantity, reason, ..
        } = row;
        println!("{mark} {difference:>10} {allowed:>8}  {quantity}{values} ({reason})");
    }
    rows
}

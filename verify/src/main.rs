//! Writes verify/REPORT.md and its pictures.

use clap::Parser;
use looselink::scene::{Analysis, Scene};
use looselink::simulate::Simulation;
use miette::{IntoDiagnostic, Result, WrapErr};
use plot::save;
use records::RunningCampaign;
use records::root;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use verify::check::{Agreement, Standing};
use verify::compare::scenes::ROWS;
use verify::compare::{equations, flexible, impacts, machines, rigid, scenes, statistics};
use verify::figures::{self, overlay};
use verify::report::ComparisonReport;
use verify::trajectory::ComparisonPlan;

const STARTS: &str = "Both programs read the file, assemble the mechanism and find its velocities, accelerations and channels. In all \
    tables the two values are those at the place of the largest difference; the last two columns have what is allowed, the \
    measure of the difference and the reason of the tolerance.";
const EQUATIONS: &str = "Equations are compared at 50 states along the first part of the motion, in the coordinates that each scene has \
    when it is run. Scenes in which a rigid body has the coordinates of its centre or of the joint that holds it are compared in \
    natural coordinates too. Every coordinate is displaced at \
    random: by up to 0.2 mm in scenes with inverse kinematics, by up to three clearances in other scenes with clearance, and \
    otherwise by up to 0.1 m or 0.1 rad times a random factor between 1e-8 and 1. Rates, impact velocities and accelerations of known \
    coordinates are random. The reference has separate coordinates Q for every body. They are functions Q(q) of Looselink's \
    coordinates, whose derivatives J = dQ/dq make JᵀMJ of the mass matrix of the reference, Jᵀ(f + M dJ/dt v) of its forces, and \
    likewise its tangents. Elongations of Maxwell elements are among the coordinates. [everything](scenes/everything.toml) has \
    every kind of body, joint, force, damping and prescribed motion except clearance, inverse kinematics and Maxwell elements.";
const IMPACTS: &str = "Impacts are compared one by one, in the order in which they occur; channels are compared up to the last of \
    these impacts. The scenes are cases 3 and 4, a slider-crank with one loose joint, and a body that hangs by a loose joint on a \
    welded flexible link.";
const OTHERS: &str = "The scene [everything](scenes/everything.toml) is compared with two steps, which give the order at which the \
    difference falls. Static scenes are compared at all their equilibria. Every scene without clearance is compared over its first \
    twenty output intervals, each channel in units of its own range. Two scenes with fine meshes follow, for which the reference uses KLU.";
const CYCLES: &str = "Loose joints are chaotic: after some tens of milliseconds two runs have no impact in common, even two runs of \
    the same program. Means, extremes and energies of cycles 2 and 3 are compared instead. Looselink uses the scenes' step of \
    1.25 µs, IDA a relative tolerance of 1e-7.";

/// Compares the two programs and writes verify/REPORT.md.
#[derive(Parser)]
struct Arguments {
    /// Prints how the two agree on a scene of your own instead. Exit codes: 0 all agree, 1 some differ, 2 not compared.
    scene: Option<PathBuf>,
}

fn main() -> Result<ExitCode> {
    if let Some(path) = Arguments::parse().scene {
        return Ok(own(&path).unwrap_or_else(|error| {
            eprintln!("{error:?}");
            ExitCode::from(2)
        }));
    }
    let campaign = RunningCampaign::begin("comparison")?;
    let folder = root().join("verify");
    let pictures = &folder.join("figures");
    let mut others = machines::smooth()?;
    others.extend(all(
        "equilibria",
        scenes::of(Analysis::Static)?,
        scenes::equilibrium,
    )?);
    others.extend(all("first rows", machines::plans()?, machines::first_rows)?);
    others.extend(all(
        "fine meshes",
        machines::fine_meshes(),
        machines::first_rows,
    )?);
    #[rustfmt::skip]
    let sections = vec![
        ("Every scene: its start", STARTS.into(), all("starts", scenes::all()?, scenes::start)?),
        ("Equations", EQUATIONS.into(), all("equations", equations::plans()?, equations::agreements)?),
        ideal(pictures)?,
        ("The first impacts", IMPACTS.into(), all("impacts", impacts::all(), impacts::ImpactSeries::agreements)?),
        ("Other mechanisms", OTHERS.into(), others),
        ("Two cycles of cases 3 and 4", CYCLES.into(), all("cycles", vec![3, 4], |c| statistics::agreements(*c))?),
    ];
    trajectories(pictures)?;
    let faults = ladder::faults::judged()?;
    let report = ComparisonReport { sections, faults };
    let path = folder.join("REPORT.md");
    fs::write(&path, report.page().into_diagnostic()?)
        .into_diagnostic()
        .wrap_err_with(|| format!("cannot write {}", path.display()))?;
    campaign.finish()?;
    let rows = report.sections.iter().flat_map(|section| &section.2);
    let failed = rows.filter(|row| !row.holds());
    let named = failed.map(|row| eprintln!("does not hold: {} of {}", row.quantity, row.scene));
    Ok(ExitCode::from(u8::from(named.count() > 0)))
}

/// Compares a scene as its user wrote it: start, equations and first rows, or equilibria.
fn own(path: &Path) -> Result<ExitCode> {
    let scene = Scene::load(path, &[])?;
    Simulation::new(&scene)?;
    let (duration, interval) = (scene.simulation.duration, scene.output.interval);
    let is_static = scene.simulation.analysis == Analysis::Static;
    let most = if is_static { f64::INFINITY } else { ROWS };
    let end = duration.min(most * interval);
    let plan = ComparisonPlan::of_file(path, &[], end, interval);
    plan.reference()
        .wrap_err("Looselink accepts this scene, but the reference refuses it")?;
    let mut rows = show("Start", scenes::start(&plan)?);
    if !rows[0].holds() {
        println!(
            "\nThe starts differ, and the remaining comparisons are skipped. A sketch that leaves the mechanism free to move \
             determines the start only roughly: give an angle or a state."
        );
    } else if is_static {
        rows.extend(show("Equilibria at all loads", scenes::equilibrium(&plan)?));
    } else {
        let equations = equations::agreements(&plan)?;
        rows.extend(show(
            "Equations at 50 random states near the motion",
            equations,
        ));
        let motion = format!(
            "Motion up to {end} s of {duration} s ({} output intervals)",
            (end / interval).round()
        );
        match scene.smallest_clearance() {
            None => rows.extend(show(&motion, machines::first_rows(&plan)?)),
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
    for row in rows
        .iter()
        .filter(|row| row.standing != Standing::Zero || !row.holds())
    {
        let [difference, allowed] = [row.difference, row.tolerance].map(|x| numbers::number(x, 2));
        let (mark, values) = match (row.holds(), row.counts()) {
            (true, true) => (' ', String::new()),
            (true, false) => ('~', String::new()),
            (false, _) => ('!', format!(": {:e} and {:e}", row.rust, row.cpp)),
        };
        println!(
            "{mark} {difference:>10} {allowed:>8}  {}{values} ({})",
            row.quantity, row.reason
        );
    }
    rows
}

type ReportSection = (&'static str, String, Vec<Agreement>);

/// The rows of all things to compare.
fn all<T>(
    what: &str,
    things: Vec<T>,
    rows: impl Fn(&T) -> Result<Vec<Agreement>>,
) -> Result<Vec<Agreement>> {
    eprintln!("{what}");
    let each = things.iter().map(rows).collect::<Result<Vec<_>>>()?;
    Ok(each.concat())
}

fn ideal(pictures: &Path) -> Result<ReportSection> {
    let mut rows = rigid::agreements()?;
    let runs = [1, 4].map(flexible::convergence);
    let runs = runs.into_iter().collect::<Result<Vec<_>>>()?;
    rows.extend(runs.iter().flat_map(flexible::Convergence::agreements));
    save(&figures::convergence(&runs), pictures, "convergence")?;
    let own = runs.iter().map(|run| {
        let [position, acceleration, _, force] = [0, 1, 2, 3].map(|q| run.curves[q].own);
        let [coarse, fine] = run.relative;
        format!(
            "{}, relative tolerance {coarse:.0e} against {fine:.0e}: {position:.0e} m in position, {acceleration:.0e} m/s² in \
             acceleration, {force:.0e} N in B1",
            run.name()
        )
    });
    let own: Vec<String> = own.collect();
    let text = format!(
        "Case 2: the difference from IDA falls with the square of Looselink's step. The error of IDA is estimated by the \
         difference between its runs with two tolerances: {}. Looselink is compared with the tighter run. An order is listed \
         for steps that resolve the highest modes and for differences above twice the error of IDA.",
        own.join("; ")
    );
    Ok(("Cases 1 and 2: ideal joints", text, rows))
}

/// Overlays and differences of cases 2, 3 and 4.
fn trajectories(pictures: &Path) -> Result<()> {
    let horizon = "The difference starts at rounding level, grows with every impact and reaches the size of the motion; a \
                   smaller step delays this.";
    let smooth = "Without impacts the difference grows with time only.";
    for (name, duration, interval, steps, remark) in [
        ("case2", 0.1, 1e-4, [1e-6, 2.5e-7], smooth),
        ("case3", 0.05, 2e-5, [1e-6, 1e-7], horizon),
        ("case4", 0.03, 2e-5, [1e-6, 1e-7], horizon),
    ] {
        let plan = ComparisonPlan::new(format!("3rrr/{name}"), duration, interval);
        save(&overlay(plan, steps, 1e-12)?.figure(remark), pictures, name)?;
    }
    Ok(())
}

//! Writes verify/REPORT.md and its pictures.

use ladder::seeded::root;
use miette::{IntoDiagnostic, Result, WrapErr, miette};
use plot::save;
use records::Run;
use std::fs;
use std::process::ExitCode;
use verify::check::Agreement;
use verify::compare::{
    classes, cost, elements, equations, flexible, impacts, laws, machines, rigid, statistics,
};
use verify::faults::{list, outcomes};
use verify::figures::{self, overlay};
use verify::report::Report;
use verify::trajectory::{Plan, tolerances};

fn main() -> Result<ExitCode> {
    let run = Run::begin("comparison")?;
    let folder = root().join("verify");
    let pictures = folder.join("figures");

    // one run at a time, before anything runs beside it
    eprintln!("cost at the same error");
    let costs = cost::plans().map(cost::curves);
    let costs = costs.into_iter().collect::<Result<Vec<_>>>()?;
    save(&figures::cost(&costs), &pictures, "cost")?;

    eprintln!("elements, laws, equations");
    let mut sections = vec![parts()?];
    eprintln!("cases 1 and 2");
    sections.push(ideal(&pictures)?);
    eprintln!("first impacts");
    sections.push(first_impacts()?);
    eprintln!("other mechanisms");
    sections.push(other_mechanisms()?);
    eprintln!("trajectories");
    let overlays = trajectories(&pictures)?;
    eprintln!("two cycles of cases 3 and 4");
    let spreads = [3, 4].map(statistics::spread);
    let spreads = spreads.into_iter().collect::<Result<Vec<_>>>()?;
    let rows = spreads.iter().flat_map(statistics::Spread::agreements);
    let text = "Looselink at the scenes' own step of 1.25 µs, IDA with relative tolerance 1e-7.";
    sections.push(("Two cycles of cases 3 and 4", text.into(), rows.collect()));

    let report = Report {
        missing: missing()?,
        faults: seeded()?,
        sections,
        overlays,
        spreads,
        costs,
    };
    let path = folder.join("REPORT.md");
    fs::write(&path, report.page())
        .into_diagnostic()
        .wrap_err_with(|| format!("cannot write {}", path.display()))?;
    run.finish()?;
    let rows = report.sections.iter().flat_map(|s| &s.2);
    let failed: Vec<&Agreement> = rows.filter(|row| !row.holds()).collect();
    for row in &failed {
        eprintln!("does not hold: {} of {}", row.quantity, row.scene);
    }
    Ok(ExitCode::from(u8::from(!failed.is_empty())))
}

type Section = (&'static str, String, Vec<Agreement>);

fn parts() -> Result<Section> {
    let mut rows = elements::agreements().into_diagnostic()?;
    rows.extend(laws::agreements().into_diagnostic()?);
    for plan in equations::plans() {
        rows.extend(equations::agreements(&plan)?);
    }
    let text = format!(
        "Each row shows the two values where their difference is largest. Equations are compared in {} states along the path. \
         Every coordinate is displaced at random: by up to 0.2 mm in the 3-RRR, in other mechanisms by three clearances, or by \
         0.1 m and 0.1 rad without clearance. Rates and impact velocities are random. M, f and the tangents of the reference, \
         which has separate coordinates for every body, are summed over the nodes that bodies share in Looselink. \
         [everything](scenes/everything.toml) has every kind of body, joint, force, damping and prescribed motion except \
         clearance and inverse kinematics.",
        equations::STATES
    );
    Ok(("Elements, laws, equations", text, rows))
}

fn ideal(pictures: &std::path::Path) -> Result<Section> {
    let mut rows = rigid::agreements()?;
    let runs = [1, 4].map(flexible::convergence);
    let runs = runs.into_iter().collect::<Result<Vec<_>>>()?;
    rows.extend(runs.iter().flat_map(flexible::Convergence::agreements));
    save(&figures::convergence(&runs), pictures, "convergence")?;
    let own: Vec<String> = runs
        .iter()
        .map(|run| {
            let [coarse, fine] = run.relative;
            format!(
                "{} per link, relative tolerance {coarse:.0e} against {fine:.0e}: {:.0e} m in position, {:.0e} m/s² in \
                 acceleration, {:.0e} N in B1",
                flexible::elements(run.elements), run.own[0], run.own[1], run.own[3]
            )
        })
        .collect();
    let text = format!(
        "Case 2: the difference from IDA falls with the square of Looselink's step. The error of IDA is estimated by the \
         difference between its runs with two tolerances: {}. Looselink is compared with the tighter run. An order is listed \
         for steps that resolve the highest modes and for differences above twice the error of IDA.",
        own.join("; ")
    );
    Ok(("Cases 1 and 2: ideal joints", text, rows))
}

fn first_impacts() -> Result<Section> {
    let mut rows = Vec::new();
    for series in impacts::all() {
        rows.extend(series.agreements()?);
    }
    let text =
        "Impacts are compared one by one in their order, channels up to the last compared impact.";
    Ok(("Cases 3 and 4: the first impacts", text.into(), rows))
}

fn other_mechanisms() -> Result<Section> {
    let mut rows = machines::smooth()?;
    rows.extend(machines::impacts()?);
    let text = "A scene with every kind of element except clearance and inverse kinematics, with the order at which the \
                difference falls; then the first impacts of a slider-crank with clearance, and of a body that hangs by a joint \
                with clearance on a welded flexible link.";
    Ok(("Other mechanisms", text.into(), rows))
}

/// Overlays and differences of cases 2, 3 and 4.
fn trajectories(pictures: &std::path::Path) -> Result<Vec<(&'static str, String)>> {
    let horizon = "The difference starts at rounding level, grows with every impact and reaches the size of the motion; a \
                   smaller step delays this.";
    let list = [
        (
            "case2",
            Plan::new("3rrr/case2", 0.1, 1e-4),
            [1e-6, 2.5e-7],
            "Without impacts the difference grows with time only.",
        ),
        (
            "case3",
            Plan::new("3rrr/case3", 0.05, 2e-5),
            [1e-6, 1e-7],
            horizon,
        ),
        (
            "case4",
            Plan::new("3rrr/case4", 0.03, 2e-5),
            [1e-6, 1e-7],
            horizon,
        ),
    ];
    let mut overlays = Vec::new();
    for (name, plan, steps, horizon) in list {
        let title = format!("{}: Looselink and IDA, and their difference", plan.name());
        save(
            &overlay(plan, steps, 1e-12)?.figure(horizon),
            pictures,
            name,
        )?;
        overlays.push((name, title));
    }
    Ok(overlays)
}

/// Channels that the reference has no counterpart for, in the scene with most of them.
fn missing() -> Result<Vec<String>> {
    let plan = Plan::new("3rrr/case4-friction", 1e-3, 1e-4);
    let cpp = plan.cpp(&tolerances(1e-6, 1e-9, 1e-7))?;
    Ok(classes::missing(&plan.rust(1e-5)?, &cpp))
}

fn seeded() -> Result<Vec<(verify::faults::Fault, verify::faults::Outcome)>> {
    let outcomes = outcomes()?;
    let find = |fault: verify::faults::Fault| {
        let outcome = outcomes.iter().find(|o| o.name == fault.name).cloned();
        let name = fault.name.clone();
        let outcome = outcome.ok_or_else(|| miette!("fault `{name}` has not been run"))?;
        Ok((fault, outcome))
    };
    list()?.into_iter().map(find).collect()
}

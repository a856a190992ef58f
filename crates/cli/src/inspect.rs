//! `looselink inspect`

use super::failure::CommandFailure;
use super::{SceneArguments, print};
use clap::Args;
use looselink::interaction::contact::{V0, V1};
use looselink::output::json;
use looselink::scene::{Analysis, MotionKind, Pace, Scene};
use looselink::simulate::{Inspection, Simulation};
use numbers::{exact, number};

#[derive(Debug, Args)]
pub struct Arguments {
    #[command(flatten)]
    scene: SceneArguments,
    /// Machine-readable output.
    #[arg(long)]
    json: bool,
}

/// Shows the compiled scene on standard output.
pub fn inspect(arguments: &Arguments) -> Result<(), CommandFailure> {
    let (scene, simulation) = arguments.scene.load()?;
    let inspection = simulation.inspect();
    match arguments.json {
        true => print(json(&inspection)?),
        false => print(text(&scene, &simulation, &inspection)),
    }
}

fn text(scene: &Scene, simulation: &Simulation, inspection: &Inspection) -> String {
    let mut out = format!("{}\n\n", scene.title);
    let duration = scene.simulation.duration;
    for (name, value) in [
        ("bodies", scene.bodies.len().to_string()),
        ("joints", scene.joints.len().to_string()),
        ("unknown coordinates", inspection.unknowns.to_string()),
        ("multipliers", inspection.multipliers.to_string()),
        ("contacts", inspection.contacts.to_string()),
        ("effects", inspection.effects.join(", ")),
        (
            "duration",
            match (scene.integrator.pace, scene.simulation.analysis) {
                (Pace::Step(step), Analysis::Dynamic) => format!(
                    "{} s, about {:.0} steps of {} s",
                    exact(duration),
                    duration / step,
                    exact(step)
                ),
                (Pace::Step(step), Analysis::Static) => format!(
                    "load path to t = {} in about {:.0} steps",
                    exact(duration),
                    duration / step
                ),
                (Pace::Accuracy(accuracy), _) => {
                    format!("{} s, with an accuracy of {accuracy}", exact(duration))
                }
            },
        ),
        (
            "channels",
            format!(
                "{} every {} s",
                simulation.channels().len(),
                exact(scene.output.interval)
            ),
        ),
        ("method", scene.integrator.method_name().to_owned()),
        ("scene hash", scene.hash()),
    ] {
        out += &format!("  {name:<22}{value}\n");
    }
    let channels = simulation.channels().iter();
    let channels = channels.map(|c| format!("{} [{}]", c.name, c.unit));
    for (title, entries) in [
        ("Masses and poses at the start", &bodies(scene, simulation)),
        ("Drives at the start", &drives(scene)),
        ("Joints with clearance", &clearances(scene)),
        ("Assumptions and notes", &inspection.assumptions),
        ("Unknown coordinates", &inspection.coordinates),
        ("Constraints", &inspection.constraints),
        ("Channels", &channels.collect()),
    ] {
        if !entries.is_empty() {
            out += &format!("\n{title}\n");
        }
        for entry in entries {
            out += &format!("  {entry}\n");
        }
    }
    out
}

/// Mass and pose of every body that has a mass, and the total mass.
fn bodies(scene: &Scene, simulation: &Simulation) -> Vec<String> {
    let mut total = 0.0;
    let mut lines = Vec::new();
    for (index, body) in scene.bodies.iter().enumerate() {
        let Some(mass) = body.kind.mass() else {
            continue;
        };
        total += mass;
        let [x, y, theta] = simulation.model().pose(index, simulation.state()).position;
        let [mass, x, y, degrees] = [mass, x, y, theta.to_degrees()].map(|value| number(value, 4));
        lines.push(format!(
            "{:<20}{mass} kg, centre of mass at x = {x} m, y = {y} m, turned by {degrees} degrees",
            body.name
        ));
    }
    lines.push(format!("{:<20}{} kg", "all bodies", number(total, 4)));
    lines
}

/// What drives prescribe at t = 0, in degrees, too: a motion in degrees instead of radians is seen at once.
fn drives(scene: &Scene) -> Vec<String> {
    let mut lines = Vec::new();
    for motion in &scene.motions {
        match &motion.kind {
            MotionKind::Angle { joint, angle } => {
                let [angle, speed, _] = angle.at(0.0);
                lines.push(format!(
                    "{:<19} turns {}: angle {} rad, {} degrees, speed {} rad/s",
                    motion.name,
                    scene.joints[*joint].name,
                    number(angle, 4),
                    number(angle.to_degrees(), 4),
                    number(speed, 4)
                ));
            }
            MotionKind::Point { point, coordinates } => {
                let body = &scene.bodies[point.body];
                let name = &body.kind.points()[point.point].name;
                for (axis, coordinate) in ["x", "y"].iter().zip(coordinates) {
                    let Some(coordinate) = coordinate else {
                        continue;
                    };
                    let [value, speed, _] = coordinate.at(0.0);
                    lines.push(format!(
                        "{:<19} moves {}.{name}: {axis} = {} m, speed {} m/s",
                        motion.name,
                        body.name,
                        number(value, 4),
                        number(speed, 4)
                    ));
                }
            }
        }
    }
    lines
}

/// Clearance, stiffness and friction of every contact.
fn clearances(scene: &Scene) -> Vec<String> {
    let mut lines = Vec::new();
    for joint in &scene.joints {
        if let Some(contact) = joint.contact() {
            let radius = contact.bearing_radius;
            let radius = radius.map_or(String::new(), |r| {
                format!("bearing radius {} m, ", exact(r))
            });
            let source = match contact.from_materials {
                true => " (that of a sphere in a spherical cup, without the length of the pin)",
                false => "",
            };
            let friction = contact.friction.map_or(String::new(), |f| {
                let [v0, v1] = [(f.v0, V0), (f.v1, V1)].map(|(v, default)| match v == default {
                    true => format!("{} m/s, the default", exact(v)),
                    false => format!("{} m/s", exact(v)),
                });
                let coefficient = exact(f.coefficient);
                format!(", friction {coefficient} with v0 = {v0}, and v1 = {v1}")
            });
            lines.push(format!(
                "{:<20}clearance {} m, {radius}stiffness K = {} N/m^{}{source}{friction}",
                joint.name,
                exact(contact.clearance),
                number(contact.stiffness, 4),
                exact(contact.exponent)
            ));
        }
    }
    lines
}

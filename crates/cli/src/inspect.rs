//! `looselink inspect`

use super::failure::CommandFailure;
use super::{SceneArguments, print};
use clap::Args;
use folder::json;
use looselink::scene::{Analysis, MotionKind, Pace, Scene};
use looselink::simulate::{Inspection, Simulation};
use numbers::{exact, number};

#[derive(Debug, Args)]
pub struct Arguments {
    #[command(flatten)]
    scene: SceneArguments,
    /// Show all bodies, joints, notes, coordinates, constraints and channels, not only what fits on a screen.
    #[arg(long, conflicts_with = "json")]
    all: bool,
    /// Machine-readable output.
    #[arg(long)]
    json: bool,
}

/// A part of what is shown.
struct Section {
    title: &'static str,
    lines: Vec<String>,
    /// Lines that are shown without `--all`: with the head of 13 lines, and two lines a section, forty at most.
    most: usize,
}

impl Section {
    /// Its text; a section that is cut says how many lines it leaves out.
    fn text(&self, all: bool) -> String {
        let count = self.lines.len();
        let cut = !all && count > self.most;
        let shown = match cut {
            true => self.most.saturating_sub(1),
            false => count,
        };
        if shown == 0 {
            return String::new();
        }
        let mut text = format!("\n{}\n", self.title);
        let lines = self.lines.iter().take(shown);
        lines.for_each(|line| text += &format!("  {line}\n"));
        if cut {
            text += &format!("  and {} more: --all\n", count - shown);
        }
        text
    }
}

/// Shows the compiled scene on standard output.
pub fn inspect(arguments: &Arguments) -> Result<(), CommandFailure> {
    let (scene, simulation) = arguments.scene.load()?;
    let inspection = simulation.inspect();
    match arguments.json {
        true => print(json(&inspection)?),
        false => print(text(&scene, &simulation, &inspection, arguments.all)),
    }
}

fn text(scene: &Scene, simulation: &Simulation, inspection: &Inspection, all: bool) -> String {
    let mut out = format!("{}\n\n", scene.title);
    let duration = scene.simulation.duration;
    let mobility = match inspection.freedoms {
        Some(freedoms) => freedoms.to_string(),
        None => {
            "not counted: the start is singular, or does not fit the ideal mechanism".to_owned()
        }
    };
    for (name, value) in [
        ("bodies", scene.bodies.len().to_string()),
        ("joints", scene.joints.len().to_string()),
        ("mobility", mobility),
        (
            "unknown coordinates",
            format!(
                "{}, {} of them independent",
                inspection.unknowns, inspection.independent
            ),
        ),
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
    for (title, lines, most) in [
        (
            "Masses and poses at the start",
            bodies(scene, simulation),
            7,
        ),
        ("Drives at the start", drives(scene), 3),
        ("Joints with clearance", clearances(scene), 5),
        ("Notes and assumptions", inspection.assumptions.clone(), 4),
        ("Unknown coordinates", inspection.coordinates.clone(), 0),
        ("Constraints", inspection.constraints.clone(), 0),
        ("Channels", channels.collect(), 0),
    ] {
        out += &Section { title, lines, most }.text(all);
    }
    out
}

/// The total mass, then mass and pose of every body that has a mass.
fn bodies(scene: &Scene, simulation: &Simulation) -> Vec<String> {
    let mut total = 0.0;
    let mut lines = vec![String::new()];
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
    lines[0] = format!("{:<20}{} kg", "all bodies", number(total, 4));
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

/// Clearance, stiffness and friction of every contact, of joints that share them together.
fn clearances(scene: &Scene) -> Vec<String> {
    let mut alike: Vec<(String, Vec<&str>)> = Vec::new();
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
            let friction = contact.friction.as_ref();
            let friction = friction.map_or(String::new(), |f| format!(", {}", f.law.describe()));
            let line = format!(
                "clearance {} m, {radius}stiffness K = {} N/m^{}{source}{friction}",
                exact(contact.clearance),
                number(contact.stiffness, 4),
                exact(contact.exponent)
            );
            match alike.iter_mut().find(|(known, _)| *known == line) {
                Some((_, joints)) => joints.push(&joint.name),
                None => alike.push((line, vec![&joint.name])),
            }
        }
    }
    let named = alike.into_iter();
    let named = named.map(|(line, joints)| format!("{:<19} {line}", joints.join(", ")));
    named.collect()
}

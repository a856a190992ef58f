//! From a mechanism and genes to the text of a scene.

use super::actions::{RandomDrive, contact, drive, forces};
use super::genes::{Genes, Tape};
use super::mechanism::{
    Form, Hinge, HingeKind, Member, PinRef, PlanePoint, RandomMechanism, Topology, add, mechanism,
    rotate, scale, sub,
};
use std::fmt::Write;

/// A scene that nobody drew.
#[derive(Debug, Clone)]
pub struct RandomScene {
    /// Its text.
    pub text: String,
    /// What is in it, for tallies: kind of mechanism, method, parts, each once.
    pub features: Vec<&'static str>,
}

/// Scales by which numbers are chosen, so that they act on each other.
#[derive(Debug, Clone, Copy)]
pub struct Scales {
    /// Length \[m\].
    pub length: f64,
    /// Mass \[kg\].
    pub mass: f64,
    /// Time within which things move by the length \[s\].
    pub time: f64,
    /// Step, or what it would be without an accuracy \[s\].
    pub step: f64,
    /// Duration of the run \[s\].
    pub duration: f64,
}

impl Scales {
    /// Length over time \[m/s\].
    pub fn speed(&self) -> f64 {
        self.length / self.time
    }

    /// Mass times acceleration \[N\].
    pub fn force(&self) -> f64 {
        self.mass * self.length / self.time.powi(2)
    }
}

/// The name of a point of a member.
pub(super) fn point_name(m: &RandomMechanism, pin: PinRef) -> String {
    let point = match (m.members[pin.member].form, pin.pin) {
        (Form::Rigid | Form::Flexible { .. }, 0) => "start".to_owned(),
        (Form::Rigid | Form::Flexible { .. }, _) => "end".to_owned(),
        (Form::Mass, _) => "center".to_owned(),
        (_, k) => format!("p{k}"),
    };
    format!("{}.{point}", member_name(pin.member))
}

/// The name of a member.
pub(super) fn member_name(index: usize) -> String {
    match index {
        0 => "ground".to_owned(),
        _ => format!("body{index}"),
    }
}

/// The name of a joint.
pub(super) fn joint_name(index: usize) -> String {
    format!("joint{}", index + 1)
}

/// The scene that genes make.
pub fn draw(genes: &Genes) -> RandomScene {
    let mut tape = genes.tape();
    let mut m = mechanism(&mut tape.part(300));
    let mut features = vec![m.topology.name()];
    let mut pace = pace(&mut tape.part(20), &m, &mut features);
    let scales = Scales {
        length: m.size,
        mass: m.members[1..].iter().fold(0.0, |s, b| s + b.mass) / (m.members.len() - 1) as f64,
        time: pace.time,
        step: pace.step,
        duration: pace.duration,
    };
    let mut text = String::new();
    let mut parts = tape.part(20);
    let gravity = parts.chance(0.5).then(|| parts.vector(-1.0, 1.0));
    let drive = drive(&mut tape.part(40), &m, &scales);
    let forces = forces(&mut tape.part(90), &mut m, &scales);
    let mut contacts = String::new();
    let mut least = f64::INFINITY;
    let mut laws = tape.part(140);
    for (j, hinge) in m.hinges.iter().enumerate() {
        let mut tape = laws.part(14);
        if hinge.kind == HingeKind::Loose {
            let contact = contact(&mut tape, j, &scales, &mut features);
            least = f64::min(least, contact.clearance);
            contacts += &contact.text;
        }
    }
    let start = start(
        &mut tape.part(60),
        &mut m,
        drive.as_ref(),
        &scales,
        least,
        &mut features,
    );

    writeln!(text, "format = 1\ntitle = {:?}\n", m.topology.name()).unwrap();
    writeln!(text, "[simulation]\nduration = {:?}", pace.duration).unwrap();
    if let Some(g) = gravity {
        let g = scale(scales.length / scales.time.powi(2), g);
        writeln!(text, "gravity = {g:?}").unwrap();
        features.push("gravity");
    }
    if least.is_finite() {
        let tolerance = least * pace.onset;
        writeln!(
            pace.integrator,
            "onset_tolerance = {tolerance:?}\nlocate_onsets = {:?}",
            pace.locate
        )
        .unwrap();
    }
    writeln!(text, "\n[integrator]\n{}", pace.integrator).unwrap();
    writeln!(
        text,
        "[output]\ninterval = {:?}\nchannels = [\"*\"]\n",
        pace.interval
    )
    .unwrap();
    text += &contacts;
    let mut materials = tape.part(100);
    for (b, member) in m.members.iter().enumerate() {
        text += &body(
            &mut materials.part(8),
            b,
            member,
            &m,
            &scales,
            &mut features,
        );
    }
    for (j, hinge) in m.hinges.iter().enumerate() {
        text += &joint(j, hinge, &m, &mut features);
    }
    if let Some(drive) = &drive {
        text += &drive.text;
        features.push(drive.feature);
    }
    for force in &forces {
        text += &force.text;
        features.push(force.feature);
    }
    text += &start;
    if m.near_singular {
        features.push("near a singular pose");
    }
    if is_free(&m) {
        features.push("free-flying");
    }
    features.sort_unstable();
    features.dedup();
    RandomScene { text, features }
}

/// True where no joint leads to the ground.
fn is_free(m: &RandomMechanism) -> bool {
    m.hinges
        .iter()
        .all(|h| h.first.member != 0 && h.second.member != 0)
}

/// Method, step or accuracy, duration.
struct RandomPace {
    integrator: String,
    time: f64,
    step: f64,
    duration: f64,
    interval: f64,
    onset: f64,
    locate: bool,
}

fn pace(tape: &mut Tape, m: &RandomMechanism, features: &mut Vec<&'static str>) -> RandomPace {
    let time = tape.decades(-3.0, 1.0);
    // contacts last a small part of the time in which things move
    let loose = m.hinges.iter().any(|h| h.kind == HingeKind::Loose);
    let step = time * tape.decades(-5.5, if loose { -2.5 } else { -0.5 });
    let between_rows = tape.whole(1, 10);
    let rows = tape.whole(2, 20);
    let interval = between_rows as f64 * step;
    let duration = rows as f64 * interval;
    let methods = [
        "bathe",
        "bathe",
        "trapezoidal",
        "generalized_alpha",
        "hht",
        "backward_euler",
        "dormand_prince",
        "dop853",
        "esdirk3",
        "esdirk5",
    ];
    let mut method = tape.pick(&methods);
    // velocity Verlet keeps no constraints
    let verlet = tape.chance(0.3);
    if verlet && matches!(m.topology, Topology::Masses | Topology::Journal) {
        method = "velocity_verlet";
    }
    features.push(method);
    let mut integrator = format!("method = {method:?}\n");
    let (with_gamma, gamma) = (tape.chance(0.2), tape.between(0.2, 0.8));
    let (with_radius, radius) = (tape.chance(0.3), tape.between(0.0, 1.0));
    match method {
        "bathe" if with_gamma => writeln!(integrator, "gamma = {gamma:?}").unwrap(),
        "bathe" if with_radius => writeln!(integrator, "spectral_radius = {radius:?}").unwrap(),
        "generalized_alpha" => writeln!(integrator, "spectral_radius = {radius:?}").unwrap(),
        "hht" => writeln!(integrator, "spectral_radius = {:?}", 0.5 + 0.5 * radius).unwrap(),
        _ => {}
    }
    let follows = tape.chance(0.3);
    let (digits, energy, horizon) = (tape.decades(-8.0, -3.0), tape.chance(0.2), tape.chance(0.5));
    let can_follow = [
        "bathe",
        "trapezoidal",
        "dormand_prince",
        "dop853",
        "esdirk3",
        "esdirk5",
    ];
    if follows && can_follow.contains(&method) {
        let horizon = if horizon { duration } else { 0.3 * duration };
        let energy = match energy {
            true => {
                let kinetic =
                    m.members.iter().fold(0.0, |s, b| s + b.mass) * (m.size / time).powi(2);
                format!(", energy = {:?}", digits * kinetic)
            }
            false => String::new(),
        };
        let position = digits * m.size;
        writeln!(
            integrator,
            "accuracy = {{ position = {position:?}, horizon = {horizon:?}{energy} }}"
        )
        .unwrap();
        features.push("accuracy");
    } else {
        writeln!(integrator, "step = {step:?}").unwrap();
    }
    let tolerance = m.size / time * tape.decades(-12.0, -8.0);
    if !matches!(method, "dormand_prince" | "dop853" | "velocity_verlet") {
        writeln!(integrator, "newton_tolerance = {tolerance:?}").unwrap();
    }
    RandomPace {
        integrator,
        time,
        step,
        duration,
        interval,
        onset: tape.decades(-6.0, -2.0),
        locate: !tape.chance(0.1),
    }
}

fn body(
    tape: &mut Tape,
    index: usize,
    member: &Member,
    m: &RandomMechanism,
    scales: &Scales,
    features: &mut Vec<&'static str>,
) -> String {
    let name = member_name(index);
    let points = |origin: PlanePoint, theta: f64| {
        let mut text = String::new();
        for (k, pin) in member.pins.iter().enumerate() {
            let at = rotate(-theta, sub(*pin, origin));
            writeln!(text, "points.p{k} = {at:?}").unwrap();
        }
        text
    };
    let mass = member.mass;
    match member.form {
        Form::Ground => format!(
            "[bodies.{name}]\ntype = \"ground\"\n{}\n",
            points([0.0; 2], 0.0)
        ),
        Form::Mass => {
            features.push("point mass");
            format!("[bodies.{name}]\ntype = \"point_mass\"\nmass = {mass:?}\n\n")
        }
        Form::Body { centre } => {
            features.push("rigid body");
            let inertia = mass * m.size.powi(2) * tape.decades(-3.0, 0.0);
            format!(
                "[bodies.{name}]\ntype = \"rigid_body\"\nmass = {mass:?}\ninertia = {inertia:?}\n{}\n",
                points(centre, member.theta)
            )
        }
        Form::Rigid | Form::Flexible { .. } => {
            let length = length(member);
            let (width, height) = (
                length * tape.decades(-2.0, -1.0),
                length * tape.decades(-2.0, -1.0),
            );
            let density = mass / (width * height * length);
            let mut text = format!(
                "[sections.s{index}]\nwidth = {width:?}\nheight = {height:?}\n\n[materials.m{index}]\ndensity = {density:?}\n"
            );
            // the first bending frequency of a pinned link, in units of 1/time
            let frequency = tape.decades(0.0, 4.0) / scales.time;
            let modulus = 12.0 * density * (frequency * length * length / (9.87 * width)).powi(2);
            let (damped, kelvin, tau) =
                (tape.chance(0.3), tape.chance(0.7), tape.decades(-4.0, 0.0));
            let model = match member.form {
                Form::Flexible { elements } => {
                    features.push("flexible link");
                    writeln!(text, "youngs_modulus = {modulus:?}").unwrap();
                    let mut model = format!("model = \"flexible\"\nelements = {elements}\n");
                    if damped && kelvin {
                        features.push("structural damping");
                        writeln!(model, "kelvin_voigt = {:?}", tau / frequency).unwrap();
                    } else if damped {
                        features.push("structural damping");
                        writeln!(
                            model,
                            "rayleigh = {{ mass = {:?}, stiffness = {:?} }}",
                            tau / scales.time,
                            tau / frequency
                        )
                        .unwrap();
                    }
                    model
                }
                _ => {
                    features.push("rigid link");
                    "model = \"rigid\"\n".to_owned()
                }
            };
            text + &format!(
                "\n[bodies.{name}]\ntype = \"link\"\n{model}length = {length:?}\nsection = \"s{index}\"\nmaterial = \"m{index}\"\n\n"
            )
        }
    }
}

/// Length of a link \[m\].
fn length(member: &Member) -> f64 {
    super::mechanism::norm(sub(member.pins[1], member.pins[0]))
}

fn joint(
    index: usize,
    hinge: &Hinge,
    m: &RandomMechanism,
    features: &mut Vec<&'static str>,
) -> String {
    let [first, second] = [hinge.first, hinge.second].map(|pin| point_name(m, pin));
    let theta = |pin: PinRef| m.members[pin.member].theta;
    let turned = theta(hinge.second) - theta(hinge.first);
    let head = format!("[joints.{}]\n", joint_name(index));
    head + &match hinge.kind {
        HingeKind::Ideal => {
            features.push("ideal revolute");
            format!(
                "type = \"revolute\"\nbearing = {first:?}\njournal = {second:?}\nmodel = \"ideal\"\n\n"
            )
        }
        HingeKind::Loose => {
            features.push("clearance");
            format!(
                "type = \"revolute\"\nbearing = {first:?}\njournal = {second:?}\nmodel = \"clearance\"\ncontact = \"c{index}\"\n\n"
            )
        }
        HingeKind::Weld { vector } => {
            features.push("weld");
            let slope = if vector { "vector" } else { "direction" };
            format!(
                "type = \"weld\"\nfirst = {first:?}\nsecond = {second:?}\nangle = {turned:?}\nslope = {slope:?}\n\n"
            )
        }
        HingeKind::Slide { direction, locked } => {
            features.push("prismatic");
            let along = rotate(direction - theta(hinge.first), [1.0, 0.0]);
            let rotation = match locked {
                true => format!("rotation = \"locked\"\nangle = {turned:?}"),
                false => "rotation = \"free\"".to_owned(),
            };
            format!(
                "type = \"prismatic\"\nguide = {first:?}\ndirection = {along:?}\nslider = {second:?}\n{rotation}\n\n"
            )
        }
    }
}

/// Which members hang together by joints without play, as the lowest index among them.
fn components(m: &RandomMechanism) -> Vec<usize> {
    let mut of: Vec<usize> = (0..m.members.len()).collect();
    for _ in 0..m.members.len() {
        for hinge in m.hinges.iter().filter(|h| h.kind != HingeKind::Loose) {
            let (i, j) = (hinge.first.member, hinge.second.member);
            let least = of[i].min(of[j]);
            (of[i], of[j]) = (least, least);
        }
    }
    of
}

/// Centre of mass of a body.
fn position(member: &Member) -> PlanePoint {
    match member.form {
        Form::Body { centre } => centre,
        Form::Rigid | Form::Flexible { .. } => scale(0.5, add(member.pins[0], member.pins[1])),
        _ => member.pins[0],
    }
}

/// `[initial]`. Exact poses in which parts that joints with play leave free are moved; poses with a velocity to be
/// completed; or a sketch.
fn start(
    tape: &mut Tape,
    m: &mut RandomMechanism,
    drive: Option<&RandomDrive>,
    scales: &Scales,
    clearance: f64,
    features: &mut Vec<&'static str>,
) -> String {
    let prescribed = |b: usize| drive.is_some_and(|d| d.moves.contains(&b));
    let sketched = tape.chance(0.15);
    let completed = tape.chance(0.4);
    let part = clearance.min(scales.length) * 0.45;
    let mut text = String::new();
    if drive.is_some_and(|d| d.by_kinematics) {
        writeln!(text, "[initial]\nsketch = {{ {} }}", sketch(m, 0.0)).unwrap();
        features.push("start from inverse kinematics");
        return text;
    }
    let moving = drive.is_some_and(|d| d.moving);
    let has_point_joint = |b: usize| {
        let own = |h: &&Hinge| h.first.member == b || h.second.member == b;
        m.hinges.iter().filter(own).count() < 2
    };
    if sketched && !m.hinges.is_empty() {
        features.push("start from a sketch");
        let jitter = tape.between(0.0, 0.02) * m.size;
        writeln!(text, "[initial]\nsketch = {{ {} }}", sketch(m, jitter)).unwrap();
        for b in 1..m.members.len() {
            if has_point_joint(b) && !prescribed(b) {
                text += &pose(m, b, None);
            }
        }
        return text;
    }
    if completed || moving {
        features.push("start completed");
        for b in (1..m.members.len()).filter(|b| !prescribed(*b)) {
            text += &pose(m, b, None);
        }
        if let Some(j) = moving.then(|| m.hinges.len() - 1) {
            // the poses are held; a joint in the sketch asks for velocities that fit the drive
            let [x, y] = m.members[m.hinges[j].second.member].pins[m.hinges[j].second.pin];
            text = format!(
                "[initial]\nsketch = {{ {} = [{x:?}, {y:?}] }}\n{text}",
                joint_name(j)
            );
        }
        let chosen = tape.whole(1, m.members.len() - 1);
        let speed = scales.speed() * tape.signed_decades(-2.0, 0.5);
        if drive.is_none() && !prescribed(chosen) {
            let quantity = match m.members[chosen].form {
                Form::Mass => format!("vx = {speed:?}"),
                _ => format!("omega = {:?}", speed / m.size),
            };
            writeln!(
                text,
                "[initial.velocities]\n{} = {{ {quantity} }}",
                member_name(chosen)
            )
            .unwrap();
        }
        return text;
    }
    features.push("start exact");
    let of = components(m);
    let mut motions = Vec::new();
    for _ in 0..m.members.len() {
        let mut tape = tape.part(6);
        motions.push((
            scale(
                part * tape.between(0.0, 1.0),
                rotate(tape.angle(), [1.0, 0.0]),
            ),
            tape.signed_decades(-2.0, 0.0),
            tape.signed_decades(-2.0, 0.5),
        ));
    }
    for b in 1..m.members.len() {
        if of[b] == 0 {
            if !prescribed(b) {
                text += &pose(m, b, None);
            }
            continue;
        }
        let (shift, drift, turn) = motions[of[b]];
        let member = &mut m.members[b];
        for pin in &mut member.pins {
            *pin = add(*pin, shift);
        }
        if let Form::Body { centre } = &mut member.form {
            *centre = add(*centre, shift);
        }
        // a driven joint may lead to a part that is free otherwise
        let moves = if drive.is_some() { 0.0 } else { 1.0 };
        let (drift, turn) = (moves * scales.speed() * drift, moves * turn / scales.time);
        // the part turns about the first pin of its first member, and drifts
        let pivot = m.members[of[b]].pins[0];
        let arm = sub(position(&m.members[b]), pivot);
        let velocity = add([drift, 0.5 * drift], [-turn * arm[1], turn * arm[0]]);
        text += &pose(m, b, Some((velocity, turn)));
    }
    text
}

/// Where the joints are, a little off.
fn sketch(m: &RandomMechanism, jitter: f64) -> String {
    let mut entries = Vec::new();
    for (j, hinge) in m.hinges.iter().enumerate() {
        let at = m.members[hinge.second.member].pins[hinge.second.pin];
        let off = rotate(2.4 * j as f64, [jitter, 0.0]);
        entries.push(format!("{} = {:?}", joint_name(j), add(at, off)));
    }
    entries.join(", ")
}

/// An entry of `initial.bodies`.
fn pose(m: &RandomMechanism, b: usize, velocity: Option<(PlanePoint, f64)>) -> String {
    let member = &m.members[b];
    let [x, y] = position(member);
    let mut text = format!(
        "[initial.bodies.{}]\nx = {x:?}\ny = {y:?}\n",
        member_name(b)
    );
    if member.form != Form::Mass {
        writeln!(text, "theta = {:?}", member.theta).unwrap();
    }
    if let Some(([vx, vy], omega)) = velocity {
        writeln!(text, "vx = {vx:?}\nvy = {vy:?}").unwrap();
        if member.form != Form::Mass {
            writeln!(text, "omega = {omega:?}").unwrap();
        }
    }
    text
}

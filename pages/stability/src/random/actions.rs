//! What acts on a mechanism: contacts, drives, springs, loads.

use super::genes::Tape;
use super::mechanism::{
    Form, HingeKind, PinRef, PlanePoint, RandomMechanism, Topology, add, norm, scale, sub,
};
use super::text::{Scales, joint_name, member_name, point_name};
use looselink::contact::normal::LAWS;

/// The contact of a loose joint.
pub struct RandomContact {
    /// Its table.
    pub text: String,
    /// Clearance \[m\].
    pub clearance: f64,
}

/// The contact of joint `index`.
pub fn contact(
    tape: &mut Tape,
    index: usize,
    scales: &Scales,
    features: &mut Vec<&'static str>,
) -> RandomContact {
    let clearance = scales.length * tape.decades(-4.0, -2.0);
    let radius = clearance * tape.decades(0.5, 2.0);
    let law = tape.pick(&LAWS);
    features.push(law.name);
    let exponent = tape.pick(&[1.5, 1.0, 2.0]);
    // the stiffness at which an impact at the speed of the scene lasts from a few tenths of a step to many
    let depth = (scales.speed() * scales.step * tape.decades(-0.5, 2.0)).min(clearance);
    let stiffness =
        0.5 * (exponent + 1.0) * scales.mass * scales.speed().powi(2) / depth.powf(exponent + 1.0);
    let restitution = tape.between(0.2, 1.0);
    let floor = scales.speed() * tape.decades(-8.0, -3.0);
    let mut text = format!(
        "[contacts.c{index}]\nlaw = {:?}\nbearing_radius = {radius:?}\nclearance = {clearance:?}\nstiffness = {stiffness:?}\nexponent = {exponent:?}\n",
        law.name
    );
    if law.is_damped {
        text += &format!("restitution = {restitution:?}\nimpact_velocity_floor = {floor:?}\n");
    }
    let (friction, coefficient) = (tape.chance(0.4), tape.decades(-2.0, 0.0));
    let (v0, v1) = (tape.decades(-5.0, -2.0), tape.decades(0.5, 2.0));
    let slip = tape.pick(&["material", "paper"]);
    if friction {
        features.push(match slip {
            "paper" => "friction, slip as printed",
            _ => "friction, slip of the material",
        });
        let v0 = v0 * scales.speed();
        text += &format!(
            "friction = {{ law = \"ambrosio\", coefficient = {coefficient:?}, v0 = {v0:?}, v1 = {:?}, slip = {slip:?} }}\n",
            v0 * v1
        );
    }
    RandomContact {
        text: text + "\n",
        clearance,
    }
}

/// A function of time, as it is written.
struct RandomFunction {
    text: String,
    /// Whether its rate at t = 0 is not zero.
    moving: bool,
}

/// A function with this value at t = 0 that changes by about `amount` within the time of the scales; smooth where a motion
/// follows it.
fn function(
    tape: &mut Tape,
    start: f64,
    amount: f64,
    scales: &Scales,
    smooth: bool,
) -> RandomFunction {
    let (t, end) = (scales.time, scales.duration);
    let kind = tape.pick(&[
        "number",
        "polynomial",
        "smooth_step",
        "harmonic",
        "spin_up",
        "table",
        "ramp",
    ]);
    let (a, b) = (tape.between(0.1, 1.0), tape.angle());
    let text = match kind {
        "polynomial" => format!(
            "{{ type = \"polynomial\", coefficients = [{start:?}, {:?}, {:?}] }}",
            amount / t,
            0.3 * amount / (t * t)
        ),
        "smooth_step" => format!(
            "{{ type = \"smooth_step\", from = {start:?}, to = {:?}, start = 0.0, duration = {:?} }}",
            start + amount * (end / t).min(1.0),
            a * end
        ),
        "harmonic" => format!(
            "{{ type = \"harmonic\", mean = {:?}, amplitude = {amount:?}, frequency = {:?}, phase = {b:?} }}",
            start - amount * b.sin(),
            a / t
        ),
        "spin_up" => format!(
            "{{ type = \"spin_up\", start = {start:?}, speed = {:?}, duration = {:?} }}",
            amount / t,
            a * end
        ),
        "table" => format!(
            "{{ type = \"table\", rows = [[0.0, {start:?}], [{:?}, {:?}], [{:?}, {start:?}]] }}",
            0.6 * end,
            start + amount * (end / t).min(1.0),
            1.01 * end
        ),
        "ramp" if !smooth => format!(
            "{{ type = \"ramp\", from = {start:?}, to = {:?}, start = {:?}, duration = {:?} }}",
            start + amount,
            0.2 * end,
            a * end
        ),
        _ => format!("{start:?}"),
    };
    RandomFunction {
        text,
        moving: matches!(kind, "polynomial" | "harmonic" | "table"),
    }
}

/// A prescribed motion.
pub struct RandomDrive {
    /// Its tables.
    pub text: String,
    /// What it is, for tallies.
    pub feature: &'static str,
    /// Whether it moves at t = 0.
    pub moving: bool,
    /// Members that it moves without equations of their own.
    pub moves: Vec<usize>,
    /// Whether it follows inverse kinematics, which make the start.
    pub by_kinematics: bool,
}

/// A drive, or none.
pub fn drive(tape: &mut Tape, m: &RandomMechanism, scales: &Scales) -> Option<RandomDrive> {
    let (wanted, direct) = (tape.chance(0.35), !tape.chance(0.5));
    if !wanted {
        return None;
    }
    if m.topology == Topology::Parallel && !direct {
        return follow(tape, m, scales);
    }
    let turning = |h: &usize| matches!(m.hinges[*h].kind, HingeKind::Ideal | HingeKind::Loose);
    let with_angle = |h: &usize| {
        let hinge = &m.hinges[*h];
        [hinge.first, hinge.second]
            .iter()
            .all(|p| m.members[p.member].form != Form::Mass)
    };
    let choices: Vec<usize> = (0..m.hinges.len())
        .filter(turning)
        .filter(with_angle)
        .collect();
    let first = *choices.first()?;
    let inner = tape.chance(0.3);
    let other = choices[tape.whole(0, choices.len() - 1)];
    let j = if inner { other } else { first };
    let hinge = &m.hinges[j];
    let theta = |pin: PinRef| m.members[pin.member].theta;
    let angle = theta(hinge.second) - theta(hinge.first);
    let amount = tape.signed_decades(-1.0, 0.5);
    let function = function(tape, angle, amount, scales, true);
    let mut moves = Vec::new();
    for (pin, other) in [(hinge.second, hinge.first), (hinge.first, hinge.second)] {
        let stiff = matches!(m.members[pin.member].form, Form::Rigid | Form::Body { .. });
        if hinge.kind == HingeKind::Ideal && other.member == 0 && stiff {
            moves.push(pin.member);
        }
    }
    Some(RandomDrive {
        text: format!(
            "[drives.drive1]\ntype = \"angle\"\njoint = {:?}\nangle = {}\n\n",
            joint_name(j),
            function.text
        ),
        feature: "driven angle",
        moving: function.moving,
        moves,
        by_kinematics: false,
    })
}

/// The platform of a parallel mechanism follows a path by its three cranks.
fn follow(tape: &mut Tape, m: &RandomMechanism, scales: &Scales) -> Option<RandomDrive> {
    let cranks_fit = (0..3).all(|h| {
        m.hinges[h].kind == HingeKind::Ideal
            && [m.hinges[h].first, m.hinges[h].second]
                .iter()
                .all(|p| !matches!(m.members[p.member].form, Form::Flexible { .. }))
    });
    let platform = m
        .members
        .iter()
        .position(|b| b.pins.len() == 3 && b.form != Form::Ground)?;
    let Form::Body { centre } = m.members[platform].form else {
        return None;
    };
    if !cranks_fit {
        return None;
    }
    let theta = m.members[platform].theta;
    let radius = 0.05 * scales.length * tape.between(0.1, 1.0);
    let phase = tape.angle();
    let circle = tape.chance(0.5);
    let path = if circle {
        let middle = sub(centre, scale(radius, [phase.cos(), phase.sin()]));
        format!(
            "{{ type = \"circle\", center = {middle:?}, radius = {radius:?}, frequency = {:?}, phase = {phase:?}, theta = {theta:?} }}",
            tape.between(0.1, 2.0) / scales.time
        )
    } else {
        let to = add(centre, scale(radius, [phase.cos(), phase.sin()]));
        format!(
            "{{ type = \"line\", from = [{:?}, {:?}, {theta:?}], to = [{:?}, {:?}, {:?}], duration = {:?} }}",
            centre[0],
            centre[1],
            to[0],
            to[1],
            theta + 0.05,
            scales.duration
        )
    };
    let joints = [0, 1, 2].map(joint_name);
    Some(RandomDrive {
        text: format!(
            "[drives.drive1]\ntype = \"inverse_kinematics\"\njoints = {joints:?}\nbody = {:?}\npath = {path}\n\n",
            member_name(platform)
        ),
        feature: "inverse kinematics",
        moving: true,
        moves: Vec::new(),
        by_kinematics: true,
    })
}

/// A spring or a load.
pub struct RandomForce {
    /// Its table.
    pub text: String,
    /// What it is, for tallies.
    pub feature: &'static str,
}

/// Springs and loads; anchors of springs become points of the ground.
pub fn forces(tape: &mut Tape, m: &mut RandomMechanism, scales: &Scales) -> Vec<RandomForce> {
    let mut forces = Vec::new();
    let mut name = 0;
    let mut named = |body: &str| {
        name += 1;
        format!("[forces.force{name}]\n{body}\n\n")
    };
    let springs = match m.topology {
        Topology::Masses => m.members.len() - 1,
        _ => usize::from(tape.chance(0.3)),
    };
    for k in 0..springs {
        let mut tape = tape.part(10);
        let to = match m.topology {
            Topology::Masses => PinRef {
                member: k + 1,
                pin: 0,
            },
            _ => random_pin(&mut tape, m),
        };
        let from = match m.topology {
            Topology::Masses => PinRef { member: k, pin: 0 },
            _ => {
                let off = tape.vector(-0.5, 0.0);
                let at = add(at(m, to), scale(scales.length, off));
                m.members[0].pins.push(at);
                PinRef {
                    member: 0,
                    pin: m.members[0].pins.len() - 1,
                }
            }
        };
        let distance = norm(sub(at(m, to), at(m, from)));
        let stiffness = scales.mass / scales.time.powi(2) * tape.decades(-1.0, 3.0);
        let damped = tape.chance(0.4);
        let damping = if damped {
            scales.mass / scales.time * tape.decades(-2.0, 0.5)
        } else {
            0.0
        };
        let linear = tape.chance(0.3);
        let rest = if linear {
            0.0
        } else {
            distance * tape.between(0.7, 1.3)
        };
        forces.push(RandomForce {
            text: named(&format!(
                "type = \"spring_damper\"\nfrom = {:?}\nto = {:?}\nstiffness = {stiffness:?}\ndamping = {damping:?}\nrest_length = {rest:?}",
                point_name(m, from),
                point_name(m, to)
            )),
            feature: "spring and damper",
        });
    }
    let (coil, load, motor) = (tape.chance(0.2), tape.chance(0.25), tape.chance(0.2));
    let turns = |pin: PinRef| m.members[pin.member].form != Form::Mass;
    if coil
        && let Some(j) = m.hinges.iter().position(|h| {
            matches!(h.kind, HingeKind::Ideal | HingeKind::Loose)
                && turns(h.first)
                && turns(h.second)
        })
    {
        let hinge = &m.hinges[j];
        let angle = m.members[hinge.second.member].theta - m.members[hinge.first.member].theta;
        let size = scales.force() * scales.length;
        let (stiffness, damping) = (
            size * tape.decades(-2.0, 2.0),
            size * scales.time * tape.decades(-3.0, 0.0),
        );
        let rest = angle + tape.between(-1.0, 1.0);
        forces.push(RandomForce {
            text: named(&format!(
                "type = \"torsion_spring\"\njoint = {:?}\nstiffness = {stiffness:?}\ndamping = {damping:?}\nrest_angle = {rest:?}",
                joint_name(j)
            )),
            feature: "torsion spring",
        });
    }
    if load {
        let pin = random_pin(tape, m);
        let body = tape.chance(0.4) && turns(pin);
        let [x, y] = [0, 1].map(|_| {
            let size = scales.force() * tape.signed_decades(-2.0, 1.0);
            function(tape, 0.3 * size, size, scales, false).text
        });
        let frame = if body { "body" } else { "ground" };
        forces.push(RandomForce {
            text: named(&format!(
                "type = \"force\"\npoint = {:?}\nx = {x}\ny = {y}\nframe = {frame:?}",
                point_name(m, pin)
            )),
            feature: "applied force",
        });
    }
    if motor {
        let pin = random_pin(tape, m);
        let size = scales.force() * scales.length * tape.signed_decades(-2.0, 1.0);
        let value = function(tape, 0.3 * size, size, scales, false).text;
        if turns(pin) {
            forces.push(RandomForce {
                text: named(&format!(
                    "type = \"torque\"\npoint = {:?}\nvalue = {value}",
                    point_name(m, pin)
                )),
                feature: "applied torque",
            });
        }
    }
    forces
}

fn at(m: &RandomMechanism, pin: PinRef) -> PlanePoint {
    m.members[pin.member].pins[pin.pin]
}

/// A pin of a body that moves.
fn random_pin(tape: &mut Tape, m: &RandomMechanism) -> PinRef {
    let member = tape.whole(1, m.members.len() - 1);
    let pin = tape.whole(0, m.members[member].pins.len() - 1);
    PinRef { member, pin }
}

//! Mechanisms with every kind of joint, force and drive, against closed forms and balances.

use crate::support::{TestRecording, run_scene};
use ladder::{Rung, Worst};
use looselink::scene::Scene;
use looselink::simulate::Report;
use std::f64::consts::TAU;

fn run(text: &str) -> (TestRecording, Report) {
    let scene =
        Scene::parse("mechanism", text, &[]).unwrap_or_else(|e| panic!("{e} at {:?}", e.place()));
    run_scene(&scene)
}

fn head(duration: f64, step: f64, interval: f64, gravity: [f64; 2], channels: &str) -> String {
    format!(
        r#"
format = 1
title = "mechanism"
[simulation]
duration = {duration:?}
gravity = {gravity:?}
[integrator]
method = "bathe"
step = {step:?}
newton_tolerance = 1e-12
[output]
interval = {interval:?}
channels = [{channels}]
[materials.steel]
density = 7800.0
youngs_modulus = 2.1e11
[sections.bar]
width = 0.01
height = 0.02
[bodies.ground]
type = "ground"
points.O = [0.0, 0.0]
"#
    )
}

/// Flores' slider-crank with ideal joints: closed-form kinematics, and forces by Newton and Euler.
#[test]
fn an_ideal_slider_crank_is_the_closed_form() {
    let omega = 523.598775598299;
    let text = head(
        0.012,
        2e-6,
        1e-4,
        [0.0, 0.0],
        r#""slider.*", "rod.*", "guide.*", "pin.*", "B.*", "O.torque""#,
    ) + &format!(
        r#"
[bodies.crank]
type = "link"
model = "rigid"
length = 0.05
section = "bar"
material = "steel"
[bodies.rod]
type = "rigid_body"
mass = 0.21
inertia = 2.5e-4
center_of_mass = [0.06, 0.0]
points.B = [0.0, 0.0]
points.C = [0.12, 0.0]
[bodies.slider]
type = "rigid_body"
mass = 0.14
inertia = 1e-5
points.C = [0.0, 0.0]
[joints.O]
type = "revolute"
bearing = "ground.O"
journal = "crank.start"
model = "ideal"
[joints.B]
type = "revolute"
bearing = "crank.end"
journal = "rod.B"
model = "ideal"
[joints.pin]
type = "revolute"
bearing = "slider.C"
journal = "rod.C"
model = "ideal"
[joints.guide]
type = "prismatic"
guide = "ground.O"
direction = [1.0, 0.0]
slider = "slider.C"
rotation = "locked"
[drives.motor]
type = "angle"
joint = "O"
angle = {{ type = "polynomial", coefficients = [0.3, {omega:?}] }}
[initial.sketch]
B = [0.048, 0.015]
pin = [0.167, 0.0]
"#
    );
    let (run, report) = run(&text);
    assert_eq!(
        report.rejected_steps + report.fallbacks + report.singular_poses,
        0
    );
    let (r, l) = (0.05, 0.12);
    let get = |name: &str| run.get(name);
    let t = get("t");
    let (places, motion, forces) = (Worst::new(), Worst::new(), Worst::new());
    for k in 0..t.len() {
        let phi = 0.3 + omega * t[k];
        // rod angle psi from l sin psi = -r sin phi, and its rates
        let (s, c) = phi.sin_cos();
        let psi = (-r * s / l).asin();
        let psi_dot = -r * omega * c / (l * psi.cos());
        let psi_ddot =
            (r * omega * omega * s + l * psi_dot * psi_dot * psi.sin()) / (l * psi.cos());
        let x = r * c + l * psi.cos();
        let ax =
            -r * omega * omega * c - l * (psi_ddot * psi.sin() + psi_dot * psi_dot * psi.cos());
        places.see(get("slider.x")[k] - x);
        motion.see((get("rod.omega")[k] - psi_dot) / omega);
        motion.see((get("slider.ax")[k] - ax) / (r * omega * omega));
        // the slider takes its force from the rod (pin: slider on rod) and from the guide
        let scale = 0.21 * r * omega * omega;
        forces.see((get("pin.fx")[k] + 0.14 * ax) / scale);
        forces.see((get("guide.fy")[k] - get("pin.fy")[k]) / scale);
        forces.see(get("guide.fx")[k] / scale);
        forces.see(get("guide.torque")[k] / (0.01 * scale));
        // the rod: forces of both pins are its inertia
        let rod = [get("rod.ax")[k], get("rod.ay")[k]];
        forces.see((get("B.fx")[k] + get("pin.fx")[k] - 0.21 * rod[0]) / scale);
        forces.see((get("B.fy")[k] + get("pin.fy")[k] - 0.21 * rod[1]) / scale);
        // the motor holds the moment of the rod's force about O; the crank turns evenly
        let torque = r * (c * get("B.fy")[k] - s * get("B.fx")[k]);
        forces.see((get("O.torque")[k] - torque) / (scale * r));
    }
    let reason = "the mechanism has no degree of freedom: a few roundings";
    Rung::Routes
        .asks("Ideal slider-crank: position of the slider against closed-form kinematics [m]")
        .within(&places, 1e-15, reason);
    Rung::Routes
        .asks("Ideal slider-crank: rates against closed-form kinematics, over ω (rod) and r ω² (slider)")
        .within(&motion, 1e-13, reason);
    Rung::Routes
        .asks("Ideal slider-crank: joint forces and motor torque against Newton and Euler, over the rod's m r ω² (torques: times r, guide 1 cm)")
        .within(&forces, 1e-13, reason);
    assert!(
        get("O.torque").iter().any(|m| m.abs() > 10.0),
        "nothing was tested"
    );
}

/// A rod driven about a moving body takes the torque of its inertia and weight: the drive is a constraint there.
#[test]
fn a_drive_between_moving_bodies_reports_its_torque() {
    let text = head(
        1.0,
        1e-4,
        0.05,
        [0.0, -9.81],
        r#""arm.*", "elbow.*", "energy.*""#,
    ) + r#"
[bodies.base]
type = "rigid_body"
mass = 2.0
inertia = 0.1
points.foot = [0.0, 0.0]
points.elbow = [0.0, 0.3]
[bodies.arm]
type = "rigid_body"
mass = 1.5
inertia = 0.02
points.elbow = [-0.25, 0.0]
[joints.foot]
type = "weld"
first = "ground.O"
second = "base.foot"
[joints.elbow]
type = "revolute"
bearing = "base.elbow"
journal = "arm.elbow"
model = "ideal"
[drives.motor]
type = "angle"
joint = "elbow"
angle = { type = "harmonic", mean = 0.4, amplitude = 0.8, frequency = 1.3, phase = 0.2 }
[initial.sketch]
foot = [0.0, 0.0]
elbow = [0.0, 0.3]
"#;
    let (run, report) = run(&text);
    let inertia = 0.02 + 1.5 * 0.25 * 0.25;
    let t = run.get("t");
    let (torques, motion) = (Worst::new(), Worst::new());
    for k in 0..t.len() {
        let phase = TAU * 1.3 * t[k] + 0.2;
        let angle = 0.4 + 0.8 * phase.sin();
        let growth = -0.8 * (TAU * 1.3).powi(2) * phase.sin();
        let torque = inertia * growth + 1.5 * 9.81 * 0.25 * angle.cos();
        torques.see(run.get("elbow.torque")[k] - torque);
        motion.see((run.get("elbow.angle")[k] - angle) / 1e-14);
        motion.see((run.get("elbow.speed")[k] - 0.8 * TAU * 1.3 * phase.cos()) / 1e-13);
    }
    Rung::Routes
        .asks("Arm driven about a body welded to ground: torque against that of inertia and weight [N m]")
        .within(&torques, 1e-12, "the arm's motion is prescribed: rounding of 50 N m");
    Rung::Routes
        .asks("Arm driven about a body welded to ground: angle and speed against the drive's law, in units of 1e-14 rad and 1e-13 rad/s")
        .within(&motion, 1.0, "the arm's motion is prescribed: rounding");
    Rung::Balance
        .asks("Arm driven about a body welded to ground: work of the motor against kinetic and potential energy [J]")
        .within(
            report.ledger.unwrap().numerical,
            1e-11,
            "quadrature of a smooth power: error of order 4 in h ω = 8e-4, times some joules",
        );
}

/// A beam that starts in equilibrium under its weight stays there.
#[test]
fn a_start_in_equilibrium_stays_at_rest() {
    let text = head(
        0.1,
        1e-4,
        0.01,
        [0.0, -9.81],
        r#""points.*", "energy.*", "clamp.*""#,
    ) + r#"
[bodies.beam]
type = "link"
model = "flexible"
length = 2.0
section = "bar"
material = "steel"
elements = 4
[joints.clamp]
type = "weld"
first = "ground.O"
second = "beam.start"
angle = 0.5
[initial]
equilibrium = true
bodies.beam = { x = 0.8775825618903728, y = 0.479425538604203, theta = 0.5 }
"#;
    let (run, _) = run(&text);
    let y = run.get("points.beam.end.y");
    assert!(y[0] < 2.0 * 0.5_f64.sin() - 0.01, "it hangs: {}", y[0]);
    let worst = Worst::new();
    for value in &y[1..] {
        worst.see(value - y[0]);
    }
    Rung::Balance
        .asks("Clamped beam started in equilibrium under its weight: motion of the tip over 0.1 s [m]")
        .within(&worst, 1e-13, "Newton's last update and rounding of 2 m");
    let weight = 7800.0 * 2e-4 * 2.0 * 9.81;
    Rung::Balance
        .asks("Clamped beam in equilibrium under its weight: force of the clamp against the weight, relative error")
        .within(
            run.get("clamp.fy")[0] / weight - 1.0,
            1e-9,
            "EA = 4e7 N times the rounding of a strain, 1e-16, over a weight of 30 N",
        );
    let lever: f64 = run.get("clamp.torque")[0] / weight;
    // the centre of mass of the bent beam lies near half its length along the clamp's direction
    assert!((lever - 0.5_f64.cos()).abs() < 0.02, "{lever}");
}

/// A frame of rigid bars with a flexible link welded into it, a rigid body that hangs on its middle by a loose joint, and a
/// spring with a damper across: the ledger closes at the order of the scheme.
#[test]
fn a_frame_with_a_hanging_body_balances() {
    let text = |step: f64| {
        head(
            0.04,
            step,
            0.04,
            [0.0, -9.81],
            r#""body.*", "hook.*", "strut.*", "energy.*""#,
        )
        .replace(
            "newton_tolerance",
            "onset_tolerance = 1e-14\nnewton_tolerance",
        ) + r#"
[contacts.pin]
law = "lankarani_nikravesh"
bearing_radius = 0.01
clearance = 1e-4
stiffness = 1e9
exponent = 1.5
restitution = 0.8
impact_velocity_floor = 1e-6
[bodies.left]
type = "rigid_body"
mass = 3.0
inertia = 0.05
points.foot = [0.0, -0.2]
points.top = [0.0, 0.2]
[bodies.right]
type = "rigid_body"
mass = 3.0
inertia = 0.05
points.foot = [0.0, -0.2]
points.top = [0.0, 0.2]
[bodies.beam]
type = "link"
model = "flexible"
length = 1.0
section = "bar"
material = "steel"
elements = 4
points.middle = 0.5
kelvin_voigt = 1e-4
[bodies.body]
type = "rigid_body"
mass = 1.0
inertia = 0.01
points.eye = [0.0, 0.1]
points.side = [0.1, 0.0]
[joints.foot]
type = "revolute"
bearing = "ground.O"
journal = "left.foot"
model = "ideal"
[joints.skid]
type = "prismatic"
guide = "ground.O"
direction = [1.0, 0.0]
slider = "right.foot"
rotation = "free"
[joints.corner1]
type = "weld"
first = "left.top"
second = "beam.start"
[joints.corner2]
type = "weld"
first = "right.top"
second = "beam.end"
slope = "vector"
[joints.hook]
type = "revolute"
bearing = "beam.middle"
journal = "body.eye"
model = "clearance"
contact = "pin"
[forces.strut]
type = "spring_damper"
from = "left.foot"
to = "body.side"
stiffness = 2000.0
damping = 3.0
rest_length = 0.6
[initial]
bodies.left = { x = 0.0, y = 0.2, theta = 0.0 }
bodies.right = { x = 1.0, y = 0.2, theta = 0.0 }
bodies.beam = { x = 0.5, y = 0.4, theta = 0.0 }
bodies.body = { x = 0.5, y = 0.3, theta = 0.0 }
"#
    };
    let numerical = |step: f64| {
        let (_, report) = run(&text(step));
        assert!(report.onsets >= 1, "the hook closes");
        let ledger = report.ledger.unwrap();
        assert!(
            ledger.damping_dissipated > 0.0
                && ledger.contact_dissipated > 0.0
                && ledger.stored.springs > 0.0
        );
        (
            ledger.numerical.abs(),
            ledger.damping_dissipated + ledger.contact_dissipated,
        )
    };
    let ((coarse, _), (fine, lost)) = (numerical(4e-6), numerical(1e-6));
    Rung::Balance
        .asks("Frame with a body in a loose hook, spring and damper, h = 1e-6 s: numerical loss of energy over the dissipated energy")
        .within(fine / lost, 1e-3, "a term missing from the balance would be of the order of the dissipated energy: a thousandth of it tells");
    assert!(fine < coarse, "{fine:e} {coarse:e}");
}

/// Mass-proportional damping slows a free beam by exp(-alpha t); strain-rate damping does not see the flight.
#[test]
fn damping_of_a_free_beam() {
    let text = |damping: &str| {
        head(0.5, 1e-4, 0.5, [0.0, 0.0], r#""beam.*", "energy.*""#)
            + r#"
[bodies.beam]
type = "link"
model = "flexible"
length = 0.5
section = "bar"
material = "steel"
elements = 2
"# + damping + r#"
[initial]
bodies.beam = { x = 0.0, y = 0.0, theta = 0.3, vx = 1.0, vy = -0.4, omega = 0.0 }
"#
    };
    let (mass, report) = run(&text("rayleigh = { mass = 0.7, stiffness = 0.0 }"));
    let last = |run: &TestRecording, name: &str| run.get(name)[1];
    let worst = Worst::new();
    worst.see(last(&mass, "beam.vx") - (-0.35_f64).exp());
    worst.see(last(&mass, "beam.vy") + 0.4 * (-0.35_f64).exp());
    Rung::Routes
        .asks("Free beam with mass-proportional damping α: velocity after 0.5 s against exp(-αt) [m/s]")
        .within(&worst, 1e-8, "the scheme's error of (αh)²");
    Rung::Balance
        .asks("Free beam with mass-proportional damping: numerical loss of energy over 0.5 s [J]")
        .within(
            report.ledger.unwrap().numerical,
            1e-7,
            "the scheme's error of (αh)²",
        );
    let (strain, report) = run(&text("kelvin_voigt = 1e-3"));
    let worst = Worst::new();
    worst.see((last(&strain, "beam.vx") - 1.0) / 1e-12);
    worst.see(report.ledger.unwrap().damping_dissipated / 1e-15);
    Rung::Identities
        .asks("Free beam with strain-rate damping in rigid flight: speed lost and energy dissipated in 0.5 s, in units of 1e-12 m/s and 1e-15 J")
        .within(&worst, 1.0, "a rigid motion has no strain: rounding");
}

/// A pin in a slot of a turning lever: the quick-return mechanism's lever angle is that of the crank pin seen from its pivot.
#[test]
fn a_pin_in_a_slot_turns_the_lever() {
    let text = head(0.5, 1e-4, 0.02, [0.0, 0.0], r#""lever.*", "slot.*""#).replace(
        "points.O = [0.0, 0.0]",
        "points.O = [0.0, 0.0]\npoints.P = [0.0, -0.3]",
    ) + r#"
[bodies.crank]
type = "link"
model = "rigid"
length = 0.1
section = "bar"
material = "steel"
[bodies.lever]
type = "rigid_body"
mass = 1.0
inertia = 0.02
points.pivot = [-0.25, 0.0]
[joints.O]
type = "revolute"
bearing = "ground.O"
journal = "crank.start"
model = "ideal"
[joints.P]
type = "revolute"
bearing = "ground.P"
journal = "lever.pivot"
model = "ideal"
[joints.slot]
type = "prismatic"
guide = "lever.pivot"
direction = [1.0, 0.0]
slider = "crank.end"
rotation = "free"
[drives.motor]
type = "angle"
joint = "O"
angle = { type = "polynomial", coefficients = [0.0, 12.0] }
[initial.sketch]
P = [0.0, -0.3]
slot = [0.1, 0.0]
"#;
    let (run, _) = run(&text);
    let t = run.get("t");
    let worst = Worst::new();
    for k in 0..t.len() {
        let pin = [0.1 * (12.0 * t[k]).cos(), 0.1 * (12.0 * t[k]).sin() + 0.3];
        let angle = pin[1].atan2(pin[0]);
        worst.see((run.get("lever.theta")[k] - angle) / 1e-13);
        worst.see((run.get("slot.travel")[k] - pin[0].hypot(pin[1])) / 1e-12);
        let along = (pin[0] * -1.2 * (12.0 * t[k]).sin() + pin[1] * 1.2 * (12.0 * t[k]).cos())
            / pin[0].hypot(pin[1]);
        worst.see((run.get("slot.travel_rate")[k] - along) / 1e-12);
    }
    Rung::Routes
        .asks("Quick return: angle of the lever, travel in its slot and rate against closed-form kinematics, in units of 1e-13 rad, 1e-12 m, 1e-12 m/s")
        .within(&worst, 1.0, "the mechanism has no degree of freedom: rounding");
}

/// The reaction of a hinge that has no multiplier, because its node is known, counts springs, dampers and loads at either
/// end of the link: with them it is mass times acceleration, for a rigid link and for a flexible one.
#[test]
fn reactions_without_multipliers_count_all_forces() {
    let (forces, losses) = (Worst::new(), Worst::new());
    for model in [
        "model = \"rigid\"",
        "model = \"flexible\"\nelements = 2\nkelvin_voigt = 1e-3",
    ] {
        let text = head(
            0.3,
            1e-5,
            0.01,
            [0.3, -9.81],
            r#""bar.*", "points.bar.*", "O.*", "rope.*", "twist.*""#,
        )
        .replace(
            "points.O = [0.0, 0.0]",
            "points.O = [0.0, 0.0]\npoints.P = [0.5, 0.7]",
        ) + "[bodies.bar]\ntype = \"link\"\n"
            + model
            + r#"
length = 1.0
section = "bar"
material = "steel"
[joints.O]
type = "revolute"
bearing = "ground.O"
journal = "bar.start"
model = "ideal"
[forces.rope]
type = "spring_damper"
from = "ground.P"
to = "bar.end"
stiffness = 40.0
damping = 2.0
rest_length = 0.3
[forces.twist]
type = "torsion_spring"
joint = "O"
stiffness = 3.0
damping = 0.1
rest_angle = 0.4
[forces.push]
type = "force"
point = "bar.end"
x = 2.0
y = { type = "harmonic", mean = 1.0, amplitude = 3.0, frequency = 2.0, phase = 0.0 }
frame = "body"
[forces.foot]
type = "force"
point = "bar.start"
x = 5.0
y = -4.0
frame = "ground"
[initial]
bodies.bar = { x = 0.4975020826390129, y = 0.04991670832341408, theta = 0.1 }
"#;
        let (run, report) = run(&text.replace("\"twist.*\"", "\"twist.*\", \"push.*\""));
        let get = |name: &str| run.get(name);
        let mass = 7800.0 * 2e-4;
        for k in 0..run.len() {
            let end = [get("points.bar.end.x")[k], get("points.bar.end.y")[k]];
            let to_peg = [0.5 - end[0], 0.7 - end[1]];
            let pull = get("rope.force")[k] / to_peg[0].hypot(to_peg[1]);
            for (i, (acceleration, force, push, foot, gravity)) in [
                ("bar.ax", "O.fx", "push.fx", 5.0, 0.3),
                ("bar.ay", "O.fy", "push.fy", -4.0, -9.81),
            ]
            .into_iter()
            .enumerate()
            {
                let applied = mass * gravity + pull * to_peg[i] + get(push)[k] + foot;
                let reaction = mass * get(acceleration)[k] - applied;
                forces.see(get(force)[k] - reaction);
            }
        }
        losses.see(report.ledger.unwrap().numerical);
    }
    Rung::Balance
        .asks("Hinged bar, rigid or flexible, with springs, dampers and loads: reaction against mass times acceleration less applied forces [N]")
        .within(&forces,
            1e-11,
            "the same terms summed in another order: rounding of some 10 N",
        );
    Rung::Balance
        .asks("Hinged bar, rigid or flexible, with springs, dampers and loads: numerical loss of energy over 0.3 s [J]")
        .within(&losses,
            1e-6,
            "order 2 of the scheme, times some joules",
        );
}

/// A bar on a torsional spring of 3 N m/rad, up to the damping of the spring.
fn twisted_bar(channels: &str) -> String {
    let channels = format!(r#""twist.*"{channels}"#);
    head(0.01, 1e-4, 0.01, [0.0, 0.0], &channels)
        + r#"
[bodies.bar]
type = "link"
model = "rigid"
length = 1.0
section = "bar"
material = "steel"
[joints.O]
type = "revolute"
bearing = "ground.O"
journal = "bar.start"
model = "ideal"
[forces.twist]
type = "torsion_spring"
joint = "O"
stiffness = 3.0
"#
}

/// The angle of a torsional spring is counted from the turn of its rest angle: at rest beyond half a turn it has no torque.
#[test]
fn a_torsion_spring_starts_in_the_turn_of_its_rest_angle() {
    let text = twisted_bar("")
        + r#"damping = 0.0
rest_angle = 10.0
[initial]
bodies.bar = { x = -0.4195357645382262, y = -0.2720105554446849, theta = 10.0 }
"#;
    let (run, _) = run(&text);
    for (torque, angle) in run.get("twist.torque").iter().zip(run.get("twist.angle")) {
        // rounding of 10 rad
        assert!(
            torque.abs() < 1e-13 && (angle - 10.0).abs() < 1e-14,
            "{torque} {angle}"
        );
    }
}

/// Its channel is the torque on the journal's body, counter-clockwise positive: the one that accelerates the bar.
#[test]
fn the_torque_of_a_torsion_spring_is_that_on_the_journal() {
    let text = twisted_bar(r#", "bar.alpha""#)
        + r#"damping = 0.1
rest_angle = 0.3
[initial]
bodies.bar = { x = 0.5, y = 0.0, theta = 0.0, vx = 0.0, vy = 1.0, omega = 2.0 }
"#;
    let (run, _) = run(&text);
    let [torque, alpha] = ["twist.torque", "bar.alpha"].map(|name| run.get(name)[0]);
    // 3.0 N m/rad times 0.3 rad, less 0.1 N m s/rad times 2 rad/s
    assert!((torque - 0.7).abs() < 1e-14, "{torque}");
    let last = run.get("twist.torque").len() - 1;
    let [later, slower] = ["twist.torque", "bar.alpha"].map(|name| run.get(name)[last]);
    assert!(alpha > 0.0 && (torque / alpha - later / slower).abs() < 1e-9 * torque / alpha);
}

/// Under a part s of the load a lever on a torsion spring stands where k phi = s (tau - m g l cos phi): its weight and the
/// torque grow together, the spring acts in full, and the pin carries s m g.
#[test]
fn weight_and_loads_of_a_static_analysis_grow_in_proportion() {
    let text = r#"
format = 1
title = "a lever under its weight"
[simulation]
analysis = "static"
duration = 2.0
gravity = [0.0, -9.81]
[integrator]
method = "bathe"
step = 0.05
newton_tolerance = 1e-10
[output]
interval = 0.25
channels = ["lever.theta", "O.fy"]
[bodies.ground]
type = "ground"
points.O = [0.0, 0.0]
[materials.heavy]
density = 2000.0
[sections.bar]
width = 0.1
height = 0.01
[bodies.lever]
type = "link"
model = "rigid"
length = 1.0
section = "bar"
material = "heavy"
[joints.O]
type = "revolute"
bearing = "ground.O"
journal = "lever.start"
model = "ideal"
[forces.twist]
type = "torsion_spring"
joint = "O"
stiffness = 20.0
damping = 0.0
rest_angle = 0.0
[forces.motor]
type = "torque"
point = "lever.start"
value = 3.0
[initial]
bodies.lever = { x = 0.5, y = 0.0, theta = 0.0 }
"#;
    let (run, _) = run(text);
    let left = Worst::new();
    let [t, theta, force] = ["t", "lever.theta", "O.fy"].map(|name| run.get(name));
    for (k, phi) in theta.iter().enumerate() {
        let part = 0.5 * t[k];
        left.see(20.0 * phi - part * (3.0 - 2.0 * 9.81 * 0.5 * phi.cos()));
        left.see(force[k] - part * 2.0 * 9.81);
    }
    assert_eq!(t.len(), 9);
    let reason = "N m and N, rounding of an equilibrium with torques of 10 N m and forces of 20 N";
    Rung::Identities
        .asks("Do the weight and the loads of a static analysis grow in proportion?")
        .within(&left, 1e-12, reason);
}

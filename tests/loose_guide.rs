//! Guides with play: impacts, momentum, dissipation, and what a scene must not say.

use crate::support::{difference, load, path, run, run_scene};
use ladder::{Rung, Worst};
use looselink::scene::Scene;

/// A pin that flies straight at a wall meets what a journal meets that flies along a diameter of its bearing.
#[test]
fn a_wall_is_met_as_a_bearing() {
    let wall = r#"joints.pin={type="loose_guide",guide="ground.bearing",direction=[0.0,-1.0],slider="journal.center",contact="aluminium"}"#;
    let [bearing, guide] = [&[][..], &[wall]].map(|o| run("bouncing-journal.toml", o).0);
    assert!(bearing.onsets.len() > 3, "there are impacts on both sides");
    let names = [
        "pin.penetration",
        "pin.fx",
        "pin.ex",
        "pin.ex_rate",
        "pin.eccentricity_rate",
        "journal.x",
        "journal.vx",
    ];
    let worst = difference([&bearing, &guide], names, 0.0);
    Rung::Routes
        .asks("Pin between two walls and journal on a diameter of its bearing: difference of motion, force and penetration, relative to the largest value")
        .within(&worst, 1e-9, "rounding of the normal, times a stiffness of 1e11 and a dozen impacts");
}

/// Two free bodies, a plate with a slot and a pin in it, that hit and rub.
const FREE: &str = r#"
format = 1
title = "a pin in the slot of a plate, both free"
simulation = { duration = 0.05 }
integrator = { method = "dormand_prince", step = 2e-6, onset_tolerance = 1e-13 }
output = { interval = 1e-4, channels = ["*"] }
contacts.wall = { law = "hunt_crossley", clearance = 1e-4, stiffness = 1e8, exponent = 1.5, restitution = 0.8, impact_velocity_floor = 1e-6, friction = { law = "ambrosio", coefficient = 0.3, v0 = 1e-3, v1 = 1e-1 } }
bodies.ground = { type = "ground" }
bodies.plate = { type = "rigid_body", mass = 0.3, inertia = 4e-4, points.slot = [0.03, -0.02] }
bodies.tool = { type = "rigid_body", mass = 0.2, inertia = 1e-4, points.pin = [0.01, 0.02] }
joints.slot = { type = "loose_guide", guide = "plate.slot", direction = [0.8, 0.6], slider = "tool.pin", contact = "wall" }
initial.bodies.plate = { x = 0.0, y = 0.0, theta = 0.0, vx = 0.0, vy = 0.0, omega = 1.5 }
initial.bodies.tool = { x = 0.02, y = -0.04, theta = 0.0, vx = 0.4, vy = -0.1, omega = -2.0 }
"#;

#[test]
fn momentum_and_energy_of_a_free_pin_and_slot_balance() {
    let (run, _) = run_scene(&Scene::parse("free", FREE, &[]).unwrap());
    assert!(run.onsets.len() > 5, "{} impacts", run.onsets.len());
    let momenta = |row: usize| {
        let mut sum = [0.0; 3];
        for (body, mass, inertia) in [("plate", 0.3, 4e-4), ("tool", 0.2, 1e-4)] {
            let [x, y, vx, vy, omega] =
                ["x", "y", "vx", "vy", "omega"].map(|c| run.get(&format!("{body}.{c}"))[row]);
            sum[0] += mass * vx;
            sum[1] += mass * vy;
            sum[2] += mass * (x * vy - y * vx) + inertia * omega;
        }
        sum
    };
    // largest of each: mass times speed, and that times a distance of 5 cm
    let (start, sizes) = (momenta(0), [0.1, 0.1, 0.005]);
    let worst = Worst::new();
    for row in 0..run.len() {
        for ((now, start), size) in momenta(row).into_iter().zip(start).zip(sizes) {
            worst.see((now - start) / size);
        }
    }
    let last = run.len() - 1;
    assert!(
        run.get("energy.friction_dissipated")[last] > 1e-4,
        "the pin rubs"
    );
    let numerical = Worst::new();
    let kinetic = run.get("energy.kinetic")[0];
    run.get("energy.numerical")
        .iter()
        .for_each(|lost| numerical.see(lost / kinetic));
    Rung::Balance
        .asks("Pin in the slot of a free plate, with impacts and friction: change of momentum and angular momentum, relative")
        .within(&worst, 1e-9, "momentum is linear: rounding of 25,000 steps; angular momentum: steps of 1/50 of a contact, order 5");
    Rung::Balance
        .asks("Pin in the slot of a free plate, with impacts and friction: energy lost by the integrator, relative")
        .within(&numerical, 1e-6, "steps of 1/50 of a contact, order 4 at the kinks of the friction law");
}

/// With play 0.1 mm the yoke stays within 0.1 mm and the deepest penetration of the ideal motion.
#[test]
fn a_yoke_follows_its_crank_within_the_play() {
    let overrides = ["simulation.duration=0.6"];
    let (recording, report) = run("scotch-yoke.toml", &overrides);
    assert!(report.warnings().is_empty(), "{:?}", report.warnings());
    assert!(recording.onsets.len() > 5);
    let deepest = recording
        .get("slot.penetration")
        .into_iter()
        .fold(0.0, f64::max);
    let play = recording
        .get("slot.ex")
        .into_iter()
        .fold(0.0_f64, |m, e| m.max(e.abs()));
    // the slot is upright: the distance of the pin from its centre line is ex
    assert!((play - 1e-4 - deepest).abs() < 1e-15, "{play} {deepest}");
    let travel = recording.get("slot.travel");
    let (low, high) = travel
        .iter()
        .fold((0.0_f64, 0.0_f64), |(a, b), x| (a.min(*x), b.max(*x)));
    assert!(
        (low + 0.1).abs() < 1e-3 && (high - 0.1).abs() < 1e-3,
        "{low} {high}"
    );
}

#[test]
fn contacts_of_guides_and_bearings_are_told_apart() {
    let text = std::fs::read_to_string(path("scotch-yoke.toml")).unwrap();
    for (change, told) in [
        ("contacts.pin.friction.slip=\"paper\"", "slip \"paper\""),
        (
            "joints.axle={type=\"revolute\",bearing=\"ground.axle\",journal=\"crank.start\",model=\"clearance\",contact=\"pin\"}",
            "no `bearing_radius`",
        ),
        ("joints.slot.contact=\"pins\"", "pins"),
        ("joints.slot.direction=[0.0,0.0]", "must not be zero"),
    ] {
        let error = Scene::parse("yoke", &text, &[change.to_owned()]).unwrap_err();
        assert!(error.to_string().contains(told), "{change}: {error}");
    }
    assert!(load("scotch-yoke.toml", &[]).joints[2].contact().is_some());
}

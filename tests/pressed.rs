//! Starts with the journals pressed against their bearings by the forces of the ideal joints.

use crate::bad_input::rendered;
use crate::support::{TestRecording, all_scenes, load, run};
use looselink::scene::Scene;
use looselink::simulate::{Report, Simulation};

const PRESSED: &str = "initial.journals=\"pressed\"";
/// Rigid mechanisms with loose revolute joints, and steps that resolve how a contact at rest gives way.
const RIGID: [(&str, &[&str]); 3] = [
    ("slider-crank/loose.toml", &["slider_pin"]),
    ("four-bar-three-loose.toml", &["B", "C", "D"]),
    ("3rrr/case3.toml", &["B1", "B2", "B3", "C1", "C2", "C3"]),
];

/// The first two milliseconds of a scene.
fn first(scene: &str, changes: &[String]) -> TestRecording {
    let mut changes = changes.to_vec();
    changes.push("simulation.duration=0.002".to_owned());
    changes.push("output.channels=[\"*\"]".to_owned());
    let changes: Vec<&str> = changes.iter().map(String::as_str).collect();
    run(scene, &changes).0
}

fn largest(run: &TestRecording, channel: &str) -> f64 {
    run.get(channel).iter().fold(0.0, |m, x| x.abs().max(m))
}

/// The forces at the start are those of the ideal joints, and stay near them; the impacts of a centred start exceed them many times.
#[test]
fn the_first_forces_are_those_of_the_ideal_joints() {
    for (scene, joints) in RIGID {
        let ideal = joints.iter().map(|j| format!("joints.{j}.model=\"ideal\""));
        let ideal = first(scene, &ideal.collect::<Vec<_>>());
        let pressed = first(scene, &[PRESSED.to_owned()]);
        for joint in joints {
            let [fx, fy] = ["fx", "fy"].map(|c| format!("{joint}.{c}"));
            let size = ideal.get(&format!("{joint}.force"))[0];
            for channel in [fx, fy] {
                let (wanted, found) = (ideal.get(&channel)[0], pressed.get(&channel)[0]);
                // the bodies are moved by clearances, parts in ten thousand of their lengths
                assert!(
                    (found - wanted).abs() < 0.01 * size,
                    "{scene} {channel}: {found} N, not {wanted} N"
                );
            }
            let channel = format!("{joint}.force");
            let [most, found] = [&ideal, &pressed].map(|run| largest(run, &channel));
            assert!(
                found < 1.3 * most,
                "{scene} {joint}: {found} N, not {most} N"
            );
            // the surfaces rest on each other
            let rate = pressed.get(&format!("{joint}.eccentricity_rate"))[0];
            assert!(rate.abs() < 1e-9, "{scene} {joint}: {rate} m/s");
            let supplied = largest(&pressed, "energy.kinetic");
            let lost = largest(&pressed, "energy.numerical");
            assert!(lost < 1e-4 * supplied, "{scene}: {lost} of {supplied} J");
        }
    }
    let centred = first("slider-crank/loose.toml", &[]);
    let pressed = first("slider-crank/loose.toml", &[PRESSED.to_owned()]);
    let [centred, pressed] = [centred, pressed].map(|run| largest(&run, "slider_pin.force"));
    assert!(centred > 5.0 * pressed, "{centred} N, {pressed} N");
}

/// Links that bend start undeformed and vibrate about the forces of rigid ones, which an undamped vibration at most doubles.
#[test]
fn the_first_forces_of_bending_links_are_about_those_of_rigid_ones() {
    let rigid = first("3rrr/case3.toml", &[PRESSED.to_owned()]);
    let bending = first("3rrr/case4.toml", &[PRESSED.to_owned()]);
    for joint in ["B1", "B2", "B3", "C1", "C2", "C3"] {
        let channel = format!("{joint}.force");
        let [most, found] = [&rigid, &bending].map(|run| largest(run, &channel));
        assert!(found < 2.5 * most, "{joint}: {found} N, not {most} N");
    }
}

/// The pin of a loose guide is pressed against the wall that would hold it in an ideal one.
#[test]
fn a_pin_is_pressed_against_the_wall_of_a_guide() {
    let common = [
        "drives.motor.angle=\"pi / 4 + 12 * t\"",
        "contacts.pin.friction.coefficient=0",
    ];
    let slot = "joints.slot={ type = \"prismatic\", guide = \"yoke.slot\", slider = \"crank.end\", direction = [0.0, 1.0], rotation = \"free\" }";
    let with = |change: &str| {
        let changes = common.iter().chain([&change]);
        first(
            "scotch-yoke.toml",
            &changes.map(|s| (*s).to_owned()).collect::<Vec<_>>(),
        )
    };
    let (ideal, pressed) = (with(slot), with(PRESSED));
    for channel in ["slot.fx", "slot.fy"] {
        let (wanted, found) = (ideal.get(channel)[0], pressed.get(channel)[0]);
        let size = ideal.get("slot.force")[0];
        assert!(size > 0.0);
        assert!(
            (found - wanted).abs() < 0.01 * size,
            "{channel}: {found} N, not {wanted} N"
        );
    }
    let [most, found] = [&ideal, &pressed].map(|run| largest(run, "slot.force"));
    assert!(found < 1.3 * most, "{found} N, not {most} N");
}

#[test]
fn every_scene_with_clearance_starts_pressed() {
    let mut loose = 0;
    for name in all_scenes() {
        let scene = load(&name, &[PRESSED]);
        if scene.joints.iter().all(|joint| joint.contact().is_none()) {
            continue;
        }
        loose += 1;
        let simulation = Simulation::new(&scene).unwrap_or_else(|e| panic!("{name}: {e}"));
        for (j, joint) in scene.joints.iter().enumerate() {
            let Some((gap, rate, closed)) = simulation.model().gap(j, simulation.state()) else {
                continue;
            };
            let rests = closed && gap.delta > 0.0 && rate.abs() < 1e-9;
            assert!(
                rests || gap.eccentricity < 1e-12,
                "{name}, {}: {gap:?}, {rate} m/s",
                joint.name
            );
        }
    }
    assert!(loose >= 10, "{loose} scenes");
}

/// Without a force the journal stays in the middle, and a note says so, only where the scene asks for journals that are pressed.
#[test]
fn a_journal_without_a_force_stays_centred() {
    let centred = run("bouncing-journal.toml", &[]).1;
    let (run, report) = run("bouncing-journal.toml", &[PRESSED]);
    assert_eq!(report.unpressed, Some(vec!["pin".to_owned()]));
    let said = |report: &Report| {
        report
            .notes()
            .iter()
            .any(|n| n.contains("no force presses"))
    };
    assert!(said(&report) && !said(&centred));
    let eccentricity = run.get("pin.eccentricity");
    assert!(eccentricity.iter().all(|e| *e == 0.0), "{eccentricity:?}");
}

fn refused(scene: &str, changes: &[&str]) -> String {
    let changes: Vec<String> = changes.iter().map(|s| (*s).to_owned()).collect();
    let scene = Scene::load(&crate::support::path(scene), &changes).unwrap();
    rendered(&Simulation::new(&scene).expect_err("it starts"))
}

#[test]
fn what_cannot_be_pressed_is_named() {
    let text = refused(
        "four-bar-three-loose.toml",
        &[PRESSED, "contacts.pin.clearance=1e-9"],
    );
    assert!(
        text.contains("cannot start pressed: a force of")
            && text.contains("beyond its clearance of 1\u{a0}nm"),
        "{text}"
    );
    let scene = r#"
format = 1
title = "a stretched rod in a loose pin"
simulation = { duration = 1e-4, gravity = [0.0, -9.81] }
integrator = { method = "bathe", step = 1e-6, newton_tolerance = 1e-10, onset_tolerance = 1e-12 }
output = { interval = 1e-5, channels = ["*"] }
materials.steel = { density = 7850.0, youngs_modulus = 210e9 }
sections.bar = { width = 0.01, height = 0.01 }
contacts.pin = { law = "hertz", bearing_radius = 0.01, clearance = 1e-4, stiffness = 1e11, exponent = 1.5 }
bodies.ground = { type = "ground", points.A = [0.0, 0.0] }
bodies.rod = { type = "link", model = "flexible", length = 0.5, section = "bar", material = "steel", elements = 2 }
joints.A = { type = "revolute", bearing = "ground.A", journal = "rod.start", model = "clearance", contact = "pin" }
initial.bodies.rod = { point = "start", x = 0.0, y = 0.0, theta = 0.0, strain = 1e-4 }
initial.journals = "pressed"
"#;
    let scene = Scene::parse("rod", scene, &[]).unwrap();
    let text = rendered(&Simulation::new(&scene).expect_err("it starts"));
    assert!(text.contains("rod starts stretched or bending"), "{text}");
}

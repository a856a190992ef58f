//! Scenes that must load, and what they load as.

use crate::bad_input::CASE4;
use crate::support::{all_scenes, path};
use looselink::body::{FlexibleLink, RigidBody};
use looselink::contact::Slip;
use looselink::contact::friction::Ambrosio;
use looselink::contact::normal::damped_power::{HERTZ, LANKARANI_NIKRAVESH};
use looselink::scene::Scene;
use looselink::simulate::Simulation;
use looselink::stepper::bathe::splitting;

pub fn load(text: &str, overrides: &[&str]) -> Scene {
    let overrides: Vec<String> = overrides.iter().map(|o| o.to_string()).collect();
    match Scene::parse("scene.toml", text, &overrides) {
        Ok(scene) => scene,
        Err(error) => panic!(
            "{overrides:?}: {error} at {:?}: {}",
            error.place(),
            error.underlined()
        ),
    }
}

fn edited(from: &str, to: &str) -> Scene {
    assert!(CASE4.contains(from), "`{from}` is not in the scene");
    load(&CASE4.replacen(from, to, 1), &[])
}

pub fn contact(scene: &Scene, joint: &str) -> Option<looselink::scene::Contact> {
    let joint = &scene.joints[scene.joint(joint).unwrap()];
    joint.contact().cloned()
}

#[test]
fn every_scene_of_the_folder_loads() {
    let names = all_scenes();
    for name in &names {
        Scene::load(&path(name), &[]).unwrap_or_else(|e| panic!("{name}: {e} at {:?}", e.place()));
    }
    assert!(names.len() >= 26, "only {names:?} found");
}

#[test]
fn case_4_is_what_the_paper_says() {
    let scene = load(CASE4, &[]);
    let names: Vec<&str> = scene.bodies.iter().map(|b| b.name.as_str()).collect();
    assert_eq!(
        names,
        [
            "ground", "crank1", "crank2", "crank3", "link1", "link2", "link3", "platform"
        ]
    );
    let names: Vec<&str> = scene.joints.iter().map(|j| j.name.as_str()).collect();
    assert_eq!(
        names,
        ["A1", "A2", "A3", "B1", "B2", "B3", "C1", "C2", "C3"]
    );
    assert_eq!(scene.drives[0].joints, [0, 1, 2]);
    let method = scene.integrator.method;
    assert_eq!((method.name(), splitting(&method)), ("bathe", 0.5));
    let flexible: &FlexibleLink = scene.bodies[4].kind.get().unwrap();
    assert_eq!((flexible.elements, flexible.youngs_modulus), (1, 7e9));
    let link = &flexible.link;
    assert_eq!((link.area, link.density), (0.005 * 0.03, 2700.0));
    // Relative tolerance 1e-15: a handful of roundings.
    approx::assert_relative_eq!(
        link.second_moment,
        0.03 * 0.005f64.powi(3) / 12.0,
        max_relative = 1e-15
    );
    let platform: &RigidBody = scene.bodies[7].kind.get().unwrap();
    // Four digits are given: 0.440 kg; I = m s^2 / 12 with s = sqrt(3) 0.112 m.
    approx::assert_abs_diff_eq!(platform.mass, 0.440, epsilon = 5e-4);
    let side = 3f64.sqrt() * 0.112;
    approx::assert_relative_eq!(
        platform.inertia,
        platform.mass * side * side / 12.0,
        max_relative = 1e-15
    );
    approx::assert_abs_diff_eq!(platform.points[2].at[0], 0.0, epsilon = 1e-16);
    approx::assert_relative_eq!(platform.points[2].at[1], 0.112);
    let pin = contact(&scene, "C2").unwrap();
    assert_eq!(pin.law, &LANKARANI_NIKRAVESH);
    let compliance = 2.0 * (1.0 - 0.33f64.powi(2)) / 70e9;
    let stiffness = 4.0 / (3.0 * compliance) * (0.01f64 * (0.01 - 2e-5) / 2e-5).sqrt();
    // R_j = R_i - c loses c's last bits.
    approx::assert_relative_eq!(pin.stiffness, stiffness, max_relative = 1e-14);
    let friction = pin.friction.unwrap();
    let law = friction.law.get::<Ambrosio>().unwrap();
    assert_eq!(
        (law.coefficient, law.v0, law.v1, friction.slip),
        (0.1, 1e-4, 1e-3, Slip::Paper)
    );
    let assumed = scene
        .assumptions
        .iter()
        .find(|a| a.path == "contacts.pin.restitution")
        .unwrap();
    assert_eq!(assumed.value, "0.9");
}

#[test]
fn all_assumed_values_of_a_scene_are_listed() {
    for scene in [
        "case1",
        "case2",
        "case3",
        "case4",
        "case2-70gpa",
        "case4-friction",
        "case4-4elements",
    ] {
        let text = std::fs::read_to_string(format!("scenes/3rrr/{scene}.toml")).unwrap();
        let marked = text
            .lines()
            .filter(|l| !l.starts_with('#') && l.contains("# assumed"))
            .count();
        let listed = load(&text, &[]).assumptions.len();
        assert!(
            listed >= marked,
            "{scene}: {marked} marked, {listed} listed"
        );
    }
}

#[test]
fn edits_that_are_allowed() {
    edited("duration = 3.0", "duration = 3\ngravity = [0, -9.81]");
    edited("method =", "gamma = 0.5857864376269049\nmethod =");
    edited("center = [0.0, 0.0]", "center = [0, 0]");
    edited(
        "points.A1 = { radius = 0.4, degrees = 210 }",
        "points.A1 = [-0.3464, -0.2]",
    );
    edited("interval = 1e-4", "interval = 0.0003");
    edited("frequency = 1.0", "frequency = -1.0");
    assert_eq!(
        contact(&edited("slip = \"paper\"", ""), "B1")
            .unwrap()
            .friction
            .unwrap()
            .slip,
        Slip::Material
    );
    assert!(
        contact(&edited("coefficient = 0.1", "coefficient = 0"), "B1")
            .unwrap()
            .friction
            .is_none()
    );
    let stiff = edited(
        "bearing_material = \"aluminium\"\njournal_material = \"aluminium\"",
        "stiffness = 1e11",
    );
    assert_eq!(contact(&stiff, "B1").unwrap().stiffness, 1e11);
    let hertz = CASE4.replacen("lankarani_nikravesh", "hertz", 1);
    let hertz = load(
        &hertz.replacen("restitution = 0.9", "restitution = 1.0", 1),
        &[],
    );
    assert_eq!(contact(&hertz, "B1").unwrap().law, &HERTZ);
}

#[test]
fn paths() {
    let circle = "{ type = \"circle\", center = [0.0, 0.0], radius = 0.1, frequency = 1.0, phase = 0.0, theta = 0.0 }";
    let line = edited(
        circle,
        "{ type = \"line\", from = [0, 0, 0], to = [0.1, 0, 0.2], duration = 1 }",
    );
    // halfway in time is halfway along a quintic
    let half = line.drives[0].path.at(0.5);
    assert_eq!(half.position, [0.05, 0.0, 0.1]);
    let table = edited(
        circle,
        "{ type = \"table\", rows = [[0, 0, 0, 0], [1, 0.1, 0, 0],\n [3, 0, 0, 0]] }",
    );
    assert_eq!(table.drives[0].path.at(1.0).position, [0.1, 0.0, 0.0]);
}

#[test]
fn plates() {
    let triangle = "plate = { shape = \"equilateral_triangle\", circumradius = 0.112, thickness = 0.01, material = \"aluminium\" }";
    let mass = |scene: &Scene| {
        let rigid: &RigidBody = scene.bodies[7].kind.get().unwrap();
        (rigid.mass, rigid.inertia)
    };
    let disc = edited(
        triangle,
        "plate = { shape = \"disc\", radius = 0.1, thickness = 0.01, material = \"aluminium\" }",
    );
    let (m, i) = mass(&disc);
    approx::assert_relative_eq!(
        m,
        2700.0 * std::f64::consts::PI * 1e-4,
        max_relative = 1e-14
    );
    approx::assert_relative_eq!(i, m * 0.1 * 0.1 / 2.0, max_relative = 1e-14);
    let rectangle = "plate = { shape = \"rectangle\", width = 0.3, height = 0.4, thickness = 0.01, material = \"aluminium\" }";
    let (m, i) = mass(&edited(triangle, rectangle));
    approx::assert_relative_eq!(m, 2700.0 * 0.12 * 0.01, max_relative = 1e-14);
    approx::assert_relative_eq!(i, m * 0.25 / 12.0, max_relative = 1e-14);
    // A mass beside the plate scales the inertia with it.
    let (m, i) = mass(&load(CASE4, &["bodies.platform.mass=1.2"]));
    assert_eq!(m, 1.2);
    approx::assert_relative_eq!(i, 1.2 * 0.112 * 0.112 / 4.0, max_relative = 1e-14);
    let assumption = CASE4
        .lines()
        .find(|l| l.starts_with("\"bodies.platform.plate"))
        .unwrap();
    let typed = CASE4.replacen(triangle, "mass = 1.5\ninertia = 0.01", 1);
    assert_eq!(
        mass(&load(&typed.replacen(assumption, "", 1), &[])),
        (1.5, 0.01)
    );
}

#[test]
fn no_scene_needs_the_onset_tolerance_without_clearance() {
    let text = std::fs::read_to_string("scenes/3rrr/case1.toml").unwrap();
    load(&text.replacen("onset_tolerance = 1e-13", "", 1), &[]);
}

/// A pattern chooses all channels that it fits, and every channel is recorded once, behind the time.
#[test]
fn channels_are_chosen_by_patterns() {
    for (patterns, expected) in [
        (
            r#"["B1.f*e", "*.fx", "B1.force"]"#,
            "t B1.force A1.fx A2.fx A3.fx B1.fx B2.fx B3.fx C1.fx C2.fx C3.fx",
        ),
        (r#"["platform.theta", "t"]"#, "t platform.theta"),
        (r#"["error.*"]"#, "t error.x error.y error.theta"),
    ] {
        let scene = load(CASE4, &[&format!("output.channels={patterns}")]);
        let simulation = Simulation::new(&scene).unwrap();
        let names = simulation.channels().iter().map(|c| c.name.as_str());
        assert_eq!(names.collect::<Vec<_>>().join(" "), expected);
    }
    // a channel is not known by the beginning of its name
    let scene = load(CASE4, &[r#"output.channels=["B1.f"]"#]);
    assert!(Simulation::new(&scene).is_err());
}

/// The velocities belong to the method and have defaults, the coefficient is a property of the materials.
#[test]
fn velocities_of_friction_have_defaults() {
    let changes = [r#"contacts.aluminium.friction={ law = "ambrosio", coefficient = 0.2 }"#];
    let text = include_str!("../scenes/bouncing-journal.toml");
    let friction = contact(&load(text, &changes), "pin")
        .unwrap()
        .friction
        .unwrap();
    let law = friction.law.get::<Ambrosio>().unwrap();
    assert_eq!([law.v0, law.v1], [1e-4, 1e-3]);
    assert_eq!(law.coefficient, 0.2);
    let typed = [
        r#"contacts.aluminium={ law = "hertz", bearing_radius = 0.01, clearance = 2e-5, stiffness = 1e10, exponent = 1.5 }"#,
    ];
    let from_materials =
        |changes: &[&str]| contact(&load(text, changes), "pin").unwrap().from_materials;
    assert!(from_materials(&[]) && !from_materials(&typed));
}

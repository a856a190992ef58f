//! Kinds that a user of the library adds.

use crate::support::run_scene;
use looselink::contact::normal::{NormalForce, NormalLaw, NormalLawKind, NormalParameters};
use looselink::document::Key;
use looselink::motion::{Function, FunctionKind, FunctionOfTime};
use looselink::registry::Registry;
use looselink::scene::Scene;
use looselink::simulate::{Recording, RunError, Simulation};
use looselink::stepper::{Method, Parameter, Scheme};
use std::sync::Arc;

#[path = "../examples/own_contact_law.rs"]
#[allow(dead_code, reason = "the example is a program")]
mod own_contact_law;

#[path = "../examples/own_integrator.rs"]
#[allow(dead_code, reason = "the example is a program")]
mod own_integrator;

#[path = "../examples/own_interaction.rs"]
#[allow(dead_code, reason = "the example is a program")]
mod own_interaction;

#[path = "../examples/own_observer.rs"]
#[allow(dead_code, reason = "the example is a program")]
mod own_observer;

mod quantities;
mod slot;

/// A wall that pushes with a constant force.
#[derive(Debug)]
struct Constant(f64);

impl NormalLaw for Constant {
    fn force(&self, _: f64, _: f64, _: f64) -> NormalForce {
        NormalForce {
            value: self.0,
            by_delta: 0.0,
            by_rate: 0.0,
            elastic: self.0,
            clamped: false,
        }
    }

    fn energy(&self, delta: f64) -> f64 {
        self.0 * delta.max(0.0)
    }

    fn delivered_restitution(&self) -> f64 {
        1.0
    }
}

static CONSTANT: NormalLawKind = NormalLawKind {
    name: "constant",
    is_damped: false,
    keys: &[Key::positive(
        "force",
        "N",
        "of `\"constant\"`: the force of every penetration",
    )],
    build: |p: &NormalParameters| Box::new(Constant(p.own[0])),
};

/// The scheme of the example, with a parameter that it does not use.
static SYMPLECTIC_EULER: Scheme = Scheme {
    name: "symplectic_euler",
    order: 1,
    is_explicit: true,
    keeps_constraints: false,
    parameters: &[Parameter {
        name: "theta",
        range: [0.0, 1.0],
        closed: true,
        default: Some("0.5"),
        purpose: "the share of the acceleration",
    }],
    build: |_, shape| (own_integrator::SCHEME.build)(&Method::new(&own_integrator::SCHEME), shape),
};

fn registry() -> Registry {
    Registry::standard()
        .with_law(&CONSTANT)
        .with_scheme(&SYMPLECTIC_EULER)
}

fn scene(overrides: &[&str]) -> Result<Scene, looselink::scene::SceneError> {
    let text = include_str!("../scenes/bouncing-journal.toml");
    let overrides: Vec<String> = overrides.iter().map(|o| (*o).to_owned()).collect();
    Scene::parse_with(&registry(), "bouncing-journal.toml", text, &overrides)
}

#[test]
fn a_scene_names_a_law_and_a_scheme_of_the_user() {
    let scene = scene(&[
        "integrator={method=\"symplectic_euler\",step=1e-7,onset_tolerance=1e-13}",
        "simulation.duration=0.004",
        "output={interval=1e-5,channels=[\"journal.vx\",\"pin.*\"]}",
        "contacts.aluminium={law=\"constant\",bearing_radius=0.01,clearance=2e-5,stiffness=1.0,exponent=1.0,force=50.0}",
    ]);
    let mut simulation = Simulation::new(&scene.unwrap()).unwrap();
    let mut recording = Recording::new(&simulation);
    simulation.run(&mut recording).unwrap();
    // 0.05 kg at 0.02 m/s turns back in 2 m v/F
    let contact = &recording.onsets[0];
    let lasted = contact.end.unwrap() - contact.t;
    // order 1: a step of 1e-7 s in 4e-5 s
    assert!((lasted - 4e-5).abs() < 1e-6, "{lasted}");
    assert!((contact.impact_velocity - 0.02).abs() < 1e-12);
}

/// chi = 3 (1 - c_e)/(2 c_e) delivers 0.8999 for a restitution of 0.9.
#[test]
fn a_scene_names_the_law_of_the_example() {
    let registry = Registry::standard().with_law(&own_contact_law::LAW);
    let text = include_str!("../scenes/bouncing-journal.toml");
    let own = ["contacts.aluminium.law=hu_guo".to_owned()];
    let scene = Scene::parse_with(&registry, "bouncing-journal.toml", text, &own).unwrap();
    let recording = run_scene(&scene).0;
    let impact = &recording.onsets[0];
    let restitution = impact.exit_velocity.unwrap() / impact.impact_velocity;
    // 50 steps of order 2 in a contact
    assert!((restitution - 0.8999).abs() < 5e-4, "{restitution}");
}

#[test]
fn parameters_and_names_of_the_user_are_checked_as_all_others() {
    for (overrides, message) in [
        (
            ["integrator.method=symplectic_euler", "integrator.theta=2"],
            "`integrator.theta` must lie between 0 and 1, not 2",
        ),
        (
            ["integrator.method=bathe", "integrator.theta=1"],
            "`integrator.theta` is a parameter of \"symplectic_euler\" only",
        ),
        (
            ["integrator.method=symplectic_eule", "integrator.step=1e-6"],
            "did you mean `symplectic_euler`?",
        ),
        (
            ["contacts.aluminium.law=konstant", "integrator.step=1e-6"],
            "did you mean `constant`?",
        ),
        (
            ["contacts.aluminium.law=constant", "integrator.step=1e-6"],
            "missing key `force` in contacts.aluminium",
        ),
        (
            ["contacts.aluminium.force=1.0", "integrator.step=1e-6"],
            "unknown key `force` in contacts.aluminium",
        ),
    ] {
        let error = scene(&overrides).unwrap_err().to_string();
        assert!(error.contains(message), "{error}");
    }
    // without the registry nobody knows them
    let text = include_str!("../scenes/bouncing-journal.toml");
    let unknown = ["integrator.method=symplectic_euler".to_owned()];
    assert!(Scene::parse("bouncing-journal.toml", text, &unknown).is_err());
    assert_eq!(Method::new(&SYMPLECTIC_EULER).get("gamma"), None);
}

/// A joint with a contact geometry of its own is the loose guide of the library, on a body that does not turn.
#[test]
fn a_scene_names_a_joint_of_the_user() {
    let registry = Registry::standard().with_joint(&slot::KIND);
    let text = slot::SCENE;
    let guide = text
        .replace(
            "type = \"slot\", middle =",
            "type = \"loose_guide\", guide =",
        )
        .replace(", pin =", ", slider =");
    assert!(Scene::parse("slot", text, &[]).is_err());
    let [own, guide] = [text, &guide].map(|text| {
        let scene = Scene::parse_with(&registry, "slot", text, &[]).unwrap();
        run_scene(&scene).0
    });
    assert!(own.onsets.len() > 2, "{} impacts", own.onsets.len());
    assert_eq!(own.onsets.len(), guide.onsets.len());
    // the first impacts: later ones amplify rounding
    let rows = own.row(0.05);
    for name in own.names() {
        let (a, b) = (own.get(name), guide.get(name));
        // the balance of energy is a difference of energies that are far larger
        let size = a.iter().fold(1e-5_f64, |m, x| m.max(x.abs()));
        for (a, b) in a.iter().zip(&b).take(rows) {
            assert!((a - b).abs() < 1e-9 * size, "{name}: {a} {b}");
        }
    }
}

/// Quadratic drag alone on a mass: v = v_0/(1 + c v_0 t/m).
#[test]
fn a_scene_names_the_force_of_the_example() {
    const SCENE: &str = r#"
        format = 1
        title = "a mass in water"
        simulation = { duration = 1.0 }
        integrator = { method = "bathe", step = 1e-3, newton_tolerance = 1e-12 }
        output = { interval = 0.1, channels = ["mass.*", "water.*", "energy.*"] }
        bodies.ground = { type = "ground", points.O = [0.0, 0.0] }
        bodies.mass = { type = "point_mass", mass = 2.0 }
        forces.water = { type = "drag", point = "mass.center", coefficient = 0.5 }
        initial.bodies.mass = { x = 0.0, y = 0.0, vx = 2.4, vy = 3.2 }
    "#;
    let registry = Registry::standard().with_force(&own_interaction::DRAG);
    let scene = Scene::parse_with(&registry, "scene", SCENE, &[]).unwrap();
    let (recording, _) = run_scene(&scene);
    let (t, fy) = (recording.get("t"), recording.get("water.fy"));
    let (vx, work) = (recording.get("mass.vx"), recording.get("energy.work"));
    for i in 0..t.len() {
        // c v_0/m is 1/s
        let v = 4.0 / (1.0 + t[i]);
        // order 2 with steps of a thousandth of the time in which the speed halves
        assert!((vx[i] - 0.6 * v).abs() < 1e-6 * v, "{}", vx[i]);
        assert!((fy[i] + 0.8 * 0.5 * v * v).abs() < 1e-5, "{}", fy[i]);
        assert!((work[i] - (v * v - 16.0)).abs() < 1e-5, "{}", work[i]);
    }
}

/// The observer of the example sees the impacts that a recording keeps, and stops the run.
#[test]
fn an_observer_of_the_user_sees_all_contacts() {
    let overrides = ["simulation.duration=0.02".to_owned()];
    let path = "scenes/slider-crank/loose.toml".as_ref();
    let scene = Scene::load(path, &overrides).unwrap();
    let mut hardest = own_observer::HardestImpacts::default();
    let mut simulation = Simulation::new(&scene).unwrap();
    let ended = simulation.run(&mut hardest).unwrap_err();
    assert!(matches!(ended, RunError::Interrupted { .. }), "{ended}");
    let recording = run_scene(&scene).0;
    let ended = recording.onsets.iter().filter(|onset| onset.end.is_some());
    let velocities: Vec<f64> = ended
        .take(hardest.contacts)
        .map(|onset| onset.impact_velocity)
        .collect();
    assert!(hardest.contacts >= 20, "{hardest:?}");
    assert_eq!(velocities.len(), hardest.contacts);
    let largest = velocities.into_iter().fold(0.0, f64::max);
    assert_eq!(
        hardest.by_joint,
        [("slider_pin".to_owned(), largest)].into()
    );
}

/// height t^2
#[derive(Debug)]
struct Parabola(f64);

impl FunctionOfTime for Parabola {
    fn at(&self, t: f64) -> [f64; 3] {
        [self.0 * t * t, 2.0 * self.0 * t, 2.0 * self.0]
    }
}

static PARABOLA: FunctionKind = FunctionKind {
    name: "parabola",
    keys: &[Key::number("height", "value/s2", "the value at one second")],
    read: |table, _, _| Ok(Function::Own(Arc::new(Parabola(table.number("height")?)))),
};

/// A load, a driven angle and a path follow a function of the user as they follow that of the library.
#[test]
fn a_scene_names_a_function_of_the_user() {
    const SCENE: &str = r#"
        format = 1
        title = "a pendulum on a crank and a mass that is pushed"
        simulation = { duration = 0.5, gravity = [0.0, -9.81] }
        integrator = { method = "trapezoidal", step = 1e-3, newton_tolerance = 1e-10 }
        output = { interval = 0.1, channels = ["*"] }
        bodies.ground = { type = "ground", points.O = [0.0, 0.0] }
        bodies.crank = { type = "rigid_body", mass = 1.0, inertia = 0.1, points.A = [0.0, 0.0], points.B = [0.5, 0.0] }
        bodies.stage = { type = "moving", path = { type = "coordinates", x = F, y = 0.0, theta = 0.0 }, points.P = [1.0, 0.0] }
        bodies.mass = { type = "point_mass", mass = 2.0 }
        joints.O = { type = "revolute", model = "ideal", bearing = "ground.O", journal = "crank.A" }
        drives.turn = { type = "angle", joint = "O", angle = F }
        forces.spring = { type = "spring_damper", from = "stage.P", to = "mass.center", stiffness = 50.0, damping = 1.0, rest_length = 0.0 }
        forces.push = { type = "force", point = "mass.center", x = F, y = 0.0, frame = "ground" }
        forces.twist = { type = "torque", point = "crank.B", value = F }
        initial.bodies.mass = { x = 1.0, y = 0.0 }
    "#;
    let registry = Registry::standard().with_function(&PARABOLA);
    let run = |function: &str| {
        let text = SCENE.replace("= F", &format!("= {function}"));
        let scene = Scene::parse_with(&registry, "scene", &text, &[]).unwrap();
        run_scene(&scene).0
    };
    let own = run("{ type = \"parabola\", height = 3.0 }");
    let polynomial = run("{ type = \"polynomial\", coefficients = [0.0, 0.0, 3.0] }");
    for name in own.names() {
        let (a, b) = (own.get(name), polynomial.get(name));
        let size = a.iter().fold(1e-9_f64, |m, x| m.max(x.abs()));
        for (a, b) in a.iter().zip(&b) {
            // rounding of some hundred steps
            assert!((a - b).abs() < 1e-10 * size, "{name}: {a} {b}");
        }
    }
    assert!(own.get("mass.x")[5] > 1.0, "nothing moved");
}

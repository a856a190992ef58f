//! The boundary: errors come back typed and with their text, and mechanisms that make no sense are refused.

use looselink::simulate::Simulation;
use verify::channels::coordinates;
use verify::compare::classes;
use verify::reference::{Error, Mechanism, Row, System};
use verify::trajectory::{Plan, tolerances};

fn mechanism(scene: &'static str) -> Mechanism {
    let plan = Plan::new(scene, 0.01, 1e-3);
    plan.description().unwrap().mechanism
}

#[test]
fn full_coordinates_are_counted() {
    for (scene, unknowns, constraints) in [
        ("3rrr/case1", 27, 3 + 3 + 6 + 6 + 6 + 3),
        ("3rrr/case2", 39, 3 + 6 + 6 + 6 + 3),
        ("3rrr/case3", 27, 3 + 3 + 6 + 3),
        ("3rrr/case4", 39, 3 + 6 + 3),
    ] {
        let mechanism = mechanism(scene);
        let system = System::new(&mechanism).unwrap();
        let sum: usize = mechanism.bodies.iter().map(coordinates).sum();
        assert_eq!(system.coordinates(), sum, "{scene}");
        assert_eq!(
            [system.coordinates(), system.constraints()],
            [unknowns, constraints],
            "{scene}"
        );
    }
}

#[test]
fn bad_mechanisms_are_refused_by_name() {
    type Damage = fn(&mut Mechanism);
    let damages: [(&str, Damage); 6] = [
        ("joint", |m| m.joints[4].journal.body = 99),
        ("body", |m| m.bodies[1].density = -1.0),
        ("body", |m| m.bodies[4].elements = 0),
        ("contact", |m| m.contacts[0].clearance = f64::NAN),
        ("leg", |m| m.legs[1].joint_b = -3),
        ("path", |m| m.path.radius = f64::INFINITY),
    ];
    for (part, damage) in damages {
        let mut mechanism = mechanism("3rrr/case4");
        damage(&mut mechanism);
        match System::new(&mechanism) {
            Err(Error::BadInput(message)) => {
                assert!(message.contains(part), "{part}: {message}");
            }
            other => panic!("{part}: {other:?}"),
        }
    }
}

/// What the reference lacks is refused, not left out.
#[test]
fn scenes_beyond_the_reference_are_refused() {
    for (text, missing) in [
        ("bodies.platform.plate.shape=\"disc\"", "disc"),
        ("contacts.pin.law=\"hertz\"", "hertz"),
        ("drives.input.path={type=\"line\"}", "drives.input"),
    ] {
        let plan = Plan::new("3rrr/case3", 0.01, 1e-3).with("", &[text.to_owned()]);
        let error = format!("{:?}", plan.description().unwrap_err());
        assert!(error.contains(missing), "{error}");
    }
}

#[test]
fn a_path_out_of_reach_is_refused_with_its_time() {
    let mut mechanism = mechanism("3rrr/case1");
    mechanism.path.radius = 0.4;
    let system = System::new(&mechanism).unwrap();
    let tried = (0..100).find_map(|k| system.start(0.01 * f64::from(k)).err());
    match tried {
        Some(Error::Unreachable { message, .. }) => assert!(message.contains("leg"), "{message}"),
        other => panic!("{other:?}"),
    }
}

/// What IDA says arrives word by word, with its flag and the time, and the run is dead afterwards.
#[test]
fn a_failure_of_ida_is_an_error_with_its_message() {
    let mechanism = mechanism("3rrr/case2");
    let system = System::new(&mechanism).unwrap();
    let (q, v) = system.start(0.0).unwrap();
    let mut row = Row::default();
    let impossible = tolerances(1e-18, 1e-40, 1e-40);
    let mut run = system.run(0.0, &q, &v, &impossible).unwrap();
    let first = run.advance(0.01, &mut row).unwrap_err();
    match &first {
        // IDA_TOO_MUCH_ACC
        Error::Ida {
            flag: -2, message, ..
        } => {
            assert!(message.contains("too much accuracy"), "{message}");
        }
        other => panic!("{other:?}"),
    }
    assert_eq!(run.advance(0.02, &mut row).unwrap_err(), first);
}

/// So does a budget of steps that is used up.
#[test]
fn too_many_steps_are_an_error() {
    let mechanism = mechanism("3rrr/case2");
    let system = System::new(&mechanism).unwrap();
    let (q, v) = system.start(0.0).unwrap();
    let mut few = tolerances(1e-10, 1e-13, 1e-11);
    few.max_steps = 10;
    let mut run = system.run(0.0, &q, &v, &few).unwrap();
    match run.advance(0.01, &mut Row::default()) {
        Err(Error::Ida { message, t, .. }) => {
            assert!(message.contains("max_steps"), "{message}");
            assert!(t > 0.0 && t < 0.01, "{t}");
        }
        other => panic!("{other:?}"),
    }
}

#[test]
fn the_same_run_gives_the_same_bytes() {
    let bits = || {
        let run = Plan::new("3rrr/case4", 0.006, 1e-3).cpp(&tolerances(1e-8, 1e-11, 1e-9));
        let run = run.unwrap();
        let columns = run.columns.into_values().flatten();
        columns.map(f64::to_bits).collect::<Vec<_>>()
    };
    assert_eq!(bits(), bits());
}

/// Channels without a counterpart are those that the report lists, and no others slip in.
#[test]
fn channels_without_a_counterpart_are_known() {
    let plan = Plan::new("3rrr/case4-friction", 1e-3, 1e-4);
    let (rust, cpp) = (
        plan.rust(1e-5).unwrap(),
        plan.cpp(&tolerances(1e-6, 1e-9, 1e-7)).unwrap(),
    );
    let eccentricity = [".ex", ".ey", ".ex_rate", ".ey_rate", ".eccentricity_rate"];
    let angles = [".theta"];
    let known = |name: &String| {
        eccentricity
            .iter()
            .chain(&angles)
            .any(|e| name.ends_with(e))
            || ["energy.gravity", "energy.damping_dissipated"].contains(&name.as_str())
    };
    let missing = classes::missing(&rust, &cpp);
    assert!(missing.iter().all(known), "{missing:?}");
    assert!(rust.columns.len() > 4 * missing.len(), "most are compared");
    for name in cpp.columns.keys() {
        assert!(rust.columns.contains_key(name), "Looselink has no {name}");
    }
    let scene = plan.scene(1e-5).unwrap();
    let channels = Simulation::new(&scene).unwrap().channels().len();
    assert_eq!(
        channels,
        rust.columns.len() + 1,
        "all channels and the time"
    );
}

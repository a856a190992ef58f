//! Thresholds of what a run says of itself, and scales of the errors that its control follows: runs on both sides of each.

use crate::support::{load, run_scene};
use ladder::{Rung, Worst};
use looselink::model::Model;
use looselink::scene::Scene;
use looselink::simulate::{
    ContactEvent, Control, Observer, Onset, Progress, Recording, Report, RunError, Simulation,
};
use looselink::system::State;
use std::f64::consts::PI;
use std::io::Result;

/// A point mass on a horizontal spring to the ground; without stiffness there is no spring.
#[derive(Clone, Copy, Default)]
struct Oscillator {
    mass: f64,
    stiffness: f64,
    damping: f64,
    /// From its place at rest \[m\].
    displacement: f64,
    velocity: f64,
}

/// One radian per second and one metre.
const UNIT: Oscillator = Oscillator {
    mass: 1.0,
    stiffness: 1.0,
    damping: 0.0,
    displacement: 1.0,
    velocity: 0.0,
};

fn parse(text: &str) -> Scene {
    Scene::parse("scene", text, &[]).unwrap_or_else(|e| panic!("{e}\n{text}"))
}

/// Point masses that do not touch each other.
fn oscillators(masses: &[Oscillator], integrator: &str, interval: f64, duration: f64) -> Scene {
    let mut text = format!(
        r#"
format = 1
title = "oscillators"
simulation = {{ duration = {duration:?} }}
integrator = {{ {integrator} }}
output = {{ interval = {interval:?}, channels = ["*"] }}
bodies.ground = {{ type = "ground", points.left = [-10.0, 0.0] }}
"#
    );
    for (i, one) in masses.iter().enumerate() {
        let (x, v) = (one.displacement, one.velocity);
        text += &format!(
            "bodies.m{i} = {{ type = \"point_mass\", mass = {:?} }}\n",
            one.mass
        );
        text += &format!("initial.bodies.m{i} = {{ x = {x:?}, y = 0.0, vx = {v:?}, vy = 0.0 }}\n");
        if one.stiffness > 0.0 {
            text += &format!(
                "forces.s{i} = {{ type = \"spring_damper\", from = \"ground.left\", to = \"m{i}.center\", stiffness = {:?}, damping = {:?}, rest_length = 10.0 }}\n",
                one.stiffness, one.damping
            );
        }
    }
    parse(&text)
}

/// Runs just below the thresholds of warnings, without the warning, and just above, with it.
///
/// * The backward Euler rule takes the part (omega h)^2 of the energy of an oscillator in every step, and a damper c h/m of it.
/// * Velocity Verlet changes the acceleration of an oscillator by omega h of its size.
/// * The trapezoidal rule has the local errors h^3 a'/12 and h^3 a''/12. In n periods of an oscillator of amplitude A they add up to
///   (omega h)^2 A n/3 and, times the time 2/omega in which it crosses its range 2 A, to (omega h)^2 A/6: of that range, with n = 5,
///   to 22 (omega h)^2/24.
/// * A link that starts compressed has its largest strain at the start.
#[test]
fn warnings_begin_at_their_thresholds_in_runs() {
    const PARTS: [f64; 2] = [0.97, 1.03];
    let euler = |step: f64| {
        format!("method = \"backward_euler\", newton_tolerance = 1e-13, step = {step:e}")
    };
    let lost = PARTS.map(|part| {
        let steps = (1e-2 * part / (1e-4 - 5e-7 * part)).round();
        oscillators(&[UNIT], &euler(0.01), 0.01, 0.01 * steps)
    });
    let dissipated = PARTS.map(|part| {
        let damped = Oscillator {
            damping: 1e-3 / (0.05 * part),
            ..UNIT
        };
        oscillators(&[damped], &euler(1e-3), 0.1, 6.3)
    });
    let unresolved = PARTS.map(|part| {
        let method = format!("method = \"velocity_verlet\", step = {part}");
        oscillators(&[UNIT], &method, part, 300.0 * part)
    });
    let erring = PARTS.map(|part| {
        let step = (0.24 * part / 22.0_f64).sqrt();
        let method = format!("method = \"trapezoidal\", newton_tolerance = 1e-13, step = {step:?}");
        let duration = step * (10.0 * PI / step).round();
        oscillators(&[UNIT], &method, step, duration)
    });
    let strained = PARTS.map(|part| {
        parse(&format!(
            r#"
format = 1
title = "a soft rod is released"
simulation = {{ duration = 1e-3 }}
integrator = {{ method = "bathe", step = 1e-5, newton_tolerance = 1e-9 }}
output = {{ interval = 1e-4, channels = ["*"] }}
materials.soft = {{ density = 1000.0, youngs_modulus = 1e6 }}
sections.bar = {{ width = 0.1, height = 0.1 }}
bodies.ground = {{ type = "ground", points.O = [0.0, 0.0] }}
bodies.rod = {{ type = "link", model = "flexible", elements = 1, length = 1.0, section = "bar", material = "soft" }}
joints.O = {{ type = "revolute", bearing = "ground.O", journal = "rod.start", model = "ideal" }}
initial.bodies.rod = {{ point = "start", x = 0.0, y = 0.0, theta = 0.0, strain = {:?} }}
"#,
            -0.2 * part
        ))
    });
    let mut wrong = Vec::new();
    for (words, scenes) in [
        ("the energy of the motion", lost),
        ("the dissipated energy", dissipated),
        ("do not resolve a vibration", unresolved),
        ("the largest range of motion", erring),
        ("the theory of slender elastic links", strained),
    ] {
        for (scene, told) in scenes.iter().zip([false, true]) {
            let warnings = run_scene(scene).1.warnings();
            if warnings.iter().any(|w| w.contains(words)) != told {
                wrong.push((words, told, warnings));
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

/// Accelerations that change by more than their size from step to step are told of a coordinate from a tenth of the largest
/// acceleration on, and where its changes move it by more than a billionth of the largest range of motion.
///
/// Velocity Verlet with five steps a period changes the acceleration of an oscillator by theta = omega h = 2 sin(pi/5) of its size, and
/// moves it by at most theta^3 sin(3 pi/5) of its amplitude.
#[test]
fn an_unresolved_vibration_is_told_from_a_tenth_of_the_largest_acceleration_on() {
    const STEP: f64 = 0.1;
    const DURATION: f64 = 126.0 * STEP;
    let theta = 2.0 * (0.2 * PI).sin();
    let fast = |displacement: f64| Oscillator {
        mass: 1.0,
        stiffness: (theta / STEP).powi(2),
        displacement,
        ..Oscillator::default()
    };
    let free = Oscillator {
        mass: 1.0,
        velocity: 1.0,
        ..Oscillator::default()
    };
    let of_acceleration = 0.1 * (STEP / theta).powi(2);
    let of_travel = 1e-9 * DURATION / (theta.powi(3) * (0.6 * PI).sin());
    for (other, threshold) in [(UNIT, of_acceleration), (free, of_travel)] {
        for (part, told) in [(0.96, false), (1.04, true)] {
            let pair = [other, fast(part * threshold)];
            let method = format!("method = \"velocity_verlet\", step = {STEP}");
            let (_, report) = run_scene(&oscillators(&pair, &method, STEP, DURATION));
            let warnings = report.warnings();
            let found = warnings.iter().any(|w| w.contains("do not resolve"));
            assert_eq!(found, told, "{part} of {threshold:e} m: {warnings:?}");
        }
    }
}

/// A run is stopped where the integrator has gained ten times the energy supplied, here that of the start, and not before. Velocity
/// Verlet just beyond its limit of stability gains a seventh with each step.
#[test]
fn a_run_is_stopped_at_ten_times_the_energy_supplied() {
    let method = "method = \"velocity_verlet\", step = 2.001";
    let mut simulation = Simulation::new(&oscillators(&[UNIT], method, 2.001, 1e3)).unwrap();
    let mut recording = Recording::new(&simulation);
    let ended = simulation.run(&mut recording);
    let Err(RunError::Unstable { gained, .. }) = ended else {
        panic!("{ended:?}");
    };
    let lost = recording.get("energy.numerical").unwrap();
    let before = -lost[lost.len() - 1];
    let supplied = 0.5;
    assert!(
        before < 10.0 * supplied && 10.0 * supplied < gained,
        "{before} {gained}"
    );
    assert!(gained < 1.15 * before, "{before} {gained}");
}

/// The backward Euler rule takes the part (omega h)^2 of the energy of an oscillator in every step.
fn damped(
    energy: f64,
    horizon: f64,
    more: &[Oscillator],
    [interval, duration]: [f64; 2],
) -> Report {
    let method = format!(
        "method = \"backward_euler\", newton_tolerance = 1e-12, accuracy = {{ position = 1e9, energy = {energy:e}, horizon = {horizon:e} }}"
    );
    let masses = [&[UNIT], more].concat();
    run_scene(&oscillators(&masses, &method, interval, duration)).1
}

/// A step may change the energy by its part of the horizon, and by 1e-5 of what the horizon may at least. Steps aim at a third of it.
/// The energy is 1/2 J; of the accuracies that make steps of 0.01 s, one is for steps of a tenth of the horizon and one for steps of 1e-6.
#[test]
fn a_step_may_change_the_energy_by_its_share() {
    const STEP: f64 = 0.01;
    let change = 0.5 * STEP * STEP;
    for (horizon, share) in [(0.1, 10.0 * STEP), (1e4, 1e-5)] {
        // the second of two seconds: the first steps find their length
        let [one, two] = [1.0, 2.0]
            .map(|duration| damped(3.0 * change / share, horizon, &[], [0.25, duration]).steps);
        let steps = (two - one) as f64 * STEP;
        // rows cut steps, and the oscillator loses 2 % of its energy
        assert!(
            (0.9..1.1).contains(&steps),
            "{steps} of 100 steps, {horizon} s"
        );
    }
}

/// Changes of the energy below 32 roundings of its terms do not count: with a free mass whose energy makes 32 roundings less than the
/// change in a step, steps are rejected.
#[test]
fn changes_of_the_energy_count_from_their_rounding_on() {
    const STEP: f64 = 0.01;
    let change = 0.5 * STEP * STEP;
    for (part, counts) in [(0.7, true), (1.4, false)] {
        let free = Oscillator {
            mass: 2.0 * part * change / (32.0 * f64::EPSILON),
            velocity: 1.0,
            ..Oscillator::default()
        };
        let control = damped(1e-30, 1.0, &[free], [STEP, 0.1]).accuracy.unwrap();
        assert_eq!(
            control.rejected_by.contains_key("the energy balance"),
            counts,
            "{control:?}"
        );
    }
}

/// Steps that contacts last, and the report when so many of them have ended.
#[derive(Default)]
struct ContactWatch {
    since_onset: u64,
    lasted: Vec<u64>,
    most: usize,
}

impl Observer for ContactWatch {
    fn row(&mut self, _: &[f64]) -> Result<()> {
        Ok(())
    }

    fn onset(&mut self, _: &Onset) -> Result<()> {
        self.since_onset = 0;
        Ok(())
    }

    fn contact(&mut self, contact: &ContactEvent) -> Result<()> {
        if contact.end.is_some() {
            self.lasted.push(self.since_onset);
        }
        Ok(())
    }

    // called after the step that ends with the onset, and after all others
    fn step(&mut self, _: &Progress) -> Result<Control> {
        self.since_onset += 1;
        Ok(match self.lasted.len() >= self.most {
            true => Control::Stop,
            false => Control::Continue,
        })
    }
}

/// Contacts of three steps are brief, those of four are not.
#[test]
fn contacts_are_brief_below_four_steps() {
    let mut all = Vec::new();
    for step in ["2.5e-5", "3.2e-5", "4e-5", "5e-5"] {
        let settings = [
            &format!("integrator.step={step}"),
            &format!("output.interval={step}"),
        ];
        let scene = load("bouncing-journal.toml", &settings.map(|s| s.as_str()));
        let mut simulation = Simulation::new(&scene).unwrap();
        let mut watch = ContactWatch {
            most: usize::MAX,
            ..ContactWatch::default()
        };
        simulation.run(&mut watch).unwrap();
        let report = simulation.report();
        let brief = watch.lasted.iter().filter(|steps| **steps < 4).count();
        assert_eq!(report.brief_contacts, brief as u64, "{:?}", watch.lasted);
        let warned = report
            .warnings()
            .iter()
            .any(|w| w.contains("fewer than four steps"));
        assert_eq!(warned, brief > 0);
        all.extend(watch.lasted);
    }
    assert!(all.contains(&3) && all.contains(&4), "{all:?}");
}

/// Ten brief contacts in succession are chatter, nine are not.
#[test]
fn ten_brief_contacts_are_chatter() {
    let scene = load("hard/chatter.toml", &["integrator.step=1e-4"]);
    let chatter_after = |most: usize| {
        let mut simulation = Simulation::new(&scene).unwrap();
        let mut watch = ContactWatch {
            most,
            ..ContactWatch::default()
        };
        let _ = simulation.run(&mut watch);
        (simulation.report().chatter, watch.lasted)
    };
    let first = (10..20)
        .map(chatter_after)
        .find(|(chatter, _)| !chatter.is_empty());
    let (chatter, lasted) = first.unwrap();
    assert_eq!(chatter[0].onsets, 10);
    let in_succession = lasted.iter().rev().take_while(|steps| **steps < 4);
    assert!(in_succession.count() >= 10, "{lasted:?}");
}

/// A journal is too deep in its bearing from a tenth of its radius on, or from the clearance on where that is more. A mass m with the speed v is stopped by a contact of K delta^1.5 at
/// delta = (5 m v^2/(4 K))^(2/5).
#[test]
fn a_journal_is_too_deep_from_a_tenth_of_the_radius_and_the_clearance_on() {
    const RADIUS: f64 = 0.01;
    for (clearance, part, beyond) in [
        (2e-5, 0.098, false),
        (2e-5, 0.102, true),
        (2e-3, 0.198, false),
        (2e-3, 0.202, true),
    ] {
        let stiffness = 1.25 * 0.05 / (part * RADIUS).powf(2.5);
        let changes = [
            format!("contacts.aluminium={{ law = \"lankarani_nikravesh\", bearing_radius = {RADIUS}, clearance = {clearance:e}, stiffness = {stiffness:e}, exponent = 1.5, restitution = 1.0, impact_velocity_floor = 1e-6 }}"),
            "initial.bodies.journal={ x = 0.0, y = 0.0, theta = 0.0, vx = 1.0, vy = 0.0, omega = 0.0 }".to_owned(),
            "integrator.step=1e-4".to_owned(),
            "output.interval=1e-4".to_owned(),
        ];
        let (_, report) = run_scene(&load(
            "bouncing-journal.toml",
            &changes.each_ref().map(String::as_str),
        ));
        assert_eq!(!report.overrun.is_empty(), beyond, "{:?}", report.impacts);
        let warned = report
            .warnings()
            .iter()
            .any(|w| w.contains("deep into a bearing"));
        assert_eq!(warned, beyond);
    }
}

/// The accuracy that is used: what was asked for, up to a part of the clearance of 2e-5 m.
#[test]
fn an_accuracy_is_used_up_to_a_part_of_the_clearance() {
    for (method, part) in [
        ("\"dormand_prince\"", 0.01),
        ("\"bathe\", newton_tolerance = 1e-10", 0.5),
    ] {
        let largest = part * 2e-5;
        for asked in [0.98 * largest, 1.02 * largest] {
            let change = format!(
                "integrator={{ method = {method}, onset_tolerance = 1e-12, accuracy = {{ position = {asked:e}, horizon = 0.01 }} }}"
            );
            let scene = load(
                "bouncing-journal.toml",
                &[&change, "simulation.duration=1e-4"],
            );
            let used = run_scene(&scene).1.accuracy.unwrap().followed;
            assert_eq!(used, f64::min(asked, largest), "{method}");
        }
    }
}

/// Coordinates and velocities at the rows.
#[derive(Default)]
struct StateRows(Vec<[Vec<f64>; 2]>);

impl Observer for StateRows {
    fn row(&mut self, _: &[f64]) -> Result<()> {
        Ok(())
    }

    fn state(&mut self, _: &Model, at: &State) -> Result<()> {
        self.0.push([at.q.clone(), at.v.clone()]);
        Ok(())
    }

    fn step(&mut self, _: &Progress) -> Result<Control> {
        Ok(Control::Continue)
    }
}

/// What has an error: a name, the scene without its integrator, the unknowns, whether their values are coordinates (0) or velocities (1),
/// and the distance of a unit of them \[m\].
struct Scaled {
    name: &'static str,
    scene: &'static str,
    unknowns: std::ops::Range<usize>,
    level: usize,
    length: f64,
}

const HEAD: &str = "format = 1\ntitle = \"one kind of unknown\"\nsimulation = { duration = 0.5, gravity = [0.0, -10.0] }\noutput = { interval = 0.0625, channels = [\"t\"] }\n";

const SCALED: [Scaled; 7] = [
    Scaled {
        name: "x and y of a point mass",
        scene: r#"
bodies.ground = { type = "ground", points.top = [0.0, 0.0] }
bodies.bob = { type = "point_mass", mass = 1.0 }
forces.spring = { type = "spring_damper", from = "ground.top", to = "bob.center", stiffness = 1600.0, damping = 0.0, rest_length = 1.0 }
initial.bodies.bob = { x = 0.6, y = -0.7 }
"#,
        unknowns: 0..2,
        level: 0,
        length: 1.0,
    },
    // the distance of its farthest point, and its radius of gyration
    Scaled {
        name: "the angle of a body in a joint, with a point far away",
        scene: r#"
bodies.ground = { type = "ground", points.pin = [0.0, 0.0] }
bodies.rod = { type = "rigid_body", mass = 1.0, inertia = 1e-4, points.hole = [0.0, 0.0], points.tip = [3.0, 4.0] }
joints.pin = { type = "revolute", bearing = "ground.pin", journal = "rod.hole", model = "ideal" }
forces.coil = { type = "torsion_spring", joint = "pin", stiffness = 0.16, damping = 0.0, rest_angle = 0.0 }
initial.bodies.rod = { x = 0.0, y = 0.0, theta = 0.4 }
"#,
        unknowns: 0..1,
        level: 0,
        length: 5.0,
    },
    Scaled {
        name: "the angle of a body in a joint, with a large radius of gyration",
        scene: r#"
bodies.ground = { type = "ground", points.pin = [0.0, 0.0] }
bodies.rod = { type = "rigid_body", mass = 1.0, inertia = 4.0, points.hole = [0.0, 0.0] }
joints.pin = { type = "revolute", bearing = "ground.pin", journal = "rod.hole", model = "ideal" }
forces.coil = { type = "torsion_spring", joint = "pin", stiffness = 6400.0, damping = 0.0, rest_angle = 0.0 }
initial.bodies.rod = { x = 0.0, y = 0.0, theta = 0.4 }
"#,
        unknowns: 0..1,
        level: 0,
        length: 2.0,
    },
    Scaled {
        name: "the angle of a body among x and y",
        scene: r#"
bodies.ground = { type = "ground", points.pin = [0.0, 0.0] }
bodies.rod = { type = "rigid_body", mass = 1.0, inertia = 1e-4, coordinates = "center", points.hole = [0.0, 0.0], points.tip = [3.0, 4.0] }
joints.pin = { type = "revolute", bearing = "ground.pin", journal = "rod.hole", model = "ideal" }
forces.coil = { type = "torsion_spring", joint = "pin", stiffness = 0.16, damping = 0.0, rest_angle = 0.0 }
initial.bodies.rod = { x = 0.0, y = 0.0, theta = 0.4 }
"#,
        unknowns: 2..3,
        level: 0,
        length: 5.0,
    },
    Scaled {
        name: "the angle of a rigid link",
        scene: r#"
materials.steel = { density = 1000.0, youngs_modulus = 2e11 }
sections.bar = { width = 0.01, height = 0.1 }
bodies.ground = { type = "ground", points.a = [-5.0, -100.0], points.b = [5.0, -100.0], points.c = [-5.0, 100.0], points.d = [5.0, 100.0] }
bodies.rod = { type = "link", model = "rigid", length = 10.0, section = "bar", material = "steel", coordinates = "center" }
forces.one = { type = "spring_damper", from = "ground.a", to = "rod.start", stiffness = 2500.0, damping = 0.0, rest_length = 100.0 }
forces.two = { type = "spring_damper", from = "ground.d", to = "rod.end", stiffness = 2500.0, damping = 0.0, rest_length = 100.0 }
initial.bodies.rod = { x = 0.0, y = 0.0, theta = 0.1 }
"#,
        unknowns: 2..3,
        level: 0,
        length: 5.0,
    },
    // a unit of slope moves a point by 4/27 of the element at most
    Scaled {
        name: "slopes of a flexible link",
        scene: r#"
materials.soft = { density = 1000.0, youngs_modulus = 1e7 }
sections.bar = { width = 0.1, height = 0.1 }
bodies.ground = { type = "ground", points.a = [0.0, 0.0], points.b = [2.0, 0.0] }
bodies.rod = { type = "link", model = "flexible", elements = 1, length = 2.0, section = "bar", material = "soft" }
joints.a = { type = "revolute", bearing = "ground.a", journal = "rod.start", model = "ideal" }
joints.b = { type = "revolute", bearing = "ground.b", journal = "rod.end", model = "ideal" }
initial.bodies.rod = { x = 1.0, y = 0.0, theta = 0.0 }
"#,
        unknowns: 0..4,
        level: 0,
        length: 2.0 * 4.0 / 27.0,
    },
    // the velocity of its unknown
    Scaled {
        name: "the elongation of a Maxwell element",
        scene: r#"
bodies.ground = { type = "ground", points.wall = [0.0, 0.0] }
bodies.block = { type = "moving", path = { type = "coordinates", x = { type = "harmonic", mean = 1.0, amplitude = 0.3, frequency = 4.0, phase = 0.0 }, y = 0.0, theta = 0.0 }, points.hook = [0.0, 0.0] }
bodies.bob = { type = "point_mass", mass = 1.0 }
forces.element = { type = "maxwell", from = "ground.wall", to = "block.hook", stiffness = 200.0, damping = 10.0, rest_length = 0.8 }
initial.bodies.bob = { x = 0.0, y = 0.0 }
"#,
        unknowns: 2..3,
        level: 1,
        length: 1.0,
    },
];

/// The error of every kind of unknown, as the distance by which it moves a point of its body, is what was asked for, and not far less.
#[test]
fn errors_of_all_kinds_of_unknowns_are_those_asked_for() {
    const POSITION: f64 = 1e-5;
    let [most, least] = [Worst::new(), Worst::new()];
    for Scaled {
        name,
        scene,
        unknowns,
        level,
        length,
    } in SCALED
    {
        let rows = |position: f64, method: &str| {
            let pace = format!(
                "integrator = {{ method = \"{method}\", accuracy = {{ position = {position:e} }} }}\n"
            );
            let scene = parse(&format!("{HEAD}{pace}{scene}"));
            let mut simulation = Simulation::new(&scene).unwrap_or_else(|e| panic!("{name}: {e}"));
            let mut rows = StateRows::default();
            simulation
                .run(&mut rows)
                .unwrap_or_else(|e| panic!("{name}: {e}"));
            rows.0
        };
        let exact = rows(1e-4 * POSITION, "dop853");
        let found = rows(POSITION, "dormand_prince");
        let pairs = exact.iter().zip(&found);
        let errors = pairs.flat_map(|(exact, found)| {
            let unknowns = unknowns.clone();
            unknowns.map(|i| length * (exact[level][i] - found[level][i]).abs())
        });
        let error = errors.fold(0.0, f64::max);
        for (worst, ratio) in [(&most, error / POSITION), (&least, POSITION / error)] {
            worst.at(format!("for {name}"));
            worst.see(ratio);
        }
    }
    Rung::OrderInTime
        .asks("Positions, angles, slopes and internal states, each alone: achieved error over requested accuracy")
        .within(&most, 3.0, "no run may miss the requested accuracy more than threefold");
    Rung::OrderInTime
        .asks("Positions, angles, slopes and internal states, each alone: requested accuracy over achieved error")
        .within(&least, 20.0, "steps aim at a third of the accuracy, which errors of one sign alone reach");
}

//! An absent effect costs nothing: a scene with an effect taken out is the scene that never had it, to the last byte.

use crate::support::{load, run_scene};
use ladder::{Rung, Worst};
use looselink::scene::{Scene, SceneError};
use looselink::simulate::Simulation;
use looselink::system::System;
use studies::ablation::{Observed, Origin, SceneEffect, VariantRole, ablate, effects, variants};

/// What the scenes of a pair are brought to, so that they differ in the effect alone; long enough for impacts.
const LIKE: [&str; 4] = [
    "simulation.duration=0.02",
    "integrator.step=1e-5",
    "output.interval=2e-4",
    r#"output.channels=["*"]"#,
];

/// A scene, the effects that are taken out, the scene that was written without them.
type AblationPair = (&'static str, &'static [SceneEffect], &'static str);

const PAIRS: [AblationPair; 9] = [
    (
        "3rrr/case4-friction.toml",
        &[SceneEffect::Friction],
        "3rrr/case4.toml",
    ),
    (
        "3rrr/case4.toml",
        &[SceneEffect::Clearance],
        "3rrr/case2.toml",
    ),
    (
        "3rrr/case4.toml",
        &[SceneEffect::Flexibility],
        "3rrr/case3.toml",
    ),
    (
        "3rrr/case4.toml",
        &[SceneEffect::Flexibility, SceneEffect::Clearance],
        "3rrr/case1.toml",
    ),
    (
        "3rrr/case4-friction.toml",
        &[SceneEffect::Clearance, SceneEffect::Flexibility],
        "3rrr/case1.toml",
    ),
    (
        "3rrr/case4-4elements.toml",
        &[SceneEffect::Elements],
        "3rrr/case4.toml",
    ),
    (
        "ablation/everything.toml",
        &[SceneEffect::Gravity],
        "ablation/without-gravity.toml",
    ),
    (
        "ablation/everything.toml",
        &[SceneEffect::StructuralDamping],
        "ablation/without-structural-damping.toml",
    ),
    (
        "ablation/everything.toml",
        &[SceneEffect::ContactDamping],
        "ablation/without-contact-damping.toml",
    ),
];

fn without(scene: &Scene, removed: &[SceneEffect]) -> Scene {
    removed.iter().fold(scene.clone(), |scene, effect| {
        assert!(effect.is_in(&scene), "{} is there", effect.name());
        let scene = effect.removed_from(&scene);
        let scene = scene.unwrap_or_else(|e| panic!("{}: {e}", effect.name()));
        assert!(!effect.is_in(&scene), "{} is gone", effect.name());
        scene
    })
}

fn simulation(scene: &Scene) -> Simulation {
    Simulation::new(scene).unwrap_or_else(|e| panic!("{e}"))
}

/// The compiled model in full: every list, every number to the last digit.
fn written(scene: &Scene) -> String {
    format!("{:?}", simulation(scene).model())
}

#[test]
fn a_removed_effect_leaves_the_model_of_a_scene_that_never_had_it() {
    for (full, removed, never) in PAIRS {
        let (full, never) = (load(full, &LIKE), load(never, &LIKE));
        let ablated = without(&full, removed);
        let [a, b] = [&ablated, &never].map(simulation);
        let (a, b) = (a.model(), b.model());
        assert_eq!(a.shape(), b.shape(), "{}", never.title);
        assert_eq!(a.effects(), b.effects(), "{}", never.title);
        assert_eq!(a.unknown_names(), b.unknown_names(), "{}", never.title);
        assert_eq!(
            format!("{:?}", a.symbolic()),
            format!("{:?}", b.symbolic()),
            "{}: pattern and pivot order",
            never.title
        );
        // not by assert_eq: the text is long
        assert!(written(&ablated) == written(&never), "{}", never.title);
        assert!(
            written(&full) != written(&never),
            "{}: the comparison sees the effect",
            never.title
        );
    }
}

#[test]
fn a_removed_effect_leaves_the_run_of_a_scene_that_never_had_it() {
    let worst = Worst::new();
    for (full, removed, never) in PAIRS {
        let never = load(never, &LIKE);
        let (a, report) = run_scene(&without(&load(full, &LIKE), removed));
        let (b, other) = run_scene(&never);
        worst.at(format!("in {}", never.title));
        assert_eq!(a.names(), b.names(), "{}", never.title);
        assert_eq!(
            report.effects, other.effects,
            "{}: evaluations",
            never.title
        );
        assert_eq!(report, other, "{}", never.title);
        assert_eq!(a.onsets, b.onsets, "{}", never.title);
        for name in a.names() {
            let bits = |values: Vec<f64>| values.into_iter().map(f64::to_bits).collect::<Vec<_>>();
            let (a, b) = (bits(a.get(name)), bits(b.get(name)));
            assert_eq!(a.len(), b.len());
            let different = a.iter().zip(&b).filter(|(a, b)| a != b).count();
            worst.see(different as f64);
        }
    }
    Rung::Routes
        .asks("Scene with an effect removed against a scene written without it, nine pairs: recorded numbers whose bits differ, per channel")
        .within(
            &worst,
            0.0,
            "an absent effect adds nothing to the model: the same arithmetic in the same order",
        );
}

/// Removing what stands on an effect goes with it: no order of removals leaves anything behind.
#[test]
fn the_rigid_ideal_mechanism_has_none_of_the_terms() {
    let scene = load("ablation/everything.toml", &LIKE);
    let all = variants(&scene);
    let ideal = all[0].scene.as_ref().unwrap();
    assert_eq!(effects(ideal), []);
    let model = simulation(ideal);
    let names: Vec<&str> = model.model().effects().to_vec();
    assert_eq!(names, ["length_constraint"]);
    assert_eq!(model.model().shape().contacts, 0);
}

#[test]
fn every_effect_is_added_and_removed_with_what_it_needs() {
    let scene = load("ablation/everything.toml", &[]);
    assert_eq!(effects(&scene), SceneEffect::ALL);
    let names: Vec<String> = variants(&scene).iter().map(|v| v.name()).collect();
    assert_eq!(
        names,
        [
            "rigid ideal mechanism",
            "+ flexibility",
            "+ more elements (on flexibility)",
            "+ structural damping (on flexibility)",
            "+ clearance",
            "+ contact damping (on clearance)",
            "+ friction (on clearance)",
            "+ gravity",
            "full scene",
            "− flexibility (and more elements, structural damping)",
            "− more elements",
            "− structural damping",
            "− clearance (and contact damping, friction)",
            "− contact damping",
            "− friction",
            "− gravity",
        ]
    );
    for variant in variants(&scene) {
        let built = variant.scene.as_ref().unwrap();
        assert_eq!(effects(built), variant.effects, "{}", variant.name());
        let both = [&variant.effects[..], &variant.removed].concat();
        assert_eq!(both.len(), SceneEffect::ALL.len(), "{}", variant.name());
        simulation(built);
    }
    // only what is there is listed
    let scene = load("3rrr/case2.toml", &[]);
    let roles: Vec<VariantRole> = variants(&scene).iter().map(|v| v.role).collect();
    assert_eq!(
        roles,
        [
            VariantRole::Ideal,
            VariantRole::Added(SceneEffect::Flexibility),
            VariantRole::Full,
            VariantRole::Removed(SceneEffect::Flexibility)
        ]
    );
}

/// A bob that hangs from the middle of a link of two elements: one element does not have that node.
const HANGING: &str = r#"
format = 1
title = "a bob in the middle"
simulation = { duration = 2e-4, gravity = [0.0, -9.81] }
integrator = { method = "bathe", step = 1e-5, newton_tolerance = 1e-11 }
output = { interval = 1e-5, channels = ["bob.x"] }
materials.steel = { density = 7800.0, youngs_modulus = 2e9 }
sections.bar = { width = 0.004, height = 0.01 }
bodies.ground = { type = "ground", points.O = [0.0, 0.0] }
bodies.rod = { type = "link", model = "flexible", elements = 2, length = 0.2, section = "bar", material = "steel", points.middle = 0.1 }
bodies.bob = { type = "rigid_body", mass = 0.4, inertia = 1e-3, points.top = [0.0, 0.05] }
joints.O = { type = "revolute", bearing = "ground.O", journal = "rod.start", model = "ideal" }
joints.P = { type = "revolute", bearing = "rod.middle", journal = "bob.top", model = "ideal" }
[initial.bodies]
rod = { x = 0.1, y = 0.0, theta = 0.0, vx = 0.0, vy = 0.0, omega = 0.0 }
bob = { x = 0.1, y = -0.05, theta = 0.0, vx = 0.0, vy = 0.0, omega = 0.0 }
"#;

#[test]
fn a_variant_that_cannot_be_built_is_told_by_name() {
    let scene = Scene::parse("hanging", HANGING, &[]).unwrap_or_else(|e| panic!("{e}"));
    let error = |effect: SceneEffect| -> SceneError { effect.removed_from(&scene).unwrap_err() };
    let elements = error(SceneEffect::Elements);
    assert_eq!(
        elements.to_string(),
        "joint P uses the inner node rod.middle, but one element has none"
    );
    assert!(elements.underlined().contains("rod.middle"));

    let body = Observed::choose(&scene, None).unwrap();
    assert_eq!(
        (body.name.as_str(), body.error_from),
        ("bob", Origin::Ideal)
    );
    let ablation = ablate(&scene, body, Some(1), &mut |_| {});
    let text = ablation.text();
    let mut lines = text.lines().filter(|l| l.starts_with("  − more elements"));
    let reported = lines.next().unwrap();
    assert!(
        reported.contains(" not possible: joint P uses"),
        "{reported}"
    );
    // a rigid link has the point, so there is a path to compare with: both fall, by g t^2/2 in 0.2 ms at most
    let full = ablation.outcome(VariantRole::Full).unwrap();
    let error = full.physics.rms_error.unwrap();
    assert!(error > 0.0 && error < 2e-7, "{error}");
    assert!(full.physics.peak_acceleration.unwrap() > 1.0);
    assert!(ablation.outcome(VariantRole::Ideal).is_some());
    let gravity = ablation
        .outcome(VariantRole::Removed(SceneEffect::Gravity))
        .unwrap();
    // nothing moves: rounding
    assert!(gravity.physics.peak_acceleration.unwrap() < 1e-9);

    // an inner point that nothing uses goes without a word
    let free = HANGING
        .replace("rod.middle", "rod.end")
        .replace("x = 0.1,", "x = 0.2,");
    let scene = Scene::parse("free", &free, &[]).unwrap_or_else(|e| panic!("{e}"));
    assert!(SceneEffect::Elements.removed_from(&scene).is_ok());
    assert!(SceneEffect::Flexibility.removed_from(&scene).is_ok());
}

#[test]
fn what_is_measured_is_what_a_run_records() {
    let overrides = [
        "simulation.duration=0.01",
        "output.interval=1e-4",
        r#"output.channels=["*"]"#,
    ];
    let scene = load(
        "3rrr/case4.toml",
        &[&overrides[..], &["integrator.step=1e-5"]].concat(),
    );
    let body = Observed::choose(&scene, None).unwrap();
    assert_eq!(
        (body.name.as_str(), body.error_from),
        ("platform", Origin::Prescribed)
    );
    let ablation = ablate(&scene, body, Some(2), &mut |_| {});
    let full = ablation.outcome(VariantRole::Full).unwrap();
    let (run, report) = run_scene(&scene);
    let [x, y, ax, ay] = ["error.x", "error.y", "platform.ax", "platform.ay"].map(|c| run.get(c));
    let lengths = |x: &[f64], y: &[f64]| {
        x.iter()
            .zip(y)
            .map(|(x, y)| x.hypot(*y))
            .collect::<Vec<_>>()
    };
    let rms = |v: &[f64]| (v.iter().map(|v| v * v).sum::<f64>() / v.len() as f64).sqrt();
    let peak = |v: &[f64]| v.iter().copied().fold(0.0, f64::max);
    // rows miss peaks of the loose joints, which every contact keeps
    let force = |joint: &str| {
        let rows = run.get(&format!("{joint}.force"));
        let contacts = run.onsets.iter().filter(|c| c.joint == joint);
        contacts
            .map(|c| c.largest_force)
            .fold(peak(&rows), f64::max)
    };
    let contact = |joint: &str| {
        let column = run.get(&format!("{joint}.contact"));
        column.iter().sum::<f64>() / column.len() as f64
    };
    let loose = ["B1", "B2", "B3", "C1", "C2", "C3"];
    let expected = [
        rms(&lengths(&x, &y)),
        peak(&lengths(&x, &y)),
        rms(&lengths(&ax, &ay)),
        peak(&lengths(&ax, &ay)),
        force(full.peak_joint.as_ref().unwrap()),
        loose.iter().map(|j| contact(j)).sum::<f64>() / 6.0,
    ];
    for (measured, expected) in full.physics.values().into_iter().zip(expected) {
        // sums of a hundred numbers, perhaps in another order
        approx::assert_relative_eq!(measured.unwrap(), expected, max_relative = 1e-14);
    }
    let others = ["A1", "A2", "A3"].iter().chain(&loose);
    assert!(
        others
            .map(|j| force(j))
            .all(|f| f <= full.physics.peak_joint_force.unwrap())
    );
    assert_eq!(full.counts.steps, report.steps);
    assert_eq!(full.counts.evaluations, report.effects);
    assert_eq!(full.cost.runs, 2);
    let product = full.cost.real_time_factor * full.cost.cpu_seconds_a_simulated_second;
    approx::assert_relative_eq!(product, 1.0, max_relative = 1e-14);
    // the same mechanism by two ways is measured once
    let [added, removed] = [
        VariantRole::Added(SceneEffect::Flexibility),
        VariantRole::Removed(SceneEffect::Clearance),
    ];
    assert_eq!(ablation.outcome(added), ablation.outcome(removed));
}

#[test]
fn the_body_may_be_chosen() {
    let scene = load("3rrr/case4.toml", &[]);
    let crank = Observed::choose(&scene, Some("crank2")).unwrap();
    assert_eq!(
        (crank.name.as_str(), crank.error_from),
        ("crank2", Origin::Ideal)
    );
    let error = Observed::choose(&scene, Some("ground")).unwrap_err();
    assert!(
        error
            .to_string()
            .starts_with("no body that moves is called `ground`; there are crank1, ")
    );
    let scene = load("ablation/everything.toml", &[]);
    assert_eq!(Observed::choose(&scene, None).unwrap().name, "rocker");
    let scene = load("three-spring.toml", &[]);
    assert_eq!(Observed::choose(&scene, None).unwrap().name, "node3");
}

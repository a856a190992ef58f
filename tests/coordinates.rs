//! Coordinates of rigid bodies: which ones a scene gets, and that the motion is the same in all of them.

use crate::support::{NATURAL, load, run};
use ladder::{Rung, Worst};
use looselink::simulate::Simulation;
use std::collections::BTreeMap;

const CENTRED: [&str; 3] = [
    "bodies.link1.coordinates=\"center\"",
    "bodies.link2.coordinates=\"center\"",
    "bodies.link3.coordinates=\"center\"",
];

/// Numbers of unknowns and multipliers.
fn size(scene: &str, overrides: &[&str]) -> [usize; 2] {
    let simulation = Simulation::new(&load(scene, overrides)).unwrap();
    let shape = simulation.model().shape();
    [shape.unknowns, shape.multipliers]
}

#[test]
fn links_that_share_no_node_have_the_coordinates_of_their_centres() {
    assert_eq!(size("3rrr/case3.toml", &[]), [12, 0]);
    assert_eq!(size("3rrr/case3.toml", &NATURAL), [15, 3]);
    // B1 makes the start of link1 the end of the driven crank
    let ideal = "joints.B1={type=\"revolute\",bearing=\"crank1.end\",journal=\"link1.start\",model=\"ideal\"}";
    assert_eq!(size("3rrr/case3.toml", &[ideal]), [10, 0]);
    let natural = NATURAL[0];
    assert_eq!(size("3rrr/case3.toml", &[ideal, natural]), [11, 1]);
    // C1 is at a corner of the platform: two rows keep the end of link1 there
    let ideal = "joints.C1={type=\"revolute\",bearing=\"platform.C1\",journal=\"link1.end\",model=\"ideal\"}";
    assert_eq!(size("3rrr/case3.toml", &[ideal]), [12, 2]);
    assert_eq!(size("3rrr/case1.toml", &[]), [6, 6]);
    assert_eq!(size("3rrr/case1.toml", &NATURAL), [9, 9]);
    // the cranks are driven
    let simulation = Simulation::new(&load("3rrr/case3.toml", &NATURAL[2..])).unwrap();
    let notes = simulation.inspect().assumptions;
    let expected = [
        "rigid links with x, y of their centres of mass and theta: link1, link2",
        "rigid links with natural coordinates, x, y of their ends: link3",
    ];
    assert!(notes.ends_with(&expected.map(str::to_owned)), "{notes:?}");
}

#[test]
fn a_body_that_one_joint_holds_has_the_coordinate_of_this_joint() {
    const CENTER: &str = "bodies.rod.coordinates='center'";
    assert_eq!(size("pendulum.toml", &[]), [1, 0]);
    assert_eq!(size("pendulum.toml", &[CENTER]), [3, 2]);
    let loose = |overrides: &[&str]| size("slider-crank/loose.toml", overrides);
    assert_eq!(loose(&[]), [2, 0]);
    let slider = "bodies.slider.coordinates='center'";
    assert_eq!(loose(&[CENTER]), [4, 2]);
    assert_eq!(loose(&[CENTER, slider]), [6, 4]);
    // a guide that is not along an axis, and one on which the slider turns
    assert_eq!(loose(&["joints.guide.direction=[1.0, 1e-30]"]), [4, 2]);
    let free = ["joints.guide.rotation='free'"];
    assert_eq!(size("slider-crank/ideal.toml", &free), [4, 3]);
    let simulation = Simulation::new(&load("slider-crank/loose.toml", &[])).unwrap();
    let notes = simulation.inspect().assumptions;
    let note = "rigid bodies with the one coordinate that their joint leaves: rod, slider";
    assert!(notes.contains(&note.to_owned()), "{notes:?}");
}

/// Positions, forces of joints, torques of drives and energies. A position that is wrong by 1e-10 m is wrong by 1e-8 of the smallest
/// mechanism, which is 1 cm long, and so are its accelerations and forces; both runs may be wrong.
#[test]
fn all_channels_are_those_of_other_coordinates() {
    let worst = Worst::new();
    for (name, bodies, duration) in [
        ("pendulum.toml", &["rod"][..], 1.0),
        ("quick-return.toml", &["lever", "ram"], 0.5),
        ("harmonic-slider.toml", &["rod", "slider"], 0.2),
        ("slider-crank/ideal.toml", &["rod", "slider"], 0.012),
        ("slider-crank/free-slider.toml", &["crank"], 0.1),
        ("slider-crank/flexible.toml", &["slider"], 0.003),
        ("andrews-squeezer.toml", &["K1", "K3", "K5", "K7"], 0.02),
    ] {
        let settings = [
            "integrator={method='esdirk5',newton_tolerance=1e-12,accuracy={position=1e-10,horizon=0.5}}"
                .to_owned(),
            "assumptions={}".to_owned(),
            "output.channels=['*']".to_owned(),
            format!("simulation.duration={duration}"),
        ];
        let center = bodies
            .iter()
            .map(|body| format!("bodies.{body}.coordinates='center'"));
        let center: Vec<String> = settings.iter().cloned().chain(center).collect();
        let of = |set: &[String]| {
            let set: Vec<&str> = set.iter().map(String::as_str).collect();
            run(name, &set).0
        };
        let [held, center] = [of(&settings), of(&center)];
        let kind = |channel: &str| match channel.starts_with("energy.") {
            true => "energy".to_owned(),
            false => channel.rsplit('.').next().unwrap_or_default().to_owned(),
        };
        let mut sizes: BTreeMap<String, f64> = BTreeMap::new();
        for channel in held.names() {
            let values = held.get(channel);
            let largest = values.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
            let size = sizes.entry(kind(channel)).or_default();
            *size = size.max(largest);
        }
        for channel in held.names() {
            worst.at(format!("{channel} of {name}"));
            for (a, b) in held.get(channel).iter().zip(center.get(channel)) {
                worst.see((a - b) / sizes[&kind(channel)]);
            }
        }
    }
    Rung::Routes
        .asks("Seven mechanisms, in coordinates of joints and of centres: difference of all channels, over the largest of the same kind")
        .within(&worst, 2e-8, "1e-10 m, the accuracy of both, over 1 cm, the size of the smallest");
}

/// Each run may be wrong by the accuracy times the amplification of the motion: 876 over 10 ms in case 3 (GUARANTEE.md), 1
/// in the ideal mechanism, where the drives determine the motion.
#[test]
fn the_motion_does_not_depend_on_the_coordinates() {
    for (scene, accuracy, amplification, scheme) in [
        ("3rrr/case3.toml", 1e-11, 876.0, "dormand_prince"),
        ("3rrr/case1.toml", 1e-8, 1.0, "esdirk5"),
    ] {
        let integrator = format!(
            "integrator={{method={scheme:?},newton_tolerance=1e-12,onset_tolerance=1e-13,accuracy={{position={accuracy:e},horizon=0.01}}}}"
        );
        let span = [
            &*integrator,
            "assumptions={}",
            "simulation.duration=0.01",
            "output.interval=1e-3",
            "output.channels=[\"platform.x\",\"platform.y\",\"link*.x\",\"link*.y\",\"link*.theta\"]",
        ];
        let [(natural, _), (centred, _)] =
            [NATURAL, CENTRED].map(|coordinates| run(scene, &[&span[..], &coordinates].concat()));
        for name in natural.names() {
            let pairs = natural.get(name).into_iter().zip(centred.get(name));
            let apart = pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            // an angle is a difference of positions over half a link, 0.121 m
            let lever = if name.ends_with("theta") { 0.121 } else { 1.0 };
            let allowed = 2.0 * accuracy * amplification / lever;
            assert!(
                apart <= allowed,
                "{scene}, {name}: {apart:e} of {allowed:e}"
            );
        }
    }
}

//! Coordinates of rigid links: which ones a scene gets, and that the motion is the same in all of them.

use crate::support::{NATURAL, load, run};
use looselink::simulate::Simulation;

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
    assert_eq!(size("3rrr/case3.toml", &[ideal]), [11, 1]);
    // C1 is at a corner of the platform: two rows keep the end of link1 there
    let ideal = "joints.C1={type=\"revolute\",bearing=\"platform.C1\",journal=\"link1.end\",model=\"ideal\"}";
    assert_eq!(size("3rrr/case3.toml", &[ideal]), [12, 2]);
    assert_eq!(size("3rrr/case1.toml", &[]), [9, 9]);
    // the cranks are driven
    let simulation = Simulation::new(&load("3rrr/case3.toml", &NATURAL[2..])).unwrap();
    let notes = simulation.inspect().assumptions;
    let expected = [
        "rigid links with x, y of their centres of mass and theta: link1, link2",
        "rigid links with natural coordinates, x, y of their ends: link3",
    ];
    assert!(notes.ends_with(&expected.map(str::to_owned)), "{notes:?}");
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

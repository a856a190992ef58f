//! `path=value` overrides: what they change, and how they fail.

use crate::bad_input::{CASE4, check, fault};
use crate::good_input::{contact, load};
use looselink::body::{FlexibleLink, RigidLink};

#[test]
fn overrides_point_into_the_override() {
    #[rustfmt::skip]
    let cases = [
        ("integrator.step=fast", "`integrator.step` must be a number, not a string", "fast"),
        ("integrator.step=-1", "must be greater than zero, not -1", "-1"),
        ("integrator.stepp=1e-6", "unknown key `stepp` in integrator; did you mean `step`?", "stepp"),
        ("integrater.step=1e-6", "the scene has no `integrater`; did you mean `integrator`?", "integrater"),
        ("bodies.link9.elements=2", "the scene has no `bodies.link9`; did you mean `bodies.link1`?", "link9"),
        ("joints.B1.model=idea", "cannot be \"idea\"; did you mean `ideal`?", "idea"),
        ("joints.B1.model.x=1", "`joints.B1.model` is a string and has no parts", "x"),
        ("output.channels.9=a", "has the indices 0 to 6, not `9`", "9"),
        ("step", "an override needs `=`", "step"),
        ("=1", "has an empty part", ""),
        ("integrator..step=1", "has an empty part", ""),
        ("integrator.step=", "an override needs a value", ""),
        ("integrator.step=[1", "not valid TOML", "[1"),
    ];
    for (text, message, underlined) in cases {
        let error = fault(CASE4, &[text]);
        check(&error, text, message, underlined);
        assert_eq!(error.place().unwrap().0, "--set", "{text}: {error}");
    }
}

#[test]
fn overrides() {
    let scene = load(
        CASE4,
        &[
            "integrator.step=1e-6",
            " joints.B1.model = ideal ",
            "bodies.link1.elements=4",
            "bodies.link2.model=rigid",
        ],
    );
    assert_eq!(scene.integrator.step(), Some(1e-6));
    assert!(contact(&scene, "B1").is_none() && contact(&scene, "B2").is_some());
    let kind = |body: &str| &scene.bodies[scene.body(body).unwrap()].kind;
    let link: &FlexibleLink = kind("link1").get().unwrap();
    assert_eq!((link.elements, link.youngs_modulus), (4, 7e9));
    assert!(kind("link2").get::<RigidLink>().is_some());
    let scene = load(
        CASE4,
        &[
            "bodies.ground.points.A1=[0.1, 0.2]",
            "bodies.ground.points.A1.1=0.3",
        ],
    );
    assert_eq!(scene.bodies[0].kind.points()[0].at.as_slice(), [0.1, 0.3]);
    // A missing optional key is created; the last override of a key wins.
    let scene = load(
        CASE4,
        &[
            "integrator.gamma=0.3",
            "integrator.gamma=0.4",
            "simulation.gravity=[0, -9.81]",
        ],
    );
    let method = scene.integrator.method;
    assert_eq!((method.name(), method.get("gamma")), ("bathe", Some(0.4)));
    assert_eq!(scene.simulation.gravity, Some([0.0, -9.81]));
    // The value shown with an assumption is the one in force.
    let scene = load(CASE4, &["contacts.pin.restitution=0.5"]);
    assert!(
        scene
            .assumptions
            .iter()
            .any(|a| a.path == "contacts.pin.restitution" && a.value == "0.5")
    );
}

#[test]
fn the_hash_tells_texts_and_overrides_apart() {
    let hash = |text: &str, overrides: &[&str]| load(text, overrides).hash();
    let plain = hash(CASE4, &[]);
    assert_eq!(plain.len(), 64);
    assert_eq!(plain, hash(CASE4, &[]));
    assert_ne!(plain, hash(CASE4, &["integrator.step=1e-5"]));
    assert_ne!(
        plain,
        hash(&CASE4.replacen("phase = 0.0", "phase = 0.5", 1), &[])
    );
    assert_ne!(
        hash(CASE4, &["simulation.duration=1", "output.interval=1e-3"]),
        hash(CASE4, &["output.interval=1e-3", "simulation.duration=1"])
    );
}

//! Discs: mass and inertia from dimensions, points, and the pendulum on the rim.

use crate::support::{difference, load, run, run_scene};
use ladder::{Rung, Worst};
use looselink::scene::Scene;
use std::f64::consts::PI;

const SCENE: &str = "driven-disc.toml";

/// The same disc as a rigid body, whose mass and inertia are typed.
#[test]
fn a_disc_is_a_rigid_body() {
    let mass = 7850.0 * PI * 0.01 * 0.01;
    let typed = format!(
        r#"bodies.disc={{type="rigid_body",mass={mass:?},inertia={:?},points={{center=[0.0,0.0],rim={{radius=0.1,degrees=90.0}}}}}}"#,
        0.5 * mass * 0.01
    );
    let [disc, body] = [&[][..], &[&*typed]].map(|overrides| run(SCENE, overrides).0);
    let worst = difference([&disc, &body], disc.names(), 1e-3);
    Rung::Routes
        .asks("Disc given by radius, thickness and material, and as a rigid body: difference of all channels, relative to the largest value")
        .within(&worst, 1e-9, "rounding of mass and inertia, carried along for 3 s");
}

/// A disc about its rim has the inertia 3/2 m R^2: small swings have the period 2 pi sqrt(3 R/(2 g)).
#[test]
fn a_disc_swings_about_its_rim() {
    let still = [
        "drives.shake={type=\"point\",point=\"disc.rim\",x=0.0,y=0.0}",
        "initial.velocities.disc.omega=1e-3",
        "integrator={method=\"dormand_prince\",step=1e-3}",
    ];
    let (recording, _) = run(SCENE, &still);
    let frequency = (2.0 * 9.81 / (3.0 * 0.1_f64)).sqrt();
    let worst = Worst::new();
    for (t, omega) in recording.get("t").iter().zip(recording.get("disc.omega")) {
        worst.see(omega / 1e-3 - (frequency * t).cos());
    }
    Rung::Routes
        .asks("Disc swinging about its rim: angular velocity, relative to the largest, against cos(t sqrt(2 g/(3 R)))")
        .within(&worst, 1e-6, "the period of a swing of 0.12 mrad differs by 1e-9 of it, over 12 periods; steps of 1/250 of a period, order 5");
}

#[test]
fn points_and_masses_of_discs_are_checked() {
    let scene = load(SCENE, &["bodies.disc.points={bolt=[0.02,0.0]}"]);
    let names: Vec<_> = scene.bodies[1]
        .kind
        .points()
        .iter()
        .map(|p| p.name.clone())
        .collect();
    assert_eq!(names, ["center", "rim", "bolt"]);
    run_scene(&scene);
    let text = std::fs::read_to_string(crate::support::path(SCENE)).unwrap();
    for (change, told) in [
        ("bodies.disc.points={rim=[0.1,0.0]}", "already"),
        (
            "bodies.disc.mass=1.0",
            "cannot be combined with a given `mass`",
        ),
        ("bodies.disc.radius=-0.1", "`bodies.disc.radius` must be"),
        (
            "bodies.disc={type=\"disc\",radius=0.1}",
            "missing key `material`",
        ),
        ("bodies.disc.rims=0.0", "unknown key"),
    ] {
        let error = Scene::parse(SCENE, &text, &[change.to_owned()]).unwrap_err();
        assert!(error.to_string().contains(told), "{change}: {error}");
    }
}

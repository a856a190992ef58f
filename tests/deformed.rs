//! Starts of deformed links, states at any point of a body, and loads along straight lines.

use crate::support::{load, path, rising_zeros, run};
use ladder::{Rung, Worst};
use looselink::scene::Scene;
use looselink::simulate::Simulation;
use std::f64::consts::{PI, TAU};

const STRING: &str = "plucked-string.toml";
const BAR: &str = "ringing-bar.toml";

/// w^2 = (E/rho) eps b^2 + (E I/(rho A)) b^4, b = k pi/l: the frequencies of the stretched string.
fn of_string(k: f64) -> f64 {
    let b = k * PI / 0.65;
    let speed = 210e9 / 7850.0;
    let bending = speed * 3e-4_f64.powi(2) / 12.0;
    (speed * 0.002002 * b * b + bending * b.powi(4)).sqrt() / TAU
}

#[test]
fn a_stretched_string_has_the_frequencies_of_its_tension() {
    let mut simulation = Simulation::new(&load(STRING, &[])).unwrap();
    let modes = simulation.modes(false).unwrap().modes;
    let worst = Worst::new();
    for (k, mode) in modes.iter().take(3).enumerate() {
        worst.see(mode.frequency / of_string(k as f64 + 1.0) - 1.0);
    }
    Rung::OrderInElements
        .asks("Stretched string of 8 elements: relative difference of its first three frequencies from those of its tension and stiffness")
        .within(&worst, 1e-4, "cubics: the error of mode k is below (k pi/8)^6/30240 of the tension's part, 9e-5 for k = 3");
}

/// The zeros of the free vibration after the string is let go.
#[test]
fn a_plucked_string_vibrates_with_its_first_frequency() {
    let (recording, _) = run(STRING, &[]);
    let (t, y) = (recording.get("t"), recording.get("points.string.middle.y"));
    let released = recording.row(0.0102) - 1;
    let zeros = rising_zeros(&t[released..], &y[released..]);
    assert!(zeros.len() >= 5, "{zeros:?}");
    let frequency = (zeros.len() - 1) as f64 / (zeros[zeros.len() - 1] - zeros[0]);
    Rung::Routes
        .asks("Plucked string: relative difference of the frequency of its motion from that of its tension and stiffness")
        .within(frequency / of_string(1.0) - 1.0, 2e-3, "overtones shift a zero by a hundredth of a period, over six periods; the stretch by a pull of 0.4 mm raises the frequency by 1e-4");
}

/// Energies of the deformation, E A l eps^2/2 and rho A l^5 kappa^2/1440, and a motion of the centre of mass without them.
#[test]
fn a_deformed_start_has_its_energies_and_no_momentum() {
    let energies = |scene: &Scene| {
        let simulation = Simulation::new(scene).unwrap();
        let model = simulation.model();
        (
            model.energies(simulation.state()),
            model.pose(model.bodies().len() - 1, simulation.state()),
        )
    };
    let still =
        "initial.bodies.bar={x=0.3,y=-0.2,theta=0.7,vx=0.0,vy=0.0,omega=0.0,bending_rate=40.0}";
    let (bent, pose) = energies(&load(BAR, &[still]));
    let kinetic = 7850.0 * 2e-4 * 0.5_f64.powi(5) * 40.0_f64.powi(2) / 1440.0;
    let worst = Worst::new();
    worst.see(bent.kinetic / kinetic - 1.0);
    worst.see(pose.velocity[0]);
    worst.see(pose.velocity[1]);
    let long = "initial.bodies.bar={x=0.3,y=-0.2,theta=0.7,strain=0.01}";
    let (stretched, _) = energies(&load(BAR, &[long]));
    worst.see(stretched.axial / (0.5 * 210e9 * 2e-4 * 0.5 * 0.01 * 0.01) - 1.0);
    // a uniform stretch has no second derivative
    worst.see(stretched.bending);
    Rung::Identities
        .asks("Bar that starts stretched or bending: relative differences of its energies from their formulas, velocity of its centre of mass [m/s]")
        .within(&worst, 1e-9, "cubics have the quadratic shape exactly; rounding of energies of differences of slopes");
}

/// What bends in the bar does not change its flight: parabola and spin of a rigid bar, to the change of its inertia.
#[test]
fn a_ringing_bar_flies_as_a_rigid_one() {
    let (recording, _) = run(BAR, &[]);
    let worst = Worst::new();
    let places = recording
        .get("bar.x")
        .into_iter()
        .zip(recording.get("bar.y"));
    for (t, (x, y)) in recording.get("t").into_iter().zip(places) {
        worst.see(x - t);
        worst.see(y - (2.0 * t - 0.5 * 9.81 * t * t));
    }
    Rung::Balance
        .asks("Ringing bar in free flight: distance of its centre of mass from the parabola [m]")
        .within(
            &worst,
            1e-10,
            "both stages are exact for constant acceleration; 5000 steps, each to 1e-11 m/s",
        );
}

/// The same start, given at the centre of mass and at every named point.
#[test]
fn a_state_may_be_that_of_any_point() {
    let worst = Worst::new();
    let start = |scene: &str, body: &str, state: &str| {
        let change = format!("initial.bodies.{body}={{{state}}}");
        let simulation = Simulation::new(&load(scene, &[&change])).unwrap();
        let (state, model) = (simulation.state(), simulation.model());
        let index = model.bodies().iter().position(|b| b.name == body).unwrap();
        let points = (0..model.bodies()[index].points.len()).map(|p| model.point(index, p, state));
        let points: Vec<_> = points.collect();
        ([state.q.clone(), state.v.clone()].concat(), points)
    };
    let deformed = "theta=0.5,omega=3.0,bending_rate=40.0,strain=0.003";
    for (scene, body, turned, names) in [
        (BAR, "bar", deformed, &["start", "end", "middle"][..]),
        (
            "bouncing-journal.toml",
            "journal",
            "theta=0.5,omega=3.0",
            &["center"],
        ),
    ] {
        let (whole, points) = start(scene, body, &format!("x=0.0,y=1e-6,vx=0.1,vy=0.2,{turned}"));
        for (name, [at, rate, _]) in names.iter().zip(points) {
            let state = format!(
                "point={name:?},x={:?},y={:?},vx={:?},vy={:?},{turned}",
                at.x, at.y, rate.x, rate.y
            );
            let (again, _) = start(scene, body, &state);
            whole.iter().zip(&again).for_each(|(x, y)| worst.see(x - y));
        }
    }
    Rung::Identities
        .asks("States given at any named point of a link and of a rigid body: difference of the starts [m, m/s, rad]")
        .within(&worst, 1e-14, "rounding");
}

#[test]
fn deformed_starts_and_points_are_checked() {
    for (scene, change, message) in [
        (
            BAR,
            "initial.bodies.bar.strain=-0.5",
            "must lie above -0.5 and not above 1",
        ),
        (
            BAR,
            "initial.bodies.bar.point=\"midle\"",
            "there is no point of the body called `midle`; did you mean `middle`",
        ),
        (
            "bouncing-journal.toml",
            "initial.bodies.journal.strain=0.0",
            "unknown key `strain`",
        ),
        (
            STRING,
            "initial={sketch={left=[0.0,0.0]},bodies={string={x=0.3,y=0.0,theta=0.0,strain=0.1}}}",
            "string cannot be assembled: it starts stretched or bending",
        ),
        (
            STRING,
            "initial.bodies.string.strain=0.001",
            "the pose of string does not fit",
        ),
    ] {
        let scene = Scene::load(&path(scene), &[change.to_owned()]);
        let error = scene.and_then(|scene| Simulation::new(&scene).map(drop));
        let error = error.unwrap_err().to_string();
        assert!(error.contains(message), "{change}: {error}");
    }
}

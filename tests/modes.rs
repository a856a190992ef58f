//! Natural frequencies and mode shapes against closed forms, over meshes, and against motions.

use crate::support::{load, rising_zeros, run_scene};
use ladder::{Rung, Worst};
use looselink::modes::Modes;
use looselink::scene::Scene;
use looselink::simulate::Simulation;
use looselink::system::System;
use std::f64::consts::{PI, TAU};

const HEAD: &str = r#"
format = 1
title = "modes"
simulation = { duration = 1.0 }
integrator = { method = "bathe", step = 1e-4, newton_tolerance = 1e-12 }
output = { interval = 1e-3, channels = ["*"] }
materials.steel = { density = 7800.0, youngs_modulus = 210e9 }
sections.bar = { width = 0.01, height = 0.005 }
"#;

/// A steel bar of 1 m along x between two pins, or free.
fn bar(elements: usize, pinned: bool) -> Scene {
    let mut text = format!(
        r#"{HEAD}
bodies.ground = {{ type = "ground", points.left = [0, 0], points.right = [1, 0] }}
bodies.bar = {{ type = "link", model = "flexible", length = 1.0, section = "bar", material = "steel", elements = {elements} }}
initial.bodies.bar = {{ x = 0.5, y = 0.0, theta = 0.0 }}
"#
    );
    if pinned {
        text += r#"
joints.left = { type = "revolute", model = "ideal", bearing = "ground.left", journal = "bar.start" }
joints.right = { type = "revolute", model = "ideal", bearing = "ground.right", journal = "bar.end" }
"#;
    }
    Scene::parse("bar.toml", &text, &[]).unwrap()
}

fn modes_of(scene: &Scene) -> Modes {
    Simulation::new(scene).unwrap().modes(false).unwrap()
}

/// sqrt(EI/(rho A)) of the bar [m2/s].
fn bending_speed() -> f64 {
    (210e9 / 7800.0 * 0.01_f64.powi(2) / 12.0).sqrt()
}

/// The frequency nearest to an expected one.
fn nearest(modes: &Modes, expected: f64) -> f64 {
    let frequencies = modes.modes.iter().map(|mode| mode.frequency);
    let distance = |f: &f64| (f - expected).abs();
    frequencies
        .min_by(|a, b| distance(a).total_cmp(&distance(b)))
        .unwrap()
}

/// A rod on a pin at the distance R from the axis of a crank that turns at Omega: the acceleration of the pin acts as a weight,
/// w^2 = m s R Omega^2/(I + m s^2) with its centre of mass at the distance s.
#[test]
fn a_rod_on_a_turning_crank_swings_about_the_radius() {
    let (mass, inertia, s, r, speed) = (0.4_f64, 3e-3, 0.12, 0.3, 20.0);
    let text = format!(
        r#"{HEAD}
bodies.ground = {{ type = "ground", points.O = [0, 0] }}
bodies.crank = {{ type = "link", model = "rigid", length = {r:?}, section = "bar", material = "steel" }}
bodies.rod = {{ type = "rigid_body", mass = {mass:?}, inertia = {inertia:?}, points.pin = [{:?}, 0] }}
joints.O = {{ type = "revolute", model = "ideal", bearing = "ground.O", journal = "crank.start" }}
joints.pin = {{ type = "revolute", model = "ideal", bearing = "crank.end", journal = "rod.pin" }}
drives.motor = {{ type = "angle", joint = "O", angle = {{ type = "polynomial", coefficients = [0.0, {speed:?}] }} }}
initial.bodies.rod = {{ x = {:?}, y = 0.0, theta = 0.0, vx = 0.0, vy = {:?}, omega = 0.0 }}
"#,
        -s,
        r + s,
        speed * r
    );
    let scene = Scene::parse("crank.toml", &text, &[]).unwrap();
    let expected = (mass * s * r * speed * speed / (inertia + mass * s * s)).sqrt() / TAU;
    let [mode] = &modes_of(&scene).modes[..] else {
        panic!("the rod alone can move");
    };
    let error = Worst::new();
    error.see(mode.frequency / expected - 1.0);
    Rung::Identities
        .asks("A rod on the end of a crank that turns: relative error of the frequency at which it swings about the radius")
        .within(&error, 1e-14, "rounding");
}

/// f = (k pi)^2/(2 pi l^2) sqrt(EI/(rho A)). With cubics on elements of length h the relative error is (k pi h/l)^4/1440 to
/// leading order (Strang & Fix 1973, An Analysis of the Finite Element Method, chapter 6).
#[test]
fn a_bar_between_pins_vibrates_as_euler_and_bernoulli_say() {
    let worst = Worst::new();
    for elements in [4, 8, 16] {
        let modes = modes_of(&bar(elements, true));
        for k in 1..=elements / 4 {
            let beta = k as f64 * PI;
            let exact = beta * beta * bending_speed() / TAU;
            let error = nearest(&modes, exact) / exact - 1.0;
            let predicted = (beta / elements as f64).powi(4) / 1440.0;
            worst.see(error / predicted - 1.0);
        }
    }
    Rung::OrderInElements
        .asks("Bar between pins, 4 to 16 elements: error of the natural frequencies up to the number n/4, relative to (k pi/n)^4/1440, less one")
        .within(&worst, 0.1, "the next term of the error is smaller by (k pi/n)^2, which is at most 0.6, times a factor below a sixth");
}

/// Waves along a bar between fixed ends: w^2 = E/rho b^2 (1 + I/A b^2), b = pi/l. The second term is that of the bending energy,
/// which is the energy of r'' in both directions.
#[test]
fn a_bar_between_pins_vibrates_along_its_axis() {
    let slender = 0.01_f64.powi(2) / 12.0 * PI * PI;
    let exact = (210e9 / 7800.0 * (1.0 + slender)).sqrt() / 2.0;
    let errors = [2, 4, 8].map(|n| {
        let modes = modes_of(&bar(n, true));
        (1.0 / n as f64, nearest(&modes, exact) / exact - 1.0)
    });
    Rung::OrderInElements
        .asks("Bar between pins: error of the first frequency of axial vibrations over the length of the elements")
        .falls("Element length l/L", &errors, 5.0..7.0, "cubics: the square of the error of a slope, h^6");
}

/// cos(b) cosh(b) = 1, and three motions without vibration.
#[test]
fn a_free_bar_has_three_free_motions() {
    const BETAS: [f64; 3] = [4.730040744862704, 7.853204624095838, 10.995607838001671];
    let mut errors = [Vec::new(), Vec::new(), Vec::new()];
    for elements in [8, 16, 32] {
        let modes = modes_of(&bar(elements, false));
        assert!(
            modes.modes[..3]
                .iter()
                .all(|m| m.frequency == 0.0 && m.growth == 0.0)
        );
        assert!(modes.modes[3].frequency > 1.0);
        for (errors, beta) in errors.iter_mut().zip(BETAS) {
            let exact = beta * beta * bending_speed() / TAU;
            errors.push((1.0 / elements as f64, nearest(&modes, exact) / exact - 1.0));
        }
    }
    for (k, errors) in errors.iter().enumerate() {
        Rung::OrderInElements
            .asks(format!(
                "Free bar: error of the frequency of bending {} over the length of the elements",
                k + 1
            ))
            .falls(
                "Element length l/L",
                errors,
                3.5..4.5,
                "cubics: the square of the error of a curvature, h^4",
            );
    }
}

/// A parallelogram of two uniform cranks and a coupler, which does not turn, with a spring and a damper at a crank:
/// w^2 = k/(2 m_c a^2/3 + m a^2), damping ratio c/(2 w I).
fn parallelogram(angle: f64, more: &str) -> Scene {
    let [x, y] = [0.2 * angle.cos(), 0.2 * angle.sin()];
    let text = format!(
        r#"{HEAD}
bodies.ground = {{ type = "ground", points.A = [0, 0], points.D = [0.5, 0] }}
bodies.left = {{ type = "link", model = "rigid", length = 0.2, section = "bar", material = "steel" }}
bodies.right = {{ type = "link", model = "rigid", length = 0.2, section = "bar", material = "steel" }}
bodies.coupler = {{ type = "link", model = "rigid", length = 0.5, section = "bar", material = "steel" }}
joints.A = {{ type = "revolute", model = "ideal", bearing = "ground.A", journal = "left.start" }}
joints.B = {{ type = "revolute", model = "ideal", bearing = "left.end", journal = "coupler.start" }}
joints.C = {{ type = "revolute", model = "ideal", bearing = "coupler.end", journal = "right.end" }}
joints.D = {{ type = "revolute", model = "ideal", bearing = "ground.D", journal = "right.start" }}
forces.spring = {{ type = "torsion_spring", joint = "A", stiffness = 3.0, damping = 0.002, rest_angle = {angle} }}
initial.sketch.B = [{x}, {y}]
initial.sketch.C = [{}, {y}]
{more}
"#,
        x + 0.5
    );
    Scene::parse("parallelogram.toml", &text, &[]).unwrap()
}

/// Mass of a bar of 1 m [kg].
const BAR: f64 = 7800.0 * 0.01 * 0.005;

#[test]
fn a_four_bar_with_a_spring_vibrates_as_its_inertia_says() {
    let inertia = BAR * (2.0 * 0.2_f64.powi(3) / 3.0 + 0.5 * 0.2_f64.powi(2));
    let exact = (3.0 / inertia).sqrt();
    let (worst, damping) = (Worst::new(), Worst::new());
    for angle in [0.3, 1.0, 2.5] {
        let modes = modes_of(&parallelogram(angle, ""));
        assert_eq!(modes.modes.len(), 1);
        let mode = &modes.modes[0];
        worst.see(TAU * mode.frequency / exact - 1.0);
        damping.see(mode.damping / (0.002 / (2.0 * exact * inertia)) - 1.0);
    }
    Rung::Routes
        .asks("Parallelogram with a torsion spring: relative difference of the natural frequency from sqrt(k/I)")
        .within(&worst, 1e-11, "rounding, times the ratio of lengths to the height of the parallelogram");
    Rung::Routes
        .asks("Parallelogram with a torsional damper: relative difference of the damping ratio from c/(2 w I)")
        .within(&damping, 1e-11, "rounding, as before");
}

/// The period of a small swing of the same mechanism.
#[test]
fn a_mode_is_what_a_small_motion_shows() {
    let modes = modes_of(&parallelogram(1.0, ""));
    let start = "initial.velocities.left.omega = 1e-3";
    let scene = parallelogram(1.0, start);
    let (recording, _) = run_scene(&scene);
    let (t, speed) = (recording.get("t"), recording.get("left.omega"));
    let zeros = rising_zeros(&t, &speed);
    assert!(zeros.len() > 2, "{zeros:?}");
    let period = (zeros[zeros.len() - 1] - zeros[0]) / (zeros.len() - 1) as f64;
    let damped = modes.modes[0].frequency * (1.0 - modes.modes[0].damping.powi(2)).sqrt();
    Rung::Routes
        .asks("Parallelogram with a spring: relative difference of the frequency of a small motion from that of the mode")
        .within(1.0 / period / damped - 1.0, 1e-3, "linear interpolation of zeros between rows, 1/30 of a period apart");
}

/// The windows of IFToMM A02 swing as a pendulum with w^2 = 11.445 1/s2: standing up they are unstable with that rate.
#[test]
fn a_mechanism_that_stands_up_is_unstable() {
    let scene = load("n-four-bar.toml", &["initial.velocities={}"]);
    let modes = modes_of(&scene);
    let growth = modes.modes[0].growth;
    Rung::ClosedForms
        .asks("Two four-bar windows standing up (IFToMM A02): w^2 from the growth of the unstable mode")
        .within(growth * growth / 11.445 - 1.0, 5e-5, "five digits of the closed form, g (3 N + 1)/2 over (4 N + 1)/3");
}

/// A journal that presses on its bearing with F at a penetration delta, on a circle of radius c + delta:
/// w^2 = n K delta^(n-1)/m along the force, F/((c + delta) m) across it; it turns freely.
#[test]
fn a_closed_contact_is_a_spring() {
    const DELTA: f64 = 1e-7;
    let start = format!(
        "initial.bodies.journal={{x={:e},y=0.0,theta=0.0}}",
        2e-5 + DELTA
    );
    let scene = load("bouncing-journal.toml", &[&start]);
    let contact = scene.joints[0].contact().unwrap();
    let (k, n, clearance) = (contact.stiffness, contact.exponent, contact.clearance);
    let delta = (clearance + DELTA) - clearance;
    let mut simulation = Simulation::new(&scene).unwrap();
    let closed = simulation.modes(false).unwrap();
    let along = (n * k * delta.powf(n - 1.0) / 0.05).sqrt() / TAU;
    let across = (k * delta.powf(n) / ((clearance + delta) * 0.05)).sqrt() / TAU;
    let worst = Worst::new();
    for expected in [along, across] {
        worst.see(nearest(&closed, expected) / expected - 1.0);
    }
    Rung::Routes
        .asks("Journal pressed on its bearing: relative difference of both natural frequencies from those of the contact law")
        .within(&worst, 1e-9, "rounding of a penetration of 1e-7 m beside a clearance of 2e-5 m");
    let open = simulation.modes(true).unwrap();
    let free = |modes: &Modes| modes.modes.iter().filter(|m| m.frequency == 0.0).count();
    assert_eq!([free(&closed), free(&open)], [1, 3]);
}

/// Case 4 with all six contacts closed: every link moved by the clearance and a penetration of 0.1 um.
#[test]
fn case_4_with_closed_contacts_converges_with_the_elements() {
    let frequencies = |elements: usize| {
        let elements =
            ["link1", "link2", "link3"].map(|link| format!("bodies.{link}.elements={elements}"));
        let scene = load("3rrr/case4.toml", &elements.each_ref().map(String::as_str));
        let mut simulation = Simulation::new(&scene).unwrap();
        let mut state = simulation.state().clone();
        let contact = scene
            .joints
            .iter()
            .find_map(|joint| joint.contact())
            .unwrap();
        let shift = contact.clearance + 1e-7;
        let names = simulation.model().unknown_names();
        let positions = names[..simulation.model().shape().unknowns]
            .iter()
            .enumerate();
        for (i, name) in
            positions.filter(|(_, name)| name.starts_with("link") && !name.contains("slope"))
        {
            let angle = name.as_bytes()[4] as f64;
            state.q[i] += shift
                * if name.ends_with(".x") {
                    angle.cos()
                } else {
                    angle.sin()
                };
        }
        simulation.continue_from(&state).unwrap();
        assert_eq!(simulation.model().closed(simulation.state()).count(), 6);
        let modes = simulation.modes(false).unwrap().modes;
        let vibrating = modes
            .into_iter()
            .map(|mode| mode.frequency)
            .filter(|f| *f > 0.0);
        vibrating.collect::<Vec<_>>()
    };
    let finest = frequencies(16);
    // the first of every link, and the next three: bending
    let errors = |k: usize| {
        let error = |n: usize| (1.0 / n as f64, frequencies(n)[k] / finest[k] - 1.0);
        [2, 4, 8].map(error)
    };
    for k in [0, 3] {
        Rung::OrderInElements
            .asks(format!("Case 4 with six closed contacts: error of vibration {} over the length of the elements, against 16", k + 1))
            .falls("Element length l/L", &errors(k), 3.3..4.7, "cubics: h^4; the reference adds a sixteenth at the finest mesh");
    }
}

/// Whatever the mesh, a mode moves the unknown that it names by a metre, and the constraints hold to first order.
#[test]
fn shapes_satisfy_the_constraints() {
    let scene = load("3rrr/case2.toml", &[]);
    let mut simulation = Simulation::new(&scene).unwrap();
    let modes = simulation.modes(false).unwrap();
    let model = simulation.model();
    let (n, worst) = (model.shape().unknowns, Worst::new());
    let mut phi = vec![0.0; model.shape().multipliers];
    for mode in &modes.modes {
        let mut at = simulation.state().clone();
        at.v.fill(0.0);
        at.v[..n].copy_from_slice(&mode.shape[..n]);
        model.constraint_velocity(&at, &mut phi);
        // the drive moves as it does, with velocities that the shape does not have
        let mut still = simulation.state().clone();
        still.v.fill(0.0);
        let mut drift = phi.clone();
        model.constraint_velocity(&still, &mut drift);
        phi.iter().zip(&drift).for_each(|(x, y)| worst.see(x - y));
    }
    Rung::Identities
        .asks("Mode shapes of case 2: largest change of a constraint when the unknown that moves most moves 1 m [m]")
        .within(&worst, 1e-10, "rounding of an orthonormal basis, times lengths of slopes");
}

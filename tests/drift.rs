//! The energy that Bathe's scheme loses or gains on nonlinear mechanisms that proptest draws.
//!
//! Let y' = f(y) be the equations of motion and H the energy. A step of the scheme with gamma = 1/2 differs from the motion by
//! h^3 (f''(f, f)/24 + c f' f' f) + O(h^4): its weights give 5/12 for the integral of t^2, which is 1/3. The second term is
//! orthogonal to the gradient of the energy. The first one changes the energy by -h^3/24 times the rate of H''(f, f), and the
//! sum over the steps telescopes:
//!
//! ```text
//! E(t) - E(0) = -h^2/24 [H''(f, f)(t) - H''(f, f)(0)] - loss,    H''(f, f) = v.K v + a.M a
//! ```
//!
//! So the energy oscillates with an amplitude of order h^2 that does not grow with the number of steps. With omega the highest
//! frequency of the mechanism, H''(f, f) is at most 2 omega^2 times the energy in play. The loss is at most that of a linear
//! vibration of this frequency with all of the energy, (h omega)^4/144 a step (`tests/steppers.rs`). The runs are short
//! enough for the first part to be the larger one, so the order is 2. Constraints, on which every stage ends, change the terms and
//! not their order.

use crate::support::run_scene;
use ladder::{Rung, Worst};
use looselink::link::{AncfCable, ElasticRoute};
use looselink::scene::Scene;
use nalgebra::{DMatrix, SymmetricEigen};
use proptest::prelude::*;

const GRAVITY: f64 = 9.81;
/// Width of a beam out of the plane \[m\].
const WIDTH: f64 = 0.01;
/// Rows of a run, and coarsest steps from row to row.
const ROWS: usize = 20;
const STEPS: usize = 10;
/// Mechanisms of each kind.
const CASES: u32 = 100;

/// A beam whose weight would stretch it by `strain`, and that is `slenderness` times its length thick.
#[derive(Debug, Clone, Copy)]
struct Beam {
    length: f64,
    density: f64,
    strain: f64,
    slenderness: f64,
    elements: usize,
}

impl Beam {
    fn modulus(&self) -> f64 {
        self.density * GRAVITY * self.length / self.strain
    }

    fn thickness(&self) -> f64 {
        self.slenderness * self.length
    }

    /// The highest frequency of one element that is free \[rad/s\]: no mode of a mechanism with such elements, in which other
    /// masses and constraints may only add inertia, is higher (Irons and Treharne 1971).
    fn highest_frequency(&self) -> f64 {
        let l = self.length / self.elements as f64;
        let area = WIDTH * self.thickness();
        let ea = self.modulus() * area;
        let ei = ea * self.thickness().powi(2) / 12.0;
        let (mut f, mut k) = ([0.0; 8], [[0.0; 8]; 8]);
        AncfCable::new(l, ea, ei).force_and_tangent(
            &[0.0, 0.0, 1.0, 0.0, l, 0.0, 1.0, 0.0],
            &mut f,
            &mut k,
        );
        let m = AncfCable::mass(l, self.density * area);
        let mass = DMatrix::from_fn(
            8,
            8,
            |i, j| if i % 2 == j % 2 { m[i / 2][j / 2] } else { 0.0 },
        );
        let inverse = mass.cholesky().unwrap().l().try_inverse().unwrap();
        let stiffness = DMatrix::from_fn(8, 8, |i, j| k[i][j]);
        let scaled = &inverse * stiffness * inverse.transpose();
        SymmetricEigen::new(scaled).eigenvalues.max().sqrt()
    }

    /// Its material, section and body, as lines of a scene.
    fn text(&self) -> String {
        format!(
            r#"
materials.soft = {{ density = {:?}, youngs_modulus = {:?} }}
sections.strip = {{ width = {:?}, height = {WIDTH:?} }}
bodies.beam = {{ type = "link", model = "flexible", elements = {}, length = {:?}, section = "strip", material = "soft" }}"#,
            self.density,
            self.modulus(),
            self.thickness(),
            self.elements,
            self.length,
        )
    }
}

/// Beams with a strain between two powers of ten.
fn beams(strain: std::ops::Range<f64>) -> impl Strategy<Value = Beam> {
    (
        0.3..1.5_f64,
        1e3..8e3_f64,
        strain,
        -2.3..-1.0_f64,
        1..4_usize,
    )
        .prop_map(|(length, density, strain, slenderness, elements)| Beam {
            length,
            density,
            strain: 10.0_f64.powf(strain),
            slenderness: 10.0_f64.powf(slenderness),
            elements,
        })
}

/// A mechanism at its start.
#[derive(Debug)]
struct DrawnMechanism {
    /// Its bodies, joints and initial state, as lines of a scene.
    text: String,
    gravity: [f64; 2],
    /// Its highest frequency \[rad/s\].
    highest: f64,
    /// The highest frequency times the coarsest step.
    coarsest: f64,
}

impl DrawnMechanism {
    /// Largest energy that the integrator lost or gained over a run, over the energy in play, with steps `refined` times as
    /// short as the coarsest.
    fn drift(&self, method: &str, refined: f64) -> f64 {
        let step = self.coarsest / self.highest;
        let interval = STEPS as f64 * step;
        let text = format!(
            r#"
format = 1
title = "a mechanism"
simulation = {{ duration = {:?}, gravity = {:?} }}
integrator = {{ method = "{method}", step = {:?}, newton_tolerance = 1e-14, onset_tolerance = 1e-14 }}
output = {{ interval = {interval:?}, channels = ["energy.*"] }}
{}"#,
            ROWS as f64 * interval,
            self.gravity,
            step / refined,
            self.text,
        );
        let scene = Scene::parse("drawn", &text, &[]).unwrap_or_else(|e| panic!("{e}\n{text}"));
        let (run, _) = run_scene(&scene);
        let channel = |name: &str| run.get(&format!("energy.{name}"));
        let parts = ["kinetic", "axial", "bending", "contact"].map(channel);
        let in_play = (0..run.len()).map(|row| parts.iter().map(|part| part[row]).sum::<f64>());
        let drift = channel("numerical")
            .iter()
            .fold(0.0_f64, |m, x| m.max(x.abs()));
        drift / in_play.fold(0.0, f64::max)
    }

    /// Largest part used of what the drift may be, at three steps of which each is half the one before, and the two orders
    /// that it falls with.
    fn falls(&self, method: &str) -> (f64, [f64; 2]) {
        let drifts = [1.0, 2.0, 4.0].map(|refined| (refined, self.drift(method, refined)));
        let used = drifts.map(|(refined, drift)| {
            let x = self.coarsest / refined;
            let steps = (ROWS * STEPS) as f64 * refined;
            drift / (x.powi(2) / 12.0 + steps * x.powi(4) / 144.0)
        });
        let orders = [0, 1].map(|i| (drifts[i].1 / drifts[i + 1].1).log2());
        (used.into_iter().fold(0.0, f64::max), orders)
    }
}

/// By how much an order may differ from 2. The next term is smaller by a factor h omega, at most a fifth; halving the step
/// halves it, which takes up to a tenth from the order, or twice that where the leading term is small itself.
const ORDER_TOLERANCE: f64 = 0.2;

fn holds(name: &str, strategy: impl Strategy<Value = DrawnMechanism>) {
    let (used, off) = (Worst::new(), Worst::new());
    proptest!(ProptestConfig::with_cases(CASES), |(drawn in strategy)| {
        let (drift, orders) = drawn.falls("bathe");
        used.see(drift);
        prop_assert!(drift <= 1.0, "drift over its bound: {drift}");
        for order in orders {
            off.see(order - 2.0);
            prop_assert!((order - 2.0).abs() <= ORDER_TOLERANCE, "orders {orders:?}");
        }
        // a scheme of order 1 fails the same check
        let (_, [order, _]) = drawn.falls("backward_euler");
        prop_assert!(order < 2.0 - ORDER_TOLERANCE, "backward Euler has order {order}");
    });
    Rung::Balance
        .asks(format!("{name}: largest energy lost or gained by Bathe's scheme at three steps, over its bound"))
        .within(&used, 1.0, "((h ω)²/12 + n (h ω)⁴/144) times the energy of the motion over n steps, ω the highest frequency; of random mechanisms");
    Rung::OrderInTime
        .asks(format!(
            "{name}: largest deviation from 2 of the order of this energy in the step"
        ))
        .within(
            &off,
            ORDER_TOLERANCE,
            "the leading term is of order 2; the next is smaller by h ω, at most a fifth; of random mechanisms",
        );
}

/// Speeds of either direction, far from rest: turning makes the equations nonlinear.
fn speeds() -> impl Strategy<Value = f64> {
    prop_oneof![2.0..6.0_f64, -6.0..-2.0_f64]
}

#[test]
fn flexible_pendulums_keep_their_energy_to_second_order() {
    let strategy =
        (beams(-2.3..-1.0), -3.1..3.1_f64, speeds()).prop_map(|(beam, angle, omega)| {
            let (sine, cosine) = angle.sin_cos();
            let [x, y] = [0.5 * beam.length * cosine, 0.5 * beam.length * sine];
            let [vx, vy] = [-omega * y, omega * x];
            DrawnMechanism {
                text: format!(
                    r#"{}
bodies.ground = {{ type = "ground", points.O = [0, 0] }}
joints.O = {{ type = "revolute", bearing = "ground.O", journal = "beam.start", model = "ideal" }}
initial.bodies.beam = {{ x = {x:?}, y = {y:?}, theta = {angle:?}, vx = {vx:?}, vy = {vy:?}, omega = {omega:?} }}
"#,
                    beam.text()
                ),
                gravity: [0.0, -GRAVITY],
                highest: beam.highest_frequency(),
                coarsest: 0.2,
            }
        });
    holds("Flexible pendulums", strategy);
}

/// Four-bars with a flexible coupler: a crank and a rocker that stand up, far from poses where bars lie in one line.
#[test]
fn closed_loops_keep_their_energy_to_second_order() {
    let bars = (0.2..0.4_f64, 0.2..0.4_f64, 0.3..0.6_f64);
    let angles = (1.05..2.1_f64, 1.05..2.1_f64);
    let bent = |(_, (crank, rocker, base), (alpha, beta), _): &(
        Beam,
        (f64, f64, f64),
        (f64, f64),
        f64,
    )| {
        let along = [
            base + rocker * beta.cos() - crank * alpha.cos(),
            rocker * beta.sin() - crank * alpha.sin(),
        ];
        let coupler = along[1].atan2(along[0]);
        [alpha, beta]
            .iter()
            .all(|bar| (coupler - *bar).sin().abs() > 0.3)
    };
    let drawn = (beams(-3.0..-2.0), bars, angles, speeds());
    let strategy = drawn.prop_filter("the coupler in line with a bar", bent).prop_map(
        |(beam, (crank, rocker, base), (alpha, beta), omega)| {
            let knee = [crank * alpha.cos(), crank * alpha.sin()];
            let wrist = [base + rocker * beta.cos(), rocker * beta.sin()];
            let length = (wrist[0] - knee[0]).hypot(wrist[1] - knee[1]);
            let beam = Beam { length, ..beam };
            DrawnMechanism {
                text: format!(
                    r#"{}
materials.heavy = {{ density = 2000.0 }}
sections.bar = {{ width = 0.01, height = 0.01 }}
bodies.ground = {{ type = "ground", points.A = [0, 0], points.D = [{base:?}, 0] }}
bodies.crank = {{ type = "link", model = "rigid", length = {crank:?}, section = "bar", material = "heavy" }}
bodies.rocker = {{ type = "link", model = "rigid", length = {rocker:?}, section = "bar", material = "heavy" }}
joints.A = {{ type = "revolute", bearing = "ground.A", journal = "crank.start", model = "ideal" }}
joints.B = {{ type = "revolute", bearing = "crank.end", journal = "beam.start", model = "ideal" }}
joints.C = {{ type = "revolute", bearing = "beam.end", journal = "rocker.end", model = "ideal" }}
joints.D = {{ type = "revolute", bearing = "ground.D", journal = "rocker.start", model = "ideal" }}
initial.sketch = {{ B = {knee:?}, C = {wrist:?} }}
initial.velocities.crank = {{ omega = {omega:?} }}
"#,
                    beam.text()
                ),
                gravity: [0.0, -GRAVITY],
                highest: beam.highest_frequency(),
                coarsest: 0.1,
            }
        },
    );
    holds("Four-bars with a flexible coupler", strategy);
}

/// A journal that its weight holds against the wall of its bearing, by Hertz' law: it swings about the depth at which it
/// would rest, by up to half of it, and slides along the wall. The highest frequency is that at the deepest point.
#[test]
fn resting_contacts_keep_their_energy_to_second_order() {
    let contact = (0.01..1.0_f64, 8.0..11.0_f64, 1.0..2.0_f64);
    let swing = prop_oneof![0.3..0.5_f64, -0.5..-0.3_f64];
    let strategy = (contact, -1.0..1.0_f64, swing, -0.1..0.1_f64).prop_map(
        |((mass, log_stiffness, log_clearance), angle, swing, slide)| {
            let stiffness = 10.0_f64.powf(log_stiffness);
            let rest = (mass * GRAVITY / stiffness).powf(2.0 / 3.0);
            let clearance = rest * 10.0_f64.powf(log_clearance);
            let eccentricity = clearance + rest * (1.0 + swing);
            let speed = slide * (GRAVITY * clearance).sqrt();
            let (s, c) = angle.sin_cos();
            DrawnMechanism {
                text: format!(
                    r#"
contacts.soft = {{ law = "hertz", bearing_radius = 0.01, clearance = {clearance:?}, stiffness = {stiffness:?}, exponent = 1.5 }}
bodies.ground = {{ type = "ground", points.O = [0, 0] }}
bodies.pin = {{ type = "rigid_body", mass = {mass:?}, inertia = 1e-4, points.O = [0, 0] }}
joints.O = {{ type = "revolute", bearing = "ground.O", journal = "pin.O", model = "clearance", contact = "soft" }}
initial.bodies.pin = {{ x = {:?}, y = {:?}, theta = 0, vx = {:?}, vy = {:?}, omega = 0 }}
"#,
                    eccentricity * s,
                    -eccentricity * c,
                    speed * c,
                    speed * s,
                ),
                gravity: [GRAVITY * s, -GRAVITY * c],
                highest: (1.5 * stiffness * (rest * 1.5).sqrt() / mass).sqrt(),
                coarsest: 0.05,
            }
        },
    );
    holds("Journals resting in loose bearings", strategy);
}

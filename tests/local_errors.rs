//! Estimated local errors of motions with forces that depend on velocities, against the error of a step.
//!
//! The error of a step is the difference from DOP853 over the same step from the same coordinates, velocities and contact memory.

use crate::support::load;
use ladder::{Rung, Worst};
use looselink::newton::Newton;
use looselink::scene::Scene;
use looselink::simulate::{Control, Observer, Onset, Progress, RunError, Simulation};
use looselink::stepper::{
    LocalError, Method, Scheme, backward_euler, dormand_prince, midpoint, trapezoidal,
    velocity_verlet,
};
use looselink::system::{State, System};

/// Three masses in a row, with a damper of a third of the critical damping and more beside every spring.
const DAMPERS: &str = r#"
format = 1
title = "a damped chain"
simulation = { duration = 1.0 }
integrator = { method = "dop853", step = 1e-3 }
output = { interval = 1e-3, channels = ["*"] }
bodies.ground = { type = "ground", points.left = [0.0, 0.0] }
bodies.a = { type = "point_mass", mass = 1.0 }
bodies.b = { type = "point_mass", mass = 2.0 }
bodies.c = { type = "point_mass", mass = 0.5 }
forces.one = { type = "spring_damper", from = "ground.left", to = "a.center", stiffness = 90.0, damping = 6.0, rest_length = 1.0 }
forces.two = { type = "spring_damper", from = "a.center", to = "b.center", stiffness = 40.0, damping = 9.0, rest_length = 1.0 }
forces.three = { type = "spring_damper", from = "b.center", to = "c.center", stiffness = 60.0, damping = 3.0, rest_length = 1.0 }
initial.bodies = { a = { x = 1.1, y = 0.0, vx = 0.0, vy = 0.4 }, b = { x = 2.3, y = 0.1, vx = -0.5, vy = 0.0 }, c = { x = 3.1, y = 0.0 } }
"#;

/// Stops at the first onset.
#[derive(Default)]
struct FirstOnset(bool);

impl Observer for FirstOnset {
    fn row(&mut self, _: &[f64]) -> std::io::Result<()> {
        Ok(())
    }

    fn onset(&mut self, _: &Onset) -> std::io::Result<()> {
        self.0 = true;
        Ok(())
    }

    fn step(&mut self, _: &Progress) -> std::io::Result<Control> {
        Ok(if self.0 {
            Control::Stop
        } else {
            Control::Continue
        })
    }
}

/// A motion, a state of it from which steps are taken, and its time scale \[s\].
struct Motion {
    name: &'static str,
    simulation: Simulation,
    scale: f64,
}

/// The journal of the bouncing scene with a restitution of 0.5, at its first onset. A contact lasts about 80 us.
fn at_the_onset() -> Motion {
    let changes = [
        "contacts.aluminium.restitution=0.5",
        "integrator={ method = \"dop853\", step = 1e-6, onset_tolerance = 1e-17 }",
        "output.interval=1e-6",
        "initial.bodies.journal={ x = 0.0, y = 0.0, theta = 0.0, vx = 0.02, vy = 0.003, omega = 0.0 }",
    ];
    let mut simulation = Simulation::new(&load("bouncing-journal.toml", &changes)).unwrap();
    let ended = simulation.run(&mut FirstOnset::default());
    assert!(matches!(ended, Err(RunError::Interrupted { .. })));
    assert!(simulation.state().memory[0] > 0.0);
    Motion {
        name: "Contact with a restitution of 0.5",
        simulation,
        scale: 1e-5,
    }
}

fn motions() -> [Motion; 3] {
    let mut chain = Simulation::new(&Scene::parse("chain", DAMPERS, &[]).unwrap()).unwrap();
    chain.advance_to(0.05, &mut ()).unwrap();
    let damped = [
        "bodies.rod.kelvin_voigt=0.01",
        "bodies.rod.elements=2",
        "integrator={ method = \"dop853\", step = 1e-4 }",
    ];
    let mut rod = Simulation::new(&load("soft-pendulum.toml", &damped)).unwrap();
    rod.advance_to(0.1, &mut ()).unwrap();
    let mut contact = at_the_onset();
    let inside = contact.simulation.state().t + 2e-5;
    contact.simulation.advance_to(inside, &mut ()).unwrap();
    [
        Motion {
            name: "Viscous dampers",
            simulation: chain,
            scale: 0.02,
        },
        Motion {
            name: "Structural damping",
            simulation: rod,
            scale: 2e-3,
        },
        contact,
    ]
}

impl Motion {
    /// The state after a time h from another one, by DOP853.
    fn exact(&self, from: &State, h: f64) -> State {
        const STEPS: i32 = 40;
        let model = self.simulation.model();
        let mut newton = Newton::new(model, 1e-16);
        let mut work = model.work();
        let (mut from, t) = (from.clone(), from.t);
        newton.make_consistent(model, &mut from, &mut work).unwrap();
        let mut to = from.clone();
        let mut scheme = Method::new(&dormand_prince::ORDER_8).stepper(model.shape());
        for k in 1..=STEPS {
            let t = t + h * f64::from(k) / f64::from(STEPS);
            scheme
                .step(model, &from, t, &mut to, &mut newton, &mut work)
                .unwrap();
            from.copy_from(&to);
        }
        to
    }

    /// Of the last of some steps with these ratios to h: the error of q and v and the error less its estimate, each by its largest
    /// entry.
    fn last_step(&self, method: Method, h: f64, ratios: &[f64]) -> [[f64; 2]; 2] {
        let model = self.simulation.model();
        let n = model.shape().unknowns;
        let mut newton = Newton::new(model, 1e-16);
        let mut work = model.work();
        let mut scheme = method.stepper(model.shape());
        let mut error = LocalError::new(n);
        let mut from = self.simulation.state().clone();
        newton.make_consistent(model, &mut from, &mut work).unwrap();
        let (mut to, mut middle, mut before) = (from.clone(), from.clone(), from.clone());
        for ratio in ratios {
            before.copy_from(&from);
            let t = from.t + ratio * h;
            scheme
                .step(model, &from, t, &mut to, &mut newton, &mut work)
                .unwrap();
            if scheme.needs_midpoint(&from) {
                midpoint(model, &from, &to, &mut middle, &mut newton, &mut work);
            }
            scheme.local_error(&from, &to, &middle, &mut error);
            scheme.accept();
            from.copy_from(&to);
        }
        let truth = self.exact(&before, to.t - before.t);
        let largest = |x: &[f64], y: &[f64], estimate: &[f64], counted: f64| {
            let errors = x.iter().zip(y).zip(estimate);
            let missed = errors.map(|((x, y), e)| (x - y - counted * e).abs());
            missed.fold(0.0, f64::max)
        };
        [0.0, 1.0].map(|counted| {
            [
                largest(&truth.q[..n], &to.q, &error.q, counted),
                largest(&truth.v[..n], &to.v, &error.v, counted),
            ]
        })
    }
}

/// The schemes that estimate their errors from accelerations of earlier steps and have no memory of their own.
const SCHEMES: [(&Scheme, &str); 3] = [
    (&velocity_verlet::SCHEME, "velocity Verlet"),
    (&trapezoidal::SCHEME, "the trapezoidal rule"),
    (&backward_euler::SCHEME, "the backward Euler rule"),
];

/// The error over its estimate tends to one, from the first step of a motion on, and with steps that change.
#[test]
fn local_errors_of_damped_motions_are_estimated() {
    let motions = motions();
    for (scheme, name) in SCHEMES {
        let missed = [0.02, 0.01, 0.005].map(|h| {
            let worst = Worst::new();
            for motion in &motions {
                for ratios in [&[1.0] as &[f64], &[1.0, 1.0], &[1.0, 0.6, 0.9, 0.5, 1.0]] {
                    let found = motion.last_step(Method::new(scheme), h * motion.scale, ratios);
                    worst.at(format!("{}, steps {ratios:?}", motion.name));
                    let [error, missed] = found;
                    (0..2).for_each(|level| worst.see(missed[level] / error[level]));
                }
            }
            (h, worst)
        });
        let falling = missed.each_ref().map(|(h, worst)| (*h, worst.value()));
        Rung::OrderInTime
            .asks(format!(
                "{name}, dampers, structural damping and a contact with a restitution of 0.5: what the estimate of a local error misses, relative to the error"
            ))
            .falls("Step over the time scale of the motion", &falling, 0.8..1.2, "the estimate is right to leading order");
        Rung::OrderInTime
            .asks(format!(
                "{name}, the same with steps of 1/50 of the time scale"
            ))
            .within(
                &missed[0].1,
                0.05,
                "the next term, of a few times the step over the time scale",
            );
    }
}

/// After an onset the acceleration grows as t^1.5. With the acceleration in the middle of the step the error of velocity is estimated as
/// 0.0976 h a_1, and that of position, by velocity Verlet, as 0.1179 h^2 a_1. They are 1/10 and 4/35.
#[test]
fn local_errors_after_an_onset_are_estimated() {
    let motion = at_the_onset();
    let worst = Worst::new();
    for (scheme, name) in SCHEMES {
        for h in [0.02, 0.01] {
            let found = motion.last_step(Method::new(scheme), h * motion.scale, &[1.0]);
            let [error, missed] = found;
            worst.at(format!("velocity, {name}"));
            worst.see(missed[1] / error[1]);
            if scheme.is_explicit {
                worst.at(format!("position, {name}"));
                worst.see(missed[0] / error[0]);
            }
        }
    }
    Rung::OrderInTime
        .asks("First step after an onset, restitution 0.5: what the estimate of a local error misses, relative to the error")
        .within(&worst, 0.035, "0.0976 for 1/10, 0.1179 for 4/35, and the next term");
}

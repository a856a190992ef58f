//! An integration scheme from outside the library: `cargo run --release --example own_integrator`.

use looselink::checkpoint::{Carried, Checkpoint};
use looselink::stepper::{Estimate, EstimatedSolution, LocalError, Scheme, StepError, Stepper};
use looselink::system::{State, System, Work};
use looselink::{newton::Newton, registry::Registry, scene::Scene, simulate::Simulation};

/// The symplectic Euler method: v_1 = v + h a, q_1 = q + h v_1.
#[derive(Debug)]
struct SymplecticEuler;

impl Carried for SymplecticEuler {
    /// Nothing that a checkpoint has to hold: each step depends on its start alone.
    fn carry(&mut self, _: &mut Checkpoint) {}
}

#[rustfmt::skip]
impl Stepper for SymplecticEuler {
    fn step(&mut self, system: &dyn System, from: &State, t: f64, to: &mut State, newton: &mut Newton, work: &mut Work)
        -> Result<usize, StepError> {
        let h = t - from.t;
        to.copy_from(from);
        to.t = t;
        system.prescribe(from, to, work)?;
        for i in 0..system.shape().unknowns {
            to.v[i] = from.v[i] + h * from.a[i];
            to.q[i] = from.q[i] + h * to.v[i];
        }
        newton.accelerate(system, to, work)?;
        Ok(system.powers(to, work))
    }

    fn estimate(&self) -> Estimate { Estimate { order: 2.0, of: EstimatedSolution::Solution, implicit: false } }

    /// The step of the trapezoidal rule minus this step, to leading order.
    fn local_error(&self, from: &State, to: &State, _: &State, error: &mut LocalError) {
        let h = to.t - from.t;
        for (i, (q, v)) in error.q.iter_mut().zip(&mut error.v).enumerate() {
            (*q, *v) = (-0.5 * h * h * from.a[i], 0.5 * h * (to.a[i] - from.a[i]));
        }
    }
}

/// As a scene names it.
#[rustfmt::skip]
pub static SCHEME: Scheme = Scheme {
    name: "symplectic_euler", order: 1, parameters: &[], is_explicit: true, keeps_constraints: false,
    build: |_, _| Box::new(SymplecticEuler),
};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let method = [r#"integrator={method="symplectic_euler",step=1e-5}"#.to_owned()];
    let registry = Registry::standard().with_scheme(&SCHEME);
    let scene = Scene::load_with(&registry, "scenes/soft-pendulum.toml".as_ref(), &method)?;
    let mut simulation = Simulation::new(&scene)?;
    simulation.run(&mut ())?;
    println!("{:#?}", simulation.report().ledger);
    Ok(())
}

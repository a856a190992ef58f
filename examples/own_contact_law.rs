//! A normal contact law from outside the library: `cargo run --release --example own_contact_law`.

use looselink::contact::normal::{DampedPower, NormalLawKind};
use looselink::registry::Registry;
use looselink::scene::Scene;
use looselink::simulate::{Recording, Simulation};
use std::error::Error;

/// Hu and Guo 2015, Multibody Syst. Dyn. 35:131: chi = 3 (1 - c_e)/(2 c_e).
pub static LAW: NormalLawKind = NormalLawKind {
    name: "hu_guo",
    is_damped: true,
    keys: &[],
    build: |p| {
        Box::new(DampedPower {
            stiffness: p.stiffness,
            exponent: p.exponent,
            damping: 1.5 * (1.0 - p.restitution) / p.restitution,
            impact_velocity_floor: p.impact_velocity_floor,
        })
    },
};

fn main() -> Result<(), Box<dyn Error>> {
    let registry = Registry::standard().with_law(&LAW);
    let overrides = ["contacts.aluminium.law=hu_guo".to_owned()];
    let scene = "scenes/bouncing-journal.toml".as_ref();
    let scene = Scene::load_with(&registry, scene, &overrides)?;
    let mut simulation = Simulation::new(&scene)?;
    let mut recording = Recording::new(&simulation);
    simulation.run(&mut recording)?;
    for impact in &recording.onsets {
        if let Some(exit_velocity) = impact.exit_velocity {
            println!("restitution {:.3}", exit_velocity / impact.impact_velocity);
        }
    }
    Ok(())
}

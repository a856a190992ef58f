//! An observer from outside the library: it keeps no rows, and stops the run after twenty contacts.
//! `cargo run --release --example own_observer` prints the hardest impacts of the joints of a slider-crank.

use looselink::scene::Scene;
use looselink::simulate::{ContactEvent, Control, Observer, Progress, RunError, Simulation};
use std::collections::BTreeMap;
use std::io::Result;

/// Statistics of the contacts that have ended.
#[derive(Debug, Default)]
pub struct HardestImpacts {
    /// The largest velocity of approach of each joint \[m/s\].
    pub by_joint: BTreeMap<String, f64>,
    /// The number of contacts that have ended.
    pub contacts: usize,
}

impl Observer for HardestImpacts {
    /// The channels of the scene, at every output interval.
    fn row(&mut self, _values: &[f64]) -> Result<()> {
        Ok(())
    }

    fn contact(&mut self, contact: &ContactEvent) -> Result<()> {
        let onset = contact.onset;
        let hardest = self.by_joint.entry(onset.joint.to_owned()).or_default();
        *hardest = hardest.max(onset.impact_velocity);
        self.contacts += 1;
        Ok(())
    }

    fn step(&mut self, _progress: &Progress) -> Result<Control> {
        Ok(match self.contacts {
            ..20 => Control::Continue,
            _ => Control::Stop,
        })
    }
}

fn main() -> std::result::Result<(), Box<dyn std::error::Error>> {
    let scene = Scene::load("scenes/slider-crank/loose.toml".as_ref(), &[])?;
    let mut hardest = HardestImpacts::default();
    match Simulation::new(&scene)?.run(&mut hardest) {
        Ok(()) => {}
        Err(RunError::Interrupted { t }) => println!("stopped at {t:.6} s"),
        Err(error) => return Err(error.into()),
    }
    for (joint, velocity) in &hardest.by_joint {
        println!("{joint}: {velocity:.4} m/s");
    }
    Ok(())
}

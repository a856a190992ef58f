//! A force from outside the library: a pendulum swings in water, which drags by the square of the speed.
//! `cargo run --release --example own_interaction` prints the work of the water.

use looselink::document::Key;
use looselink::effect::Effect;
use looselink::interaction::{ForceKind, PointLaw, PointLoad};
use looselink::math::plane::Vec2;
use looselink::{registry::Registry, scene::Scene, simulate::Simulation};
use std::sync::Arc;

/// The force as a scene names it.
pub static DRAG: ForceKind = ForceKind {
    name: "drag",
    keys: &[
        Key::point("point", "where it acts"),
        Key::positive("coefficient", "N s2/m2", "force by squared speed"),
    ],
    read: |table, names| {
        let point = names.point(&table.field("point")?)?;
        let law = Arc::new(Drag(table.number("coefficient")?));
        Ok(Arc::new(PointLoad { point, law }))
    },
};

/// F = -c |v| v. Its derivatives are finite differences, unless the law has a method `gradient` that returns them.
#[derive(Debug)]
struct Drag(f64);

impl PointLaw for Drag {
    fn effect(&self) -> Effect {
        "drag"
    }

    fn force(&self, _t: f64, _r: Vec2, v: Vec2) -> Vec2 {
        -self.0 * v.norm() * v
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let registry = Registry::standard().with_force(&DRAG);
    let water = r#"forces={water={type="drag",point="rod.bob",coefficient=0.5}}"#;
    let scene = "scenes/pendulum.toml".as_ref();
    let scene = Scene::load_with(&registry, scene, &[water.to_owned()])?;
    let mut simulation = Simulation::new(&scene)?;
    simulation.run(&mut ())?;
    let ledger = simulation.report().ledger.expect("a dynamic analysis");
    println!("work of the water: {:.3} J", ledger.work);
    Ok(())
}

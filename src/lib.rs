//! Elastodynamics of planar mechanisms with flexible links and joint clearance.
//!
//! A scene describes a mechanism; [`simulate::Simulation`] compiles and runs it; an [`simulate::Observer`] receives rows of
//! named channels as they come. This example runs the 3-RRR mechanism with rigid links and joint clearance for twelve
//! milliseconds:
//!
//! ```
//! use looselink::scene::Scene;
//! use looselink::simulate::{Control, Observer, Onset, Progress, Simulation};
//! use std::io::Result;
//!
//! struct Print;
//! impl Observer for Print {
//!     fn row(&mut self, values: &[f64]) -> Result<()> {
//!         Ok(println!("{values:?}"))
//!     }
//!     fn onset(&mut self, o: &Onset) -> Result<()> {
//!         Ok(println!("{} closes at {} s with {} m/s", o.joint, o.t, o.impact_velocity))
//!     }
//!     fn step(&mut self, _: &Progress) -> Result<Control> {
//!         Ok(Control::Continue)
//!     }
//! }
//!
//! let overrides = ["simulation.duration=0.012".into(), "output.interval=0.004".into()];
//! let scene = Scene::load("scenes/3rrr/case3.toml".as_ref(), &overrides)?;
//! let mut simulation = Simulation::new(&scene)?;
//! assert_eq!(simulation.inspect().unknowns, 12);
//! simulation.run(&mut Print)?;
//! assert!(simulation.report().onsets > 10);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! [`simulate::Recording`] is an observer that keeps everything in memory.
//!
//! # User-defined kinds
//!
//! A [`registry::Registry`] holds the kinds of laws, forces, joints and methods that a scene can name. A program can add kinds of
//! its own and read scenes with
//! [`scene::Scene::load_with`]:
//!
//! | what | trait | example |
//! |---|---|---|
//! | normal contact law | [`contact::normal::NormalLaw`], or a factor for [`contact::normal::DampedPower`] | `examples/own_contact_law.rs` |
//! | force on a point | [`interaction::PointLaw`] | `examples/own_interaction.rs` |
//! | any other force, joint, body | [`interaction::ForceModel`], [`interaction::JointModel`], [`body::Body`] | |
//! | integration scheme | [`stepper::Stepper`] | `examples/own_integrator.rs` |
//! | function of time | [`motion::FunctionOfTime`] | |
//! | format of tables | [`table::Format`] | |
//! | receiver of results | [`simulate::Observer`] | `examples/own_observer.rs` |
//!
//! EQUATIONS.md maps the equations of the paper
//! to functions; ARCHITECTURE.md maps the mechanics to folders.
#![forbid(unsafe_code)]

pub mod body;
pub mod checkpoint;
pub mod compile;
pub mod constraint;
pub mod contact;
pub mod document;
mod eccentric_mass;
pub mod effect;
pub mod force;
pub mod initial;
pub mod interaction;
pub mod kinematics;
pub mod ledger;
pub mod link;
pub mod marker;
pub mod math;
pub mod model;
pub mod modes;
pub mod motion;
pub mod newton;
pub mod output;
pub mod record;
pub mod registry;
pub mod scene;
pub mod simulate;
pub mod stepper;
pub mod system;
pub mod table;
pub mod terms;

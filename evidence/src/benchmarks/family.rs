//! Mechanisms of any size.

use crate::benchmarks::growth::{STEP, STEPS};
use clap::ValueEnum;
use minijinja::render;
use serde::{Deserialize, Serialize};

/// A kind of mechanism whose number of bodies can grow.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, ValueEnum)]
#[serde(rename_all = "kebab-case")]
pub enum Family {
    /// A hanging chain of rigid bodies with ideal joints.
    Chain,
    /// The same with play in every joint.
    LooseChain,
    /// Cranks beside each other, each with a drive, two rods and two sliders.
    SliderCranks,
    /// Parallelograms beside each other, each with a redundant bar.
    Parallelograms,
}

impl Family {
    /// All of them.
    pub const ALL: [Family; 4] = [
        Family::Chain,
        Family::LooseChain,
        Family::SliderCranks,
        Family::Parallelograms,
    ];

    /// Its name in words.
    pub fn name(self) -> &'static str {
        match self {
            Family::Chain => "chain, ideal",
            Family::LooseChain => "chain with play",
            Family::SliderCranks => "driven slider-cranks",
            Family::Parallelograms => "parallelograms with redundant bars",
        }
    }

    /// A scene with this number of bodies, a multiple of 20.
    pub fn scene(self, bodies: usize) -> String {
        render!(
            include_str!("../../templates/families.toml"),
            name => self.name(), family => self, bodies, step => STEP, duration => STEP * STEPS as f64
        )
    }
}

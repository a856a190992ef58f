//! Numbers from which every choice of a scene is made.

use looselink::math::plane::{Vec2, unit};
use proptest::collection::vec;
use proptest::strategy::Strategy;
use std::f64::consts::TAU;

/// Numbers of a scene.
const GENES: usize = 800;

/// Numbers in [0, 1). Zero is the plainest choice everywhere, so that a failing scene shrinks towards a plain one.
pub fn genes() -> impl Strategy<Value = Vec<f64>> {
    vec(0.0..1.0_f64, GENES)
}

/// Reads genes one after the other.
pub struct Tape<'a>(pub &'a [f64]);

impl<'a> Tape<'a> {
    /// The next `count` genes, for a decision that may read fewer: those of the next decision stay where they are.
    pub fn part(&mut self, count: usize) -> Tape<'a> {
        let (part, rest) = self.0.split_at(count);
        self.0 = rest;
        Tape(part)
    }

    /// True with this probability.
    pub fn chance(&mut self, probability: f64) -> bool {
        self.between(0.0, 1.0) >= 1.0 - probability
    }

    /// Between two numbers.
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        let (first, rest) = self.0.split_first().expect("there are genes enough");
        self.0 = rest;
        low + (high - low) * first
    }

    /// Between two powers of ten.
    pub fn decades(&mut self, low: f64, high: f64) -> f64 {
        10.0_f64.powf(self.between(low, high))
    }

    /// A whole number from `low` to `high`, both included.
    pub fn whole(&mut self, low: usize, high: usize) -> usize {
        low + self.between(0.0, (high - low + 1) as f64) as usize
    }

    /// One of these; the first is the plainest.
    pub fn pick<T: Copy>(&mut self, choices: &[T]) -> T {
        choices[self.whole(0, choices.len() - 1)]
    }

    /// -1 or 1 times a number between two powers of ten.
    pub fn signed_decades(&mut self, low: f64, high: f64) -> f64 {
        let sign = if self.chance(0.5) { -1.0 } else { 1.0 };
        sign * self.decades(low, high)
    }

    /// An angle \[rad\].
    pub fn angle(&mut self) -> f64 {
        self.between(0.0, TAU)
    }

    /// A vector of any direction with a length between two powers of ten.
    pub fn vector(&mut self, low: f64, high: f64) -> Vec2 {
        unit(self.angle()) * self.decades(low, high)
    }
}

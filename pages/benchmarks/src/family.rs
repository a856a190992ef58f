//! Mechanisms of any size.

use crate::growth::{STEP, STEPS};
use clap::ValueEnum;
use serde::{Deserialize, Serialize};
use std::fmt::Write;

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
        let duration = STEP * STEPS as f64;
        let mut text = format!(
            r#"format = 1
title = "{}"
simulation = {{ duration = {duration}, gravity = [0.0, -9.81] }}
integrator = {{ method = "bathe", step = {STEP}, newton_tolerance = 1e-10, onset_tolerance = 1e-12 }}
output = {{ interval = {duration}, channels = ["energy.*"] }}
materials.steel = {{ density = 7850.0, youngs_modulus = 2e11, poissons_ratio = 0.3 }}
sections.bar = {{ width = 0.01, height = 0.01 }}
contacts.pin = {{ law = "lankarani_nikravesh", bearing_radius = 0.01, clearance = 1e-5, bearing_material = "steel", journal_material = "steel", exponent = 1.5, restitution = 0.9, impact_velocity_floor = 1e-6 }}
bodies.ground.type = "ground"
"#,
            self.name()
        );
        let ideal = r#"model = "ideal""#;
        match self {
            Family::Chain => chain(&mut text, bodies, ideal),
            Family::LooseChain => {
                chain(&mut text, bodies, r#"model = "clearance", contact = "pin""#)
            }
            Family::SliderCranks => (0..bodies / 5).for_each(|k| slider_crank(&mut text, k)),
            Family::Parallelograms => (0..bodies / 4).for_each(|k| parallelogram(&mut text, k)),
        }
        text
    }
}

/// Adds lines to a text.
macro_rules! add {
    ($text:expr, $($line:tt)*) => {
        writeln!($text, $($line)*).expect("a string takes any text")
    };
}

/// A chain that starts horizontally, at rest.
fn chain(text: &mut String, links: usize, model: &str) {
    add!(text, "bodies.ground.points.O = [0.0, 0.0]");
    for k in 0..links {
        let bearing = match k {
            0 => "ground.O".to_owned(),
            _ => format!("link{}.b", k - 1),
        };
        add!(
            text,
            r#"bodies.link{k} = {{ type = "rigid_body", mass = 0.1, inertia = 1e-4, points.a = [-0.05, 0.0], points.b = [0.05, 0.0] }}
joints.j{k} = {{ type = "revolute", bearing = "{bearing}", journal = "link{k}.a", {model} }}
initial.bodies.link{k} = {{ x = {}, y = 0.0, theta = 0.0 }}"#,
            0.05 + 0.1 * k as f64
        );
    }
}

/// A crank of 0.05 m with two rods of 0.12 m to sliders on opposite sides, all in one line at the start.
fn slider_crank(text: &mut String, k: usize) {
    let y = k as f64;
    add!(
        text,
        r#"bodies.ground.points.O{k} = [0.0, {y}]
bodies.crank{k} = {{ type = "link", model = "rigid", length = 0.05, section = "bar", material = "steel" }}
joints.main{k} = {{ type = "revolute", bearing = "ground.O{k}", journal = "crank{k}.start", model = "ideal" }}
drives.motor{k} = {{ type = "angle", joint = "main{k}", angle = {{ type = "polynomial", coefficients = [0.0, 500.0] }} }}"#
    );
    for (side, slider) in [("_left", -0.07), ("_right", 0.17)] {
        add!(
            text,
            r#"bodies.rod{k}{side} = {{ type = "rigid_body", mass = 0.21, inertia = 2.5e-4, points.a = [-0.06, 0.0], points.b = [0.06, 0.0] }}
bodies.slider{k}{side} = {{ type = "rigid_body", mass = 0.14, inertia = 1e-5, points.pin = [0.0, 0.0] }}
joints.crank_pin{k}{side} = {{ type = "revolute", bearing = "crank{k}.end", journal = "rod{k}{side}.a", model = "ideal" }}
joints.slider_pin{k}{side} = {{ type = "revolute", bearing = "slider{k}{side}.pin", journal = "rod{k}{side}.b", model = "ideal" }}
joints.guide{k}{side} = {{ type = "prismatic", guide = "ground.O{k}", direction = [1.0, 0.0], slider = "slider{k}{side}.pin", rotation = "locked" }}
initial.sketch.crank_pin{k}{side} = [0.05, {y}]
initial.sketch.slider_pin{k}{side} = [{slider}, {y}]
initial.bodies.slider{k}{side} = {{ x = {slider}, y = {y}, theta = 0.0 }}"#
        );
    }
}

/// A coupler on three parallel cranks of 0.1 m, at rest.
fn parallelogram(text: &mut String, k: usize) {
    let y = k as f64;
    add!(
        text,
        r#"bodies.coupler{k} = {{ type = "rigid_body", mass = 1.0, inertia = 0.01, points.p0 = [-0.2, 0.0], points.p1 = [0.0, 0.0], points.p2 = [0.2, 0.0] }}"#
    );
    for crank in 0..3 {
        let x = 0.2 * crank as f64;
        add!(
            text,
            r#"bodies.ground.points.g{k}x{crank} = [{x}, {y}]
bodies.crank{k}x{crank} = {{ type = "link", model = "rigid", length = 0.1, section = "bar", material = "steel" }}
joints.main{k}x{crank} = {{ type = "revolute", bearing = "ground.g{k}x{crank}", journal = "crank{k}x{crank}.start", model = "ideal" }}
joints.pin{k}x{crank} = {{ type = "revolute", bearing = "crank{k}x{crank}.end", journal = "coupler{k}.p{crank}", model = "ideal" }}
initial.sketch.pin{k}x{crank} = [{}, {}]"#,
            x + 0.06,
            y + 0.08
        );
    }
}

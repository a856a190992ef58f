//! Variants of a case: its mesh, and starts that a tiny displacement tells apart.

use crate::kinematics::MechanismGeometry;
use std::f64::consts::TAU;

/// Starts of every ensemble.
pub const STARTS: usize = 16;
/// Displacement of the platform between the starts of an ensemble \[m\].
pub const MOVED: f64 = 1e-12;

/// Overrides for so many elements a link.
pub fn mesh(elements: usize) -> Vec<String> {
    let of = |i| format!("bodies.link{i}.elements={elements}");
    (1..=3).map(of).collect()
}

/// So many elements a link in words.
pub fn mesh_name(elements: usize) -> String {
    format!("{elements} elements a link")
}

/// The start of case 3 or 4 with the platform moved by `moved` \[m\], in one of [`STARTS`] directions.
///
/// The velocity is that of the ideal mechanism, which the scene has without this override.
pub fn moved(g: &MechanismGeometry, moved: f64, start: usize) -> String {
    let (sin, cos) = (TAU * start as f64 / STARTS as f64).sin_cos();
    let [x, y, theta] = g.pose(0.0);
    let speed = TAU * g.frequency * g.radius;
    format!(
        "initial.bodies={{ platform = {{ x = {:?}, y = {:?}, theta = {theta:?}, vx = 0.0, vy = {speed:?}, omega = 0.0 }} }}",
        x + moved * cos,
        y + moved * sin
    )
}

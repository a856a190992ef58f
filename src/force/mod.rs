//! Forces between bodies.

mod clearance_joint;
mod friction;

pub use clearance_joint::{ClearanceJoint, Geometry};
pub use friction::FrictionalJoint;

/// Most coordinates that one joint can depend on: a node, and another node that fixes its spin, on both sides.
pub const WIDTH: usize = 8;

/// A square block in the local coordinates of a joint.
pub type LocalMatrix = [[f64; WIDTH]; WIDTH];

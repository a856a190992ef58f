//! The effects that a run counts, by their names in reports. A term declares its own.

/// The name of an effect.
pub type Effect = &'static str;

/// Elastic force of an ANCF element.
pub const ELASTIC: Effect = "ancf_elastic_force";
/// Normal contact law.
pub const CONTACT: Effect = "contact_law";
/// Friction law.
pub const FRICTION: Effect = "friction_law";
/// Weight.
pub const GRAVITY: Effect = "gravity";
/// Inverse kinematics of the ideal rigid mechanism.
pub const INVERSE_KINEMATICS: Effect = "inverse_kinematics";

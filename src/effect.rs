//! The effects that a run counts.

/// Indices into [`crate::system::Work::tally`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Effect {
    /// Elastic force of an ANCF element.
    Elastic = 0,
    /// Length of a rigid link.
    Length = 1,
    /// Ideal joint as a constraint.
    Coincidence = 2,
    /// Normal contact law.
    Contact = 3,
    /// Friction law.
    Friction = 4,
    /// Weight.
    Gravity = 5,
    /// Inverse kinematics of the ideal rigid mechanism.
    InverseKinematics = 6,
    /// Prescribed relative angle or held slope: welds, guides that do not turn, driven joints.
    Direction = 7,
    /// Point on a line.
    Slide = 8,
    /// Prescribed coordinate of a point.
    Place = 9,
    /// Translational spring-damper.
    SpringDamper = 10,
    /// Torsional spring-damper.
    TorsionSpring = 11,
    /// Applied force.
    PointForce = 12,
    /// Applied torque.
    Torque = 13,
    /// Kelvin-Voigt damping of an element.
    ElementDamping = 14,
    /// Damping proportional to mass.
    MassDamping = 15,
}

impl Effect {
    /// All effects, with their names in reports.
    pub const ALL: [(Effect, &'static str); 16] = [
        (Effect::Elastic, "ancf_elastic_force"),
        (Effect::Length, "length_constraint"),
        (Effect::Coincidence, "ideal_joint_constraint"),
        (Effect::Contact, "contact_law"),
        (Effect::Friction, "friction_law"),
        (Effect::Gravity, "gravity"),
        (Effect::InverseKinematics, "inverse_kinematics"),
        (Effect::Direction, "direction_constraint"),
        (Effect::Slide, "sliding_constraint"),
        (Effect::Place, "prescribed_coordinate"),
        (Effect::SpringDamper, "spring_damper"),
        (Effect::TorsionSpring, "torsion_spring"),
        (Effect::PointForce, "applied_force"),
        (Effect::Torque, "applied_torque"),
        (Effect::ElementDamping, "element_damping"),
        (Effect::MassDamping, "mass_damping"),
    ];
}

//! The reference implementation as a Rust library: owned values, typed errors.

use crate::ffi::{self, ErrorRecord};
pub use ffi::{
    Body, Contact, Elastic, Function, Joint, Leg, Load, Mechanism, Motion, Path, Point, Row,
    Spring, Statistics, Tolerances, TorsionSpring,
};

/// Kinds of `ls_body`.
pub mod body_kind {
    pub const GROUND: i32 = 0;
    pub const RIGID_LINK: i32 = 1;
    pub const FLEXIBLE_LINK: i32 = 2;
    pub const RIGID_BODY: i32 = 3;
    pub const POINT_MASS: i32 = 4;
    pub const MOVING_BODY: i32 = 5;
}

/// Kinds of `ls_joint`.
pub mod joint_kind {
    pub const REVOLUTE: i32 = 0;
    pub const PRISMATIC: i32 = 1;
    pub const WELD: i32 = 2;
}

/// Kinds of `ls_function`.
pub mod function_kind {
    pub const POLYNOMIAL: i32 = 0;
    pub const HARMONIC: i32 = 1;
    pub const RAMP: i32 = 2;
    pub const SMOOTH_STEP: i32 = 3;
    pub const SPIN_UP: i32 = 4;
}

/// Kinds of `ls_load`.
pub mod load_kind {
    pub const DEAD_FORCE: i32 = 0;
    pub const FOLLOWER_FORCE: i32 = 1;
    pub const TORQUE: i32 = 2;
}

/// Kinds of `ls_motion`.
pub mod motion_kind {
    pub const ANGLE: i32 = 0;
    pub const COORDINATE: i32 = 1;
}

/// What the reference implementation reports when it cannot go on.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum Error {
    /// The description makes no sense.
    #[error("the reference refuses the mechanism: {0}")]
    BadInput(String),
    /// The path leaves what the legs can reach.
    #[error("the reference cannot follow the path: {message} at t = {t} s")]
    Unreachable {
        /// Names the leg.
        message: String,
        /// When \[s\].
        t: f64,
    },
    /// The integrator failed.
    #[error("IDA fails with flag {flag} at t = {t} s: {message}")]
    Ida {
        /// IDA's return value.
        flag: i32,
        /// IDA's own message.
        message: String,
        /// When \[s\].
        t: f64,
    },
    /// A value is not finite.
    #[error("the reference meets a value that is not finite: {message} at t = {t} s")]
    NotFinite {
        /// Names the value.
        message: String,
        /// When \[s\].
        t: f64,
    },
    /// Anything else.
    #[error("the reference fails: {0}")]
    Internal(String),
}

impl From<Box<ErrorRecord>> for Error {
    fn from(record: Box<ErrorRecord>) -> Error {
        let (message, t) = (record.message(), record.time);
        match record.code {
            1 => Error::BadInput(message),
            2 => Error::Unreachable { message, t },
            3 => Error::Ida {
                flag: record.flag,
                message,
                t,
            },
            4 => Error::NotFinite { message, t },
            _ => Error::Internal(message),
        }
    }
}

/// Versions of the libraries the reference stands on.
pub fn versions() -> String {
    format!(
        "Eigen {}, SUNDIALS {}",
        env!("EIGEN_VERSION"),
        ffi::sundials_version()
    )
}

/// Mass matrix of an element of this mass \[kg\] and length \[m\], row by row.
///
/// # Errors
/// See [`Error`].
pub fn element_mass(mass: f64, length: f64) -> Result<[f64; 64], Error> {
    Ok(ffi::element_mass(mass, length)?)
}

/// Elastic energy, force and tangent of an element; `stiffness` is EA \[N\] and EI \[N m2\].
///
/// # Errors
/// See [`Error`].
pub fn element_elastic(stiffness: [f64; 2], length: f64, q: &[f64; 8]) -> Result<Elastic, Error> {
    Ok(ffi::element_elastic(stiffness, length, q)?)
}

/// K of a contact \[N/m^n\].
///
/// # Errors
/// See [`Error`].
pub fn contact_stiffness(contact: &Contact) -> Result<f64, Error> {
    Ok(ffi::contact_stiffness(contact)?)
}

/// Normal force with its derivatives by penetration and rate, and whether it is clamped.
///
/// # Errors
/// See [`Error`].
pub fn contact_normal(
    contact: &Contact,
    delta: f64,
    rate: f64,
    impact_velocity: f64,
) -> Result<([f64; 3], bool), Error> {
    Ok(ffi::contact_normal(contact, delta, rate, impact_velocity)?)
}

/// Friction force along the direction of slip with its derivatives by slip and normal force.
///
/// # Errors
/// See [`Error`].
pub fn contact_friction(contact: &Contact, slip: f64, normal: f64) -> Result<[f64; 3], Error> {
    Ok(ffi::contact_friction(contact, slip, normal)?)
}

/// An assembled mechanism; matrices are row by row.
#[derive(Debug)]
pub struct System(ffi::System);

/// f, df/dq and df/dv.
#[derive(Debug)]
pub struct Force {
    pub value: Vec<f64>,
    pub by_q: Vec<f64>,
    pub by_v: Vec<f64>,
}

/// Phi, Phi_q and Phi_t.
#[derive(Debug)]
pub struct ConstraintRows {
    pub phi: Vec<f64>,
    pub phi_q: Vec<f64>,
    pub phi_t: Vec<f64>,
}

impl System {
    /// Assembles a mechanism.
    ///
    /// # Errors
    /// See [`Error`].
    pub fn new(mechanism: &Mechanism) -> Result<System, Error> {
        Ok(System(ffi::System::new(mechanism)?))
    }

    /// Coordinates: every body has its own.
    pub fn coordinates(&self) -> usize {
        self.0.n
    }

    /// Constraints: every length, ideal joint and crank.
    pub fn constraints(&self) -> usize {
        self.0.m
    }

    /// Angle \[rad\], rate and acceleration of every crank.
    ///
    /// # Errors
    /// See [`Error`].
    pub fn cranks(&self, t: f64) -> Result<Vec<[f64; 3]>, Error> {
        Ok(self.0.cranks(t)?)
    }

    /// Positions and velocities of the ideal mechanism.
    ///
    /// # Errors
    /// See [`Error`].
    pub fn start(&self, t: f64) -> Result<(Vec<f64>, Vec<f64>), Error> {
        Ok(self.0.start(t)?)
    }

    /// M.
    ///
    /// # Errors
    /// See [`Error`].
    pub fn mass(&self, q: &[f64]) -> Result<Vec<f64>, Error> {
        Ok(self.0.mass(q)?)
    }

    /// f with its derivatives; `z` is the impact velocity of every joint, 0 where open or ideal.
    ///
    /// # Errors
    /// See [`Error`].
    pub fn force(&self, t: f64, q: &[f64], v: &[f64], z: &[f64]) -> Result<Force, Error> {
        let [value, by_q, by_v] = self.0.force(t, q, v, z)?;
        Ok(Force { value, by_q, by_v })
    }

    /// Constraints with their derivatives.
    ///
    /// # Errors
    /// See [`Error`].
    pub fn constraint_rows(&self, t: f64, q: &[f64]) -> Result<ConstraintRows, Error> {
        let [phi, phi_q, phi_t] = self.0.constraint_rows(t, q)?;
        Ok(ConstraintRows { phi, phi_q, phi_t })
    }

    /// Starts a run at (t, q, v) with all contacts open.
    ///
    /// # Errors
    /// See [`Error`].
    pub fn run(&self, t: f64, q: &[f64], v: &[f64], tolerances: &Tolerances) -> Result<Run, Error> {
        Ok(Run(ffi::Run::new(&self.0, t, q, v, tolerances)?))
    }
}

/// A contact that closes or opens.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Event {
    /// When \[s\].
    pub t: f64,
    /// Index of the joint.
    pub joint: usize,
    /// True for an onset.
    pub onset: bool,
    /// Rate of the penetration \[m/s\].
    pub velocity: f64,
    /// Journal less bearing \[m\].
    pub eccentricity: [f64; 2],
    /// Of a loss the largest penetration since the onset \[m\].
    pub deepest: f64,
}

/// A run of IDA under way.
#[derive(Debug)]
pub struct Run(ffi::Run);

impl Run {
    /// Integrates to `t` and describes the state there.
    ///
    /// # Errors
    /// See [`Error`]; after one the run is dead.
    pub fn advance(&mut self, t: f64, row: &mut Row) -> Result<(), Error> {
        Ok(self.0.advance(t, row)?)
    }

    /// Events from the one with index `first` on.
    pub fn events(&self, first: usize) -> Vec<Event> {
        let events = self.0.events(first).into_iter();
        events
            .map(|e| Event {
                t: e.time,
                joint: usize::try_from(e.joint).expect("indices are not negative"),
                onset: e.onset != 0,
                velocity: e.velocity,
                eccentricity: [e.eccentricity_x, e.eccentricity_y],
                deepest: e.deepest,
            })
            .collect()
    }

    /// Counts so far.
    pub fn statistics(&self) -> Statistics {
        self.0.statistics()
    }
}

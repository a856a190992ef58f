//! The C interface of the reference implementation, `reference-cpp/include/reference.h`, and everything that is unsafe.
//!
//! Structs mirror the header field by field. The functions below take slices whose lengths they check, and turn the
//! library's error records into [`ErrorRecord`]s; [`crate::reference`] gives them a shape that Rust is used to.

use std::ffi::{CStr, c_char};
use std::ptr::{NonNull, null_mut};

/// `ls_error`
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct ErrorRecord {
    pub code: i32,
    pub flag: i32,
    pub time: f64,
    message: [c_char; 496],
}

impl ErrorRecord {
    fn blank() -> ErrorRecord {
        ErrorRecord {
            code: 0,
            flag: 0,
            time: 0.0,
            message: [0; 496],
        }
    }

    /// The text up to its zero byte.
    pub fn message(&self) -> String {
        let bytes = self.message.map(|c| c as u8);
        let end = bytes.iter().position(|&b| b == 0).unwrap_or(bytes.len());
        String::from_utf8_lossy(&bytes[..end]).into_owned()
    }
}

/// `ls_body`
#[repr(C)]
#[derive(Debug, Clone, Copy, Default)]
pub struct Body {
    pub kind: i32,
    pub elements: i32,
    pub length: f64,
    pub width: f64,
    pub height: f64,
    pub density: f64,
    pub youngs_modulus: f64,
    pub plate_circumradius: f64,
    pub plate_thickness: f64,
    pub mass: f64,
    pub inertia: f64,
    pub strain_damping: f64,
    pub mass_damping: f64,
    pub function: i32,
    pub reserved: i32,
}

/// `ls_function`
#[repr(C)]
#[derive(Debug, Clone, Copy, Default)]
pub struct Function {
    pub kind: i32,
    pub reserved: i32,
    pub c: [f64; 6],
}

/// `ls_point`
#[repr(C)]
#[derive(Debug, Clone, Copy, Default)]
pub struct Point {
    pub body: i32,
    pub reserved: i32,
    pub x: f64,
    pub y: f64,
}

/// `ls_contact`
#[repr(C)]
#[derive(Debug, Clone, Copy, Default)]
pub struct Contact {
    pub normal: i32,
    pub friction: i32,
    pub slip: i32,
    pub reserved: i32,
    pub bearing_radius: f64,
    pub clearance: f64,
    pub stiffness: f64,
    pub bearing_modulus: f64,
    pub bearing_poisson: f64,
    pub journal_modulus: f64,
    pub journal_poisson: f64,
    pub exponent: f64,
    pub restitution: f64,
    pub impact_velocity_floor: f64,
    pub friction_coefficient: f64,
    pub friction_v0: f64,
    pub friction_v1: f64,
}

/// `ls_joint`
#[repr(C)]
#[derive(Debug, Clone, Copy, Default)]
pub struct Joint {
    pub bearing: Point,
    pub journal: Point,
    pub contact: i32,
    pub kind: i32,
    pub hold_rotation: i32,
    pub hold_slope: i32,
    pub direction: f64,
    pub angle: f64,
}

/// `ls_spring`
#[repr(C)]
#[derive(Debug, Clone, Copy, Default)]
pub struct Spring {
    pub from: Point,
    pub to: Point,
    pub stiffness: f64,
    pub damping: f64,
    pub rest_length: f64,
}

/// `ls_torsion_spring`
#[repr(C)]
#[derive(Debug, Clone, Copy, Default)]
pub struct TorsionSpring {
    pub joint: i32,
    pub reserved: i32,
    pub stiffness: f64,
    pub damping: f64,
    pub rest_angle: f64,
}

/// `ls_load`
#[repr(C)]
#[derive(Debug, Clone, Copy, Default)]
pub struct Load {
    pub kind: i32,
    pub x: i32,
    pub y: i32,
    pub reserved: i32,
    pub point: Point,
    pub reaction: Point,
}

/// `ls_motion`
#[repr(C)]
#[derive(Debug, Clone, Copy, Default)]
pub struct Motion {
    pub kind: i32,
    pub function: i32,
    pub joint: i32,
    pub reserved: i32,
    pub point: Point,
    pub nx: f64,
    pub ny: f64,
}

/// `ls_leg`
#[repr(C)]
#[derive(Debug, Clone, Copy, Default)]
pub struct Leg {
    pub joint_a: i32,
    pub joint_b: i32,
    pub joint_c: i32,
    pub elbow: i32,
}

/// `ls_path`
#[repr(C)]
#[derive(Debug, Clone, Copy, Default)]
pub struct Path {
    pub body: i32,
    pub reserved: i32,
    pub centre_x: f64,
    pub centre_y: f64,
    pub radius: f64,
    pub frequency: f64,
    pub phase: f64,
    pub theta: f64,
}

/// `ls_tolerances`
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct Tolerances {
    pub relative: f64,
    pub position: f64,
    pub velocity: f64,
    pub max_step: f64,
    pub max_order: i32,
    pub reserved: i32,
    pub max_steps: i64,
}

/// `ls_event`
#[repr(C)]
#[derive(Debug, Clone, Copy, Default)]
pub struct Event {
    pub time: f64,
    pub velocity: f64,
    pub eccentricity_x: f64,
    pub eccentricity_y: f64,
    pub deepest: f64,
    pub joint: i32,
    pub onset: i32,
}

/// `ls_statistics`
#[repr(C)]
#[derive(Debug, Clone, Copy, Default)]
pub struct Statistics {
    pub steps: i64,
    pub residuals: i64,
    pub jacobians: i64,
    pub error_failures: i64,
    pub convergence_failures: i64,
    pub restarts: i64,
    pub clamps: i64,
}

#[repr(C)]
struct RawMechanism {
    bodies: *const Body,
    joints: *const Joint,
    contacts: *const Contact,
    legs: *const Leg,
    functions: *const Function,
    springs: *const Spring,
    torsion_springs: *const TorsionSpring,
    loads: *const Load,
    motions: *const Motion,
    n_bodies: i32,
    n_joints: i32,
    n_contacts: i32,
    n_legs: i32,
    n_functions: i32,
    n_springs: i32,
    n_torsion_springs: i32,
    n_loads: i32,
    n_motions: i32,
    reserved: i32,
    path: Path,
    gravity: [f64; 2],
}

#[repr(C)]
struct RawRow {
    t: f64,
    q: *const f64,
    v: *const f64,
    a: *const f64,
    lambda: *const f64,
    joint_force: *const f64,
    joint_couple: *const f64,
    penetration: *const f64,
    impact_velocity: *const f64,
    torque: *const f64,
    motion_force: *const f64,
    energies: [f64; ENERGIES],
}

/// Energies of a row.
pub const ENERGIES: usize = 11;

#[repr(C)]
struct RawSystem {
    opaque: [u8; 0],
}

#[repr(C)]
struct RawRun {
    opaque: [u8; 0],
}

unsafe extern "C" {
    fn ls_sundials_version() -> *const c_char;
    fn ls_element_mass(mass: f64, length: f64, matrix: *mut f64, error: *mut ErrorRecord) -> i32;
    fn ls_element_elastic(
        axial_stiffness: f64,
        bending_stiffness: f64,
        length: f64,
        q: *const f64,
        energy: *mut f64,
        force: *mut f64,
        tangent: *mut f64,
        error: *mut ErrorRecord,
    ) -> i32;
    fn ls_contact_stiffness(
        contact: *const Contact,
        stiffness: *mut f64,
        error: *mut ErrorRecord,
    ) -> i32;
    fn ls_contact_normal(
        contact: *const Contact,
        delta: f64,
        rate: f64,
        impact_velocity: f64,
        force: *mut f64,
        by_delta: *mut f64,
        by_rate: *mut f64,
        clamped: *mut i32,
        error: *mut ErrorRecord,
    ) -> i32;
    fn ls_contact_friction(
        contact: *const Contact,
        slip: f64,
        normal: f64,
        force: *mut f64,
        by_slip: *mut f64,
        by_normal: *mut f64,
        error: *mut ErrorRecord,
    ) -> i32;
    fn ls_system_new(mechanism: *const RawMechanism, error: *mut ErrorRecord) -> *mut RawSystem;
    fn ls_system_free(system: *mut RawSystem);
    fn ls_system_coordinates(system: *const RawSystem) -> i32;
    fn ls_system_constraints(system: *const RawSystem) -> i32;
    fn ls_system_cranks(
        system: *const RawSystem,
        t: f64,
        angles: *mut f64,
        error: *mut ErrorRecord,
    ) -> i32;
    fn ls_system_start(
        system: *const RawSystem,
        t: f64,
        q: *mut f64,
        v: *mut f64,
        error: *mut ErrorRecord,
    ) -> i32;
    fn ls_system_mass(
        system: *const RawSystem,
        q: *const f64,
        mass: *mut f64,
        error: *mut ErrorRecord,
    ) -> i32;
    fn ls_system_force(
        system: *const RawSystem,
        t: f64,
        q: *const f64,
        v: *const f64,
        z: *const f64,
        force: *mut f64,
        by_q: *mut f64,
        by_v: *mut f64,
        error: *mut ErrorRecord,
    ) -> i32;
    fn ls_system_constraint_rows(
        system: *const RawSystem,
        t: f64,
        q: *const f64,
        phi: *mut f64,
        phi_q: *mut f64,
        phi_t: *mut f64,
        error: *mut ErrorRecord,
    ) -> i32;
    fn ls_run_new(
        system: *const RawSystem,
        t: f64,
        q: *const f64,
        v: *const f64,
        tolerances: *const Tolerances,
        error: *mut ErrorRecord,
    ) -> *mut RawRun;
    fn ls_run_free(run: *mut RawRun);
    fn ls_run_advance(run: *mut RawRun, t: f64, row: *mut RawRow, error: *mut ErrorRecord) -> i32;
    fn ls_run_event_count(run: *const RawRun) -> i64;
    fn ls_run_event(run: *const RawRun, index: i64, event: *mut Event) -> i32;
    fn ls_run_statistics(run: *const RawRun, statistics: *mut Statistics);
}

/// Calls a function that returns a code and fills an error record.
fn checked(call: impl FnOnce(*mut ErrorRecord) -> i32) -> Result<(), Box<ErrorRecord>> {
    let mut error = ErrorRecord::blank();
    match call(&raw mut error) {
        0 => Ok(()),
        _ => Err(Box::new(error)),
    }
}

/// Version of SUNDIALS.
pub fn sundials_version() -> String {
    // SAFETY: the library returns a string constant that ends with a zero byte.
    let text = unsafe { CStr::from_ptr(ls_sundials_version()) };
    text.to_string_lossy().into_owned()
}

/// Mass matrix of an element.
pub fn element_mass(mass: f64, length: f64) -> Result<[f64; 64], Box<ErrorRecord>> {
    let mut matrix = [0.0; 64];
    // SAFETY: the library writes 8 x 8 numbers.
    checked(|e| unsafe { ls_element_mass(mass, length, matrix.as_mut_ptr(), e) })?;
    Ok(matrix)
}

/// Elastic quantities of one element.
#[derive(Debug, Clone)]
pub struct Elastic {
    /// Axial and bending energy \[J\].
    pub energy: [f64; 2],
    /// dU/dq.
    pub force: [f64; 8],
    /// d2U/dq2, row by row.
    pub tangent: [f64; 64],
}

/// Energies, force and tangent of an element.
pub fn element_elastic(
    stiffness: [f64; 2],
    length: f64,
    q: &[f64; 8],
) -> Result<Elastic, Box<ErrorRecord>> {
    let (mut energy, mut force, mut tangent) = ([0.0; 2], [0.0; 8], [0.0; 64]);
    let [axial, bending] = stiffness;
    // SAFETY: the library reads 8 numbers and writes 2, 8 and 64.
    checked(|e| unsafe {
        ls_element_elastic(
            axial,
            bending,
            length,
            q.as_ptr(),
            energy.as_mut_ptr(),
            force.as_mut_ptr(),
            tangent.as_mut_ptr(),
            e,
        )
    })?;
    Ok(Elastic {
        energy,
        force,
        tangent,
    })
}

/// K of a contact.
pub fn contact_stiffness(contact: &Contact) -> Result<f64, Box<ErrorRecord>> {
    let mut k = 0.0;
    // SAFETY: the library reads one struct and writes one number.
    checked(|e| unsafe { ls_contact_stiffness(contact, &raw mut k, e) })?;
    Ok(k)
}

/// Normal force, its derivatives by penetration and rate, and whether it is clamped.
pub fn contact_normal(
    contact: &Contact,
    delta: f64,
    rate: f64,
    impact_velocity: f64,
) -> Result<([f64; 3], bool), Box<ErrorRecord>> {
    let ([mut f, mut by_delta, mut by_rate], mut clamped) = ([0.0; 3], 0);
    // SAFETY: the library reads one struct and writes three numbers and a flag.
    checked(|e| unsafe {
        ls_contact_normal(
            contact,
            delta,
            rate,
            impact_velocity,
            &raw mut f,
            &raw mut by_delta,
            &raw mut by_rate,
            &raw mut clamped,
            e,
        )
    })?;
    Ok(([f, by_delta, by_rate], clamped != 0))
}

/// Friction force and its derivatives by slip and normal force.
pub fn contact_friction(
    contact: &Contact,
    slip: f64,
    normal: f64,
) -> Result<[f64; 3], Box<ErrorRecord>> {
    let [mut f, mut by_slip, mut by_normal] = [0.0; 3];
    // SAFETY: the library reads one struct and writes three numbers.
    checked(|e| unsafe {
        ls_contact_friction(
            contact,
            slip,
            normal,
            &raw mut f,
            &raw mut by_slip,
            &raw mut by_normal,
            e,
        )
    })?;
    Ok([f, by_slip, by_normal])
}

/// `ls_mechanism`, with lists that own their items.
#[derive(Debug, Clone, Default)]
pub struct Mechanism {
    pub bodies: Vec<Body>,
    pub joints: Vec<Joint>,
    pub contacts: Vec<Contact>,
    pub legs: Vec<Leg>,
    pub functions: Vec<Function>,
    pub springs: Vec<Spring>,
    pub torsion_springs: Vec<TorsionSpring>,
    pub loads: Vec<Load>,
    pub motions: Vec<Motion>,
    pub path: Path,
    /// \[m/s2\]
    pub gravity: [f64; 2],
}

/// An assembled mechanism of the library.
#[derive(Debug)]
pub struct System {
    raw: NonNull<RawSystem>,
    /// Coordinates.
    pub n: usize,
    /// Constraints.
    pub m: usize,
    joints: usize,
    legs: usize,
    motions: usize,
}

impl System {
    /// Assembles; the library copies what it is given.
    pub fn new(mechanism: &Mechanism) -> Result<System, Box<ErrorRecord>> {
        let count = |n: usize| i32::try_from(n).expect("a mechanism is small");
        let m = mechanism;
        let raw = RawMechanism {
            bodies: m.bodies.as_ptr(),
            joints: m.joints.as_ptr(),
            contacts: m.contacts.as_ptr(),
            legs: m.legs.as_ptr(),
            functions: m.functions.as_ptr(),
            springs: m.springs.as_ptr(),
            torsion_springs: m.torsion_springs.as_ptr(),
            loads: m.loads.as_ptr(),
            motions: m.motions.as_ptr(),
            n_bodies: count(m.bodies.len()),
            n_joints: count(m.joints.len()),
            n_contacts: count(m.contacts.len()),
            n_legs: count(m.legs.len()),
            n_functions: count(m.functions.len()),
            n_springs: count(m.springs.len()),
            n_torsion_springs: count(m.torsion_springs.len()),
            n_loads: count(m.loads.len()),
            n_motions: count(m.motions.len()),
            reserved: 0,
            path: m.path,
            gravity: m.gravity,
        };
        let mut error = ErrorRecord::blank();
        // SAFETY: pointers and counts belong together and live through the call.
        let system = unsafe { ls_system_new(&raw const raw, &raw mut error) };
        let raw = NonNull::new(system).ok_or_else(|| Box::new(error))?;
        // SAFETY: the handle is live.
        let sizes = unsafe {
            [
                ls_system_coordinates(raw.as_ptr()),
                ls_system_constraints(raw.as_ptr()),
            ]
        };
        let [n, m] = sizes.map(|x| usize::try_from(x).expect("sizes are not negative"));
        Ok(System {
            raw,
            n,
            m,
            joints: mechanism.joints.len(),
            legs: mechanism.legs.len(),
            motions: mechanism.motions.len(),
        })
    }

    /// Angle, rate and acceleration of every crank.
    pub fn cranks(&self, t: f64) -> Result<Vec<[f64; 3]>, Box<ErrorRecord>> {
        let mut angles = vec![[0.0; 3]; self.legs];
        // SAFETY: the library writes three numbers a leg.
        checked(|e| unsafe {
            ls_system_cranks(self.raw.as_ptr(), t, angles.as_mut_ptr().cast(), e)
        })?;
        Ok(angles)
    }

    /// Positions and velocities of the ideal mechanism.
    pub fn start(&self, t: f64) -> Result<(Vec<f64>, Vec<f64>), Box<ErrorRecord>> {
        let (mut q, mut v) = (vec![0.0; self.n], vec![0.0; self.n]);
        // SAFETY: the library writes n numbers to each.
        checked(|e| unsafe {
            ls_system_start(self.raw.as_ptr(), t, q.as_mut_ptr(), v.as_mut_ptr(), e)
        })?;
        Ok((q, v))
    }

    /// M, row by row.
    pub fn mass(&self, q: &[f64]) -> Result<Vec<f64>, Box<ErrorRecord>> {
        assert_eq!(q.len(), self.n);
        let mut mass = vec![0.0; self.n * self.n];
        // SAFETY: the library reads n numbers and writes n x n.
        checked(|e| unsafe {
            ls_system_mass(self.raw.as_ptr(), q.as_ptr(), mass.as_mut_ptr(), e)
        })?;
        Ok(mass)
    }

    /// f, df/dq and df/dv.
    pub fn force(
        &self,
        t: f64,
        q: &[f64],
        v: &[f64],
        z: &[f64],
    ) -> Result<[Vec<f64>; 3], Box<ErrorRecord>> {
        assert_eq!([q.len(), v.len(), z.len()], [self.n, self.n, self.joints]);
        let square = self.n * self.n;
        let (mut f, mut by_q, mut by_v) = (vec![0.0; self.n], vec![0.0; square], vec![0.0; square]);
        // SAFETY: the library reads n, n and one number a joint, and writes n, n x n and n x n.
        checked(|e| unsafe {
            ls_system_force(
                self.raw.as_ptr(),
                t,
                q.as_ptr(),
                v.as_ptr(),
                z.as_ptr(),
                f.as_mut_ptr(),
                by_q.as_mut_ptr(),
                by_v.as_mut_ptr(),
                e,
            )
        })?;
        Ok([f, by_q, by_v])
    }

    /// Phi, Phi_q and Phi_t.
    pub fn constraint_rows(&self, t: f64, q: &[f64]) -> Result<[Vec<f64>; 3], Box<ErrorRecord>> {
        assert_eq!(q.len(), self.n);
        let (mut phi, mut phi_q, mut phi_t) = (
            vec![0.0; self.m],
            vec![0.0; self.m * self.n],
            vec![0.0; self.m],
        );
        // SAFETY: the library reads n numbers and writes m, m x n and m.
        checked(|e| unsafe {
            ls_system_constraint_rows(
                self.raw.as_ptr(),
                t,
                q.as_ptr(),
                phi.as_mut_ptr(),
                phi_q.as_mut_ptr(),
                phi_t.as_mut_ptr(),
                e,
            )
        })?;
        Ok([phi, phi_q, phi_t])
    }
}

impl Drop for System {
    fn drop(&mut self) {
        // SAFETY: the handle is live and dropped once.
        unsafe { ls_system_free(self.raw.as_ptr()) }
    }
}

/// A state on the way, copied out of the library.
#[derive(Debug, Clone, Default)]
pub struct Row {
    pub t: f64,
    pub q: Vec<f64>,
    pub v: Vec<f64>,
    pub a: Vec<f64>,
    pub lambda: Vec<f64>,
    /// Two numbers a joint.
    pub joint_force: Vec<f64>,
    /// One number a joint.
    pub joint_couple: Vec<f64>,
    pub penetration: Vec<f64>,
    pub impact_velocity: Vec<f64>,
    pub torque: Vec<f64>,
    /// One number a motion.
    pub motion_force: Vec<f64>,
    /// Kinetic, axial, bending, contact, gravity, springs, work, contact dissipated, clamp, friction dissipated, damping
    /// dissipated.
    pub energies: [f64; ENERGIES],
}

/// A run of the library under way.
#[derive(Debug)]
pub struct Run {
    raw: NonNull<RawRun>,
    n: usize,
    m: usize,
    joints: usize,
    legs: usize,
    motions: usize,
}

impl Run {
    /// Starts with all contacts open.
    pub fn new(
        system: &System,
        t: f64,
        q: &[f64],
        v: &[f64],
        tolerances: &Tolerances,
    ) -> Result<Run, Box<ErrorRecord>> {
        assert_eq!([q.len(), v.len()], [system.n, system.n]);
        let mut error = ErrorRecord::blank();
        // SAFETY: the handle is live, the library reads n numbers from each and copies what it keeps.
        let run = unsafe {
            ls_run_new(
                system.raw.as_ptr(),
                t,
                q.as_ptr(),
                v.as_ptr(),
                tolerances,
                &raw mut error,
            )
        };
        Ok(Run {
            raw: NonNull::new(run).ok_or_else(|| Box::new(error))?,
            n: system.n,
            m: system.m,
            joints: system.joints,
            legs: system.legs,
            motions: system.motions,
        })
    }

    /// Integrates to t and copies the state there into `row`.
    pub fn advance(&mut self, t: f64, row: &mut Row) -> Result<(), Box<ErrorRecord>> {
        let mut raw = RawRow {
            t,
            q: null_mut(),
            v: null_mut(),
            a: null_mut(),
            lambda: null_mut(),
            joint_force: null_mut(),
            joint_couple: null_mut(),
            penetration: null_mut(),
            impact_velocity: null_mut(),
            torque: null_mut(),
            motion_force: null_mut(),
            energies: [0.0; ENERGIES],
        };
        // SAFETY: the handle is live; the library fills the struct.
        checked(|e| unsafe { ls_run_advance(self.raw.as_ptr(), t, &raw mut raw, e) })?;
        let copies = [
            (&mut row.q, raw.q, self.n),
            (&mut row.v, raw.v, self.n),
            (&mut row.a, raw.a, self.n),
            (&mut row.lambda, raw.lambda, self.m),
            (&mut row.joint_force, raw.joint_force, 2 * self.joints),
            (&mut row.joint_couple, raw.joint_couple, self.joints),
            (&mut row.penetration, raw.penetration, self.joints),
            (&mut row.impact_velocity, raw.impact_velocity, self.joints),
            (&mut row.torque, raw.torque, self.legs),
            (&mut row.motion_force, raw.motion_force, self.motions),
        ];
        for (to, from, length) in copies {
            to.clear();
            if length > 0 {
                assert!(!from.is_null(), "the library fills every pointer of a row");
                // SAFETY: not null, and of the stated length until the next call on this run, which the exclusive
                // borrow excludes.
                to.extend_from_slice(unsafe { std::slice::from_raw_parts(from, length) });
            }
        }
        (row.t, row.energies) = (raw.t, raw.energies);
        Ok(())
    }

    /// Events from the one with index `first` on.
    pub fn events(&self, first: usize) -> Vec<Event> {
        // SAFETY: the handle is live.
        let count = unsafe { ls_run_event_count(self.raw.as_ptr()) };
        let first = i64::try_from(first).expect("events are few");
        let event = |index| {
            let mut event = Event::default();
            // SAFETY: the handle is live and the library writes one struct.
            let code = unsafe { ls_run_event(self.raw.as_ptr(), index, &raw mut event) };
            assert_eq!(code, 0, "an event below the count exists");
            event
        };
        (first..count).map(event).collect()
    }

    /// Counts so far.
    pub fn statistics(&self) -> Statistics {
        let mut statistics = Statistics::default();
        // SAFETY: the handle is live and the library writes one struct.
        unsafe { ls_run_statistics(self.raw.as_ptr(), &raw mut statistics) };
        statistics
    }
}

impl Drop for Run {
    fn drop(&mut self) {
        // SAFETY: the handle is live and dropped once.
        unsafe { ls_run_free(self.raw.as_ptr()) }
    }
}

//! The reference implementation as a Rust library: owned values, typed errors. The only file that calls C.

use crate::ffi::*;
pub use crate::ffi::{LsCriticalPoint, LsEvent, LsRest, LsTolerances};
use nalgebra::{DMatrix, DVector};
use std::ffi::{CStr, CString, c_char, c_int};
use std::ptr::NonNull;

/// Of a call of the reference.
type Result<T> = std::result::Result<T, ReferenceError>;

/// The code of a static analysis that a critical point ends, as in the header.
pub const LIMIT: i32 = 6;

/// What the reference implementation reports when it cannot go on.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("the reference: {message}{}", self.place())]
pub struct ReferenceError {
    /// What it is about, as in the header.
    pub code: i32,
    /// Path of the key, empty where the failure has no place in the scene.
    pub field: String,
    /// Line in the scene, 0 for an override.
    pub line: i32,
    /// IDA's return value.
    pub flag: i32,
    /// When \[s\].
    pub t: f64,
    /// What is wrong; IDA's own words where it fails.
    pub message: String,
}

impl ReferenceError {
    /// Where and when, as far as the failure has a place.
    fn place(&self) -> String {
        let ReferenceError { field, line, t, .. } = self;
        match (field.as_str(), *t > 0.0) {
            ("", false) => String::new(),
            ("", true) => format!(", at t = {t} s"),
            _ if *line == 0 => format!(", in `{field}`"),
            _ => format!(", in `{field}`, line {line}"),
        }
    }
}

/// A text of the library.
///
/// # Safety
/// `text` is zero-terminated.
unsafe fn owned(text: *const c_char) -> String {
    // SAFETY: see above
    let text = unsafe { CStr::from_ptr(text) };
    text.to_string_lossy().into_owned()
}

/// What a function of the library returns, and the error record that it fills.
fn call<T>(work: impl FnOnce(*mut LsError) -> T) -> (T, impl FnOnce() -> ReferenceError) {
    // SAFETY: numbers and empty texts
    let mut error: LsError = unsafe { std::mem::zeroed() };
    let result = work(&mut error);
    let error = move || ReferenceError {
        code: error.code,
        // SAFETY: the library ends its texts with zero
        field: unsafe { owned(error.field.as_ptr()) },
        line: error.line,
        flag: error.flag,
        t: error.time,
        // SAFETY: likewise
        message: unsafe { owned(error.message.as_ptr()) },
    };
    (result, error)
}

/// Calls a function that returns a new object, or null.
fn made<T>(work: impl FnOnce(*mut LsError) -> *mut T) -> Result<NonNull<T>> {
    let (object, error) = call(work);
    NonNull::new(object).ok_or_else(error)
}

/// Calls a function that fills vectors of these lengths.
fn filled<const N: usize>(
    lengths: [usize; N],
    work: impl FnOnce([*mut f64; N], *mut LsError) -> c_int,
) -> Result<[Vec<f64>; N]> {
    let mut vectors = lengths.map(|length| vec![0.0; length]);
    let pointers = vectors.each_mut().map(Vec::as_mut_ptr);
    let (code, error) = call(|e| work(pointers, e));
    if code == 0 { Ok(vectors) } else { Err(error()) }
}

/// Calls a function that describes an equilibrium.
fn found(work: impl FnOnce(*mut LsRest, *mut LsError) -> c_int) -> Result<LsRest> {
    let mut rest = LsRest::default();
    let pointer: *mut LsRest = &mut rest;
    let (code, error) = call(|e| work(pointer, e));
    if code == 0 { Ok(rest) } else { Err(error()) }
}

/// Version of the library that integrates.
pub fn versions() -> String {
    // SAFETY: the text is a constant of the library
    format!("SUNDIALS {}", unsafe { owned(ls_sundials_version()) })
}

/// A scene as the reference reads and assembles it.
///
/// An internal state x counts as the velocity of a coordinate of unit mass, as in EQUATIONS.md: f has the entry -dx/dt there.
#[derive(Debug)]
pub struct ReferenceScene {
    handle: NonNull<LsScene>,
    /// Names of the coordinates, those of internal states last.
    pub coordinates: Vec<String>,
    /// The internal states at t = 0.
    states: Vec<f64>,
    /// Names of the constraint rows.
    pub rows: Vec<String>,
    /// Names of the joints.
    pub joints: Vec<String>,
    /// Names of the channels, `t` first.
    pub channels: Vec<String>,
}

// SAFETY: the library has no globals, and what changes a scene borrows it alone
unsafe impl Send for ReferenceScene {}
// SAFETY: likewise
unsafe impl Sync for ReferenceScene {}

impl Drop for ReferenceScene {
    fn drop(&mut self) {
        // SAFETY: the handle is freed once
        unsafe { ls_scene_free(self.handle.as_ptr()) }
    }
}

/// f, df/dq and df/dv.
pub type ForceAndTangents = (DVector<f64>, DMatrix<f64>, DMatrix<f64>);
/// Phi, Phi_q and Phi_t.
pub type ConstraintRows = (DVector<f64>, DMatrix<f64>, DVector<f64>);

/// A state at which equations are compared; z is the impact velocity of every joint, 0 where open or ideal.
#[derive(Debug, Clone, Copy)]
pub struct ReferenceState<'a> {
    pub t: f64,
    pub q: &'a [f64],
    pub v: &'a [f64],
    pub z: &'a [f64],
}

/// Rates of internal states and their derivatives, row by row.
struct StateRates {
    rates: Vec<f64>,
    by_q: Vec<f64>,
    by_v: Vec<f64>,
    by_states: Vec<f64>,
}

impl ReferenceScene {
    /// Reads the text of a scene with overrides `path=value`, and assembles its start.
    pub fn read(text: &str, overrides: &[String]) -> Result<ReferenceScene> {
        let c_text = |s: &str| CString::new(s).expect("scenes have no zero bytes");
        let (text, overrides) = (c_text(text), overrides.iter().map(|o| c_text(o)));
        let overrides: Vec<CString> = overrides.collect();
        let pointers: Vec<*const c_char> = overrides.iter().map(|o| o.as_ptr()).collect();
        // SAFETY: texts are zero-terminated and live through the call
        let handle = made(|e| unsafe {
            ls_scene_read(text.as_ptr(), pointers.as_ptr(), pointers.len(), e)
        })?;
        let names = |list: i32| -> Vec<String> {
            // SAFETY: the handle is of a scene; a name is null only beyond the end
            let names = (0..).map(|i| unsafe { ls_scene_name(handle.as_ptr(), list, i) });
            let names = names.take_while(|name| !name.is_null());
            // SAFETY: names are zero-terminated
            names.map(|name| unsafe { owned(name) }).collect()
        };
        let mut scene = ReferenceScene {
            coordinates: names(0),
            states: Vec::new(),
            rows: names(1),
            joints: names(2),
            channels: names(3),
            handle,
        };
        let names = names(6);
        // SAFETY: a number for every state
        let [states] = filled([names.len()], |[states], e| unsafe {
            ls_scene_states(scene.handle.as_ptr(), states, e)
        })?;
        scene.states = states;
        scene.coordinates.extend(names);
        Ok(scene)
    }

    /// Number of the coordinates of bodies.
    fn of_bodies(&self) -> usize {
        self.coordinates.len() - self.states.len()
    }

    /// Sets the internal states, after a check that a state has the right lengths. Returns q, v and z.
    fn go_to(&mut self, at: ReferenceState) -> Result<[*const f64; 3]> {
        let (n, lengths) = (self.coordinates.len(), [at.q.len(), at.v.len(), at.z.len()]);
        assert_eq!(lengths, [n, n, self.joints.len()], "a state of this scene");
        let n = self.of_bodies();
        // SAFETY: a number for every state
        filled([], |[], e| unsafe {
            ls_scene_set_states(self.handle.as_ptr(), at.v[n..].as_ptr(), e)
        })?;
        Ok([at.q, at.v, at.z].map(<[f64]>::as_ptr))
    }

    /// q and v at t = 0.
    pub fn start(&self) -> Result<[Vec<f64>; 2]> {
        // SAFETY: a number for every coordinate
        let [mut q, mut v] = filled([self.of_bodies(); 2], |[q, v], e| unsafe {
            ls_scene_start(self.handle.as_ptr(), q, v, e)
        })?;
        v.extend(&self.states);
        q.resize(v.len(), 0.0);
        Ok([q, v])
    }

    /// The impact velocity of every joint at t = 0, 0 where open.
    pub fn start_contacts(&self) -> Result<Vec<f64>> {
        // SAFETY: a number for every joint
        let [z] = filled([self.joints.len()], |[z], e| unsafe {
            ls_scene_start_contacts(self.handle.as_ptr(), z, e)
        })?;
        Ok(z)
    }

    /// The equilibrium that a scene starts from.
    pub fn rest(&self) -> Result<LsRest> {
        // SAFETY: the handle is of a scene
        found(|rest, e| unsafe { ls_scene_rest(self.handle.as_ptr(), rest, e) })
    }

    /// M.
    pub fn mass(&self) -> Result<DMatrix<f64>> {
        let (n, all) = (self.of_bodies(), self.coordinates.len());
        // SAFETY: the matrix is n x n
        let [mass] = filled([n * n], |[mass], e| unsafe {
            ls_scene_mass(self.handle.as_ptr(), mass, e)
        })?;
        let mut mass = DMatrix::from_row_slice(n, n, &mass).resize(all, all, 0.0);
        (n..all).for_each(|i| mass[(i, i)] = 1.0);
        Ok(mass)
    }

    /// f, df/dq and df/dv.
    pub fn force(&mut self, at: ReferenceState) -> Result<ForceAndTangents> {
        let ([q, v, z], scene) = (self.go_to(at)?, self.handle.as_ptr());
        let (n, s) = (self.of_bodies(), self.states.len());
        // SAFETY: the state fits the scene; a vector and two matrices of n
        let [mut f, by_q, by_v] = filled([n, n * n, n * n], |[f, by_q, by_v], e| unsafe {
            ls_scene_force(scene, at.t, q, v, z, f, by_q, by_v, e)
        })?;
        // SAFETY: likewise; a matrix of n x s
        let [by_states] = filled([n * s], |[by_states], e| unsafe {
            ls_scene_force_by_states(scene, at.t, q, v, z, by_states, e)
        })?;
        let StateRates {
            rates,
            by_q: rates_by_q,
            by_v: rates_by_v,
            by_states: rates_by_states,
        } = self.state_rates(at)?;
        f.extend(rates.iter().map(|rate| -rate));
        let matrix =
            |rows, columns, entries: &[f64]| DMatrix::from_row_slice(rows, columns, entries);
        let [mut all_by_q, mut all_by_v] = [(); 2].map(|()| DMatrix::zeros(n + s, n + s));
        all_by_q
            .view_mut((0, 0), (n, n))
            .copy_from(&matrix(n, n, &by_q));
        all_by_q
            .view_mut((n, 0), (s, n))
            .copy_from(&-matrix(s, n, &rates_by_q));
        all_by_v
            .view_mut((0, 0), (n, n))
            .copy_from(&matrix(n, n, &by_v));
        all_by_v
            .view_mut((0, n), (n, s))
            .copy_from(&matrix(n, s, &by_states));
        all_by_v
            .view_mut((n, 0), (s, n))
            .copy_from(&-matrix(s, n, &rates_by_v));
        let of_states = -matrix(s, s, &rates_by_states);
        all_by_v.view_mut((n, n), (s, s)).copy_from(&of_states);
        Ok((f.into(), all_by_q, all_by_v))
    }

    /// dx/dt of all internal states, and its derivatives, row by row.
    fn state_rates(&mut self, at: ReferenceState) -> Result<StateRates> {
        let ([q, v, z], scene) = (self.go_to(at)?, self.handle.as_ptr());
        let (n, s) = (self.of_bodies(), self.states.len());
        let lengths = [s, s * n, s * n, s * s];
        // SAFETY: the state fits the scene; a vector and matrices with a row for every state
        let [rates, by_q, by_v, by_states] =
            filled(lengths, |[rates, by_q, by_v, by_x], e| unsafe {
                ls_scene_state_rates(scene, at.t, q, v, z, rates, by_q, by_v, by_x, e)
            })?;
        Ok(StateRates {
            rates,
            by_q,
            by_v,
            by_states,
        })
    }

    /// Phi, Phi_q and Phi_t.
    pub fn constraint_rows(&self, t: f64, q: &[f64]) -> Result<ConstraintRows> {
        let (n, m, all) = (self.of_bodies(), self.rows.len(), self.coordinates.len());
        assert_eq!(q.len(), all, "a state of this scene");
        // SAFETY: q fits the scene; vectors of m, a matrix of m x n
        let [phi, phi_q, phi_t] = filled([m, m * n, m], |[phi, phi_q, phi_t], e| unsafe {
            ls_scene_constraint_rows(self.handle.as_ptr(), t, q.as_ptr(), phi, phi_q, phi_t, e)
        })?;
        let phi_q = DMatrix::from_row_slice(m, n, &phi_q).resize_horizontally(all, 0.0);
        Ok((phi.into(), phi_q, phi_t.into()))
    }

    /// a and lambda of the equations of motion.
    pub fn acceleration(&mut self, at: ReferenceState) -> Result<[DVector<f64>; 2]> {
        let ([q, v, z], scene) = (self.go_to(at)?, self.handle.as_ptr());
        let lengths = [self.of_bodies(), self.rows.len()];
        // SAFETY: the state fits the scene; n and m numbers
        let [mut a, lambda] = filled(lengths, |[a, lambda], e| unsafe {
            ls_scene_acceleration(scene, at.t, q, v, z, a, lambda, e)
        })?;
        a.extend(self.state_rates(at)?.rates);
        Ok([a.into(), lambda.into()])
    }

    /// All channels, in the order of their names.
    pub fn values(&mut self, at: ReferenceState) -> Result<Vec<f64>> {
        let ([q, v, z], scene) = (self.go_to(at)?, self.handle.as_ptr());
        // SAFETY: the state fits the scene; a number for every channel
        let [values] = filled([self.channels.len()], |[values], e| unsafe {
            ls_scene_channels(scene, at.t, q, v, z, values, e)
        })?;
        Ok(values)
    }

    /// Begins a run at the start of the scene.
    pub fn run(&self, tolerances: &LsTolerances) -> Result<ReferenceRun<'_>> {
        // SAFETY: the run keeps its own copy of the scene
        let handle = made(|e| unsafe { ls_run_new(self.handle.as_ptr(), tolerances, e) })?;
        Ok(ReferenceRun {
            scene: self,
            handle,
        })
    }
}

/// A run under way, of IDA or of a static analysis.
#[derive(Debug)]
pub struct ReferenceRun<'a> {
    scene: &'a ReferenceScene,
    handle: NonNull<LsRun>,
}

impl Drop for ReferenceRun<'_> {
    fn drop(&mut self) {
        // SAFETY: the handle is freed once
        unsafe { ls_run_free(self.handle.as_ptr()) }
    }
}

impl ReferenceRun<'_> {
    /// Goes on to `t`; all channels there.
    pub fn advance(&mut self, t: f64) -> Result<Vec<f64>> {
        // SAFETY: a number for every channel
        let [values] = filled([self.scene.channels.len()], |[values], e| unsafe {
            ls_run_advance(self.handle.as_ptr(), t, values, e)
        })?;
        Ok(values)
    }

    /// Events from the one with index `first` on.
    pub fn events(&self, first: usize) -> Vec<LsEvent> {
        // SAFETY: the handle is of a run
        let count = unsafe { ls_run_event_count(self.handle.as_ptr()) };
        let event = |i| {
            let mut event = LsEvent::default();
            // SAFETY: the index is below the count
            unsafe { ls_run_event(self.handle.as_ptr(), i, &mut event) };
            event
        };
        (first..count).map(event).collect()
    }

    /// The last equilibrium of a static analysis.
    pub fn rest(&self) -> Result<LsRest> {
        // SAFETY: the handle is of a run
        found(|rest, e| unsafe { ls_run_rest(self.handle.as_ptr(), rest, e) })
    }

    /// The critical points that a static analysis has passed, and one that has ended it.
    pub fn critical_points(&self) -> Vec<LsCriticalPoint> {
        // SAFETY: the handle is of a run
        let count = unsafe { ls_run_critical_count(self.handle.as_ptr()) };
        let point = |i| {
            let mut point = LsCriticalPoint::default();
            // SAFETY: the index is below the count
            unsafe { ls_run_critical_point(self.handle.as_ptr(), i, &mut point) };
            point
        };
        (0..count).map(point).collect()
    }
}

//! The C interface of the reference implementation, `reference-cpp/include/reference.h`, field by field.

use std::ffi::{c_char, c_int};

/// `ls_error`
#[repr(C)]
pub struct LsError {
    pub code: i32,
    pub flag: i32,
    pub line: i32,
    pub column: i32,
    pub time: f64,
    pub field: [c_char; 128],
    pub message: [c_char; 640],
}

/// `ls_tolerances`
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct LsTolerances {
    pub relative: f64,
    pub position: f64,
    pub velocity: f64,
    pub max_step: f64,
    pub newton: f64,
    pub max_order: i32,
    pub linear_solver: i32,
    pub max_steps: i64,
}

/// `ls_event`
#[repr(C)]
#[derive(Default)]
pub struct LsEvent {
    pub time: f64,
    pub velocity: f64,
    pub eccentricity: [f64; 2],
    pub deepest: f64,
    pub joint: i32,
    pub onset: i32,
}

/// `ls_rest`
#[repr(C)]
#[derive(Debug, Clone, Copy, Default)]
pub struct LsRest {
    pub eigenvalue: f64,
    pub stability: i32,
    pub coordinate: i32,
}

/// `ls_critical_point`
#[repr(C)]
#[derive(Default)]
pub struct LsCriticalPoint {
    pub t: f64,
    pub part: f64,
    pub is_limit: i32,
    pub coordinate: i32,
}

/// `ls_scene`
#[repr(C)]
pub struct LsScene([u8; 0]);

/// `ls_run`
#[repr(C)]
pub struct LsRun([u8; 0]);

#[rustfmt::skip]
unsafe extern "C" {
    pub fn ls_scene_read(text: *const c_char, overrides: *const *const c_char, count: usize, error: *mut LsError)
        -> *mut LsScene;
    pub fn ls_scene_free(scene: *mut LsScene);
    pub fn ls_scene_name(scene: *const LsScene, list: i32, index: usize) -> *const c_char;
    pub fn ls_scene_start(scene: *const LsScene, q: *mut f64, v: *mut f64, error: *mut LsError) -> c_int;
    pub fn ls_scene_start_contacts(scene: *const LsScene, z: *mut f64, error: *mut LsError) -> c_int;
    pub fn ls_scene_rest(scene: *const LsScene, rest: *mut LsRest, error: *mut LsError) -> c_int;
    pub fn ls_scene_set_states(scene: *mut LsScene, states: *const f64, error: *mut LsError) -> c_int;
    pub fn ls_scene_states(scene: *const LsScene, states: *mut f64, error: *mut LsError) -> c_int;
    pub fn ls_scene_state_rates(scene: *const LsScene, t: f64, q: *const f64, v: *const f64, z: *const f64,
        rates: *mut f64, by_q: *mut f64, by_v: *mut f64, by_states: *mut f64, error: *mut LsError) -> c_int;
    pub fn ls_scene_force_by_states(scene: *const LsScene, t: f64, q: *const f64, v: *const f64, z: *const f64,
        by_states: *mut f64, error: *mut LsError) -> c_int;
    pub fn ls_scene_mass(scene: *const LsScene, mass: *mut f64, error: *mut LsError) -> c_int;
    pub fn ls_scene_force(scene: *const LsScene, t: f64, q: *const f64, v: *const f64, z: *const f64,
        force: *mut f64, by_q: *mut f64, by_v: *mut f64, error: *mut LsError) -> c_int;
    pub fn ls_scene_constraint_rows(scene: *const LsScene, t: f64, q: *const f64,
        phi: *mut f64, phi_q: *mut f64, phi_t: *mut f64, error: *mut LsError) -> c_int;
    pub fn ls_scene_acceleration(scene: *const LsScene, t: f64, q: *const f64, v: *const f64, z: *const f64,
        a: *mut f64, lambda: *mut f64, error: *mut LsError) -> c_int;
    pub fn ls_scene_channels(scene: *const LsScene, t: f64, q: *const f64, v: *const f64, z: *const f64,
        values: *mut f64, error: *mut LsError) -> c_int;
    pub fn ls_run_new(scene: *const LsScene, tolerances: *const LsTolerances, error: *mut LsError) -> *mut LsRun;
    pub fn ls_run_free(run: *mut LsRun);
    pub fn ls_run_advance(run: *mut LsRun, t: f64, values: *mut f64, error: *mut LsError) -> c_int;
    pub fn ls_run_event_count(run: *const LsRun) -> usize;
    pub fn ls_run_event(run: *const LsRun, index: usize, event: *mut LsEvent) -> c_int;
    pub fn ls_run_critical_count(run: *const LsRun) -> usize;
    pub fn ls_run_critical_point(run: *const LsRun, index: usize, point: *mut LsCriticalPoint) -> c_int;
    pub fn ls_run_rest(run: *const LsRun, rest: *mut LsRest, error: *mut LsError) -> c_int;
    pub fn ls_sundials_version() -> *const c_char;
}

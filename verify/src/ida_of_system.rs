//! IDA and KLU on the residual and the tangent of Looselink: what another integrator makes of the same equations.
//!
//! y = (q, v, lambda) with the constraints on the acceleration level, a problem of index 1,
//!
//! ```text
//! F = (q' - v,  M v' + f + Phi_q^T lambda,  d2(Phi)/dt2)
//! ```
//!
//! whose drift off the constraints is of the order of the tolerance within a few periods. Of J = dF/dy + c dF/dy' the derivatives
//! of d2(Phi)/dt2 by q and v are left out: they are smaller than c Phi_q by the angle through which bodies turn in a step. With
//! dv = c dq - b1 from the first row, J (dq, dv, dlambda) = (b1, b2, b3) becomes
//!
//! ```text
//! [ M + C / c + K / c2   Phi_q^T ] [ dq           ]   [ (b2 + c (M + C / c) b1) / c2 ]
//! [ Phi_q                0       ] [ dlambda / c2 ] = [ (b3 + c Phi_q b1) / c2       ]
//! ```
//!
//! with the tangent of Looselink for the weights 1 / c2 and 1 / c on the left: half as many unknowns.

use cpu_time::ThreadTime;
use looselink::newton::Newton;
use looselink::scene::Scene;
use looselink::simulate::Simulation;
use looselink::system::{State, System, Weights, Work};
use serde::{Deserialize, Serialize};
use std::ffi::{CStr, c_char};
use std::ops::{Deref, DerefMut};

/// `li_vector`
#[repr(C)]
struct LiVector {
    values: *mut f64,
    length: i64,
}

impl Deref for LiVector {
    type Target = [f64];

    fn deref(&self) -> &[f64] {
        // SAFETY: IDA's vectors last longer than the call that hands them over
        unsafe { std::slice::from_raw_parts(self.values, self.length as usize) }
    }
}

impl DerefMut for LiVector {
    fn deref_mut(&mut self) -> &mut [f64] {
        // SAFETY: likewise, and no two of a call are the same
        unsafe { std::slice::from_raw_parts_mut(self.values, self.length as usize) }
    }
}

/// `li_equations`
#[repr(C)]
struct LiEquations<'a> {
    data: *mut Equations<'a>,
    unknowns: i32,
    multipliers: i32,
    contacts: i32,
    columns: *const i64,
    rows: *const i64,
    residual: extern "C" fn(&mut Equations, f64, LiVector, LiVector, LiVector) -> i32,
    jacobian: extern "C" fn(&mut Equations, f64, f64, LiVector, LiVector, LiVector) -> i32,
    condense: extern "C" fn(&mut Equations, LiVector, LiVector),
    expand: extern "C" fn(&mut Equations, LiVector, LiVector, LiVector),
    gaps: extern "C" fn(&mut Equations, f64, LiVector, LiVector) -> i32,
    change: extern "C" fn(&mut Equations, f64, LiVector, LiVector) -> i32,
    row: extern "C" fn(&mut Equations, LiVector),
}

/// `li_run`
#[repr(C)]
struct LiRun {
    relative: f64,
    position: f64,
    velocity: f64,
    duration: f64,
    interval: f64,
    longest: f64,
    newton: f64,
    max_order: i32,
    dense: i32,
}

/// `li_counts`
#[repr(C)]
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct LiCounts {
    pub steps: i64,
    pub residuals: i64,
    pub jacobians: i64,
    pub changes: i64,
}

#[allow(improper_ctypes, reason = "C hands the equations through")]
unsafe extern "C" {
    fn li_integrate(
        equations: *const LiEquations,
        run: *const LiRun,
        y: *mut f64,
        yp: *mut f64,
        counts: *mut LiCounts,
        message: *mut c_char,
        length: i32,
    ) -> i32;
}

/// What IDA computed.
#[derive(Debug)]
pub struct IdaRun {
    /// The unknown coordinates at every multiple of the interval.
    pub rows: Vec<Vec<f64>>,
    /// Processor time \[s\].
    pub seconds: f64,
    pub counts: LiCounts,
}

/// What factorises Newton's matrix.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum LinearSolver {
    /// A sparse direct solver.
    Klu,
    /// Gaussian elimination of a dense matrix.
    Dense,
}

/// Shares of an error test up to which Newton's method may iterate: that of the comparisons, IDA's own, a loose one.
pub const NEWTON: [f64; 3] = [0.05, 0.33, 1.0];

/// To how much positions are held for a tolerance of one \[m\].
pub const POSITION: f64 = 1e-3;

/// How IDA integrates.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct IdaSettings {
    /// Largest order of BDF, 1 to 5; those above 2 are unstable on a part of the imaginary axis.
    pub max_order: i32,
    /// Relative tolerance of every unknown over the tolerance of the run.
    pub ratio: f64,
    /// Of Newton's matrix.
    pub linear_solver: LinearSolver,
    /// Share of an error test up to which Newton's method iterates.
    pub newton: f64,
}

/// Why there is no run.
#[derive(Debug, Clone, thiserror::Error)]
pub enum IdaError {
    /// It was given up.
    #[error("it takes longer than {0} s")]
    TooLong(f64),
    /// What the scene or IDA says.
    #[error("{0}")]
    Said(String),
}

/// Unknowns and multipliers: the size of Newton's matrix.
///
/// # Errors
/// What the scene says.
pub fn matrix_size(scene: &Scene) -> Result<usize, String> {
    let simulation = Simulation::new(scene).map_err(|e| e.to_string())?;
    let shape = simulation.model().shape();
    Ok(shape.unknowns + shape.multipliers)
}

/// Integrates a scene, giving up in the row after `longest` \[s\] of processor time; `tolerance` is that of positions over a
/// millimetre and of velocities over 0.1 m/s.
///
/// # Errors
/// See [`IdaError`].
pub fn integrate(
    scene: &Scene,
    settings: IdaSettings,
    tolerance: f64,
    longest: f64,
) -> Result<IdaRun, IdaError> {
    let simulation = Simulation::new(scene).map_err(|e| IdaError::Said(e.to_string()))?;
    let mut equations = Equations::new(&simulation, scene.integrator.onset_tolerance);
    let at = simulation.state();
    let n = equations.n;
    let mut y = [&at.q[..n], &at.v[..n], &at.lambda].concat();
    let mut yp = [&at.v[..n], &at.a[..n], &vec![0.0; at.lambda.len()]].concat();
    let [columns, rows] = equations.find_pattern();
    let shape = simulation.model().shape();
    let interface = LiEquations {
        data: &raw mut equations,
        unknowns: n as i32,
        multipliers: shape.multipliers as i32,
        contacts: shape.contacts as i32,
        columns: columns.as_ptr(),
        rows: rows.as_ptr(),
        residual,
        jacobian,
        condense,
        expand,
        gaps,
        change,
        row,
    };
    let run = LiRun {
        relative: settings.ratio * tolerance,
        position: POSITION * tolerance,
        velocity: 0.1 * tolerance,
        duration: scene.simulation.duration,
        interval: scene.output.interval,
        longest,
        newton: settings.newton,
        max_order: settings.max_order,
        dense: i32::from(settings.linear_solver == LinearSolver::Dense),
    };
    let mut counts = LiCounts::default();
    let mut message = [0; 512];
    let clock = ThreadTime::now();
    // SAFETY: the pointers are those of vectors of the lengths that the interface names, and outlive the call; `data` is the
    // only access to `equations` while it lasts
    let flag = unsafe {
        li_integrate(
            &raw const interface,
            &raw const run,
            y.as_mut_ptr(),
            yp.as_mut_ptr(),
            &raw mut counts,
            message.as_mut_ptr(),
            message.len() as i32,
        )
    };
    let seconds = clock.elapsed().as_secs_f64();
    if flag > 0 {
        return Err(IdaError::TooLong(longest));
    }
    if flag < 0 {
        // SAFETY: the library ends its text with zero
        let text = unsafe { CStr::from_ptr(message.as_ptr()) };
        return Err(IdaError::Said(text.to_string_lossy().into_owned()));
    }
    Ok(IdaRun {
        rows: equations.found,
        seconds,
        counts,
    })
}

/// The system with its memory.
struct Equations<'a> {
    system: &'a dyn System,
    n: usize,
    work: Work,
    newton: Newton,
    at: State,
    /// A state nearby, from which prescribed motions are followed.
    nearby: State,
    onset_tolerance: f64,
    phi: Vec<f64>,
    r: Vec<f64>,
    /// Of the entries of the matrix, column by column, in the tangent.
    slots: Vec<usize>,
    /// Row, column, tangent and slot of the entries of M + C / c and of Phi_q.
    eliminated: Vec<[usize; 4]>,
    /// M + C / c + K / c2 and M + C / c in the layout of the tangent.
    tangents: [Vec<f64>; 2],
    c: f64,
    /// True where forces depend on velocities.
    is_damped: bool,
    crossings: Vec<[f64; 2]>,
    found: Vec<Vec<f64>>,
}

impl<'a> Equations<'a> {
    fn new(simulation: &'a Simulation, onset_tolerance: f64) -> Equations<'a> {
        let system: &dyn System = simulation.model();
        let shape = system.shape();
        let length = system.symbolic().len();
        Equations {
            system,
            n: shape.unknowns,
            work: system.work(),
            newton: Newton::new(system, 0.0),
            at: simulation.state().clone(),
            nearby: simulation.state().clone(),
            onset_tolerance,
            phi: vec![0.0; shape.multipliers],
            r: vec![0.0; shape.coordinates],
            slots: Vec::new(),
            eliminated: Vec::new(),
            tangents: [vec![0.0; length], vec![0.0; length]],
            c: 1.0,
            is_damped: true,
            crossings: vec![[0.0; 2]; shape.crossings],
            found: Vec::new(),
        }
    }

    /// Makes a tangent that of these weights.
    fn linearise(&mut self, tangent: usize, q: f64, v: f64) {
        let (at, r, phi, work) = (&self.at, &mut self.r, &mut self.phi, &mut self.work);
        let k = &mut self.tangents[tangent];
        self.system.linearise(at, Weights { q, v }, r, phi, k, work);
    }

    /// The entries of the tangent that are not zero at the start or, where contacts may close, all of its pattern: where each column
    /// begins, and the rows.
    fn find_pattern(&mut self) -> [Vec<i64>; 2] {
        let (mut columns, mut rows) = (vec![0], Vec::new());
        let (n, symbolic) = (self.n, self.system.symbolic());
        let length = symbolic.len();
        let [with_stiffness, with_damping, mass] =
            [[1.0, 0.0], [0.0, 1.0], [0.0, 0.0]].map(|[q, v]| {
                self.linearise(1, q, v);
                self.tangents[1].clone()
            });
        let has_contacts = !self.crossings.is_empty();
        self.is_damped = has_contacts || mass != with_damping;
        // the entries of the pattern, each with its slot and one more
        let numbers: Vec<f64> = (1..=length).map(|number| number as f64).collect();
        let numbers = symbolic.to_dense(&numbers);
        let size = n + self.phi.len();
        for j in 0..size {
            for i in (0..size).filter(|&i| numbers[(i, j)] > 0.0) {
                let slot = numbers[(i, j)] as usize - 1;
                let has = |values: &[f64]| has_contacts || values[slot] != 0.0;
                let has_inertia = has(&mass) || has(&with_damping);
                if !(has_inertia || has(&with_stiffness)) {
                    continue;
                }
                rows.push(i as i64);
                self.slots.push(slot);
                if j < n && (i >= n || has_inertia) {
                    self.eliminated.push([i, j, usize::from(i < n), slot]);
                }
            }
            columns.push(rows.len() as i64);
        }
        [columns, rows]
    }

    /// Takes over y and y' at a time; false where the prescribed motion has no solution.
    fn move_to(&mut self, t: f64, y: &[f64], yp: Option<&[f64]>) -> bool {
        let n = self.n;
        self.at.t = t;
        let followed = self
            .system
            .prescribe(&self.nearby, &mut self.at, &mut self.work);
        self.at.q[..n].copy_from_slice(&y[..n]);
        self.at.v[..n].copy_from_slice(&y[n..2 * n]);
        self.at.lambda.copy_from_slice(&y[2 * n..]);
        if let Some(yp) = yp {
            self.at.a[..n].copy_from_slice(&yp[n..2 * n]);
        }
        self.nearby.copy_from(&self.at);
        followed.is_ok()
    }
}

extern "C" fn residual(
    e: &mut Equations,
    t: f64,
    y: LiVector,
    yp: LiVector,
    mut r: LiVector,
) -> i32 {
    if !e.move_to(t, &y, Some(&yp)) {
        return 1;
    }
    let n = e.n;
    e.system.residual(&e.at, &mut e.r, &mut e.phi, &mut e.work);
    e.system.constraint_acceleration(&e.at, &mut e.phi);
    for i in 0..n {
        r[i] = yp[i] - y[n + i];
    }
    r[n..2 * n].copy_from_slice(&e.r[..n]);
    r[2 * n..].copy_from_slice(&e.phi);
    i32::from(r.iter().any(|x| !x.is_finite()))
}

extern "C" fn jacobian(
    e: &mut Equations,
    t: f64,
    c: f64,
    y: LiVector,
    yp: LiVector,
    mut entries: LiVector,
) -> i32 {
    if !e.move_to(t, &y, Some(&yp)) {
        return 1;
    }
    e.c = c;
    e.linearise(0, c.powi(-2), c.recip());
    if e.is_damped {
        e.linearise(1, 0.0, c.recip());
    }
    for (entry, slot) in entries.iter_mut().zip(&e.slots) {
        *entry = e.tangents[0][*slot];
    }
    0
}

extern "C" fn condense(e: &mut Equations, b: LiVector, mut condensed: LiVector) {
    let (first, others) = b.split_at(e.n);
    condensed.copy_from_slice(others);
    for &[i, j, tangent, slot] in &e.eliminated {
        condensed[i] += e.c * e.tangents[tangent][slot] * first[j];
    }
    condensed.iter_mut().for_each(|x| *x /= e.c * e.c);
}

extern "C" fn expand(e: &mut Equations, b: LiVector, condensed: LiVector, mut x: LiVector) {
    let (n, c) = (e.n, e.c);
    for i in 0..n {
        x[i] = condensed[i];
        x[n + i] = c * condensed[i] - b[i];
    }
    for (x, multiplier) in x[2 * n..].iter_mut().zip(&condensed[n..]) {
        *x = c * c * multiplier;
    }
}

extern "C" fn gaps(e: &mut Equations, t: f64, y: LiVector, mut gaps: LiVector) -> i32 {
    if !e.move_to(t, &y, None) {
        return 1;
    }
    e.system.crossings(&e.at, &mut e.crossings);
    for (out, [past, _]) in gaps.iter_mut().zip(&e.crossings) {
        *out = *past;
    }
    0
}

extern "C" fn change(e: &mut Equations, t: f64, mut y: LiVector, mut yp: LiVector) -> i32 {
    if !e.move_to(t, &y, Some(&yp)) {
        return 1;
    }
    let n = e.n;
    e.system.crossings(&e.at, &mut e.crossings);
    // a root is found to the rounding of its time
    let tolerance = e.onset_tolerance.max(1e-12);
    let (at, crossings) = (&mut e.at, &e.crossings);
    e.system.commit(at, crossings, tolerance, &mut |_| {});
    if e.newton.make_consistent(e.system, at, &mut e.work).is_err() {
        return 1;
    }
    e.nearby.copy_from(at);
    y[n..2 * n].copy_from_slice(&at.v[..n]);
    y[2 * n..].copy_from_slice(&at.lambda);
    yp[..n].copy_from_slice(&at.v[..n]);
    yp[n..2 * n].copy_from_slice(&at.a[..n]);
    yp[2 * n..].fill(0.0);
    0
}

extern "C" fn row(e: &mut Equations, y: LiVector) {
    e.found.push(y[..e.n].to_vec());
}

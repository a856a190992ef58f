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
use std::ffi::{CStr, c_char, c_void};

/// `li_equations`
#[repr(C)]
struct LiEquations {
    data: *mut c_void,
    unknowns: i32,
    multipliers: i32,
    contacts: i32,
    columns: *const i64,
    rows: *const i64,
    residual: extern "C" fn(*mut c_void, f64, *const f64, *const f64, *mut f64) -> i32,
    jacobian: extern "C" fn(*mut c_void, f64, f64, *const f64, *const f64, *mut f64) -> i32,
    condense: extern "C" fn(*mut c_void, *const f64, *mut f64),
    expand: extern "C" fn(*mut c_void, *const f64, *const f64, *mut f64),
    gaps: extern "C" fn(*mut c_void, f64, *const f64, *mut f64) -> i32,
    change: extern "C" fn(*mut c_void, f64, *mut f64, *mut f64) -> i32,
    row: extern "C" fn(*mut c_void, f64, *const f64),
}

/// `li_run`
#[repr(C)]
struct LiRun {
    relative: f64,
    position: f64,
    velocity: f64,
    duration: f64,
    interval: f64,
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

/// Unknowns and multipliers: the size of Newton's matrix.
///
/// # Errors
/// What the scene says.
pub fn matrix_size(scene: &Scene) -> Result<usize, String> {
    let simulation = Simulation::new(scene).map_err(|e| e.to_string())?;
    let shape = simulation.model().shape();
    Ok(shape.unknowns + shape.multipliers)
}

/// Integrates a scene; `tolerance` is that of positions over a millimetre and of velocities over 0.1 m/s.
///
/// # Errors
/// What the scene or IDA says.
pub fn integrate(scene: &Scene, settings: IdaSettings, tolerance: f64) -> Result<IdaRun, String> {
    let simulation = Simulation::new(scene).map_err(|e| e.to_string())?;
    let mut equations = MechanismEquations::new(&simulation, scene.integrator.onset_tolerance);
    let at = simulation.state();
    let n = equations.n;
    let mut y = [&at.q[..n], &at.v[..n], &at.lambda].concat();
    let mut yp = [&at.v[..n], &at.a[..n], &vec![0.0; at.lambda.len()]].concat();
    // IDA reads the pattern while the equations are written to
    let (columns, rows) = (equations.columns.clone(), equations.rows.clone());
    let shape = simulation.model().shape();
    let interface = LiEquations {
        data: (&raw mut equations).cast(),
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
        position: 1e-3 * tolerance,
        velocity: 0.1 * tolerance,
        duration: scene.simulation.duration,
        interval: scene.output.interval,
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
    if flag != 0 {
        // SAFETY: the library ends its text with zero
        let text = unsafe { CStr::from_ptr(message.as_ptr()) };
        return Err(text.to_string_lossy().into_owned());
    }
    Ok(IdaRun {
        rows: equations.found,
        seconds,
        counts,
    })
}

/// The system with its memory.
struct MechanismEquations<'a> {
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
    /// Pattern of the matrix, column by column, and the slots of its entries in the tangent.
    columns: Vec<i64>,
    rows: Vec<i64>,
    slots: Vec<usize>,
    /// Row, column and slot of the entries of M + C / c, and of Phi_q.
    inertia: Vec<[usize; 3]>,
    gradient: Vec<[usize; 3]>,
    /// M + C / c + K / c2 and M + C / c in the layout of the tangent.
    tangent: Vec<f64>,
    with_damping: Vec<f64>,
    c: f64,
    /// True where forces depend on velocities.
    is_damped: bool,
    gaps: Vec<[f64; 2]>,
    found: Vec<Vec<f64>>,
}

impl<'a> MechanismEquations<'a> {
    fn new(simulation: &'a Simulation, onset_tolerance: f64) -> MechanismEquations<'a> {
        let system: &dyn System = simulation.model();
        let shape = system.shape();
        let length = system.symbolic().len();
        let mut equations = MechanismEquations {
            system,
            n: shape.unknowns,
            work: system.work(),
            newton: Newton::new(system, 0.0),
            at: simulation.state().clone(),
            nearby: simulation.state().clone(),
            onset_tolerance,
            phi: vec![0.0; shape.multipliers],
            r: vec![0.0; shape.coordinates],
            columns: vec![0],
            rows: Vec::new(),
            slots: Vec::new(),
            inertia: Vec::new(),
            gradient: Vec::new(),
            tangent: vec![0.0; length],
            with_damping: vec![0.0; length],
            c: 1.0,
            is_damped: true,
            gaps: vec![[0.0; 2]; shape.contacts],
            found: Vec::new(),
        };
        equations.find_pattern();
        equations
    }

    /// The tangent with these weights.
    fn linearise(&mut self, q: f64, v: f64, k: &mut [f64]) {
        let (at, r, phi, work) = (&self.at, &mut self.r, &mut self.phi, &mut self.work);
        self.system.linearise(at, Weights { q, v }, r, phi, k, work);
    }

    /// The entries of the tangent that are not zero at the start or, where contacts may close, all of its pattern.
    fn find_pattern(&mut self) {
        let (n, symbolic) = (self.n, self.system.symbolic());
        let length = symbolic.len();
        let [mut mass, mut with_damping, mut tangent] = [(); 3].map(|()| vec![0.0; length]);
        self.linearise(0.0, 0.0, &mut mass);
        self.linearise(0.0, 1.0, &mut with_damping);
        self.linearise(1.0, 0.0, &mut tangent);
        let has_contacts = !self.gaps.is_empty();
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
                if !(has_inertia || has(&tangent)) {
                    continue;
                }
                self.rows.push(i as i64);
                self.slots.push(slot);
                if j < n && i >= n {
                    self.gradient.push([i, j, slot]);
                } else if j < n && has_inertia {
                    self.inertia.push([i, j, slot]);
                }
            }
            self.columns.push(self.rows.len() as i64);
        }
        self.with_damping = mass;
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

/// The system and y behind the pointers of a call.
///
/// # Safety
/// The pointers are those that IDA hands through, see [`integrate`].
unsafe fn behind<'e>(
    data: *mut c_void,
    y: *const f64,
) -> (&'e mut MechanismEquations<'e>, &'e [f64]) {
    // SAFETY: see above
    unsafe {
        let equations = &mut *data.cast::<MechanismEquations>();
        let size = 2 * equations.n + equations.phi.len();
        (equations, std::slice::from_raw_parts(y, size))
    }
}

extern "C" fn residual(
    data: *mut c_void,
    t: f64,
    y: *const f64,
    yp: *const f64,
    r: *mut f64,
) -> i32 {
    // SAFETY: IDA's vectors have the size of y
    let (equations, y, yp, r) = unsafe {
        let (equations, y) = behind(data, y);
        (
            equations,
            y,
            std::slice::from_raw_parts(yp, y.len()),
            std::slice::from_raw_parts_mut(r, y.len()),
        )
    };
    if !equations.move_to(t, y, Some(yp)) {
        return 1;
    }
    let MechanismEquations {
        system,
        n,
        work,
        at,
        phi,
        r: force,
        ..
    } = equations;
    system.residual(at, force, phi, work);
    system.constraint_acceleration(at, phi);
    for i in 0..*n {
        r[i] = yp[i] - y[*n + i];
    }
    r[*n..2 * *n].copy_from_slice(&force[..*n]);
    r[2 * *n..].copy_from_slice(phi);
    i32::from(r.iter().any(|x| !x.is_finite()))
}

extern "C" fn jacobian(
    data: *mut c_void,
    t: f64,
    c: f64,
    y: *const f64,
    yp: *const f64,
    entries: *mut f64,
) -> i32 {
    // SAFETY: IDA's vectors have the size of y, its matrix has the pattern given
    let (equations, y, yp) = unsafe {
        let (equations, y) = behind(data, y);
        (equations, y, std::slice::from_raw_parts(yp, y.len()))
    };
    if !equations.move_to(t, y, Some(yp)) {
        return 1;
    }
    equations.c = c;
    let mut tangent = std::mem::take(&mut equations.tangent);
    equations.linearise(c.powi(-2), c.recip(), &mut tangent);
    equations.tangent = tangent;
    if equations.is_damped {
        let mut with_damping = std::mem::take(&mut equations.with_damping);
        equations.linearise(0.0, c.recip(), &mut with_damping);
        equations.with_damping = with_damping;
    }
    // SAFETY: as many as the pattern has
    let entries = unsafe { std::slice::from_raw_parts_mut(entries, equations.slots.len()) };
    for (entry, slot) in entries.iter_mut().zip(&equations.slots) {
        *entry = equations.tangent[*slot];
    }
    0
}

extern "C" fn condense(data: *mut c_void, b: *const f64, condensed: *mut f64) {
    // SAFETY: b has the size of y; the other has that of the matrix
    let (equations, b, condensed) = unsafe {
        let (equations, b) = behind(data, b);
        let size = b.len() - equations.n;
        (
            equations,
            b,
            std::slice::from_raw_parts_mut(condensed, size),
        )
    };
    let (first, others) = b.split_at(equations.n);
    let c = equations.c;
    condensed.copy_from_slice(others);
    for &[i, j, slot] in &equations.inertia {
        condensed[i] += c * equations.with_damping[slot] * first[j];
    }
    for &[i, j, slot] in &equations.gradient {
        condensed[i] += c * equations.tangent[slot] * first[j];
    }
    condensed.iter_mut().for_each(|x| *x /= c * c);
}

extern "C" fn expand(data: *mut c_void, b: *const f64, condensed: *const f64, x: *mut f64) {
    // SAFETY: b and x have the size of y; the other has that of the matrix
    let (equations, b, condensed, x) = unsafe {
        let (equations, b) = behind(data, b);
        let (n, size) = (equations.n, b.len());
        (
            equations,
            b,
            std::slice::from_raw_parts(condensed, size - n),
            std::slice::from_raw_parts_mut(x, size),
        )
    };
    let (n, c) = (equations.n, equations.c);
    for i in 0..n {
        x[i] = condensed[i];
        x[n + i] = c * condensed[i] - b[i];
    }
    for (x, multiplier) in x[2 * n..].iter_mut().zip(&condensed[n..]) {
        *x = c * c * multiplier;
    }
}

extern "C" fn gaps(data: *mut c_void, t: f64, y: *const f64, gaps: *mut f64) -> i32 {
    // SAFETY: IDA's vectors have the size of y
    let (equations, y) = unsafe { behind(data, y) };
    if !equations.move_to(t, y, None) {
        return 1;
    }
    equations.system.gaps(&equations.at, &mut equations.gaps);
    // SAFETY: one for every contact
    let gaps = unsafe { std::slice::from_raw_parts_mut(gaps, equations.gaps.len()) };
    for (out, [delta, _]) in gaps.iter_mut().zip(&equations.gaps) {
        *out = *delta;
    }
    0
}

extern "C" fn change(data: *mut c_void, t: f64, y: *mut f64, yp: *mut f64) -> i32 {
    // SAFETY: y and y' are the vectors of `integrate`
    let (equations, y, yp) = unsafe {
        let (equations, _) = behind(data, y);
        let size = 2 * equations.n + equations.phi.len();
        (
            equations,
            std::slice::from_raw_parts_mut(y, size),
            std::slice::from_raw_parts_mut(yp, size),
        )
    };
    if !equations.move_to(t, y, Some(yp)) {
        return 1;
    }
    let MechanismEquations {
        system,
        n,
        work,
        newton,
        at,
        gaps,
        onset_tolerance,
        nearby,
        ..
    } = equations;
    let n = *n;
    system.gaps(at, gaps);
    // a root is found to the rounding of its time
    let tolerance = onset_tolerance.max(1e-12);
    system.commit(at, gaps, tolerance, &mut |_, _, _| {});
    if newton.make_consistent(*system, at, work).is_err() {
        return 1;
    }
    nearby.copy_from(at);
    y[n..2 * n].copy_from_slice(&at.v[..n]);
    y[2 * n..].copy_from_slice(&at.lambda);
    yp[..n].copy_from_slice(&at.v[..n]);
    yp[n..2 * n].copy_from_slice(&at.a[..n]);
    yp[2 * n..].fill(0.0);
    0
}

extern "C" fn row(data: *mut c_void, _: f64, y: *const f64) {
    // SAFETY: IDA's vectors have the size of y
    let (equations, y) = unsafe { behind(data, y) };
    equations.found.push(y[..equations.n].to_vec());
}

//! IDA and KLU on the residual and the tangent of Looselink: what another integrator makes of the same equations.
//!
//! y = (q, v, lambda) with the constraints on the acceleration level, a problem of index 1,
//!
//! ```text
//! F = (q' - v,  M v' + f + Phi_q^T lambda,  d2(Phi)/dt2)
//! ```
//!
//! whose drift off the constraints is of the order of the tolerance within a few periods. Of dF/dy + c dF/dy' the derivatives of
//! d2(Phi)/dt2 by q and v are left out: they are smaller than c Phi_q by the angle through which bodies turn in a step.

use cpu_time::ThreadTime;
use looselink::newton::Newton;
use looselink::scene::Scene;
use looselink::simulate::Simulation;
use looselink::system::{State, System, Weights, Work};
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
    gaps: extern "C" fn(*mut c_void, f64, *const f64, *mut f64) -> i32,
    change: extern "C" fn(*mut c_void, f64, *mut f64, *mut f64) -> i32,
    row: extern "C" fn(*mut c_void, f64, *const f64),
}

/// `li_run`
#[repr(C)]
struct LiRun {
    position: f64,
    velocity: f64,
    duration: f64,
    interval: f64,
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

/// Integrates a scene; `relative` is the tolerance of positions over a millimetre and of velocities over 0.1 m/s.
///
/// # Errors
/// What the scene or IDA says.
pub fn integrate(scene: &Scene, relative: f64) -> Result<IdaRun, String> {
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
        gaps,
        change,
        row,
    };
    let run = LiRun {
        position: 1e-3 * relative,
        velocity: 0.1 * relative,
        duration: scene.simulation.duration,
        interval: scene.output.interval,
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
    /// Pattern of the matrix, column by column, and what each entry is.
    columns: Vec<i64>,
    rows: Vec<i64>,
    entries: Vec<Entry>,
    /// M, M + K and M + C in the layout of the tangent.
    mass: Vec<f64>,
    with_stiffness: Vec<f64>,
    with_damping: Vec<f64>,
    /// True where forces depend on velocities.
    is_damped: bool,
    gaps: Vec<[f64; 2]>,
    found: Vec<Vec<f64>>,
}

/// An entry of dF/dy + c dF/dy'; numbers are slots of the tangent.
#[derive(Clone, Copy)]
enum Entry {
    /// c
    Rate,
    /// -1
    Velocity,
    /// K
    Stiffness(usize),
    /// c M + C
    Inertia(usize),
    /// Phi_q^T
    Force(usize),
    /// c Phi_q
    Constraint(usize),
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
            entries: Vec::new(),
            mass: vec![0.0; length],
            with_stiffness: vec![0.0; length],
            with_damping: vec![0.0; length],
            is_damped: true,
            gaps: vec![[0.0; 2]; shape.contacts],
            found: Vec::new(),
        };
        equations.linearise();
        equations.is_damped = shape.contacts > 0 || equations.mass != equations.with_damping;
        equations.find_pattern();
        equations
    }

    /// M, M + K and M + C at the state.
    fn linearise(&mut self) {
        let weights = |q, v| Weights { q, v };
        let (at, r, phi, work) = (&self.at, &mut self.r, &mut self.phi, &mut self.work);
        let mut fill = |w, k: &mut [f64]| self.system.linearise(at, w, r, phi, k, work);
        fill(weights(1.0, 0.0), &mut self.with_stiffness);
        if self.is_damped {
            fill(weights(0.0, 0.0), &mut self.mass);
            fill(weights(0.0, 1.0), &mut self.with_damping);
        }
    }

    /// The entries of the tangent that are not zero at the start or, where contacts may close, all of its pattern.
    fn find_pattern(&mut self) {
        let (n, symbolic) = (self.n, self.system.symbolic());
        let m = self.phi.len();
        // the entries of the pattern, each with its slot and one more
        let numbers: Vec<f64> = (1..=symbolic.len()).map(|number| number as f64).collect();
        let numbers = symbolic.to_dense(&numbers);
        let slot = |i: usize, j: usize| numbers[(i, j)] as usize - 1;
        let is_there = |i: usize, j: usize, values: &[f64]| {
            numbers[(i, j)] > 0.0 && (!self.gaps.is_empty() || values[slot(i, j)] != 0.0 || i == j)
        };
        let size = 2 * n + m;
        for column in 0..size {
            let mut add = |row: usize, entry: Entry| {
                self.rows.push(row as i64);
                self.entries.push(entry);
            };
            if column < n {
                add(column, Entry::Rate);
                for i in (0..n).filter(|&i| is_there(i, column, &self.with_stiffness)) {
                    add(n + i, Entry::Stiffness(slot(i, column)));
                }
            } else if column < 2 * n {
                let j = column - n;
                add(j, Entry::Velocity);
                let inertia =
                    |i: usize| is_there(i, j, &self.mass) || is_there(i, j, &self.with_damping);
                for i in (0..n).filter(|&i| inertia(i)) {
                    add(n + i, Entry::Inertia(slot(i, j)));
                }
                for k in (0..m).filter(|&k| is_there(n + k, j, &self.with_stiffness)) {
                    add(2 * n + k, Entry::Constraint(slot(n + k, j)));
                }
            } else {
                let k = column - n;
                for i in (0..n).filter(|&i| is_there(i, k, &self.with_stiffness)) {
                    add(n + i, Entry::Force(slot(i, k)));
                }
            }
            self.columns.push(self.rows.len() as i64);
        }
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
    equations.linearise();
    let MechanismEquations {
        entries: kinds,
        mass,
        with_stiffness,
        with_damping,
        ..
    } = equations;
    // SAFETY: as many as the pattern has
    let entries = unsafe { std::slice::from_raw_parts_mut(entries, kinds.len()) };
    for (entry, kind) in entries.iter_mut().zip(kinds) {
        *entry = match *kind {
            Entry::Rate => c,
            Entry::Velocity => -1.0,
            Entry::Stiffness(s) => with_stiffness[s] - mass[s],
            Entry::Inertia(s) => c * mass[s] + (with_damping[s] - mass[s]),
            Entry::Force(s) => with_stiffness[s],
            Entry::Constraint(s) => c * with_stiffness[s],
        };
    }
    0
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

//! Newton's method: stages, projections and equilibria, and the linear solves of the acceleration level.

mod factors;
mod iteration;
mod response;
mod singular;
mod statics;

pub(crate) use factors::Factors;
pub(crate) use iteration::{Update, iterate};
pub use response::Response;

use crate::checkpoint::carried;
use crate::system::{State, System, Weights, Work};
use singular::{SINGULAR, Truncated};

/// Largest number of iterations of a stage; a stage that converges needs far fewer.
const MAX_ITERATIONS: usize = 15;
/// Updates that no longer decrease count as rounding below this many tolerances.
const ROUNDING_BAND: f64 = 1e4;
/// A projection of positions ends when its update is below this part of the largest position: the error left is the square of
/// the update, by Newton's quadratic convergence.
const PROJECTED: f64 = 1e-10;

/// Counts of the work done.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Counters {
    /// Stages and load steps solved.
    pub stages: u64,
    /// Newton iterations.
    pub newton_iterations: u64,
    /// Factorisations of the tangent.
    pub factorisations: u64,
    /// Factorisations with row exchanges, because the fixed pivot order met a weak pivot.
    pub fallbacks: u64,
    /// Stages accepted because their updates had come down to rounding, above the tolerance.
    pub stagnations: u64,
    /// Stages that ended in a nearly singular pose, where the singular direction was left out.
    pub singular_poses: u64,
}

carried!(Counters { stages, newton_iterations, factorisations, fallbacks, stagnations, singular_poses } but {});

/// Why there is no solution.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Failure {
    /// Newton's method does not converge; the unknown with the largest last update and its size: in velocity \[m/s\] for a
    /// stage, otherwise in units of the coordinates.
    NoConvergence {
        /// Unknown.
        index: usize,
        /// Update.
        update: f64,
    },
    /// A state that is not finite; the unknown.
    NotFinite {
        /// Unknown.
        index: usize,
    },
    /// The tangent is singular; the unknown with the weak pivot.
    Singular {
        /// Unknown.
        index: usize,
    },
}

impl Failure {
    /// Index of the unknown or multiplier that failed.
    pub fn index(&self) -> usize {
        match *self {
            Failure::NoConvergence { index, .. }
            | Failure::NotFinite { index }
            | Failure::Singular { index } => index,
        }
    }
}

/// Solver memory: allocated once, used for every stage.
#[derive(Debug)]
pub struct Newton {
    tolerance: f64,
    r: Vec<f64>,
    phi: Vec<f64>,
    b: Vec<f64>,
    /// The tangent of a stage.
    stage: Factors,
    /// The matrix of the acceleration level.
    acceleration: Factors,
    /// True where the state made consistent last is a pose in which the constraints lose rank.
    in_singular_pose: bool,
    met_singular_pose: bool,
    /// True once `acceleration` holds the mass matrix of a system without multipliers, which never changes.
    holds_mass: bool,
    /// Work done so far.
    pub counters: Counters,
}

// the mass matrix of a system without multipliers has been factorised at the start of the run
carried!(Newton { in_singular_pose, met_singular_pose, counters } but { tolerance, r, phi, b, stage, acceleration, holds_mass });

impl Newton {
    /// Memory for a system; `tolerance` is the largest error left in a velocity \[m/s\].
    pub fn new(system: &dyn System, tolerance: f64) -> Newton {
        let shape = system.shape();
        let size = shape.unknowns + shape.multipliers;
        Newton {
            tolerance,
            r: vec![0.0; shape.coordinates],
            phi: vec![0.0; shape.multipliers],
            b: vec![0.0; size],
            stage: Factors::new(system.symbolic()),
            acceleration: Factors::new(system.acceleration_symbolic()),
            in_singular_pose: false,
            met_singular_pose: false,
            holds_mass: false,
            counters: Counters::default(),
        }
    }

    /// The residual and the factors of the tangent of a stage.
    fn renew_stage(
        &mut self,
        system: &dyn System,
        at: &State,
        w: Weights,
        work: &mut Work,
    ) -> Result<(), Failure> {
        let (r, phi) = (&mut self.r, &mut self.phi);
        self.stage
            .renew(system.symbolic(), &mut self.counters, |k| {
                system.linearise(at, w, r, phi, k, work);
            })
    }

    /// Phi and the factors of the acceleration level.
    fn renew_level(&mut self, system: &dyn System, at: &State) -> Result<(), Failure> {
        let phi = &mut self.phi;
        self.acceleration
            .renew(system.acceleration_symbolic(), &mut self.counters, |k| {
                system.acceleration_level(at, phi, k);
            })?;
        self.holds_mass = system.shape().multipliers == 0;
        Ok(())
    }

    /// Solves M a + f + Phi_q^T lambda = 0, Phi = 0 for (a, lambda) with q = q_hat + w.q a, v = v_hat + w.v a.
    ///
    /// `s` holds the guess of (a, lambda) and the known coordinates; the solution overwrites the guess. Constraint rows are
    /// divided by w.q, so that the matrix tends to that of the acceleration level as the step decreases. The iteration has
    /// converged when the estimated error of every velocity is below the tolerance. With constraints the tolerance is at least
    /// 16 eps |q| w.v/w.q, the rounding of Phi as an error of velocity.
    ///
    /// # Errors
    /// See [`Failure`].
    pub fn solve_stage(
        &mut self,
        system: &dyn System,
        w: Weights,
        q_hat: &[f64],
        v_hat: &[f64],
        s: &mut State,
        work: &mut Work,
    ) -> Result<(), Failure> {
        let n = system.shape().unknowns;
        self.counters.stages += 1;
        let mut tolerance = self.tolerance;
        if system.shape().multipliers > 0 {
            let size = q_hat[..n].iter().fold(0.0_f64, |m, q| m.max(q.abs()));
            tolerance = tolerance.max(16.0 * f64::EPSILON * size * w.v / w.q);
        }
        let move_to = |s: &mut State| {
            for i in 0..n {
                s.q[i] = q_hat[i] + w.q * s.a[i];
                s.v[i] = v_hat[i] + w.v * s.a[i];
            }
        };
        iterate(MAX_ITERATIONS, |iteration| {
            move_to(s);
            self.counters.newton_iterations += 1;
            match iteration.renew {
                true => self.renew_stage(system, s, w, work)?,
                false => system.residual(s, &mut self.r, &mut self.phi, work),
            }
            for i in 0..n {
                self.b[i] = -self.r[i];
            }
            for (b, phi) in self.b[n..].iter_mut().zip(&self.phi) {
                *b = -phi / w.q;
            }
            self.stage.solve(system.symbolic(), &mut self.b);
            for (x, d) in s.a[..n].iter_mut().zip(&self.b) {
                *x += d;
            }
            for (lambda, d) in s.lambda.iter_mut().zip(&self.b[n..]) {
                *lambda += d;
            }
            let update = Update::largest(self.b[..n].iter().map(|d| w.v * d));
            let rate = update.size / iteration.last;
            let linear = if iteration.number == 0 || rate >= 1.0 {
                update.size
            } else {
                rate / (1.0 - rate) * update.size
            };
            // after one large update the rate says nothing: this is its error for constraints with a curvature of 1/m
            let error = linear.max(update.size * update.size * w.q / w.v);
            let rounding =
                iteration.number >= 2 && rate > 0.3 && update.size < ROUNDING_BAND * tolerance;
            let converged = error <= tolerance || rounding;
            self.counters.stagnations += u64::from(converged && error > tolerance);
            Ok((update, converged))
        })?;
        move_to(s);
        Ok(())
    }

    /// Makes a state consistent at its q: v is projected on Phi_q v + Phi_t = 0 with the change of least kinetic energy, then
    /// M a + Phi_q^T lambda = -f and d2(Phi)/dt2 = 0, that is Phi_q a = gamma, give (a, lambda).
    ///
    /// The multipliers and constrained accelerations of Bathe's stages on the position level are of order one; those found
    /// here are of order two. A direction in which the constraints have lost rank is left out and counted.
    ///
    /// # Errors
    /// [`Failure::Singular`] where the constraints contradict or repeat each other.
    pub fn make_consistent(
        &mut self,
        system: &dyn System,
        s: &mut State,
        work: &mut Work,
    ) -> Result<(), Failure> {
        if self.begin_acceleration_level(system, s)? {
            return self.end_in_singular_pose(system, s, true, work);
        }
        if system.shape().multipliers > 0 {
            system.constraint_velocity(s, &mut self.phi);
            self.b[..system.shape().unknowns].fill(0.0);
            self.move_by(system, |s| &mut s.v, s);
        }
        self.end_acceleration_level(system, s, work)
    }

    /// The accelerations and multipliers at (q, v) as they are: M a + Phi_q^T lambda = -f, Phi_q a = gamma.
    ///
    /// # Errors
    /// As [`Newton::make_consistent`].
    pub fn accelerate(
        &mut self,
        system: &dyn System,
        s: &mut State,
        work: &mut Work,
    ) -> Result<(), Failure> {
        if self.begin_acceleration_level(system, s)? {
            return self.end_in_singular_pose(system, s, false, work);
        }
        self.end_acceleration_level(system, s, work)
    }

    /// The accelerations at a state beside the motion: a singular pose there is neither counted nor remembered.
    ///
    /// # Errors
    /// As [`Newton::make_consistent`].
    pub fn accelerate_aside(
        &mut self,
        system: &dyn System,
        s: &mut State,
        work: &mut Work,
    ) -> Result<(), Failure> {
        let poses = self.counters.singular_poses;
        let of_the_motion = (self.in_singular_pose, self.met_singular_pose);
        let result = self.accelerate(system, s, work);
        self.counters.singular_poses = poses;
        (self.in_singular_pose, self.met_singular_pose) = of_the_motion;
        result
    }

    /// Factorises the acceleration level. Returns true in a pose where the constraints lose rank.
    fn begin_acceleration_level(
        &mut self,
        system: &dyn System,
        s: &State,
    ) -> Result<bool, Failure> {
        if self.holds_mass {
            return Ok(false);
        }
        self.renew_level(system, s)?;
        let n = system.shape().unknowns;
        let pivots = || {
            system
                .acceleration_symbolic()
                .pivot_range(&self.acceleration.values, n)
        };
        self.in_singular_pose = system.shape().multipliers > 0
            && (self.acceleration.dense.is_some() || pivots() < SINGULAR);
        Ok(self.in_singular_pose)
    }

    /// Solves for (a, lambda) with the factors of the acceleration level.
    fn end_acceleration_level(
        &mut self,
        system: &dyn System,
        s: &mut State,
        work: &mut Work,
    ) -> Result<(), Failure> {
        let n = system.shape().unknowns;
        s.a[..n].fill(0.0);
        system.free_residual(s, &mut self.r, work);
        system.constraint_acceleration(s, &mut self.phi);
        for i in 0..n {
            self.b[i] = -self.r[i];
        }
        self.move_by(system, |s| &mut s.a, s);
        s.lambda.copy_from_slice(&self.b[n..]);
        match s.a[..n].iter().position(|a| !a.is_finite()) {
            Some(index) => Err(Failure::NotFinite { index }),
            None => Ok(()),
        }
    }

    /// Projects q on Phi = 0, in the norm of the mass matrix: the projection that ends a step of an explicit scheme on a
    /// constrained system (Eich 1993, SIAM J. Numer. Anal. 30:1467).
    ///
    /// # Errors
    /// See [`Failure`].
    pub fn project_positions(&mut self, system: &dyn System, s: &mut State) -> Result<(), Failure> {
        let n = system.shape().unknowns;
        let size = s.q[..n].iter().fold(0.0_f64, |m, q| m.max(q.abs()));
        iterate(MAX_ITERATIONS, |_| {
            self.renew_level(system, s)?;
            self.b[..n].fill(0.0);
            self.solve_for_phi(system);
            for i in 0..n {
                let increment = self.b[i] + s.q_low[i];
                let before = s.q[i];
                s.q[i] = before + increment;
                s.q_low[i] = increment - (s.q[i] - before);
            }
            let update = Update::largest(self.b[..n].iter().copied());
            Ok((update, update.size <= PROJECTED * size))
        })
    }

    /// The end of [`Newton::make_consistent`] or, without `project`, of [`Newton::accelerate`], without the directions in
    /// which the constraints have lost rank. It allocates.
    fn end_in_singular_pose(
        &mut self,
        system: &dyn System,
        s: &mut State,
        project: bool,
        work: &mut Work,
    ) -> Result<(), Failure> {
        let n = system.shape().unknowns;
        self.counters.singular_poses += 1;
        self.met_singular_pose = true;
        let k = &mut self.acceleration.values;
        system.acceleration_level(s, &mut self.phi, k);
        let Some(truncated) = Truncated::new(system.acceleration_symbolic(), k, n) else {
            return Err(Failure::Singular { index: n });
        };
        if project {
            system.constraint_velocity(s, &mut self.phi);
            let change = truncated.projection(&self.phi);
            s.v.iter_mut().zip(&change).for_each(|(v, d)| *v += d);
        }
        s.a[..n].fill(0.0);
        system.free_residual(s, &mut self.r, work);
        system.constraint_acceleration(s, &mut self.phi);
        let (a, lambda) = truncated.accelerations(&self.r[..n], &self.phi);
        s.a[..n].copy_from_slice(&a);
        s.lambda.copy_from_slice(&lambda);
        match s.a[..n].iter().position(|a| !a.is_finite()) {
            Some(index) => Err(Failure::NotFinite { index }),
            None => Ok(()),
        }
    }

    /// Ends a stage: makes v and a consistent if there are constraints, then evaluates the integrands of the energy ledger.
    /// Returns the number of clamped contacts.
    ///
    /// # Errors
    /// As [`Newton::make_consistent`].
    pub fn finish_stage(
        &mut self,
        system: &dyn System,
        s: &mut State,
        work: &mut Work,
    ) -> Result<usize, Failure> {
        if system.shape().multipliers > 0 {
            self.make_consistent(system, s, work)?;
        }
        Ok(system.powers(s, work))
    }

    /// True where a state has been made consistent in a singular pose since [`Newton::forget_singular_pose`].
    pub fn met_singular_pose(&self) -> bool {
        self.met_singular_pose
    }

    /// Begins a step: forgets singular poses met before.
    pub fn forget_singular_pose(&mut self) {
        self.met_singular_pose = false;
    }

    /// Removes from a local error e of velocities or coordinates the parts that do not stay in the motion: the part normal to
    /// the constraints, which the projection removes, and, for an `implicit` scheme, the modes faster than the step, which its
    /// stage matrix suppresses,
    ///
    /// ```text
    /// (M + w.v C + w.q K) x + Phi_q^T mu = M e        Phi_q x = 0
    /// ```
    ///
    /// (Hosea & Shampine 1996, Appl. Numer. Math. 20:21, for systems without constraints). In a singular pose the constraints do
    /// not determine the free directions; only that of the velocity v is known to be one. There x is the part of e along v.
    pub fn filter(&mut self, system: &dyn System, implicit: bool, v: &[f64], e: &mut [f64]) {
        let n = system.shape().unknowns;
        let constrained = system.shape().multipliers > 0;
        if !implicit && !constrained {
            return;
        }
        system.momentum(e, &mut self.b);
        if constrained && self.in_singular_pose {
            let along: f64 = self.b[..n].iter().zip(v).map(|(b, v)| b * v).sum();
            system.momentum(&v[..n], &mut self.b);
            let square: f64 = self.b[..n].iter().zip(v).map(|(b, v)| b * v).sum();
            let part = if square > 0.0 { along / square } else { 0.0 };
            e.iter_mut().zip(v).for_each(|(e, v)| *e = part * v);
            return;
        }
        self.b[n..].fill(0.0);
        match implicit {
            true => self.stage.solve(system.symbolic(), &mut self.b),
            false => self
                .acceleration
                .solve(system.acceleration_symbolic(), &mut self.b),
        }
        e.copy_from_slice(&self.b[..n]);
    }

    /// Solves the acceleration level with the right side `b`, whose first part (unknowns) is set, and -phi.
    fn solve_for_phi(&mut self, system: &dyn System) {
        let n = system.shape().unknowns;
        for (b, phi) in self.b[n..].iter_mut().zip(&self.phi) {
            *b = -phi;
        }
        self.acceleration
            .solve(system.acceleration_symbolic(), &mut self.b);
    }

    /// Solves as above and adds the first part of the solution to the positions, velocities or accelerations of the state.
    fn move_by(
        &mut self,
        system: &dyn System,
        level: fn(&mut State) -> &mut Vec<f64>,
        s: &mut State,
    ) {
        let n = system.shape().unknowns;
        self.solve_for_phi(system);
        for (x, d) in level(s).iter_mut().zip(&self.b[..n]) {
            *x += d;
        }
    }
}

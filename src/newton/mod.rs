//! Newton's method: stages, projections and equilibria, and the linear solves of the acceleration level.

mod crossing;
mod descent;
mod extent;
mod factors;
mod interruption;
mod iteration;
mod load_path;
mod prediction;
mod response;
mod singular;
mod softest;
mod stage;
mod statics;
mod tangent;

pub use crossing::Crossing;
pub use extent::Extent;
pub use interruption::interruptible;
pub(crate) use iteration::{Update, iterate, iterate_interruptibly};
pub use load_path::{ArcMetric, PathTangent};
pub use response::{Response, ResponseTerm};
pub use softest::Softest;
pub use stage::{Level, StageEquations};

use crate::checkpoint::{Carried, Checkpoint, carried};
use crate::math::lu::WeakPivot;
use crate::math::saddle_point::SaddleFactors;
use crate::system::{State, System, Work};
use prediction::Prediction;
use singular::{SINGULAR, Truncated};
use tangent::Tangent;

/// Largest number of iterations of a stage; a stage that converges needs far fewer.
const MAX_ITERATIONS: usize = 15;
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
    /// Stages that had no solution on the acceleration level and were solved on the position level.
    pub position_level_stages: u64,
    /// Stages that ended in a nearly singular pose, where the singular direction was left out.
    pub singular_poses: u64,
    /// Multiply-adds of residuals, tangents, factorisations and solves, by their order of magnitude.
    pub operations: u64,
}

carried!(Counters { stages, newton_iterations, factorisations, fallbacks, stagnations, position_level_stages, singular_poses, operations } but {});

/// Multiply-adds of evaluations and of the linear algebra that goes with them.
#[derive(Debug, Clone, Copy)]
struct Costs {
    residual: u64,
    /// A tangent and its factorisation.
    tangent: u64,
    solve: u64,
    /// The matrix of the acceleration level and its factorisation.
    level: u64,
    level_solve: u64,
}

impl Costs {
    fn of(system: &dyn System) -> Costs {
        let (symbolic, terms) = (system.symbolic(), system.operations());
        let [level, level_solve] = system.acceleration_matrix().operations();
        Costs {
            residual: terms.residual,
            tangent: terms.tangent + symbolic.operations() as u64,
            solve: symbolic.operations_of_solve() as u64,
            level: level as u64,
            level_solve: level_solve as u64,
        }
    }
}

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
    /// The potential falls without end; the unknown that moves most.
    Falls {
        /// Unknown.
        index: usize,
    },
}

impl From<WeakPivot> for Failure {
    fn from(WeakPivot { index }: WeakPivot) -> Failure {
        Failure::Singular { index }
    }
}

impl Failure {
    /// Index of the unknown or multiplier that failed.
    pub fn index(&self) -> usize {
        match *self {
            Failure::NoConvergence { index, .. }
            | Failure::NotFinite { index }
            | Failure::Singular { index }
            | Failure::Falls { index } => index,
        }
    }
}

/// An error where a value is not finite.
fn not_finite(values: &[f64]) -> Result<(), Failure> {
    // 0 x is zero for all others; the sum needs no branch for each
    if values.iter().map(|x| 0.0 * x).sum::<f64>() == 0.0 {
        return Ok(());
    }
    let index = values.iter().position(|x| !x.is_finite()).unwrap_or(0);
    Err(Failure::NotFinite { index })
}

/// Solver memory: allocated once, used for every stage.
#[derive(Debug)]
pub struct Newton {
    tolerance: f64,
    costs: Costs,
    /// Metres per unit of the last unknowns, which are internal states.
    metres: Vec<f64>,
    r: Vec<f64>,
    phi: Vec<f64>,
    b: Vec<f64>,
    /// Two right sides.
    pair: Vec<[f64; 2]>,
    /// The tangents of stages, the one used last first: a step has stages of one or two weights.
    tangents: [Tangent; 2],
    prediction: Prediction,
    /// The matrix of the acceleration level.
    acceleration: SaddleFactors,
    /// True where the state made consistent last is a pose in which the constraints lose rank.
    in_singular_pose: bool,
    met_singular_pose: bool,
    /// Work done so far.
    pub counters: Counters,
}

impl Newton {
    /// Memory for a system; `tolerance` is the largest error left in a velocity \[m/s\].
    pub fn new(system: &dyn System, tolerance: f64) -> Newton {
        let shape = system.shape();
        let size = shape.unknowns + shape.multipliers;
        Newton {
            tolerance,
            costs: Costs::of(system),
            metres: system.states().iter().map(|state| state.metres).collect(),
            r: vec![0.0; shape.coordinates],
            phi: vec![0.0; shape.multipliers],
            b: vec![0.0; size],
            pair: vec![[0.0; 2]; size],
            tangents: std::array::from_fn(|_| Tangent::new(system.symbolic())),
            prediction: Prediction::new(shape),
            acceleration: system.acceleration_matrix().factors(),
            in_singular_pose: false,
            met_singular_pose: false,
            counters: Counters::default(),
        }
    }

    /// Carries what later steps depend on.
    pub fn carry(&mut self, system: &dyn System, checkpoint: &mut Checkpoint) {
        let Newton {
            tolerance: _,
            costs: _,
            metres: _,
            r: _,
            phi: _,
            b: _,
            pair: _,
            tangents,
            prediction,
            acceleration: _,
            in_singular_pose,
            met_singular_pose,
            counters,
        } = self;
        for tangent in tangents {
            tangent.carry(system.symbolic(), checkpoint);
        }
        prediction.carry(checkpoint);
        in_singular_pose.carry(checkpoint);
        met_singular_pose.carry(checkpoint);
        counters.carry(checkpoint);
    }

    /// A step of a scheme with stages begins at `from`.
    pub fn begin_step(&mut self, from: &State) {
        if self.prediction.begin_step(from) {
            self.tangents.iter_mut().for_each(Tangent::discard);
        }
    }

    /// Phi and the factors of the acceleration level.
    fn renew_level(&mut self, system: &dyn System, at: &State) -> Result<(), Failure> {
        let factors = &mut self.acceleration;
        system.acceleration_level(at, &mut self.phi, &mut factors.gradient);
        self.counters.factorisations += 1;
        self.counters.operations += self.costs.level;
        let factored = system.acceleration_matrix().factor_any(factors);
        self.counters.fallbacks += u64::from(factored != Ok(false));
        factored?;
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
            self.solve_for_phi(system);
            let change = &self.b[..system.shape().unknowns];
            s.v.iter_mut().zip(change).for_each(|(v, d)| *v += d);
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
        let matrix = system.acceleration_matrix();
        if matrix.is_constant() {
            return Ok(false);
        }
        self.renew_level(system, s)?;
        self.in_singular_pose =
            system.shape().multipliers > 0 && matrix.pivot_range(&self.acceleration) < SINGULAR;
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
        self.counters.operations += self.costs.residual + self.costs.level_solve;
        system.free_residual(s, &mut self.r, work);
        system.constraint_acceleration(s, &mut self.phi);
        let (b, rows) = self.b.split_at_mut(n);
        b.iter_mut().zip(&self.r).for_each(|(b, r)| *b = -r);
        rows.iter_mut()
            .zip(&self.phi)
            .for_each(|(b, phi)| *b = -phi);
        let matrix = system.acceleration_matrix();
        matrix.solve(&mut self.acceleration, &mut self.b);
        let (a, lambda) = self.b.split_at(n);
        s.a[..n].copy_from_slice(a);
        s.lambda.copy_from_slice(lambda);
        not_finite(a)
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
        let matrix = system.acceleration_matrix();
        let matrix = matrix.to_dense(&self.acceleration.gradient);
        let Some(truncated) = Truncated::new(&matrix, n) else {
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
        not_finite(&s.a[..n])
    }

    /// Ends a stage on the position level: makes v and a consistent if there are constraints, then evaluates the integrands of
    /// the energy ledger. Returns the number of clamped contacts.
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
            self.prediction.solved(s);
            self.make_consistent(system, s, work)?;
            self.prediction.shifted(s);
        }
        Ok(self.finish_consistent_stage(system, s, work))
    }

    /// Ends a stage whose a and lambda are those of the acceleration level: evaluates the integrands of the energy ledger. Returns
    /// the number of clamped contacts.
    pub fn finish_consistent_stage(
        &mut self,
        system: &dyn System,
        s: &mut State,
        work: &mut Work,
    ) -> usize {
        self.prediction.finish(s);
        system.powers(s, work)
    }

    /// Ends a step of a scheme whose stages are on the acceleration level: projects q and v on the constraints and solves for
    /// (a, lambda) there.
    ///
    /// # Errors
    /// As [`Newton::project_positions`] and [`Newton::make_consistent`].
    pub fn return_to_constraints(
        &mut self,
        system: &dyn System,
        s: &mut State,
        work: &mut Work,
    ) -> Result<(), Failure> {
        self.project_positions(system, s)?;
        self.make_consistent(system, s, work)
    }

    /// The last step is not to be continued: forgets what its stages have found.
    pub fn forget_step(&mut self) {
        self.prediction.forget_step();
    }

    /// The motion goes on from a state that no step has led to.
    pub fn forget_motion(&mut self) {
        self.prediction.forget_all();
        self.tangents.iter_mut().for_each(Tangent::discard);
    }

    /// True where a state has been made consistent in a singular pose since [`Newton::forget_singular_pose`].
    pub fn met_singular_pose(&self) -> bool {
        self.met_singular_pose
    }

    /// Begins a step: forgets singular poses met before.
    pub fn forget_singular_pose(&mut self) {
        self.met_singular_pose = false;
    }

    /// Removes from local errors e, of velocities and of coordinates, the parts that do not stay in the motion: the part normal to
    /// the constraints, which the projection removes, and, for an `implicit` scheme, the modes faster than the step, which its
    /// stage matrix suppresses,
    ///
    /// ```text
    /// (M + w.v C + w.q K) x + Phi_q^T mu = M e        Phi_q x = 0
    /// ```
    ///
    /// (Hosea & Shampine 1996, Appl. Numer. Math. 20:21, for systems without constraints). In a singular pose the constraints do
    /// not determine the free directions; only that of the velocity v is known to be one. There x is the part of e along v.
    pub fn filter(
        &mut self,
        system: &dyn System,
        implicit: bool,
        v: &[f64],
        errors: [&mut [f64]; 2],
    ) {
        let n = system.shape().unknowns;
        let constrained = system.shape().multipliers > 0;
        let is_singular = constrained && self.in_singular_pose;
        if implicit && !is_singular {
            self.pair.fill([0.0; 2]);
            for (side, e) in errors.iter().enumerate() {
                system.momentum(e, &mut self.b);
                let momentum = self.pair.iter_mut().zip(&self.b[..n]);
                momentum.for_each(|(pair, b)| pair[side] = *b);
            }
            self.counters.operations += 2 * self.costs.solve;
            let [Tangent { factors, .. }, _] = &self.tangents;
            factors.solve_pair(system.symbolic(), &mut self.pair, &mut self.b);
            for (side, e) in errors.into_iter().enumerate() {
                e.iter_mut().zip(&self.pair).for_each(|(e, x)| *e = x[side]);
            }
            return;
        }
        if !constrained {
            return;
        }
        for e in errors {
            system.momentum(e, &mut self.b);
            if is_singular {
                let along: f64 = self.b[..n].iter().zip(v).map(|(b, v)| b * v).sum();
                system.momentum(&v[..n], &mut self.b);
                let square: f64 = self.b[..n].iter().zip(v).map(|(b, v)| b * v).sum();
                let part = if square > 0.0 { along / square } else { 0.0 };
                e.iter_mut().zip(v).for_each(|(e, v)| *e = part * v);
                continue;
            }
            self.b[n..].fill(0.0);
            self.counters.operations += self.costs.solve;
            let matrix = system.acceleration_matrix();
            matrix.solve(&mut self.acceleration, &mut self.b);
            e.copy_from_slice(&self.b[..n]);
        }
    }

    /// Solves the acceleration level with the right side (0, -phi).
    fn solve_for_phi(&mut self, system: &dyn System) {
        let n = system.shape().unknowns;
        self.counters.operations += self.costs.level_solve;
        for (b, phi) in self.b[n..].iter_mut().zip(&self.phi) {
            *b = -phi;
        }
        let matrix = system.acceleration_matrix();
        matrix.solve_rows(&mut self.acceleration, &mut self.b);
    }
}

//! Crossings of paths of equilibria, also of those that an imperfection has pulled apart.
//!
//! Where the stiffness has one small eigenvalue, of the direction c, the equations
//!
//! ```text
//! f(q, t) + Phi_q^T lambda + beta M c = 0    Phi(q, t) = 0    c^T M (q - q_0) = a c^T M c
//! ```
//!
//! are regular. They leave one function beta(a, t), the reduction of Lyapunov and Schmidt, which vanishes at equilibria. Paths cross
//! where it vanishes at a saddle, beta_a = beta_t = 0 and beta_aa beta_tt < beta_at^2, in the directions of
//! beta_aa a'^2 + 2 beta_at a' t' + beta_tt t'^2 = 0 (Keller 1977; Golubitsky & Schaeffer 1985, Singularities and Groups in
//! Bifurcation Theory, chapter II). At a limit point beta_t is not zero.
//!
//! A saddle at which beta does not vanish is the bifurcation of a perfect structure nearby: the one on which the force beta M c acts
//! (Moore 1980, Numer. Funct. Anal. Optim. 2:441). Its paths cross; those of the structure itself pass each other. The structure differs
//! from the perfect one as if it had, free of stress, the shape a c with a = beta/(t beta_at): Koiter's imperfection, which lowers the
//! load of a limit point by a part of order a^(2/3), while t at the saddle has an error of order a.

use super::load_path::{ArcMetric, DIFFERENCE, MAX_ITERATIONS, PathTangent, SetLoad};
use super::softest::SLOWEST;
use super::statics::{Ending, LAST_UPDATE, move_by};
use super::{Failure, Newton, iterate_interruptibly};
use crate::system::{Equilibrium, State, Work};

/// Updates of Newton's method for a saddle at least halve, by the theorem of Newton and Kantorovich.
const CONTRACTION: f64 = 0.5;

/// A crossing of two paths of a structure that is perfect, or nearly so.
#[derive(Debug, Clone)]
pub struct Crossing {
    /// Where they cross.
    pub state: State,
    /// The amplitude of the imperfection, the largest displacement of a point: as part of the size, or of the amplitude at which the
    /// load of the other path has changed by its own size, if this is smaller.
    pub imperfection: f64,
    /// The direction of the path on which the load changes faster, towards growing loads.
    pub along: PathTangent,
}

/// What the reduction starts from.
struct Origin<'a> {
    state: &'a State,
    /// M c, with c so long that its largest displacement is the size.
    momentum: Vec<f64>,
    /// c^T M c.
    mass: f64,
}

/// The reduction at (a, t), with t as part of the duration.
struct Reduction {
    by_amplitude: f64,
    by_load: f64,
    /// Changes of unknowns and multipliers with a and with t, ...
    amplitude: Vec<f64>,
    load: Vec<f64>,
    /// ... and how many of them are coordinates.
    coordinates: usize,
}

/// beta and the state on which it acts.
#[derive(Clone)]
struct Compensated {
    state: State,
    beta: f64,
    a: f64,
}

impl Compensated {
    /// To another a and t, to first order.
    fn go(&mut self, at: &Reduction, [a, load]: [f64; 2], duration: f64) {
        let changes = at.amplitude.iter().zip(&at.load);
        let changes: Vec<f64> = changes.map(|(x, y)| a * x + load * y).collect();
        move_by(&mut self.state, &changes);
        self.state.t += load * duration;
        self.beta += a * at.by_amplitude + load * at.by_load;
        self.a += a;
    }
}

impl Reduction {
    /// Of two directions (a', t') the one in which the load changes faster, towards growing loads.
    fn faster(&self, metric: ArcMetric, directions: [[f64; 2]; 2]) -> PathTangent {
        let [one, other] = directions.map(|[a, load]| {
            let unknowns = self.amplitude.iter().zip(&self.load);
            let unknowns = unknowns.map(|(x, y)| a * x + load * y).collect();
            PathTangent::normalised(metric, self.coordinates, unknowns, load)
        });
        let mut along = match one.load.abs() > other.load.abs() {
            true => one,
            false => other,
        };
        if along.load < 0.0 {
            along.reverse();
        }
        along
    }
}

/// Derivatives of beta beyond the first.
struct Second {
    aa: f64,
    at: f64,
    tt: f64,
    aaa: f64,
}

impl Second {
    fn discriminant(&self) -> f64 {
        self.at * self.at - self.aa * self.tt
    }

    /// The update of (a, t) by which the gradient would vanish.
    fn newton(&self, [by_amplitude, by_load]: [f64; 2]) -> [f64; 2] {
        [
            (self.tt * by_amplitude - self.at * by_load) / self.discriminant(),
            (self.aa * by_load - self.at * by_amplitude) / self.discriminant(),
        ]
    }

    /// The directions (a', t') of the two paths at a saddle.
    fn directions(&self) -> Option<[[f64; 2]; 2]> {
        let discriminant = self.discriminant();
        let root = -(self.at + discriminant.sqrt().copysign(self.at));
        (discriminant > 0.0).then_some([[root, self.aa], [self.tt, root]])
    }

    /// That of beta at the saddle, at a t as part of the duration.
    fn imperfection(&self, beta: f64, t: f64) -> f64 {
        let weakens = t * self.at;
        let asymmetric = (self.aa / (2.0 * weakens)).abs();
        let symmetric = (self.aaa / (6.0 * weakens)).abs().sqrt();
        (beta / weakens).abs() * asymmetric.max(symmetric).max(1.0)
    }
}

fn product(x: &[f64], y: &[f64]) -> f64 {
    x.iter().zip(y).map(|(x, y)| x * y).sum()
}

impl Newton {
    /// The crossing near an equilibrium, whose stiffness has the smallest eigenvalue in `direction`; none where Newton's method does
    /// not lead to one.
    ///
    /// # Errors
    /// See [`Failure`]; there is no crossing nearby.
    pub fn crossing<E: From<Failure>>(
        &mut self,
        system: &dyn Equilibrium,
        metric: ArcMetric,
        set_load: SetLoad<E>,
        (near, direction): (&State, &[f64]),
        work: &mut Work,
    ) -> Result<Option<Crossing>, E> {
        let (_, farthest) = metric.extent.farthest(direction.iter().copied());
        let scale = metric.extent.size / farthest;
        let c: Vec<f64> = direction.iter().map(|x| scale * x).collect();
        let mut momentum = vec![0.0; c.len()];
        system.momentum(&c, &mut momentum);
        let origin = Origin {
            mass: product(&c, &momentum),
            momentum,
            state: near,
        };
        let mut at = Compensated {
            state: near.clone(),
            beta: 0.0,
            a: 0.0,
        };
        let mut last = f64::INFINITY;
        for _ in 0..MAX_ITERATIONS {
            let here = self.reduce(system, metric, set_load, &origin, &mut at, work)?;
            let mut beside = |way: [f64; 2]| {
                let mut near = at.clone();
                near.go(&here, way, metric.duration);
                set_load(&mut near.state, work)?;
                let there = self.reduce(system, metric, set_load, &origin, &mut near, work)?;
                Ok::<_, E>([
                    (there.by_amplitude - here.by_amplitude) / DIFFERENCE,
                    (there.by_load - here.by_load) / DIFFERENCE,
                ])
            };
            let [after, _] = beside([DIFFERENCE, 0.0])?;
            let [before, _] = beside([-DIFFERENCE, 0.0])?;
            let [mixed, by_load_twice] = beside([0.0, DIFFERENCE])?;
            let second = Second {
                aa: 0.5 * (after - before),
                at: mixed,
                tt: by_load_twice,
                aaa: (after + before) / DIFFERENCE,
            };
            let update = second.newton([here.by_amplitude, here.by_load]);
            let size = update[0].hypot(update[1]);
            if !(size.is_finite() && size <= CONTRACTION * last) {
                return Ok(None);
            }
            at.go(&here, update, metric.duration);
            set_load(&mut at.state, work)?;
            if size <= LAST_UPDATE {
                return Ok(second.directions().map(|directions| Crossing {
                    imperfection: second.imperfection(at.beta, at.state.t / metric.duration),
                    along: here.faster(metric, directions),
                    state: at.state,
                }));
            }
            last = size;
        }
        Ok(None)
    }

    /// The compensated equilibrium at its a and t, from a state nearby.
    fn reduce<E: From<Failure>>(
        &mut self,
        system: &dyn Equilibrium,
        metric: ArcMetric,
        set_load: SetLoad<E>,
        origin: &Origin,
        at: &mut Compensated,
        work: &mut Work,
    ) -> Result<Reduction, E> {
        let n = system.shape().unknowns;
        let Compensated { state, beta, a } = at;
        state.v.fill(0.0);
        state.a.fill(0.0);
        self.counters.stages += 1;
        let mut ending = Ending::default();
        let (mut scale, mut shift) = (1.0, 0.0);
        // K^-1 M c, and its product with M c
        let (mut soft, mut softness) = (Vec::new(), 0.0);
        iterate_interruptibly(MAX_ITERATIONS, |iteration| {
            self.counters.newton_iterations += 1;
            shift = 0.0;
            scale = match self.renew_stiffness(system, state, shift, work) {
                Err(Failure::Singular { .. }) => {
                    shift = SLOWEST;
                    self.renew_stiffness(system, state, shift, work)?
                }
                scale => scale?,
            };
            for (r, m) in self.r[..n].iter_mut().zip(&origin.momentum) {
                *r += *beta * m;
            }
            self.solve_against_residual(system, scale);
            let mut change = self.b.clone();
            self.b[..n].copy_from_slice(&origin.momentum);
            self.b[n..].fill(0.0);
            self.solve_for_equilibrium(system, scale);
            soft.clone_from(&self.b);
            softness = product(&soft[..n], &origin.momentum);
            let moved: Vec<f64> = (0..n)
                .map(|i| state.q[i] - origin.state.q[i] + change[i])
                .collect();
            let growth = (product(&moved, &origin.momentum) - *a * origin.mass) / softness;
            for (x, d) in change.iter_mut().zip(&soft) {
                *x -= growth * d;
            }
            *beta += growth;
            move_by(state, &change);
            let update = metric.extent.update(&change[..n]);
            Ok((
                update,
                ending.is_reached(iteration, update, metric.extent, state),
            ))
        })?;
        state.q_low.fill(0.0);
        let mut load = self.follow_load(system, metric, set_load, state, scale, work)?;
        let by_load = product(&load[..n], &origin.momentum) / softness;
        for (x, d) in load.iter_mut().zip(&soft) {
            *x -= by_load * d;
        }
        let amplitude = soft.iter().map(|x| x * origin.mass / softness).collect();
        Ok(Reduction {
            by_amplitude: shift - origin.mass / softness,
            by_load,
            amplitude,
            load,
            coordinates: n,
        })
    }
}

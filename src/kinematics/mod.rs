//! Inverse kinematics of the ideal rigid mechanism: the driven body follows its path, which determines all other bodies.
//!
//! The mechanism is compiled like any other, rigid and with ideal joints, the driven body known. Its constraints then
//! determine all coordinates: Newton on Phi(q) = 0, and linear solves of Phi_q v = 0 and Phi_q a = gamma give exact rates.
//! The linear systems are those of the acceleration level with unit masses, \[\[I, Phi_q^T\], \[Phi_q, 0\]\], whose
//! solution is the one of least norm.

mod inverse_jacobian;
pub(crate) mod limit;
mod series;

pub(crate) use inverse_jacobian::UnitMotions;

use crate::checkpoint::carried;
use crate::math::plane::pair;
use crate::math::saddle_point::SaddleFactors;
use crate::model::Model;
use crate::motion::Knot;
use crate::newton::{Failure, Update, iterate_interruptibly};
use crate::system::{PrescribeError, Prescribed, State, System};
use numbers::number;
use series::Series;
use std::sync::Arc;

/// After an update below this part of the mechanism the error is far below rounding, by the quadratic convergence of Newton's method.
const LAST_UPDATE: f64 = 1e-9;
/// An update below this part leaves the factors as good as they would be anew.
const SAME_POSE: f64 = 1e-15;

/// The ideal mechanism and where its coordinates stand among those of the real one.
#[derive(Debug)]
pub struct Kinematics {
    /// Rigid links, ideal joints, the driven body known.
    pub(crate) mechanism: Box<Model>,
    /// Index of its first coordinate in the real mechanism.
    pub(crate) offset: usize,
    /// Its coordinates at t = 0.
    pub(crate) start: Vec<f64>,
    /// Its coordinates that are not fixed.
    pub(crate) moving: Vec<usize>,
    /// The time in which the path passes through all its poses \[s\].
    pub(crate) period: f64,
    /// End of the motion \[s\].
    pub(crate) duration: f64,
    /// Length of the mechanism \[m\].
    pub(crate) size: f64,
    /// How far every unknown moves points of its body \[m\].
    pub(crate) lengths: Vec<f64>,
    /// Two links in series between known points: the loops whose closing can be described in words.
    pub(crate) dyads: Vec<Dyad>,
}

/// Two links whose common joint is found by intersecting two circles.
#[derive(Debug)]
pub(crate) struct Dyad {
    /// Known ends: first coordinate and the joint there.
    pub ends: [(usize, String); 2],
    /// Names and lengths of the links.
    pub links: [(String, f64); 2],
}

/// State and solver memory of the ideal mechanism.
#[derive(Debug, Clone)]
pub struct Inner {
    /// Its state.
    pub state: State,
    /// Constraint values.
    phi: Vec<f64>,
    /// Matrix of the acceleration level.
    factors: SaddleFactors,
    /// Right side, unknowns and multipliers.
    b: Vec<f64>,
    /// Its motion over a span of time.
    series: Series,
}

carried!(Inner { state, series } but { phi, factors, b });

/// The motion of the ideal mechanism, which the real one follows.
#[derive(Debug, Clone)]
struct IdealMotion {
    kinematics: Arc<Kinematics>,
    inner: Inner,
}

carried!(IdealMotion { inner } but { kinematics });

impl Prescribed for IdealMotion {
    fn follow(&mut self, from: &State, to: &mut State) -> Result<(), PrescribeError> {
        self.kinematics.prescribe(from, to, &mut self.inner)
    }

    fn knots(&self, until: f64) -> Vec<Knot> {
        self.kinematics.mechanism.motion_knots(until)
    }

    fn duplicate(&self) -> Box<dyn Prescribed> {
        Box::new(self.clone())
    }
}

impl Kinematics {
    /// The motion as one that a mechanism follows.
    pub fn motion(self: &Arc<Self>) -> Box<dyn Prescribed> {
        Box::new(IdealMotion {
            kinematics: self.clone(),
            inner: self.work(),
        })
    }

    /// Work memory with a state whose fixed coordinates are set.
    pub fn work(&self) -> Inner {
        let shape = self.mechanism.shape();
        let size = shape.unknowns + shape.multipliers;
        Inner {
            state: self.mechanism.blank_state(),
            phi: vec![0.0; shape.multipliers],
            factors: self.mechanism.acceleration_matrix().factors(),
            b: vec![0.0; size],
            series: Series::new(self.moving.len(), self.period),
        }
    }

    /// Sets the coordinates of the ideal mechanism in `to` at `to.t`, near those in `from`: from a series over a span of
    /// time where the motion is smooth, else by solving for them.
    ///
    /// # Errors
    /// When the mechanism cannot close, or its pose is singular.
    pub fn prescribe(
        &self,
        from: &State,
        to: &mut State,
        inner: &mut Inner,
    ) -> Result<(), PrescribeError> {
        if self.follow_series(from, to, inner) {
            return Ok(());
        }
        self.solve_at(from, to, inner)
    }

    /// Sets the coordinates of the ideal mechanism in `to` at `to.t` by solving for them, starting from those in `from`.
    ///
    /// # Errors
    /// As [`Kinematics::prescribe`].
    pub fn solve_at(
        &self,
        from: &State,
        to: &mut State,
        inner: &mut Inner,
    ) -> Result<(), PrescribeError> {
        self.begin(from, inner);
        self.move_to(to.t, inner)?;
        self.hand_over(inner, to);
        Ok(())
    }

    /// Writes its coordinates and rates among those of the real mechanism.
    pub(crate) fn hand_over(&self, inner: &Inner, to: &mut State) {
        let here = self.offset..self.offset + inner.state.q.len();
        to.q[here.clone()].copy_from_slice(&inner.state.q);
        to.v[here.clone()].copy_from_slice(&inner.state.v);
        to.a[here].copy_from_slice(&inner.state.a);
    }

    /// Takes over the coordinates in `from`.
    fn begin(&self, from: &State, inner: &mut Inner) {
        let here = self.offset..self.offset + inner.state.q.len();
        inner.state.t = from.t;
        inner.state.q.copy_from_slice(&from.q[here.clone()]);
        inner.state.v.copy_from_slice(&from.v[here.clone()]);
        inner.state.a.copy_from_slice(&from.a[here]);
    }

    /// Goes on to time t.
    fn move_to(&self, t: f64, inner: &mut Inner) -> Result<(), PrescribeError> {
        let s = &mut inner.state;
        let dt = t - s.t;
        s.t = t;
        for (q, (v, a)) in s.q.iter_mut().zip(s.v.iter().zip(&s.a)) {
            *q += dt * (v + 0.5 * dt * a);
        }
        self.solve(inner, 20)
    }

    /// Closes the mechanism at the time of `inner.state` from the coordinates in it, then finds the rates.
    ///
    /// # Errors
    /// When the mechanism cannot close, or its pose is singular.
    pub fn solve(&self, inner: &mut Inner, max_iterations: usize) -> Result<(), PrescribeError> {
        let mechanism = &*self.mechanism;
        let n = mechanism.shape().unknowns;
        mechanism.follow_rules(&mut inner.state);
        mechanism.move_driven_nodes(&mut inner.state);
        inner.state.v[..n].fill(0.0);
        inner.state.a[..n].fill(0.0);
        let mut last = 0.0;
        let closed = iterate_interruptibly(max_iterations, |_| {
            self.factor(inner)?;
            self.least_norm(inner);
            for (q, dq) in inner.state.q.iter_mut().zip(&inner.b[..n]) {
                *q += dq;
            }
            let moved = inner.b[..n].iter().zip(&self.lengths);
            let update = Update::largest(moved.map(|(dq, length)| dq * length));
            last = update.size / self.size;
            Ok((update, last <= LAST_UPDATE))
        });
        closed.map_err(|failure| self.explain(failure, inner))?;
        if last > SAME_POSE {
            let factored = self.factor(inner);
            factored.map_err(|failure| self.explain(failure, inner))?;
        }
        mechanism.constraint_velocity(&inner.state, &mut inner.phi);
        self.least_norm(inner);
        inner.state.v[..n].copy_from_slice(&inner.b[..n]);
        mechanism.constraint_acceleration(&inner.state, &mut inner.phi);
        self.least_norm(inner);
        inner.state.a[..n].copy_from_slice(&inner.b[..n]);
        Ok(())
    }

    /// Phi and the factors of \[\[L, Phi_q^T\], \[Phi_q, 0\]\] at the current coordinates, with the squared displacements of the unknowns
    /// in L. A weak pivot is that of a singular pose,
    /// which no exchange of rows removes.
    fn factor(&self, inner: &mut Inner) -> Result<(), Failure> {
        let Inner {
            state,
            phi,
            factors,
            ..
        } = inner;
        let mechanism = &self.mechanism;
        mechanism.acceleration_level(state, phi, &mut factors.gradient);
        Ok(mechanism.acceleration_matrix().factor(factors)?)
    }

    /// Why the mechanism has no pose.
    fn explain(&self, failure: Failure, inner: &Inner) -> PrescribeError {
        let closed = inner.phi.iter().all(|x| x.abs() < LAST_UPDATE * self.size);
        match failure {
            Failure::Singular { index } if closed => {
                let name = self.mechanism.unknown_name(index);
                let message = format!("the ideal rigid mechanism is in a singular pose ({name})");
                let t = inner.state.t;
                PrescribeError { message, t }
            }
            _ => self.cannot_close(&inner.state),
        }
    }

    /// Solves Phi_q x = -phi for the x of the least displacements: the first entries of `inner.b`.
    fn least_norm(&self, inner: &mut Inner) {
        let n = self.mechanism.shape().unknowns;
        for (b, phi) in inner.b[n..].iter_mut().zip(&inner.phi) {
            *b = -phi;
        }
        let matrix = self.mechanism.acceleration_matrix();
        matrix.solve_rows(&mut inner.factors, &mut inner.b);
    }

    fn cannot_close(&self, at: &State) -> PrescribeError {
        let t = at.t;
        let apart = self.dyads.iter().find_map(|dyad| dyad.apart(at));
        let message = apart.unwrap_or_else(|| match self.mechanism.worst_constraint(at) {
            Some((value, _, name)) => {
                let off = number(value, 4);
                format!("the ideal rigid mechanism cannot close: {name} is off by {off} m")
            }
            None => "the ideal rigid mechanism cannot follow the path".to_owned(),
        });
        PrescribeError { message, t }
    }
}

impl Dyad {
    /// Says that the two links are too short or too long for the distance between their ends, if they are.
    fn apart(&self, at: &State) -> Option<String> {
        let [(i, from), (j, to)] = &self.ends;
        let distance = (pair(&at.q, *i) - pair(&at.q, *j)).norm();
        let [(first, l1), (second, l2)] = &self.links;
        let (sum, difference) = (l1 + l2, (l1 - l2).abs());
        let why = match () {
            () if distance > sum => format!("exceeds {l1} m + {l2} m = {sum:.6} m"),
            () if distance < difference => {
                format!("is less than |{l1} m - {l2} m| = {difference:.6} m")
            }
            () => return None,
        };
        Some(format!(
            "{first} and {second} cannot close: |{from} {to}| = {distance:.6} m {why}"
        ))
    }
}

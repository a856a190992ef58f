//! Equilibrium: f(q) + Phi_q^T lambda = 0, Phi = 0, everything at rest.
//!
//! Without inertia the stiffness K may be singular although the mechanism is held by its constraints: a beam with a
//! prescribed direction is an example. K + s Phi_q^T Phi_q is regular and, with s Phi_q^T Phi added to the residual, has the
//! same solution for any s > 0; s is the largest stiffness on the diagonal. The constraints are written as s Phi = 0 and the
//! multipliers as lambda/s, so that all entries of the matrix are of similar size.

use crate::math::lu::DenseLu;
use crate::model::Model;
use crate::newton::{Counters, Failure};
use crate::system::{State, System, Weights, Work};

/// Largest number of Newton iterations of a load step; one that converges needs fewer.
const MAX_ITERATIONS: usize = 40;
/// An update below this part of the largest coordinate is followed by one more, whose error is the square of it.
const LAST_UPDATE: f64 = 1e-8;
/// An update below this part of the largest coordinate that no longer decreases is rounding.
const ROUNDING: f64 = 1e-12;
/// The load path from the undeformed start to the equilibrium is halved at most this many times.
const HALVINGS: i32 = 20;

/// Solver memory: allocated once, used for every load step.
#[derive(Debug)]
pub struct Statics {
    r: Vec<f64>,
    phi: Vec<f64>,
    k: Vec<f64>,
    b: Vec<f64>,
    /// Residual that is subtracted: zero except on the load path to an equilibrium start.
    offset: Vec<f64>,
    /// Work done so far.
    pub counters: Counters,
}

impl Statics {
    /// Memory for a model.
    pub fn new(model: &Model) -> Statics {
        let shape = model.shape();
        let size = shape.unknowns + shape.multipliers;
        Statics {
            r: vec![0.0; shape.coordinates],
            phi: vec![0.0; shape.multipliers],
            k: vec![0.0; model.symbolic().len()],
            b: vec![0.0; size],
            offset: vec![0.0; shape.unknowns],
            counters: Counters::default(),
        }
    }

    /// Equilibrium at the known coordinates and loads of `s`, from the q and lambda in it.
    ///
    /// # Errors
    /// See [`Failure`]; updates are reported in units of coordinates. `s` is then undefined.
    pub fn solve(&mut self, model: &Model, s: &mut State, work: &mut Work) -> Result<(), Failure> {
        let n = model.shape().unknowns;
        s.v.fill(0.0);
        s.a.fill(0.0);
        self.counters.stages += 1;
        let (mut last, mut worst, mut finishing) = (f64::INFINITY, 0, false);
        for _ in 0..MAX_ITERATIONS {
            self.counters.newton_iterations += 1;
            let scale = self.evaluate(model, s, work);
            for i in 0..n {
                self.b[i] = self.offset[i] - self.r[i];
            }
            for (b, phi) in self.b[n..].iter_mut().zip(&self.phi) {
                *b = -scale * phi;
            }
            self.factor_and_solve(model)?;
            let mut update = 0.0;
            for i in 0..n {
                s.q[i] += self.b[i];
                let size = self.b[i].abs();
                if size.is_nan() || size > update {
                    (update, worst) = (size, i);
                }
            }
            for (lambda, d) in s.lambda.iter_mut().zip(&self.b[n..]) {
                *lambda += scale * d;
            }
            if !update.is_finite() {
                return Err(Failure::NotFinite { index: worst });
            }
            let size = s.q.iter().fold(f64::MIN_POSITIVE, |m, q| m.max(q.abs()));
            if finishing && (update < last || update <= ROUNDING * size) {
                s.q_low.fill(0.0);
                return Ok(());
            }
            finishing = update <= LAST_UPDATE * size;
            last = update;
        }
        Err(Failure::NoConvergence {
            index: worst,
            update: last,
        })
    }

    /// Residual and tangent without inertia, stiffened where constraints act; returns the scale of the multipliers.
    fn evaluate(&mut self, model: &Model, s: &State, work: &mut Work) -> f64 {
        let w = Weights { q: 1.0, v: 0.0 };
        model.linearise(s, w, &mut self.r, &mut self.phi, &mut self.k, work);
        model.remove_mass(&mut self.k);
        model.augment(s, &mut self.r, &mut self.k)
    }

    fn factor_and_solve(&mut self, model: &Model) -> Result<(), Failure> {
        self.counters.factorisations += 1;
        let symbolic = model.symbolic();
        let full = self.k.clone();
        match symbolic.factor(&mut self.k) {
            Ok(()) => symbolic.solve(&self.k, &mut self.b),
            Err(weak) => {
                self.counters.fallbacks += 1;
                let dense = DenseLu::factor(symbolic, &full);
                dense
                    .ok_or(Failure::Singular { index: weak.index })?
                    .solve(&mut self.b);
            }
        }
        Ok(())
    }

    /// Equilibrium under the loads of `s` as they are, from an undeformed start: the residual of the start is taken off
    /// in parts, r(q) = (1 - p) r(q_0) with p from 0 to 1, in steps that halve where they fail.
    ///
    /// # Errors
    /// The failure of the smallest step.
    pub fn settle(&mut self, model: &Model, s: &mut State, work: &mut Work) -> Result<(), Failure> {
        let n = model.shape().unknowns;
        s.v.fill(0.0);
        s.a.fill(0.0);
        s.lambda.fill(0.0);
        self.evaluate(model, s, work);
        let first: Vec<f64> = self.r[..n].to_vec();
        let (mut part, mut step) = (0.0_f64, 1.0_f64);
        let mut reached = s.clone();
        while part < 1.0 {
            let next = (part + step).min(1.0);
            for (o, r) in self.offset.iter_mut().zip(&first) {
                *o = (1.0 - next) * r;
            }
            match self.solve(model, s, work) {
                Ok(()) => {
                    part = next;
                    step *= 2.0;
                    reached.copy_from(s);
                }
                Err(failure) if step < 2.0_f64.powi(-HALVINGS) => {
                    self.offset.fill(0.0);
                    return Err(failure);
                }
                Err(_) => {
                    step *= 0.5;
                    s.copy_from(&reached);
                }
            }
        }
        self.offset.fill(0.0);
        Ok(())
    }
}

//! The equations of a model: residual, tangent, rates, contact memory, powers.

use super::{Effect, Model};
use crate::force::{ClearanceJoint, WIDTH};
use crate::link::ElasticRoute;
use crate::math::lu::Symbolic;
use crate::system::{INTEGRALS, Integral, PrescribeError, Shape, State, System, Weights, Work};

/// Local coordinates of an element.
#[inline]
fn gather8(coordinates: &[usize], q: &[f64]) -> [f64; 8] {
    std::array::from_fn(|i| q[coordinates[i]])
}

impl Model {
    /// r = M a + weight.
    #[inline]
    fn inertia(&self, a: &[f64], r: &mut [f64]) {
        for (i, r) in r.iter_mut().enumerate() {
            let range = self.mass.row_start[i]..self.mass.row_start[i + 1];
            let row = self.mass.columns[range.clone()]
                .iter()
                .zip(&self.mass.values[range]);
            *r = row.map(|(&j, m)| m * a[j]).sum();
        }
        for &(i, weight) in &self.weight {
            r[i] += weight;
        }
    }

    /// Adds Phi_q^T lambda to r and sets phi.
    #[inline]
    fn constraints(&self, at: &State, r: &mut [f64], phi: &mut [f64]) {
        for c in &self.lengths {
            let gradient = c.term.gradient(&at.q);
            let lambda = at.lambda[c.row];
            phi[c.row] = c.term.value(&at.q);
            c.block.add_vector(&gradient.map(|g| g * lambda), r);
        }
        for c in &self.coincidences {
            let gradient = c.term.gradient(&at.q);
            let value = c.term.value(&at.q);
            phi[c.row..c.row + 2].copy_from_slice(&value);
            for (d, row) in gradient.rows.iter().enumerate() {
                let lambda = at.lambda[c.row + d];
                c.block.add_vector(&row.map(|g| g * lambda), r);
            }
        }
    }

    fn count(&self, work: &mut Work) {
        work.tally[Effect::Elastic as usize] += self.elements.len() as u64;
        work.tally[Effect::Length as usize] += self.lengths.len() as u64;
        work.tally[Effect::Coincidence as usize] += self.coincidences.len() as u64;
        work.tally[Effect::Gravity as usize] += u64::from(!self.weight.is_empty());
    }

    /// Sets the coordinates of the path-driven body at time `to.t`.
    pub(crate) fn follow_path(&self, to: &mut State) {
        if let Some(rule) = &self.path {
            let motion = rule.path.at(to.t);
            to.q[rule.x..rule.x + 3].copy_from_slice(&motion.position);
            to.v[rule.x..rule.x + 3].copy_from_slice(&motion.velocity);
            to.a[rule.x..rule.x + 3].copy_from_slice(&motion.acceleration);
        }
    }

    /// Sets the known nodes that ride on known bodies.
    pub(crate) fn ride(&self, to: &mut State) {
        for rider in &self.riders {
            let arm = rider.marker.arm(&to.q);
            let position = rider.marker.position(&to.q, arm);
            let velocity = rider.marker.velocity(&to.v, arm);
            let acceleration = rider.marker.acceleration(&to.v, &to.a, arm);
            for i in 0..2 {
                to.q[rider.x + i] = position[i];
                to.v[rider.x + i] = velocity[i];
                to.a[rider.x + i] = acceleration[i];
            }
        }
    }

    /// The loose joints, with and without friction, as geometry and memory index.
    fn clearances(&self) -> impl Iterator<Item = (&ClearanceJoint, usize)> {
        let smooth = self.loose.iter().map(|c| (&c.term, c.contact));
        smooth.chain(self.frictional.iter().map(|c| (&c.term.joint, c.contact)))
    }
}

impl System for Model {
    fn shape(&self) -> Shape {
        self.shape
    }

    fn symbolic(&self) -> &Symbolic {
        &self.symbolic
    }

    fn work(&self) -> Work {
        let inner = self.kinematics.as_ref().map(|k| Box::new(k.work()));
        Work {
            tally: [0; Effect::ALL.len()].to_vec(),
            inner,
        }
    }

    fn prescribe(
        &self,
        from: &State,
        to: &mut State,
        work: &mut Work,
    ) -> Result<(), PrescribeError> {
        let n = self.shape.unknowns;
        to.q[n..].copy_from_slice(&from.q[n..]);
        to.v[n..].copy_from_slice(&from.v[n..]);
        to.a[n..].copy_from_slice(&from.a[n..]);
        self.follow_path(to);
        if let Some(kinematics) = &self.kinematics {
            work.tally[Effect::InverseKinematics as usize] += 1;
            let inner = work
                .inner
                .as_mut()
                .expect("a model with a drive has work memory for it");
            kinematics.prescribe(from, to, inner)?;
        }
        self.ride(to);
        Ok(())
    }

    fn residual(&self, at: &State, r: &mut [f64], phi: &mut [f64], work: &mut Work) {
        self.count(work);
        self.inertia(&at.a, r);
        for e in &self.elements {
            let mut f = [0.0; 8];
            e.kernel
                .force(&gather8(&e.block.coordinates, &at.q), &mut f);
            e.block.add_vector(&f, r);
        }
        self.constraints(at, r, phi);
        for c in &self.loose {
            let mut f = [0.0; WIDTH];
            if c.term
                .force(&at.q, &at.v, at.z[c.contact], &mut f)
                .is_some()
            {
                work.tally[Effect::Contact as usize] += 1;
                c.block.add_vector(&f, r);
            }
        }
        for c in &self.frictional {
            let mut f = [0.0; WIDTH];
            if c.term
                .force(&at.q, &at.v, at.z[c.contact], &mut f)
                .is_some()
            {
                work.tally[Effect::Contact as usize] += 1;
                work.tally[Effect::Friction as usize] += 1;
                c.block.add_vector(&f, r);
            }
        }
    }

    fn linearise(
        &self,
        at: &State,
        w: Weights,
        r: &mut [f64],
        phi: &mut [f64],
        k: &mut [f64],
        work: &mut Work,
    ) {
        self.count(work);
        k.copy_from_slice(&self.mass.tangent);
        self.inertia(&at.a, r);
        for e in &self.elements {
            let (mut f, mut tangent) = ([0.0; 8], [[0.0; 8]; 8]);
            e.kernel
                .force_and_tangent(&gather8(&e.block.coordinates, &at.q), &mut f, &mut tangent);
            e.block.add_vector(&f, r);
            e.block.add_matrix(&tangent, w.q, k);
        }
        self.constraints(at, r, phi);
        for c in &self.lengths {
            let s = w.q * c.term.curvature(at.lambda[c.row]);
            let n = 4;
            for i in 0..n {
                k[c.block.slots[i * n + i] as usize] += s;
                k[c.block.slots[i * n + (i + 2) % n] as usize] -= s;
            }
            c.border[0].set(&c.term.gradient(&at.q), k);
        }
        for c in &self.coincidences {
            let n = c.block.coordinates.len();
            let lambda = [at.lambda[c.row], at.lambda[c.row + 1]];
            for (i, bend) in c.term.curvature(&at.q, lambda).into_iter().flatten() {
                k[c.block.slots[i * n + i] as usize] += w.q * bend;
            }
            let gradient = c.term.gradient(&at.q);
            for (border, row) in c.border.iter().zip(&gradient.rows) {
                border.set(&row[..gradient.columns], k);
            }
        }
        for c in &self.loose {
            let (mut f, mut tangent) = ([0.0; WIDTH], [[0.0; WIDTH]; WIDTH]);
            if c.term
                .force_and_tangent(&at.q, &at.v, at.z[c.contact], w, &mut f, &mut tangent)
                .is_some()
            {
                work.tally[Effect::Contact as usize] += 1;
                c.block.add_vector(&f, r);
                c.block.add_matrix(&tangent, 1.0, k);
            }
        }
        for c in &self.frictional {
            let (mut f, mut tangent) = ([0.0; WIDTH], [[0.0; WIDTH]; WIDTH]);
            if c.term
                .force_and_tangent(&at.q, &at.v, at.z[c.contact], w, &mut f, &mut tangent)
                .is_some()
            {
                work.tally[Effect::Contact as usize] += 1;
                work.tally[Effect::Friction as usize] += 1;
                c.block.add_vector(&f, r);
                c.block.add_matrix(&tangent, 1.0, k);
            }
        }
    }

    fn constraint_velocity(&self, at: &State, out: &mut [f64]) {
        for c in &self.lengths {
            out[c.row] = c.term.velocity(at);
        }
        for c in &self.coincidences {
            out[c.row..c.row + 2].copy_from_slice(&c.term.velocity(at));
        }
    }

    fn constraint_acceleration(&self, at: &State, out: &mut [f64]) {
        for c in &self.lengths {
            out[c.row] = c.term.acceleration(at);
        }
        for c in &self.coincidences {
            out[c.row..c.row + 2].copy_from_slice(&c.term.acceleration(at));
        }
    }

    fn gaps(&self, at: &State, delta: &mut [f64], rate: &mut [f64]) {
        for (joint, contact) in self.clearances() {
            let g = joint.geometry(&at.q, &at.v);
            delta[contact] = g.delta;
            rate[contact] = ClearanceJoint::rate(&g);
        }
    }

    fn commit(
        &self,
        at: &mut State,
        tolerance: f64,
        onset: &mut dyn FnMut(usize, f64, f64),
    ) -> usize {
        let mut onsets = 0;
        for (joint, contact) in self.clearances() {
            let g = joint.geometry(&at.q, &at.v);
            let rate = ClearanceJoint::rate(&g);
            let open = at.z[contact] == 0.0;
            if open && (g.delta >= -tolerance && rate > 0.0 || g.delta > tolerance) {
                // a journal that starts inside the bearing's wall has no impact velocity: the law's floor stands in
                at.z[contact] = rate.max(f64::MIN_POSITIVE);
                onset(contact, rate, g.delta);
                onsets += 1;
            } else if !open && (g.delta < -tolerance || g.delta <= tolerance && rate <= 0.0) {
                at.z[contact] = 0.0;
            }
        }
        onsets
    }

    fn powers(&self, at: &mut State, work: &mut Work) -> usize {
        let mut powers = [0.0; INTEGRALS];
        let mut clamps = 0;
        powers[Integral::Work as usize] = self.drive_power(at, work);
        for (joint, contact) in self.clearances() {
            let g = joint.geometry(&at.q, &at.v);
            if let Some(force) = joint.normal_force(&g, at.z[contact]) {
                let rate = ClearanceJoint::rate(&g);
                let loss = (force.value - force.elastic) * rate;
                powers[Integral::ContactDissipated as usize] += loss;
                if force.clamped {
                    clamps += 1;
                    powers[Integral::Clamp as usize] += loss;
                }
            }
        }
        for c in &self.frictional {
            powers[Integral::FrictionDissipated as usize] +=
                c.term.dissipation(&at.q, &at.v, at.z[c.contact]);
        }
        at.powers = powers;
        clamps
    }

    fn unknown_name(&self, index: usize) -> String {
        self.names[index].clone()
    }
}

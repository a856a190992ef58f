//! The equations of a model: residual, tangent, rates, contact memory, powers.

use super::memory::{contact_state, is_closed};
use super::{Model, PlacedContact, PlacedEccentric, Rule};
use crate::constraint::{self, Curvature, ROWS};
use crate::contact;
use crate::force::WIDTH;
use crate::ledger::{OF_WORK, Powers};
use crate::link::{AncfCable, ElasticRoute};
use crate::math::lu::Symbolic;
use crate::math::plane::{quarter_turn, rotation};
use crate::math::saddle_point::SaddlePoint;
use crate::system::{
    Changed, Equilibrium, InternalState, Operations, PrescribeError, Shape, State, System, Weights,
    Work,
};

/// Local coordinates of an element.
#[inline]
fn gather8(coordinates: &[usize], q: &[f64]) -> [f64; 8] {
    std::array::from_fn(|i| q[coordinates[i]])
}

impl Model {
    /// r = M a + weight, in the rows of unknown coordinates.
    #[inline]
    fn inertia(&self, at: &State, r: &mut [f64]) {
        let (rows, others) = r.split_at_mut(self.shape.unknowns);
        self.mass.product.times(&at.a, rows);
        others.fill(0.0);
        self.known_loads(at, r);
    }

    /// Adds the inertia forces of known accelerations, the couples of eccentric masses, and the weight. Forces of eccentric masses
    /// act on known coordinates.
    #[inline]
    fn known_loads(&self, at: &State, r: &mut [f64]) {
        for PlacedEccentric { mass, .. } in &self.eccentric {
            r[mass.pose[2]] += mass.couple(at);
        }
        for &(i, j, m) in &self.mass.known {
            r[i] += m * at.a[j];
        }
        for &(i, weight) in &self.weight {
            r[i] += at.weight * weight;
        }
    }

    /// Adds Phi_q^T lambda to r and sets phi.
    #[inline]
    fn constraints(&self, at: &State, r: &mut [f64], phi: &mut [f64]) {
        let mut gradient = [[0.0; constraint::WIDTH]; ROWS];
        for c in &self.constraints {
            let value = c.term.value_and_gradient(at, &mut gradient);
            for d in 0..c.rows {
                phi[c.row + d] = c.kept[d] * value[d];
                c.block.add_scaled(at.lambda[c.row + d], &gradient[d], r);
            }
        }
    }

    /// As [`Model::constraints`]; also adds to the tangent.
    #[inline]
    fn linearised_constraints(
        &self,
        at: &State,
        w: Weights,
        r: &mut [f64],
        phi: &mut [f64],
        k: &mut [f64],
    ) {
        let mut gradient = [[0.0; constraint::WIDTH]; ROWS];
        for c in &self.constraints {
            let value = c.term.value_and_gradient(at, &mut gradient);
            for d in 0..c.rows {
                phi[c.row + d] = c.kept[d] * value[d];
                c.block.add_scaled(at.lambda[c.row + d], &gradient[d], r);
                c.border[d].add(&gradient[d], k);
            }
            let mut out = Curvature {
                slots: &c.block.slots,
                columns: c.block.coordinates.len(),
                weight: w.q,
                tangent: k,
            };
            c.term.curvature(at, c.multipliers(at), &mut out);
        }
    }

    /// The closed contacts; open ones have no force.
    #[inline]
    fn closed_contacts<'a>(
        &'a self,
        at: &'a State,
    ) -> impl Iterator<Item = (&'a PlacedContact, contact::ContactState<'a>)> {
        let contacts = self.contacts.iter().enumerate();
        let closed = contacts.filter(|(i, _)| is_closed(at, *i));
        closed.map(|(i, c)| (c, contact_state(at, i)))
    }

    /// Adds elastic forces, forces without memory and contact forces to r.
    #[inline]
    fn forces(&self, at: &State, r: &mut [f64], work: &mut Work) {
        for e in &self.elements {
            let mut f = [0.0; 8];
            e.kernel
                .force(&gather8(&e.block.coordinates, &at.q), &mut f);
            e.block.add_vector(&f, r);
        }
        for acting in &self.forces {
            let mut f = [0.0; WIDTH];
            acting.term.force(at, &mut f);
            acting.block.add_vector(&f, r);
        }
        for (c, state) in self.closed_contacts(at) {
            let mut f = [0.0; WIDTH];
            if c.pair.force(state, &mut f) {
                c.count(work);
                c.block.add_vector(&f, r);
            }
        }
    }

    /// Adds the same to r, and their tangents to k.
    #[inline]
    fn linearised_forces(
        &self,
        at: &State,
        w: Weights,
        r: &mut [f64],
        k: &mut [f64],
        work: &mut Work,
    ) {
        for e in &self.elements {
            let mut f = [0.0; 8];
            let q = gather8(&e.block.coordinates, &at.q);
            let tangent = e.kernel.linearised(&q, &mut f);
            e.block.add_vector(&f, r);
            e.block.add_matrix(&tangent, w.q, k);
        }
        for acting in &self.forces {
            let (mut f, mut tangent) = ([0.0; WIDTH], [[0.0; WIDTH]; WIDTH]);
            acting.term.force_and_tangent(at, w, &mut f, &mut tangent);
            acting.block.add_vector(&f, r);
            acting.block.add_matrix(&tangent, 1.0, k);
        }
        for (c, state) in self.closed_contacts(at) {
            let (mut f, mut tangent) = ([0.0; WIDTH], [[0.0; WIDTH]; WIDTH]);
            if c.pair.force_and_tangent(state, w, &mut f, &mut tangent) {
                c.count(work);
                c.block.add_vector(&f, r);
                c.block.add_matrix(&tangent, 1.0, k);
            }
        }
    }

    /// Subtracts the masses from a tangent; the entries of dropped rows remain.
    fn scale_mass(&self, factor: f64, k: &mut [f64]) {
        for (k, m) in k.iter_mut().zip(&self.mass.tangent) {
            *k -= (1.0 - factor) * m;
        }
        for p in &self.constraints {
            for d in (0..p.rows).filter(|&d| p.kept[d] == 0.0) {
                let m = self.shape.unknowns + p.row + d;
                k[self.symbolic.slot(m, m) as usize] = 1.0;
            }
        }
    }

    /// Adds s Phi_q^T Phi_q to a tangent and s Phi_q^T Phi to the residual, where s is the largest stiffness on the diagonal of the
    /// tangent against displacements of points, and multiplies the constraint rows and columns by s. Returns s.
    fn augment(&self, at: &State, r: &mut [f64], k: &mut [f64]) -> f64 {
        let lengths = self.lengths().into_iter().enumerate();
        let lengths = lengths.filter(|(_, length)| *length > 0.0);
        let stiffness = lengths
            .map(|(i, length)| k[self.symbolic.slot(i, i) as usize].abs() / (length * length));
        let s = match stiffness.fold(0.0, f64::max) {
            0.0 => 1.0,
            largest => largest,
        };
        for p in &self.constraints {
            let (value, gradient) = (p.term.value(at), p.term.gradient(at));
            let columns = p.block.coordinates.len();
            for d in (0..p.rows).filter(|&d| p.kept[d] != 0.0) {
                // s - 1 would lose the digits of a small s
                p.border[d].add(&gradient[d].map(|g| -g), k);
                p.border[d].add(&gradient[d].map(|g| s * g), k);
                for i in 0..columns {
                    r[p.block.coordinates[i]] += s * gradient[d][i] * value[d];
                    for j in 0..columns {
                        let slot = p.block.slots[i * columns + j] as usize;
                        k[slot] += s * gradient[d][i] * gradient[d][j];
                    }
                }
            }
        }
        s
    }

    fn count(&self, work: &mut Work) {
        for &(counter, count) in &self.counts {
            work.tally[counter] += count;
        }
    }

    /// Sets the coordinates that are functions of time, at time `to.t`.
    pub(crate) fn follow_rules(&self, to: &mut State) {
        for rule in &self.rules {
            match rule {
                Rule::Path { x, path } => {
                    let pose = path.at(to.t);
                    to.q[*x..x + 3].copy_from_slice(&pose.position);
                    to.v[*x..x + 3].copy_from_slice(&pose.velocity);
                    to.a[*x..x + 3].copy_from_slice(&pose.acceleration);
                }
                Rule::Turn {
                    pivot,
                    point: (x, s),
                    theta,
                    angle,
                    sign,
                } => {
                    let [phi, rate, growth] = angle.at(to.t).map(|x| sign * x);
                    let arm = rotation(phi) * s;
                    let turn = quarter_turn(arm);
                    for i in 0..2 {
                        to.q[x + i] = to.q[pivot + i] + arm[i];
                        to.v[x + i] = rate * turn[i];
                        to.a[x + i] = growth * turn[i] - rate * rate * arm[i];
                    }
                    if let Some(theta) = *theta {
                        (to.q[theta], to.v[theta], to.a[theta]) = (phi, rate, growth);
                    }
                }
            }
        }
    }

    /// Sets the known nodes that are fixed to known bodies.
    pub(crate) fn move_driven_nodes(&self, to: &mut State) {
        for driven_node in &self.driven_nodes {
            let arm = driven_node.marker.arm(&to.q);
            let position = driven_node.marker.position(&to.q, arm);
            let velocity = driven_node.marker.velocity(&to.v, arm);
            let acceleration = driven_node.marker.acceleration(&to.v, &to.a, arm);
            for i in 0..2 {
                to.q[driven_node.x + i] = position[i];
                to.v[driven_node.x + i] = velocity[i];
                to.a[driven_node.x + i] = acceleration[i];
            }
        }
    }
}

impl System for Model {
    fn shape(&self) -> Shape {
        self.shape
    }

    fn states(&self) -> &[InternalState] {
        &self.states
    }

    fn symbolic(&self) -> &Symbolic {
        &self.symbolic
    }

    fn acceleration_matrix(&self) -> &SaddlePoint {
        &self.acceleration_matrix
    }

    fn operations(&self) -> Operations {
        let elements = self.elements.len() as u64;
        let [force, with_tangent] = AncfCable::OPERATIONS;
        let constraints = self.constraints.iter().map(|c| &c.block);
        let forces = self.forces.iter().map(|f| &f.block);
        let contacts = self.contacts.iter().map(|c| &c.block);
        let blocks = constraints.chain(forces).chain(contacts);
        let terms = blocks.map(|block| block.coordinates.len() as u64);
        // a term takes some operations with each local coordinate, and some with each entry of its tangent
        let [linear, square] = terms.fold([0, 0], |[a, b], n| [a + 8 * n, b + 3 * n * n]);
        let residual = self.mass.entries.len() as u64 + elements * force + linear;
        Operations {
            residual,
            tangent: residual + elements * (with_tangent - force) + square,
        }
    }

    fn work(&self) -> Work {
        Work {
            tally: vec![0; self.effects.len()],
            prescribed: self.prescribed.clone(),
        }
    }

    fn prescribe(
        &self,
        from: &State,
        to: &mut State,
        work: &mut Work,
    ) -> Result<(), PrescribeError> {
        to.copy_known(from);
        self.follow_rules(to);
        for motion in &mut work.prescribed {
            work.tally[self.kinematics_counter] += 1;
            motion.follow(from, to)?;
        }
        self.move_driven_nodes(to);
        Ok(())
    }

    fn momentum(&self, x: &[f64], out: &mut [f64]) {
        self.mass.product.times(x, out);
    }

    fn residual(&self, at: &State, r: &mut [f64], phi: &mut [f64], work: &mut Work) {
        self.count(work);
        self.inertia(at, r);
        self.constraints(at, r, phi);
        self.forces(at, r, work);
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
        self.inertia(at, r);
        for PlacedEccentric { mass, slot } in &self.eccentric {
            k[*slot as usize] += w.q * mass.stiffness(at);
        }
        self.linearised_constraints(at, w, r, phi, k);
        self.linearised_forces(at, w, r, k, work);
    }

    fn acceleration_level(&self, at: &State, phi: &mut [f64], gradient: &mut [f64]) {
        let mut local = [[0.0; constraint::WIDTH]; ROWS];
        for c in &self.constraints {
            let value = c.term.value_and_gradient(at, &mut local);
            for d in 0..c.rows {
                phi[c.row + d] = c.kept[d] * value[d];
                for (&entry, g) in c.entries[d].iter().zip(&local[d]) {
                    gradient[entry as usize] = *g;
                }
            }
        }
    }

    fn free_residual(&self, at: &State, r: &mut [f64], work: &mut Work) {
        self.count(work);
        r.fill(0.0);
        self.known_loads(at, r);
        self.forces(at, r, work);
    }

    fn constraint_velocity(&self, at: &State, out: &mut [f64]) {
        for c in &self.constraints {
            let rate = c.term.velocity(at);
            for d in 0..c.rows {
                out[c.row + d] = c.kept[d] * rate[d];
            }
        }
    }

    fn constraint_acceleration(&self, at: &State, out: &mut [f64]) {
        for c in &self.constraints {
            let rate = c.term.acceleration(at);
            for d in 0..c.rows {
                out[c.row + d] = c.kept[d] * rate[d];
            }
        }
    }

    fn crossings(&self, at: &State, crossings: &mut [[f64; 2]]) {
        self.measure_crossings(at, crossings);
    }

    fn next_instant(&self, at: &State) -> f64 {
        self.instant_after(at)
    }

    fn commit(
        &self,
        at: &mut State,
        crossings: &[[f64; 2]],
        tolerance: f64,
        changed: &mut dyn FnMut(Changed),
    ) {
        self.commit_contacts(at, crossings, tolerance, changed);
        self.commit_forces(at, crossings, tolerance, changed);
    }

    fn powers(&self, at: &mut State, work: &mut Work) -> usize {
        let mut all = std::mem::take(&mut at.powers);
        let mut clamps = 0;
        all.fill(0.0);
        all[OF_WORK] = self.drive_power(at, work) + self.drift_power(at);
        for (c, state) in self.closed_contacts(at) {
            let mut powers = Powers {
                all: &mut all,
                own: &c.entries,
            };
            clamps += usize::from(c.pair.powers(state, &mut powers));
        }
        for acting in &self.forces {
            let mut powers = Powers {
                all: &mut all,
                own: &acting.entries,
            };
            acting.term.powers(at, &mut powers);
        }
        at.powers = all;
        clamps
    }

    fn is_smooth(&self, at: &State) -> bool {
        self.closed(at).next().is_none() && self.forces.iter().all(|acting| acting.term.is_smooth())
    }

    fn unknown_name(&self, index: usize) -> String {
        self.names[index].clone()
    }
}

impl Equilibrium for Model {
    fn plain_stiffness(&self, at: &State, work: &mut Work) -> Vec<f64> {
        let (mut r, mut phi) = (vec![0.0; at.q.len()], vec![0.0; at.lambda.len()]);
        let mut k = vec![0.0; self.symbolic.len()];
        self.linearise(
            at,
            Weights { q: 1.0, v: 0.0 },
            &mut r,
            &mut phi,
            &mut k,
            work,
        );
        self.scale_mass(0.0, &mut k);
        k
    }

    fn stiffness(
        &self,
        at: &State,
        inertia: f64,
        r: &mut [f64],
        phi: &mut [f64],
        k: &mut [f64],
        work: &mut Work,
    ) -> f64 {
        self.linearise(at, Weights { q: 1.0, v: 0.0 }, r, phi, k, work);
        self.scale_mass(inertia, k);
        self.augment(at, r, k)
    }
}

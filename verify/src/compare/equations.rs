//! The assembled equations of a scene at random states near its motion, term by term.

use super::scenes;
use crate::check::{Agreement, LargestDifference};
use crate::embedding::{self, Embedding};
use crate::reference::{ConstraintRows, ReferenceScene, ReferenceState};
use crate::trajectory::ComparisonPlan;
use looselink::body::{RigidBody, RigidLink};
use looselink::model::Model;
use looselink::scene::{Analysis, Scene};
use looselink::simulate::{Recording, Simulation};
use looselink::system::{State, System, Weights};
use miette::{IntoDiagnostic, Result};
use nalgebra::{DMatrix, DVector, Dim, Dyn, Matrix, VecStorage};
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use std::collections::BTreeMap;

/// States a scene is tried at.
pub const STATES: usize = 50;
/// Relative to the largest entry of each part.
const TOLERANCE: f64 = 1e-11;
/// The same where the reference's rows are differenced over [`SPAN`]: 1e-10 of truncation and rounding, and a reserve.
const DIFFERENCING: f64 = 1e-8;
/// Rounding of the eight coordinates of an element, or of as many terms, over their size.
const ROUNDING: f64 = 2e-15;
/// Span of central differences of the rows: coordinates in m, angles in rad.
const SPAN: f64 = 1e-5;

/// Scenes whose equations are compared: those of the list, and all that move.
pub fn plans() -> Result<Vec<ComparisonPlan>> {
    Ok([super::plans().equations, scenes::of(Analysis::Dynamic)?].concat())
}

/// Both sides of a scene and the way between their coordinates.
struct ScenePair {
    simulation: Simulation,
    reference: ReferenceScene,
    embedding: Embedding,
    /// Looselink's constraint rows as combinations of those of the reference.
    rows: DMatrix<f64>,
    /// The joint of each contact.
    contacts: Vec<usize>,
    /// M of the full coordinates.
    mass: DMatrix<f64>,
    /// How far coordinates are moved \[m, rad\].
    spread: f64,
}

/// A part of the equations: its name, and the measure of the difference with the reason of what is allowed.
type Part = (&'static str, &'static str);
const RELATIVE: &str = "relative to the largest entry; rounding";
const STRAINS: &str =
    "relative to the largest entry, or to what rounding of the coordinates does to it; rounding";
const MASS: Part = ("assembled mass matrix", RELATIVE);
const OPEN: Part = ("assembled force, contacts open", STRAINS);
const CLOSED: Part = ("assembled force, contacts closed", STRAINS);
const DAMPING: Part = ("assembled df/dv", RELATIVE);
const STIFFNESS: Part = ("assembled df/dq", RELATIVE);
const BALANCE: Part = (
    "residual of Looselink's equations of motion with the accelerations and multipliers of the reference",
    "relative to the inertia force, or to what rounding of the coordinates does to forces; rounding",
);
const VALUE: Part = ("constraint values", "m; rounding of coordinates");
const GRADIENT: Part = ("constraint gradients", RELATIVE);
const VELOCITY: Part = ("constraint velocities, Φ_q v + Φ_t", "m/s; rounding");
const ACCELERATION: Part = (
    "constraint accelerations with the accelerations of the reference",
    "relative to the largest acceleration, at least 1 m/s²; rounding",
);
const CURVATURE: Part = (
    "geometric stiffness of the constraints, d(Φ_qᵀλ)/dq",
    "relative to the largest entry; truncation and rounding of the reference's difference quotient",
);

/// A vector or a matrix.
type Dense<C> = Matrix<f64, Dyn, C, VecStorage<f64, Dyn, C>>;

/// The largest difference of each part over all states.
#[derive(Default)]
struct EquationDifferences(BTreeMap<Part, LargestDifference>);

impl EquationDifferences {
    fn part(&mut self, part: Part) -> &mut LargestDifference {
        self.0.entry(part).or_default()
    }

    /// Looks at a vector of what should be zero, measured in units of `scale`.
    fn see_zero(&mut self, part: Part, rust: &DVector<f64>, scale: f64) {
        let zeros = vec![0.0; rust.len()];
        self.part(part).see_scaled(rust.as_slice(), &zeros, scale);
    }

    /// Looks at two vectors or matrices, measured in units of the largest entry of the second. Below `rounding` both are zero.
    fn see<C: Dim>(&mut self, part: Part, rust: &Dense<C>, cpp: &Dense<C>, rounding: f64) {
        let size = cpp.amax();
        if rust.amax().max(size) <= rounding {
            self.part(part).see(0.0, 0.0, 1.0);
        } else {
            let scale = size.max(rounding / TOLERANCE);
            let worst = self.part(part);
            worst.see_scaled(rust.as_slice(), cpp.as_slice(), scale);
        }
    }
}

/// The rows of a scene in the coordinates that it has, and in those of the reference if these are others.
pub fn agreements(plan: &ComparisonPlan) -> Result<Vec<Agreement>> {
    let mut pair = ScenePair::new(plan, plan)?;
    let bodies = pair.simulation.model().bodies();
    let others = bodies.iter().any(embedding::is_rooted);
    let mut rows = pair.agreements(plan, plan.name())?;
    if others {
        let name = plan.name() + ", natural coordinates";
        rows.extend(ScenePair::new(plan, &natural(plan)?)?.agreements(plan, name)?);
    }
    Ok(rows)
}

/// The plan with natural coordinates for all rigid links, and those of their centres for other rigid bodies: the full coordinates of
/// the reference are copies of them.
fn natural(plan: &ComparisonPlan) -> Result<ComparisonPlan> {
    let mut natural = plan.clone();
    for body in &plan.scene(None)?.bodies {
        let coordinates = match &body.kind {
            kind if kind.get::<RigidLink>().is_some() => "natural",
            kind if kind.get::<RigidBody>().is_some() => "center",
            _ => continue,
        };
        let set = format!("bodies.{}.coordinates={coordinates:?}", body.name);
        natural.overrides.push(set);
    }
    Ok(natural)
}

impl ScenePair {
    /// The scene in the coordinates of a variant.
    fn new(plan: &ComparisonPlan, variant: &ComparisonPlan) -> Result<ScenePair> {
        let reference = plan.reference()?;
        let scene = variant.scene(None)?;
        let simulation = Simulation::new(&scene)?;
        let model = simulation.model();
        Ok(ScenePair {
            spread: spread(&scene),
            embedding: Embedding::new(&reference, model),
            rows: embedding::rows(&reference, model, &scene),
            contacts: embedding::contacts(&reference, model),
            mass: reference.mass().into_diagnostic()?,
            reference,
            simulation,
        })
    }

    fn agreements(&mut self, plan: &ComparisonPlan, name: String) -> Result<Vec<Agreement>> {
        let mut random = ChaCha8Rng::seed_from_u64(4);
        let mut differences = EquationDifferences::default();
        let mut recording = Recording::new(&self.simulation);
        for k in 0..STATES {
            let t = plan.duration * k as f64 / STATES as f64;
            let advanced = self.simulation.advance_to(t, &mut recording);
            advanced.into_diagnostic()?;
            let at = self.state(&mut random);
            self.compare_forces(&at, &mut random, &mut differences)?;
            self.compare_constraints(&at, &mut differences)?;
        }
        // without constraints and contacts some parts do not exist
        let seen = differences.0.into_iter().filter(|(_, worst)| worst.is_seen);
        let rows = seen.map(|(part, worst)| {
            let allowed = match part {
                CURVATURE => DIFFERENCING,
                _ => TOLERANCE,
            };
            worst.row(part.0, &name, allowed, part.1)
        });
        Ok(rows.collect())
    }

    /// The state that the run has reached, moved at random, with random rates and contacts.
    fn state(&self, random: &mut ChaCha8Rng) -> State {
        let model = self.simulation.model();
        let mut known = self.simulation.state().clone();
        // links are compared from the smallest strains on
        let spread = match model.shape().contacts {
            0 => self.spread * 10_f64.powf(random.random_range(-8.0..0.0)),
            _ => self.spread,
        };
        for i in 0..model.shape().unknowns {
            known.q[i] += spread * random.random_range(-1.0..1.0);
            known.v[i] += 0.1 * random.random_range(-1.0..1.0);
        }
        for velocity in &mut known.memory[..model.shape().contacts] {
            *velocity = random.random_range(0.01..0.1);
        }
        known.lambda.fill(0.0);
        known.a[..model.shape().unknowns].fill(0.0);
        known
    }

    /// M, f and its tangents, and the accelerations that the reference finds.
    fn compare_forces(
        &mut self,
        at: &State,
        random: &mut ChaCha8Rng,
        parts: &mut EquationDifferences,
    ) -> Result<()> {
        let (model, t) = (self.simulation.model(), at.t);
        let shape = model.shape();
        let n = shape.unknowns;
        let jacobian = self.embedding.at(at).jacobian;
        let mass = jacobian.tr_mul(&(&self.mass * &jacobian));
        let [_, _, rust_mass] = rust_matrices(model, at);
        parts.see(MASS, &rust_mass, &mass, 0.0);

        let mut open = at.clone();
        model.open_contacts(&mut open);
        let mut rounding = 0.0;
        for (part, state) in [(CLOSED, at), (OPEN, &open)] {
            if part == CLOSED && shape.contacts == 0 {
                continue;
            }
            let mut mine = state.clone();
            let mut z = vec![0.0; self.reference.joints.len()];
            for (&joint, memory) in self.contacts.iter().zip(&mine.memory) {
                z[joint] = *memory;
            }
            // tangents depend on the accelerations of known coordinates
            for a in &mut mine.a[n..] {
                *a = random.random_range(-10.0..10.0);
            }
            let full = self.embedding.at(&mine);
            let (q, v, z) = (full.q.as_slice(), full.v.as_slice(), &z[..]);
            let cpp = self.reference.force(ReferenceState { t, q, v, z });
            let cpp = cpp.into_diagnostic()?;
            let [stiffness, damping] = full.tangents(&self.mass, &cpp);
            let [rust_stiffness, rust_damping, _] = rust_matrices(model, &mine);
            // terms of the reference that cancel each other are rounded
            let momentum = ROUNDING * self.mass.amax() * full.v.amax();
            let inertia = ROUNDING * (self.mass.amax() * full.a.amax() + cpp.0.amax());
            parts.see(STIFFNESS, &rust_stiffness, &stiffness, inertia);
            parts.see(DAMPING, &rust_damping, &damping, momentum);

            mine.a.fill(0.0);
            let full = self.embedding.at(&mine);
            let force = full.gather(&(&self.mass * &full.a + cpp.0));
            // forces of small strains are differences of coordinates
            rounding = inertia + ROUNDING * stiffness.amax() * full.q.amax();
            parts.see(part, &residual(model, &mine), &force, rounding);
        }

        let still = State {
            a: vec![0.0; at.a.len()],
            ..open.clone()
        };
        let mut solved = open;
        let full = self.embedding.at(&solved);
        let (q, v) = (full.q.as_slice(), full.v.as_slice());
        let z = &vec![0.0; self.reference.joints.len()];
        let state = ReferenceState { t, q, v, z };
        let [a, lambda] = self.reference.acceleration(state).into_diagnostic()?;
        let rates = |at: &State| {
            let mut rates = DVector::zeros(shape.multipliers);
            model.constraint_acceleration(at, rates.as_mut_slice());
            rates
        };
        let scale = rates(&still).amax().max(a.amax()).max(1.0);
        solved.a[..n].copy_from_slice(full.missing(&a).as_slice());
        parts.see_zero(ACCELERATION, &rates(&solved), scale);
        let inertia = (residual(model, &solved) - residual(model, &still)).amax();
        let multipliers = &self.rows * lambda;
        solved.lambda.copy_from_slice(multipliers.as_slice());
        let scale = inertia.max(rounding / TOLERANCE).max(f64::MIN_POSITIVE);
        parts.see_zero(BALANCE, &residual(model, &solved), scale);
        Ok(())
    }

    /// Looselink's constraint rows against those of the same name.
    fn compare_constraints(&self, at: &State, parts: &mut EquationDifferences) -> Result<()> {
        let model = self.simulation.model();
        let (n, m) = (model.shape().unknowns, model.shape().multipliers);
        if m == 0 {
            return Ok(());
        }
        // values, derivatives by the full coordinates, and by time
        let rows = |q: &DVector<f64>| -> Result<ConstraintRows> {
            let cpp = self.reference.constraint_rows(at.t, q.as_slice());
            let (phi, phi_q, phi_t) = cpp.into_diagnostic()?;
            Ok((&self.rows * phi, &self.rows * phi_q, &self.rows * phi_t))
        };
        let full = self.embedding.at(at);
        let (cpp_phi, cpp_phi_q, cpp_phi_t) = rows(&full.q)?;
        let cpp_rates = &cpp_phi_q * &full.v + cpp_phi_t;
        let gradients = &cpp_phi_q * &full.jacobian;
        let (phi, phi_q) = rust_constraints(model, at);
        let mut rates = vec![0.0; m];
        model.constraint_velocity(at, &mut rates);
        // rows that are left out are zero
        let kept = |row: &usize| self.rows.row(*row).amax() > 0.0;
        for row in (0..m).filter(kept) {
            parts.part(VELOCITY).see(rates[row], cpp_rates[row], 1.0);
            parts.part(VALUE).see(phi[row], cpp_phi[row], 1.0);
            let [rust, cpp] = [&phi_q, &gradients].map(|rows| rows.row(row).transpose());
            parts.see(GRADIENT, &rust, &cpp, ROUNDING);
        }

        let mut loaded = at.clone();
        model.open_contacts(&mut loaded);
        let [unloaded, ..] = rust_matrices(model, &loaded);
        for row in (0..m).filter(kept) {
            loaded.lambda[row] = 1.0 + row as f64;
        }
        let [rust, ..] = rust_matrices(model, &loaded);
        let lambda = DVector::from_column_slice(&loaded.lambda);
        let mut bent = DMatrix::zeros(n, n);
        for j in 0..n {
            let couples = |by: f64| -> Result<DVector<f64>> {
                let mut moved = at.clone();
                moved.q[j] += by;
                let full = self.embedding.at(&moved);
                let (_, phi_q, _) = rows(&full.q)?;
                Ok(full.gather(&phi_q.tr_mul(&lambda)))
            };
            bent.set_column(j, &((couples(SPAN)? - couples(-SPAN)?) / (2.0 * SPAN)));
        }
        // rounding in the difference quotient of rows of size 1
        let rounding = lambda.amax() * 1e-15 / SPAN / DIFFERENCING;
        let scale = bent.amax().max(rounding);
        let worst = parts.part(CURVATURE);
        worst.see_scaled((rust - unloaded).as_slice(), bent.as_slice(), scale);
        Ok(())
    }
}

/// Far enough that loose joints touch and directions change, not so far that forces of contacts dwarf all others.
fn spread(scene: &Scene) -> f64 {
    match (scene.drives.is_empty(), scene.smallest_clearance()) {
        (false, _) => 2e-4,
        (true, Some(clearance)) => 3.0 * clearance,
        (true, None) => 0.1,
    }
}

/// The left side of the equations of motion of the unknowns.
fn residual(model: &Model, at: &State) -> DVector<f64> {
    let shape = model.shape();
    let (mut r, mut phi) = (vec![0.0; shape.coordinates], vec![0.0; shape.multipliers]);
    model.residual(at, &mut r, &mut phi, &mut model.work());
    DVector::from_column_slice(&r[..shape.unknowns])
}

/// df/dq, df/dv and M over the unknowns: the stage matrix for a weight in one of the tangents less M, which has none.
fn rust_matrices(model: &Model, at: &State) -> [DMatrix<f64>; 3] {
    let shape = model.shape();
    let n = shape.unknowns;
    let matrix = |q: f64, v: f64| {
        let (mut r, mut phi) = (vec![0.0; shape.coordinates], vec![0.0; shape.multipliers]);
        let (mut k, w) = (vec![0.0; model.symbolic().len()], Weights { q, v });
        model.linearise(at, w, &mut r, &mut phi, &mut k, &mut model.work());
        let dense = model.symbolic().to_dense(&k);
        DMatrix::from_fn(n, n, |i, j| dense[(i, j)])
    };
    let mass = matrix(0.0, 0.0);
    [matrix(1.0, 0.0) - &mass, matrix(0.0, 1.0) - &mass, mass]
}

/// Phi and Phi_q over the unknowns.
fn rust_constraints(model: &Model, at: &State) -> (Vec<f64>, DMatrix<f64>) {
    let shape = model.shape();
    let (n, m) = (shape.unknowns, shape.multipliers);
    let mut phi = vec![0.0; m];
    let matrix = model.acceleration_matrix();
    let mut gradient = matrix.factors().gradient;
    model.acceleration_level(at, &mut phi, &mut gradient);
    let dense = matrix.to_dense(&gradient);
    (phi, DMatrix::from_fn(m, n, |row, i| dense[(n + row, i)]))
}

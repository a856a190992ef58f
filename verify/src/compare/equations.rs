//! The assembled equations of a scene at random states near its motion, term by term.

use super::scenes;
use crate::check::{Agreement, LargestDifference, largest};
use crate::embedding::{self, Embedding};
use crate::reference::{ConstraintRows, ReferenceScene, ReferenceState};
use crate::trajectory::ComparisonPlan;
use looselink::body::{RigidBody, RigidLink};
use looselink::model::Model;
use looselink::scene::{Analysis, Scene};
use looselink::simulate::{Control, Observer, Progress, RunError, Simulation};
use looselink::system::{State, System, Weights};
use miette::{IntoDiagnostic, Result};
use nalgebra::{DMatrix, DVector};
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

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

/// Scenes whose equations are compared: all that move; an element of every stiffness; every law of contact and friction that both
/// have; the paper's cases with more elements, other paths and friction; and a scene with every other element.
pub fn plans() -> Result<Vec<ComparisonPlan>> {
    let table =
        "{type=\"table\",rows=[[0.0,0.1,0.0,0.0],[0.04,0.08,0.02,0.1],[0.1,0.05,0.01,0.0]]}";
    let line = "{type=\"line\",from=[0.1,0.0,0.0],to=[0.0,0.05,0.2],duration=0.1}";
    let spline = "{type=\"table\",rows=[[0.0,0.2],[0.2,0.25],[0.3,0.22],[0.5,0.2]]}";
    let friction = "{law=\"ambrosio\",coefficient=0.3,v0=0.01,v1=0.1,slip=\"paper\"}";
    let case = |scene| ComparisonPlan::new(scene, 0.1, 1e-3);
    let loose = |scene| ComparisonPlan::new(scene, 0.02, 1e-3);
    let link = ComparisonPlan::new("../verify/scenes/link", 1e-3, 1e-4);
    let journal = ComparisonPlan::new("../verify/scenes/journal", 1e-4, 1e-5);
    let everything = ComparisonPlan::new("../verify/scenes/everything", 0.5, 1e-3);
    let maxwell = [
        "forces.dash={type=\"maxwell\",from=\"base.hook\",to=\"rod.middle\",stiffness=40,damping=3,rest_length=0.2}",
        "forces.strut={type=\"maxwell\",from=\"block.left\",to=\"lever.end\",stiffness=25,damping=8,rest_length=0.5}",
    ];
    let turned = "initial.bodies.flag={point=\"edge\",x=0.3,y=0.0,theta=0.3}";
    let slope = ComparisonPlan::new("hard/slope-on-the-first-side", 0.04, 2e-3);
    let mut plans = vec![
        case("3rrr/case2").with(", 4 elements in link 2", &["bodies.link2.elements=4"]),
        case("3rrr/case1").with(", path from a table", &[&format!("drives.input.path={table}")]),
        case("3rrr/case2").with(", straight path", &[&format!("drives.input.path={line}")]),
        loose("3rrr/case3").with_friction(),
        loose("3rrr/case4").with_friction(),
        slope.with(", turned by 0.3 rad", &["joints.weld.angle=0.3", turned]),
        everything.clone().with(", two Maxwell elements", &maxwell),
        everything.clone().with(", y from a table", &[&format!("drives.push.y={spline}")]),
        everything,
        link.clone().with(", slender", &["sections.any.width=1e-5", "materials.any.youngs_modulus=2e11"]),
        link.clone().with(", stout", &["sections.any.width=0.2", "bodies.link.length=0.03"]),
        link,
        journal.clone().with(", Hunt-Crossley", &["contacts.pin.law=\"hunt_crossley\""]),
        journal.clone().with(", Flores", &["contacts.pin.law=\"flores\"", "contacts.pin.exponent=2.1"]),
        journal.clone().with(
            ", Hertz",
            &["contacts.pin={law=\"hertz\",bearing_radius=0.01,clearance=2e-5,stiffness=1e9,exponent=1.5}"],
        ),
        journal.clone().with(", friction of the paper", &[&format!("contacts.pin.friction={friction}")]),
        journal.clone().with_friction(),
        journal,
    ];
    plans.extend(scenes::of(Analysis::Dynamic)?);
    Ok(plans)
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

/// A part of the equations: its name, the measure of the difference with the reason of what is allowed, and that.
type Part = (&'static str, &'static str, f64);
const RELATIVE: &str = "relative to the largest entry; rounding";
const STRAINS: &str =
    "relative to the largest entry, or to what rounding of the coordinates does to it; rounding";
const MASS: Part = ("assembled mass matrix", RELATIVE, TOLERANCE);
const OPEN: Part = ("assembled force, contacts open", STRAINS, TOLERANCE);
const CLOSED: Part = ("assembled force, contacts closed", STRAINS, TOLERANCE);
const DAMPING: Part = ("assembled df/dv", RELATIVE, TOLERANCE);
const STIFFNESS: Part = ("assembled df/dq", RELATIVE, TOLERANCE);
const BALANCE: Part = (
    "residual of Looselink's equations of motion with the accelerations and multipliers of the reference",
    "relative to the inertia force, or to what rounding of the coordinates does to forces; rounding",
    TOLERANCE,
);
const VALUE: Part = ("constraint values", "m; rounding of coordinates", TOLERANCE);
const GRADIENT: Part = ("constraint gradients", RELATIVE, TOLERANCE);
const VELOCITY: Part = (
    "constraint velocities, Φ_q v + Φ_t",
    "m/s; rounding",
    TOLERANCE,
);
const ACCELERATION: Part = (
    "constraint accelerations with the accelerations of the reference",
    "relative to the largest acceleration, at least 1 m/s²; rounding",
    TOLERANCE,
);
const CURVATURE: Part = (
    "geometric stiffness of the constraints, d(Φ_qᵀλ)/dq",
    "relative to the largest entry; truncation and rounding of the reference's difference quotient",
    DIFFERENCING,
);

/// The largest difference of each part over all states.
#[derive(Default)]
struct EquationDifferences(Vec<(Part, LargestDifference)>);

impl EquationDifferences {
    /// Looks at two vectors or matrices, measured in units of `scale`.
    fn see_scaled(&mut self, part: Part, rust: &[f64], cpp: &[f64], scale: f64) {
        let known = self.0.iter().position(|(known, _)| *known == part);
        let place = known.unwrap_or_else(|| {
            self.0.push((part, LargestDifference::default()));
            self.0.len() - 1
        });
        self.0[place].1.see_scaled(rust, cpp, scale);
    }

    /// The same in units of the largest entry of the second. Below `rounding` both are zero.
    fn see(&mut self, part: Part, rust: &[f64], cpp: &[f64], rounding: f64) {
        if largest(rust).max(largest(cpp)) <= rounding {
            self.see_scaled(part, &[0.0], &[0.0], 1.0);
        } else {
            self.see_scaled(part, rust, cpp, largest(cpp).max(rounding / TOLERANCE));
        }
    }
}

/// Ends a run at an instant.
struct Until(f64);

impl Observer for Until {
    fn row(&mut self, _: &[f64]) -> std::io::Result<()> {
        Ok(())
    }

    fn step(&mut self, progress: &Progress) -> std::io::Result<Control> {
        let goes_on = progress.t < self.0;
        Ok(if goes_on {
            Control::Continue
        } else {
            Control::Stop
        })
    }
}

/// The rows of a scene in the coordinates that it has, and in those of links and centres if these are others.
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
        for k in 0..STATES {
            let t = plan.duration * k as f64 / STATES as f64;
            match self.simulation.run(&mut Until(t)) {
                Ok(()) | Err(RunError::Interrupted { .. }) => {}
                Err(error) => return Err(error).into_diagnostic(),
            }
            let at = self.state(&mut random);
            self.compare_forces(&at, &mut random, &mut differences)?;
            self.compare_constraints(&at, &mut differences)?;
        }
        // without constraints and contacts some parts do not exist
        let seen = differences
            .0
            .into_iter()
            .filter(|(_, worst)| worst.is_seen());
        let row = |((what, reason, allowed), worst): (Part, LargestDifference)| {
            worst.row(what, &name, allowed, reason)
        };
        Ok(seen.map(row).collect())
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
        for z in &mut known.z {
            *z = random.random_range(0.01..0.1);
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
        let mass = self.embedding.at(at).mass(&self.mass);
        let [_, _, rust_mass] = rust_matrices(model, at);
        parts.see(MASS, rust_mass.as_slice(), mass.as_slice(), 0.0);

        let open = State {
            z: vec![0.0; at.z.len()],
            ..at.clone()
        };
        let closed = (CLOSED, at.clone());
        let closed = Some(closed).filter(|_| !at.z.is_empty());
        let states = closed.into_iter().chain([(OPEN, open.clone())]);
        let mut rounding = 0.0;
        for (part, mut mine) in states {
            let mut z = vec![0.0; self.reference.joints.len()];
            for (&joint, memory) in self.contacts.iter().zip(&mine.z) {
                z[joint] = *memory;
            }
            // tangents depend on the accelerations of known coordinates
            for a in &mut mine.a[n..] {
                *a = random.random_range(-10.0..10.0);
            }
            let full = self.embedding.at(&mine);
            let (q, v, z) = (full.q.as_slice(), full.v.as_slice(), &z[..]);
            let cpp = self
                .reference
                .force(ReferenceState { t, q, v, z })
                .into_diagnostic()?;
            let [stiffness, damping] = full.tangents(&self.mass, &cpp);
            let [rust_stiffness, rust_damping, _] = rust_matrices(model, &mine);
            // terms of the reference that cancel each other are rounded
            let momentum = ROUNDING * self.mass.amax() * full.v.amax();
            let inertia = ROUNDING * (self.mass.amax() * full.a.amax() + cpp.0.amax());
            let (rust, cpp_k) = (rust_stiffness.as_slice(), stiffness.as_slice());
            parts.see(STIFFNESS, rust, cpp_k, inertia);
            let (rust, cpp_c) = (rust_damping.as_slice(), damping.as_slice());
            parts.see(DAMPING, rust, cpp_c, momentum);

            mine.a.fill(0.0);
            let full = self.embedding.at(&mine);
            let force = full.gather(&(&self.mass * &full.a + cpp.0));
            // forces of small strains are differences of coordinates
            rounding = inertia + ROUNDING * stiffness.amax() * full.q.amax();
            let rust = residual(model, &mine);
            parts.see(part, &rust[..n], force.as_slice(), rounding);
        }

        let mut solved = open;
        let full = self.embedding.at(&solved);
        let (q, v) = (full.q.as_slice(), full.v.as_slice());
        let z = &vec![0.0; self.reference.joints.len()];
        let state = ReferenceState { t, q, v, z };
        let [a, lambda] = self.reference.acceleration(state).into_diagnostic()?;
        let mut rates = vec![0.0; shape.multipliers];
        let still = State {
            a: vec![0.0; at.a.len()],
            ..solved.clone()
        };
        model.constraint_acceleration(&still, &mut rates);
        let scale = largest(&rates).max(a.amax()).max(1.0);
        solved.a[..n].copy_from_slice(full.missing(&a).as_slice());
        model.constraint_acceleration(&solved, &mut rates);
        let zeros = vec![0.0; n.max(rates.len())];
        parts.see_scaled(ACCELERATION, &rates, &zeros[..rates.len()], scale);
        let [forces, all] = [&still, &solved].map(|state| residual(model, state));
        let inertia = all[..n].iter().zip(&forces).map(|(all, force)| all - force);
        let inertia = largest(&inertia.collect::<Vec<f64>>());
        solved
            .lambda
            .copy_from_slice((&self.rows * lambda).as_slice());
        let scale = inertia.max(rounding / TOLERANCE).max(f64::MIN_POSITIVE);
        let balance = &residual(model, &solved)[..n];
        parts.see_scaled(BALANCE, balance, &zeros[..n], scale);
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
            parts.see_scaled(VELOCITY, &[rates[row]], &[cpp_rates[row]], 1.0);
            parts.see_scaled(VALUE, &[phi[row]], &[cpp_phi[row]], 1.0);
            let [rust, cpp] = [&phi_q, &gradients].map(|rows| rows.rows(row, 1).into_owned());
            parts.see(GRADIENT, rust.as_slice(), cpp.as_slice(), ROUNDING);
        }

        let mut loaded = State {
            z: vec![0.0; at.z.len()],
            ..at.clone()
        };
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
        let rust = rust - unloaded;
        parts.see_scaled(CURVATURE, rust.as_slice(), bent.as_slice(), scale);
        Ok(())
    }
}

/// The plan with natural coordinates for all rigid links, and those of their centres for other rigid bodies: the full coordinates of
/// the reference are copies of them.
fn natural(plan: &ComparisonPlan) -> Result<ComparisonPlan> {
    let scene = plan.scene(None)?;
    let mut natural = plan.clone();
    for body in &scene.bodies {
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

/// Far enough that loose joints touch and directions change, not so far that forces of contacts dwarf all others.
fn spread(scene: &Scene) -> f64 {
    match (scene.drives.is_empty(), scene.smallest_clearance()) {
        (false, _) => 2e-4,
        (true, Some(clearance)) => 3.0 * clearance,
        (true, None) => 0.1,
    }
}

/// The left side of the equations of motion.
fn residual(model: &Model, at: &State) -> Vec<f64> {
    let shape = model.shape();
    let (mut r, mut phi) = (vec![0.0; shape.coordinates], vec![0.0; shape.multipliers]);
    model.residual(at, &mut r, &mut phi, &mut model.work());
    r
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

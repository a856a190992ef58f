//! The assembled equations of a scene at random states near its motion, term by term.

use super::scenes;
use crate::check::{Agreement, LargestDifference, largest};
use crate::embedding::Embedding;
use crate::reference::{ReferenceScene, ReferenceState};
use crate::trajectory::ComparisonPlan;
use looselink::body::{RigidBody, RigidLink};
use looselink::interaction::{SlopeClamp, Weld};
use looselink::model::Model;
use looselink::scene::{Analysis, PointRef, Scene};
use looselink::simulate::{Control, Observer, Progress, RunError, Simulation};
use looselink::system::{State, System, Weights};
use miette::{IntoDiagnostic, Result};
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// States a scene is tried at.
pub const STATES: usize = 50;
/// Relative to the largest entry of each part.
const TOLERANCE: f64 = 1e-11;
/// The same where the reference's rows are differenced over [`SPAN`]: 1e-10 of truncation and rounding, and a reserve.
const DIFFERENCING: f64 = 1e-8;
/// 2e-15, the rounding of the eight coordinates of an element, over that: forces of small strains are differences of
/// coordinates.
const COORDINATES: f64 = 2e-4;
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
    let mut plans = vec![
        case("3rrr/case2").with(", 4 elements in link 2", &["bodies.link2.elements=4"]),
        case("3rrr/case1").with(", path from a table", &[&format!("drives.input.path={table}")]),
        case("3rrr/case2").with(", straight path", &[&format!("drives.input.path={line}")]),
        loose("3rrr/case3").with_friction(),
        loose("3rrr/case4").with_friction(),
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
    for plan in scenes::of(Analysis::Dynamic)? {
        if are_comparable(&plan.scene(None)?) {
            plans.push(plan);
        }
    }
    Ok(plans)
}

/// False if a weld holds the slope vector of its first side: the two programs write its rows in different frames. False also with
/// internal states of forces, for which the reference has no rows in its equations of motion; their motion is compared.
pub fn are_comparable(scene: &Scene) -> bool {
    let mut forces = scene.forces.iter();
    if forces.any(|force| !force.kind.states().is_empty()) {
        return false;
    }
    let is_link = |p: PointRef| scene.bodies[p.body].kind.link().is_some();
    !scene.joints.iter().any(|joint| {
        let weld = joint.model.get::<Weld>();
        let holds_vector = weld.is_some_and(|weld| weld.slope == SlopeClamp::Vector);
        holds_vector && is_link(joint.bearing) && !is_link(joint.journal)
    })
}

/// Both sides of a scene and the way between their coordinates.
struct ScenePair {
    simulation: Simulation,
    reference: ReferenceScene,
    embedding: Embedding,
    /// How far coordinates are moved \[m, rad\].
    spread: f64,
}

/// A part of the equations.
#[derive(Clone, Copy)]
enum EquationPart {
    Mass,
    Open,
    Closed,
    Damping,
    Stiffness,
    Balance,
    Value,
    Gradient,
    Velocity,
    Acceleration,
    Curvature,
}

const ROUNDING: &str = "relative to the largest entry; rounding";
const STRAINS: &str =
    "relative to the largest entry, or to what rounding of the coordinates does to it; rounding";
/// For each part its name, the measure of the difference with the reason of what is allowed, and that.
#[rustfmt::skip]
const PARTS: [(&str, &str, f64); 11] = [
    ("assembled mass matrix", ROUNDING, TOLERANCE),
    ("assembled force, contacts open", STRAINS, TOLERANCE),
    ("assembled force, contacts closed", STRAINS, TOLERANCE),
    ("assembled df/dv", ROUNDING, TOLERANCE),
    ("assembled df/dq", ROUNDING, TOLERANCE),
    ("residual of Looselink's equations of motion with the accelerations and multipliers of the reference",
     "relative to the inertia force, or to what rounding of the coordinates does to forces; rounding", TOLERANCE),
    ("constraint values", "m; rounding of coordinates", TOLERANCE),
    ("constraint gradients", ROUNDING, TOLERANCE),
    ("constraint velocities, Φ_q v + Φ_t", "m/s; rounding", TOLERANCE),
    ("constraint accelerations with the accelerations of the reference",
     "relative to the largest acceleration, at least 1 m/s²; rounding", TOLERANCE),
    ("geometric stiffness of the constraints, d(Φ_qᵀλ)/dq",
     "relative to the largest entry; truncation and rounding of the reference's difference quotient", DIFFERENCING),
];

/// The largest difference of each part over all states.
#[derive(Default)]
struct EquationDifferences([LargestDifference; PARTS.len()]);

impl EquationDifferences {
    fn of(&mut self, part: EquationPart) -> &mut LargestDifference {
        &mut self.0[part as usize]
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

/// The rows of a scene.
pub fn agreements(plan: &ComparisonPlan) -> Result<Vec<Agreement>> {
    let mut pair = ScenePair::new(plan)?;
    let mut random = ChaCha8Rng::seed_from_u64(4);
    let mut differences = EquationDifferences::default();
    for k in 0..STATES {
        let t = plan.duration * k as f64 / STATES as f64;
        match pair.simulation.run(&mut Until(t)) {
            Ok(()) | Err(RunError::Interrupted { .. }) => {}
            Err(error) => return Err(error).into_diagnostic(),
        }
        let at = pair.state(&mut random);
        pair.compare_forces(&at, &mut differences)?;
        pair.compare_constraints(&at, &mut differences)?;
    }
    // without constraints and contacts some parts do not exist
    let parts = PARTS
        .iter()
        .zip(differences.0)
        .filter(|(_, worst)| worst.is_seen());
    let row = |((quantity, reason, tolerance), worst): (&(&str, &str, f64), LargestDifference)| {
        worst.row(quantity, &plan.name(), *tolerance, reason)
    };
    Ok(parts.map(row).collect())
}

impl ScenePair {
    fn new(plan: &ComparisonPlan) -> Result<ScenePair> {
        let reference = plan.reference()?;
        let scene = natural(plan)?.scene(None)?;
        let simulation = Simulation::new(&scene)?;
        let embedding = Embedding::new(&reference, simulation.model());
        Ok(ScenePair {
            spread: spread(&scene),
            reference,
            embedding,
            simulation,
        })
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
        known.a.fill(0.0);
        known
    }

    /// M, f and its tangents, and the accelerations that the reference finds.
    fn compare_forces(&self, at: &State, parts: &mut EquationDifferences) -> Result<()> {
        let (model, embedding, t) = (self.simulation.model(), &self.embedding, at.t);
        let (width, n) = (at.q.len(), model.shape().unknowns);
        let (q, v) = (&embedding.spread(&at.q), &embedding.spread(&at.v));
        let corner = |k: &[f64]| block(&embedding.congruence(k), width, n);
        let mass = corner(&self.reference.mass().into_diagnostic()?);
        let [_, _, rust_mass] = rust_matrices(model, at);
        parts.of(EquationPart::Mass).see_all(&rust_mass, &mass);

        let open = State {
            z: vec![0.0; at.z.len()],
            ..at.clone()
        };
        let closed = (EquationPart::Closed, at.clone());
        let closed = Some(closed).filter(|_| !at.z.is_empty());
        let mut rounding = 0.0;
        for (part, mine) in closed
            .into_iter()
            .chain([(EquationPart::Open, open.clone())])
        {
            let z = &embedding.memory(&mine.z);
            let [f, by_q, by_v] = self
                .reference
                .force(ReferenceState { t, q, v, z })
                .into_diagnostic()?;
            let (force, stiffness) = (&embedding.gather(&f)[..n], corner(&by_q));
            rounding = COORDINATES * largest(&stiffness) * largest(q);
            let scale = largest(force).max(rounding).max(f64::MIN_POSITIVE);
            parts
                .of(part)
                .see_scaled(&residual(model, &mine)[..n], force, scale);
            let [rust_stiffness, damping, _] = rust_matrices(model, &mine);
            parts
                .of(EquationPart::Stiffness)
                .see_all(&rust_stiffness, &stiffness);
            parts
                .of(EquationPart::Damping)
                .see_all(&damping, &corner(&by_v));
        }

        let z = &embedding.memory(&open.z);
        let [a, lambda] = self
            .reference
            .acceleration(ReferenceState { t, q, v, z })
            .into_diagnostic()?;
        let mut solved = open;
        let mut rates = vec![0.0; model.shape().multipliers];
        model.constraint_acceleration(&solved, &mut rates);
        let scale = largest(&rates).max(largest(&a)).max(1.0);
        embedding.take(&a, &mut solved.a);
        model.constraint_acceleration(&solved, &mut rates);
        let zeros = vec![0.0; n.max(rates.len())];
        parts
            .of(EquationPart::Acceleration)
            .see_scaled(&rates, &zeros[..rates.len()], scale);
        let inertia = largest(&residual(model, &solved)[..n]);
        for (mine, row) in solved.lambda.iter_mut().zip(&embedding.rows) {
            *mine = row.map_or(0.0, |row| lambda[row]);
        }
        let scale = inertia.max(rounding).max(f64::MIN_POSITIVE);
        let balance = &residual(model, &solved)[..n];
        parts
            .of(EquationPart::Balance)
            .see_scaled(balance, &zeros[..n], scale);
        Ok(())
    }

    /// Looselink's constraint rows against those of the same name.
    fn compare_constraints(&self, at: &State, parts: &mut EquationDifferences) -> Result<()> {
        let (model, embedding) = (self.simulation.model(), &self.embedding);
        let (q, v) = (&embedding.spread(&at.q), &embedding.spread(&at.v));
        let rows = |q: &[f64]| self.reference.constraint_rows(at.t, q).into_diagnostic();
        let (n, m, width) = (model.shape().unknowns, model.shape().multipliers, q.len());
        let (phi, phi_q) = rust_constraints(model, at);
        let mut rates = vec![0.0; m];
        model.constraint_velocity(at, &mut rates);
        let [cpp_phi, cpp_phi_q, cpp_phi_t] = rows(q)?;
        let places = embedding.rows.iter().enumerate();
        let places = places.filter_map(|(row, place)| Some((row, (*place)?)));
        for (row, place) in places.clone() {
            let gradient = &cpp_phi_q[place * width..(place + 1) * width];
            let rate = gradient.iter().zip(v).map(|(g, v)| g * v).sum::<f64>();
            parts
                .of(EquationPart::Velocity)
                .see(rates[row], rate + cpp_phi_t[place], 1.0);
            parts
                .of(EquationPart::Value)
                .see(phi[row], cpp_phi[place], 1.0);
            let gradient = &embedding.gather(gradient)[..n];
            parts
                .of(EquationPart::Gradient)
                .see_all(&phi_q[row * n..(row + 1) * n], gradient);
        }

        let mut loaded = State {
            z: vec![0.0; at.z.len()],
            ..at.clone()
        };
        let [unloaded, ..] = rust_matrices(model, &loaded);
        for (row, _) in places.clone() {
            loaded.lambda[row] = 1.0 + row as f64;
        }
        let [rust, ..] = rust_matrices(model, &loaded);
        let rust: Vec<f64> = rust.iter().zip(&unloaded).map(|(l, u)| l - u).collect();
        let mut bent = vec![0.0; n * n];
        for j in 0..n {
            let mut unit = vec![0.0; at.q.len()];
            unit[j] = SPAN;
            let step = embedding.spread(&unit);
            let moved = |sign: f64| {
                let q: Vec<f64> = q.iter().zip(&step).map(|(q, d)| q + sign * d).collect();
                rows(&q)
            };
            let ([_, low, _], [_, high, _]) = (moved(-1.0)?, moved(1.0)?);
            let mut column = vec![0.0; width];
            for (row, place) in places.clone() {
                for (c, sum) in column.iter_mut().enumerate() {
                    let entry = place * width + c;
                    *sum += loaded.lambda[row] * (high[entry] - low[entry]);
                }
            }
            for (i, value) in embedding.gather(&column)[..n].iter().enumerate() {
                bent[i * n + j] = value / (2.0 * SPAN);
            }
        }
        // rounding in the difference quotient of rows of size 1
        let rounding = largest(&loaded.lambda) * 1e-15 / SPAN / DIFFERENCING;
        if m > 0 {
            let scale = largest(&bent).max(rounding);
            parts
                .of(EquationPart::Curvature)
                .see_scaled(&rust, &bent, scale);
        }
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
fn rust_matrices(model: &Model, at: &State) -> [Vec<f64>; 3] {
    let shape = model.shape();
    let n = shape.unknowns;
    let matrix = |q: f64, v: f64| -> Vec<f64> {
        let (mut r, mut phi) = (vec![0.0; shape.coordinates], vec![0.0; shape.multipliers]);
        let mut k = vec![0.0; model.symbolic().len()];
        model.linearise(
            at,
            Weights { q, v },
            &mut r,
            &mut phi,
            &mut k,
            &mut model.work(),
        );
        let dense = model.symbolic().to_dense(&k);
        (0..n * n).map(|e| dense[(e / n, e % n)]).collect()
    };
    let mass = matrix(0.0, 0.0);
    let [stiffness, damping] = [(1.0, 0.0), (0.0, 1.0)].map(|(q, v)| {
        let both = matrix(q, v).into_iter().zip(&mass);
        both.map(|(k, m)| k - m).collect()
    });
    [stiffness, damping, mass]
}

/// Phi and Phi_q over the unknowns.
fn rust_constraints(model: &Model, at: &State) -> (Vec<f64>, Vec<f64>) {
    let shape = model.shape();
    let (n, m) = (shape.unknowns, shape.multipliers);
    let mut phi = vec![0.0; m];
    let matrix = model.acceleration_matrix();
    let mut gradient = matrix.factors().gradient;
    model.acceleration_level(at, &mut phi, &mut gradient);
    let dense = matrix.to_dense(&gradient);
    let entries = (0..m * n).map(|e| dense[(n + e / n, e % n)]);
    (phi, entries.collect())
}

/// The upper left n x n of a square matrix of `width`.
fn block(matrix: &[f64], width: usize, n: usize) -> Vec<f64> {
    let rows = matrix.chunks_exact(width).take(n);
    rows.flat_map(|row| &row[..n]).copied().collect()
}

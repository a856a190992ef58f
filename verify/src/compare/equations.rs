//! The assembled equations of a scene at random states near its manifold, term by term.

use crate::check::{Agreement, Worst, largest};
use crate::description::Description;
use crate::embedding::Embedding;
use crate::reference::{Mechanism, System as Reference, body_kind, joint_kind};
use crate::trajectory::Plan;
use looselink::model::Model;
use looselink::simulate::Simulation;
use looselink::system::{State, System, Weights};
use miette::{IntoDiagnostic, Result};
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// States a scene is tried at.
pub const STATES: usize = 100;
/// Relative to the largest entry of each part.
const TOLERANCE: f64 = 1e-11;
/// The same where the reference's rows are differenced over [`SPAN`]: 1e-10 of truncation and rounding, and a reserve.
const DIFFERENCING: f64 = 1e-8;
/// Span of central differences of the rows: coordinates in m, angles in rad, times over the duration that is looked at.
const SPAN: f64 = 1e-5;

/// Scenes whose equations are compared: the four cases, more elements, both readings of the slip; every other element,
/// a link welded into a frame with a body that hangs loosely, and mechanisms of the library.
pub fn plans() -> Vec<Plan> {
    let plan = |scene| Plan::new(scene, 1.0, 1e-3);
    vec![
        plan("3rrr/case1"),
        plan("3rrr/case2"),
        plan("3rrr/case2").with(
            ", 4 elements in link 2",
            &["bodies.link2.elements=4".to_owned()],
        ),
        plan("3rrr/case3"),
        plan("3rrr/case4"),
        plan("3rrr/case4-friction"),
        plan("3rrr/case3").with_friction(),
        plan("3rrr/case4").with_friction(),
        Plan::new("../verify/scenes/everything", 0.5, 1e-3),
        Plan::new("frame-with-hanging-body", 0.3, 1e-3),
        Plan::new("slider-crank/loose", 0.012, 1e-3),
        Plan::new("four-bar-three-loose", 0.1, 1e-3),
        plan("quick-return"),
    ]
}

/// Both sides of a scene and the way between their coordinates.
struct Pair {
    simulation: Simulation,
    reference: Reference,
    embedding: Embedding,
    description: Description,
    /// For each contact of Looselink the joint of the reference.
    joints: Vec<usize>,
    /// How far coordinates are moved \[m, rad\].
    spread: f64,
    /// Span of differences in time \[s\].
    instant: f64,
}

/// Differences of each part of the equations.
#[derive(Default)]
struct Parts {
    start: Worst,
    mass: Worst,
    force: Worst,
    contact: Worst,
    stiffness: Worst,
    damping: Worst,
    constraint: Worst,
    gradient: Worst,
    velocity: Worst,
    convective: Worst,
    curvature: Worst,
}

/// The rows of a scene.
///
/// # Errors
/// A scene that one of the sides refuses.
pub fn agreements(plan: &Plan) -> Result<Vec<Agreement>> {
    let pair = Pair::new(plan)?;
    let mut random = ChaCha8Rng::seed_from_u64(4);
    let mut parts = Parts::default();
    let mut last = pair.simulation.state().clone();
    for k in 0..STATES {
        let t = plan.duration * k as f64 / STATES as f64;
        let at = pair.state(t, &last, &mut random, &mut parts.start)?;
        last.copy_from(&at);
        pair.compare(t, &at, &mut parts)?;
    }
    let name = plan.name();
    let shape = pair.simulation.model().shape();
    let row =
        |worst: Worst, quantity: &str, reason: &str| worst.row(quantity, &name, TOLERANCE, reason);
    let rounding = "of the largest entry; rounding";
    let mut rows = Vec::new();
    let mechanism = &pair.description.mechanism;
    if !mechanism.legs.is_empty() {
        rows.push(row(
            parts.start,
            "ideal poses and velocities",
            "m and m/s; closed form against Newton's method",
        ));
    }
    rows.push(row(parts.mass, "assembled mass matrix", rounding));
    if shape.multipliers > 0 {
        rows.extend([
            row(
                parts.constraint,
                "constraint values",
                "m; rounding of coordinates",
            ),
            row(parts.gradient, "constraint gradients", rounding),
            row(
                parts.velocity,
                "constraint velocities, Φ_q v + Φ_t",
                "m/s; rounding",
            ),
            Agreement {
                tolerance: DIFFERENCING,
                ..row(
                    parts.convective,
                    "convective acceleration of the constraints",
                    "of 1 m/s² or the largest entry; truncation of the reference's difference quotient along the motion",
                )
            },
            Agreement {
                tolerance: DIFFERENCING,
                ..row(
                    parts.curvature,
                    "curvature of the constraints, d(Φ_qᵀλ)/dq",
                    "of the largest entry; truncation of the reference's difference quotient",
                )
            },
        ]);
    }
    // with or without anything in them: a part that only one side has must not go unseen
    rows.push(row(parts.force, "assembled force, contacts open", rounding));
    rows.push(row(parts.damping, "assembled df/dv", rounding));
    rows.push(row(
        parts.stiffness,
        "assembled df/dq",
        "of the largest entry; relative rounding of the penetration, a small difference of coordinates",
    ));
    if shape.contacts > 0 {
        rows.push(row(
            parts.contact,
            "assembled force, contacts closed",
            "of the largest entry; relative rounding of the penetration, a small difference of coordinates",
        ));
    }
    Ok(rows)
}

impl Pair {
    fn new(plan: &Plan) -> Result<Pair> {
        let description = plan.description()?;
        let reference = Reference::new(&description.mechanism).into_diagnostic()?;
        let simulation = Simulation::new(&plan.scene(1e-5)?)?;
        let model = simulation.model();
        let embedding = Embedding::new(&description, model, model.shape().coordinates);
        let contact_joint = |c| {
            let j = model.contact_joint(c)?;
            let name = &model.joints()[j].name;
            description.joints.iter().position(|n| n == name)
        };
        let joints = (0..model.shape().contacts).map(contact_joint);
        let joints = joints.collect::<Option<_>>();
        Ok(Pair {
            joints: joints.expect("every contact belongs to a joint of both sides"),
            spread: spread(&description.mechanism),
            instant: SPAN * plan.duration,
            description,
            reference,
            embedding,
            simulation,
        })
    }

    /// A pose moved at random, with random rates and contacts: where legs follow a path the ideal pose at time t, which
    /// Newton's method finds from `last`, a state shortly before; elsewhere the assembled start with what is prescribed at t.
    fn state(
        &self,
        t: f64,
        last: &State,
        random: &mut ChaCha8Rng,
        start: &mut Worst,
    ) -> Result<State> {
        let model = self.simulation.model();
        let shape = model.shape();
        let mut known = last.clone();
        known.t = t;
        if self.description.mechanism.legs.is_empty() {
            let assembled = self.simulation.state();
            known.q.copy_from_slice(&assembled.q);
            known.v.copy_from_slice(&assembled.v);
            let prescribed = model.prescribe(assembled, &mut known, &mut model.work());
            prescribed.into_diagnostic()?;
        } else {
            let (q, v) = self.reference.start(t).into_diagnostic()?;
            self.embedding.take(&q, &mut known.q, shape.unknowns);
            self.embedding.take(&v, &mut known.v, shape.unknowns);
            let prescribed = model.prescribe(last, &mut known, &mut model.work());
            prescribed.into_diagnostic()?;
            for (rust, cpp) in [(&known.q, &q), (&known.v, &v)] {
                start.see_scaled(&self.embedding.spread(rust), cpp, 1.0);
            }
        }
        for i in 0..shape.unknowns {
            known.q[i] += self.spread * random.random_range(-1.0..1.0);
            known.v[i] += 0.1 * random.random_range(-1.0..1.0);
        }
        for z in &mut known.z {
            *z = random.random_range(0.01..0.1);
        }
        known.lambda.fill(0.0);
        Ok(known)
    }

    /// The joint memory of the reference.
    fn memory(&self, z: &[f64], joints: usize) -> Vec<f64> {
        let mut memory = vec![0.0; joints];
        for (&joint, z) in self.joints.iter().zip(z) {
            memory[joint] = *z;
        }
        memory
    }

    fn compare(&self, t: f64, at: &State, parts: &mut Parts) -> Result<()> {
        let model = self.simulation.model();
        let joints = model.joints().len();
        let (q, v) = (self.embedding.spread(&at.q), self.embedding.spread(&at.v));
        let mass = self.reference.mass(&q).into_diagnostic()?;
        let mass = self.embedding.congruence(&mass);
        parts.mass.see_all(&rust_mass(model, at), &mass);

        let closed = self.memory(&at.z, joints);
        // without the rows of coordinates that the reference has not: points of the ground, the ideal mechanism of a drive
        let mine = |at: &State| {
            let still = State {
                a: vec![0.0; at.a.len()],
                ..at.clone()
            };
            self.embedding.keep(residual(model, &still))
        };
        let mut open = at.clone();
        open.z.fill(0.0);
        let cpp = self.reference.force(t, &q, &v, &vec![0.0; joints]);
        let cpp = self.embedding.gather(&cpp.into_diagnostic()?.value);
        parts.force.see_all(&mine(&open), &cpp);
        let cpp = self.reference.force(t, &q, &v, &closed);
        let cpp = cpp.into_diagnostic()?;
        parts
            .contact
            .see_all(&mine(at), &self.embedding.gather(&cpp.value));
        let n = model.shape().unknowns;
        let corner = |k: &[f64]| block(&self.embedding.congruence(k), at.q.len(), n);
        let [stiffness, damping] = rust_tangents(model, at);
        parts.stiffness.see_all(&stiffness, &corner(&cpp.by_q));
        parts.damping.see_all(&damping, &corner(&cpp.by_v));
        self.compare_constraints(t, at, &q, parts)
    }

    /// Looselink's constraint rows against those of the same length or joint.
    fn compare_constraints(&self, t: f64, at: &State, q: &[f64], parts: &mut Parts) -> Result<()> {
        let model = self.simulation.model();
        let rows = self.reference.constraint_rows(t, q).into_diagnostic()?;
        let (n, width) = (model.shape().unknowns, q.len());
        let (phi, phi_q) = rust_constraints(model, at);
        let v = self.embedding.spread(&at.v);
        let mut rates = vec![0.0; phi.len()];
        model.constraint_velocity(at, &mut rates);
        for (row, place) in self.constraint_places().into_iter().enumerate() {
            let place = place.expect("every constraint of Looselink is one of the reference");
            let gradient = &rows.phi_q[place * width..(place + 1) * width];
            let rate = gradient.iter().zip(&v).map(|(g, v)| g * v).sum::<f64>();
            parts
                .velocity
                .see(rates[row], rate + rows.phi_t[place], 1.0);
            let gradient = self.embedding.gather(gradient);
            parts.constraint.see(phi[row], rows.phi[place], 1.0);
            parts
                .gradient
                .see_all(&phi_q[row * n..(row + 1) * n], &gradient[..n]);
        }
        self.compare_second_derivatives(t, at, q, parts)
    }

    /// What the rows' second derivatives enter: accelerations at rest coordinates, and the tangent of Phi_q^T lambda.
    fn compare_second_derivatives(
        &self,
        t: f64,
        at: &State,
        q: &[f64],
        parts: &mut Parts,
    ) -> Result<()> {
        let model = self.simulation.model();
        let (n, m) = (model.shape().unknowns, model.shape().multipliers);
        if m == 0 {
            return Ok(());
        }
        let width = q.len();
        let places: Vec<usize> = self.constraint_places().into_iter().flatten().collect();
        let rows = |direction: &[f64], by: f64| {
            let q: Vec<f64> = q.iter().zip(direction).map(|(q, d)| q + by * d).collect();
            self.reference.constraint_rows(t, &q).into_diagnostic()
        };
        let slope = |direction: &[f64]| -> Result<Vec<f64>> {
            let (low, high) = (rows(direction, -SPAN)?, rows(direction, SPAN)?);
            let pairs = high.phi_q.iter().zip(&low.phi_q);
            Ok(pairs.map(|(h, l)| (h - l) / (2.0 * SPAN)).collect())
        };

        // of the rates Φ_q v + Φ_t along the motion
        let v = self.embedding.spread(&at.v);
        let rates = |by: f64| -> Result<Vec<f64>> {
            let q: Vec<f64> = q.iter().zip(&v).map(|(q, v)| q + by * v).collect();
            let rows = self
                .reference
                .constraint_rows(t + by, &q)
                .into_diagnostic()?;
            let along = rows.phi_q.chunks_exact(width).zip(&rows.phi_t);
            let rate = |(g, drift): (&[f64], &f64)| {
                drift + g.iter().zip(&v).map(|(g, v)| g * v).sum::<f64>()
            };
            Ok(along.map(rate).collect())
        };
        let (low, high) = (rates(-self.instant)?, rates(self.instant)?);
        let mut convective = vec![0.0; m];
        let still = State {
            a: vec![0.0; at.a.len()],
            ..at.clone()
        };
        model.constraint_acceleration(&still, &mut convective);
        let slopes = places
            .iter()
            .map(|&p| (high[p] - low[p]) / (2.0 * self.instant));
        let slopes: Vec<f64> = slopes.collect();
        let scale = largest(&slopes).max(1.0);
        parts.convective.see_scaled(&convective, &slopes, scale);

        let mut loaded = at.clone();
        loaded.z.fill(0.0);
        for (row, lambda) in loaded.lambda.iter_mut().enumerate() {
            *lambda = 1.0 + row as f64;
        }
        let unloaded = State {
            lambda: vec![0.0; m],
            ..loaded.clone()
        };
        let ([with, _], [without, _]) = (
            rust_tangents(model, &loaded),
            rust_tangents(model, &unloaded),
        );
        let rust: Vec<f64> = with.iter().zip(&without).map(|(w, o)| w - o).collect();
        let mut cpp = vec![0.0; n * n];
        for j in 0..n {
            let mut unit = vec![0.0; at.q.len()];
            unit[j] = 1.0;
            let bent = slope(&self.embedding.spread(&unit))?;
            let mut column = vec![0.0; width];
            for (place, lambda) in places.iter().zip(&loaded.lambda) {
                let gradient = &bent[place * width..(place + 1) * width];
                for (sum, g) in column.iter_mut().zip(gradient) {
                    *sum += lambda * g;
                }
            }
            for (i, value) in self.embedding.gather(&column)[..n].iter().enumerate() {
                cpp[i * n + j] = *value;
            }
        }
        parts.curvature.see_all(&rust, &cpp);
        Ok(())
    }

    /// For each multiplier of Looselink the row of the reference, through the names of links and joints.
    fn constraint_places(&self) -> Vec<Option<usize>> {
        let model = self.simulation.model();
        let mut names = Vec::new();
        let Description {
            mechanism,
            bodies,
            joints,
            motions,
            ..
        } = &self.description;
        for (body, name) in mechanism.bodies.iter().zip(bodies) {
            match body.kind {
                body_kind::RIGID_LINK => names.push(format!("length of {name}")),
                body_kind::MOVING_BODY => names.extend(["x", "y", "theta"].map(String::from)),
                _ => {}
            }
        }
        for (joint, name) in mechanism.joints.iter().zip(joints) {
            let parts: &[&str] = match joint.kind {
                joint_kind::PRISMATIC if joint.hold_rotation != 0 => &["line", "angle"],
                joint_kind::PRISMATIC => &["line"],
                joint_kind::WELD if joint.hold_slope != 0 => &["x", "y", "slope x", "slope y"],
                joint_kind::WELD => &["x", "y", "angle"],
                _ if joint.contact < 0 => &["x", "y"],
                _ => &[],
            };
            names.extend(parts.iter().map(|part| format!("joint {name} ({part})")));
        }
        names.extend(mechanism.legs.iter().map(|_| "leg".to_owned()));
        names.extend(
            motions
                .iter()
                .map(|[_, drive, part]| format!("drive {drive} ({part})")),
        );
        let multipliers = &model.unknown_names()[model.shape().unknowns..];
        let place = |name: &String| names.iter().position(|n| n == name);
        multipliers.iter().map(place).collect()
    }
}

/// Far enough that loose joints touch and directions change, not so far that forces of contacts dwarf all others.
fn spread(mechanism: &Mechanism) -> f64 {
    let clearances = mechanism.contacts.iter().map(|c| c.clearance);
    let largest = clearances.fold(0.0, f64::max);
    match (mechanism.legs.is_empty(), largest > 0.0) {
        (false, _) => 2e-4,
        (true, true) => 3.0 * largest,
        (true, false) => 0.1,
    }
}

fn residual(model: &Model, at: &State) -> Vec<f64> {
    let shape = model.shape();
    let (mut r, mut phi) = (vec![0.0; shape.coordinates], vec![0.0; shape.multipliers]);
    model.residual(at, &mut r, &mut phi, &mut model.work());
    r
}

/// Columns of M by unit accelerations, with no force acting.
fn rust_mass(model: &Model, at: &State) -> Vec<f64> {
    let n = at.a.len();
    let mut open = at.clone();
    open.z.fill(0.0);
    open.a.fill(0.0);
    let still = residual(model, &open);
    let mut mass = vec![0.0; n * n];
    // so large that the forces, which cancel, are rounding beside it; a power of two, which divides without rounding
    let large = f64::from(1 << 24);
    for j in 0..n {
        open.a[j] = large;
        for (i, (moved, still)) in residual(model, &open).iter().zip(&still).enumerate() {
            mass[i * n + j] = (moved - still) / large;
        }
        open.a[j] = 0.0;
    }
    mass
}

/// df/dq and df/dv over the unknowns: the stage matrix for a weight in one of them, less M.
fn rust_tangents(model: &Model, at: &State) -> [Vec<f64>; 2] {
    let matrix = |w: Weights| {
        let shape = model.shape();
        let (mut r, mut phi) = (vec![0.0; shape.coordinates], vec![0.0; shape.multipliers]);
        let mut k = vec![0.0; model.symbolic().len()];
        model.linearise(at, w, &mut r, &mut phi, &mut k, &mut model.work());
        model.symbolic().to_dense(&k)
    };
    let mass = matrix(Weights { q: 0.0, v: 0.0 });
    let n = model.shape().unknowns;
    [Weights { q: 1.0, v: 0.0 }, Weights { q: 0.0, v: 1.0 }].map(|w| {
        let k = matrix(w);
        let entries = (0..n * n).map(|e| (e / n, e % n));
        entries.map(|e| k[e] - mass[e]).collect()
    })
}

/// Phi and Phi_q over the unknowns.
fn rust_constraints(model: &Model, at: &State) -> (Vec<f64>, Vec<f64>) {
    let shape = model.shape();
    let (n, m) = (shape.unknowns, shape.multipliers);
    let mut phi = vec![0.0; m];
    let mut k = vec![0.0; model.level_symbolic().len()];
    model.level(at, &mut phi, &mut k);
    let dense = model.level_symbolic().to_dense(&k);
    let entries = (0..m * n).map(|e| dense[(n + e / n, e % n)]);
    (phi, entries.collect())
}

/// The upper left n x n of a square matrix of `width`.
fn block(matrix: &[f64], width: usize, n: usize) -> Vec<f64> {
    let rows = matrix.chunks_exact(width).take(n);
    rows.flat_map(|row| &row[..n]).copied().collect()
}

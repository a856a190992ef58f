//! Statements of sections 2 to 5: elements, coordinates, contact, integration.

use crate::evidence::{Evidence, statement};
use crate::interval::CriterionVerdict;
use crate::statement::{Basis, Statement};
use looselink::body::{Body, FlexibleLink, RigidBody};
use looselink::link::{ElasticRoute, GaussCable, LiteralCable};
use looselink::simulate::Simulation;
use looselink::stepper::bathe::splitting;
use numbers::{digits, percent, si};

/// The statements.
pub fn statements(e: &Evidence) -> Vec<Statement> {
    vec![
        coordinates(e),
        constant_mass(e),
        invariants_exact(),
        invariants_efficient(e),
        tangent_dominates(e),
        no_constraints(e),
        located(e),
        dissipates(e),
        restitution(e),
        two_sources(e),
        bathe(e),
    ]
}

fn coordinates(e: &Evidence) -> Statement {
    let of = |kind: &dyn Body| match (kind.get(), kind.get()) {
        (Some(FlexibleLink { elements, .. }), _) => 4 * (elements + 1),
        (_, Some(RigidBody { .. })) => 3,
        _ => 0,
    };
    let count: usize = e.c.both.scene.bodies.iter().map(|b| of(&*b.kind)).sum();
    Statement {
        measured: format!("the scene of case 4 has {count}; separate coordinates for the cranks would add 12."),
        criterion: "the count is 27",
        verdict: CriterionVerdict::of(count == 27),
        basis: Basis::Construction,
        why: "A cubic element has 4 coordinates per node, so one element per link gives 3 × 8; the platform has 3. The cranks have none, because their pins are known functions of time.".into(),
        ..statement("coordinates", "Abstract, Sect. 3, 7", "Natural coordinates for rigid and ANCF for flexible links lower the global coordinates: 27 in all, 24 of the flexible links and 3 of the platform.")
    }
}

fn constant_mass(e: &Evidence) -> Statement {
    let bodies = e.c.both.scene.bodies.iter();
    let links = bodies.filter_map(|b| b.kind.get::<FlexibleLink>());
    let elements: usize = links.map(|link| link.elements).sum();
    Statement {
        measured: format!(
            "the mass matrices of the {elements} elements of case 4 are integrated once, when the scene is compiled, and do not depend on the coordinates."
        ),
        criterion: "the integral of eq. 10 does not contain q",
        verdict: CriterionVerdict::Holds,
        basis: Basis::Construction,
        why: "r = S q is linear in q, so the integrand contains only S.".into(),
        ..statement(
            "mass",
            "Sect. 2.2, eq. 10",
            "The mass matrix of the element is constant.",
        )
    }
}

/// Length \[m\], axial \[N\] and bending stiffness \[N m2\] of the passive link, and states of it: straight, stretched,
/// bent.
const LINK: (f64, f64, f64) = (0.242, 1.05e6, 2.1875);

fn states() -> [[f64; 8]; 3] {
    let l = LINK.0;
    [
        [0.0, 0.0, 1.0, 0.0, l, 0.0, 1.0, 0.0],
        [
            0.1,
            -0.2,
            0.8,
            0.6,
            0.1 + 0.81 * l,
            -0.2 + 0.6 * l,
            0.8,
            0.61,
        ],
        [0.0, 0.0, 0.9, 0.4, 0.95 * l, 0.05 * l, 0.9, -0.3],
    ]
}

fn invariants_exact() -> Statement {
    let (l, ea, ei) = LINK;
    let (literal, gauss) = (LiteralCable::new(l, ea, ei), GaussCable::new(l, ea, ei));
    let mut worst: f64 = 0.0;
    for q in states() {
        let ([mut f, mut g], [mut k, mut m]) = ([[0.0; 8]; 2], [[[0.0; 8]; 8]; 2]);
        literal.force_and_tangent(&q, &mut f, &mut k);
        gauss.force_and_tangent(&q, &mut g, &mut m);
        let largest = m.iter().flatten().fold(0.0_f64, |a, x| a.max(x.abs()));
        let pairs = k.iter().flatten().zip(m.iter().flatten());
        worst = pairs.fold(worst, |w, (a, b)| w.max((a - b).abs() / largest));
        // a force is of the size of the axial stiffness times the part of it that does not cancel
        worst = f
            .iter()
            .zip(g)
            .fold(worst, |w, (a, b)| w.max((a - b).abs() / ea));
    }
    Statement {
        measured: format!(
            "force and tangent by eqs. 14 and 15 as printed differ from five-point Gauss quadrature, which is exact here, by at most {} in {} states, relative to the axial stiffness and to the largest entry of the tangent.",
            digits(worst),
            states().len()
        ),
        // rounding of the 64 terms of a sum: about a hundred units
        criterion: "below 1e-14, a hundred rounding errors",
        verdict: CriterionVerdict::of(worst < 1e-14),
        basis: Basis::Construction,
        why: "Both evaluate the same integrals of polynomials exactly. Eq. 11 prints U_l twice; the second is the bending energy U_t.".into(),
        ..statement("invariants", "Sect. 2.2, eqs. 13-15", "The invariant matrices give the elastic force and its tangent.")
    }
}

fn invariants_efficient(e: &Evidence) -> Statement {
    let t = e.t;
    Statement {
        measured: format!(
            "eqs. 14 and 15 as printed take {} times the time of five-point Gauss quadrature for force and tangent of an element. With the 35 distinct integrals of the symmetric tensor behind those matrices it is {} times (measured on {}).",
            digits(t.literal / t.gauss),
            digits(t.reduced / t.gauss),
            t.day
        ),
        criterion: "the invariant matrices as printed take less time than quadrature",
        verdict: CriterionVerdict::of(t.literal < t.gauss),
        why: "Eq. 14 needs 64 quadratic forms with 8 × 8 matrices, which repeat the same 35 numbers. The method is efficient once this symmetry is used.".into(),
        ..statement("efficiency", "Sect. 2.2", "The invariant matrix method improves the computation efficiency.")
    }
}

fn tangent_dominates(e: &Evidence) -> Statement {
    let t = e.t;
    let part = |one: f64| {
        let elastic = t.evaluations * one;
        elastic / (t.step - t.evaluations * t.reduced + elastic)
    };
    let (literal, reduced) = (part(t.literal), part(t.reduced));
    Statement {
        measured: format!(
            "elastic force and tangent take {} of the time of a step of case 2 by eqs. 14 and 15 as printed, and {} with the reduced tensor ({} evaluations per step; measured on {}).",
            percent(literal),
            percent(reduced),
            digits(t.evaluations),
            t.day
        ),
        criterion: "more than half of the time, by the equations as printed",
        verdict: CriterionVerdict::of(literal > 0.5),
        why: "It depends on the method of evaluation: with the reduced tensor the rest of the step takes more time.".into(),
        ..statement("most time", "Sect. 2.2, eq. 15", "The derivative of the elastic force will be the most time consuming part in simulation.")
    }
}

fn no_constraints(e: &Evidence) -> Statement {
    let compiled = Simulation::new(&e.c.both.scene).map(|s| s.inspect());
    let (unknowns, multipliers) = compiled.map_or((0, usize::MAX), |i| (i.unknowns, i.multipliers));
    Statement {
        measured: format!(
            "case 4 has {unknowns} unknown coordinates and {multipliers} multipliers."
        ),
        criterion: "no multiplier",
        verdict: CriterionVerdict::of(multipliers == 0),
        basis: Basis::Construction,
        why: "The driven pins are known functions of time, and joints with clearance are forces."
            .into(),
        ..statement(
            "no constraints",
            "Sect. 3.2",
            "With clearances the constraints are lost, and there is no need to form the constraint equations of the driving links.",
        )
    }
}

fn located(e: &Evidence) -> Statement {
    let all = [e.loose(), e.both()]
        .map(|m| m.values("unlocated"))
        .concat();
    let missed: f64 = all.iter().sum();
    let trials = [e.loose(), e.both()].map(|m| m.mean("trials_a_change"));
    let tolerance = e.c.both.scene.integrator.onset_tolerance;
    Statement {
        measured: format!(
            "contact changes of {} runs that are not located to within {}: {missed}. Trial steps per contact change: {} (case 3) and {} (case 4).",
            all.len(),
            si(tolerance, "m"),
            trials[0].reported(digits),
            trials[1].reported(digits)
        ),
        criterion: "all are located",
        verdict: CriterionVerdict::of(missed == 0.0),
        why: "Bracketed Newton iteration for zero penetration as a function of the step length."
            .into(),
        sources: e.ensembles(),
        ..statement(
            "located",
            "Sect. 4.1",
            "The moment of contact can be found accurately by the Newton-Raphson method.",
        )
    }
}

fn dissipates(e: &Evidence) -> Statement {
    let joule = |v: f64| si(v, "J");
    let lost = [e.loose(), e.both()].map(|m| m.mean("contact_dissipated"));
    Statement {
        measured: format!(
            "energy dissipated in contacts in three cycles: {} in case 3 and {} in case 4.",
            lost[0].reported(joule),
            lost[1].reported(joule)
        ),
        criterion: "above 0 in both",
        verdict: lost[0].above(0.0).and(lost[1].above(0.0)),
        why: "The damping term of eq. 24 dissipates energy in every impact, more for a lower coefficient of restitution."
            .into(),
        sources: e.ensembles(),
        ..statement(
            "dissipates",
            "Sect. 4.2",
            "The contact force model accounts for the energy dissipation during the impact process.",
        )
    }
}

fn restitution(e: &Evidence) -> Statement {
    let scene = &e.c.both.scene;
    let contact = scene.joint("B1").and_then(|j| scene.joints[j].contact());
    let (typed, delivered) = contact.map_or((f64::NAN, f64::NAN), |c| {
        (c.restitution, c.normal_law().delivered_restitution())
    });
    Statement {
        measured: format!(
            "after a free impact with c_e = {} the journal has {} of its impact velocity.",
            digits(typed),
            digits(delivered)
        ),
        criterion: "within 1 % of each other",
        verdict: CriterionVerdict::of((delivered / typed - 1.0).abs() < 0.01),
        basis: Basis::Assumption,
        why: "The paper does not give c_e; 0.9 is assumed. The law is an approximation for small losses: c_e = 0.5 gives 0.7252.".into(),
        ..statement("restitution", "Sect. 4.2, eq. 24", "c_e is the restitution coefficient.")
    }
}

fn two_sources(e: &Evidence) -> Statement {
    let impacts = e.loose().mean("deviation_frequency");
    let meshes = crate::ensembles::MESHES.map(|n| e.e.single(&format!("{n} elements a link")));
    let frequency = meshes.map(|m| m.measures.get("deviation_frequency"));
    let change = frequency
        .map(|f| (f / frequency[0] - 1.0).abs())
        .into_iter()
        .fold(0.0, f64::max);
    let hertz = |v: f64| si(v, "Hz");
    let reported: Vec<String> = frequency.iter().map(|f| hertz(*f)).collect();
    let mut sources = vec![e.loose().source()];
    sources.extend(meshes.map(|m| m.source()));
    Statement {
        measured: format!(
            "median frequency of the deviation of the acceleration: {} with contacts and rigid links (case 3); {} with 1, 2, 4 and 8 elements per link and without contacts (case 2).",
            impacts.reported(hertz),
            reported.join(", ")
        ),
        criterion: "contacts alone excite more than 50 Hz, and a finer mesh changes the frequency by more than 10 %",
        verdict: impacts.above(50.0).and(CriterionVerdict::of(change > 0.1)),
        why: "A finer mesh adds bending modes, which hardly move the platform.".into(),
        sources,
        ..statement(
            "two sources",
            "Sect. 5",
            "The high frequency responses are stimulated both by the high frequency contact forces and by the finite element discretization.",
        )
    }
}

fn bathe(e: &Evidence) -> Statement {
    let gamma = splitting(&e.c.both.scene.integrator.method);
    let runs = [&e.c.flexible, &e.c.loose, &e.c.both];
    Statement {
        measured: format!("the runs of the figures use this method with a first sub-step of {} h and reach {} s.", digits(gamma), crate::campaign::DURATION),
        criterion: "the first sub-step is h/2 and these runs reach the end",
        verdict: CriterionVerdict::of(gamma == 0.5 && runs.iter().all(|r| r.t.last().is_some_and(|t| *t > crate::campaign::DURATION - r.plan.interval))),
        basis: Basis::Construction,
        why: "The paper prints no step. Without physical damping, the step determines how fast a vibration decays.".into(),
        sources: runs.map(|r| r.source()).to_vec(),
        ..statement("bathe", "Abstract, Sect. 5", "The two-step Bathe method with two equal sub-steps solves the motion equations.")
    }
}

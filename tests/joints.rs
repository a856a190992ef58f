//! Loose joints: forces, tangents with all their couplings, and the balance of force and moment.

use crate::differencing;
use ladder::{Rung, Worst};
use looselink::contact::friction::{
    Ambrosio, Bristle, CoulombStribeck, ElastoPlastic, FrictionLaw, LuGre, Stribeck,
};
use looselink::contact::geometry::CircleInCircle;
use looselink::contact::normal::NormalParameters;
use looselink::contact::normal::damped_power::LANKARANI_NIKRAVESH;
use looselink::contact::{ContactPair, ContactState, FrictionalPair, FrictionlessPair, Slip};
use looselink::force::WIDTH;
use looselink::interaction::loose_guide::Walls;
use looselink::marker::{Marker, Separation, Spin};
use looselink::math::plane::Vec2;
use looselink::system::Weights;
use std::sync::Arc;

/// Coordinates: a node and a second node, a body, another body, a slope, an internal state. Sizes near one, so that differences resolve.
fn coordinates() -> (Vec<f64>, Vec<f64>) {
    let q = vec![
        0.0, 0.0, 0.9, 0.4, 0.05, 0.02, 0.7, -0.02, 0.03, -0.4, 1.1, 0.3, 0.0,
    ];
    let v = vec![
        0.2, -0.1, 0.3, 0.5, 0.6, 0.25, 0.9, 0.1, 0.35, -0.7, 0.2, 0.4, 0.025,
    ];
    (q, v)
}

const NODE: Marker = Marker::Node { x: 0 };
const BODY: Marker = Marker::OnBody {
    pose: [4, 5, 6],
    s: Vec2::new(0.02, 0.05),
};
const OTHER: Marker = Marker::OnBody {
    pose: [7, 8, 9],
    s: Vec2::new(-0.03, 0.01),
};

const COEFFICIENT: Stribeck = Stribeck {
    kinetic: 0.3,
    static_: 0.5,
    velocity: 0.7,
};
const STRIBECK: CoulombStribeck = CoulombStribeck {
    coefficient: COEFFICIENT,
    v_r: 0.6,
    viscous: 0.1,
};
const BRISTLE: Bristle = Bristle {
    coefficient: COEFFICIENT,
    stiffness: 10.0,
    damping: 0.3,
    damping_velocity: 0.9,
    viscous: 0.1,
};
/// At the deflection of 0.025 m between the elastic limit and the steady deflection.
const ELASTO_PLASTIC: ElastoPlastic = ElastoPlastic {
    bristle: BRISTLE,
    elastic_limit: 0.01,
};

fn joint(bearing: Marker, journal: Marker) -> FrictionlessPair<CircleInCircle> {
    let parameters = NormalParameters {
        stiffness: 50.0,
        exponent: 1.5,
        restitution: 0.7,
        impact_velocity_floor: 1e-6,
        own: &[],
    };
    FrictionlessPair {
        geometry: CircleInCircle {
            bearing,
            journal,
            bearing_radius: 0.2,
            clearance: 0.03,
        },
        law: (LANKARANI_NIKRAVESH.build)(&parameters),
    }
}

/// A closed contact.
fn closed<'a>(q: &'a [f64], v: &'a [f64]) -> ContactState<'a> {
    ContactState {
        q,
        v,
        a: &[0.0; 13],
        impact_velocity: 0.5,
    }
}

/// The local force and the tangents by q and by v of a term, gathered over all coordinates.
type Evaluate<'a> =
    &'a dyn Fn(&[f64], &[f64], Weights, &mut [f64; WIDTH], &mut [[f64; WIDTH]; WIDTH]) -> bool;

fn check(name: &str, local: &[usize], evaluate: Evaluate) {
    let (q, v) = coordinates();
    let total = |q: &[f64], v: &[f64], w: Weights| {
        let (mut f, mut k) = ([0.0; WIDTH], [[0.0; WIDTH]; WIDTH]);
        assert!(
            evaluate(q, v, w, &mut f, &mut k),
            "{name}: the surfaces must touch"
        );
        (f, k)
    };
    let n = local.len();
    for (level, w) in [
        ("q", Weights { q: 1.0, v: 0.0 }),
        ("v", Weights { q: 0.0, v: 1.0 }),
    ] {
        let (_, k) = total(&q, &v, w);
        let rows: Vec<Vec<f64>> = (0..n).map(|r| k[r][..n].to_vec()).collect();
        let x: Vec<f64> = local
            .iter()
            .map(|&i| if level == "q" { q[i] } else { v[i] })
            .collect();
        let force = |x: &[f64]| {
            let (mut q, mut v) = (q.clone(), v.clone());
            for (&i, x) in local.iter().zip(x) {
                if level == "q" { q[i] = *x } else { v[i] = *x }
            }
            total(&q, &v, w).0[..n].to_vec()
        };
        // by the velocities the normal force is linear and friction piecewise quadratic
        differencing::check(
            &format!("the loose joint, {name}, by {level}"),
            &force,
            &rows,
            &x,
            1e-3,
            level == "v",
        );
    }
}

#[test]
fn tangents_without_friction() {
    for (name, bearing, journal) in [
        ("node in body", NODE, BODY),
        ("body in node", BODY, NODE),
        ("body in body", BODY, OTHER),
    ] {
        let joint = joint(bearing, journal);
        check(name, &joint.coordinates(), &|q, v, w, f, k| {
            joint.force_and_tangent(closed(q, v), w, f, k)
        });
    }
}

#[test]
fn tangents_with_friction() {
    // v0 < |slip| < v1: the sloping part of the law, where every term of the tangent counts
    let ambrosio = Ambrosio {
        coefficient: 0.3,
        v0: 0.01,
        v1: 3.0,
    };
    let laws: [(&str, Arc<dyn FrictionLaw>); 4] = [
        ("ambrosio", Arc::new(ambrosio)),
        ("coulomb_stribeck", Arc::new(STRIBECK)),
        ("lugre", Arc::new(LuGre(BRISTLE))),
        ("elasto_plastic", Arc::new(ELASTO_PLASTIC)),
    ];
    let spins = [
        ("fixed", Spin::Fixed),
        ("chord", Spin::Chord { from: 0, to: 2 }),
        ("slope", Spin::Slope { x: 10 }),
    ];
    for (slip, (law_name, law)) in [Slip::Paper, Slip::Material]
        .into_iter()
        .flat_map(|slip| laws.iter().map(move |law| (slip, law)))
    {
        for (name, spin) in spins {
            let spins = [spin, Spin::Angle { theta: 6 }];
            let state = law.state().map(|_| 12);
            let friction = FrictionalPair::new(joint(NODE, BODY), law.clone(), slip, spins, state);
            let evaluate =
                |q: &[f64], v: &[f64], w, f: &mut [f64; WIDTH], k: &mut [[f64; WIDTH]; WIDTH]| {
                    friction.force_and_tangent(closed(q, v), w, f, k)
                };
            check(
                &format!(
                    "with friction {law_name}, {} slip, {name}",
                    format!("{slip:?}").to_lowercase()
                ),
                &friction.coordinates(),
                &evaluate,
            );
        }
    }
}

/// The force and moment on one side balance those on the other, and the moment is that of the contact point.
#[test]
fn friction_balances_and_dissipates() {
    let (q, v) = coordinates();
    let law = Ambrosio {
        coefficient: 0.3,
        v0: 0.01,
        v1: 0.5,
    };
    let spins = [Spin::Angle { theta: 6 }, Spin::Angle { theta: 9 }];
    let joint = FrictionalPair::new(
        joint(BODY, OTHER),
        Arc::new(law),
        Slip::Material,
        spins,
        None,
    );
    let at = closed(&q, &v);
    let mut f = [0.0; WIDTH];
    assert!(joint.force(at, &mut f), "the surfaces touch");
    let scale = f[0].abs() + f[1].abs();
    for i in 0..2 {
        // action and reaction: a few roundings
        assert!((f[i] + f[3 + i]).abs() <= 1e-15 * scale);
    }
    // the two contact points are delta apart along n, so the pair of tangential forces keeps the moment T delta
    let moment = f[2] + f[5] + q[4] * f[1] - q[5] * f[0] + q[7] * f[4] - q[8] * f[3];
    let gap = joint.gap(&q, &v);
    let (normal, tangential) = joint.forces(at).expect("the surfaces touch");
    Rung::Balance
        .asks("Is T δ the only moment of the forces of a loose joint with friction? Relative to the force")
        .within(
            (moment - tangential.value * gap.delta) / scale,
            1e-14,
            "a few roundings",
        );
    assert!(joint.dissipation(at)[0] > 0.0);
    // the work of the local force is what elastic and dissipated power add up to
    let power: f64 = joint
        .coordinates()
        .iter()
        .zip(f)
        .map(|(&i, f)| f * v[i])
        .sum();
    let expected = normal.value * joint.rate(&gap) + joint.dissipation(at)[0];
    Rung::Balance
        .asks("Is the power of a loose joint with friction the sum of the rates of stored and dissipated energy? Relative error")
        .within((power - expected) / power.abs().max(scale), 1e-14, "a few roundings");
}

/// A residual without a tangent takes a shorter way to the same force.
#[test]
fn the_force_alone_is_that_of_the_tangent() {
    let (q, v) = coordinates();
    let w = Weights { q: 1.0, v: 1.0 };
    let law = Ambrosio {
        coefficient: 0.3,
        v0: 0.01,
        v1: 3.0,
    };
    let same = |name: &str, alone: [f64; WIDTH], with_tangent: [f64; WIDTH], normal: f64| {
        for (a, b) in alone.iter().zip(with_tangent) {
            // one quotient and one product each, and arms shorter than 1
            assert!((a - b).abs() <= 4.0 * f64::EPSILON * normal, "{name}");
        }
    };
    for (name, bearing, journal) in [
        ("node in body", NODE, BODY),
        ("body in node", BODY, NODE),
        ("body in body", BODY, OTHER),
    ] {
        let (mut alone, mut with_tangent, mut k) =
            ([0.0; WIDTH], [0.0; WIDTH], [[0.0; WIDTH]; WIDTH]);
        let smooth = joint(bearing, journal);
        let at = closed(&q, &v);
        let normal = smooth.normal_force(&smooth.gap(&q, &v), at.impact_velocity);
        let normal = normal.expect("the surfaces touch").value;
        assert!(smooth.force(at, &mut alone));
        assert!(smooth.force_and_tangent(at, w, &mut with_tangent, &mut k));
        same(name, alone, with_tangent, normal);

        let spins = [Spin::Angle { theta: 6 }, Spin::Angle { theta: 9 }];
        let rough = FrictionalPair::new(smooth, Arc::new(law), Slip::Material, spins, None);
        let (mut alone, mut with_tangent) = ([0.0; WIDTH], [0.0; WIDTH]);
        rough.force(at, &mut alone);
        rough.force_and_tangent(at, w, &mut with_tangent, &mut k);
        same(name, alone, with_tangent, normal);
    }
}

#[test]
fn no_normal_is_asked_for_at_the_centre() {
    let joint = joint(NODE, BODY);
    let (mut q, v) = coordinates();
    let arm = BODY.arm(&q);
    (q[4], q[5]) = (q[0] - arm[0], q[1] - arm[1]);
    let mut f = [0.0; WIDTH];
    assert!(!joint.force(closed(&q, &v), &mut f));
    assert_eq!(f, [0.0; WIDTH]);
    assert!(joint.rate(&joint.gap(&q, &v)) > 0.0);
}

/// Both slip velocities by their definitions (eqs. 22-23 as printed; the material's with the radii), the law on them, and
/// the force on the journal.
#[test]
fn friction_follows_the_definitions_of_slip() {
    let (q, v) = coordinates();
    let law = Ambrosio {
        coefficient: 0.3,
        v0: 0.01,
        v1: 3.0,
    };
    let spins = [Spin::Angle { theta: 6 }, Spin::Angle { theta: 9 }];
    let (bearing_radius, clearance) = (0.2, 0.03);
    let arm = |theta: f64, s: [f64; 2]| {
        let (sine, cosine) = theta.sin_cos();
        [cosine * s[0] - sine * s[1], sine * s[0] + cosine * s[1]]
    };
    let (a, b) = (arm(q[6], [0.02, 0.05]), arm(q[9], [-0.03, 0.01]));
    let e = [q[7] + b[0] - q[4] - a[0], q[8] + b[1] - q[5] - a[1]];
    let e_dot = [
        v[7] - v[9] * b[1] - v[4] + v[6] * a[1],
        v[8] + v[9] * b[0] - v[5] - v[6] * a[0],
    ];
    let distance = e[0].hypot(e[1]);
    let (n, delta) = ([e[0] / distance, e[1] / distance], distance - clearance);
    let sliding = -e_dot[0] * n[1] + e_dot[1] * n[0];
    let rate = e_dot[0] * n[0] + e_dot[1] * n[1];
    let chi = 0.75 * (1.0 - 0.49);
    let normal = 50.0 * delta.powf(1.5) * (1.0 + chi * rate / 0.5);
    let worst = Worst::new();
    for (slip, velocity) in [
        (Slip::Paper, sliding * delta / distance),
        (
            Slip::Material,
            sliding + v[9] * (bearing_radius - clearance) - v[6] * bearing_radius,
        ),
    ] {
        assert!(velocity.abs() > law.v0, "the law must act");
        let joint = FrictionalPair::new(joint(BODY, OTHER), Arc::new(law), slip, spins, None);
        let at = closed(&q, &v);
        let (pressed, rubbed) = joint.forces(at).expect("the surfaces touch");
        let size = (velocity.abs() - law.v0) / (law.v1 - law.v0) * 0.3 * normal;
        let tangential = size * velocity.signum();
        worst.see(pressed.value / normal - 1.0);
        worst.see(rubbed.value / tangential - 1.0);
        let force = joint.reaction(at);
        worst.see((force[0] + normal * n[0] - tangential * n[1]) / normal);
        worst.see((force[1] + normal * n[1] + tangential * n[0]) / normal);
        // friction takes the power of the velocities that it acts on
        let taken = match slip {
            Slip::Paper => tangential * sliding,
            Slip::Material => tangential * velocity,
        };
        worst.see((joint.dissipation(at)[0] - taken) / taken);
    }
    Rung::Identities
        .asks("Do normal force, friction, force on the journal and power follow their definitions, for both slips? Relative error")
        .within(&worst, 1e-13, "rounding; delta is a difference of numbers twice its size");
}

/// Pins between walls on a body, on a rigid link and on the end of a flexible one, with and without friction.
#[test]
fn tangents_of_pins_between_walls() {
    let law = Ambrosio {
        coefficient: 0.3,
        v0: 0.01,
        v1: 3.0,
    };
    for (name, guide, spin, slider) in [
        ("on a body", BODY, Spin::Angle { theta: 6 }, NODE),
        ("on a link", NODE, Spin::Chord { from: 0, to: 2 }, OTHER),
        ("on a slope", NODE, Spin::Slope { x: 10 }, OTHER),
        ("on the ground", NODE, Spin::Fixed, BODY),
    ] {
        let surface = || FrictionlessPair {
            geometry: Walls::new(
                Separation {
                    from: guide,
                    to: slider,
                },
                spin,
                -0.6,
                0.003,
            ),
            law: joint(NODE, BODY).law,
        };
        let smooth = surface();
        check(
            &format!("pin between walls {name}"),
            &smooth.coordinates(),
            &|q, v, w, f, k| smooth.force_and_tangent(closed(q, v), w, f, k),
        );
        let spins = [spin, Spin::Angle { theta: 9 }];
        let rough = FrictionalPair::new(surface(), Arc::new(law), Slip::Material, spins, None);
        check(
            &format!("pin between walls {name}, with friction"),
            &rough.coordinates(),
            &|q, v, w, f, k| rough.force_and_tangent(closed(q, v), w, f, k),
        );
    }
}

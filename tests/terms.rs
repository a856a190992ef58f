//! Every constraint and every force by differencing: gradients, curvatures, rates, tangents, powers. The states are
//! random, with a straight undeformed beam among them.

use ladder::{Rung, Worst};
use looselink::constraint::{
    Align, ClampSlope, Coincide, Constraint, Curvature, Length, Place, Slide,
};
use looselink::effect::Effect;
use looselink::force::{ElementDamping, Events, Force, MassDamping, WIDTH};
use looselink::interaction::point_law::{LoadGradient, PointLaw, differences};
use looselink::interaction::rod::Distance;
use looselink::interaction::{
    ForceByLaw, Maxwell, PointForce, SpringDamper, Torque, TorsionSpring,
};
use looselink::ledger::{Powers, Side};
use looselink::marker::{Marker, Separation, Spin};
use looselink::math::plane::{Rotation, Vec2, unit};
use looselink::motion::Function;
use looselink::system::{Shape, State, Weights};
use nalgebra::Matrix2;
use std::sync::Arc;

/// Coordinates: two bodies (0..3, 3..6), nodes and slopes of an element (6..14), two more nodes (14..18).
const COUNT: usize = 18;

fn body(x: usize, s: [f64; 2]) -> Marker {
    Marker::OnBody {
        pose: [x, x + 1, x + 2],
        s: s.into(),
    }
}

fn between(from: Marker, to: Marker) -> Separation {
    Separation { from, to }
}

/// A smooth motion of all coordinates: state k is c + b sin(w t + p) with numbers that differ from one to the next.
fn state(k: usize, t: f64) -> State {
    let shape = Shape {
        unknowns: COUNT,
        coordinates: COUNT,
        multipliers: 0,
        contacts: 0,
        crossings: 0,
        memory: 1,
        entries: 5,
    };
    let mut s = State::zeros(shape);
    s.t = t;
    for i in 0..COUNT {
        let x = (k * COUNT + i) as f64;
        let centre = match i {
            6..14 if k == 0 => [0.1, 0.2, 0.8, 0.6, 0.1 + 0.4, 0.2 + 0.3, 0.8, 0.6][i - 6],
            6..14 => [0.1, 0.2, 0.8, 0.6, 0.5, 0.5, 0.8, 0.6][i - 6] + 0.1 * (1.7 * x).sin(),
            _ => (2.3 * x).sin(),
        };
        // the first state is a straight undeformed beam at t = 0 that is moving
        let (size, rate, phase) = (
            0.2,
            1.0 + 0.3 * (1.1 * x).cos(),
            if k == 0 { 0.0 } else { x },
        );
        let (sine, cosine) = (rate * t + phase).sin_cos();
        s.q[i] = centre + size * sine;
        s.v[i] = size * rate * cosine;
        s.a[i] = -size * rate * rate * sine;
    }
    s
}

fn constraints() -> Vec<(&'static str, Box<dyn Constraint>)> {
    let angle = Function::Polynomial(vec![0.3, 0.7, -0.2]);
    vec![
        (
            "length",
            Box::new(Length {
                i: 14,
                j: 16,
                length: 0.7,
            }),
        ),
        (
            "coincide, body and node",
            Box::new(Coincide {
                bearing: body(0, [0.3, -0.1]),
                journal: Marker::Node { x: 6 },
            }),
        ),
        (
            "coincide, chord and body",
            Box::new(Coincide {
                bearing: Marker::OnChord {
                    from: 14,
                    to: 16,
                    share: 0.3,
                },
                journal: body(3, [0.2, 0.4]),
            }),
        ),
        (
            "align, bodies",
            Box::new(Align {
                first: Spin::Angle { theta: 2 },
                second: Spin::Angle { theta: 5 },
                angle: angle.clone(),
                scale: 1.0,
            }),
        ),
        (
            "align, chord and slope",
            Box::new(Align {
                first: Spin::Chord { from: 14, to: 16 },
                second: Spin::Slope { x: 8 },
                angle,
                scale: 0.6,
            }),
        ),
        (
            "align, ground and slope",
            Box::new(Align {
                first: Spin::Fixed,
                second: Spin::Slope { x: 8 },
                angle: Function::Constant(0.2),
                scale: 1.0,
            }),
        ),
        (
            "clamped slope on a body",
            Box::new(ClampSlope {
                first: Spin::Angle { theta: 2 },
                slope: 8,
                turn: Rotation::new(0.4),
                scale: 1.0,
                sign: 1.0,
            }),
        ),
        (
            "clamped slope on a chord",
            Box::new(ClampSlope {
                first: Spin::Chord { from: 14, to: 16 },
                slope: 12,
                turn: Rotation::new(-0.3),
                scale: 1.3,
                sign: 1.0,
            }),
        ),
        (
            "slide on a body",
            Box::new(Slide {
                ends: between(body(0, [0.1, 0.2]), body(3, [-0.2, 0.3])),
                spin: Spin::Angle { theta: 2 },
                turn: Rotation::new(0.7),
                scale: 1.0,
            }),
        ),
        (
            "slide on a chord",
            Box::new(Slide {
                ends: between(Marker::Node { x: 14 }, Marker::Node { x: 6 }),
                spin: Spin::Chord { from: 14, to: 16 },
                turn: Rotation::identity(),
                scale: 1.2,
            }),
        ),
        (
            "rod, bodies",
            Box::new(Distance {
                ends: between(body(0, [0.3, -0.1]), body(3, [0.2, 0.4])),
                length: 0.8,
            }),
        ),
        (
            "rod, chord and node",
            Box::new(Distance {
                ends: between(
                    Marker::OnChord {
                        from: 14,
                        to: 16,
                        share: 0.3,
                    },
                    Marker::Node { x: 6 },
                ),
                length: 0.8,
            }),
        ),
        (
            "place",
            Box::new(Place {
                marker: body(3, [0.4, 0.1]),
                direction: Vec2::new(0.6, 0.8),
                value: Function::Harmonic {
                    mean: 0.1,
                    amplitude: 0.4,
                    frequency: 0.3,
                    phase: 0.2,
                },
            }),
        ),
    ]
}

/// Sum over the columns of local values at their global coordinates.
fn global(coordinates: &[usize], local: &[f64]) -> Vec<f64> {
    let mut sum = vec![0.0; COUNT];
    for (&i, x) in coordinates.iter().zip(local) {
        sum[i] += x;
    }
    sum
}

/// The state with coordinate i moved.
fn moved(s: &State, i: usize, by: f64) -> State {
    let mut s = s.clone();
    s.q[i] += by;
    s
}

#[test]
fn constraints_agree_with_their_differences() {
    let h = 1e-5;
    let [gradients, curvatures, rates] = [Worst::new(), Worst::new(), Worst::new()];
    let mut drifts = 0;
    for (name, c) in constraints() {
        for worst in [&gradients, &curvatures, &rates] {
            worst.at(name);
        }
        for k in 0..8 {
            let s = state(k, 0.0);
            let coordinates = c.coordinates();
            let rows = c.rows();
            let gradient = c.gradient(&s);
            let (mut touched, mut bent) = (false, false);
            for i in 0..COUNT {
                let (low, high) = (c.value(&moved(&s, i, -h)), c.value(&moved(&s, i, h)));
                for d in 0..rows {
                    let exact = global(&coordinates, &gradient[d])[i];
                    touched |= exact != 0.0;
                    gradients.see(exact - (high[d] - low[d]) / (2.0 * h));
                }
            }
            // d(Phi_q^T lambda)/dq, through a dense local matrix
            let lambda = [0.7, -1.3];
            let n = coordinates.len();
            let slots: Vec<u32> = (0..(n * n) as u32).collect();
            let mut local = vec![0.0; n * n];
            let mut out = Curvature {
                slots: &slots,
                columns: n,
                weight: 1.0,
                tangent: &mut local,
            };
            c.curvature(&s, lambda, &mut out);
            let force = |s: &State| {
                let gradient = c.gradient(s);
                let mut sum = vec![0.0; COUNT];
                for d in 0..rows {
                    let row = global(&coordinates, &gradient[d]);
                    sum.iter_mut()
                        .zip(row)
                        .for_each(|(f, g)| *f += lambda[d] * g);
                }
                sum
            };
            for j in 0..COUNT {
                let (low, high) = (force(&moved(&s, j, -h)), force(&moved(&s, j, h)));
                for i in 0..COUNT {
                    let mut exact = 0.0;
                    for (r, &gi) in coordinates.iter().enumerate() {
                        for (q, &gj) in coordinates.iter().enumerate() {
                            exact += if (gi, gj) == (i, j) {
                                local[r * n + q]
                            } else {
                                0.0
                            };
                        }
                    }
                    bent |= exact != 0.0;
                    curvatures.see(exact - (high[i] - low[i]) / (2.0 * h));
                }
            }
            assert!(touched, "{name}");
            let flat = matches!(name, "clamped slope on a chord" | "align, ground and slope");
            assert_eq!(bent, !flat, "{name}: curvature");
            // rates by time alone
            let at = |t: f64| {
                let mut later = s.clone();
                later.t += t;
                c.value(&later)
            };
            let (low, high) = (at(-h), at(h));
            let rate = (high[0] - low[0]) / (2.0 * h);
            rates.see(c.drift(&s) - rate);
            assert_eq!(low[1], high[1], "{name} {k}: drift of the second row");
            drifts += usize::from(c.drift(&s) != 0.0);
            // rates along the motion
            let (low, high) = (state(k, -h), state(k, h));
            let (velocity, acceleration) = (c.velocity(&s), c.acceleration(&s));
            for d in 0..rows {
                let rate = (c.value(&high)[d] - c.value(&low)[d]) / (2.0 * h);
                rates.see(velocity[d] - rate);
                let rate = (c.velocity(&high)[d] - c.velocity(&low)[d]) / (2.0 * h);
                rates.see(acceleration[d] - rate);
            }
            // the columns of a constraint are overwritten, whatever was there before
            let mut again = gradient.map(|row| row.map(|g| g + 7.0));
            assert_eq!(c.value_and_gradient(&s, &mut again), c.value(&s), "{name}");
            for d in 0..rows {
                assert_eq!(again[d][..n], gradient[d][..n], "{name}");
            }
        }
    }
    assert!(drifts > 0, "no constraint depends on time");
    let reason = "central differences of quantities near one: h² and eps/h are 1e-10";
    for (worst, what) in [
        (gradients, "gradients"),
        (curvatures, "curvatures d(Φ_qᵀλ)/dq"),
        (rates, "rates and accelerations along a motion"),
    ] {
        Rung::Derivatives
            .asks(format!(
                "Do the {what} of every kind of constraint agree with differences?"
            ))
            .within(&worst, 3e-9, reason);
    }
}

/// The force and the couple of the first side on the second do the work that -Phi_q^T lambda does when the second side is
/// moved alone.
#[test]
fn reactions_are_conjugate_to_motions() {
    let angle = Function::Polynomial(vec![0.3, 0.7, -0.2]);
    let slide = |slider| Slide {
        ends: between(body(0, [0.1, 0.2]), slider),
        spin: Spin::Angle { theta: 2 },
        turn: Rotation::new(0.7),
        scale: 1.0,
    };
    // each with the coordinates that move the second side along x and y
    let points: [(Box<dyn Constraint>, [usize; 2]); 5] = [
        (
            Box::new(Distance {
                ends: between(body(0, [0.3, -0.1]), body(3, [0.2, 0.4])),
                length: 0.8,
            }),
            [3, 4],
        ),
        (
            Box::new(Coincide {
                bearing: body(0, [0.3, -0.1]),
                journal: Marker::Node { x: 6 },
            }),
            [6, 7],
        ),
        (Box::new(slide(body(3, [-0.2, 0.3]))), [3, 4]),
        (Box::new(slide(Marker::Node { x: 6 })), [6, 7]),
        (
            Box::new(Place {
                marker: body(3, [0.4, 0.1]),
                direction: Vec2::new(0.6, 0.8),
                value: Function::Constant(0.1),
            }),
            [3, 4],
        ),
    ];
    let directions: [(Box<dyn Constraint>, Spin); 4] = [
        (
            Box::new(Align {
                first: Spin::Angle { theta: 2 },
                second: Spin::Angle { theta: 5 },
                angle: angle.clone(),
                scale: 1.0,
            }),
            Spin::Angle { theta: 5 },
        ),
        (
            Box::new(Align {
                first: Spin::Chord { from: 14, to: 16 },
                second: Spin::Slope { x: 8 },
                angle,
                scale: 0.6,
            }),
            Spin::Slope { x: 8 },
        ),
        (
            Box::new(ClampSlope {
                first: Spin::Angle { theta: 2 },
                slope: 8,
                turn: Rotation::new(0.4),
                scale: 1.0,
                sign: 1.0,
            }),
            Spin::Slope { x: 8 },
        ),
        (
            Box::new(ClampSlope {
                first: Spin::Chord { from: 14, to: 16 },
                slope: 12,
                turn: Rotation::new(-0.3),
                scale: 1.3,
                sign: 1.0,
            }),
            Spin::Slope { x: 12 },
        ),
    ];
    let lambda = [0.7, -1.3];
    let worst = Worst::new();
    for k in 0..8 {
        let s = state(k, 0.0);
        let power = |c: &dyn Constraint, v: &[f64]| -> f64 {
            let (coordinates, gradient) = (c.coordinates(), c.gradient(&s));
            let row = |d: usize| -> f64 {
                let sum = global(&coordinates, &gradient[d]);
                sum.iter().zip(v).map(|(g, v)| g * v).sum()
            };
            -(0..c.rows()).map(|d| lambda[d] * row(d)).sum::<f64>()
        };
        for (c, moved) in &points {
            for (force, i) in c.force(&s, lambda).into_iter().zip(moved) {
                let mut v = [0.0; COUNT];
                v[*i] = 1.0;
                worst.see(power(&**c, &v) - force);
            }
            assert_eq!(c.couple(&s, lambda), 0.0);
        }
        for (c, spin) in &directions {
            let mut v = [0.0; COUNT];
            match *spin {
                Spin::Angle { theta } => v[theta] = 1.0,
                Spin::Slope { x } => (v[x], v[x + 1]) = (-s.q[x + 1], s.q[x]),
                _ => unreachable!("second sides are angles and slopes"),
            }
            worst.see(power(&**c, &v) - c.couple(&s, lambda));
            assert_eq!(c.force(&s, lambda), Vec2::zeros());
        }
    }
    Rung::Identities
        .asks("Do force and couple of a joint do the work of its multipliers? Error of the power for unit velocities")
        .within(&worst, 1e-14, "rounding of sums of numbers near one");
}

/// A direction has two zeros, half a turn apart; only the second is reported. Other constraints have none.
#[test]
fn the_second_zero_of_an_angle_is_told() {
    let align = Align {
        first: Spin::Angle { theta: 2 },
        second: Spin::Angle { theta: 5 },
        angle: Function::Constant(0.4),
        scale: 1.0,
    };
    let mut s = state(1, 0.0);
    for (turn, second) in [(0.0, false), (std::f64::consts::PI, true), (1.5, false)] {
        s.q[5] = s.q[2] + 0.4 + turn;
        assert_eq!(align.half_turn(&s), second, "{turn}");
    }
    for (name, c) in constraints() {
        assert!(name.starts_with("align") || !c.half_turn(&s), "{name}");
    }
}

/// Travel along the line and distance from it make up the distance of the slider from the guide's point.
#[test]
fn travel_is_measured_along_the_line() {
    let slide = Slide {
        ends: between(body(0, [0.1, 0.2]), Marker::Node { x: 6 }),
        spin: Spin::Angle { theta: 2 },
        turn: Rotation::new(0.7),
        scale: 1.0,
    };
    let h = 1e-5;
    for k in 0..8 {
        let s = state(k, 0.0);
        let (sine, cosine) = s.q[2].sin_cos();
        let guide = [
            s.q[0] + 0.1 * cosine - 0.2 * sine,
            s.q[1] + 0.1 * sine + 0.2 * cosine,
        ];
        let e = [s.q[6] - guide[0], s.q[7] - guide[1]];
        let [travel, rate] = slide.travel(&s);
        let (line_sine, line_cosine) = (s.q[2] + 0.7).sin_cos();
        // rounding of numbers near one
        assert!((travel - (line_cosine * e[0] + line_sine * e[1])).abs() < 1e-14);
        let [high, low] = [h, -h].map(|t| slide.travel(&state(k, t))[0]);
        // central differences, as above
        assert!((rate - (high - low) / (2.0 * h)).abs() < 3e-9, "{k}");
    }
}

/// F = -0.6 |v| v - 2 |r|^2 r + t (0.3, -0.2).
#[derive(Debug)]
struct DragAndSpring;

impl PointLaw for DragAndSpring {
    fn effect(&self) -> Effect {
        "drag_and_spring"
    }

    fn force(&self, t: f64, r: Vec2, v: Vec2) -> Vec2 {
        -0.6 * v.norm() * v - 2.0 * r.norm_squared() * r + t * Vec2::new(0.3, -0.2)
    }

    fn gradient(&self, _: f64, r: Vec2, v: Vec2, _: Vec2) -> LoadGradient {
        let one = Matrix2::identity();
        let by_r = -2.0 * (r.norm_squared() * one + 2.0 * r * r.transpose());
        let by_v = -0.6 * (v.norm() * one + v * v.transpose() / v.norm());
        LoadGradient::from_columns(&[
            by_r.column(0),
            by_r.column(1),
            by_v.column(0),
            by_v.column(1),
        ])
    }
}

/// The differences that stand in for derivatives are as exact as their step promises, also where the point is at the origin.
#[test]
fn differences_of_a_law_are_its_derivatives() {
    let law = DragAndSpring;
    let worst = Worst::new();
    for (r, v) in [
        ([0.4, -0.7], [0.3, 0.9]),
        ([0.0, 0.0], [1e-3, 0.0]),
        ([-1.0, 1e-3], [0.0, -0.8]),
    ] {
        let (r, v) = (Vec2::from(r), Vec2::from(v));
        let force = law.force(0.5, r, v);
        let differenced = differences(|r, v| law.force(0.5, r, v), r, v, force);
        worst.see((differenced - law.gradient(0.5, r, v, force)).amax());
    }
    Rung::Derivatives
        .asks(
            "Do the differences that replace the derivatives of a user-defined law agree with them?",
        )
        .within(
            &worst,
            1e-5,
            "rounding of two newtons over a step of 1.5e-10, the step of arguments near zero",
        );
}

fn forces() -> Vec<(&'static str, Box<dyn Force>)> {
    let by_law = |marker| {
        Box::new(ForceByLaw {
            marker,
            law: Arc::new(DragAndSpring),
        })
    };
    let element: Vec<usize> = (6..14).collect();
    vec![
        (
            "spring-damper between bodies",
            Box::new(SpringDamper {
                from: body(0, [0.3, -0.1]),
                to: body(3, [0.2, 0.4]),
                stiffness: 3.0,
                damping: 0.7,
                rest_length: 0.4,
            }),
        ),
        (
            "maxwell between bodies",
            Box::new(Maxwell {
                spring: SpringDamper {
                    from: body(0, [0.3, -0.1]),
                    to: body(3, [0.2, 0.4]),
                    stiffness: 3.0,
                    damping: 0.0,
                    rest_length: 0.4,
                },
                damping: 0.7,
                elongation: 17,
                start: 0.1,
            }),
        ),
        (
            "spring without rest length",
            Box::new(SpringDamper {
                from: Marker::Node { x: 6 },
                to: Marker::Node { x: 14 },
                stiffness: 3.0,
                damping: 0.0,
                rest_length: 0.0,
            }),
        ),
        (
            "torsion spring, slope and chord",
            Box::new(TorsionSpring {
                first: Spin::Slope { x: 8 },
                second: Spin::Chord { from: 14, to: 16 },
                stiffness: 2.0,
                damping: 0.4,
                rest_angle: 0.3,
                memory: 0,
            }),
        ),
        (
            "torsion spring, ground and body",
            Box::new(TorsionSpring {
                first: Spin::Fixed,
                second: Spin::Angle { theta: 5 },
                stiffness: 2.0,
                damping: 0.4,
                rest_angle: -0.2,
                memory: 0,
            }),
        ),
        (
            "dead force on a body",
            Box::new(PointForce {
                marker: body(0, [0.3, -0.1]),
                spin: Spin::Fixed,
                components: [
                    Function::Constant(1.3),
                    Function::Polynomial(vec![0.2, 0.5]),
                ],
            }),
        ),
        (
            "follower force on a beam",
            Box::new(PointForce {
                marker: Marker::Node { x: 10 },
                spin: Spin::Slope { x: 12 },
                components: [Function::Constant(0.4), Function::Constant(-0.9)],
            }),
        ),
        (
            "follower force on a body",
            Box::new(PointForce {
                marker: body(3, [0.3, 0.2]),
                spin: Spin::Angle { theta: 5 },
                components: [Function::Constant(0.4), Function::Constant(-0.9)],
            }),
        ),
        ("law at a point of a body", by_law(body(3, [0.3, 0.2]))),
        ("law at a node of a beam", by_law(Marker::Node { x: 10 })),
        (
            "law at a point of a chord",
            by_law(Marker::OnChord {
                from: 14,
                to: 16,
                share: 0.3,
            }),
        ),
        (
            "torque between a slope and a chord",
            Box::new(Torque {
                first: Spin::Slope { x: 8 },
                second: Spin::Chord { from: 14, to: 16 },
                value: Function::Constant(0.8),
            }),
        ),
        (
            "torque on a slope",
            Box::new(Torque {
                first: Spin::Fixed,
                second: Spin::Slope { x: 12 },
                value: Function::Constant(0.8),
            }),
        ),
        (
            "element damping",
            Box::new(ElementDamping::new(element.clone(), 0.5, 2.0, 0.3)),
        ),
        (
            "mass damping",
            Box::new(MassDamping {
                values: (0..64)
                    .map(|i| if i % 9 == 0 { 1.5 } else { 0.0 })
                    .collect(),
                coordinates: element,
            }),
        ),
    ]
}

#[test]
fn forces_agree_with_their_differences() {
    let h = 1e-5;
    let [tangents, balances] = [Worst::new(), Worst::new()];
    for (name, term) in forces() {
        for worst in [&tangents, &balances] {
            worst.at(name);
        }
        for k in 0..8 {
            let mut s = state(k, 0.0);
            if let Some(events) = term.events() {
                events.commit(&mut s, &[], 0.0);
            }
            let coordinates = term.coordinates();
            let force = |s: &State| {
                let mut f = [0.0; WIDTH];
                term.force(s, &mut f);
                global(&coordinates, &f)
            };
            let mut resists = false;
            for w in [Weights { q: 1.0, v: 0.0 }, Weights { q: 0.0, v: 1.0 }] {
                let (mut f, mut local) = ([0.0; WIDTH], [[0.0; WIDTH]; WIDTH]);
                term.force_and_tangent(&s, w, &mut f, &mut local);
                assert_eq!(global(&coordinates, &f), force(&s), "{name}");
                for j in 0..COUNT {
                    let pushed = |by: f64| {
                        let mut s = s.clone();
                        s.q[j] += w.q * by;
                        s.v[j] += w.v * by;
                        force(&s)
                    };
                    let (low, high) = (pushed(-h), pushed(h));
                    for i in 0..COUNT {
                        let mut exact = 0.0;
                        for (r, &gi) in coordinates.iter().enumerate() {
                            for (c, &gj) in coordinates.iter().enumerate() {
                                exact += if (gi, gj) == (i, j) { local[r][c] } else { 0.0 };
                            }
                        }
                        resists |= exact != 0.0;
                        let difference = (high[i] - low[i]) / (2.0 * h);
                        tangents.see(exact - difference);
                    }
                }
            }
            assert!(resists, "{name}");
            // the power of the force is what is stored, dissipated and put in
            let entries = term.entries();
            let mut powers = vec![0.0; entries.len()];
            let own: Vec<usize> = (0..entries.len()).collect();
            let (all, own) = (&mut powers[..], &own[..]);
            term.powers(&s, &mut Powers { all, own });
            let on = |side| {
                let entries = entries.iter().zip(&powers);
                let own = entries.filter(|(entry, _)| entry.side == side);
                own.map(|(_, power)| power).sum::<f64>()
            };
            let stored = (term.energy(&state_with(&s, k, h)) - term.energy(&state_with(&s, k, -h)))
                / (2.0 * h);
            let lost = on(Side::Lost);
            let power: f64 = force(&s).iter().zip(&s.v).map(|(f, v)| f * v).sum();
            let balance = stored + lost - on(Side::Supplied);
            // here an internal state moves as the other coordinates, not as its own equation says
            if !name.starts_with("maxwell") {
                balances.see(power - balance);
            }
            assert!(lost >= 0.0, "{name}");
        }
    }
    let reason = "central differences of quantities near ten: h² and eps/h are 1e-10";
    Rung::Derivatives
        .asks("Do the tangents of springs, loads and damping by positions and velocities agree with differences?")
        .within(&tangents, 3e-8, reason);
    Rung::Balance
        .asks("Is the power of springs, loads and damping the sum of the rates of stored, supplied and dissipated energy?")
        .within(&balances, 3e-8, reason);
}

/// The state at another instant with the memory of `s`.
fn state_with(s: &State, k: usize, t: f64) -> State {
    let mut other = state(k, t);
    other.memory.copy_from_slice(&s.memory);
    other
}

/// A rigid motion of a bent beam is not damped inside.
#[test]
fn element_damping_does_not_see_rigid_motions() {
    let damping = ElementDamping::new((6..14).collect(), 0.5, 2.0, 0.3);
    let mut s = state(3, 0.0);
    let omega = 1.7;
    for x in (6..14).step_by(2) {
        let drift = if x == 6 || x == 10 {
            [0.3, -0.8]
        } else {
            [0.0; 2]
        };
        s.v[x] = drift[0] - omega * s.q[x + 1];
        s.v[x + 1] = drift[1] + omega * s.q[x];
    }
    let mut f = [0.0; WIDTH];
    damping.force(&s, &mut f);
    let worst = Worst::new();
    f.iter().for_each(|f| worst.see(*f));
    Rung::Identities
        .asks("Is a rigid motion of a bent element free of strain-rate damping?")
        .within(&worst, 1e-14, "rounding of forces near one");
}

/// Full turns are counted: two turns of the second body wind a spring twice.
#[test]
fn torsion_springs_count_turns() {
    let spring = TorsionSpring {
        first: Spin::Fixed,
        second: Spin::Slope { x: 8 },
        stiffness: 2.0,
        damping: 0.0,
        rest_angle: 0.0,
        memory: 0,
    };
    let mut s = state(1, 0.0);
    let last = 4.0 * std::f64::consts::PI;
    for step in 0..=40 {
        let angle = last * f64::from(step) / 40.0;
        (s.q[8], s.q[9]) = (angle.cos(), angle.sin());
        // turns are counted, and the motion does not feel it
        assert!(!spring.commit(&mut s, &[], 0.0));
    }
    // rounding of 12.6
    assert!((spring.measure(&s)[1] - last).abs() < 1e-14);
    assert!((spring.energy(&s) - last * last).abs() < 1e-12);
}

/// At the start the angle is within half a turn of the rest angle, however many turns that has.
#[test]
fn torsion_springs_start_near_their_rest_angle() {
    let two_turns = 4.0 * std::f64::consts::PI;
    let spring = TorsionSpring {
        first: Spin::Fixed,
        second: Spin::Slope { x: 8 },
        stiffness: 2.0,
        damping: 0.0,
        rest_angle: two_turns,
        memory: 0,
    };
    let mut s = state(1, 0.0);
    (s.q[8], s.q[9]) = (0.1_f64.cos(), 0.1_f64.sin());
    spring.begin(&mut s);
    // rounding of 12.6
    assert!((spring.measure(&s)[1] - two_turns - 0.1).abs() < 1e-14);
}

/// What belongs to the first side of a constraint or force: the joint forces of eliminated joints are summed by it.
#[test]
fn sides_are_split_behind_the_first() {
    let splits = |name: &str| match name {
        "length" | "spring without rest length" => 2,
        "rod, bodies" => 3,
        "rod, chord and node" => 4,
        "coincide, body and node" | "spring-damper between bodies" | "maxwell between bodies" => 3,
        "coincide, chord and body" | "align, chord and slope" | "clamped slope on a chord" => 4,
        "align, bodies" | "clamped slope on a body" => 1,
        "slide on a body" => 3 + 1,
        "slide on a chord" => 2 + 4,
        "torsion spring, slope and chord" | "torque between a slope and a chord" => 2,
        _ => 0,
    };
    for (name, c) in constraints() {
        assert_eq!(c.sides()[0].len(), splits(name), "{name}");
    }
    for (name, f) in forces() {
        assert_eq!(f.sides()[0].len(), splits(name), "{name}");
    }
}

/// What forces tell of themselves, with closed forms at one state.
#[test]
fn forces_tell_what_they_do() {
    let s = state(2, 0.0);
    let by_name = |wanted: &str| {
        let found = forces().into_iter().find(|(name, _)| *name == wanted);
        found.expect("the force is in the list").1
    };
    let reported = |force: &dyn Force| -> Vec<(&'static str, f64)> {
        let names = force.quantities().iter().map(|(name, _)| *name);
        names.zip(force.measure(&s)).collect()
    };
    let spring = by_name("spring without rest length");
    let e = [s.q[14] - s.q[6], s.q[15] - s.q[7]];
    let e_dot = [s.v[14] - s.v[6], s.v[15] - s.v[7]];
    let length = e[0].hypot(e[1]);
    let rate = (e[0] * e_dot[0] + e[1] * e_dot[1]) / length;
    let expected = [("force", 3.0 * length), ("length", length), ("rate", rate)];
    let worst = Worst::new();
    let compare = |reported: &[(&str, f64)], expected: &[(&str, f64)]| {
        assert_eq!(reported.len(), expected.len());
        for (reported, expected) in reported.iter().zip(expected) {
            assert_eq!(reported.0, expected.0);
            worst.see(reported.1 - expected.1);
        }
    };
    compare(&reported(&*spring), &expected);
    let coil = by_name("torsion spring, ground and body");
    let angle = s.q[5];
    let speed = s.v[5];
    // on the second body, the journal's: against the angle
    let torque = -2.0 * (angle + 0.2) - 0.4 * speed;
    compare(
        &reported(&*coil),
        &[("torque", torque), ("angle", angle), ("speed", speed)],
    );
    compare(
        &reported(&*by_name("dead force on a body")),
        &[("fx", 1.3), ("fy", 0.2)],
    );
    let law = DragAndSpring.force(
        s.t,
        Vec2::new(s.q[10], s.q[11]),
        Vec2::new(s.v[10], s.v[11]),
    );
    compare(
        &reported(&*by_name("law at a node of a beam")),
        &[("fx", law.x), ("fy", law.y)],
    );
    compare(
        &reported(&*by_name("torque on a slope")),
        &[("torque", 0.8)],
    );
    for silent in ["element damping", "mass damping"] {
        let force = by_name(silent);
        compare(&reported(&*force), &[]);
        assert_eq!((force.energy(&s), force.measure(&s)), (0.0, [0.0; 3]));
    }
    Rung::Identities
        .asks("Do springs and loads report forces, lengths, angles and rates that follow their definitions?")
        .within(&worst, 1e-14, "rounding of numbers near one");
}

/// The ground does not turn, so its directions depend on no coordinate.
#[test]
fn a_fixed_direction_has_no_columns() {
    let turning = Spin::Angle { theta: 0 }.columns(unit(0.3));
    assert_eq!((turning.len(), turning.is_empty()), (1, false));
    let fixed = Spin::Fixed.columns(unit(0.3));
    assert_eq!((fixed.len(), fixed.is_empty()), (0, true));
}

/// Where the ends of a spring without rest length meet, the rate of its length is how fast they part.
#[test]
fn ends_of_a_spring_that_meet_part_at_their_relative_velocity() {
    let shape = Shape {
        unknowns: 4,
        coordinates: 4,
        multipliers: 0,
        contacts: 0,
        crossings: 0,
        memory: 0,
        entries: 5,
    };
    let spring = SpringDamper {
        from: Marker::Node { x: 0 },
        to: Marker::Node { x: 2 },
        stiffness: 10.0,
        damping: 0.0,
        rest_length: 0.0,
    };
    let mut at = State::zeros(shape);
    at.v = vec![0.1, 0.0, 0.4, 0.4];
    assert_eq!(spring.measure(&at), [0.0, 0.0, 0.5]);
    // along the line, once there is one
    at.q[2] = 1e-3;
    let [_, length, rate] = spring.measure(&at);
    assert!((length - 1e-3).abs() < 1e-18 && (rate - 0.3).abs() < 1e-15);
}

//! The battery of element kernels: mass, energy, force, tangent, every route of the registry.

use crate::differencing;
use ladder::{Rung, Worst};
use looselink::link::{AncfCable, ElasticRoute, ROUTES, natural_rigid};
use proptest::prelude::*;

const LENGTH: f64 = 0.242;
const EA: f64 = 1.05e6;
const EI: f64 = 2.1875;

/// A physical state: an undeformed element moved rigidly, then stretched and bent within bounds.
fn states() -> impl Strategy<Value = [f64; 8]> {
    let bend = prop::array::uniform4(-1.0..1.0_f64);
    (
        -0.5..0.5_f64,
        -0.5..0.5_f64,
        -3.1..3.1_f64,
        -9.0..-0.5_f64,
        bend,
    )
        .prop_map(|(x, y, angle, log_size, d)| {
            let size = 10.0_f64.powf(log_size);
            let (s, c) = angle.sin_cos();
            let mut q = [x, y, c, s, x + LENGTH * c, y + LENGTH * s, c, s];
            for (i, d) in d.iter().enumerate() {
                q[[2, 3, 6, 7][i]] += size * d;
                q[4 + i % 2] += 0.3 * LENGTH * size * d;
            }
            q
        })
}

fn straight(angle: f64) -> [f64; 8] {
    let (s, c) = angle.sin_cos();
    [0.1, -0.2, c, s, 0.1 + LENGTH * c, -0.2 + LENGTH * s, c, s]
}

fn evaluate(route: &dyn ElasticRoute, q: &[f64; 8]) -> ([f64; 8], [[f64; 8]; 8]) {
    let (mut f, mut k) = ([0.0; 8], [[0.0; 8]; 8]);
    route.force_and_tangent(q, &mut f, &mut k);
    (f, k)
}

/// Rounding of the force: the strain is the difference of numbers near one, times EA, and bending EI/l^2; in the
/// coordinates (r/l, r') both are forces.
fn rounding(q: &[f64; 8]) -> f64 {
    let slope = q[2].hypot(q[3]).max(q[6].hypot(q[7])).max(1.0);
    1e-13 * (EA + EI / (LENGTH * LENGTH)) * slope.powi(3)
}

#[test]
fn mass_is_symmetric_positive_definite_and_sums_to_the_mass() {
    let (least, translation, rotation) = (Worst::new(), Worst::new(), Worst::new());
    proptest!(|(l in 1e-3..10.0_f64, density in 1e-3..100.0_f64)| {
        let m = AncfCable::mass(l, density);
        let matrix = nalgebra::Matrix4::from_fn(|i, j| m[i][j]);
        prop_assert_eq!(matrix, matrix.transpose());
        let scaled = nalgebra::Matrix4::from_fn(|i, j| {
            let size = |a: usize| if a % 2 == 1 { l } else { 1.0 };
            m[i][j] / (size(i) * size(j) * density * l)
        });
        least.see(1.0 / scaled.symmetric_eigenvalues().min().max(0.0));
        // translation: the position functions sum to one
        let total = m[0][0] + 2.0 * m[0][2] + m[2][2];
        translation.see((total - density * l) / (density * l));
        // rotation of the undeformed element about its start: rho A l^3/3
        let v = [0.0, 1.0, l, 1.0];
        let inertia: f64 = (0..4).map(|i| (0..4).map(|j| v[i] * m[i][j] * v[j]).sum::<f64>()).sum();
        rotation.see((inertia - density * l.powi(3) / 3.0) / (density * l.powi(3)));
    });
    Rung::Identities
        .asks("Is the element's mass matrix symmetric and positive definite? Inverse of its least scaled eigenvalue")
        .within(&least, 1e4, "scaled to (r, l r'), the matrix is the same for all elements; symmetric to the last bit");
    Rung::Identities
        .asks("Does the mass of a translating element sum to its mass? Relative error")
        .within(&translation, 4.0 * f64::EPSILON, "rounding of three terms");
    Rung::Identities
        .asks("Is the inertia of a rotating element that of a rod, m l²/3? Relative error")
        .within(
            &rotation,
            1e-14,
            "rounding of sixteen terms that partly cancel",
        );
}

#[test]
fn routes_agree() {
    let (forces, tangents) = (Worst::new(), Worst::new());
    proptest!(|(q in states())| {
        let (force, tangent) = evaluate(&*(ROUTES[0].build)(LENGTH, EA, EI), &q);
        let largest = tangent.iter().flatten().fold(0.0_f64, |m, k| m.max(k.abs()));
        for route in &ROUTES[1..] {
            let (f, k) = evaluate(&*(route.build)(LENGTH, EA, EI), &q);
            let mut alone = [0.0; 8];
            (route.build)(LENGTH, EA, EI).force(&q, &mut alone);
            for i in 0..8 {
                let to_force = if [0, 1, 4, 5].contains(&i) { 1.0 } else { 1.0 / LENGTH };
                forces.see((f[i] - force[i]) * to_force / rounding(&q));
                forces.see((f[i] - alone[i]) * to_force / rounding(&q));
                for j in 0..8 {
                    tangents.see((k[i][j] - tangent[i][j]) / largest);
                }
            }
        }
    });
    Rung::Routes
        .asks("Are the elastic forces of invariants in closed form, of Gauss quadrature and of eqs. 12-15 as printed the same?")
        .within(&forces, 1.0, "in units of 1e-13 (EA + EI/l²) |r'|³, the rounding of a difference of numbers near EA");
    Rung::Routes
        .asks("Are their tangents the same? Relative to the largest entry")
        .within(&tangents, 1e-12, "rounding of sums of some hundred terms");
}

#[test]
fn rigid_motion_stores_nothing_and_needs_no_force() {
    let (energies, forces) = (Worst::new(), Worst::new());
    proptest!(|(angle in -10.0..10.0_f64, x in -1.0..1.0_f64)| {
        let mut q = straight(angle);
        q[0] += x;
        q[4] += x;
        let cable = AncfCable::new(LENGTH, EA, EI);
        let (axial, bending) = cable.energy(&q);
        energies.see(axial / (EA * LENGTH * 1e-29));
        energies.see(bending / (EI / LENGTH * 1e-28));
        let mut f = [0.0; 8];
        cable.force(&q, &mut f);
        f.iter().for_each(|f| forces.see(f / rounding(&q)));
    });
    Rung::Identities
        .asks("Does a rigid motion of an undeformed element store no energy?")
        .within(
            &energies,
            1.0,
            "in units of 1e-29 EA l and 1e-28 EI/l: squares of rounded strains and bends",
        );
    Rung::Identities
        .asks("Does a rigid motion of an undeformed element need no force?")
        .within(&forces, 1.0, "in units of 1e-13 (EA + EI/l²): rounding");
}

#[test]
fn force_turns_with_the_frame() {
    let worst = Worst::new();
    proptest!(|(q in states(), angle in -3.0..3.0_f64)| {
        let (s, c) = f64::sin_cos(angle);
        let turn = |v: &[f64; 8]| {
            let mut out = *v;
            for i in [0, 2, 4, 6] {
                (out[i], out[i + 1]) = (c * v[i] - s * v[i + 1], s * v[i] + c * v[i + 1]);
            }
            out
        };
        let cable = AncfCable::new(LENGTH, EA, EI);
        let (mut f, mut turned) = ([0.0; 8], [0.0; 8]);
        cable.force(&q, &mut f);
        cable.force(&turn(&q), &mut turned);
        for (a, b) in turn(&f).iter().zip(turned) {
            worst.see((a - b) / rounding(&q));
        }
    });
    Rung::Identities
        .asks("Does the elastic force turn with the frame?")
        .within(
            &worst,
            1.0,
            "in units of 1e-13 (EA + EI/l²) |r'|³: rounding",
        );
}

#[test]
fn force_is_the_gradient_of_the_energy() {
    let worst = Worst::new();
    proptest!(|(q in states())| {
        // differences of an energy of size EA l eps^2 resolve the force only for strains that are not tiny
        let cable = AncfCable::new(1.0, 1.0, 0.01);
        let q = q.map(|x| 2.0 * x);
        let energy = |q: &[f64; 8]| { let (a, b) = cable.energy(q); a + b };
        let mut f = [0.0; 8];
        cable.force(&q, &mut f);
        let size = f.iter().fold(1.0_f64, |m, x| m.max(x.abs()));
        for i in 0..8 {
            let moved = |by: f64| { let mut p = q; p[i] += by; energy(&p) };
            let h = 1e-3;
            let slope = (8.0 * (moved(h) - moved(-h)) - (moved(2.0 * h) - moved(-2.0 * h))) / (12.0 * h);
            worst.see((slope - f[i]) / size);
        }
    });
    Rung::Derivatives
        .asks("Is the elastic force the gradient of the energy? Relative to the largest force")
        .within(&worst, 1e-11, "a fourth-order difference of a quartic is exact but for rounding, 1e-16 over a span of 1e-3");
}

#[test]
fn tangent_is_the_derivative_of_the_force() {
    let bent = [0.1, -0.2, 1.05, 0.3, 0.31, -0.14, 0.8, -0.5];
    let slack = [0.1, -0.2, 0.4, 0.1, 0.2, -0.1, 0.3, -0.2];
    for route in ROUTES {
        let kernel = (route.build)(LENGTH, EA, EI);
        let force = |x: &[f64]| {
            let mut f = [0.0; 8];
            kernel.force(&std::array::from_fn(|i| x[i]), &mut f);
            f.to_vec()
        };
        for (name, q) in [
            ("straight", straight(0.0)),
            ("turned", straight(2.2)),
            ("bent", bent),
            ("slack", slack),
        ] {
            let (_, k) = evaluate(&*kernel, &q);
            let rows: Vec<Vec<f64>> = k.iter().map(|row| row.to_vec()).collect();
            differencing::check(
                &format!("the elastic force, {}, {name} element", route.name),
                &force,
                &rows,
                &q,
                1e-3,
                false,
            );
            let asymmetry = (0..64)
                .map(|n| (k[n / 8][n % 8] - k[n % 8][n / 8]).abs())
                .fold(0.0_f64, f64::max);
            let size = rows.iter().flatten().fold(0.0_f64, |m, k| m.max(k.abs()));
            // a Hessian is symmetric; the routes sum in different orders
            assert!(
                asymmetry <= 1e-15 * size * 8.0,
                "{}: {asymmetry:e}",
                route.name
            );
        }
    }
}

/// Force and tangent of one element computed once with plain quadrature, independently of this code.
#[test]
fn published_element() {
    let q = [0.1, -0.2, 1.05, 0.3, 1.9, 0.4, 0.8, -0.5];
    let (length, ea, ei) = (2.0, 1000.0, 7.0);
    let force = [
        -3.3165178571427774,
        -26.253571428571394,
        51.179166666666724,
        8.733333333333345,
        3.3165178571427774,
        26.253571428571394,
        -52.226488095238125,
        -16.21190476190473,
    ];
    let worst = Worst::new();
    let (axial, bending) = AncfCable::new(length, ea, ei).energy(&q);
    worst.see((axial + bending) / 15.735773809523824 - 1.0);
    for route in ROUTES {
        let (f, k) = evaluate(&*(route.build)(length, ea, ei), &q);
        for i in 0..8 {
            worst.see((f[i] - force[i]) / 52.0);
        }
        worst.see(k[0][0] / 491.30357142857144 - 1.0);
        worst.see(k[1][3] / -1.9375 - 1.0);
        let trace: f64 = (0..8).map(|i| k[i][i]).sum();
        let square: f64 = k.iter().flatten().map(|x| x * x).sum();
        worst.see(trace / 1827.619047619047 - 1.0);
        worst.see(square.sqrt() / 1326.7286049150268 - 1.0);
    }
    Rung::Published
        .asks("Are energy, force and tangent of the regression element those listed, by every route? Relative error")
        .within(&worst, 1e-12, "the listed digits; the least entry is a difference of numbers 500 times its size");
}

/// The strain that runs report, against Hermite's polynomials differentiated at eleven points.
#[test]
fn strain_is_that_of_the_centre_line() {
    let worst = Worst::new();
    let cable = AncfCable::new(LENGTH, EA, EI);
    proptest!(|(q in states())| {
        for k in 0..=10 {
            let xi = f64::from(k) / 10.0;
            let chord = 6.0 * xi * (1.0 - xi) / LENGTH;
            let (start, end) = (1.0 - 4.0 * xi + 3.0 * xi * xi, 3.0 * xi * xi - 2.0 * xi);
            let slope = [0, 1].map(|i| chord * (q[4 + i] - q[i]) + start * q[2 + i] + end * q[6 + i]);
            let exact = 0.5 * (slope[0] * slope[0] + slope[1] * slope[1] - 1.0);
            worst.see(cable.strain(&q, xi) - exact);
        }
    });
    Rung::Routes
        .asks("Is the strain of an element (r'·r' - 1)/2 of Hermite's polynomials?")
        .within(&worst, 1e-14, "rounding of slopes near one");
}

/// A rigid link in natural coordinates moves as a rod: m/2 v² in translation, m l²/24 ω² about its middle.
#[test]
fn a_rigid_link_has_the_inertia_of_a_rod() {
    let (mass, length, omega) = (0.7, 0.3, 2.0);
    let m = natural_rigid::mass(mass);
    let energy = |ends: [f64; 2]| -> f64 {
        let pairs = (0..2).flat_map(|a| (0..2).map(move |b| (a, b)));
        pairs.map(|(a, b)| 0.5 * ends[a] * m[a][b] * ends[b]).sum()
    };
    let worst = Worst::new();
    worst.see(energy([1.5, 1.5]) / (0.5 * mass * 2.25) - 1.0);
    let tip = 0.5 * length * omega;
    worst.see(energy([-tip, tip]) / (mass * length * length * omega * omega / 24.0) - 1.0);
    Rung::Identities
        .asks("Does a rigid link in natural coordinates have the kinetic energy of a rod? Relative error")
        .within(&worst, 1e-15, "a few roundings");
}

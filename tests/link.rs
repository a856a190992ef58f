//! The battery of element kernels: mass, energy, force, tangent, every route of the registry.

use ladder::{Rung, Worst};
use looselink::link::{AncfCable, ElasticRoute, ROUTES, natural_rigid};
use nalgebra::Matrix4;
use proptest::prelude::*;
use std::f64::consts::PI;

/// The unit roundoff, as often as any term of a sum is rounded on its way into the result: the literal route adds some
/// seventy terms one after the other, each a product of six numbers that are rounded themselves. A sum is then right to this
/// times the sum of the magnitudes of its terms.
const ROUNDINGS: f64 = 100.0 * f64::EPSILON;

/// Length \[m\], EA \[N\] and EI \[N m2\].
#[derive(Debug, Clone, Copy)]
struct ElementProperties {
    length: f64,
    ea: f64,
    ei: f64,
}

impl ElementProperties {
    /// A passive link of the 3-RRR scenes.
    const LINK: ElementProperties = ElementProperties {
        length: 0.242,
        ea: 1.05e6,
        ei: 2.1875,
    };

    /// With a given EI/(EA l^2).
    fn with_ratio(length: f64, ea: f64, ratio: f64) -> ElementProperties {
        let ei = ratio * ea * length * length;
        ElementProperties { length, ea, ei }
    }

    fn cable(&self) -> AncfCable {
        AncfCable::new(self.length, self.ea, self.ei)
    }

    /// The unit of local coordinate i: positions are generated in lengths of the element, slopes as they are.
    fn unit(&self, i: usize) -> f64 {
        if [2, 3, 6, 7].contains(&i) {
            1.0
        } else {
            self.length
        }
    }

    /// Local coordinates of a shape given as (r/l, r').
    fn place(&self, shape: &[f64; 8]) -> [f64; 8] {
        std::array::from_fn(|i| self.unit(i) * shape[i])
    }
}

/// Elements of 0.01 to 10 m with EI/(EA l^2) from 1e-8 to 1.
fn elements() -> impl Strategy<Value = ElementProperties> {
    (-2.0..1.0_f64, 0.0..8.0_f64, -8.0..0.0_f64).prop_map(|(length, ea, ratio)| {
        ElementProperties::with_ratio(
            10.0_f64.powf(length),
            10.0_f64.powf(ea),
            10.0_f64.powf(ratio),
        )
    })
}

/// The undeformed shape at an angle.
fn straight(angle: f64) -> [f64; 8] {
    let (s, c) = angle.sin_cos();
    [0.1, -0.2, c, s, 0.1 + c, -0.2 + s, c, s]
}

/// Physical shapes: the undeformed element moved rigidly, then stretched and bent by up to a third.
fn shapes() -> impl Strategy<Value = [f64; 8]> {
    let rigid = (-0.5..0.5_f64, -0.5..0.5_f64, -PI..PI);
    let deformed = (-9.0..-0.5_f64, prop::array::uniform6(-1.0..1.0_f64));
    (rigid, deformed).prop_map(|((x, y, angle), (log_size, by))| {
        let (s, c) = angle.sin_cos();
        let mut shape = [x, y, c, s, x + c, y + s, c, s];
        for (coordinate, by) in shape[2..].iter_mut().zip(by) {
            *coordinate += 10.0_f64.powf(log_size) * by;
        }
        shape
    })
}

/// Holds `check` against the straight undeformed element, along x and turned, slender and thick, and then against elements
/// and shapes that proptest generates.
fn straight_and_generated(
    check: impl Fn(&ElementProperties, &[f64; 8]) -> Result<(), TestCaseError>,
) {
    for ratio in [1e-8, 1e-4, 1.0] {
        for angle in [0.0, 2.2] {
            let element = ElementProperties::with_ratio(0.242, 1.05e6, ratio);
            let checked = check(&element, &element.place(&straight(angle)));
            checked.unwrap_or_else(|e| panic!("straight at {angle}, {element:?}: {e}"));
        }
    }
    proptest!(|(element in elements(), shape in shapes())| {
        check(&element, &element.place(&shape))?;
    });
}

/// Points and weights of Gauss and Legendre on \[0, 1\], exact up to degree 2 N - 1: roots of the polynomial P_N.
fn gauss<const N: usize>() -> [(f64, f64); N] {
    std::array::from_fn(|k| {
        let mut x = (PI * (k as f64 + 0.75) / (N as f64 + 0.5)).cos();
        let mut slope = f64::NAN;
        // Newton's method from this start converges within a few steps
        for _ in 0..10 {
            let (mut before, mut p) = (1.0, x);
            for n in 1..N {
                let n = n as f64;
                (before, p) = (p, ((2.0 * n + 1.0) * x * p - n * before) / (n + 1.0));
            }
            slope = N as f64 * (x * p - before) / (x * x - 1.0);
            x -= p / slope;
        }
        (0.5 * (1.0 + x), 1.0 / ((1.0 - x * x) * slope * slope))
    })
}

/// Hermite's polynomials that interpolate (r_i, r_i', r_j, r_j') at xi = x/l, and their first and second derivatives by x.
fn hermite(xi: f64, l: f64) -> [[f64; 4]; 3] {
    let (xi2, xi3) = (xi * xi, xi * xi * xi);
    let values = [
        1.0 - 3.0 * xi2 + 2.0 * xi3,
        l * (xi - 2.0 * xi2 + xi3),
        3.0 * xi2 - 2.0 * xi3,
        l * (xi3 - xi2),
    ];
    let first = [
        (6.0 * xi2 - 6.0 * xi) / l,
        1.0 - 4.0 * xi + 3.0 * xi2,
        (6.0 * xi - 6.0 * xi2) / l,
        3.0 * xi2 - 2.0 * xi,
    ];
    let second = [
        (12.0 * xi - 6.0) / (l * l),
        (6.0 * xi - 4.0) / l,
        (6.0 - 12.0 * xi) / (l * l),
        (6.0 * xi - 2.0) / l,
    ];
    [values, first, second]
}

/// Strain energy, its gradient and its Hessian.
#[derive(Debug)]
struct Elastic {
    energy: f64,
    force: [f64; 8],
    tangent: [[f64; 8]; 8],
}

/// Eq. 11 by quadrature, independently of every route: U = EA/2 int eps^2 dx + EI/2 int r''.r'' dx with
/// eps = (r'.r' - 1)/2 has degree 8 in xi, below the 15 that eight points are exact for.
///
/// `of` is what is taken of each number: with `f64::abs` every sum is that of the magnitudes of its terms, which
/// [`ROUNDINGS`] multiplies.
fn eq_11(element: &ElementProperties, q: &[f64; 8], of: fn(f64) -> f64) -> Elastic {
    let ElementProperties { length, ea, ei } = *element;
    let mut sum = Elastic {
        energy: 0.0,
        force: [0.0; 8],
        tangent: [[0.0; 8]; 8],
    };
    for (xi, weight) in gauss::<8>() {
        let w = weight * length;
        let [_, first, second] = hermite(xi, length).map(|s| s.map(of));
        let at = |s: &[f64; 4], i: usize| (0..4).map(|a| s[a] * of(q[2 * a + i])).sum::<f64>();
        let slope = [0, 1].map(|i| at(&first, i));
        let bend = [0, 1].map(|i| at(&second, i));
        let strain = 0.5 * (slope[0] * slope[0] + slope[1] * slope[1] + of(-1.0));
        sum.energy += 0.5 * w * ea * strain * strain;
        sum.energy += 0.5 * w * ei * (bend[0] * bend[0] + bend[1] * bend[1]);
        for (a, i) in (0..8).map(|row| (row / 2, row % 2)) {
            sum.force[2 * a + i] +=
                w * (ea * strain * first[a] * slope[i] + ei * second[a] * bend[i]);
            for (b, j) in (0..8).map(|column| (column / 2, column % 2)) {
                let both = ea * first[a] * first[b];
                let diagonal = both * strain + ei * second[a] * second[b];
                sum.tangent[2 * a + i][2 * b + j] +=
                    w * (both * slope[i] * slope[j] + if i == j { diagonal } else { 0.0 });
            }
        }
    }
    sum
}

/// Rounding of the elastic force, in the coordinates (r/l, r'), all of them newtons times metres.
fn rounding(element: &ElementProperties, q: &[f64; 8]) -> f64 {
    let terms = eq_11(element, q, f64::abs).force;
    let scaled = (0..8).map(|i| element.unit(i) * terms[i]);
    ROUNDINGS * scaled.fold(0.0, f64::max)
}

/// Looks at an error over what is allowed of it; more than 1 fails the case, and proptest makes it plain.
fn see(worst: &Worst, error: f64, allowed: f64, what: &str) -> Result<(), TestCaseError> {
    worst.see(error / allowed);
    // written so that what is not a number fails
    prop_assert!(
        error.abs() <= allowed,
        "{what}: {error:e}, allowed {allowed:e}"
    );
    Ok(())
}

#[test]
fn mass_is_symmetric_positive_definite_with_total_first_moment_and_inertia_about_both_ends() {
    let least = Worst::new();
    let [total, moment, inertia, entries] = std::array::from_fn(|_| Worst::new());
    proptest!(|(log_length in -3.0..1.0_f64, log_density in -3.0..2.0_f64)| {
        let (l, density) = (10.0_f64.powf(log_length), 10.0_f64.powf(log_density));
        let m = AncfCable::mass(l, density);
        let matrix = Matrix4::from_fn(|i, j| m[i][j]);
        prop_assert_eq!(matrix, matrix.transpose());
        let size = [1.0, l, 1.0, l];
        let scaled = Matrix4::from_fn(|i, j| m[i][j] / (size[i] * size[j] * density * l));
        let eigenvalue = scaled.symmetric_eigenvalues().min();
        least.see(1.0 / eigenvalue.max(0.0));
        prop_assert!(eigenvalue > 0.0, "least eigenvalue {eigenvalue:e}");
        let product = |v: [f64; 4], w: [f64; 4], of: fn(f64) -> f64| -> f64 {
            (0..16).map(|n| of(v[n / 4] * m[n / 4][n % 4] * w[n % 4])).sum()
        };
        let same = |worst: &Worst, v, w, exact: f64, what| {
            see(worst, product(v, w, |x| x) - exact, ROUNDINGS * product(v, w, f64::abs), what)
        };
        // a translation, and displacements x and l - x that turn the undeformed element about its start and its end
        let (shift, start, end) = ([1.0, 0.0, 1.0, 0.0], [0.0, 1.0, l, 1.0], [l, -1.0, 0.0, -1.0]);
        let mass = density * l;
        same(&total, shift, shift, mass, "total mass")?;
        same(&moment, shift, start, mass * l / 2.0, "first moment about the start")?;
        same(&moment, shift, end, mass * l / 2.0, "first moment about the end")?;
        same(&inertia, start, start, mass * l * l / 3.0, "moment of inertia about the start")?;
        same(&inertia, end, end, mass * l * l / 3.0, "moment of inertia about the end")?;
        same(&inertia, start, end, mass * l * l / 6.0, "product of x and l - x")?;
        // rigid motions see three combinations of the ten numbers; quadrature sees each
        for n in 0..16 {
            let (a, b) = (n / 4, n % 4);
            let integral = |of: fn(f64) -> f64| -> f64 {
                let terms = gauss::<8>().map(|(xi, weight)| {
                    let [s, ..] = hermite(xi, l);
                    of(density * l * weight * s[a] * s[b])
                });
                terms.iter().sum()
            };
            see(&entries, m[a][b] - integral(|x| x), ROUNDINGS * integral(f64::abs), "an entry")?;
        }
    });
    Rung::Identities
        .asks("Is the element's mass matrix symmetric and positive definite? Inverse of its least scaled eigenvalue")
        .within(&least, 1e4, "scaled to (r, l r'), the matrix is the same for all elements; symmetric to the last bit");
    let reason = "in units of 100 eps times the sum of the magnitudes of the terms: rounding";
    for (worst, question) in [
        (
            &total,
            "Is the mass of an element right, over lengths and densities?",
        ),
        (&moment, "Are its first moments about both ends, m l/2?"),
        (
            &inertia,
            "Are its moments of inertia about both ends, m l²/3?",
        ),
        (
            &entries,
            "Is every number of its mass matrix that of the quadrature of Hermite's polynomials?",
        ),
    ] {
        Rung::Identities.asks(question).within(worst, 1.0, reason);
    }
}

/// The elastic force is cubic in every coordinate, so the central difference over 2 h has the error c h^2 and no other:
/// (4 D(h/2) - D(h))/3 is free of truncation for any h. What remains is the rounding rho of the forces, with
/// 4/3 (2 rho/h) + 1/3 (rho/h) = 3 rho/h. A span that is not small makes it small.
#[test]
fn jacobian_of_every_route_is_the_derivative_of_its_force_and_both_are_those_of_gauss_quadrature() {
    const SPAN: f64 = 0.25;
    let [forces, tangents, asymmetry] = std::array::from_fn(|_| Worst::new());
    let derivatives = ROUTES.map(|_| Worst::new());
    straight_and_generated(|element, q| {
        let (exact, terms) = (eq_11(element, q, |x| x), eq_11(element, q, f64::abs));
        let moved = |j: usize, by: f64| {
            let mut moved = *q;
            moved[j] += by;
            moved
        };
        // magnitudes of the forces where they are differenced
        let differenced: [[f64; 8]; 8] = std::array::from_fn(|j| {
            let farthest = q[j].abs() + SPAN * element.unit(j);
            let mut far = *q;
            far[j] = farthest;
            eq_11(element, &far, f64::abs).force
        });
        for (route, derivative) in ROUTES.iter().zip(&derivatives) {
            let kernel = (route.build)(element.length, element.ea, element.ei);
            let force = |q: &[f64; 8]| {
                let mut f = [0.0; 8];
                kernel.force(q, &mut f);
                f
            };
            let (mut f, mut k) = ([0.0; 8], [[0.0; 8]; 8]);
            kernel.force_and_tangent(q, &mut f, &mut k);
            let alone = force(q);
            for i in 0..8 {
                let allowed = 2.0 * ROUNDINGS * terms.force[i];
                see(&forces, f[i] - exact.force[i], allowed, route.name)?;
                see(&forces, alone[i] - exact.force[i], allowed, route.name)?;
                for j in 0..8 {
                    let allowed = 2.0 * ROUNDINGS * terms.tangent[i][j];
                    // entries without a term are zero in both
                    if allowed > 0.0 {
                        see(
                            &tangents,
                            k[i][j] - exact.tangent[i][j],
                            allowed,
                            route.name,
                        )?;
                        see(&asymmetry, k[i][j] - k[j][i], allowed, route.name)?;
                    }
                }
            }
            let mut same_bits = true;
            for j in 0..8 {
                let h = SPAN * element.unit(j);
                let central = |h: f64| {
                    let (high, low) = (force(&moved(j, h)), force(&moved(j, -h)));
                    std::array::from_fn::<f64, 8, _>(|i| (high[i] - low[i]) / (2.0 * h))
                };
                let (coarse, fine) = (central(h), central(h / 2.0));
                for i in 0..8 {
                    let difference = (4.0 * fine[i] - coarse[i]) / 3.0;
                    let allowed =
                        3.0 * ROUNDINGS * differenced[j][i] / h + ROUNDINGS * terms.tangent[i][j];
                    see(derivative, k[i][j] - difference, allowed, route.name)?;
                    same_bits &= k[i][j] == difference;
                }
            }
            let largest = k.iter().flatten().fold(0.0_f64, |m, k| m.max(k.abs()));
            prop_assert!(
                largest > 0.0 && !same_bits,
                "{}: a check of nothing",
                route.name
            );
        }
        Ok(())
    });
    let generated = "over the straight element, generated states and EI/(EA l²) from 1e-8 to 1";
    let reason = "in units of 100 eps times the sum of the magnitudes of the terms: rounding";
    Rung::Routes
        .asks(format!(
            "Is the elastic force of every route that of Gauss quadrature of eq. 11, {generated}?"
        ))
        .within(&forces, 1.0, reason);
    Rung::Routes
        .asks(format!(
            "Is the tangent of every route that of Gauss quadrature of eq. 11, {generated}?"
        ))
        .within(&tangents, 1.0, reason);
    Rung::Identities
        .asks("Is the tangent of every route symmetric, as a Hessian is?")
        .within(&asymmetry, 1.0, reason);
    for (route, worst) in ROUTES.iter().zip(&derivatives) {
        Rung::Derivatives
            .asks(format!("Is the tangent of the elastic force its derivative, route {}, {generated}?", route.name))
            .within(worst, 1.0, "in units of what rounding leaves of two central differences that cancel each other's truncation");
    }
}

#[test]
fn rigid_motion_stores_nothing_and_needs_no_force() {
    let (energies, forces) = (Worst::new(), Worst::new());
    let ElementProperties { length, ea, ei } = ElementProperties::LINK;
    proptest!(|(angle in -10.0..10.0_f64, x in -1.0..1.0_f64)| {
        let mut q = ElementProperties::LINK.place(&straight(angle));
        q[0] += x;
        q[4] += x;
        let cable = ElementProperties::LINK.cable();
        let (axial, bending) = cable.energy(&q);
        energies.see(axial / (ea * length * 1e-29));
        energies.see(bending / (ei / length * 1e-28));
        let mut f = [0.0; 8];
        cable.force(&q, &mut f);
        f.iter().enumerate().for_each(|(i, f)| forces.see(f * ElementProperties::LINK.unit(i) / rounding(&ElementProperties::LINK, &q)));
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
        .within(
            &forces,
            1.0,
            "in units of 100 eps times the sum of the magnitudes of the terms: rounding",
        );
}

#[test]
fn force_turns_with_the_frame() {
    let worst = Worst::new();
    proptest!(|(element in elements(), shape in shapes(), angle in -3.0..3.0_f64)| {
        let q = element.place(&shape);
        let (s, c) = f64::sin_cos(angle);
        let turn = |v: &[f64; 8]| {
            let mut out = *v;
            for i in [0, 2, 4, 6] {
                (out[i], out[i + 1]) = (c * v[i] - s * v[i + 1], s * v[i] + c * v[i + 1]);
            }
            out
        };
        let (mut f, mut turned) = ([0.0; 8], [0.0; 8]);
        element.cable().force(&q, &mut f);
        element.cable().force(&turn(&q), &mut turned);
        let allowed = rounding(&element, &q) + rounding(&element, &turn(&q));
        for (i, (a, b)) in turn(&f).iter().zip(turned).enumerate() {
            see(&worst, (a - b) * element.unit(i), allowed, "a turned force")?;
        }
    });
    Rung::Identities
        .asks("Does the elastic force turn with the frame?")
        .within(
            &worst,
            1.0,
            "in units of 100 eps times the sum of the magnitudes of the terms, of both: rounding",
        );
}

/// The energy is a quartic in every coordinate: the difference of fourth order has no truncation error, and its rounding
/// is (8 * 2 rho + 2 rho)/(12 h).
#[test]
fn force_is_the_gradient_of_the_energy_and_the_energy_is_that_of_gauss_quadrature() {
    const SPAN: f64 = 0.125;
    let (gradients, energies) = (Worst::new(), Worst::new());
    straight_and_generated(|element, q| {
        let cable = element.cable();
        let energy = |q: &[f64; 8]| {
            let (axial, bending) = cable.energy(q);
            axial + bending
        };
        let allowed = 2.0 * ROUNDINGS * eq_11(element, q, f64::abs).energy;
        see(
            &energies,
            energy(q) - eq_11(element, q, |x| x).energy,
            allowed,
            "energy",
        )?;
        let mut f = [0.0; 8];
        cable.force(q, &mut f);
        let terms = eq_11(element, q, f64::abs).force;
        for i in 0..8 {
            let h = SPAN * element.unit(i);
            let moved = |by: f64| {
                let mut moved = *q;
                moved[i] += by;
                energy(&moved)
            };
            let slope =
                (8.0 * (moved(h) - moved(-h)) - (moved(2.0 * h) - moved(-2.0 * h))) / (12.0 * h);
            let mut far = *q;
            far[i] = q[i].abs() + 2.0 * h;
            let rho = ROUNDINGS * eq_11(element, &far, f64::abs).energy;
            see(
                &gradients,
                f[i] - slope,
                1.5 * rho / h + ROUNDINGS * terms[i],
                "gradient",
            )?;
        }
        Ok(())
    });
    Rung::Derivatives
        .asks("Is the elastic force the gradient of the energy?")
        .within(&gradients, 1.0, "in units of the rounding of a difference of fourth order, which is exact for a quartic");
    Rung::Routes
        .asks("Is the strain energy that of Gauss quadrature of eq. 11?")
        .within(
            &energies,
            1.0,
            "in units of 100 eps times the sum of the magnitudes of the terms: rounding",
        );
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
        let (mut f, mut k) = ([0.0; 8], [[0.0; 8]; 8]);
        (route.build)(length, ea, ei).force_and_tangent(&q, &mut f, &mut k);
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
    Rung::Computed
        .asks("Are energy, force and tangent of the regression element those listed, by every route? Relative error")
        .within(&worst, 1e-12, "the listed digits; the least entry is a difference of numbers 500 times its size");
}

/// The strain and the curvature that runs report, against Hermite's polynomials differentiated at eleven points.
#[test]
fn strain_and_curvature_are_those_of_the_centre_line() {
    let worst = Worst::new();
    straight_and_generated(|element, q| {
        for k in 0..=10 {
            let xi = f64::from(k) / 10.0;
            let [_, first, second] = hermite(xi, element.length);
            let sum = |x: [f64; 4], of: fn(f64) -> f64| {
                [0, 1].map(|i| (0..4).map(|a| of(x[a] * q[2 * a + i])).sum::<f64>())
            };
            let slope = |of| sum(first, of);
            let square = |s: [f64; 2]| s[0] * s[0] + s[1] * s[1];
            let strain = 0.5 * (square(slope(|x| x)) - 1.0);
            let allowed = ROUNDINGS * 0.5 * (square(slope(f64::abs)) + 1.0);
            see(
                &worst,
                element.cable().strain(q, xi) - strain,
                allowed,
                "strain",
            )?;
            let [x, y] = sum(second, |x| x);
            let [most_x, most_y] = sum(second, f64::abs);
            see(
                &worst,
                element.cable().curvature(q, xi) - x.hypot(y),
                ROUNDINGS * (most_x + most_y),
                "curvature",
            )?;
        }
        Ok(())
    });
    Rung::Routes
        .asks("Is the strain of an element (r'·r' - 1)/2 of Hermite's polynomials?")
        .within(
            &worst,
            1.0,
            "in units of 100 eps times the sum of the magnitudes of the terms: rounding",
        );
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

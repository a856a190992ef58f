//! Cantilevers in the functional of this element, F2: EA/2 (1/2 (r'.r' - 1))^2 + EI/2 r''.r''.

use super::{CLAMP, beam, last, run, statics};
use crate::support::Recording;
use std::f64::consts::TAU;

/// Relative accuracy of the listed digits of tip displacements: they are printed to 1e-12 m.
const DIGITS: f64 = 1e-8;

fn tip_load(force: [f64; 2]) -> String {
    format!(
        r#"
[forces.tip]
type = "force"
point = "beam.end"
x = {:?}
y = {:?}
frame = "ground"
"#,
        force[0], force[1]
    )
}

/// Gerstmayr and Irschik 2008: L = 2, EA = 2.07e9, EI = 1.725e6, P = 3 EI/L^2 downwards.
fn thick(elements: usize, clamp: &str) -> Recording {
    let text = statics(10)
        + &beam(2.0, 2.07e9, 1.725e6, 78.0, elements)
        + CLAMP
        + clamp
        + &tip_load([0.0, -1_293_750.0]);
    run(&text, &[])
}

fn displacement(run: &Recording, length: f64) -> [f64; 2] {
    [
        last(run, "points.beam.end.x") - length,
        last(run, "points.beam.end.y"),
    ]
}

fn agrees(what: &str, got: [f64; 2], listed: [f64; 2]) {
    for (g, l) in got.iter().zip(listed) {
        assert!(
            (g - l).abs() <= DIGITS * l.abs(),
            "{what}: {got:?}, listed {listed:?}"
        );
    }
}

/// I: section 4.4 of the list of cases, clamp (x, y, r'_y).
#[test]
fn thick_cantilever_at_every_listed_mesh() {
    for (n, x, y) in [
        (1, -0.362693762003, -0.993606271553),
        (2, -0.488776804312, -1.173780377752),
        (4, -0.507924376081, -1.205220078348),
        (8, -0.509242076597, -1.207293963761),
        (16, -0.509285882511, -1.207364220014),
        (64, -0.509287612613, -1.207366926460),
    ] {
        agrees(
            &format!("n = {n}"),
            displacement(&thick(n, ""), 2.0),
            [x, y],
        );
    }
}

/// I: the limit of the strong form, found by Chebyshev collocation.
#[test]
fn thick_cantilever_tends_to_the_limit_of_its_functional() {
    let limit = [-0.50928761779, -1.20736693427];
    let error = |n: usize| {
        let [x, y] = displacement(&thick(n, ""), 2.0);
        (x - limit[0]).hypot(y - limit[1])
    };
    // the layer of thickness sqrt(EI/EA) = L/69 where the stretch varies is resolved from n = 64 on
    let (coarse, fine) = (error(64), error(128));
    assert!(fine < 1e-9, "{fine:e}");
    let order = (coarse / fine).log2();
    assert!((3.5..4.5).contains(&order), "order {order}");
}

/// I: the full slope vector clamped is another problem, with another limit.
#[test]
fn thick_cantilever_with_the_slope_vector_clamped() {
    let run = thick(64, "slope = \"vector\"\n");
    agrees(
        "vector",
        displacement(&run, 2.0),
        [-0.509217085, -1.207308233],
    );
}

/// I: section 4.5, L = 2, EA = 1e6, EI = 2500/3, rho A = 78 under its own weight.
#[test]
fn cantilever_under_gravity_at_every_listed_mesh() {
    for (n, x, y) in [
        (4, -0.49856239125, -1.22717954978),
        (8, -0.50208361507, -1.23254150237),
        (16, -0.50221723460, -1.23275426334),
        (32, -0.50222214997, -1.23276224648),
    ] {
        let text = statics(10) + &beam(2.0, 1e6, 2500.0 / 3.0, 78.0, n) + CLAMP;
        let run = run(&text, &["simulation.gravity=[0.0, -9.81]".into()]);
        agrees(&format!("n = {n}"), displacement(&run, 2.0), [x, y]);
    }
}

/// E: the inextensible elastica. F2 differs from it by a few EI/(EA L^2), the square of the slenderness.
#[test]
fn elastica_in_the_thin_limit() {
    let slenderness = 1e-6;
    for (load, deflection, shortening) in [
        (0.25, 0.08274591535441744, 0.004117818409975759),
        (1.0, 0.3017207737998135, 0.05643323628337688),
        (2.0, 0.4934574803967118, 0.1606417208251672),
        (5.0, 0.7137915236119127, 0.3876283607244299),
        (10.0, 0.8106090248802965, 0.5549955977537513),
    ] {
        let text = statics(20)
            + &beam(1.0, 1.0 / slenderness, 1.0, 1.0, 128)
            + CLAMP
            + &tip_load([0.0, -load]);
        let run = run(&text, &[]);
        let [x, y] = displacement(&run, 1.0);
        let error = (x + shortening).hypot(y + deflection);
        // the load stretches what hangs along it by P/EA = (P L^2/EI) EI/(EA L^2), which passes 5 for the largest
        let factor = load.max(5.0);
        assert!(error < factor * slenderness, "P L^2/EI = {load}: {error:e}");
    }
}

/// P: a dead force -P and a moment 2.5 P at the tip, L = 2 pi, EI = 2 (Harsch, Capobianco and Eugster 2021), inextensible.
#[test]
fn elastica_under_force_and_moment() {
    let (length, bending, slenderness) = (TAU, 2.0, 1e-6);
    let axial = bending / (slenderness * length * length);
    for (alpha, x, y) in [
        (10.0 / 9.0, 6.2098293744871, -0.9023055347978),
        (50.0 / 9.0, 5.4772678584927, -2.8698731964526),
        (10.0, 4.9785345669, -3.4676357007),
    ] {
        let load = alpha * bending / (length * length);
        let moment = format!(
            "[forces.moment]\ntype = \"torque\"\npoint = \"beam.end\"\nvalue = {:?}\n",
            2.5 * load
        );
        let text = statics(20)
            + &beam(length, axial, bending, 1.0, 128)
            + CLAMP
            + &tip_load([0.0, -load])
            + &moment;
        let run = run(&text, &[]);
        let error =
            (last(&run, "points.beam.end.x") - x).hypot(last(&run, "points.beam.end.y") - y);
        // as above, the moment's curvature of 2.5 P/EI = 2.5 alpha/L^2 among the loads
        assert!(
            error < 10.0 * slenderness * length,
            "alpha = {alpha}: {error:e}"
        );
    }
}

/// E, P: Princeton beam in its two planes (Obrezkov et al. 2022 list ANSYS beams). The inextensible elastica has neither
/// shear, which the strong plane of ANSYS has to 5e-4, nor stretch.
#[test]
fn princeton_beam_in_both_planes() {
    let (modulus, h, w, length) = (71.7e9, 12.3777e-3, 3.2024e-3, 0.508);
    for (load, weak, elastica, ansys) in [
        (8.896, false, 0.01070860148, 0.01071417630),
        (8.896, true, 0.1462486573, 0.146245978),
        (13.345, false, 0.01605493858, 0.01606423724),
        (13.345, true, 0.2006789248, 0.200677707),
    ] {
        let (thickness, width): (f64, f64) = if weak { (w, h) } else { (h, w) };
        let axial = modulus * thickness * width;
        let bending = modulus * width * thickness.powi(3) / 12.0;
        let text =
            statics(10) + &beam(length, axial, bending, 1.0, 32) + CLAMP + &tip_load([0.0, -load]);
        let [_, y] = displacement(&run(&text, &[]), length);
        let stretch = 5.0 * bending / (axial * length * length);
        assert!(
            (-y - elastica).abs() < stretch * length,
            "{load} N: {y}, elastica {elastica}"
        );
        assert!(
            (-y - ansys).abs() < 6e-4 * ansys,
            "{load} N: {y}, ANSYS {ansys}"
        );
    }
}

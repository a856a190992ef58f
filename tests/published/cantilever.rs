//! Cantilevers in the functional of this element, F2: EA/2 (1/2 (r'.r' - 1))^2 + EI/2 r''.r''.

use super::{CLAMP, beam, last, run, statics};
use crate::support::TestRecording;
use ladder::{Rung, Worst};
use std::f64::consts::TAU;

const CARDILLO: &str = "analytic centreline after Harsch, Capobianco and Eugster 2021, https://github.com/cardilloproject/cardillo, \
     test/_data_cantilever/centerline_IEB_analytic.csv";
const OBREZKOV: &str = "ANSYS beams after Obrezkov et al. 2022, https://github.com/jgerstmayr/EXUDYN, \
     main/pythonDev/TestModels/ANCFBeamTest.py";

/// Relative accuracy of the listed digits of tip displacements.
const DIGITS: f64 = 1e-8;
const DIGITS_REASON: &str =
    "the listed digits, printed to 1e-9 m or better, and Newton's last update";

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
fn thick(elements: usize, clamp: &str) -> TestRecording {
    let text = statics(10)
        + &beam(2.0, 2.07e9, 1.725e6, 78.0, elements)
        + CLAMP
        + clamp
        + &tip_load([0.0, -1_293_750.0]);
    run(&text, &[])
}

fn displacement(run: &TestRecording, length: f64) -> [f64; 2] {
    [
        last(run, "points.beam.end.x") - length,
        last(run, "points.beam.end.y"),
    ]
}

fn compare(worst: &Worst, got: [f64; 2], listed: [f64; 2]) {
    for (g, l) in got.iter().zip(listed) {
        worst.see(g / l - 1.0);
    }
}

/// I: section 4.4 of the list of cases, clamp (x, y, r'_y).
#[test]
fn thick_cantilever_at_every_listed_mesh() {
    let worst = Worst::new();
    for (n, x, y) in [
        (1, -0.362693762003, -0.993606271553),
        (2, -0.488776804312, -1.173780377752),
        (4, -0.507924376081, -1.205220078348),
        (8, -0.509242076597, -1.207293963761),
        (16, -0.509285882511, -1.207364220014),
        (64, -0.509287612613, -1.207366926460),
    ] {
        compare(&worst, displacement(&thick(n, ""), 2.0), [x, y]);
    }
    Rung::Computed
        .asks("Thick cantilever, F2, n = 1 ... 64: tip displacement against the listed digits, relative error")
        .within(&worst, DIGITS, DIGITS_REASON);
}

/// I: the limit of the strong form, found by Chebyshev collocation.
#[test]
fn thick_cantilever_tends_to_the_limit_of_its_functional() {
    let limit = [-0.50928761779, -1.20736693427];
    let error = |n: usize| {
        let [x, y] = displacement(&thick(n, ""), 2.0);
        (x - limit[0]).hypot(y - limit[1])
    };
    let errors = [(1.0 / 64.0, error(64)), (1.0 / 128.0, error(128))];
    Rung::OrderInElements
        .asks("Thick cantilever, F2: distance of the tip from the limit of the strong form [m]")
        .falls(
            "Element length l/L",
            &errors,
            3.5..4.5,
            "order 4 from n = 64 on, which resolves the layer of thickness sqrt(EI/EA) = L/69 where the stretch varies",
        );
    Rung::Computed
        .asks("Thick cantilever, F2, n = 128: distance of the tip from the limit found by Chebyshev collocation [m]")
        .within(errors[1].1, 1e-9, "a sixteenth of the distance of the listed 64 elements, 9.4e-9 m, is 6e-10 m");
}

/// I: the full slope vector clamped is another problem, with another limit.
#[test]
fn thick_cantilever_with_the_slope_vector_clamped() {
    let run = thick(64, "slope = \"vector\"\n");
    let worst = Worst::new();
    compare(
        &worst,
        displacement(&run, 2.0),
        [-0.509217085, -1.207308233],
    );
    Rung::Computed
        .asks("Thick cantilever with its slope vector clamped, n = 64: tip displacement against the listed digits, relative error")
        .within(&worst, DIGITS, DIGITS_REASON);
}

/// I: section 4.5, L = 2, EA = 1e6, EI = 2500/3, rho A = 78 under its own weight.
#[test]
fn cantilever_under_gravity_at_every_listed_mesh() {
    let worst = Worst::new();
    for (n, x, y) in [
        (4, -0.49856239125, -1.22717954978),
        (8, -0.50208361507, -1.23254150237),
        (16, -0.50221723460, -1.23275426334),
        (32, -0.50222214997, -1.23276224648),
    ] {
        let text = statics(10) + &beam(2.0, 1e6, 2500.0 / 3.0, 78.0, n) + CLAMP;
        let run = run(&text, &["simulation.gravity=[0.0, -9.81]".into()]);
        compare(&worst, displacement(&run, 2.0), [x, y]);
    }
    Rung::Computed
        .asks("Cantilever under its weight, F2, n = 4 ... 32: tip displacement against the listed digits, relative error")
        .within(&worst, DIGITS, DIGITS_REASON);
}

/// E: the inextensible elastica. F2 differs from it by a few EI/(EA L^2), the square of the slenderness.
#[test]
fn elastica_in_the_thin_limit() {
    let slenderness = 1e-6;
    let worst = Worst::new();
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
        worst.see((x + shortening).hypot(y + deflection) / (load.max(5.0) * slenderness));
    }
    Rung::ClosedForms
        .asks("Inextensible elastica, P L²/EI = 0.25 ... 10: distance of a thin cantilever's tip from it, over max(5, P L²/EI) EI/(EA L)")
        .within(&worst,
            1.0,
            "F2 differs from it by a few EI/(EA L²), and the load stretches the beam by P/EA = (P L²/EI) EI/(EA L²)",
        );
}

/// P: a dead force -P and a moment 2.5 P at the tip, L = 2 pi, EI = 2 (Harsch, Capobianco and Eugster 2021), inextensible.
#[test]
fn elastica_under_force_and_moment() {
    let (length, bending, slenderness) = (TAU, 2.0, 1e-6);
    let axial = bending / (slenderness * length * length);
    let worst = Worst::new();
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
        worst.see(error / (slenderness * length));
    }
    Rung::Published
        .asks("Inextensible elastica under a dead force and a moment, three loads: distance of a thin cantilever's tip from it, over EI/(EA L)")
        .from(CARDILLO).within(&worst,
            10.0,
            "F2 differs from it by a few EI/(EA L²); the moment's curvature of 2.5 P/EI is among the loads",
        );
}

/// E, P: Princeton beam in its two planes (Obrezkov et al. 2022 list ANSYS beams). The inextensible elastica has neither
/// shear, which the strong plane of ANSYS has to 5e-4, nor stretch.
#[test]
fn princeton_beam_in_both_planes() {
    let (modulus, h, w, length) = (71.7e9, 12.3777e-3, 3.2024e-3, 0.508);
    let (from_elastica, from_ansys) = (Worst::new(), Worst::new());
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
        from_elastica.see((y + elastica) * axial * length / bending);
        from_ansys.see((y + ansys) / ansys);
    }
    Rung::ClosedForms
        .asks("Princeton beam in both planes: deflection against the inextensible elastica, over EI/(EA L)")
        .within(&from_elastica, 5.0, "F2 stretches by a few EI/(EA L²)");
    Rung::Published
        .asks("Princeton beam in both planes: deflection against ANSYS beams, relative error")
        .from(OBREZKOV)
        .within(
            &from_ansys,
            6e-4,
            "the ANSYS beams shear: 5e-4 of the deflection in the strong plane",
        );
}

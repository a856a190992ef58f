//! Roll-up by an end moment, in the closed form of this element's functional (E).

use super::{CLAMP, beam, last, run, statics};
use ladder::{Rung, Worst};
use std::f64::consts::TAU;

const AXIAL: f64 = 1e4;
const BENDING: f64 = 1.0;

/// lambda^2 = 1 - 2 EI/EA kappa^2 and M = EI kappa lambda^2 for the curvature kappa of one full turn.
fn closing() -> (f64, f64) {
    let stretch_squared = 1.0 - 2.0 * BENDING / AXIAL * TAU * TAU;
    (stretch_squared.sqrt(), BENDING * TAU * stretch_squared)
}

fn tip(elements: usize, moment: f64) -> [f64; 2] {
    let torque =
        format!("[forces.tip]\ntype = \"torque\"\npoint = \"beam.end\"\nvalue = {moment:?}\n");
    let text = statics(40) + &beam(1.0, AXIAL, BENDING, 1.0, elements) + CLAMP + &torque;
    let run = run(&text, &[]);
    [
        last(&run, "points.beam.end.x"),
        last(&run, "points.beam.end.y"),
    ]
}

/// I: distances of the tip from the clamp at the closing moment; order 4 in the number of elements.
#[test]
fn the_circle_closes_at_order_four() {
    let (stretch, moment) = closing();
    assert!((stretch - 0.996044334595).abs() < 1e-12);
    assert!((moment / TAU - 0.992104316479).abs() < 1e-12);
    let distance = |n| {
        let [x, y] = tip(n, moment);
        x.hypot(y)
    };
    let worst = Worst::new();
    let mut errors = Vec::new();
    for (n, listed) in [
        (4, 2.84e-2),
        (8, 1.58e-3),
        (16, 9.91e-5),
        (32, 6.24e-6),
        (64, 3.91e-7),
    ] {
        let d = distance(n);
        worst.see(d / listed - 1.0);
        errors.push((1.0 / n as f64, d));
    }
    Rung::Computed
        .asks("Roll-up to a full circle, n = 4 ... 64: distance of the tip from the clamp against the listed digits, relative error")
        .within(&worst, 6e-3, "three digits are listed");
    Rung::OrderInElements
        .asks("Roll-up to a full circle, n = 8 ... 64: distance of the tip from the clamp [m]")
        .falls("Element length l/L", &errors[1..], 3.8..4.2, "order 4");
}

/// At 2 pi EI/L, where the inextensible beam closes, this functional must not.
#[test]
fn the_moment_of_the_inextensible_beam_does_not_close_it() {
    let [x, y] = tip(64, TAU * BENDING);
    Rung::ClosedForms
        .asks("Roll-up by the moment that closes the inextensible beam: distance between tip and clamp over L")
        .between(
            x.hypot(y),
            0.007..0.009,
            "κL - 2π is 2π times 8π² EI/(EA L²) = 0.0496 to first order, on a radius of L/2π",
        );
}

/// E: stretch, curvature and energy along the whole way, x = lambda/kappa sin(kappa L).
#[test]
fn the_load_path_follows_the_closed_form() {
    let worst = Worst::new();
    for turn in [0.1, 0.25, 0.5, 0.8] {
        let kappa = TAU * turn;
        let square = 1.0 - 2.0 * BENDING / AXIAL * kappa * kappa;
        let [x, y] = tip(64, BENDING * kappa * square);
        let radius = square.sqrt() / kappa;
        let (ex, ey) = (radius * kappa.sin(), radius * (1.0 - kappa.cos()));
        worst.see((x - ex).hypot(y - ey));
    }
    Rung::ClosedForms
        .asks("Roll-up by 0.1 ... 0.8 of a turn, n = 64: distance of the tip from the closed form over L")
        .within(&worst, 4e-7, "the listed distance at a full turn, which bends the elements more, is 3.91e-7 L");
}

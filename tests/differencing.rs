//! Compares hand-written derivatives with central differences, in a way that can fail.

use ladder::Rung;

/// Largest difference between `tangent` (rows of n) and the central difference of `force` at `x` with step `h`.
fn error(force: &dyn Fn(&[f64]) -> Vec<f64>, tangent: &[Vec<f64>], x: &[f64], h: f64) -> f64 {
    let mut worst = 0.0_f64;
    for j in 0..x.len() {
        let moved = |by: f64| {
            let mut y = x.to_vec();
            y[j] += by;
            force(&y)
        };
        let (low, high) = (moved(-h), moved(h));
        for i in 0..low.len() {
            worst = worst.max(((high[i] - low[i]) / (2.0 * h) - tangent[i][j]).abs());
        }
    }
    worst
}

/// Asserts that `tangent` is the Jacobian of `force` at `x`: the central difference tends to it as h^2 (bounded on both
/// sides) until rounding, and the two are neither zero nor equal to the last bit.
///
/// For a force that is at most quadratic in each coordinate the central difference has no truncation error; pass
/// `exact`, and only rounding is allowed.
pub fn check(
    name: &str,
    force: &dyn Fn(&[f64]) -> Vec<f64>,
    tangent: &[Vec<f64>],
    x: &[f64],
    h: f64,
    exact: bool,
) {
    let size = tangent
        .iter()
        .flatten()
        .fold(0.0_f64, |m, k| m.max(k.abs()));
    assert!(size > 0.0, "{name}: the tangent is zero");
    let (coarse, fine) = (
        error(force, tangent, x, h),
        error(force, tangent, x, h / 4.0),
    );
    if exact {
        Rung::Derivatives
            .asks(format!(
                "Is the tangent of {name} its derivative? Relative error"
            ))
            .within(
                fine / size,
                1e-7,
                "quadratic at most: rounding of the force over the span of the difference",
            );
        return;
    }
    let errors = [(h, coarse / size), (h / 4.0, fine / size)];
    Rung::Derivatives
        .asks(format!("Is the tangent of {name} its derivative?"))
        .falls(
            "Span of the difference",
            &errors,
            1.8..2.2,
            "the error of a central difference",
        );
    assert!(fine < 1e-3 * size, "{name}: {fine:e} of {size:e}");
}

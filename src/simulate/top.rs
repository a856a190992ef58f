//! The maximum of a cubic given by its values and slopes at both ends.

/// Place and value of the maximum on \[0, h\] of the cubic with end values y and slopes v; `None` without a maximum inside.
/// Between two steps a smooth quantity differs from this cubic by h^4.
pub(super) fn top(h: f64, [y0, y1]: [f64; 2], [v0, v1]: [f64; 2]) -> Option<(f64, f64)> {
    if !(v0 > 0.0 && v1 < 0.0) {
        return None;
    }
    // y = y0 + v0 t + c t^2 + d t^3; the slope falls through zero once
    let c = (3.0 * (y1 - y0) / h - 2.0 * v0 - v1) / h;
    let d = (v0 + v1 - 2.0 * (y1 - y0) / h) / (h * h);
    let root = (c * c - 3.0 * d * v0).max(0.0).sqrt();
    // the root that stays finite as d vanishes, where c < 0
    let t = v0 / (root - c);
    Some((t, y0 + t * (v0 + t * (c + t * d))))
}

#[cfg(test)]
mod tests {
    use super::top;

    #[test]
    fn the_top_of_a_cubic_is_found() {
        // y = t (1 - t) (2 - t)/2 on [0.2, 0.9]: top at 1 - 1/sqrt 3, height 1/(3 sqrt 3)
        let y = |t: f64| 0.5 * t * (1.0 - t) * (2.0 - t);
        let v = |t: f64| 0.5 * (2.0 - 6.0 * t + 3.0 * t * t);
        let (t, found) = top(0.7, [y(0.2), y(0.9)], [v(0.2), v(0.9)]).unwrap();
        assert!((found - 1.0 / 27f64.sqrt()).abs() < 1e-15);
        assert!((0.2 + t - (1.0 - 1.0 / 3f64.sqrt())).abs() < 1e-14);
        assert_eq!(top(0.1, [0.0, 0.1], [1.0, 1.0]), None);
    }
}

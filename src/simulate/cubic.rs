//! The cubic given by its values and slopes at both ends of a step: its maximum, and where it passes zero. Between two steps a
//! smooth quantity differs from it by h^4.

/// Iterations for a zero; bisection alone needs 52.
const MOST_ITERATIONS: usize = 60;

/// c and d of y = y_0 + v_0 t + c t^2 + d t^3.
fn coefficients(h: f64, [y0, y1]: [f64; 2], [v0, v1]: [f64; 2]) -> [f64; 2] {
    let slope = (y1 - y0) / h;
    [
        (3.0 * slope - 2.0 * v0 - v1) / h,
        (v0 + v1 - 2.0 * slope) / (h * h),
    ]
}

/// A zero on \[0, h\] of the cubic with end values y and slopes v; `None` unless it rises from below zero to above.
pub(super) fn crossing(h: f64, y: [f64; 2], v: [f64; 2]) -> Option<f64> {
    if !(y[0] < 0.0 && y[1] > 0.0) {
        return None;
    }
    let [c, d] = coefficients(h, y, v);
    let (mut low, mut high) = (0.0, h);
    let mut t = h * y[0] / (y[0] - y[1]);
    for _ in 0..MOST_ITERATIONS {
        let value = y[0] + t * (v[0] + t * (c + t * d));
        match value > 0.0 {
            true => high = t,
            false => low = t,
        }
        let newton = t - value / (v[0] + t * (2.0 * c + 3.0 * t * d));
        let next = match newton > low && newton < high {
            true => newton,
            false => 0.5 * (low + high),
        };
        if (next - t).abs() <= f64::EPSILON * h {
            break;
        }
        t = next;
    }
    Some(t)
}

/// Place and value of the maximum on \[0, h\] of the cubic with end values y and slopes v; `None` without a maximum inside.
pub(super) fn top(h: f64, [y0, y1]: [f64; 2], [v0, v1]: [f64; 2]) -> Option<(f64, f64)> {
    if !(v0 > 0.0 && v1 < 0.0) {
        return None;
    }
    // the slope falls through zero once
    let [c, d] = coefficients(h, [y0, y1], [v0, v1]);
    let root = (c * c - 3.0 * d * v0).max(0.0).sqrt();
    // the root that stays finite as d vanishes, where c < 0
    let t = v0 / (root - c);
    Some((t, y0 + t * (v0 + t * (c + t * d))))
}

#[cfg(test)]
mod tests {
    use super::{crossing, top};

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

    #[test]
    fn the_zero_of_a_cubic_is_found() {
        // y = t (t - 1) (t - 2)/2 - 0.1 rises through zero once on [0, 0.4]
        let y = |t: f64| 0.5 * t * (t - 1.0) * (t - 2.0) - 0.1;
        let v = |t: f64| 0.5 * (2.0 - 6.0 * t + 3.0 * t * t);
        let zero = crossing(0.4, [y(0.0), y(0.4)], [v(0.0), v(0.4)]).unwrap();
        // rounding of terms of the order of one, over a slope of the order of one
        assert!(y(zero).abs() < 1e-15, "{zero}");
        assert_eq!(crossing(0.1, [0.1, 0.2], [1.0, 1.0]), None);
        assert_eq!(crossing(0.1, [-0.2, -0.1], [1.0, 1.0]), None);
    }
}

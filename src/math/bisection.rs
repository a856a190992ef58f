//! Bisection down to neighbouring numbers.

/// Where a condition that holds at `from` and not at `to` ends, to rounding.
pub fn bisected(mut from: f64, mut to: f64, mut holds: impl FnMut(f64) -> bool) -> f64 {
    loop {
        let middle = 0.5 * (from + to);
        if middle == from || middle == to {
            return to;
        }
        match holds(middle) {
            true => from = middle,
            false => to = middle,
        }
    }
}

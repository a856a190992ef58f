//! Knots: instants at which a function of time or one of its derivatives jumps.

/// A knot of a function.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Knot {
    /// The last time \[s\] that belongs to the function before the knot, and the first one after it, which may be the same.
    pub sides: [f64; 2],
    /// What jumps: 0 the value, otherwise the order of the lowest derivative that does.
    pub level: usize,
}

impl Knot {
    /// At time t, which belongs to what follows where the value or a derivative that is evaluated jumps.
    pub fn at(t: f64, level: usize) -> Knot {
        Knot {
            sides: [t.next_down(), t],
            level,
        }
    }
}

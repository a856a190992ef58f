//! Cuts polylines at the frame of a panel.

use crate::decimate::PixelPoint;

/// A rectangle in pixels, `low` and `high` corners inclusive.
#[derive(Clone, Copy)]
pub struct ClipRectangle {
    /// Least x and y.
    pub low: PixelPoint,
    /// Greatest x and y.
    pub high: PixelPoint,
}

impl ClipRectangle {
    /// Whether the point lies inside.
    pub fn contains(&self, (x, y): PixelPoint) -> bool {
        (self.low.0..=self.high.0).contains(&x) && (self.low.1..=self.high.1).contains(&y)
    }

    /// The parts of a polyline inside the frame; a point that is not finite ends a part.
    pub fn clip(&self, points: &[PixelPoint]) -> Vec<Vec<PixelPoint>> {
        let mut parts: Vec<Vec<PixelPoint>> = Vec::new();
        let mut open = false;
        for pair in points.windows(2) {
            let Some((a, b)) = self.segment(pair[0], pair[1]) else {
                open = false;
                continue;
            };
            match parts.last_mut() {
                Some(part) if open => part.push(b),
                _ => parts.push(vec![a, b]),
            }
            open = b == pair[1];
        }
        parts
    }

    /// Liang & Barsky (1984): the part of a segment inside the frame.
    fn segment(&self, a: PixelPoint, b: PixelPoint) -> Option<(PixelPoint, PixelPoint)> {
        if ![a.0, a.1, b.0, b.1].iter().all(|v| v.is_finite()) {
            return None;
        }
        if self.contains(a) && self.contains(b) {
            return Some((a, b));
        }
        let (dx, dy) = (b.0 - a.0, b.1 - a.1);
        let (mut enter, mut leave) = (0.0_f64, 1.0_f64);
        let edges = [
            (-dx, a.0 - self.low.0),
            (dx, self.high.0 - a.0),
            (-dy, a.1 - self.low.1),
            (dy, self.high.1 - a.1),
        ];
        for (p, q) in edges {
            if p == 0.0 {
                if q < 0.0 {
                    return None;
                }
            } else if p < 0.0 {
                enter = enter.max(q / p);
            } else {
                leave = leave.min(q / p);
            }
        }
        let at = |u: f64| {
            if u == 1.0 {
                b
            } else {
                (a.0 + u * dx, a.1 + u * dy)
            }
        };
        (enter <= leave).then(|| (at(enter), at(leave)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const FRAME: ClipRectangle = ClipRectangle {
        low: (0.0, 0.0),
        high: (10.0, 10.0),
    };

    #[test]
    fn a_curve_that_leaves_and_returns_is_cut_in_two() {
        let parts = FRAME.clip(&[(1.0, 5.0), (4.0, 20.0), (8.0, 5.0), (9.0, 5.0)]);
        assert_eq!(parts.len(), 2);
        assert!(parts.iter().flatten().all(|&p| FRAME.contains(p)));
        assert_eq!(parts[1].last(), Some(&(9.0, 5.0)));
    }

    #[test]
    fn points_that_are_not_numbers_open_a_gap() {
        let parts = FRAME.clip(&[
            (1.0, 1.0),
            (2.0, 2.0),
            (3.0, f64::NAN),
            (4.0, 4.0),
            (5.0, 5.0),
        ]);
        assert_eq!(parts.len(), 2);
    }
}

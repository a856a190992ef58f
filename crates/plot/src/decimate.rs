//! Thins polylines to what the pixels can show. Points are in pixels, x to the right.

/// A point in pixels.
pub type PixelPoint = (f64, f64);

/// How far a thinned polyline may be from the full one: 0.1 pixels of a screen with 96 dots an inch, in units of the drawing.
const TOLERANCE: f64 = 0.1 * 300.0 / 96.0;

/// Indices of the points of a series whose x never decreases: of every pixel column the first, lowest, highest and last point,
/// in their order, but for those on the chord of their neighbours. No extreme value of a column is lost.
pub fn envelope(points: &[PixelPoint]) -> Vec<usize> {
    let mut kept = Vec::new();
    let mut first = 0;
    let is_one =
        |a: &PixelPoint, b: &PixelPoint| a.0.floor() == b.0.floor() && is_drawn(a) == is_drawn(b);
    for column in points.chunk_by(is_one) {
        let by = |a: &usize, b: &usize| column[*a].1.total_cmp(&column[*b].1);
        let low = (0..column.len()).min_by(by).unwrap_or(0);
        let high = (0..column.len()).max_by(by).unwrap_or(0);
        let mut order = vec![0, low, high, column.len() - 1];
        order.sort_unstable();
        order.dedup();
        kept.extend(order.into_iter().map(|i| first + i));
        first += column.len();
    }
    chords(points, kept, TOLERANCE)
}

/// Indices of at most `budget` points of a curve: those on the chord of their neighbours are dropped; the tolerance is doubled
/// until the budget is met.
pub fn portrait(points: &[PixelPoint], budget: usize) -> Vec<usize> {
    let mut tolerance = TOLERANCE;
    let mut kept = chords(points, (0..points.len()).collect(), tolerance);
    while kept.len() > budget {
        tolerance *= 2.0;
        kept = chords(points, kept, tolerance);
    }
    kept
}

/// False of a point without a place, such as zero on a logarithmic axis.
fn is_drawn(point: &PixelPoint) -> bool {
    point.0.is_finite() && point.1.is_finite()
}

/// Indices of the points that are not on the chord of their neighbours. Points that are not drawn interrupt the line: of each
/// interruption the first is kept.
fn chords(points: &[PixelPoint], indices: Vec<usize>, tolerance: f64) -> Vec<usize> {
    let drawn = |i: &usize| is_drawn(&points[*i]);
    let runs = indices.chunk_by(|a, b| drawn(a) == drawn(b));
    let kept = runs.map(|run| match drawn(&run[0]) {
        true => simplified(points, run, tolerance),
        false => vec![run[0]],
    });
    kept.flatten().collect()
}

/// Douglas & Peucker (1973) on the points with these indices, in pieces of a thousand, which bounds its cost.
fn simplified(points: &[PixelPoint], indices: &[usize], tolerance: f64) -> Vec<usize> {
    const PIECE: usize = 1000;
    let last = indices.len().saturating_sub(1);
    let mut keep = vec![indices.len() == 1; indices.len()];
    let mut open: Vec<(usize, usize)> = (0..last)
        .step_by(PIECE)
        .map(|a| (a, (a + PIECE).min(last)))
        .collect();
    while let Some((a, b)) = open.pop() {
        keep[a] = true;
        keep[b] = true;
        let [from, to] = [a, b].map(|i| points[indices[i]]);
        let farthest = (a + 1..b)
            .map(|i| (i, chord_distance(points[indices[i]], from, to)))
            .max_by(|x, y| x.1.total_cmp(&y.1));
        if let Some((i, distance)) = farthest
            && distance > tolerance
        {
            open.extend([(a, i), (i, b)]);
        }
    }
    let kept = indices.iter().zip(keep).filter(|(_, keep)| *keep);
    kept.map(|(index, _)| *index).collect()
}

/// Distance of a point from the segment a-b.
fn chord_distance(p: PixelPoint, a: PixelPoint, b: PixelPoint) -> f64 {
    let (dx, dy) = (b.0 - a.0, b.1 - a.1);
    let square = dx * dx + dy * dy;
    let u = if square > 0.0 {
        (((p.0 - a.0) * dx + (p.1 - a.1) * dy) / square).clamp(0.0, 1.0)
    } else {
        0.0
    };
    (p.0 - a.0 - u * dx).hypot(p.1 - a.1 - u * dy)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The points with these indices.
    fn at(points: &[PixelPoint], indices: &[usize]) -> Vec<PixelPoint> {
        indices.iter().map(|i| points[*i]).collect()
    }

    /// The largest distance of a point from the polyline through the points with these indices.
    fn distance(points: &[PixelPoint], indices: &[usize]) -> f64 {
        let mut largest = 0.0_f64;
        for pair in indices.windows(2) {
            for p in &points[pair[0]..=pair[1]] {
                largest = largest.max(chord_distance(*p, points[pair[0]], points[pair[1]]));
            }
        }
        largest
    }

    #[test]
    fn envelope_is_short_and_keeps_every_peak() {
        let mut points: Vec<PixelPoint> = (0..300_000)
            .map(|i| (f64::from(i) * 0.002, f64::from(i).sin()))
            .collect();
        points[123_456].1 = 40.0;
        points[7].1 = -40.0;
        let kept = envelope(&points);
        assert!(kept.len() <= 4 * 601);
        assert!(kept.contains(&123_456) && kept.contains(&7));
        assert_eq!((kept[0], kept[kept.len() - 1]), (0, points.len() - 1));
        assert!(kept.is_sorted());
    }

    #[test]
    fn points_without_a_place_interrupt_a_line_and_hide_nothing() {
        // a difference that is zero every third row, on a logarithmic axis
        let points: Vec<PixelPoint> = (0..300)
            .map(|i| {
                let y = 100.0 + 40.0 * f64::from(i).sin();
                let y = if i % 3 == 0 { f64::INFINITY } else { y };
                (0.5 * f64::from(i), y)
            })
            .collect();
        for kept in [envelope(&points), portrait(&points, 1000)] {
            let drawn = |i: &&usize| points[**i].1.is_finite();
            let highest = |indices: &[usize]| {
                let heights = indices.iter().filter(drawn).map(|i| points[*i].1);
                heights.fold(0.0, f64::max)
            };
            let all: Vec<usize> = (0..points.len()).collect();
            assert_eq!(highest(&kept), highest(&all));
            assert!(kept.iter().filter(drawn).count() >= 100);
            assert!(kept.iter().any(|i| !points[*i].1.is_finite()));
        }
    }

    #[test]
    fn thinned_lines_stay_within_a_tenth_of_a_pixel() {
        let circle: Vec<PixelPoint> = (0..10_000)
            .map(|i| f64::from(i) * 1e-3)
            .map(|a| (50.0 * a.cos(), 50.0 * a.sin()))
            .collect();
        let kept = portrait(&circle, usize::MAX);
        // an arc of 50 units is within t of its chord up to an angle of sqrt(8 t / 50)
        assert!((44..200).contains(&kept.len()), "{}", kept.len());
        assert!(distance(&circle, &kept) <= TOLERANCE);
        let line: Vec<PixelPoint> = (0..5000).map(|i| (0.7 * f64::from(i), 3.0)).collect();
        assert!(envelope(&line).len() <= 12);
        let wave = line.iter().map(|(x, _)| (*x, 40.0 * (0.01 * x).sin()));
        let wave: Vec<PixelPoint> = wave.collect();
        let kept = envelope(&wave);
        assert!(kept.len() < 700 && distance(&wave, &kept) <= TOLERANCE);
    }

    #[test]
    fn few_points_stay() {
        for count in 0..3 {
            let points: Vec<PixelPoint> = (0..count).map(|i| (f64::from(i), 0.0)).collect();
            let all: Vec<usize> = (0..points.len()).collect();
            assert_eq!(envelope(&points), all);
            assert_eq!(portrait(&points, 9), all);
        }
    }

    #[test]
    fn a_dense_portrait_meets_its_budget_and_keeps_its_outline() {
        let points: Vec<PixelPoint> = (0..100_000)
            .map(f64::from)
            .map(|i| {
                (
                    300.0 + 250.0 * (i * 6e-5).cos(),
                    300.0 + 200.0 * (i * 0.05).sin(),
                )
            })
            .collect();
        let kept = at(&points, &portrait(&points, 20_000));
        assert!(kept.len() <= 20_000);
        let top = |p: &[PixelPoint]| p.iter().map(|p| p.1).fold(f64::MIN, f64::max);
        assert!((top(&kept) - top(&points)).abs() <= 1.0);
    }
}

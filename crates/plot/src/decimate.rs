//! Thins polylines to what the pixels can show. Points are in pixels, x to the right.

/// A point in pixels.
pub type PixelPoint = (f64, f64);

/// The envelope of a series whose x never decreases: of every pixel column the first, lowest, highest and last point,
/// in their order. No extreme value is lost and at most four points a column remain.
pub fn envelope(points: &[PixelPoint]) -> Vec<PixelPoint> {
    let mut kept = Vec::new();
    for column in points.chunk_by(|a, b| a.0.floor() == b.0.floor()) {
        let by = |a: &usize, b: &usize| column[*a].1.total_cmp(&column[*b].1);
        let low = (0..column.len()).min_by(by).unwrap_or(0);
        let high = (0..column.len()).max_by(by).unwrap_or(0);
        let mut order = vec![0, low, high, column.len() - 1];
        order.sort_unstable();
        order.dedup();
        kept.extend(order.into_iter().map(|i| column[i]));
    }
    kept
}

/// A curve of at most `budget` points: points closer than a quarter pixel to the last one kept are dropped, then those
/// that lie within half a pixel of the chord of their neighbours; the tolerance is doubled until the budget is met.
pub fn portrait(points: &[PixelPoint], budget: usize) -> Vec<PixelPoint> {
    let mut kept: Vec<PixelPoint> = Vec::new();
    for (i, &(x, y)) in points.iter().enumerate() {
        let far = kept
            .last()
            .is_none_or(|&(kx, ky)| (x - kx).hypot(y - ky) >= 0.25);
        if far || i + 1 == points.len() {
            kept.push((x, y));
        }
    }
    let mut tolerance = 0.5;
    while kept.len() > budget {
        kept = chords(&kept, tolerance);
        tolerance *= 2.0;
    }
    kept
}

/// Douglas & Peucker (1973) on pieces of a thousand points, which bounds its cost.
fn chords(points: &[PixelPoint], tolerance: f64) -> Vec<PixelPoint> {
    const PIECE: usize = 1000;
    let mut keep = vec![false; points.len()];
    let mut open: Vec<(usize, usize)> = (0..points.len() - 1)
        .step_by(PIECE)
        .map(|a| (a, (a + PIECE).min(points.len() - 1)))
        .collect();
    while let Some((a, b)) = open.pop() {
        keep[a] = true;
        keep[b] = true;
        let farthest = (a + 1..b)
            .map(|i| (i, chord_distance(points[i], points[a], points[b])))
            .max_by(|x, y| x.1.total_cmp(&y.1));
        if let Some((i, distance)) = farthest
            && distance > tolerance
        {
            open.extend([(a, i), (i, b)]);
        }
    }
    let kept = points.iter().zip(keep).filter(|(_, keep)| *keep);
    kept.map(|(point, _)| *point).collect()
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

    #[test]
    fn envelope_is_short_and_keeps_every_peak() {
        let mut points: Vec<PixelPoint> = (0..300_000)
            .map(|i| (f64::from(i) * 0.002, f64::from(i).sin()))
            .collect();
        points[123_456].1 = 40.0;
        points[7].1 = -40.0;
        let kept = envelope(&points);
        assert!(kept.len() <= 4 * 601);
        assert!(kept.contains(&points[123_456]) && kept.contains(&points[7]));
        assert_eq!(kept.first(), points.first());
        assert_eq!(kept.last(), points.last());
        assert!(kept.windows(2).all(|w| w[0].0 <= w[1].0));
    }

    #[test]
    fn portrait_stays_within_a_quarter_pixel() {
        let points: Vec<PixelPoint> = (0..10_000)
            .map(|i| f64::from(i) * 1e-3)
            .map(|a| (50.0 * a.cos(), 50.0 * a.sin()))
            .collect();
        let kept = portrait(&points, usize::MAX);
        assert!(kept.len() < 2100);
        for p in &points {
            let nearest = kept
                .iter()
                .map(|k| (k.0 - p.0).hypot(k.1 - p.1))
                .fold(f64::MAX, f64::min);
            assert!(nearest <= 0.25);
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
        let kept = portrait(&points, 20_000);
        assert!(kept.len() <= 20_000);
        let top = |p: &[PixelPoint]| p.iter().map(|p| p.1).fold(f64::MIN, f64::max);
        assert!((top(&kept) - top(&points)).abs() <= 1.0);
    }
}

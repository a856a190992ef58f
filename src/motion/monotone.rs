//! An interpolant of a table that keeps flats flat and never overshoots: quintic pieces, twice continuously differentiable.
//!
//! Between neighbouring rows the polynomial of degree 5 has the values y, slopes d and second derivatives s of both rows. Over an
//! interval of length h its control points (Bernstein form) are
//!
//! ```text
//! y_0,  y_0 + h d_0/5,  y_0 + 2 h d_0/5 + h^2 s_0/20,  y_1 - 2 h d_1/5 + h^2 s_1/20,  y_1 - h d_1/5,  y_1
//! ```
//!
//! and it is monotone where they are: the derivative is a combination of their differences with weights that are not negative
//! (Farin 2002, Curves and Surfaces for CAGD, chapter 5). Half of the difference of the two in the middle is left to either row, so
//! that this is a condition on each row alone. With the secant slope S = (y_1 - y_0)/h >= 0 it reads
//!
//! ```text
//! d >= 0,   of the interval after the row:   -4 d/h <= s <= (10 S - 8 d)/h
//!           of the interval before the row:  -(10 S - 8 d)/h <= s <= 4 d/h
//! ```
//!
//! Some s fulfils both if d <= 5/2 S in either interval and d <= 5/4 p, where p is the slope of the parabola through the row and its
//! neighbours. So d and s are those of a polynomial through up to five rows, first d and then s brought within its bounds, as Dougherty,
//! Edelman and Hyman do with bounds of their own (1989, Math. Comp. 52, 471-494). EQUATIONS.md has the recipe.

use super::table::poses_between;
use super::{Knot, Path, Pose};

/// Rows of the polynomial that a slope and a second derivative come from: the error of the interpolant is of order 5.
const STENCIL: usize = 5;

/// Monotone between neighbouring rows, constant where they are equal, twice continuously differentiable.
#[derive(Debug, Clone)]
pub struct MonotoneQuintic<const N: usize> {
    times: Vec<f64>,
    values: Vec<[f64; N]>,
    /// Of each interval: coefficients of the powers of u = (t - t_0)/h.
    pieces: Vec<[[f64; 6]; N]>,
}

impl<const N: usize> MonotoneQuintic<N> {
    /// Its rows, at which its third derivative jumps.
    pub(super) fn rows(&self) -> Vec<Knot> {
        self.times.iter().map(|&t| Knot::at(t, 3)).collect()
    }

    /// An interpolant of values at increasing times, two at least.
    pub fn new(rows: impl Iterator<Item = (f64, [f64; N])>) -> MonotoneQuintic<N> {
        let (times, values): (Vec<f64>, Vec<[f64; N]>) = rows.unzip();
        let mut pieces = vec![[[0.0; 6]; N]; times.len() - 1];
        for i in 0..N {
            let column: Vec<f64> = values.iter().map(|row| row[i]).collect();
            let derivatives = derivatives_at_rows(&times, &column);
            for (k, piece) in pieces.iter_mut().enumerate() {
                let h = times[k + 1] - times[k];
                let end = |k: usize| [column[k], derivatives[k][0], derivatives[k][1]];
                piece[i] = quintic(h, end(k), end(k + 1));
            }
        }
        MonotoneQuintic {
            times,
            values,
            pieces,
        }
    }

    /// The values of its rows.
    pub(crate) fn values(&self) -> &[[f64; N]] {
        &self.values
    }

    /// Values, first and second derivatives at time t.
    pub fn derivatives(&self, t: f64) -> [[f64; N]; 3] {
        let after = self.times.partition_point(|&x| x <= t);
        let k = after.clamp(1, self.times.len() - 1) - 1;
        let h = self.times[k + 1] - self.times[k];
        let u = (t - self.times[k]) / h;
        let mut result = [[0.0; N]; 3];
        for (i, c) in self.pieces[k].iter().enumerate() {
            result[0][i] = c[0] + u * (c[1] + u * (c[2] + u * (c[3] + u * (c[4] + u * c[5]))));
            result[1][i] = (c[1]
                + u * (2.0 * c[2] + u * (3.0 * c[3] + u * (4.0 * c[4] + u * 5.0 * c[5]))))
                / h;
            result[2][i] =
                (2.0 * c[2] + u * (6.0 * c[3] + u * (12.0 * c[4] + u * 20.0 * c[5]))) / (h * h);
        }
        result
    }
}

/// Coefficients of the powers of u of the polynomial of degree 5 with a value, slope and second derivative at either end.
fn quintic(h: f64, [y_0, d_0, s_0]: [f64; 3], [y_1, d_1, s_1]: [f64; 3]) -> [f64; 6] {
    let (d_0, s_0, d_1, s_1) = (h * d_0, h * h * s_0, h * d_1, h * h * s_1);
    // what the parabola of the first end leaves for the second: value, slope and second derivative
    let value = (y_1 - y_0) - d_0 - 0.5 * s_0;
    let slope = d_1 - d_0 - s_0;
    let second = s_1 - s_0;
    [
        y_0,
        d_0,
        0.5 * s_0,
        10.0 * value - 4.0 * slope + 0.5 * second,
        -15.0 * value + 7.0 * slope - second,
        6.0 * value - 3.0 * slope + 0.5 * second,
    ]
}

/// Slope and second derivative at every row.
fn derivatives_at_rows(times: &[f64], values: &[f64]) -> Vec<[f64; 2]> {
    let secants = times.windows(2).zip(values.windows(2));
    let secants: Vec<f64> = secants
        .map(|(t, y)| (y[1] - y[0]) / (t[1] - t[0]))
        .collect();
    let rows = 0..times.len();
    rows.map(|k| match turn(times, &secants, k) {
        Some(second) => [0.0, second],
        None => within_a_rise(times, values, &secants, k),
    })
    .collect()
}

/// The second derivative at a row where the values turn or a flat begins, ends or goes on; none at other rows. There the slope
/// is zero.
fn turn(times: &[f64], secants: &[f64], k: usize) -> Option<f64> {
    let before = k.checked_sub(1).map(|k| secants[k]);
    let after = secants.get(k).copied();
    let (Some(before), Some(after)) = (before, after) else {
        let flat = before.or(after) == Some(0.0);
        return flat.then_some(0.0);
    };
    if before * after > 0.0 {
        return None;
    }
    let (h_0, h_1) = (times[k] - times[k - 1], times[k + 1] - times[k]);
    let parabola = 2.0 * (after - before) / (h_0 + h_1);
    let bound = 10.0 * f64::min(before.abs() / h_0, after.abs() / h_1);
    Some(parabola.clamp(-bound, bound))
}

/// Slope and second derivative at a row on whose sides the values rise, or fall; at the first and the last row on its one side.
fn within_a_rise(times: &[f64], values: &[f64], secants: &[f64], k: usize) -> [f64; 2] {
    let last = times.len() - 1;
    let sign = secants[k.min(last - 1)].signum();
    let rises = |interval: usize| secants[interval] * sign > 0.0;
    let mut from = k;
    while from > 0 && rises(from - 1) {
        from -= 1;
    }
    let mut to = k;
    while to < last && rises(to) {
        to += 1;
    }
    let centred = k.saturating_sub(STENCIL / 2);
    let first = centred.min((to + 1).saturating_sub(STENCIL)).max(from);
    let stencil = first..=to.min(first + STENCIL - 1);
    let [slope, second] = polynomial(&times[stencil.clone()], &values[stencil], times[k]);

    let step = |interval: usize| times[interval + 1] - times[interval];
    let (before, after) = (k.checked_sub(1), (k < last).then_some(k));
    let mut steepest = f64::INFINITY;
    for interval in [before, after].into_iter().flatten() {
        steepest = steepest.min(2.5 * secants[interval] * sign);
    }
    if let (Some(a), Some(b)) = (before, after) {
        let parabola = (secants[a] * step(b) + secants[b] * step(a)) / (step(a) + step(b));
        steepest = steepest.min(1.25 * parabola * sign);
    }
    let d = (slope * sign).clamp(0.0, steepest);
    let mut s = second * sign;
    let bounds = |interval: usize| {
        let (h, secant) = (step(interval), secants[interval] * sign);
        (4.0 * d / h, (10.0 * secant - 8.0 * d) / h)
    };
    if let Some((most, least)) = before.map(bounds) {
        s = s.min(most).max(-least);
    }
    if let Some((least, most)) = after.map(bounds) {
        s = s.max(-least).min(most);
    }
    [d * sign, s * sign]
}

/// Slope and second derivative at time t of the polynomial through rows, by Newton's divided differences.
fn polynomial(times: &[f64], values: &[f64], t: f64) -> [f64; 2] {
    let n = times.len();
    let mut differences = values.to_vec();
    for order in 1..n {
        for k in (order..n).rev() {
            let rise = differences[k] - differences[k - 1];
            differences[k] = rise / (times[k] - times[k - order]);
        }
    }
    let mut at = [0.0; 3];
    for k in (0..n).rev() {
        let x = t - times[k];
        at = [
            at[0] * x + differences[k],
            at[1] * x + at[0],
            at[2] * x + 2.0 * at[1],
        ];
    }
    [at[1], at[2]]
}

impl Path for MonotoneQuintic<3> {
    fn at(&self, t: f64) -> Pose {
        Pose::of_derivatives(self.derivatives(t))
    }

    fn sweep(&self, duration: f64) -> (f64, usize) {
        (duration, poses_between(&self.times, duration))
    }

    fn knots(&self, _: f64) -> Vec<Knot> {
        self.rows()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table(rows: &[[f64; 2]]) -> MonotoneQuintic<1> {
        MonotoneQuintic::new(rows.iter().map(|&[t, y]| (t, [y])))
    }

    fn at(table: &MonotoneQuintic<1>, t: f64) -> [f64; 3] {
        table.derivatives(t).map(|[x]| x)
    }

    /// Tables of 2 to 12 rows with steps and rises of very different sizes, falls and flats.
    fn random_tables() -> impl Iterator<Item = Vec<[f64; 2]>> {
        // the generator of Knuth's MMIX
        let mut state = 1_u64;
        let mut random = move || {
            state = state
                .wrapping_mul(6364136223846793005)
                .wrapping_add(1442695040888963407);
            (state >> 11) as f64 / (1_u64 << 53) as f64
        };
        (0..2000).map(move |_| {
            let mut row = [0.0, random()];
            let rows = 2 + (11.0 * random()) as usize;
            let falls = 0.5 * random();
            let next = |_| {
                let size = 10.0_f64.powf(4.0 * random() - 2.0);
                let turn = random();
                let rise = match turn {
                    x if x < falls => -size,
                    x if x < 0.8 => size,
                    _ => 0.0,
                };
                row = [row[0] + 10.0_f64.powf(2.0 * random() - 1.0), row[1] + rise];
                row
            };
            (0..rows).map(next).collect()
        })
    }

    fn value(c: &[f64], u: f64) -> f64 {
        c.iter().rev().fold(0.0, |sum, c| sum * u + c)
    }

    fn derivative(c: &[f64]) -> Vec<f64> {
        let terms = c.iter().enumerate().skip(1);
        terms.map(|(k, c)| k as f64 * c).collect()
    }

    /// Where a polynomial changes its sign between 0 and 1: once at most between neighbouring sign changes of its derivative.
    fn sign_changes(c: &[f64]) -> Vec<f64> {
        if c.len() < 2 {
            return Vec::new();
        }
        let mut ends = sign_changes(&derivative(c));
        ends.extend([0.0, 1.0]);
        ends.sort_by(f64::total_cmp);
        let changes = |pair: &[f64]| {
            let [mut from, mut to] = [pair[0], pair[1]];
            let positive = value(c, from) > 0.0;
            if (value(c, to) > 0.0) == positive {
                return None;
            }
            for _ in 0..60 {
                let middle = 0.5 * (from + to);
                match (value(c, middle) > 0.0) == positive {
                    true => from = middle,
                    false => to = middle,
                }
            }
            Some(from)
        };
        ends.windows(2).filter_map(changes).collect()
    }

    #[test]
    fn pieces_are_monotone_between_neighbouring_rows() {
        let mut limited = 0;
        for rows in random_tables() {
            let f = table(&rows);
            for (k, pair) in rows.windows(2).enumerate() {
                let ([t_0, y_0], [t_1, y_1]) = (pair[0], pair[1]);
                let (h, rise) = (t_1 - t_0, y_1 - y_0);
                // rounding of a sum of six numbers, none of which exceeds 100 rises
                let least = -1e-13 * rise.abs() / h;
                let c = f.pieces[k][0];
                if rise == 0.0 {
                    assert_eq!(c, [y_0, 0.0, 0.0, 0.0, 0.0, 0.0], "{rows:?}");
                    continue;
                }
                let slope = derivative(&c);
                let extremes = sign_changes(&derivative(&slope));
                let dense = (0..=100).map(|i| f64::from(i) / 100.0);
                for u in extremes.into_iter().chain(dense) {
                    let slope = value(&slope, u) / h * rise.signum();
                    assert!(slope >= least, "{rows:?}: {slope} at {}", t_0 + u * h);
                }
                limited += usize::from(k > 0 && c[1] == 0.0);
            }
        }
        assert!(limited > 100, "no slope was limited");
    }

    #[test]
    fn neighbouring_pieces_agree_up_to_the_second_derivative() {
        for rows in random_tables() {
            let f = table(&rows);
            for k in 1..rows.len() - 1 {
                let ends = |c: [f64; 6], h: f64| {
                    let weights = [
                        [1.0; 6],
                        [0.0, 1.0, 2.0, 3.0, 4.0, 5.0],
                        [0.0, 0.0, 2.0, 6.0, 12.0, 20.0],
                    ];
                    let sum = |w: [f64; 6]| (0..6).map(|i| w[i] * c[i]).sum::<f64>();
                    let size = c.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
                    let levels = [1.0, h, h * h];
                    (
                        [0, 1, 2].map(|level| sum(weights[level]) / levels[level]),
                        levels.map(|level| size / level),
                    )
                };
                let (before, sizes) = ends(f.pieces[k - 1][0], rows[k][0] - rows[k - 1][0]);
                let c = f.pieces[k][0];
                let h = rows[k + 1][0] - rows[k][0];
                let after = [c[0], c[1] / h, 2.0 * c[2] / (h * h)];
                for level in 0..3 {
                    // rounding of six products with weights up to 20
                    let bound = 1e-13 * sizes[level];
                    assert!(
                        (before[level] - after[level]).abs() <= bound,
                        "{rows:?}, row {k}, level {level}"
                    );
                }
            }
        }
    }

    #[test]
    fn what_needs_no_limit_is_reproduced() {
        // a straight line through two rows and more; a polynomial of degree 4 that rises everywhere
        let line = |t: f64| [3.0 - 2.0 * t, -2.0, 0.0];
        let quartic = |t: f64| {
            let u = t - 1.0;
            [
                t + u.powi(3) / 3.0 - u.powi(4) / 8.0,
                1.0 + u * u - u.powi(3) / 2.0,
                2.0 * u - 1.5 * u * u,
            ]
        };
        type Exact = fn(f64) -> [f64; 3];
        let cases: [(&[f64], Exact); 3] = [
            (&[0.0, 0.7], line),
            (&[0.0, 0.1, 0.5, 0.6, 2.0], line),
            (&[0.0, 0.25, 0.6, 0.8, 1.0, 1.3, 1.55, 1.7, 2.0], quartic),
        ];
        for (times, exact) in cases {
            let rows: Vec<[f64; 2]> = times.iter().map(|&t| [t, exact(t)[0]]).collect();
            let f = table(&rows);
            for i in 0..=100 {
                let t = times[times.len() - 1] * f64::from(i) / 100.0;
                for (found, exact) in at(&f, t).iter().zip(exact(t)) {
                    // second derivatives of values with rounding 1e-16 over intervals of 0.1
                    assert!((found - exact).abs() < 1e-11, "{t}: {found} {exact}");
                }
            }
        }
    }

    /// Between two flats there is the smooth step from rest to rest, and flats are flat.
    #[test]
    fn a_rise_between_dwells_is_a_smooth_step() {
        let f = table(&[
            [0.0, 0.0],
            [0.2, 0.0],
            [0.4, 0.03],
            [0.6, 0.03],
            [0.8, 0.0],
            [1.0, 0.0],
        ]);
        for i in 0..=1000 {
            let t = f64::from(i) / 1000.0;
            let rest = |value: f64| [value, 0.0, 0.0];
            let step = |from: f64, rise: f64| {
                let [s, by_u, by_u2] = super::super::line::quintic((t - from) / 0.2);
                [s * rise, by_u * rise / 0.2, by_u2 * rise / 0.04]
            };
            let expected = match t {
                t if t <= 0.2 || t >= 0.8 => rest(0.0),
                t if t < 0.4 => step(0.2, 0.03),
                t if t <= 0.6 => rest(0.03),
                _ => step(0.6, -0.03).map(|x| x),
            };
            for (level, (found, expected)) in at(&f, t).into_iter().zip(expected).enumerate() {
                let expected = if level == 0 && t > 0.6 && t < 0.8 {
                    expected + 0.03
                } else {
                    expected
                };
                // rounding of 20 c_5 = 20 6 0.03 over 0.2^2
                assert!(
                    (found - expected).abs() < 1e-13,
                    "{t}, level {level}: {found} {expected}"
                );
            }
        }
    }

    /// The largest error at rows ever closer falls with the power 5 of their distance, that of the acceleration with the power 3.
    #[test]
    fn the_error_is_of_order_five() {
        let exact = |t: f64| {
            [
                t + 0.4 * (2.0 * t).sin(),
                1.0 + 0.8 * (2.0 * t).cos(),
                -1.6 * (2.0 * t).sin(),
            ]
        };
        let errors = |n: u32| {
            // neighbouring intervals differ, and the ratio of the largest to the smallest is 3
            let time = |k: u32| {
                let x = f64::from(k) / f64::from(n);
                2.0 * (x + 0.5 * (std::f64::consts::TAU * x).sin() / std::f64::consts::TAU)
            };
            let rows: Vec<[f64; 2]> = (0..=n).map(|k| [time(k), exact(time(k))[0]]).collect();
            let f = table(&rows);
            let mut largest = [0.0_f64; 3];
            for i in 0..=20_000 {
                let t = 2.0 * f64::from(i) / 20_000.0;
                let [found, exact] = [at(&f, t), exact(t)];
                largest = std::array::from_fn(|l| largest[l].max((found[l] - exact[l]).abs()));
            }
            largest
        };
        let [coarse, fine] = [errors(40), errors(80)];
        for (level, order) in [(0, 5.0), (1, 4.0), (2, 3.0)] {
            let found = (coarse[level] / fine[level]).log2();
            // terms of the next order at 40 rows
            assert!((found - order).abs() < 0.3, "level {level}: order {found}");
        }
    }

    /// A table that is turned upside down or read backwards gives the same curve, turned or read backwards.
    #[test]
    fn neither_direction_is_preferred() {
        for rows in random_tables().take(200) {
            let end = rows[rows.len() - 1][0];
            let down: Vec<[f64; 2]> = rows.iter().map(|[t, y]| [*t, -y]).collect();
            let back: Vec<[f64; 2]> = rows.iter().rev().map(|[t, y]| [end - t, *y]).collect();
            let [f, down, back] = [&rows, &down, &back].map(|rows| table(rows));
            let size = rows.iter().fold(0.0_f64, |m, row| m.max(row[1].abs()));
            for i in 0..=50 {
                let t = rows[0][0] + (end - rows[0][0]) * f64::from(i) / 50.0;
                let [value, _, _] = at(&f, t);
                assert_eq!(at(&down, t)[0], -value);
                // rounding of a time moves a value by its slope, up to 1e5 in these tables
                assert!(
                    (at(&back, end - t)[0] - value).abs() < 1e-9 * size,
                    "{rows:?} at {t}"
                );
            }
        }
    }
}

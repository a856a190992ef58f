//! Products of a constant sparse matrix with vectors.

/// A square matrix. Two neighbouring rows with the same entries, one column apart, are multiplied together: masses act alike on x
/// and y.
#[derive(Debug, Default)]
pub struct SparseProduct {
    /// Rows that stand alone, each with the end of its entries; then the first of every two rows.
    singles: Vec<RowEnd>,
    pairs: Vec<RowEnd>,
    /// Columns and values: of the single rows, then of the first rows of the pairs.
    entries: Vec<(u32, f64)>,
}

#[derive(Debug, Clone, Copy)]
struct RowEnd {
    row: u32,
    end: u32,
}

impl SparseProduct {
    /// Of rows with their columns, ascending, and values.
    pub fn new(rows: &[Vec<(usize, f64)>]) -> SparseProduct {
        let mut product = SparseProduct::default();
        let (mut singles, mut pairs) = (Vec::new(), Vec::new());
        let mut i = 0;
        while i < rows.len() {
            let next = rows.get(i + 1);
            let shifted = rows[i].iter().map(|&(j, value)| (j + 1, value));
            match next.is_some_and(|next| shifted.eq(next.iter().copied())) {
                true => pairs.push(i),
                false => singles.push(i),
            }
            i += 1 + usize::from(pairs.last() == Some(&i));
        }
        let mut add = |&i: &usize| {
            let row = rows[i].iter().map(|&(j, value)| (j as u32, value));
            product.entries.extend(row);
            RowEnd {
                row: i as u32,
                end: product.entries.len() as u32,
            }
        };
        product.singles = singles.iter().map(&mut add).collect();
        product.pairs = pairs.iter().map(&mut add).collect();
        product
    }

    /// The matrix times x, into the first entries of `out`.
    #[inline]
    pub fn times(&self, x: &[f64], out: &mut [f64]) {
        self.rows_times(x, |row, sum| out[row] = sum);
    }

    /// x^T A x.
    #[inline]
    pub fn quadratic_form(&self, x: &[f64]) -> f64 {
        let mut form = 0.0;
        self.rows_times(x, |row, sum| form += x[row] * sum);
        form
    }

    /// Every row with its product.
    #[inline]
    fn rows_times(&self, x: &[f64], mut take: impl FnMut(usize, f64)) {
        let mut start = 0;
        for &RowEnd { row, end } in &self.singles {
            let mut sum = 0.0;
            for &(j, value) in &self.entries[start..end as usize] {
                sum += value * x[j as usize];
            }
            take(row as usize, sum);
            start = end as usize;
        }
        for &RowEnd { row, end } in &self.pairs {
            let mut sums = [0.0; 2];
            for &(j, value) in &self.entries[start..end as usize] {
                let x: &[f64; 2] = x[j as usize..]
                    .first_chunk()
                    .expect("columns come in pairs");
                for (sum, x) in sums.iter_mut().zip(x) {
                    *sum += value * x;
                }
            }
            take(row as usize, sums[0]);
            take(row as usize + 1, sums[1]);
            start = end as usize;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn products_are_those_of_the_rows() {
        // a pair, a single row with the columns of the next but other values, a pair that shares a column, an empty row
        let rows = vec![
            vec![(0, 2.0), (4, 0.5)],
            vec![(1, 2.0), (5, 0.5)],
            vec![(2, 1.0), (3, 0.25)],
            vec![(3, 1.5), (4, 0.25)],
            vec![(0, 0.5), (4, 3.0), (5, 0.1)],
            vec![(1, 0.5), (5, 3.0), (6, 0.1)],
            vec![],
        ];
        let product = SparseProduct::new(&rows);
        assert_eq!((product.singles.len(), product.pairs.len()), (3, 2));
        assert_eq!(product.entries.len(), 9);
        let x: Vec<f64> = (0..7).map(|i| 0.3 + f64::from(i * i)).collect();
        let mut out = [f64::NAN; 7];
        product.times(&x, &mut out);
        for (row, out) in rows.iter().zip(out) {
            let sum = row.iter().fold(0.0, |sum, &(j, value)| sum + value * x[j]);
            assert_eq!(out, sum);
        }
        let form = x.iter().zip(out).map(|(x, out)| x * out).sum::<f64>();
        // the same products in another order: a rounding for each of the seven sums
        assert!((product.quadratic_form(&x) - form).abs() <= 7.0 * f64::EPSILON * form);
    }
}

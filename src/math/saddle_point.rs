//! The saddle-point matrix of the acceleration level, \[\[M, G^T\], \[G, 0\]\], whose M is constant.
//!
//! M is factorised once. What changes with the pose is G = Phi_q, so only the Schur complement S = G M^-1 G^T is formed and
//! factorised anew: one row for each multiplier, whatever the number of elements. It needs no more of M^-1 than its entries
//! between coordinates that constraints depend on, which are constant:
//!
//! ```text
//! S mu = G M^-1 b - c        x = M^-1 (b - G^T mu)        for M x + G^T mu = b,  G x = c
//! ```
//!
//! Where masses couple the coordinates of many constraints, as in a chain whose rigid links share their nodes, S is full. The
//! matrix is then factorised as a whole, in an order that keeps it sparse. The numbers of operations decide.

use super::groups::Groups;
use super::lu::{DenseLu, Symbolic, WeakPivot};
use super::mass_inverse::{MassFactors, MassInverse};
use faer::Mat;
use std::collections::BTreeMap;

/// With more entries an unknown, columns of M^-1 cost more than a solve with its factors.
const LONGEST_COLUMNS: usize = 6;
/// With fewer products a row, S is formed without a comparison of the operations.
const FEW_PRODUCTS: usize = 64;

/// The matrix with its pattern and the factors of M.
///
/// The entries of G are a list of values, row by row, whose last one is a discarded slot for coordinates that are no unknowns.
#[derive(Debug)]
pub struct SaddlePoint {
    entries: SaddleEntries,
    /// Rows that are replaced by mu = 0.
    dropped: Vec<usize>,
    form: SaddleForm,
}

/// M, and where the entries of G stand.
#[derive(Debug)]
struct SaddleEntries {
    unknowns: usize,
    /// (row, column, mass) of M.
    mass: Vec<(usize, usize, f64)>,
    /// The unknown of every entry of G.
    columns: Vec<usize>,
    /// End of the entries of every row of G.
    ends: Vec<usize>,
}

#[derive(Debug)]
enum SaddleForm {
    Complement(Box<Complement>),
    Bordered(Box<Bordered>),
}

/// M and S, one after the other.
#[derive(Debug)]
struct Complement {
    mass: MassInverse,
    /// Columns of M^-1 for the unknowns that G depends on, unless they are too long.
    inverse: Option<InverseColumns>,
    symbolic: Symbolic,
    products: Vec<Product>,
    /// The entries of S that are sums of products, in the order of the products.
    sums: Vec<Sum>,
    /// Where the diagonal of S stands.
    diagonal: Vec<u32>,
}

/// Columns of M^-1, one after the other.
#[derive(Debug, Default)]
struct InverseColumns {
    /// The unknown of a column, and the end of its entries.
    columns: Vec<(u32, u32)>,
    /// Rows and values.
    entries: Vec<(u32, f64)>,
}

/// weight g_first g_second.
#[derive(Debug, Clone, Copy)]
struct Product {
    first: u32,
    second: u32,
    weight: f64,
}

/// An entry of S, of which the twin across the diagonal has the same value, and the end of its products.
#[derive(Debug, Clone, Copy)]
struct Sum {
    slot: u32,
    twin: u32,
    end: u32,
}

/// The whole matrix.
#[derive(Debug)]
struct Bordered {
    symbolic: Symbolic,
    /// M in the layout of the matrix.
    mass: Vec<f64>,
    /// Where every entry of G stands in G and in G^T.
    slots: Vec<[u32; 2]>,
}

/// G and the factors that follow from it.
#[derive(Debug, Clone)]
pub struct SaddleFactors {
    /// Entries of G.
    pub gradient: Vec<f64>,
    /// Factors of S or of the whole matrix.
    values: Vec<f64>,
    /// The diagonal of S, where S is formed.
    diagonal: Vec<f64>,
    /// Memory of a solve.
    scratch: Vec<f64>,
    /// Factors of the whole matrix with row exchanges, where the fixed pivot order met a weak pivot.
    dense: Option<DenseLu>,
}

impl SaddlePoint {
    /// The matrix with the entries of M as (row, column, mass), and the unknowns of each row of G.
    pub fn new(
        unknowns: usize,
        mass: Vec<(usize, usize, f64)>,
        rows: &[Vec<usize>],
    ) -> SaddlePoint {
        let ends = rows.iter().scan(0, |end, row| {
            *end += row.len();
            Some(*end)
        });
        let entries = SaddleEntries {
            unknowns,
            mass,
            columns: rows.concat(),
            ends: ends.collect(),
        };
        SaddlePoint {
            form: entries.form(),
            entries,
            dropped: Vec::new(),
        }
    }
}

/// Unknowns that masses couple, and the entries of G that belong to them.
struct MassGroup {
    unknowns: Vec<usize>,
    /// (row, entry)
    entries: Vec<(usize, usize)>,
}

impl SaddleEntries {
    /// The form with fewer operations.
    fn form(&self) -> SaddleForm {
        let groups = self.groups();
        let complement = || self.complement(&groups).map(Box::new);
        let products: usize = groups.iter().map(|group| group.entries.len().pow(2)).sum();
        if products <= FEW_PRODUCTS * self.ends.len()
            && let Some(complement) = complement()
        {
            return SaddleForm::Complement(complement);
        }
        let bordered = self.bordered();
        match products < bordered.symbolic.operations() {
            true => complement().map(SaddleForm::Complement),
            false => None,
        }
        .unwrap_or(SaddleForm::Bordered(Box::new(bordered)))
    }

    /// The groups of unknowns.
    fn groups(&self) -> Vec<MassGroup> {
        let mut coupled = Groups::new(self.unknowns);
        for &(i, j, _) in &self.mass {
            coupled.unite(i, j);
        }
        let group = |unknowns| MassGroup {
            unknowns,
            entries: Vec::new(),
        };
        let mut groups: Vec<MassGroup> = coupled.all().into_iter().map(group).collect();
        let mut of = vec![0; self.unknowns];
        for (k, group) in groups.iter().enumerate() {
            group.unknowns.iter().for_each(|&i| of[i] = k);
        }
        for (row, entries) in self.rows() {
            for entry in entries {
                groups[of[self.columns[entry]]].entries.push((row, entry));
            }
        }
        groups
    }

    /// First entry of a row of G.
    fn start(&self, row: usize) -> usize {
        if row == 0 { 0 } else { self.ends[row - 1] }
    }

    /// The rows of G with the range of their entries.
    fn rows(&self) -> impl Iterator<Item = (usize, std::ops::Range<usize>)> {
        (0..self.ends.len()).map(|row| (row, self.start(row)..self.ends[row]))
    }

    /// M and S as two matrices; `None` if a pivot of M is weak.
    fn complement(&self, groups: &[MassGroup]) -> Option<Complement> {
        let mut sums = BTreeMap::<(usize, usize), Vec<Product>>::new();
        let mut masses = vec![Vec::new(); groups.len()];
        let mut place = vec![(0, 0); self.unknowns];
        for (g, group) in groups.iter().enumerate() {
            for (local, &i) in group.unknowns.iter().enumerate() {
                place[i] = (g, local);
            }
        }
        for &(i, j, m) in &self.mass {
            masses[place[i].0].push((place[i].1, place[j].1, m));
        }
        let mut inverse = InverseColumns::default();
        let longest = LONGEST_COLUMNS * self.unknowns;
        let factors = groups.iter().zip(masses);
        let factors =
            factors.map(|(group, m)| MassFactors::new(group.unknowns.len(), m.into_iter()));
        let factors: Vec<MassFactors> = factors.collect::<Option<_>>()?;
        for (group, factors) in groups.iter().zip(&factors) {
            let local = |entry: usize| place[self.columns[entry]].1;
            let mut columns = BTreeMap::new();
            for &(_, entry) in &group.entries {
                let own = local(entry);
                columns
                    .entry(own)
                    .or_insert_with(|| factors.inverse_column(own));
            }
            for (&own, column) in &columns {
                if inverse.entries.len() > longest {
                    break;
                }
                let rows = group.unknowns.iter().zip(column);
                let rows = rows.filter(|(_, value)| **value != 0.0);
                inverse
                    .entries
                    .extend(rows.map(|(&i, value)| (i as u32, *value)));
                let end = inverse.entries.len() as u32;
                inverse.columns.push((group.unknowns[own] as u32, end));
            }
            for &(row, first) in &group.entries {
                let column = &columns[&local(first)];
                for &(other, second) in &group.entries {
                    if row < other || row == other && first < second {
                        continue;
                    }
                    let twice = if row == other && first != second {
                        2.0
                    } else {
                        1.0
                    };
                    sums.entry((row, other)).or_default().push(Product {
                        first: first as u32,
                        second: second as u32,
                        weight: twice * column[local(second)],
                    });
                }
            }
        }
        let blocks = groups.iter().map(|group| &*group.unknowns);
        let whole = || MassFactors::new(self.unknowns, self.mass.iter().copied());
        let mass = MassInverse::new(whole, blocks.zip(&factors))?;
        let m = self.ends.len();
        let cliques: Vec<Vec<usize>> = sums.keys().map(|&(i, j)| vec![i, j]).collect();
        let symbolic = Symbolic::analyse(m, &cliques, &vec![Vec::new(); m]);
        let mut complement = Complement {
            mass,
            inverse: (inverse.entries.len() <= longest).then_some(inverse),
            products: Vec::new(),
            sums: Vec::new(),
            diagonal: (0..symbolic.n()).map(|i| symbolic.slot(i, i)).collect(),
            symbolic,
        };
        for ((i, j), products) in sums {
            complement.products.extend(products);
            complement.sums.push(Sum {
                slot: complement.symbolic.slot(i, j),
                twin: complement.symbolic.slot(j, i),
                end: complement.products.len() as u32,
            });
        }
        Some(complement)
    }

    /// The matrix as a whole, each row of G after its unknowns.
    fn bordered(&self) -> Bordered {
        let n = self.unknowns;
        let mut cliques: Vec<Vec<usize>> = self.mass.iter().map(|&(i, j, _)| vec![i, j]).collect();
        let mut after = vec![Vec::new(); n];
        for (row, entries) in self.rows() {
            let unknowns = &self.columns[entries];
            cliques.extend(unknowns.iter().map(|&i| vec![i, n + row]));
            after.push(unknowns.to_vec());
        }
        let symbolic = Symbolic::analyse(after.len(), &cliques, &after);
        let slots = self.rows().flat_map(|(row, entries)| {
            let unknowns = self.columns[entries].iter();
            let symbolic = &symbolic;
            unknowns.map(move |&i| [symbolic.slot(n + row, i), symbolic.slot(i, n + row)])
        });
        let slots = slots.collect();
        Bordered {
            mass: symbolic.filled(self.mass.iter().copied()),
            symbolic,
            slots,
        }
    }
}

impl SaddlePoint {
    /// Memory for G and its factors.
    pub fn factors(&self) -> SaddleFactors {
        let length = match &self.form {
            SaddleForm::Complement(complement) => complement.symbolic.len(),
            SaddleForm::Bordered(bordered) => bordered.symbolic.len(),
        };
        SaddleFactors {
            gradient: vec![0.0; self.entries.columns.len() + 1],
            values: vec![0.0; length],
            diagonal: vec![0.0; self.entries.ends.len()],
            scratch: vec![0.0; self.entries.unknowns],
            dense: None,
        }
    }

    /// Multiply-adds of a factorisation and of a solve.
    pub fn operations(&self) -> [usize; 2] {
        let gradient = self.entries.columns.len();
        match &self.form {
            SaddleForm::Complement(complement) => {
                let Complement { mass, symbolic, .. } = &**complement;
                let columns = complement.inverse.as_ref();
                let inverse = columns.map_or(mass.operations(), |c| c.entries.len());
                [
                    2 * complement.products.len() + symbolic.operations(),
                    mass.operations() + symbolic.operations_of_solve() + 2 * gradient + inverse,
                ]
            }
            SaddleForm::Bordered(bordered) => [
                bordered.symbolic.operations(),
                bordered.symbolic.operations_of_solve(),
            ],
        }
    }

    /// Replaces a row of G, whose entries and right sides are zero from now on, by mu = 0.
    pub fn drop_row(&mut self, row: usize) {
        self.dropped.push(row);
    }

    /// First entry of a row of G.
    pub fn first_entry(&self, row: usize) -> usize {
        self.entries.start(row)
    }

    /// The entry that is discarded.
    pub fn discarded_entry(&self) -> u32 {
        self.entries.columns.len() as u32
    }

    /// True where the factors of M are all there is to factorise.
    pub fn is_constant(&self) -> bool {
        self.entries.ends.is_empty() && matches!(self.form, SaddleForm::Complement(_))
    }

    /// Factorises the matrix of the gradient in `factors`.
    ///
    /// # Errors
    /// A weak pivot.
    pub fn factor(&self, factors: &mut SaddleFactors) -> Result<(), WeakPivot> {
        let SaddleFactors {
            gradient,
            values,
            diagonal,
            ..
        } = factors;
        factors.dense = None;
        match &self.form {
            SaddleForm::Complement(complement) => {
                complement.factor(gradient, &self.dropped, values, diagonal)
            }
            SaddleForm::Bordered(bordered) => {
                values.copy_from_slice(&bordered.mass);
                for (slots, g) in bordered.slots.iter().zip(&*gradient) {
                    slots.iter().for_each(|slot| values[*slot as usize] += g);
                }
                for row in self.dropped.iter().map(|row| self.entries.unknowns + row) {
                    values[bordered.symbolic.slot(row, row) as usize] = 1.0;
                }
                return bordered.symbolic.factor(values);
            }
        }
        .map_err(|weak| WeakPivot {
            index: self.entries.unknowns + weak.index,
        })
    }

    /// As [`SaddlePoint::factor`]; after a weak pivot, once more as a dense matrix with row exchanges. Returns true in that case.
    ///
    /// # Errors
    /// The matrix is singular to rounding.
    pub fn factor_any(&self, factors: &mut SaddleFactors) -> Result<bool, WeakPivot> {
        let Err(weak) = self.factor(factors) else {
            return Ok(false);
        };
        factors.dense = DenseLu::factor(self.to_dense(&factors.gradient));
        match factors.dense {
            Some(_) => Ok(true),
            None => Err(weak),
        }
    }

    /// Smallest pivot of the rows of G over its entry in S, or where S is not formed over the largest pivot; zero where a pivot was weak.
    /// The first is the squared sine of a row to those before it in the metric of M^-1, whatever the units of the rows.
    pub fn pivot_range(&self, factors: &SaddleFactors) -> f64 {
        if factors.dense.is_some() {
            return 0.0;
        }
        match &self.form {
            SaddleForm::Complement(complement) => {
                // the factors hold the inverses of the pivots
                let rows = factors.diagonal.iter().zip(&complement.diagonal);
                let inverses =
                    rows.map(|(entry, slot)| (entry * factors.values[*slot as usize]).abs());
                1.0 / inverses.fold(0.0, f64::max)
            }
            SaddleForm::Bordered(bordered) => bordered
                .symbolic
                .pivot_range(&factors.values, self.entries.unknowns),
        }
    }

    /// Solves for (x, mu) with right side (b, c), in place.
    pub fn solve(&self, factors: &mut SaddleFactors, b: &mut [f64]) {
        let SaddleFactors {
            gradient,
            values,
            scratch,
            dense,
            ..
        } = factors;
        if let Some(dense) = dense {
            return dense.solve(b);
        }
        match &self.form {
            SaddleForm::Bordered(bordered) => bordered.symbolic.solve(values, b),
            SaddleForm::Complement(complement) => {
                let (x, mu) = b.split_at_mut(self.entries.unknowns);
                complement.mass.solve(x);
                for (row, entries) in self.entries.rows() {
                    let terms = gradient[entries.clone()]
                        .iter()
                        .zip(&self.entries.columns[entries]);
                    let sum: f64 = terms.map(|(g, &i)| g * x[i]).sum();
                    mu[row] = sum - mu[row];
                }
                complement.symbolic.solve(values, mu);
                self.subtract(complement, gradient, mu, scratch, x);
            }
        }
    }

    /// Solves for (x, mu) with right side (0, c), in place: only the last part of `b` is read.
    pub fn solve_rows(&self, factors: &mut SaddleFactors, b: &mut [f64]) {
        let (x, mu) = b.split_at_mut(self.entries.unknowns);
        x.fill(0.0);
        let SaddleForm::Complement(complement) = &self.form else {
            return self.solve(factors, b);
        };
        if factors.dense.is_some() {
            return self.solve(factors, b);
        }
        let SaddleFactors {
            gradient,
            values,
            scratch,
            ..
        } = factors;
        mu.iter_mut().for_each(|mu| *mu = -*mu);
        complement.symbolic.solve(values, mu);
        self.subtract(complement, gradient, mu, scratch, x);
    }

    /// Subtracts M^-1 G^T mu from x.
    fn subtract(
        &self,
        complement: &Complement,
        gradient: &[f64],
        mu: &[f64],
        scratch: &mut [f64],
        x: &mut [f64],
    ) {
        scratch.fill(0.0);
        for (row, entries) in self.entries.rows() {
            let terms = gradient[entries.clone()]
                .iter()
                .zip(&self.entries.columns[entries]);
            terms.for_each(|(g, &i)| scratch[i] += g * mu[row]);
        }
        match &complement.inverse {
            Some(InverseColumns { columns, entries }) => {
                let mut start = 0;
                for &(own, end) in columns {
                    let factor = scratch[own as usize];
                    for &(i, value) in &entries[start..end as usize] {
                        x[i as usize] -= factor * value;
                    }
                    start = end as usize;
                }
            }
            None => {
                complement.mass.solve(scratch);
                x.iter_mut()
                    .zip(scratch)
                    .for_each(|(x, change)| *x -= *change);
            }
        }
    }

    /// The matrix in full.
    pub fn to_dense(&self, gradient: &[f64]) -> Mat<f64> {
        let n = self.entries.unknowns;
        let mut dense = Mat::zeros(n + self.entries.ends.len(), n + self.entries.ends.len());
        for &(i, j, m) in &self.entries.mass {
            dense[(i, j)] += m;
        }
        for (row, entries) in self.entries.rows() {
            for entry in entries {
                let i = self.entries.columns[entry];
                dense[(n + row, i)] += gradient[entry];
                dense[(i, n + row)] += gradient[entry];
            }
        }
        for row in self.dropped.iter().map(|row| n + row) {
            dense[(row, row)] = 1.0;
        }
        dense
    }
}

impl Complement {
    /// Forms S and factorises it.
    fn factor(
        &self,
        gradient: &[f64],
        dropped: &[usize],
        values: &mut [f64],
        diagonal: &mut [f64],
    ) -> Result<(), WeakPivot> {
        values.fill(0.0);
        let mut start = 0;
        for sum in &self.sums {
            let end = sum.end as usize;
            let terms = self.products[start..end].iter();
            let terms = terms
                .map(|p| p.weight * (gradient[p.first as usize] * gradient[p.second as usize]));
            let sum_of: f64 = terms.sum();
            (values[sum.slot as usize], values[sum.twin as usize]) = (sum_of, sum_of);
            start = end;
        }
        for &row in dropped {
            values[self.symbolic.slot(row, row) as usize] = 1.0;
        }
        for (entry, slot) in diagonal.iter_mut().zip(&self.diagonal) {
            *entry = values[*slot as usize];
        }
        self.symbolic.factor(values)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A chain of rigid bars: masses couple neighbouring nodes, and a row ties each node to the next but one.
    fn chain(nodes: usize) -> (SaddlePoint, Vec<f64>) {
        let mut mass = Vec::new();
        for i in 0..nodes {
            mass.push((i, i, 2.0 + 0.1 * (i % 7) as f64));
            if i + 1 < nodes {
                mass.extend([(i, i + 1, 0.5), (i + 1, i, 0.5)]);
            }
        }
        let rows: Vec<Vec<usize>> = (0..nodes - 2).map(|i| vec![i, i + 1, i + 2]).collect();
        let gradient = (0..3 * rows.len()).map(|k| 0.3 + ((7 * k) % 5) as f64);
        let gradient = gradient.chain([f64::NAN]).collect();
        (SaddlePoint::new(nodes, mass, &rows), gradient)
    }

    /// Bodies of three coordinates, the first two with a mass of their own, each tied to the next one.
    fn bodies(count: usize) -> (SaddlePoint, Vec<f64>) {
        let mass = (0..count).flat_map(|b| {
            let x = 3 * b;
            let coupled = [
                (x, x, 2.0),
                (x, x + 1, 0.3),
                (x + 1, x, 0.3),
                (x + 1, x + 1, 1.5),
            ];
            coupled.into_iter().chain([(x + 2, x + 2, 0.4)])
        });
        let rows: Vec<Vec<usize>> = (0..count - 1)
            .map(|b| vec![3 * b, 3 * b + 2, 3 * b + 3, 3 * b + 4])
            .collect();
        let gradient = (0..4 * rows.len()).map(|k| 0.5 + ((3 * k) % 4) as f64);
        let gradient = gradient.chain([f64::NAN]).collect();
        (SaddlePoint::new(3 * count, mass.collect(), &rows), gradient)
    }

    /// Largest residual of solutions, with and without a right side of the first rows, over the size of its terms.
    fn residual(matrix: &SaddlePoint, gradient: &[f64]) -> f64 {
        let mut factors = matrix.factors();
        factors.gradient.copy_from_slice(gradient);
        matrix.factor(&mut factors).unwrap();
        let dense = matrix.to_dense(gradient);
        let size = dense.nrows();
        let mut worst = 0.0_f64;
        for only_rows in [false, true] {
            let is_dropped = |i: usize| {
                matrix
                    .dropped
                    .iter()
                    .any(|row| matrix.entries.unknowns + row == i)
            };
            let right = |i: usize| match only_rows && i < matrix.entries.unknowns || is_dropped(i) {
                true => 0.0,
                false => 1.0 + ((5 * i) % 3) as f64,
            };
            let mut x: Vec<f64> = (0..size).map(right).collect();
            match only_rows {
                true => matrix.solve_rows(&mut factors, &mut x),
                false => matrix.solve(&mut factors, &mut x),
            }
            for i in 0..size {
                let terms = (0..size).map(|j| dense[(i, j)] * x[j]);
                let (sum, sizes) = terms.fold((0.0, 0.0), |(s, m), t| (s + t, m + t.abs()));
                let error = (sum - right(i)).abs() / (sizes + right(i)).max(1.0);
                worst = if error <= worst { worst } else { error };
            }
        }
        worst
    }

    #[test]
    fn both_forms_solve() {
        // some tens of roundings, which masses of a condition number of ten may amplify
        let bound = 1e3 * f64::EPSILON;
        let (mut matrix, mut gradient) = bodies(5);
        assert!(matches!(matrix.form, SaddleForm::Complement(_)));
        let left = residual(&matrix, &gradient);
        assert!(left < bound, "{left:e}");
        gradient[4..8].fill(0.0);
        matrix.drop_row(1);
        let left = residual(&matrix, &gradient);
        assert!(left < bound, "{left:e}");

        let (mut matrix, mut gradient) = chain(60);
        assert!(matches!(matrix.form, SaddleForm::Bordered(_)));
        let left = residual(&matrix, &gradient);
        assert!(left < bound, "{left:e}");
        gradient[3..6].fill(0.0);
        matrix.drop_row(1);
        let left = residual(&matrix, &gradient);
        assert!(left < bound, "{left:e}");
    }

    #[test]
    fn columns_of_the_inverse_and_a_solve_agree() {
        let (mut matrix, gradient) = bodies(5);
        let SaddleForm::Complement(complement) = &mut matrix.form else {
            panic!("masses couple few unknowns");
        };
        assert!(complement.inverse.take().is_some());
        let left = residual(&matrix, &gradient);
        assert!(left < 1e3 * f64::EPSILON, "{left:e}");
    }

    #[test]
    fn repeated_rows_have_no_pivot() {
        let mass = vec![(0, 0, 1.0), (1, 1, 2.0)];
        let matrix = SaddlePoint::new(2, mass, &[vec![0, 1], vec![0, 1]]);
        let mut factors = matrix.factors();
        factors.gradient[..4].copy_from_slice(&[1.0, 1.0, 1.0, 1.0]);
        assert_eq!(matrix.factor(&mut factors), Err(WeakPivot { index: 3 }));
        assert_eq!(matrix.factor_any(&mut factors), Err(WeakPivot { index: 3 }));
    }
}

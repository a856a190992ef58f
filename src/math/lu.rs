//! LU factorisation with a pattern and a pivot order that are fixed when the model is compiled.
//!
//! The tangent of a mechanism keeps its pattern for the whole run and is dominated by a positive definite mass
//! matrix bordered by constraints, so the pivot order can be chosen once: minimum degree, a multiplier only after the
//! coordinates of its constraint. The numeric work is then that of small dense blocks, whose products are subtracted at
//! precomputed places.
//! A pivot that turns out weak is reported; the caller falls back to a factorisation with row exchanges
//! ([`DenseLu`]) and counts it.

use super::copies::Copies;
use super::larger;
use super::minimum_degree::minimum_degree;
use faer::linalg::solvers::{PartialPivLu, Solve};

/// A multiplier that exceeds this loses so many digits that the factorisation is not used.
pub const LARGEST_MULTIPLIER: f64 = 1e9;

/// Structure of the matrix: pattern with fill, pivot order, positions of the entries in the value array.
///
/// Neighbouring pivots whose columns have the same pattern form a supernode: dense blocks that are eliminated together. The values
/// of a supernode with s pivots, to which r later unknowns are coupled, stand together: the s x s block of the pivots, row by row,
/// whose diagonal its inverse replaces; the r x s block of L below it, row by row; the s x r block of U right of it, column by
/// column. One more entry at the end of the array takes what is scattered to known coordinates and is never read.
#[derive(Debug)]
pub struct Symbolic {
    supernodes: Vec<Supernode>,
    /// Unknowns in the order of elimination.
    order: Vec<usize>,
    /// Place of each unknown in this order.
    position: Vec<usize>,
    /// Supernode of each place.
    supernode_of: Vec<usize>,
    /// Places of the unknowns that are coupled to a supernode and eliminated after it, ascending; supernode after supernode.
    structure: Vec<usize>,
    /// The same unknowns by their indices.
    coupled: Vec<usize>,
    /// [`LARGEST_MULTIPLIER`], for a diagonal that is not of order one larger.
    largest_multiplier: f64,
    /// For every (row, column) pair of a supernode's structure, row by row, where its value stands behind those of the supernode.
    targets: Vec<u32>,
    /// The copies of unknowns for which many rows wait.
    copies: Option<Box<Copies>>,
}

/// What elimination needs to know of one supernode.
#[derive(Debug)]
struct Supernode {
    /// Place of its first pivot.
    first: usize,
    /// Number of its pivots.
    size: usize,
    /// How many unknowns are coupled to it.
    count: usize,
    /// Start of its values.
    start: usize,
    /// Start of its unknowns in the structure.
    structure: usize,
    /// Start of its targets.
    targets: usize,
}

/// Most pivots of a supernode: kernels are compiled for every size.
const LARGEST_SUPERNODE: usize = 9;

/// Calls the kernel that is compiled for a number of pivots.
macro_rules! of_size {
    ($size:expr, $kernel:ident $(<$other:ident>)?($($argument:expr),*)) => {
        match $size {
            1 => $kernel::<1 $(, $other)?>($($argument),*),
            2 => $kernel::<2 $(, $other)?>($($argument),*),
            3 => $kernel::<3 $(, $other)?>($($argument),*),
            4 => $kernel::<4 $(, $other)?>($($argument),*),
            5 => $kernel::<5 $(, $other)?>($($argument),*),
            6 => $kernel::<6 $(, $other)?>($($argument),*),
            7 => $kernel::<7 $(, $other)?>($($argument),*),
            8 => $kernel::<8 $(, $other)?>($($argument),*),
            _ => $kernel::<LARGEST_SUPERNODE $(, $other)?>($($argument),*),
        }
    };
}

impl Supernode {
    /// End of its values.
    fn end(&self) -> usize {
        self.start + self.size * (self.size + 2 * self.count)
    }
}

/// A pivot too small to divide by, in the row and column of unknown `index`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct WeakPivot {
    /// Unknown whose pivot is weak.
    pub index: usize,
}

impl Symbolic {
    /// Analyses an n x n matrix whose pattern is the union of dense blocks on the index sets `cliques`, each with one row at most. Unknown
    /// i is eliminated after those in `after[i]`: a multiplier after all coordinates of its constraint, whose elimination
    /// leaves it the pivot -Phi_q M^-1 Phi_q^T.
    ///
    /// # Panics
    /// If an index is not below n, or the orders asked for contradict each other.
    pub fn analyse(n: usize, cliques: &[Vec<usize>], after: &[Vec<usize>]) -> Symbolic {
        let (mut cliques, mut after) = (cliques.to_vec(), after.to_vec());
        let copies = Copies::put(n, &mut cliques, &mut after).map(Box::new);
        let (order, coupled) = minimum_degree(after.len(), &cliques, &after);
        Symbolic {
            copies,
            ..Self::layout(order, &coupled)
        }
    }

    /// Collects the pivots in supernodes and gives every entry its place; `coupled` are the unknowns coupled to each pivot.
    fn layout(order: Vec<usize>, coupled: &[Vec<usize>]) -> Symbolic {
        let n = order.len();
        let (order, coupled) = depth_first(&order, coupled);
        let mut position = vec![0; n];
        for (k, &i) in order.iter().enumerate() {
            position[i] = k;
        }
        let places = |k: usize| {
            let mut places: Vec<usize> = coupled[k].iter().map(|&i| position[i]).collect();
            places.sort_unstable();
            places
        };
        let mut symbolic = Symbolic {
            supernodes: Vec::new(),
            supernode_of: Vec::with_capacity(n),
            structure: Vec::new(),
            coupled: Vec::new(),
            largest_multiplier: LARGEST_MULTIPLIER,
            targets: Vec::new(),
            position: Vec::new(),
            order: Vec::new(),
            copies: None,
        };
        let (mut first, mut start) = (0, 0);
        while first < n {
            let mut last = first;
            let mut structure = places(first);
            while last + 1 < n && last + 1 - first < LARGEST_SUPERNODE {
                let next = places(last + 1);
                if structure.first() != Some(&(last + 1)) || structure[1..] != next {
                    break;
                }
                last += 1;
                structure = next;
            }
            let node = Supernode {
                first,
                size: last + 1 - first,
                count: structure.len(),
                start,
                structure: symbolic.structure.len(),
                targets: 0,
            };
            start = node.end();
            let index = symbolic.supernodes.len();
            symbolic
                .supernode_of
                .extend(std::iter::repeat_n(index, node.size));
            symbolic.coupled.extend(structure.iter().map(|&p| order[p]));
            symbolic.structure.extend(structure);
            symbolic.supernodes.push(node);
            first = last + 1;
        }
        (symbolic.order, symbolic.position) = (order, position);
        for f in 0..symbolic.supernodes.len() {
            let places = symbolic.structure(f).to_vec();
            symbolic.supernodes[f].targets = symbolic.targets.len();
            let end = symbolic.supernodes[f].end();
            for &i in &places {
                for &j in &places {
                    let entry = symbolic.entry(i, j);
                    let entry = entry.expect("the pattern is closed under elimination");
                    symbolic.targets.push((entry - end) as u32);
                }
            }
        }
        symbolic
    }

    /// Places of the unknowns coupled to supernode `f`.
    fn structure(&self, f: usize) -> &[usize] {
        let Supernode {
            structure, count, ..
        } = self.supernodes[f];
        &self.structure[structure..structure + count]
    }

    /// Value index of the entry in rows and columns counted in pivot order.
    fn entry(&self, i: usize, j: usize) -> Option<usize> {
        let f = self.supernode_of[i.min(j)];
        let node = &self.supernodes[f];
        let Supernode {
            first, size, start, ..
        } = *node;
        let local = |place: usize| match place - first {
            own if own < size => Some(own),
            _ => Some(size + self.structure(f).binary_search(&place).ok()?),
        };
        let (row, column) = (local(i)?, local(j)?);
        Some(
            start
                + match (row < size, column < size) {
                    // rows of the pivots, then rows of L
                    (_, true) => row * size + column,
                    // columns of U
                    (true, false) => (node.count + column) * size + row,
                    (false, false) => return None,
                },
        )
    }

    /// Value index of an entry of the pattern.
    fn place(&self, row: usize, column: usize) -> usize {
        self.entry(self.position[row], self.position[column])
            .expect("the entry belongs to a clique")
    }

    /// What a copy or what ties it stands for.
    fn original(&self, i: usize) -> usize {
        self.copies.as_ref().map_or(i, |copies| copies.original(i))
    }

    /// Number of unknowns.
    pub fn n(&self) -> usize {
        self.order.len() - self.copies.as_ref().map_or(0, |copies| copies.len())
    }

    /// Length of the value array, the discarded last entry included.
    pub fn len(&self) -> usize {
        self.discarded_slot() as usize + 1
    }

    /// True for a matrix without unknowns.
    pub fn is_empty(&self) -> bool {
        self.n() == 0
    }

    /// Index of the value that takes what is scattered to known coordinates.
    pub fn discarded_slot(&self) -> u32 {
        self.supernodes.last().map_or(0, Supernode::end) as u32
    }

    /// Value index of entry (row, column), or of the discarded entry where one of them is not an unknown (index >= n).
    ///
    /// # Panics
    /// If the entry is not in the pattern.
    pub fn slot(&self, row: usize, column: usize) -> u32 {
        if row >= self.n() || column >= self.n() {
            return self.discarded_slot();
        }
        let [row, column] = match &self.copies {
            Some(copies) => copies.entry(row, column),
            None => [row, column],
        };
        self.place(row, column) as u32
    }

    /// A matrix with these entries, each a row, a column and a value.
    pub fn filled(&self, entries: impl IntoIterator<Item = (usize, usize, f64)>) -> Vec<f64> {
        let mut values = vec![0.0; self.len()];
        for (i, j, value) in entries {
            values[self.slot(i, j) as usize] += value;
        }
        values
    }

    /// Says how large the diagonal m is beside rows of order one, such as masses beside constraints. The multipliers of these rows are
    /// 1/m, and those behind their pivots, -1/m, are m: neither loses digits.
    pub fn expect_diagonal(&mut self, m: f64) {
        self.largest_multiplier = LARGEST_MULTIPLIER * m.max(1.0 / m);
    }

    /// The limit of multipliers beyond which a pivot is weak.
    pub fn largest_multiplier(&self) -> f64 {
        self.largest_multiplier
    }

    /// Factorises in place: A = L U.
    ///
    /// # Errors
    /// The first pivot that is zero, not finite, or much smaller than its column.
    pub fn factor(&self, values: &mut [f64]) -> Result<(), WeakPivot> {
        self.factor_within(values, self.largest_multiplier)
    }

    /// As [`Symbolic::factor`] of a matrix whose entries are alike in size, with a limit of multipliers of its own.
    ///
    /// # Errors
    /// As [`Symbolic::factor`].
    pub fn factor_within(&self, values: &mut [f64], limit: f64) -> Result<(), WeakPivot> {
        assert_eq!(values.len(), self.len());
        if let Some(copies) = &self.copies {
            copies.tie(values, |i, j| self.place(i, j));
        }
        for node in &self.supernodes {
            let (here, behind) = values.split_at_mut(node.end());
            let here = &mut here[node.start..];
            let targets = &self.targets[node.targets..][..node.count * node.count];
            let weak = of_size!(node.size, eliminate(here, behind, targets, limit));
            if let Err(pivot) = weak {
                let index = self.original(self.order[node.first + pivot]);
                return Err(WeakPivot { index });
            }
        }
        Ok(())
    }

    /// Multiply-subtracts of a factorisation.
    pub fn operations(&self) -> usize {
        let nodes = self.supernodes.iter();
        nodes.map(|f| f.size * (f.size + f.count).pow(2)).sum()
    }

    /// Multiply-subtracts of a solve.
    pub fn operations_of_solve(&self) -> usize {
        self.len()
    }

    /// Index of the value of a pivot.
    fn diagonal(&self, unknown: usize) -> usize {
        let place = self.position[unknown];
        let node = &self.supernodes[self.supernode_of[place]];
        node.start + (place - node.first) * (node.size + 1)
    }

    /// The pivot of an unknown in the factors of [`Symbolic::factor`].
    pub fn pivot(&self, values: &[f64], unknown: usize) -> f64 {
        1.0 / values[self.diagonal(unknown)]
    }

    /// The smallest squared sine of a row that ties copies of an unknown to the rows eliminated before it; one where there is none.
    pub fn smallest_tie(&self, values: &[f64]) -> f64 {
        let ties = self.copies.iter().flat_map(|copies| copies.rows());
        let sines = ties.map(|row| -self.pivot(values, row));
        sines.fold(1.0, f64::min)
    }

    /// Smallest over largest pivot of the unknowns from `first` on, in the factors of [`Symbolic::factor`]; the squared sine of a tie,
    /// where that is smaller.
    pub fn pivot_range(&self, values: &[f64], first: usize) -> f64 {
        let inverses = (first..self.n()).map(|i| values[self.diagonal(i)].abs());
        let (low, high) = inverses.fold((f64::INFINITY, 0.0_f64), |(l, h), p| (l.min(p), h.max(p)));
        (low / high).min(self.smallest_tie(values))
    }

    /// Solves L U x = b with the factors of [`Symbolic::factor`]; `b` in, x out.
    pub fn solve(&self, values: &[f64], b: &mut [f64]) {
        let (b, _) = b.as_chunks_mut::<1>();
        self.solve_all(values, b);
    }

    /// The same for R right sides, of which `b` has one entry each for every unknown.
    pub fn solve_all<const R: usize>(&self, values: &[f64], b: &mut [[f64; R]]) {
        if self.copies.is_none() {
            return self.substitute(values, b);
        }
        let mut all = b.to_vec();
        all.resize(self.order.len(), [0.0; R]);
        self.substitute(values, &mut all);
        b.copy_from_slice(&all[..b.len()]);
    }

    /// The same, with room for the copies in b.
    fn substitute<const R: usize>(&self, values: &[f64], b: &mut [[f64; R]]) {
        for node in &self.supernodes {
            let (own, coupled, values) = self.parts(node, values);
            of_size!(node.size, forward<R>(own, coupled, values, b))
        }
        for node in self.supernodes.iter().rev() {
            let (own, coupled, values) = self.parts(node, values);
            of_size!(node.size, backward<R>(own, coupled, values, b))
        }
    }

    /// The pivots of a supernode, the unknowns coupled to it, and its values.
    #[inline]
    fn parts<'a>(
        &'a self,
        f: &Supernode,
        values: &'a [f64],
    ) -> (&'a [usize], &'a [usize], &'a [f64]) {
        (
            &self.order[f.first..f.first + f.size],
            &self.coupled[f.structure..f.structure + f.count],
            &values[f.start..f.end()],
        )
    }

    /// The matrix in full, before it is factorised.
    pub fn to_dense(&self, values: &[f64]) -> faer::Mat<f64> {
        let mut dense = faer::Mat::zeros(self.n(), self.n());
        self.for_each_entry(values, |i, j, value| dense[(i, j)] += value);
        dense
    }

    /// Visits every entry of the pattern before it is factorised: row, column, value. An entry of copies is visited in parts.
    pub fn for_each_entry(&self, values: &[f64], mut see: impl FnMut(usize, usize, f64)) {
        for (f, node) in self.supernodes.iter().enumerate() {
            let own = node.first..node.first + node.size;
            for i in own.clone() {
                for j in own.clone().chain(self.structure(f).iter().copied()) {
                    // a diagonal entry, and one of two pivots of the supernode, come once
                    let pairs = [(i, j), (j, i)];
                    let once = match own.contains(&j) {
                        true => 1,
                        false => 2,
                    };
                    for &(i, j) in &pairs[..once] {
                        let value = self.entry(i, j).map_or(0.0, |entry| values[entry]);
                        let [row, column] = [i, j].map(|i| self.original(self.order[i]));
                        see(row, column, value);
                    }
                }
            }
        }
    }
}

/// The same elimination with every pivot behind those that it waits for, as late as possible: pivots of one part of the matrix
/// follow each other. Pivots and the unknowns coupled to them in, the same out.
fn depth_first(order: &[usize], coupled: &[Vec<usize>]) -> (Vec<usize>, Vec<Vec<usize>>) {
    let n = order.len();
    let mut position = vec![0; n];
    for (k, &i) in order.iter().enumerate() {
        position[i] = k;
    }
    let parent = |k: usize| coupled[k].iter().map(|&i| position[i]).min();
    let mut children = vec![Vec::new(); n];
    let mut pending = Vec::new();
    for k in (0..n).rev() {
        match parent(k) {
            Some(parent) => children[parent].push(k),
            None => pending.push(k),
        }
    }
    // a pivot is visited twice: first its children are put before it, then it follows them
    let mut visited = vec![false; n];
    let mut sorted = Vec::with_capacity(n);
    while let Some(&k) = pending.last() {
        if std::mem::replace(&mut visited[k], true) {
            pending.pop();
            sorted.push(k);
        } else {
            pending.append(&mut children[k]);
        }
    }
    (
        sorted.iter().map(|&k| order[k]).collect(),
        sorted.iter().map(|&k| coupled[k].clone()).collect(),
    )
}

/// The blocks of a supernode with S pivots: of the pivots, of L row by row, of U column by column.
struct SupernodeBlocks<'a, const S: usize> {
    pivots: &'a [[f64; S]; S],
    lower: &'a [[f64; S]],
    upper: &'a [[f64; S]],
}

#[inline(always)]
fn blocks<const S: usize>(values: &[f64]) -> SupernodeBlocks<'_, S> {
    let (rows, _) = values.as_chunks::<S>();
    let (pivots, rest) = rows.split_first_chunk().expect("a supernode has S pivots");
    let (lower, upper) = rest.split_at(rest.len() / 2);
    SupernodeBlocks {
        pivots,
        lower,
        upper,
    }
}

/// Eliminates the pivots of a supernode; the error is the number of a weak one.
#[inline]
fn eliminate<const S: usize>(
    here: &mut [f64],
    behind: &mut [f64],
    targets: &[u32],
    limit: f64,
) -> Result<(), usize> {
    let (rows, _) = here.as_chunks_mut::<S>();
    let (pivots, rest) = rows
        .split_first_chunk_mut::<S>()
        .expect("a supernode has S pivots");
    let mut largest = [0.0_f64; S];
    for k in 0..S {
        let inverse = 1.0 / pivots[k][k];
        pivots[k][k] = inverse;
        for i in k + 1..S {
            let l = pivots[i][k] * inverse;
            pivots[i][k] = l;
            largest[k] = larger(largest[k], l);
            for j in k + 1..S {
                pivots[i][j] -= l * pivots[k][j];
            }
        }
    }
    let (lower, upper) = rest.split_at_mut(rest.len() / 2);
    for row in lower.iter_mut() {
        for k in 0..S {
            for m in 0..k {
                row[k] -= row[m] * pivots[m][k];
            }
            row[k] *= pivots[k][k];
            largest[k] = larger(largest[k], row[k]);
        }
    }
    for k in 0..S {
        if !pivots[k][k].is_finite() || largest[k].is_nan() || largest[k] > limit {
            return Err(k);
        }
    }
    for column in upper.iter_mut() {
        for k in 1..S {
            for m in 0..k {
                column[k] -= pivots[k][m] * column[m];
            }
        }
    }
    if lower.is_empty() {
        return Ok(());
    }
    for (row, targets) in lower.iter().zip(targets.chunks_exact(lower.len())) {
        for (column, &target) in upper.iter().zip(targets) {
            behind[target as usize] -= dot(row, column);
        }
    }
    Ok(())
}

#[inline]
fn dot<const S: usize>(x: &[f64; S], y: &[f64; S]) -> f64 {
    let mut sum = x[0] * y[0];
    for k in 1..S {
        sum += x[k] * y[k];
    }
    sum
}

/// L x = b for the pivots of a supernode; subtracts from b what they contribute to later rows.
#[inline]
fn forward<const S: usize, const R: usize>(
    own: &[usize],
    coupled: &[usize],
    values: &[f64],
    b: &mut [[f64; R]],
) {
    let SupernodeBlocks { pivots, lower, .. } = blocks::<S>(values);
    let own: &[usize; S] = own.try_into().expect("a supernode has S pivots");
    let mut x = own.map(|i| b[i]);
    for k in 0..S {
        for m in 0..k {
            for r in 0..R {
                x[k][r] -= pivots[k][m] * x[m][r];
            }
        }
        b[own[k]] = x[k];
    }
    for (&row, l) in coupled.iter().zip(lower) {
        for r in 0..R {
            b[row][r] -= dot(l, &x.map(|x| x[r]));
        }
    }
}

/// U x = b for the pivots of a supernode, with the later unknowns known.
#[inline]
fn backward<const S: usize, const R: usize>(
    own: &[usize],
    coupled: &[usize],
    values: &[f64],
    b: &mut [[f64; R]],
) {
    let SupernodeBlocks { pivots, upper, .. } = blocks::<S>(values);
    let own: &[usize; S] = own.try_into().expect("a supernode has S pivots");
    let mut x = own.map(|i| b[i]);
    for (&column, u) in coupled.iter().zip(upper) {
        let known = b[column];
        for k in 0..S {
            for r in 0..R {
                x[k][r] -= u[k] * known[r];
            }
        }
    }
    for k in (0..S).rev() {
        for m in k + 1..S {
            for r in 0..R {
                x[k][r] -= pivots[k][m] * x[m][r];
            }
        }
        for r in 0..R {
            x[k][r] *= pivots[k][k];
        }
        b[own[k]] = x[k];
    }
}

/// Passes of equilibration: each takes the square root of how far rows are from a largest entry of one.
const EQUILIBRATIONS: usize = 6;

/// Dense LU with row exchanges, for the rare matrix that the fixed order cannot take. It allocates.
///
/// Rows and columns are scaled alike until their largest entries are near one (Ruiz 2001, RAL-TR-2001-034), so that a
/// stiffness of 1e10 N/m beside a constraint of order one does not look singular.
#[derive(Debug, Clone)]
pub struct DenseLu {
    factors: PartialPivLu<f64>,
    scale: Vec<f64>,
}

impl DenseLu {
    /// Factorises a matrix; `None` when it is singular to rounding.
    pub fn factor(mut matrix: faer::Mat<f64>) -> Option<DenseLu> {
        let n = matrix.nrows();
        let mut scale = vec![1.0; n];
        for _ in 0..EQUILIBRATIONS {
            let size = |i: usize| (0..n).fold(0.0_f64, |m, j| m.max(matrix[(i, j)].abs()));
            let by: Vec<f64> = (0..n).map(|i| 1.0 / size(i).sqrt()).collect();
            if by.iter().any(|x| !x.is_finite()) {
                return None;
            }
            for i in 0..n {
                for j in 0..n {
                    matrix[(i, j)] *= by[i] * by[j];
                }
                scale[i] *= by[i];
            }
        }
        let factors = matrix.partial_piv_lu();
        let upper = factors.U();
        let diagonal = (0..n).map(|i| upper[(i, i)].abs());
        let (smallest, largest) =
            diagonal.fold((f64::INFINITY, 0.0_f64), |(s, l), d| (s.min(d), l.max(d)));
        // a pivot below the rounding of the largest one carries no digit
        (largest.is_finite() && smallest > f64::EPSILON * largest)
            .then_some(DenseLu { factors, scale })
    }

    /// Solves for `b` in place.
    pub fn solve(&self, b: &mut [f64]) {
        b.iter_mut().zip(&self.scale).for_each(|(b, s)| *b *= s);
        self.factors.solve_in_place(faer::ColMut::from_slice_mut(b));
        b.iter_mut().zip(&self.scale).for_each(|(b, s)| *b *= s);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two masses, each of two coordinates, tied to each other by one constraint and the first to ground by another.
    fn bordered() -> (Symbolic, Vec<f64>) {
        let cliques = vec![vec![0, 1], vec![2, 3], vec![0, 1, 2, 3, 4], vec![0, 1, 5]];
        let mut after = vec![Vec::new(); 6];
        after[4] = vec![0, 1, 2, 3];
        after[5] = vec![0, 1];
        let symbolic = Symbolic::analyse(6, &cliques, &after);
        let mut values = vec![0.0; symbolic.len()];
        let mut set = |i: usize, j: usize, x: f64| values[symbolic.slot(i, j) as usize] = x;
        for (i, m) in [2.0, 3.0, 1.0, 1.5].into_iter().enumerate() {
            set(i, i, m);
        }
        set(0, 1, 0.3);
        set(1, 0, -0.2);
        for (i, g) in [0.0, 1.0, 0.4, -1.0].into_iter().enumerate() {
            set(i, 4, g);
            set(4, i, g);
        }
        for (i, g) in [0.7, 0.1].into_iter().enumerate() {
            set(i, 5, g);
            set(5, i, g);
        }
        (symbolic, values)
    }

    #[test]
    fn agrees_with_dense_elimination() {
        let (symbolic, mut values) = bordered();
        let dense = DenseLu::factor(symbolic.to_dense(&values)).unwrap();
        let b = [1.0, -2.0, 0.5, 3.0, 0.25, -1.0];
        let (mut x, mut y) = (b, b);
        symbolic.factor(&mut values).unwrap();
        symbolic.solve(&values, &mut x);
        dense.solve(&mut y);
        let mut pairs = b.map(|b| [b, -2.0 * b]);
        symbolic.solve_all(&values, &mut pairs);
        // multiplication by two is exact
        assert_eq!(pairs, x.map(|x| [x, -2.0 * x]));
        for i in 0..6 {
            // both are backward stable here: a few roundings of numbers near one
            assert!((x[i] - y[i]).abs() < 1e-14, "{x:?} {y:?}");
        }
    }

    #[test]
    fn a_singular_matrix_is_refused_by_both() {
        let (symbolic, mut values) = bordered();
        for i in 0..2 {
            values[symbolic.slot(i, 5) as usize] = 0.0;
            values[symbolic.slot(5, i) as usize] = 0.0;
        }
        assert!(DenseLu::factor(symbolic.to_dense(&values)).is_none());
        assert_eq!(symbolic.factor(&mut values), Err(WeakPivot { index: 5 }));
    }

    #[test]
    fn what_is_scattered_to_known_coordinates_is_not_read() {
        let (symbolic, mut values) = bordered();
        assert_eq!(symbolic.slot(0, 17), symbolic.discarded_slot());
        values[symbolic.discarded_slot() as usize] = f64::NAN;
        assert!(symbolic.factor(&mut values).is_ok());
    }
}

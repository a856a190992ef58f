//! Unknowns for which many rows wait, as several copies: the stretching of dense columns (Grcar 1990, Matrix Stretching for Linear
//! Equations, Sandia report SAND90-8723).
//!
//! A row is eliminated after its unknowns, so an unknown couples all rows that wait for it: those of a body with m joints would cost
//! m^3. Such an unknown x is replaced by copies x_0, x_1, ..., each with a few of its rows. A row b (x_k - x_(k-1)) = 0 ties every
//! copy to the one before it, and a (x_k - x_(k-1))^2/2, which vanishes with it, gives every copy a pivot. The solution is the same.

use std::collections::HashMap;

/// With more rows an unknown has copies. As many rows cost a fraction of a millisecond.
const CROWD: usize = 64;
/// Neighbouring rows that share copies: they cost about as much as what ties the copies of the three coordinates of a body.
const GROUP: usize = 16;

/// The copies in a matrix of n unknowns and rows. They stand behind these, each followed by the row that ties it.
#[derive(Debug)]
pub struct Copies {
    n: usize,
    ties: Vec<Tie>,
    /// Where the entry of a pair stands of which one has copies.
    pairs: HashMap<[usize; 2], [usize; 2]>,
}

/// What ties a copy to the one before it.
#[derive(Debug)]
struct Tie {
    /// The unknown, which is the first copy.
    unknown: usize,
    before: usize,
    /// The first row of the copy.
    row: usize,
    /// Number of the copies of the unknown.
    count: f64,
}

impl Copies {
    /// Puts copies into the pattern of a matrix of n unknowns and rows that is the union of dense blocks on `cliques`, each with one row
    /// at most, where i is eliminated after those in `after[i]`. None where no unknown needs copies.
    pub fn put(
        n: usize,
        cliques: &mut Vec<Vec<usize>>,
        after: &mut Vec<Vec<usize>>,
    ) -> Option<Copies> {
        let mut waiting = vec![0; n];
        after.iter().flatten().for_each(|&i| waiting[i] += 1);
        let is_crowded = |i: usize| i < n && waiting[i] > CROWD;
        let waits_in_crowd: Vec<bool> = after
            .iter()
            .map(|own| own.iter().any(|&i| is_crowded(i)))
            .collect();
        let mut copies = Copies {
            n,
            ties: Vec::new(),
            pairs: HashMap::new(),
        };
        // the last copy of every unknown, the group of its rows, and the number of copies
        let mut last: HashMap<usize, (usize, usize, f64)> = HashMap::new();
        let rows = (0..n).filter(|&row| waits_in_crowd[row]);
        for (k, row) in rows.enumerate() {
            let group = k / GROUP;
            for i in after[row].iter_mut().filter(|i| is_crowded(**i)) {
                let (copy, its_group, count) = last.entry(*i).or_insert((*i, group, 1.0));
                if *its_group != group {
                    copies.ties.push(Tie {
                        unknown: *i,
                        before: *copy,
                        row,
                        count: 0.0,
                    });
                    (*copy, *its_group, *count) = (n + copies.len() - 2, group, *count + 1.0);
                }
                copies.pairs.insert([row, *i], [row, *copy]);
                copies.pairs.insert([*i, row], [*copy, row]);
                *i = *copy;
            }
        }
        for clique in cliques.iter_mut() {
            let own = clique.clone();
            if let Some(&row) = own.iter().find(|&&i| waits_in_crowd[i]) {
                for i in clique.iter_mut() {
                    *i = copies.entry(row, *i)[1];
                }
            }
            for (&i, &a) in own.iter().zip(&*clique) {
                for (&j, &b) in own.iter().zip(&*clique) {
                    if i != j && (is_crowded(i) || is_crowded(j)) {
                        copies.pairs.entry([i, j]).or_insert([a, b]);
                    }
                }
            }
        }
        for (k, tie) in copies.ties.iter_mut().enumerate() {
            tie.count = last[&tie.unknown].2;
            let [copy, row] = places(n, k);
            after.extend([vec![], vec![tie.before, copy]]);
            cliques.push(vec![tie.before, copy, row]);
        }
        (!copies.ties.is_empty()).then_some(copies)
    }

    /// Where the entry of a row and a column stands.
    pub fn entry(&self, row: usize, column: usize) -> [usize; 2] {
        let pair = [row, column];
        self.pairs.get(&pair).copied().unwrap_or(pair)
    }

    /// Number of what stands behind the unknowns and rows.
    pub fn len(&self) -> usize {
        2 * self.ties.len()
    }

    /// The rows that tie copies.
    pub fn rows(&self) -> impl Iterator<Item = usize> {
        (0..self.ties.len()).map(|k| places(self.n, k)[1])
    }

    /// What an index stands for: an unknown for its copies, and for the row that ties a copy the first row that waits for this copy.
    pub fn original(&self, i: usize) -> usize {
        match i.checked_sub(self.n) {
            None => i,
            Some(behind) if behind % 2 == 0 => self.ties[behind / 2].unknown,
            Some(behind) => self.ties[behind / 2].row,
        }
    }

    /// Puts the ties into the values of a matrix, where `place` says where an entry stands. With a as large as the diagonal of the unknown
    /// times the number of its copies, the chain of all copies is as stiff as the unknown. With b^2 = a the pivot of the row is the
    /// squared sine of its angle to the rows eliminated before it.
    pub fn tie(&self, values: &mut [f64], place: impl Fn(usize, usize) -> usize) {
        // backwards: the first tie of an unknown changes the diagonal that all of them take
        for (k, tie) in self.ties.iter().enumerate().rev() {
            let a = match values[place(tie.unknown, tie.unknown)].abs() {
                0.0 => 1.0,
                diagonal => diagonal * tie.count,
            };
            let [copy, row] = places(self.n, k);
            let ends = [(copy, 1.0), (tie.before, -1.0)];
            for (i, sign) in ends {
                for (j, other) in ends {
                    values[place(i, j)] += sign * other * a;
                }
                values[place(row, i)] = sign * a.sqrt();
                values[place(i, row)] = sign * a.sqrt();
            }
        }
    }
}

/// The copy that tie k ties, and the row of the tie, behind n unknowns and rows.
fn places(n: usize, k: usize) -> [usize; 2] {
    [n + 2 * k, n + 2 * k + 1]
}

#[cfg(test)]
mod tests {
    use super::super::lu::{DenseLu, Symbolic};
    use super::CROWD;
    use crate::math::generic;

    /// A body of three coupled coordinates to which masses are tied, each of one coordinate by one row.
    fn body(masses: usize) -> (Symbolic, Vec<f64>) {
        let n = 3 + 2 * masses;
        let mut cliques = vec![vec![0, 1, 2]];
        let mut after = vec![Vec::new(); n];
        for mass in 3..3 + masses {
            let row = mass + masses;
            after[row] = vec![0, 1, 2, mass];
            cliques.push(vec![0, 1, 2, mass, row]);
        }
        let symbolic = Symbolic::analyse(n, &cliques, &after);
        let mut entries: Vec<(usize, usize, f64)> =
            (0..3 + masses).map(|i| (i, i, 2.0 + generic(i))).collect();
        entries.extend([(0, 1, 0.3), (1, 0, -0.2)]);
        for mass in 3..3 + masses {
            let row = mass + masses;
            for (k, i) in [0, 1, 2, mass].into_iter().enumerate() {
                let g = generic(4 * mass + k);
                entries.extend([(row, i, g), (i, row, g), (mass, i, 0.1 * g)]);
            }
        }
        let values = symbolic.filled(entries);
        (symbolic, values)
    }

    #[test]
    fn a_matrix_with_copies_has_the_solution_of_the_whole_one() {
        let (symbolic, mut values) = body(3 * CROWD);
        let n = symbolic.n();
        assert_eq!(n, 3 + 6 * CROWD);
        let dense = DenseLu::factor(symbolic.to_dense(&values)).unwrap();
        let b: Vec<f64> = (n..2 * n).map(generic).collect();
        let (mut x, mut y) = (b.clone(), b);
        dense.solve(&mut y);
        let mut pairs: Vec<[f64; 2]> = x.iter().map(|x| [*x, -2.0 * x]).collect();
        symbolic.factor(&mut values).unwrap();
        symbolic.solve(&values, &mut x);
        symbolic.solve_all(&values, &mut pairs);
        let size = y.iter().fold(1.0_f64, |m, y| m.max(y.abs()));
        for ((x, y), pair) in x.iter().zip(&y).zip(pairs) {
            // multiplication by two is exact
            assert_eq!(pair, [*x, -2.0 * x]);
            // roundings, some thousand times for the condition of the matrix
            assert!((x - y).abs() < 1e-12 * size, "{x} {y}");
        }
    }

    #[test]
    fn a_body_with_four_times_the_joints_takes_four_times_the_operations() {
        let [few, many] = [10, 40].map(|crowds| body(crowds * CROWD).0.operations());
        // a part is proportional, with some more fill in the larger one
        assert!(many < 5 * few, "{few} {many}");
    }
}

//! The inverse of a constant mass matrix: block by block where few coordinates are coupled, as those of rigid bodies and of links
//! of one element are, otherwise by its factors.

use super::lu::Symbolic;

/// The largest block whose inverse is formed.
const LARGEST: usize = 4;

/// A factorised mass matrix.
#[derive(Debug)]
pub struct MassFactors {
    symbolic: Symbolic,
    values: Vec<f64>,
}

impl MassFactors {
    /// Of the entries (row, column, mass); `None` if a pivot is weak.
    pub fn new(
        n: usize,
        entries: impl Iterator<Item = (usize, usize, f64)> + Clone,
    ) -> Option<MassFactors> {
        let cliques: Vec<Vec<usize>> = entries.clone().map(|(i, j, _)| vec![i, j]).collect();
        let symbolic = Symbolic::analyse(n, &cliques, &vec![Vec::new(); n]);
        let mut values = symbolic.filled(entries);
        symbolic.factor(&mut values).ok()?;
        Some(MassFactors { symbolic, values })
    }

    /// Solves M x = b; `b` in, x out.
    pub fn solve(&self, b: &mut [f64]) {
        self.symbolic.solve(&self.values, b);
    }

    /// A column of the inverse.
    pub fn inverse_column(&self, column: usize) -> Vec<f64> {
        let mut values = vec![0.0; self.symbolic.n()];
        values[column] = 1.0;
        self.solve(&mut values);
        values
    }
}

/// Blocks of S unknowns: which they are, and the columns of the inverse.
#[derive(Debug, Default)]
struct Blocks<const S: usize>(Vec<([u32; S], [[f64; S]; S])>);

impl<const S: usize> Blocks<S> {
    fn add(&mut self, unknowns: &[usize], factors: &MassFactors) {
        let columns = std::array::from_fn(|k| {
            let column = factors.inverse_column(k);
            std::array::from_fn(|row| column[row])
        });
        let unknowns = std::array::from_fn(|k| unknowns[k] as u32);
        self.0.push((unknowns, columns));
    }

    #[inline]
    fn solve(&self, b: &mut [f64]) {
        for (unknowns, columns) in &self.0 {
            let right = unknowns.map(|i| b[i as usize]);
            let mut x = [0.0; S];
            for (column, value) in columns.iter().zip(right) {
                for (x, c) in x.iter_mut().zip(column) {
                    *x += c * value;
                }
            }
            for (i, x) in unknowns.iter().zip(x) {
                b[*i as usize] = x;
            }
        }
    }
}

/// Solves with a mass matrix.
#[derive(Debug)]
pub enum MassInverse {
    /// By the inverses of its blocks.
    Blocks(Box<BlockInverses>),
    /// By its factors.
    Factors(MassFactors),
}

/// The inverses of the blocks, by size.
#[derive(Debug, Default)]
pub struct BlockInverses {
    ones: Blocks<1>,
    twos: Blocks<2>,
    threes: Blocks<3>,
    fours: Blocks<4>,
}

impl MassInverse {
    /// Of a matrix with its coupled unknowns and the factors of each such block; `whole` makes those of the matrix, where a block
    /// is too large.
    pub fn new<'a>(
        whole: impl FnOnce() -> Option<MassFactors>,
        blocks: impl Iterator<Item = (&'a [usize], &'a MassFactors)>,
    ) -> Option<MassInverse> {
        let mut inverses = BlockInverses::default();
        for (unknowns, factors) in blocks {
            match unknowns.len() {
                1 => inverses.ones.add(unknowns, factors),
                2 => inverses.twos.add(unknowns, factors),
                3 => inverses.threes.add(unknowns, factors),
                LARGEST => inverses.fours.add(unknowns, factors),
                _ => return whole().map(MassInverse::Factors),
            }
        }
        Some(MassInverse::Blocks(Box::new(inverses)))
    }

    /// Solves M x = b; `b` in, x out.
    pub fn solve(&self, b: &mut [f64]) {
        match self {
            MassInverse::Blocks(blocks) => {
                blocks.ones.solve(b);
                blocks.twos.solve(b);
                blocks.threes.solve(b);
                blocks.fours.solve(b);
            }
            MassInverse::Factors(factors) => factors.solve(b),
        }
    }

    /// Multiply-adds of a solve.
    pub fn operations(&self) -> usize {
        match self {
            MassInverse::Blocks(blocks) => {
                let BlockInverses {
                    ones,
                    twos,
                    threes,
                    fours,
                } = &**blocks;
                ones.0.len() + 4 * twos.0.len() + 9 * threes.0.len() + 16 * fours.0.len()
            }
            MassInverse::Factors(factors) => factors.symbolic.operations_of_solve(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{MassFactors, MassInverse};

    /// Blocks of sizes 1 to 4 whose unknowns are interleaved.
    #[test]
    fn blocks_and_factors_solve_alike() {
        let blocks = [vec![5], vec![0, 7], vec![2, 4, 9], vec![1, 3, 6, 8]];
        let mass = |i: usize, j: usize| match i == j {
            true => 3.0 + i as f64,
            false => 0.3 * (1 + (i * j) % 3) as f64,
        };
        let entries = |block: &[usize]| -> Vec<(usize, usize, f64)> {
            let pairs = block
                .iter()
                .flat_map(|&i| block.iter().map(move |&j| (i, j)));
            pairs.map(|(i, j)| (i, j, mass(i, j))).collect()
        };
        let all: Vec<_> = blocks.iter().flat_map(|block| entries(block)).collect();
        let whole = || MassFactors::new(10, all.iter().copied());
        let own: Vec<MassFactors> = blocks
            .iter()
            .map(|block| {
                let place = |i| block.iter().position(|own| *own == i).unwrap();
                let local = entries(block).into_iter();
                let local: Vec<_> = local.map(|(i, j, m)| (place(i), place(j), m)).collect();
                MassFactors::new(block.len(), local.into_iter()).unwrap()
            })
            .collect();
        let inverse = MassInverse::new(whole, blocks.iter().map(Vec::as_slice).zip(&own)).unwrap();
        assert!(matches!(inverse, MassInverse::Blocks(_)));
        assert_eq!(inverse.operations(), 30);
        let right: Vec<f64> = (0..10).map(|i| 1.0 - 0.3 * f64::from(i)).collect();
        let mut x = right.clone();
        inverse.solve(&mut x);
        for i in 0..10 {
            let product: f64 = all.iter().filter(|e| e.0 == i).map(|e| e.2 * x[e.1]).sum();
            // a few roundings of numbers up to 10, times a condition number below 10
            let bound = 400.0 * f64::EPSILON;
            assert!((product - right[i]).abs() < bound, "{i}: {product}");
        }
        let five: Vec<usize> = (0..5).collect();
        let large = MassFactors::new(5, (0..5).map(|i| (i, i, 1.0))).unwrap();
        let inverse = MassInverse::new(whole, [(&five[..], &large)].into_iter()).unwrap();
        assert!(matches!(inverse, MassInverse::Factors(_)));
    }
}

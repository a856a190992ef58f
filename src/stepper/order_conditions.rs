//! The order conditions of Runge-Kutta methods by rooted trees (Hairer, Nørsett & Wanner 1993, Solving Ordinary Differential
//! Equations I, II.2), with which the tests check coefficients.

/// The principal error of the solution over that of the embedded one, in Dormand and Prince's pair of orders 5 and 4.
pub const DORMAND_PRINCE: f64 = 0.337;

/// A rooted tree: the trees on its root.
#[derive(Debug, Clone, PartialEq)]
struct RootedTree(Vec<RootedTree>);

impl RootedTree {
    /// All trees of each number of nodes, up to the largest.
    fn all(largest: usize) -> Vec<Vec<RootedTree>> {
        let mut trees: Vec<Vec<RootedTree>> = vec![Vec::new()];
        for nodes in 1..=largest {
            let mut of_size = Vec::new();
            let last = (nodes, usize::MAX);
            RootedTree::with(&mut Vec::new(), nodes - 1, last, &trees, &mut of_size);
            trees.push(of_size);
        }
        trees
    }

    /// Adds the trees that have the `chosen` trees on their root and others of `nodes` nodes together. None of these comes after
    /// the `last` one in the order of size and place in the list of their size.
    fn with(
        chosen: &mut Vec<RootedTree>,
        nodes: usize,
        last: (usize, usize),
        smaller: &[Vec<RootedTree>],
        trees: &mut Vec<RootedTree>,
    ) {
        if nodes == 0 {
            trees.push(RootedTree(chosen.clone()));
        }
        for size in 1..=last.0.min(nodes) {
            let places = match size == last.0 {
                true => smaller[size].len().min(last.1.saturating_add(1)),
                false => smaller[size].len(),
            };
            for place in 0..places {
                chosen.push(smaller[size][place].clone());
                RootedTree::with(chosen, nodes - size, (size, place), smaller, trees);
                chosen.pop();
            }
        }
    }

    fn size(&self) -> usize {
        1 + self.0.iter().map(RootedTree::size).sum::<usize>()
    }

    /// The density: its inverse is the value of the order condition.
    fn density(&self) -> f64 {
        self.0.iter().map(RootedTree::density).product::<f64>() * self.size() as f64
    }

    /// The number of its symmetries.
    fn symmetry(&self) -> f64 {
        let own = self.0.iter().enumerate().map(|(i, tree)| {
            let equal = self.0[..=i].iter().filter(|other| *other == tree);
            tree.symmetry() * equal.count() as f64
        });
        own.product()
    }

    /// The elementary weights of all stages.
    fn of_stages(&self, method: &RungeKutta) -> Vec<f64> {
        let mut weights = vec![1.0; method.0.len()];
        for tree in &self.0 {
            let factors = method.times(&tree.of_stages(method));
            weights.iter_mut().zip(factors).for_each(|(w, x)| *w *= x);
        }
        weights
    }
}

/// The rows of a_ij of all stages; a row ends with its last entry that is not zero.
#[derive(Debug)]
pub struct RungeKutta(pub Vec<Vec<f64>>);

impl RungeKutta {
    /// A x.
    pub fn times(&self, x: &[f64]) -> Vec<f64> {
        let product = |row: &Vec<f64>| row.iter().zip(x).map(|(a, x)| a * x).sum();
        self.0.iter().map(product).collect()
    }

    /// Norm of the error coefficients of some weights for all trees of a number of nodes.
    pub fn error(&self, weights: &[f64], nodes: usize) -> f64 {
        self.norm(weights, nodes, |density| 1.0 / density)
    }

    /// The same of the difference of two formulas, whose weights add up to zero.
    pub fn difference(&self, weights: &[f64], nodes: usize) -> f64 {
        self.norm(weights, nodes, |_| 0.0)
    }

    /// The coefficient of z^power in the sum of the weighted slopes of y' = y, with z = h.
    pub fn coefficient(&self, weights: &[f64], power: u32) -> f64 {
        let ones = vec![1.0; self.0.len()];
        let powers = (1..power).fold(ones, |x, _| self.times(&x));
        weights.iter().zip(powers).map(|(b, x)| b * x).sum()
    }

    /// That of the error of the solution with these weights, in which the lower powers have none.
    pub fn error_coefficient(&self, weights: &[f64], power: u32) -> f64 {
        let factorial: f64 = (1..=power).map(f64::from).product();
        (self.coefficient(weights, power) - 1.0 / factorial).abs()
    }

    fn norm(&self, weights: &[f64], nodes: usize, exact: impl Fn(f64) -> f64) -> f64 {
        let errors = RootedTree::all(nodes).pop().into_iter().flatten();
        let errors = errors.map(|tree| {
            let stages = tree.of_stages(self);
            let sum: f64 = weights.iter().zip(stages).map(|(b, x)| b * x).sum();
            (sum - exact(tree.density())) / tree.symmetry()
        });
        errors.map(|e: f64| e * e).sum::<f64>().sqrt()
    }
}

#[test]
fn all_trees_are_found() {
    let numbers: Vec<usize> = RootedTree::all(9).iter().map(Vec::len).collect();
    assert_eq!(numbers, [0, 1, 1, 2, 4, 9, 20, 48, 115, 286]);
}

//! The order of elimination by minimum degree: next is always the unknown with the fewest neighbours.
//!
//! Eliminating an unknown makes its neighbours a clique. The graph is kept as its cliques, at first those of the matrix (the
//! quotient graph of George & Liu 1989, SIAM Review 31:1), and a degree is the size of a union of cliques. It decreases by one at most
//! when a neighbour is eliminated, so that it is counted again only where this bound makes an unknown the next one.

use std::collections::BTreeSet;

/// A symmetric pattern as a union of cliques, of which some unknowns have been eliminated.
struct QuotientGraph {
    /// The unknowns of every clique; none once one of them has been eliminated.
    members: Vec<Vec<usize>>,
    /// The cliques of every unknown.
    cliques: Vec<Vec<usize>>,
    seen: Marks,
}

/// A set of unknowns that is emptied at once.
struct Marks {
    of: Vec<usize>,
    current: usize,
}

impl Marks {
    fn new(n: usize) -> Marks {
        Marks {
            of: vec![0; n],
            current: 0,
        }
    }

    fn clear(&mut self) {
        self.current += 1;
    }

    /// True if it was not in the set.
    fn insert(&mut self, i: usize) -> bool {
        std::mem::replace(&mut self.of[i], self.current) != self.current
    }
}

impl QuotientGraph {
    fn new(n: usize, cliques: &[Vec<usize>]) -> QuotientGraph {
        let mut graph = QuotientGraph {
            members: Vec::new(),
            cliques: vec![Vec::new(); n],
            seen: Marks::new(n),
        };
        for clique in cliques {
            graph.seen.clear();
            let once = clique.iter().copied().filter(|&i| graph.seen.insert(i));
            let once = once.collect();
            graph.add(once);
        }
        graph
    }

    fn add(&mut self, clique: Vec<usize>) {
        for &i in &clique {
            self.cliques[i].push(self.members.len());
        }
        self.members.push(clique);
    }

    /// Number of neighbours of an unknown.
    fn degree(&mut self, i: usize) -> usize {
        self.cliques[i].retain(|&c| !self.members[c].is_empty());
        self.seen.clear();
        self.seen.insert(i);
        let neighbours = self.cliques[i].iter().flat_map(|&c| &self.members[c]);
        neighbours.filter(|&&j| self.seen.insert(j)).count()
    }

    /// Eliminates a pivot. Returns the unknowns coupled to it, ascending.
    fn eliminate(&mut self, pivot: usize) -> Vec<usize> {
        self.seen.clear();
        self.seen.insert(pivot);
        let mut front = Vec::new();
        for c in std::mem::take(&mut self.cliques[pivot]) {
            let members = std::mem::take(&mut self.members[c]).into_iter();
            front.extend(members.filter(|&i| self.seen.insert(i)));
        }
        front.sort_unstable();
        self.add(front.clone());
        front
    }
}

/// The order in which n unknowns are eliminated, and the unknowns coupled to each pivot, ascending. The pattern is the union of
/// dense blocks on the index sets `cliques`. Of unknowns with as many neighbours the first is next; unknown i is eliminated after
/// those in `after[i]`.
///
/// # Panics
/// If an index is not below n, or the orders asked for contradict each other.
pub fn minimum_degree(
    n: usize,
    cliques: &[Vec<usize>],
    after: &[Vec<usize>],
) -> (Vec<usize>, Vec<Vec<usize>>) {
    assert_eq!(after.len(), n);
    let mut graph = QuotientGraph::new(n, cliques);
    let mut degrees: Vec<usize> = (0..n).map(|i| graph.degree(i)).collect();
    // a neighbour has been eliminated since the degree was counted: it is a lower bound
    let mut is_bound = vec![false; n];
    // how many unknowns must still go before each one, and those that wait for each one
    let mut awaited: Vec<usize> = after.iter().map(Vec::len).collect();
    let mut waiting = vec![Vec::new(); n];
    for (i, before) in after.iter().enumerate() {
        before.iter().for_each(|&j| waiting[j].push(i));
    }
    // the unknowns that can go, by their number of neighbours
    let free = (0..n).filter(|&i| awaited[i] == 0);
    let mut ready: BTreeSet<(usize, usize)> = free.map(|i| (degrees[i], i)).collect();
    let mut order = Vec::with_capacity(n);
    let mut coupled = Vec::with_capacity(n);
    while order.len() < n {
        let next = ready.pop_first();
        let (bound, pivot) = next.expect("the orders asked for do not contradict each other");
        if std::mem::take(&mut is_bound[pivot]) {
            degrees[pivot] = graph.degree(pivot);
            if degrees[pivot] > bound {
                ready.insert((degrees[pivot], pivot));
                continue;
            }
        }
        let front = graph.eliminate(pivot);
        for &i in &front {
            let before = (degrees[i], i);
            degrees[i] = degrees[i].saturating_sub(1);
            is_bound[i] = true;
            if ready.remove(&before) {
                ready.insert((degrees[i], i));
            }
        }
        for &i in &waiting[pivot] {
            awaited[i] -= 1;
            if awaited[i] == 0 {
                ready.insert((degrees[i], i));
            }
        }
        order.push(pivot);
        coupled.push(front);
    }
    (order, coupled)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// The same with the neighbours of every unknown.
    fn explicit(
        n: usize,
        cliques: &[Vec<usize>],
        after: &[Vec<usize>],
    ) -> (Vec<usize>, Vec<Vec<usize>>) {
        let mut neighbours = vec![BTreeSet::new(); n];
        for clique in cliques {
            for &i in clique {
                neighbours[i].extend(clique.iter().copied().filter(|&j| j != i));
            }
        }
        let (mut order, mut coupled) = (Vec::new(), Vec::new());
        for _ in 0..n {
            let left = (0..n).filter(|i| !order.contains(i));
            let ready = left.filter(|&i| after[i].iter().all(|j| order.contains(j)));
            let pivot = ready.min_by_key(|&i| (neighbours[i].len(), i)).unwrap();
            let front: Vec<usize> = neighbours[pivot].iter().copied().collect();
            for &i in &front {
                neighbours[i].remove(&pivot);
                neighbours[i].extend(front.iter().copied().filter(|&j| j != i));
            }
            order.push(pivot);
            coupled.push(front);
        }
        (order, coupled)
    }

    proptest! {
        #[test]
        fn the_order_is_that_of_explicit_elimination(
            cliques in prop::collection::vec(prop::collection::vec(0..25_usize, 0..6), 0..30),
            late in prop::collection::vec((0..10_usize, 10..25_usize), 0..12),
        ) {
            let mut after = vec![Vec::new(); 25];
            for (i, before) in late {
                if !after[i].contains(&before) {
                    after[i].push(before);
                }
            }
            prop_assert_eq!(
                minimum_degree(25, &cliques, &after),
                explicit(25, &cliques, &after)
            );
        }
    }
}

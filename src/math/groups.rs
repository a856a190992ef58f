//! Disjoint groups of indices.

/// Groups that are united pair by pair.
#[derive(Debug)]
pub struct Groups {
    /// Another index of the same group; that which stands for the group is its own.
    parent: Vec<usize>,
}

impl Groups {
    /// Every index below n in a group of its own.
    pub fn new(n: usize) -> Groups {
        Groups {
            parent: (0..n).collect(),
        }
    }

    /// The index that stands for the group of i.
    pub fn find(&mut self, mut i: usize) -> usize {
        while self.parent[i] != i {
            self.parent[i] = self.parent[self.parent[i]];
            i = self.parent[i];
        }
        i
    }

    /// Joins the group of i to that of j; what stands for the latter stands for both.
    pub fn unite(&mut self, i: usize, j: usize) {
        let (i, j) = (self.find(i), self.find(j));
        self.parent[i] = j;
    }

    /// All groups in the order of their first indices, each ascending.
    pub fn all(mut self) -> Vec<Vec<usize>> {
        let n = self.parent.len();
        let mut places = vec![None; n];
        let mut groups: Vec<Vec<usize>> = Vec::new();
        for i in 0..n {
            let place = *places[self.find(i)].get_or_insert(groups.len());
            match groups.get_mut(place) {
                Some(group) => group.push(i),
                None => groups.push(vec![i]),
            }
        }
        groups
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn groups_are_united_and_listed_in_order() {
        let mut groups = Groups::new(6);
        groups.unite(4, 1);
        groups.unite(5, 4);
        groups.unite(0, 3);
        assert_eq!([5, 0, 2].map(|i| groups.find(i)), [1, 3, 2]);
        assert_eq!(groups.all(), [vec![0, 3], vec![1, 4, 5], vec![2]]);
    }
}

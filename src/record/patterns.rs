//! Patterns of names, all compared with all names at once.
//!
//! The patterns are the paths of one tree, whose nodes follow each other by a character; from a node that ends in `*` every character
//! leads back to it, too. A name is followed through the tree on all its paths together, so that it takes the time of the patterns that
//! begin like it, not that of all.

use std::collections::HashMap;

/// Stands for any sequence of characters, an empty one included.
pub const WILDCARD: char = '*';

/// The names that fit patterns.
#[derive(Debug, PartialEq, Eq)]
pub struct Choice {
    /// Indices of the names that fit a pattern, each once: by the first pattern that they fit, then in their own order.
    pub names: Vec<usize>,
    /// Indices of the patterns that no name fits, ascending.
    pub unmatched: Vec<usize>,
}

/// Chooses the names that fit patterns.
pub fn choose<'a>(
    patterns: impl IntoIterator<Item = &'a str>,
    names: impl IntoIterator<Item = &'a str>,
) -> Choice {
    let mut tree = Tree::default();
    let ends: Vec<usize> = patterns.into_iter().map(|text| tree.add(text)).collect();
    // the first pattern that ends at a node
    let mut first: HashMap<usize, usize> = HashMap::new();
    for (pattern, &end) in ends.iter().enumerate() {
        first.entry(end).or_insert(pattern);
    }
    let mut is_matched = vec![false; tree.is_wild.len()];
    let mut chosen = Vec::new();
    for (k, name) in names.into_iter().enumerate() {
        let reached = tree.follow(name);
        reached.iter().for_each(|&node| is_matched[node] = true);
        let patterns = reached.iter().filter_map(|node| first.get(node));
        chosen.extend(patterns.min().map(|&pattern| (pattern, k)));
    }
    chosen.sort_unstable();
    Choice {
        names: chosen.into_iter().map(|(_, k)| k).collect(),
        unmatched: (0..ends.len()).filter(|&k| !is_matched[ends[k]]).collect(),
    }
}

/// The tree of patterns; node 0 is its root.
#[derive(Debug)]
struct Tree {
    /// The node that follows a node by a character.
    next: HashMap<(usize, char), usize>,
    /// For every node whether it ends in `*`.
    is_wild: Vec<bool>,
    /// For every node the number of the step that reached it last.
    step_of: Vec<usize>,
    step: usize,
}

impl Default for Tree {
    fn default() -> Tree {
        Tree {
            next: HashMap::new(),
            is_wild: vec![false],
            step_of: vec![0],
            step: 0,
        }
    }
}

impl Tree {
    /// Adds a pattern. Returns the node where it ends.
    fn add(&mut self, pattern: &str) -> usize {
        let mut node = 0;
        for c in pattern.chars() {
            // a second wildcard stands for nothing more
            if c == WILDCARD && self.is_wild[node] {
                continue;
            }
            node = *self.next.entry((node, c)).or_insert_with(|| {
                self.is_wild.push(c == WILDCARD);
                self.step_of.push(0);
                self.is_wild.len() - 1
            });
        }
        node
    }

    /// The nodes where the paths of a name end.
    fn follow(&mut self, name: &str) -> Vec<usize> {
        let mut reached = Vec::new();
        self.step += 1;
        self.reach(0, &mut reached);
        for c in name.chars() {
            let before = std::mem::take(&mut reached);
            self.step += 1;
            for node in before {
                if self.is_wild[node] {
                    self.reach(node, &mut reached);
                }
                if let Some(&node) = self.next.get(&(node, c)) {
                    self.reach(node, &mut reached);
                }
            }
        }
        reached
    }

    /// Adds a node to those reached, once in a step, and the wildcard behind it, which may stand for nothing.
    fn reach(&mut self, node: usize, reached: &mut Vec<usize>) {
        if std::mem::replace(&mut self.step_of[node], self.step) == self.step {
            return;
        }
        reached.push(node);
        if let Some(&wild) = self.next.get(&(node, WILDCARD)) {
            self.reach(wild, reached);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Whether one pattern fits a name, by its definition.
    fn fits(pattern: &[u8], name: &[u8]) -> bool {
        match pattern.split_first() {
            None => name.is_empty(),
            Some((b'*', rest)) => (0..=name.len()).any(|k| fits(rest, &name[k..])),
            Some((c, rest)) => name
                .split_first()
                .is_some_and(|(first, behind)| first == c && fits(rest, behind)),
        }
    }

    proptest! {
        #[test]
        fn names_are_chosen_as_one_pattern_after_the_other_would(
            patterns in prop::collection::vec("[ab.*]{0,6}", 0..12),
            names in prop::collection::vec("[ab.]{0,6}", 0..20),
        ) {
            let mut expected = Choice { names: Vec::new(), unmatched: Vec::new() };
            for (k, pattern) in patterns.iter().enumerate() {
                let fits = |i: &usize| fits(pattern.as_bytes(), names[*i].as_bytes());
                let fitting: Vec<usize> = (0..names.len()).filter(fits).collect();
                if fitting.is_empty() {
                    expected.unmatched.push(k);
                }
                let new = fitting.into_iter().filter(|i| !expected.names.contains(i));
                let new: Vec<usize> = new.collect();
                expected.names.extend(new);
            }
            let texts = patterns.iter().map(String::as_str);
            prop_assert_eq!(choose(texts, names.iter().map(String::as_str)), expected);
        }
    }

    /// Paths that a name takes, over its length: patterns that begin otherwise cost nothing.
    #[test]
    fn more_patterns_do_not_make_a_name_take_longer() {
        for form in ["body#.*", "*body#.x", "b*#.x", "*y#*x", "body#.x"] {
            let paths = |count: usize| {
                let mut tree = Tree::default();
                (0..count).for_each(|k| {
                    tree.add(&form.replace('#', &k.to_string()));
                });
                let name = "body7.x";
                let ends = (0..=name.len()).map(|end| tree.follow(&name[..end]).len());
                ends.sum::<usize>()
            };
            assert_eq!(paths(10), paths(1000), "{form}");
        }
    }
}

//! Warnings of runs, shown beside the results that rest on them.

use std::cmp::Ordering;
use std::collections::BTreeSet;

/// A run, or a group of runs that are alike, and what it warns of.
#[derive(Debug, Clone)]
pub struct WarningSource {
    /// How the report calls it, such as `run 4` or `ensemble A`.
    pub name: String,
    /// Its warnings.
    pub warnings: Vec<String>,
}

/// The warnings of several runs, each kind once: every number from its least to its largest, a name with how many others
/// stand in its place, and how many runs have it.
pub fn merged(runs: &[&[String]]) -> Vec<String> {
    let mut kinds: Vec<(Vec<String>, WarningKind)> = Vec::new();
    for (run, warnings) in runs.iter().enumerate() {
        for warning in warnings.iter() {
            let (words, values) = split(warning);
            let kind = match kinds.iter().position(|(known, _)| *known == words) {
                Some(known) => known,
                None => {
                    kinds.push((words, WarningKind::default()));
                    kinds.len() - 1
                }
            };
            kinds[kind].1.runs.insert(run);
            kinds[kind].1.values.push(values);
        }
    }
    kinds
        .into_iter()
        .map(|(words, kind)| {
            let mut text = String::new();
            for (i, word) in words.iter().enumerate() {
                text += word;
                if i + 1 < words.len() {
                    text += &range(kind.values.iter().map(|values| values[i].as_str()));
                }
            }
            text + &format!(" (in {} of {} runs)", kind.runs.len(), runs.len())
        })
        .collect()
}

/// Warnings with the same words.
#[derive(Default)]
struct WarningKind {
    /// The runs that have one.
    runs: BTreeSet<usize>,
    /// The numbers and names of each warning.
    values: Vec<Vec<String>>,
}

/// The text between the numbers and names, one piece more than there are of them, and the numbers and names. A name has a
/// digit, such as B1, or a dot, such as rod.end.x.
fn split(warning: &str) -> (Vec<String>, Vec<String>) {
    let (mut words, mut values) = (vec![String::new()], Vec::new());
    for (i, token) in warning.split(' ').enumerate() {
        let last = words.len() - 1;
        if i > 0 {
            words[last].push(' ');
        }
        let head = token.trim_start_matches('(');
        let bare = head.trim_end_matches([',', ':', ')', '.']);
        if bare.contains(|c: char| c.is_ascii_digit() || c == '.') {
            words[last] += &token[..token.len() - head.len()];
            values.push(bare.to_owned());
            words.push(head[bare.len()..].to_owned());
        } else {
            words[last] += token;
        }
    }
    (words, values)
}

/// The least and the largest of some numbers, as they were written; of names the first, and how many others there are.
fn range<'a>(values: impl Iterator<Item = &'a str>) -> String {
    let written: BTreeSet<&str> = values.collect();
    let number = |text: &&str| text.parse::<f64>().ok();
    let mut numbers: Vec<&str> = written.iter().copied().collect();
    if numbers.iter().any(|text| number(text).is_none()) {
        return match numbers.as_slice() {
            [one] => (*one).to_owned(),
            [one, other] => format!("{one} or {other}"),
            [one, others @ ..] => format!("{one} or {} others", others.len()),
            [] => String::new(),
        };
    }
    numbers.sort_by(|a, b| number(a).partial_cmp(&number(b)).unwrap_or(Ordering::Equal));
    match (numbers.first(), numbers.last()) {
        (Some(least), Some(largest)) if least != largest => format!("{least} to {largest}"),
        (Some(least), _) => (*least).to_owned(),
        _ => String::new(),
    }
}

/// Warnings in a cell of a table.
pub fn reported(warnings: &[String]) -> String {
    if warnings.is_empty() {
        "none".into()
    } else {
        warnings.join("; ").replace('|', "\\|")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn warnings_of_one_kind_become_one_with_ranges() {
        let runs = [
            vec!["the integrator lost 1.2e-6 J, 7.0 % of B1".to_owned()],
            vec![],
            vec![
                "the integrator lost 8e-7 J, 5.5 % of B1".to_owned(),
                "the integrator lost 9e-7 J, 6 % of C1".to_owned(),
                "clamps: 2".to_owned(),
            ],
        ];
        let runs: Vec<&[String]> = runs.iter().map(Vec::as_slice).collect();
        assert_eq!(
            merged(&runs),
            [
                "the integrator lost 8e-7 to 1.2e-6 J, 5.5 to 7.0 % of B1 or C1 (in 2 of 3 runs)",
                "clamps: 2 (in 1 of 3 runs)"
            ]
        );
    }
}

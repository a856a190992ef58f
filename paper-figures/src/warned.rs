//! Warnings of runs, shown beside the results that rest on them.

/// A run, or a group of runs that are alike, and what it warns of.
#[derive(Debug, Clone)]
pub struct Source {
    /// How the report calls it, such as `run 4` or `ensemble A`.
    pub name: String,
    /// Its warnings.
    pub warnings: Vec<String>,
}

/// The warnings of several runs, each kind once: every number from its least to its largest, and how many runs have it.
pub fn merged(runs: &[&[String]]) -> Vec<String> {
    let mut kinds: Vec<(Vec<String>, Vec<Vec<String>>)> = Vec::new();
    for warning in runs.iter().flat_map(|warnings| warnings.iter()) {
        let (words, numbers) = split(warning);
        match kinds.iter_mut().find(|(known, _)| *known == words) {
            Some((_, all)) => all.push(numbers),
            None => kinds.push((words, vec![numbers])),
        }
    }
    kinds
        .into_iter()
        .map(|(words, all)| {
            let mut text = String::new();
            for (i, word) in words.iter().enumerate() {
                text += word;
                if i + 1 < words.len() {
                    text += &range(all.iter().map(|numbers| numbers[i].as_str()));
                }
            }
            text + &format!(" (in {} of {} runs)", all.len(), runs.len())
        })
        .collect()
}

/// The text between the numbers, one piece more than there are numbers, and the numbers. Digits that belong to a name,
/// such as those of B1, are text.
fn split(warning: &str) -> (Vec<String>, Vec<String>) {
    let (mut words, mut numbers) = (vec![String::new()], Vec::new());
    for (i, token) in warning.split(' ').enumerate() {
        let last = words.len() - 1;
        if i > 0 {
            words[last].push(' ');
        }
        let bare = token.trim_end_matches([',', ':']);
        if bare.parse::<f64>().is_ok() {
            numbers.push(bare.to_owned());
            words.push(token[bare.len()..].to_owned());
        } else {
            words[last] += token;
        }
    }
    (words, numbers)
}

/// The least and the largest of some numbers, as they were written.
fn range<'a>(numbers: impl Iterator<Item = &'a str>) -> String {
    let mut written: Vec<&str> = numbers.collect();
    written.sort_by(|a, b| {
        let value = |text: &str| text.parse().unwrap_or(f64::NAN);
        f64::total_cmp(&value(a), &value(b))
    });
    match (written.first(), written.last()) {
        (Some(least), Some(largest)) if least != largest => format!("{least} to {largest}"),
        (Some(least), _) => (*least).to_owned(),
        _ => String::new(),
    }
}

/// Warnings in a cell of a table.
pub fn told(warnings: &[String]) -> String {
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
                "clamps: 2".to_owned(),
            ],
        ];
        let runs: Vec<&[String]> = runs.iter().map(Vec::as_slice).collect();
        assert_eq!(
            merged(&runs),
            [
                "the integrator lost 8e-7 to 1.2e-6 J, 5.5 to 7.0 % of B1 (in 2 of 3 runs)",
                "clamps: 2 (in 1 of 3 runs)"
            ]
        );
    }
}

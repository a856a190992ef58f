//! Warnings of many runs in a few lines.

/// Warnings of several runs, each kind once: the words of the first run that has it, and how many have it. Warnings are of one kind
/// that differ by numbers and names alone, that is by words with a digit or a dot inside.
pub fn merged<'a>(runs: impl IntoIterator<Item = &'a Vec<String>>) -> Vec<String> {
    let runs: Vec<&Vec<String>> = runs.into_iter().collect();
    let mut kinds: Vec<(String, &str)> = Vec::new();
    for warning in runs.iter().copied().flatten() {
        let kind = kind(warning);
        if kinds.iter().all(|(known, _)| *known != kind) {
            kinds.push((kind, warning));
        }
    }
    let line = |(known, first): (String, &str)| {
        let has = |run: &&&Vec<String>| run.iter().any(|warning| kind(warning) == known);
        let (count, all) = (runs.iter().filter(has).count(), runs.len());
        format!("{first} (like this in {count} of {all} runs)")
    };
    kinds.into_iter().map(line).collect()
}

fn kind(warning: &str) -> String {
    let is_word = |word: &&str| {
        let inside = word.trim_matches([',', ':', '(', ')', '.', ';']);
        !inside.contains(|c: char| c.is_ascii_digit() || c == '.')
    };
    warning
        .split(' ')
        .filter(is_word)
        .collect::<Vec<_>>()
        .join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn warnings_of_one_kind_become_one() {
        let runs = [
            vec!["the integrator lost 1.2e-6 J, 7.0 % of B1".to_owned()],
            vec![],
            vec![
                "the integrator lost 8e-7 J, 5.5 % of B1".to_owned(),
                "the integrator lost 9e-7 J, 6 % of C1".to_owned(),
                "clamps: 2".to_owned(),
            ],
        ];
        assert_eq!(
            merged(&runs),
            [
                "the integrator lost 1.2e-6 J, 7.0 % of B1 (like this in 2 of 3 runs)",
                "clamps: 2 (like this in 1 of 3 runs)"
            ]
        );
    }
}

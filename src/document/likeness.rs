//! Names that are like another: what an unknown name was meant to be.

/// Letters of a name that may be taken for another.
const LONGEST: usize = 64;
/// Known names that a message lists: few enough to be read.
const LISTED: usize = 5;

/// The known name nearest to `name`, when it is near enough to be meant.
pub fn nearest<'k>(name: &str, known: impl IntoIterator<Item = &'k str>) -> Option<&'k str> {
    let letters = name.chars().count();
    // Nobody mistypes a name as long as this, and the comparison of two takes the product of their lengths.
    if letters > LONGEST {
        return None;
    }
    // A third of the letters may differ: `lenght` finds `length`, `mass` does not find `model`.
    let limit = ((letters + 1) / 3).max(1);
    let name = name.to_lowercase();
    let distance = |k: &&str| strsim::damerau_levenshtein(&name, &k.to_lowercase());
    let known = known.into_iter();
    let nearest = known.filter(|k| k.chars().count() <= LONGEST);
    let nearest = nearest.min_by_key(distance);
    nearest.filter(|k| distance(k) <= limit)
}

/// The end of a message about an unknown name: a suggestion, or nothing.
pub fn did_you_mean<'k>(name: &str, known: impl IntoIterator<Item = &'k str>) -> String {
    nearest(name, known).map_or(String::new(), |k| format!("; did you mean `{k}`?"))
}

/// The known names; of many those that are most like `name`, and how many there are.
pub(crate) fn listed(name: &str, known: &[&str]) -> String {
    if known.len() <= LISTED {
        return format!("known: {}", known.join(", "));
    }
    let mut ranked: Vec<(f64, &str)> = known.iter().map(|k| (likeness(name, k), *k)).collect();
    ranked.sort_by(|a, b| b.0.total_cmp(&a.0));
    let first: Vec<&str> = ranked[..LISTED].iter().map(|(_, k)| *k).collect();
    format!("nearest of {}: {}", known.len(), first.join(", "))
}

/// How much two names are alike: the parts between dots, dashes and underscores that they share, then their letters.
fn likeness(name: &str, known: &str) -> f64 {
    if [name, known].iter().any(|n| n.chars().count() > LONGEST) {
        return 0.0;
    }
    let [name, known] = [name, known].map(str::to_lowercase);
    let parts = |text: &'_ str| {
        let parts = text.split(|c: char| !c.is_alphanumeric());
        parts.map(str::to_owned).collect::<Vec<_>>()
    };
    let others = parts(&known);
    let shared = parts(&name).iter().filter(|p| others.contains(p)).count();
    shared as f64 + strsim::normalized_damerau_levenshtein(&name, &known)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn few_names_are_all_listed_and_many_by_likeness() {
        assert_eq!(listed("x", &["b", "a"]), "known: b, a");
        let many = [
            "platform", "link1", "crank1", "crank2", "crank3", "link2", "link3",
        ];
        let said = listed("crnk2", &many);
        assert!(said.starts_with("nearest of 7: crank2, "), "{said}");
        assert_eq!(said.matches(", ").count(), LISTED - 1);
        // a part that both have counts for more than letters
        let parts = ["left_arm", "left_leg", "right_arm", "elbow", "shin", "toe"];
        let said = listed("arm_lft", &parts);
        assert!(said.contains("6: left_arm, right_arm, "), "{said}");
    }
}

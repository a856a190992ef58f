//! Texts of a study: they stand in tables, pictures and messages, one line each.

use texts::{described, harmful, harmful_in_line, is_invisible};
use toml::de::{DeTable, DeValue};

/// A text that a study cannot have.
pub struct RefusedText {
    /// Where its value, or its key, begins.
    pub byte: usize,
    /// Which it is, and what is wrong with it.
    pub message: String,
}

/// The first text of a study that nothing could show.
pub fn refused(table: &DeTable, above: &str) -> Option<RefusedText> {
    table.iter().find_map(|(key, value)| {
        let name = key.get_ref();
        let path = match above {
            "" => name.to_string(),
            above => format!("{above}.{name}"),
        };
        let wrong = in_name(name).map(|wrong| RefusedText {
            byte: key.span().start,
            message: format!("`{path}` {wrong}"),
        });
        wrong.or_else(|| of_value(value.get_ref(), value.span().start, &path, name))
    })
}

/// That of a value below the key `name`.
fn of_value(value: &DeValue, byte: usize, path: &str, name: &str) -> Option<RefusedText> {
    match value {
        DeValue::String(text) => {
            let wrong = match name {
                // a change of a scene may have lines
                "set" => harmful(text).next().map(|(_, c)| holds(c)),
                "name" => in_name(text),
                _ => harmful_in_line(text).map(holds),
            };
            let message = format!("`{path}` {}", wrong?);
            Some(RefusedText { byte, message })
        }
        DeValue::Array(items) => {
            let mut items = items.iter().enumerate();
            items.find_map(|(index, item)| {
                let path = format!("{path}.{index}");
                of_value(item.get_ref(), item.span().start, &path, name)
            })
        }
        DeValue::Table(table) => refused(table, path),
        _ => None,
    }
}

/// What is wrong with a name: two that differ by what nobody sees would look alike.
fn in_name(name: &str) -> Option<String> {
    let invisible = || name.chars().find(|c| is_invisible(*c));
    harmful_in_line(name).or_else(invisible).map(holds)
}

fn holds(c: char) -> String {
    format!("holds {}", described(c))
}

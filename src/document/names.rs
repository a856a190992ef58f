//! Tables whose keys the user chooses.

use super::error::SceneError;
use super::field::Field;
use indexmap::IndexMap;

/// First parts of the names of channels that belong to no body, joint or force.
pub(crate) const RESERVED: [&str; 4] = ["error", "energy", "points", "t"];

/// Reads a table whose keys are names the user chose.
pub(crate) fn named<T>(
    table: Option<Field>,
    mut read: impl FnMut(&Field) -> Result<T, SceneError>,
) -> Result<IndexMap<String, T>, SceneError> {
    let mut result = IndexMap::new();
    if let Some(table) = table {
        for field in table.fields()?.entries() {
            check_name(&field, &[])?;
            result.insert(field.name.clone(), read(&field)?);
        }
    }
    Ok(result)
}

/// Names become parts of channel names, of paths and of column headings.
pub(crate) fn check_name(field: &Field, reserved: &[&str]) -> Result<(), SceneError> {
    let name = &field.name;
    if reserved.contains(&name.as_str()) {
        let message =
            format!("the name `{name}` is reserved: channels of the program begin with it");
        return Err(field.key_fault(message, "reserved"));
    }
    let fine = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '-';
    if name.is_empty() || !name.chars().all(fine) {
        let message = format!("`{name}` is not a valid name");
        let help = "names consist of ASCII letters, digits, `_` and `-`";
        return Err(field.key_fault(message, "not a name").with_help(help));
    }
    Ok(())
}

/// A derived quantity must have survived the arithmetic of extreme inputs.
pub fn derived(field: &Field, what: &str, x: f64) -> Result<f64, SceneError> {
    if x.is_finite() && x > 0.0 {
        return Ok(x);
    }
    Err(field.key_fault(
        format!("`{}` gives {what} of {x:?}", field.path),
        "out of range",
    ))
}

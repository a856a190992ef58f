//! Python values as TOML: what is written into a scene.

use super::errors::raise;
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict, PyFloat, PyInt, PyList, PyString, PyTuple};

/// Tables in tables end at this depth; a scene needs five levels.
const DEPTH: usize = 32;

/// The text of a whole scene, one named thing a line. Callables are added to `callables`.
///
/// # Errors
/// A value that a scene cannot hold; the message names the key.
pub fn document(scene: &Bound<PyDict>, callables: &Bound<PyList>) -> PyResult<String> {
    let mut text = String::new();
    for (key, value) in scene.iter() {
        let name = key_name(&key, "the scene")?;
        let things = value.cast::<PyDict>();
        let things = things.ok().filter(|things| {
            !things.is_empty() && things.values().iter().all(|v| v.is_instance_of::<PyDict>())
        });
        match things {
            Some(things) => {
                for (thing, value) in things.iter() {
                    let thing = key_name(&thing, &name)?;
                    let value = inline(&value, &format!("{name}.{thing}"), callables, 2)?;
                    text += &format!("{}.{} = {value}\n", written_key(&name), written_key(&thing));
                }
            }
            None => {
                let value = inline(&value, &name, callables, 1)?;
                text += &format!("{} = {value}\n", written_key(&name));
            }
        }
    }
    Ok(text)
}

/// What stands behind the `=` of an override. Callables are added to `callables`.
///
/// # Errors
/// A value that a scene cannot hold; the message names its path.
pub fn override_value(
    value: &Bound<PyAny>,
    path: &str,
    callables: &Bound<PyList>,
) -> PyResult<String> {
    match value.cast::<PyString>() {
        // as it is typed on a command line
        Ok(word) if is_word(word.to_str()?) => Ok(word.to_str()?.to_owned()),
        _ => inline(value, path, callables, 0),
    }
}

/// True of text that TOML does not know and that an override takes without quotes.
fn is_word(text: &str) -> bool {
    let mut letters = text.chars();
    let begins = letters.next().is_some_and(|c| c.is_ascii_alphabetic());
    begins
        && letters.all(|c| c.is_ascii_alphanumeric() || c == '_')
        && !["true", "false", "inf", "nan"].contains(&text)
}

fn inline(
    value: &Bound<PyAny>,
    path: &str,
    callables: &Bound<PyList>,
    depth: usize,
) -> PyResult<String> {
    if depth > DEPTH {
        let message = format!("`{path}` is nested too deeply for a scene");
        return Err(raise::<PyValueError>(message));
    }
    if value.is_instance_of::<PyBool>() {
        return Ok(value.extract::<bool>()?.to_string());
    }
    if value.is_instance_of::<PyInt>() {
        let number = value.extract::<i64>();
        return number.map(|n| n.to_string()).map_err(|_| {
            raise::<PyValueError>(format!("`{path}` is an integer that does not fit 64 bits"))
        });
    }
    if value.is_instance_of::<PyFloat>() {
        return Ok(written_number(value.extract()?));
    }
    if let Ok(text) = value.cast::<PyString>() {
        return Ok(quoted(text.to_str()?));
    }
    if let Ok(table) = value.cast::<PyDict>() {
        let mut entries = Vec::new();
        for (key, value) in table.iter() {
            let key = key_name(&key, path)?;
            let value = inline(&value, &format!("{path}.{key}"), callables, depth + 1)?;
            entries.push(format!("{} = {value}", written_key(&key)));
        }
        return Ok(match entries.is_empty() {
            true => "{}".to_owned(),
            false => format!("{{ {} }}", entries.join(", ")),
        });
    }
    if value.is_instance_of::<PyList>() || value.is_instance_of::<PyTuple>() {
        let mut items = Vec::new();
        for (index, item) in value.try_iter()?.enumerate() {
            items.push(inline(
                &item?,
                &format!("{path}.{index}"),
                callables,
                depth + 1,
            )?);
        }
        return Ok(format!("[{}]", items.join(", ")));
    }
    // scalars and arrays of NumPy
    if value.hasattr("tolist")? {
        return inline(&value.call_method0("tolist")?, path, callables, depth + 1);
    }
    if value.is_callable() {
        return named_callable(path, value, None, "", callables);
    }
    let kind = value.get_type().name()?;
    let message = format!("`{path}` cannot be written into a scene: it is of type {kind}");
    Err(raise::<PyTypeError>(message))
}

/// The table that names a callable, with other keys before its number.
///
/// # Errors
/// None but for want of memory.
pub fn named_callable(
    path: &str,
    function: &Bound<PyAny>,
    tangent: Option<&Bound<PyAny>>,
    keys: &str,
    callables: &Bound<PyList>,
) -> PyResult<String> {
    let number = callables.len();
    callables.append((path, function, tangent))?;
    Ok(format!(
        "{{ type = \"callable\", {keys}number = {number} }}"
    ))
}

fn key_name(key: &Bound<PyAny>, place: &str) -> PyResult<String> {
    match key.cast::<PyString>() {
        Ok(key) => Ok(key.to_str()?.to_owned()),
        Err(_) => Err(raise::<PyTypeError>(format!(
            "the keys of {place} must be strings, not {}",
            key.repr()?
        ))),
    }
}

/// A key, in quotes where TOML wants them.
pub fn written_key(key: &str) -> String {
    let bare = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '-';
    match !key.is_empty() && key.chars().all(bare) {
        true => key.to_owned(),
        false => quoted(key),
    }
}

/// A string of JSON is one of TOML, but for the delete character.
pub fn quoted(text: &str) -> String {
    serde_json::Value::from(text)
        .to_string()
        .replace('\u{7f}', "\\u007F")
}

/// The shortest digits that read back to the same bits.
fn written_number(value: f64) -> String {
    format!("{value:?}").to_lowercase()
}

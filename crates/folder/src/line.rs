//! Lines of JSON that end with the CRC-32 of what stands before it: a line that was damaged or edited is known.

use serde::Serialize;
use serde::de::DeserializeOwned;
use std::io;

/// Stands before the CRC-32 of a line. The name is no other key of a line, so that every reader of JSON finds both.
const KEY: &[u8] = b",\"line_crc32\":\"";
/// The same in lines of earlier programs.
const EARLIER_KEY: &[u8] = b",\"crc32\":\"";
/// Stands after it.
const END: &[u8] = b"\"}";
/// Hexadecimal digits of a CRC-32.
const DIGITS: usize = 8;

/// A value with keys as a line, `{...,"line_crc32":"89abcdef"}` and a line feed. The CRC-32 is that of all bytes before its key.
///
/// # Errors
/// A value that JSON does not have, or one without keys.
pub fn line_of(value: &impl Serialize) -> io::Result<Vec<u8>> {
    let mut line = serde_json::to_vec(value)?;
    if line.pop() != Some(b'}') || line.len() < 2 {
        return Err(io::ErrorKind::InvalidInput.into());
    }
    let crc = crc32fast::hash(&line);
    line.extend_from_slice(KEY);
    line.extend(format!("{crc:0DIGITS$x}").bytes());
    line.extend_from_slice(END);
    line.push(b'\n');
    Ok(line)
}

/// The value of a line; none of one that was not written by [`line_of`] or was changed since.
pub fn value_of<T: DeserializeOwned>(line: &[u8]) -> Option<T> {
    let line = line.strip_suffix(b"\n").unwrap_or(line);
    let (rest, crc) = line.strip_suffix(END)?.split_last_chunk::<DIGITS>()?;
    let value = rest
        .strip_suffix(KEY)
        .or_else(|| rest.strip_suffix(EARLIER_KEY))?;
    let written = format!("{:0DIGITS$x}", crc32fast::hash(value));
    if written.as_bytes() != crc {
        return None;
    }
    serde_json::from_slice(&[value, b"}"].concat()).ok()
}

#[cfg(test)]
mod tests {
    use super::{line_of, value_of};
    use std::collections::BTreeMap;

    #[test]
    fn lines_of_earlier_programs_are_read() {
        // by Python's zlib.crc32
        let line = br#"{"file":"a","crc32":7,"crc32":"04068cbe"}"#;
        let value = value_of::<serde_json::Value>(line).unwrap();
        assert_eq!(value, serde_json::json!({"file": "a", "crc32": 7}));
    }

    #[test]
    fn a_line_with_any_bit_flipped_is_known() {
        let value = BTreeMap::from([("run".to_owned(), 17.25), ("t".to_owned(), 0.1)]);
        let line = line_of(&value).unwrap();
        assert_eq!(value_of(&line), Some(value));
        // the line feed ends it and is not part of it
        for bit in 0..8 * (line.len() - 1) {
            let mut flipped = line.clone();
            flipped[bit / 8] ^= 1 << (bit % 8);
            assert_eq!(value_of::<BTreeMap<String, f64>>(&flipped), None, "{bit}");
        }
        assert!(line_of(&BTreeMap::<String, f64>::new()).is_err() && line_of(&1.0).is_err());
    }
}

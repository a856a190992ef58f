//! A JSON object a row, whose keys are the names of the columns.

use super::{Cell, Format};

pub(super) static FORMAT: Format = Format {
    name: "json_lines",
    extension: "jsonl",
    header: |_, _| {},
    row: |columns, cells, text| {
        for (i, (name, cell)) in columns.iter().zip(cells).enumerate() {
            text.push(if i == 0 { b'{' } else { b',' });
            quoted(name, text);
            text.push(b':');
            match cell {
                // the shortest decimal fraction that reads back as the same number
                Cell::Number(x) if x.is_finite() => {
                    text.extend_from_slice(ryu::Buffer::new().format(*x).as_bytes());
                }
                Cell::Word(word) => quoted(word, text),
                Cell::Number(_) | Cell::Empty => text.extend_from_slice(b"null"),
            }
        }
        text.extend_from_slice(b"}\n");
    },
};

/// Names and words hold no quotes and no backslashes.
fn quoted(word: &str, text: &mut Vec<u8>) {
    text.push(b'"');
    text.extend_from_slice(word.as_bytes());
    text.push(b'"');
}

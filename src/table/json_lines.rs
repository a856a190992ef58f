//! A JSON object a row, whose keys are the names of the columns.

use super::{Cell, Format};

pub(super) static FORMAT: Format = Format {
    name: "json_lines",
    extension: "jsonl",
    column: quoted,
    header: |_, _| {},
    row: |columns, cells, text| {
        for (i, (name, cell)) in columns.iter().zip(cells).enumerate() {
            text.push(if i == 0 { b'{' } else { b',' });
            text.extend_from_slice(name.as_bytes());
            text.push(b':');
            match cell {
                // the shortest decimal fraction that reads back as the same number
                Cell::Number(x) if x.is_finite() => {
                    text.extend_from_slice(ryu::Buffer::new().format(*x).as_bytes());
                }
                Cell::Word(word) => text.extend_from_slice(quoted(word).as_bytes()),
                Cell::Number(_) | Cell::Empty => text.extend_from_slice(b"null"),
            }
        }
        text.extend_from_slice(b"}\n");
    },
};

fn quoted(word: &str) -> String {
    serde_json::Value::from(word).to_string()
}

//! Cells between commas, below a line with the names of the columns. Names and words are no formulas of a spreadsheet.

use super::{Cell, Format};
use texts::csv::cell as written;

pub(super) static FORMAT: Format = Format {
    name: "csv",
    extension: "csv",
    column: |name| written(name).into_owned(),
    header: |columns, text| {
        text.extend_from_slice(columns.join(",").as_bytes());
        text.push(b'\n');
    },
    row: |_, cells, text| {
        for cell in cells {
            match cell {
                // the shortest decimal fraction that reads back as the same number
                Cell::Number(x) => text.extend_from_slice(ryu::Buffer::new().format(*x).as_bytes()),
                Cell::Word(word) => text.extend_from_slice(written(word).as_bytes()),
                Cell::Empty => {}
            }
            text.push(b',');
        }
        if let Some(last) = text.last_mut() {
            *last = b'\n';
        }
    },
};

//! Rows of 64-bit numbers, little-endian, after a line with the names of the columns: for tables that programs read. What is no
//! number is NaN.

use super::{Cell, Format};
use serde_json::Value;

pub(crate) static FORMAT: Format = Format {
    name: "float64",
    extension: "bin",
    column: |name| Value::from(name).to_string(),
    header: |columns, text| {
        let columns = columns.join(",");
        text.extend(format!("{{\"columns\":[{columns}]}}\n").as_bytes());
    },
    row: |_, cells, text| {
        for cell in cells {
            let number = match cell {
                Cell::Number(number) => *number,
                Cell::Word(_) | Cell::Empty => f64::NAN,
            };
            text.extend(number.to_le_bytes());
        }
    },
};

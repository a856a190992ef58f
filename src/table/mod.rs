//! Formats of tables that are written row by row, one a file.

mod csv;
pub(crate) mod float64;
mod json_lines;

/// The formats that a scene can name; the first is taken by default.
pub static FORMATS: [&Format; 2] = [&csv::FORMAT, &json_lines::FORMAT];

/// A cell of a row.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Cell<'a> {
    /// A number.
    Number(f64),
    /// A word, such as the name of a joint.
    Word(&'a str),
    /// Nothing.
    Empty,
}

/// A format of tables.
#[derive(Debug)]
pub struct Format {
    /// Its name in a scene.
    pub name: &'static str,
    /// How names of its files end.
    pub extension: &'static str,
    /// How the name of a column is written; asked once, not for every row.
    pub column: fn(name: &str) -> String,
    /// Appends what comes before the rows of a table with these columns, as they are written.
    pub header: fn(columns: &[String], text: &mut Vec<u8>),
    /// Appends a row of a table with these columns, as they are written.
    pub row: fn(columns: &[String], cells: &[Cell], text: &mut Vec<u8>),
}

impl Format {
    /// The name of the file of a table.
    pub fn file(&self, table: &str) -> String {
        format!("{table}.{}", self.extension)
    }
}

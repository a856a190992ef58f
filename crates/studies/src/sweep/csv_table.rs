//! A table as CSV: `name [unit]` above every column, numbers with as many digits as it takes to read back the same bits. Names and
//! texts are no formulas of a spreadsheet.

use super::columns::{Column, SweepCell};
use texts::csv::content;

/// A file in memory.
pub struct CsvTable(csv::Writer<Vec<u8>>);

impl CsvTable {
    /// A table with these columns.
    pub fn new(columns: &[Column]) -> csv::Result<CsvTable> {
        let mut writer = csv::Writer::from_writer(Vec::new());
        let heads = columns.iter().map(Column::head);
        writer.write_record(heads.map(|head| content(&head).into_owned()))?;
        Ok(CsvTable(writer))
    }

    /// Adds a row, in the order of the columns.
    pub fn row(&mut self, cells: &[SweepCell]) -> csv::Result<()> {
        let texts = cells.iter().map(|cell| match cell {
            SweepCell::Whole(n) => n.to_string(),
            SweepCell::Number(Some(x)) => format!("{x:?}"),
            SweepCell::Number(None) => String::new(),
            SweepCell::Text(text) => content(text).into_owned(),
        });
        self.0.write_record(texts)
    }

    /// The bytes of the file.
    pub fn finish(self) -> std::io::Result<Vec<u8>> {
        self.0.into_inner().map_err(|e| e.into_error())
    }
}

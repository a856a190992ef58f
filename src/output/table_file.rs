//! A table that is written row by row.

use super::folder::naming;
use crate::table::{Cell, Format};
use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::PathBuf;

#[derive(Debug)]
pub(super) struct TableFile {
    path: PathBuf,
    format: &'static Format,
    columns: Vec<String>,
    writer: BufWriter<File>,
    /// The row being composed: rows reach the file whole, however the run ends.
    line: Vec<u8>,
}

impl TableFile {
    /// Creates a file that is not there yet, locks it against other runs and writes the header.
    pub(super) fn create(
        path: PathBuf,
        format: &'static Format,
        columns: impl IntoIterator<Item = String>,
    ) -> io::Result<TableFile> {
        let file = File::create_new(&path).map_err(naming(&path))?;
        // Not on Windows, where a lock would keep readers out; where a file system has no locks, nobody is warned.
        if cfg!(unix) {
            let _ = file.try_lock();
        }
        let mut table = TableFile {
            path,
            format,
            columns: columns.into_iter().collect(),
            writer: BufWriter::new(file),
            line: Vec::new(),
        };
        (format.header)(&table.columns, &mut table.line);
        table.write()?;
        table.flush()?;
        Ok(table)
    }

    pub(super) fn row(&mut self, cells: &[Cell]) -> io::Result<()> {
        (self.format.row)(&self.columns, cells, &mut self.line);
        self.write()
    }

    fn write(&mut self) -> io::Result<()> {
        let result = self.writer.write_all(&self.line);
        self.line.clear();
        result.map_err(naming(&self.path))
    }

    pub(super) fn flush(&mut self) -> io::Result<()> {
        self.writer.flush().map_err(naming(&self.path))
    }

    /// Ends the table, on disk before a summary tells of it.
    pub(super) fn close(&mut self) -> io::Result<()> {
        self.flush()?;
        let file = self.writer.get_ref();
        file.sync_all().map_err(naming(&self.path))
    }
}

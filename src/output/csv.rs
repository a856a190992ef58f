//! A table that is written row by row.

use super::earlier::naming;
use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::PathBuf;

#[derive(Debug)]
pub(super) struct CsvFile {
    path: PathBuf,
    writer: BufWriter<File>,
    /// The row being composed: rows reach the file whole, however the run ends.
    line: Vec<u8>,
}

impl CsvFile {
    /// Creates a file that is not there yet, locks it against other runs and writes the header.
    pub(super) fn create(
        path: PathBuf,
        header: impl IntoIterator<Item = String>,
    ) -> io::Result<CsvFile> {
        let file = File::create_new(&path).map_err(|e| naming(&path, e))?;
        // Not on Windows, where a lock would keep readers out; where a file system has no locks, nobody is warned.
        if cfg!(unix) {
            let _ = file.try_lock();
        }
        let mut table = CsvFile {
            path,
            writer: BufWriter::new(file),
            line: Vec::new(),
        };
        header.into_iter().for_each(|name| table.text(&name));
        table.end_row()?;
        table.flush()?;
        Ok(table)
    }

    /// Appends a cell; names of the scene hold no comma and no quote.
    pub(super) fn text(&mut self, text: &str) {
        self.line.extend_from_slice(text.as_bytes());
        self.line.push(b',');
    }

    /// Appends the shortest decimal fraction that reads back as the same number.
    pub(super) fn number(&mut self, x: f64) {
        self.text(ryu::Buffer::new().format(x));
    }

    pub(super) fn end_row(&mut self) -> io::Result<()> {
        if let Some(last) = self.line.last_mut() {
            *last = b'\n';
        }
        let result = self.writer.write_all(&self.line);
        self.line.clear();
        result.map_err(|e| naming(&self.path, e))
    }

    pub(super) fn flush(&mut self) -> io::Result<()> {
        self.writer.flush().map_err(|e| naming(&self.path, e))
    }

    /// Ends the table, on disk before a summary tells of it.
    pub(super) fn close(&mut self) -> io::Result<()> {
        self.flush()?;
        let file = self.writer.get_ref();
        file.sync_all().map_err(|e| naming(&self.path, e))
    }
}

//! A table that is written row by row.

use super::folder::naming;
use crate::table::{Cell, Format};
use std::fs::{File, OpenOptions, TryLockError};
use std::io::{self, BufWriter, ErrorKind, Seek, SeekFrom, Write};
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
        let mut table = TableFile::new(path, format, columns, file);
        (format.header)(&table.columns, &mut table.line);
        table.write()?;
        table.flush()?;
        Ok(table)
    }

    /// Opens a file again that was written before, and locks it; it must have `size` bytes at least.
    pub(super) fn reopen(
        path: PathBuf,
        format: &'static Format,
        columns: impl IntoIterator<Item = String>,
        size: u64,
    ) -> io::Result<TableFile> {
        let file = OpenOptions::new().write(true).open(&path);
        let file = file.map_err(naming(&path))?;
        if cfg!(unix) && matches!(file.try_lock(), Err(TryLockError::WouldBlock)) {
            return Err(ErrorKind::WouldBlock.into());
        }
        if file.metadata().map_err(naming(&path))?.len() < size {
            let message = format!("`{}` has lost rows", path.display());
            return Err(io::Error::new(ErrorKind::InvalidData, message));
        }
        Ok(TableFile::new(path, format, columns, file))
    }

    /// Goes on after `size` bytes; what follows them is lost.
    pub(super) fn cut(&mut self, size: u64) -> io::Result<()> {
        let file = self.writer.get_mut();
        let cut = file
            .set_len(size)
            .and_then(|()| file.seek(SeekFrom::End(0)).map(drop));
        cut.map_err(naming(&self.path))
    }

    fn new(
        path: PathBuf,
        format: &'static Format,
        columns: impl IntoIterator<Item = String>,
        file: File,
    ) -> TableFile {
        TableFile {
            path,
            format,
            columns: columns.into_iter().collect(),
            writer: BufWriter::new(file),
            line: Vec::new(),
        }
    }

    /// The name of the file.
    pub(super) fn name(&self) -> String {
        let name = self.path.file_name().unwrap_or_default();
        name.to_string_lossy().into_owned()
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

    /// Sees that all rows so far are on disk, before another file tells of them; returns how many bytes they have.
    pub(super) fn sync(&mut self) -> io::Result<u64> {
        self.flush()?;
        let file = self.writer.get_ref();
        let size = file.sync_all().and_then(|()| Ok(file.metadata()?.len()));
        size.map_err(naming(&self.path))
    }
}

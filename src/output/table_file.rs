//! A table that is written row by row.

use crate::table::{Cell, Format};
use folder::{Digest, Digesting, Folder, OutputError, naming, naming_read, open, refuse_changed};
use std::fs::{File, OpenOptions};
use std::io::{self, ErrorKind, Seek, SeekFrom, Write};
use std::path::PathBuf;

/// Bytes that are written and digested at a time: a digest of single rows would cost several times as much a byte.
const PIECE: usize = 1 << 16;

#[derive(Debug)]
pub(super) struct TableFile {
    path: PathBuf,
    format: &'static Format,
    /// As the format writes them.
    columns: Vec<String>,
    file: File,
    /// What has been written.
    digesting: Digesting,
    /// Whole rows that are to be written: rows reach the file whole, however the run ends.
    rows: Vec<u8>,
}

impl TableFile {
    /// Creates a file that is not there yet, and writes the header.
    pub(super) fn create(
        folder: &Folder,
        name: &str,
        format: &'static Format,
        columns: Vec<String>,
    ) -> Result<TableFile, OutputError> {
        let file = folder.create(name)?;
        let path = folder.path().join(name);
        let mut table = TableFile::new(path, format, columns, file, Digesting::default());
        (format.header)(&table.columns, &mut table.rows);
        table.flush()?;
        Ok(table)
    }

    /// Opens a file again whose first rows were written before; what follows them is cut.
    ///
    /// # Errors
    /// [`OutputError::Changed`] where these rows are not what was written; the file is then as it was.
    pub(super) fn reopen(
        folder: &Folder,
        name: &str,
        format: &'static Format,
        columns: Vec<String>,
        written: Digest,
    ) -> Result<TableFile, OutputError> {
        let path = folder.path().join(name);
        let changed = |how: &str| OutputError::Changed {
            path: path.clone(),
            how: how.to_owned(),
        };
        let file = open(&path, OpenOptions::new().read(true).write(true));
        let file = file.map_err(|e| match e.kind() {
            ErrorKind::NotFound => changed("is missing"),
            _ => e.into(),
        })?;
        if Digest::read(&file, written.bytes).map_err(naming_read(&path))? != written {
            return Err(changed(
                "has lost rows, or was changed since its last checkpoint",
            ));
        }
        let digesting = Digesting::after(written);
        Ok(TableFile::new(path, format, columns, file, digesting))
    }

    /// Cuts what follows the rows that were written before.
    pub(super) fn cut(&mut self) -> io::Result<()> {
        let size = self.digesting.digest().bytes;
        let cut = self.file.set_len(size);
        let cut = cut.and_then(|()| self.file.seek(SeekFrom::Start(size)).map(drop));
        cut.map_err(naming(&self.path))
    }

    fn new(
        path: PathBuf,
        format: &'static Format,
        columns: Vec<String>,
        file: File,
        digesting: Digesting,
    ) -> TableFile {
        TableFile {
            path,
            format,
            columns: columns.iter().map(|name| (format.column)(name)).collect(),
            file,
            digesting,
            rows: Vec::new(),
        }
    }

    /// The name of the file.
    pub(super) fn name(&self) -> String {
        let name = self.path.file_name().unwrap_or_default();
        name.to_string_lossy().into_owned()
    }

    pub(super) fn row(&mut self, cells: &[Cell]) -> io::Result<()> {
        (self.format.row)(&self.columns, cells, &mut self.rows);
        match self.rows.len() < PIECE {
            true => Ok(()),
            false => self.flush(),
        }
    }

    pub(super) fn flush(&mut self) -> io::Result<()> {
        let written = self.file.write_all(&self.rows);
        match &written {
            Ok(()) => self.digesting.update(&self.rows),
            // a part of the rows may have found a place
            Err(_) => drop(self.cut()),
        }
        self.rows.clear();
        written.map_err(naming(&self.path))
    }

    /// Sees that all rows so far are on the disk, before another file tells of them.
    pub(super) fn sync(&mut self) -> io::Result<Digest> {
        self.flush()?;
        self.file.sync_all().map_err(naming(&self.path))?;
        Ok(self.digesting.digest())
    }

    /// Refuses rows that somebody else has changed, moved or deleted.
    ///
    /// # Errors
    /// [`OutputError::Changed`].
    pub(super) fn refuse_changed(&self) -> Result<(), OutputError> {
        let digest = self.digesting.digest();
        refuse_changed(&self.path, Some(&self.file), digest, u64::MAX)
    }
}

impl Drop for TableFile {
    /// A run that ends in an error keeps the rows before it.
    fn drop(&mut self) {
        // the error that ends the run is told, not what follows from it
        let _ = self.flush();
    }
}

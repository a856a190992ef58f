//! Rows of a sweep on disk: in every file a line that says of which sweep, then one JSON line a run, in the order in which runs
//! ended.
//!
//! A line is on the disk before the next run of its thread begins. A kill or a full disk may cut the last line, which is cut off
//! when its file is opened again; its run is made again.

use super::{FILES, RowPlaces, RowTiming, Sweep, SweepError, SweepRow};
use crate::study_file::StudyError;
use looselink::output::{OutputError, naming};
use serde::{Deserialize, Serialize};
use std::fmt;
use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{self, BufRead, BufReader, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::str::FromStr;

/// How names of files with rows begin and end.
const ROWS: &str = "runs";
/// How names of files with times begin.
const TIMES: &str = "times";
const EXTENSION: &str = ".jsonl";

/// A part of the runs of a sweep: those whose number leaves the remainder `index` - 1 when it is divided by `count`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Shard {
    index: usize,
    count: usize,
}

impl fmt::Display for Shard {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "{}/{}", self.index, self.count)
    }
}

impl Shard {
    /// All runs.
    pub const WHOLE: Shard = Shard { index: 1, count: 1 };

    /// True of a run that belongs to it.
    pub fn has(self, run: usize) -> bool {
        run % self.count == self.index - 1
    }

    /// The name of a file of the shard.
    fn file(self, name: &str) -> String {
        match self {
            Shard::WHOLE => format!("{name}{EXTENSION}"),
            Shard { index, count } => format!("{name}-{index}-of-{count}{EXTENSION}"),
        }
    }
}

impl FromStr for Shard {
    type Err = String;

    fn from_str(text: &str) -> Result<Shard, String> {
        let parts = text.split_once('/');
        let parts = parts.and_then(|(i, n)| Some((i.parse().ok()?, n.parse().ok()?)));
        match parts {
            Some((index, count)) if index >= 1 && index <= count => Ok(Shard { index, count }),
            _ => Err("write i/n with 1 <= i <= n, for example 3/16".to_owned()),
        }
    }
}

/// The first line of a file.
#[derive(Debug, PartialEq, Serialize, Deserialize)]
struct FileHead {
    /// See [`Sweep::digest`].
    sweep: String,
    version: String,
    title: String,
}

/// Where a row stands.
#[derive(Debug, Clone, Copy)]
pub(crate) struct RowPlace {
    file: u32,
    from: u64,
    length: u32,
}

/// The number of a run at the beginning of its line.
#[derive(Deserialize)]
struct Numbered {
    run: usize,
}

/// The rows of a sweep in a folder.
#[derive(Debug)]
pub struct Store {
    /// All files with rows.
    files: Vec<(PathBuf, File)>,
    places: RowPlaces,
    /// The file that receives rows, its end, and the file of their times.
    own: Option<(usize, u64, File)>,
}

impl Store {
    /// All rows of a sweep that a folder holds.
    ///
    /// # Errors
    /// Rows of another sweep or another version of the program; files that cannot be read or are damaged.
    pub fn read(folder: &Path, sweep: &Sweep) -> Result<Store, SweepError> {
        let mut store = Store {
            files: Vec::new(),
            places: RowPlaces::new(),
            own: None,
        };
        for path in row_files(folder)? {
            let file = File::open(&path).map_err(naming(&path))?;
            store.index(path, file, sweep)?;
        }
        Ok(store)
    }

    /// As [`Store::read`], and opens the file of a shard for more rows; the folder is created. With `anew` all rows and
    /// tables that are there are deleted first.
    ///
    /// # Errors
    /// As [`Store::read`]; another process writes the same shard; the files cannot be written.
    pub fn open(
        folder: &Path,
        sweep: &Sweep,
        shard: Shard,
        anew: bool,
    ) -> Result<Store, SweepError> {
        fs::create_dir_all(folder).map_err(naming(folder))?;
        let path = folder.join(shard.file(ROWS));
        let options = OpenOptions::new()
            .read(true)
            .append(true)
            .create(true)
            .clone();
        let mut own = options.open(&path).map_err(naming(&path))?;
        match own.try_lock() {
            Ok(()) => {}
            Err(TryLockError::WouldBlock) => {
                return Err(OutputError::Busy(folder.to_owned()).into());
            }
            Err(TryLockError::Error(e)) => return Err(naming(&path)(e).into()),
        }
        if anew {
            clear(folder, &path)?;
            own.set_len(0).map_err(naming(&path))?;
        }
        cut_torn_line(&mut own).map_err(naming(&path))?;
        if own.metadata().map_err(naming(&path))?.len() == 0 {
            let line = line_of(&FileHead::of(sweep))?;
            own.write_all(&line).map_err(naming(&path))?;
            own.sync_all().map_err(naming(&path))?;
        }
        let mut store = Store::read(folder, sweep)?;
        let end = own.metadata().map_err(naming(&path))?.len();
        let place = store.files.iter().position(|(known, _)| *known == path);
        let place = place.expect("the file has been created");
        store.files[place].1 = own;
        let times = folder.join(shard.file(TIMES));
        let mut file = options.open(&times).map_err(naming(&times))?;
        cut_torn_line(&mut file).map_err(naming(&times))?;
        store.own = Some((place, end, file));
        Ok(store)
    }

    /// Notes where the rows of a file stand. Of a run with two rows, which two shards may have made, the first counts.
    fn index(&mut self, path: PathBuf, file: File, sweep: &Sweep) -> Result<(), SweepError> {
        let fault = |message: String| StudyError::Plain(format!("`{}`: {message}", path.display()));
        let mut reader = BufReader::new(&file);
        let (mut line, mut from, mut number) = (Vec::new(), 0, 0);
        loop {
            line.clear();
            let length = reader.read_until(b'\n', &mut line).map_err(naming(&path))?;
            if length == 0 || line.last() != Some(&b'\n') {
                break;
            }
            number += 1;
            if number == 1 {
                let head: Option<FileHead> = serde_json::from_slice(&line).ok();
                head.ok_or_else(|| "it holds no rows of a sweep".to_owned())
                    .and_then(|head| head.check(sweep))
                    .map_err(fault)?;
            } else {
                let numbered: Numbered = serde_json::from_slice(&line)
                    .map_err(|e| fault(format!("line {number} is damaged: {e}")))?;
                let place = RowPlace {
                    file: self.files.len() as u32,
                    from,
                    length: length as u32,
                };
                self.places.entry(numbered.run).or_insert(place);
            }
            from += length as u64;
        }
        self.files.push((path, file));
        Ok(())
    }

    /// True of a run whose row is there.
    pub fn has(&self, run: usize) -> bool {
        self.places.contains_key(&run)
    }

    /// Number of rows of a shard.
    pub fn made(&self, shard: Shard) -> usize {
        self.places.keys().filter(|run| shard.has(**run)).count()
    }

    /// Number of rows.
    pub fn len(&self) -> usize {
        self.places.len()
    }

    /// True without rows.
    pub fn is_empty(&self) -> bool {
        self.places.is_empty()
    }

    /// Numbers of the runs whose rows are there, in order.
    pub fn numbers(&self) -> impl Iterator<Item = usize> {
        self.places.keys().copied()
    }

    /// The row of a run.
    ///
    /// # Errors
    /// It is not there, or cannot be read.
    pub fn row(&self, run: usize) -> Result<SweepRow, SweepError> {
        let Some(place) = self.places.get(&run) else {
            return Err(StudyError::Plain(format!("run {run} has not been made")).into());
        };
        let (path, file) = &self.files[place.file as usize];
        let mut line = vec![0; place.length as usize];
        let mut file: &File = file;
        file.seek(SeekFrom::Start(place.from))
            .map_err(naming(path))?;
        file.read_exact(&mut line).map_err(naming(path))?;
        serde_json::from_slice(&line).map_err(|e| {
            let message = format!("`{}`: the row of run {run} is damaged: {e}", path.display());
            StudyError::Plain(message).into()
        })
    }

    /// Appends a row, and its time to another file; the row is on the disk when this returns.
    ///
    /// # Errors
    /// When it cannot be written.
    ///
    /// # Panics
    /// When the store was opened for reading.
    pub fn append(&mut self, row: &SweepRow, timing: &RowTiming) -> Result<(), SweepError> {
        let (file, end, times) = self.own.as_mut().expect("a store opened for writing");
        let (path, rows) = &mut self.files[*file];
        let line = line_of(row)?;
        let written = rows.write_all(&line).and_then(|()| rows.sync_data());
        if let Err(error) = written {
            // a part of a line would make the next one unreadable; if this fails too, the line is cut when the file is opened
            let _ = rows.set_len(*end);
            return Err(naming(path)(error).into());
        }
        let place = RowPlace {
            file: *file as u32,
            from: *end,
            length: line.len() as u32,
        };
        *end += line.len() as u64;
        self.places.insert(row.run, place);
        // it may be lost: it is no result
        Ok(times.write_all(&line_of(timing)?)?)
    }
}

impl FileHead {
    fn of(sweep: &Sweep) -> FileHead {
        FileHead {
            sweep: sweep.digest().to_owned(),
            version: env!("CARGO_PKG_VERSION").to_owned(),
            title: sweep.study.title.clone(),
        }
    }

    /// Refuses rows that would not be the same if they were made now.
    fn check(&self, sweep: &Sweep) -> Result<(), String> {
        let now = FileHead::of(sweep);
        if self.sweep != now.sweep {
            return Err(format!(
                "it holds rows of another study, scene or target (\"{}\"); choose another folder, or begin anew with --force (in Python `force=True`)",
                self.title
            ));
        }
        match self.version == now.version {
            true => Ok(()),
            false => Err(format!(
                "it holds rows of version {} of the program, and this is {}; choose another folder, or begin anew with --force (in Python `force=True`)",
                self.version, now.version
            )),
        }
    }
}

/// The times of all runs that a folder holds, in the order of their numbers; of a run that was made twice those of its first row.
///
/// # Errors
/// A file that cannot be read.
pub(super) fn timings(folder: &Path) -> Result<Vec<RowTiming>, SweepError> {
    let mut all = std::collections::BTreeMap::new();
    for path in time_files(folder)? {
        let text = fs::read_to_string(&path).map_err(naming(&path))?;
        // a line that a kill has cut is no loss
        let lines = text
            .lines()
            .filter_map(|line| serde_json::from_str(line).ok());
        for timing in lines {
            let timing: RowTiming = timing;
            all.entry(timing.run).or_insert(timing);
        }
    }
    Ok(all.into_values().collect())
}

/// Deletes the rows, times and tables of a folder but one file of rows, which is open.
///
/// # Errors
/// Another process writes to one of the files; nothing is then deleted.
fn clear(folder: &Path, own: &Path) -> Result<(), SweepError> {
    let mut others = row_files(folder)?;
    others.retain(|path| path != own);
    let mut locked = Vec::new();
    for path in &others {
        let file = File::open(path).map_err(naming(path))?;
        match file.try_lock() {
            Ok(()) => locked.push(file),
            Err(TryLockError::WouldBlock) => {
                return Err(OutputError::Busy(folder.to_owned()).into());
            }
            Err(TryLockError::Error(e)) => return Err(naming(path)(e).into()),
        }
    }
    let tables = FILES.iter().map(|name| folder.join(name));
    let all = tables.chain(others).chain(time_files(folder)?);
    all.into_iter().try_for_each(|path| remove(&path))
}

/// Deletes a file that may not be there.
pub(super) fn remove(path: &Path) -> Result<(), SweepError> {
    match fs::remove_file(path) {
        Err(e) if e.kind() != io::ErrorKind::NotFound => Err(naming(path)(e).into()),
        _ => Ok(()),
    }
}

fn row_files(folder: &Path) -> Result<Vec<PathBuf>, SweepError> {
    files(folder, ROWS)
}

fn time_files(folder: &Path) -> Result<Vec<PathBuf>, SweepError> {
    files(folder, TIMES)
}

/// The files of all shards, in the order of their names.
fn files(folder: &Path, start: &str) -> Result<Vec<PathBuf>, SweepError> {
    let mut files = Vec::new();
    for entry in fs::read_dir(folder).map_err(naming(folder))? {
        let path = entry.map_err(naming(folder))?.path();
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        let rest = name.strip_prefix(start);
        let middle = rest.and_then(|rest| rest.strip_suffix(EXTENSION));
        if middle.is_some_and(|middle| middle.is_empty() || middle.starts_with('-')) {
            files.push(path);
        }
    }
    files.sort();
    Ok(files)
}

/// Cuts what stands after the last line feed.
fn cut_torn_line(file: &mut File) -> io::Result<()> {
    let mut reader = BufReader::new(&*file);
    let (mut whole, mut line) = (0, Vec::new());
    loop {
        line.clear();
        let length = reader.read_until(b'\n', &mut line)?;
        if length == 0 || line.last() != Some(&b'\n') {
            return file.set_len(whole);
        }
        whole += length as u64;
    }
}

fn line_of(value: &impl Serialize) -> io::Result<Vec<u8>> {
    let mut line = serde_json::to_vec(value)?;
    line.push(b'\n');
    Ok(line)
}

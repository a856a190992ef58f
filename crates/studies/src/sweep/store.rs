//! Rows of a sweep on disk: in every file a line that says of which sweep, then one JSON line a run, in the order in which runs
//! ended. Each line ends with its own CRC-32.
//!
//! A line is on the disk before the next run of its thread begins. A kill or a full disk may cut the last line, which is cut off
//! when its file is opened again; its run is made again.

use super::{FILES, RowPlaces, RowTiming, Sweep, SweepError, SweepRow};
use crate::study_file::StudyError;
use folder::{
    Digesting, Folder, Kind, OutputError, line_of, naming, naming_read, open, open_to_read,
    refuse_changed, refuse_moved, value_of,
};
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
/// What to do with rows that cannot be continued.
const ELSEWHERE: &str =
    "choose another folder, or begin anew with --force (in Python `force=True`)";

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
#[serde(deny_unknown_fields)]
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
    files: Vec<RowFile>,
    places: RowPlaces,
    own: Option<OwnRows>,
    /// Locked as long as rows may come, and until tables are made of them.
    folder: Option<Folder>,
}

/// A file with rows.
#[derive(Debug)]
struct RowFile {
    path: PathBuf,
    file: File,
    /// What has been read and written.
    digesting: Digesting,
}

/// The file that receives rows.
#[derive(Debug)]
struct OwnRows {
    /// Its place among all files.
    file: usize,
    times: (PathBuf, File),
}

impl Store {
    /// All rows of a sweep that a folder holds, also those that were brought there.
    ///
    /// # Errors
    /// Rows of another sweep or another version of the program; files that cannot be read or are damaged.
    pub fn read(folder: &Path, sweep: &Sweep) -> Result<Store, SweepError> {
        let mut store = Store {
            files: Vec::new(),
            places: RowPlaces::new(),
            own: None,
            folder: None,
        };
        for name in names(folder, ROWS)? {
            let path = folder.join(name);
            let file = open_to_read(&path)?;
            store.index(path, file, sweep)?;
        }
        Ok(store)
    }

    /// As [`Store::read`], for tables of these rows: nobody begins the sweep anew meanwhile.
    ///
    /// # Errors
    /// As [`Store::read`]; a sweep that begins anew; files of others that have the names of its tables.
    pub fn to_merge(path: &Path, sweep: &Sweep) -> Result<Store, SweepError> {
        if !path.is_dir() {
            let message = format!("`{}` is no folder with rows of a sweep", path.display());
            return Err(StudyError::Plain(message).into());
        }
        let folder = Folder::share(path, kind())?;
        let mut store = Store::read(path, sweep)?;
        store.folder = Some(folder);
        Ok(store)
    }

    /// As [`Store::read`], and opens the file of a shard for more rows; the folder is created. With `anew` all rows and
    /// tables that are there are set aside first. Where this is refused, nothing is changed.
    ///
    /// # Errors
    /// As [`Store::read`]; another process writes the same shard; files of others that have the names of its files; the files
    /// cannot be written; a shard of a bisection.
    pub fn open(path: &Path, sweep: &Sweep, shard: Shard, anew: bool) -> Result<Store, SweepError> {
        sweep.check_shard(shard)?;
        let names = [ROWS, TIMES].map(|name| shard.file(name));
        let folder = match anew {
            true => {
                let mut folder = Folder::claim(path, with_rows(path)?, true)?;
                folder.begin(names.iter().cloned())?;
                folder
            }
            false => {
                let mut folder = Folder::share(path, kind())?;
                // rows that are refused are refused before anything is listed
                Store::read(path, sweep)?;
                folder.adopt(&names)?;
                folder
            }
        };
        Store::receiving(folder, sweep, &names)
    }

    /// Opens the files that receive rows and their times.
    fn receiving(folder: Folder, sweep: &Sweep, names: &[String; 2]) -> Result<Store, SweepError> {
        let [path, times_path] = names.each_ref().map(|name| folder.path().join(name));
        let mut options = OpenOptions::new();
        options.read(true).append(true).create(true);
        let mut rows = open(&path, &mut options)?;
        match rows.try_lock() {
            Err(TryLockError::WouldBlock) => {
                return Err(OutputError::Busy(folder.path().to_owned()).into());
            }
            // a file system without locks: the documentation says what that means
            Ok(()) | Err(TryLockError::Error(_)) => {}
        }
        cut_torn_line(&mut rows).map_err(naming(&path))?;
        if rows.metadata().map_err(naming(&path))?.len() == 0 {
            let line = line_of(&FileHead::of(sweep))?;
            rows.write_all(&line).map_err(naming(&path))?;
            rows.sync_all().map_err(naming(&path))?;
        }
        let mut times = open(&times_path, &mut options)?;
        // a time may be lost, but no line is to follow a part of one
        cut_torn_line(&mut times).map_err(naming(&times_path))?;
        let mut store = Store::read(folder.path(), sweep)?;
        let file = store.files.iter().position(|known| known.path == path);
        let file = file.expect("the file has been created");
        store.files[file].file = rows;
        store.own = Some(OwnRows {
            file,
            times: (times_path, times),
        });
        store.folder = Some(folder);
        Ok(store)
    }

    /// Notes where the rows of a file stand. Of a run with two rows, which two shards may have made, the first counts.
    fn index(&mut self, path: PathBuf, file: File, sweep: &Sweep) -> Result<(), SweepError> {
        let fault = |message: String| StudyError::Plain(format!("`{}`: {message}", path.display()));
        let mut reader = BufReader::new(&file);
        let (mut line, mut number) = (Vec::new(), 0);
        let mut digesting = Digesting::default();
        loop {
            line.clear();
            let length = reader
                .read_until(b'\n', &mut line)
                .map_err(naming_read(&path))?;
            if length == 0 || line.last() != Some(&b'\n') {
                break;
            }
            number += 1;
            if number == 1 {
                FileHead::read(&line)
                    .and_then(|head| head.check(sweep))
                    .map_err(fault)?;
            } else {
                let numbered: Option<Numbered> = value_of(&line);
                let numbered = numbered.ok_or_else(|| {
                    fault(format!(
                        "line {number} is damaged; without that line its run is made again"
                    ))
                })?;
                let place = RowPlace {
                    file: self.files.len() as u32,
                    from: digesting.digest().bytes,
                    length: length as u32,
                };
                self.places.entry(numbered.run).or_insert(place);
            }
            digesting.update(&line);
        }
        // a file without a whole line is nobody's, unless the manifest lists it
        if number > 0 {
            self.files.push(RowFile {
                path,
                file,
                digesting,
            });
        }
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
        let RowFile { path, file, .. } = &self.files[place.file as usize];
        let mut line = vec![0; place.length as usize];
        let mut file: &File = file;
        file.seek(SeekFrom::Start(place.from))
            .map_err(naming_read(path))?;
        file.read_exact(&mut line).map_err(naming_read(path))?;
        let row = value_of(&line).filter(|row: &SweepRow| row.run == run);
        row.ok_or_else(|| {
            let message = format!("`{}`: the row of run {run} is damaged", path.display());
            StudyError::Plain(message).into()
        })
    }

    /// Refuses rows that somebody else has moved, deleted or changed since they were read or written.
    ///
    /// # Errors
    /// [`OutputError::Changed`].
    pub(super) fn refuse_changed(&self) -> Result<(), SweepError> {
        self.folder.iter().try_for_each(Folder::refuse_moved)?;
        for (place, rows) in self.files.iter().enumerate() {
            let known = rows.digesting.digest();
            let counts = match self.own.as_ref().is_some_and(|own| own.file == place) {
                true => u64::MAX,
                // another shard may add rows
                false => known.bytes,
            };
            refuse_changed(&rows.path, Some(&rows.file), known, counts)?;
        }
        Ok(())
    }

    /// Appends a row, and its time to another file; the row is on the disk when this returns.
    ///
    /// # Errors
    /// When it cannot be written.
    ///
    /// # Panics
    /// When the store was opened for reading.
    pub fn append(&mut self, row: &SweepRow, timing: &RowTiming) -> Result<(), SweepError> {
        let own = self.own.as_mut().expect("a store opened for writing");
        let RowFile {
            path,
            file,
            digesting,
        } = &mut self.files[own.file];
        // the next runs would be made for nothing
        refuse_moved(path, file)?;
        let line = line_of(row)?;
        let end = digesting.digest().bytes;
        let written = file.write_all(&line).and_then(|()| file.sync_data());
        if let Err(error) = written {
            // a part of a line would make the next one unreadable; if this fails too, the line is cut when the file is opened
            let _ = file.set_len(end);
            return Err(naming(path)(error).into());
        }
        let place = RowPlace {
            file: own.file as u32,
            from: end,
            length: line.len() as u32,
        };
        digesting.update(&line);
        self.places.insert(row.run, place);
        // it may be lost: it is no result
        let time = line_of(timing)?;
        let (path, times) = &mut own.times;
        Ok(times.write_all(&time).map_err(naming(path))?)
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

    fn read(line: &[u8]) -> Result<FileHead, String> {
        if let Some(head) = value_of(line) {
            return Ok(head);
        }
        // one of this version has a further key, which a fault may have renamed
        let is_earlier = serde_json::from_slice::<FileHead>(line).is_ok();
        Err(match is_earlier {
            true => format!(
                "its rows are of an earlier program, which gave them no checksums; {ELSEWHERE}"
            ),
            false => {
                "it holds no rows of a sweep, or its first line, which names the sweep, is damaged; \
                 without this file its runs are made again"
                    .to_owned()
            }
        })
    }

    /// Refuses rows that would not be the same if they were made now.
    fn check(&self, sweep: &Sweep) -> Result<(), String> {
        let now = FileHead::of(sweep);
        if self.sweep != now.sweep {
            return Err(format!(
                "it holds rows of another study, scene or target (\"{}\"); {ELSEWHERE}",
                self.title
            ));
        }
        match self.version == now.version {
            true => Ok(()),
            false => Err(format!(
                "it holds rows of version {} of the program, and this is {}; {ELSEWHERE}",
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
    for name in names(folder, TIMES)? {
        let path = folder.join(name);
        let mut bytes = Vec::new();
        let mut file = open_to_read(&path)?;
        file.read_to_end(&mut bytes).map_err(naming_read(&path))?;
        // a line that a kill has cut is no loss, nor is a damaged one
        for timing in bytes.split(|byte| *byte == b'\n').filter_map(value_of) {
            let timing: RowTiming = timing;
            all.entry(timing.run).or_insert(timing);
        }
    }
    Ok(all.into_values().collect())
}

/// A sweep as a kind of result, without its rows.
pub(super) fn kind() -> Kind {
    Kind {
        name: "a sweep",
        files: FILES.map(str::to_owned).to_vec(),
    }
}

/// A sweep as a kind of result, with the names of rows and times that a folder has.
fn with_rows(folder: &Path) -> Result<Kind, SweepError> {
    let mut kind = kind();
    if folder.is_dir() {
        kind.files.extend(names(folder, ROWS)?);
        kind.files.extend(names(folder, TIMES)?);
    }
    Ok(kind)
}

/// The names of the files of all shards in a folder, sorted.
fn names(folder: &Path, start: &str) -> Result<Vec<String>, SweepError> {
    let mut names = Vec::new();
    for entry in fs::read_dir(folder).map_err(naming_read(folder))? {
        let name = entry.map_err(naming_read(folder))?.file_name();
        let Some(name) = name.to_str() else { continue };
        let rest = name.strip_prefix(start);
        let middle = rest.and_then(|rest| rest.strip_suffix(EXTENSION));
        let shard = middle.and_then(|middle| match middle {
            "" => Some(Shard::WHOLE),
            _ => middle.strip_prefix('-')?.replace("-of-", "/").parse().ok(),
        });
        if shard.is_some_and(|shard| shard.file(start) == name) {
            names.push(name.to_owned());
        }
    }
    names.sort();
    Ok(names)
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

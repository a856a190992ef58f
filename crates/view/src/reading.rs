//! Reads files of a result, all of the same run.

use folder::{
    Kind, MANIFEST, OutputError, add_to, earlier_result, held, lists, naming_read, verify,
};
use looselink::output;
use looselink::registry::Registry;
use looselink::scene::SceneError;
use std::io;
use std::path::{Path, PathBuf};
use std::thread::sleep;
use std::time::{Duration, Instant};

/// The file of the page in the folder of a result.
pub const PAGE: &str = "view.html";

/// A run with its page, as a kind of result.
pub fn kind() -> Kind {
    output::kind(&Registry::standard().formats, &[PAGE])
}

/// Why a result cannot be shown.
#[derive(Debug, thiserror::Error)]
pub enum ViewError {
    /// A folder without a result, or with one that is damaged.
    #[error("{0}")]
    Result(String),
    /// Its scene has a fault.
    #[error(transparent)]
    Scene(SceneError),
    /// The system refused; the message names the file.
    #[error("{0}")]
    Io(#[from] io::Error),
    /// The page cannot stand beside the result.
    #[error(transparent)]
    Output(#[from] OutputError),
}

impl From<SceneError> for ViewError {
    /// The file of the scene may have been replaced by any other.
    fn from(error: SceneError) -> ViewError {
        ViewError::Scene(error.without_contents())
    }
}

/// How long a run is waited for that has no rows yet. Its rows reach the disk every second, on a busy machine some seconds later.
const PATIENCE: Duration = Duration::from_secs(10);
/// Time between two attempts.
const PAUSE: Duration = Duration::from_millis(5);

/// Files by which runs are told apart: a repeated run differs by its timing only.
const RUN: [&str; 4] = [MANIFEST, "summary.json", "scene.toml", output::TIMING];

/// What tells a run in a folder from another one, and one under way from its end.
#[derive(PartialEq)]
struct Mark([Option<Vec<u8>>; RUN.len()]);

impl Mark {
    fn of(folder: &Path) -> Mark {
        Mark(RUN.map(|file| folder::read(&folder.join(file)).ok()))
    }
}

/// Puts a page beside the result that it shows: made again where that has ended or has been replaced meanwhile.
pub(crate) fn keep_page(
    folder: &Path,
    mut page: impl FnMut() -> Result<String, ViewError>,
) -> Result<PathBuf, ViewError> {
    let started = Instant::now();
    while started.elapsed() < PATIENCE {
        let mark = Mark::of(folder);
        let page = page()?;
        let files = [(PAGE, page.as_bytes())];
        if add_to(folder, &kind(), &files, || Mark::of(folder) == mark)? {
            return Ok(folder.join(PAGE));
        }
    }
    Err(replaced_again(folder))
}

/// True of a result with a page that the program has written.
pub fn has_page(folder: &Path) -> bool {
    lists(folder, PAGE) && folder.join(PAGE).is_file()
}

fn replaced_again(folder: &Path) -> ViewError {
    let name = folder.display();
    ViewError::Result(format!(
        "`{name}` is being replaced by one run after the other"
    ))
}

/// Reads files of a result, all of the same run: again where that has ended or has been replaced meanwhile, or has no rows yet.
pub(crate) fn of_one_run<T>(
    folder: &Path,
    load: impl Fn() -> Result<T, ViewError>,
) -> Result<T, ViewError> {
    let started = Instant::now();
    loop {
        let before = Mark::of(folder);
        let loaded = load();
        let is_of_one_run = Mark::of(folder) == before;
        let is_late = matches!(loaded, Err(ViewError::Result(_)));
        let is_awaited = is_late && is_under_way(folder, &before);
        if is_of_one_run && !is_awaited {
            return loaded;
        }
        if started.elapsed() < PATIENCE {
            sleep(PAUSE);
            continue;
        }
        return match (loaded, earlier_result(folder)) {
            (Err(ViewError::Result(why)), Some(earlier)) if is_of_one_run => {
                let earlier = earlier.display();
                Err(ViewError::Result(format!(
                    "{why}; the earlier result is in `{earlier}`"
                )))
            }
            (loaded, _) if is_of_one_run => loaded,
            _ => Err(replaced_again(folder)),
        };
    }
}

/// True of a folder to which a run writes, or wrote until it was killed.
fn is_under_way(folder: &Path, Mark([manifest, summary, ..]): &Mark) -> bool {
    let read = |bytes: &Vec<u8>| serde_json::from_slice::<serde_json::Value>(bytes);
    let goes_on = |bytes| read(bytes).is_ok_and(|summary| summary["status"] == "incomplete");
    // for a moment the manifest of a result that begins is empty
    let of_a_run = held(folder).is_none_or(|held| held == kind().name);
    manifest.is_some() && of_a_run && summary.as_ref().is_none_or(goes_on)
}

/// A file of a result, whose table has a digest once the run `has_ended`.
pub(crate) fn read(folder: &Path, name: &str, has_ended: bool) -> Result<Vec<u8>, ViewError> {
    let path = folder.join(name);
    let bytes = folder::read(&path).map_err(|e| match e.kind() {
        io::ErrorKind::NotADirectory => ViewError::Result(format!(
            "`{}` is a file, not the folder of a result; `looselink run` writes one",
            folder.display()
        )),
        io::ErrorKind::NotFound => ViewError::Result(missing(folder, name)),
        _ => naming_read(&path)(e).into(),
    })?;
    verify(folder, name, &bytes, has_ended).map_err(|e| match e {
        OutputError::Io(e) => e.into(),
        changed => ViewError::Result(changed.to_string()),
    })?;
    Ok(bytes)
}

/// Why a folder without a file holds no result.
fn missing(folder: &Path, name: &str) -> String {
    let place = folder.display();
    match held(folder) {
        Some(held) if held != kind().name => format!("`{place}` holds {held}, not a run"),
        Some(_) => format!(
            "`{place}` holds a part of a run: it has no `{name}`, which was deleted, or the run ended as it began"
        ),
        None => format!("`{place}` holds no result of `looselink run`: it has no `{name}`"),
    }
}

#[cfg(test)]
mod tests {
    use super::of_one_run;
    use std::cell::Cell;
    use std::fs;

    #[test]
    fn files_are_read_again_when_another_run_has_come_between() {
        let folder = tempfile::tempdir().unwrap();
        let summary = folder.path().join("summary.json");
        fs::write(&summary, "0").unwrap();
        // replaced so many times while it is read
        for (replaced, expected) in [(0, Some(0)), (3, Some(3)), (usize::MAX, None)] {
            let reads = Cell::new(0);
            let read = of_one_run(folder.path(), || {
                let n = reads.get();
                reads.set(n + 1);
                if n < replaced {
                    fs::write(&summary, (n + 1).to_string()).unwrap();
                }
                Ok(n)
            });
            assert_eq!(read.ok(), expected);
            fs::write(&summary, "0").unwrap();
        }
    }
}

//! The journal of a campaign: what it has measured so far, and for how long.

use miette::{IntoDiagnostic, Result, WrapErr, miette};
use rayon::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::collections::HashMap;
use std::fs::{self, File, OpenOptions};
use std::io::Write;
use std::path::Path;
use std::sync::Mutex;
use std::time::Instant;

/// Finished items by their name. An item that is in the journal is not measured again.
pub struct Journal {
    lines: Mutex<Lines>,
    begun: Instant,
    /// Duration of the parts before an interruption \[s\].
    before: f64,
}

struct Lines {
    done: HashMap<String, Value>,
    file: Option<File>,
}

/// A line of the file.
#[derive(Serialize, Deserialize)]
struct Line {
    /// Duration of the campaign when the item was finished \[s\].
    at: f64,
    item: String,
    value: Value,
}

impl Journal {
    /// Opens the journal of a campaign; with `resume` its items count, else it begins anew.
    ///
    /// # Errors
    /// A file that cannot be read or written, or has a line other than the last that is none.
    pub fn open(path: &Path, resume: bool) -> Result<Journal> {
        let name = path.display().to_string();
        let text = match path.exists() && resume {
            true => fs::read_to_string(path).into_diagnostic()?,
            false => String::new(),
        };
        let (mut done, mut before) = (HashMap::new(), 0.0_f64);
        let mut sound = String::new();
        for (number, line) in text.lines().enumerate() {
            match serde_json::from_str::<Line>(line) {
                Ok(Line { at, item, value }) => {
                    before = before.max(at);
                    done.insert(item, value);
                    sound += line;
                    sound.push('\n');
                }
                // the interruption cut it off
                Err(_) if number + 1 == text.lines().count() => {}
                Err(e) => return Err(miette!("{name}, line {}: {e}", number + 1)),
            }
        }
        let file = fs::write(path, sound).and_then(|()| OpenOptions::new().append(true).open(path));
        let file = file
            .into_diagnostic()
            .wrap_err_with(|| format!("cannot write {name}"))?;
        Ok(Journal::of(done, Some(file), before))
    }

    /// A journal without a file.
    pub fn unkept() -> Journal {
        Journal::of(HashMap::new(), None, 0.0)
    }

    fn of(done: HashMap<String, Value>, file: Option<File>, before: f64) -> Journal {
        let lines = Mutex::new(Lines { done, file });
        Journal {
            lines,
            begun: Instant::now(),
            before,
        }
    }

    /// Duration of the campaign so far, without the time between its parts \[s\].
    pub fn seconds(&self) -> f64 {
        self.before + self.begun.elapsed().as_secs_f64()
    }

    /// What the journal has under this name; else it is measured now.
    ///
    /// # Errors
    /// Those of `measure`; a journal that cannot be written, an item of another kind.
    pub fn item<T: Serialize + DeserializeOwned>(
        &self,
        name: &str,
        measure: impl FnOnce() -> Result<T>,
    ) -> Result<T> {
        let known = self.lines().done.get(name).cloned();
        let value = match known {
            Some(value) => value,
            None => {
                let value = serde_json::to_value(measure()?).into_diagnostic()?;
                self.keep(name, &value)?;
                value
            }
        };
        // the same value whether it was measured now or before
        serde_json::from_value(value)
            .into_diagnostic()
            .wrap_err_with(|| format!("{name} in the journal"))
    }

    /// Items side by side on so many threads; the results have the order of `keys`.
    ///
    /// # Errors
    /// That of an item that failed.
    pub fn items<K: Sync, T: Serialize + DeserializeOwned + Send>(
        &self,
        keys: &[K],
        threads: usize,
        name: impl Fn(&K) -> String + Sync,
        measure: impl Fn(&K) -> Result<T> + Sync,
    ) -> Result<Vec<T>> {
        // after a failure nothing else begins
        pool(threads).install(|| {
            let keys = keys.par_iter().with_max_len(1);
            keys.map(|key| self.item(&name(key), || measure(key)))
                .collect()
        })
    }

    fn keep(&self, name: &str, value: &Value) -> Result<()> {
        let at = self.seconds();
        let (item, value) = (name.to_owned(), value.clone());
        let line = Line { at, item, value };
        let text = serde_json::to_string(&line).into_diagnostic()?;
        let mut lines = self.lines();
        if let Some(file) = &mut lines.file {
            writeln!(file, "{text}")
                .into_diagnostic()
                .wrap_err("cannot write the journal")?;
            eprintln!("{at:7.0} s  {name}");
        }
        match lines.done.insert(line.item, line.value) {
            None => Ok(()),
            Some(_) => Err(miette!("two items have the name {name}")),
        }
    }

    fn lines(&self) -> std::sync::MutexGuard<'_, Lines> {
        self.lines.lock().unwrap_or_else(|e| e.into_inner())
    }
}

/// Does something with every key on so many threads; results in the order of `keys`.
pub fn each<K: Sync, T: Send>(keys: &[K], threads: usize, work: impl Fn(&K) -> T + Sync) -> Vec<T> {
    pool(threads).install(|| keys.par_iter().with_max_len(1).map(&work).collect())
}

fn pool(threads: usize) -> ThreadPool {
    let pool = ThreadPoolBuilder::new().num_threads(threads).build();
    pool.expect("threads can be started")
}

#[cfg(test)]
mod tests {
    use super::Journal;
    use miette::miette;
    use std::fs;

    #[test]
    fn an_interrupted_campaign_measures_only_the_rest() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("journal");
        let all = |journal: &Journal, broken: usize| {
            let measured = std::sync::Mutex::new(Vec::new());
            let found = journal.items(&[0, 1, 2, 3], 2, usize::to_string, |key| {
                measured.lock().unwrap().push(*key);
                match *key == broken {
                    true => Err(miette!("interrupted")),
                    false => Ok((*key, 0.1 * *key as f64)),
                }
            });
            let mut measured = measured.into_inner().unwrap();
            measured.sort_unstable();
            (found, measured)
        };
        let (found, _) = all(&Journal::open(&path, false).unwrap(), 2);
        assert!(found.unwrap_err().to_string().contains("interrupted"));
        // a line that was being written
        let text = fs::read_to_string(&path).unwrap() + "{\"at\":1";
        let known = text.lines().count() - 1;
        fs::write(&path, text).unwrap();
        let (found, measured) = all(&Journal::open(&path, true).unwrap(), 9);
        assert_eq!(found.unwrap(), [0, 1, 2, 3].map(|k| (k, 0.1 * k as f64)));
        assert_eq!(measured.len(), 4 - known);
        assert!(measured.contains(&2));
        // the whole of it is known now, and is forgotten without `resume`
        assert!(all(&Journal::open(&path, true).unwrap(), 9).1.is_empty());
        assert_eq!(all(&Journal::open(&path, false).unwrap(), 9).1.len(), 4);
    }

    #[test]
    fn what_is_known_is_not_measured_again() {
        let journal = Journal::unkept();
        let value = |v: f64| journal.item("x", || Ok(v)).unwrap();
        assert_eq!(value(1.0), 1.0);
        assert_eq!(value(2.0), 1.0);
    }

    #[test]
    fn a_broken_journal_is_refused_by_line() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("journal");
        fs::write(
            &path,
            "{\"at\":1,\"item\":\"a\",\"value\":1}\nno\n{\"at\":1,\"item\":\"b\",\"value\":1}\n",
        )
        .unwrap();
        let error = Journal::open(&path, true).err().unwrap();
        assert!(error.to_string().contains("line 2"), "{error}");
    }
}

//! A copy of the sources, whose records are all of its state.

use records::{RecordRegistry, Tree, check, root, write_notes};
use std::fs;
use std::path::{Path, PathBuf};
use tempfile::TempDir;
use walkdir::{DirEntry, WalkDir};

/// Endings of what is copied.
const COPIED: [&str; 9] = [
    "rs", "toml", "cpp", "hpp", "h", "csv", "md", "json", "jsonl",
];

pub struct SourceCopy(TempDir);

fn is_source(entry: &DirEntry) -> bool {
    let name = entry.file_name().to_string_lossy();
    entry.depth() == 0 || !(name.starts_with('.') || ["target", "out", "corpus"].contains(&&*name))
}

impl SourceCopy {
    /// The sources of the project; every record has their digests.
    pub fn new() -> SourceCopy {
        let copy = SourceCopy(TempDir::new().unwrap());
        let from = root().canonicalize().unwrap();
        for entry in WalkDir::new(&from).into_iter().filter_entry(is_source) {
            let entry = entry.unwrap();
            let ending = entry.path().extension().unwrap_or_default();
            if entry.file_type().is_file() && COPIED.iter().any(|copied| ending == *copied) {
                let to = copy.path(entry.path().strip_prefix(&from).unwrap());
                fs::create_dir_all(to.parent().unwrap()).unwrap();
                fs::copy(entry.path(), to).unwrap();
            }
        }
        fs::create_dir_all(copy.path("pages/records/state")).unwrap();
        let registry = RecordRegistry::read(copy.root()).unwrap();
        let tree = Tree::new(copy.root());
        for (name, record) in &registry.records {
            let digests = tree.digests(&registry.sources(record).unwrap()).unwrap();
            let text = serde_json::to_string(&digests).unwrap();
            copy.write(&format!("pages/records/state/{name}.json"), &text);
        }
        write_notes(copy.root()).unwrap();
        assert_eq!(copy.outdated(), [""; 0]);
        copy
    }

    pub fn root(&self) -> &Path {
        self.0.path()
    }

    pub fn path(&self, file: impl AsRef<Path>) -> PathBuf {
        self.root().join(file)
    }

    pub fn read(&self, file: &str) -> String {
        fs::read_to_string(self.path(file)).unwrap()
    }

    pub fn write(&self, file: &str, text: &str) {
        fs::write(self.path(file), text).unwrap();
    }

    /// Puts one text in the place of another, which stands in the file; hands back the earlier text of the file.
    pub fn change(&self, file: &str, from: &str, to: &str) -> String {
        let before = self.read(file);
        assert!(before.contains(from), "{file} has no {from:?}");
        self.write(file, &before.replacen(from, to, 1));
        before
    }

    /// What the gate says.
    pub fn outdated(&self) -> Vec<String> {
        check(self.root()).unwrap().outdated
    }

    /// The files of the records that are outdated, after a change of `file` which each line names.
    pub fn outdated_by(&self, file: &str) -> Vec<String> {
        let lines = self.outdated();
        let named = lines.iter().map(|line| {
            let rest = format!(" is of an earlier state: {file} changed; ");
            let (record, claim) = line.split_once(&rest).unwrap_or_else(|| panic!("{line}"));
            assert!(claim.contains(".md, "), "{line}");
            record.to_owned()
        });
        named.collect()
    }
}

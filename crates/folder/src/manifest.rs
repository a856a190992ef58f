//! Which files of a folder are the program's.

use crate::digest::Digest;
use crate::error::{OutputError, naming_read};
use crate::line::{line_of, value_of};
use crate::read;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::io::{self, Cursor, ErrorKind, Read, Seek, SeekFrom, Write};
use std::path::{Component, Path};

/// The file of the manifest. Each of its lines ends with its own CRC-32; the last line about a file counts.
pub const MANIFEST: &str = "manifest.jsonl";

/// How its first line begins.
const HEAD: &[u8] = b"{\"looselink\":";

/// A line.
#[derive(Debug, Serialize, Deserialize)]
#[serde(untagged)]
enum Line {
    /// The first one: what the folder holds.
    Head {
        looselink: String,
        /// True where the result has replaced another one, which stands aside until this one is whole.
        #[serde(default, skip_serializing_if = "std::ops::Not::not")]
        replaces: bool,
    },
    /// A file of the program and, of one that is written to its end, its digest.
    File {
        file: String,
        #[serde(flatten)]
        digest: Option<Digest>,
    },
}

/// What a manifest says.
#[derive(Debug, Default)]
pub(crate) struct Manifest {
    /// True of a file that is none.
    pub is_foreign: bool,
    /// What the folder holds; none of an empty manifest.
    pub kind: Option<String>,
    /// See [`Line::Head`].
    pub replaces: bool,
    /// The files of the program.
    pub files: BTreeMap<String, Option<Digest>>,
}

impl Manifest {
    /// Reads a manifest. What is no line of it counts for nothing: then a file is not listed, and nobody touches it.
    pub fn read(file: &mut (impl Read + Seek)) -> io::Result<Manifest> {
        let mut bytes = Vec::new();
        file.seek(SeekFrom::Start(0))?;
        file.read_to_end(&mut bytes)?;
        Ok(Manifest::parse(&bytes))
    }

    /// That of a folder, if it has one.
    pub fn of(folder: &Path) -> io::Result<Option<Manifest>> {
        let path = folder.join(MANIFEST);
        match read(&path) {
            Ok(bytes) => Ok(Some(Manifest::parse(&bytes))),
            Err(e) if matches!(e.kind(), ErrorKind::NotFound | ErrorKind::NotADirectory) => {
                Ok(None)
            }
            Err(e) => Err(naming_read(&path)(e)),
        }
    }

    fn parse(bytes: &[u8]) -> Manifest {
        let mut manifest = Manifest::default();
        // a kill may cut the first line
        let is_cut =
            !bytes.contains(&b'\n') && (bytes.starts_with(HEAD) || HEAD.starts_with(bytes));
        for line in bytes.split(|byte| *byte == b'\n').filter_map(value_of) {
            match line {
                Line::Head {
                    looselink,
                    replaces,
                } => {
                    manifest.kind = Some(looselink);
                    manifest.replaces = replaces;
                }
                Line::File { file, digest } if is_plain(&file) => {
                    manifest.files.insert(file, digest);
                }
                Line::File { .. } => {}
            }
        }
        manifest.is_foreign = manifest.kind.is_none() && !is_cut;
        manifest
    }

    /// Adds lines: what the folder holds, where that is new, and files with their digests. They are on the disk when this returns.
    pub fn add(
        &mut self,
        to: &mut (impl Read + Seek + Write),
        kind: &str,
        files: impl IntoIterator<Item = (String, Option<Digest>)>,
    ) -> io::Result<()> {
        let mut lines = Vec::new();
        // a line that a kill has cut ends here
        if to.seek(SeekFrom::End(0))? > 0 {
            let mut last = [0];
            to.seek(SeekFrom::End(-1))?;
            to.read_exact(&mut last)?;
            lines.extend((last != *b"\n").then_some(b'\n'));
        }
        if self.kind.is_none() {
            let looselink = kind.to_owned();
            let replaces = self.replaces;
            lines.extend(line_of(&Line::Head {
                looselink,
                replaces,
            })?);
            self.kind = Some(kind.to_owned());
        }
        for (file, digest) in files {
            self.files.insert(file.clone(), digest);
            lines.extend(line_of(&Line::File { file, digest })?);
        }
        // in one call: programs that share a folder add lines at the same time
        to.write_all(&lines)
    }

    /// The bytes of a new manifest; none where it lists no file.
    pub fn bytes(kind: &str, files: &BTreeMap<String, Option<Digest>>) -> io::Result<Vec<u8>> {
        let mut bytes = Cursor::new(Vec::new());
        if !files.is_empty() {
            let files = files.iter().map(|(file, digest)| (file.clone(), *digest));
            Manifest::default().add(&mut bytes, kind, files)?;
        }
        Ok(bytes.into_inner())
    }
}

/// What has become of a file whose bytes are not those of the program.
const DAMAGED: &str = "is damaged, or was changed after the program wrote it";

/// True of the name of a file in the folder itself.
fn is_plain(name: &str) -> bool {
    let mut parts = Path::new(name).components();
    matches!((parts.next(), parts.next()), (Some(Component::Normal(only)), None) if only == name)
}

/// What a folder holds by its manifest: the name of a [`crate::Kind`].
pub fn held(folder: &Path) -> Option<String> {
    Manifest::of(folder).ok()??.kind
}

/// True of a file of the program in a folder with a manifest.
pub fn lists(folder: &Path, name: &str) -> bool {
    let manifest = Manifest::of(folder).ok().flatten();
    manifest.is_some_and(|manifest| manifest.files.contains_key(name))
}

/// Refuses the bytes of a file of a result that are not those that the program wrote. Where a result has not ended, and where an
/// earlier version wrote it, which made no manifest, there may be no digest: then they are taken as they are.
///
/// # Errors
/// [`OutputError::Changed`], also of the manifest of a result that `has_ended` and whose digest is lost.
pub fn verify(folder: &Path, name: &str, bytes: &[u8], has_ended: bool) -> Result<(), OutputError> {
    let Some(manifest) = Manifest::of(folder)? else {
        return Ok(());
    };
    match manifest.files.get(name) {
        Some(Some(digest)) if *digest != Digest::of(bytes) => Err(OutputError::Changed {
            path: folder.join(name),
            how: DAMAGED.to_owned(),
        }),
        None | Some(None) if has_ended => Err(OutputError::Changed {
            path: folder.join(MANIFEST),
            how: format!("{DAMAGED}: it lacks the digest of `{name}`"),
        }),
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::Manifest;
    use crate::digest::Digest;
    use std::io::{Cursor, Write};

    #[test]
    fn the_last_line_counts_and_a_torn_one_does_not() {
        let mut file = Cursor::new(Vec::new());
        let mut manifest = Manifest::default();
        let digest = Some(Digest::of(b"rows"));
        let files = [("a".to_owned(), None), ("b".to_owned(), digest)];
        manifest.add(&mut file, "a run", files).unwrap();
        let read = Manifest::read(&mut file).unwrap();
        assert_eq!(read.kind.as_deref(), Some("a run"));
        assert_eq!(read.files, manifest.files);
        file.write_all(b"{\"file\":\"c\",\"cr").unwrap();
        let mut read = Manifest::read(&mut file).unwrap();
        assert!(!read.files.contains_key("c"));
        let again = [("a".to_owned(), digest)];
        read.add(&mut file, "a sweep", again).unwrap();
        let read = Manifest::read(&mut file).unwrap();
        assert_eq!(read.kind.as_deref(), Some("a run"));
        assert_eq!(read.files["a"], digest);
    }

    /// A manifest that came with a folder from elsewhere.
    #[test]
    fn files_elsewhere_are_not_listed() {
        let mut file = Cursor::new(Vec::new());
        let names = ["../a", "/etc/passwd", "a/b", ".", "..", "", "a/", "good"];
        let names = names.map(|name| (name.to_owned(), None));
        Manifest::default().add(&mut file, "a run", names).unwrap();
        let read = Manifest::read(&mut file).unwrap();
        assert_eq!(read.files.keys().collect::<Vec<_>>(), ["good"]);
    }
}

//! Files that a user names.

use crate::document::nearest;
use std::fs::File;
use std::io::{self, ErrorKind, Read};
use std::path::{Path, PathBuf};

/// Larger files are refused: a table of 100 000 rows takes about 5 MB, and the worst text of this size 2.3 GB of memory.
const LARGEST_FILE: u64 = 8 << 20;

/// The bytes of a scene or a study; whatever the file is, their number is bounded.
///
/// # Errors
/// A file that cannot be read, or that is larger than 8 MiB.
pub fn read_file(path: &Path) -> io::Result<Vec<u8>> {
    let file = File::open(path).map_err(|error| match (error.kind(), similar(path)) {
        (ErrorKind::NotFound, Some(near)) => {
            let hint = format!("{error}; did you mean `{}`?", near.display());
            io::Error::new(ErrorKind::NotFound, hint)
        }
        _ => error,
    })?;
    let mut bytes = Vec::new();
    file.take(LARGEST_FILE + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > LARGEST_FILE {
        return Err(io::Error::other("it is larger than 8 MiB"));
    }
    Ok(bytes)
}

/// The file in the same folder whose name is nearest to that of a path, with the same extension.
fn similar(path: &Path) -> Option<PathBuf> {
    let folder = match path.parent()? {
        here if here.as_os_str().is_empty() => Path::new("."),
        folder => folder,
    };
    let files = folder.read_dir().ok()?.flatten().map(|entry| entry.path());
    let alike = files.filter(|file| file.extension() == path.extension() && file.is_file());
    let stem = |file: &Path| Some(file.file_stem()?.to_str()?.to_owned());
    let mut stems: Vec<String> = alike.filter_map(|file| stem(&file)).collect();
    stems.sort_unstable();
    let wanted = stem(path)?;
    let near = nearest(&wanted, stems.iter().map(String::as_str))?;
    let name = path.file_name()?.to_str()?.replacen(&wanted, near, 1);
    Some(path.with_file_name(name))
}

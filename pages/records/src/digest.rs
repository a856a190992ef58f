//! Digests of source files over what they mean.

use crate::{cpp, rust};
use miette::{IntoDiagnostic, Result, WrapErr, miette};
use numbers::hexadecimal;
use sha2::{Digest, Sha256};
use std::cell::RefCell;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use toml::Value;
use walkdir::WalkDir;

/// Digest of each file, by its path from the root.
pub type Digests = BTreeMap<String, String>;

/// Endings of the files of a folder that count.
const COUNTED: [&str; 6] = ["rs", "toml", "cpp", "hpp", "h", "csv"];

/// Digits of a digest that are kept: by chance two agree once in 2⁶⁴.
const DIGITS: usize = 16;

/// The sources below a root; every file is read once.
pub struct Tree {
    root: PathBuf,
    known: RefCell<Digests>,
}

impl Tree {
    /// The tree below `root`.
    pub fn new(root: &Path) -> Tree {
        Tree {
            root: root.to_owned(),
            known: RefCell::default(),
        }
    }

    /// Digests of the files that are named or stand in a folder that is named, without those named with `!` in front.
    ///
    /// # Errors
    /// A name that is not there, and a file that cannot be read as what its ending says.
    pub fn digests(&self, sources: &[String]) -> Result<Digests> {
        let (without, with): (Vec<&str>, Vec<&str>) = sources
            .iter()
            .map(String::as_str)
            .partition(|source| source.starts_with('!'));
        let mut digests = Digests::new();
        for source in with {
            for path in self.files(source)? {
                digests.insert(path.clone(), self.digest(path)?);
            }
        }
        for source in without {
            let source = &source[1..];
            if !self.root.join(source).exists() {
                return Err(miette!("{source} is left out, but is not there"));
            }
            digests.retain(|path, _| !Path::new(path).starts_with(source));
        }
        Ok(digests)
    }

    /// The file of this name, or the counted files of the folder.
    fn files(&self, source: &str) -> Result<Vec<String>> {
        let mut paths = Vec::new();
        for entry in WalkDir::new(self.root.join(source)) {
            let entry = entry.into_diagnostic()?;
            let path = entry.path().strip_prefix(&self.root).into_diagnostic()?;
            let ending = path.extension().unwrap_or_default();
            if entry.file_type().is_file() && COUNTED.iter().any(|counted| ending == *counted) {
                paths.push(path.to_string_lossy().replace('\\', "/"));
            }
        }
        match paths.is_empty() {
            true => Err(miette!("{source} has no source files")),
            false => Ok(paths),
        }
    }

    fn digest(&self, path: String) -> Result<String> {
        if let Some(digest) = self.known.borrow().get(&path) {
            return Ok(digest.clone());
        }
        let text = fs::read_to_string(self.root.join(&path))
            .into_diagnostic()
            .wrap_err_with(|| format!("cannot read {path}"))?;
        let meaning = meaning(&path, &text).wrap_err_with(|| path.clone())?;
        let digest = hexadecimal(&Sha256::digest(meaning))[..DIGITS].to_owned();
        self.known.borrow_mut().insert(path, digest.clone());
        Ok(digest)
    }
}

/// The bytes that a digest is taken of.
fn meaning(path: &str, text: &str) -> Result<Vec<u8>> {
    match path.rsplit('.').next() {
        Some("rs") => rust::tokens(text).into_diagnostic(),
        Some("toml") => {
            let table = text.parse::<toml::Table>().into_diagnostic()?;
            let mut out = Vec::new();
            value(&Value::Table(table), &mut out);
            Ok(out)
        }
        Some("cpp" | "hpp" | "h") => Ok(cpp::tokens(text)),
        _ => Ok(text.as_bytes().to_vec()),
    }
}

/// One way to write a value: keys in the order of the alphabet, whatever order the library keeps them in; floating-point
/// numbers by their bits.
fn value(of: &Value, out: &mut Vec<u8>) {
    let mut put = |sign: u8, text: &[u8]| {
        out.push(sign);
        out.extend_from_slice(text);
        out.push(0);
    };
    match of {
        Value::String(text) => put(b's', text.as_bytes()),
        Value::Integer(number) => put(b'i', number.to_string().as_bytes()),
        Value::Float(number) => put(b'f', format!("{:x}", number.to_bits()).as_bytes()),
        Value::Boolean(is) => put(b'b', is.to_string().as_bytes()),
        Value::Datetime(at) => put(b'd', at.to_string().as_bytes()),
        Value::Array(entries) => {
            put(b'[', b"");
            for entry in entries {
                value(entry, out);
            }
            out.push(b']');
        }
        Value::Table(table) => {
            put(b'{', b"");
            let mut entries: Vec<(&String, &Value)> = table.iter().collect();
            entries.sort_by_key(|(key, _)| *key);
            for (key, entry) in entries {
                out.extend_from_slice(key.as_bytes());
                out.push(0);
                value(entry, out);
            }
            out.push(b'}');
        }
    }
}

#[cfg(test)]
mod tests {
    use super::meaning;

    #[test]
    fn a_scene_is_what_it_says_not_how() {
        let scene = "format = 1\n[integrator]\nstep = 1e-5\nmethod = \"bathe\"\n";
        let of = |text: &str| meaning("a.toml", text).unwrap();
        assert_eq!(
            of(scene),
            of(
                "# a comment\nintegrator = { method = 'bathe', step = 0.00001 } # another\nformat = 1\n"
            )
        );
        for (from, to) in [
            ("1e-5", "2e-5"),
            ("bathe", "euler"),
            ("step", "stop"),
            ("= 1\n", "= 1.0\n"),
        ] {
            assert_ne!(of(scene), of(&scene.replace(from, to)), "{from}");
        }
    }

    #[test]
    fn a_file_that_is_not_what_its_ending_says_is_refused() {
        assert!(meaning("a.rs", "fn f( {").is_err());
        assert!(meaning("a.toml", "a = ").is_err());
    }
}

//! What the fuzzer starts from.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use toml::{Table, Value};

/// Seeds of a target, and the words of its language.
pub struct Pool {
    /// Whole files.
    pub seeds: Vec<String>,
    /// Keys and choices.
    pub words: Vec<String>,
}

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

fn read(path: &Path) -> String {
    fs::read_to_string(path).unwrap_or_else(|e| panic!("{}: {e}", path.display()))
}

/// All scenes of the project: those of `scenes/` and the examples of docs/scene.md.
pub fn scenes() -> Pool {
    let document = read(&root().join("docs/scene.md"));
    let mut seeds = Vec::new();
    for folder in [
        "scenes",
        "scenes/3rrr",
        "scenes/slider-crank",
        "scenes/ablation",
    ] {
        seeds.extend(files(folder));
    }
    seeds.extend(examples(&document));
    Pool {
        seeds,
        words: words(&document),
    }
}

/// All studies of the project.
pub fn studies() -> Pool {
    let document = read(&root().join("docs/study.md"));
    Pool {
        seeds: files("studies"),
        words: words(&document),
    }
}

impl Pool {
    /// Writes the seeds where cargo-fuzz looks for those of `target`, and beside them the words as a dictionary.
    pub fn write(&self, target: &str) {
        let folder = root().join("fuzz/corpus").join(target);
        fs::create_dir_all(&folder).expect("the folder of the corpus");
        for (n, seed) in self.seeds.iter().enumerate() {
            fs::write(folder.join(format!("seed-{n}")), seed).expect("a seed");
        }
        let quoted: String = self.words.iter().map(|w| format!("{w:?}\n")).collect();
        fs::write(folder.with_extension("dict"), quoted).expect("the dictionary");
    }
}

fn files(folder: &str) -> Vec<String> {
    let entries = fs::read_dir(root().join(folder)).expect("a folder of seeds");
    let mut paths: Vec<_> = entries.map(|e| e.expect("an entry").path()).collect();
    paths.retain(|path| path.extension().is_some_and(|e| e == "toml"));
    paths.sort();
    paths.iter().map(|path| read(path)).collect()
}

/// Examples of docs/scene.md; one without a `format` changes the first.
fn examples(document: &str) -> Vec<String> {
    let blocks = document.split("```toml\n").skip(1);
    let tables = blocks.map(|block| {
        let text = block.split("```").next().unwrap_or("");
        text.parse::<Table>().expect("an example of docs/scene.md")
    });
    let mut base: Option<Table> = None;
    let whole = tables.map(|example| {
        let mut scene = match &base {
            Some(base) if !example.contains_key("format") => base.clone(),
            _ => Table::new(),
        };
        for (name, value) in example {
            match (scene.get_mut(&name), value) {
                (Some(Value::Table(old)), Value::Table(new)) => old.extend(new),
                (_, value) => {
                    scene.insert(name, value);
                }
            }
        }
        base.get_or_insert_with(|| scene.clone());
        toml::to_string(&scene).expect("a table is TOML")
    });
    whole.collect()
}

/// What stands between backticks and is one word.
fn words(document: &str) -> Vec<String> {
    let quoted = document
        .lines()
        .flat_map(|line| line.split('`').skip(1).step_by(2));
    let one = |w: &&str| !w.is_empty() && !w.contains(|c: char| c.is_whitespace() || !c.is_ascii());
    let words: BTreeSet<_> = quoted.filter(one).map(str::to_owned).collect();
    words.into_iter().collect()
}

//! The evidence fits in a hand.

use records::root;
use std::fs;
use std::path::Path;
use std::process::Command;

/// Pages that a person reads.
const PAGES: [&str; 9] = [
    "README.md",
    "EVIDENCE.md",
    "ACCURACY.md",
    "BENCHMARKS.md",
    "STABILITY.md",
    "VERIFICATION.md",
    "verify/REPORT.md",
    "paper-figures/REPRODUCTION.md",
    "scenes/README.md",
];
/// Folders of what is measured and rendered.
const FOLDERS: [&str; 2] = ["evidence/data/", "evidence/pictures/"];
/// Of the pages and folders together \[bytes\].
const LARGEST: u64 = 6_000_000;
/// Of a page: lines and bytes. Two screens of tables are read, more are not.
const LONGEST: (usize, usize) = (200, 25_000);
/// Screenshots; drawings are SVG.
const SCREENSHOTS: usize = 10;
/// Of the programs that measure and render.
const PROGRAMS: [&str; 3] = ["evidence/", "paper-figures/", "verify/"];

/// Files under version control whose paths begin and end so.
fn tracked(begins: &[&str], ends: &str) -> Vec<String> {
    let mut git = Command::new("git");
    let listed = git.args(["ls-files"]).current_dir(root()).output().unwrap();
    assert!(listed.status.success(), "git lists the files");
    let text = String::from_utf8(listed.stdout).unwrap();
    let chosen = text
        .lines()
        .filter(|path| path.ends_with(ends) && begins.iter().any(|begin| path.starts_with(begin)));
    chosen.map(str::to_owned).collect()
}

fn bytes(path: impl AsRef<Path>) -> u64 {
    fs::metadata(root().join(path)).map_or(0, |data| data.len())
}

#[test]
fn data_pictures_and_pages_are_small() {
    let files = tracked(&[&PAGES[..], &FOLDERS].concat(), "");
    let sum: u64 = files.iter().map(bytes).sum();
    assert!(sum <= LARGEST, "{sum} bytes in {} files", files.len());
}

#[test]
fn few_pictures_are_made_of_pixels() {
    let files = tracked(&[""], ".png");
    assert!(files.len() <= SCREENSHOTS, "{files:?}");
}

#[test]
fn pages_are_short() {
    for page in PAGES {
        let Ok(text) = fs::read_to_string(root().join(page)) else {
            panic!("{page} is not there");
        };
        let size = (text.lines().count(), text.len());
        assert!(
            size.0 <= LONGEST.0 && size.1 <= LONGEST.1,
            "{page}: {} lines, {} bytes",
            size.0,
            size.1
        );
    }
}

#[test]
fn programs_that_make_them_are_short() {
    let count = |path: &String| {
        let text = fs::read_to_string(root().join(path));
        text.map_or(0, |text| text.lines().count())
    };
    let lines = |begins: &[&str]| -> usize { tracked(begins, ".rs").iter().map(count).sum() };
    let [programs, solver] = [lines(&PROGRAMS), lines(&["src/"])];
    assert!(
        2 * programs <= solver,
        "{programs} lines of Rust beside {solver} of the solver"
    );
}

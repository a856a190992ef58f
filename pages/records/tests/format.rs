//! Digests do not see how code is laid out, and see every line of it.

use crate::support::SourceCopy;
use records::{Digests, Tree};
use std::process::Command;

const KERNELS: [&str; 5] = [
    "src/link",
    "src/contact",
    "src/constraint",
    "src/force",
    "src/stepper",
];

fn digests(copy: &SourceCopy, source: &str) -> miette::Result<Digests> {
    Tree::new(copy.root()).digests(&[source.to_owned()])
}

#[test]
fn other_widths_of_lines_change_no_digest() {
    let copy = SourceCopy::new();
    let before = digests(&copy, "src").unwrap();
    let original: Vec<String> = before.keys().map(|file| copy.read(file)).collect();
    for width in ["60", "140"] {
        let status = Command::new("rustfmt")
            .args(["--edition", "2024", "--config"])
            .arg(format!("max_width={width}"))
            .arg(copy.path("src/lib.rs"))
            .status();
        assert!(status.unwrap().success());
        let after = digests(&copy, "src").unwrap();
        let changed: Vec<&String> = before.keys().filter(|f| before[*f] != after[*f]).collect();
        assert!(changed.is_empty(), "{width}: {changed:?}");
        let moved = before.keys().zip(&original);
        let moved = moved
            .filter(|(file, text)| copy.read(file) != **text)
            .count();
        assert!(moved > before.len() / 2, "{width}: {moved} files");
    }
}

/// Any line of code that goes missing changes the digest of its file or leaves no Rust at all; a comment that goes missing
/// changes nothing.
#[test]
fn every_line_of_the_kernels_counts() {
    let copy = SourceCopy::new();
    let (mut code, mut comments) = (0, 0);
    for (file, digest) in KERNELS.iter().flat_map(|k| digests(&copy, k).unwrap()) {
        let text = copy.read(&file);
        let program = text.split("#[cfg(test)]").next().unwrap();
        for (n, line) in program.lines().enumerate() {
            let others = text.lines().enumerate().filter(|(i, _)| *i != n);
            let others: Vec<&str> = others.map(|(_, line)| line).collect();
            copy.write(&file, &others.join("\n"));
            let changed = digests(&copy, &file).map_or(true, |now| now[&file] != digest);
            let line = line.trim();
            let is_comment = line.is_empty() || line.starts_with("//");
            assert_eq!(changed, !is_comment, "{file}, line {}: {line}", n + 1);
            *(if is_comment { &mut comments } else { &mut code }) += 1;
        }
        copy.write(&file, &text);
    }
    println!("{code} lines of code, {comments} others");
    assert!(code > 1000 && comments > 100);
}

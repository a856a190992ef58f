//! Runs every scene below `scenes/` once, draws it, and writes `scenes/README.md`.

mod drawing;
mod page;
mod runs;

use miette::{IntoDiagnostic, Result};
use std::path::Path;

fn main() -> Result<()> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes");
    let mut entries = Vec::new();
    for name in runs::names(&root)? {
        eprintln!("{name}");
        let run = runs::run(&root, &name)?;
        plot::save(&drawing::figure(&run), &root.join("gallery"), &run.slug())?;
        entries.push(page::entry(&run));
    }
    std::fs::write(root.join("README.md"), page::page(&entries)).into_diagnostic()
}

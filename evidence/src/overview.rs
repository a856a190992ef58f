//! The page about the other pages.

use crate::campaign::Renderer;
use crate::output::{Data, Output};
use miette::Result;

/// EVIDENCE.md.
pub const RENDERER: Renderer = Renderer {
    records: &[
        "accuracy",
        "benchmarks",
        "comparison",
        "figures",
        "gallery",
        "maps",
        "tests",
    ],
    render,
};

fn render(_: &Data, out: &mut Output) -> Result<()> {
    out.page_of_pages("EVIDENCE.md", "evidence.md")
}

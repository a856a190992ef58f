//! A result of `looselink run` as one HTML file in which the mechanism moves, or as SVG frames.
//!
//! The page needs no network. Its program is `assets/viewer.html`, which is built from the TypeScript in `web/`; this crate adds
//! the data: what bodies and joints look like ([`drawing`], [`moved`]), and how they move ([`tracks`]), compressed ([`pack`]).

pub mod drawing;
pub mod frames;
pub mod moved;
pub mod pack;
mod reading;
pub mod stored;
pub mod tracks;

pub use reading::{PAGE, ViewError, has_page, kind};
pub use stored::{StoredChannel, StoredResult, StoredRun, StoredSummary};

use drawing::RunDrawing;
use pack::Pack;
use serde::Serialize;
use std::path::{Path, PathBuf};
use texts::harmless;

const TEMPLATE: &str = include_str!("../assets/viewer.html");
/// Where the data stand in the page.
const PLACE: &str = "<!--DATA-->";

/// Everything the page shows of some runs; its arrays are in the pack.
#[derive(Serialize)]
struct Contents {
    runs: Vec<RunDrawing>,
    pack: String,
}

/// Writes the page of the result in a folder beside it, with another run as its ghost, if there is one; returns its file.
///
/// # Errors
/// As [`StoredRun::load`]; files of somebody else, and a page that cannot be written.
pub fn keep_page(folder: &Path, ghost: Option<StoredRun>) -> Result<PathBuf, ViewError> {
    let mut ghosts: Vec<StoredRun> = ghost.into_iter().collect();
    reading::keep_page(folder, || {
        let mut runs = vec![StoredRun::load(folder)?];
        runs.append(&mut ghosts);
        let page = page(&runs);
        ghosts = runs.split_off(1);
        Ok(page)
    })
}

/// The page of a run, with another one as its ghost if there are two.
pub fn page(runs: &[StoredRun]) -> String {
    let mut pack = Pack::default();
    let drawings = runs.iter().map(|run| RunDrawing::new(run, &mut pack));
    let contents = Contents {
        runs: drawings.collect(),
        pack: pack.encode(),
    };
    let data = serde_json::to_string(&contents).expect("numbers, texts and lists");
    // `<` cannot end the script element from inside a string
    let data = harmless(&data).replace('<', "\\u003c");
    let element = format!("<script type=\"application/json\" id=\"data\">{data}</script>");
    let (head, tail) = TEMPLATE
        .split_once(PLACE)
        .expect("the page has a place for data");
    [head, &element, tail].concat()
}

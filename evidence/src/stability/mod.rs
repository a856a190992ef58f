//! Hard cases, random mechanisms and random input: where methods come to their limits, and that nothing is wrong in silence.

pub mod cases;
pub mod map;
pub mod outcome;
mod page;
pub mod random;

use crate::campaign::{Campaign, Renderer, results};
use cases::{Check, checks};
use map::{MadeMap, Map, files};
use miette::Result;
use random::soak;
use records::{Journal, threads};
use serde::{Deserialize, Serialize};
use std::path::Path;

/// The campaigns; `fuzz/run.sh` writes one more record.
pub const CAMPAIGNS: [Campaign; 3] = [
    Campaign {
        name: "maps",
        minutes: 10,
        seeds: "none",
        measure: measure_maps,
    },
    Campaign {
        name: "long",
        minutes: 10,
        seeds: "none",
        measure: |journal| results(all_checks(journal, true)?),
    },
    Campaign {
        name: "soak",
        minutes: 20,
        seeds: "1",
        measure: soak::measure,
    },
];

/// The page, its pictures and the tables of the site.
pub const RENDERER: Renderer = Renderer {
    records: &["maps", "long", "soak", "fuzz"],
    render: page::render,
};

/// The record `maps`.
#[derive(Serialize, Deserialize)]
pub struct Maps {
    maps: Vec<MadeMap>,
    checks: Vec<Check>,
}

fn measure_maps(journal: &Journal) -> Result<serde_json::Value> {
    let make = |path: &Path| {
        let name = path.file_stem().unwrap_or_default().to_string_lossy();
        journal.item(&name, || Map::load(path)?.make(&name))
    };
    let files = files()?;
    results(Maps {
        maps: files.iter().map(|path| make(path)).collect::<Result<_>>()?,
        checks: all_checks(journal, false)?,
    })
}

/// The checks of all cases, or those that take minutes.
fn all_checks(journal: &Journal, long: bool) -> Result<Vec<Check>> {
    let numbers: Vec<usize> = (1..=cases::cases()?.len()).collect();
    let made = journal.items(
        &numbers,
        threads(),
        |n| format!("case {n}"),
        |n| checks(*n, long),
    )?;
    Ok(made.concat())
}

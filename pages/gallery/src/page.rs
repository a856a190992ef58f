//! The page that shows all scenes.

use crate::runs::SceneRun;
use looselink::scene::Analysis;
use numbers::si;

/// The entry of a run.
pub fn entry(run: &SceneRun) -> String {
    let (slug, name) = (run.slug(), &run.name);
    let sizes = &run.inspection;
    let report = &run.report;
    let length = match (run.scene.simulation.analysis, run.show.duration) {
        (Analysis::Static, _) => format!("{} load steps", report.steps),
        (Analysis::Dynamic, None) => {
            format!("{} steps over {}", report.steps, si(report.t, "s"))
        }
        (Analysis::Dynamic, Some(_)) => format!(
            "{} steps over the first {} of {}",
            report.steps,
            si(report.t, "s"),
            si(run.scene.simulation.duration, "s")
        ),
    };
    let onsets = match sizes.contacts {
        0 => String::new(),
        _ => format!("; contact onsets: {}", report.onsets),
    };
    format!(
        "## {}\n\n{}\n\n![{name}](gallery/{slug}.png)\n\n    looselink run scenes/{name}.toml --out out/{slug}\n\n\
         Unknowns: {}; multipliers: {}; contacts: {}; {length}{onsets}.\n",
        run.scene.title,
        first_sentence(run.scene.text()),
        sizes.unknowns,
        sizes.multipliers,
        sizes.contacts,
    )
}

/// The page.
pub fn page(entries: &[String]) -> String {
    format!(
        "# Scenes\n\n\
         `cargo run --release -p gallery` runs every scene of this folder and writes this page. Left: the mechanism at five \
         instants, from light to dark, with the points of the ground in black. Right: one of its channels. The comment at the \
         head of each file gives the source of its data and what to look at.\n\n{}",
        entries.join("\n")
    )
}

/// The first sentence of the comment at the head of a scene.
fn first_sentence(text: &str) -> String {
    let comment: Vec<&str> = text
        .lines()
        .map_while(|line| line.strip_prefix('#'))
        .map(str::trim)
        .collect();
    // a sentence ends with its line or before a space
    let joined = comment.join(" ") + " ";
    match joined.split_once(". ") {
        Some((sentence, _)) => format!("{sentence}."),
        None => joined.trim().to_owned(),
    }
}

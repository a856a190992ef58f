//! The documents speak of what is there.

use looselink::scene::Scene;
use looselink::simulate::Simulation;
use std::path::Path;

fn read(file: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(file);
    std::fs::read_to_string(path).unwrap_or_else(|e| panic!("{file}: {e}"))
}

#[test]
fn files_named_in_documents_exist() {
    let folders = [
        "src/",
        "crates/",
        "evidence/",
        "tests/",
        "scenes/",
        "benches/",
        "paper-figures/",
        "verify/",
        "fuzz/",
    ];
    let mut seen = 0;
    for document in ["README.md", "ARCHITECTURE.md", "EQUATIONS.md"] {
        let text = read(document);
        for name in text.split(['`', '(', ')', ' ', '\n']) {
            let is_path = folders.iter().any(|f| name.starts_with(f));
            let is_pattern = name.contains(['*', '<'])
                || name.contains("..")
                || name.contains("/x.")
                || name.contains("NN");
            if is_path && !is_pattern {
                let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(name);
                assert!(path.exists(), "{document} names {name}");
                seen += 1;
            }
        }
    }
    assert!(seen > 30, "{seen} paths were seen");
}

#[test]
fn the_citation_is_of_this_version() {
    let citation = read("CITATION.cff");
    let version = concat!("version: ", env!("CARGO_PKG_VERSION"));
    assert!(citation.lines().any(|line| line == version), "{version}");
}

#[test]
fn the_scene_of_the_readme_runs() {
    let text = read("README.md");
    let (_, rest) = text.split_once("```toml\n").unwrap();
    let (scene, _) = rest.split_once("```").unwrap();
    let scene = Scene::parse("README.md", scene, &[]).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(Simulation::new(&scene).unwrap().inspect().contacts, 1);
}

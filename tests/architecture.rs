//! The architecture as tests: files and folders of `src` depend on each other in one direction, and the solver on few
//! crates.

use petgraph::algo::kosaraju_scc;
use petgraph::graphmap::DiGraphMap;
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;
use syn::visit::Visit;
use syn::{ItemUse, UseTree};

/// Folders and files at the top of `src`, the lowest first: each uses those before it only.
const LAYERS: [&str; 28] = [
    "checkpoint",
    "math",
    "table",
    "effect",
    "ledger",
    "marker",
    "link",
    "document",
    "motion",
    "system",
    "constraint",
    "force",
    "contact",
    "eccentric_mass",
    "terms",
    "body",
    "interaction",
    "newton",
    "stepper",
    "registry",
    "scene",
    "model",
    "modes",
    "kinematics",
    "compile",
    "initial",
    "record",
    "simulate",
];

/// What writes the results of a simulation.
const ABOVE: &str = "output";

/// Crates that the solver is made of. toml_parser and winnow are compiled for toml in any case.
const CRATES: [&str; 17] = [
    "cpu-time",
    "faer",
    "folder",
    "indexmap",
    "miette",
    "nalgebra",
    "numbers",
    "ryu",
    "serde",
    "serde_json",
    "sha2",
    "strsim",
    "texts",
    "thiserror",
    "toml",
    "toml_parser",
    "winnow",
];

/// Paths of a module, such as `scene::joints`, with the text of its file.
type Modules = BTreeMap<Vec<String>, syn::File>;

fn modules(folder: &Path, path: &[String], found: &mut Modules) {
    for entry in fs::read_dir(folder).unwrap() {
        let file = entry.unwrap().path();
        let name = file.file_stem().unwrap().to_str().unwrap().to_owned();
        let inside = match name.as_str() {
            "lib" | "mod" => path.to_vec(),
            _ => [path, &[name]].concat(),
        };
        if file.is_dir() {
            modules(&file, &inside, found);
        } else {
            let text = fs::read_to_string(&file).unwrap();
            found.insert(inside, syn::parse_file(&text).unwrap());
        }
    }
}

/// Collects the paths that a file names, from the top of the crate, without its tests.
struct Paths<'a> {
    module: &'a [String],
    found: BTreeSet<Vec<String>>,
}

impl Paths<'_> {
    /// A path that begins with `crate`, `super` or `self`.
    fn see(&mut self, parts: &[String]) {
        let mut base = match parts[0].as_str() {
            "crate" => Vec::new(),
            "super" | "self" => self.module.to_vec(),
            _ => return,
        };
        for part in parts {
            match part.as_str() {
                "crate" | "self" => {}
                "super" => drop(base.pop()),
                name => base.push(name.to_owned()),
            }
        }
        self.found.insert(base);
    }

    fn tree(&mut self, tree: &UseTree, before: &[String]) {
        match tree {
            UseTree::Path(path) => {
                self.tree(&path.tree, &[before, &[path.ident.to_string()]].concat());
            }
            UseTree::Group(group) => group.items.iter().for_each(|t| self.tree(t, before)),
            UseTree::Name(name) => self.see(&[before, &[name.ident.to_string()]].concat()),
            UseTree::Rename(name) => self.see(&[before, &[name.ident.to_string()]].concat()),
            UseTree::Glob(_) => self.see(before),
        }
    }
}

impl<'ast> Visit<'ast> for Paths<'_> {
    fn visit_item_use(&mut self, item: &'ast ItemUse) {
        self.tree(&item.tree, &[]);
    }

    fn visit_path(&mut self, path: &'ast syn::Path) {
        let parts: Vec<String> = path.segments.iter().map(|s| s.ident.to_string()).collect();
        self.see(&parts);
        syn::visit::visit_path(self, path);
    }

    fn visit_item_mod(&mut self, module: &'ast syn::ItemMod) {
        let tests = module.attrs.iter().any(|a| a.path().is_ident("cfg"));
        if !tests {
            syn::visit::visit_item_mod(self, module);
        }
    }
}

/// (user, used) for every two files, as paths of modules.
fn uses(modules: &Modules) -> BTreeSet<(Vec<String>, Vec<String>)> {
    let mut uses = BTreeSet::new();
    for (module, file) in modules {
        let found = BTreeSet::new();
        let mut paths = Paths { module, found };
        paths.visit_file(file);
        for mut used in paths.found {
            while !modules.contains_key(&used) {
                used.pop();
            }
            if !used.is_empty() && used != *module {
                uses.insert((module.clone(), used));
            }
        }
    }
    uses
}

fn of_the_crate() -> Modules {
    let mut found = Modules::new();
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    modules(&folder, &[], &mut found);
    assert!(found.len() > 80, "{} files were read", found.len());
    found
}

/// Circles among files. A module and the files of its folder may use each other.
fn circles(uses: &BTreeSet<(Vec<String>, Vec<String>)>) -> Vec<Vec<String>> {
    let name = |path: &[String]| path.join("::");
    let names: BTreeMap<&Vec<String>, String> = uses
        .iter()
        .flat_map(|(a, b)| [(a, name(a)), (b, name(b))])
        .collect();
    let apart = |a: &[String], b: &[String]| !a.starts_with(b) && !b.starts_with(a);
    let edges = uses.iter().filter(|(a, b)| apart(a, b));
    let graph: DiGraphMap<&str, ()> =
        DiGraphMap::from_edges(edges.map(|(a, b)| (names[a].as_str(), names[b].as_str())));
    let components = kosaraju_scc(&graph).into_iter().filter(|c| c.len() > 1);
    components
        .map(|c| c.into_iter().map(str::to_owned).collect())
        .collect()
}

#[test]
fn files_use_each_other_in_no_circle() {
    assert_eq!(circles(&uses(&of_the_crate())), [[""; 0]; 0]);
}

/// The check sees what it is for.
#[test]
fn a_circle_is_found() {
    for (place, text) in [
        ("newton", "use crate::simulate::{Simulation, report};"),
        // a path inside a function counts as a `use`
        ("contact", "fn f() { crate::compile::joints::spin() }"),
    ] {
        let mut modules = of_the_crate();
        modules.insert(vec![place.to_owned()], syn::parse_file(text).unwrap());
        let found = circles(&uses(&modules));
        assert!(found.concat().contains(&place.to_owned()), "{found:?}");
    }
}

#[test]
fn layers_point_downward() {
    let modules = of_the_crate();
    let layer = |module: &[String]| match module[0].as_str() {
        ABOVE => LAYERS.len(),
        name => {
            let place = LAYERS.iter().position(|l| *l == name);
            place.unwrap_or_else(|| panic!("{name} is no layer"))
        }
    };
    for (user, used) in uses(&modules) {
        if !user.is_empty() && user[0] != used[0] {
            let (from, to) = (user.join("::"), used.join("::"));
            assert!(
                layer(&user) > layer(&used),
                "{from} uses {to}, which lies above it"
            );
        }
    }
}

#[test]
fn the_solver_is_made_of_few_crates() {
    let manifest = fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("Cargo.toml"));
    let manifest: toml::Table = manifest.unwrap().parse().unwrap();
    let crates: Vec<&str> = manifest["dependencies"]
        .as_table()
        .unwrap()
        .keys()
        .map(String::as_str)
        .collect();
    assert_eq!(crates, CRATES);
}

//! Compiles `../reference-cpp` and `ida`, and finds the libraries it needs.

mod locate;

use locate::Libraries;
use std::path::{Path, PathBuf};

fn main() {
    let libraries = locate::libraries().unwrap_or_else(|missing| {
        eprintln!("{missing}");
        std::process::exit(1);
    });
    // the lints link nothing, and know build scripts of their own: the C++ would be compiled once more for them
    if !cfg!(clippy) {
        compile(&libraries);
    }
    link(&libraries);
    for variable in locate::VARIABLES {
        println!("cargo:rerun-if-env-changed={variable}");
    }
}

fn compile(libraries: &Libraries) {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../reference-cpp");
    let own = Path::new(env!("CARGO_MANIFEST_DIR")).join("ida");
    for folder in [&root, &own] {
        println!("cargo:rerun-if-changed={}", folder.display());
    }
    let mut build = cc::Build::new();
    build
        .cpp(true)
        .std("c++17")
        .opt_level(3) // the cost of the reference is compared; Eigen needs inlining in every profile
        .debug(false) // half the time of the compiler
        .warnings(true)
        .extra_warnings(true)
        .include(root.join("include"))
        .files(sources(&root.join("src")))
        .files(sources(&own));
    for include in &libraries.includes {
        // the compiler looks in /usr/include by itself, and last, where C++ wants it
        if include == Path::new("/usr/include") {
            continue;
        }
        // as system headers: their warnings are not ours
        build.flag("-isystem").flag(include.display().to_string());
    }
    let compiled = precompile(&mut build, &root);
    build.compile("looselink_reference");
    // it takes 100 MB, if it was made
    std::fs::remove_file(compiled).ok();
}

/// Reads the headers of Eigen once for all files, where the compiler can: with GCC a compiled header beside the one that is included
/// takes its place. Other compilers include the header itself. Returns where the compiled header is.
fn precompile(build: &mut cc::Build, root: &Path) -> PathBuf {
    let folder = PathBuf::from(std::env::var_os("OUT_DIR").expect("cargo names a folder"));
    let header = folder.join("eigen.hpp");
    let text = "#include <Eigen/Dense>\n#include <Eigen/Sparse>\n";
    std::fs::write(&header, text).expect("the folder can be written to");
    let compiler = build.get_compiler();
    build.flag("-include").flag(header.display().to_string());
    let compiled = header.with_extension("hpp.gch");
    if compiler.is_like_gnu() {
        let mut command = compiler.to_command();
        command.args(["-x", "c++-header", "-o"]).arg(&compiled);
        let status = command.arg(&header).current_dir(root).status();
        let status = status.expect("the compiler can be started");
        assert!(status.success(), "Eigen cannot be compiled: {status}");
    }
    compiled
}

/// All C++ files, in an order that does not depend on the file system.
fn sources(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder)
        .unwrap_or_else(|e| panic!("cannot read {}: {e}", folder.display()));
    let mut files: Vec<PathBuf> = entries
        .map(|entry| entry.expect("the folder can be listed").path())
        .filter(|path| path.extension().is_some_and(|e| e == "cpp"))
        .collect();
    files.sort();
    files
}

fn link(libraries: &Libraries) {
    if let Some(folder) = &libraries.folder {
        println!("cargo:rustc-link-search=native={}", folder.display());
        println!("cargo:rustc-link-arg=-Wl,-rpath,{}", folder.display());
    }
    for name in libraries.names {
        println!("cargo:rustc-link-lib={name}");
    }
}

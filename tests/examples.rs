//! The programs in `examples/` print what they promise. `cargo test` has built them.

use std::env::consts::EXE_SUFFIX;
use std::fs;
use std::path::Path;
use std::process::Command;

/// What each prints.
const PRINTED: [(&str, &str); 4] = [
    ("own_contact_law", "restitution 0.900"),
    ("own_integrator", "numerical: "),
    ("own_interaction", "work of the water: -"),
    ("own_observer", "slider_pin: "),
];

#[test]
fn examples_are_short_and_run() {
    let top = Path::new(env!("CARGO_MANIFEST_DIR"));
    let files = fs::read_dir(top.join("examples")).unwrap();
    let mut sources: Vec<_> = files.map(|file| file.unwrap().path()).collect();
    sources.retain(|path| path.extension().is_some_and(|end| end == "rs"));
    assert_eq!(sources.len(), PRINTED.len());
    let test = std::env::current_exe().unwrap();
    let built = test.ancestors().nth(2).unwrap().join("examples");
    for (name, wanted) in PRINTED {
        let source = fs::read_to_string(top.join(format!("examples/{name}.rs"))).unwrap();
        assert!(source.lines().count() < 60, "{name} is long");
        let program = built.join(format!("{name}{EXE_SUFFIX}"));
        let output = Command::new(&program).current_dir(top).output();
        let output = output.unwrap_or_else(|error| {
            panic!("{}: {error}; `cargo test` builds it", program.display())
        });
        let printed = String::from_utf8_lossy(&output.stdout);
        assert!(
            output.status.success() && printed.contains(wanted),
            "{name} printed: {printed}"
        );
    }
}

//! Limits in the command line: what `check` and `run` say of drives beyond the reach and of loops that cannot close.

use crate::command_line::{expect, looselink};
use std::path::Path;

/// A four-bar whose crank cannot make a full turn, driven past its toggle.
const FOUR_BAR: &str = r#"
format = 1
title = "a crank beyond its reach"
simulation = { duration = 2.0 }
integrator = { method = "bathe", step = 1e-3, newton_tolerance = 1e-9 }
output = { interval = 0.01, channels = ["*"] }
materials.steel = { density = 7850.0 }
sections.bar = { width = 0.01, height = 0.01 }
bodies.ground = { type = "ground", points.O2 = [0.0, 0.0], points.O4 = [5.0, 0.0] }
bodies.crank = { type = "link", model = "rigid", length = 4.0, section = "bar", material = "steel" }
bodies.coupler = { type = "link", model = "rigid", length = 2.0, section = "bar", material = "steel" }
bodies.rocker = { type = "link", model = "rigid", length = 3.5, section = "bar", material = "steel" }
joints.O2 = { type = "revolute", bearing = "ground.O2", journal = "crank.start", model = "ideal" }
joints.A = { type = "revolute", bearing = "crank.end", journal = "coupler.start", model = "ideal" }
joints.B = { type = "revolute", bearing = "coupler.end", journal = "rocker.end", model = "ideal" }
joints.O4 = { type = "revolute", bearing = "ground.O4", journal = "rocker.start", model = "ideal" }
drives.motor = { type = "angle", joint = "O2", angle = "0.6 + t" }
initial.sketch = { B = [5.0, 3.5] }
"#;

const LIMIT: &str = "drive motor cannot turn joint O2 beyond 1.2987013 rad (74.4101 degrees), which it reaches at \
                     t = 0.69870127 s: coupler and rocker are in line at joints A, B and O4";

fn on_disk(folder: &Path) -> String {
    let file = folder.join("four-bar.toml");
    std::fs::write(&file, FOUR_BAR).unwrap();
    file.to_str().unwrap().to_owned()
}

#[test]
fn check_and_run_name_the_limit_of_a_drive() {
    let folder = tempfile::tempdir().unwrap();
    let scene = on_disk(folder.path());
    let checked = looselink(&["check", &scene]);
    expect(&checked, 2, LIMIT);
    expect(&checked, 2, "four-bar.toml:17:16");
    let out = folder.path().join("out");
    let ran = looselink(&["run", &scene, "--quiet", "--out", out.to_str().unwrap()]);
    expect(&ran, 3, LIMIT);
    let shown = String::from_utf8_lossy(&ran.stderr).into_owned();
    assert!(!shown.contains("warning"), "{shown}");
    // it ends before the limit
    expect(
        &looselink(&["check", &scene, "--set", "simulation.duration=0.69"]),
        0,
        "",
    );
    // a flexible link may give way a little: a warning
    let flexible = [
        "check",
        &scene,
        "--set",
        "bodies.coupler.model=flexible",
        "--set",
        "bodies.coupler.elements=1",
        "--set",
        "materials.steel.youngs_modulus=2.1e11",
    ];
    expect(
        &looselink(&flexible),
        0,
        "t = 0.69870127 s in the ideal rigid mechanism",
    );
}

#[test]
fn a_loop_that_cannot_close_is_told_with_its_least_gap() {
    let folder = tempfile::tempdir().unwrap();
    let scene = on_disk(folder.path());
    let checked = looselink(&["check", &scene, "--set", "bodies.coupler.length=0.05"]);
    let expected = "joint B stays open by 0.624 m at least, with all others closed; coupler would have to be 0.674 m or longer, or \
                    rocker 2.876 m or shorter, or crank 2.143 m or shorter";
    expect(&checked, 2, expected);
}

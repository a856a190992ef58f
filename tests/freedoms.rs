//! Degrees of freedom of scenes, and how many of them are driven.

use crate::support::{load, run};
use looselink::initial::Freedoms;

fn said(scene: &str, changes: &[&str]) -> String {
    Freedoms::of(&load(scene, changes)).map_or(String::new(), |found| found.to_string())
}

#[test]
fn degrees_of_freedom_are_counted() {
    for (scene, changes, wanted) in [
        ("pendulum.toml", &[][..], "1 degree of freedom, not driven"),
        ("quick-return.toml", &[], "1 degree of freedom, driven"),
        // its third bar repeats the others
        (
            "hard/third-bar.toml",
            &[],
            "1 degree of freedom, not driven",
        ),
        // the height of a wheel is prescribed
        ("car-axis.toml", &[], "1 of 3 degrees of freedom is driven"),
        (
            "driven-disc.toml",
            &[],
            "2 of 3 degrees of freedom are driven",
        ),
        // with ideal joints and rigid links
        (
            "3rrr/case4.toml",
            &[],
            "3 degrees of freedom, all of them driven",
        ),
        ("cantilever-static.toml", &[], "0 degrees of freedom"),
        (
            "slider-crank/free-slider.toml",
            &[],
            "3 degrees of freedom, none of them driven",
        ),
        // two pendulums, of which the second hangs from the first
        (
            "double-pendulum-flexible.toml",
            &[],
            "2 degrees of freedom, none of them driven",
        ),
    ] {
        assert_eq!(said(scene, changes), wanted, "{scene}");
    }
}

/// A run says so where drives leave freedoms, and only there.
#[test]
fn a_run_that_is_driven_in_part_says_so() {
    let short = ["simulation.duration=0.01", "output.interval=0.01"];
    let told = |scene: &str| run(scene, &short).1.freedoms;
    let partly = "2 of 3 degrees of freedom are driven".to_owned();
    assert_eq!(told("driven-disc.toml"), Some(partly));
    assert_eq!(told("quick-return.toml"), None);
    assert_eq!(told("pendulum.toml"), None);
}

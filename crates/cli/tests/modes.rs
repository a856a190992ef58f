//! `looselink modes`: what it prints, what it refuses, and the pages of modes.

use crate::command_line::{TOP, expect, files, looselink, read};
use serde_json::Value;
use std::path::Path;

const CASE_4: &str = "scenes/3rrr/case4.toml";

fn text(arguments: &[&str]) -> String {
    let output = looselink(&[&["modes"], arguments].concat());
    expect(&output, 0, "");
    String::from_utf8(output.stdout).unwrap()
}

/// A rotor blade of 8 m, clamped at its hub: b = 1.8751, f = b^2/(2 pi l^2) sqrt(EI/(rho A)).
#[test]
fn modes_are_printed_from_the_slowest_on() {
    let shown = text(&["scenes/spin-up.toml", "--count", "2"]);
    let lines: Vec<&str> = shown.lines().collect();
    assert_eq!(lines[0], "rotor blade spun up, t = 0 s");
    assert!(lines[3].starts_with("   1       0.6044"), "{shown}");
    assert_eq!(lines.len(), 6, "{shown}");
    assert!(lines[5].starts_with("and 31 more: --count 33"), "{shown}");
}

#[test]
fn loose_joints_are_open_or_closed_or_ideal() {
    let heading = |more: &[&str]| {
        let at = [CASE_4, "--at", "0.005", "--count", "30"];
        let shown = text(&[&at, more].concat());
        let ideal = shown.contains("unstable") || shown.contains("(free)");
        (
            shown
                .lines()
                .next()
                .unwrap()
                .split(", ")
                .last()
                .unwrap()
                .to_owned(),
            ideal,
        )
    };
    assert_eq!(heading(&[]), ("closed: B1".to_owned(), true));
    assert_eq!(
        heading(&["--contacts", "open"]),
        ("with all loose joints open".to_owned(), true)
    );
    assert_eq!(
        heading(&["--contacts", "ideal"]),
        ("with ideal joints".to_owned(), false)
    );
}

/// Whatever channels a scene asks for, its joints can be ideal.
#[test]
fn every_loose_scene_has_modes_with_ideal_joints() {
    let mut scenes = 0;
    for folder in [
        "scenes",
        "scenes/3rrr",
        "scenes/slider-crank",
        "scenes/hard",
    ] {
        let folder = Path::new(TOP).join(folder);
        for name in files(&folder).iter().filter(|name| name.ends_with(".toml")) {
            if !read(&folder, name).contains("\"clearance\"") {
                continue;
            }
            let scene = folder.join(name);
            let scene = scene.to_str().unwrap();
            let output = looselink(&["modes", scene, "--contacts", "ideal"]);
            let told = String::from_utf8_lossy(&output.stderr).into_owned();
            // a mechanism of rigid links has no modes, and no journal can start beside the centre of an ideal joint
            let faults = [
                "nothing that can move",
                "does not fit joint pin",
                "violate joint pin",
            ];
            let is_told = faults.iter().any(|fault| told.contains(fault));
            assert!(output.status.success() || is_told, "{scene}: {told}");
            scenes += 1;
        }
    }
    assert!(scenes > 10, "{scenes} scenes");
}

#[test]
fn journals_that_float_at_the_start_are_told() {
    let told = |more: &[&str]| {
        let output = looselink(&[&["modes", "scenes/slider-crank/both.toml"], more].concat());
        expect(&output, 0, "");
        String::from_utf8(output.stderr).unwrap()
    };
    let note = "note: the journal of slider_pin floats at t = 0: it moves freely; `--contacts ideal` holds it";
    assert!(told(&[]).contains(note), "{}", told(&[]));
    assert_eq!(told(&["--contacts", "ideal"]), "");
    assert_eq!(told(&["--contacts", "open"]), "");
    let several = looselink(&["modes", CASE_4, "--count", "1"]);
    expect(&several, 0, "");
    let several = String::from_utf8(several.stderr).unwrap();
    let note = "note: the journals of B1, B2, B3, C1, C2, C3 float at t = 0: they move freely";
    assert!(several.contains(note), "{several}");
}

/// The same pose of a scene with overrides and of its result.
#[test]
fn a_result_has_the_modes_of_its_scene() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("run");
    let out = out.to_str().unwrap();
    let change = [
        "--set",
        "bodies.link1.elements=2",
        "--set",
        "simulation.duration=0.002",
    ];
    let run = [&["run", CASE_4, "--quiet", "--out", out], &change[..]].concat();
    expect(&looselink(&run), 0, "");
    let of_run = text(&[out, "--at", "0.001", "--json"]);
    let of_scene = text(&[&[CASE_4, "--at", "0.001", "--json"], &change[..]].concat());
    assert_eq!(of_run, of_scene);
    let modes: Value = serde_json::from_str(&of_run).unwrap();
    let shape = modes["modes"][9]["shape"].as_object().unwrap();
    assert!(shape.contains_key("link1.node1.x"));
    let largest = shape
        .values()
        .map(|x| x.as_f64().unwrap().abs())
        .fold(0.0, f64::max);
    assert!(largest >= 1.0);
}

#[test]
fn every_mode_that_vibrates_has_a_page() {
    let folder = tempfile::tempdir().unwrap();
    let pages = folder.path().join("modes");
    let scene = "scenes/slider-crank/flexible.toml";
    let modes = [
        "modes",
        scene,
        "--count",
        "3",
        "--view",
        pages.to_str().unwrap(),
    ];
    expect(&looselink(&modes), 0, "3 pages in");
    assert_eq!(
        files(&pages),
        ["mode-01.html", "mode-02.html", "mode-03.html"]
    );
    assert!(read(&pages, "mode-02.html").contains("Mode 2, "));
}

#[test]
fn what_has_no_modes_is_refused() {
    let refused = |arguments: &[&str], code, message| {
        expect(&looselink(&[&["modes"], arguments].concat()), code, message);
    };
    refused(
        &[CASE_4, "--at", "-1"],
        2,
        "--at -1 lies outside the duration",
    );
    refused(
        &[CASE_4, "--at", "1e9"],
        2,
        "--at 1000000000 lies outside the duration, 0 to 3 s",
    );
    refused(&[CASE_4, "--at", "nan"], 2, "lies outside the duration");
    refused(
        &["scenes/3rrr/case1.toml"],
        3,
        "constraints and drives leave nothing that can move",
    );
    refused(&["nowhere.toml"], 2, "nowhere.toml");
}

/// A free bar whose shape bends at the start vibrates at its first bending frequency, the slowest that is not a free motion: the
/// largest peak of `plot --spectrum` is that of `modes`.
#[test]
fn the_spectrum_of_a_motion_has_its_peak_at_a_mode() {
    let still =
        "initial.bodies.bar={x=0.0,y=0.0,theta=0.0,vx=0.0,vy=0.0,omega=0.0,bending_rate=4.0}";
    let change = ["--set", "simulation.gravity=[0.0,0.0]", "--set", still];
    let scene = "scenes/ringing-bar.toml";
    let output = looselink(&[&["modes", scene, "--json"], &change[..]].concat());
    let modes: Value = serde_json::from_slice(&output.stdout).unwrap();
    let frequencies = modes["modes"].as_array().unwrap().iter();
    let mut frequencies = frequencies.filter_map(|mode| mode["frequency"].as_f64());
    let frequency = frequencies.find(|f| *f > 1.0).unwrap();

    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().to_str().unwrap();
    let long = [
        "--set",
        "simulation.duration=0.2",
        "--set",
        "integrator.step=2e-5",
    ];
    let run = looselink(&[&["run", scene, "--out", out, "--force"], &change[..], &long].concat());
    expect(&run, 0, "");
    let figure = folder.path().join("spectrum.svg");
    let channel = [
        "--spectrum",
        "points.bar.middle.y",
        "-o",
        figure.to_str().unwrap(),
    ];
    expect(&looselink(&[&["plot", out], &channel[..]].concat()), 0, "");
    let figure = read(folder.path(), "spectrum.svg");
    let (_, peak) = figure.split_once("largest peak at ").unwrap();
    let peak: f64 = peak.split(' ').next().unwrap().parse().unwrap();
    // the frequencies are 5 Hz apart, the inverse of 0.2 s and a row
    assert!((peak - frequency).abs() <= 2.5, "{peak} Hz, {frequency} Hz");
}

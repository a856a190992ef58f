//! `looselink plot`.

use crate::command_line::{expect, looselink, read, run};
use std::path::Path;
use std::process::Output;

fn plot(folder: &Path, file: &str, more: &[&str]) -> Output {
    let output = folder.join(file);
    let arguments = [
        "plot",
        folder.to_str().unwrap(),
        "-o",
        output.to_str().unwrap(),
    ];
    looselink(&[&arguments, more].concat())
}

#[test]
fn figures_say_what_they_show() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path();
    expect(&run(out, &["--set", "integrator.step=1.6e-6"]), 0, "");
    let channels = ["--channels", "journal.x", "journal.v*", "energy.kinetic"];
    expect(&plot(out, "time.svg", &channels), 0, "");
    let figure = read(out, "time.svg");
    for text in [
        "journal.x",
        "journal.vy",
        "energy.kinetic",
        "(m/s)",
        "bathe",
        "step 1.6",
        "integrator.step=1.6e-6",
    ] {
        assert!(figure.contains(text), "{text} is not in the figure");
    }
    let section = ["--phase", "pin.ex", "pin.ey", "--poincare", "0.005"];
    expect(&plot(out, "section.svg", &section), 0, "");
    assert!(read(out, "section.svg").contains("5 points"));
    expect(
        &plot(out, "spectrum.svg", &["--spectrum", "journal.vx"]),
        0,
        "",
    );
    let figure = read(out, "spectrum.svg");
    // 0.02 s of rows
    for text in [
        "Amplitude of journal.vx",
        "resolution 50 Hz",
        "largest peak at",
    ] {
        assert!(figure.contains(text), "{text} is not in the figure");
    }
    let slow = ["--spectrum", "journal.vx", "--max-frequency", "160"];
    expect(&plot(out, "slow.svg", &slow), 0, "");
    assert!(read(out, "slow.svg") != figure);
}

#[test]
fn a_name_in_png_makes_a_png_or_says_how_to_get_one() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path();
    expect(&run(out, &[]), 0, "");
    let output = plot(out, "orbit.png", &["--phase", "pin.ex", "pin.ey"]);
    let image = std::fs::read(out.join("orbit.png"));
    if cfg!(feature = "png") {
        expect(&output, 0, "");
        let image = image.unwrap();
        assert!(image.starts_with(b"\x89PNG") && image.len() > 5000);
    } else {
        let how = "`cargo install --locked --path crates/cli --features png`";
        expect(&output, 2, how);
        expect(&output, 2, ".svg");
        assert!(image.is_err());
    }
}

#[test]
fn what_cannot_be_drawn_is_said() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path();
    expect(&run(out, &[]), 0, "");
    for (more, message) in [
        (
            &["--channels", "journal.z"][..],
            "did you mean `journal.x`?",
        ),
        (&["--channels", "pins.*"], "its channels: "),
        (
            &["--phase", "pin.ex", "pin.ey", "--poincare", "0.0033333"],
            "no row at t = ",
        ),
        (
            &["--phase", "pin.ex", "pin.ey", "--poincare", "1e-18"],
            "shorter than",
        ),
        (
            &["--channels", "journal.x", "--poincare", "0.1"],
            "cannot be used with",
        ),
        (
            &["--channels", "journal.x", "--from", "7"],
            "fewer than two rows",
        ),
        (
            &["--spectrum", "journal.x", "--max-frequency", "70"],
            "fewer than two frequencies lie below --max-frequency; the spectrum has one every 50 Hz",
        ),
        (
            &["--channels", "journal.x", "--max-frequency", "70"],
            "cannot be used with",
        ),
        (&[], "required"),
    ] {
        expect(&plot(out, "figure.svg", more), 2, message);
    }
    expect(
        &plot(out, "figure.pdf", &["--spectrum", "journal.x"]),
        2,
        "must end in .svg or .png",
    );
    assert!(!out.join("figure.svg").exists());
}

/// Names so long that each has a line of the legend.
#[test]
fn a_png_of_too_many_channels_is_refused_with_their_number() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path();
    let mut scene = "format = 1\ntitle = \"many channels\"\nsimulation = { duration = 2e-3 }\n\
        integrator = { method = \"bathe\", step = 1e-3 }\noutput = { interval = 1e-3, channels = [\"body*\"] }\n\
        bodies.ground = { type = \"ground\", points = { o = [0, 0] } }\n"
        .to_owned();
    for k in 0..100 {
        let name = format!("body{k}-{}", "long".repeat(25));
        scene += &format!(
            "bodies.{name} = {{ type = \"rigid_body\", mass = 1, inertia = 1, points = {{ o = [0, 0] }} }}\n\
             initial.bodies.{name} = {{ x = {k}, y = 0, theta = 0 }}\n"
        );
    }
    let file = out.join("scene.toml");
    std::fs::write(&file, scene).unwrap();
    let result = out.join("result");
    let [file, result] = [&file, &result].map(|path| path.to_str().unwrap());
    expect(&looselink(&["run", file, "--out", result]), 0, "");
    let result = Path::new(result);
    std::fs::write(result.join("many.png"), "what was there").unwrap();
    let output = plot(result, "many.png", &["--channels", "body*"]);
    for text in ["names 900 channels", "at most 32767", ".svg"] {
        expect(&output, 2, text);
    }
    assert_eq!(read(result, "many.png"), "what was there");
    expect(&plot(result, "many.svg", &["--channels", "body*"]), 0, "");
}

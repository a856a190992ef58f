//! What is misspelt is answered with what was meant.

use crate::command_line::{expect, looselink};
use std::fs;

const SCENE: &str = "scenes/slider-crank/both.toml";

#[test]
fn words_of_the_command_line() {
    for (arguments, meant) in [
        (&["inspct", SCENE][..], "'inspect'"),
        (&["rnu", SCENE], "a similar subcommand exists: 'run'"),
        (&["run", SCENE, "--ouut", "x"], "'--out'"),
        (&["completions", "bsh"], "'bash'"),
        (
            &["check", SCENE, "--accuracy", "positon=1"],
            "did you mean `position`?",
        ),
        (
            &["ablate", SCENE, "--body", "slidre"],
            "there are crank, rod, slider; did you mean `slider`?",
        ),
        (
            &["check", "scenes/slider-crank/bth.toml"],
            "did you mean `scenes/slider-crank/both.toml`?",
        ),
        (
            &["precision", "studies/case33.toml", "--out", "unused"],
            "did you mean `studies/case3.toml`?",
        ),
    ] {
        expect(&looselink(arguments), 2, meant);
    }
}

#[test]
fn templates() {
    let output = looselink(&["new", "fuor-bar", "unused.toml"]);
    expect(&output, 2, "a similar value exists: 'four-bar'");
    expect(
        &output,
        2,
        "[possible values: pendulum, crane, slider-crank, four-bar, 3rrr, empty]",
    );
}

#[test]
fn names_and_words_of_a_scene() {
    for (change, meant) in [
        // paths
        ("integrater.step=1e-6", "did you mean `integrator`?"),
        ("bodies.rodd.elements=2", "did you mean `bodies.rod`?"),
        // keys
        ("integrator.stepp=1e-6", "did you mean `step`?"),
        ("simulation.gravty=[0, 0]", "did you mean `gravity`?"),
        ("contacts.pin.restituton=1", "did you mean `restitution`?"),
        (
            "contacts.pin.friction={ low = \"ambrosio\" }",
            "did you mean `law`?",
        ),
        ("bodies.rod.elments=2", "did you mean `elements`?"),
        (
            "integrator.accuracy={ positon = 1 }",
            "did you mean `position`?",
        ),
        (
            "drives.motor.angle={ type = \"polynomial\", coeficients = [1] }",
            "did you mean `coefficients`?",
        ),
        // kinds
        ("bodies.rod.type=lnk", "did you mean `link`?"),
        ("joints.main.type=revolut", "did you mean `revolute`?"),
        ("drives.motor.type=angel", "did you mean `angle`?"),
        (
            "drives.motor.angle.type=polinomial",
            "did you mean `polynomial`?",
        ),
        (
            "forces={ f = { type = \"torqe\" } }",
            "did you mean `torque`?",
        ),
        (
            "bodies.slider={ type = \"rigid_body\", plate = { shape = \"rectangel\" } }",
            "did you mean `rectangle`?",
        ),
        // words
        (
            "joints.slider_pin.model=clearence",
            "did you mean `clearance`?",
        ),
        (
            "contacts.pin.law=hunt_crosley",
            "did you mean `hunt_crossley`?",
        ),
        ("integrator.method=bath", "did you mean `bathe`?"),
        ("simulation.analysis=sttic", "did you mean `static`?"),
        ("output.format=cvs", "did you mean `csv`?"),
        // names
        ("joints.main.bearing=grund.main", "did you mean `ground`?"),
        ("joints.main.bearing=ground.mian", "did you mean `main`?"),
        ("joints.slider_pin.contact=pins", "did you mean `pin`?"),
        ("bodies.rod.section=rodd", "did you mean `rod`?"),
        ("bodies.rod.material=stel", "did you mean `steel`?"),
        ("drives.motor.joint=mian", "did you mean `main`?"),
        (
            "initial.sketch.crankpin=[0, 0]",
            "did you mean `crank_pin`?",
        ),
        ("initial.bodies.slidr={ x = 0 }", "did you mean `slider`?"),
        (
            "assumptions={ \"materials.steel.densty\" = \"why\" }",
            "did you mean `materials.steel.density`?",
        ),
        // channels
        (
            "output.channels=[\"slidr.x\"]",
            "the nearest is \"slider.x\"",
        ),
    ] {
        expect(&looselink(&["check", SCENE, "--set", change]), 2, meant);
    }
}

#[test]
fn keys_of_a_study() {
    let folder = tempfile::tempdir().unwrap();
    let study = folder.path().join("study.toml");
    let out = folder.path().join("out");
    let arguments = [
        "precision",
        study.to_str().unwrap(),
        "--out",
        out.to_str().unwrap(),
    ];
    for (text, meant) in [
        ("titel = \"x\"", "did you mean `title`?"),
        ("[[curves]]\nstep = [1e-3]", "did you mean `steps`?"),
    ] {
        fs::write(&study, text).unwrap();
        expect(&looselink(&arguments), 2, meant);
    }
}

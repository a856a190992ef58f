//! Titles, names, units and words of studies.

use super::readers::{csv, json, markdown, squeezed, svg};
use super::{HostileText, assert_harmless, corpus, quoted, scene, titled};
use crate::command_line::files;
use folder::Folder;
use looselink::scene::Scene;
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;
use studies::ablation::{self, Observed, ablate};
use studies::machine::machine;
use studies::precision::{self, Effort, Study, StudyOutcome};
use studies::sweep::{FILES, Shard, Store, Sweep, SweepError, SweepSource, execute, merge};

/// A sweep with a text in every place that takes one.
fn sweep(
    title: &str,
    parameter: &str,
    unit: &str,
    measure: &str,
    word: &str,
) -> Result<Sweep, SweepError> {
    let study = format!(
        "title = {title}\nscene = \"scene.toml\"\n[parameters.{parameter}]\nfields = [\"bodies.journal.mass\"]\nvalues = [0.05, 0.06]\n\
         unit = {unit}\n[parameters.word]\nfields = [\"title\"]\nvalues = [{word}]\n[measures.{measure}]\nof = \"last\"\n\
         channels = [\"journal.x\"]\n[envelopes.{measure}]\nchannels = [\"journal.x\"]\nparts = 2\n"
    );
    Sweep::new(SweepSource {
        path: PathBuf::from("study.toml"),
        study,
        scene: scene(),
        target: None,
    })
}

#[test]
fn sweeps_refuse_texts_by_their_character_or_show_them() {
    let folder = tempfile::tempdir().unwrap();
    for (k, case) in corpus().into_iter().enumerate() {
        let text = quoted(&case.text);
        let [x, y] = ["\"x\"", "\"y\""];
        let tries = [
            (
                sweep(&text, x, x, y, x),
                &case.refused,
                "line 1, column 9: `title`",
            ),
            (
                sweep(x, x, &text, y, x),
                &case.refused,
                "line 6, column 8: `parameters.x.unit`",
            ),
            (
                sweep(x, x, x, y, &text),
                &case.refused,
                "line 9, column 11: `parameters.word.values.0`",
            ),
        ];
        for (made, refused, place) in tries {
            check(&case, made.err(), refused.as_deref(), place);
        }
        let name = case.refused_name();
        check(
            &case,
            sweep(x, &text, x, y, x).err(),
            name,
            "line 3, column 13: `parameters.",
        );
        check(
            &case,
            sweep(x, x, x, &text, x).err(),
            name,
            "line 10, column 11: `measures.",
        );
        if case.refused.is_none() {
            let name = if case.refused_name().is_none() {
                &text
            } else {
                y
            };
            let out = folder.path().join(k.to_string());
            let made = sweep(&text, &name.replacen('"', "\"p", 1), &text, name, &text).unwrap();
            show_sweep(&case, &made, &out);
        }
    }
}

#[track_caller]
fn check(case: &HostileText, error: Option<SweepError>, refused: Option<&str>, place: &str) {
    let said = error.map(|error| error.to_string());
    match (refused, said) {
        (None, None) => {}
        (Some(code), Some(said)) => {
            assert!(
                said.starts_with(&format!("`study.toml`, {place}")),
                "{said}"
            );
            assert!(said.contains(&format!("holds {code}, ")), "{said}");
        }
        (refused, said) => panic!("{:?}: {refused:?} {said:?}", case.text),
    }
}

/// Makes the runs of a sweep, and reads all that is written of them.
fn show_sweep(case: &HostileText, sweep: &Sweep, out: &Path) {
    let mut store = Store::open(out, sweep, Shard::WHOLE, false).unwrap();
    let (one, stop) = (NonZeroUsize::MIN, AtomicBool::new(false));
    execute(sweep, &mut store, Shard::WHOLE, one, &stop, &mut |_| {}).unwrap();
    let merged = merge(sweep, &store, out).unwrap();
    assert_harmless(&merged.page, &case.text);
    // no file is named after a text
    let known = |name: &String| {
        FILES.contains(&&**name)
            || ["manifest.jsonl", "runs.jsonl", "times.jsonl"].contains(&&**name)
    };
    let names = files(out);
    assert!(names.len() >= 7 && names.iter().all(known), "{names:?}");
    let study = &sweep.study;
    let (measure, _) = study.measures.first().unwrap();
    let (parameter, _) = study.parameters.first().unwrap();
    let table = csv(&out.join("sweep.csv"));
    assert_eq!(table[0][3], format!("{parameter} [{}]", case.text));
    assert_eq!(table[0][7], format!("{measure} [m]"));
    assert_eq!(table[1][4], case.text);
    assert_eq!(csv(&out.join("envelopes.csv"))[1][0], *measure);
    let summary = json(&out.join("sweep.json"));
    assert_eq!(summary["title"], case.text);
    assert_eq!(summary["units"][parameter], case.text);
    let blocks = markdown(&out.join("sweep.md"));
    assert_eq!(blocks[0], squeezed(&case.text));
    assert!(blocks.contains(&squeezed(measure)), "{blocks:?}");
    let shown = svg(&out.join("sweep.svg"));
    assert!(shown.contains(&squeezed(&case.text)), "{shown}");
}

/// A study of precision with a title and the name of a curve.
fn precision(title: &str, curve: &str) -> String {
    format!(
        "title = {title}\nscene = \"scene.toml\"\nduration = 4e-4\ninterval = 4e-5\nposition = [\"journal.x\"]\n[reference]\nset = []\n\
         steps = [1e-5, 5e-6]\n[[curves]]\nname = {curve}\nsteps = [4e-5]\n"
    )
}

#[test]
fn studies_of_precision_refuse_texts_or_show_them() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("study.toml");
    std::fs::write(folder.path().join("scene.toml"), scene()).unwrap();
    let machine = machine();
    for (k, case) in corpus().into_iter().enumerate() {
        let text = quoted(&case.text);
        for (study, refused, place) in [
            (
                precision(&text, "\"x\""),
                case.refused.as_deref(),
                "line 1, column 9: `title` holds",
            ),
            (
                precision("\"x\"", &text),
                case.refused_name(),
                "line 10, column 8: `curves.0.name` holds",
            ),
        ] {
            match (refused, Study::parse(&path, &study)) {
                (None, Ok(_)) => {}
                (Some(code), Err(error)) => {
                    let said = error.to_string();
                    assert!(said.contains(&format!("{place} {code}, ")), "{said}");
                }
                (refused, study) => panic!("{:?}: {refused:?} {:?}", case.text, study.err()),
            }
        }
        if case.refused_name().is_some() {
            continue;
        }
        let study = Study::parse(&path, &precision(&text, &text)).unwrap();
        let effort = Effort {
            repeats: 1,
            smoke: true,
        };
        let found = StudyOutcome::run(&study, effort, &mut |_| {}).unwrap();
        let out = folder.path().join(k.to_string());
        let into = Folder::claim(&out, precision::kind(), false).unwrap();
        found.write(&study, &machine, into).unwrap();
        assert_harmless(&found.page(&study, &machine), &case.text);
        let blocks = markdown(&out.join("precision.md"));
        let text = squeezed(&case.text);
        assert!(blocks[0] == text && blocks.contains(&text), "{blocks:?}");
        assert!(svg(&out.join("precision.svg")).contains(&text));
        assert_eq!(
            json(&out.join("precision.json"))["runs"][0]["curve"],
            case.text
        );
    }
}

#[test]
fn ablations_show_titles() {
    let folder = tempfile::tempdir().unwrap();
    for (k, case) in corpus()
        .into_iter()
        .filter(|case| case.refused.is_none())
        .enumerate()
    {
        let scene = Scene::parse("scene.toml", &titled(&quoted(&case.text)), &[]).unwrap();
        let body = Observed::choose(&scene, None).unwrap();
        let made = ablate(&scene, body, Some(1), &mut |_| {});
        let out = folder.path().join(k.to_string());
        let into = Folder::claim(&out, ablation::kind(), false).unwrap();
        made.write(into).unwrap();
        assert_harmless(&made.text(), &case.text);
        let text = squeezed(&case.text);
        assert_eq!(
            markdown(&out.join("ablation.md"))[0],
            format!("{text},effectbyeffect")
        );
        assert!(svg(&out.join("ablation.svg")).contains(&text));
        assert_eq!(json(&out.join("ablation.json"))["title"], case.text);
    }
}

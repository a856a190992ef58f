//! Text that is no scene at all, files that are none, overrides that miss, and anything a fuzzer thinks of.

use crate::bad_input::{CASE4, check, check_all, fault, rendered};
use looselink::scene::Scene;
use proptest::prelude::*;

#[test]
fn faults_of_the_text_itself() {
    #[rustfmt::skip]
    check_all(&[
        ("length = 0.245", "length 0.245", "not valid TOML: key with no value", "length 0.245"),
        ("length = 0.245", "length = 0.245\nlength = 0.3", "the key `length` is given twice", "length"),
        ("[bodies.link1]", "[bodies.crank1]", "the key `crank1` is given twice", "crank1"),
        ("title = \"3-RRR, case 4 with friction in B and C\"", "title = \"3-RRR", "not valid TOML", "title = \"3-RRR"),
        ("length = 0.245", "length\u{a0}= 0.245", "this no-break space (U+00A0) is not that of a keyboard: write a space", "\u{a0}"),
        ("title = \"3-RRR, case 4 with friction in B and C\"", "title = “3-RRR”", "this quotation mark (U+201C) is not that of a keyboard: write \"", "“"),
    ]);
    check(&fault("", &[]), "empty", "the scene is empty", "");
    check(
        &fault("# nothing\n", &[]),
        "comment",
        "the scene is empty",
        "",
    );
    check(
        &fault("format = [", &[]),
        "cut short",
        "not valid TOML",
        "format = [",
    );
}

#[test]
fn faults_of_the_file() {
    let folder = tempfile::tempdir().unwrap();
    let read = |name: &str| Scene::load(&folder.path().join(name), &[]).unwrap_err();
    let error = read("absent.toml");
    assert!(
        error.to_string().contains("absent.toml`: No such file"),
        "{error}"
    );
    assert!(read(".").to_string().contains("it is a directory"));
    std::fs::write(
        folder.path().join("latin1.toml"),
        b"format = 1\ntitle = \"Gelenk f\xfcr\"\n",
    )
    .unwrap();
    let error = read("latin1.toml");
    assert!(error.to_string().contains("not UTF-8"), "{error}");
    assert_eq!(
        error.place().map(|(_, line, column)| (line, column)),
        Some((2, 18))
    );
}

/// Whatever text a user wrote, messages and excerpts hold no character that commands a terminal.
#[test]
fn harmful_characters_are_refused_and_never_shown() {
    for (c, told) in [
        ('\u{1b}', "U+001B, a control character"),
        ('\u{9b}', "U+009B, a control character"),
        ('\u{7f}', "U+007F, a control character"),
        ('\u{2028}', "U+2028, a separator of lines"),
        ('\u{202e}', "U+202E, which turns the direction of a text"),
        ('\u{fffe}', "U+FFFE, which is no character"),
    ] {
        let escaped = format!("\\u{:04X}", u32::from(c));
        let [raw, escaped] = [c.to_string(), escaped].map(|c| CASE4.replace("3-RRR, case 4", &c));
        let change = format!("title=\"{c}\"");
        for (text, overrides) in [(&*raw, &[][..]), (&escaped, &[]), (CASE4, &[&*change])] {
            let error = fault(text, overrides);
            let said = error.to_string();
            assert!(said.ends_with(&format!(" holds {told}")), "{said}");
            assert!(!rendered(&error).contains(c), "{said}");
        }
    }
    // of a file with any name
    let error = Scene::parse("a\u{1b}\nb", "x = 1", &[]).unwrap_err();
    assert!(
        rendered(&error).contains("[aU+001BU+000Ab:1:1]"),
        "{}",
        rendered(&error)
    );
}

/// A file that another file names may be any: its fault is told without a word of it.
#[test]
fn faults_without_contents() {
    for (text, overrides, told) in [
        (
            "a b",
            &[][..],
            "`file`, line 1, column 1: not valid TOML: key with no value, expected `=`",
        ),
        (
            "x = 1\nsecret = hunter2",
            &[],
            "`file`, line 2, column 10: not valid TOML: string values must be quoted, expected literal string",
        ),
        (
            "secret = 1",
            &[],
            "`file`, line 1, column 1: it has no `format = 1`, so it is no scene",
        ),
        (
            "secret = 1",
            &["simulation.duration=1"],
            "`file`, line 1, column 1: it has no `format = 1`, so it is no scene",
        ),
        (
            "format = 1\n\ntitel = 5",
            &[],
            "`file`, line 3, column 1: unknown key `titel` in the scene; did you mean `title`?",
        ),
        (
            "format = 1\ntitle = \"x\"",
            &["titel=5"],
            "unknown key `titel` in the scene; did you mean `title`?",
        ),
    ] {
        let overrides: Vec<String> = overrides.iter().map(|o| (*o).to_owned()).collect();
        let error = Scene::parse("file", text, &overrides).unwrap_err();
        let error = error.without_contents();
        assert_eq!(error.to_string(), told);
        let shown = rendered(&error);
        assert!(
            !shown.contains("secret") && !shown.contains("hunter2"),
            "{shown}"
        );
        // an override is not of the file
        assert_eq!(
            shown.contains("titel=5"),
            error.change().is_some(),
            "{shown}"
        );
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2000, failure_persistence: None, ..ProptestConfig::default() })]

    /// Whatever stands in the file, the answer is a scene or a fault that can be shown.
    #[test]
    fn mutated_scenes_never_panic(edits in prop::collection::vec((0..CASE4.len(), 0..40usize, any::<Vec<u8>>()), 1..4)) {
        let mut bytes = CASE4.as_bytes().to_vec();
        for (at, cut, insert) in edits {
            let at = at.min(bytes.len());
            let end = (at + cut).min(bytes.len());
            bytes.splice(at..end, insert.into_iter().take(8));
        }
        let text = String::from_utf8_lossy(&bytes);
        if let Err(error) = Scene::parse("scene.toml", &text, &[]) {
            prop_assert!(!rendered(&error).is_empty());
        }
    }

    /// The same for tokens of the language in any order, which reach deeper than bytes do.
    #[test]
    fn shuffled_lines_never_panic(order in prop::collection::vec(0..200usize, 0..200)) {
        let lines: Vec<&str> = CASE4.lines().collect();
        let text: String = order.iter().filter_map(|n| lines.get(*n)).flat_map(|l| [*l, "\n"]).collect();
        if let Err(error) = Scene::parse("scene.toml", &text, &[]) {
            prop_assert!(!rendered(&error).is_empty());
        }
    }

    #[test]
    fn arbitrary_overrides_never_panic(text in "[a-z.\"=\\[\\]{}0-9 é]{0,30}") {
        if let Err(error) = Scene::parse("scene.toml", CASE4, &[text]) {
            prop_assert!(!rendered(&error).is_empty());
        }
    }
}

#[test]
fn deep_nesting_is_refused_not_followed() {
    let deep = 200_000;
    for text in [
        format!("a = {}", "[".repeat(deep)),
        format!("a = {}1{}", "[".repeat(70), "]".repeat(70)),
        format!("a = {}", "{ a = ".repeat(deep)),
        format!("a = {}", "{ a.a = ".repeat(70)),
        format!("a{} = 1", ".a".repeat(deep)),
        format!("[a{}]", ".a".repeat(deep)),
        format!(
            "[a{0}]\na{0} = {1}",
            ".a".repeat(70),
            format!("{{ a{} = ", ".a".repeat(70)).repeat(70)
        ),
        format!(
            "[a{0}]\na{0} = {1}1{2}",
            ".a".repeat(70),
            format!("{{ a{} = ", ".a".repeat(70)).repeat(70),
            "}".repeat(70)
        ),
    ] {
        assert!(!rendered(&fault(&text, &[])).is_empty());
    }
    let nested = format!("a = {}1{}", "[".repeat(40), "]".repeat(40));
    let message = fault(&nested, &[]).to_string();
    assert_eq!(message, "this is nested too deeply for a scene");
    // dots and brackets of strings and comments, and those of one line after the other, do not nest
    let flat = format!(
        "title = \"{0}\" # {0}\n{1}",
        ".[".repeat(50),
        "a.a = [1.0]\n".repeat(50)
    );
    let message = fault(&flat, &[]).to_string();
    assert_eq!(message, "the key `a` is given twice");
}

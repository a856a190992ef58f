//! Input that once made the reader hang or swell: it is refused within moderate time, memory and length of message.

use crate::bad_input::{CASE4, fault, rendered};
use looselink::scene::Scene;
use std::time::{Duration, Instant};

/// Longest message that is still read; the line of a table of a megabyte was shown whole, within minutes.
const READABLE: usize = 10_000;

/// What is long, the scene, a part of the message.
type LongInput = (&'static str, String, &'static str);

fn cases() -> Vec<LongInput> {
    let many = |text: &str| text.repeat(1_000_000);
    let edited = |from: &str, to: &str| {
        assert!(CASE4.contains(from), "`{from}` is not in the scene");
        CASE4.replacen(from, to, 1)
    };
    vec![
        (
            "a line in front of the fault",
            edited(
                "format = 1",
                &format!("format = 1 #{}\nforce = 2", many("é")),
            ),
            "unknown key `force`",
        ),
        (
            "the line of the fault",
            edited("format = 1", &format!("format = 1\nx = [{}]", many("1, "))),
            "unknown key `x` in the scene",
        ),
        (
            "the value at fault",
            edited("duration = 3.0", &format!("duration = [{}]", many("1, "))),
            "`simulation.duration` must be a number, not an array",
        ),
        (
            "the value quoted by the message",
            edited("title = ", &format!("format = {}1\ntitle = ", many("0"))).replacen(
                "format = 1\n",
                "",
                1,
            ),
            "a number does not begin with zeros",
        ),
        (
            "a value at fault of several lines",
            edited(
                "duration = 3.0",
                &format!(
                    "duration = [\n{}\n,\n1]",
                    many("1, ").trim_end_matches(", ")
                ),
            ),
            "`simulation.duration` must be a number, not an array",
        ),
        (
            "the second line of a value at fault",
            edited(
                "duration = 3.0",
                &format!("duration = [\n1,\n{}]", many("1, ")),
            ),
            "`simulation.duration` must be a number, not an array",
        ),
        (
            "an unknown key",
            edited("format = 1", &format!("format = 1\n{} = 2", many("k"))),
            "unknown key `kkkkkk",
        ),
        (
            "two names that differ",
            edited("[bodies.link1]", &format!("[bodies.{}]", many("n"))).replacen(
                "\"link1.start\"",
                &format!("\"{}m.start\"", many("n")),
                1,
            ),
            "there is no body `nnnnnn",
        ),
        (
            "a line in front of a syntax error",
            edited("format = 1", &format!("format = 1 #{}\n]", many("x"))),
            "not valid TOML",
        ),
    ]
}

#[test]
fn long_input_gives_short_messages_in_time() {
    for (name, text, message) in cases() {
        let started = Instant::now();
        let error = fault(&text, &[]);
        let shown = rendered(&error);
        assert!(error.to_string().contains(message), "{name}: {error}");
        assert!(shown.len() < READABLE, "{name}: {} bytes", shown.len());
        let (file, line, column) = error.place().unwrap();
        assert!(
            shown.contains(&format!("{file}:{line}:{column}")),
            "{name}: {shown}"
        );
        // a hundred times what it takes, and far below the minutes of before
        assert!(started.elapsed() < Duration::from_secs(10), "{name}");
    }
}

#[test]
fn long_overrides_give_short_messages() {
    let long = "1, ".repeat(1_000_000);
    for set in [
        format!("a.b=[{long}]"),
        format!("simulation.duration=[{long}]"),
    ] {
        assert!(rendered(&fault(CASE4, &[&set])).len() < READABLE);
    }
}

/// A file without an end is read up to a bound.
#[cfg(target_os = "linux")]
#[test]
fn endless_files_are_refused() {
    let endless = "/dev/zero".as_ref();
    let message = Scene::load(endless, &[]).unwrap_err().to_string();
    assert_eq!(message, "cannot read `/dev/zero`: it is larger than 8 MiB");
}

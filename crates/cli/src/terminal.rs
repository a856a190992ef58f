//! What reaches the terminal: all that the program writes to standard output and standard error goes through here, and holds no
//! character with which a text of others could command the terminal.

use super::failure::CommandFailure;
use std::io::{ErrorKind, IsTerminal, Write};
use std::path::Path;
use texts::{harmless, harmless_line};

/// Writes to standard output; a reader that has gone away is no fault.
pub fn print(text: impl AsRef<[u8]>) -> Result<(), CommandFailure> {
    let text = String::from_utf8_lossy(text.as_ref());
    let mut out = std::io::stdout().lock();
    let written = out.write_all(harmless(&text).as_bytes());
    match written.and_then(|()| out.flush()) {
        Err(e) if e.kind() != ErrorKind::BrokenPipe => Err(CommandFailure::system(format!(
            "cannot write to standard output: {e}"
        ))),
        _ => Ok(()),
    }
}

/// A line on standard error.
pub fn say(line: &str) {
    show(&harmless_line(line));
}

/// What may have colours of our own, on standard error; the texts of others in it are harmless already.
pub fn show(text: &str) {
    // A run does not fail because nobody listens.
    let _ = writeln!(std::io::stderr(), "{text}");
}

/// A path as a word of a command line: in quotes, where it has characters that a shell takes for others.
pub fn word(path: &Path) -> String {
    let text = path.display().to_string();
    let quoted = shlex::try_quote(&text).map(String::from);
    // of all characters a NUL alone cannot be quoted, and no path has it
    quoted.unwrap_or(text)
}

/// True where standard error is a terminal.
pub fn is_shown_to_people() -> bool {
    std::io::stderr().is_terminal()
}

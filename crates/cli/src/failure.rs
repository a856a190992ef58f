//! How a command fails: what is shown, and the exit code.

use super::terminal::show;
use folder::OutputError;
use looselink::scene::SceneError;
use looselink::simulate::RunError;
use messages::{Colors, run_failure, scene_fault};
use std::fmt::Display;
use std::io;
use std::process::ExitCode;
use studies::StudyError;
use studies::sweep::SweepError;
use texts::{harmless, harmless_line};
use view::ViewError;

const SYSTEM: u8 = 1;
const BAD_INPUT: u8 = 2;
const CANNOT_GO_ON: u8 = 3;
/// 128 + SIGINT, what shells expect.
pub const INTERRUPTED: u8 = 130;

/// The end of a command that did not do what it was asked.
#[derive(Debug)]
pub struct CommandFailure {
    code: u8,
    /// Harmless but for colours of our own.
    text: String,
}

impl CommandFailure {
    fn new(code: u8, message: impl Display) -> CommandFailure {
        CommandFailure {
            code,
            text: format!("error: {}", harmless_line(&message.to_string())),
        }
    }

    /// Input or output failed.
    pub fn system(message: impl Display) -> CommandFailure {
        CommandFailure::new(SYSTEM, message)
    }

    /// What the command line asks for cannot be done.
    pub fn bad_input(message: impl Display) -> CommandFailure {
        CommandFailure::new(BAD_INPUT, message)
    }

    /// What was asked for does not exist at that state.
    pub fn cannot_go_on(message: impl Display) -> CommandFailure {
        CommandFailure::new(CANNOT_GO_ON, message)
    }

    /// A run that ended early.
    pub fn run(error: &RunError) -> CommandFailure {
        let code = match error {
            RunError::Interrupted { .. } => INTERRUPTED,
            RunError::Output(_) => SYSTEM,
            _ => CANNOT_GO_ON,
        };
        CommandFailure::new(code, run_failure(error))
    }

    /// The same failure with more to say.
    pub fn and(mut self, more: &str) -> CommandFailure {
        self.text += &harmless_line(more);
        self
    }

    /// What failed on the way of another failure.
    pub fn after(&self, what: &str) -> String {
        format!("; {what}: {}", self.text.trim_start_matches("error: "))
    }

    /// Tells the user on standard error.
    pub fn show(&self) -> ExitCode {
        show(self.text.trim_end());
        ExitCode::from(self.code)
    }
}

impl From<SceneError> for CommandFailure {
    fn from(error: SceneError) -> CommandFailure {
        CommandFailure {
            code: BAD_INPUT,
            text: scene_fault(&error, Colors::OfTerminal),
        }
    }
}

impl From<StudyError> for CommandFailure {
    fn from(error: StudyError) -> CommandFailure {
        match error {
            // lines of the study may stand below each other
            StudyError::Plain(message) => CommandFailure {
                code: BAD_INPUT,
                text: format!("error: {}", harmless(&message)),
            },
            StudyError::Scene(error) => error.into(),
        }
    }
}

impl From<SweepError> for CommandFailure {
    fn from(error: SweepError) -> CommandFailure {
        match error {
            SweepError::Study(error) => error.into(),
            SweepError::Output(error) => error.into(),
            SweepError::Interrupted { .. } => CommandFailure::new(INTERRUPTED, error),
            SweepError::NoAnswer(_) => CommandFailure::cannot_go_on(error),
        }
    }
}

impl From<ViewError> for CommandFailure {
    fn from(error: ViewError) -> CommandFailure {
        match error {
            ViewError::Result(message) => CommandFailure::bad_input(message),
            ViewError::Scene(error) => error.into(),
            ViewError::Io(error) => error.into(),
            ViewError::Output(error) => error.into(),
        }
    }
}

impl From<io::Error> for CommandFailure {
    /// A link, a pipe or a file with a second name in the place of a file is refused as other bad input is.
    fn from(error: io::Error) -> CommandFailure {
        match error.kind() {
            io::ErrorKind::InvalidInput => CommandFailure::bad_input(error),
            _ => CommandFailure::system(error),
        }
    }
}

impl From<OutputError> for CommandFailure {
    fn from(error: OutputError) -> CommandFailure {
        match error {
            OutputError::Io(error) => error.into(),
            OutputError::Changed { .. } => CommandFailure::system(error),
            OutputError::OfAnotherKind { .. } => {
                CommandFailure::bad_input(error).and("; choose another folder")
            }
            OutputError::NotADirectory(_)
            | OutputError::NotAFile(_)
            | OutputError::Busy(_)
            | OutputError::Foreign(_)
            | OutputError::NoManifest(_) => CommandFailure::bad_input(error),
            OutputError::NotResumable { .. } => CommandFailure::bad_input(error)
                .and("; `looselink run` with --force begins the run anew"),
            OutputError::Occupied { .. } => CommandFailure::bad_input(error)
                .and("; choose another folder, or replace it with --force"),
        }
    }
}

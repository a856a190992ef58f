//! How a command fails: what is shown, and the exit code.

use looselink::output::OutputError;
use looselink::scene::SceneError;
use looselink::simulate::RunError;
use miette::MietteHandlerOpts;
use std::io::Write;
use std::process::ExitCode;
use studies::precision::StudyError;

const SYSTEM: u8 = 1;
const BAD_INPUT: u8 = 2;
const CANNOT_GO_ON: u8 = 3;
/// 128 + SIGINT, what shells expect.
pub const INTERRUPTED: u8 = 130;

/// The end of a command that did not do what it was asked.
#[derive(Debug)]
pub struct Failure {
    code: u8,
    message: Message,
}

#[derive(Debug)]
enum Message {
    Scene(SceneError),
    Plain(String),
}

impl Failure {
    /// Input or output failed.
    pub fn system(message: String) -> Failure {
        Failure {
            code: SYSTEM,
            message: Message::Plain(message),
        }
    }

    /// What the command line asks for cannot be done.
    pub fn bad_input(message: String) -> Failure {
        Failure {
            code: BAD_INPUT,
            message: Message::Plain(message),
        }
    }

    /// A run that ended early.
    pub fn run(error: &RunError) -> Failure {
        let (code, message) = match error {
            RunError::Interrupted { .. } => (INTERRUPTED, error.to_string()),
            RunError::Output(_) => (SYSTEM, error.to_string()),
            RunError::Unaffordable { .. } => (
                CANNOT_GO_ON,
                format!(
                    "the run stops at its first step: {error}; another method may take fewer steps"
                ),
            ),
            _ => (CANNOT_GO_ON, format!("the run cannot go on: {error}")),
        };
        Failure {
            code,
            message: Message::Plain(message),
        }
    }

    /// The same failure with more to say.
    pub fn and(mut self, more: &str) -> Failure {
        if let Message::Plain(message) = &mut self.message {
            message.push_str(more);
        }
        self
    }

    /// Tells the user on standard error.
    pub fn show(&self) -> ExitCode {
        let text = match &self.message {
            Message::Plain(message) => format!("error: {message}"),
            Message::Scene(error) => {
                // Whole lines: a message that is cut in two cannot be searched for.
                let hook =
                    |_: &_| Box::new(MietteHandlerOpts::new().wrap_lines(false).build()) as _;
                // Fails only when a hook is there already.
                let _ = miette::set_hook(Box::new(hook));
                format!("{:?}", miette::Report::new(error.clone()))
            }
        };
        // Standard error is closed: nobody can read this.
        let _ = writeln!(std::io::stderr(), "{}", text.trim_end());
        ExitCode::from(self.code)
    }
}

impl From<SceneError> for Failure {
    fn from(error: SceneError) -> Failure {
        Failure {
            code: BAD_INPUT,
            message: Message::Scene(error),
        }
    }
}

impl From<StudyError> for Failure {
    fn from(error: StudyError) -> Failure {
        match error {
            StudyError::Plain(message) => Failure::bad_input(message),
            StudyError::Scene(error) => error.into(),
        }
    }
}

impl From<OutputError> for Failure {
    fn from(error: OutputError) -> Failure {
        let (code, hint) = match error {
            OutputError::Io(_) => (SYSTEM, ""),
            OutputError::NotADirectory(_) | OutputError::NotAFile(_) | OutputError::Busy(_) => {
                (BAD_INPUT, "")
            }
            OutputError::Occupied { .. } => (
                BAD_INPUT,
                "; choose another folder, or replace it with --force",
            ),
        };
        Failure {
            code,
            message: Message::Plain(format!("{error}{hint}")),
        }
    }
}

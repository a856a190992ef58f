//! Faults of a scene and failures of a run.

use looselink::scene::SceneError;
use looselink::simulate::RunError;
use miette::{MietteHandlerOpts, ReportHandler};
use std::fmt::{self, Debug, Formatter};

/// Whether a text has colours.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Colors {
    /// Where standard error is a terminal that shows them.
    OfTerminal,
    /// None.
    None,
}

/// A fault of a scene with file, line, column and the underlined text. Whole lines: a message that is cut in two cannot be searched
/// for.
pub fn scene_fault(error: &SceneError, colors: Colors) -> String {
    let options = MietteHandlerOpts::new().wrap_lines(false);
    let options = match colors {
        Colors::OfTerminal => options,
        Colors::None => options.color(false),
    };
    let shown = RenderedFault {
        error,
        handler: Box::new(options.build()),
    };
    format!("{shown:?}")
}

struct RenderedFault<'a> {
    error: &'a SceneError,
    handler: Box<dyn ReportHandler>,
}

impl Debug for RenderedFault<'_> {
    fn fmt(&self, f: &mut Formatter) -> fmt::Result {
        self.handler.debug(self.error, f)
    }
}

/// Why a run has ended early.
pub fn run_failure(error: &RunError) -> String {
    match error {
        RunError::Interrupted { .. } | RunError::Output(_) => error.to_string(),
        RunError::Unaffordable { .. } => {
            format!("the run stops at its first step: {error}; another method may take fewer steps")
        }
        _ => format!("the run cannot go on: {error}"),
    }
}

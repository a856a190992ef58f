//! Functions of time as Python callables.
//!
//! The text of a scene names a callable by its number: `{ type = "callable", number = 0 }`. While the scene is read, its callables
//! are those of this thread. What a callable raises is kept for this thread, too, because a simulation has one thread: the callable
//! then counts as not a number, at which every method stops, and the exception is raised once the solver has returned.

use super::errors::raise;
use looselink::document::{Fields, Key, SceneError, Takes};
use looselink::motion::{Function, FunctionKind, FunctionOfTime, Use};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use std::cell::RefCell;
use std::sync::Arc;

/// A callable of a scene.
#[derive(Debug)]
pub struct Given {
    /// What is called.
    pub function: Py<PyAny>,
    /// What gives the derivatives of a load.
    pub tangent: Option<Py<PyAny>>,
}

thread_local! {
    static GIVEN: RefCell<Vec<Arc<Given>>> = const { RefCell::new(Vec::new()) };
    static RAISED: RefCell<Option<PyErr>> = const { RefCell::new(None) };
}

/// Does `read` while a scene can name these callables.
pub fn with_given<T>(given: &[Arc<Given>], read: impl FnOnce() -> T) -> T {
    let before = GIVEN.replace(given.to_vec());
    let result = read();
    GIVEN.set(before);
    result
}

/// What a callable has raised on this thread since it was last asked for.
pub fn take_raised() -> Option<PyErr> {
    RAISED.take()
}

/// What a callable gives; nothing once one has raised an exception, which is kept.
pub fn call<T>(call: impl FnOnce(Python) -> PyResult<T>) -> Option<T> {
    if RAISED.with_borrow(Option::is_some) {
        return None;
    }
    let result = Python::attach(call);
    result.map_err(|error| RAISED.set(Some(error))).ok()
}

/// The key by which a scene names a callable.
pub const NUMBER: Key = Key::new(
    "number",
    Takes::Whole(0, i64::MAX),
    "the number of the callable",
);

/// The callable that a table names.
pub fn given(table: &Fields) -> Result<Arc<Given>, SceneError> {
    let field = table.field(NUMBER.name)?;
    let number = usize::try_from(field.integer()?).ok();
    let found = GIVEN.with_borrow(|given| given.get(number?).cloned());
    found.ok_or_else(|| {
        let message = format!("there is no callable `{}`", field.written());
        field.fault(message, "not given by this program")
    })
}

/// A function of time that calls Python: for loads f(t) = value, for motions f(t) = (value, rate, acceleration).
pub static FUNCTION: FunctionKind = FunctionKind {
    name: "callable",
    keys: &[NUMBER],
    read: |table, purpose, _| {
        let function = CallableFunction {
            path: table.path().to_owned(),
            given: given(table)?,
            purpose,
        };
        match function.values(0.0) {
            Some(_) => Ok(Function::Own(Arc::new(function))),
            // the exception is raised instead
            None => Err(table.fault(format!("the callable of `{}` fails", table.path()), "here")),
        }
    },
};

#[derive(Debug)]
struct CallableFunction {
    path: String,
    given: Arc<Given>,
    purpose: Use,
}

impl CallableFunction {
    fn values(&self, t: f64) -> Option<[f64; 3]> {
        call(|py| {
            let result = self.given.function.bind(py).call1((t,))?;
            let values = match self.purpose {
                Use::Load => result.extract().map(|value| [value, 0.0, 0.0]),
                Use::Motion => result.extract(),
            };
            let values = values.map_err(|_| self.wrong(&result))?;
            finite(&self.path, t, &values)?;
            Ok(values)
        })
    }

    fn wrong(&self, result: &Bound<PyAny>) -> PyErr {
        let wanted = match self.purpose {
            Use::Load => "a number",
            Use::Motion => "(value, rate, acceleration)",
        };
        wrong_result(&self.path, wanted, result)
    }
}

impl FunctionOfTime for CallableFunction {
    fn at(&self, t: f64) -> [f64; 3] {
        self.values(t).unwrap_or([f64::NAN; 3])
    }
}

/// The exception for a callable that returns something else.
pub fn wrong_result(path: &str, wanted: &str, result: &Bound<PyAny>) -> PyErr {
    let shown = result.repr().map_or(String::new(), |repr| repr.to_string());
    raise::<PyTypeError>(format!(
        "the callable of `{path}` must return {wanted}, not {shown}"
    ))
}

/// Refuses values that are not finite.
pub fn finite(path: &str, t: f64, values: &[f64]) -> PyResult<()> {
    match values.iter().find(|value| !value.is_finite()) {
        Some(value) => Err(raise::<PyValueError>(format!(
            "the callable of `{path}` returns {value} at t = {t} s"
        ))),
        None => Ok(()),
    }
}

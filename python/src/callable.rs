//! Callables of a scene, and functions of time that call them.
//!
//! The text of a scene names a callable by its number: `{ type = "callable", number = 0 }`. While a scene is read, run or shown, its
//! callables are those of this thread, because a simulation has one thread. What one of them raises is kept for this thread, too:
//! the callable then counts as not a number, at which every method stops, and the exception is raised once the solver has returned.
//! So a compiled scene holds no object of Python.

use super::errors::raise;
use super::stack::room;
use looselink::document::{Fields, Key, SceneError, Takes};
use looselink::motion::{Function, FunctionKind, FunctionOfTime, Use};
use looselink::newton::interruptible;
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyTuple;
use std::cell::{Cell, RefCell};
use std::collections::BTreeSet;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Time between two looks at signals.
const LOOK: Duration = Duration::from_millis(50);

/// The callables of a scene by their numbers, each as (path, function, tangent or None), or None where others have taken its place. A
/// tuple, which the garbage collector of Python looks into.
pub type Callables = Py<PyTuple>;

/// What a callable of a scene is called for.
#[derive(Debug, Clone, Copy)]
pub enum Role {
    /// The function of time, or the load.
    Function,
    /// The derivatives of a load.
    Tangent,
}

/// The scene that this thread evaluates.
struct Evaluated {
    /// By their numbers, what is called in each role.
    callables: Vec<Option<[Py<PyAny>; 2]>>,
    /// How many of them have been called before.
    checked: usize,
    /// Those that the text names.
    named: BTreeSet<usize>,
    raised: Option<PyErr>,
}

thread_local! {
    static EVALUATED: RefCell<Option<Evaluated>> = const { RefCell::new(None) };
}

/// The scene around the one that is evaluated, whose callable evaluates it.
struct Outer(Option<Evaluated>);

impl Drop for Outer {
    fn drop(&mut self) {
        // what it held may end objects of Python, which are free to do anything: not while the cell is borrowed
        drop(EVALUATED.replace(self.0.take()));
    }
}

/// Does `work` while a scene can call these callables, of which the first ones have been called before.
///
/// # Errors
/// What a callable has raised, and RecursionError where the stack of the thread is almost full.
pub fn evaluating<T>(
    py: Python,
    callables: &Callables,
    checked: usize,
    work: impl FnOnce() -> PyResult<T>,
) -> PyResult<T> {
    room()?;
    let callables = callables.bind(py).iter().map(|callable| {
        let callable: Option<(Py<PyAny>, _, _)> = callable.extract()?;
        Ok(callable.map(|(_path, function, tangent)| [function, tangent]))
    });
    let outer = EVALUATED.replace(Some(Evaluated {
        callables: callables.collect::<PyResult<_>>()?,
        checked,
        named: BTreeSet::new(),
        raised: None,
    }));
    let _outer = Outer(outer);
    let result = work();
    // what a callable raised is the cause of the fault
    take_raised().map_or(result, Err)
}

/// Does `work`, which may take long, and ends it after Ctrl-C: what Python then raises is kept as what a callable raises.
pub fn watching<T>(work: impl FnOnce() -> T) -> T {
    let looked = Cell::new(Instant::now());
    let ended = || EVALUATED.with_borrow(|e| e.as_ref().is_some_and(|e| e.raised.is_some()));
    let asked = move || {
        // iterations may be short or long
        if !ended() && looked.get().elapsed() >= LOOK {
            looked.set(Instant::now());
            let signals = Python::attach(|py| py.check_signals());
            signals.unwrap_or_else(keep_raised);
        }
        ended()
    };
    interruptible(asked, work)
}

/// What a callable of the scene that is evaluated has raised since it was last asked for.
pub fn take_raised() -> Option<PyErr> {
    EVALUATED.with_borrow_mut(|evaluated| evaluated.as_mut()?.raised.take())
}

/// What a callable of the scene that is evaluated gives; nothing once one has raised an exception, which is kept.
pub fn call<T>(
    number: usize,
    role: Role,
    call: impl FnOnce(Bound<PyAny>) -> PyResult<T>,
) -> Option<T> {
    Python::attach(|py| {
        let raised = |evaluated: &Evaluated| evaluated.raised.is_some();
        let function = EVALUATED.with_borrow(|evaluated| {
            let evaluated = evaluated.as_ref().filter(|evaluated| !raised(evaluated))?;
            evaluated.callable(py, number, role)
        })?;
        // while it works it may evaluate another scene
        call(function).map_err(keep_raised).ok()
    })
}

fn keep_raised(error: PyErr) {
    EVALUATED.with_borrow_mut(|evaluated| {
        let evaluated = evaluated.as_mut().expect("a scene is evaluated");
        evaluated.raised = Some(error);
    });
}

impl Evaluated {
    fn callable<'py>(
        &self,
        py: Python<'py>,
        number: usize,
        role: Role,
    ) -> Option<Bound<'py, PyAny>> {
        let callable = self.callables.get(number)?.as_ref()?;
        Some(callable[role as usize].clone_ref(py).into_bound(py))
    }
}

/// True where the scene that is evaluated has a callable in a role.
pub fn is_given(number: usize, role: Role) -> bool {
    Python::attach(|py| {
        let callable =
            EVALUATED.with_borrow(|evaluated| evaluated.as_ref()?.callable(py, number, role));
        callable.is_some_and(|callable| !callable.is_none())
    })
}

/// The key by which a scene names a callable.
pub const NUMBER: Key = Key::new(
    "number",
    Takes::Whole(0, i64::MAX),
    "the number of the callable",
);

/// The number of the callable that a table names.
///
/// # Errors
/// A number that this program has not given.
pub fn number(table: &Fields) -> Result<usize, SceneError> {
    let field = table.field(NUMBER.name)?;
    let number = usize::try_from(field.integer()?).ok();
    let known = |number: &usize| is_given(*number, Role::Function);
    let number = number.filter(known).ok_or_else(|| {
        let message = format!("there is no callable `{}`", field.written());
        field.fault(message, "not given by this program")
    })?;
    EVALUATED.with_borrow_mut(|evaluated| evaluated.as_mut().map(|e| e.named.insert(number)));
    Ok(number)
}

/// Callables by their numbers, without those that the scene that is evaluated has not named.
///
/// # Errors
/// None but for want of memory.
pub fn named_only<'py>(callables: &Bound<'py, PyTuple>) -> PyResult<Bound<'py, PyTuple>> {
    let named = EVALUATED.with_borrow(|evaluated| evaluated.as_ref().map(|e| e.named.clone()));
    let named = named.unwrap_or_default();
    let kept = callables.iter().enumerate();
    let kept = kept.map(|(number, callable)| named.contains(&number).then_some(callable));
    PyTuple::new(callables.py(), kept.collect::<Vec<_>>())
}

/// True of callables that have been called before to check them.
fn is_checked(number: usize) -> bool {
    EVALUATED.with_borrow(|evaluated| evaluated.as_ref().is_some_and(|e| number < e.checked))
}

/// A function of time that calls Python: for loads f(t) = value, for motions f(t) = (value, rate, acceleration).
pub static FUNCTION: FunctionKind = FunctionKind {
    name: "callable",
    keys: &[NUMBER],
    read: |table, purpose, _| {
        let function = CallableFunction {
            path: table.path().to_owned(),
            number: number(table)?,
            purpose,
        };
        if !is_checked(function.number) && function.values(0.0).is_none() {
            // the exception is raised instead
            let message = format!("the callable of `{}` fails", table.path());
            return Err(table.fault(message, "here"));
        }
        Ok(Function::Own(Arc::new(function)))
    },
};

#[derive(Debug)]
struct CallableFunction {
    path: String,
    number: usize,
    purpose: Use,
}

impl CallableFunction {
    fn values(&self, t: f64) -> Option<[f64; 3]> {
        call(self.number, Role::Function, |function| {
            let result = function.call1((t,))?;
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

//! `[integrator]`: scheme, step or accuracy, tolerances.

use super::error::SceneError;
use super::field::Field;
use super::fields::Fields;
use super::{Accuracy, Analysis, Integrator, Method, Pace, Simulation};
use crate::registry::Registry;
use crate::stepper::{Parameter, Scheme};
use numbers::number;

/// More steps than this are a slip of the pen: a week of computing at 20 microseconds a step.
const MOST_STEPS: f64 = 1e10;

/// `clearance` is the smallest one of the scene.
pub(super) fn read(
    root: &Fields,
    simulation: &Simulation,
    clearance: Option<f64>,
    registry: &Registry,
) -> Result<Integrator, SceneError> {
    let mut table = root
        .required("integrator", "the table of method, step and tolerances")?
        .fields()?;
    let schemes = &registry.schemes;
    let parameters = schemes.iter().flat_map(|s| s.parameters);
    let mut known = vec!["method"];
    for parameter in parameters {
        if !known.contains(&parameter.name) {
            known.push(parameter.name);
        }
    }
    known.extend([
        "step",
        "accuracy",
        "newton_tolerance",
        "onset_tolerance",
        "locate_onsets",
    ]);
    table.only(&known)?;
    let names: Vec<String> = schemes.iter().map(|s| format!("{:?}", s.name)).collect();
    let purpose = format!("the integration scheme: {}", names.join(", "));
    let named = table.required("method", &purpose)?;
    let choices: Vec<_> = schemes.iter().map(|s| (s.name, *s)).collect();
    let method = method(&table, named.choice(&choices)?, schemes)?;
    let paced = pace_field(&table)?;
    let pace = match paced.name.as_str() {
        "step" => Pace::Step(step(&paced, simulation)?),
        _ => Pace::Accuracy(accuracy(&paced, simulation, clearance.is_some())?),
    };
    Ok(Integrator {
        method,
        pace,
        newton_tolerance: newton_tolerance(&table, method)?,
        onset_tolerance: onset_tolerance(&table, clearance)?,
        locate_onsets: match table.optional("locate_onsets") {
            Some(field) => field.boolean()?,
            None => true,
        },
        method_span: named.node.span,
        pace_span: paced.node.span,
    })
}

/// The scheme with the parameters that the table gives.
fn method(
    table: &Fields,
    scheme: &'static Scheme,
    schemes: &[&'static Scheme],
) -> Result<Method, SceneError> {
    let has = |scheme: &Scheme, name| scheme.parameters.iter().any(|p| p.name == name);
    for parameter in schemes.iter().flat_map(|s| s.parameters) {
        if let Some(field) = table.optional(parameter.name)
            && !has(scheme, parameter.name)
        {
            let owners = schemes.iter().filter(|s| has(s, parameter.name));
            let owners: Vec<String> = owners.map(|s| format!("{:?}", s.name)).collect();
            let message = format!(
                "`{}` is a parameter of {} only",
                field.path,
                owners.join(", ")
            );
            return Err(field.key_fault(message, "remove this"));
        }
    }
    let mut method = Method::new(scheme);
    for parameter in scheme.parameters {
        let field = match parameter.required {
            true => Some(table.required(parameter.name, parameter.purpose)?),
            false => table.optional(parameter.name),
        };
        if let Some(field) = field {
            method = method.with(parameter.name, value(&field, parameter)?);
        }
    }
    Ok(method)
}

/// A number in the range of a parameter.
fn value(field: &Field, parameter: &Parameter) -> Result<f64, SceneError> {
    let ([least, most], x) = (parameter.range, field.number()?);
    if parameter.closed && (least..=most).contains(&x) || x > least && x < most {
        return Ok(x);
    }
    let ends = if parameter.closed {
        ""
    } else {
        ", both excluded"
    };
    Err(field.must(&format!("lie between {least} and {most}{ends}")))
}

/// `step` or `accuracy`; where both stand the one that comes from a later source, which is an override.
fn pace_field<'a>(table: &Fields<'a>) -> Result<Field<'a>, SceneError> {
    match (table.optional("step"), table.optional("accuracy")) {
        (Some(step), Some(accuracy)) => match step.key.source().cmp(&accuracy.key.source()) {
            std::cmp::Ordering::Less => Ok(accuracy),
            std::cmp::Ordering::Greater => Ok(step),
            std::cmp::Ordering::Equal => {
                let message = "`integrator` has both `step` and `accuracy`: give only one of them";
                Err(accuracy.key_fault(message, "remove this or `step`"))
            }
        },
        (None, Some(accuracy)) => Ok(accuracy),
        _ => table.required(
            "step",
            "the time step [s]; or give `accuracy = { position = ... }` [m] instead of it",
        ),
    }
}

fn step(field: &Field, simulation: &Simulation) -> Result<f64, SceneError> {
    let step = field.positive()?;
    if step > simulation.duration {
        return Err(field.must(&format!(
            "not be longer than the duration of {} s",
            simulation.duration
        )));
    }
    let steps = simulation.duration / step;
    if steps > MOST_STEPS {
        let message = format!(
            "`{}` is too small: {} steps in all",
            field.path,
            number(steps, 2)
        );
        return Err(field.fault(message, "at most 1e10 steps"));
    }
    Ok(step)
}

/// `loose` where a joint has clearance.
fn accuracy(field: &Field, simulation: &Simulation, loose: bool) -> Result<Accuracy, SceneError> {
    if simulation.analysis == Analysis::Static {
        let message = "a static analysis takes a `step`, not an `accuracy`";
        return Err(field.key_fault(message, "write `step`"));
    }
    let mut table = field.fields()?;
    table.only(&["position", "energy", "horizon"])?;
    let position = table
        .required(
            "position",
            "the error allowed in the position of a point [m]",
        )?
        .positive()?;
    let energy = match table.optional("energy") {
        Some(energy) => Some(energy.positive()?),
        None => None,
    };
    let purpose = "the time [s] over which errors may add up to `position`; it is required because a joint has clearance: \
                   such motion is chaotic, and beyond some tens of milliseconds no step is small enough";
    let horizon = match table.optional("horizon") {
        None if loose => Some(table.required("horizon", purpose)?),
        other => other,
    };
    let horizon = horizon.map_or(Ok(simulation.duration), |h| h.positive())?;
    Ok(Accuracy {
        position,
        energy,
        horizon,
    })
}

fn newton_tolerance(table: &Fields, method: Method) -> Result<f64, SceneError> {
    let purpose = "the largest error Newton's method may leave in a velocity [m/s]";
    let field = match method.scheme.is_explicit {
        true => table.optional("newton_tolerance"),
        false => Some(table.required("newton_tolerance", purpose)?),
    };
    field.map_or(Ok(0.0), |f| f.positive())
}

fn onset_tolerance(table: &Fields, clearance: Option<f64>) -> Result<f64, SceneError> {
    let purpose = "the largest penetration or gap at a located contact onset [m]; it is required because a joint has clearance";
    let field = match clearance {
        Some(_) => Some(table.required("onset_tolerance", purpose)?),
        None => table.optional("onset_tolerance"),
    };
    let Some(field) = field else {
        return Ok(0.0);
    };
    let tolerance = field.positive()?;
    if clearance.is_some_and(|c| tolerance >= c) {
        return Err(field.must("be less than every clearance"));
    }
    Ok(tolerance)
}

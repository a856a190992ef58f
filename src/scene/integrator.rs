//! `[integrator]`: scheme, step or accuracy, tolerances.

use super::{AUTO, Accuracy, Analysis, Integrator, Method, Pace, SimulationTable};
use crate::document::{Field, Fields, Key, SceneError, Span, Takes, quoted};
use crate::registry::Registry;
use crate::stepper::{CANDIDATES, Parameter, Scheme};
use indexmap::IndexMap;
use numbers::number;
use std::cmp::Ordering;

/// More steps than this are a slip of the pen: a week of computing at 20 microseconds a step.
const MOST_STEPS: f64 = 1e10;

/// Contacts begin and end to this part of the smallest clearance: the velocity of an impact from the speed of a free fall through the
/// clearance has half this relative error.
const OF_CLEARANCE: f64 = 1e-7;

/// The keys of `[integrator]` besides the parameters of schemes.
pub(super) static INTEGRATOR: [Key; 7] = [
    Key::name_in("method", "schemes", "the scheme, see below; auto chooses one for an accuracy")
        .or("required, except in a static analysis, which has none"),
    Key::positive(
        "step",
        "s",
        "the time step, at most `duration`; of a static analysis the step of t",
    )
    .or("required without `accuracy`"),
    Key::table(
        "accuracy",
        "the error that is allowed, instead of a step: `accuracy = { position = ... }`",
    )
    .or("required without `step`"),
    Key::positive(
        "newton_tolerance",
        "m/s",
        "the largest error that Newton's method leaves in a velocity (rad/s for angles, 1/s for slopes)",
    )
    .or("1e-13 of the size of the mechanism over `step`; with `accuracy` 1e-4 of its position over its horizon"),
    Key::positive(
        "onset_tolerance",
        "m",
        "the largest penetration or gap at a located onset or loss of contact; below the clearance of every joint",
    )
    .or("1e-7 of the smallest clearance"),
    Key::new(
        "locate_onsets",
        Takes::Boolean,
        "whether a step is cut where a contact closes or opens. With false the error of an impact depends on where in the step it falls; for comparisons only",
    )
    .or("true"),
    Key::word(
        "knots",
        &["stop", "ignore"],
        "whether a step of a method of order above 3 ends at every knot of a spline; at jumps and kinks every step ends",
    )
    .or("`\"stop\"`"),
];

/// The keys of `[integrator.accuracy]`.
pub(super) static ACCURACY: [Key; 3] = [
    Key::positive(
        "position",
        "m",
        "the allowed estimated error of the position of any point of a body, as the steps of a horizon add it up",
    ),
    Key::positive(
        "energy",
        "J",
        "the allowed error of the energy balance, the channel `energy.numerical`, within a horizon",
    )
    .or("none"),
    Key::positive(
        "horizon",
        "s",
        "the time over which the errors of single steps add up. With clearance the motion is chaotic: beyond some tens of milliseconds no step is small enough",
    )
    .or("required with clearance, else `duration`"),
];

/// Parameters by name, each with the schemes that have it.
type Parameters = IndexMap<&'static str, (&'static Parameter, Vec<&'static Scheme>)>;

/// Every parameter of a scheme once.
pub(super) fn parameters(schemes: &[&'static Scheme]) -> Parameters {
    let mut parameters = Parameters::new();
    for scheme in schemes {
        for parameter in scheme.parameters {
            let entry = parameters.entry(parameter.name);
            let (_, owners) = entry.or_insert_with(|| (parameter, Vec::new()));
            owners.push(scheme);
        }
    }
    parameters
}

/// `clearance` is the smallest one of the scene.
pub(super) fn read(
    root: &Fields,
    simulation: &SimulationTable,
    clearance: Option<f64>,
    registry: &Registry,
) -> Result<Integrator, SceneError> {
    let mut table = root.field("integrator")?.fields()?;
    let schemes = &registry.schemes;
    let parameters = parameters(schemes);
    let before: Vec<_> = parameters.keys().copied().collect();
    table.declare(&before, &INTEGRATOR)?;
    let names = quoted(schemes.iter().map(|s| s.name));
    let is_dynamic = simulation.analysis == Analysis::Dynamic;
    let named = match table.optional("method") {
        None if is_dynamic => Some(table.required(
            "method",
            &format!("the integration scheme: {names}, or {AUTO:?} with an accuracy"),
        )?),
        named => named,
    };
    let automatic = [(AUTO, None)];
    let choices = schemes.iter().map(|s| (s.name, Some(*s))).chain(automatic);
    let scheme = match &named {
        Some(named) => named.choice(&choices.collect::<Vec<_>>())?,
        None => None,
    };
    let method = method(&table, scheme.unwrap_or(CANDIDATES[0]), &parameters)?;
    let (pace, pace_span) = pace(
        &table,
        simulation,
        clearance.is_some(),
        scheme.is_none() && is_dynamic,
    )?;
    if let Some(named) = named.as_ref().filter(|_| scheme.is_none() && is_dynamic)
        && matches!(pace, Pace::Step(_))
    {
        let message = format!(
            "`{}` = {AUTO:?} chooses the scheme for an accuracy",
            named.path
        );
        let error = named.fault(message, "needs an `accuracy` instead of a `step`");
        let [key, value] = match clearance.is_some() {
            true => [", horizon = ...", ",horizon=0.01"],
            false => ["", ""],
        };
        let help = format!(
            "write `accuracy = {{ position = ...{key} }}` in place of `step`, or name a scheme; on the command line `--accuracy position=1e-8{value}`"
        );
        return Err(error.with_help(help));
    }
    Ok(Integrator {
        method,
        automatic: scheme.is_none() && named.is_some(),
        pace,
        newton_tolerance: table.optional_number("newton_tolerance")?,
        onset_tolerance: onset_tolerance(&table, clearance)?,
        locate_onsets: table.optional_boolean("locate_onsets")?.unwrap_or(true),
        ends_at_knots: table.optional_word("knots")?.is_none_or(|word| word == 0),
        method_span: named.map_or(table.whole.span(), |named| named.node.span),
        pace_span,
    })
}

/// The scheme with the parameters that the table gives.
fn method(
    table: &Fields,
    scheme: &'static Scheme,
    parameters: &Parameters,
) -> Result<Method, SceneError> {
    for (name, (_, owners)) in parameters {
        if let Some(field) = table.optional(name)
            && !owners.iter().any(|owner| owner.name == scheme.name)
        {
            let owners = quoted(owners.iter().map(|s| s.name));
            let message = format!("`{}` is a parameter of {owners} only", field.path);
            return Err(field.key_fault(message, "remove this"));
        }
    }
    let mut method = Method::new(scheme);
    for parameter in scheme.parameters {
        let field = match parameter.default {
            None => Some(table.required(parameter.name, parameter.purpose)?),
            Some(_) => table.optional(parameter.name),
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
    let ends = match parameter.closed {
        true => "",
        false => ", both excluded",
    };
    Err(field.must(&format!("lie between {least} and {most}{ends}")))
}

/// `step` or `accuracy`, and where it stands; where both stand the one that comes from a later source, which is an override.
/// `loose` where a joint has clearance, `automatic` where the scheme is left open.
fn pace(
    table: &Fields,
    simulation: &SimulationTable,
    loose: bool,
    automatic: bool,
) -> Result<(Pace, Span), SceneError> {
    let source = |name| Some(table.optional(name)?.node.key.source());
    let order = source("step").cmp(&source("accuracy"));
    match (order, table.optional("accuracy")) {
        (Ordering::Equal, Some(accuracy)) => {
            let message = "`integrator` has both `step` and `accuracy`: give only one of them";
            Err(accuracy.key_fault(message, "remove this or `step`"))
        }
        (Ordering::Less, Some(field)) => {
            let accuracy = accuracy(&field, simulation, loose)?;
            Ok((Pace::Accuracy(accuracy), field.span()))
        }
        _ => {
            let (name, what) = match automatic && source("step").is_none() {
                true => (
                    "accuracy",
                    "the allowed error, for which \"auto\" chooses the scheme",
                ),
                false => (
                    "step",
                    "the time step; `accuracy`, an allowed error, can take its place",
                ),
            };
            let field = table.required(name, what)?;
            Ok((Pace::Step(step(&field, simulation)?), field.span()))
        }
    }
}

fn step(field: &Field, simulation: &SimulationTable) -> Result<f64, SceneError> {
    let step = simulation.check_time(field)?;
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

fn accuracy(
    field: &Field,
    simulation: &SimulationTable,
    loose: bool,
) -> Result<Accuracy, SceneError> {
    if simulation.analysis == Analysis::Static {
        let message = "a static analysis takes a `step`, not an `accuracy`";
        return Err(field.key_fault(message, "write `step`"));
    }
    let mut table = field.fields()?;
    table.declare(&[], &ACCURACY)?;
    Ok(Accuracy {
        position: table.number("position")?,
        energy: table.optional_number("energy")?,
        horizon: match loose {
            true => table.number("horizon")?,
            false => table
                .optional_number("horizon")?
                .unwrap_or(simulation.duration),
        },
    })
}

fn onset_tolerance(table: &Fields, clearance: Option<f64>) -> Result<f64, SceneError> {
    let Some(clearance) = clearance else {
        return Ok(table.optional_number("onset_tolerance")?.unwrap_or(0.0));
    };
    let given = table.optional_number("onset_tolerance")?;
    let tolerance = given.unwrap_or(OF_CLEARANCE * clearance);
    if tolerance >= clearance {
        return Err(table
            .field("onset_tolerance")?
            .must("be less than every clearance"));
    }
    Ok(tolerance)
}

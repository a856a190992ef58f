//! `[integrator]`: scheme, step or accuracy, tolerances.

use super::error::SceneError;
use super::field::Field;
use super::fields::Fields;
use super::{Accuracy, Analysis, Integrator, Method, Pace, Simulation};
use numbers::number;

/// More steps than this are a slip of the pen: a week of computing at 20 microseconds a step.
const MOST_STEPS: f64 = 1e10;

/// `clearance` is the smallest one of the scene.
pub(super) fn read(
    root: &Fields,
    simulation: &Simulation,
    clearance: Option<f64>,
) -> Result<Integrator, SceneError> {
    let mut table = root
        .required("integrator", "the table of method, step and tolerances")?
        .fields()?;
    table.only(&[
        "method",
        "gamma",
        "spectral_radius",
        "step",
        "accuracy",
        "newton_tolerance",
        "onset_tolerance",
        "locate_onsets",
    ])?;
    let names = Method::NAMES.map(|name| format!("{name:?}")).join(", ");
    let named = table.required("method", &format!("the integration scheme: {names}"))?;
    let method = method(
        &table,
        named.choice(&Method::NAMES.map(|name| (name, name)))?,
    )?;
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

fn method(table: &Fields, name: &str) -> Result<Method, SceneError> {
    for (key, owners) in [
        ("gamma", &["bathe"] as &[&str]),
        ("spectral_radius", &["bathe", "generalized_alpha", "hht"]),
    ] {
        if let Some(field) = table.optional(key)
            && !owners.contains(&name)
        {
            let owners: Vec<String> = owners.iter().map(|o| format!("{o:?}")).collect();
            let message = format!(
                "`{}` is a parameter of {} only",
                field.path,
                owners.join(", ")
            );
            return Err(field.key_fault(message, "remove this"));
        }
    }
    Ok(match name {
        "bathe" => bathe(table)?,
        "trapezoidal" => Method::Trapezoidal,
        "backward_euler" => Method::BackwardEuler,
        "generalized_alpha" => Method::GeneralizedAlpha {
            spectral_radius: required_radius(table, 0.0)?,
        },
        "hht" => Method::Hht {
            spectral_radius: required_radius(table, 0.5)?,
        },
        "velocity_verlet" => Method::VelocityVerlet,
        _ => Method::DormandPrince,
    })
}

fn bathe(table: &Fields) -> Result<Method, SceneError> {
    let radius = table.optional("spectral_radius");
    let radius = radius
        .map(|field| spectral_radius(&field, 0.0))
        .transpose()?;
    let gamma = match (table.optional("gamma"), radius) {
        (Some(field), _) => {
            let gamma = field.number()?;
            if !(gamma > 0.0 && gamma < 1.0) {
                return Err(field.must("lie between 0 and 1, both excluded"));
            }
            gamma
        }
        (None, Some(radius)) => optimal_gamma(radius),
        (None, None) => 0.5,
    };
    Ok(Method::Bathe {
        gamma,
        spectral_radius: radius.unwrap_or(0.0),
    })
}

/// The splitting at which both sub-steps have the same stage matrix (Noh & Bathe 2019, Comput. Struct. 212:299):
/// gamma = (2 - sqrt(2 + 2 rho))/(1 - rho), 1/2 at rho = 1.
fn optimal_gamma(radius: f64) -> f64 {
    // the same without a difference of nearly equal numbers
    2.0 / (2.0 + (2.0 + 2.0 * radius).sqrt())
}

fn required_radius(table: &Fields, least: f64) -> Result<f64, SceneError> {
    let purpose = format!(
        "the spectral radius at infinite frequency, from {least}, which damps most, to 1, which damps nothing"
    );
    spectral_radius(&table.required("spectral_radius", &purpose)?, least)
}

fn spectral_radius(field: &Field, least: f64) -> Result<f64, SceneError> {
    let radius = field.number()?;
    if !(least..=1.0).contains(&radius) {
        return Err(field.must(&format!("lie between {least} and 1")));
    }
    Ok(radius)
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
    let field = match method.is_explicit() {
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

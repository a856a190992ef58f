//! The first impacts of a run, for its summary.

use super::top::top;
use crate::model::Model;
use crate::system::State;
use serde::Serialize;

/// Impacts that the summary lists.
const LISTED: usize = 10;

/// One impact, from its onset to its first loss of contact.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Impact {
    /// Onset \[s\].
    pub t: f64,
    /// The joint.
    pub joint: String,
    /// delta_dot at onset \[m/s\].
    pub impact_velocity: f64,
    /// Direction of the eccentricity vector at onset, from the x axis \[rad\].
    pub angle: f64,
    /// Largest penetration \[m\]; so far, for a contact that is still closed.
    pub deepest_penetration: f64,
    /// When the contact was lost \[s\].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub end: Option<f64>,
}

/// Watches the first impacts.
#[derive(Debug, Default)]
pub(super) struct Impacts {
    pub listed: Vec<Impact>,
    /// Joint, and penetration and its rate at the last accepted step, of each listed impact.
    open: Vec<Option<(usize, f64, f64)>>,
}

impl Impacts {
    /// Memory for the list, so that the step loop does not allocate.
    pub fn new() -> Impacts {
        Impacts {
            listed: Vec::with_capacity(LISTED),
            open: Vec::with_capacity(LISTED),
        }
    }

    /// A contact has closed.
    pub fn begin(&mut self, model: &Model, joint: usize, impact_velocity: f64, at: &State) {
        if self.listed.len() == LISTED {
            return;
        }
        let ([x, y], delta, _) = model.clearance(joint, at).unwrap_or_default();
        self.listed.push(Impact {
            t: at.t,
            joint: model.joints()[joint].name.clone(),
            impact_velocity,
            angle: y.atan2(x),
            deepest_penetration: delta,
            end: None,
        });
        self.open.push(Some((joint, delta, impact_velocity)));
    }

    /// A step of length h has been accepted. Between two steps the penetration is the cubic through both ends, whose top
    /// has an error of h^4.
    pub fn step(&mut self, model: &Model, h: f64, at: &State) {
        for (impact, open) in self.listed.iter_mut().zip(&mut self.open) {
            let Some((joint, before, rate_before)) = *open else {
                continue;
            };
            let Some((delta, rate, closed)) = model.penetration(joint, at) else {
                continue;
            };
            let top = top(h, [before, delta], [rate_before, rate]).map_or(delta, |(_, top)| top);
            impact.deepest_penetration = impact.deepest_penetration.max(delta).max(top);
            *open = closed.then_some((joint, delta, rate));
            if !closed {
                impact.end = Some(at.t);
            }
        }
    }
}

//! Measures the integrator during a run: its estimated error, and the energy it loses or gains.
//!
//! Every step has the local errors e_q and e_v (see the stepper's estimate). With l_i the largest distance by which a unit
//! change of coordinate i moves a point of its body,
//!
//! ```text
//! E = max_i l_i (sum |e_q,i| + tau_i max_t |sum e_v,i|),   tau_i = (max q_i - min q_i)/max |v_i|
//! ```
//!
//! is the error of position \[m\] of the whole run if nothing amplifies it. A coordinate that prescribed motions determine through
//! the constraints has none. Impacts do amplify it, and a mechanism with
//! clearance is chaotic. An error of velocity grows for tau_i \[s\], the time in which the coordinate crosses its range.
//!
//! Accelerations and forces may be wrong where positions are right: an undamped scheme keeps a vibration that the steps do not
//! resolve in the accelerations. Over the run, with da the change of a over a step,
//!
//! ```text
//! rho_i = sqrt(int da_i^2 dt / int a_i^2 dt)
//! ```
//!
//! is 2 pi/n for a vibration of n steps a period. The largest rho_i is reported, over the coordinates with at least a tenth of
//! the largest acceleration whose changes move points by more than rounding.

use super::scale;
use crate::checkpoint::carried;
use crate::ledger::{OF_WORK, Side};
use crate::model::{Energies, Model};
use crate::scene::{Pace, Scene};
use crate::stepper::LocalError;
use crate::system::State;
use serde::Serialize;

/// Coordinates with less than this part of the largest acceleration do not count for rho,
const LEAST_SHARE: f64 = 0.1;
/// nor do those whose changes h^2 da are below this part of the largest range of motion, which are rounding.
const SHAKEN: f64 = 1e-9;
/// A mechanism rests whose points stay within this part of its size: below the tolerance of any part.
const AT_REST: f64 = 1e-9;
/// A run with equal steps is stopped when the integrator has gained this many times the larger of the energy supplied and [`plain_motion`].
const UNSTABLE: f64 = 10.0;

/// What was measured of the integrator.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Integration {
    /// Estimated error of position \[m\], if nothing amplifies it.
    pub estimated_error: f64,
    /// The coordinate that has it.
    pub estimated_error_of: String,
    /// Largest rho of a coordinate: rms change of its acceleration from step to step over the rms of the acceleration; 2 pi/n
    /// for n steps a period.
    pub acceleration_change: f64,
    /// The coordinate that has it.
    pub acceleration_change_of: String,
    /// Largest range of motion of a coordinate over the recorded rows, as a distance \[m\].
    pub travel: f64,
    /// Least and greatest energy lost by the integrator over the recorded rows \[J\]; a negative loss is a gain.
    pub lost: [f64; 2],
    /// Size of the mechanism \[m\].
    pub size: f64,
    /// Energy in play \[J\]: the largest sum of kinetic and elastic energy over the recorded rows, plus the energy dissipated.
    pub turnover: f64,
}

/// Measures during a run.
#[derive(Debug)]
pub(super) struct Meter {
    lengths: Vec<f64>,
    sums: Vec<IntegrationSums>,
    extents: Vec<Extent>,
    lost: [f64; 2],
    turnover: f64,
    dissipated: f64,
    first: Option<FirstRow>,
    /// Largest magnitude of the work of drives and loads so far, over all steps: rows may miss it.
    work: f64,
    /// [`UNSTABLE`]; infinite with an accuracy, where a gain is an error that was allowed.
    unstable: f64,
    /// Largest energy supplied so far: that at the start plus the work of drives, loads and weight.
    supplied: f64,
    /// See [`plain_motion`].
    plain: f64,
    size: f64,
    elapsed: f64,
}

carried!(Meter { sums, extents, lost, turnover, dissipated, first, work, supplied, elapsed } but { lengths, unstable, plain, size });

/// Energies at the first row.
#[derive(Debug, Clone, Copy, Default)]
struct FirstRow {
    balance: f64,
    gravity: f64,
    /// Kinetic and elastic energy \[J\].
    turnover: f64,
}

/// Energy that the integrator has put into the motion, far beyond what the scene supplies.
#[derive(Debug, Clone, Copy)]
pub(super) struct Gain {
    /// Energy gained \[J\].
    pub gained: f64,
    /// Energy supplied: that at the start plus the work of drives, loads and weight since \[J\].
    pub supplied: f64,
}

carried!(FirstRow { balance, gravity, turnover } but {});

/// Errors of one unknown so far.
#[derive(Debug, Clone, Copy, Default)]
struct IntegrationSums {
    /// Sum of |e_q|.
    position: f64,
    /// Sum of e_v ...
    velocity: f64,
    /// ... and its largest magnitude.
    peak: f64,
    /// Integral of the square of the acceleration ...
    acceleration: f64,
    /// ... of that of its change over a step ...
    change: f64,
    /// ... and the largest square of a displacement h^2 da.
    shaking: f64,
}

carried!(IntegrationSums { position, velocity, peak, acceleration, change, shaking } but {});

/// Range of an unknown over the recorded rows.
#[derive(Debug, Clone, Copy, Default)]
struct Extent {
    least: f64,
    greatest: f64,
    /// Largest magnitude of its rate.
    fastest: f64,
}

carried!(Extent { least, greatest, fastest } but {});

impl Integration {
    /// True of a mechanism whose points stay within a billionth of its size: what changes there is rounding, of which nothing is said.
    pub fn rests(&self) -> bool {
        self.travel <= AT_REST * self.size
    }
}

impl Extent {
    const EMPTY: Extent = Extent {
        least: f64::INFINITY,
        greatest: f64::NEG_INFINITY,
        fastest: 0.0,
    };

    fn see(&mut self, q: f64, v: f64) {
        self.least = self.least.min(q);
        self.greatest = self.greatest.max(q);
        self.fastest = self.fastest.max(v.abs());
    }

    fn width(&self) -> f64 {
        (self.greatest - self.least).max(0.0)
    }

    /// Time in which the range is crossed, within a run that has lasted for `elapsed` \[s\].
    fn crossing(&self, elapsed: f64) -> f64 {
        match self.fastest * elapsed > self.width() {
            true => self.width() / self.fastest,
            false => elapsed,
        }
    }
}

/// Kinetic energy \[J\] of all bodies at the speed that crosses the mechanism once in the duration of the run.
///
/// A gain of energy is measured against it at a start from rest, where the energy supplied is zero and the errors of the first
/// steps are as large as the motion.
fn plain_motion(scene: &Scene, size: f64) -> f64 {
    let masses = scene.bodies.iter().filter_map(|body| body.kind.mass());
    let mass: f64 = masses.sum();
    0.5 * mass * (size / scene.simulation.duration).powi(2)
}

/// The largest of some values, with its index.
fn largest(values: impl Iterator<Item = f64>) -> Option<(usize, f64)> {
    values.enumerate().max_by(|a, b| a.1.total_cmp(&b.1))
}

/// The name of the unknown that has the largest value; empty without unknowns.
fn name(model: &Model, largest: Option<(usize, f64)>) -> &str {
    largest.map_or("", |(i, _)| &model.unknown_names()[i])
}

impl Meter {
    /// For a run from a start.
    pub fn new(scene: &Scene, model: &Model, start: &State) -> Meter {
        let unknowns = model.shape().unknowns;
        let size = scale::size(scene, model, start);
        Meter {
            lengths: model.lengths(),
            sums: vec![IntegrationSums::default(); unknowns],
            extents: vec![Extent::EMPTY; unknowns],
            lost: [0.0; 2],
            turnover: 0.0,
            dissipated: 0.0,
            first: None,
            work: 0.0,
            unstable: match scene.integrator.pace {
                Pace::Step(_) => UNSTABLE,
                Pace::Accuracy(_) => f64::INFINITY,
            },
            supplied: 0.0,
            plain: plain_motion(scene, size),
            size,
            elapsed: 0.0,
        }
    }

    /// Records a step that is about to be accepted, with its local error.
    pub fn step(&mut self, from: &State, to: &State, error: &LocalError) {
        let h = to.t - from.t;
        self.elapsed = to.t;
        self.work = self.work.max(to.integrals[OF_WORK].abs());
        let accelerations = from.a.iter().zip(&to.a);
        let errors = error.q.iter().zip(&error.v);
        for ((sums, (q, v)), (a, a_1)) in self.sums.iter_mut().zip(errors).zip(accelerations) {
            let change = (a_1 - a) * (a_1 - a);
            sums.acceleration += h * a_1 * a_1;
            sums.change += h * change;
            sums.shaking = sums.shaking.max(change * (h * h) * (h * h));
            sums.position += q.abs();
            sums.velocity += v;
            sums.peak = sums.peak.max(sums.velocity.abs());
        }
    }

    /// A row is recorded, of a state with these energies.
    ///
    /// # Errors
    /// When the integrator has put far more energy into the motion than the scene supplies.
    pub fn row(&mut self, model: &Model, energies: &Energies, at: &State) -> Result<(), Gain> {
        for (extent, (q, v)) in self.extents.iter_mut().zip(at.q.iter().zip(&at.v)) {
            extent.see(*q, *v);
        }
        let (balance, size) = energies.balance(model, at);
        let turnover = energies.total() - energies.gravity;
        let first = *self.first.get_or_insert(FirstRow {
            balance,
            gravity: energies.gravity,
            turnover,
        });
        let lost = first.balance - balance;
        self.lost = [self.lost[0].min(lost), self.lost[1].max(lost)];
        self.turnover = self.turnover.max(turnover);
        self.dissipated = model.booked(at, Side::Lost);
        let weight = (energies.gravity - first.gravity).abs();
        self.supplied = self.supplied.max(first.turnover + self.work + weight);
        let supplied = self.supplied;
        let bound = self.unstable * supplied.max(self.plain) + f64::EPSILON.sqrt() * size;
        match -lost > bound || !lost.is_finite() {
            true => Err(Gain {
                gained: -lost,
                supplied,
            }),
            false => Ok(()),
        }
    }

    /// The unknown with the largest velocity.
    pub fn fastest<'a>(&self, model: &'a Model, at: &State) -> &'a str {
        let speeds = at.v.iter().zip(&self.lengths).map(|(v, l)| l * v.abs());
        name(model, largest(speeds))
    }

    /// The unknown with the largest of some local errors.
    pub fn worst<'a>(&self, model: &'a Model, error: &LocalError) -> &'a str {
        let errors = error.q.iter().zip(&self.lengths).map(|(e, l)| l * e.abs());
        name(model, largest(errors))
    }

    /// What has been measured so far.
    pub fn report(&self, model: &Model) -> Integration {
        let parts = self.sums.iter().zip(&self.extents).zip(&self.lengths);
        let errors = parts.clone().zip(&model.determined);
        let errors = errors.map(
            |(((sums, extent), length), is_determined)| match is_determined {
                // every step ends on the constraints
                true => 0.0,
                false => length * (sums.position + extent.crossing(self.elapsed) * sums.peak),
            },
        );
        let worst = largest(errors);
        let travels = parts
            .clone()
            .map(|((_, extent), length)| length * extent.width());
        let travel = travels.fold(0.0, f64::max);
        let sizes = parts
            .clone()
            .map(|((sums, _), length)| length * sums.acceleration.sqrt());
        let size = sizes.fold(0.0, f64::max);
        let changes = parts.map(|((sums, _), length)| {
            let carries = length * sums.acceleration.sqrt() >= LEAST_SHARE * size;
            let moves = length * sums.shaking.sqrt() > SHAKEN * travel;
            match carries && moves {
                true => (sums.change / sums.acceleration).sqrt(),
                false => 0.0,
            }
        });
        let roughest = largest(changes);
        Integration {
            estimated_error: worst.map_or(0.0, |w| w.1),
            estimated_error_of: name(model, worst).to_owned(),
            acceleration_change: roughest.map_or(0.0, |r| r.1),
            acceleration_change_of: name(model, roughest).to_owned(),
            travel,
            size: self.size,
            lost: self.lost,
            // a mechanism at rest moves by rounding
            turnover: (self.turnover + self.dissipated.max(0.0)).max(f64::EPSILON * self.plain),
        }
    }
}

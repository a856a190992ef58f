//! Records every contact from its onset to its end, keeps the first ones for the summary, and counts those of every joint.

use super::cubic::top;
use super::observer::{ContactEnd, ContactEvent, Observer, Onset};
use crate::checkpoint::carried;
use crate::model::Model;
use crate::scene::Scene;
use crate::system::{Changed, State};
use serde::Serialize;
use std::collections::BTreeMap;
use std::io;

/// Contacts that the summary lists.
const LISTED: usize = 10;

/// A contact that was reported, kept after the run.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Impact {
    /// Onset \[s\].
    pub t: f64,
    /// The joint.
    pub joint: String,
    /// delta_dot at onset \[m/s\].
    pub impact_velocity: f64,
    /// Penetration at the located onset \[m\], zero within the onset tolerance.
    pub delta: f64,
    /// Direction of the eccentricity vector at onset, from the x axis \[rad\].
    pub angle: f64,
    /// Largest penetration \[m\]; so far, for a contact that is still closed.
    pub deepest_penetration: f64,
    /// Largest force at the end of a step \[N\]; so far, for a contact that is still closed.
    pub largest_force: f64,
    /// When the contact was lost \[s\].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub end: Option<f64>,
    /// -delta_dot when the contact was lost \[m/s\].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub exit_velocity: Option<f64>,
}

impl From<&ContactEvent<'_>> for Impact {
    fn from(contact: &ContactEvent) -> Impact {
        let onset = &contact.onset;
        Impact {
            t: onset.t,
            joint: onset.joint.to_owned(),
            impact_velocity: onset.impact_velocity,
            delta: onset.delta,
            angle: onset.angle,
            deepest_penetration: contact.deepest_penetration,
            largest_force: contact.largest_force,
            end: contact.end.map(|end| end.t),
            exit_velocity: contact.end.map(|end| end.exit_velocity),
        }
    }
}

impl From<&Onset<'_>> for Impact {
    fn from(onset: &Onset) -> Impact {
        Impact::from(&ContactEvent {
            onset: *onset,
            deepest_penetration: onset.delta,
            largest_force: 0.0,
            end: None,
        })
    }
}

impl Impact {
    /// As it was reported.
    pub(super) fn event(&self) -> ContactEvent<'_> {
        let end = self.end.zip(self.exit_velocity);
        ContactEvent {
            onset: Onset {
                t: self.t,
                joint: &self.joint,
                impact_velocity: self.impact_velocity,
                delta: self.delta,
                angle: self.angle,
            },
            deepest_penetration: self.deepest_penetration,
            largest_force: self.largest_force,
            end: end.map(|(t, exit_velocity)| ContactEnd { t, exit_velocity }),
        }
    }
}

/// Follows every contact.
#[derive(Debug)]
pub(super) struct Impacts {
    /// What is known of each contact that is closed.
    closed: Vec<Option<Course>>,
    /// The first contacts of the run.
    listed: Vec<Course>,
    /// Radius of the bearing of each contact, and the largest penetration so far \[m\].
    depths: Vec<[f64; 2]>,
    /// What was counted of each contact that has opened again.
    counts: Vec<ContactCount>,
    /// From when on contacts count \[s\].
    from: f64,
}

carried!(Impacts { closed, depths, counts } and up to LISTED of { listed } but { from });

/// The contacts of a joint.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct ContactCount {
    /// Contacts that began after the start.
    pub impacts: u64,
    /// Time in contact \[s\].
    pub closed: f64,
    /// The largest force \[N\], and its time \[s\].
    pub largest: [f64; 2],
    /// The largest force after the first contact \[N\].
    pub later: f64,
    /// True once the first contact is over, if the joint began without one.
    pub has_settled: bool,
    /// True from the first onset on.
    has_begun: bool,
}

carried!(ContactCount { impacts, closed, largest, later, has_settled, has_begun } but {});

impl ContactCount {
    /// Adds the time of a contact up to its end or to now.
    fn add(&mut self, course: &Course, to: f64, from: f64) {
        self.closed += (to - course.t.max(from)).max(0.0);
    }

    /// A force, which counts from a time on.
    fn see(&mut self, force: f64, t: f64, from: f64) {
        if t < from {
            return;
        }
        if force > self.largest[0] {
            self.largest = [force, t];
        }
        if self.has_settled {
            self.later = self.later.max(force);
        }
    }
}

/// Penetration over the radius of a bearing beyond which no contact law holds, if it also exceeds the clearance. The half width of the
/// contact by Hertz, for radii R and R - c, is R sqrt(delta/c) and reaches the radius at delta = c; a tenth of the radius is far beyond
/// small strains, however large the clearance.
const DEEP: f64 = 0.1;

/// A journal that has gone so deep into its bearing that no contact law holds.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Overrun {
    /// Largest penetration \[m\].
    pub penetration: f64,
    /// Radius of the bearing \[m\].
    pub bearing_radius: f64,
}

/// A contact from its onset on.
#[derive(Debug, Clone, Copy, Default)]
struct Course {
    joint: usize,
    t: f64,
    impact_velocity: f64,
    delta: f64,
    angle: f64,
    deepest: f64,
    largest_force: f64,
    end: Option<ContactEnd>,
    /// Penetration and its rate at the last accepted step.
    before: [f64; 2],
    /// Its index among the first contacts of the run.
    listed: Option<usize>,
}

carried!(Course { joint, t, impact_velocity, delta, angle, deepest, largest_force, end, before, listed } but {});

impl Course {
    fn onset<'a>(&self, model: &'a Model) -> Onset<'a> {
        Onset {
            t: self.t,
            joint: &model.joints()[self.joint].name,
            impact_velocity: self.impact_velocity,
            delta: self.delta,
            angle: self.angle,
        }
    }

    fn contact<'a>(&self, model: &'a Model) -> ContactEvent<'a> {
        ContactEvent {
            onset: self.onset(model),
            deepest_penetration: self.deepest,
            largest_force: self.largest_force,
            end: self.end,
        }
    }
}

impl Impacts {
    /// Allocates all memory, so that the step loop does not.
    pub fn new(scene: &Scene, model: &Model) -> Impacts {
        let contacts = 0..model.shape().contacts;
        let radius = |contact| {
            let joint = model.contact_joint(contact);
            let contact = joint.and_then(|joint| scene.joints[joint].contact());
            contact
                .and_then(|contact| contact.bearing_radius)
                .unwrap_or(f64::INFINITY)
        };
        Impacts {
            closed: vec![None; contacts.len()],
            listed: Vec::with_capacity(LISTED),
            counts: vec![ContactCount::default(); contacts.len()],
            depths: contacts.map(|contact| [radius(contact), 0.0]).collect(),
            from: scene.output.extremes_from,
        }
    }

    /// Begins those of these changes that are onsets, and counts them.
    pub fn begin_all(&mut self, model: &Model, changed: &[Changed], at: &State) -> u64 {
        let mut onsets = 0;
        for change in changed {
            if let Changed::Onset {
                contact,
                velocity,
                delta,
            } = *change
            {
                onsets += 1;
                self.begin(model, contact, [delta, velocity], at);
            }
        }
        onsets
    }

    /// A contact has closed.
    fn begin(&mut self, model: &Model, contact: usize, [delta, rate]: [f64; 2], at: &State) {
        let Some(joint) = model.contact_joint(contact) else {
            return;
        };
        let (gap, ..) = model.gap(joint, at).unwrap_or_default();
        let mut course = Course {
            joint,
            t: at.t,
            impact_velocity: rate,
            delta,
            angle: gap.e[1].atan2(gap.e[0]),
            deepest: delta,
            largest_force: model.contact_force(contact, at).norm(),
            end: None,
            before: [delta, rate],
            listed: None,
        };
        if self.listed.len() < LISTED {
            course.listed = Some(self.listed.len());
            self.listed.push(course);
        }
        self.closed[contact] = Some(course);
        let count = &mut self.counts[contact];
        // a contact that is closed at the start is no impact, and no impact of the start precedes others
        let starts_closed = at.t == 0.0;
        count.impacts += u64::from(!starts_closed && at.t >= self.from);
        count.has_settled |= starts_closed;
        count.has_begun = true;
        count.see(course.largest_force, at.t, self.from);
    }

    /// What was counted of a contact up to time t.
    pub fn count(&self, contact: usize, t: f64) -> ContactCount {
        let mut count = self.counts[contact];
        if let Some(course) = &self.closed[contact] {
            count.add(course, t, self.from);
        }
        count
    }

    /// True once the first impact of a joint is over, of one that starts without contact.
    pub fn has_settled(&self, contact: usize) -> bool {
        self.counts[contact].has_settled
    }

    /// True where the first impacts are over, of all joints that have had any.
    pub fn have_settled(&self) -> bool {
        let mut begun = self
            .counts
            .iter()
            .filter(|count| count.has_begun)
            .peekable();
        begun.peek().is_some() && begun.all(|count| count.has_settled)
    }

    /// The onset of a contact that is closed.
    pub fn onset<'a>(&self, model: &'a Model, contact: usize) -> Option<Onset<'a>> {
        self.closed[contact].map(|course| course.onset(model))
    }

    /// Records an accepted step of length h, with the crossings at its end, and reports the contacts that it opened. Between two steps
    /// the penetration is the cubic through values and rates at both ends, whose maximum has an error of h^4.
    ///
    /// # Errors
    /// When a contact cannot be reported.
    pub fn step(
        &mut self,
        model: &Model,
        h: f64,
        at: &State,
        crossings: &[[f64; 2]],
        observer: &mut dyn Observer,
    ) -> io::Result<()> {
        let depths = self.depths.iter_mut();
        for (contact, (slot, [_, deepest])) in self.closed.iter_mut().zip(depths).enumerate() {
            let Some(course) = slot else { continue };
            let [delta, rate] = crossings[contact].map(|x| -x);
            let closed = at.memory[contact] > 0.0;
            let [before, rate_before] = course.before;
            let top = top(h, [before, delta], [rate_before, rate]).map_or(delta, |(_, top)| top);
            course.deepest = course.deepest.max(delta).max(top);
            *deepest = deepest.max(course.deepest);
            let force = model.contact_force(contact, at).norm();
            course.largest_force = course.largest_force.max(force);
            let count = &mut self.counts[contact];
            count.see(force, at.t, self.from);
            course.before = [delta, rate];
            course.end = (!closed).then_some(ContactEnd {
                t: at.t,
                exit_velocity: -rate,
            });
            if let Some(place) = course.listed {
                self.listed[place] = *course;
            }
            if !closed {
                observer.contact(&course.contact(model))?;
                count.add(course, at.t, self.from);
                count.has_settled = true;
                *slot = None;
            }
        }
        Ok(())
    }

    /// Ends the run: reports the contacts that are still closed, in the order of the joints.
    ///
    /// # Errors
    /// When a contact cannot be reported.
    pub fn finish(&self, model: &Model, observer: &mut dyn Observer) -> io::Result<()> {
        let mut closed = self.closed.iter().flatten();
        closed.try_for_each(|course| observer.contact(&course.contact(model)))
    }

    /// Joints that were overrun.
    pub fn overrun(&self, scene: &Scene, model: &Model) -> BTreeMap<String, Overrun> {
        let depths = self.depths.iter().enumerate();
        let named = depths.filter_map(|(contact, &[bearing_radius, penetration])| {
            let joint = model.contact_joint(contact)?;
            let clearance = scene.joints[joint].contact()?.clearance;
            if penetration <= clearance.max(DEEP * bearing_radius) {
                return None;
            }
            let overrun = Overrun {
                penetration,
                bearing_radius,
            };
            Some((model.joints()[joint].name.clone(), overrun))
        });
        named.collect()
    }

    /// The first contacts of the run.
    pub fn listed(&self, model: &Model) -> Vec<Impact> {
        let listed = self.listed.iter();
        listed
            .map(|course| Impact::from(&course.contact(model)))
            .collect()
    }
}

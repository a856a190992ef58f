//! What locks a mechanism at the limit of a drive, in words: bodies whose joints are in line, or a body across its guide.

use super::assembly::position;
use super::extent::extent;
use super::{Compiler, Role};
use crate::body::PointRef;
use crate::math::plane::{Rotation, Vec2};
use crate::model::Model;
use crate::scene::MotionKind;
use crate::system::State;
use std::collections::BTreeSet;

/// Points are in line and lines perpendicular up to this angle \[rad\]; those of a limit are to some 1e-8.
const ALIGNED: f64 = 1e-6;

/// What holds a body in a loop.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Place {
    /// A joint, by its index.
    Joint(usize),
    /// A point that a drive moves.
    Point(PointRef),
}

/// The bodies under stress at a limit.
pub(super) struct Locked<'a> {
    c: &'a Compiler<'a>,
    mechanism: &'a Model,
    pose: &'a State,
    loaded: BTreeSet<usize>,
    /// Joints closer than this are at one place \[m\].
    apart: f64,
}

impl<'a> Locked<'a> {
    /// Of a pose in which forces in these bodies are in equilibrium by themselves.
    pub fn at(
        c: &'a Compiler,
        mechanism: &'a Model,
        pose: &'a State,
        stressed: impl Iterator<Item = usize>,
    ) -> Locked<'a> {
        Locked {
            c,
            mechanism,
            pose,
            loaded: stressed.filter(|b| c.roles[*b] == Role::Free).collect(),
            apart: ALIGNED * extent(c.scene),
        }
    }

    /// The places that hold a body in the loop, each with its own point and the body beyond it, if a joint leads to one.
    fn places_of(&self, body: usize) -> Vec<(Place, PointRef, Option<usize>)> {
        let is_held = |point: PointRef| {
            let mut motions = self.c.scene.motions.iter();
            motions.any(|m| matches!(m.kind, MotionKind::Point { point: p, .. } if p == point))
        };
        let points = 0..self.c.bodies[body].points().len();
        let all = points.flat_map(|point| {
            let own = PointRef { body, point };
            let held = is_held(own).then_some((Place::Point(own), own, None));
            let joints = self
                .c
                .joints_at(own)
                .iter()
                .map(move |&(joint, partner)| (Place::Joint(joint), own, Some(partner.body)));
            joints.chain(held)
        });
        let is_of_loop =
            |other: usize| self.loaded.contains(&other) || self.c.roles[other] != Role::Free;
        let (mut places, others): (Vec<_>, Vec<_>) =
            all.partition(|(.., other)| other.is_none_or(is_of_loop));
        for (place, own, other) in others {
            // a body that only hands on a force, from one joint to another at the same place
            let is_new = places.iter().all(|(_, p, _)| !self.are_together(*p, own));
            if is_new && other.is_some_and(|other| self.hands_on(own, other)) {
                places.push((place, own, other));
            }
        }
        places
    }

    fn are_together(&self, a: PointRef, b: PointRef) -> bool {
        (self.place(a) - self.place(b)).norm() <= self.apart
    }

    /// True of a body with a joint to a second body of the loop where it is joined to that of `own`.
    fn hands_on(&self, own: PointRef, other: usize) -> bool {
        (0..self.c.bodies[other].points().len()).any(|point| {
            let point = PointRef { body: other, point };
            let mut partners = self.c.joints_at(point).iter();
            self.are_together(point, own)
                && partners.any(|(_, p)| p.body != own.body && self.loaded.contains(&p.body))
        })
    }

    fn place(&self, point: PointRef) -> Vec2 {
        position(self.mechanism, self.pose, point)
    }

    fn body(&self, body: usize) -> &str {
        &self.c.scene.bodies[body].name
    }

    fn joint(&self, joint: usize) -> &str {
        &self.c.scene.joints[joint].name
    }

    /// Places in a sentence.
    fn listed(&self, places: &[Place]) -> String {
        let only_joints: Option<Vec<&str>> = (places.iter())
            .map(|place| match place {
                Place::Joint(joint) => Some(self.joint(*joint)),
                Place::Point(_) => None,
            })
            .collect();
        if let Some(names) = only_joints {
            return format!("joints {}", listed(&names));
        }
        let names: Vec<String> = (places.iter())
            .map(|place| match place {
                Place::Joint(joint) => format!("joint {}", self.joint(*joint)),
                Place::Point(point) => format!("point {}", self.c.point_name(*point)),
            })
            .collect();
        listed(&names.iter().map(String::as_str).collect::<Vec<_>>())
    }

    /// Why the mechanism cannot go on.
    pub fn in_words(&self) -> String {
        let in_line = self.in_line();
        let found = in_line.or_else(|| self.perpendicular());
        let found = found.or_else(|| self.beyond());
        let found = found.or_else(|| self.meeting());
        found.unwrap_or_else(|| {
            let bodies: Vec<&str> = self.loaded.iter().map(|b| self.body(*b)).collect();
            format!(
                "forces in {} are in equilibrium by themselves",
                listed(&bodies)
            )
        })
    }

    /// Two bodies that share a joint, or have joints at one place, and whose three joints lie on one line.
    fn in_line(&self) -> Option<String> {
        let pairs = self.loaded.iter().flat_map(|first| {
            let others = self.loaded.range(first + 1..);
            others.map(move |second| (*first, *second))
        });
        for (first, second) in pairs {
            let shares = |(_, own, other): &(Place, PointRef, Option<usize>)| {
                let mut places = self.places_of(second).into_iter();
                *other == Some(second) || places.any(|(_, p, _)| self.are_together(p, *own))
            };
            for (middle, own, _) in self.places_of(first).into_iter().filter(shares) {
                let centre = self.place(own);
                let far = |body: usize| {
                    let places = self.places_of(body).into_iter();
                    places.filter_map(move |(place, point, _)| {
                        let arm = self.place(point) - centre;
                        (place != middle && arm.norm() > self.apart).then_some((place, arm))
                    })
                };
                for (from, a) in far(first) {
                    for (to, b) in far(second) {
                        if a.perp(&b).abs() <= ALIGNED * a.norm() * b.norm() {
                            return Some(format!(
                                "{} and {} are in line at {}",
                                self.body(first),
                                self.body(second),
                                self.listed(&[from, middle, to])
                            ));
                        }
                    }
                }
            }
        }
        None
    }

    /// Three bodies with two joints each, along which forces act that meet in one point or are parallel.
    fn meeting(&self) -> Option<String> {
        let lines = self.loaded.iter().filter_map(|&body| {
            let [(_, a, _), (_, b, _)] = self.places_of(body)[..] else {
                return None;
            };
            let (from, arm) = (self.place(a), self.place(b) - self.place(a));
            let along = arm.try_normalize(self.apart)?;
            Some((body, from, along))
        });
        let lines: Vec<_> = lines.collect();
        let &[(first, p, a), (second, q, b), (third, r, c)] = &lines[..] else {
            return None;
        };
        let names = listed(&[first, second, third].map(|body| self.body(body)));
        let sine = a.perp(&b);
        if sine.abs() <= ALIGNED {
            let is_parallel = a.perp(&c).abs() <= ALIGNED;
            return is_parallel.then(|| format!("{names} are parallel"));
        }
        let meets = p + (q - p).perp(&b) / sine * a;
        let off = (meets - r).perp(&c).abs();
        (off <= ALIGNED * (meets - r).norm())
            .then(|| format!("the lines of {names} meet in one point"))
    }

    /// A joint of the loop on the line through the two joints of a body, along which the force in this body acts.
    fn beyond(&self) -> Option<String> {
        for &body in &self.loaded {
            let [(first, a, _), (second, b, _)] = self.places_of(body)[..] else {
                continue;
            };
            let line = self.place(b) - self.place(a);
            for &other in &self.loaded {
                for (place, point, _) in self.places_of(other) {
                    let arm = self.place(point) - self.place(a);
                    let is_third = place != first
                        && place != second
                        && arm.norm() > self.apart
                        && (arm - line).norm() > self.apart;
                    if is_third && line.perp(&arm).abs() <= ALIGNED * line.norm() * arm.norm() {
                        let mut places = [place, first, second];
                        places.sort_unstable();
                        return Some(format!("{} are in line", self.listed(&places)));
                    }
                }
            }
        }
        None
    }

    /// A body whose two joints lie on a line perpendicular to that of its own prismatic joint or of one of its neighbour.
    fn perpendicular(&self) -> Option<String> {
        for (j, joint) in self.c.joints.iter().enumerate() {
            let Some(direction) = joint.line() else {
                continue;
            };
            let sides = &self.c.scene.joints[j];
            let guide = &self.mechanism.bodies()[sides.bearing.body].placed;
            let turned = guide
                .kind
                .frame_at(&guide.x, &self.pose.q, &self.pose.v)
                .map_or(0.0, |frame| frame.position[2]);
            let line = Rotation::new(turned + direction) * Vec2::x();
            for &body in &self.loaded {
                let own = self.places_of(body);
                let slides = sides.journal.body;
                if body != slides && own.iter().all(|(.., other)| *other != Some(slides)) {
                    continue;
                }
                for (_, from, _) in &own {
                    for (_, to, _) in &own {
                        let arm = self.place(*to) - self.place(*from);
                        if arm.norm() > self.apart && arm.dot(&line).abs() <= ALIGNED * arm.norm() {
                            return Some(format!(
                                "{} is perpendicular to the line of joint {}",
                                self.body(body),
                                self.joint(j)
                            ));
                        }
                    }
                }
            }
        }
        None
    }
}

/// Names in a sentence.
pub(super) fn listed(names: &[&str]) -> String {
    match names {
        [rest @ .., last] if !rest.is_empty() => format!("{} and {last}", rest.join(", ")),
        names => names.join(", "),
    }
}

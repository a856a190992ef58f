//! What the joints that inverse kinematics actuates determine of the ideal mechanism, and where they lose control of it.
//!
//! The pose of the driven body determines the ideal mechanism, which so has the three degrees of freedom x, y and theta. With the joints
//! held, the body can move along the null space of K in theta' = K (x, y, theta)'. Where K loses rank along the path, the mechanism is in a
//! singular pose of type 2 (Gosselin and Angeles 1990, IEEE Transactions on Robotics and Automation 6:281): its determinant has a zero
//! there, which a change of its sign shows.

use super::drive::{at_start, mark_driven};
use super::extent::extent;
use super::locked::{Locked, listed};
use super::{Compiler, Mode, Role, is_ideal, known_roles};
use crate::kinematics::{Inner, Kinematics, UnitMotions};
use crate::marker::Spin;
use crate::math::bisection::bisected;
use crate::math::independent_rows::IndependentRows;
use crate::math::{generic, larger};
use crate::model::PlacedConstraint;
use crate::scene::{Drive, Scene};
use crate::system::State;
use nalgebra::{Matrix3, RowVector3};
use numbers::number;
use std::fmt::{self, Display, Formatter};

/// Coordinates of the driven body.
const POSE: usize = 3;
/// A second pose, as a part of the path: the first one may be singular.
const ELSEWHERE: f64 = 0.382;
/// Rates, motions and determinants below this are zero, as parts of those of a mechanism of its size: far above rounding.
const ZERO: f64 = 1e-9;
/// A multiplier below this part of the largest is none.
const TAKES_PART: f64 = 1e-6;
/// Significant digits of instants.
const DIGITS: usize = 8;

/// The ideal mechanism of inverse kinematics and its actuated joints.
pub(crate) struct Actuation<'a> {
    scene: &'a Scene,
    drive: &'a Drive,
    kinematics: Kinematics,
    inner: Inner,
    /// First coordinate of the driven body.
    x: usize,
    /// The directions whose angle every actuated joint turns.
    spins: Vec<[Spin; 2]>,
    /// Length of the mechanism \[m\].
    size: f64,
}

/// What the joints that follow control along the path.
pub(crate) enum Control {
    /// The position of the driven body, all the way.
    Kept,
    /// Not its position.
    Missing(Uncontrolled),
    /// Its position but in some poses.
    Lost(LossOfControl),
}

/// Joints that do not determine the position of the body that should follow a path.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Uncontrolled {
    /// The name of the drive.
    drive: String,
    /// Its joints, in words.
    joints: String,
    /// The driven body.
    body: String,
    /// Degrees of freedom that are left.
    pub left: usize,
    /// The bodies that move with them.
    pub moving: Vec<String>,
}

/// Poses on the path in which the actuated joints do not hold the ideal mechanism.
#[derive(Debug, Clone, PartialEq)]
pub struct LossOfControl {
    /// When they are passed \[s\].
    pub times: Vec<f64>,
    /// What is special about the first one: which bodies are in line at which joints.
    pub cause: String,
    /// The name of the drive.
    drive: String,
    /// The driven body.
    body: String,
    /// False where links are flexible or joints have clearance.
    is_exact: bool,
}

/// A pose on the path.
struct PoseOnPath {
    state: State,
    /// Rates of the joints by those of the driven body, in units of its length.
    rates: Vec<RowVector3<f64>>,
    motions: UnitMotions,
}

/// What the joints determine in a pose.
struct Determined {
    rank: usize,
    /// Whether the position of the driven body is among it.
    is_placed: bool,
    /// The bodies that move with the joints held.
    moving: Vec<usize>,
}

impl<'a> Actuation<'a> {
    /// That of the inverse kinematics of a scene. None where the mechanism cannot follow its path, or where a joint holds the driven body
    /// on what is known: then x, y and theta are not free.
    pub fn of(scene: &'a Scene) -> Option<Actuation<'a>> {
        let drive = scene.drives.first()?;
        let roles = known_roles(scene);
        let (_, kinematics, _) = at_start(scene, drive, &roles).ok()?;
        let is_known = |body: usize| body == drive.body || roles[body] != Role::Free;
        let mut sides = scene.joints.iter().map(|j| j.points().map(|p| p.body));
        if sides.any(|sides| sides.contains(&drive.body) && sides.into_iter().all(is_known)) {
            return None;
        }
        let bodies = kinematics.mechanism.bodies();
        let spins = drive.joints.iter().map(|&joint| {
            let points = scene.joints[joint].points();
            points.map(|p| bodies[p.body].placed.spin(p.point))
        });
        Some(Actuation {
            scene,
            drive,
            x: bodies[drive.body].placed.x[0],
            spins: spins.collect(),
            size: extent(scene),
            inner: kinematics.work(),
            kinematics,
        })
    }

    /// How many degrees of freedom the joints determine, and how many they leave.
    pub fn freedoms(mut self) -> Option<[usize; 2]> {
        let rank = self.determined()?.rank;
        Some([rank, POSE - rank])
    }

    /// The bodies that move with the joints held.
    pub fn left_free(mut self) -> Option<Vec<usize>> {
        Some(self.determined()?.moving)
    }

    /// What the joints control along the path. None where some of them repeat others, whose ranks no determinant shows.
    pub fn control(mut self) -> Option<Control> {
        let Determined {
            rank,
            is_placed,
            moving,
        } = self.determined()?;
        let names = |all: Vec<usize>| -> Vec<String> {
            let names = all.into_iter().map(|b| &self.scene.bodies[b].name);
            names.cloned().collect()
        };
        if !is_placed {
            let joints = self.drive.joints.iter();
            let joints: Vec<&str> = joints.map(|j| &*self.scene.joints[*j].name).collect();
            return Some(Control::Missing(Uncontrolled {
                drive: self.drive.name.clone(),
                joints: match joints[..] {
                    [one] => format!("joint {one} does"),
                    _ => format!("joints {} do", listed(&joints)),
                },
                body: self.scene.bodies[self.drive.body].name.clone(),
                left: POSE - rank,
                moving: names(moving),
            }));
        }
        if rank < self.spins.len() {
            return None;
        }
        let losses = self.losses()?;
        let Some(first) = losses.first() else {
            return Some(Control::Kept);
        };
        Some(Control::Lost(LossOfControl {
            cause: self.cause(first)?,
            times: losses.iter().map(|pose| pose.state.t).collect(),
            drive: self.drive.name.clone(),
            body: self.scene.bodies[self.drive.body].name.clone(),
            is_exact: is_ideal(self.scene),
        }))
    }

    /// Motions of the driven body along x, along y and about its reference point by which points move alike.
    fn units(&self) -> [f64; POSE] {
        [self.size, self.size, 1.0]
    }

    /// What the joints determine in a pose that is not singular.
    fn determined(&mut self) -> Option<Determined> {
        let (horizon, _) = self.drive.path.sweep(self.kinematics.duration);
        let start = self.start()?;
        let there = self.pose(&start.state, ELSEWHERE * horizon)?;
        let [here, there] = [start, there].map(|pose| self.determined_in(&pose));
        Some(if there.rank > here.rank { there } else { here })
    }

    fn determined_in(&self, pose: &PoseOnPath) -> Determined {
        let rows = pose.rates.iter();
        let rows: Vec<Vec<(usize, f64)>> = rows
            .map(|row| row.iter().copied().enumerate().collect())
            .collect();
        let independent = IndependentRows::homogeneous(POSE, &rows);
        let still = |x: [f64; POSE]| {
            let free = independent.free_part(&x);
            free.iter().all(|x| x.abs() <= ZERO)
        };
        let free = independent.free_part(&[0, 1, 2].map(generic));
        let mechanism = &*self.kinematics.mechanism;
        let bodies = mechanism.bodies();
        let (mut lengths, angles) = (mechanism.lengths(), mechanism.known_angles());
        let known = lengths.len()..pose.state.q.len();
        lengths.extend(known.map(|i| if angles.contains(&i) { self.size } else { 1.0 }));
        let units = self.units();
        let moves = |i: usize| {
            let parts = free.iter().zip(units).zip(&pose.motions);
            let rate: f64 = parts
                .map(|((free, unit), motion)| free * unit * motion[i])
                .sum();
            rate.abs() * lengths[i] > ZERO * self.size
        };
        let moving = (0..bodies.len()).filter(|&b| bodies[b].coordinates().any(moves));
        Determined {
            rank: rows.len() - independent.dependent.len(),
            is_placed: still([1.0, 0.0, 0.0]) && still([0.0, 1.0, 0.0]),
            moving: moving.collect(),
        }
    }

    /// The pose at t = 0.
    fn start(&mut self) -> Option<PoseOnPath> {
        let inner = &mut self.inner;
        inner.state.t = 0.0;
        inner.state.q.copy_from_slice(&self.kinematics.start);
        self.kinematics.solve(inner, 20).ok()?;
        let state = inner.state.clone();
        Some(self.measured(state))
    }

    /// The pose at another time, from one nearby.
    fn pose(&mut self, from: &State, t: f64) -> Option<PoseOnPath> {
        let mut state = from.clone();
        state.t = t;
        let solved = self.kinematics.solve_at(from, &mut state, &mut self.inner);
        solved.ok()?;
        Some(self.measured(state))
    }

    /// The rates in the pose that was just solved for.
    fn measured(&mut self, state: State) -> PoseOnPath {
        let motions = self.kinematics.unit_motions(&mut self.inner, self.x);
        let units = self.units();
        let rates = self.spins.iter().map(|spins| {
            let row = std::array::from_fn(|i| {
                let [first, second] = spins.map(|spin| spin.rate(&state.q, &motions[i]));
                units[i] * (second - first)
            });
            let row = RowVector3::from(row);
            if row.norm() > ZERO {
                row
            } else {
                RowVector3::zeros()
            }
        });
        PoseOnPath {
            rates: rates.collect(),
            state,
            motions,
        }
    }

    /// The poses in which the determinant has zeros, in the order of time.
    fn losses(&mut self) -> Option<Vec<PoseOnPath>> {
        let (horizon, poses) = self.drive.path.sweep(self.kinematics.duration);
        let mut from = self.start()?;
        let mut found = Vec::new();
        if from.determinant().abs() <= ZERO {
            found.push(self.start()?);
        }
        for k in 1..=poses {
            let next = self.pose(&from.state, horizon * k as f64 / poses as f64)?;
            let (before, here) = (from.determinant(), next.determinant());
            let is_first = before.abs() > ZERO;
            if is_first && here.abs() <= ZERO {
                // a path may rest in such a pose
                found.push(self.pose(&from.state, next.state.t)?);
            } else if is_first && here * before < 0.0 {
                let at = bisected(from.state.t, next.state.t, |t| {
                    let pose = self.pose(&from.state, t);
                    pose.is_some_and(|pose| pose.determinant() * before > 0.0)
                });
                let pose = self.pose(&from.state, at)?;
                // where a rate has no bound, its row jumps to its opposite
                found.extend((pose.determinant().abs() <= ZERO).then_some(pose));
            }
            from = next;
        }
        Some(found)
    }

    /// Why the joints do not hold the mechanism in a pose.
    fn cause(&mut self, pose: &PoseOnPath) -> Option<String> {
        // the factors of this pose
        self.pose(&pose.state, pose.state.t)?;
        let u = pose.rows().svd(true, false).u?;
        let torques = self.spins.iter().zip(&pose.rates).enumerate();
        let torques = torques.map(|(j, (spins, rates))| {
            let length = rates.norm();
            (
                *spins,
                u[(j, POSE - 1)] / if length > 0.0 { length } else { 1.0 },
            )
        });
        let torques: Vec<_> = torques.collect();
        let mechanism = &*self.kinematics.mechanism;
        let multipliers = self
            .kinematics
            .multipliers_of_torques(&mut self.inner, &torques);
        let largest = multipliers.iter().copied().fold(0.0, larger);
        let takes_part = |c: &&PlacedConstraint| {
            let mut own = multipliers[c.row..c.row + c.rows].iter();
            own.any(|x| x.abs() > TAKES_PART * largest)
        };
        let stressed = mechanism.constraints.iter().filter(takes_part);
        let stressed = stressed.flat_map(|c| c.owners.iter().copied());
        let mut roles = known_roles(self.scene);
        mark_driven(self.scene, self.drive, &mut roles).ok()?;
        let c = Compiler::new(self.scene, Mode::Ideal, roles);
        let stressed = stressed.chain([self.drive.body]);
        Some(Locked::at(&c, mechanism, &pose.state, stressed).in_words())
    }
}

impl PoseOnPath {
    /// The rates of the joints, each row of length 1; a body whose position alone they determine turns freely.
    fn rows(&self) -> Matrix3<f64> {
        let row = |j: usize| match self.rates.get(j) {
            Some(row) => row.try_normalize(0.0).unwrap_or_default(),
            None => RowVector3::new(0.0, 0.0, 1.0),
        };
        Matrix3::from_rows(&[row(0), row(1), row(2)])
    }

    fn determinant(&self) -> f64 {
        self.rows().determinant()
    }
}

impl LossOfControl {
    /// What a motion up to time t \[s\] meets of it.
    pub fn up_to(&self, t: f64) -> Option<LossOfControl> {
        let mut met = self.clone();
        met.times.retain(|at| *at <= t);
        (!met.times.is_empty()).then_some(met)
    }
}

impl Display for Uncontrolled {
    fn fmt(&self, f: &mut Formatter) -> fmt::Result {
        let Uncontrolled {
            drive,
            joints,
            body,
            left,
            moving,
        } = self;
        let moving: Vec<&str> = moving.iter().map(String::as_str).collect();
        let (are, move_) = (
            if *left == 1 { "is" } else { "are" },
            if moving.len() == 1 { "moves" } else { "move" },
        );
        write!(
            f,
            "drive {drive}: its {joints} not determine the position of {body}, which will not follow its path: {left} of {POSE} degrees of \
             freedom {are} left, with which {} {move_}; name further joints in `joints`",
            listed(&moving)
        )
    }
}

impl Display for LossOfControl {
    fn fmt(&self, f: &mut Formatter) -> fmt::Result {
        let LossOfControl {
            drive, body, cause, ..
        } = self;
        let times: Vec<String> = self.times.iter().map(|t| number(*t, DIGITS)).collect();
        let mechanism = match self.is_exact {
            true => "",
            false => " of the ideal rigid mechanism",
        };
        write!(
            f,
            "drive {drive} loses control of {body} at t = {} s, in a singular pose{mechanism}: {cause}",
            times[0]
        )?;
        if times.len() > 1 {
            write!(f, ", and again at t = {} s", times[1..].join(" s, "))?;
        }
        let consequence = match self.is_exact {
            true => {
                "the torques and forces have no bound near it, and the largest recorded ones depend on the step"
            }
            false => "the torques and forces of the ideal mechanism have no bound near it",
        };
        write!(f, "; {consequence}")
    }
}

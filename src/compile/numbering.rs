//! Numbers the coordinates: which link ends share a node, which are known, and the indices of every body.

use super::extent::{FITS, extent};
use super::{Compiler, Mode, Role};
use crate::body::{Body, Content, HeldSlot, Known, PointRef, Slot};
use crate::interaction::Placed;
use crate::marker::Marker;
use crate::math::groups::Groups;
use crate::math::plane::Vec2;
use crate::model::{DrivenNode, Model};
use crate::scene::{MotionKind, SceneError};
use crate::system::InternalState;
use std::sync::Arc;

/// All coordinates of a mechanism.
pub(crate) struct Numbering {
    pub unknowns: usize,
    /// Coordinates including those of the inner mechanism, which come last.
    pub coordinates: usize,
    /// First coordinate of the inner mechanism.
    pub offset: usize,
    pub names: Vec<String>,
    /// Every body with its coordinates.
    pub bodies: Vec<Placed>,
    /// Internal states of every joint and of every force: the last unknowns.
    pub joint_states: Vec<Vec<usize>>,
    pub force_states: Vec<Vec<usize>>,
    /// What they are.
    pub states: Vec<InternalState>,
    /// Known coordinates that never change, with their values.
    pub fixed: Vec<(usize, f64)>,
    pub driven_nodes: Vec<DrivenNode>,
    /// For every joint, whether shared or known coordinates keep its points together.
    pub eliminated: Vec<bool>,
}

/// Classes of slots that share a node; the slots of all bodies are counted one after the other.
struct Nodes {
    /// Index of the first slot of every body.
    first: Vec<usize>,
    classes: Groups,
    /// The known point that a class is fixed to.
    anchor: Vec<Option<PointRef>>,
    /// First coordinate, once numbered.
    x: Vec<Option<usize>>,
}

impl Nodes {
    /// The class of a slot of a body.
    fn class(&mut self, body: usize, slot: usize) -> usize {
        self.classes.find(self.first[body] + slot)
    }
}

/// Shares and anchors the ends of free links; says of every joint whether this keeps its points together.
fn connect(c: &Compiler) -> Result<(Nodes, Vec<bool>), SceneError> {
    let mut count = 0;
    let mut first = Vec::with_capacity(c.slots.len());
    for slots in &c.slots {
        first.push(count);
        count += slots.len();
    }
    let mut nodes = Nodes {
        first,
        classes: Groups::new(count),
        anchor: vec![None; count],
        x: vec![None; count],
    };
    let joints = 0..c.scene.joints.len();
    let eliminated = joints.map(|j| connect_joint(c, &mut nodes, j));
    let eliminated = eliminated.collect::<Result<_, _>>()?;
    Ok((nodes, eliminated))
}

/// Of every joint, whether it makes two points one node or one of them known.
pub(super) fn shared_nodes(c: &Compiler) -> Result<Vec<bool>, SceneError> {
    connect(c).map(|(_, eliminated)| eliminated)
}

/// Makes the points of joint `j` one node or one of them known, where that is possible; true if it is.
fn connect_joint(c: &Compiler, nodes: &mut Nodes, j: usize) -> Result<bool, SceneError> {
    let joint = &c.scene.joints[j];
    if c.holds[j] {
        return Ok(true);
    }
    if c.joints[j].contact().is_some() || !c.joints[j].coincides() {
        return Ok(false);
    }
    let redundant = |what: &str| {
        let message = format!("joint {} is redundant: {what}", joint.name);
        Err(c.joint_error(j, message, "redundant joint"))
    };
    // what fixes its points already may do so at one place or at two
    let fixed = |what: &str, anchors: [Option<PointRef>; 2]| {
        let at = anchors.map(|point| c.on_ground(point?));
        match at {
            [Some(a), Some(b)] if (a - b).norm() > FITS * extent(c.scene) => {
                let apart = numbers::si((a - b).norm(), "m");
                let message = format!(
                    "joint {} contradicts others: {what}, {apart} apart",
                    joint.name
                );
                Err(c.joint_error(j, message, "contradictory joint"))
            }
            _ => redundant(what),
        }
    };
    let points = joint.points();
    let known = points.map(|p| c.is_known(p));
    if known == [true; 2] && !c.may_stay_closed(j) {
        return redundant("the motion of both of its bodies is prescribed");
    }
    // the class of the node of a free end
    let class = |p: PointRef| Some(nodes.class(p.body, c.node(p)?));
    match points.map(class) {
        _ if known == [true; 2] => {}
        [Some(a), Some(b)] if a == b => {
            return redundant("other joints already make its two points coincide");
        }
        [Some(a), Some(b)] if nodes.anchor[a].is_some() && nodes.anchor[b].is_some() => {
            let anchors = [nodes.anchor[a], nodes.anchor[b]];
            return fixed("both of its points are already fixed", anchors);
        }
        [Some(a), Some(b)] => {
            nodes.classes.unite(b, a);
            // only what stands for a class is fixed
            nodes.anchor[a] = nodes.anchor[a].or(nodes.anchor[b].take());
        }
        [Some(class), None] | [None, Some(class)] if known.contains(&true) => {
            if let Some(anchor) = nodes.anchor[class] {
                let anchors = [Some(anchor), Some(points[usize::from(known[1])])];
                return fixed("the link end it joins is already fixed", anchors);
            }
            nodes.anchor[class] = Some(points[usize::from(known[1])]);
        }
        _ => return Ok(false),
    }
    Ok(true)
}

/// Numbers all coordinates; `inner` is the ideal mechanism that drives this one. Known coordinates follow the unknown ones: the
/// ground, bodies on paths, driven nodes, and last the inner mechanism.
pub(crate) fn number(c: &Compiler, inner: Option<&Model>) -> Result<Numbering, SceneError> {
    let (mut nodes, eliminated) = connect(c)?;
    let mut numbering = number_unknowns(c, &mut nodes, eliminated);
    for b in 0..c.bodies.len() {
        numbering.know(c, b);
    }
    for b in 0..c.bodies.len() {
        if let Role::Turned(m) = c.roles[b] {
            numbering.turn_link(c, b, m);
        }
    }
    let classes = 0..nodes.anchor.len();
    let anchored: Vec<usize> = classes.filter(|&e| nodes.anchor[e].is_some()).collect();
    let riders = anchored.iter().filter(|&&e| c.needs_rider(&nodes, e));
    numbering.offset = numbering.coordinates + 2 * riders.count();
    for b in (0..c.bodies.len()).filter(|b| c.roles[*b] == Role::Driven) {
        if let Some(inner) = inner {
            numbering.bodies[b].x = shifted(&inner.bodies()[b].placed.x, numbering.offset);
        }
    }
    numbering.anchor(&mut nodes, &anchored);
    for b in 0..c.bodies.len() {
        numbering.carry(c, b);
    }
    numbering.coordinates = numbering.offset + inner.map_or(0, |m| m.shape().coordinates);

    // ends tied to known points got their coordinates only now
    for b in (0..c.bodies.len()).filter(|b| c.roles[*b] == Role::Free) {
        for (s, _) in c.slots[b]
            .iter()
            .enumerate()
            .filter(|(_, slot)| slot.point.is_some())
        {
            let x = &mut numbering.bodies[b].x[s];
            let class = nodes.class(b, s);
            *x = nodes.x[class].unwrap_or(*x);
        }
    }
    Ok(numbering)
}

/// The unknown coordinates, body by body in the order of the scene, then the internal states of forces.
fn number_unknowns(c: &Compiler, nodes: &mut Nodes, eliminated: Vec<bool>) -> Numbering {
    let mut names = Vec::new();
    let mut take = |labels: &[String]| {
        names.extend_from_slice(labels);
        names.len() - labels.len()
    };
    let blank = |(kind, slots): (&Arc<dyn Body>, &Vec<Slot>)| Placed {
        kind: kind.clone(),
        x: vec![usize::MAX; slots.len()],
    };
    let mut bodies: Vec<Placed> = c.bodies.iter().zip(&c.slots).map(blank).collect();
    for (b, body) in c.scene.bodies.iter().enumerate() {
        if c.roles[b] != Role::Free {
            continue;
        }
        for (s, slot) in c.slots[b].iter().enumerate() {
            let labels = slot.content.names().iter();
            let labels = labels.map(|name| format!("{}{}.{name}", body.name, slot.label));
            let labels: Vec<String> = labels.collect();
            bodies[b].x[s] = match slot.point {
                // numbered with what is known
                None if slot.held.is_some() => usize::MAX,
                None => take(&labels),
                Some(_) => {
                    let class = nodes.class(b, s);
                    if nodes.anchor[class].is_none() && nodes.x[class].is_none() {
                        nodes.x[class] = Some(take(&labels));
                    }
                    nodes.x[class].unwrap_or(usize::MAX)
                }
            };
        }
    }
    let mut states = Vec::new();
    let mut take_states = |owner: &str, own: Vec<InternalState>| -> Vec<usize> {
        let own = own.into_iter().map(|state| {
            states.push(state);
            take(&[format!("{owner}.{}", state.name)])
        });
        own.collect()
    };
    let joints = c.scene.joints.iter().zip(&c.joints);
    let joint_states = joints.map(|(joint, model)| take_states(&joint.name, model.states()));
    let joint_states = joint_states.collect();
    let real = c.scene.forces.iter().filter(|_| c.mode != Mode::Ideal);
    let force_states = real.map(|force| take_states(&force.name, force.kind.states()));
    let force_states = force_states.collect();
    let unknowns = names.len();
    Numbering {
        unknowns,
        coordinates: unknowns,
        offset: 0,
        names,
        bodies,
        joint_states,
        force_states,
        states,
        fixed: Vec::new(),
        driven_nodes: Vec::new(),
        eliminated,
    }
}

impl Compiler<'_> {
    /// Position of a point of the ground.
    pub fn on_ground(&self, point: PointRef) -> Option<Vec2> {
        let fixed = self.roles[point.body] == Role::Ground;
        fixed.then(|| self.bodies[point.body].points()[point.point].at)
    }

    /// True for a class fixed to a known point of a rigid body, whose node must be computed.
    fn needs_rider(&self, nodes: &Nodes, class: usize) -> bool {
        // all points of the ground are nodes
        let moving = nodes.anchor[class].filter(|point| self.roles[point.body] != Role::Ground);
        moving.is_some_and(|point| {
            let x = vec![0; self.slots[point.body].len()];
            let marker = self.bodies[point.body].marker(point.point, &x);
            !matches!(marker, Marker::Node { .. })
        })
    }
}

/// Coordinates of a body of the inner mechanism, counted in the outer one.
pub(crate) fn shifted(x: &[usize], offset: usize) -> Vec<usize> {
    x.iter().map(|x| x + offset).collect()
}

impl Numbering {
    /// The coordinates of a body that are known.
    fn know(&mut self, c: &Compiler, b: usize) {
        let poses = c.slots[b].iter().all(|slot| slot.content == Content::Pose);
        match (c.bodies[b].known(), c.roles[b]) {
            (Some(Known::Fixed), _) => {
                for (s, point) in c.bodies[b].points().iter().enumerate() {
                    let x = self.known(2);
                    self.fixed.extend([(x, point.at.x), (x + 1, point.at.y)]);
                    self.bodies[b].x[s] = x;
                }
            }
            (_, Role::Path) => self.bodies[b].x = vec![self.known(3)],
            (_, Role::Turned(_)) if poses => self.bodies[b].x = vec![self.known(3)],
            (_, Role::Free) => {
                for (s, slot) in c.slots[b].iter().enumerate() {
                    if let Some(held) = slot.held {
                        let x = self.known(slot.content.names().len());
                        self.bodies[b].x[s] = x;
                        if let HeldSlot::At(value) = held {
                            self.fixed.push((x, value));
                        }
                    }
                }
            }
            _ => {}
        }
    }

    /// Lets the point at which a joint holds a body follow its partner. It has coordinates of its own, although they are those of the
    /// partner, so that what acts on it is not mistaken for what acts there.
    fn carry(&mut self, c: &Compiler, b: usize) {
        let Some(hold) = c.bodies[b].hold().filter(|hold| hold.line.is_none()) else {
            return;
        };
        let held = PointRef {
            body: b,
            point: hold.point,
        };
        let partner = c.scene.joints[hold.joint].partner(held);
        let partner = partner.expect("a joint holds a body at one of its points");
        let x = self.bodies[b].x[0];
        match c.roles[partner.body] {
            Role::Ground => {
                let at = c.bodies[partner.body].points()[partner.point].at;
                self.fixed.extend([(x, at.x), (x + 1, at.y)]);
            }
            _ => {
                let marker = self.bodies[partner.body].marker(partner.point);
                self.driven_nodes.push(DrivenNode { x, marker });
            }
        }
    }

    /// Coordinates of the nodes that are fixed to known points.
    fn anchor(&mut self, nodes: &mut Nodes, anchored: &[usize]) {
        for &class in anchored {
            let Some(point) = nodes.anchor[class] else {
                continue;
            };
            let x = match self.bodies[point.body].marker(point.point) {
                Marker::Node { x } => x,
                marker => {
                    let x = self.known(2);
                    self.driven_nodes.push(DrivenNode { x, marker });
                    x
                }
            };
            nodes.x[class] = Some(x);
        }
    }

    /// Coordinates of a link that motion `m` turns about a point of the ground: that point, and known ends.
    fn turn_link(&mut self, c: &Compiler, b: usize, m: usize) {
        let MotionKind::Angle { joint, .. } = c.scene.motions[m].kind else {
            unreachable!("only an angle turns a body");
        };
        let joint = &c.scene.joints[joint];
        let (own, ground) = match joint.journal.body == b {
            true => (joint.journal, joint.bearing),
            false => (joint.bearing, joint.journal),
        };
        for (s, slot) in c.slots[b].iter().enumerate() {
            match slot.point {
                Some(point) if point == own.point => {
                    self.bodies[b].x[s] = self.bodies[ground.body].x[ground.point];
                }
                Some(_) => self.bodies[b].x[s] = self.known(2),
                None => {}
            }
        }
    }

    fn known(&mut self, count: usize) -> usize {
        self.coordinates += count;
        self.coordinates - count
    }
}

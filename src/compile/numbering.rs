//! Numbers the coordinates: which link ends share a node, which are known, and the indices of every body.

use super::{Compiler, Mode, Role};
use crate::marker::Marker;
use crate::model::{BodyCoordinates, DrivenNode, Model};
use crate::scene::{BodyKind, JointModel, LinkModel, MotionKind, PointRef, SceneError};

/// How a joint of this mechanism connects its points.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Connection {
    /// By sharing or eliminating coordinates.
    Eliminated,
    /// By two constraint rows.
    Constraint,
    /// By contact forces.
    Contact,
}

/// All coordinates of a mechanism.
pub(crate) struct Numbering {
    pub unknowns: usize,
    /// Coordinates including those of the inner mechanism, which come last.
    pub coordinates: usize,
    /// First coordinate of the inner mechanism.
    pub offset: usize,
    pub names: Vec<String>,
    /// Coordinates of every body.
    pub bodies: Vec<BodyCoordinates>,
    /// Known coordinates that never change, with their values.
    pub fixed: Vec<(usize, f64)>,
    pub driven_nodes: Vec<DrivenNode>,
    pub connections: Vec<Connection>,
}

/// Classes of link ends that share a node (union-find); the index of an end is 2 body + end.
struct Nodes {
    parent: Vec<usize>,
    /// The known point that a class is fixed to.
    anchor: Vec<Option<PointRef>>,
    /// First coordinate, once numbered.
    x: Vec<Option<usize>>,
}

impl Nodes {
    fn find(&self, mut end: usize) -> usize {
        while self.parent[end] != end {
            end = self.parent[end];
        }
        end
    }
}

fn end_of(point: PointRef) -> usize {
    2 * point.body + point.point
}

/// Shares and anchors the ends of free links.
fn connect(c: &Compiler) -> Result<(Nodes, Vec<Connection>), SceneError> {
    let count = 2 * c.scene.bodies.len();
    let mut nodes = Nodes {
        parent: (0..count).collect(),
        anchor: vec![None; count],
        x: vec![None; count],
    };
    let mut connections = Vec::new();
    for (j, joint) in c.scene.joints.iter().enumerate() {
        let redundant = |what: &str| {
            let message = format!("joint {} is redundant: {what}", joint.name);
            c.joint_error(j, message, "redundant joint")
        };
        let (bearing, journal) = (joint.bearing, joint.journal);
        let free_end = |p: PointRef| !c.is_known(p) && c.is_node(p);
        connections.push(if !c.is_ideal(j) {
            Connection::Contact
        } else if matches!(joint.model, JointModel::Prismatic { .. }) {
            Connection::Constraint
        } else if c.is_known(bearing) && c.is_known(journal) {
            if !c.may_stay_closed(j) {
                return Err(redundant("the motion of both of its bodies is prescribed"));
            }
            Connection::Eliminated
        } else if free_end(bearing) && free_end(journal) {
            let (a, b) = (nodes.find(end_of(bearing)), nodes.find(end_of(journal)));
            if a == b {
                return Err(redundant(
                    "other joints already make its two points coincide",
                ));
            }
            if nodes.anchor[a].is_some() && nodes.anchor[b].is_some() {
                return Err(redundant("both of its points are already fixed"));
            }
            nodes.parent[b] = a;
            // only the root of a class is fixed
            nodes.anchor[a] = nodes.anchor[a].or(nodes.anchor[b].take());
            Connection::Eliminated
        } else if free_end(bearing) && c.is_known(journal)
            || free_end(journal) && c.is_known(bearing)
        {
            let (end, known) = if free_end(bearing) {
                (bearing, journal)
            } else {
                (journal, bearing)
            };
            let class = nodes.find(end_of(end));
            if nodes.anchor[class].is_some() {
                return Err(redundant("the link end it joins is already fixed"));
            }
            nodes.anchor[class] = Some(known);
            Connection::Eliminated
        } else {
            Connection::Constraint
        });
    }
    Ok((nodes, connections))
}

/// Numbers all coordinates; `inner` is the ideal mechanism that drives this one.
pub(crate) fn number(c: &Compiler, inner: Option<&Model>) -> Result<Numbering, SceneError> {
    let (mut nodes, connections) = connect(c)?;
    let mut names = Vec::new();
    let mut take = |labels: &[String]| {
        names.extend_from_slice(labels);
        names.len() - labels.len()
    };
    let xy = |label: String| [format!("{label}.x"), format!("{label}.y")];

    // unknown coordinates, body by body in the order of the scene
    let mut bodies = vec![BodyCoordinates::Ground { points: Vec::new() }; c.scene.bodies.len()];
    for (b, body) in c.scene.bodies.iter().enumerate() {
        if c.roles[b] != Role::Free {
            continue;
        }
        let mut node_of = |end: usize, take: &mut dyn FnMut(&[String]) -> usize| {
            let class = nodes.find(2 * b + end);
            if nodes.anchor[class].is_none() && nodes.x[class].is_none() {
                let point = PointRef {
                    body: b,
                    point: end,
                };
                nodes.x[class] = Some(take(&xy(c.point_name(point))));
            }
            nodes.x[class].unwrap_or(usize::MAX)
        };
        bodies[b] = match &body.kind {
            BodyKind::Ground { .. } | BodyKind::Moving { .. } => {
                unreachable!("these bodies are not free")
            }
            BodyKind::PointMass { .. } => BodyCoordinates::PointMass {
                x: node_of(0, &mut take),
            },
            BodyKind::Rigid(_) => {
                let labels = ["x", "y", "theta"].map(|s| format!("{}.{s}", body.name));
                BodyCoordinates::Rigid { x: take(&labels) }
            }
            BodyKind::Link(link) => match (c.mode, link.model) {
                (Mode::Ideal, _) | (_, LinkModel::Rigid) => BodyCoordinates::RigidLink {
                    ends: [node_of(0, &mut take), node_of(1, &mut take)],
                },
                (Mode::Real, LinkModel::Flexible { elements, .. }) => {
                    let (mut positions, mut slopes) = (Vec::new(), Vec::new());
                    for k in 0..=elements {
                        let label = format!("{}.node{k}", body.name);
                        positions.push(match k {
                            0 => node_of(0, &mut take),
                            k if k == elements => node_of(1, &mut take),
                            _ => take(&xy(label.clone())),
                        });
                        slopes.push(take(&xy(format!("{label}.slope"))));
                    }
                    let element_length = link.length / elements as f64;
                    BodyCoordinates::FlexibleLink {
                        nodes: positions,
                        slopes,
                        elements: 0..0,
                        element_length,
                        points: [0, elements]
                            .into_iter()
                            .chain(link.points.iter().map(|p| p.node))
                            .collect(),
                    }
                }
            },
        };
    }
    let unknowns = names.len();

    // known coordinates: the ground, the body on the path, the driven_nodes, the inner mechanism
    let mut numbering = Numbering {
        unknowns,
        coordinates: unknowns,
        offset: 0,
        names,
        bodies,
        fixed: Vec::new(),
        driven_nodes: Vec::new(),
        connections,
    };
    for (b, body) in c.scene.bodies.iter().enumerate() {
        match (&body.kind, c.roles[b]) {
            (BodyKind::Ground { points }, _) => {
                let mut firsts = Vec::new();
                for point in points {
                    let x = numbering.known(2);
                    numbering
                        .fixed
                        .extend([(x, point.at[0]), (x + 1, point.at[1])]);
                    firsts.push(x);
                }
                numbering.bodies[b] = BodyCoordinates::Ground { points: firsts };
            }
            (_, Role::Path) | (BodyKind::Rigid(_), Role::Turned(_)) => {
                numbering.bodies[b] = BodyCoordinates::Rigid {
                    x: numbering.known(3),
                }
            }
            _ => {}
        }
    }
    for b in 0..c.scene.bodies.len() {
        if let (BodyKind::Link(_), Role::Turned(m)) = (&c.scene.bodies[b].kind, c.roles[b]) {
            numbering.bodies[b] = numbering.turned_link(c, b, m);
        }
    }
    let anchored: Vec<usize> = (0..nodes.parent.len())
        .filter(|&e| nodes.anchor[e].is_some())
        .collect();
    numbering.offset = numbering.coordinates
        + 2 * anchored
            .iter()
            .filter(|&&e| c.needs_rider(&nodes, e))
            .count();
    if let Some(inner) = inner {
        for b in 0..c.scene.bodies.len() {
            if c.roles[b] == Role::Driven {
                numbering.bodies[b] = shifted(&inner.bodies()[b].coordinates, numbering.offset);
            }
        }
    }
    for &class in &anchored {
        let Some(point) = nodes.anchor[class] else {
            continue;
        };
        let x = match c.marker(&numbering.bodies[point.body], point) {
            Marker::Node { x } => x,
            marker => {
                let x = numbering.known(2);
                numbering.driven_nodes.push(DrivenNode { x, marker });
                x
            }
        };
        nodes.x[class] = Some(x);
    }
    numbering.coordinates = numbering.offset + inner.map_or(0, |m| m.shape().coordinates);

    // ends tied to known points got their coordinates only now
    for b in 0..c.scene.bodies.len() {
        let x = |end: usize| nodes.x[nodes.find(2 * b + end)];
        match &mut numbering.bodies[b] {
            BodyCoordinates::RigidLink { ends } if c.roles[b] == Role::Free => {
                *ends = [x(0).unwrap_or(ends[0]), x(1).unwrap_or(ends[1])];
            }
            BodyCoordinates::FlexibleLink {
                nodes: positions, ..
            } => {
                let last = positions.len() - 1;
                positions[0] = x(0).unwrap_or(positions[0]);
                positions[last] = x(1).unwrap_or(positions[last]);
            }
            BodyCoordinates::PointMass { x: own } => *own = x(0).unwrap_or(*own),
            _ => {}
        }
    }
    Ok(numbering)
}

impl Compiler<'_> {
    /// The marker of a point, given the coordinates of its body.
    pub fn marker(&self, coordinates: &BodyCoordinates, point: PointRef) -> Marker {
        match (coordinates, &self.scene.bodies[point.body].kind) {
            (BodyCoordinates::Rigid { x }, BodyKind::Rigid(rigid)) => Marker::OnBody {
                x: *x,
                s: rigid.points[point.point].at,
            },
            (BodyCoordinates::Ground { points }, _) => Marker::Node {
                x: points[point.point],
            },
            (BodyCoordinates::Rigid { x }, BodyKind::Moving { points, .. }) => Marker::OnBody {
                x: *x,
                s: points[point.point].at,
            },
            (BodyCoordinates::FlexibleLink { nodes, points, .. }, _) => Marker::Node {
                x: nodes[points[point.point]],
            },
            (BodyCoordinates::RigidLink { ends }, BodyKind::Link(link)) if point.point > 1 => {
                Marker::OnChord {
                    from: ends[0],
                    to: ends[1],
                    share: link.share(point.point),
                }
            }
            (BodyCoordinates::RigidLink { ends }, _) => Marker::Node {
                x: ends[point.point],
            },
            (BodyCoordinates::PointMass { x }, _) => Marker::Node { x: *x },
            (BodyCoordinates::Rigid { .. }, _) => {
                unreachable!("only these bodies have reference-point coordinates")
            }
        }
    }

    /// True for a class fixed to a known point of a rigid body, whose node must be computed.
    fn needs_rider(&self, nodes: &Nodes, class: usize) -> bool {
        let Some(point) = nodes.anchor[class] else {
            return false;
        };
        matches!(
            self.scene.bodies[point.body].kind,
            BodyKind::Rigid(_) | BodyKind::Moving { .. }
        )
    }
}

/// Coordinates of a body of the inner mechanism, counted in the outer one.
pub(crate) fn shifted(coordinates: &BodyCoordinates, offset: usize) -> BodyCoordinates {
    match coordinates {
        BodyCoordinates::Rigid { x } => BodyCoordinates::Rigid { x: x + offset },
        BodyCoordinates::RigidLink { ends } => BodyCoordinates::RigidLink {
            ends: ends.map(|x| x + offset),
        },
        other => other.clone(),
    }
}

impl Numbering {
    /// Coordinates of a link that motion `m` turns about a point of the ground: that point, and a known end.
    fn turned_link(&mut self, c: &Compiler, b: usize, m: usize) -> BodyCoordinates {
        let MotionKind::Angle { joint, .. } = c.scene.motions[m].kind else {
            unreachable!("only an angle turns a body");
        };
        let joint = &c.scene.joints[joint];
        let (own, ground) = if joint.journal.body == b {
            (joint.journal, joint.bearing)
        } else {
            (joint.bearing, joint.journal)
        };
        let mut ends = [self.known(2); 2];
        if let BodyCoordinates::Ground { points } = &self.bodies[ground.body] {
            ends[own.point] = points[ground.point];
        }
        BodyCoordinates::RigidLink { ends }
    }

    fn known(&mut self, count: usize) -> usize {
        self.coordinates += count;
        self.coordinates - count
    }
}

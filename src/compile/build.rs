//! Builds a model from the terms of a scene: masses, patterns, and the place of each term in the equations.

use super::joints::{joint_terms, motion_terms};
use super::mass::{mass, planar_inertia, weight};
use super::numbering::{Numbering, shifted};
use super::rules::rules;
use super::terms::Terms;
use super::{Compiler, Mode, Role, loads, reactions};
use crate::constraint::Length;
use crate::effect::Effect;
use crate::kinematics::Kinematics;
use crate::link::{AncfCable, ElasticRoute, natural_rigid};
use crate::math::lu::Symbolic;
use crate::model::{
    Block, BodyCoordinates, Border, ConstraintTerm, Element, Inertia, Mass, Model, PlacedBody,
    PlacedConstraint, PlacedContact, PlacedForce, PlacedJoint, PlacedPoint,
};
use crate::scene::{BodyKind, Link, LinkModel, PointRef, SceneError};
use crate::system::Shape;
use std::sync::Arc;

/// Builds the model.
pub(super) fn build(
    c: &Compiler,
    mut numbering: Numbering,
    kinematics: Option<&Arc<Kinematics>>,
) -> Result<Model, SceneError> {
    let mut terms = Terms::default();
    for b in 0..c.scene.bodies.len() {
        body_terms(c, &mut numbering, b, &mut terms)?;
    }
    let mut own = Vec::new();
    for (j, joint) in c.scene.joints.iter().enumerate() {
        own.push(joint_terms(c, &numbering, j, joint, &mut terms)?);
    }
    motion_terms(c, &numbering, &mut own, &mut terms);
    if c.mode == Mode::Real {
        loads::add(c, &numbering, &mut terms);
    }

    let n = numbering.unknowns;
    if let Some(row) = terms
        .rows
        .iter()
        .find(|r| r.term.coordinates().iter().all(|&i| i >= n))
    {
        let message = format!(
            "{} constrains only points whose motion is known already, because they are fixed or prescribed",
            row.names[0]
        );
        return Err(c.scene.error(row.span, message, "nothing here can move"));
    }
    let multipliers = terms.rows.iter().map(|row| row.names.len()).sum();
    let symbolic = analyse(&terms, n);
    let mut names = numbering.names.clone();
    names.extend(terms.rows.iter().flat_map(|row| row.names.iter().cloned()));

    let weight = if c.mode == Mode::Real {
        weight(&terms.inertia, numbering.coordinates)
    } else {
        Vec::new()
    };
    let mut mass = mass(std::mem::take(&mut terms.inertia), &numbering, c.mode);
    let acceleration_symbolic = analyse_level(&terms, &mass, n);
    mass.tangent = mass.matrix(n, &symbolic, c.mode);
    mass.acceleration_level = mass.matrix(n, &acceleration_symbolic, c.mode);
    let place = |coordinates: Vec<usize>| Block::new(coordinates, &symbolic, n);
    let elements = terms
        .elements
        .into_iter()
        .map(|(kernel, coordinates)| Element {
            kernel,
            block: place(coordinates),
        })
        .collect();
    let mut row = 0;
    let constraints = terms.rows.into_iter().map(|r| {
        let coordinates = r.term.coordinates();
        let rows = r.term.rows();
        let borders = |symbolic| {
            let border = |d| Border::new(&coordinates, row + d, symbolic, n);
            (0..rows).map(border).collect()
        };
        let placed = PlacedConstraint {
            border: borders(&symbolic),
            acceleration_border: borders(&acceleration_symbolic),
            owners: owners(&coordinates, r.term.split(), r.sides),
            block: place(coordinates),
            effect: r.effect,
            row,
            rows,
            kept: [1.0; 2],
            term: r.term,
        };
        row += rows;
        placed
    });
    let constraints: Vec<PlacedConstraint> = constraints.collect();
    let forces = terms.forces.into_iter().map(|(term, sides)| {
        let coordinates = term.coordinates();
        PlacedForce {
            owners: owners(&coordinates, term.split(), sides),
            block: place(coordinates),
            term,
        }
    });
    let forces = forces.collect();
    let contacts = terms.contacts.into_iter().map(|pair| PlacedContact {
        block: place(pair.coordinates()),
        pair,
    });
    let contacts: Vec<PlacedContact> = contacts.collect();

    let shape = Shape {
        unknowns: n,
        coordinates: numbering.coordinates,
        multipliers,
        contacts: contacts.len(),
        angles: terms.angles,
    };
    let mut model = Model {
        shape,
        symbolic,
        acceleration_symbolic,
        names,
        mass,
        elements,
        constraints,
        forces,
        counts: Vec::new(),
        named_forces: terms.named_forces,
        contacts,
        weight,
        fixed: numbering.fixed.clone(),
        rules: rules(c, &numbering),
        prescribed: kinematics.into_iter().map(Kinematics::motion).collect(),
        driven: Vec::new(),
        driven_nodes: numbering.driven_nodes,
        bodies: Vec::new(),
        joints: Vec::new(),
    };
    model.count_effects();
    model.bodies = c
        .scene
        .bodies
        .iter()
        .zip(numbering.bodies)
        .enumerate()
        .map(|(b, (body, coordinates))| PlacedBody {
            name: body.name.clone(),
            points: points(c, &coordinates, b),
            coordinates,
            prescribed: kinematics.and_then(|k| prescribed(c, k, b)),
        })
        .collect();
    if c.mode == Mode::Real {
        model.driven = reactions::driven_forces(c, &model, kinematics.map(|k| &**k), &own);
        for (j, joint) in c.scene.joints.iter().enumerate() {
            let (kind, actuator) = reactions::joint(c, &model, &own, j)?;
            model.joints.push(PlacedJoint {
                name: joint.name.clone(),
                kind,
                actuator,
                couple: own[j].couple,
                turned: own[j].turned,
                slide: own[j].slide,
            });
        }
    }
    Ok(model)
}

/// The body of each local coordinate: the first `split` belong to the first side.
fn owners(coordinates: &[usize], split: usize, sides: [usize; 2]) -> Vec<usize> {
    (0..coordinates.len())
        .map(|c| sides[usize::from(c >= split)])
        .collect()
}

/// Named points of a body that moves.
fn points(c: &Compiler, coordinates: &BodyCoordinates, body: usize) -> Vec<PlacedPoint> {
    let count = match &c.scene.bodies[body].kind {
        BodyKind::Ground { .. } => 0,
        BodyKind::Link(link) => 2 + link.points.len(),
        BodyKind::Rigid(rigid) => rigid.points.len(),
        BodyKind::PointMass { .. } => 1,
        BodyKind::Moving { points, .. } => points.len(),
    };
    let place = |point| {
        let point = PointRef { body, point };
        let name = c.point_name(point);
        PlacedPoint {
            name: name
                .split_once('.')
                .map_or(name.clone(), |(_, p)| p.to_owned()),
            marker: c.marker(coordinates, point),
            slope: match coordinates {
                BodyCoordinates::FlexibleLink { slopes, points, .. } => {
                    Some(slopes[points[point.point]])
                }
                _ => None,
            },
        }
    };
    (0..count).map(place).collect()
}

/// First coordinate of body `b` in the ideal mechanism that the drive follows.
fn prescribed(c: &Compiler, kinematics: &Kinematics, b: usize) -> Option<usize> {
    if !c.scene.drives.iter().any(|d| d.body == b) {
        return None;
    }
    match shifted(
        &kinematics.mechanism.bodies()[b].coordinates,
        kinematics.offset,
    ) {
        BodyCoordinates::Rigid { x } => Some(x),
        _ => None,
    }
}

fn body_terms(
    c: &Compiler,
    numbering: &mut Numbering,
    b: usize,
    terms: &mut Terms,
) -> Result<(), SceneError> {
    let body = &c.scene.bodies[b];
    let gravity = c.scene.simulation.gravity.unwrap_or([0.0; 2]);
    match (&body.kind, &mut numbering.bodies[b]) {
        (BodyKind::Rigid(rigid), BodyCoordinates::Rigid { x }) => {
            let (m, i) = (rigid.mass, rigid.inertia);
            terms.inertia.push(Inertia {
                coordinates: vec![*x, *x + 1, *x + 2],
                values: vec![m, 0.0, 0.0, 0.0, m, 0.0, 0.0, 0.0, i],
                field: vec![gravity[0], gravity[1], 0.0],
            });
        }
        (BodyKind::PointMass { mass }, BodyCoordinates::PointMass { x }) => {
            terms
                .inertia
                .push(planar_inertia([[*mass]], [*x], [true], gravity));
        }
        (BodyKind::Link(link), BodyCoordinates::RigidLink { ends }) => {
            let mass = link.density * link.area * link.length;
            terms.inertia.push(planar_inertia(
                natural_rigid::mass(mass),
                *ends,
                [true; 2],
                gravity,
            ));
            if c.roles[b] == Role::Free {
                let [i, j] = *ends;
                if i >= numbering.unknowns && j >= numbering.unknowns {
                    let message = format!(
                        "the length of {} is redundant: the joints at its two ends fix it already",
                        body.name
                    );
                    return Err(c.scene.error(body.span, message, "redundant link"));
                }
                let length = Length {
                    i,
                    j,
                    length: link.length,
                };
                let name = format!("length of {}", body.name);
                terms.constrain(
                    ConstraintTerm::Length(length),
                    Effect::Length,
                    &name,
                    &[""],
                    [b, b],
                    body.span,
                );
            }
        }
        (
            BodyKind::Link(link),
            BodyCoordinates::FlexibleLink {
                nodes,
                slopes,
                elements,
                element_length,
                ..
            },
        ) => {
            let first = terms.elements.len();
            for k in 0..nodes.len() - 1 {
                let firsts = [nodes[k], slopes[k], nodes[k + 1], slopes[k + 1]];
                let m = AncfCable::mass(*element_length, link.density * link.area);
                terms.inertia.push(planar_inertia(
                    m,
                    firsts,
                    [true, false, true, false],
                    gravity,
                ));
                let coordinates = firsts.iter().flat_map(|&x| [x, x + 1]).collect();
                terms
                    .elements
                    .push((kernel(link, *element_length), coordinates));
            }
            *elements = first..terms.elements.len();
        }
        _ => {}
    }
    Ok(())
}

fn kernel(link: &Link, element_length: f64) -> AncfCable {
    let modulus = match link.model {
        LinkModel::Flexible { youngs_modulus, .. } => youngs_modulus,
        LinkModel::Rigid => unreachable!("a rigid link has no elements"),
    };
    AncfCable::new(
        element_length,
        modulus * link.area,
        modulus * link.second_moment,
    )
}

impl Compiler<'_> {
    /// 1/|d| of the undeformed direction of a body: of a chord its length, else 1.
    pub fn inverse_size(&self, body: usize, numbering: &Numbering) -> f64 {
        match (&numbering.bodies[body], &self.scene.bodies[body].kind) {
            (BodyCoordinates::RigidLink { .. }, BodyKind::Link(link)) => 1.0 / link.length,
            _ => 1.0,
        }
    }
}

/// Cliques of a pattern, and the unknowns after which each unknown is eliminated.
struct Pattern {
    unknowns: usize,
    cliques: Vec<Vec<usize>>,
    after: Vec<Vec<usize>>,
}

impl Pattern {
    /// A pattern without cliques, multipliers after the coordinates of their constraints.
    fn new(terms: &Terms, unknowns: usize) -> Pattern {
        let mut after = vec![Vec::new(); unknowns];
        for row in &terms.rows {
            let coordinates = row.term.coordinates().into_iter();
            let coordinates: Vec<usize> = coordinates.filter(|i| *i < unknowns).collect();
            after.extend(std::iter::repeat_n(coordinates, row.names.len()));
        }
        Pattern {
            unknowns,
            cliques: Vec::new(),
            after,
        }
    }

    /// The multipliers, each with the unknown coordinates of its constraint.
    fn rows(&self) -> Vec<(usize, Vec<usize>)> {
        let rows = self.after.iter().cloned().enumerate();
        rows.skip(self.unknowns).collect()
    }

    fn add(&mut self, coordinates: &[usize]) {
        let unknown = coordinates.iter().copied().filter(|i| *i < self.unknowns);
        self.cliques.push(unknown.collect());
    }

    fn analyse(&self) -> Symbolic {
        Symbolic::analyse(self.after.len(), &self.cliques, &self.after)
    }
}

/// Pattern and pivot order of the tangent.
fn analyse(terms: &Terms, n: usize) -> Symbolic {
    let mut pattern = Pattern::new(terms, n);
    for (row, mut coordinates) in pattern.rows() {
        coordinates.push(row);
        pattern.cliques.push(coordinates);
    }
    for part in &terms.inertia {
        pattern.add(&part.coordinates);
    }
    for (_, coordinates) in &terms.elements {
        pattern.add(coordinates);
    }
    for (force, _) in &terms.forces {
        pattern.add(&force.coordinates());
    }
    for pair in &terms.contacts {
        pattern.add(&pair.coordinates());
    }
    pattern.analyse()
}

/// Pattern and pivot order of the matrix of the acceleration level: x and y of a node share no mass, and the coordinates of a
/// constraint meet only in its row.
fn analyse_level(terms: &Terms, mass: &Mass, n: usize) -> Symbolic {
    let mut pattern = Pattern::new(terms, n);
    for (row, coordinates) in pattern.rows() {
        let pairs = coordinates.into_iter().map(|i| vec![i, row]);
        pattern.cliques.extend(pairs);
    }
    for i in 0..n {
        for (&j, _) in mass.row(i) {
            pattern.add(&[i, j]);
        }
    }
    pattern.analyse()
}

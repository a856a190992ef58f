//! Builds the lists of a model: masses, elements, constraints, joints, each with its place in the equations.

use super::mass::{mass, planar_inertia, weight};
use super::numbering::{Connection, Numbering, shifted};
use super::{Compiler, Mode, Role, reactions};
use crate::constraint::{Coincide, Length};
use crate::contact::{Ambrosio, normal_law};
use crate::force::{ClearanceJoint, FrictionalJoint};
use crate::kinematics::Kinematics;
use crate::link::{AncfCable, ElasticRoute, natural_rigid};
use crate::marker::Spin;
use crate::math::lu::Symbolic;
use crate::model::{
    Block, BodyCoordinates, BodyPlace, Border, Contacting, Element, Inertia, JointPlace, Model,
    PathRule, Placed,
};
use crate::motion;
use crate::scene::{BodyKind, Joint, JointModel, Link, LinkModel, PointRef, SceneError};
use crate::system::Shape;

/// Terms before they have slots: what they are, on which coordinates.
#[derive(Default)]
struct Terms {
    inertia: Vec<Inertia>,
    elements: Vec<(AncfCable, Vec<usize>)>,
    /// With the body.
    lengths: Vec<(Length, usize)>,
    coincidences: Vec<(Coincide, String)>,
    loose: Vec<ClearanceJoint>,
    frictional: Vec<FrictionalJoint>,
    /// Contact memory of each loose and each frictional joint.
    loose_contacts: Vec<usize>,
    frictional_contacts: Vec<usize>,
    contacts: usize,
}

/// Builds the model.
pub(super) fn build(
    c: &Compiler,
    mut numbering: Numbering,
    kinematics: Option<Kinematics>,
) -> Result<Model, SceneError> {
    let mut terms = Terms::default();
    for b in 0..c.scene.bodies.len() {
        body_terms(c, &mut numbering, b, &mut terms);
    }
    let mut own = Vec::new();
    for (j, joint) in c.scene.joints.iter().enumerate() {
        own.push(joint_terms(c, &numbering, j, joint, &mut terms)?);
    }

    let n = numbering.unknowns;
    for &(length, body) in &terms.lengths {
        if length.i >= n && length.j >= n {
            let body = &c.scene.bodies[body];
            let message = format!(
                "the length of {} repeats what the joints of both its ends already fix",
                body.name
            );
            return Err(c.scene.error(body.span, message, "redundant link"));
        }
    }
    let multipliers = terms.lengths.len() + 2 * terms.coincidences.len();
    let symbolic = analyse(&terms, n, multipliers);
    let mut names = numbering.names.clone();
    let length_name =
        |&(_, body): &(Length, usize)| format!("length of {}", c.scene.bodies[body].name);
    names.extend(terms.lengths.iter().map(length_name));
    for (_, name) in &terms.coincidences {
        names.extend(["x", "y"].map(|d| format!("{name} ({d})")));
    }

    let weight = if c.mode == Mode::Real {
        weight(&terms.inertia, numbering.coordinates)
    } else {
        Vec::new()
    };
    let mass = mass(terms.inertia, &numbering, &symbolic, c.mode);
    let place = |coordinates: Vec<usize>| Block::new(coordinates, &symbolic, n);
    let border = |coordinates: &[usize], row| Border::new(coordinates, row, &symbolic, n);
    let elements = terms
        .elements
        .into_iter()
        .map(|(kernel, coordinates)| Element {
            kernel,
            block: place(coordinates),
        })
        .collect();
    let lengths: Vec<_> = terms
        .lengths
        .into_iter()
        .enumerate()
        .map(|(row, (term, _))| {
            let coordinates = term.coordinates().to_vec();
            Placed {
                term,
                row,
                border: vec![border(&coordinates, row)],
                block: place(coordinates),
            }
        })
        .collect();
    let coincidences = terms
        .coincidences
        .into_iter()
        .enumerate()
        .map(|(i, (term, _))| {
            let row = lengths.len() + 2 * i;
            let coordinates = term.coordinates();
            let borders = vec![border(&coordinates, row), border(&coordinates, row + 1)];
            Placed {
                term,
                row,
                border: borders,
                block: place(coordinates),
            }
        })
        .collect();
    let loose = terms
        .loose
        .into_iter()
        .zip(terms.loose_contacts)
        .map(|(term, contact)| Contacting {
            block: place(term.coordinates()),
            term,
            contact,
        })
        .collect();
    let frictional = terms
        .frictional
        .into_iter()
        .zip(terms.frictional_contacts)
        .map(|(term, contact)| Contacting {
            block: place(term.coordinates()),
            term,
            contact,
        })
        .collect();

    let shape = Shape {
        unknowns: n,
        coordinates: numbering.coordinates,
        multipliers,
        contacts: terms.contacts,
    };
    let mut model = Model {
        shape,
        symbolic,
        names,
        mass,
        elements,
        lengths,
        coincidences,
        loose,
        frictional,
        weight,
        fixed: numbering.fixed,
        path: path_rule(c, &numbering.bodies),
        kinematics: kinematics.map(|k| Kinematics {
            offset: numbering.offset,
            ..k
        }),
        driven: Vec::new(),
        riders: numbering.riders,
        bodies: Vec::new(),
        joints: Vec::new(),
    };
    model.bodies = c
        .scene
        .bodies
        .iter()
        .zip(numbering.bodies)
        .enumerate()
        .map(|(b, (body, coordinates))| BodyPlace {
            name: body.name.clone(),
            coordinates,
            prescribed: prescribed(c, &model, b),
        })
        .collect();
    if c.mode == Mode::Real {
        model.driven = reactions::driven_forces(c, &model, &own);
        for (j, joint) in c.scene.joints.iter().enumerate() {
            let (kind, actuator) = reactions::joint(c, &model, &own, j)?;
            model.joints.push(JointPlace {
                name: joint.name.clone(),
                kind,
                actuator,
            });
        }
    }
    Ok(model)
}

/// First coordinate of what the drive prescribes for body `b`.
fn prescribed(c: &Compiler, model: &Model, b: usize) -> Option<usize> {
    let kinematics = model.kinematics.as_ref()?;
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

fn path_rule(c: &Compiler, bodies: &[BodyCoordinates]) -> Option<PathRule> {
    let drive = c.scene.drives.first().filter(|_| c.mode == Mode::Ideal)?;
    match bodies[drive.body] {
        BodyCoordinates::Rigid { x } => Some(PathRule {
            x,
            path: motion::path(&drive.path),
        }),
        _ => None,
    }
}

fn body_terms(c: &Compiler, numbering: &mut Numbering, b: usize, terms: &mut Terms) {
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
        (BodyKind::Link(link), BodyCoordinates::RigidLink { ends }) => {
            let mass = link.density * link.area * link.length;
            terms.inertia.push(planar_inertia(
                natural_rigid::mass(mass),
                *ends,
                [true; 2],
                gravity,
            ));
            if c.roles[b] == Role::Free {
                let length = Length {
                    i: ends[0],
                    j: ends[1],
                    length: link.length,
                };
                terms.lengths.push((length, b));
            }
        }
        (
            BodyKind::Link(link),
            BodyCoordinates::FlexibleLink {
                nodes,
                slopes,
                elements,
                element_length,
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

/// The term that a joint brings into the equations, by its index in the list of its kind.
#[derive(Debug, Clone, Copy)]
pub(super) enum OwnTerm {
    Constraint(usize),
    Loose(usize),
    Frictional(usize),
    /// None: the joint shares or eliminates coordinates.
    Eliminated,
}

fn joint_terms(
    c: &Compiler,
    numbering: &Numbering,
    j: usize,
    joint: &Joint,
    terms: &mut Terms,
) -> Result<OwnTerm, SceneError> {
    let [bearing, journal] =
        [joint.bearing, joint.journal].map(|p| c.marker(&numbering.bodies[p.body], p));
    match (numbering.connections[j], &joint.model) {
        (Connection::Eliminated, _) => Ok(OwnTerm::Eliminated),
        (Connection::Contact, JointModel::Clearance(contact)) => {
            let n = numbering.unknowns;
            if bearing.x() >= n && journal.x() >= n {
                let message = format!(
                    "joint {} has clearance between two points whose motion is known",
                    joint.name
                );
                return Err(c.joint_error(j, message, "nothing here can move"));
            }
            let law = normal_law(contact);
            let term = ClearanceJoint {
                bearing,
                journal,
                clearance: contact.clearance,
                law,
            };
            terms.contacts += 1;
            match contact.friction {
                None => {
                    terms.loose.push(term);
                    terms.loose_contacts.push(terms.contacts - 1);
                    Ok(OwnTerm::Loose(terms.loose.len() - 1))
                }
                Some(f) => {
                    let law = Ambrosio {
                        coefficient: f.coefficient,
                        v0: f.v0,
                        v1: f.v1,
                    };
                    let spins = [joint.bearing, joint.journal].map(|p| spin(numbering, p));
                    let term =
                        FrictionalJoint::new(term, law, f.slip, contact.bearing_radius, spins);
                    terms.frictional.push(term);
                    terms.frictional_contacts.push(terms.contacts - 1);
                    Ok(OwnTerm::Frictional(terms.frictional.len() - 1))
                }
            }
        }
        _ => {
            terms.coincidences.push((
                Coincide { bearing, journal },
                format!("joint {}", joint.name),
            ));
            Ok(OwnTerm::Constraint(terms.coincidences.len() - 1))
        }
    }
}

/// How the material at a point turns.
fn spin(numbering: &Numbering, point: PointRef) -> Spin {
    match &numbering.bodies[point.body] {
        BodyCoordinates::Ground { .. } => Spin::Fixed,
        BodyCoordinates::Rigid { x } => Spin::Angle { theta: x + 2 },
        BodyCoordinates::RigidLink { ends } => Spin::Chord {
            from: ends[0],
            to: ends[1],
        },
        BodyCoordinates::FlexibleLink { slopes, .. } => Spin::Slope {
            x: if point.point == 0 {
                slopes[0]
            } else {
                slopes[slopes.len() - 1]
            },
        },
    }
}

/// Pattern and pivot order of the tangent.
fn analyse(terms: &Terms, n: usize, multipliers: usize) -> Symbolic {
    let mut cliques: Vec<Vec<usize>> = Vec::new();
    let mut after = vec![Vec::new(); n + multipliers];
    let mut clique = |coordinates: &[usize], row: Option<usize>| {
        let mut unknown: Vec<usize> = coordinates.iter().copied().filter(|&i| i < n).collect();
        if let Some(row) = row {
            after[n + row].clone_from(&unknown);
            unknown.push(n + row);
        }
        cliques.push(unknown);
    };
    for part in &terms.inertia {
        clique(&part.coordinates, None);
    }
    for (_, coordinates) in &terms.elements {
        clique(coordinates, None);
    }
    for (row, (length, _)) in terms.lengths.iter().enumerate() {
        clique(&length.coordinates(), Some(row));
    }
    for (i, (coincide, _)) in terms.coincidences.iter().enumerate() {
        let row = terms.lengths.len() + 2 * i;
        for d in 0..2 {
            clique(&coincide.coordinates(), Some(row + d));
        }
    }
    for joint in &terms.loose {
        clique(&joint.coordinates(), None);
    }
    for joint in &terms.frictional {
        clique(&joint.coordinates(), None);
    }
    Symbolic::analyse(n + multipliers, &cliques, &after)
}

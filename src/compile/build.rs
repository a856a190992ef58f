//! Builds a model from the terms of a scene: masses, patterns, and the place of each term in the equations.

use super::mass::{mass, weight};
use super::motions::motion_terms;
use super::numbering::{Numbering, shifted};
use super::places::{Places, events, ledger};
use super::reactions::Reactions;
use super::rules::rules;
use super::{Compiler, Mode, Role};
use crate::body::Point;
use crate::interaction::{Ends, JointEnds, Placed};
use crate::kinematics::Kinematics;
use crate::marker::Marker;
use crate::math::lu::Symbolic;
use crate::math::saddle_point::SaddlePoint;
use crate::model::{DrivenForces, Model, PlacedBody, PlacedPoint};
use crate::scene::{Analysis, SceneError};
use crate::system::Shape;
use crate::terms::{ConstraintRows, ConstraintTerm, ForceTerm, Inertia, JointTerms, Owner, Terms};
use std::collections::HashSet;
use std::ops::Range;
use std::sync::Arc;

/// The terms of a mechanism, and what of them belongs to each body, joint and force of the scene.
struct Collected {
    terms: Terms,
    bodies: Vec<BodyParts>,
    joints: Vec<JointTerms>,
    forces: Vec<(String, usize)>,
}

fn collect(c: &Compiler, numbering: &Numbering) -> Result<Collected, SceneError> {
    let mut terms = Terms {
        gravity: c.scene.simulation.gravity.unwrap_or([0.0; 2]),
        ..Terms::default()
    };
    let bodies = 0..c.bodies.len();
    let bodies = bodies.map(|b| body_terms(c, numbering, b, &mut terms));
    let bodies = bodies.collect::<Result<_, _>>()?;
    let joints = 0..c.joints.len();
    let joints = joints.map(|j| joint_terms(c, numbering, j, &mut terms));
    let mut joints: Vec<JointTerms> = joints.collect::<Result<_, _>>()?;
    motion_terms(c, numbering, &mut joints, &mut terms);
    let forces = match c.mode {
        Mode::Real | Mode::Pressed => force_terms(c, numbering, &mut terms),
        Mode::Ideal => Vec::new(),
    };
    // rigid links may overdetermine the mechanism that presses journals, and a link between known points may fit: such rows are
    // redundant
    let known = |row: &&ConstraintRows| {
        let coordinates = row.term.coordinates();
        let may_fit = c.mode == Mode::Pressed || matches!(row.term, ConstraintTerm::Length(_));
        !may_fit && coordinates.iter().all(|&i| i >= numbering.unknowns)
    };
    if let Some(row) = terms.constraints.iter().find(known) {
        let message = format!(
            "{} constrains only points whose motion is known already, because they are fixed or prescribed",
            row.names[0]
        );
        return Err(c.scene.error(row.span, message, "nothing here can move"));
    }
    Ok(Collected {
        terms,
        bodies,
        joints,
        forces,
    })
}

/// Builds the model.
pub(super) fn build(
    c: &Compiler,
    numbering: Numbering,
    kinematics: Option<&Arc<Kinematics>>,
) -> Result<Model, SceneError> {
    let Collected {
        mut terms,
        bodies: parts,
        joints: own,
        forces: named_forces,
    } = collect(c, &numbering)?;
    let n = numbering.unknowns;
    let multipliers = terms.constraints.iter().map(|row| row.names.len()).sum();
    let mut symbolic = analyse(&terms, n);
    let rows = terms.constraints.iter().flat_map(|row| &row.names);
    let names = numbering.names.iter().chain(rows).cloned().collect();

    let weight = if c.mode != Mode::Ideal {
        weight(&terms.inertia, numbering.coordinates)
    } else {
        Vec::new()
    };
    let eccentric = std::mem::take(&mut terms.eccentric);
    let mut mass = mass(std::mem::take(&mut terms.inertia), &numbering, c.mode);
    let entries = match c.mode {
        Mode::Ideal => displacements(c, &numbering),
        Mode::Real | Mode::Pressed => mass.entries(n),
    };
    mass.tangent = symbolic.filled(entries.iter().copied());
    symbolic.expect_diagonal(typical_mass(&entries, &angles(c, &numbering)));
    let acceleration_matrix = SaddlePoint::new(n, entries, &unknown_columns(&terms, n));
    let events = events(&terms);
    let entries = ledger(&terms);
    let shape = Shape {
        unknowns: n,
        coordinates: numbering.coordinates,
        multipliers,
        contacts: terms.contacts.len(),
        crossings: events
            .last()
            .map_or(terms.contacts.len(), |last| last.crossings.end),
        memory: terms.memory(),
        entries: entries.len(),
    };
    let places = Places {
        tangent: &symbolic,
        acceleration_level: &acceleration_matrix,
        unknowns: n,
        ledger: &entries,
    };
    let mut model = Model {
        shape,
        names,
        states: numbering.states.clone(),
        angles: angles(c, &numbering),
        determined: vec![false; numbering.unknowns],
        kinematics_counter: 0,
        elastic_counter: 0,
        effects: Vec::new(),
        mass,
        eccentric: places.eccentric(eccentric),
        elements: places.elements(terms.elements),
        constraints: places.constraints(terms.constraints),
        forces: places.forces(terms.forces, terms.damping),
        instants: Vec::new(),
        ledger: entries.clone(),
        events,
        counts: Vec::new(),
        named_forces,
        contacts: places.contacts(terms.contacts),
        weight,
        fixed: numbering.fixed.clone(),
        rules: rules(c, &numbering),
        prescribed: kinematics.into_iter().map(Kinematics::motion).collect(),
        driven: DrivenForces::default(),
        driven_nodes: numbering.driven_nodes,
        bodies: Vec::new(),
        joints: Vec::new(),
        contact_joints: contact_joints(&own, shape.contacts),
        symbolic,
        acceleration_matrix,
    };
    model.count_effects();
    let bodies = numbering.bodies.into_iter().zip(parts).enumerate();
    let bodies = bodies.map(|(b, (placed, parts))| placed_body(c, b, placed, parts, kinematics));
    model.bodies = bodies.collect();
    if c.mode != Mode::Ideal {
        let reactions = Reactions::new(c, &model, &own);
        let grips = reactions.driven(kinematics.map(|k| &**k));
        let joints = (0..own.len()).map(|j| reactions.joint(j));
        model.joints = joints.collect::<Result<_, _>>()?;
        for (joint, states) in model.joints.iter_mut().zip(numbering.joint_states) {
            joint.states = states;
        }
        model.instants = model.find_instants(c.scene.simulation.duration);
        model.driven = DrivenForces::new(&grips, n, &model.weight);
    }
    Ok(model)
}

/// A body with its coordinates and terms.
fn placed_body(
    c: &Compiler,
    b: usize,
    placed: Placed,
    parts: BodyParts,
    kinematics: Option<&Arc<Kinematics>>,
) -> PlacedBody {
    PlacedBody {
        name: c.scene.bodies[b].name.clone(),
        points: points(c, &placed, b),
        contents: c.slots[b].iter().map(|slot| slot.content).collect(),
        prescribed: kinematics.and_then(|k| prescribed(c, k, b)),
        moves: c.roles[b] != Role::Ground,
        inertia: parts.inertia,
        eccentric: parts.eccentric,
        elements: parts.elements,
        placed,
    }
}

/// The joint of every contact.
fn contact_joints(own: &[JointTerms], contacts: usize) -> Vec<Option<usize>> {
    let mut joints = vec![None; contacts];
    for (j, terms) in own.iter().enumerate() {
        if let ForceTerm::Contact(contact) = terms.force {
            joints[contact] = Some(j);
        }
    }
    joints
}

/// The unknown angles of rigid bodies.
fn angles(c: &Compiler, numbering: &Numbering) -> Vec<usize> {
    let bodies = c.slots.iter().zip(&numbering.bodies);
    let slots = bodies.flat_map(|(slots, placed)| slots.iter().zip(&placed.x));
    let angles = slots.filter_map(|(slot, x)| Some(x + slot.content.angle()?));
    angles.filter(|angle| *angle < numbering.unknowns).collect()
}

/// The matrix whose form is the sum of the squared displacements that the unknowns make: the squares of their lengths, as
/// (row, column, value).
fn displacements(c: &Compiler, numbering: &Numbering) -> Vec<(usize, usize, f64)> {
    let n = numbering.unknowns;
    let mut entries: Vec<_> = (0..n).map(|i| (i, i, 1.0)).collect();
    for (slots, placed) in c.slots.iter().zip(&numbering.bodies) {
        let levers = placed.levers(slots.iter().map(|slot| slot.content));
        for (x, lever) in levers.filter(|(x, lever)| *x < n && *lever > 0.0) {
            entries[x].2 = lever * lever;
        }
    }
    entries
}

/// Named points of a body that moves.
fn points(c: &Compiler, placed: &Placed, body: usize) -> Vec<PlacedPoint> {
    if c.roles[body] == Role::Ground {
        return Vec::new();
    }
    let points = placed.kind.points().iter().enumerate();
    let place = |(i, point): (usize, &Point)| PlacedPoint {
        name: point.name.clone(),
        marker: placed.marker(i),
        slope: placed.kind.slope_slot(i).map(|slot| placed.x[slot]),
    };
    points.map(place).collect()
}

/// First coordinate of body `b` in the ideal mechanism that the drive follows.
fn prescribed(c: &Compiler, kinematics: &Kinematics, b: usize) -> Option<usize> {
    let driven = c.scene.drives.iter().any(|d| d.body == b);
    let x = &kinematics.mechanism.bodies()[b].placed.x;
    driven.then(|| shifted(x, kinematics.offset)[0])
}

/// The terms of a body, by their indices.
struct BodyParts {
    inertia: Range<usize>,
    eccentric: Range<usize>,
    elements: Range<usize>,
}

fn body_terms(
    c: &Compiler,
    numbering: &Numbering,
    b: usize,
    terms: &mut Terms,
) -> Result<BodyParts, SceneError> {
    let body = &c.scene.bodies[b];
    let first = [
        terms.inertia.len(),
        terms.eccentric.len(),
        terms.elements.len(),
    ];
    let before = terms.constraints.len();
    let owner = Owner {
        name: &body.name,
        sides: [b, b],
        span: body.span,
    };
    c.bodies[b].terms(&numbering.bodies[b].x, owner, terms);
    if c.roles[b] != Role::Free {
        terms.constraints.truncate(before);
    }
    Ok(BodyParts {
        inertia: first[0]..terms.inertia.len(),
        eccentric: first[1]..terms.eccentric.len(),
        elements: first[2]..terms.elements.len(),
    })
}

fn joint_terms(
    c: &Compiler,
    numbering: &Numbering,
    j: usize,
    terms: &mut Terms,
) -> Result<JointTerms, SceneError> {
    let joint = &c.scene.joints[j];
    let points = joint.points();
    let markers = points.map(|p| numbering.bodies[p.body].marker(p.point));
    let loose = c.joints[j].contact().is_some();
    let mut coordinates = markers.iter().flat_map(Marker::coordinates);
    if loose && coordinates.all(|x| x >= numbering.unknowns) {
        let message = format!(
            "joint {} has clearance, but both of its points are fixed or prescribed",
            joint.name
        );
        return Err(c.joint_error(j, message, "nothing here can move"));
    }
    let ends = JointEnds {
        markers,
        spins: points.map(|p| numbering.bodies[p.body].spin(p.point)),
        inverse_sizes: points.map(|p| c.inverse_size(p.body)),
        owner: Owner {
            name: &format!("joint {}", joint.name),
            sides: points.map(|p| p.body),
            span: joint.span,
        },
        states: &numbering.joint_states[j],
        eliminated: numbering.eliminated[j],
    };
    Ok(c.joints[j].terms(&ends, terms))
}

/// Adds the forces of the scene; returns their names with their indices.
fn force_terms(c: &Compiler, numbering: &Numbering, terms: &mut Terms) -> Vec<(String, usize)> {
    let simulation = &c.scene.simulation;
    let full_load = (simulation.analysis == Analysis::Static).then_some(simulation.duration);
    let mut names = Vec::new();
    for (force, states) in c.scene.forces.iter().zip(&numbering.force_states) {
        let ends = Ends {
            bodies: &numbering.bodies,
            joints: &c.scene.joints,
            full_load,
            memory: terms.memory(),
            states,
        };
        names.push((force.name.clone(), terms.forces.len()));
        terms.forces.push(force.kind.term(&ends));
        terms.slots += force.kind.slots();
    }
    let states = numbering.joint_states.iter().chain(&numbering.force_states);
    terms.inertia.extend(states.flatten().map(|&x| Inertia {
        coordinates: vec![x],
        values: vec![1.0],
        field: vec![0.0],
    }));
    names
}

impl Compiler<'_> {
    /// 1/|d| of the undeformed direction of a body.
    pub fn inverse_size(&self, body: usize) -> f64 {
        1.0 / self.bodies[body].direction_size()
    }
}

/// The unknown coordinates of every row of Phi_q.
fn unknown_columns(terms: &Terms, unknowns: usize) -> Vec<Vec<usize>> {
    let rows = terms.constraints.iter().flat_map(|row| {
        let coordinates = row.term.coordinates().into_iter();
        let coordinates: Vec<usize> = coordinates.filter(|i| *i < unknowns).collect();
        std::iter::repeat_n(coordinates, row.names.len())
    });
    rows.collect()
}

/// The geometric mean of the masses of the unknown positions \[kg\]; 1 where there are none.
fn typical_mass(entries: &[(usize, usize, f64)], angles: &[usize]) -> f64 {
    let angles: HashSet<usize> = angles.iter().copied().collect();
    let own = entries
        .iter()
        .filter(|(i, j, m)| i == j && *m > 0.0 && !angles.contains(i));
    let logarithms: Vec<f64> = own.map(|(_, _, m)| m.ln()).collect();
    match logarithms.len() {
        0 => 1.0,
        count => (logarithms.iter().sum::<f64>() / count as f64).exp(),
    }
}

/// Pattern and pivot order of the tangent: a multiplier after the coordinates of its constraint.
fn analyse(terms: &Terms, n: usize) -> Symbolic {
    let mut after = vec![Vec::new(); n];
    after.extend(unknown_columns(terms, n));
    let borders = after.iter().enumerate().skip(n);
    let borders = borders.map(|(row, coordinates)| [&coordinates[..], &[row]].concat());
    let blocks = (terms.inertia.iter().map(|part| part.coordinates.clone()))
        .chain(
            terms
                .elements
                .iter()
                .map(|(_, coordinates)| coordinates.clone()),
        )
        .chain(terms.forces.iter().map(|(force, _)| force.coordinates()))
        .chain(terms.contacts.iter().map(|pair| pair.coordinates()));
    let blocks = blocks.map(|coordinates| coordinates.into_iter().filter(|i| *i < n).collect());
    let cliques: Vec<Vec<usize>> = borders.chain(blocks).collect();
    Symbolic::analyse(after.len(), &cliques, &after)
}

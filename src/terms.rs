//! The terms of a mechanism as bodies and interactions give them, before they have a place in the equations.

use crate::constraint::{Coincide, Constraint, Curvature, Gradient, Length, ROWS, Slide};
use crate::contact::ContactPair;
use crate::document::Span;
use crate::eccentric_mass::EccentricMass;
use crate::effect::Effect;
use crate::force::Force;
use crate::link::AncfCable;
use crate::marker::Spin;
use crate::system::State;

/// The terms of a mechanism, by kind.
#[derive(Debug, Default)]
pub struct Terms {
    /// Gravity \[m/s2\].
    pub gravity: [f64; 2],
    /// Masses.
    pub inertia: Vec<Inertia>,
    /// What masses beside the reference points of their bodies add.
    pub eccentric: Vec<EccentricMass>,
    /// Elements and their coordinates.
    pub elements: Vec<(AncfCable, Vec<usize>)>,
    /// Constraints.
    pub constraints: Vec<ConstraintRows>,
    /// Forces, with the bodies of their two sides.
    pub forces: Vec<(Box<dyn Force>, [usize; 2])>,
    /// Forces of structural damping, with their body.
    pub damping: Vec<(Box<dyn Force>, usize)>,
    /// Contacts.
    pub contacts: Vec<Box<dyn ContactPair>>,
    /// Numbers of memory that forces need.
    pub slots: usize,
}

/// A constraint and the names of its rows.
#[derive(Debug)]
pub struct ConstraintRows {
    /// The constraint.
    pub term: ConstraintTerm,
    /// One name a row.
    pub names: Vec<String>,
    /// Bodies of its two sides.
    pub sides: [usize; 2],
    /// Its place in the scene file.
    pub span: Span,
}

/// What a constraint belongs to.
#[derive(Debug, Clone, Copy)]
pub struct Owner<'a> {
    /// The beginning of the names of its rows.
    pub name: &'a str,
    /// Bodies of its two sides.
    pub sides: [usize; 2],
    /// Where it stands in the scene.
    pub span: Span,
}

impl Terms {
    /// Adds a constraint whose rows are called as their owner and what `parts` says; returns its index.
    pub fn constrain(&mut self, term: ConstraintTerm, owner: Owner, parts: &[&str]) -> usize {
        debug_assert_eq!(parts.len(), term.rows());
        let names = parts.iter().map(|part| match *part {
            "" => owner.name.to_owned(),
            part => format!("{} ({part})", owner.name),
        });
        self.constraints.push(ConstraintRows {
            names: names.collect(),
            term,
            sides: owner.sides,
            span: owner.span,
        });
        self.constraints.len() - 1
    }

    /// Numbers of memory: those of contacts, then those of forces.
    pub fn memory(&self) -> usize {
        self.contacts.len() + self.slots
    }
}

/// A constraint: the kinds that every mechanism has many of by themselves, so that the step loop calls them directly.
#[derive(Debug)]
pub enum ConstraintTerm {
    /// Length of a rigid link.
    Length(Length),
    /// Two points that coincide.
    Coincide(Coincide),
    /// Any other.
    Other(Box<dyn Constraint>),
}

impl ConstraintTerm {
    /// See [`Constraint::value_and_gradient`].
    #[inline]
    pub fn value_and_gradient(&self, at: &State, gradient: &mut Gradient) -> [f64; ROWS] {
        match self {
            ConstraintTerm::Length(term) => term.value_and_gradient(at, gradient),
            ConstraintTerm::Coincide(term) => term.value_and_gradient(at, gradient),
            ConstraintTerm::Other(term) => term.value_and_gradient(at, gradient),
        }
    }

    /// See [`Constraint::curvature`].
    #[inline]
    pub fn curvature(&self, at: &State, lambda: [f64; ROWS], out: &mut Curvature) {
        match self {
            ConstraintTerm::Length(term) => term.curvature(at, lambda, out),
            ConstraintTerm::Coincide(term) => term.curvature(at, lambda, out),
            ConstraintTerm::Other(term) => term.curvature(at, lambda, out),
        }
    }

    /// What it is counted as.
    pub fn effect(&self) -> Effect {
        Constraint::effect(&**self)
    }
}

impl std::ops::Deref for ConstraintTerm {
    type Target = dyn Constraint;

    fn deref(&self) -> &(dyn Constraint + 'static) {
        match self {
            ConstraintTerm::Length(term) => term,
            ConstraintTerm::Coincide(term) => term,
            ConstraintTerm::Other(term) => &**term,
        }
    }
}

/// A mass matrix on some coordinates, row by row.
#[derive(Debug)]
pub struct Inertia {
    /// The coordinates.
    pub coordinates: Vec<usize>,
    /// The matrix.
    pub values: Vec<f64>,
    /// Gravity field on these coordinates: g on positions, zero on slopes and angles \[m/s2\].
    pub field: Vec<f64>,
}

impl Inertia {
    /// Mass and moment of inertia on x, y, theta.
    pub fn of_pose(pose: [usize; 3], m: f64, i: f64, g: [f64; 2]) -> Inertia {
        Inertia {
            coordinates: pose.to_vec(),
            values: vec![m, 0.0, 0.0, 0.0, m, 0.0, 0.0, 0.0, i],
            field: vec![g[0], g[1], 0.0],
        }
    }

    /// m (x) I_2 on the positions and slopes that start at `firsts`; gravity acts on the positions.
    pub fn planar<const N: usize>(
        m: [[f64; N]; N],
        firsts: [usize; N],
        positions: [bool; N],
        g: [f64; 2],
    ) -> Inertia {
        let coordinates = firsts.iter().flat_map(|&x| [x, x + 1]).collect();
        let mut values = vec![0.0; 4 * N * N];
        for a in 0..N {
            for b in 0..N {
                for i in 0..2 {
                    values[(2 * a + i) * 2 * N + 2 * b + i] = m[a][b];
                }
            }
        }
        let field = |position: &bool| if *position { g } else { [0.0; 2] };
        Inertia {
            coordinates,
            values,
            field: positions.iter().flat_map(field).collect(),
        }
    }
}

/// Terms of a joint, by index in the list of their kind.
#[derive(Debug, Clone, Copy)]
pub struct JointTerms {
    /// What carries its force.
    pub force: ForceTerm,
    /// What holds an angle.
    pub couple: Option<CoupleTerm>,
    /// Directions whose angle a motion prescribes.
    pub turned: Option<[Spin; 2]>,
    /// The line on which its second point stays or nearly stays.
    pub slide: Option<Slide>,
}

impl JointTerms {
    /// A joint with a force alone.
    pub fn of(force: ForceTerm) -> JointTerms {
        JointTerms {
            force,
            couple: None,
            turned: None,
            slide: None,
        }
    }
}

/// The term that carries the couple of a joint.
#[derive(Debug, Clone, Copy)]
pub enum CoupleTerm {
    /// A constraint of directions.
    Constraint(usize),
    /// None: the angle is known.
    Eliminated,
}

/// The term that carries the force of a joint.
#[derive(Debug, Clone, Copy)]
pub enum ForceTerm {
    /// A constraint.
    Constraint(usize),
    /// A contact.
    Contact(usize),
    /// None: the joint shares or eliminates coordinates.
    Eliminated,
}

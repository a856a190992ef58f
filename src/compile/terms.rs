//! Terms of the equations before they have a place there.

use crate::constraint::Slide;
use crate::contact::ContactPair;
use crate::effect::Effect;
use crate::force::Force;
use crate::link::AncfCable;
use crate::marker::Spin;
use crate::model::{ConstraintTerm, Inertia};
use crate::scene::Span;

/// A constraint before it has slots.
pub(super) struct Row {
    pub term: ConstraintTerm,
    pub effect: Effect,
    /// One name a row.
    pub names: Vec<String>,
    /// Bodies of its two sides.
    pub sides: [usize; 2],
    /// Its place in the scene file.
    pub span: Span,
}

/// Terms before they have slots: kind and coordinates.
#[derive(Default)]
pub(super) struct Terms {
    pub inertia: Vec<Inertia>,
    pub elements: Vec<(AncfCable, Vec<usize>)>,
    pub rows: Vec<Row>,
    /// With the bodies of its two sides.
    pub forces: Vec<(Box<dyn Force>, [usize; 2])>,
    pub named_forces: Vec<(String, usize)>,
    pub contacts: Vec<Box<dyn ContactPair>>,
    /// Angle memories.
    pub angles: usize,
}

impl Terms {
    /// Adds a constraint whose rows are called `name` and what `parts` says; returns its index.
    pub fn constrain(
        &mut self,
        term: ConstraintTerm,
        effect: Effect,
        name: &str,
        parts: &[&str],
        sides: [usize; 2],
        span: Span,
    ) -> usize {
        debug_assert_eq!(parts.len(), term.rows());
        let names = parts.iter().map(|part| match *part {
            "" => name.to_owned(),
            part => format!("{name} ({part})"),
        });
        self.rows.push(Row {
            names: names.collect(),
            term,
            effect,
            sides,
            span,
        });
        self.rows.len() - 1
    }
}

/// Terms of a joint, by index in the list of their kind.
#[derive(Debug, Clone, Copy)]
pub(super) struct JointTerms {
    pub force: ForceTerm,
    /// Constraint of directions.
    pub couple: Option<usize>,
    /// Directions whose angle a motion prescribes.
    pub turned: Option<[Spin; 2]>,
    /// The line of a prismatic joint.
    pub slide: Option<Slide>,
}

/// The term that carries the force of a joint.
#[derive(Debug, Clone, Copy)]
pub(super) enum ForceTerm {
    Constraint(usize),
    Contact(usize),
    /// None: the joint shares or eliminates coordinates.
    Eliminated,
}

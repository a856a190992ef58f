//! A joint held together by multipliers of its own.

use crate::interaction::{JointEnds, JointModel};
use crate::terms::{JointTerms, Terms};
use std::sync::Arc;

/// An ideal joint whose force is the multiplier of a constraint, also where its bodies could share a node.
#[derive(Debug)]
pub(super) struct Pin {
    ideal: Arc<dyn JointModel>,
}

impl Pin {
    /// Of an ideal joint.
    pub fn of(ideal: Arc<dyn JointModel>) -> Arc<dyn JointModel> {
        Arc::new(Pin { ideal })
    }
}

/// It neither coincides nor leaves a coordinate, so that nothing is eliminated.
impl JointModel for Pin {
    fn is_revolute(&self) -> bool {
        self.ideal.is_revolute()
    }

    fn angle(&self) -> Option<f64> {
        self.ideal.angle()
    }

    fn line(&self) -> Option<f64> {
        self.ideal.line()
    }

    fn terms(&self, ends: &JointEnds, terms: &mut Terms) -> JointTerms {
        self.ideal.terms(ends, terms)
    }
}

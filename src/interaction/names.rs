//! What the tables of interactions can name: points of bodies, joints.

use super::Joint;
use crate::body::{Body, PointRef};
use crate::document::{Field, Fields, SceneError};
use crate::motion::FunctionReader;
use indexmap::IndexMap;
use std::collections::HashMap;
use std::sync::Arc;

/// The label of a point without direction.
pub(crate) const NO_DIRECTION: &str = "a point has no direction";

/// The bodies and joints read so far.
#[derive(Debug)]
pub struct Names<'a> {
    /// Bodies.
    pub bodies: &'a IndexMap<String, Arc<dyn Body>>,
    /// Joints.
    pub joints: &'a IndexMap<String, Joint>,
    /// What reads functions of time.
    pub functions: &'a FunctionReader,
    /// Indices of the points of all bodies.
    points: HashMap<(usize, &'a str), usize>,
}

impl<'a> Names<'a> {
    /// The names of bodies and joints.
    pub fn new(
        bodies: &'a IndexMap<String, Arc<dyn Body>>,
        joints: &'a IndexMap<String, Joint>,
        functions: &'a FunctionReader,
    ) -> Names<'a> {
        let points = bodies.values().enumerate().flat_map(|(b, body)| {
            let points = body.points().iter().enumerate();
            points.map(move |(index, point)| ((b, point.name.as_str()), index))
        });
        Names {
            bodies,
            joints,
            functions,
            points: points.collect(),
        }
    }

    /// The point that a field names as `"body.point"`.
    ///
    /// # Errors
    /// There is no such body or point.
    pub fn point(&self, field: &Field) -> Result<PointRef, SceneError> {
        let text = field.text()?;
        let Some((body, point)) = text.split_once('.') else {
            let message = format!("`{}` must be \"body.point\", not \"{text}\"", field.path);
            return Err(field.fault(message, "no `.` here"));
        };
        let Some((index, _, found)) = self.bodies.get_full(body) else {
            return Err(field.dangling("body", body, self.bodies.keys().map(String::as_str)));
        };
        match self.points.get(&(index, point)) {
            Some(&point) => Ok(PointRef { body: index, point }),
            None => {
                let kind = format!("point of `{body}` called");
                let names = found.points().iter().map(|p| p.name.as_str());
                Err(field.dangling(&kind, point, names))
            }
        }
    }

    /// As [`Names::point`], of a body that has a direction.
    ///
    /// # Errors
    /// There is no such point, or it belongs to a point mass.
    pub fn turning_point(&self, field: &Field) -> Result<PointRef, SceneError> {
        let point = self.point(field)?;
        self.check_turns(field, point)?;
        Ok(point)
    }

    /// Refuses a point whose body has no direction.
    ///
    /// # Errors
    /// The body is a point mass.
    pub fn check_turns(&self, field: &Field, point: PointRef) -> Result<(), SceneError> {
        match self.directionless(field, point) {
            Some(message) => Err(field.fault(message, NO_DIRECTION)),
            None => Ok(()),
        }
    }

    /// What is wrong where a field needs the direction at a point that has none.
    pub(crate) fn directionless(&self, field: &Field, point: PointRef) -> Option<String> {
        let (name, body) = self.bodies.get_index(point.body)?;
        let message = format!(
            "`{}` needs the direction of {name}, but a point mass has none",
            field.path
        );
        (!body.turns()).then_some(message)
    }

    /// The two ends of a force that acts along their line.
    ///
    /// # Errors
    /// There are no such points, or they are the same.
    pub fn two_points(&self, table: &Fields) -> Result<[PointRef; 2], SceneError> {
        let (from, to_field) = (table.field("from")?, table.field("to")?);
        let [from_point, to] = [self.point(&from)?, self.point(&to_field)?];
        if from_point == to {
            let message = format!("`{}` joins a point to itself", table.path());
            return Err(to_field.fault(message, "the same point"));
        }
        Ok([from_point, to])
    }

    /// The revolute joint that a field names: its index.
    ///
    /// # Errors
    /// There is no such joint, or one of its bodies has no direction; `otherwise` says what follows if it is not revolute.
    pub fn revolute(&self, field: &Field, otherwise: &str) -> Result<usize, SceneError> {
        let (index, joint) = field.lookup("joint", self.joints)?;
        if !joint.model.is_revolute() {
            let message = format!("the joint `{}` is not revolute{otherwise}", joint.name);
            return Err(field.fault(message, "its bodies do not turn freely"));
        }
        Ok(index)
    }
}

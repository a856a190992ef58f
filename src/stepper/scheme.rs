//! Kinds of integration schemes, with the parameters that a scene gives them.

use super::Stepper;
use crate::system::Shape;
use std::fmt;

/// A parameter of a scheme: a number in a range.
#[derive(Debug)]
pub struct Parameter {
    /// Its key in a scene.
    pub name: &'static str,
    /// Ends of its range.
    pub range: [f64; 2],
    /// True if the ends belong to the range.
    pub closed: bool,
    /// What holds without it; a scene has to give a parameter that has none.
    pub default: Option<&'static str>,
    /// What it is.
    pub purpose: &'static str,
}

/// A kind of integration scheme.
pub struct Scheme {
    /// Its name in a scene.
    pub name: &'static str,
    /// Its order: the global error is proportional to this power of the step.
    pub order: u32,
    /// True for a scheme without equations to solve in a stage, which needs no tolerance of Newton's method.
    pub is_explicit: bool,
    /// True for a scheme that keeps constraints. Its steps end with velocities, accelerations and multipliers that satisfy them on
    /// the levels of velocity and acceleration ([`crate::newton::Newton::make_consistent`]).
    pub keeps_constraints: bool,
    /// Its parameters, [`MOST`] at most.
    pub parameters: &'static [Parameter],
    /// The scheme with its memory for a system; the method gives the parameters.
    pub build: fn(&Method, Shape) -> Box<dyn Stepper>,
}

impl fmt::Debug for Scheme {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(self.name)
    }
}

/// Most parameters of a scheme.
pub const MOST: usize = 4;

/// A scheme with values of its parameters.
#[derive(Debug, Clone, Copy)]
pub struct Method {
    /// The scheme.
    pub scheme: &'static Scheme,
    values: [Option<f64>; MOST],
}

impl PartialEq for Method {
    fn eq(&self, other: &Method) -> bool {
        self.name() == other.name() && self.values == other.values
    }
}

impl Method {
    /// The scheme without values.
    pub const fn new(scheme: &'static Scheme) -> Method {
        Method {
            scheme,
            values: [None; MOST],
        }
    }

    /// The same with a value of a parameter. The scheme must have it.
    #[must_use]
    pub fn with(mut self, parameter: &str, value: f64) -> Method {
        let place = self.place(parameter);
        let place = place.unwrap_or_else(|| panic!("{} has no {parameter}", self.name()));
        self.values[place] = Some(value);
        self
    }

    /// The value of a parameter, if the scheme has it and a value is given.
    pub fn get(&self, parameter: &str) -> Option<f64> {
        self.values[self.place(parameter)?]
    }

    fn place(&self, parameter: &str) -> Option<usize> {
        let parameters = self.scheme.parameters;
        parameters.iter().position(|p| p.name == parameter)
    }

    /// The name of the scheme in a scene.
    pub fn name(&self) -> &'static str {
        self.scheme.name
    }

    /// The scheme with its memory for a system of this shape.
    pub fn stepper(&self, shape: Shape) -> Box<dyn Stepper> {
        (self.scheme.build)(self, shape)
    }
}

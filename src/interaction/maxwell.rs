//! `type = "maxwell"`: a spring and a damper in series between two points.

use super::spring_damper::LineOfAction;
use super::{Ends, ForceKind, ForceModel, SpringDamper, SpringDamperModel};
use crate::body::PointRef;
use crate::document::Key;
use crate::effect::Effect;
use crate::force::{Force, LocalMatrix, WIDTH};
use crate::ledger::{self, Entry, Powers};
use crate::system::{InternalState, State, Weights};
use std::sync::Arc;

pub(super) static KIND: ForceKind = ForceKind {
    name: "maxwell",
    keys: &[
        Key::point("from", "one end"),
        Key::point("to", "the other end"),
        Key::positive("stiffness", "N/m", "the stiffness of the spring"),
        Key::positive("damping", "N s/m", "the damping of the damper"),
        Key::non_negative(
            "rest_length",
            "m",
            "the length without force, the damper pushed in",
        ),
        Key::number(
            "elongation",
            "m",
            "how far the damper is drawn out at the start",
        )
        .or("0"),
    ],
    read: |table, names| {
        let [from, to] = names.two_points(table)?;
        let spring = SpringDamper {
            from,
            to,
            stiffness: table.number("stiffness")?,
            damping: 0.0,
            rest_length: table.number("rest_length")?,
        };
        Ok(Arc::new(MaxwellModel {
            spring,
            damping: table.number("damping")?,
            elongation: table.optional_number("elongation")?.unwrap_or(0.0),
        }))
    },
};

/// A Maxwell element as a scene describes it.
#[derive(Debug, Clone, Copy)]
pub struct MaxwellModel {
    /// The spring, with the rest length where the damper is pushed in.
    pub spring: SpringDamperModel,
    /// Damping of the damper \[N s/m\].
    pub damping: f64,
    /// Elongation of the damper at the start \[m\].
    pub elongation: f64,
}

impl ForceModel for MaxwellModel {
    fn points(&self) -> Vec<PointRef> {
        self.spring.points()
    }

    fn states(&self) -> Vec<InternalState> {
        vec![InternalState {
            name: "elongation",
            unit: "m",
            metres: 1.0,
            is_stiff: false,
        }]
    }

    fn term(&self, ends: &Ends) -> (Box<dyn Force>, [usize; 2]) {
        let (spring, bodies) = self.spring.place(ends);
        let term = Maxwell {
            spring,
            damping: self.damping,
            elongation: ends.states[0],
            start: self.elongation,
        };
        (Box::new(term), bodies)
    }
}

/// Pull N = k (L - L_0 - z) along the line between two points, c dz/dt = N.
#[derive(Debug, Clone, Copy)]
pub struct Maxwell {
    /// The spring, with the rest length at z = 0.
    pub spring: SpringDamper,
    /// c \[N s/m\].
    pub damping: f64,
    /// Index of the internal state, whose velocity is z \[m\].
    pub elongation: usize,
    /// z at t = 0 \[m\].
    pub start: f64,
}

impl Maxwell {
    /// The spring at the elongation that the damper has.
    fn at(&self, at: &State) -> SpringDamper {
        SpringDamper {
            rest_length: self.spring.rest_length + at.v[self.elongation],
            ..self.spring
        }
    }

    /// Local index of the internal state.
    fn place(&self) -> usize {
        self.spring.ends().width()
    }

    /// N \[N\] and the line it acts along.
    fn pull(&self, at: &State) -> (f64, LineOfAction) {
        let spring = self.at(at);
        let line = spring.line(at);
        (spring.pull(&line), line)
    }
}

impl Force for Maxwell {
    fn effect(&self) -> Effect {
        "maxwell"
    }

    fn sides(&self) -> [Vec<usize>; 2] {
        let [from, mut to] = self.spring.sides();
        to.push(self.elongation);
        [from, to]
    }

    fn force(&self, at: &State, f: &mut [f64; WIDTH]) {
        let (pull, line) = self.pull(at);
        SpringDamper::pull_ends(&line, pull, f);
        f[self.place()] -= pull / self.damping;
    }

    fn force_and_tangent(&self, at: &State, w: Weights, f: &mut [f64; WIDTH], k: &mut LocalMatrix) {
        let (pull, line) = self.pull(at);
        let (stiffness, z) = (self.spring.stiffness, self.place());
        SpringDamper::pull_ends(&line, pull, f);
        f[z] -= pull / self.damping;
        self.at(at).tangent(at, w, &line, k);
        // N depends on q through L, whose gradient is n^T de/dq, and on z
        for (c, along) in line.along[..z].iter().enumerate() {
            k[c][z] -= w.v * stiffness * along;
            k[z][c] -= w.q * stiffness * along / self.damping;
        }
        k[z][z] += w.v * stiffness / self.damping;
    }

    fn begin(&self, at: &mut State) {
        at.v[self.elongation] = self.start;
    }

    fn stores_energy(&self) -> bool {
        true
    }

    fn fault(&self, at: &State) -> Option<&'static str> {
        self.at(at).fault(at)
    }

    fn energy(&self, at: &State) -> f64 {
        self.at(at).energy(at)
    }

    fn entries(&self) -> Vec<&'static Entry> {
        vec![&ledger::DAMPING]
    }

    fn powers(&self, at: &State, powers: &mut Powers) {
        let (pull, _) = self.pull(at);
        powers.add(0, pull * pull / self.damping);
    }

    fn quantities(&self) -> &'static [(&'static str, &'static str)] {
        &[("force", "N"), ("length", "m"), ("elongation", "m")]
    }

    fn measure(&self, at: &State) -> [f64; 3] {
        let (pull, line) = self.pull(at);
        [pull, line.length, at.v[self.elongation]]
    }
}

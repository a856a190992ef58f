//! `type = "maxwell"`: a spring and a damper in series between two points.

use super::{Ends, ForceKind, ForceModel, SpringDamper};
use crate::body::PointRef;
use crate::document::Key;
use crate::effect::Effect;
use crate::force::{Force, LocalMatrix, WIDTH};
use crate::system::{INTEGRALS, Integral, State, Weights};
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
        Ok(Arc::new(MaxwellModel {
            from,
            to,
            stiffness: table.number("stiffness")?,
            damping: table.number("damping")?,
            rest_length: table.number("rest_length")?,
            elongation: table.optional_number("elongation")?.unwrap_or(0.0),
        }))
    },
};

/// A Maxwell element as a scene describes it.
#[derive(Debug, Clone, Copy)]
pub struct MaxwellModel {
    /// One end.
    pub from: PointRef,
    /// The other.
    pub to: PointRef,
    /// Stiffness \[N/m\].
    pub stiffness: f64,
    /// Damping \[N s/m\].
    pub damping: f64,
    /// Rest length \[m\].
    pub rest_length: f64,
    /// Elongation of the damper at the start \[m\].
    pub elongation: f64,
}

impl ForceModel for MaxwellModel {
    fn points(&self) -> Vec<PointRef> {
        vec![self.from, self.to]
    }

    fn states(&self) -> &'static [&'static str] {
        &["elongation"]
    }

    fn term(&self, ends: &Ends) -> (Box<dyn Force>, [usize; 2]) {
        let term = Maxwell {
            spring: SpringDamper {
                from: ends.marker(self.from),
                to: ends.marker(self.to),
                stiffness: self.stiffness,
                damping: 0.0,
                rest_length: self.rest_length,
            },
            damping: self.damping,
            elongation: ends.states[0],
            start: self.elongation,
        };
        (Box::new(term), [self.from.body, self.to.body])
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
        self.spring.from.width() + self.spring.to.width()
    }

    /// N \[N\] and L \[m\].
    fn pull(&self, at: &State) -> [f64; 2] {
        let [pull, length, _] = self.at(at).measure(at);
        [pull, length]
    }
}

impl Force for Maxwell {
    fn effect(&self) -> Effect {
        "maxwell"
    }

    fn coordinates(&self) -> Vec<usize> {
        let mut coordinates = self.spring.coordinates();
        coordinates.push(self.elongation);
        coordinates
    }

    fn split(&self) -> usize {
        self.spring.split()
    }

    fn force(&self, at: &State, f: &mut [f64; WIDTH]) {
        self.at(at).force(at, f);
        f[self.place()] -= self.pull(at)[0] / self.damping;
    }

    fn force_and_tangent(&self, at: &State, w: Weights, f: &mut [f64; WIDTH], k: &mut LocalMatrix) {
        let spring = self.at(at);
        spring.force_and_tangent(at, w, f, k);
        let (z, stiffness) = (self.place(), spring.stiffness);
        f[z] -= self.pull(at)[0] / self.damping;
        // N depends on q through L, whose gradient is n^T de/dq, and on z
        for (c, along) in spring.line(at).along[..z].iter().enumerate() {
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

    fn powers(&self, at: &State, powers: &mut [f64; INTEGRALS]) {
        let [pull, _] = self.pull(at);
        powers[Integral::DampingDissipated as usize] += pull * pull / self.damping;
    }

    fn quantities(&self) -> &'static [(&'static str, &'static str)] {
        &[("force", "N"), ("length", "m"), ("elongation", "m")]
    }

    fn measure(&self, at: &State) -> [f64; 3] {
        let [pull, length] = self.pull(at);
        [pull, length, at.v[self.elongation]]
    }
}

//! Instants at which what is given as a function of time is not smooth.

use super::{Model, Rule};
use crate::motion::Knot;

/// An instant at which a step ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Instant {
    /// The last time \[s\] at which the functions of before hold, and the first one at which those of after do.
    pub sides: [f64; 2],
    /// What happens.
    pub kind: InstantKind,
}

/// What happens at an instant.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum InstantKind {
    /// Accelerations jump.
    Jump,
    /// Loads have a kink.
    Kink,
    /// A higher derivative jumps.
    Knot,
}

impl Model {
    /// The instants from zero to a time \[s\], in their order.
    pub(crate) fn find_instants(&self, until: f64) -> Vec<Instant> {
        let loads = self.forces.iter().flat_map(|f| f.term.knots(until));
        let loads = loads.map(|knot| Instant::of(knot, [InstantKind::Jump, InstantKind::Kink]));
        let motions = self.motion_knots(until).into_iter();
        let motions = motions.map(|knot| Instant::of(knot, [InstantKind::Jump; 3]));
        let within = |instant: &Instant| instant.end() > 0.0 && instant.end() < until;
        let mut instants: Vec<Instant> = loads.chain(motions).filter(within).collect();
        instants.sort_by(|a, b| {
            let times = a.sides[1].total_cmp(&b.sides[1]);
            times.then(a.kind.cmp(&b.kind))
        });
        // the gravest of those at one time
        instants.dedup_by(|b, a| a.sides[1] == b.sides[1]);
        instants
    }

    /// The knots of prescribed motions.
    pub(crate) fn motion_knots(&self, until: f64) -> Vec<Knot> {
        let rules = self.rules.iter().flat_map(|rule| match rule {
            Rule::Path { path, .. } => path.knots(until),
            Rule::Turn { angle, .. } => angle.knots(until),
        });
        let constraints = self.constraints.iter().flat_map(|c| c.term.knots(until));
        let followed = self
            .prescribed
            .iter()
            .flat_map(|motion| motion.knots(until));
        rules.chain(constraints).chain(followed).collect()
    }
}

impl Instant {
    /// Where the step before it ends \[s\].
    pub fn end(&self) -> f64 {
        match self.kind {
            InstantKind::Jump => self.sides[0],
            InstantKind::Kink | InstantKind::Knot => self.sides[1],
        }
    }

    /// The instant of a knot: by the level that jumps one of `kinds`, or one of a higher derivative.
    fn of<const N: usize>(knot: Knot, kinds: [InstantKind; N]) -> Instant {
        Instant {
            sides: knot.sides,
            kind: kinds.get(knot.level).copied().unwrap_or(InstantKind::Knot),
        }
    }
}

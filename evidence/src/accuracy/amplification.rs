//! How much a motion amplifies the errors of its steps.
//!
//! An error of a step is one of velocity, dv, which in free flight carries the mechanism d = H max|dv| away within the
//! horizon H, or one of position, d = max|dq|. Neighbouring motions leave the motion with the one or the other. The
//! amplification is the largest distance of positions later on, over d. To stay neighbouring, a motion whose distance is
//! more than [`BROUGHT_BACK`] d is brought back to d along the line between the two, and the factors are multiplied
//! (Benettin et al. 1980, DOI 10.1007/BF02128236).

use crate::accuracy::guarantee::{ROWS, loose};
use looselink::scene::Scene;
use looselink::simulate::{Recording, RunError, Simulation};
use looselink::system::State;
use paper_figures::exponents::{apart, bring_back};

/// Neighbouring motions of a scene without and with loose joints, every other one displaced in position. Each has another
/// direction; the first leaves the motion at the start, the others later, up to half of the horizon: an impact may take away
/// what came before it.
pub const NEIGHBOURS: [usize; 2] = [2, 16];
/// Displacement over the accuracy of both motions: far above what their steps add to it.
const DISPLACED: f64 = 100.0;
/// Steps of a displaced motion, over those of a reference, that are too many.
const MORE_STEPS: u64 = 4;
/// Part of a displacement below which what the joints leave of it is rounding.
const LEAST: f64 = 1e-6;
/// Distance at which a motion is brought back, over the displacement.
const BROUGHT_BACK: f64 = 10.0;

/// The largest amplification of any neighbouring motion; `steps` are those of a reference. It is 0 where drives leave nothing
/// to displace; none where a motion does not come to the end.
///
/// # Errors
/// A scene that cannot start.
pub fn amplification(scene: &Scene, position: f64, steps: u64) -> miette::Result<Option<f64>> {
    let motion = Simulation::new(scene)?;
    let count = NEIGHBOURS[usize::from(loose(scene))];
    let mut neighbours = Vec::new();
    for k in 0..count {
        neighbours.push(Neighbour {
            next: motion.state().clone(),
            simulation: Simulation::new(scene)?,
            leaves: k * ROWS / (2 * count),
            velocities: directions(&motion, k),
            displacement: 0.0,
            factor: 1.0,
            of_position: k % 2 == 1,
        });
    }
    Ok(largest(scene, motion, neighbours, DISPLACED * position, steps).ok())
}

fn largest(
    scene: &Scene,
    mut motion: Simulation,
    mut neighbours: Vec<Neighbour>,
    displacement: f64,
    steps: u64,
) -> Result<f64, RunError> {
    let horizon = scene.simulation.duration;
    // it bounds the steps of all motions together
    let mut limit = Recording::new(&motion);
    limit.most_steps = MORE_STEPS * steps * (1 + neighbours.len() as u64);
    let mut largest = 0.0_f64;
    for row in 0..=ROWS {
        let t = horizon * row as f64 / ROWS as f64;
        motion.advance_to(t, &mut limit)?;
        for neighbour in &mut neighbours {
            neighbour.simulation.advance_to(t, &mut limit)?;
            if row == neighbour.leaves {
                neighbour.leave(&motion, displacement / horizon)?;
                let left = horizon * neighbour.distance(|i| neighbour.faster(&motion, i));
                neighbour.displacement = if left > LEAST * displacement {
                    left
                } else {
                    0.0
                };
            } else if neighbour.displacement > 0.0
                && neighbour.of_position
                && row == neighbour.leaves + 1
            {
                // what a row makes of a velocity is a displacement that the joints allow
                let way = neighbour.distance(|i| neighbour.apart(&motion, i));
                neighbour.displacement = displacement;
                neighbour.bring_back(&motion, [displacement / way, 0.0])?;
            } else if neighbour.displacement > 0.0 {
                largest = largest.max(neighbour.grown(&motion)?);
            }
        }
    }
    Ok(largest)
}

/// Unknowns that are coordinates x or y, each with the part of a velocity along it; points of one body have the same. A mechanism
/// without them, such as a pendulum, is displaced by its angles, in radians: their distances are only compared with each other.
fn directions(motion: &Simulation, k: usize) -> Vec<(usize, f64)> {
    let names = &motion.model().unknown_names()[..motion.model().shape().unknowns];
    let body = |name: &str| name.split('.').next().map(str::to_owned);
    let mut bodies: Vec<_> = names.iter().map(|name| body(name)).collect();
    bodies.dedup();
    let places = names
        .iter()
        .enumerate()
        .filter(|(_, name)| !name.contains(".slope."));
    let parts = places.filter_map(|(i, name)| {
        let number = bodies.iter().position(|b| *b == body(name))?;
        let (sin, cos) = (1.0 + (7 * number + k) as f64).sin_cos();
        let part = [(".x", cos), (".y", sin)]
            .into_iter()
            .find(|(axis, _)| name.ends_with(axis))?;
        Some((i, part.1))
    });
    let parts: Vec<(usize, f64)> = parts.collect();
    if parts.is_empty() {
        return (0..names.len()).map(|i| (i, 1.0)).collect();
    }
    parts
}

struct Neighbour {
    simulation: Simulation,
    next: State,
    /// Row at which it leaves the motion.
    leaves: usize,
    velocities: Vec<(usize, f64)>,
    /// d \[m\]; 0 before it has left and where nothing can be displaced.
    displacement: f64,
    /// Product of what its distance has been divided by.
    factor: f64,
    of_position: bool,
}

impl Neighbour {
    /// Leaves with this velocity, of which the joints may take a part away.
    fn leave(&mut self, motion: &Simulation, velocity: f64) -> Result<(), RunError> {
        self.next.copy_from(motion.state());
        for (i, part) in &self.velocities {
            self.next.v[*i] += velocity * part;
        }
        self.simulation.continue_from(&self.next)
    }

    fn distance(&self, apart: impl Fn(usize) -> f64) -> f64 {
        self.velocities
            .iter()
            .map(|(i, _)| apart(*i).abs())
            .fold(0.0, f64::max)
    }

    fn faster(&self, motion: &Simulation, i: usize) -> f64 {
        self.simulation.state().v[i] - motion.state().v[i]
    }

    fn apart(&self, motion: &Simulation, i: usize) -> f64 {
        apart(motion.state(), self.simulation.state(), i)
    }

    /// The amplification so far; a motion that has gone far is brought back.
    fn grown(&mut self, motion: &Simulation) -> Result<f64, RunError> {
        let grown = self.distance(|i| self.apart(motion, i)) / self.displacement;
        let amplification = self.factor * grown;
        if grown > BROUGHT_BACK {
            self.factor = amplification;
            self.bring_back(motion, [1.0 / grown; 2])?;
        }
        Ok(amplification)
    }

    /// Goes on from so many times the distances of coordinates and of velocities.
    fn bring_back(&mut self, motion: &Simulation, factors: [f64; 2]) -> Result<(), RunError> {
        let (one, other) = (motion.state(), self.simulation.state());
        let unknowns = motion.model().shape().unknowns;
        bring_back(&mut self.next, one, other, unknowns, factors);
        self.simulation.continue_from(&self.next)
    }
}

#[cfg(test)]
mod tests {
    use super::amplification;
    use looselink::scene::Scene;
    use records::root;

    /// It has no coordinate but an angle. A displacement first stays as it is: the torque of its weight hardly changes with the
    /// angle near the horizontal.
    #[test]
    fn a_pendulum_is_displaced_by_its_angle() -> miette::Result<()> {
        let short = [
            "simulation.duration=0.1",
            "output.interval=0.002",
            "integrator.method=dormand_prince",
            "integrator.accuracy={ position = 1e-8, horizon = 0.1 }",
        ]
        .map(str::to_owned);
        let scene = Scene::load(&root().join("scenes/pendulum.toml"), &short)?;
        let found = amplification(&scene, 1e-8, 1000)?;
        assert!(found.is_some_and(|a| (a - 1.0).abs() < 0.1), "{found:?}");
        Ok(())
    }
}

//! What a run does that no machine does, seen at its rows.

use crate::checkpoint::carried;
use crate::ledger::OF_WORK;
use crate::model::Model;
use crate::scene::Scene;
use crate::system::State;
use numbers::number;

/// Largest power \[W\]: that of a large power station.
const POWER: f64 = 1e9;

/// What is seen of a run.
#[derive(Debug, Clone, Copy)]
pub(super) struct Plausibility {
    /// Time \[s\] of the last row, and work of drives and loads until then \[J\].
    last: [f64; 2],
    /// Largest mean power between two rows \[W\].
    power: f64,
    /// Largest distance of the driven body from its prescribed position \[m\].
    off: f64,
    /// The box of its path.
    least: [f64; 2],
    most: [f64; 2],
}

carried!(Plausibility { last, power, off, least, most } but {});

impl Default for Plausibility {
    fn default() -> Plausibility {
        Plausibility {
            last: [0.0; 2],
            power: 0.0,
            off: 0.0,
            least: [f64::INFINITY; 2],
            most: [f64::NEG_INFINITY; 2],
        }
    }
}

impl Plausibility {
    /// Sees the state of a row.
    pub fn row(&mut self, scene: &Scene, model: &Model, at: &State) {
        let work = at.integrals[OF_WORK];
        let [t, before] = std::mem::replace(&mut self.last, [at.t, work]);
        if at.t > t {
            self.power = self.power.max((work - before).abs() / (at.t - t));
        }
        let driven = scene.drives.first().map(|drive| drive.body);
        let Some((body, path)) = driven.and_then(|b| Some((b, model.prescribed(b, at)?))) else {
            return;
        };
        let [x, y, _] = model.pose(body, at).position;
        let [path_x, path_y, _] = path.position;
        self.off = self.off.max((x - path_x).hypot(y - path_y));
        for (axis, p) in [path_x, path_y].into_iter().enumerate() {
            self.least[axis] = self.least[axis].min(p);
            self.most[axis] = self.most[axis].max(p);
        }
    }

    /// What no machine does, each with its value and a question.
    pub fn told(&self, scene: &Scene) -> Vec<String> {
        let mut told = Vec::new();
        if self.power > POWER {
            told.push(format!(
                "drives and loads supply or take {} W between two rows, as much as a large power station: are these SI units?",
                number(self.power, 2)
            ));
        }
        let size = (self.most[0] - self.least[0]).hypot(self.most[1] - self.least[1]);
        if let Some(drive) = scene.drives.first()
            && size > 0.0
            && self.off > size
        {
            told.push(format!(
                "{} is up to {} m off its path, which is only {} m large: it does not follow the path. Check stiffnesses and clearances",
                scene.bodies[drive.body].name,
                number(self.off, 2),
                number(size, 2)
            ));
        }
        told
    }
}

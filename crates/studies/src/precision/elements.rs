//! What the number of elements does to error and time.
//!
//! Few elements and a long step may err to opposite sides; then a run comes nearer to the reference than its mesh allows, by
//! luck. So a point keeps an error only when all finer points of its curve keep it too, and what the finest point keeps is
//! the floor of the mesh.

use super::{Study, StudyOutcome, StudyPace};
use numbers::si;
use plot::{Axis, Color, Mark, Panel, palette};

/// A floor counts as reached within this factor.
const NEAR: f64 = 2.0;
/// Order of the positions of cubic elements.
const ORDER: i32 = 4;
/// The lightest line; finer paces are darker.
const LIGHT: Color = (190, 190, 210);

/// All numbers of elements of a study.
pub(super) struct Meshes(Vec<Mesh>);

/// A number of elements, with its points from coarse to fine.
struct Mesh {
    elements: usize,
    color: Color,
    points: Vec<MeshPoint>,
}

struct MeshPoint {
    pace: StudyPace,
    /// Processor time \[s\].
    seconds: f64,
    /// Error of position \[m\].
    error: f64,
    /// The largest error of this point and all finer ones \[m\].
    kept: f64,
}

impl Meshes {
    pub fn new(study: &Study, outcome: &StudyOutcome) -> Meshes {
        let meshes = study.curves.iter().filter_map(|curve| {
            let runs = outcome.runs.iter().zip(&outcome.timings);
            let runs = runs.filter(|(run, _)| run.curve == curve.name);
            let points = runs.filter_map(|(run, timing)| {
                let error = run.result.as_ref().ok()?.errors.position;
                Some(MeshPoint {
                    pace: run.pace,
                    seconds: timing.as_ref()?.median,
                    error,
                    kept: error,
                })
            });
            let mut points: Vec<MeshPoint> = points.collect();
            for i in (1..points.len()).rev() {
                points[i - 1].kept = points[i - 1].kept.max(points[i].kept);
            }
            Some(Mesh {
                elements: curve.elements?,
                color: outcome.color(&curve.name),
                points,
            })
        });
        Meshes(meshes.filter(|mesh| !mesh.points.is_empty()).collect())
    }

    /// Draws the least time for every error behind the curves of a panel of errors over time, and notes whose it is.
    pub fn mark_cheapest(&self, panel: &mut Panel) {
        let meshes = self.0.iter();
        let mut points: Vec<(usize, &MeshPoint)> = meshes
            .flat_map(|mesh| mesh.points.iter().map(|point| (mesh.elements, point)))
            .collect();
        points.sort_by(|a, b| a.1.seconds.total_cmp(&b.1.seconds));
        let (mut x, mut y) = (Vec::new(), Vec::new());
        let mut ranges: Vec<(usize, f64)> = Vec::new();
        let mut least = f64::INFINITY;
        for (elements, point) in points {
            if point.kept >= least {
                continue;
            }
            if least.is_finite() {
                x.push(point.seconds);
                y.push(least);
            }
            x.push(point.seconds);
            y.push(point.kept);
            least = point.kept;
            match ranges.last_mut() {
                Some((last, error)) if *last == elements => *error = least,
                _ => ranges.push((elements, least)),
            }
        }
        let cheapest = Mark::curve("least time for an error", LIGHT, &x, &y);
        panel.marks.insert(0, cheapest.width(14));
        let ranges = ranges
            .iter()
            .map(|(n, error)| format!("{n} down to {}", si(*error, "m")));
        panel.note = format!(
            "Cheapest number of elements: {}.",
            ranges.collect::<Vec<String>>().join(", then ")
        );
    }

    /// Errors over the number of elements, one line a step or accuracy.
    pub fn errors(&self) -> Panel {
        let mut paces: Vec<StudyPace> = Vec::new();
        for point in self.0.iter().flat_map(|mesh| &mesh.points) {
            if !paces.contains(&point.pace) {
                paces.push(point.pace);
            }
        }
        let mut marks = Vec::new();
        for (k, pace) in paces.iter().enumerate() {
            let found = self.0.iter().filter_map(|mesh| {
                let point = mesh.points.iter().find(|point| point.pace == *pace)?;
                Some((mesh.elements as f64, point.error))
            });
            let (x, y): (Vec<f64>, Vec<f64>) = found.unzip();
            let shade = shade((k + 1) as f64 / paces.len() as f64);
            marks.push(Mark::curve("", shade, &x, &y));
            marks.push(Mark::points(&pace.to_string(), shade, &x, &y, 8));
        }
        if let [.., coarse, fine] = &self.0[..] {
            let [n, m] = [coarse, fine].map(|mesh| mesh.elements as f64);
            let floor = fine.floor();
            let guide = [floor * (m / n).powi(ORDER), floor];
            let label = format!("order {ORDER}");
            marks.push(Mark::curve(&label, palette::VERMILION, &[n, m], &guide));
        }
        Panel {
            title: "Error of position against elements".into(),
            note: "Black: the finest step, whose error is the floor of each number of elements."
                .into(),
            x: self.axis(),
            y: Axis::new("Error", "m", 1.0).log(),
            marks,
        }
    }

    /// Times within which every number of elements comes near its floor.
    pub fn times(&self) -> Panel {
        let reached = |mesh: &Mesh| {
            let mut points = mesh.points.iter();
            let near = points.find(|point| point.kept <= NEAR * mesh.floor());
            near.map_or(f64::NAN, |point| point.seconds)
        };
        let x: Vec<f64> = self.0.iter().map(|mesh| mesh.elements as f64).collect();
        let y: Vec<f64> = self.0.iter().map(reached).collect();
        let mut marks = vec![Mark::curve("", palette::GREY, &x, &y)];
        for ((mesh, x), y) in self.0.iter().zip(x).zip(y) {
            let floor = format!("{}: {}", mesh.elements, si(mesh.floor(), "m"));
            marks.push(Mark::points(&floor, mesh.color, &[x], &[y], 11));
        }
        Panel {
            title: format!("Time to reach {NEAR} times the floor"),
            note: "Floor of each number of elements:".into(),
            x: self.axis(),
            y: Axis::new("Processor time", "s", 1.0).log(),
            marks,
        }
    }

    fn axis(&self) -> Axis {
        let numbers = self.0.iter().map(|mesh| mesh.elements as f64);
        Axis::new("Elements per link", "", 1.0).log_at(numbers.collect())
    }
}

impl Mesh {
    /// What its finest point keeps \[m\].
    fn floor(&self) -> f64 {
        self.points.last().map_or(f64::NAN, |point| point.kept)
    }
}

/// Between the lightest line at 0 and black at 1.
fn shade(depth: f64) -> Color {
    let mix = |light: u8, dark: u8| {
        (f64::from(light) + depth * (f64::from(dark) - f64::from(light))).round() as u8
    };
    let ((r, g, b), dark) = (LIGHT, palette::BLACK);
    (mix(r, dark.0), mix(g, dark.1), mix(b, dark.2))
}

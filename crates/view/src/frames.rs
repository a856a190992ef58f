//! A run as a series of SVG pictures, for films and papers.

use super::moved::{Moved, Shape};
use super::stored::StoredRun;
use std::fmt::Write;

/// Width of a picture \[pixels\], and the part of the mechanism's size that is left free around it.
const WIDTH: f64 = 960.0;
const MARGIN: f64 = 0.12;
/// Thickness of bars and radius of joints, relative to the size of the mechanism.
const BAR: f64 = 0.026;
const RING: f64 = 0.014;
const STYLE: &str = "text{font:16px sans-serif}.body{fill:#5b7fb4;stroke:#5b7fb4;stroke-linejoin:round;stroke-linecap:round;\
opacity:.8}.beam{fill:none;stroke:#d2691e;stroke-linecap:round}.ground{fill:#e2e5e9;stroke:#6a737d}\
.joint{fill:#fff;stroke:#24292f}.loose{fill:#fff;stroke:#c2352b}";

/// Pictures at evenly spaced rows, the first and the last among them.
pub fn frames(run: &StoredRun, count: usize) -> Vec<String> {
    let (bodies, bounds) = Moved::all(run);
    let last = run.result.times.len() - 1;
    let intervals = count.saturating_sub(1).max(1);
    let rows = (0..count).map(|k| (k as f64 / intervals as f64 * last as f64).round() as usize);
    rows.map(|row| frame(run, &bodies, bounds, row)).collect()
}

/// The picture of a row.
fn frame(run: &StoredRun, bodies: &[Moved], bounds: [f64; 4], row: usize) -> String {
    let [x0, y0, x1, y1] = bounds;
    let size = (x1 - x0).max(y1 - y0).max(f64::MIN_POSITIVE);
    let margin = MARGIN * size;
    let scale = WIDTH / (x1 - x0 + 2.0 * margin);
    let height = scale * (y1 - y0 + 2.0 * margin);
    let [left, top] = [scale * (margin - x0), scale * (margin + y1)];
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {WIDTH} {height:.2}\"><style>{STYLE}</style>\
        <rect width=\"100%\" height=\"100%\" fill=\"#fff\"/><text x=\"12\" y=\"24\">t = {:.6} s</text>\
        <g transform=\"translate({left:.4} {top:.4}) scale({scale:.6} {:.6})\">\n",
        run.result.times[row], -scale
    );
    let places: Vec<Place> = bodies.iter().map(|body| Place::of(body, row)).collect();
    for (body, place) in bodies.iter().zip(&places) {
        place.draw(&body.shape, size, &mut svg);
    }
    let named = &run.result.scene.bodies;
    for joint in &run.result.scene.joints {
        let end = joint.bearing;
        let class = if joint.contact().is_some() {
            "loose"
        } else {
            "joint"
        };
        let point = &named[end.body].kind.points()[end.point];
        let [x, y] = places[end.body].point(&bodies[end.body].shape, point.at.into());
        // writing to a string cannot fail
        let _ = writeln!(
            svg,
            "<circle class=\"{class}\" cx=\"{x:.6}\" cy=\"{y:.6}\" r=\"{:.6}\" stroke-width=\"{:.6}\"/>",
            RING * size,
            0.3 * RING * size
        );
    }
    svg + "</g></svg>\n"
}

/// A body at a row.
struct Place {
    pose: [f64; 4],
    deviations: Vec<f64>,
}

impl Place {
    fn of(body: &Moved, row: usize) -> Place {
        let value = |track: &Vec<f64>| track.get(row).copied().unwrap_or_default();
        Place {
            pose: std::array::from_fn(|i| value(&body.pose[i])),
            deviations: body.deviations.iter().map(value).collect(),
        }
    }

    /// From the frame of the body to the plane.
    fn carry(&self, [u, w]: [f64; 2]) -> [f64; 2] {
        let [x, y, theta, _] = self.pose;
        let (s, c) = theta.sin_cos();
        [x + c * u - s * w, y + s * u + c * w]
    }

    /// A point of the body; on a flexible link those between the ends are taken on the chord.
    fn point(&self, shape: &Shape, at: [f64; 2]) -> [f64; 2] {
        match shape {
            Shape::Ground => at,
            Shape::Beam { length, .. } => self.carry([at[0] / length * self.pose[3], 0.0]),
            Shape::Hull(_) | Shape::Disc(_) => self.carry(at),
        }
    }

    fn draw(&self, shape: &Shape, size: f64, svg: &mut String) {
        let path = match shape {
            Shape::Ground => return,
            Shape::Beam { elements, length } => self.beam(*elements, *length),
            Shape::Disc(radius) => {
                let [x, y] = self.carry([0.0; 2]);
                let _ = writeln!(
                    svg,
                    "<circle class=\"body\" cx=\"{x:.6}\" cy=\"{y:.6}\" r=\"{radius:.6}\" stroke-width=\"0\"/>"
                );
                return;
            }
            Shape::Hull(corners) => {
                let corners = corners.iter().map(|corner| self.carry(*corner));
                let corners = corners.map(|[x, y]| format!("{x:.6} {y:.6}"));
                format!("M{}Z", corners.collect::<Vec<_>>().join("L"))
            }
        };
        let (class, share) = match shape {
            Shape::Beam { .. } => ("beam", 0.5),
            _ => ("body", 1.0),
        };
        let width = share * BAR * size;
        let _ = writeln!(
            svg,
            "<path class=\"{class}\" d=\"{path}\" stroke-width=\"{width:.6}\"/>"
        );
    }

    /// The cubics of a flexible link: control points lie a third of an element along the slopes.
    fn beam(&self, elements: usize, length: f64) -> String {
        let chord = self.pose[3];
        let third = length / elements as f64 / 3.0;
        let node = |k: usize, along: f64| {
            let [u, w, su, sw] = std::array::from_fn(|i| self.deviations[4 * k + i]);
            let straight = chord * k as f64 / elements as f64;
            let [x, y] = self.carry([straight + u + along * (chord / length + su), w + along * sw]);
            format!("{x:.6} {y:.6}")
        };
        let mut path = format!("M{}", node(0, 0.0));
        for k in 1..=elements {
            let (a, b) = (node(k - 1, third), node(k, -third));
            let _ = write!(path, "C{a} {b} {}", node(k, 0.0));
        }
        path
    }
}

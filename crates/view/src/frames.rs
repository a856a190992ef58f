//! A run as a series of SVG pictures, for films and papers: bodies and joints.

use super::moved::{BodyShape, bounds};
use super::stored::StoredRun;
use looselink::interaction::Placed;
use looselink::scene::Analysis;
use std::fmt::Write;

/// Width of a picture \[pixels\], and the part of the mechanism's size that is left free around it.
const WIDTH: f64 = 960.0;
const MARGIN: f64 = 0.12;
/// Thickness of bars and radius of joints, relative to the size of the mechanism.
const BAR: f64 = 0.026;
const RING: f64 = 0.014;
const STYLE: &str = "text{font:16px sans-serif}.body{fill:#5b7fb4;stroke:#5b7fb4;stroke-linejoin:round;stroke-linecap:round;\
opacity:.8}.beam{fill:none;stroke:#d2691e;stroke-linecap:round}\
.joint{fill:#fff;stroke:#24292f;stroke-width:2}.loose{fill:#fff;stroke:#c2352b;stroke-width:2}";

/// From the plane to the picture.
struct FrameScale {
    bounds: [f64; 4],
    size: f64,
    /// Pixels a metre.
    factor: f64,
}

impl FrameScale {
    fn new(bounds: [f64; 4]) -> FrameScale {
        let [x0, y0, x1, y1] = bounds;
        let size = (x1 - x0).max(y1 - y0);
        FrameScale {
            bounds,
            size,
            factor: WIDTH / (x1 - x0 + 2.0 * MARGIN * size),
        }
    }

    fn height(&self) -> f64 {
        let [_, y0, _, y1] = self.bounds;
        self.factor * (y1 - y0 + 2.0 * MARGIN * self.size)
    }

    fn pixels(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let margin = MARGIN * self.size;
        let [x0, _, _, y1] = self.bounds;
        [
            self.factor * (x - x0 + margin),
            self.factor * (y1 + margin - y),
        ]
    }

    /// A point as a part of a path.
    fn text(&self, at: [f64; 2]) -> String {
        let [x, y] = self.pixels(at);
        format!("{x:.2} {y:.2}")
    }
}

/// Pictures at evenly spaced rows, the first and the last among them; a single one shows the first row.
pub fn frames(run: &StoredRun, count: usize) -> Vec<String> {
    let scale = FrameScale::new(bounds(run));
    let last = (run.motion.len() - 1) as f64;
    let intervals = count.saturating_sub(1).max(1) as f64;
    let rows = (0..count).map(|k| (k as f64 / intervals * last).round() as usize);
    let mut q = run.simulation.state().q.clone();
    rows.map(|row| {
        run.layout.restore(&run.motion[row], &mut q);
        frame(run, &scale, run.result.times[row], &q)
    })
    .collect()
}

/// The picture of a state.
fn frame(run: &StoredRun, scale: &FrameScale, t: f64, q: &[f64]) -> String {
    let unit = match run.result.scene.simulation.analysis {
        Analysis::Dynamic => " s",
        Analysis::Static => "",
    };
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {WIDTH} {:.2}\"><style>{STYLE}</style>\
        <rect width=\"100%\" height=\"100%\" fill=\"#fff\"/><text x=\"12\" y=\"24\">t = {t:.6}{unit}</text>\n",
        scale.height()
    );
    let bodies = run.simulation.model().bodies();
    for body in bodies {
        svg += &draw(&body.placed, scale, q);
    }
    for joint in &run.result.scene.joints {
        let class = if joint.contact().is_some() {
            "loose"
        } else {
            "joint"
        };
        for end in joint.points() {
            let marker = bodies[end.body].placed.marker(end.point);
            let [x, y] = scale.pixels(marker.position(q, marker.arm(q)).into());
            let r = RING * scale.size * scale.factor;
            // writing to a string cannot fail
            let _ = writeln!(
                svg,
                "<circle class=\"{class}\" cx=\"{x:.2}\" cy=\"{y:.2}\" r=\"{r:.2}\"/>"
            );
        }
    }
    svg + "</svg>\n"
}

/// A body in a state.
fn draw(placed: &Placed, scale: &FrameScale, q: &[f64]) -> String {
    let width = BAR * scale.size * scale.factor;
    let frame = || {
        placed
            .kind
            .frame_at(&placed.x, q, q)
            .map(|frame| frame.position)
    };
    let path = |class: &str, d: &str, width: f64| {
        format!("<path class=\"{class}\" d=\"{d}\" stroke-width=\"{width:.2}\"/>\n")
    };
    match (BodyShape::of(placed), frame()) {
        (BodyShape::Beam { elements, length }, _) => path(
            "beam",
            &beam(&placed.x, q, elements, length, scale),
            0.5 * width,
        ),
        (BodyShape::Disc(radius), Some([x, y, _])) => {
            let ([x, y], r) = (scale.pixels([x, y]), radius * scale.factor);
            format!(
                "<circle class=\"body\" cx=\"{x:.2}\" cy=\"{y:.2}\" r=\"{r:.2}\" stroke-width=\"0\"/>\n"
            )
        }
        (BodyShape::Hull(corners), Some([x, y, theta])) => {
            let (s, c) = theta.sin_cos();
            let carried = |[u, w]: [f64; 2]| scale.text([x + c * u - s * w, y + s * u + c * w]);
            let corners: Vec<String> = match corners.is_empty() {
                true => vec![carried([0.0; 2])],
                false => corners.into_iter().map(carried).collect(),
            };
            path("body", &format!("M{}Z", corners.join("L")), width)
        }
        (BodyShape::Ground, _) | (_, None) => String::new(),
    }
}

/// The cubics of a flexible link: control points lie a third of an element along the slopes.
fn beam(x: &[usize], q: &[f64], elements: usize, length: f64, scale: &FrameScale) -> String {
    let third = length / elements as f64 / 3.0;
    let node = |k: usize, along: f64| {
        let [at, slope] = [x[2 * k], x[2 * k + 1]];
        scale.text([q[at] + along * q[slope], q[at + 1] + along * q[slope + 1]])
    };
    let mut path = format!("M{}", node(0, 0.0));
    for k in 1..=elements {
        let (a, b) = (node(k - 1, third), node(k, -third));
        let _ = write!(path, "C{a} {b} {}", node(k, 0.0));
    }
    path
}

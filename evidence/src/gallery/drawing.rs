//! One figure a scene: the mechanism at a few instants, and a channel over time.

use crate::gallery::Entry;
use crate::gallery::runs::{SceneRun, nodes};
use looselink::body::{Ground, Known};
use looselink::scene::{Analysis, NamedBody, PointRef};
use plot::{Axis, Color, Figure, Mark, Panel, palette};

/// Instants at which the mechanism is drawn.
const INSTANTS: usize = 5;
/// Samples of the curve between two nodes of a flexible link.
const SAMPLES: usize = 8;
/// Samples closer than this part of its length to the line through their neighbours are left out.
const STRAIGHT: f64 = 2e-4;
/// Colour of the first instant; the last has that of the palette.
const EARLY: Color = (185, 205, 220);

/// The figure of a run.
pub fn figure(run: &SceneRun, entry: &Entry) -> Figure {
    Figure {
        rows: vec![vec![mechanism(run, entry), channel(run, entry)]],
        caption: String::new(),
    }
}

/// What t is called: time, or the part of the load.
fn clock(run: &SceneRun) -> (&'static str, &'static str) {
    match run.scene.simulation.analysis {
        Analysis::Dynamic => ("Time t", "s"),
        Analysis::Static => ("Part of the load", ""),
    }
}

fn channel(run: &SceneRun, entry: &Entry) -> Panel {
    let (label, unit) = clock(run);
    let (name, t) = (&*entry.channel, run.get("t").unwrap_or_default());
    let y = run.get(name).unwrap_or_default();
    Panel {
        title: name.to_owned(),
        note: String::new(),
        x: Axis::new(label, unit, 1.0).over(0.0, t.last().copied().unwrap_or(1.0)),
        y: Axis::new(
            &entry.label,
            &format!("{}{}", entry.prefix, symbol(run.unit(name))),
            factor(&entry.prefix),
        ),
        marks: vec![Mark::series("", palette::BLUE, t, y)],
    }
}

/// How many units with this prefix are one without.
fn factor(prefix: &str) -> f64 {
    match prefix {
        "µ" => 1e6,
        "m" => 1e3,
        "k" => 1e-3,
        _ => 1.0,
    }
}

/// A unit as it is printed.
fn symbol(unit: &'static str) -> &'static str {
    match unit {
        "m/s2" => "m/s²",
        "rad/s2" => "rad/s²",
        "1" => "",
        unit => unit,
    }
}

fn mechanism(run: &SceneRun, entry: &Entry) -> Panel {
    let t = run.get("t").unwrap_or_default();
    let last = t.last().copied().unwrap_or_default();
    let end = entry.drawn.unwrap_or(last).min(last);
    let (_, unit) = clock(run);
    let mut marks = paths(run);
    for k in 0..INSTANTS {
        let share = k as f64 / (INSTANTS - 1) as f64;
        let row = nearest(t, share * end);
        let color = blend(EARLY, palette::BLUE, share);
        let label = match unit {
            "" => format!("{:.2}", t[row]),
            unit => numbers::si(t[row], unit),
        };
        pose(run, row, color, &label, &mut marks);
    }
    marks.extend(grounds(run));
    Panel {
        title: "Mechanism".into(),
        note: String::new(),
        x: Axis::new("x", "m", 1.0).equal(),
        y: Axis::new("y", "m", 1.0),
        marks,
    }
}

fn nearest(t: &[f64], wanted: f64) -> usize {
    let distance = |row: &usize| (t[*row] - wanted).abs();
    let rows = 0..t.len();
    rows.min_by(|a, b| distance(a).total_cmp(&distance(b)))
        .unwrap_or_default()
}

fn blend(from: Color, to: Color, share: f64) -> Color {
    let mix = |a: u8, b: u8| (f64::from(a) + share * (f64::from(b) - f64::from(a))).round() as u8;
    (mix(from.0, to.0), mix(from.1, to.1), mix(from.2, to.2))
}

/// Names of the points that the run has recorded of a body, in the order of the body.
fn points(run: &SceneRun, body: &NamedBody) -> Vec<String> {
    let names: Vec<String> = match body.kind.get() {
        Some(link) => nodes(link),
        None => body.kind.points().iter().map(|p| p.name.clone()).collect(),
    };
    let recorded = |name: &String| run.get(&format!("points.{}.{name}.x", body.name)).is_some();
    names.into_iter().filter(recorded).collect()
}

/// Two channels of a point, `x` and `y` or the two of its slope.
fn pair(
    run: &SceneRun,
    body: &NamedBody,
    point: &str,
    names: [&str; 2],
    row: usize,
) -> Option<[f64; 2]> {
    let value = |q: &str| {
        let channel = run.get(&format!("points.{}.{point}.{q}", body.name))?;
        channel.get(row).copied()
    };
    Some([value(names[0])?, value(names[1])?])
}

/// Everything at one instant; the label goes to the first mark.
fn pose(run: &SceneRun, row: usize, color: Color, label: &str, marks: &mut Vec<Mark>) {
    let before = marks.len();
    for force in &run.scene.forces {
        if let [from, to] = force.kind.points()[..] {
            let ends = [from, to].map(|p| place(run, p, row));
            if let [Some(a), Some(b)] = ends {
                marks.push(Mark::curve("", color, &[a[0], b[0]], &[a[1], b[1]]).width(2));
            }
        }
    }
    for body in &run.scene.bodies {
        if let Some(Known::Fixed) = body.kind.known() {
            continue;
        }
        let names = points(run, body);
        let at: Vec<[f64; 2]> = names
            .iter()
            .filter_map(|name| pair(run, body, name, ["x", "y"], row))
            .collect();
        let outline = match body.kind.link() {
            Some(link) if !body.kind.is_rigid() => bent(run, body, link.length, &names, row),
            Some(_) => at.clone(),
            None => hull(at.clone()),
        };
        let (x, y): (Vec<f64>, Vec<f64>) = outline.iter().map(|p| (p[0], p[1])).unzip();
        if outline.len() > 1 {
            marks.push(Mark::curve("", color, &x, &y).width(5));
        }
        // nodes between the ends of a flexible link are not marked
        let marked: Vec<&[f64; 2]> = match body.kind.link() {
            Some(_) => at.first().into_iter().chain(at.last()).collect(),
            None => at.iter().collect(),
        };
        let (x, y): (Vec<f64>, Vec<f64>) = marked.iter().map(|p| (p[0], p[1])).unzip();
        let radius = if outline.len() > 1 { 7 } else { 12 };
        marks.push(Mark::points("", color, &x, &y, radius));
    }
    if let Some(first) = marks.get_mut(before) {
        first.label = label.to_owned();
    }
}

/// Where a point of the scene is.
fn place(run: &SceneRun, point: PointRef, row: usize) -> Option<[f64; 2]> {
    let body = &run.scene.bodies[point.body];
    let own = &body.kind.points()[point.point];
    match body.kind.known() {
        Some(Known::Fixed) => Some(own.at.into()),
        _ => pair(run, body, &own.name, ["x", "y"], row),
    }
}

/// The axis of a flexible link: the cubic of its elements between nodes and slopes.
fn bent(
    run: &SceneRun,
    body: &NamedBody,
    length: f64,
    names: &[String],
    row: usize,
) -> Vec<[f64; 2]> {
    let get = |name: &String, channels| pair(run, body, name, channels, row).unwrap_or_default();
    let l = length / (names.len() - 1) as f64;
    let mut line = vec![get(&names[0], ["x", "y"])];
    for ends in names.windows(2) {
        let [p, q] = [0, 1].map(|i| get(&ends[i], ["x", "y"]));
        let [s, e] = [0, 1].map(|i| get(&ends[i], ["slope_x", "slope_y"]));
        for k in 1..=SAMPLES {
            let u = k as f64 / SAMPLES as f64;
            let (u2, u3) = (u * u, u * u * u);
            line.push([0, 1].map(|i| {
                (1.0 - 3.0 * u2 + 2.0 * u3) * p[i]
                    + (3.0 * u2 - 2.0 * u3) * q[i]
                    + l * ((u - 2.0 * u2 + u3) * s[i] + (u3 - u2) * e[i])
            }));
        }
    }
    bends(&line, STRAIGHT * length)
}

/// A line without the points that are closer than `tolerance` to what is left of it.
fn bends(line: &[[f64; 2]], tolerance: f64) -> Vec<[f64; 2]> {
    let [first, .., last] = line else {
        return line.to_vec();
    };
    let way = [last[0] - first[0], last[1] - first[1]];
    let length = way[0].hypot(way[1]);
    let away = |p: &[f64; 2]| {
        let d = [p[0] - first[0], p[1] - first[1]];
        if length == 0.0 {
            d[0].hypot(d[1])
        } else {
            (way[0] * d[1] - way[1] * d[0]).abs() / length
        }
    };
    let distances = line.iter().map(away).enumerate();
    match distances.max_by(|a, b| a.1.total_cmp(&b.1)) {
        Some((k, distance)) if distance > tolerance && k > 0 && k + 1 < line.len() => {
            let mut kept = bends(&line[..=k], tolerance);
            kept.pop();
            kept.extend(bends(&line[k..], tolerance));
            kept
        }
        _ => vec![*first, *last],
    }
}

/// The convex hull of the points of a rigid body, closed.
fn hull(mut points: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
    if points.len() < 3 {
        return points;
    }
    points.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
    let turn = |a: [f64; 2], b: [f64; 2], c: [f64; 2]| {
        (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
    };
    let side = |points: &mut dyn Iterator<Item = [f64; 2]>| {
        let mut chain: Vec<[f64; 2]> = Vec::new();
        for p in points {
            while chain.len() > 1 && turn(chain[chain.len() - 2], chain[chain.len() - 1], p) <= 0.0
            {
                chain.pop();
            }
            chain.push(p);
        }
        chain
    };
    let mut outline = side(&mut points.iter().copied());
    outline.pop();
    outline.extend(side(&mut points.iter().rev().copied()));
    outline
}

/// The paths of bodies that are drawn as one dot only.
fn paths(run: &SceneRun) -> Vec<Mark> {
    let mut marks = Vec::new();
    for body in &run.scene.bodies {
        if let Some(Known::Fixed) = body.kind.known() {
            continue;
        }
        let names = points(run, body);
        if let [name] = &names[..] {
            let of = |q| run.get(&format!("points.{}.{name}.{q}", body.name));
            let (x, y) = (of("x").unwrap_or_default(), of("y").unwrap_or_default());
            marks.push(Mark::curve("", palette::GREY, x, y).width(1));
        }
    }
    marks
}

/// The points of the ground.
fn grounds(run: &SceneRun) -> Vec<Mark> {
    let mut marks = Vec::new();
    for body in &run.scene.bodies {
        if let Some(Ground { points }) = body.kind.get() {
            let (x, y): (Vec<f64>, Vec<f64>) = points.iter().map(|p| (p.at.x, p.at.y)).unzip();
            marks.push(Mark::points("", palette::BLACK, &x, &y, 9));
        }
    }
    marks
}

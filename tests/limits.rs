//! Limits: drives that lead beyond the reach of a mechanism, loops that cannot close, constraints that lose rank at the start.

use crate::support::{all_scenes, load};
use looselink::compile::drive_limit::{DriveCourse, DriveLimit};
use looselink::scene::Scene;
use looselink::simulate::{Recording, RunError, Simulation};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

const HEAD: &str = r#"
format = 1
title = "limits"
integrator = { method = "bathe", step = 1e-3, newton_tolerance = 1e-9 }
output = { interval = 0.01, channels = ["*"] }
materials.steel = { density = 7850.0 }
sections.bar = { width = 0.01, height = 0.01 }
"#;

fn link(name: &str, length: f64) -> String {
    format!(
        "bodies.{name} = {{ type = \"link\", model = \"rigid\", length = {length}, section = \"bar\", material = \"steel\" }}\n"
    )
}

fn pin(name: &str, bearing: &str, journal: &str) -> String {
    format!(
        "joints.{name} = {{ type = \"revolute\", bearing = \"{bearing}\", journal = \"{journal}\", model = \"ideal\" }}\n"
    )
}

/// The simulation of a scene whose text follows the head.
fn simulation(text: &str) -> Simulation {
    let text = format!("{HEAD}{text}");
    let scene = Scene::parse("scene.toml", &text, &[]).unwrap_or_else(|e| panic!("{e}\n{text}"));
    Simulation::new(&scene).unwrap_or_else(|e| panic!("{e}\n{text}"))
}

fn limit(text: &str) -> DriveLimit {
    match simulation(text).drive_course() {
        DriveCourse::Limited(limit) => (**limit).clone(),
        other => panic!("{other:?}\n{text}"),
    }
}

/// A four-bar of these lengths (ground, crank, coupler, rocker) whose crank is driven by a function that begins at `angle`.
fn four_bar([g, a, b, c]: [f64; 4], angle: f64, motion: &str, duration: f64) -> String {
    let (x, y) = (a * angle.cos(), a * angle.sin());
    // B by the intersection of two circles
    let (dx, dy) = (g - x, -y);
    let d = dx.hypot(dy);
    let along = (d * d + b * b - c * c) / (2.0 * d);
    let across = (b * b - along * along).max(0.0).sqrt();
    let (bx, by) = (
        x + (along * dx - across * dy) / d,
        y + (along * dy + across * dx) / d,
    );
    format!(
        "simulation = {{ duration = {duration} }}\nbodies.ground = {{ type = \"ground\", points.O = [0.0, 0.0], points.D = [{g}, 0.0] }}\n\
         {}{}{}{}{}{}{}drives.motor = {{ type = \"angle\", joint = \"O\", angle = {motion} }}\ninitial.sketch = {{ B = [{bx}, {by}] }}\n",
        link("crank", a),
        link("coupler", b),
        link("rocker", c),
        pin("O", "ground.O", "crank.start"),
        pin("A", "crank.end", "coupler.start"),
        pin("B", "coupler.end", "rocker.end"),
        pin("D", "ground.D", "rocker.start"),
    )
}

/// Numbers between 0 and 1 (Knuth's linear congruential generator).
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> f64 {
        let product = self.0.wrapping_mul(6_364_136_223_846_793_005);
        self.0 = product.wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// The crank can go as far as coupler and rocker lie in line: |A D| = b + c or |b - c|.
#[test]
fn a_crank_stops_where_coupler_and_rocker_are_in_line() {
    let mut numbers = Numbers(1);
    let (mut found, mut folded) = (0, 0);
    while found < 50 {
        let [g, a, b, c] = std::array::from_fn(|_| 0.2 + numbers.next());
        let at = |d: f64| {
            let cosine: f64 = (a * a + g * g - d * d) / (2.0 * a * g);
            (cosine.abs() < 1.0).then(|| cosine.acos())
        };
        let limits = [b + c, (b - c).abs()].map(at);
        let start = TAU * numbers.next() - PI;
        let distance = (a * a + g * g - 2.0 * a * g * start.cos()).sqrt();
        // well inside of its range, which has an end
        let closes = distance < 0.98 * (b + c) && distance > 1.02 * (b - c).abs();
        if !closes || limits == [None; 2] {
            continue;
        }
        let direction = if numbers.next() < 0.5 { -1.0 } else { 1.0 };
        let all = limits
            .iter()
            .enumerate()
            .filter_map(|(i, l)| Some((i, (*l)?)));
        let all =
            all.flat_map(|(i, l)| [l - TAU, l, l + TAU, -l - TAU, -l, -l + TAU].map(|l| (i, l)));
        let ahead = all.filter(|(_, l)| (l - start) * direction > 0.0);
        let (i, expected) = ahead
            .min_by(|a, b| (a.1 - start).abs().total_cmp(&(b.1 - start).abs()))
            .unwrap();
        let motion = format!("\"{start} + {direction}*t\"");
        let limit = limit(&four_bar([g, a, b, c], start, &motion, 7.0));
        let value = limit.values[0].unwrap();
        // far below what a drive is made to
        assert!(
            (value - expected).abs() < 1e-9,
            "{value} {expected}: {limit}"
        );
        assert!((limit.t - (expected - start).abs()).abs() < 1e-9, "{limit}");
        let cause = "coupler and rocker are in line at joints A, B and D";
        assert_eq!(limit.cause, cause, "{limit}");
        assert!(limit.stops_the_motion());
        found += 1;
        folded += i;
    }
    // both kinds
    assert!(folded > 5 && folded < 45, "{folded}");
}

fn slider_crank(crank: f64, rod: f64, drive: &str, at: [f64; 2], duration: f64) -> String {
    let [x, y] = at;
    format!(
        "simulation = {{ duration = {duration} }}\nbodies.ground = {{ type = \"ground\", points.O = [0.0, 0.0] }}\n\
         bodies.slider = {{ type = \"point_mass\", mass = 1.0 }}\n{}{}{}{}{}\
         joints.slot = {{ type = \"prismatic\", guide = \"ground.O\", slider = \"slider.center\", direction = [1.0, 0.0], rotation = \"free\" }}\n\
         {drive}\ninitial.sketch = {{ A = [{x}, {y}], B = [{}, 0.0] }}\n",
        link("crank", crank),
        link("rod", rod),
        pin("O", "ground.O", "crank.start"),
        pin("A", "crank.end", "rod.start"),
        pin("B", "rod.end", "slider.center"),
        x + (rod * rod - y * y).sqrt(),
    )
}

/// A rod shorter than the crank: a sin(theta) = l.
#[test]
fn a_crank_stops_where_its_rod_is_too_short() {
    let drive = "drives.motor = { type = \"angle\", joint = \"O\", angle = \"t\" }";
    let limit = limit(&slider_crank(0.2, 0.15, drive, [0.2, 0.0], 2.0));
    let expected = (0.15_f64 / 0.2).asin();
    assert!((limit.t - expected).abs() < 1e-9, "{limit}");
    assert_eq!(
        limit.cause,
        "rod is perpendicular to the line of joint slot"
    );
}

/// A slider that is pulled until crank and rod are stretched, and pushed until they fold.
#[test]
fn a_prescribed_point_beyond_the_reach() {
    let at = [0.1, 0.03_f64.sqrt()];
    let start = 0.1 + (0.09_f64 - 0.03).sqrt();
    for (speed, expected) in [(0.5, 0.5), (-0.5, 0.1)] {
        let drive = format!(
            "drives.push = {{ type = \"point\", point = \"slider.center\", x = \"{start} + {speed}*t\" }}"
        );
        let limit = limit(&slider_crank(0.2, 0.3, &drive, at, 2.0));
        let [x, y] = limit.values;
        assert!(
            (x.unwrap() - expected).abs() < 1e-9 && y.is_none(),
            "{limit}"
        );
        assert_eq!(
            limit.cause,
            "crank and rod are in line at joints O, A and B"
        );
        assert!(
            limit
                .to_string()
                .starts_with("drive push cannot move slider.center beyond x = ")
        );
    }
}

/// The tip of two links leaves their reach along a line; both of its coordinates are prescribed, so the trace is one in time.
#[test]
fn a_tip_that_leaves_the_reach() {
    let text = format!(
        "simulation = {{ duration = 3.0 }}\nbodies.ground = {{ type = \"ground\", points.O = [0.0, 0.0] }}\n{}{}{}{}\
         drives.tip = {{ type = \"point\", point = \"fore.end\", x = \"0.3 + 0.2*t\", y = \"0.1*t^2\" }}\n\
         initial.sketch = {{ A = [0.15, 0.3], fore.end = [0.3, 0.0] }}\n",
        link("upper", 0.35),
        link("fore", 0.4),
        pin("O", "ground.O", "upper.start"),
        pin("A", "upper.end", "fore.start"),
    );
    let limit = limit(&text);
    let distance = (0.3 + 0.2 * limit.t).hypot(0.1 * limit.t * limit.t);
    assert!((distance - 0.75).abs() < 1e-9, "{limit}");
    let cause = "upper and fore are in line at joint O, joint A and point fore.end";
    assert_eq!(limit.cause, cause);
}

/// Cranks that turn fully, a drive that turns back before its limit, and a flat parallelogram that is passed; a drive that ends at its
/// limit is told.
#[test]
fn what_stays_within_the_reach_has_no_limit() {
    let crank_rocker = [1.0, 0.3, 0.8, 0.7];
    let toggle = ((25.0 + 16.0 - 30.25) / 40.0_f64).acos();
    let swing = |amplitude: f64| {
        let (middle, range) = (toggle - 0.2, 0.2 * amplitude);
        format!("\"{middle} + {range}*sin(5*t)\"")
    };
    let to_the_end = format!(
        "{{ type = \"smooth_step\", from = 0.6, to = {toggle}, start = 0.0, duration = 1.0 }}"
    );
    for text in [
        four_bar(crank_rocker, 0.4, "\"0.4 + 30*t\"", 200.0),
        four_bar([5.0, 4.0, 2.0, 3.5], toggle - 0.2, &swing(0.999), 10.0),
        four_bar([1.0, 0.4, 1.0, 0.4], 0.5, "\"0.5 + 2*t\"", 20.0),
    ] {
        let course = simulation(&text).drive_course().clone();
        assert_eq!(course, DriveCourse::Complete, "{text}");
    }
    let text = four_bar([5.0, 4.0, 2.0, 3.5], 0.6, &to_the_end, 2.0);
    let at_end = limit(&text);
    assert!(at_end.t == 1.0 && !at_end.stops_the_motion(), "{at_end}");
    let text = four_bar([5.0, 4.0, 2.0, 3.5], toggle - 0.2, &swing(1.001), 10.0);
    let limit = limit(&text);
    assert!((limit.values[0].unwrap() - toggle).abs() < 1e-9, "{limit}");
    assert!(
        (limit.t - 0.2 * (1.0 / 1.001_f64).asin()).abs() < 1e-9,
        "{limit}"
    );
}

/// Two cranks of a five-bar, one of which leads it beyond its reach, and a joint between two moving links that is driven.
#[test]
fn limits_of_several_drives() {
    let five_bar = |left: &str, right: &str| {
        format!(
            "simulation = {{ duration = 4.0 }}\n\
             bodies.ground = {{ type = \"ground\", points.O = [0.0, 0.0], points.D = [1.0, 0.0] }}\n{}{}{}{}{}{}{}{}{}\
             drives.left = {{ type = \"angle\", joint = \"O\", angle = {left} }}\n\
             drives.right = {{ type = \"angle\", joint = \"D\", angle = {right} }}\ninitial.sketch = {{ B = [0.5, 0.9] }}\n",
            link("crank", 0.4),
            link("arm", 0.7),
            link("forearm", 0.7),
            link("handle", 0.4),
            pin("O", "ground.O", "crank.start"),
            pin("A", "crank.end", "arm.start"),
            pin("B", "arm.end", "forearm.end"),
            pin("C", "handle.end", "forearm.start"),
            pin("D", "ground.D", "handle.start"),
        )
    };
    let limit = limit(&five_bar("\"1.5 + t\"", "\"1.6 - 0.8*t\""));
    let (a, c) = (1.5 + limit.t, 1.6 - 0.8 * limit.t);
    let distance = (1.0 + 0.4 * c.cos() - 0.4 * a.cos()).hypot(0.4 * (c.sin() - a.sin()));
    assert!((distance - 1.4).abs() < 1e-9, "{limit}");
    assert_eq!(
        limit.cause,
        "arm and forearm are in line at joints A, B and C"
    );
    let text = five_bar("\"1.5 + 0.1*sin(t)\"", "\"1.6 - 0.1*sin(2*t)\"");
    assert_eq!(*simulation(&text).drive_course(), DriveCourse::Complete);
    // crank and coupler turn towards each other until |O B| = g - c
    let (start, expected) = (-0.8_f64, -(-0.95_f64).acos());
    let (x, y) = (0.5 + 0.6 * start.cos(), 0.6 * start.sin());
    let far = x.hypot(y);
    let cosine = (far * far + 1.0 - 0.64) / (2.0 * far);
    let turn = cosine.acos() - y.atan2(x);
    let [a, b] = [(0.5, 0.0), (x, y)].map(|(x, y)| {
        let (sine, cosine) = turn.sin_cos();
        format!("[{}, {}]", x * cosine - y * sine, x * sine + y * cosine)
    });
    let text = four_bar([1.0, 0.5, 0.6, 0.8], 1.0, "1.0", 5.0);
    let (head, _) = text.split_once("drives.").unwrap();
    let text = format!(
        "{head}drives.elbow = {{ type = \"angle\", joint = \"A\", angle = \"{start} - 0.5*t\" }}\n\
         initial.sketch = {{ A = {a}, B = {b} }}\n"
    );
    let limit = self::limit(&text);
    assert!(
        (limit.values[0].unwrap() - expected).abs() < 1e-9,
        "{limit}"
    );
    assert_eq!(limit.cause, "joints O, B and D are in line");
}

/// What moves freely beside a driven loop is no obstacle; a mechanism with more freedoms than drives has no trace.
#[test]
fn freedoms_that_no_drive_determines() {
    let loop_text = four_bar([5.0, 4.0, 2.0, 3.5], 0.6, "\"0.6 + t\"", 2.0);
    let (head, sketch) = loop_text.split_once("initial.").unwrap();
    let text = format!(
        "{head}{}{}initial.{}",
        link("bob", 0.5),
        pin("hook", "coupler.end", "bob.start"),
        sketch.replace("{ B", "{ bob.end = [5.0, 3.0], B")
    );
    assert!((limit(&text).t - 0.698_701_27).abs() < 1e-8);
    let text = head.replace("\"O\", angle = \"0.6 + t\"", "\"O\", angle = \"0.6 + 0*t\"");
    let five = format!(
        "{}{}{}{}initial.sketch = {{ B = [5.0, 3.5], E = [4.38, 3.44] }}\n",
        text.replace(
            "\"coupler.end\", journal = \"rocker.end\"",
            "\"coupler.end\", journal = \"extra.start\""
        ),
        link("extra", 0.6),
        pin("E", "extra.end", "rocker.end"),
        ""
    );
    assert_eq!(*simulation(&five).drive_course(), DriveCourse::Undetermined);
}

/// The scenes of the project go to their ends.
#[test]
fn scenes_of_the_project_have_no_limit() {
    let mut complete = 0;
    for name in all_scenes() {
        let scene = load(&name, &[]);
        let course = Simulation::new(&scene).unwrap().drive_course().clone();
        let is_singular = name == "hard/type-2-singularity.toml";
        let is_expected = match course {
            DriveCourse::LosesControl(_) => is_singular,
            DriveCourse::Complete | DriveCourse::Undetermined => !is_singular,
            _ => false,
        };
        assert!(is_expected, "{name}: {course:?}");
        complete += usize::from(course == DriveCourse::Complete);
    }
    assert!(complete > 5, "{complete}");
}

/// A run that comes to the limit says the same, and nothing of what follows from it.
#[test]
fn a_run_ends_at_the_limit() {
    let text = four_bar([5.0, 4.0, 2.0, 3.5], 0.6, "\"0.6 + t\"", 2.0);
    let mut simulation = simulation(&text);
    let expected = limit(&text);
    let mut recording = Recording::new(&simulation);
    let ended = simulation.run(&mut recording);
    let Err(RunError::DriveLimit(found)) = &ended else {
        panic!("{ended:?}");
    };
    assert_eq!(**found, expected);
    assert!((simulation.state().t - found.t).abs() < 1e-6);
    let report = simulation.report();
    assert_eq!(report.error, Some(expected.to_string()));
    assert!(report.warnings().is_empty(), "{:?}", report.warnings());
    assert!(
        expected
            .to_string()
            .contains("at t = 0.69870127 s: coupler and rocker are in line"),
        "{expected}"
    );
    assert!(FRAC_PI_2 > expected.values[0].unwrap());
}

/// The error of a scene that reads well and cannot start.
fn refused(text: &str) -> String {
    let text = format!("{HEAD}{text}");
    let scene = Scene::parse("scene.toml", &text, &[]).unwrap_or_else(|e| panic!("{e}\n{text}"));
    match Simulation::new(&scene) {
        Ok(_) => panic!("it starts\n{text}"),
        Err(error) => error.to_string(),
    }
}

/// The gap is |A D| less than rocker and coupler allow; lengths that close the loop lie at the end of the same interval.
#[test]
fn a_loop_that_cannot_close_has_its_least_gap() {
    let mut numbers = Numbers(7);
    let mut found = [0; 2];
    while found.iter().any(|count| *count < 5) {
        let [g, a, b, c] = std::array::from_fn(|_| 0.2 + numbers.next());
        let angle = TAU * numbers.next();
        let d = (a * a + g * g - 2.0 * a * g * angle.cos()).sqrt();
        let (gap, kind) = match () {
            () if d > 1.05 * (b + c) => (d - b - c, 0),
            () if d < 0.95 * (b - c).abs() => ((b - c).abs() - d, 1),
            () => continue,
        };
        let text = four_bar([g, a, b, c], angle, &format!("{angle:?}"), 1.0);
        let error = refused(&text);
        // the crank alone may be longer than all others together: no gap is needed to see it
        if error.contains("more than all other bodies") {
            continue;
        }
        let number = |after: &str| -> f64 {
            let (_, rest) = error.split_once(after).unwrap_or_else(|| panic!("{error}"));
            rest.split_whitespace().next().unwrap().parse().unwrap()
        };
        // three digits are printed
        assert!(
            (number("joint B stays open by ") / gap - 1.0).abs() < 5.1e-3,
            "{gap} {error}"
        );
        let coupler = if kind == 0 || b < c { b + gap } else { b - gap };
        let rocker = if kind == 0 || c < b { c + gap } else { c - gap };
        for (name, length, own) in [("coupler", coupler, b), ("rocker", rocker, c)] {
            let printed = number(&format!(
                "{name} {}",
                if name == "coupler" {
                    "would have to be "
                } else {
                    ""
                }
            ));
            let outward = if length > own {
                printed - length
            } else {
                length - printed
            };
            assert!(
                (0.0..1.01e-3 * length).contains(&(outward + 1e-9)),
                "{length} {error}"
            );
            let closes = text.replace(&link(name, own), &link(name, printed));
            let scene = Scene::parse("scene.toml", &format!("{HEAD}{closes}"), &[]).unwrap();
            // the loop closes, far from the sketch perhaps
            if let Err(error) = Simulation::new(&scene) {
                assert!(
                    !error.to_string().contains("cannot be assembled"),
                    "{error}\n{closes}"
                );
            }
        }
        found[kind] += 1;
    }
}

/// Peaucellier's cell with an inner point that its arms cannot reach: both loops stay open by 0.05 m, and the first is named.
#[test]
fn a_cell_that_is_too_short() {
    let mut text = String::from(
        "simulation = { duration = 1.0 }\nbodies.ground = { type = \"ground\", points.O = [0.0, 0.0], points.P = [0.2, 0.0] }\n",
    );
    for (name, length) in [
        ("long1", 0.4),
        ("long2", 0.4),
        ("s1", 0.15),
        ("s2", 0.15),
        ("s3", 0.15),
        ("s4", 0.15),
    ] {
        text += &link(name, length);
    }
    for (name, bearing, journal) in [
        ("O1", "ground.O", "long1.start"),
        ("O2", "ground.O", "long2.start"),
        ("P1", "ground.P", "s1.start"),
        ("P2", "ground.P", "s2.start"),
        ("A1", "long1.end", "s1.end"),
        ("A2", "long1.end", "s3.start"),
        ("B1", "long2.end", "s2.end"),
        ("B2", "long2.end", "s4.start"),
        ("Q", "s3.end", "s4.end"),
    ] {
        text += &pin(name, bearing, journal);
    }
    text += "initial.sketch = { A1 = [0.30, 0.10], B1 = [0.30, -0.10], Q = [0.40, 0.0] }\n";
    let error = refused(&text);
    let expected = "joint A1 stays open by 0.05 m at least, with all others closed (and another loop cannot close); long1 would have \
                    to be 0.35 m or shorter, or s1 0.2 m or longer";
    assert!(error.contains(expected), "{error}");
    // its inner point on a driven crank
    let crank = link("crank", 0.1) + &pin("C", "ground.C", "crank.start");
    let text = text
        .replace("points.P = [0.2, 0.0]", "points.C = [0.1, 0.0]")
        .replace("ground.P", "crank.end")
        + &crank
        + "drives.motor = { type = \"angle\", joint = \"C\", angle = 0.0 }\n";
    let error = refused(&text);
    assert!(
        error.ends_with(&format!("{expected}, or crank 0.15 m or longer")),
        "{error}"
    );
}

/// The same mechanism in micrometres and in kilometres: the same words, the same digits.
#[test]
fn tolerances_follow_the_size_of_the_mechanism() {
    for scale in [1e-6, 1.0, 1e4] {
        let lengths = [5.0, 4.0, 2.0, 3.5].map(|l| l * scale);
        let limit = limit(&four_bar(lengths, 0.6, "\"0.6 + t\"", 2.0));
        assert!((limit.t - 0.698_701_275).abs() < 1e-8, "{scale}: {limit}");
        let short = [5.0, 4.0, 0.05, 3.5].map(|l| l * scale);
        let error = refused(&four_bar(short, 0.6, "\"0.6 + t\"", 2.0).replace("NaN", "0.0"));
        assert!(error.contains("joint B stays open by "), "{error}");
        // off by a thousandth of a millionth of the mechanism and by a millionth
        for (off, fits) in [(1e-10, true), (1e-6, false)] {
            let bar = parallel_bars(scale, 0.2 * scale * (1.0 + off));
            let text = format!("{HEAD}{bar}");
            let scene = Scene::parse("scene.toml", &text, &[]).unwrap();
            let started = Simulation::new(&scene).map(|s| s.report().redundant.len());
            assert_eq!(started.ok(), fits.then_some(1), "{scale} {off}");
        }
    }
}

/// A plate on three parallel bars, the first of which is driven; the third has a length of its own.
fn parallel_bars(scale: f64, third: f64) -> String {
    let at = |x: f64, y: f64| format!("[{:?}, {:?}]", x * scale, y * scale);
    let (x, y) = (0.2 * 1.2_f64.cos(), 0.2 * 1.2_f64.sin());
    format!(
        "simulation = {{ duration = 0.2 }}\n\
         bodies.ground = {{ type = \"ground\", points.A = {}, points.B = {}, points.C = {} }}\n\
         bodies.plate = {{ type = \"rigid_body\", mass = 1.0, inertia = 0.1, points.a = {}, points.b = {}, points.c = {} }}\n\
         {}{}{}{}{}{}{}{}{}\
         drives.motor = {{ type = \"angle\", joint = \"A\", angle = \"1.2 + t\" }}\n\
         initial.sketch = {{ a = {}, b = {}, c = {} }}\n",
        at(0.0, 0.0),
        at(0.1, 0.0),
        at(0.25, 0.0),
        at(0.0, 0.0),
        at(0.1, 0.0),
        at(0.25, 0.0),
        link("first", 0.2 * scale),
        link("second", 0.2 * scale),
        link("third", third),
        pin("A", "ground.A", "first.start"),
        pin("B", "ground.B", "second.start"),
        pin("C", "ground.C", "third.start"),
        pin("a", "plate.a", "first.end"),
        pin("b", "plate.b", "second.end"),
        pin("c", "plate.c", "third.end"),
        at(x, y),
        at(0.1 + x, y),
        at(0.25 + x, y),
    )
}

/// A third bar whose length does not fit contradicts the others by what it is off; the message has the length that fits.
#[test]
fn redundant_bars_repeat_and_contradict() {
    let error = refused(&parallel_bars(1.0, 0.21));
    assert!(
        error.contains("joint c contradicts the other constraints, by 0.01 m"),
        "{error}"
    );
    assert!(error.contains("third 0.2 m"), "{error}");
    // hardly off: a plate on three bars of nearly the same length does not turn
    let error = refused(&parallel_bars(1.0, 0.20001));
    assert!(
        error.contains("contradicts the other constraints, by 1e-5 m"),
        "{error}"
    );
    assert!(
        error.contains("third 0.2 m") && !error.contains("longer"),
        "{error}"
    );
    // a bar between two fixed points
    let bar = |length: f64| {
        format!(
            "simulation = {{ duration = 0.1, gravity = [0.0, -9.81] }}\n\
             bodies.ground = {{ type = \"ground\", points.A = [0.0, 0.0], points.B = [0.3, 0.4] }}\n{}{}{}{}{}\
             initial.sketch = {{ pendulum.end = [0.2, 0.0] }}\n",
            link("bar", length),
            link("pendulum", 0.2),
            pin("A", "ground.A", "bar.start"),
            pin("B", "ground.B", "bar.end"),
            pin("P", "ground.A", "pendulum.start"),
        )
    };
    let mut fits = simulation(&bar(0.5));
    fits.run(&mut ()).unwrap();
    assert_eq!(fits.report().redundant, ["joint B (y)"]);
    // the end of a link on two points of the ground
    let twice = format!(
        "{}{}",
        pin("E", "ground.B", "pendulum.end"),
        pin("F", "ground.A", "pendulum.end")
    );
    let error = refused(&bar(0.5).replace("initial.", &format!("{twice}initial.")));
    assert!(
        error.contains("joint F contradicts others: the link end it joins is already fixed, 500"),
        "{error}"
    );
    let error = refused(&bar(0.51));
    assert!(
        error.contains("contradicts the other constraints, by 0.01 m; bar would have to be 0.5 m"),
        "{error}"
    );
}

/// Two bars in one line between fixed pins, and a body on a pin and on a bar that points at the pin: a motion of first order. A bar
/// that is inclined holds the body, and a dead centre from which branches go on is a singular pose.
#[test]
fn a_rigid_but_shaky_start_is_named() {
    let bars = |rise: f64| {
        format!(
            "simulation = {{ duration = 0.1 }}\n\
             bodies.ground = {{ type = \"ground\", points.A = [0.0, 0.0], points.B = [1.0, 0.0] }}\n{}{}{}{}{}\
             initial.sketch = {{ C = [0.5, {rise}] }}\n",
            link("p", 0.5_f64.hypot(rise)),
            link("q", 0.5_f64.hypot(rise)),
            pin("A", "ground.A", "p.start"),
            pin("B", "ground.B", "q.start"),
            pin("C", "p.end", "q.end"),
        )
    };
    let expected =
        "the constraints lose rank at the start: p.end can move to first order but not to second";
    assert!(refused(&bars(0.0)).contains(expected));
    assert!(simulation(&bars(0.1)).report().redundant.is_empty());
    let arm = |x: f64, y: f64| {
        format!(
            "simulation = {{ duration = 0.1 }}\n\
             bodies.ground = {{ type = \"ground\", points.A = [0.0, 0.0], points.D = [{x}, {y}] }}\n\
             bodies.arm = {{ type = \"rigid_body\", mass = 1.0, inertia = 0.1, points.a = [0.0, 0.0], points.b = [0.5, 0.0] }}\n\
             {}{}{}{}initial.sketch = {{ Q = [0.5, 0.0] }}\n",
            link("bar", (x - 0.5).hypot(y)),
            pin("A", "ground.A", "arm.a"),
            pin("Q", "arm.b", "bar.start"),
            pin("D", "ground.D", "bar.end"),
        )
    };
    let error = refused(&arm(0.75, 0.0));
    assert!(
        error.contains("can move to first order but not to second"),
        "{error}"
    );
    assert!(simulation(&arm(0.6, 0.2)).report().redundant.is_empty());
    let flat = four_bar([1.0, 0.4, 1.0, 0.4], 0.0, "1.0", 1.0);
    let (head, _) = flat.split_once("drives.").unwrap();
    let error = refused(&format!(
        "{head}initial.sketch = {{ A = [0.4, 0.0], B = [1.4, 0.0] }}\n"
    ));
    assert!(error.contains("the start is a singular pose"), "{error}");
}

/// A drive that ends exactly in a dead centre: `check` and a run that cannot end there name it; a motion that can is not stopped.
#[test]
fn a_drive_may_end_in_its_limit() {
    let text = |reach: f64| {
        let [x, y]: [f64; 2] = [1.0 / 60.0, (0.01_f64 - 1.0 / 3600.0).sqrt()];
        slider_crank(
            0.1,
            0.3,
            &format!(
                "drives.m = {{ type = \"point\", point = \"slider.center\", x = {{ type = \"smooth_step\", from = {:?}, to = {reach:?}, start = 0.0, duration = 1.5 }} }}",
                x + (0.09 - y * y).sqrt()
            ),
            [x, y],
            2.0,
        )
    };
    let at_end = limit(&text(0.4));
    assert!(
        (at_end.t - 1.5).abs() < 1e-3 && !at_end.stops_the_motion(),
        "{at_end}"
    );
    let beyond = limit(&text(0.4 + 1e-6));
    assert!(beyond.t < 1.5 && beyond.stops_the_motion(), "{beyond}");
    for found in [at_end, beyond] {
        assert!(
            found
                .to_string()
                .contains("cannot move slider.center beyond x = 0.4 m"),
            "{found}"
        );
        assert!(found.cause.contains("crank and rod are in line"), "{found}");
    }
    assert!(matches!(
        simulation(&text(0.4 - 1e-6)).drive_course(),
        DriveCourse::Complete
    ));
}

/// A static analysis does not follow an arc past the toggle of its crank: it ends with the words of `check`.
#[test]
fn a_static_drive_ends_at_its_limit() {
    let text = four_bar([0.6, 0.5, 0.3, 0.45], 0.6, "\"0.6 + 0.5*t\"", 3.0);
    for method in ["", "analysis = \"static\", "] {
        let text = text.replace("simulation = { ", &format!("simulation = {{ {method}"));
        let mut simulation = simulation(&text);
        let Err(error) = simulation.run(&mut ()) else {
            panic!("{text}");
        };
        assert!(
            matches!(error, RunError::DriveLimit(_))
                && error.to_string().contains("at t = 1.7830935 s"),
            "{error}"
        );
    }
}

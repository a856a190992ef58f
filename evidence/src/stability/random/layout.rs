//! Where the points of a mechanism are, and which bodies go through them.

use super::genes::Tape;
use looselink::math::plane::{Vec2, quarter_turn, unit};

/// Kinds of mechanism, the plainest first; what there is most to vary of stands more than once.
pub const TOPOLOGIES: [&str; 13] = [
    "chain", "chain", "chain", "four-bar", "four-bar", "slider", "slider", "slot", "bars",
    "parallel", "parallel", "springs", "journal",
];
/// Those that have no loop, and so no singular pose.
pub const OPEN: [&str; 4] = ["chain", "slot", "springs", "journal"];

/// Points, and through which of them bodies go.
pub struct Layout {
    /// Points \[m\].
    pub points: Vec<Vec2>,
    /// Digits of the points of the ground, then of every body.
    pub members: String,
    /// Member and point of a guide, of its slider, and its direction \[rad\].
    pub slide: Option<([usize; 2], [usize; 2], f64)>,
}

/// The points of a mechanism of this kind and size.
pub fn layout(topology: &str, tape: &mut Tape, size: f64, near_singular: bool) -> Layout {
    let at = |x: f64, y: f64| size * Vec2::new(x, y);
    let crank =
        |tape: &mut Tape, axis: Vec2| axis + size * tape.between(0.2, 0.5) * unit(tape.angle());
    let near = |tape: &mut Tape, low: f64, high: f64| {
        let (near, far) = (tape.decades(-4.0, -2.0), tape.between(low, high));
        if near_singular { near } else { far }
    };
    // a point beside the middle of two others, out of their line: the third corner of a triangle
    let apex = |tape: &mut Tape, a: Vec2, b: Vec2| {
        let height = near(tape, 0.3, 1.0);
        a + tape.between(0.35, 0.65) * (b - a) + height * quarter_turn(b - a)
    };
    let a = Vec2::zeros();
    let mut slide = None;
    let (points, members) = match topology {
        "chain" => {
            let links = tape.whole(1, 4);
            let (flies, hung) = (tape.chance(0.3), tape.chance(0.4));
            let mut points = vec![a];
            let mut members = if flies { "-" } else { "0" }.to_owned();
            for k in 0..links {
                let reach = size * tape.between(0.5, 1.5);
                points.push(points[k] + reach * unit(tape.angle()));
                members += &format!(" {k}{}", k + 1);
            }
            if hung {
                members += &format!(" {links}");
            }
            return Layout {
                points,
                members,
                slide,
            };
        }
        "springs" => {
            let places = (0..=tape.whole(1, 4)).map(|k| at(k as f64, tape.between(0.0, 0.3)));
            let points: Vec<Vec2> = places.collect();
            let members = &"0 1 2 3 4"[..2 * points.len() - 1];
            (points, members)
        }
        "four-bar" => {
            let (b, d) = (crank(tape, a), at(tape.between(0.8, 1.5), 0.0));
            (vec![a, b, apex(tape, b, d), d], "03 01 12 23")
        }
        "slider" => {
            let b = crank(tape, a);
            let reach = near(tape, 0.6, 1.2);
            let pin = Vec2::new(b.x + size * reach, size * tape.between(0.0, 0.1));
            slide = Some(([0, 2], [3, 2], 0.0));
            (vec![a, b, pin], "0 01 12 2")
        }
        "slot" => {
            let (b, foot) = (crank(tape, a), at(0.0, -1.0));
            let way = b - foot;
            slide = Some(([2, 2], [1, 1], way.y.atan2(way.x)));
            (vec![a, b, foot, foot + 1.5 * way], "02 01 23")
        }
        // three equal bars between the ground and one body: the third repeats the constraints of the others
        "bars" => {
            let bar = 0.6 * size * unit(near(tape, 0.4, 2.7));
            let feet = [0.0, 0.5, 1.0].map(|x| at(x, 0.0));
            let points = [feet, feet.map(|foot| foot + bar)].concat();
            (points, "012 345 03 14 25")
        }
        // a platform on three legs, each a crank and a rod
        "parallel" => {
            let turn = tape.between(-0.3, 0.3);
            let angles = [0.5, 2.6, 4.7];
            let feet = angles.map(|angle| size * unit(angle));
            let corners = angles.map(|angle| 0.3 * size * unit(angle + turn));
            let elbows = [0, 1, 2].map(|k| apex(tape, feet[k], corners[k]));
            let points = [feet, elbows, corners].concat();
            (points, "012 678 03 14 25 36 47 58")
        }
        // in a bearing of the ground, or of a body that flies
        _ => match tape.chance(0.5) {
            true => (vec![a, at(1.0, 0.0)], "- 01 0"),
            false => (vec![a], "0 0"),
        },
    };
    Layout {
        points,
        members: members.to_owned(),
        slide,
    }
}

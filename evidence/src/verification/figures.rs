//! Convergence pictures: error against abscissa, with the slopes that bound the order.

use ladder::{Allowed, Answer, ErrorCurve};
use numbers::digits;
use plot::{Axis, Figure, Mark, Panel, palette};

/// Panels a row.
const COLUMNS: usize = 3;
/// A panel with more curves than this has no legend for them.
const LABELLED: usize = 6;

/// All curves of a rung with this title. Curves share a panel that are asked for at one place of one test, over the same
/// abscissae, with the same bounds.
pub fn convergence<'a>(title: &str, answers: impl Iterator<Item = &'a Answer>) -> Figure {
    let mut families: Vec<Vec<(&Answer, &ErrorCurve)>> = Vec::new();
    let key =
        |(a, curve): (&Answer, &ErrorCurve)| (a.file.clone(), a.line, a.allowed, curve.errors[0].0);
    for answer in answers {
        let Some(curve) = &answer.curve else { continue };
        let one = (answer, curve);
        match families.iter_mut().find(|f| key(f[0]) == key(one)) {
            Some(family) => family.push(one),
            None => families.push(vec![one]),
        }
    }
    let caption = format!(
        "{title}: measured errors (dots) and the least and greatest slopes that the tests allow (lines). Where a panel has \
         several curves, each is divided by its error at the largest abscissa. The table has scene, method and reference \
         of every curve."
    );
    let panels = families.iter().filter_map(|family| panel(family));
    Figure::grid(panels.collect(), COLUMNS, caption)
}

fn panel(family: &[(&Answer, &ErrorCurve)]) -> Option<Panel> {
    let Allowed::Between(low, high) = family[0].0.allowed else {
        return None;
    };
    let (_, longest) = family.iter().max_by_key(|(_, c)| c.errors.len())?;
    let alone = family.len() == 1;
    let unit = |curve: &ErrorCurve| if alone { 1.0 } else { curve.errors[0].1 };
    let (start, first) = longest.errors[0];
    let top = first / unit(longest);
    let x: Vec<f64> = longest.errors.iter().map(|e| e.0).collect();
    let bounds = [(low, palette::GREY), (high, palette::BLACK)];
    let mut marks: Vec<Mark> = Vec::from(bounds.map(|(order, color)| {
        let y: Vec<f64> = x.iter().map(|x| top * (x / start).powf(order)).collect();
        Mark::curve(&format!("slope {}", digits(order)), color, &x, &y)
    }));
    let questions: Vec<&str> = family.iter().map(|(a, _)| a.question.as_str()).collect();
    let (note, own) = common(&questions);
    let colors = palette::SERIES[..LABELLED].iter().cycle();
    for (((_, curve), own), color) in family.iter().zip(&own).zip(colors) {
        let errors = curve.errors.iter();
        let (x, y): (Vec<f64>, Vec<f64>) = errors.map(|e| (e.0, e.1 / unit(curve))).unzip();
        let label = if family.len() <= LABELLED { own } else { "" };
        marks.push(Mark::curve("", *color, &x, &y));
        marks.push(Mark::points(label, *color, &x, &y, 8));
    }
    let orders = || family.iter().map(|(a, _)| (1e2 * a.number).round() / 1e2);
    let (least, greatest) = (
        orders().fold(f64::INFINITY, f64::min),
        orders().fold(f64::NEG_INFINITY, f64::max),
    );
    Some(Panel {
        title: match least == greatest {
            true => format!("Order {}", digits(least)),
            false => format!("Order {} … {}", digits(least), digits(greatest)),
        },
        note,
        x: Axis::new(&longest.abscissa, "", 1.0).log(),
        y: match alone {
            true => Axis::new("Error", "", 1.0).log(),
            false => Axis::new("Error over its largest value", "", 1.0).log(),
        },
        marks,
    })
}

/// What the questions begin and end with, and what is left of each.
fn common(questions: &[&str]) -> (String, Vec<String>) {
    let words: Vec<Vec<&str>> = questions.iter().map(|q| q.split(' ').collect()).collect();
    let first = &words[0];
    if words.len() == 1 {
        return (questions[0].to_owned(), vec![String::new()]);
    }
    let shortest = words.iter().map(Vec::len).min().unwrap_or(0);
    let begins = |i: &usize| words.iter().all(|w| w[*i] == first[*i]);
    let head = (0..shortest).take_while(begins).count();
    let ends = |i: &usize| {
        let mut words = words.iter();
        words.all(|w| w[w.len() - 1 - i] == first[first.len() - 1 - i])
    };
    let tail = (0..shortest - head).take_while(ends).count();
    let joined = [&first[..head], &["…"], &first[first.len() - tail..]].concat();
    let own = words.iter().map(|w| w[head..w.len() - tail].join(" "));
    let own = own.map(|own| own.trim_end_matches([',', ':']).to_owned());
    (joined.join(" "), own.collect())
}

#[cfg(test)]
mod tests {
    use super::common;

    #[test]
    fn families_are_named_by_what_they_share() {
        let (shared, own) = common(&["pendulum, n = 1: tip [m]", "pendulum, n = 2: tip [m]"]);
        assert_eq!(shared, "pendulum, n = … tip [m]");
        assert_eq!(own, ["1", "2"]);
        assert_eq!(common(&["alone"]).0, "alone");
    }
}

//! Convergence pictures: error against abscissa, with the slopes that bound the order.

use ladder::{Allowed, Answer, ErrorCurve, Rung};
use plot::{Axis, Figure, Mark, Panel, palette};

/// Panels a row.
const COLUMNS: usize = 3;
/// Colours of curves; a seventh curve has the first again.
const COLORS: usize = 6;
/// A panel with more curves than this has no legend for them.
const LABELLED: usize = 6;

/// All curves of a rung; none when it has no curves.
pub fn convergence(rung: Rung, answers: &[Answer]) -> Option<Figure> {
    let mut families: Vec<Vec<&Answer>> = Vec::new();
    for answer in answers.iter().filter(|a| a.rung == rung) {
        if answer.curve.is_none() {
            continue;
        }
        match families.iter_mut().find(|f| are_kin(f[0], answer)) {
            Some(family) => family.push(answer),
            None => families.push(vec![answer]),
        }
    }
    let panels: Vec<Panel> = families.iter().filter_map(|f| panel(f)).collect();
    if panels.is_empty() {
        return None;
    }
    let rows = panels.len().div_ceil(COLUMNS);
    let mut panels = panels.into_iter();
    let rows = (0..rows).map(|_| panels.by_ref().take(COLUMNS).collect());
    let (title, _) = rung.title();
    Some(Figure {
        rows: rows.collect(),
        caption: format!(
            "{title}: measured errors (dots) and the least and greatest slopes that the tests allow (lines). Where a panel \
             has several curves, each is divided by its error at the largest abscissa. The table has scene, method and \
             reference of every curve."
        ),
    })
}

/// Asked at one place of one test, over the same abscissae, with the same bounds.
fn are_kin(a: &Answer, b: &Answer) -> bool {
    let start = |x: &Answer| x.curve.as_ref().and_then(ErrorCurve::start).map(|(h, _)| h);
    (&a.file, a.line, a.allowed) == (&b.file, b.line, b.allowed) && start(a) == start(b)
}

fn panel(family: &[&Answer]) -> Option<Panel> {
    let Allowed::Between(low, high) = family[0].allowed else {
        return None;
    };
    let curves: Vec<&ErrorCurve> = family.iter().filter_map(|a| a.curve.as_ref()).collect();
    let longest = curves.iter().max_by_key(|c| c.errors.len())?;
    let (start, top) = longest.start()?;
    let alone = family.len() == 1;
    let top = if alone { top } else { 1.0 };
    let x: Vec<f64> = longest.errors.iter().map(|e| e.0).collect();
    let mut marks: Vec<Mark> = [(low, palette::GREY), (high, palette::BLACK)]
        .map(|(order, color)| {
            let y: Vec<f64> = x.iter().map(|x| top * (x / start).powf(order)).collect();
            Mark::curve(&format!("slope {}", numbers::digits(order)), color, &x, &y)
        })
        .into();
    let questions: Vec<&str> = family.iter().map(|a| a.question.as_str()).collect();
    let (common, own) = common(&questions);
    for (i, curve) in curves.iter().enumerate() {
        let (_, first) = curve.start()?;
        let unit = if alone { 1.0 } else { first };
        let (x, y): (Vec<f64>, Vec<f64>) = curve.errors.iter().map(|e| (e.0, e.1 / unit)).unzip();
        let color = palette::SERIES[i % COLORS];
        let label = match (alone, family.len() <= LABELLED) {
            (false, true) => own[i].as_str(),
            _ => "",
        };
        marks.push(Mark::curve("", color, &x, &y));
        marks.push(Mark::points(label, color, &x, &y, 8));
    }
    let orders = family.iter().map(|a| a.number);
    let least = orders.clone().fold(f64::INFINITY, f64::min);
    let greatest = orders.fold(f64::NEG_INFINITY, f64::max);
    let order = |x: f64| numbers::digits((1e2 * x).round() / 1e2);
    let title = match (alone, order(least) == order(greatest)) {
        (false, false) => format!("Order {} … {}", order(least), order(greatest)),
        _ => format!("Order {}", order(least)),
    };
    let note = match family.len() {
        1 => common,
        n if n <= LABELLED => common,
        n => format!("{n} curves: {}, and others", questions[0]),
    };
    let y = if alone {
        "Error"
    } else {
        "Error over its largest value"
    };
    Some(Panel {
        title,
        note,
        x: Axis::new(&longest.abscissa, "", 1.0).log(),
        y: Axis::new(y, "", 1.0).log(),
        marks,
    })
}

/// What the questions begin and end with, and what is left of each.
fn common(questions: &[&str]) -> (String, Vec<String>) {
    let words: Vec<Vec<&str>> = questions.iter().map(|q| q.split(' ').collect()).collect();
    let shortest = words.iter().map(Vec::len).min().unwrap_or(0);
    if words.len() == 1 {
        return (questions[0].to_owned(), vec![String::new()]);
    }
    let agree = |pick: &dyn Fn(&Vec<&str>) -> String| {
        let first = pick(&words[0]);
        words.iter().all(|w| pick(w) == first)
    };
    let head = (0..shortest).take_while(|&i| agree(&|w| w[i].to_owned()));
    let head = head.count();
    let tail = (0..shortest - head).take_while(|&i| agree(&|w| w[w.len() - 1 - i].to_owned()));
    let tail = tail.count();
    let first = &words[0];
    let joined = [&first[..head], &["…"], &first[first.len() - tail..]].concat();
    let own = words.iter().map(|w| {
        w[head..w.len() - tail]
            .join(" ")
            .trim_end_matches([',', ':'])
            .to_owned()
    });
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

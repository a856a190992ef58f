//! The orders that tests measure, between those that they allow.

use ladder::{Allowed, Answer};
use plot::{Axis, Figure, Mark, Panel, palette};

/// A panel of each title with its answers.
pub fn orders<'a>(rungs: impl Iterator<Item = (&'a str, Vec<&'a Answer>)>) -> Figure {
    let caption = "Orders: a dot is what a test measures, the band has the least and the greatest order that it allows. The page of all \
                   questions has scene, method, step and reference of each.";
    let panels = rungs.map(|(title, answers)| panel(title, &answers));
    Figure::grid(panels.collect(), 2, caption.to_owned())
}

fn panel(title: &str, answers: &[&Answer]) -> Panel {
    let orders = answers.iter().filter_map(|answer| match answer.allowed {
        Allowed::Between(low, high) => Some([low, high, answer.number]),
        Allowed::AtMost(_) => None,
    });
    let mut orders: Vec<[f64; 3]> = orders.collect();
    // bands of one order side by side
    let middle = |[low, high, _]: &[f64; 3]| low + high;
    orders.sort_by(|a, b| middle(a).total_cmp(&middle(b)).then(a[2].total_cmp(&b[2])));
    let x: Vec<f64> = (1..=orders.len()).map(|k| k as f64).collect();
    let [low, high, measured] = [0, 1, 2].map(|i| orders.iter().map(|o| o[i]).collect::<Vec<_>>());
    Panel {
        title: title.to_owned(),
        note: String::new(),
        x: Axis::new("Question, by the order that is allowed", "", 1.0),
        y: Axis::new("Order", "", 1.0),
        marks: vec![
            Mark::band("allowed", palette::GREY, &x, &low, &high),
            Mark::points("measured", palette::BLUE, &x, &measured, 4),
        ],
    }
}

#[cfg(test)]
mod tests {
    use super::panel;
    use ladder::{Allowed, Answer, Rung};

    #[test]
    fn every_order_stands_between_its_bounds() {
        let answer = |number, allowed| Answer {
            rung: Rung::OrderInTime,
            question: String::new(),
            source: None,
            number,
            allowed,
            reason: String::new(),
            file: String::new(),
            line: 0,
            curve: None,
        };
        let five = answer(5.0, Allowed::Between(4.8, 5.2));
        let two = answer(2.0, Allowed::Between(1.9, 2.1));
        let none = answer(0.1, Allowed::AtMost(1.0));
        let marks = panel("", &[&five, &two, &none]).marks;
        assert_eq!(marks[1].y, [2.0, 5.0]);
        // to the right along the upper bounds and back along the lower ones
        assert_eq!(marks[0].y, [2.1, 5.2, 4.8, 1.9]);
    }
}

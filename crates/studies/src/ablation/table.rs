//! Tables as aligned text and as Markdown.

use std::fmt::Write;

/// Names in the first column, numbers in the others.
#[derive(Debug, Clone)]
pub(super) struct Table {
    head: Vec<String>,
    rows: Vec<(String, Cells)>,
}

/// What stands behind the name of a row.
#[derive(Debug, Clone)]
enum Cells {
    Numbers(Vec<String>),
    Note(String),
}

impl Table {
    /// A table with these columns, the first that of the names.
    pub fn new(head: &[&str]) -> Table {
        Table {
            head: head.iter().map(|h| (*h).to_owned()).collect(),
            rows: Vec::new(),
        }
    }

    /// Adds a row of numbers, or of one remark in their place.
    pub fn row(&mut self, name: String, numbers: Result<Vec<String>, String>) {
        let cells = match numbers {
            Ok(numbers) => Cells::Numbers(numbers),
            Err(note) => Cells::Note(note),
        };
        self.rows.push((name, cells));
    }

    /// Columns of equal width for a terminal, names to the left, numbers to the right.
    pub fn text(&self) -> String {
        let width = |text: &str| text.chars().count();
        let mut widths: Vec<usize> = self.head.iter().map(|h| width(h)).collect();
        for (name, cells) in &self.rows {
            widths[0] = widths[0].max(width(name));
            if let Cells::Numbers(numbers) = cells {
                for (w, number) in widths[1..].iter_mut().zip(numbers) {
                    *w = (*w).max(width(number));
                }
            }
        }
        let mut out = String::new();
        let mut line = |name: &str, numbers: &[String]| {
            let mut text = format!("  {name:<0$}", widths[0]);
            for (number, w) in numbers.iter().zip(&widths[1..]) {
                write!(text, "  {number:>w$}").expect("a string takes any text");
            }
            out.push_str(text.trim_end());
            out.push('\n');
        };
        line(&self.head[0], &self.head[1..]);
        for (name, cells) in &self.rows {
            match cells {
                Cells::Numbers(numbers) => line(name, numbers),
                Cells::Note(note) => line(name, std::slice::from_ref(note)),
            }
        }
        out
    }

    /// A table for a page; a remark stands in the second column.
    pub fn markdown(&self) -> String {
        let rule: Vec<String> = (0..self.head.len())
            .map(|column| if column == 0 { "---" } else { "---:" }.to_owned())
            .collect();
        let mut out = markdown_row(&self.head) + &markdown_row(&rule);
        for (name, cells) in &self.rows {
            let mut row = vec![name.clone()];
            match cells {
                Cells::Numbers(numbers) => row.extend(numbers.iter().cloned()),
                Cells::Note(note) => row.push(note.clone()),
            }
            row.resize(self.head.len(), String::new());
            out += &markdown_row(&row);
        }
        out
    }
}

fn markdown_row(cells: &[String]) -> String {
    let cells: Vec<String> = cells.iter().map(|c| c.replace('|', "\\|")).collect();
    format!("| {} |\n", cells.join(" | "))
}

#[cfg(test)]
mod tests {
    use super::Table;

    #[test]
    fn both_forms_have_all_cells() {
        let mut table = Table::new(&["variant", "error", "force"]);
        table.row("+ a".into(), Ok(vec!["1.5\u{a0}µm".into(), "–".into()]));
        table.row("− b".into(), Err("not possible: x | y".into()));
        assert_eq!(
            table.text(),
            "  variant   error  force\n  + a      1.5\u{a0}µm      –\n  − b      not possible: x | y\n"
        );
        assert_eq!(
            table.markdown(),
            "| variant | error | force |\n| --- | ---: | ---: |\n| + a | 1.5\u{a0}µm | – |\n\
             | − b | not possible: x \\| y |  |\n"
        );
    }
}

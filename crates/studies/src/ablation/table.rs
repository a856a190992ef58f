//! Tables as aligned text and as Markdown.

use texts::markdown::cell;

/// Names in the first column, numbers in the others.
#[derive(Debug, Clone)]
pub(super) struct TextTable {
    /// The heads, then the rows; one that is shorter than the heads is a name and a remark.
    lines: Vec<Vec<String>>,
}

impl TextTable {
    /// A table with these columns, the first that of the names.
    pub fn new(head: &[&str]) -> TextTable {
        let head = head.iter().map(|h| (*h).to_owned()).collect();
        TextTable { lines: vec![head] }
    }

    /// Adds a row of numbers, or of one remark in their place.
    pub fn row(&mut self, name: String, numbers: Result<Vec<String>, String>) {
        let mut line = numbers.unwrap_or_else(|remark| vec![remark]);
        line.insert(0, name);
        self.lines.push(line);
    }

    /// Columns of equal width for a terminal, names to the left, numbers to the right.
    pub fn text(&self) -> String {
        let columns = self.lines[0].len();
        let mut widths = vec![0; columns];
        for line in &self.lines {
            // a remark may be longer than its column
            let cells = if line.len() < columns { 1 } else { columns };
            for (width, cell) in widths.iter_mut().zip(&line[..cells]) {
                *width = cell.chars().count().max(*width);
            }
        }
        let mut out = String::new();
        for line in &self.lines {
            let mut text = format!("  {:<1$}", line[0], widths[0]);
            for (cell, width) in line.iter().zip(&widths).skip(1) {
                text += &format!("  {cell:>width$}");
            }
            out += &format!("{}\n", text.trim_end());
        }
        out
    }

    /// A table for a page; a remark stands in the second column.
    pub fn markdown(&self) -> String {
        let columns = self.lines[0].len();
        let rows = self.lines.iter().map(|line| {
            let mut cells: Vec<String> = line.iter().map(|text| cell(text)).collect();
            cells.resize(columns, String::new());
            format!("| {} |\n", cells.join(" | "))
        });
        let mut rows: Vec<String> = rows.collect();
        rows.insert(1, format!("| ---{} |\n", " | ---:".repeat(columns - 1)));
        rows.concat()
    }
}

#[cfg(test)]
mod tests {
    use super::TextTable;

    #[test]
    fn both_forms_have_all_cells() {
        let mut table = TextTable::new(&["variant", "error", "force"]);
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

//! Tables of text that fit 120 columns, and the numbers in them.

use super::output::one_line;

/// Widest line of any table.
pub(crate) const WIDTH: usize = 120;

/// Three significant digits or more, so that 0.014 ms and 1824 ms both say something.
pub(crate) fn milliseconds(ms: f64) -> String {
    let decimals = match ms {
        ms if ms < 9.9995 => 3,
        ms if ms < 99.995 => 2,
        ms if ms < 999.95 => 1,
        _ => 0,
    };
    format!("{ms:.decimals$}")
}

/// One line without control characters, cut to the table's width, with a sign that it was cut.
pub(crate) fn clipped(line: &str) -> String {
    let line = &*one_line(line);
    if line.chars().count() <= WIDTH {
        return line.to_string();
    }
    line.chars().take(WIDTH - 1).chain(['…']).collect()
}

/// Rows with a label on the left and right-aligned cells.
pub(crate) struct Grid {
    heads: Vec<&'static str>,
    label_limit: usize,
    pub(crate) rows: Vec<(String, Vec<String>)>,
}

impl Grid {
    pub(crate) fn new(heads: Vec<&'static str>, label_limit: usize) -> Self {
        Self { heads, label_limit, rows: Vec::new() }
    }

    /// Lets labels be as long as the columns leave room for.
    pub(crate) fn fill_width(&mut self) {
        let columns: usize = self.widths().iter().map(|width| 2 + width).sum();
        self.label_limit = WIDTH.saturating_sub(columns);
    }

    /// Lines that a row with this label takes.
    pub(crate) fn lines_of(&self, label: &str) -> usize {
        let length = one_line(label).chars().count();
        if length <= self.label_limit {
            1
        } else {
            length.div_ceil(WIDTH) + 1
        }
    }

    /// Letters of each column.
    fn widths(&self) -> Vec<usize> {
        let width = |column: usize| {
            let cells = self.rows.iter().map(|(_, cells)| cells[column].chars().count());
            cells.chain([self.heads[column].chars().count()]).max().unwrap_or(0)
        };
        (0..self.heads.len()).map(width).collect()
    }

    pub(crate) fn lines(&self, label_head: &str) -> Vec<String> {
        // Labels may name files.
        let labels: Vec<_> = self.rows.iter().map(|(label, _)| one_line(label)).collect();
        let fitting = labels.iter().map(|label| label.chars().count());
        let fitting = fitting.filter(|&length| length <= self.label_limit);
        let label_width = fitting.chain([label_head.chars().count()]).max().unwrap_or(0);
        let widths = self.widths();
        let line = |label: &str, cells: &mut dyn Iterator<Item = &str>| {
            let mut line = format!("{label:label_width$}");
            for (cell, width) in cells.zip(&widths) {
                line.push_str(&format!("  {cell:>width$}"));
            }
            line
        };
        let mut lines = vec![line(label_head, &mut self.heads.iter().copied())];
        for (label, (_, cells)) in labels.iter().zip(&self.rows) {
            let mut cells = cells.iter().map(String::as_str);
            if self.lines_of(label) == 1 {
                lines.push(line(label, &mut cells));
                continue;
            }
            let letters: Vec<char> = label.chars().collect();
            lines.extend(letters.chunks(WIDTH).map(|part| part.iter().collect()));
            lines.push(line("", &mut cells));
        }
        lines
    }
}

//! Tables of numbers for people: aligned text, or Markdown for reports.

use std::fmt;

use evenlight::Vector;
use evenlight::mesh::isolation::Place;
use evenlight::surface::ExtraordinaryPoint;

/// Rows of cells under a header.
pub struct Table {
    header: Vec<String>,
    rows: Vec<Vec<String>>,
}

impl Table {
    /// A table without rows.
    pub fn new(header: &[&str]) -> Self {
        Self { header: header.iter().map(ToString::to_string).collect(), rows: Vec::new() }
    }

    /// Appends a row with as many cells as the header has.
    pub fn push(&mut self, cells: impl IntoIterator<Item = String>) {
        self.rows.push(cells.into_iter().collect());
    }

    /// The table in Markdown.
    pub fn markdown(&self) -> String {
        let line = |cells: &[String]| format!("| {} |\n", cells.join(" | "));
        let rule = |k| if self.is_numeric(k) { "---:" } else { "---" }.to_owned();
        let rule: Vec<String> = (0..self.header.len()).map(rule).collect();
        let rows = self.rows.iter().map(|row| line(row));
        [line(&self.header), line(&rule)].into_iter().chain(rows).collect()
    }

    /// Whether a column holds numbers only, or nothing.
    fn is_numeric(&self, column: usize) -> bool {
        let mut cells = self.rows.iter().filter_map(|row| row.get(column));
        cells.all(|cell| cell == NONE || cell.parse::<f64>().is_ok())
    }

    fn width(&self, column: usize) -> usize {
        let cells = self.rows.iter().chain([&self.header]).filter_map(|row| row.get(column));
        cells.map(|cell| cell.chars().count()).max().unwrap_or_default()
    }

    fn padded(&self, column: usize, cell: &str) -> String {
        let width = self.width(column);
        if self.is_numeric(column) { format!("{cell:>width$}") } else { format!("{cell:<width$}") }
    }
}

/// Numbers aligned to the right, text to the left, two blanks between columns.
impl fmt::Display for Table {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        for row in [&self.header].into_iter().chain(&self.rows) {
            let cells = row.iter().enumerate().map(|(k, cell)| self.padded(k, cell));
            writeln!(f, "{}", cells.collect::<Vec<_>>().join("  ").trim_end())?;
        }
        Ok(())
    }
}

/// The cell for a number that does not exist.
const NONE: &str = "-";

/// `x` with four significant digits; powers of ten only for what is very large or small.
///
/// A number that does not exist (NaN, or an end of an empty range) is `-`.
pub fn short(x: f64) -> String {
    if !x.is_finite() {
        return NONE.to_owned();
    }
    let size = x.abs();
    match size {
        0.0 => "0".to_owned(),
        1e-3..1e5 => {
            let digits_before = size.log10().floor() as i32 + 1;
            format!("{x:.0$}", (4 - digits_before).max(0) as usize)
        }
        _ => format!("{x:.2e}"),
    }
}

/// Three numbers as [`short`] writes them.
pub fn triple(v: Vector) -> String {
    v.map(short).join(" ")
}

/// `vertex 7`, or `face 7` for the centre of a face that is no quad.
pub fn point_name(point: &ExtraordinaryPoint) -> String {
    match point.place {
        Place::Vertex(v) => format!("vertex {}", v.0),
        Place::FaceCentre(f) => format!("face {}", f.0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_are_aligned() {
        let mut table = Table::new(&["n", "lambda", "scheme"]);
        table.push(["10", "0.5", "eg"].map(str::to_owned));
        assert_eq!(table.to_string(), " n  lambda  scheme\n10     0.5  eg\n");
        let expected = "| n | lambda | scheme |\n| ---: | ---: | --- |\n| 10 | 0.5 | eg |\n";
        assert_eq!(table.markdown(), expected);
    }

    #[test]
    fn numbers_have_four_digits() {
        let numbers = [0.0, 1.0, -0.123456, 12345.678, 1e-16, 3e9, f64::NAN, f64::INFINITY];
        let expected = ["0", "1.000", "-0.1235", "12346", "1.00e-16", "3.00e9", "-", "-"];
        assert_eq!(numbers.map(short), expected);
    }
}

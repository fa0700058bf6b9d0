//! What the shapes and lines of a plot stand for.

use super::Series;
use super::marks::{line, shape, text};

/// Height of a row.
const ROW: f64 = 20.0;
/// Length of the piece of line in a row.
const SAMPLE: f64 = 24.0;
/// From a line of text's middle down to the line it stands on.
pub(super) const BASELINE: f64 = 4.0;

/// A row for each series, from (x, y) down.
pub(super) fn legend(series: &[Series], (x, y): (f64, f64)) -> String {
    let row = |(place, one): (usize, &Series)| {
        let y = y + ROW * (place as f64 + 0.5);
        let sample = line(one, &[(x, y), (x + SAMPLE, y)]);
        let mark = shape(one, (x + 0.5 * SAMPLE, y), "");
        let name = text("plot-text", (x + SAMPLE + 8.0, y + BASELINE), "start", &one.name);
        format!("{sample}{mark}{name}")
    };
    series.iter().enumerate().map(row).collect()
}

/// Height of the legend of so many series.
pub(super) fn height(series: usize) -> f64 {
    ROW * series as f64
}

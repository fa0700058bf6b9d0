//! Shapes and lines of a plot, in its own units.

use super::{Mark, Series, Stroke};
use crate::report::html::escape;

/// Half the size of a shape.
const HALF: f64 = 4.0;
/// Radius of a ring.
const RING: f64 = 8.0;

/// A shape at (x, y), with its tooltip in a browser.
pub(super) fn shape(series: &Series, (x, y): (f64, f64), title: &str) -> String {
    let class = series.class();
    let title = if title.is_empty() { String::new() } else { format!("<title>{}</title>", escape(title)) };
    let polygon = |corners: &[(f64, f64)]| {
        let corners: Vec<String> =
            corners.iter().map(|(dx, dy)| format!("{:.2},{:.2}", x + dx, y + dy)).collect();
        format!("<polygon class=\"plot-mark {class}\" points=\"{}\">{title}</polygon>", corners.join(" "))
    };
    match series.mark {
        Mark::None => String::new(),
        Mark::Dot => {
            format!(
                "<circle class=\"plot-mark {class}\" cx=\"{x:.2}\" cy=\"{y:.2}\" r=\"{HALF}\">{title}</circle>"
            )
        }
        Mark::Ring => {
            format!(
                "<circle class=\"plot-ring {class}\" cx=\"{x:.2}\" cy=\"{y:.2}\" r=\"{RING}\">{title}</circle>"
            )
        }
        Mark::Square => polygon(&[(-HALF, -HALF), (HALF, -HALF), (HALF, HALF), (-HALF, HALF)]),
        Mark::Diamond => {
            let far = 1.3 * HALF;
            polygon(&[(0.0, -far), (far, 0.0), (0.0, far), (-far, 0.0)])
        }
        Mark::Triangle => {
            let far = 1.25 * HALF;
            polygon(&[(0.0, -far), (far, 0.8 * far), (-far, 0.8 * far)])
        }
    }
}

/// The line through places; nothing if the series has none.
pub(super) fn line(series: &Series, places: &[(f64, f64)]) -> String {
    let kind = match series.stroke {
        Stroke::None => return String::new(),
        Stroke::Thin => "plot-line",
        Stroke::Dashed => "plot-line plot-dashed",
        Stroke::Wide => "plot-wide",
    };
    let places: Vec<String> = places.iter().map(|(x, y)| format!("{x:.2},{y:.2}")).collect();
    format!("<polyline class=\"{kind} {}\" points=\"{}\"/>", series.class(), places.join(" "))
}

/// Text at (x, y); `kind` is a CSS class.
pub(super) fn text(kind: &str, (x, y): (f64, f64), anchor: &str, words: &str) -> String {
    format!(
        "<text class=\"{kind}\" x=\"{x:.2}\" y=\"{y:.2}\" text-anchor=\"{anchor}\">{}</text>",
        escape(words)
    )
}

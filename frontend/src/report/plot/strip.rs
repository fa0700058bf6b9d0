//! Curves over time, panel below panel, with rows of marks under them.

use super::marks::text;
use crate::report::html::escape;
use std::fmt::Write;

const STYLE: &str = include_str!("plot.css");
const WIDTH: f64 = 1000.0;
const SIDES: (f64, f64) = (84.0, 980.0);
const TOP: f64 = 46.0;
const PANEL_HEIGHT: f64 = 120.0;
/// Between panels; the names of curves stand in it.
const GAP: f64 = 26.0;
/// From one name of a curve to the next.
const NAME_WIDTH: f64 = 130.0;
/// From one row of marks to the next, and the length of a mark.
const ROW: f64 = 18.0;
const MARK: f64 = 13.0;
const FOOT: f64 = 42.0;
/// Numbers along an axis.
const TICKS: u32 = 4;
/// No axis and no time is shorter.
const LEAST: f64 = 1e-3;

/// A strip.
#[derive(Clone, Debug, Default)]
pub struct Strip {
    /// What it shows.
    pub title: String,
    /// When each thing was so, seconds; they rise.
    pub at_s: Vec<f64>,
    /// From above.
    pub panels: Vec<Panel>,
    /// Below the panels.
    pub rows: Vec<Row>,
}

/// Curves with one axis, which begins at 0.
#[derive(Clone, Debug)]
pub struct Panel {
    /// What is along the axis, with its unit.
    pub name: &'static str,
    /// Where the axis ends at least.
    pub most: f64,
    /// The curves; they are named where there are several.
    pub curves: Vec<Curve>,
}

/// A curve.
#[derive(Clone, Debug)]
pub struct Curve {
    /// What it is.
    pub name: &'static str,
    /// The number of its colour in `plot.css`.
    pub tone: usize,
    /// A value for each time; one that is not finite is nobody's to know.
    pub values: Vec<f64>,
}

/// A row of marks.
#[derive(Clone, Debug)]
pub struct Row {
    /// What is marked.
    pub name: &'static str,
    /// The number of its colour in `plot.css`.
    pub tone: usize,
    /// Whether it is, at each time.
    pub is_marked: Vec<bool>,
}

impl Strip {
    /// An `<svg>` element, which is also a whole file; empty without times.
    pub fn svg(&self) -> String {
        if self.at_s.is_empty() {
            return String::new();
        }
        let rows_top = TOP + self.panels.len() as f64 * (PANEL_HEIGHT + GAP) - GAP + 10.0;
        let foot = rows_top + self.rows.len() as f64 * ROW;
        let height = foot + FOOT;
        let mut svg = format!(
            "<svg class=\"plot\" xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {WIDTH} {height}\" width=\"{WIDTH}\" \
             height=\"{height}\" role=\"img\" aria-label=\"{}\"><style>{STYLE}</style>\
             <rect class=\"plot-ground\" width=\"{WIDTH}\" height=\"{height}\"/>{}",
            escape(&self.title),
            text("plot-title", (SIDES.0, 26.0), "start", &self.title),
        );
        for (number, panel) in self.panels.iter().enumerate() {
            svg += &self.panel(panel, TOP + number as f64 * (PANEL_HEIGHT + GAP));
        }
        for (number, row) in self.rows.iter().enumerate() {
            svg += &self.row(row, rows_top + ROW * number as f64);
        }
        svg + &self.times(foot + 14.0) + "</svg>"
    }

    fn span(&self) -> (f64, f64) {
        let first = self.at_s.first().copied().unwrap_or(0.0);
        let last = self.at_s.last().copied().unwrap_or(0.0);
        (first, (last - first).max(LEAST))
    }

    fn x(&self, at_s: f64) -> f64 {
        let (first, span) = self.span();
        SIDES.0 + (SIDES.1 - SIDES.0) * (at_s - first) / span
    }

    fn panel(&self, panel: &Panel, top: f64) -> String {
        let values = panel.curves.iter().flat_map(|curve| &curve.values);
        let most = values.copied().filter(|value| value.is_finite()).fold(panel.most.max(LEAST), f64::max);
        let base = top + PANEL_HEIGHT;
        let mut svg = grid(base, most, panel.name);
        for curve in &panel.curves {
            let known = self.at_s.iter().zip(&curve.values).filter(|(_, value)| value.is_finite());
            let places = known
                .map(|(&at_s, value)| (self.x(at_s), base - PANEL_HEIGHT * (value / most).clamp(0.0, 1.0)));
            svg += &line(curve.tone, places);
        }
        let named = panel.curves.iter().enumerate().filter(|_| panel.curves.len() > 1);
        for (number, curve) in named {
            svg += &name(curve.tone, curve.name, (SIDES.0 + 4.0 + NAME_WIDTH * number as f64, top - 8.0));
        }
        svg
    }

    fn row(&self, row: &Row, top: f64) -> String {
        let mut svg = name(row.tone, row.name, (30.0, top + 11.0));
        for (&at_s, _) in self.at_s.iter().zip(&row.is_marked).filter(|(_, is_marked)| **is_marked) {
            let (x, tone) = (self.x(at_s), row.tone);
            let _ = write!(
                svg,
                "<line class=\"plot-line plot-t{tone}\" x1=\"{x:.2}\" y1=\"{top:.2}\" x2=\"{x:.2}\" y2=\"{:.2}\"/>",
                top + MARK
            );
        }
        svg
    }

    /// Numbers along the time.
    fn times(&self, y: f64) -> String {
        let (first, span) = self.span();
        let number = |tick: u32| {
            let since_s = span * f64::from(tick) / f64::from(TICKS);
            text("plot-text", (self.x(first + since_s), y), "middle", &format!("{since_s:.2} s"))
        };
        (0..=TICKS).map(number).collect()
    }
}

/// The box of a panel, its numbers and its name.
fn grid(base: f64, most: f64, name: &str) -> String {
    let (left, right) = SIDES;
    let mut svg = format!(
        "<rect class=\"plot-box\" x=\"{left}\" y=\"{:.2}\" width=\"{:.2}\" height=\"{PANEL_HEIGHT}\"/>",
        base - PANEL_HEIGHT,
        right - left
    );
    for tick in 0..=TICKS {
        let share = f64::from(tick) / f64::from(TICKS);
        let (y, value) = (base - PANEL_HEIGHT * share, most * share);
        let digits = if most >= 20.0 { 0 } else { 2 };
        let _ = write!(
            svg,
            "<line class=\"plot-grid\" x1=\"{left}\" y1=\"{y:.2}\" x2=\"{right}\" y2=\"{y:.2}\"/>"
        );
        svg += &text("plot-text", (left - 8.0, y + 4.0), "end", &format!("{value:.digits$}"));
    }
    let middle = base - 0.5 * PANEL_HEIGHT;
    svg + &format!(
        "<g transform=\"translate(22 {middle:.2}) rotate(-90)\">{}</g>",
        text("plot-name", (0.0, 0.0), "middle", name)
    )
}

fn line(tone: usize, places: impl Iterator<Item = (f64, f64)>) -> String {
    let places: Vec<String> = places.map(|(x, y)| format!("{x:.2},{y:.2}")).collect();
    format!("<polyline class=\"plot-line plot-t{tone}\" points=\"{}\"/>", places.join(" "))
}

/// A name in its colour.
fn name(tone: usize, words: &str, (x, y): (f64, f64)) -> String {
    let words = escape(words);
    format!(
        "<g class=\"plot-t{tone}\"><text fill=\"currentColor\" x=\"{x:.2}\" y=\"{y:.2}\">{words}</text></g>"
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    fn strip(at_s: &[f64]) -> Strip {
        let curve = |name, values| Curve { name, tone: 0, values };
        let values: Vec<f64> = at_s.iter().map(|at_s| 0.5 * at_s).collect();
        let from_one_on = at_s.iter().map(|&at_s| if at_s < 1.0 { f64::INFINITY } else { at_s });
        Strip {
            title: "a <b>".to_owned(),
            at_s: at_s.to_vec(),
            panels: vec![
                Panel { name: "alone", most: 100.0, curves: vec![curve("nobody names it", values.clone())] },
                Panel {
                    name: "two",
                    most: 0.0,
                    curves: vec![curve("low", values), curve("high", from_one_on.collect())],
                },
            ],
            rows: vec![Row {
                name: "late",
                tone: 4,
                is_marked: at_s.iter().map(|&at_s| at_s > 1.0).collect(),
            }],
        }
    }

    #[test]
    fn a_strip_is_whole_and_has_its_marks_and_names() {
        let svg = strip(&[0.0, 1.0, 2.0, 3.0]).svg();
        assert!(roxmltree::Document::parse(&svg).is_ok(), "{svg}");
        assert!(!svg.contains("inf") && !svg.contains("NaN"));
        assert_eq!(svg.matches("<line class=\"plot-line plot-t4\"").count(), 2);
        assert!(svg.contains(">low<") && svg.contains(">high<") && !svg.contains("nobody names it"));
        // The first panel ends at 100, the second at its largest value.
        assert!(svg.contains(">100<") && svg.contains(">3.00<"));
    }

    #[test]
    fn one_moment_is_a_strip_and_none_is_not() {
        assert!(roxmltree::Document::parse(&strip(&[2.0]).svg()).is_ok());
        assert_eq!(strip(&[]).svg(), "");
    }
}

//! How frames were controlled over time: a strip with the share of rays cast above, the two errors below, and marks where a
//! picture was begun or shown.

use super::marks::text;
use crate::report::html::escape;
use std::fmt::Write;

const STYLE: &str = include_str!("plot.css");
const WIDTH: f64 = 1000.0;
const SIDES: (f64, f64) = (84.0, 980.0);
const TOP: f64 = 46.0;
const SHARE_HEIGHT: f64 = 110.0;
const ERROR_HEIGHT: f64 = 150.0;
const MARKS_HEIGHT: f64 = 34.0;
const GAP: f64 = 26.0;
const FOOT: f64 = 44.0;
/// Numbers along an axis.
const TICKS: u32 = 4;

/// A tick of frame control.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StripTick {
    /// When it ended, seconds.
    pub at_s: f64,
    /// The share of the picture's rays that are cast.
    pub share: f64,
    /// ζ and τ, in units of 1/255.
    pub errors: [f64; 2],
    /// Whether it began a picture.
    pub begins: bool,
    /// Whether what it made is shown.
    pub shows: bool,
}

/// A strip as an `<svg>` element, which is also a whole file; empty without ticks.
pub fn strip(title: &str, ticks: &[StripTick]) -> String {
    let (Some(first), Some(last)) = (ticks.first(), ticks.last()) else { return String::new() };
    let span = (last.at_s - first.at_s).max(1e-3);
    let x = |at_s: f64| SIDES.0 + (SIDES.1 - SIDES.0) * (at_s - first.at_s) / span;
    let most =
        ticks.iter().flat_map(|tick| tick.errors).filter(|error| error.is_finite()).fold(1e-3, f64::max);
    let share_base = TOP + SHARE_HEIGHT;
    let error_base = share_base + GAP + ERROR_HEIGHT;
    let marks_top = error_base + 10.0;
    let height = marks_top + MARKS_HEIGHT + FOOT;
    let mut svg = format!(
        "<svg class=\"plot\" xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {WIDTH} {height}\" width=\"{WIDTH}\" \
         height=\"{height}\" role=\"img\" aria-label=\"{}\"><style>{STYLE}</style>\
         <rect class=\"plot-ground\" width=\"{WIDTH}\" height=\"{height}\"/>{}",
        escape(title),
        text("plot-title", (SIDES.0, 26.0), "start", title),
    );
    svg += &grid(share_base, SHARE_HEIGHT, 100.0, "rays cast, %");
    svg += &grid(error_base, ERROR_HEIGHT, most, "error, 1/255");
    let y = |base: f64, height: f64, share: f64| base - height * share.clamp(0.0, 1.0);
    svg += &line("plot-t2", ticks.iter().map(|tick| (x(tick.at_s), y(share_base, SHARE_HEIGHT, tick.share))));
    for (number, tone) in ["plot-t0", "plot-t7"].into_iter().enumerate() {
        let known = ticks.iter().filter(|tick| tick.errors[number].is_finite());
        let place =
            |tick: &StripTick| (x(tick.at_s), y(error_base, ERROR_HEIGHT, tick.errors[number] / most));
        svg += &line(tone, known.map(place));
    }
    for (row, (tone, is_marked)) in [
        ("plot-t6", (|tick: &StripTick| tick.begins) as fn(&StripTick) -> bool),
        ("plot-t4", |tick| tick.shows),
    ]
    .into_iter()
    .enumerate()
    {
        let top = marks_top + 18.0 * row as f64;
        for tick in ticks.iter().filter(|tick| is_marked(tick)) {
            let x = x(tick.at_s);
            let _ = write!(
                svg,
                "<line class=\"plot-line {tone}\" x1=\"{x:.2}\" y1=\"{top:.2}\" x2=\"{x:.2}\" y2=\"{:.2}\"/>",
                top + 13.0
            );
        }
    }
    for tick in 0..=TICKS {
        let at_s = first.at_s + span * f64::from(tick) / f64::from(TICKS);
        svg += &text(
            "plot-text",
            (x(at_s), marks_top + MARKS_HEIGHT + 16.0),
            "middle",
            &format!("{:.2} s", at_s - first.at_s),
        );
    }
    let legend = [
        ("plot-t0", "ζ, in space", share_base + GAP - 8.0, SIDES.0 + 4.0),
        ("plot-t7", "τ, in time", share_base + GAP - 8.0, SIDES.0 + 100.0),
        ("plot-t6", "begun", marks_top + 11.0, 30.0),
        ("plot-t4", "shown", marks_top + 29.0, 30.0),
    ];
    for (tone, words, y, x) in legend {
        let _ = write!(
            svg,
            "<g class=\"{tone}\"><text fill=\"currentColor\" x=\"{x:.2}\" y=\"{y:.2}\">{words}</text></g>"
        );
    }
    svg + "</svg>"
}

/// The box of a panel, its numbers and its name.
fn grid(base: f64, height: f64, most: f64, name: &str) -> String {
    let (left, right) = SIDES;
    let mut svg = format!(
        "<rect class=\"plot-box\" x=\"{left}\" y=\"{:.2}\" width=\"{:.2}\" height=\"{height}\"/>",
        base - height,
        right - left
    );
    for tick in 0..=TICKS {
        let share = f64::from(tick) / f64::from(TICKS);
        let (y, value) = (base - height * share, most * share);
        let digits = if most >= 20.0 { 0 } else { 2 };
        let _ = write!(
            svg,
            "<line class=\"plot-grid\" x1=\"{left}\" y1=\"{y:.2}\" x2=\"{right}\" y2=\"{y:.2}\"/>"
        );
        svg += &text("plot-text", (left - 8.0, y + 4.0), "end", &format!("{value:.digits$}"));
    }
    let middle = base - 0.5 * height;
    svg + &format!(
        "<g transform=\"translate(22 {middle:.2}) rotate(-90)\">{}</g>",
        text("plot-name", (0.0, 0.0), "middle", name)
    )
}

fn line(tone: &str, places: impl Iterator<Item = (f64, f64)>) -> String {
    let places: Vec<String> = places.map(|(x, y)| format!("{x:.2},{y:.2}")).collect();
    format!("<polyline class=\"plot-line {tone}\" points=\"{}\"/>", places.join(" "))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_strip_is_whole_and_has_a_mark_for_each_picture() {
        let tick = |at_s: f64| StripTick {
            at_s,
            share: at_s / 3.0,
            errors: [f64::INFINITY, 0.5 * at_s],
            begins: at_s == 0.0,
            shows: at_s > 1.0,
        };
        let svg = strip("a <b>", &[0.0, 1.0, 2.0, 3.0].map(tick));
        assert!(roxmltree::Document::parse(&svg).is_ok(), "{svg}");
        assert!(!svg.contains("inf") && !svg.contains("NaN"));
        let marks = |tone: &str| svg.matches(&format!("<line class=\"plot-line {tone}\"")).count();
        assert_eq!((marks("plot-t6"), marks("plot-t4")), (1, 2));
        assert_eq!(strip("", &[]), "");
    }
}

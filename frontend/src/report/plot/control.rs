//! How frames were controlled over time: the share of rays cast, the two errors, and marks where a picture was begun or
//! shown.

use super::strip::{Curve, Panel, Row, Strip};

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

/// The strip of some ticks.
pub fn strip_of_control(title: &str, ticks: &[StripTick]) -> Strip {
    let curve =
        |name, tone, of: fn(&StripTick) -> f64| Curve { name, tone, values: ticks.iter().map(of).collect() };
    let row = |name, tone, of: fn(&StripTick) -> bool| Row {
        name,
        tone,
        is_marked: ticks.iter().map(of).collect(),
    };
    let share = curve("rays", 2, |tick| 100.0 * tick.share);
    let errors =
        vec![curve("ζ, in space", 0, |tick| tick.errors[0]), curve("τ, in time", 7, |tick| tick.errors[1])];
    Strip {
        title: title.to_owned(),
        at_s: ticks.iter().map(|tick| tick.at_s).collect(),
        panels: vec![
            Panel { name: "rays cast, %", most: 100.0, curves: vec![share] },
            Panel { name: "error, 1/255", most: 0.0, curves: errors },
        ],
        rows: vec![row("begun", 6, |tick| tick.begins), row("shown", 4, |tick| tick.shows)],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_picture_has_its_marks() {
        let tick = |at_s: f64| StripTick {
            at_s,
            share: at_s / 3.0,
            errors: [f64::INFINITY, 0.5 * at_s],
            begins: at_s == 0.0,
            shows: at_s > 1.0,
        };
        let svg = strip_of_control("a", &[0.0, 1.0, 2.0, 3.0].map(tick)).svg();
        let marks = |tone: u32| svg.matches(&format!("<line class=\"plot-line plot-t{tone}\"")).count();
        assert_eq!((marks(6), marks(4)), (1, 2));
        assert!(svg.contains("ζ") && svg.contains("τ"));
    }
}

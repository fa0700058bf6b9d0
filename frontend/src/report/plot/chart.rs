//! A plot: its axes, its series and their legend.

use super::legend::{self, BASELINE, legend};
use super::marks::{line, shape, text};
use super::{LogAxis, Series, Stroke, Tick};
use crate::report::html::escape;

const STYLE: &str = include_str!("plot.css");
/// Width of the whole.
const WIDTH: f64 = 1000.0;
/// Left and right end of the axes' box.
const SIDES: (f64, f64) = (84.0, 700.0);
/// Top of the axes' box.
const TOP: f64 = 46.0;
/// Least height of the axes' box: as many series as it takes make it higher.
const LEAST_HEIGHT: f64 = 380.0;
/// Below the axes' box: numbers and a name.
const FOOT: f64 = 60.0;
/// Between the axes' box and the legend.
const GAP: f64 = 22.0;
/// Beside a point, to what is written there.
const BESIDE: f64 = 12.0;

/// Points and lines on two logarithmic axes.
#[derive(Clone, Debug, PartialEq)]
pub struct Chart {
    /// What it shows.
    pub title: String,
    /// What runs along the horizontal axis, with its unit.
    pub x_label: String,
    /// What runs along the vertical axis, with its unit.
    pub y_label: String,
    /// What it shows; later ones lie before earlier ones, but wide lines behind all.
    pub series: Vec<Series>,
}

/// The axes and the box that they span.
struct Frame {
    x: LogAxis,
    y: LogAxis,
    bottom: f64,
}

impl Chart {
    /// The plot as an `<svg>` element, which is also a whole file.
    pub fn svg(&self) -> String {
        let frame = Frame::around(&self.series);
        let height = frame.bottom + FOOT;
        format!(
            "<svg class=\"plot\" xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {WIDTH} {height}\" \
             width=\"{WIDTH}\" height=\"{height}\" role=\"img\" aria-label=\"{title}\"><style>{STYLE}</style>\
             <rect class=\"plot-ground\" width=\"{WIDTH}\" height=\"{height}\"/>\
             {heading}{axes}{series}{legend}</svg>",
            title = escape(&self.title),
            heading = text("plot-title", (SIDES.0, 26.0), "start", &self.title),
            axes = self.axes(&frame),
            series = self.shown(&frame),
            legend = legend(&self.series, (SIDES.1 + GAP, TOP)),
        )
    }

    fn axes(&self, frame: &Frame) -> String {
        let (left, right) = SIDES;
        let (middle_x, middle_y) = (0.5 * (left + right), 0.5 * (TOP + frame.bottom));
        let x_ticks: String = frame.x.ticks().iter().map(|tick| frame.x_tick(tick)).collect();
        let y_ticks: String = frame.y.ticks().iter().map(|tick| frame.y_tick(tick)).collect();
        format!(
            "{x_ticks}{y_ticks}<rect class=\"plot-box\" x=\"{left}\" y=\"{TOP}\" width=\"{}\" height=\"{}\"/>{}\
             <g transform=\"translate(22 {middle_y:.2}) rotate(-90)\">{}</g>",
            right - left,
            frame.bottom - TOP,
            text("plot-name", (middle_x, frame.bottom + 46.0), "middle", &self.x_label),
            text("plot-name", (0.0, 0.0), "middle", &self.y_label),
        )
    }

    fn shown(&self, frame: &Frame) -> String {
        let (behind, before): (Vec<&Series>, Vec<&Series>) =
            self.series.iter().partition(|one| one.stroke == Stroke::Wide);
        let lines: String = behind.iter().chain(&before).map(|one| line(one, &frame.places(one))).collect();
        let shapes: String = self.series.iter().map(|one| frame.shapes(one)).collect();
        let labels: String = self.series.iter().map(|one| frame.label(one)).collect();
        format!("{lines}{shapes}{labels}")
    }
}

impl Frame {
    fn around(series: &[Series]) -> Self {
        let points = || series.iter().flat_map(|one| &one.points);
        Self {
            x: LogAxis::around(points().map(|point| point.x)),
            y: LogAxis::around(points().map(|point| point.y)),
            bottom: TOP + LEAST_HEIGHT.max(legend::height(series.len())),
        }
    }

    fn x_at(&self, value: f64) -> f64 {
        SIDES.0 + self.x.share(value) * (SIDES.1 - SIDES.0)
    }

    fn y_at(&self, value: f64) -> f64 {
        self.bottom - self.y.share(value) * (self.bottom - TOP)
    }

    fn places(&self, series: &Series) -> Vec<(f64, f64)> {
        series.points.iter().map(|point| (self.x_at(point.x), self.y_at(point.y))).collect()
    }

    fn shapes(&self, series: &Series) -> String {
        let places = self.places(series);
        places.iter().zip(&series.points).map(|(&place, point)| shape(series, place, &point.title)).collect()
    }

    /// What is written beside the last point: to its left where it is far to the right.
    fn label(&self, series: &Series) -> String {
        let (Some(label), Some(&(x, y))) = (&series.label, self.places(series).last()) else {
            return String::new();
        };
        let is_far = x > SIDES.0 + 0.8 * (SIDES.1 - SIDES.0);
        let (x, anchor) = if is_far { (x - BESIDE, "end") } else { (x + BESIDE, "start") };
        let y = (y - 9.0).max(TOP + 14.0);
        text("plot-label", (x, y), anchor, label)
    }

    fn x_tick(&self, tick: &Tick) -> String {
        let x = self.x_at(tick.value);
        let words = tick.label.as_ref().map(|label| {
            let grid = grid_line((x, TOP), (x, self.bottom));
            format!("{grid}{}", text("plot-text", (x, self.bottom + 22.0), "middle", label))
        });
        format!("{}{}", words.unwrap_or_default(), tick_line((x, self.bottom), (x, self.bottom + 5.0)))
    }

    fn y_tick(&self, tick: &Tick) -> String {
        let (left, right) = SIDES;
        let y = self.y_at(tick.value);
        let words = tick.label.as_ref().map(|label| {
            let grid = grid_line((left, y), (right, y));
            format!("{grid}{}", text("plot-text", (left - 9.0, y + BASELINE), "end", label))
        });
        format!("{}{}", words.unwrap_or_default(), tick_line((left - 5.0, y), (left, y)))
    }
}

fn grid_line(from: (f64, f64), to: (f64, f64)) -> String {
    straight("plot-grid", from, to)
}

fn tick_line(from: (f64, f64), to: (f64, f64)) -> String {
    straight("plot-tick", from, to)
}

fn straight(class: &str, (x1, y1): (f64, f64), (x2, y2): (f64, f64)) -> String {
    format!("<line class=\"{class}\" x1=\"{x1:.2}\" y1=\"{y1:.2}\" x2=\"{x2:.2}\" y2=\"{y2:.2}\"/>")
}

#[cfg(test)]
mod tests;

//! Plots as self-contained SVG: points and lines on two logarithmic axes, in light and in dark.

mod axis;
mod chart;
mod legend;
mod marks;
mod series;

pub use axis::{LogAxis, Tick};
pub use chart::Chart;
pub use series::{Mark, Point, Series, Stroke};

//! Plots as self-contained SVG, in light and in dark: points and lines on two logarithmic axes, and strips over time.

mod axis;
mod chart;
mod control;
mod legend;
mod marks;
mod series;
mod strip;

pub use axis::{LogAxis, Tick};
pub use chart::Chart;
pub use control::{StripTick, strip_of_control};
pub use series::{Mark, Point, Series, Stroke};
pub use strip::{Curve, Panel, Row, Strip};

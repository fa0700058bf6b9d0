//! The times of a show as a plot.

use crate::report::Histogram;
use crate::report::plot::{Chart, Point, Series, Stroke};

/// What fraction of times is longer than each, as a plot.
pub(super) fn plot_of_beat(interval: &Histogram, latency: &Histogram, skew: &Histogram) -> String {
    let series = |(number, (name, histogram)): (usize, (&str, &Histogram))| {
        let point = |(ms, share): (f64, f64)| Point {
            x: ms,
            y: 100.0 * share,
            title: format!("{:.3} % take {ms:.3} ms or longer", 100.0 * share),
        };
        let points: Vec<Point> = histogram.beyond().into_iter().map(point).collect();
        (!points.is_empty()).then(|| Series::new(name, points).tone(number).stroke(Stroke::Thin))
    };
    let named = [("from a frame to the next", interval), ("from input to screen", latency), ("skew", skew)];
    let chart = Chart {
        title: "How long things take".to_owned(),
        x_label: "milliseconds".to_owned(),
        y_label: "frames that take as long or longer, percent".to_owned(),
        series: named.into_iter().enumerate().filter_map(series).collect(),
    };
    if chart.series.is_empty() { String::new() } else { chart.svg() }
}

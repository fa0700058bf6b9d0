//! A drawing of where the time went.

use super::html::escape;
use super::units;
use protocol::Stages;
use std::fmt::Write;

/// Width of the drawing, its own units.
const WIDTH: f64 = 1000.0;

/// The stages with their colours, in the order in which they run.
fn stages(stages: &Stages) -> [(&'static str, f64, &'static str); 5] {
    [
        ("refine", stages.refine_ms, "#7c8cff"),
        ("load", stages.load_ms, "#f2a65a"),
        ("upload", stages.upload_ms, "#e86a92"),
        ("cast", stages.cast_ms, "#3ec6b6"),
        ("read back", stages.readback_ms, "#b58cf5"),
    ]
}

/// A bar whose parts are as long as the stages took, with a legend.
pub(super) fn stage_bar(times: &Stages) -> String {
    let parts = stages(times);
    let total: f64 = parts.iter().map(|part| part.1).sum();
    let (mut bars, mut legend, mut left) = (String::new(), String::new(), 0.0);
    for (name, ms, colour) in parts {
        let width = if total > 0.0 { WIDTH * ms / total } else { 0.0 };
        let label = format!("{name}: {}", units::milliseconds(ms));
        // Writing to a string cannot fail.
        let _ = write!(
            bars,
            "<rect x=\"{left:.2}\" y=\"0\" width=\"{width:.2}\" height=\"28\" fill=\"{colour}\"><title>{}</title></rect>",
            escape(&label)
        );
        let share = if total > 0.0 { 100.0 * ms / total } else { 0.0 };
        let _ = write!(
            legend,
            "<li><i style=\"background:{colour}\"></i>{} <span>{share:.0} %</span></li>",
            escape(&label)
        );
        left += width;
    }
    format!(
        "<svg class=\"bar\" viewBox=\"0 0 {WIDTH} 28\" preserveAspectRatio=\"none\" role=\"img\" aria-label=\"time per stage\">\
         <rect width=\"{WIDTH}\" height=\"28\" fill=\"#232733\"/>{bars}</svg><ul class=\"legend\">{legend}</ul>"
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_fill_the_bar_and_nothing_divides_by_zero() {
        let bar = stage_bar(&Stages { refine_ms: 1.0, cast_ms: 3.0, ..Stages::default() });
        assert!(bar.contains("x=\"250.00\" y=\"0\" width=\"750.00\""), "{bar}");
        assert!(!stage_bar(&Stages::default()).contains("NaN"));
    }
}

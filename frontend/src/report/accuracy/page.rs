//! The report as one self-contained page.

use super::table::{HEADS, rows};
use super::{AccuracyReport, Comparison};
use crate::report::html::{escape, facts, table};
use crate::report::units;

const STYLE: &str = include_str!("../style.css");
const OWN_STYLE: &str = include_str!("accuracy.css");

/// The whole page.
pub(super) fn page(report: &AccuracyReport) -> String {
    let title = escape(&report.scene.name);
    format!(
        "<!doctype html><html lang=\"en\"><head><meta charset=\"utf-8\">\
         <meta name=\"viewport\" content=\"width=device-width\"><title>Accuracy of {title} · lightloom</title>\
         <style>{STYLE}{OWN_STYLE}</style></head><body><main>{}{}{}{}{}{}{}</main></body></html>\n",
        header(report),
        verdicts(report),
        notes(report),
        plots(report),
        numbers(report),
        setting(report),
        command(report),
    )
}

fn header(report: &AccuracyReport) -> String {
    let projectors: Vec<String> = report.projectors.iter().map(u32::to_string).collect();
    let about = format!(
        "Frame {} on {}, projectors {}: {} settings in {}, against the reference at {} pixels",
        report.frame,
        report.display.name,
        projectors.join(", "),
        report.settings.len(),
        units::milliseconds(report.wall_ms),
        units::count(report.truth.rays as u64),
    );
    let title = escape(&report.scene.name);
    format!("<header><h1>Accuracy of {title}</h1><p>{}</p></header>", escape(&about))
}

fn verdicts(report: &AccuracyReport) -> String {
    let tile = |comparison: &Comparison| {
        let (class, words) = match comparison.is_default_on_front {
            true => ("good", "on the front"),
            false => ("bad", "beaten"),
        };
        format!(
            "<div class=\"tile {class}\"><b>{words}</b><span>the default, by {}</span></div>",
            comparison.measure.name()
        )
    };
    let tiles: String = report.comparisons.iter().map(tile).collect();
    let sentences: String =
        report.verdicts().iter().map(|verdict| format!("<li>{}</li>", escape(verdict))).collect();
    format!("<div class=\"tiles\">{tiles}</div><ul class=\"verdicts\">{sentences}</ul>")
}

fn notes(report: &AccuracyReport) -> String {
    report.notes().iter().map(|note| format!("<p class=\"note\">{}</p>", escape(note))).collect()
}

fn plots(report: &AccuracyReport) -> String {
    let figures: String =
        super::plots::plots(report).iter().map(|plot| format!("<div class=\"chart\">{plot}</div>")).collect();
    format!(
        "<h2>Seconds against error</h2><p class=\"how\">A line is one step tolerance, its dots the step lengths, longest \
         first. Everything else is as by default there; what is varied alone has marks of its own. Hold the mouse over a \
         mark to read its setting.</p>{figures}"
    )
}

fn numbers(report: &AccuracyReport) -> String {
    format!(
        "<h2>Settings</h2><p class=\"how\">Steps are in voxels, levels in voxels per display resolution, errors of linear \
         colour and opacity in units of 1/255. A star marks the front of that error. Seconds are {}.</p>{}",
        escape(report.timing),
        table(&HEADS, &rows(report))
    )
}

fn setting(report: &AccuracyReport) -> String {
    let (truth, dims) = (&report.truth, report.scene.facts.dims);
    let stride = match truth.is_stride_chosen {
        true => format!("every {}, chosen for half a minute", ordinal(truth.stride)),
        false => format!("every {}", ordinal(truth.stride)),
    };
    let rows = [
        ("volume", report.scene.volume.clone()),
        ("voxels", format!("{} × {} × {}", dims.x, dims.y, dims.z)),
        ("device", report.device.adapter.clone()),
        ("why this one", report.device.reason.clone()),
        ("repetitions", report.repetitions.to_string()),
        ("pixels compared along x and y", stride),
        ("truth", "64-bit reference at the finest level, samples as stored".to_owned()),
        ("its tolerance", format!("{:.0e} of full scale", truth.tolerance)),
        ("its rays beyond that", truth.not_reached.to_string()),
        ("its time", units::milliseconds(1e3 * truth.seconds)),
    ];
    format!("<h2>How it was measured</h2><div class=\"card\">{}</div>", facts(&rows))
}

fn ordinal(number: u32) -> String {
    let ending = match (number % 10, number % 100) {
        (1, last) if last != 11 => "st",
        (2, last) if last != 12 => "nd",
        (3, last) if last != 13 => "rd",
        _ => "th",
    };
    format!("{number}{ending}")
}

fn command(report: &AccuracyReport) -> String {
    let words = escape(&report.command_line.join(" "));
    format!("<h2>Command</h2><code>{words}</code><p class=\"how\">lightloom {}</p>", escape(report.version))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ordinals_read_well() {
        assert_eq!(
            [1, 2, 3, 4, 11, 12, 21].map(ordinal),
            ["1st", "2nd", "3rd", "4th", "11th", "12th", "21st"]
        );
    }
}

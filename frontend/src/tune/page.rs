//! The page of a study of frame control.

use super::TuneReport;
use super::charts::letter;
use super::report::StageReport;
use crate::report::html::{embedded_image, escape, facts, table};
use crate::report::page::STYLE;
use renderer::output::OutputError;
use std::path::Path;

const OWN_STYLE: &str = ".chart{margin:1em 0}.pair{display:flex;flex-wrap:wrap;gap:12px}.pair figure{flex:1 1 300px;margin:0}.pair img{width:100%}";

/// The whole page, with the pictures of the folder inside.
pub(super) fn page(report: &TuneReport, folder: &Path, files: &[[String; 2]]) -> Result<String, OutputError> {
    let charts: String =
        report.charts.iter().map(|chart| format!("<div class=\"chart\">{chart}</div>")).collect();
    let strips: String =
        report.strips.iter().map(|strip| format!("<div class=\"chart\">{strip}</div>")).collect();
    let tables: String = report.stages.iter().map(|stage| stage_table(report, stage)).collect();
    let mut worst = String::new();
    for (one, names) in report.worst.iter().zip(files) {
        let mut figures = String::new();
        for (name, caption) in names.iter().zip(["shown", "as it should be"]) {
            let image = embedded_image(&folder.join(name), caption, None)?;
            figures += &format!("<figure>{image}<figcaption>{caption}</figcaption></figure>");
        }
        let head = format!("{}: instant {}, RMS {:.2} of 255", one.name, one.instant, 255.0 * one.rms);
        worst += &format!("<h3>{}</h3><div class=\"pair\">{figures}</div>", escape(&head));
    }
    Ok(format!(
        "<!doctype html><html lang=\"en\"><head><meta charset=\"utf-8\">\
         <meta name=\"viewport\" content=\"width=device-width\"><title>Frame control · lightloom</title>\
         <style>{STYLE}{OWN_STYLE}</style></head><body><main><header><h1>Frame control</h1><p>{}</p></header>{}\
         <h2>Curves</h2>{charts}<h2>Settings</h2>{tables}<h2>Over time, at the best</h2>{strips}\
         <h2>Worst instants, at the best</h2>{worst}{}</main></body></html>\n",
        escape(&about(report)),
        setting(report),
        command(report),
    ))
}

fn about(report: &TuneReport) -> String {
    let best = report.best;
    format!(
        "{} scenarios on {} machines, as an eye before {} sees them sixty times a second. Best: ρ = {}, ϑ = {}.",
        report.scenarios.len(),
        report.machines_s.len(),
        report.display,
        best.rho,
        best.theta
    )
}

fn setting(report: &TuneReport) -> String {
    let [width, height] = report.raster;
    let machines: Vec<String> = report.machines_s.iter().map(|s| format!("{s} s")).collect();
    facts(&[
        ("scenarios", report.scenarios.join("; ")),
        ("a complete picture takes", machines.join(", ")),
        ("pixels of a projector's picture", format!("{width} × {height}")),
        ("it took", format!("{:.0} s", report.seconds)),
    ])
}

fn stage_table(report: &TuneReport, stage: &StageReport) -> String {
    let mut heads = vec!["setting", "bad, by RMS", "by flicker", "rays cast for, s", "shown a second"];
    let columns: Vec<String> = report
        .scenarios
        .iter()
        .flat_map(|scenario| report.machines_s.iter().map(move |s| format!("{scenario}, {s} s")))
        .collect();
    heads.extend(columns.iter().map(String::as_str));
    let row = |(place, one): (usize, &super::report::SettingReport)| {
        let star = if place == stage.best { " *" } else { "" };
        let mean = one.shown_per_s.iter().sum::<f64>() / one.shown_per_s.len().max(1) as f64;
        let mut cells = vec![
            format!("{}{star}", one.name),
            format!("{:.3}", one.badness),
            format!("{:.3}", one.badness_by_flicker),
            format!("{:.1}", one.busy_s),
            format!("{mean:.1}"),
        ];
        cells.extend(one.scores.iter().map(|score| format!("{:.2}", 255.0 * score.rms)));
        cells
    };
    let rows: Vec<Vec<String>> = stage.settings.iter().enumerate().map(row).collect();
    format!(
        "<h3>{} varied</h3><p class=\"how\">The columns to the right are RMS errors of what the eye is shown, in units of \
         1/255. A star marks the best.</p>{}",
        letter(stage.stage),
        table(&heads, &rows)
    )
}

fn command(report: &TuneReport) -> String {
    let words = escape(&report.command_line.join(" "));
    format!("<h2>Command</h2><code>{words}</code><p class=\"how\">lightloom {}</p>", escape(report.version))
}

//! The report as one self-contained page.

use super::html::{embedded_image, escape, facts, table};
use super::legend::{marks, number};
use super::stage_bar::stage_bar;
use super::{CONTACT_SHEET, FrameSummary, LiveSummary, Report, Totals, units, upkeep};
use crate::orientation::describe;
use renderer::output::OutputError;
use std::path::Path;

/// The look of all pages.
pub(crate) const STYLE: &str = include_str!("style.css");

/// The whole page, with the first frame's contact sheet and eye views from `out` inside.
pub(super) fn page(report: &Report, out: &Path) -> Result<String, OutputError> {
    let title = escape(&report.scene.name);
    Ok(format!(
        "<!doctype html><html lang=\"en\"><head><meta charset=\"utf-8\">\
         <meta name=\"viewport\" content=\"width=device-width\"><title>{title} · lightloom</title>\
         <style>{STYLE}</style></head><body><main>{}{}{}{}{}{}{}{}</main></body></html>\n",
        header(report),
        notes(report),
        key(report, out)?,
        eyes(report, out)?,
        sheet(report, out)?,
        setting(report),
        numbers(report),
        command(report),
    ))
}

fn header(report: &Report) -> String {
    let (display, total) = (&report.display, &report.total);
    let about = format!(
        "on {}, {} projectors with {} pixels in total, {:.2} × {:.2} m",
        display.name,
        display.projectors,
        units::count(display.pixels),
        display.width_m,
        display.height_m
    );
    let memory = report.peak_memory_bytes.map_or("unknown".to_owned(), units::bytes);
    let (quality, words) = if total.complete { ("good", "complete") } else { ("bad", "not complete") };
    let tiles = [
        (quality, words.to_owned(), count_of(report.frames.len(), "frame")),
        ("", units::milliseconds(report.wall_ms), "wall clock".to_owned()),
        ("", units::count(total.rays), "rays".to_owned()),
        ("", units::count(total.samples), "samples".to_owned()),
        ("", units::per_second(total.samples, total.stages.cast_ms), "samples while casting".to_owned()),
        ("", units::bytes(total.bytes_loaded), "voxels loaded".to_owned()),
        ("", memory, "peak memory".to_owned()),
    ];
    let tile = |(class, value, name): &(&str, String, String)| {
        format!("<div class=\"tile {class}\"><b>{}</b><span>{}</span></div>", escape(value), escape(name))
    };
    format!(
        "<header><h1>{}</h1><p>{}</p></header><div class=\"tiles\">{}</div>",
        escape(&report.scene.name),
        escape(&about),
        tiles.iter().map(tile).collect::<String>()
    )
}

fn count_of(number: usize, noun: &str) -> String {
    if number == 1 { format!("1 {noun}") } else { format!("{number} {noun}s") }
}

/// Warnings for people.
fn notes(report: &Report) -> String {
    let incomplete = report.frames.iter().filter(|frame| !frame.total.complete);
    let shortfalls = incomplete
        .map(|frame| format!("Frame {} is not complete: {}", frame.index, frame.total.shortfall.join("; ")));
    let notes = shortfalls.chain(report.eye_warnings());
    let notes: String = notes.map(|note| format!("<p class=\"note\">{}</p>", escape(&note))).collect();
    format!("{notes}{}", damages(&report.total))
}

/// The bricks that could not be read; nothing if all could.
fn damages(total: &Totals) -> String {
    if total.damaged.is_empty() {
        return String::new();
    }
    let rows: String = total.damaged.iter().map(|one| format!("<li>{}</li>", escape(one))).collect();
    format!("<h2>Damaged bricks</h2><p>Their parents are shown instead.</p><ul>{rows}</ul>")
}

/// The colours of the debug view; nothing if the pictures are shown.
fn key(report: &Report, out: &Path) -> Result<String, OutputError> {
    let Some(debug) = &report.debug_view else { return Ok(String::new()) };
    let numbers: Vec<String> = marks(debug.view).into_iter().map(|value| number(debug.view, value)).collect();
    let numbers = numbers.join(", ");
    let image = embedded_image(&out.join(debug.legend), &format!("colours of {numbers}"), None)?;
    Ok(format!(
        "<h2>Instead of the pictures</h2><figure class=\"key\">{image}\
         <figcaption><b>{}</b>; from left to right: {}</figcaption></figure>",
        escape(debug.shows),
        escape(&numbers)
    ))
}

fn eyes(report: &Report, out: &Path) -> Result<String, OutputError> {
    let Some(frame) = report.frames.first().filter(|frame| !frame.eye_views.is_empty()) else {
        return Ok(String::new());
    };
    let aspect = report.display.width_m / report.display.height_m;
    let mut figures = String::new();
    for (index, (eye, file)) in report.eyes.iter().zip(&frame.eye_views).enumerate() {
        let [x, y, z] = eye.position_m;
        let place = format!("at ({x}, {y}, {z}) m, sees {}", count_of(eye.projectors_seen, "projector"));
        let image = embedded_image(&out.join(file), &format!("view of eye {index}"), Some(aspect))?;
        figures += &format!(
            "<figure>{image}<figcaption><b>Eye {index}</b> {}</figcaption></figure>",
            escape(&place)
        );
    }
    Ok(format!("<h2>What eyes see</h2><div class=\"eyes\">{figures}</div>"))
}

fn sheet(report: &Report, out: &Path) -> Result<String, OutputError> {
    let image = embedded_image(&out.join(CONTACT_SHEET), "the pictures of all projectors", None)?;
    let frame = report.frames.first().map_or(0, |frame| frame.index);
    let caption = format!("Frame {frame}, row by row from projector 0");
    Ok(format!(
        "<h2>What the projectors show</h2><figure>{image}<figcaption>{}</figcaption></figure>",
        escape(&caption)
    ))
}

fn setting(report: &Report) -> String {
    let backends = report.backends.iter().enumerate().map(|(index, backend)| {
        let device = &backend.device;
        let rows = [
            ("projectors", backend.listed_projectors()),
            ("why these", backend.why_these.clone()),
            ("adapter", device.adapter.clone()),
            ("why this one", device.reason.clone()),
            ("interpolation", device.filter.clone()),
            ("brick cache", units::bytes(device.cache_bytes)),
        ];
        format!("<div class=\"card\"><h3>Back-end {index}</h3>{}</div>", facts(&rows))
    });
    format!(
        "<h2>Setting</h2><div class=\"two\"><div class=\"card\"><h3>Scene</h3>{}</div>\
         <div class=\"card\"><h3>Display</h3>{}</div>{}</div>",
        scene_facts(report),
        display_facts(report),
        backends.collect::<String>()
    )
}

fn scene_facts(report: &Report) -> String {
    let scene = &report.scene;
    let (dims, size_mm, (low, high)) =
        (scene.facts.dims, scene.facts.voxel_size_m() * 1e3, scene.facts.value_range);
    let quality = scene.quality;
    facts(&[
        ("volume", scene.volume.clone()),
        ("voxels", format!("{} × {} × {}", dims.x, dims.y, dims.z)),
        ("voxel as the data say", format!("{:.3} × {:.3} × {:.3} mm", size_mm.x, size_mm.y, size_mm.z)),
        ("patient axes", describe(&scene.facts.frame)),
        ("values", format!("{low} to {high}")),
        ("longest edge in the display", format!("{:.3} m", scene.longest_m)),
        ("cast by", report.total.casters.join("; ")),
        ("step", format!("{} voxels", quality.step_voxels)),
        ("a ray ends when less than this can be added", format!("{:.2e}", quality.termination)),
        ("voxel size per display resolution", format!("{}", quality.lod_scale)),
    ])
}

fn display_facts(report: &Report) -> String {
    let display = &report.display;
    let [x, y, z] = display.observer_m;
    facts(&[
        ("name", display.name.clone()),
        ("screen", format!("{} × {} m", display.width_m, display.height_m)),
        ("projectors", display.projectors.to_string()),
        ("pixel on the screen, s0", format!("{:.3} mm", 1e3 * display.pixel_size_m)),
        ("angular accuracy, Φ", format!("{:.2}°", display.angular_accuracy_deg)),
        ("parallax, η", display.eta.to_string()),
        ("virtual observer", format!("({x}, {y}, {z}) m")),
    ])
}

/// Columns that totals and back-ends share.
const HEADS: [&str; 11] = [
    "",
    "time",
    "rays",
    "samples",
    "casting",
    "bricks wanted",
    "resident",
    "loaded",
    "voxels loaded",
    "bricks sampled",
    "views' own, summed",
];

fn numbers(report: &Report) -> String {
    let frames: Vec<_> = report.frames.iter().map(frame_row).collect();
    let each = report.frames.iter().flat_map(|frame| &frame.backends).map(|one| {
        let name = format!(
            "frame {}, back-end {}, {}",
            one.frame,
            one.backend,
            count_of(one.projectors.len(), "projector")
        );
        row(name, one.total_ms, &Totals::of([one]))
    });
    format!(
        "<h2>Time per stage, summed over back-ends</h2>{}{}<h2>Frames</h2>{}{}<h2>Back-ends</h2>{}",
        stage_bar(&report.total.stages),
        report.live.as_ref().map(LiveSummary::section).unwrap_or_default(),
        table(&HEADS, &frames),
        upkeep::section(&report.frames),
        table(&HEADS, &each.collect::<Vec<_>>())
    )
}

fn frame_row(frame: &FrameSummary) -> Vec<String> {
    row(format!("frame {} at {:.3} s", frame.index, frame.time_s), frame.wall_ms, &frame.total)
}

/// Bricks are counts; the working set is that of a back-end's views together, next to the sum of the views' own.
fn row(name: String, ms: f64, total: &Totals) -> Vec<String> {
    let bricks = |n| units::count(n);
    vec![
        name,
        units::milliseconds(ms),
        units::count(total.rays),
        units::count(total.samples),
        units::milliseconds(total.stages.cast_ms),
        bricks(total.bricks_wanted),
        bricks(total.bricks_resident),
        bricks(total.bricks_loaded),
        units::bytes(total.bytes_loaded),
        bricks(total.working_set_union),
        total.working_set_sum.map_or_else(|| "not counted".to_owned(), bricks),
    ]
}

fn command(report: &Report) -> String {
    let words = escape(&report.command_line.join(" "));
    format!(
        "<h2>Command</h2><code>{words}</code><p style=\"color:var(--dim)\">lightloom {}</p>",
        escape(report.version)
    )
}

//! A gallery as one self-contained page.

use super::{EYES, Exhibit, Gallery, Shot};
use crate::report::html::{embedded_image, escape};
use crate::report::page::STYLE;
use crate::report::units;
use protocol::DeviceInfo;
use renderer::output::OutputError;

/// What the page has beside the look of all pages.
const GRID: &str = include_str!("grid.css");

/// The whole page, with the pictures from the output folder inside.
pub(super) fn page(
    gallery: &Gallery,
    exhibits: &[Exhibit],
    devices: &[DeviceInfo],
) -> Result<String, OutputError> {
    let title = escape(&gallery.name);
    let mut sections = String::new();
    for exhibit in exhibits {
        sections += &section(gallery, exhibit)?;
    }
    Ok(format!(
        "<!doctype html><html lang=\"en\"><head><meta charset=\"utf-8\">\
         <meta name=\"viewport\" content=\"width=device-width\"><title>{title} · techniques · lightloom</title>\
         <style>{STYLE}{GRID}</style></head><body><main>{}{}{sections}</main></body></html>\n",
        header(gallery, devices),
        notes(exhibits),
    ))
}

fn header(gallery: &Gallery, devices: &[DeviceInfo]) -> String {
    let display = &gallery.display;
    let [left, middle, right] = gallery.subject.eyes;
    let setting = format!(
        "{} before {}, {} projectors on a screen of {:.2} × {:.2} m. Every technique is off above and on below, seen \
         {:.2} m before the screen from x = {:.2}, {:.2} and {:.2} m: from the left, the middle and the right of the \
         viewing zone.",
        gallery.name,
        display.name,
        display.projectors.len(),
        display.width_m,
        display.height_m,
        middle.z,
        left.x,
        middle.x,
        right.x
    );
    let adapters: Vec<&str> = devices.iter().map(|device| device.adapter.as_str()).collect();
    format!(
        "<header><h1>Illustrative techniques</h1><p>{}</p><p>Drawn by {}; seconds are those of all projectors.</p></header>",
        escape(&setting),
        escape(&adapters.join(", "))
    )
}

/// What a person must not overlook: pictures that miss something.
fn notes(exhibits: &[Exhibit]) -> String {
    let note = |exhibit: &Exhibit, what: &str, shot: &Shot| {
        let reason =
            shot.total.shortfall.iter().chain(&shot.total.damaged).cloned().collect::<Vec<_>>().join("; ");
        let name = exhibit.technique.name;
        (!reason.is_empty())
            .then(|| format!("<p class=\"note\">{}</p>", escape(&format!("{name}, {what}: {reason}"))))
    };
    let both = |exhibit| [note(exhibit, "off", &exhibit.off), note(exhibit, "on", &exhibit.on)];
    exhibits.iter().flat_map(both).flatten().collect()
}

fn section(gallery: &Gallery, exhibit: &Exhibit) -> Result<String, OutputError> {
    let technique = exhibit.technique;
    Ok(format!(
        "<section><h2>{}</h2><p class=\"about\">{}</p><div class=\"grid\">{}{}</div></section>",
        escape(technique.name),
        escape(technique.about),
        row(gallery, technique.name, "off", &exhibit.off)?,
        row(gallery, technique.name, "on", &exhibit.on)?,
    ))
}

fn row(gallery: &Gallery, name: &str, state: &str, shot: &Shot) -> Result<String, OutputError> {
    let aspect = gallery.display.width_m / gallery.display.height_m;
    let cost = format!(
        "{}, {:.1} samples per ray",
        units::milliseconds(1e3 * shot.wall.as_secs_f64()),
        shot.samples_per_ray()
    );
    let mut cells = format!("<div class=\"state\"><b>{state}</b><span>{}</span></div>", escape(&cost));
    for (file, eye) in shot.files.iter().zip(EYES) {
        let alt = format!("{name} {state}, from the {eye}");
        let image = embedded_image(&gallery.out.join(file), &alt, Some(aspect))?;
        cells += &format!("<figure>{image}<figcaption>{eye}</figcaption></figure>");
    }
    Ok(cells)
}

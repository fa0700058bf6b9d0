//! Looks as one self-contained page.

use super::LooksPage;
use super::plan::{Trial, file};
use crate::report::html::{embedded_image, escape};
use crate::report::page::STYLE;
use protocol::DeviceInfo;
use renderer::output::OutputError;

/// What the page has beside the look of all pages.
const LOOKS: &str = include_str!("looks.css");

/// The whole page, with the pictures from the output folder inside.
pub(super) fn page(looks: &LooksPage, devices: &[DeviceInfo]) -> Result<String, OutputError> {
    let title = escape(&looks.name);
    let mut figures = String::new();
    for trial in &looks.trials {
        figures += &figure(looks, trial)?;
    }
    Ok(format!(
        "<!doctype html><html lang=\"en\"><head><meta charset=\"utf-8\">\
         <meta name=\"viewport\" content=\"width=device-width\"><title>{title} · looks · lightloom</title>\
         <style>{STYLE}{LOOKS}</style></head><body><main>{}<div class=\"looks\">{figures}</div></main></body></html>\n",
        header(looks, devices),
    ))
}

fn header(looks: &LooksPage, devices: &[DeviceInfo]) -> String {
    let setting = format!(
        "{} before {}, as its observer sees it, in every look of the library. Ask for one with --look NAME or with \
         look = \"NAME\" in a scene.",
        looks.name, looks.display.name
    );
    let adapters: Vec<&str> = devices.iter().map(|device| device.adapter.as_str()).collect();
    format!(
        "<header><h1>Looks</h1><p>{}</p><p>Drawn by {}.</p></header>",
        escape(&setting),
        escape(&adapters.join(", "))
    )
}

fn figure(looks: &LooksPage, trial: &Trial) -> Result<String, OutputError> {
    let name = trial.name.text();
    let aspect = looks.display.width_m / looks.display.height_m;
    let image = embedded_image(&looks.out.join(file(trial.name)), name, Some(aspect))?;
    let (class, state) = match trial.verdict.fits {
        _ if trial.name == looks.chosen => ("chosen", "chosen"),
        true => ("fits", "fits"),
        false => ("misfit", "does not fit"),
    };
    Ok(format!(
        "<figure class=\"{class}\">{image}<figcaption><b>{name}</b> {}<span>{state}: {}</span></figcaption></figure>",
        escape(trial.name.about()),
        escape(&trial.verdict.why)
    ))
}

//! `lightloom gallery`.

use super::look::{ask_for_look, tell_look};
use super::say::{say, warn};
use crate::FrontendError;
use crate::adapter::{self, Backends};
use crate::cli::GalleryArgs;
use crate::gallery::{Exhibit, Gallery, Subject, with_picture_size};
use crate::progress::Progress;
use crate::report::units;
use crate::scene::Scene;
use std::time::Instant;

/// Draws all techniques and writes the page. All that can be wrong with the arguments is found before any back-end
/// starts.
pub(super) fn gallery(args: &GalleryArgs) -> Result<(), FrontendError> {
    let started = Instant::now();
    let mut scene = Scene::load(&args.scene)?;
    scene.quality = args.quality.map_or(scene.quality, |preset| preset.quality());
    let display = adapter::load_display(&args.display)?;
    let display = args.size.map_or(display.clone(), |size| with_picture_size(display, size));
    ask_for_look(&mut scene, args.look);
    let (facts, look) = adapter::meet_volume(&mut scene)?;
    let subject = Subject::new(&scene, &display, &facts)?;
    let gallery = Gallery::new(&scene.name, subject, display, &args.out)?;
    gallery.prepare_output()?;
    let backends = Backends::connect(args.drawing.backends, &gallery.display)?;
    backends.wiring.warning().iter().for_each(|warning| warn(warning));
    let options = args.drawing.options(None);
    let mut drawing = backends.start(&options, &scene.volume_ref(), &gallery.display)?;
    let mut progress = Progress::new(!args.quiet);
    let exhibits = gallery.draw(drawing.source.as_mut(), &mut progress);
    let exhibits = drawing.finish(exhibits)?;
    drop(progress);
    let page = gallery.write_page(&exhibits, &drawing.devices)?;
    exhibits.iter().for_each(warn_of_missing);
    if !args.quiet {
        tell_look(look.as_ref())?;
        let time = units::milliseconds(1e3 * started.elapsed().as_secs_f64());
        say(&format!("{} techniques, {time}: {}", exhibits.len(), page.display()))?;
    }
    Ok(())
}

fn warn_of_missing(exhibit: &Exhibit) {
    for shot in [&exhibit.off, &exhibit.on].into_iter().filter(|shot| !shot.total.complete) {
        warn(&format!("{} is not complete: {}", exhibit.technique.name, shot.total.shortfall.join("; ")));
    }
}

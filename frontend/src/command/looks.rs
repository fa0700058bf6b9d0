//! `lightloom looks`.

use super::say::{say, warn};
use crate::FrontendError;
use crate::adapter::{self, Backends};
use crate::cli::LooksArgs;
use crate::gallery::{LooksPage, with_picture_size};
use crate::progress::Progress;
use crate::report::units;
use crate::scene::{LookName, Scene, VolumeFacts, choose, read_values};
use std::time::Instant;

/// Draws the volume in every look and writes the page. All that can be wrong with the arguments is found before any
/// back-end starts.
pub(super) fn looks(args: &LooksArgs) -> Result<(), FrontendError> {
    let started = Instant::now();
    let mut scene = Scene::load(&args.scene)?;
    scene.quality = args.quality.map_or(scene.quality, |preset| preset.quality());
    let display = adapter::load_display(&args.display)?;
    let display = args.size.map_or(display.clone(), |size| with_picture_size(display, size));
    let volume = adapter::open_scene_volume(&scene)?;
    let (values, facts) = (read_values(volume.as_ref()), VolumeFacts::of(volume.as_ref()));
    drop(volume);
    let looks = LooksPage::new(&scene, &values, &facts, display, &args.out)?;
    looks.prepare_output()?;
    let backends = Backends::connect(args.drawing.backends, &looks.display)?;
    backends.wiring.warning().iter().for_each(|warning| warn(warning));
    let mut drawing = backends.start(&args.drawing.options(None), &scene.volume_ref(), &looks.display)?;
    let mut progress = Progress::new(!args.quiet);
    let shots = looks.draw(drawing.source.as_mut(), &mut progress);
    let shots = drawing.finish(shots)?;
    drop(progress);
    let page = looks.write_page(&drawing.devices)?;
    for (name, shot) in shots.iter().filter(|(_, shot)| !shot.total.complete) {
        warn(&format!("{name} is not complete: {}", shot.total.shortfall.join("; ")));
    }
    if !args.quiet {
        let time = units::milliseconds(1e3 * started.elapsed().as_secs_f64());
        say(&choose(&values).to_string())?;
        say(&format!("{} looks, {time}: {}", LookName::ALL.len(), page.display()))?;
    }
    Ok(())
}

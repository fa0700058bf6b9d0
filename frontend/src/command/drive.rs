//! `lightloom drive`.

use super::look::{ask_for_look, tell_look};
use super::show::{Show, check, show, taped};
use crate::FrontendError;
use crate::adapter;
use crate::cli::{DriveArgs, ReconstructArg};
use crate::drive::{Taped, cast};
use crate::scene::Scene;
use crate::staging::{Piece, Theatre};
use protocol::Pace;
use std::path::{Path, PathBuf};
use tape::Limits;

/// Drives a display. All that can be wrong with the arguments is found before any back-end starts.
pub(super) fn drive(args: &DriveArgs) -> Result<(), FrontendError> {
    let mut scene = Scene::load(&args.scene)?;
    scene.quality = args.quality.map_or(scene.quality, |preset| preset.quality());
    let display = adapter::load_display(&args.display)?;
    ask_for_look(&mut scene, args.look);
    let (facts, look) = adapter::meet_volume(&mut scene)?;
    scene.check_frames(0..scene.frame_count.max(1), &display, &facts)?;
    let looks = adapter::looks_of(&scene, look.as_ref())?;
    check(&args.show)?;
    if !args.show.quiet && !args.show.json {
        tell_look(look.as_ref())?;
    }
    let inputs = args.inputs.as_deref().map(inputs::Input::load).transpose()?.unwrap_or_default();
    let taped = taped(&args.show)?;
    let is_tracked = !inputs.is_empty() || taped.as_ref().is_some_and(Taped::has_inputs);
    let title = scene.name.clone();
    let piece = Piece::new(scene, facts, &looks);
    let theatre = Theatre::of_one(piece, cast(is_tracked), display, pace(&args.show))
        .with_sub_frames(args.show.reconstruct == ReconstructArg::Quincunx);
    let of_inputs = args.inputs.clone();
    let names = [&args.scene, &args.display].map(PathBuf::from);
    let files = names.into_iter().chain(of_inputs).filter(|path| is_text(path)).collect();
    let record = args.show.record.clone().map(|path| (path, Limits::default()));
    let made = Show { title, theatre, inputs, files, rate_hz: None, record, recorders: Vec::new() };
    show(&args.show, made, taped)
}

/// How frames get their detail: where nothing is late, nothing needs to be missing.
pub(super) fn pace(args: &crate::cli::ShowArgs) -> Pace {
    if args.stepped { Pace::Complete } else { args.pace() }
}

/// Whether a tape keeps a file: a description, not a volume.
pub(super) fn is_text(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension == "toml") && path.is_file()
}

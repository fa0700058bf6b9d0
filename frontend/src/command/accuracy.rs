//! `lightloom accuracy`.

use super::say::{say, warn};
use crate::FrontendError;
use crate::accuracy::{AccuracyError, Study, check_projectors, supervised, two_projectors};
use crate::adapter;
use crate::cli::AccuracyArgs;
use crate::interrupt;
use crate::progress::Progress;
use crate::report::accuracy::{self as report, AccuracyReport};
use crate::scene::{Scene, VolumeFacts};
use renderer::output::can_write_into;
use std::sync::Arc;
use std::time::Instant;

/// Measures, writes and reports. All that can be wrong with the arguments is found before any ray is cast; files are
/// written at the end.
pub(super) fn accuracy(args: &AccuracyArgs) -> Result<(), FrontendError> {
    let started = Instant::now();
    let stop = interrupt::stop_flag()?;
    let mut scene = Scene::load(&args.scene)?;
    let (study, facts) = study(args, &mut scene)?;
    can_write_into(&args.out)?;
    let study = Arc::new(study);
    let of_worker = Arc::clone(&study);
    let progress = Progress::new(!args.quiet && !args.json);
    let outcome = supervised(&stop, progress, move |watch| of_worker.run(watch))?;
    let report = AccuracyReport::new(&scene, &facts, &study, outcome, started.elapsed());
    report::write(&report, &args.out)?;
    tell(args, &report)
}

fn study(args: &AccuracyArgs, scene: &mut Scene) -> Result<(Study, VolumeFacts), FrontendError> {
    let display = adapter::load_display(&args.display)?;
    let count = scene.frame_count;
    if args.frame >= count {
        return Err(AccuracyError::Frame { frame: args.frame, count }.into());
    }
    check_projectors(&display, &args.projectors)?;
    let source = adapter::open_scene_volume(scene)?;
    let facts = VolumeFacts::of(source.as_ref());
    scene.fit_look(source.as_ref());
    let study = Study {
        frame: scene.frame(args.frame, &display, &facts)?,
        source,
        projectors: match args.projectors.is_empty() {
            true => two_projectors(&display),
            false => args.projectors.clone(),
        },
        stride: args.stride,
        repetitions: args.repetitions,
        is_full: args.full,
        is_finest: args.finest,
        device: args.device.into(),
        cache_bytes: args.cache_mib << 20,
        display,
    };
    Ok((study, facts))
}

fn tell(args: &AccuracyArgs, found: &AccuracyReport) -> Result<(), FrontendError> {
    found.notes().iter().for_each(|note| warn(note));
    if args.json {
        say(&serde_json::to_string_pretty(found)?)?;
    } else if !args.quiet {
        let truth = &found.truth;
        say(&format!(
            "{}{} pixels (stride {}) of projectors {:?}: {}",
            report::terminal_table(found),
            truth.rays,
            truth.stride,
            found.projectors,
            args.out.join(report::HTML).display()
        ))?;
    }
    Ok(())
}

//! `lightloom exhibit`.

use super::drive::{is_text, pace};
use super::say::say;
use super::show::{Show, check, show, taped};
use crate::FrontendError;
use crate::adapter;
use crate::cli::{ExhibitArgs, ReconstructArg};
use crate::drive::{Bulletin, Recorder, Supervisor};
use crate::staging::{Ensemble, Theatre};
use ::exhibit::{Exhibit, Fault, State, TapeWish};
use display_config::Display;
use std::path::{Path, PathBuf};
use std::time::SystemTime;
use tape::Limits;

/// Runs an exhibit. All that can be wrong with it is found before any back-end starts.
pub(super) fn exhibit(args: &ExhibitArgs) -> Result<(), FrontendError> {
    let opened = load(&args.file);
    if args.check {
        return tell_faults(opened.err().unwrap_or_default(), args.show.json);
    }
    let (exhibit, ensemble, display) = opened?;
    check(&args.show)?;
    let theatre = Theatre::new(ensemble, display, pace(&args.show))
        .with_marks(exhibit.marks)
        .with_sub_frames(args.show.reconstruct == ReconstructArg::Quincunx);
    let taped = taped(&args.show)?;
    let scenes = exhibit.items.iter().map(|item| PathBuf::from(&item.scene));
    let files = exhibit.files.iter().cloned().chain(scenes).chain([PathBuf::from(&exhibit.display)]);
    let files: Vec<PathBuf> = files.filter(|path| is_text(path)).collect();
    let record = match &args.show.record {
        Some(path) => Some((path.clone(), Limits::default())),
        None => exhibit.tape.as_ref().filter(|_| taped.is_none()).map(tape_of_today).transpose()?,
    };
    let disk = record.as_ref().map(|(path, _)| path.clone());
    let mut bulletin = Bulletin::open(&exhibit.title, args.status.as_deref(), args.log.as_deref(), disk)?;
    bulletin.state(State::Starting);
    let mut supervisor = Supervisor::default();
    let recorders: Vec<&mut (dyn Recorder + Send)> = vec![&mut bulletin, &mut supervisor];
    let made = Show {
        title: exhibit.title.clone(),
        theatre,
        inputs: exhibit.inputs.clone(),
        files,
        rate_hz: exhibit.rate_hz,
        record,
        recorders,
    };
    let shown = show(&args.show, made, taped);
    bulletin.state(if shown.is_ok() { State::Ended } else { State::Failed });
    if let Err(error) = &shown {
        bulletin.note(&error.to_string());
    }
    shown
}

/// The tape of a show that begins now: named by the time.
fn tape_of_today(wish: &TapeWish) -> Result<(PathBuf, Limits), FrontendError> {
    let name = ::exhibit::time_text(SystemTime::now()).replace(':', "-");
    let limits = Limits { part_bytes: Some(wish.part_bytes), keep_parts: Some(wish.keep_parts) };
    renderer::output::can_write_into(&wish.folder)?;
    Ok((wish.folder.join(format!("{name}.mcap")), limits))
}

/// An exhibit with all that it names.
pub(super) fn load(file: &Path) -> Result<(Exhibit, Ensemble, Display), Vec<Fault>> {
    let exhibit = Exhibit::load(file)?;
    let (ensemble, display) = adapter::open_exhibit(&exhibit)?;
    Ok((exhibit, ensemble, display))
}

/// Says all that is wrong; that something is, is the program's failure.
fn tell_faults(faults: Vec<Fault>, as_json: bool) -> Result<(), FrontendError> {
    if as_json {
        say(&serde_json::to_string_pretty(&faults)?)?;
    } else if faults.is_empty() {
        say("nothing is wrong with it")?;
    } else {
        faults.iter().try_for_each(|fault| say(&fault.to_string()))?;
    }
    match faults.len() {
        0 => Ok(()),
        1 => Err(FrontendError::Exhibit("the exhibit has a fault".to_owned())),
        count => Err(FrontendError::Exhibit(format!("the exhibit has {count} faults"))),
    }
}

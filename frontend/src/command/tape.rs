//! `lightloom tape`.

use super::say::say;
use crate::FrontendError;
use crate::cli::{TableArg, TapeAction, TapeArgs};
use ::tape::{Ending, Format, TapeError, cut, export, info};
use std::io::{BufWriter, stdout};
use std::path::Path;
use std::time::{Duration, SystemTime};

/// Looks into a tape.
pub(super) fn tape(args: &TapeArgs) -> Result<(), FrontendError> {
    match &args.action {
        TapeAction::Info { tape, json } => tell(tape, *json),
        TapeAction::Cut { tape, from, to, out } => {
            let seconds =
                |time: &Option<Duration>, otherwise| time.map_or(otherwise, |time| time.as_secs_f64());
            let frames = cut(tape, out, seconds(from, 0.0)..seconds(to, f64::INFINITY))?;
            say(&format!("{frames} frames written to {}", out.display()))
        }
        TapeAction::Export { tape, format } => {
            let format = match format {
                TableArg::Csv => Format::Csv,
                TableArg::Json => Format::Json,
            };
            match export(tape, format, &mut BufWriter::new(stdout().lock())) {
                // Whoever reads has seen enough.
                Err(TapeError::Export(error)) if error.kind() == std::io::ErrorKind::BrokenPipe => Ok(()),
                exported => Ok(exported?),
            }
        }
    }
}

fn tell(path: &Path, json: bool) -> Result<(), FrontendError> {
    let info = info(path)?;
    if json {
        return say(&serde_json::to_string_pretty(&info)?);
    }
    let began = ::exhibit::time_text(SystemTime::UNIX_EPOCH + Duration::from_nanos(info.head.began_ns));
    let mut lines = vec![
        format!("{}, part {} of the show that began at {began}", info.head.show, info.head.part),
        format!("recorded by lightloom {}", info.head.version),
        format!("{:.1} s, {} frames, {} changes by mouse and keys", info.length_s, info.frames, info.changes),
    ];
    lines.extend(info.events.iter().map(|(name, count)| format!("input {name}: {count} events")));
    lines.extend(info.files.iter().map(|(name, bytes)| format!("file {name}: {bytes} bytes")));
    lines.push(match &info.ending {
        Ending::Whole => "it is whole".to_owned(),
        Ending::Cut(why) => why.clone(),
    });
    say(&lines.join("\n"))
}

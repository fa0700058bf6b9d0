//! A part of a tape as a tape of its own.

use crate::error::TapeError;
use crate::info::info;
use crate::part::Part;
use crate::reader::Tape;
use crate::record::Record;
use inputs::{Event, What};
use std::collections::BTreeMap;
use std::ops::Range;
use std::path::Path;
use world::Deed;

/// Writes what lies within some seconds, from the first frame on, into a tape of its own. It begins with the places of tools,
/// buttons and axes as they were then; what had become of the world is not on it.
///
/// # Errors
/// The tape cannot be read or written, or nothing lies there.
pub fn cut(from: &Path, to: &Path, seconds: Range<f64>) -> Result<u64, TapeError> {
    let whole = info(from)?;
    let tape = Tape::open(from)?;
    let cannot_write =
        |cause: mcap::McapError| TapeError::Write { path: to.to_owned(), cause: cause.to_string() };
    let mut unfinished = to.to_owned().into_os_string();
    unfinished.push(".part");
    let unfinished = Path::new(&unfinished);
    let mut part = Part::create(unfinished, tape.head()).map_err(cannot_write)?;
    let (mut first, mut frames) = (None, 0);
    let (mut waiting, mut latest) = (Vec::new(), BTreeMap::new());
    for record in tape.records().map_while(Result::ok) {
        let Record::Frame(frame) = record else {
            waiting.push(record);
            continue;
        };
        let now = frame.moment().now;
        let at_s = now.saturating_sub(*first.get_or_insert(now)).as_secs_f64();
        let waited = std::mem::take(&mut waiting);
        if at_s >= seconds.end {
            break;
        } else if at_s < seconds.start {
            waited.iter().for_each(|record| remember(&mut latest, record));
            continue;
        }
        let before = std::mem::take(&mut latest).into_values().map(|event| Record::Deed(Deed::Event(event)));
        for record in before.chain(waited).chain([record]) {
            part.write(now, &record).map_err(cannot_write)?;
        }
        frames += 1;
    }
    let ended = part.finish().map_err(cannot_write);
    if frames == 0 {
        let _ = std::fs::remove_file(unfinished);
        let Range { start: from_s, end: to_s } = seconds;
        return Err(TapeError::NothingThere { from_s, to_s, length_s: whole.length_s });
    }
    ended?;
    std::fs::rename(unfinished, to).map_err(|cause| cannot_write(cause.into()))?;
    Ok(frames)
}

/// What a later part must begin with: the latest of each sensor, button and axis.
fn remember(latest: &mut BTreeMap<(u16, u8, u8), Event>, record: &Record) {
    let Record::Deed(Deed::Event(event)) = record else { return };
    let source = event.source.0;
    let (kind, index) = match &event.what {
        What::Pose { sensor, .. } => (0, *sensor),
        What::Button { index, .. } => (1, *index),
        What::Axis { index, .. } => (2, *index),
        What::Lost(_) => {
            latest.retain(|key, _| key.0 != source);
            return;
        }
        What::Found(_) => return,
    };
    latest.insert((source, kind, index), event.clone());
}

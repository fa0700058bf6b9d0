//! A tape as a table.

use crate::error::TapeError;
use crate::reader::Tape;
use crate::record::Record;
use inputs::What;
use serde_json::{Value, json};
use std::io::{self, Write};
use std::path::Path;
use world::Deed;

/// How a table is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// A line of values for each record, with a line of names before.
    Csv,
    /// A JSON object on a line for each record.
    Json,
}

const COLUMNS: &str = "time_s,channel,kind,number,x,y,z,qx,qy,qz,qw,value,text";

/// Writes the records of a tape as a table.
///
/// # Errors
/// It is no tape, it is damaged (what stands before has been written then), or the table cannot be written.
pub fn export(path: &Path, format: Format, out: &mut dyn Write) -> Result<(), TapeError> {
    let tape = Tape::open(path)?;
    if format == Format::Csv {
        writeln!(out, "{COLUMNS}").map_err(TapeError::Export)?;
    }
    for record in tape.records() {
        let record = record?;
        let written = match format {
            Format::Csv => write_row(&record, &tape.head().sources, out),
            Format::Json => writeln!(out, "{}", object(&record)),
        };
        written.map_err(TapeError::Export)?;
    }
    out.flush().map_err(TapeError::Export)
}

fn object(record: &Record) -> Value {
    match record {
        Record::Deed(Deed::Event(event)) => json!({ "event": event }),
        Record::Deed(Deed::Change(change)) => json!({ "change": change }),
        Record::Frame(frame) => json!({ "frame": frame }),
        Record::Said(said) => json!({ "said": said }),
    }
}

fn write_row(record: &Record, sources: &[String], out: &mut dyn Write) -> io::Result<()> {
    let seconds = |ns: u64| 1e-9 * ns as f64;
    match record {
        Record::Frame(frame) => {
            writeln!(
                out,
                "{},frames,frame,{},,,,,,,,,{:016x}",
                seconds(frame.now_ns),
                frame.frame,
                frame.check
            )
        }
        Record::Said(said) => {
            writeln!(out, "{},log,said,,,,,,,,,,{}", seconds(said.now_ns), quoted(&said.text))
        }
        Record::Deed(Deed::Change(change)) => {
            let text = serde_json::to_string(change).unwrap_or_default();
            writeln!(out, ",desk,change,,,,,,,,,,{}", quoted(&text))
        }
        Record::Deed(Deed::Event(event)) => {
            let source = sources.get(usize::from(event.source.0)).map_or("", String::as_str);
            write!(out, "{},{},", event.received.as_secs_f64(), quoted(source))?;
            match &event.what {
                What::Pose { sensor, pose: None } => writeln!(out, "lost target,{sensor},,,,,,,,,"),
                What::Pose { sensor, pose: Some(pose) } => {
                    let (p, q) = (pose.position_m(), pose.rotation());
                    let [x, y, z] = p.to_array();
                    writeln!(out, "pose,{sensor},{x},{y},{z},{},{},{},{},,", q.x, q.y, q.z, q.w)
                }
                What::Button { index, is_down } => {
                    writeln!(out, "button,{index},,,,,,,,{},", u8::from(*is_down))
                }
                What::Axis { index, value } => writeln!(out, "axis,{index},,,,,,,,{value},"),
                What::Found(text) => writeln!(out, "found,,,,,,,,,,{}", quoted(text)),
                What::Lost(text) => writeln!(out, "lost,,,,,,,,,,{}", quoted(text)),
            }
        }
    }
}

/// A text as a field (RFC 4180).
fn quoted(text: &str) -> String {
    format!("\"{}\"", text.replace('"', "\"\""))
}

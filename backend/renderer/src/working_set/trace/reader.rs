//! Reads a trace.

use super::record::{FORMAT, FrameLine, HeaderLine, NodeNumbers, VERSION};
use super::{Demand, TraceError, TraceHeader, TracedFrame};
use bricks::{NodeKey, OctreeShape};
use glam::UVec3;
use optics::Optics;
use serde::Deserialize;
use serde::de::DeserializeOwned;
use std::fs::File;
use std::io::{self, BufRead, BufReader, ErrorKind, Read};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A trace being read, frame by frame.
#[derive(Debug)]
pub struct TraceReader {
    path: PathBuf,
    file: BufReader<File>,
    /// Of the line read last, from 1.
    line: usize,
    header: TraceHeader,
    shape: OctreeShape,
    optics: Option<Arc<Optics>>,
    last_time_s: f64,
}

/// Bytes of the first line, at most: it tells of a volume and a display in few words.
const MOST_OF_HEADER: u64 = 1 << 20;
/// Bytes of a frame's line, at most: it tells of tens of millions of nodes.
const MOST_OF_FRAME: u64 = 1 << 30;

/// What a first line says of itself, whatever else is on it.
#[derive(Deserialize)]
struct Opening {
    format: String,
    version: u32,
}

impl TraceReader {
    /// Opens a trace and reads its header.
    ///
    /// # Errors
    /// The file cannot be read, or does not begin as a trace of this version.
    pub fn open(path: &Path) -> Result<Self, TraceError> {
        let file = bricks::volume::open_file(path).map_err(|e| TraceError::read(path, e))?;
        let mut file = BufReader::new(file);
        let first = next_line(&mut file, MOST_OF_HEADER).map_err(|e| TraceError::read(path, e))?;
        let text = first.unwrap_or_default();
        let header = header(&text).map_err(|why| TraceError::Line { path: path.to_owned(), line: 1, why })?;
        Ok(Self {
            path: path.to_owned(),
            file,
            line: 1,
            shape: header.shape(),
            header,
            optics: None,
            last_time_s: f64::NEG_INFINITY,
        })
    }

    /// What it was recorded of.
    pub fn header(&self) -> &TraceHeader {
        &self.header
    }

    fn frame(&mut self, text: &str) -> Result<TracedFrame, String> {
        let line: FrameLine = parsed(text)?;
        self.check(&line)?;
        let optics =
            line.optics.map(Arc::new).or(self.optics.take()).ok_or("the first frame has no `optics`")?;
        self.optics = Some(Arc::clone(&optics));
        self.last_time_s = line.time_s;
        let nodes = line.demand.into_iter().map(|numbers| node(&self.shape, numbers));
        Ok(TracedFrame {
            index: line.index,
            time_s: line.time_s,
            display_from_volume: line.display_from_volume,
            lod_scale: line.lod_scale,
            optics,
            demand: Demand::new(nodes.collect::<Result<Vec<_>, _>>()?),
        })
    }

    fn check(&self, line: &FrameLine) -> Result<(), String> {
        // A clock that runs backwards, or is NaN, would undo fades.
        if line.time_s.partial_cmp(&self.last_time_s).is_none_or(std::cmp::Ordering::is_lt) {
            return Err(format!("time_s {} comes after {}", line.time_s, self.last_time_s));
        }
        if !(line.lod_scale >= 0.0 && line.lod_scale.is_finite()) {
            return Err(format!("lod_scale {} is not a number of at least 0", line.lod_scale));
        }
        let volume = line.display_from_volume.matrix3.determinant();
        if !line.display_from_volume.is_finite() || volume == 0.0 || !volume.is_finite() {
            return Err("display_from_volume flattens the volume".into());
        }
        line.optics.as_ref().map_or(Ok(()), |optics| optics.check().map_err(|e| e.to_string()))
    }
}

impl Iterator for TraceReader {
    type Item = Result<TracedFrame, TraceError>;

    fn next(&mut self) -> Option<Self::Item> {
        let text = next_line(&mut self.file, MOST_OF_FRAME).transpose()?;
        self.line += 1;
        Some(match text {
            Err(error) => Err(TraceError::read(&self.path, error)),
            Ok(text) => self.frame(&text).map_err(|why| TraceError::Line {
                path: self.path.clone(),
                line: self.line,
                why,
            }),
        })
    }
}

/// The next line, without its end; None at the end of the file. What is no trace may have no line's end at all.
fn next_line(file: &mut BufReader<File>, most: u64) -> io::Result<Option<String>> {
    let mut line = Vec::new();
    file.by_ref().take(most + 1).read_until(b'\n', &mut line)?;
    if line.len() as u64 > most {
        return Err(io::Error::new(ErrorKind::InvalidData, "a line of it is too long for a trace"));
    }
    if line.is_empty() {
        return Ok(None);
    }
    line.pop_if(|byte| *byte == b'\n');
    String::from_utf8(line).map(Some).map_err(|_| io::Error::new(ErrorKind::InvalidData, "it is no text"))
}

fn header(text: &str) -> Result<TraceHeader, String> {
    let found = parsed::<Opening>(text).ok().filter(|found| found.format == FORMAT);
    match found {
        None => Err(format!("the file does not begin with the header of a {FORMAT}")),
        Some(Opening { version, .. }) if version != VERSION => {
            Err(format!("it has version {version}, but this program reads version {VERSION}"))
        }
        Some(_) => {
            let HeaderLine { header, .. } = parsed(text)?;
            if header.dims.min_element() == 0 {
                return Err(format!("dims {} are no size of a volume", header.dims));
            }
            let is_resolution = header.pixel_size_m > 0.0 && header.angular_accuracy >= 0.0;
            is_resolution.then_some(header).ok_or("the display resolves nothing".into())
        }
    }
}

fn node(shape: &OctreeShape, (depth, x, y, z, rays): NodeNumbers) -> Result<(NodeKey, u32), String> {
    let key = NodeKey { depth, cell: UVec3::new(x, y, z) };
    shape.contains(key).then_some((key, rays)).ok_or_else(|| format!("the volume has no node {key}"))
}

/// Every line is its own document, so only the column of an error's place means anything.
fn parsed<T: DeserializeOwned>(text: &str) -> Result<T, String> {
    serde_json::from_str(text).map_err(|error| error.to_string().replace(" at line 1 column ", " at column "))
}

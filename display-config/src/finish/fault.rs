//! What can be wrong with a map of a calibration.

use super::{MOST_MAP_PIXELS, MOST_MESH_ALONG};

/// Why a file is no map. Each goes on after "the file, ": what is wrong, and what to do.
#[derive(Debug, thiserror::Error)]
#[allow(missing_docs, reason = "the message beside each variant says what its fields are")]
pub enum MapFault {
    /// The file cannot be read, or is no file of a sensible length.
    #[error("which cannot be read ({0}); give the path of a readable file")]
    Read(std::io::Error),
    /// The first line of a mesh.
    #[error(
        "which does not begin with the word mesh and two numbers, of columns and of rows from 2 to {MOST_MESH_ALONG}; \
         write `mesh 65 49`, for instance"
    )]
    MeshHead,
    /// A line of a mesh that holds anything but numbers.
    #[error("which has a line {line} with other things than ordinary numbers of metres; correct it")]
    MeshNumber { line: usize },
    /// Too few or too many points.
    #[error("which has {found} numbers for a mesh of {columns} × {rows} points; give x and y of each")]
    MeshCount { found: usize, columns: u32, rows: u32 },
    /// A point that cannot be one of a display.
    #[error("which has a point farther away than 1000000 metres, or at no place at all; correct it")]
    MeshFar,
    /// Points that do not follow each other.
    #[error(
        "which folds over, or has no area, in the cell right of and below column {column} and row {row} (from 0); \
         measure it again"
    )]
    Folded { column: u32, row: u32 },
    /// Something that is neither of the two formats.
    #[error("which is neither a PNG nor a PFM picture; give one of these")]
    Format,
    /// A damaged picture.
    #[error("which is damaged ({0}); make it again")]
    Damaged(String),
    /// More than one channel.
    #[error(
        "which has colours or transparency; give a grey picture: a PNG of 8 or 16 bits, or a PFM with `Pf`"
    )]
    Colours,
    /// Too small or too large.
    #[error("which has {width} × {height} pixels; give at least 1, and at most {MOST_MAP_PIXELS} of them")]
    MapSize { width: u32, height: u32 },
    /// As many numbers as its size does not say.
    #[error("which has {found} numbers for {width} × {height} pixels; make it again")]
    MapCount { found: usize, width: u32, height: u32 },
    /// A number of a PFM that is no share of light.
    #[error(
        "which has {value} at column {column} and row {row} from the top (from 0); give numbers from 0 to 1"
    )]
    MapNumber { value: f32, column: usize, row: usize },
}

//! What can be wrong with a display.

use crate::finish::MapFault;
use crate::raster::MOST_PIXELS;
use crate::text::brief_number;
use std::fmt;
use std::path::PathBuf;

/// Why a ray or an eye is meaningless.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum RayError {
    /// A coordinate or η is NaN or infinite, or so extreme that the ray's coefficients are.
    #[error("a coordinate or η is infinite or not a number; give ordinary numbers of metres")]
    NotFinite,
    /// Ez = 0.
    #[error(
        "the projector's centre lies in the screen plane; move it behind the screen (z < 0) or in front of it (z > 0)"
    )]
    ProjectorInScreenPlane,
    /// Vz ≤ 0.
    #[error("the observer is at z = {} m; it must stand before the screen, at z > 0", brief_number(*z_m))]
    ObserverBehindScreen {
        /// Its z, metres.
        z_m: f64,
    },
    /// η outside [0, 1].
    #[error("η is {}; give a number from 0 (one perspective view) to 1 (full horizontal parallax)", brief_number(*eta))]
    EtaOutOfRange {
        /// The value given.
        eta: f64,
    },
    /// An eye in the screen plane or behind it.
    #[error(
        "the eye is at z = {} m, in the screen plane or behind it; put it before the screen, at z > 0",
        brief_number(*z_m)
    )]
    EyeBehindScreen {
        /// Its z, metres.
        z_m: f64,
    },
}

/// Why a point has no place on the screen.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Clip {
    /// The point lies in the observer's plane or behind it.
    #[error("the point is in the observer's plane or behind it")]
    BehindObserver,
    /// No single ray of this projector passes through the point.
    #[error("no single ray of the projector passes through the point")]
    NoImage,
    /// A coordinate of the point is NaN or infinite.
    #[error("a coordinate of the point is infinite or not a number")]
    NotFinite,
}

/// A key of a display file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Place {
    /// The file, as messages call it.
    pub file: String,
    /// The line, from 1.
    pub line: usize,
    /// The key.
    pub key: String,
}

impl fmt::Display for Place {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(out, "{}, line {}: `{}`", self.file, self.line, self.key)
    }
}

/// Why a display cannot be read. Each is one sentence that says where, what, and what to do.
#[derive(Debug, thiserror::Error)]
#[allow(missing_docs, reason = "the message beside each variant says what its fields are")]
pub enum ConfigError {
    /// The file cannot be read.
    #[error("cannot read the display file {}: {cause}; give the path of a readable .toml file", path.display())]
    Read { path: PathBuf, cause: std::io::Error },
    /// Neither a preset nor a path.
    #[error(
        "there is no preset display `{name}`{suggestion}; use one of {presets}, or give the path of a .toml file"
    )]
    UnknownPreset { name: String, suggestion: String, presets: String },
    /// Not TOML.
    #[error("{file}, line {line}: this is not TOML ({message}); correct the line")]
    Syntax { file: String, line: usize, message: String },
    /// A key that nothing reads.
    #[error("{place} is not a key of this table{suggestion}; remove it, or use {known}")]
    UnknownKey { place: Place, suggestion: String, known: String },
    /// A key that the geometry needs.
    #[error("{place} is missing from the table that starts here; add it")]
    MissingKey { place: Place },
    /// A value of another type than the key's, or not among its choices.
    #[error("{place} cannot have this value ({message}); give what it expects")]
    WrongType { place: Place, message: String },
    /// NaN or infinity.
    #[error("{place} has an infinite number or NaN; give an ordinary number")]
    NotFinite { place: Place },
    /// A number outside its range.
    #[error("{place} is {}; give {expected}", brief_number(*value))]
    OutOfRange { place: Place, value: f64, expected: &'static str },
    /// A raster that does not fit into memory, or into a message.
    #[error("{place} makes a picture of {width} × {height} pixels; give at most {MOST_PIXELS} of them")]
    TooManyPixels { place: Place, width: u32, height: u32 },
    /// A text that must not be empty.
    #[error("{place} is empty; give a name")]
    EmptyName { place: Place },
    /// Nothing would light the screen.
    #[error(
        "{place} is absent or empty, so the display has no projectors; add [[projector]] entries or a [projector_line]"
    )]
    NoProjectors { place: Place },
    /// Both ways of listing projectors at once.
    #[error("{place} and [[projector]] entries exclude each other; keep one of the two")]
    TwoLists { place: Place },
    /// Ez = 0.
    #[error(
        "{place} puts a projector in the screen plane (z = 0); move it behind the screen (z < 0) or in front of it (z > 0)"
    )]
    ProjectorInScreenPlane { place: Place },
    /// No or several placements of a raster.
    #[error(
        "{place} has {count} of the keys screen_rect_m, homography and corners_m; give exactly one of them"
    )]
    Placement { place: Place, count: usize },
    /// A file of a calibration that is none.
    #[error("{place} names {}, {fault}", path.display())]
    Map { place: Place, path: PathBuf, fault: MapFault },
    /// A raster that falls on a line, on a point, or across the horizon.
    #[error("{place} is singular: the raster has no area on the screen; measure it again")]
    SingularRaster { place: Place },
    /// Two projectors of one name.
    #[error("{place} `{name}` is already the name of another projector; give each its own")]
    DuplicateName { place: Place, name: String },
    /// Two rasters on the same pixels of an output.
    #[error(
        "{place} puts the picture on pixels of `{output}` that projector `{other}` of the same back-end uses; move one of them"
    )]
    OverlappingOutput { place: Place, output: String, other: String },
    /// A back-end of a line with more projectors than connectors.
    #[error(
        "{place} has {outputs} connectors, and back-end {backend} has more projectors; name one for each projector of a back-end"
    )]
    TooFewLineOutputs { place: Place, outputs: usize, backend: u32 },
    /// A projector that cannot be driven.
    #[error(
        "projector `{projector}` has no output in the display file; give it one (`lightloom outputs` lists them), or show \
         the display on a desktop with --desktop"
    )]
    NoOutput { projector: String },
    /// Two projectors of one back-end with the same pixels, since others share them than the file says.
    #[error(
        "projectors `{other}` and `{projector}` of one back-end have the same pixels of an output; start as many back-ends \
         as the display file wires"
    )]
    SharedOutput { projector: String, other: String },
    /// Back-ends are not numbered 0, 1, 2, …
    #[error(
        "{place} is {highest}, but no projector has back-end {missing}; number the back-ends from 0 without gaps"
    )]
    BackendGap { place: Place, highest: u32, missing: u32 },
    /// A table for a back-end that no projector names.
    #[error(
        "{place} is the table of back-end {number}, but the projectors' back-ends end at {highest}; remove it, or give \
         that back-end a projector"
    )]
    BackendWithoutProjectors { place: Place, number: usize, highest: usize },
    /// More back-ends than projectors, in a file.
    #[error("{place} is {backends} for {projectors} projectors; give each back-end at least one")]
    TooManyLineBackends { place: Place, backends: u32, projectors: u32 },
    /// No back-end, or more than projectors.
    #[error(
        "cannot share {projectors} projectors among {backends} back-ends; start from 1 to {projectors} of them"
    )]
    Backends { backends: usize, projectors: usize },
}

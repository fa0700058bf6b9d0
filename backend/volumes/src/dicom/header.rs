//! What the header of a DICOM file says of its frames; the pixels are not read.

use super::attributes::{FrameAttributes, integer, item, number, numbers, text, time, vector};
use super::lengths;
use super::pixels::PixelFormat;
use super::start::Start;
use super::syntax::is_plain;
use bricks::volume::{MAX_EDGE_VOXELS, VolumeError};
use dicom_core::Tag;
use dicom_dictionary_std::tags;
use dicom_object::{InMemDicomObject, OpenFileOptions};
use glam::DVec3;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Float pixel data, the first of the elements with pixels: reading a header ends before it.
const FIRST_PIXELS: Tag = Tag(0x7FE0, 0x0008);
/// None of the packings makes fewer bytes of so many: deflate, the best of them, has 1032.
const LARGEST_RATIO: u64 = 1032;
/// The tags that may distinguish images at the same place, in the order that they sort by.
pub(super) const MOMENT_NAMES: [&str; 5] =
    ["TemporalPosition", "AcquisitionTime", "TriggerTime", "EchoTime", "InstanceNumber"];

/// How files call an image whose numbers stand for colours (PS3.3 C.7.6.3.1.2).
const PALETTE: &str = "PALETTE COLOR";

/// What all frames of a file share.
#[derive(Clone, Debug)]
pub(super) struct ImageFile {
    pub path: PathBuf,
    pub start: Start,
    pub transfer_syntax: String,
    pub series_uid: String,
    pub description: String,
    pub modality: String,
    /// The unit of its values, where one is said.
    pub rescale_type: String,
    pub series_number: i64,
    pub rows: u32,
    pub columns: u32,
    pub frames: u32,
    /// Whether the numbers stand for the colours of a table.
    pub has_palette: bool,
    pub samples_per_pixel: u16,
    pub pixels: PixelFormat,
    /// Length of the file, bytes.
    pub length: u64,
}

/// Where a frame lies in the patient.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Pose {
    /// Centre of the first voxel, mm.
    pub position_mm: DVec3,
    /// Directions in which columns and rows count up: unit vectors.
    pub along_row: DVec3,
    pub along_column: DVec3,
}

impl Pose {
    /// The direction from slice to slice.
    pub fn normal(&self) -> DVec3 {
        self.along_row.cross(self.along_column)
    }
}

/// One image of a file.
#[derive(Clone, Debug)]
pub(super) struct Frame {
    pub file: Arc<ImageFile>,
    /// Its number in the file, from 0.
    pub index: u32,
    pub pose: Option<Pose>,
    /// From column to column and from row to row, mm.
    pub spacing_mm: Option<[f64; 2]>,
    /// From slice to slice, mm, if positions do not give it.
    pub slice_spacing_mm: Option<f64>,
    /// Value = slope × number + intercept.
    pub scaling: (f64, f64),
    /// When and how it was taken; see [`MOMENT_NAMES`].
    pub moment: [Option<f64>; MOMENT_NAMES.len()],
}

impl Frame {
    /// The frame in words.
    pub fn name(&self) -> String {
        let name = self.file.path.file_name().unwrap_or_default().to_string_lossy();
        match (self.file.frames, self.moment[MOMENT_NAMES.len() - 1]) {
            (1, Some(instance)) => format!("{name} (instance {instance})"),
            (1, None) => name.into_owned(),
            _ => format!("{name} frame {}", self.index + 1),
        }
    }

    /// Bytes of the unpacked frame.
    pub fn bytes(&self) -> usize {
        self.file.rows as usize * self.file.columns as usize * usize::from(self.file.pixels.allocated / 8)
    }
}

/// Reads the header; no frames where the file is not a DICOM file, or holds no image.
pub(super) fn read(path: &Path) -> Result<Vec<Frame>, VolumeError> {
    let Some(start) = Start::of_file(path)? else { return Ok(Vec::new()) };
    lengths::check(path, start)?;
    let length = std::fs::metadata(path).map_err(VolumeError::open(path))?.len();
    let file = start.open(path).map_err(VolumeError::open(path))?;
    let object = OpenFileOptions::new().read_until(FIRST_PIXELS).from_reader(file);
    let object = object.map_err(|cause| damaged(path, &cause))?;
    match image_file(path, start, &object, object.meta().transfer_syntax(), length)? {
        Some(file) => Ok(frames(&Arc::new(file), &object)),
        None => Ok(Vec::new()),
    }
}

/// A file that the DICOM crate gave up on.
pub(super) fn damaged(path: &Path, error: &dyn std::error::Error) -> VolumeError {
    let what = format!("{}; the file may be damaged: copy it again", cause_of(error));
    VolumeError::unsupported(path, what)
}

/// An error in its own words, from the outermost to the cause.
pub(super) fn cause_of(error: &dyn std::error::Error) -> String {
    let causes = std::iter::successors(Some(error), |&error| error.source());
    let words: Vec<String> = causes.map(|cause| cause.to_string().replace('\n', " ")).collect();
    words.join(": ")
}

fn image_file(
    path: &Path,
    start: Start,
    object: &InMemDicomObject,
    syntax: &str,
    length: u64,
) -> Result<Option<ImageFile>, VolumeError> {
    let text_of = |tag| text(object.get(tag)).unwrap_or_default();
    let integer_of = |tag| integer(object.get(tag));
    let (Some(rows), Some(columns)) = (integer_of(tags::ROWS), integer_of(tags::COLUMNS)) else {
        return Ok(None);
    };
    let edge = |count: i64| u32::try_from(count).ok().filter(|count| (1..=MAX_EDGE_VOXELS).contains(count));
    let frames = integer_of(tags::NUMBER_OF_FRAMES).unwrap_or(1);
    let (Some(rows), Some(columns), Some(frames)) = (edge(rows), edge(columns), edge(frames)) else {
        let what = format!("{frames} frames of {columns} × {rows}: each must be from 1 to {MAX_EDGE_VOXELS}");
        return Err(VolumeError::header(path, what));
    };
    let bits = |tag| integer_of(tag).and_then(|bits| u16::try_from(bits).ok());
    let allocated = bits(tags::BITS_ALLOCATED).unwrap_or(0);
    let stored = bits(tags::BITS_STORED).unwrap_or(allocated);
    let pixels = PixelFormat {
        allocated,
        stored,
        high_bit: bits(tags::HIGH_BIT).unwrap_or(stored.saturating_sub(1)),
        is_signed: integer_of(tags::PIXEL_REPRESENTATION) == Some(1),
        is_float: is_float(object, allocated),
    };
    let file = ImageFile {
        path: path.into(),
        start,
        transfer_syntax: syntax.trim_end_matches('\0').trim().to_owned(),
        series_uid: text_of(tags::SERIES_INSTANCE_UID),
        description: text_of(tags::SERIES_DESCRIPTION),
        modality: text_of(tags::MODALITY),
        rescale_type: text_of(tags::RESCALE_TYPE),
        series_number: integer_of(tags::SERIES_NUMBER).unwrap_or(0),
        rows,
        columns,
        frames,
        has_palette: text_of(tags::PHOTOMETRIC_INTERPRETATION) == PALETTE,
        samples_per_pixel: bits(tags::SAMPLES_PER_PIXEL).unwrap_or(1),
        pixels,
        length,
    };
    check_length(&file)?;
    Ok(Some(file))
}

/// Whether pixels of so many bits are floats: their files must not say what the bits of an integer mean, and all others
/// have to (PS3.3 C.7.6.3, C.7.6.24 and 25).
fn is_float(object: &InMemDicomObject, allocated: u16) -> bool {
    let of_integers = [tags::BITS_STORED, tags::HIGH_BIT, tags::PIXEL_REPRESENTATION];
    matches!(allocated, 32 | 64) && of_integers.into_iter().all(|tag| object.get(tag).is_none())
}

/// Whether the file can hold the frames, before memory is taken for them.
fn check_length(file: &ImageFile) -> Result<(), VolumeError> {
    let pixels = u64::from(file.rows) * u64::from(file.columns) * u64::from(file.frames);
    let promised = pixels.saturating_mul(u64::from(file.pixels.allocated)) / 8;
    let ratio = if is_plain(&file.transfer_syntax) { 1 } else { LARGEST_RATIO };
    if promised <= file.length.saturating_mul(ratio) && u64::from(file.frames) <= file.length {
        return Ok(());
    }
    let found = format!("the file has {}", file.length);
    Err(VolumeError::Truncated { path: file.path.clone(), promised, found })
}

fn frames(file: &Arc<ImageFile>, object: &InMemDicomObject) -> Vec<Frame> {
    let shared = item(object, tags::SHARED_FUNCTIONAL_GROUPS_SEQUENCE);
    let groups = object.get(tags::PER_FRAME_FUNCTIONAL_GROUPS_SEQUENCE).and_then(|groups| groups.items());
    let of = |index: u32| {
        let own = groups.and_then(|groups| groups.get(index as usize));
        frame(file, index, &FrameAttributes { own, shared, file: object })
    };
    (0..file.frames).map(of).collect()
}

fn frame(file: &Arc<ImageFile>, index: u32, attributes: &FrameAttributes) -> Frame {
    let find = |group, tag| attributes.find(group, tag);
    let measures = |tag| number(find(tags::PIXEL_MEASURES_SEQUENCE, tag));
    let slice_spacing_mm = measures(tags::SPACING_BETWEEN_SLICES).or_else(|| measures(tags::SLICE_THICKNESS));
    let transform = |tag| number(find(tags::PIXEL_VALUE_TRANSFORMATION_SEQUENCE, tag));
    // A dose has a scaling of its own name (PS3.3 C.8.8.3).
    let slope = transform(tags::RESCALE_SLOPE).or_else(|| transform(tags::DOSE_GRID_SCALING));
    Frame {
        file: file.clone(),
        index,
        pose: pose(index, attributes, slice_spacing_mm),
        spacing_mm: spacing_mm(attributes),
        slice_spacing_mm: slice_spacing_mm.map(f64::abs),
        scaling: (slope.unwrap_or(1.0), transform(tags::RESCALE_INTERCEPT).unwrap_or(0.0)),
        moment: moment(file, index, attributes),
    }
}

/// The frame's own position, or that of the first frame and so many slices further on.
fn pose(index: u32, attributes: &FrameAttributes, slice_spacing_mm: Option<f64>) -> Option<Pose> {
    // Nuclear medicine keeps both with the detector (PS3.3 C.8.4.11).
    let find = |group, tag| {
        let detector = || item(attributes.file, tags::DETECTOR_INFORMATION_SEQUENCE)?.get(tag);
        attributes.find(group, tag).or_else(detector)
    };
    let orientation = |start| {
        vector(find(tags::PLANE_ORIENTATION_SEQUENCE, tags::IMAGE_ORIENTATION_PATIENT), start)
            .and_then(DVec3::try_normalize)
    };
    let position_mm = vector(find(tags::PLANE_POSITION_SEQUENCE, tags::IMAGE_POSITION_PATIENT), 0)?;
    let mut pose = Pose { position_mm, along_row: orientation(0)?, along_column: orientation(3)? };
    let has_own = attributes.own.is_some_and(|own| item(own, tags::PLANE_POSITION_SEQUENCE).is_some());
    if !has_own && index > 0 {
        // A dose says how far each frame is from the first (PS3.3 C.8.8.3.2).
        let offsets = numbers(attributes.file.get(tags::GRID_FRAME_OFFSET_VECTOR));
        let offset = offsets.and_then(|offsets| Some(offsets.get(index as usize)? - offsets.first()?));
        pose.position_mm += pose.normal() * offset.or(slice_spacing_mm.map(|mm| mm * f64::from(index)))?;
    }
    Some(pose)
}

/// DICOM gives the distance of rows first.
fn spacing_mm(attributes: &FrameAttributes) -> Option<[f64; 2]> {
    let find = |tag| numbers(attributes.find(tags::PIXEL_MEASURES_SEQUENCE, tag));
    let both = find(tags::PIXEL_SPACING).or_else(|| find(tags::IMAGER_PIXEL_SPACING))?;
    Some([*both.get(1)?, *both.first()?])
}

fn moment(file: &ImageFile, index: u32, attributes: &FrameAttributes) -> [Option<f64>; MOMENT_NAMES.len()] {
    let content = |tag| attributes.find(tags::FRAME_CONTENT_SEQUENCE, tag);
    let of_file = |tag| attributes.file.get(tag);
    let echo = attributes.find(tags::MR_ECHO_SEQUENCE, tags::EFFECTIVE_ECHO_TIME);
    let instance = number(of_file(tags::INSTANCE_NUMBER));
    [
        number(of_file(tags::TEMPORAL_POSITION_IDENTIFIER).or(content(tags::TEMPORAL_POSITION_INDEX))),
        time(content(tags::FRAME_ACQUISITION_DATE_TIME).or(of_file(tags::ACQUISITION_TIME))),
        number(of_file(tags::TRIGGER_TIME)),
        number(echo.or(of_file(tags::ECHO_TIME))),
        if file.frames == 1 { instance } else { Some(f64::from(index) + 1.0) },
    ]
}

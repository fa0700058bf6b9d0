//! From a volume to a store.

use super::LevelSummary;
use crate::FrontendError;
use crate::interrupt;
use crate::orientation::FrameFacts;
use crate::progress::Progress;
use crate::scene::{Scene, VolumeSource};
use bricks::BrickSource;
use bricks::store::{BuildOptions, CodeBits, Codec, Emptiness, Store};
use bricks::volume::{ByteOrder, Element};
use glam::{DVec3, UVec3};
use serde::Serialize;
use std::cell::RefCell;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use volumes::ImportOptions;
use volumes::{RawLayout, Selection};

/// What to import, and how.
#[derive(Clone, Debug, PartialEq)]
pub struct ImportRequest {
    /// A volume file, a folder of one, `procedural:NAME` or `procedural:NAME@VOXELS`.
    pub input: PathBuf,
    /// The store to write.
    pub output: PathBuf,
    /// Bits per voxel in the store.
    pub bits: CodeBits,
    /// How bricks are compressed.
    pub codec: Codec,
    /// Memory that the import may use, bytes.
    pub memory_bytes: u64,
    /// Which bricks are left out.
    pub skipped: Skipped,
    /// Whether coarse levels keep standard deviations.
    pub has_deviation: bool,
    /// Of several DICOM series: which one.
    pub series: Option<String>,
    /// Of a pyramid: the level, 0 = finest.
    pub level: Option<u32>,
    /// Of several channels: which one, from 0.
    pub channel: Option<u32>,
    /// Of a time series: which point in time, from 0.
    pub time: Option<u32>,
    /// Edge lengths of a voxel, millimetres, in place of what the file says.
    pub voxel_mm: Option<DVec3>,
    /// The voxels of a file without header.
    pub raw: Option<RawRequest>,
}

/// Which bricks an import leaves out.
#[derive(Clone, Debug, PartialEq)]
pub enum Skipped {
    /// Those of one value.
    Uniform,
    /// Those in which every value is below this one.
    Below(f64),
    /// Those that the transfer functions of a scene file do not show.
    UnseenIn(PathBuf),
}

/// What a file without header holds.
#[derive(Clone, Debug, PartialEq)]
pub struct RawRequest {
    /// Voxels along x (fastest), y and z.
    pub dims: UVec3,
    /// Name of a voxel's type.
    pub element: String,
    /// Byte order of a voxel.
    pub byte_order: ByteOrder,
    /// Edge lengths of a voxel, millimetres.
    pub spacing_mm: DVec3,
    /// Bytes before the first voxel.
    pub skip_bytes: u64,
}

/// What an import did.
#[derive(Clone, Debug, Serialize)]
pub struct ImportSummary {
    /// Voxels along each axis.
    pub dims: UVec3,
    /// Size, orientation and place of the voxels.
    pub frame: FrameFacts,
    /// Bytes of the source's voxels.
    pub source_bytes: u64,
    /// Bytes of the store.
    pub store_bytes: u64,
    /// Bricks that hold anything.
    pub stored_bricks: u64,
    /// Bricks left out by the rules for empty ones that were not of one value.
    pub emptied_bricks: u64,
    /// Smallest and largest value.
    pub value_range: (f64, f64),
    /// Root mean square of the store's error, data units.
    pub rms_error: f64,
    /// Largest error, data units.
    pub max_error: f64,
    /// Errors of all levels, the finest first.
    pub level_errors: Vec<LevelSummary>,
    /// Non-finite voxels, which were replaced.
    pub non_finite: u64,
    /// Time it took, milliseconds.
    pub total_ms: f64,
}

/// Makes a store from a volume file, a folder of one, or a procedural volume. A signal to end stops it in good order.
pub fn import(request: &ImportRequest, progress: Progress) -> Result<ImportSummary, FrontendError> {
    check_name(&request.output)?;
    let stop = interrupt::stop_flag()?;
    let (input, options) = import_options(request, &stop)?;
    let selection = selection(request)?;
    let progress = RefCell::new(progress);
    let show = |done: u64, total: u64| {
        progress.borrow_mut().set(done as f64 / total.max(1) as f64, "slabs");
    };
    let failed = |sentence: String| match stop.load(Ordering::SeqCst) {
        true => FrontendError::Stopped(sentence),
        false => FrontendError::Volume(sentence),
    };
    let report = volumes::import(&input, &selection, &request.output, &options, &show)
        .map_err(|error| failed(error.to_string()))?;
    let store = Store::open(&request.output).map_err(|error| failed(error.to_string()))?;
    Ok(ImportSummary {
        dims: report.dims,
        frame: FrameFacts::of(&store.frame()),
        source_bytes: report.source_bytes,
        store_bytes: report.store_bytes,
        stored_bricks: report.stored_bricks,
        emptied_bricks: report.emptied_bricks,
        value_range: report.value_range,
        rms_error: report.rms_error,
        max_error: report.max_error,
        level_errors: LevelSummary::all(&report.levels),
        non_finite: report.non_finite,
        total_ms: 1e3 * report.duration.as_secs_f64(),
    })
}

/// Only by this ending do the other commands know a store.
fn check_name(store: &Path) -> Result<(), FrontendError> {
    match store.extension().is_some_and(|extension| extension == "lloom") {
        true => Ok(()),
        false => Err(FrontendError::Volume(format!(
            "{} does not end in .lloom, by which other commands know a store: give such a name",
            store.display()
        ))),
    }
}

/// The input as the importer wants it: without the `@VOXELS` of a procedural volume, which goes into the options.
fn import_options(
    request: &ImportRequest,
    stop: &Arc<AtomicBool>,
) -> Result<(PathBuf, ImportOptions), FrontendError> {
    let build = BuildOptions {
        bits: request.bits,
        codec: request.codec,
        memory_bytes: request.memory_bytes - readers_share(request),
        emptiness: emptiness(&request.skipped)?,
        has_deviation: request.has_deviation,
        stop: Some(Arc::clone(stop)),
    };
    let mut options = ImportOptions { build, ..ImportOptions::default() };
    let mut input = request.input.clone();
    // A name that is no text is a file's.
    let text = input.to_str().unwrap_or_default();
    if let Some(VolumeSource::Procedural { name, dims }) = VolumeSource::parse_procedural(text)? {
        options.procedural_dims = dims;
        input = format!("{}{name}", volumes::PROCEDURAL_PREFIX).into();
    }
    Ok((input, options))
}

/// What of the memory is for the reader; the rest is for the build.
fn readers_share(request: &ImportRequest) -> u64 {
    request.memory_bytes / 4
}

fn emptiness(skipped: &Skipped) -> Result<Emptiness, FrontendError> {
    Ok(match skipped {
        Skipped::Uniform => Emptiness::Lossless,
        Skipped::Below(value) => Emptiness::Below(*value),
        Skipped::UnseenIn(scene) => Emptiness::Invisible(Scene::visibility_in_file(scene)?),
    })
}

fn selection(request: &ImportRequest) -> Result<Selection, FrontendError> {
    Ok(Selection {
        raw: request.raw.as_ref().map(raw_layout).transpose()?,
        series: request.series.clone(),
        level: request.level,
        channel: request.channel,
        time: request.time,
        spacing_mm: request.voxel_mm,
        memory_bytes: readers_share(request),
    })
}

fn raw_layout(raw: &RawRequest) -> Result<RawLayout, FrontendError> {
    let element = &raw.element;
    let unknown = || {
        FrontendError::Volume(format!("`{element}` is no voxel type; give uint8, int16, float or the like"))
    };
    Ok(RawLayout {
        dims: raw.dims,
        element: Element::from_name(element).ok_or_else(unknown)?,
        byte_order: raw.byte_order,
        spacing_mm: raw.spacing_mm,
        header_skip_bytes: raw.skip_bytes,
    })
}

//! From a volume to a store.

use super::LevelSummary;
use crate::FrontendError;
use crate::cli::ImportArgs;
use crate::interrupt;
use crate::orientation::FrameFacts;
use crate::progress::Progress;
use crate::scene::{Scene, VolumeSource};
use bricks::BrickSource;
use bricks::store::{BuildOptions, Emptiness, Store};
use bricks::volume::Element;
use glam::UVec3;
use serde::Serialize;
use std::cell::RefCell;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use volumes::ImportOptions;
use volumes::{RawLayout, Selection};

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
pub fn import(args: &ImportArgs, progress: Progress) -> Result<ImportSummary, FrontendError> {
    let stop = interrupt::stop_flag()?;
    let (input, options) = import_options(args, &stop)?;
    let selection = selection(args)?;
    let progress = RefCell::new(progress);
    let show = |done: u64, total: u64| {
        progress.borrow_mut().set(done as f64 / total.max(1) as f64, "slabs");
    };
    let failed = |sentence: String| match stop.load(Ordering::SeqCst) {
        true => FrontendError::Stopped(sentence),
        false => FrontendError::Volume(sentence),
    };
    let report = volumes::import(&input, &selection, &args.output, &options, &show)
        .map_err(|error| failed(error.to_string()))?;
    let store = Store::open(&args.output).map_err(|error| failed(error.to_string()))?;
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

/// The input as the importer wants it: without the `@VOXELS` of a procedural volume, which goes into the options.
fn import_options(
    args: &ImportArgs,
    stop: &Arc<AtomicBool>,
) -> Result<(String, ImportOptions), FrontendError> {
    let build = BuildOptions {
        bits: args.bits.into(),
        codec: args.codec.into(),
        memory_bytes: memory_bytes(args) - readers_share(args),
        emptiness: emptiness(args)?,
        has_deviation: args.deviation,
        stop: Some(Arc::clone(stop)),
    };
    let mut options = ImportOptions { build, ..ImportOptions::default() };
    let mut input = args.input.to_string_lossy().into_owned();
    if let Some(VolumeSource::Procedural { name, dims }) = VolumeSource::parse_procedural(&input)? {
        options.procedural_dims = dims;
        input = format!("{}{name}", volumes::PROCEDURAL_PREFIX);
    }
    Ok((input, options))
}

fn memory_bytes(args: &ImportArgs) -> u64 {
    args.memory_mib << 20
}

/// What of the memory is for the reader; the rest is for the build.
fn readers_share(args: &ImportArgs) -> u64 {
    memory_bytes(args) / 4
}

fn emptiness(args: &ImportArgs) -> Result<Emptiness, FrontendError> {
    Ok(match (args.empty_below, &args.empty_for) {
        (Some(value), _) => Emptiness::Below(value),
        (None, Some(scene)) => Emptiness::Invisible(Scene::visibility_in_file(scene)?),
        (None, None) => Emptiness::Lossless,
    })
}

fn selection(args: &ImportArgs) -> Result<Selection, FrontendError> {
    let pick = &args.pick;
    Ok(Selection {
        raw: raw_layout(args)?,
        series: pick.series.clone(),
        level: pick.level,
        channel: pick.channel,
        time: pick.time,
        spacing_mm: pick.voxel_mm,
        memory_bytes: readers_share(args),
    })
}

fn raw_layout(args: &ImportArgs) -> Result<Option<RawLayout>, FrontendError> {
    let (Some(dims), Some(element)) = (args.raw.dims, &args.raw.element) else { return Ok(None) };
    let unknown = || {
        FrontendError::Volume(format!(
            "`{element}` is not a voxel type; give uint8, int16, float or the like"
        ))
    };
    Ok(Some(RawLayout {
        dims,
        element: Element::from_name(element).ok_or_else(unknown)?,
        byte_order: args.raw.endian.into(),
        spacing_mm: args.raw.raw_spacing_mm,
        header_skip_bytes: args.raw.skip_bytes,
    }))
}

//! What frames are drawn with: the device, the working set, and what stands between them.

use super::RenderError;
use super::closeness::Closeness;
use super::easing::Easing;
use super::known::Known;
use super::live_memory::Live;
use super::recording::Recording;
use super::refining::Refining;
use super::shelf::Shelf;
use super::stock::Stock;
use super::table_cache::TableCache;
use crate::device::{CacheWish, ChosenDevice, Device, open_device};
use crate::present::Finisher;
use crate::working_set::{Loader, PANTRY_BYTES, WorkingSet};
use bricks::{BrickSource, NodeKey};
use overlay::Pen;
use protocol::{DeviceInfo, RendererOptions};
use std::sync::Arc;

/// All that outlives a frame.
pub(super) struct Engine {
    pub(super) options: RendererOptions,
    /// Of each view: the projectors of the options, in their order.
    pub(super) finishers: Vec<Finisher>,
    pub(super) device: Device,
    pub(super) set: WorkingSet,
    pub(super) stock: Stock,
    pub(super) shelf: Shelf,
    pub(super) tables: TableCache,
    pub(super) closeness: Closeness,
    pub(super) live: Live,
    pub(super) easing: Easing,
    pub(super) known: Known,
    pub(super) refining: Refining,
    pub(super) recording: Recording,
    pub(super) pen: Pen,
}

impl Engine {
    pub(super) fn new(
        options: &RendererOptions,
        source: Arc<dyn BrickSource>,
    ) -> Result<(Self, DeviceInfo), RenderError> {
        let cache = CacheWish {
            bytes: options.cache_bytes,
            slots_needed: source.shape().total_node_count(),
            has_deviations: source.has_deviation(),
        };
        let ChosenDevice { device, info } =
            open_device(options.device, &options.adapter, options.filter, &cache)?;
        let finisher =
            |&projector: &u32| options.display.projectors.get(projector as usize).map(Finisher::new);
        let loader = Loader::new(Arc::clone(&source), loader_threads(), PANTRY_BYTES);
        let engine = Self {
            options: options.clone(),
            finishers: options.projectors.iter().filter_map(finisher).collect(),
            // The shelf keeps one slot blank.
            set: WorkingSet::new(source.summary(NodeKey::ROOT), device.slots() - 1),
            shelf: Shelf::new(device.slots()),
            device,
            stock: Stock::new(source, loader),
            tables: TableCache::default(),
            closeness: Closeness::default(),
            live: Live::default(),
            easing: Easing::default(),
            known: Known::default(),
            refining: Refining::default(),
            recording: Recording::default(),
            pen: Pen::default(),
        };
        Ok((engine, info))
    }
}

/// Enough to keep a disk busy while others unpack.
fn loader_threads() -> usize {
    std::thread::available_parallelism().map_or(2, |n| n.get().clamp(2, 8))
}

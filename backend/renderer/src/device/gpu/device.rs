//! A back-end's share of the GPU: its atlas and buffers.

use super::arena::Arena;
use super::atlas::{Atlas, Depth};
use super::batch::{BatchSize, views_at_once};
use super::context::Context;
use super::feedback::FrameFeedback;
use super::pictures::Pictures;
use super::plane_buffers::PlaneBuffers;
use super::precision::{filter_error, is_precise};
use super::readback::Readback;
use super::storage::{Storage, uniform};
use super::swapchain::Swapchains;
use crate::device::{Codes, DeviceError, DevicePicture, FeedbackTag, FinishJob, ShowJob, TaggedFeedback};
use crate::present::Raster;
use bricks::BRICK_VOXELS;
use layout::{FeedbackEntry, Link, NodeRecord, SceneBlock};
use needs::tables::Tables;
use optics::MOST_ENHANCERS;
use planes::Plan;
use protocol::{CodesAt, DeviceInfo, FilterChoice};
use shaders::compose::{Filter, Lookup};
use std::borrow::Cow;
use std::sync::Arc;
use twin::ProjectorRays;

/// A device with its brick cache.
#[derive(Debug)]
pub struct GpuDevice {
    pub(super) context: Arc<Context>,
    pub(super) atlas: Atlas,
    /// The bricks' standard deviations, slot by slot as in the atlas; None where bricks have none.
    pub(super) deviations: Option<Atlas>,
    pub(super) sampler: wgpu::Sampler,
    pub(super) filter: Filter,
    filter_error: Option<f32>,
    pub(super) lookup: Lookup,
    pub(super) scene: wgpu::Buffer,
    pub(super) links: wgpu::Buffer,
    pub(super) nodes: Storage,
    pub(super) cells: Storage,
    pub(super) optics: Storage,
    pub(super) importance: Storage,
    pub(super) importance_most: Storage,
    pub(super) index: Storage,
    pub(super) materials: Storage,
    pub(super) table_cells: Storage,
    pub(super) pictures: Pictures,
    pub(super) feedback: Storage,
    pub(super) frame_feedback: FrameFeedback,
    pub(super) found_back: Readback,
    /// Short rays, each with a colour of its own beside the pictures, and the way of these to the host.
    pub(super) short: Arena,
    pub(super) short_back: Readback,
    /// The nodes of the index, as they lie in their buffer.
    pub(super) records: Arc<[NodeRecord]>,
    pub(super) planes: PlaneBuffers,
    pub(super) batch: BatchSize,
}

impl GpuDevice {
    /// A device of an adapter with a cache of about `slots` bricks.
    ///
    /// # Errors
    /// No memory, or no such filter.
    pub(in crate::device) fn new(
        context: Arc<Context>,
        filter: FilterChoice,
        slots: u32,
        has_deviations: bool,
    ) -> Result<Self, DeviceError> {
        let turn = context.turn();
        let sampler = |label, filter| {
            context.device.create_sampler(&wgpu::SamplerDescriptor {
                label: Some(label),
                mag_filter: filter,
                min_filter: filter,
                ..Default::default()
            })
        };
        let trilinear = sampler("trilinear", wgpu::FilterMode::Linear);
        let filter_error = context.has_filter.then(|| filter_error(&context, &trilinear)).transpose()?;
        let filter = choose_filter(filter, filter_error)?;
        let (depth, sampler) = match filter {
            Filter::Gathered => (Depth::Layers, sampler("nearest", wgpu::FilterMode::Nearest)),
            Filter::Hardware | Filter::Exact => (Depth::Dimension, trilinear),
        };
        let atlas = Atlas::new(&context, slots, context.atlas_format, depth)?;
        let deviations = has_deviations
            .then(|| Atlas::new(&context, slots, wgpu::TextureFormat::R8Unorm, Depth::Dimension))
            .transpose()?;
        let storage = |label| Storage::new(&context, label);
        let scene = uniform::<SceneBlock>(&context, "scene");
        let links = uniform::<[Link; MOST_ENHANCERS]>(&context, "chain of enhancers");
        drop(turn);
        Ok(Self {
            atlas,
            deviations,
            sampler,
            filter,
            filter_error,
            lookup: Lookup::Listed,
            scene,
            links,
            nodes: storage("nodes"),
            cells: storage("visible cells"),
            table_cells: storage("table cells"),
            optics: storage("optics table"),
            importance: storage("importance table"),
            importance_most: storage("largest importances"),
            index: storage("refraction table"),
            materials: storage("material table"),
            pictures: Pictures::new(&context),
            feedback: storage("feedback"),
            frame_feedback: FrameFeedback::new(&context),
            found_back: Readback::new(),
            short: Arena::new(&context),
            short_back: Readback::new(),
            records: Arc::new([]),
            planes: PlaneBuffers::new(&context),
            batch: BatchSize::new(context.is_software),
            context,
        })
    }

    /// What to say of it, and why it draws with this adapter.
    pub(in crate::device) fn info(&self, why: &str) -> DeviceInfo {
        let filter = match self.filter {
            Filter::Hardware => "hardware",
            Filter::Gathered | Filter::Exact => "exact",
        };
        let measured = match self.filter_error {
            Some(error) => format!("its texture unit interpolates to {error:.1e}"),
            None => "its texture unit does not interpolate 16-bit samples".into(),
        };
        DeviceInfo {
            adapter: self.context.name.clone(),
            reason: format!("{why}; {measured}"),
            filter: filter.into(),
            cache_bytes: u64::from(self.atlas.count()) * self.brick_bytes(),
        }
    }

    fn brick_bytes(&self) -> u64 {
        let deviations = if self.deviations.is_some() { BRICK_VOXELS as u64 } else { 0 };
        self.context.brick_bytes() + deviations
    }

    pub(in crate::device) fn slots(&self) -> u32 {
        self.atlas.count()
    }

    pub(in crate::device) fn views_at_once(&self, views: &[ProjectorRays<f32>]) -> usize {
        views_at_once(views.iter().map(|rays| rays.raster), self.context.is_software)
    }

    pub(in crate::device) fn write_brick(&mut self, slot: u32, samples: &[u16]) {
        let _turn = self.context.turn();
        self.atlas.write(&self.context, slot, samples);
    }

    pub(in crate::device) fn write_deviations(&mut self, slot: u32, codes: &[u8]) {
        let _turn = self.context.turn();
        if let Some(deviations) = &self.deviations {
            deviations.write_bytes(&self.context, slot, codes);
        }
    }

    pub(in crate::device) fn write_index(&mut self, nodes: &[NodeRecord], cells: &[u32]) {
        let _turn = self.context.turn();
        self.nodes.write(&self.context, nodes);
        self.cells.write(&self.context, cells);
        self.records = nodes.into();
        self.feedback.reserve(&self.context, (nodes.len() * size_of::<FeedbackEntry>()) as u64);
        self.frame_feedback.resize(&self.context, nodes.len());
    }

    pub(in crate::device) fn write_tables(&mut self, tables: Tables) {
        let _turn = self.context.turn();
        self.lookup = Lookup::of(&tables);
        self.optics.write(&self.context, &tables.optics);
        self.table_cells.write(&self.context, &tables.cells);
        self.importance.write_if_any(&self.context, &tables.importance);
        self.importance_most.write_if_any(&self.context, &tables.importance_most);
        self.index.write_if_any(&self.context, &tables.index);
        self.planes.variation.write(&self.context, &Plan::variation(&tables));
        self.materials.write_if_any(&self.context, &tables.materials);
    }

    pub(in crate::device) fn clear_feedback(&mut self) {
        self.frame_feedback.clear();
    }

    pub(in crate::device) fn end_feedback(&mut self, tag: FeedbackTag) {
        let context = Arc::clone(&self.context);
        let _turn = context.turn();
        self.frame_feedback.end(&context, tag);
    }

    pub(in crate::device) fn has_feedback_under_way(&self) -> bool {
        self.frame_feedback.is_under_way()
    }

    pub(in crate::device) fn take_feedback(&mut self) -> Result<Option<TaggedFeedback>, DeviceError> {
        // Another back-end of this process may have the turn, for long; what it waits for moves these tables along, too.
        if let Some(_turn) = self.context.turn_if_free() {
            self.context.poll()?;
        }
        self.frame_feedback.take(&self.context)
    }

    pub(in crate::device) fn wait_feedback(&mut self) -> Result<Option<TaggedFeedback>, DeviceError> {
        let context = Arc::clone(&self.context);
        let _turn = context.turn();
        context.wait()?;
        self.frame_feedback.take(&context)
    }

    pub(in crate::device) fn show(&mut self, jobs: &[ShowJob]) -> Result<Vec<bool>, DeviceError> {
        let _turn = self.context.turn();
        self.pictures.show(&self.context, jobs)
    }

    pub(in crate::device) fn pictures(
        &mut self,
        pictures: &[DevicePicture],
    ) -> Result<Vec<Cow<'_, [f32]>>, DeviceError> {
        let _turn = self.context.turn();
        let colours = self.pictures.read(&self.context, pictures)?;
        Ok(colours.into_iter().map(Cow::Owned).collect())
    }

    pub(in crate::device) fn codes(
        &mut self,
        jobs: &[FinishJob],
        at: CodesAt,
    ) -> Result<Vec<Codes>, DeviceError> {
        let _turn = self.context.turn();
        self.pictures.codes(&self.context, jobs, at)
    }

    pub(in crate::device) fn codes_of_host(&mut self, codes: Vec<u8>, raster: Raster, at: CodesAt) -> Codes {
        let _turn = self.context.turn();
        self.pictures.codes_of_host(&self.context, codes, raster, at)
    }

    pub(in crate::device) fn swapchains(&self) -> Swapchains {
        Swapchains::new(Arc::clone(&self.context))
    }
}

fn choose_filter(choice: FilterChoice, error: Option<f32>) -> Result<Filter, DeviceError> {
    match (choice, error) {
        (FilterChoice::Exact | FilterChoice::Auto, None) => Ok(Filter::Exact),
        (FilterChoice::Exact, Some(_)) => Ok(Filter::Gathered),
        (FilterChoice::Auto, Some(error)) => {
            Ok(if is_precise(error) { Filter::Hardware } else { Filter::Gathered })
        }
        (FilterChoice::Hardware, Some(_)) => Ok(Filter::Hardware),
        (FilterChoice::Hardware, None) => Err(DeviceError(
            "this adapter's texture unit does not interpolate 16-bit samples; take --filter exact".into(),
        )),
    }
}

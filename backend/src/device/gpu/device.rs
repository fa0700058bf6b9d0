//! A back-end's share of the GPU: its atlas, buffers and kernels.

use super::atlas::Atlas;
use super::context::{Context, context};
use super::kernels::Kernels;
use super::precision::{filter_error, is_precise};
use super::readback::Readback;
use crate::device::{CastJob, CastOutcome, DeviceError};
use crate::protocol::{DeviceInfo, FilterChoice};
use bytemuck::Pod;
use shaders::compose::{Filter, KernelKey, Way};
use shaders::layout::{FeedbackEntry, Link, NodeRecord, Params};
use shaders::optics::MOST_ENHANCERS;
use shaders::tables::Tables;
use shaders::twin::view::Dispatch;
use std::sync::Arc;

/// Set in the count of samples where a ray met a node that is too coarse; as in the kernel.
const MISSING: u32 = 0x8000_0000;
/// Workgroups along x of a dispatch: a tile each.
const GROUPS_ACROSS: u32 = 32768;

/// A device with its brick cache.
#[derive(Debug)]
pub struct GpuDevice {
    context: Arc<Context>,
    atlas: Atlas,
    sampler: wgpu::Sampler,
    filter: Filter,
    filter_error: Option<f32>,
    kernels: Kernels,
    params: wgpu::Buffer,
    links: wgpu::Buffer,
    nodes: Storage,
    cells: Storage,
    optics: Storage,
    importance: Storage,
    index: Storage,
    materials: Storage,
    occupied: Storage,
    tiles: Storage,
    pixels: Storage,
    counts: Storage,
    feedback: Storage,
    feedback_back: Readback,
    counts_back: Readback,
    pixels_back: Readback,
    raster: [u32; 2],
    /// Places of the index.
    places: usize,
}

/// A storage buffer that grows to what is put into it.
#[derive(Debug)]
struct Storage {
    buffer: wgpu::Buffer,
    label: &'static str,
    used_bytes: u64,
}

impl Storage {
    fn new(context: &Context, label: &'static str) -> Self {
        Self { buffer: Self::make(context, label, 64), label, used_bytes: 64 }
    }

    fn make(context: &Context, label: &str, size: u64) -> wgpu::Buffer {
        context.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some(label),
            size,
            usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        })
    }

    /// Makes room for `bytes`; what was there may be gone.
    fn reserve(&mut self, context: &Context, bytes: u64) {
        self.used_bytes = bytes.max(64).next_multiple_of(16);
        if self.buffer.size() < self.used_bytes {
            self.buffer = Self::make(context, self.label, self.used_bytes.next_power_of_two());
        }
    }

    fn write<T: Pod>(&mut self, context: &Context, items: &[T]) {
        let bytes: &[u8] = bytemuck::cast_slice(items);
        self.reserve(context, bytes.len() as u64);
        context.queue.write_buffer(&self.buffer, 0, bytes);
    }

    /// The same, where there is anything to write.
    fn write_if_any<T: Pod>(&mut self, context: &Context, items: &[T]) {
        if !items.is_empty() {
            self.write(context, items);
        }
    }

    fn binding(&self) -> wgpu::BindingResource<'_> {
        wgpu::BindingResource::Buffer(wgpu::BufferBinding {
            buffer: &self.buffer,
            offset: 0,
            size: std::num::NonZeroU64::new(self.used_bytes),
        })
    }
}

impl GpuDevice {
    /// Opens the process's adapter with a cache of about `slots` bricks.
    ///
    /// # Errors
    /// No adapter, or no memory.
    pub fn open(filter: FilterChoice, slots: u32) -> Result<Self, DeviceError> {
        let context = context()?;
        let turn = context.turn();
        let atlas = Atlas::new(&context, slots)?;
        let sampler = context.device.create_sampler(&wgpu::SamplerDescriptor {
            label: Some("trilinear"),
            mag_filter: wgpu::FilterMode::Linear,
            min_filter: wgpu::FilterMode::Linear,
            ..Default::default()
        });
        let filter_error =
            if context.has_filter { Some(filter_error(&context, &atlas, &sampler)?) } else { None };
        let filter = choose_filter(filter, filter_error)?;
        let storage = |label| Storage::new(&context, label);
        let params = uniform::<Params>(&context, "params");
        let links = uniform::<[Link; MOST_ENHANCERS]>(&context, "chain of enhancers");
        drop(turn);
        Ok(Self {
            atlas,
            sampler,
            filter,
            filter_error,
            kernels: Kernels::default(),
            params,
            links,
            nodes: storage("nodes"),
            cells: storage("visible cells"),
            occupied: storage("occupied table cells"),
            optics: storage("optics table"),
            importance: storage("importance table"),
            index: storage("refraction table"),
            materials: storage("material table"),
            tiles: storage("tiles"),
            pixels: storage("pixels"),
            counts: storage("sample counts"),
            feedback: storage("feedback"),
            feedback_back: Readback::new(),
            counts_back: Readback::new(),
            pixels_back: Readback::new(),
            raster: [0, 0],
            places: 0,
            context,
        })
    }

    /// What to say of it.
    pub fn info(&self) -> DeviceInfo {
        let filter = match self.filter {
            Filter::Hardware => "hardware",
            Filter::Exact => "exact",
        };
        let measured = match self.filter_error {
            Some(error) => format!("its texture unit interpolates to {error:.1e}"),
            None => "its texture unit does not interpolate 16-bit samples".into(),
        };
        DeviceInfo {
            adapter: self.context.name.clone(),
            reason: format!("a driver offers it; {measured}"),
            filter: filter.into(),
        }
    }

    pub(in crate::device) fn slots(&self) -> u32 {
        self.atlas.count()
    }

    pub(in crate::device) fn write_brick(&mut self, slot: u32, samples: &[u16]) {
        let _turn = self.context.turn();
        self.atlas.write(&self.context, slot, samples);
    }

    pub(in crate::device) fn write_index(&mut self, nodes: &[NodeRecord], cells: &[u32]) {
        let _turn = self.context.turn();
        self.nodes.write(&self.context, nodes);
        self.cells.write(&self.context, cells);
        self.places = nodes.len();
        self.feedback.reserve(&self.context, (self.places * size_of::<FeedbackEntry>()) as u64);
    }

    pub(in crate::device) fn write_tables(&mut self, tables: Tables) {
        let _turn = self.context.turn();
        self.optics.write(&self.context, &tables.optics);
        self.occupied.write(&self.context, &tables.occupied);
        self.importance.write_if_any(&self.context, &tables.importance);
        self.index.write_if_any(&self.context, &tables.index);
        self.materials.write_if_any(&self.context, &tables.materials);
    }

    pub(in crate::device) fn cast(&mut self, job: &CastJob) -> Result<CastOutcome, DeviceError> {
        let context = Arc::clone(&self.context);
        let _turn = context.turn();
        self.prepare(job);
        let key = KernelKey { filter: self.filter, needs: job.needs };
        let pipeline = self.kernels.get(&context, key).clone();
        let bind_group = self.bind(&pipeline, key);
        let mut encoder = context.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        encoder.clear_buffer(&self.feedback.buffer, 0, None);
        {
            let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
            pass.set_pipeline(&pipeline);
            pass.set_bind_group(0, &bind_group, &[]);
            let tiles = job.tiles.len() as u32;
            pass.dispatch_workgroups(tiles.min(GROUPS_ACROSS), tiles.div_ceil(GROUPS_ACROSS), 1);
        }
        self.feedback_back.copy(&context, &mut encoder, &self.feedback.buffer, self.feedback.used_bytes);
        let every_pixel = job.grid.stride == 1;
        let pixels = self.raster[0] as usize * self.raster[1] as usize;
        if every_pixel {
            self.counts_back.copy(&context, &mut encoder, &self.counts.buffer, 4 * pixels as u64);
        }
        context.run(encoder)?;
        let counts = if every_pixel { self.counts_back.read(&context, pixels)? } else { Vec::new() };
        let feedback = self.feedback_back.read(&context, self.places)?;
        Ok(sum_up(job, &counts, feedback))
    }

    pub(in crate::device) fn picture(&mut self) -> Result<Vec<f32>, DeviceError> {
        let context = Arc::clone(&self.context);
        let _turn = context.turn();
        let numbers = 4 * self.raster[0] as usize * self.raster[1] as usize;
        let mut encoder = context.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        self.pixels_back.copy(&context, &mut encoder, &self.pixels.buffer, 4 * numbers as u64);
        context.run(encoder)?;
        self.pixels_back.read(&context, numbers)
    }

    /// Uploads what is particular to one cast.
    fn prepare(&mut self, job: &CastJob) {
        let dispatch = Dispatch {
            atlas_slots: self.atlas.slots,
            stride: job.grid.stride,
            tiles_across: job.grid.across,
            tiles: job.tiles.len() as u32,
        };
        self.raster = job.view.raster;
        let pixels = u64::from(self.raster[0]) * u64::from(self.raster[1]);
        self.pixels.reserve(&self.context, 16 * pixels);
        self.counts.reserve(&self.context, 4 * pixels);
        self.tiles.write(&self.context, job.tiles);
        self.context.queue.write_buffer(&self.params, 0, bytemuck::bytes_of(&job.view.params(&dispatch)));
        if !job.needs.chain.is_empty() {
            self.context.queue.write_buffer(&self.links, 0, bytemuck::cast_slice(&job.view.links()));
        }
    }

    fn bind(&self, pipeline: &wgpu::ComputePipeline, key: KernelKey) -> wgpu::BindGroup {
        let buffers = [
            (1, &self.nodes),
            (2, &self.optics),
            (3, &self.tiles),
            (4, &self.pixels),
            (5, &self.counts),
            (6, &self.feedback),
            (10, &self.occupied),
            (11, &self.cells),
        ];
        let mut entries: Vec<wgpu::BindGroupEntry> = buffers
            .into_iter()
            .map(|(binding, storage)| wgpu::BindGroupEntry { binding, resource: storage.binding() })
            .collect();
        entries.push(wgpu::BindGroupEntry { binding: 0, resource: self.params.as_entire_binding() });
        let atlas = wgpu::BindingResource::TextureView(&self.atlas.view);
        entries.push(wgpu::BindGroupEntry { binding: 7, resource: atlas });
        if key.filter == Filter::Hardware {
            let sampler = wgpu::BindingResource::Sampler(&self.sampler);
            entries.push(wgpu::BindGroupEntry { binding: 8, resource: sampler });
        }
        if !key.needs.chain.is_empty() {
            entries.push(wgpu::BindGroupEntry { binding: 12, resource: self.links.as_entire_binding() });
        }
        let tables = [
            (9, &self.importance, key.needs.reads_importance()),
            (13, &self.index, key.needs.way == Way::Refracted),
            (14, &self.materials, key.needs.has_materials),
        ];
        for (binding, storage, _) in tables.into_iter().filter(|&(.., is_read)| is_read) {
            entries.push(wgpu::BindGroupEntry { binding, resource: storage.binding() });
        }
        self.context.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &pipeline.get_bind_group_layout(0),
            entries: &entries,
        })
    }
}

/// A uniform buffer for one T.
fn uniform<T>(context: &Context, label: &str) -> wgpu::Buffer {
    context.device.create_buffer(&wgpu::BufferDescriptor {
        label: Some(label),
        size: size_of::<T>() as u64,
        usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    })
}

fn choose_filter(choice: FilterChoice, error: Option<f32>) -> Result<Filter, DeviceError> {
    match (choice, error) {
        (FilterChoice::Exact, _) | (FilterChoice::Auto, None) => Ok(Filter::Exact),
        (FilterChoice::Auto, Some(error)) => {
            Ok(if is_precise(error) { Filter::Hardware } else { Filter::Exact })
        }
        (FilterChoice::Hardware, Some(_)) => Ok(Filter::Hardware),
        (FilterChoice::Hardware, None) => Err(DeviceError(
            "this adapter's texture unit does not interpolate 16-bit samples; take --filter exact".into(),
        )),
    }
}

/// Adds up the counts of the tiles cast.
fn sum_up(job: &CastJob, counts: &[u32], feedback: Vec<FeedbackEntry>) -> CastOutcome {
    let mut outcome = CastOutcome { feedback, ..Default::default() };
    let [width, height] = job.view.raster;
    for &tile in job.tiles {
        let mut is_missing = false;
        for (x, y) in job.grid.pixels(tile, width, height) {
            outcome.rays += 1;
            if let Some(count) = counts.get(y as usize * width as usize + x as usize) {
                outcome.samples += u64::from(count & !MISSING);
                is_missing |= count & MISSING != 0;
            }
        }
        if is_missing {
            outcome.missing_tiles.push(tile);
        }
    }
    outcome
}

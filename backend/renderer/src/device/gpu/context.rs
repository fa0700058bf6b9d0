//! An adapter and its queue, opened once for the whole process.

use super::adapters;
use super::kernels::{Kernel, Kernels};
use super::pipeline_cache::PipelineCache;
use crate::device::DeviceError;
use protocol::AdapterWish;
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, TryLockError};

/// What all GPU devices of a process share that draw with one adapter. Software Vulkan drivers have crashed with several at
/// work at once, so there is one context for an adapter, and work on it takes turns.
#[derive(Debug)]
pub(in crate::device) struct Context {
    pub(super) adapter: &'static wgpu::Adapter,
    pub(super) device: wgpu::Device,
    pub(super) queue: wgpu::Queue,
    pub(super) name: String,
    /// Whether the adapter is the processor.
    pub(super) is_software: bool,
    pub(super) atlas_format: wgpu::TextureFormat,
    /// Whether the texture unit can interpolate `atlas_format` at all.
    pub(super) has_filter: bool,
    /// What the driver compiled before; None if it does not hand it out, or the user does not want it kept.
    pub(super) pipelines: Option<PipelineCache>,
    kernels: Mutex<Kernels>,
    turn: Mutex<()>,
}

/// Storage buffers of the kernel that uses everything.
const MOST_STORAGE_BUFFERS: u32 = 13;
/// Bytes of a buffer of pictures, at most, where the device would bind more at a time.
const MOST_BOUND_BYTES: u64 = 1 << 30;

type Opened = Result<Arc<Context>, DeviceError>;

/// The process's contexts by the places of their adapters.
static CONTEXTS: Mutex<BTreeMap<usize, Opened>> = Mutex::new(BTreeMap::new());

/// The context of the adapter that a wish leads to, made on first use, and why it is that one.
pub(in crate::device) fn context(wish: &AdapterWish) -> Result<(Arc<Context>, String), DeviceError> {
    let chosen = adapters::choose(wish)?;
    let mut contexts = CONTEXTS.lock().unwrap_or_else(PoisonError::into_inner);
    let open = || pollster::block_on(Context::open(adapters::adapter(chosen.index))).map(Arc::new);
    let context = contexts.entry(chosen.index).or_insert_with(open).clone()?;
    Ok((context, chosen.why))
}

impl Context {
    async fn open(adapter: &'static wgpu::Adapter) -> Result<Self, DeviceError> {
        let info = adapter.get_info();
        let name = format!("gpu: {}, {:?}", info.name, info.backend);
        let features = adapter.features()
            & (wgpu::Features::TEXTURE_FORMAT_16BIT_NORM
                | wgpu::Features::FLOAT32_FILTERABLE
                | PipelineCache::FEATURES);
        let limits = adapter.limits();
        if limits.max_storage_buffers_per_shader_stage < MOST_STORAGE_BUFFERS {
            return Err(DeviceError(format!(
                "{name} binds {} storage buffers at a time, but kernels need up to {MOST_STORAGE_BUFFERS}; take --device cpu",
                limits.max_storage_buffers_per_shader_stage
            )));
        }
        let descriptor = wgpu::DeviceDescriptor {
            label: Some("lightloom"),
            required_features: features,
            required_limits: limits,
            ..Default::default()
        };
        let (device, queue) = adapter
            .request_device(&descriptor)
            .await
            .map_err(|error| DeviceError(format!("{name} cannot be opened: {error}")))?;
        let has_unorm16 = features.contains(wgpu::Features::TEXTURE_FORMAT_16BIT_NORM);
        let has_filter = has_unorm16 || features.contains(wgpu::Features::FLOAT32_FILTERABLE);
        let atlas_format =
            if has_unorm16 { wgpu::TextureFormat::R16Unorm } else { wgpu::TextureFormat::R32Float };
        let pipelines = PipelineCache::open(&device, &info);
        let is_software = info.device_type == wgpu::DeviceType::Cpu;
        Ok(Self {
            adapter,
            device,
            queue,
            name,
            is_software,
            atlas_format,
            has_filter,
            pipelines,
            kernels: Mutex::default(),
            turn: Mutex::new(()),
        })
    }

    /// Its adapter's name, where that is a driver in software.
    pub(in crate::device) fn software_name(&self) -> Option<&str> {
        self.is_software.then_some(&self.name)
    }

    /// Bytes of a brick in the atlas.
    pub(in crate::device) fn brick_bytes(&self) -> u64 {
        let sample = if self.atlas_format == wgpu::TextureFormat::R16Unorm { 2 } else { 4 };
        sample * bricks::BRICK_VOXELS as u64
    }

    /// Bytes of a buffer that a kernel may be given.
    pub(super) fn most_bound_bytes(&self) -> u64 {
        let limits = self.device.limits();
        MOST_BOUND_BYTES.min(limits.max_buffer_size).min(limits.max_storage_buffer_binding_size)
    }

    /// A kernel, compiled by whichever device first asks for it.
    pub(super) fn kernel(&self, kernel: Kernel) -> wgpu::ComputePipeline {
        let mut kernels = self.kernels.lock().unwrap_or_else(PoisonError::into_inner);
        kernels.get(&self.device, self.pipelines.as_ref(), kernel)
    }

    /// Waits for this thread's turn on the queue.
    pub(super) fn turn(&self) -> MutexGuard<'_, ()> {
        self.turn.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The same, where no other thread has it.
    pub(super) fn turn_if_free(&self) -> Option<MutexGuard<'_, ()>> {
        match self.turn.try_lock() {
            Ok(turn) => Some(turn),
            Err(TryLockError::Poisoned(turn)) => Some(turn.into_inner()),
            Err(TryLockError::WouldBlock) => None,
        }
    }

    /// A list of work for the device.
    pub(super) fn new_encoder(&self) -> wgpu::CommandEncoder {
        self.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default())
    }

    /// Hands work to the device, behind what it has.
    pub(super) fn submit(&self, encoder: wgpu::CommandEncoder) -> wgpu::SubmissionIndex {
        self.queue.submit([encoder.finish()])
    }

    /// Waits for what was submitted, and for all before it.
    pub(super) fn wait_for(&self, submission: wgpu::SubmissionIndex) -> Result<(), DeviceError> {
        self.after_poll(
            self.device.poll(wgpu::PollType::Wait { submission_index: Some(submission), timeout: None }),
        )
    }

    /// Looks whether the device has done anything; waits for nothing.
    pub(super) fn poll(&self) -> Result<(), DeviceError> {
        self.after_poll(self.device.poll(wgpu::PollType::Poll))
    }

    /// Waits for all that was submitted.
    pub(super) fn wait(&self) -> Result<(), DeviceError> {
        self.after_poll(self.device.poll(wgpu::PollType::wait_indefinitely()))
    }

    fn after_poll(&self, outcome: Result<wgpu::PollStatus, wgpu::PollError>) -> Result<(), DeviceError> {
        outcome.map(|_| ()).map_err(|error| DeviceError(format!("{} stopped answering: {error}", self.name)))
    }
}

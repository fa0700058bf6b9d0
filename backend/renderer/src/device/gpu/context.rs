//! The adapter and its queue, one for the whole process.

use super::pipeline_cache::PipelineCache;
use crate::device::DeviceError;
use std::sync::{Arc, Mutex, MutexGuard, OnceLock, TryLockError};

/// What all GPU devices of a process share. Software Vulkan drivers have crashed with several at work at once, so
/// there is one, and work on it takes turns.
#[derive(Debug)]
pub(super) struct Context {
    pub(super) device: wgpu::Device,
    pub(super) queue: wgpu::Queue,
    pub(super) name: String,
    /// Whether the adapter is the processor.
    is_software: bool,
    pub(super) atlas_format: wgpu::TextureFormat,
    /// Whether the texture unit can interpolate `atlas_format` at all.
    pub(super) has_filter: bool,
    /// What the driver compiled before; None if it does not hand it out, or the user does not want it kept.
    pub(super) pipelines: Option<PipelineCache>,
    turn: Mutex<()>,
}

/// Storage buffers of the kernel that uses everything.
const MOST_STORAGE_BUFFERS: u32 = 12;

static CONTEXT: OnceLock<Result<Arc<Context>, DeviceError>> = OnceLock::new();

/// The process's context, made on first use.
pub(super) fn context() -> Result<Arc<Context>, DeviceError> {
    CONTEXT.get_or_init(|| pollster::block_on(Context::open()).map(Arc::new)).clone()
}

/// The adapter that `--device gpu` would take.
///
/// # Errors
/// There is none, or it cannot be opened.
pub fn adapter_name() -> Result<String, DeviceError> {
    Ok(context()?.name.clone())
}

/// The name of the adapter that `--device gpu` would take, where that is a driver in software.
pub(in crate::device) fn software_adapter() -> Option<String> {
    context().ok().filter(|context| context.is_software).map(|context| context.name.clone())
}

/// Bytes of a brick in the cache of `--device gpu`.
pub(in crate::device) fn brick_bytes() -> Result<u64, DeviceError> {
    Ok(context()?.brick_bytes())
}

impl Context {
    async fn open() -> Result<Self, DeviceError> {
        let mut wanted = wgpu::InstanceDescriptor::new_without_display_handle();
        wanted.backends = wgpu::Backends::PRIMARY;
        let instance = wgpu::Instance::new(wanted);
        let options = wgpu::RequestAdapterOptions {
            power_preference: wgpu::PowerPreference::HighPerformance,
            ..Default::default()
        };
        let adapter = instance
            .request_adapter(&options)
            .await
            .map_err(|_| DeviceError("no Vulkan driver offers an adapter".into()))?;
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
            device,
            queue,
            name,
            is_software,
            atlas_format,
            has_filter,
            pipelines,
            turn: Mutex::new(()),
        })
    }

    /// Bytes of a brick in the atlas.
    pub(super) fn brick_bytes(&self) -> u64 {
        let sample = if self.atlas_format == wgpu::TextureFormat::R16Unorm { 2 } else { 4 };
        sample * bricks::BRICK_VOXELS as u64
    }

    /// Waits for this thread's turn on the queue.
    pub(super) fn turn(&self) -> MutexGuard<'_, ()> {
        self.turn.lock().unwrap_or_else(std::sync::PoisonError::into_inner)
    }

    /// The same, where no other thread has it.
    pub(super) fn turn_if_free(&self) -> Option<MutexGuard<'_, ()>> {
        match self.turn.try_lock() {
            Ok(turn) => Some(turn),
            Err(TryLockError::Poisoned(turn)) => Some(turn.into_inner()),
            Err(TryLockError::WouldBlock) => None,
        }
    }

    /// Hands work to the device, behind what it has.
    pub(super) fn submit(&self, encoder: wgpu::CommandEncoder) {
        self.queue.submit([encoder.finish()]);
    }

    /// Submits, and waits until it is done.
    pub(super) fn run(&self, encoder: wgpu::CommandEncoder) -> Result<(), DeviceError> {
        self.submit(encoder);
        self.wait()
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

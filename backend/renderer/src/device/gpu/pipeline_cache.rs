//! Kernels as the driver compiled them, kept for the next run.

use super::cache_file::{CacheFile, folder};
use std::sync::atomic::{AtomicU32, Ordering};

/// A driver's compiled kernels. It saves time and nothing else: a kernel from it is the kernel that would be compiled.
#[derive(Debug)]
pub(super) struct PipelineCache {
    cache: wgpu::PipelineCache,
    file: CacheFile,
    /// Checksum of what the file holds, as far as this process knows.
    kept: AtomicU32,
}

impl PipelineCache {
    /// What adapters must offer for it.
    pub(super) const FEATURES: wgpu::Features = wgpu::Features::PIPELINE_CACHE;

    /// The cache of an adapter, with what the last run left; None if driver or user will not have one.
    pub(super) fn open(device: &wgpu::Device, adapter: &wgpu::AdapterInfo) -> Option<Self> {
        if !device.features().contains(Self::FEATURES) {
            return None;
        }
        let name = wgpu::util::pipeline_cache_key(adapter)?;
        let wgpu::AdapterInfo { name: model, driver, driver_info, .. } = adapter;
        let owner = format!("{name}; {model}; {driver}; {driver_info}");
        let file = CacheFile::new(&folder(|name| std::env::var_os(name))?, &name, owner);
        let blob = file.read().inspect_err(|why| {
            tracing::debug!("no compiled kernels from {}: {why}", file.path().display());
        });
        let (cache, kept) = create(device, blob.ok())?;
        Some(Self { cache, file, kept: AtomicU32::new(kept) })
    }

    /// What pipelines are made with.
    pub(super) fn cache(&self) -> &wgpu::PipelineCache {
        &self.cache
    }

    /// Writes what the driver has compiled, where it is not what the file holds. A file that cannot be written costs the
    /// next run time, and is not an error.
    pub(super) fn keep(&self) {
        let Some(blob) = self.cache.get_data() else { return };
        let checksum = crc32fast::hash(&blob);
        if self.kept.swap(checksum, Ordering::Relaxed) == checksum {
            return;
        }
        let path = self.file.path().display();
        match self.file.write(&blob) {
            Ok(()) => tracing::debug!("{} bytes of compiled kernels kept in {path}", blob.len()),
            Err(why) => tracing::debug!("compiled kernels are not kept in {path}: {why}"),
        }
    }
}

/// A cache that begins with `blob` and its checksum, or empty with 0 if wgpu does not want the blob.
fn create(device: &wgpu::Device, blob: Option<Vec<u8>>) -> Option<(wgpu::PipelineCache, u32)> {
    let scope = device.push_error_scope(wgpu::ErrorFilter::Validation);
    let descriptor = wgpu::PipelineCacheDescriptor {
        label: Some("compiled kernels"),
        data: blob.as_deref(),
        fallback: true,
    };
    // SAFETY: the blob is what `get_data` returned: the file's checksum holds, and its owner is this adapter and driver.
    let cache = unsafe { device.create_pipeline_cache(&descriptor) };
    match (pollster::block_on(scope.pop()), blob) {
        (None, blob) => Some((cache, blob.map_or(0, |blob| crc32fast::hash(&blob)))),
        (Some(why), Some(_)) => {
            tracing::debug!("the compiled kernels of the last run are ignored: {why}");
            create(device, None)
        }
        (Some(why), None) => {
            tracing::debug!("this driver keeps no compiled kernels: {why}");
            None
        }
    }
}

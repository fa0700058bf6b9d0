//! Compiled kernels, each made when a device of the process first needs it.

use super::pipeline_cache::PipelineCache;
use shaders::compose::{KernelKey, PresentKernel, TALLY_ENTRY_POINT, tally_wgsl};
use std::borrow::Cow;
use std::collections::HashMap;

/// Samples between two texels of a ramp.
const FILTER_PRECISION: &str = "
@group(0) @binding(0) var atlas: texture_3d<f32>;
@group(0) @binding(1) var trilinear: sampler;
@group(0) @binding(2) var<storage, read_write> found: array<f32>;
@compute @workgroup_size(64)
fn probe(@builtin(global_invocation_id) id: vec3<u32>) {
    let size = vec3<f32>(textureDimensions(atlas));
    let x = 4.5 + (f32(id.x) + 0.5) / 1024.0;
    found[id.x] = textureSampleLevel(atlas, trilinear, vec3<f32>(x, 4.5, 4.5) / size, 0.0).x;
}";

/// What can be compiled.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Kernel {
    /// Casts rays.
    Cast(KernelKey),
    /// Adds up what the rays of each tile counted.
    Tally,
    /// Makes what is shown of what was cast.
    Present(PresentKernel),
    /// Measures the texture unit.
    FilterPrecision,
}

impl Kernel {
    fn wgsl(&self) -> Cow<'static, str> {
        match self {
            Self::Cast(key) => key.wgsl().into(),
            Self::Tally => tally_wgsl().into(),
            Self::Present(kernel) => kernel.wgsl().into(),
            Self::FilterPrecision => FILTER_PRECISION.into(),
        }
    }

    fn entry_point(&self) -> &'static str {
        match self {
            Self::Cast(key) => key.entry_point(),
            Self::Tally => TALLY_ENTRY_POINT,
            Self::Present(kernel) => kernel.entry_point(),
            Self::FilterPrecision => "probe",
        }
    }
}

/// The kernels compiled so far.
#[derive(Debug, Default)]
pub(super) struct Kernels {
    compiled: HashMap<Kernel, wgpu::ComputePipeline>,
}

impl Kernels {
    /// A kernel of `device`.
    pub(super) fn get(
        &mut self,
        device: &wgpu::Device,
        cache: Option<&PipelineCache>,
        kernel: Kernel,
    ) -> wgpu::ComputePipeline {
        self.compiled.entry(kernel).or_insert_with(|| compile(device, cache, kernel)).clone()
    }
}

/// Its bind group layout follows from what it reads.
fn compile(device: &wgpu::Device, cache: Option<&PipelineCache>, kernel: Kernel) -> wgpu::ComputePipeline {
    let label = format!("{kernel:?}");
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some(&label),
        source: wgpu::ShaderSource::Wgsl(kernel.wgsl()),
    });
    let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: Some(&label),
        layout: None,
        module: &module,
        entry_point: Some(kernel.entry_point()),
        compilation_options: wgpu::PipelineCompilationOptions::default(),
        cache: cache.map(PipelineCache::cache),
    });
    cache.inspect(|cache| cache.keep());
    pipeline
}

//! Compiled kernels, each made when a scene first needs it.

use super::context::Context;
use super::pipeline_cache::PipelineCache;
use shaders::compose::KernelKey;
use std::collections::HashMap;

/// The kernels compiled so far.
#[derive(Debug, Default)]
pub(super) struct Kernels {
    compiled: HashMap<KernelKey, wgpu::ComputePipeline>,
}

impl Kernels {
    /// The kernel for a need.
    pub(super) fn get(&mut self, context: &Context, key: KernelKey) -> &wgpu::ComputePipeline {
        self.compiled
            .entry(key)
            .or_insert_with(|| compile(context, &format!("{key:?}"), &key.wgsl(), "cast_tile"))
    }
}

/// Compiles one entry point; its bind group layout follows from what it reads.
pub(super) fn compile(
    context: &Context,
    label: &str,
    wgsl: &str,
    entry_point: &str,
) -> wgpu::ComputePipeline {
    let module = context.device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some(label),
        source: wgpu::ShaderSource::Wgsl(wgsl.into()),
    });
    let cache = context.pipelines.as_ref();
    let pipeline = context.device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: Some(label),
        layout: None,
        module: &module,
        entry_point: Some(entry_point),
        compilation_options: wgpu::PipelineCompilationOptions::default(),
        cache: cache.map(PipelineCache::cache),
    });
    cache.inspect(|cache| cache.keep());
    pipeline
}

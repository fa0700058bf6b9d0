//! The brick cache on the GPU: one 3-D texture of slots.

use super::context::Context;
use crate::device::DeviceError;
use crate::store::BRICK_EDGE;

/// Slots along x and along y: 16 × 32 texels = 512.
const SLOTS_ACROSS: u32 = 16;

/// The texture, and how its slots lie.
#[derive(Debug)]
pub(super) struct Atlas {
    texture: wgpu::Texture,
    pub(super) view: wgpu::TextureView,
    pub(super) slots: [u32; 3],
}

impl Atlas {
    /// Room for at least `slots` bricks, as far as a texture goes.
    pub(super) fn new(context: &Context, slots: u32) -> Result<Self, DeviceError> {
        let edge = BRICK_EDGE as u32;
        let deepest = context.device.limits().max_texture_dimension_3d / edge;
        let across = SLOTS_ACROSS.min(deepest);
        let deep = slots.div_ceil(across * across).min(deepest);
        let slots = [across, across, deep];
        let scope = context.device.push_error_scope(wgpu::ErrorFilter::OutOfMemory);
        let texture = context.device.create_texture(&wgpu::TextureDescriptor {
            label: Some("brick atlas"),
            size: wgpu::Extent3d {
                width: across * edge,
                height: across * edge,
                depth_or_array_layers: deep * edge,
            },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D3,
            format: context.atlas_format,
            usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
            view_formats: &[],
        });
        if let Some(error) = pollster::block_on(scope.pop()) {
            return Err(DeviceError(format!(
                "{} has no memory for a brick cache of {} slots ({error}); make the cache smaller",
                context.name,
                across * across * deep
            )));
        }
        let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
        Ok(Self { texture, view, slots })
    }

    /// Slots there are.
    pub(super) fn count(&self) -> u32 {
        self.slots.iter().product()
    }

    /// Puts samples (65535 = 1) into a slot.
    pub(super) fn write(&self, context: &Context, slot: u32, samples: &[u16]) {
        let [across, down, _] = self.slots;
        let edge = BRICK_EDGE as u32;
        let origin = wgpu::Origin3d {
            x: slot % across * edge,
            y: slot / across % down * edge,
            z: slot / (across * down) * edge,
        };
        let as_floats: Vec<f32>;
        let bytes: &[u8] = if self.texture.format() == wgpu::TextureFormat::R16Unorm {
            bytemuck::cast_slice(samples)
        } else {
            as_floats = samples.iter().map(|&sample| f32::from(sample) / 65535.0).collect();
            bytemuck::cast_slice(&as_floats)
        };
        let bytes_per_row = (bytes.len() / (BRICK_EDGE * BRICK_EDGE)) as u32;
        context.queue.write_texture(
            wgpu::TexelCopyTextureInfo {
                texture: &self.texture,
                mip_level: 0,
                origin,
                aspect: wgpu::TextureAspect::All,
            },
            bytes,
            wgpu::TexelCopyBufferLayout {
                offset: 0,
                bytes_per_row: Some(bytes_per_row),
                rows_per_image: Some(edge),
            },
            wgpu::Extent3d { width: edge, height: edge, depth_or_array_layers: edge },
        );
    }
}

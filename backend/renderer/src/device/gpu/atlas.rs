//! The brick cache on the GPU: a texture of slots.

use super::context::Context;
use crate::device::DeviceError;
use bricks::BRICK_EDGE;

/// Slots along x and along y, 2⁴ × 32 texels = 512, while there is room along z.
const SLOT_BITS_ACROSS: u32 = 4;

/// What kernels make of its third axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Depth {
    /// A third dimension, which the texture unit interpolates along.
    Dimension,
    /// Layers, of each of which it gathers four neighbours at once.
    Layers,
}

/// The texture, and how its slots lie.
#[derive(Debug)]
pub(super) struct Atlas {
    texture: wgpu::Texture,
    pub(super) view: wgpu::TextureView,
    pub(super) slots: [u32; 3],
}

impl Atlas {
    /// Room for `slots` bricks, a power of two, as far as a texture goes. Every edge is a power of two, so that texture
    /// coordinates of whole texels are exact.
    pub(super) fn new(
        context: &Context,
        slots: u32,
        format: wgpu::TextureFormat,
        depth: Depth,
    ) -> Result<Self, DeviceError> {
        assert!(slots.is_power_of_two(), "the caller rounds the number of slots");
        let edge = BRICK_EDGE as u32;
        let limits = context.device.limits();
        let most_texels = limits.max_texture_dimension_3d.min(limits.max_texture_array_layers);
        let most = (most_texels / edge).ilog2();
        let (dimension, view) = match depth {
            Depth::Dimension => (wgpu::TextureDimension::D3, wgpu::TextureViewDimension::D3),
            Depth::Layers => (wgpu::TextureDimension::D2, wgpu::TextureViewDimension::D2Array),
        };
        let slots = layout(slots.ilog2(), most).map(|bits| 1 << bits);
        let scope = context.device.push_error_scope(wgpu::ErrorFilter::OutOfMemory);
        let texture = context.device.create_texture(&wgpu::TextureDescriptor {
            label: Some("brick atlas"),
            size: wgpu::Extent3d {
                width: slots[0] * edge,
                height: slots[1] * edge,
                depth_or_array_layers: slots[2] * edge,
            },
            mip_level_count: 1,
            sample_count: 1,
            dimension,
            format,
            usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
            view_formats: &[],
        });
        if let Some(error) = pollster::block_on(scope.pop()) {
            return Err(DeviceError(format!(
                "{} has no memory for a brick cache of {} slots ({error}); make the cache smaller",
                context.name,
                slots.iter().product::<u32>()
            )));
        }
        let dimension = Some(view);
        let view = texture.create_view(&wgpu::TextureViewDescriptor { dimension, ..Default::default() });
        Ok(Self { texture, view, slots })
    }

    /// Slots there are.
    pub(super) fn count(&self) -> u32 {
        self.slots.iter().product()
    }

    /// Puts samples (65535 = 1) into a slot.
    pub(super) fn write(&self, context: &Context, slot: u32, samples: &[u16]) {
        let as_floats: Vec<f32>;
        let bytes: &[u8] = if self.texture.format() == wgpu::TextureFormat::R16Unorm {
            bytemuck::cast_slice(samples)
        } else {
            as_floats = samples.iter().map(|&sample| f32::from(sample) / 65535.0).collect();
            bytemuck::cast_slice(&as_floats)
        };
        self.write_bytes(context, slot, bytes);
    }

    /// Puts the bytes of 32³ texels into a slot.
    pub(super) fn write_bytes(&self, context: &Context, slot: u32, bytes: &[u8]) {
        let [across, down, _] = self.slots;
        let edge = BRICK_EDGE as u32;
        let origin = wgpu::Origin3d {
            x: slot % across * edge,
            y: slot / across % down * edge,
            z: slot / (across * down) * edge,
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

/// How 2ⁿ slots lie, as powers of two of at most 2^`most` along each axis: a slab of a fixed size, as thick as it must be,
/// and larger where that is not enough.
fn layout(n: u32, most: u32) -> [u32; 3] {
    let across = n.min(SLOT_BITS_ACROSS.min(most));
    let down = (n - across).min(SLOT_BITS_ACROSS.min(most));
    let deep = (n - across - down).min(most);
    let left = n - across - down - deep;
    let more_down = left.min(most - down);
    [across + (left - more_down).min(most - across), down + more_down, deep]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slots_lie_in_a_slab_that_grows_as_far_as_a_texture_goes() {
        let expected = [
            (0, [0, 0, 0]),
            (3, [3, 0, 0]),
            (7, [4, 3, 0]),
            (14, [4, 4, 6]),
            (15, [4, 5, 6]),
            (17, [5, 6, 6]),
            (18, [6, 6, 6]),
            (20, [6, 6, 6]),
        ];
        for (n, bits) in expected {
            assert_eq!(layout(n, 6), bits, "2^{n} slots");
        }
    }
}

//! How finely this adapter's texture unit interpolates: measured, not believed.

use super::atlas::{Atlas, Depth};
use super::context::Context;
use super::kernels::Kernel;
use super::pass::note_pass;
use super::readback::Readback;
use super::storage::Stretch;
use crate::device::DeviceError;
use bricks::{BRICK_EDGE, BRICK_VOXELS};

/// Points sampled between two texels, 0 and 1.
const POINTS: u32 = 1024;

/// An interpolation error below this share of the step between two voxels counts as precise. Units with 8-bit weights
/// are off by 2⁻⁹, f32 arithmetic by about 2⁻²²; beyond 2⁻¹⁴ even the steepest transfer function of 1/64 of the range
/// shows less than 1/255.
const PRECISE: f32 = 1.0 / 16384.0;

/// The largest error of the texture unit between a texel of 0 and a texel of 1.
pub(super) fn filter_error(context: &Context, sampler: &wgpu::Sampler) -> Result<f32, DeviceError> {
    let atlas = Atlas::new(context, 1, context.atlas_format, Depth::Dimension)?;
    let ramp: Vec<u16> = (0..BRICK_VOXELS).map(|i| if i % BRICK_EDGE > 4 { 65535 } else { 0 }).collect();
    atlas.write(context, 0, &ramp);
    let pipeline = context.kernel(Kernel::FilterPrecision);
    let found = context.device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("filter precision"),
        size: u64::from(POINTS) * 4,
        usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC,
        mapped_at_creation: false,
    });
    let entries = [
        wgpu::BindGroupEntry { binding: 0, resource: wgpu::BindingResource::TextureView(&atlas.view) },
        wgpu::BindGroupEntry { binding: 1, resource: wgpu::BindingResource::Sampler(sampler) },
        wgpu::BindGroupEntry { binding: 2, resource: found.as_entire_binding() },
    ];
    let mut encoder = context.new_encoder();
    note_pass(&context.device, &mut encoder, &pipeline, &entries, [POINTS / 64, 1, 1]);
    let mut readback = Readback::new();
    readback.begin(context, found.size());
    readback.copy(&mut encoder, &Stretch { buffer: &found, offset: 0, bytes: found.size() });
    context.submit(encoder);
    let samples: Vec<f32> = readback.items(context)?;
    let error = |(i, sample): (usize, &f32)| (sample - (i as f32 + 0.5) / POINTS as f32).abs();
    Ok(samples.iter().enumerate().map(error).fold(0.0, f32::max))
}

/// Whether an error counts as precise.
pub(super) fn is_precise(error: f32) -> bool {
    error < PRECISE
}

//! Codes of pictures that stay on the device until nobody needs them any more.

use super::context::Context;
use super::storage::Stretch;
use crate::present::Raster;
use layout::present::CODED_PIXELS;
use std::sync::Arc;

/// The codes of a picture.
#[derive(Clone, Debug)]
pub(super) struct KeptCodes {
    buffer: Arc<wgpu::Buffer>,
    offset: u64,
    pub(super) raster: Raster,
}

impl KeptCodes {
    /// Where they lie.
    pub(super) fn stretch(&self) -> Stretch<'_> {
        Stretch { buffer: &self.buffer, offset: self.offset, bytes: code_bytes(self.raster) }
    }
}

/// Buffers of codes, each used again once nobody keeps any of it.
#[derive(Debug, Default)]
pub(super) struct CodeBuffers {
    buffers: Vec<Arc<wgpu::Buffer>>,
}

impl CodeBuffers {
    /// Room for the codes of some pictures, beside each other in their order.
    pub(super) fn room(
        &mut self,
        context: &Context,
        rasters: impl Iterator<Item = Raster>,
    ) -> Vec<KeptCodes> {
        let mut bytes = 0;
        let begins: Vec<(u64, Raster)> = rasters
            .map(|raster| {
                let offset = bytes;
                bytes += code_room(raster);
                (offset, raster)
            })
            .collect();
        let buffer = self.buffer(context, bytes);
        begins
            .into_iter()
            .map(|(offset, raster)| KeptCodes { buffer: Arc::clone(&buffer), offset, raster })
            .collect()
    }

    /// One that nobody uses; those that nobody uses and that are too small are given up.
    fn buffer(&mut self, context: &Context, bytes: u64) -> Arc<wgpu::Buffer> {
        self.buffers.retain(|buffer| Arc::strong_count(buffer) > 1 || buffer.size() >= bytes);
        let unused = self.buffers.iter().find(|buffer| Arc::strong_count(buffer) == 1);
        if let Some(unused) = unused {
            return Arc::clone(unused);
        }
        let made = Arc::new(context.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("codes"),
            size: bytes,
            usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        }));
        self.buffers.push(Arc::clone(&made));
        made
    }
}

/// Bytes of a row of codes on the device.
pub(super) fn row_bytes(raster: Raster) -> usize {
    3 * raster.width.next_multiple_of(CODED_PIXELS as usize)
}

/// Bytes of a picture's codes on the device.
fn code_bytes(raster: Raster) -> u64 {
    (row_bytes(raster) * raster.height) as u64
}

/// The same, until the next picture's may begin: at whole multiples of as many bytes as parts of buffers that are bound have to.
pub(super) fn code_room(raster: Raster) -> u64 {
    code_bytes(raster).next_multiple_of(256)
}

/// Red, green and blue of each pixel, from codes as the device has them.
pub(super) fn unpacked(bytes: &[u8], raster: Raster) -> Vec<u8> {
    let (row, width) = (row_bytes(raster), 3 * raster.width);
    if row == width {
        bytes.to_vec()
    } else {
        bytes.chunks(row).flat_map(|row| &row[..width]).copied().collect()
    }
}

/// Codes as the device has them, from those of each pixel.
pub(super) fn packed(codes: Vec<u8>, raster: Raster) -> Vec<u8> {
    let (row, width) = (row_bytes(raster), 3 * raster.width);
    if row == width {
        return codes;
    }
    let mut packed = vec![0; row * raster.height];
    for (packed, codes) in packed.chunks_mut(row).zip(codes.chunks(width)) {
        packed[..width].copy_from_slice(codes);
    }
    packed
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_are_whole_words_on_the_device() {
        for width in 1..9 {
            let raster = Raster { width, height: 3 };
            let codes: Vec<u8> = (0..).take(3 * width * 3).collect();
            let packed = packed(codes.clone(), raster);
            assert_eq!((packed.len() as u64, packed.len() % 12), (code_bytes(raster), 0));
            assert_eq!(unpacked(&packed, raster), codes);
        }
    }
}

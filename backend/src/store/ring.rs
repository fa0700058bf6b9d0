//! One number per voxel of the last slabs of a level: enough for a layer of bricks, the rest is forgotten.

use super::{BRICK_EDGE, StoreError};
use glam::UVec3;
use memmap2::MmapMut;
use std::fs::File;
use std::io::Write;
use std::path::Path;

/// Zeros written at once to a working file.
static ZEROS: [u8; 1 << 16] = [0; 1 << 16];

/// Where numbers are kept: in memory, or in a nameless file that the system pages in and out.
enum Memory {
    Heap(Vec<f32>),
    Mapped(MmapMut),
}

/// The last [`BRICK_EDGE`] slabs, or as many as the level has. Memory that is never written takes no room.
pub(super) struct Ring {
    width: usize,
    slab_voxels: usize,
    kept: u32,
    memory: Memory,
}

impl Ring {
    /// Bytes that a ring of a level takes at most.
    pub fn bytes(dims: UVec3) -> u64 {
        u64::from(dims.x) * u64::from(dims.y) * u64::from(kept(dims)) * size_of::<f32>() as u64
    }

    /// A ring in memory.
    pub fn in_memory(dims: UVec3) -> Self {
        Self::of(dims, Memory::Heap(vec![0.0; Self::bytes(dims) as usize / size_of::<f32>()]))
    }

    /// A ring in a mapped file whose every byte is on the disk already: a disk that fills up is an error here, and would
    /// be a crash at a page written later.
    pub fn in_file(dims: UVec3, folder: &Path) -> Result<Self, StoreError> {
        let file = tempfile::tempfile_in(folder).map_err(StoreError::write(folder))?;
        reserve(&file, Self::bytes(dims)).map_err(StoreError::write(folder))?;
        // SAFETY: the file has no name, so no other process can change or cut it.
        let map = unsafe { MmapMut::map_mut(&file) }.map_err(StoreError::write(folder))?;
        Ok(Self::of(dims, Memory::Mapped(map)))
    }

    fn of(dims: UVec3, memory: Memory) -> Self {
        let (width, height) = (dims.x as usize, dims.y as usize);
        Self { width, slab_voxels: width * height, kept: kept(dims), memory }
    }

    fn values(&self) -> &[f32] {
        match &self.memory {
            Memory::Heap(values) => values,
            Memory::Mapped(map) => bytemuck::cast_slice(map),
        }
    }

    /// The place of slab `z` in the ring.
    pub fn place(&self, z: u32) -> usize {
        (z % self.kept) as usize
    }

    /// Row `y` of a slab among the last ones written.
    pub fn row(&self, z: u32, y: usize) -> &[f32] {
        &self.values()[self.place(z) * self.slab_voxels + y * self.width..][..self.width]
    }

    /// The room of a slab; it takes that of the slab [`BRICK_EDGE`] before.
    pub fn slab_mut(&mut self, z: u32) -> &mut [f32] {
        let range = self.place(z) * self.slab_voxels..(self.place(z) + 1) * self.slab_voxels;
        let values = match &mut self.memory {
            Memory::Heap(values) => values.as_mut_slice(),
            Memory::Mapped(map) => bytemuck::cast_slice_mut(map),
        };
        &mut values[range]
    }
}

/// Slabs that are kept of a level.
pub(super) fn kept(dims: UVec3) -> u32 {
    dims.z.min(BRICK_EDGE as u32)
}

/// Gives a new file room on the disk.
fn reserve(mut file: &File, bytes: u64) -> std::io::Result<()> {
    #[cfg(target_os = "linux")]
    if rustix::fs::fallocate(file, rustix::fs::FallocateFlags::empty(), 0, bytes).is_ok() {
        return Ok(());
    }
    // A file system that cannot set room aside gets zeros; a full disk says so at one of them.
    let mut left = bytes;
    while left > 0 {
        let part = left.min(ZEROS.len() as u64);
        file.write_all(&ZEROS[..part as usize])?;
        left -= part;
    }
    Ok(())
}

//! One number per voxel of the last slabs of a level: enough for a layer of bricks; earlier slabs are dropped.

use super::StoreError;
use crate::{BRICK_EDGE, OWN_EDGE};
use glam::UVec3;
use memmap2::MmapMut;
use std::fs::File;
use std::io::Write;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

/// Edge of a tile of a slab: the own voxels of a brick.
pub(super) const TILE: usize = OWN_EDGE;

/// Zeros written at once to a working file.
static ZEROS: [u8; 1 << 16] = [0; 1 << 16];

/// Memory that the rings of a build may still take.
#[derive(Debug)]
pub(super) struct Budget(AtomicU64);

impl Budget {
    pub fn new(bytes: u64) -> Arc<Self> {
        Arc::new(Self(AtomicU64::new(bytes)))
    }

    /// Takes so many bytes if they are left; returns whether they were.
    fn take(&self, bytes: u64) -> bool {
        self.0.fetch_update(Ordering::Relaxed, Ordering::Relaxed, |left| left.checked_sub(bytes)).is_ok()
    }

    fn give(&self, bytes: u64) {
        self.0.fetch_add(bytes, Ordering::Relaxed);
    }
}

/// Where the numbers of a tile of a slab are.
enum Tile {
    /// Nowhere: they all have one value.
    Empty,
    Memory(Box<[f32]>),
    /// In the working file, at the tile's own place.
    Mapped,
}

/// The last [`BRICK_EDGE`] slabs, or as many as the level has, kept tile by tile: a brick is gathered from nine tiles of
/// every slab, and rows of a whole slab would each lie in another page. A tile that is not written takes no memory; one
/// for which the budget has none left is kept in a nameless file, which the system pages in and out.
pub(super) struct Ring {
    width: usize,
    height: usize,
    kept: u32,
    /// Of every kept slab, x fastest.
    tiles: Vec<Tile>,
    budget: Arc<Budget>,
    spill: Option<MmapMut>,
}

impl Ring {
    /// Bytes that the description of a tile takes.
    pub const TILE_BYTES: u64 = size_of::<Tile>() as u64;

    /// Bytes that a ring of a level takes at most.
    pub fn bytes(dims: UVec3) -> u64 {
        u64::from(dims.x) * u64::from(dims.y) * u64::from(kept(dims)) * size_of::<f32>() as u64
    }

    /// A ring of a level; with `spill`, the folder for its working file, it may outgrow the budget.
    ///
    /// # Errors
    /// The folder's disk has no room for the file. All of its bytes are reserved now: a full disk would crash the process
    /// when a page is written later.
    pub fn new(dims: UVec3, budget: &Arc<Budget>, spill: Option<&Path>) -> Result<Self, StoreError> {
        let (width, height) = (dims.x as usize, dims.y as usize);
        let count = width.div_ceil(TILE) * height.div_ceil(TILE) * kept(dims) as usize;
        let spill = spill.map(|folder| spill_file(folder, Self::bytes(dims))).transpose()?;
        let tiles = std::iter::repeat_with(|| Tile::Empty).take(count).collect();
        Ok(Self { width, height, kept: kept(dims), tiles, budget: Arc::clone(budget), spill })
    }

    /// Tiles along x and y.
    fn across(&self) -> [usize; 2] {
        [self.width, self.height].map(|edge| edge.div_ceil(TILE))
    }

    /// The place of slab `z` in the ring.
    pub fn place(&self, z: u32) -> usize {
        (z % self.kept) as usize
    }

    /// A tile of a slab among the last ones written, row by row; it must not be one that is known by its value.
    pub fn tile(&self, z: u32, x: usize, y: usize) -> &[f32] {
        let [across, down] = self.across();
        let place = self.place(z);
        match &self.tiles[(place * down + y) * across + x] {
            Tile::Memory(values) => values,
            Tile::Mapped => {
                let map = self.spill.as_ref().expect("tiles are mapped only where there is a file");
                let rows = TILE.min(self.height - y * TILE);
                let start = place * self.width * self.height + y * TILE * self.width + x * TILE * rows;
                &bytemuck::cast_slice(map)[start..start + rows * TILE.min(self.width - x * TILE)]
            }
            Tile::Empty => panic!("read a tile that has no numbers of its own"),
        }
    }

    /// The room of a slab, row of tiles by row of tiles; it takes that of the slab [`BRICK_EDGE`] before.
    pub fn slab_mut(&mut self, z: u32) -> Vec<TileRow<'_>> {
        let ([across, down], place) = (self.across(), self.place(z));
        let slab_voxels = self.width * self.height;
        let spill: &mut [f32] = match &mut self.spill {
            Some(map) => &mut bytemuck::cast_slice_mut(map)[place * slab_voxels..(place + 1) * slab_voxels],
            None => &mut [],
        };
        let mut spills: Vec<&mut [f32]> = spill.chunks_mut(TILE * self.width).collect();
        spills.resize_with(down, Default::default);
        let tiles = self.tiles[place * down * across..(place + 1) * down * across].chunks_mut(across);
        let (width, height, budget) = (self.width, self.height, &*self.budget);
        let row = |(y, (tiles, spill))| {
            let rows = TILE.min(height - y * TILE);
            TileRow { rows, width, tiles, spill, budget }
        };
        tiles.zip(spills).enumerate().map(row).collect()
    }
}

/// The room of a row of tiles of a slab.
pub(super) struct TileRow<'a> {
    /// Rows of voxels.
    pub rows: usize,
    width: usize,
    tiles: &'a mut [Tile],
    spill: &'a mut [f32],
    budget: &'a Budget,
}

impl TileRow<'_> {
    fn bytes(&self, tile: usize) -> u64 {
        (self.rows * TILE.min(self.width - tile * TILE) * size_of::<f32>()) as u64
    }

    /// The numbers of a tile, to be written: row by row.
    pub fn room(&mut self, tile: usize) -> &mut [f32] {
        let bytes = self.bytes(tile);
        let values = bytes as usize / size_of::<f32>();
        let place = &mut self.tiles[tile];
        if matches!(place, Tile::Empty) {
            let has_memory = self.budget.take(bytes);
            *place = if has_memory { Tile::Memory(vec![0.0; values].into()) } else { Tile::Mapped };
        }
        match place {
            Tile::Memory(values) => values,
            Tile::Mapped | Tile::Empty => {
                let start = tile * TILE * self.rows;
                &mut self.spill[start..start + values]
            }
        }
    }

    /// Drops a tile: it has one value.
    pub fn clear(&mut self, tile: usize) {
        if let Tile::Memory(_) = self.tiles[tile] {
            self.budget.give(self.bytes(tile));
        }
        self.tiles[tile] = Tile::Empty;
    }
}

/// Slabs that are kept of a level.
pub(super) fn kept(dims: UVec3) -> u32 {
    dims.z.min(BRICK_EDGE as u32)
}

fn spill_file(folder: &Path, bytes: u64) -> Result<MmapMut, StoreError> {
    let file = tempfile::tempfile_in(folder).map_err(StoreError::write(folder))?;
    reserve(&file, bytes).map_err(StoreError::write(folder))?;
    // SAFETY: the file has no name, so no other process can change or cut it.
    unsafe { MmapMut::map_mut(&file) }.map_err(StoreError::write(folder))
}

/// Reserves room on the disk for a new file.
fn reserve(mut file: &File, bytes: u64) -> std::io::Result<()> {
    #[cfg(target_os = "linux")]
    {
        use rustix::{fs::FallocateFlags, io::Errno};
        match rustix::fs::fallocate(file, FallocateFlags::empty(), 0, bytes) {
            Ok(()) => return Ok(()),
            Err(Errno::OPNOTSUPP | Errno::NOSYS | Errno::INVAL) => {}
            Err(error) => return Err(error.into()),
        }
    }
    // A file system that cannot reserve room gets zeros; a full disk then fails on one of them.
    let mut left = bytes;
    while left > 0 {
        let part = left.min(ZEROS.len() as u64);
        file.write_all(&ZEROS[..part as usize])?;
        left -= part;
    }
    Ok(())
}

//! A store in a file, mapped into memory: any brick reads alone.

use super::format::{ENTRY_BYTES, Entry, Header, HeaderError};
use super::node_table::NodeTable;
use super::{BRICK_VOXELS, Brick, BrickError, BrickSource, CodeBits, Codec, Codes};
use super::{LevelError, NodeKey, NodeSummary, OctreeShape, StoreError};
use crate::volume::{MAX_EDGE_VOXELS, VolumeFrame};
use memmap2::Mmap;
use std::fs::File;
use std::path::{Path, PathBuf};

/// An open store. What its header and table say is checked against the file's length when it is opened; the file must
/// not be cut short while it is open, as with any mapped file.
pub struct Store {
    path: PathBuf,
    header: Header,
    shape: OctreeShape,
    table: NodeTable,
    map: Mmap,
}

impl std::fmt::Debug for Store {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Store")
            .field("path", &self.path)
            .field("header", &self.header)
            .finish_non_exhaustive()
    }
}

impl Store {
    /// Opens a store and checks all of it but the bricks' contents.
    ///
    /// # Errors
    /// A missing file, a file that is no store or of another version, numbers that do not fit the file.
    pub fn open(path: &Path) -> Result<Self, StoreError> {
        let file = File::open(path).map_err(StoreError::open(path))?;
        let length = file.metadata().map_err(StoreError::open(path))?.len();
        if length == 0 {
            return Err(StoreError::NotAStore { path: path.into() });
        }
        // SAFETY: stores are written under another name and renamed, never changed in place.
        let map = unsafe { Mmap::map(&file) }.map_err(StoreError::open(path))?;
        let header = Header::from_bytes(&map).map_err(|error| match error {
            HeaderError::NotAStore => StoreError::NotAStore { path: path.into() },
            HeaderError::Version(found) => StoreError::Version { path: path.into(), found },
            HeaderError::Damaged(what) => StoreError::damaged(path, what),
        })?;
        check_header(&header).map_err(|what| StoreError::damaged(path, what))?;
        let shape = OctreeShape::new(header.dims);
        let table = check_table(&header, shape, length).map_err(|what| StoreError::damaged(path, what))?;
        let store = Self { path: path.into(), header, shape, table, map };
        store.check_entries()?;
        Ok(store)
    }

    /// The name of the volume it was built from.
    pub fn source_name(&self) -> &str {
        &self.header.source_name
    }

    /// Version of the file's format.
    pub fn version(&self) -> u32 {
        super::format::VERSION
    }

    /// Bytes of the file.
    pub fn file_bytes(&self) -> u64 {
        self.map.len() as u64
    }

    /// Bricks that take bytes.
    pub fn stored_bricks(&self) -> u64 {
        todo!()
    }

    /// Errors of the levels against the source, the finest first; empty where an older program built the store.
    pub fn level_errors(&self) -> &[LevelError] {
        &[]
    }

    /// Whether coarse levels keep standard deviations.
    pub fn has_deviation(&self) -> bool {
        false
    }

    /// Bits per code.
    pub fn bits(&self) -> CodeBits {
        self.header.bits
    }

    /// Compression of the bricks.
    pub fn codec(&self) -> Codec {
        self.header.codec
    }

    /// Bytes that a node's brick takes in the file: what reading it costs; 0 where all samples are equal.
    pub fn stored_bytes(&self, node: NodeKey) -> u32 {
        self.entry(self.table.place(node)).length
    }

    fn entry(&self, place: u64) -> Entry {
        let at = self.header.table_offset() as usize + place as usize * ENTRY_BYTES;
        let bytes = self.map[at..].first_chunk().expect("the table's length was checked against the file's");
        Entry::from_bytes(bytes)
    }

    /// Checks every entry, so that no later read can leave the file.
    fn check_entries(&self) -> Result<(), StoreError> {
        let bricks = self.header.table_offset() + self.table.nodes() * ENTRY_BYTES as u64;
        let file = self.map.len() as u64;
        for place in 0..self.table.nodes() {
            let entry = self.entry(place);
            let wrong = |what: &str| Err(StoreError::damaged(&self.path, format!("{what} of brick {place}")));
            let numbers = [entry.min, entry.max, entry.low, entry.step];
            if numbers.iter().any(|number| !number.is_finite()) || entry.min > entry.max || entry.step < 0.0 {
                return wrong("bounds, low or step are no numbers that make sense,");
            }
            let length = u64::from(entry.length);
            if length == 0 {
                continue;
            }
            if entry.offset < bricks || entry.offset.checked_add(length).is_none_or(|end| end > file) {
                return wrong("the offset and length lie outside the file,");
            }
            let full = self.header.bits.brick_bytes() as u64;
            if length > full || (self.header.codec == Codec::None && length != full) {
                return wrong("the length does not fit the codec,");
            }
        }
        Ok(())
    }
}

impl BrickSource for Store {
    fn shape(&self) -> OctreeShape {
        self.shape
    }

    fn frame(&self) -> VolumeFrame {
        VolumeFrame::of_voxels(self.header.voxel_size_m)
    }

    fn value_range(&self) -> (f64, f64) {
        self.header.value_range
    }

    fn summary(&self, node: NodeKey) -> NodeSummary {
        let entry = self.entry(self.table.place(node));
        NodeSummary { min: entry.min, max: entry.max }
    }

    fn brick(&self, node: NodeKey) -> Result<Brick, BrickError> {
        let path = self.path.display();
        if !self.shape.contains(node) {
            return Err(BrickError(format!("{path} has no brick {node:?}: it lies outside the volume")));
        }
        let place = self.table.place(node);
        let entry = self.entry(place);
        if entry.length == 0 {
            return Ok(Brick { codes: zeros(self.header.bits), low: entry.low, step: 0.0 });
        }
        let start = entry.offset as usize;
        let bytes = &self.map[start..start + entry.length as usize];
        let codes = self.header.codec.unpack(bytes, self.header.bits).map_err(|what| {
            BrickError(format!(
                "brick {place} of {path} is damaged: {what}; copy the store again or import the volume again"
            ))
        })?;
        Ok(Brick { codes, low: entry.low, step: entry.step })
    }
}

fn zeros(bits: CodeBits) -> Codes {
    match bits {
        CodeBits::Eight => Codes::U8(vec![0; BRICK_VOXELS]),
        CodeBits::Sixteen => Codes::U16(vec![0; BRICK_VOXELS]),
    }
}

fn check_header(header: &Header) -> Result<(), String> {
    let (dims, size, range) = (header.dims, header.voxel_size_m, header.value_range);
    if dims.min_element() == 0 || dims.max_element() > MAX_EDGE_VOXELS {
        return Err(format!("the dimensions are {dims}, and each must be from 1 to {MAX_EDGE_VOXELS}"));
    }
    if !size.is_finite() || size.min_element() <= 0.0 {
        return Err(format!("the voxel size is {size} m, and each edge must be positive"));
    }
    if !range.0.is_finite() || !range.1.is_finite() || range.0 > range.1 {
        return Err(format!("the values are said to range from {} to {}", range.0, range.1));
    }
    Ok(())
}

fn check_table(header: &Header, shape: OctreeShape, file_length: u64) -> Result<NodeTable, String> {
    let table = NodeTable::new(shape).filter(|table| table.nodes() == header.nodes);
    let table =
        table.ok_or_else(|| format!("{} nodes do not belong to {} voxels", header.nodes, header.dims))?;
    let end = table
        .nodes()
        .checked_mul(ENTRY_BYTES as u64)
        .and_then(|bytes| bytes.checked_add(header.table_offset()));
    match end {
        Some(end) if end <= file_length => Ok(table),
        _ => {
            Err(format!("it has {file_length} bytes, and the table of {} nodes does not fit", table.nodes()))
        }
    }
}

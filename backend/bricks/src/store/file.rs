//! A store in a file: any brick can be read alone, and many processes can read at once.

use super::bytes::checksum;
use super::entry::{Checksums, Entry, Extent};
use super::format::{Header, HeaderError, LONGEST_HEADER, version};
use super::read_at::ReadAt;
use super::table::{EntryRules, Fault, Found, Table};
use super::{CodeBits, Codec};
use super::{LevelError, StoreError, format, format_v1};
use crate::volume::{MAX_EDGE_VOXELS, Modality, VolumeFrame, open_file};
use crate::{BRICK_VOXELS, Brick, BrickError, BrickSource, CellRanges, Codes, Deviation};
use crate::{NodeKey, NodeSummary, OctreeShape};
use std::path::{Path, PathBuf};

/// An open store. Opening reads only the header, whatever the size; tables and bricks are checked as they are read, and
/// damage affects only the entry or brick it lies in.
pub struct Store {
    path: PathBuf,
    version: u32,
    file_bytes: u64,
    shape: OctreeShape,
    pub(super) header: Header,
    pub(super) table: Table,
    pub(super) rules: EntryRules,
    pub(super) file: Box<dyn ReadAt>,
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
    /// Opens a store.
    ///
    /// # Errors
    /// A missing file, a file that is not a store or of another version, a damaged header.
    pub fn open(path: &Path) -> Result<Self, StoreError> {
        let file = open_file(path).map_err(StoreError::open(path))?;
        let length = file.metadata().map_err(StoreError::open(path))?.len();
        Self::of(path, Box::new(file), length)
    }

    /// The store that these bytes are; `path` is what errors call it.
    ///
    /// # Errors
    /// Those of [`Store::open`].
    pub fn from_bytes(path: &Path, bytes: Vec<u8>) -> Result<Self, StoreError> {
        let length = bytes.len() as u64;
        Self::of(path, Box::new(bytes), length)
    }

    fn of(path: &Path, file: Box<dyn ReadAt>, file_bytes: u64) -> Result<Self, StoreError> {
        let mut start = vec![0; file_bytes.min(LONGEST_HEADER as u64) as usize];
        file.read_at(0, &mut start).map_err(StoreError::open(path))?;
        let damaged = |what: String| StoreError::damaged(path, what);
        let (version, header) = read_header(&start).map_err(|error| match error {
            HeaderError::NotAStore => StoreError::NotAStore { path: path.into() },
            HeaderError::Version(found) => StoreError::Version { path: path.into(), found },
            HeaderError::Damaged(what) => damaged(what),
        })?;
        check_header(&header).map_err(damaged)?;
        let shape = OctreeShape::new(header.dims);
        let table = match version {
            format_v1::VERSION => Table::dense(&header, shape, file_bytes),
            _ => Table::tree(&header, shape, file_bytes),
        };
        let table = table.map_err(damaged)?;
        let bricks = match table {
            Table::Dense { .. } => {
                (header.table_offset + table.count() * format_v1::ENTRY_BYTES as u64, file_bytes)
            }
            Table::Tree { .. } => (header.length(), header.table_offset),
        };
        let rules = EntryRules {
            shape,
            largest_code: header.bits.largest(),
            bricks,
            codes: header.bits.brick_bytes() as u64,
            cells: CellRanges::byte_count(header.bits) as u64,
            deviation: if header.has_deviation { BRICK_VOXELS as u64 } else { 0 },
            codec: header.codec,
        };
        Ok(Self { path: path.into(), version, file_bytes, shape, header, table, rules, file })
    }

    /// The file.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The name of the volume it was built from.
    pub fn source_name(&self) -> &str {
        &self.header.source_name
    }

    /// Version of the file's format.
    pub fn version(&self) -> u32 {
        self.version
    }

    /// Bytes of the file.
    pub fn file_bytes(&self) -> u64 {
        self.file_bytes
    }

    /// Nodes that the table lists; it leaves out what is one value throughout.
    #[cfg(test)]
    pub(super) fn listed_nodes(&self) -> u64 {
        self.table.count()
    }

    /// Bricks that take bytes. Of a store of format version 1 it reads the whole table; damaged entries do not count.
    pub fn stored_bricks(&self) -> u64 {
        self.header.stored_bricks.unwrap_or_else(|| {
            let entries = (0..self.table.count()).filter_map(|place| self.entry(place).ok());
            entries.filter(|entry| entry.extent.bytes() > 0).count() as u64
        })
    }

    /// Errors of the levels against the source, the finest first; empty if an older program built the store.
    pub fn level_errors(&self) -> &[LevelError] {
        &self.header.levels
    }

    /// Bits per code.
    pub fn bits(&self) -> CodeBits {
        self.header.bits
    }

    /// Bytes that a node's brick takes in the file; 0 where all samples are equal.
    #[cfg(test)]
    pub(super) fn stored_bytes(&self, node: NodeKey) -> u64 {
        match self.find(node) {
            Found::Entry(entry) => entry.extent.bytes(),
            Found::Within(_) | Found::Lost { .. } => 0,
        }
    }

    /// Compression of the bricks.
    pub fn codec(&self) -> Codec {
        self.header.codec
    }

    /// The range of a node's codes around each cell, without its voxels; None in stores of older programs.
    ///
    /// # Errors
    /// A damaged entry or block.
    pub fn cells(&self, node: NodeKey) -> Result<Option<CellRanges>, BrickError> {
        let entry = self.entry_of(node)?;
        if entry.extent.codes == 0 {
            return Ok(entry.extent.checksums.map(|_| CellRanges::uniform(0)));
        }
        let bytes = self.read(entry.extent.offset, u64::from(entry.extent.cells), node)?;
        self.cells_from(&entry.extent, &bytes).map_err(|what| self.damaged(node, &what))
    }

    pub(super) fn entry(&self, place: u64) -> Result<Entry, Fault> {
        self.table.entry(place, &self.rules, &*self.file)
    }

    fn find(&self, node: NodeKey) -> Found {
        self.table.find(node, &self.rules, &*self.file)
    }

    /// The entry that covers a node; one above it loses its extent, as all of the node's samples are equal.
    fn entry_of(&self, node: NodeKey) -> Result<Entry, BrickError> {
        if !self.shape.contains(node) {
            let path = self.path.display();
            return Err(BrickError::damaged(format!(
                "{path} has no brick {node}: it lies outside the volume"
            )));
        }
        match self.find(node) {
            Found::Entry(entry) => Ok(entry),
            Found::Within(entry) => {
                // The checksum of nothing is zero.
                let checksums = entry.extent.checksums.map(|_| Checksums::default());
                let extent = Extent { checksums, ..Extent::default() };
                Ok(Entry { extent, step: 0.0, deviation_step: 0.0, ..entry })
            }
            Found::Lost { place, fault: Fault::Damaged, .. } => {
                Err(self.damaged(node, &format!("entry {place} of the table")))
            }
            Found::Lost { fault: Fault::Unreadable(cause), .. } => Err(self.unreadable(node, &cause)),
        }
    }

    fn damaged(&self, node: NodeKey, what: &str) -> BrickError {
        let path = self.path.display();
        BrickError::damaged(format!(
            "brick {node} of {path} is damaged ({what}); copy the store again or import the volume again"
        ))
    }

    fn read(&self, offset: u64, length: u64, node: NodeKey) -> Result<Vec<u8>, BrickError> {
        let mut bytes = vec![0; length as usize];
        self.file.read_at(offset, &mut bytes).map_err(|cause| self.unreadable(node, &cause))?;
        Ok(bytes)
    }

    fn unreadable(&self, node: NodeKey, cause: &std::io::Error) -> BrickError {
        let path = self.path.display();
        BrickError::unavailable(format!(
            "cannot read brick {node} of {path}: {cause}; check the disk or the network"
        ))
    }

    /// Reads and decodes what an entry points to.
    pub(super) fn brick_of(&self, node: NodeKey, entry: &Entry) -> Result<Brick, BrickError> {
        let extent = &entry.extent;
        let bytes = self.read(extent.offset, extent.bytes(), node)?;
        self.decode(entry, &bytes).map_err(|what| self.damaged(node, &what))
    }

    fn decode(&self, entry: &Entry, bytes: &[u8]) -> Result<Brick, String> {
        let (extent, Header { bits, codec, .. }) = (&entry.extent, &self.header);
        let (cells, voxels) = bytes.split_at(extent.cells as usize);
        let (codes, deviation) = voxels.split_at(extent.codes as usize);
        if extent.checksums.is_some_and(|sums| sums.voxels != checksum(voxels)) {
            return Err("the checksum of its voxels differs".into());
        }
        let mut brick = Brick::new(zeros(*bits), entry.low, entry.step);
        if extent.codes > 0 {
            brick.codes = decoded(&codec.unpack(codes, bits.brick_bytes())?, *bits);
            brick.cells = self.cells_from(extent, cells)?;
        } else if extent.checksums.is_some() {
            brick.cells = Some(CellRanges::uniform(0));
        }
        if extent.deviation > 0 {
            let codes = codec.unpack(deviation, BRICK_VOXELS)?;
            brick.deviation = Some(Deviation { codes, step: entry.deviation_step });
        }
        Ok(brick)
    }

    fn cells_from(&self, extent: &Extent, bytes: &[u8]) -> Result<Option<CellRanges>, String> {
        let Some(Checksums { cells, .. }) = extent.checksums else { return Ok(None) };
        if cells != checksum(bytes) {
            return Err("the checksum of its cells differs".into());
        }
        let bits = self.header.bits;
        let plain = self.header.codec.unpack(bytes, CellRanges::byte_count(bits))?;
        Ok(Some(CellRanges::from_bytes(&plain, bits)))
    }
}

impl BrickSource for Store {
    fn shape(&self) -> OctreeShape {
        self.shape
    }

    fn frame(&self) -> VolumeFrame {
        self.header.frame
    }

    fn modality(&self) -> Modality {
        self.header.modality
    }

    fn has_deviation(&self) -> bool {
        self.header.has_deviation
    }

    fn value_range(&self) -> (f64, f64) {
        self.header.value_range
    }

    /// Where the table is damaged, the bounds are those of a node above: wider, never wrong.
    fn summary(&self, node: NodeKey) -> NodeSummary {
        match self.find(node) {
            Found::Entry(Entry { min, max, .. })
            | Found::Lost { above: Some(Entry { min, max, .. }), .. } => NodeSummary { min, max },
            Found::Within(entry) => NodeSummary { min: entry.low, max: entry.low },
            Found::Lost { above: None, .. } => {
                let (low, high) = self.header.value_range;
                let (min, max) = ((low as f32).next_down(), (high as f32).next_up());
                NodeSummary { min: min.max(f32::MIN), max: max.min(f32::MAX) }
            }
        }
    }

    fn brick(&self, node: NodeKey) -> Result<Brick, BrickError> {
        self.brick_of(node, &self.entry_of(node)?)
    }
}

fn read_header(start: &[u8]) -> Result<(u32, Header), HeaderError> {
    match version(start)? {
        version @ format_v1::VERSION => Ok((version, format_v1::header(start)?)),
        version @ format::VERSION => Ok((version, Header::from_bytes(start)?)),
        other => Err(HeaderError::Version(other)),
    }
}

fn zeros(bits: CodeBits) -> Codes {
    match bits {
        CodeBits::Eight => Codes::U8(vec![0; BRICK_VOXELS]),
        CodeBits::Sixteen => Codes::U16(vec![0; BRICK_VOXELS]),
    }
}

fn decoded(plain: &[u8], bits: CodeBits) -> Codes {
    match bits {
        CodeBits::Eight => Codes::U8(plain.to_vec()),
        CodeBits::Sixteen => {
            Codes::U16(plain.as_chunks().0.iter().map(|&code| u16::from_le_bytes(code)).collect())
        }
    }
}

fn check_header(header: &Header) -> Result<(), String> {
    let (dims, range) = (header.dims, header.value_range);
    if dims.min_element() == 0 || dims.max_element() > MAX_EDGE_VOXELS {
        return Err(format!("the dimensions are {dims}, but each must be from 1 to {MAX_EDGE_VOXELS}"));
    }
    if !header.frame.is_sound() {
        return Err(format!(
            "the voxel size is {} m, but {}",
            header.frame.voxel_size_m(),
            VolumeFrame::SOUND_EDGES
        ));
    }
    let is_error = |error: f64| error.is_finite() && error >= 0.0;
    if !header.levels.iter().all(|level| is_error(level.rms) && is_error(level.max)) {
        return Err("the errors of its levels make no sense".into());
    }
    // Beyond f32 lies no stored value.
    let is_value = |value: f64| value.abs() <= f64::from(f32::MAX);
    if !is_value(range.0) || !is_value(range.1) || range.0 > range.1 {
        return Err(format!("the values are said to range from {} to {}", range.0, range.1));
    }
    Ok(())
}

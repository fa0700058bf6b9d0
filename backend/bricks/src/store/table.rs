//! The table of an open store: from a node to what is known of it, read block by block on demand.

use super::Codec;
use super::entry::{ENTRY_BYTES, Entry};
use super::format::Header;
use super::format_v1;
use super::node_table::NodeTable;
use super::read_at::ReadAt;
use crate::{NodeKey, OctreeShape};
use std::collections::HashMap;
use std::io;
use std::sync::{Arc, PoisonError, RwLock};

/// Entries read at once: 4 KiB of them.
const BLOCK: u64 = 64;
/// Blocks that are remembered: some hundred MiB of them.
const MOST_BLOCKS: usize = 1 << 15;

/// What a node is in the table.
#[derive(Debug)]
pub(super) enum Found {
    /// It has an entry of its own.
    Entry(Entry),
    /// An entry above it stands for it: all of its samples equal this one's `low`.
    Within(Entry),
    /// Unknown, as the entry at this place is bad. Holds the last good one above it, if there is one.
    Lost { place: u64, fault: Fault, above: Option<Entry> },
}

/// Why an entry cannot be read.
#[derive(Debug)]
pub(super) enum Fault {
    /// Its checksum differs, or its numbers make no sense.
    Damaged,
    /// The file cannot be read; it may be another time.
    Unreadable(io::Error),
}

/// Entries next to each other; None for what has another checksum.
type Block = Arc<[Option<Entry>]>;

/// The table of either version of the format.
pub(super) enum Table {
    /// One entry per node of the octree, none with a checksum (version 1).
    Dense { nodes: NodeTable, start: u64 },
    /// The octree without what its constant parts stand for (version 2).
    Tree { start: u64, count: u64, blocks: RwLock<HashMap<u64, Block>> },
}

impl Table {
    /// The table of a version 1 file; an error where header and file do not agree.
    pub fn dense(header: &Header, shape: OctreeShape, file_bytes: u64) -> Result<Self, String> {
        let nodes = NodeTable::new(shape).filter(|table| table.nodes() == header.nodes);
        let nodes =
            nodes.ok_or_else(|| format!("{} nodes do not belong to {} voxels", header.nodes, header.dims))?;
        let bytes = nodes.nodes().checked_mul(format_v1::ENTRY_BYTES as u64);
        match bytes.and_then(|bytes| bytes.checked_add(header.table_offset)) {
            Some(end) if end <= file_bytes => Ok(Table::Dense { nodes, start: header.table_offset }),
            _ => Err(format!(
                "it has {file_bytes} bytes, but the table of {} nodes does not fit",
                header.nodes
            )),
        }
    }

    /// The table of a version 2 file, likewise.
    pub fn tree(header: &Header, shape: OctreeShape, file_bytes: u64) -> Result<Self, String> {
        let (start, count) = (header.table_offset, header.nodes);
        let end = count.checked_mul(ENTRY_BYTES as u64).and_then(|bytes| bytes.checked_add(start));
        if start < header.length() || end != Some(file_bytes) {
            return Err(format!(
                "it has {file_bytes} bytes, but the table of {count} nodes does not end there"
            ));
        }
        if count == 0 || NodeTable::new(shape).is_none_or(|nodes| nodes.nodes() < count) {
            return Err(format!("{count} nodes do not belong to {} voxels", header.dims));
        }
        Ok(Table::Tree { start, count, blocks: RwLock::default() })
    }

    /// Entries.
    pub fn count(&self) -> u64 {
        match self {
            Table::Dense { nodes, .. } => nodes.nodes(),
            Table::Tree { count, .. } => *count,
        }
    }

    /// The entry at a place of the table.
    pub fn entry(&self, place: u64, rules: &EntryRules, file: &dyn ReadAt) -> Result<Entry, Fault> {
        let entry = match self {
            Table::Dense { start, .. } => {
                let mut bytes = [0; format_v1::ENTRY_BYTES];
                let offset = start + place * format_v1::ENTRY_BYTES as u64;
                file.read_at(offset, &mut bytes).map_err(Fault::Unreadable)?;
                format_v1::entry(&bytes)
            }
            Table::Tree { count, .. } => {
                let block = self.block(place / BLOCK, file)?;
                let entry = block.get((place % BLOCK) as usize).copied().flatten().ok_or(Fault::Damaged)?;
                if !has_children_within(&entry, place, *count) {
                    return Err(Fault::Damaged);
                }
                entry
            }
        };
        if rules.allow(&entry) { Ok(entry) } else { Err(Fault::Damaged) }
    }

    /// A block of a tree's entries, from memory or from the file.
    fn block(&self, block: u64, file: &dyn ReadAt) -> Result<Block, Fault> {
        let Table::Tree { start, count, blocks } = self else { return Err(Fault::Damaged) };
        // A thread that panicked while it held the lock has left the map whole.
        if let Some(known) = blocks.read().unwrap_or_else(PoisonError::into_inner).get(&block) {
            return Ok(Arc::clone(known));
        }
        let first = block * BLOCK;
        let mut bytes = vec![0; count.saturating_sub(first).min(BLOCK) as usize * ENTRY_BYTES];
        file.read_at(start + first * ENTRY_BYTES as u64, &mut bytes).map_err(Fault::Unreadable)?;
        let entries: Block = bytes.as_chunks::<ENTRY_BYTES>().0.iter().map(Entry::from_bytes).collect();
        let mut blocks = blocks.write().unwrap_or_else(PoisonError::into_inner);
        if blocks.len() >= MOST_BLOCKS {
            blocks.clear();
        }
        blocks.insert(block, Arc::clone(&entries));
        Ok(entries)
    }

    /// What the table says of a node that the octree contains.
    pub fn find(&self, node: NodeKey, rules: &EntryRules, file: &dyn ReadAt) -> Found {
        match self {
            Table::Dense { nodes, .. } => {
                let place = nodes.place(node);
                match self.entry(place, rules, file) {
                    Ok(entry) => Found::Entry(entry),
                    Err(fault) => Found::Lost { place, fault, above: None },
                }
            }
            Table::Tree { .. } => self.descend(node, rules, file),
        }
    }

    /// Goes down from the root: at most one entry per depth, whatever they say.
    fn descend(&self, node: NodeKey, rules: &EntryRules, file: &dyn ReadAt) -> Found {
        let (mut place, mut above) = (0, None);
        for depth in 0..=node.depth {
            let key = NodeKey { depth, cell: node.cell >> u32::from(node.depth - depth) };
            let entry = match self.entry(place, rules, file) {
                Ok(entry) if rules.fits(key, &entry) => entry,
                Ok(_) => return Found::Lost { place, fault: Fault::Damaged, above },
                Err(fault) => return Found::Lost { place, fault, above },
            };
            if depth == node.depth {
                return Found::Entry(entry);
            }
            if entry.children == 0 {
                return Found::Within(entry);
            }
            let cell = node.cell >> u32::from(node.depth - depth - 1);
            let octant = (cell.x & 1) | (cell.y & 1) << 1 | (cell.z & 1) << 2;
            let before = (u32::from(entry.children) & ((1 << octant) - 1)).count_ones();
            (place, above) = (entry.first_child + u64::from(before), Some(entry));
        }
        unreachable!("the loop returns at the node's own depth")
    }
}

/// Whether the children of the entry at a place lie after it in a table of so many entries; one without children
/// must not say where they are.
fn has_children_within(entry: &Entry, place: u64, count: u64) -> bool {
    if entry.children == 0 {
        return entry.first_child == 0;
    }
    let end = entry.first_child.checked_add(u64::from(entry.children.count_ones()));
    entry.first_child > place && end.is_some_and(|end| end <= count)
}

/// What the numbers of an entry must keep to, so that no read can leave the file or take more memory than a brick.
#[derive(Clone, Copy, Debug)]
pub(super) struct EntryRules {
    pub shape: OctreeShape,
    /// Where bricks may lie in the file.
    pub bricks: (u64, u64),
    /// Bytes of codes, cells and deviations, not compressed.
    pub codes: u64,
    pub cells: u64,
    pub deviation: u64,
    pub codec: Codec,
    pub largest_code: u16,
}

impl EntryRules {
    pub fn allow(&self, entry: &Entry) -> bool {
        let numbers = [entry.min, entry.max, entry.low, entry.step, entry.deviation_step];
        let extent = &entry.extent;
        let fits = |length: u32, plain: u64| {
            let length = u64::from(length);
            length == 0 || length == plain || (length < plain && self.codec != Codec::None)
        };
        let end = extent.offset.checked_add(extent.bytes());
        let largest = f64::from(entry.low) + f64::from(entry.step) * f64::from(self.largest_code);
        let is_one_value = extent.codes == 0;
        numbers.iter().all(|number| number.is_finite())
            && (is_one_value || largest <= f64::from(f32::MAX) * 1.0001)
            && (extent.checksums.is_none() || (extent.cells == 0) == is_one_value)
            && entry.min <= entry.max
            && entry.step >= 0.0
            && entry.deviation_step >= 0.0
            && fits(extent.codes, self.codes)
            && fits(extent.cells, self.cells)
            && fits(extent.deviation, self.deviation)
            && (extent.bytes() == 0
                || (extent.offset >= self.bricks.0 && end.is_some_and(|end| end <= self.bricks.1)))
    }

    /// Whether an entry of the tree has the children of its node: all or, where it stands for them, none.
    pub fn fits(&self, node: NodeKey, entry: &Entry) -> bool {
        let octants = (0..8u32).filter(|&octant| self.shape.contains(node.child(octant)));
        let children = octants.fold(0u8, |bits, octant| bits | 1 << octant);
        let stands_for_all = entry.extent.bytes() == 0;
        entry.children == children || (entry.children == 0 && stands_for_all)
    }
}

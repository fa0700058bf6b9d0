//! The table of an open store: from a node to what is known of it, read block by block as it is asked for.

use super::entry::{ENTRY_BYTES, Entry};
use super::format::Header;
use super::format_v1;
use super::node_table::NodeTable;
use super::read_at::ReadAt;
use super::{Codec, NodeKey, OctreeShape};
use std::sync::OnceLock;

/// Entries read at once: 4 KiB of them.
const BLOCK: usize = 64;

/// What a node is in the table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Found {
    /// It has an entry of its own.
    Entry(Entry),
    /// An entry above it stands for it: all of its samples equal this one's `low`.
    Within(Entry),
    /// It cannot be told: the entry at this place is damaged. The last one above it that is not, where there is one.
    Damaged { place: u64, above: Option<Entry> },
}

/// The table of either version of the format.
pub(super) enum Table {
    /// One entry per node of the octree, none with a checksum (version 1).
    Dense { nodes: NodeTable, start: u64 },
    /// The octree without what its constant parts stand for (version 2).
    Tree { start: u64, count: u64, blocks: Vec<OnceLock<Box<[Option<Entry>]>>> },
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
                "it has {file_bytes} bytes, and the table of {} nodes does not fit",
                header.nodes
            )),
        }
    }

    /// The table of a version 2 file, likewise.
    pub fn tree(header: &Header, file_bytes: u64) -> Result<Self, String> {
        let (start, count) = (header.table_offset, header.nodes);
        let end = count.checked_mul(ENTRY_BYTES as u64).and_then(|bytes| bytes.checked_add(start));
        if start < header.length() || end != Some(file_bytes) || count == 0 {
            return Err(format!(
                "it has {file_bytes} bytes, and the table of {count} nodes does not end there"
            ));
        }
        let blocks = (0..count.div_ceil(BLOCK as u64)).map(|_| OnceLock::new()).collect();
        Ok(Table::Tree { start, count, blocks })
    }

    /// Entries.
    pub fn count(&self) -> u64 {
        match self {
            Table::Dense { nodes, .. } => nodes.nodes(),
            Table::Tree { count, .. } => *count,
        }
    }

    /// The entry at a place; None where it is damaged.
    pub fn entry(&self, place: u64, rules: &EntryRules, file: &dyn ReadAt) -> Option<Entry> {
        let entry = match self {
            Table::Dense { start, .. } => {
                let mut bytes = [0; format_v1::ENTRY_BYTES];
                file.read_at(start + place * format_v1::ENTRY_BYTES as u64, &mut bytes).ok()?;
                format_v1::entry(&bytes)
            }
            Table::Tree { start, count, blocks } => {
                let block = (place / BLOCK as u64) as usize;
                let entries = blocks.get(block)?.get_or_init(|| read_block(*start, *count, block, file));
                (*entries.get((place % BLOCK as u64) as usize)?)?
            }
        };
        rules.allow(&entry).then_some(entry)
    }

    /// What the table says of a node that the octree contains.
    pub fn find(&self, node: NodeKey, rules: &EntryRules, file: &dyn ReadAt) -> Found {
        match self {
            Table::Dense { nodes, .. } => {
                let place = nodes.place(node);
                match self.entry(place, rules, file) {
                    Some(entry) => Found::Entry(entry),
                    None => Found::Damaged { place, above: None },
                }
            }
            Table::Tree { .. } => self.descend(node, rules, file),
        }
    }

    /// Goes down from the root: at most one entry per depth, whatever they say.
    fn descend(&self, node: NodeKey, rules: &EntryRules, file: &dyn ReadAt) -> Found {
        let (mut place, mut above) = (0, None);
        for depth in 0..=node.depth {
            let Some(entry) = self.entry(place, rules, file) else { return Found::Damaged { place, above } };
            if depth == node.depth {
                return Found::Entry(entry);
            }
            if entry.children == 0 {
                return Found::Within(entry);
            }
            let cell = node.cell >> u32::from(node.depth - depth - 1);
            let octant = (cell.x & 1) | (cell.y & 1) << 1 | (cell.z & 1) << 2;
            if entry.children >> octant & 1 == 0 {
                return Found::Damaged { place, above };
            }
            let before = (entry.children & ((1u16 << octant) - 1) as u8).count_ones();
            (place, above) = (entry.first_child.saturating_add(u64::from(before)), Some(entry));
        }
        unreachable!("the loop returns at the node's own depth")
    }
}

fn read_block(start: u64, count: u64, block: usize, file: &dyn ReadAt) -> Box<[Option<Entry>]> {
    let first = block as u64 * BLOCK as u64;
    let entries = (count - first).min(BLOCK as u64) as usize;
    let mut bytes = vec![0; entries * ENTRY_BYTES];
    match file.read_at(start + first * ENTRY_BYTES as u64, &mut bytes) {
        Ok(()) => bytes.as_chunks::<ENTRY_BYTES>().0.iter().map(Entry::from_bytes).collect(),
        Err(_) => vec![None; entries].into(),
    }
}

/// What the numbers of an entry must keep to, so that no read can leave the file or take more memory than a brick.
#[derive(Clone, Copy, Debug)]
pub(super) struct EntryRules {
    /// Where bricks may lie in the file.
    pub bricks: (u64, u64),
    /// Bytes of codes, cells and deviations, not compressed.
    pub codes: u64,
    pub cells: u64,
    pub deviation: u64,
    pub codec: Codec,
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
        numbers.iter().all(|number| number.is_finite())
            && entry.min <= entry.max
            && entry.step >= 0.0
            && entry.deviation_step >= 0.0
            && fits(extent.codes, self.codes)
            && fits(extent.cells, self.cells)
            && fits(extent.deviation, self.deviation)
            && (extent.bytes() == 0
                || (extent.offset >= self.bricks.0 && end.is_some_and(|end| end <= self.bricks.1)))
    }
}

//! The table of a store being built: entries come layer by layer, finer layers before the coarser ones above them.

use super::entry::Entry;
use crate::{NodeKey, OctreeShape};
use std::io::Write;

/// An entry on its way into the table.
#[derive(Clone, Copy)]
struct Row {
    node: NodeKey,
    entry: Entry,
    /// Whether it stands for all below it: a constant, as all below it are.
    is_subtree: bool,
}

/// Entries of all depths, each depth in [`NodeKey`] order. What is one value in a whole subtree is kept once, so that
/// empty space takes no room.
pub(super) struct Tree {
    depths: Vec<Vec<Row>>,
}

impl Tree {
    pub fn new(shape: OctreeShape) -> Self {
        Self { depths: (0..=shape.finest_depth()).map(|_| Vec::new()).collect() }
    }

    /// Takes in a node. Those of a depth come in their order, and after all those below them. Bounds become those of
    /// all below.
    pub fn put(&mut self, node: NodeKey, entry: Entry) {
        let row = self.above(node, entry);
        self.depths[usize::from(node.depth)].push(row);
    }

    /// Drops the nodes below those of a complete layer of constant z that stand for all below them.
    pub fn end_layer(&mut self, depth: u8, layer: u32) {
        let (above, below) = self.depths.split_at_mut(usize::from(depth) + 1);
        let (Some(rows), Some(children)) = (above.last(), below.first_mut()) else { return };
        let rows = &rows[rows.partition_point(|row| row.node.cell.z < layer)..];
        let stands_for_all = |child: &Row| {
            let parent = child.node.parent().expect("a child has a parent");
            rows.binary_search_by(|row| row.node.cmp(&parent)).is_ok_and(|place| rows[place].is_subtree)
        };
        let start = children.partition_point(|row| row.node.cell.z < 2 * layer);
        let end = children.partition_point(|row| row.node.cell.z < 2 * layer + 2);
        let kept: Vec<Row> = children.drain(start..end).filter(|child| !stands_for_all(child)).collect();
        children.splice(start..start, kept);
    }

    fn above(&mut self, node: NodeKey, mut entry: Entry) -> Row {
        let is_constant = entry.extent.bytes() == 0;
        let places = self.children(node);
        let Some(rows) = self.depths.get_mut(usize::from(node.depth) + 1) else {
            return Row { node, entry, is_subtree: is_constant };
        };
        let is_subtree = is_constant
            && places.iter().flatten().all(|&place| {
                let child = &rows[place];
                child.is_subtree && child.entry.low == entry.low
            });
        for &place in places.iter().flatten() {
            let child = &rows[place].entry;
            entry.min = entry.min.min(child.min);
            entry.max = entry.max.max(child.max);
        }
        Row { node, entry, is_subtree }
    }

    /// Places of a node's children among the rows of their depth.
    fn children(&self, node: NodeKey) -> [Option<usize>; 8] {
        let rows = self.depths.get(usize::from(node.depth) + 1);
        std::array::from_fn(|octant| {
            let child = node.child(octant as u32);
            rows?.binary_search_by(|row| row.node.cmp(&child)).ok()
        })
    }

    /// Writes the table, breadth first; returns the number of entries.
    pub fn write(&self, out: &mut impl Write) -> std::io::Result<u64> {
        let (mut places, mut written) = (vec![0], 0);
        for rows in &self.depths {
            let mut below = Vec::new();
            let end = written + places.len() as u64;
            for &place in &places {
                let Row { node, mut entry, .. } = rows[place];
                let children = self.children(node);
                let first_child = end + below.len() as u64;
                below.extend(children.iter().flatten());
                entry.children = (0..8).fold(0, |bits, i| bits | u8::from(children[i].is_some()) << i);
                entry.first_child = if entry.children == 0 { 0 } else { first_child };
                out.write_all(&entry.to_bytes())?;
            }
            (places, written) = (below, end);
        }
        Ok(written)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::store::entry::ENTRY_BYTES;
    use glam::UVec3;

    fn entry(value: f32, codes: u32) -> Entry {
        let mut entry = Entry { min: value, max: value + codes as f32, low: value, ..Entry::default() };
        entry.extent.codes = codes;
        entry
    }

    /// Two levels of 4 × 4 × 4 and one root, filled layer by layer as a build does.
    fn tree(value: impl Fn(NodeKey) -> Entry) -> Tree {
        let shape = OctreeShape::new(UVec3::splat(28 * 4));
        let mut tree = Tree::new(shape);
        let layer = |depth, z| {
            shape.nodes(depth).filter(move |node| node.cell.z == z).map(|node| (node, value(node)))
        };
        for (depth, z) in [(2, 0), (2, 1), (1, 0), (2, 2), (2, 3), (1, 1), (0, 0)] {
            layer(depth, z).for_each(|(node, entry)| tree.put(node, entry));
            tree.end_layer(depth, z);
        }
        tree
    }

    fn written(tree: &Tree) -> Vec<Entry> {
        let mut bytes = Vec::new();
        let count = tree.write(&mut bytes).unwrap();
        let entries: Vec<_> = bytes
            .as_chunks::<ENTRY_BYTES>()
            .0
            .iter()
            .map(|bytes| Entry::from_bytes(bytes).unwrap())
            .collect();
        assert_eq!(count, entries.len() as u64);
        entries
    }

    #[test]
    fn one_value_everywhere_is_one_entry() {
        let entries = written(&tree(|_| entry(3.0, 0)));
        assert_eq!((entries.len(), entries[0].children, entries[0].low), (1, 0, 3.0));
    }

    #[test]
    fn only_what_differs_is_kept_with_its_family() {
        let odd = NodeKey { depth: 2, cell: UVec3::new(3, 2, 1) };
        let is_above = |node: NodeKey| node == odd || Some(node) == odd.parent() || node == NodeKey::ROOT;
        let entries =
            written(&tree(|node| entry(3.0, if is_above(node) { u32::from(node.depth) + 1 } else { 0 })));
        assert_eq!(entries.len(), 1 + 8 + 8);
        assert_eq!((entries[0].first_child, entries[0].children), (1, 0xff));
        let family = &entries[1..9];
        assert_eq!(family.iter().filter(|child| child.children == 0xff).count(), 1);
        assert_eq!((family[0b011].first_child, family[0b011].children), (9, 0xff));
        assert_eq!(entries[9 + 0b101].extent.codes, 3);
        assert_eq!((entries[0].min, entries[0].max), (3.0, 6.0), "bounds of all below");
    }

    #[test]
    fn constants_that_differ_are_all_kept() {
        let entries = written(&tree(|node| entry(if node.depth == 2 { node.cell.x as f32 } else { 1.5 }, 0)));
        assert_eq!(entries.len(), 64 + 8 + 1);
    }
}

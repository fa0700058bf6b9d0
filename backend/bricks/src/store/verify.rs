//! Checking every byte of a store.

use super::entry::Entry;
use super::table::Table;
use super::{Store, StoreError};
use crate::{BrickSource, CellRanges, NodeKey};
use rayon::prelude::*;
use std::path::Path;

/// The most damages that are listed.
pub const MOST_DAMAGES: usize = 100;
/// Bricks between two reports of progress.
const BRICKS_AT_ONCE: usize = 1024;

/// What a check found.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Verification {
    /// Bricks that were read.
    pub bricks: u64,
    /// Bytes of the file.
    pub bytes: u64,
    /// What is wrong: one sentence each that names the place; empty for a whole store. At most the first
    /// [`MOST_DAMAGES`].
    pub damages: Vec<String>,
    /// How many there are, listed or not.
    pub damage_count: u64,
}

impl Verification {
    fn note(&mut self, what: String) {
        self.damage_count += 1;
        if self.damages.len() < MOST_DAMAGES {
            self.damages.push(what);
        }
    }
}

/// Reads and checks all of a store. `progress` gets (done, total) in bricks.
///
/// # Errors
/// A file that cannot be opened as a store at all.
pub fn verify(path: &Path, progress: &dyn Fn(u64, u64)) -> Result<Verification, StoreError> {
    Ok(Store::open(path)?.verify(progress))
}

impl Store {
    /// Reads and checks all of it: header, table, every brick and what lies between. `progress` gets (done, total)
    /// in bricks. A store of format version 1 has no checksums: of its bricks only damage that keeps them from being
    /// read is found.
    pub fn verify(&self, progress: &dyn Fn(u64, u64)) -> Verification {
        let mut found = Verification { bytes: self.file_bytes(), ..Verification::default() };
        let nodes = match self.table {
            Table::Dense { .. } => dense_nodes(self, &mut found),
            Table::Tree { .. } => {
                check_header_bytes(self, &mut found);
                tree_nodes(self, &mut found)
            }
        };
        let is_stored = |listed: &&Listed| listed.entry.extent.bytes() > 0;
        let stored: Vec<&Listed> = nodes.iter().filter(is_stored).collect();
        for part in stored.chunks(BRICKS_AT_ONCE) {
            let damages: Vec<_> = part.par_iter().filter_map(|listed| damage(self, listed)).collect();
            damages.into_iter().for_each(|what| found.note(what));
            found.bricks += part.len() as u64;
            progress(found.bricks, stored.len() as u64);
        }
        found
    }
}

/// A valid header has no bytes other than those written.
fn check_header_bytes(store: &Store, found: &mut Verification) {
    let mut bytes = vec![0; store.header.length() as usize];
    if store.file.read_at(0, &mut bytes).is_err() || bytes != store.header.to_bytes() {
        found.note("the header has meaningless bytes".into());
    }
}

/// An entry of the table, and its node if that is known.
struct Listed {
    place: u64,
    node: Option<NodeKey>,
    entry: Entry,
}

fn dense_nodes(store: &Store, found: &mut Verification) -> Vec<Listed> {
    let shape = store.shape();
    let all = (0..=shape.finest_depth()).flat_map(|depth| shape.nodes(depth));
    let mut listed = Vec::new();
    for (place, node) in all.enumerate().map(|(place, node)| (place as u64, node)) {
        match store.entry(place) {
            Ok(entry) => listed.push(Listed { place, node: Some(node), entry }),
            Err(_) => found.note(format!("entry {place} of the table, of brick {node}, is damaged")),
        }
    }
    listed
}

/// All nodes of the tree. Where no entry is damaged, children must lie where their parents say, and table and bricks
/// must fill the file without gaps; otherwise data that a damaged entry points to look like data that nothing points to.
fn tree_nodes(store: &Store, found: &mut Verification) -> Vec<Listed> {
    let count = store.table.count();
    let mut keys: Vec<Option<NodeKey>> = vec![None; count as usize];
    keys[0] = Some(NodeKey::ROOT);
    let mut listed = Vec::new();
    for place in 0..count {
        let node = keys[place as usize];
        match store.entry(place) {
            Ok(entry) if node.is_none_or(|node| store.rules.fits(node, &entry)) => {
                pass_on(&entry, place, node, &mut keys, found);
                listed.push(Listed { place, node, entry });
            }
            Ok(_) | Err(_) => {
                let of = node.map_or_else(String::new, |node| format!(", of brick {node},"));
                found.note(format!("entry {place} of the table{of} is damaged"));
            }
        }
    }
    if found.damage_count == 0 {
        for stray in listed.iter().filter(|listed| listed.node.is_none()) {
            found.note(format!("entry {} of the table belongs to no node", stray.place));
        }
        check_gaps(store, &listed, found);
    }
    listed
}

/// Names the children of an entry.
fn pass_on(
    entry: &Entry,
    place: u64,
    node: Option<NodeKey>,
    keys: &mut [Option<NodeKey>],
    found: &mut Verification,
) {
    let octants = (0..8u32).filter(|octant| entry.children >> octant & 1 == 1);
    // The table rejects entries whose children lie outside it, and those without children that name a place for them.
    for (octant, slot) in octants.zip(&mut keys[entry.first_child as usize..]) {
        if slot.is_some() {
            found.note(format!("entry {place} of the table shares a child with another entry"));
        }
        *slot = node.map(|node| node.child(octant));
    }
}

/// Every byte between header and table belongs to one brick.
fn check_gaps(store: &Store, listed: &[Listed], found: &mut Verification) {
    let extents = listed.iter().map(|listed| listed.entry.extent);
    let mut extents: Vec<_> = extents.filter(|extent| extent.bytes() > 0).collect();
    extents.sort_unstable_by_key(|extent| extent.offset);
    let (mut end, last) = store.rules.bricks;
    for extent in &extents {
        if extent.offset != end {
            found.note(format!("bytes {end} to {} belong to no brick, or to two", extent.offset));
        }
        end = extent.offset + extent.bytes();
    }
    if end != last {
        found.note(format!("bytes {end} to {last} belong to no brick"));
    }
}

/// What is wrong with a brick.
fn damage(store: &Store, listed: &Listed) -> Option<String> {
    let entry = &listed.entry;
    let brick = match store.brick_of(listed.node.unwrap_or(NodeKey::ROOT), entry) {
        Ok(brick) => brick,
        Err(error) if listed.node.is_some() => return Some(error.to_string()),
        Err(_) => return Some(format!("the brick of entry {} of the table is damaged", listed.place)),
    };
    let wrong = match &brick.cells {
        Some(cells) if *cells != CellRanges::of(&brick.codes) => "its cells are not those of its voxels",
        _ if (0..2).any(|end| !within(&brick, entry, end)) => "its voxels lie outside its bounds",
        _ => return None,
    };
    Some(format!("the brick of entry {} of the table is damaged ({wrong})", listed.place))
}

/// Whether the smallest (0) or largest (1) value of a brick lies within the bounds of its node.
fn within(brick: &super::Brick, entry: &Entry, end: usize) -> bool {
    let Some(cells) = &brick.cells else { return true };
    let codes = cells.ranges().iter().map(|range| range[end]);
    let code = if end == 0 { codes.min() } else { codes.max() };
    let value = f64::from(brick.low) + f64::from(code.unwrap_or(0)) * f64::from(brick.step);
    (f64::from(entry.min)..=f64::from(entry.max)).contains(&value)
}

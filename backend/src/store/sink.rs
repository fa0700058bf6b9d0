//! A store being written: a nameless start beside the final file, which gets its name only when it is complete.

use super::format::{ENTRY_BYTES, Entry, Header};
use super::node_table::NodeTable;
use super::{NodeKey, OctreeShape, StoreError};
use crate::temporary::temporary_in;
use std::fs::File;
use std::io::{BufWriter, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use tempfile::TempPath;

/// Bytes collected before they are written.
const WRITE_BUFFER_BYTES: usize = 1 << 20;

/// A brick ready to be written; `entry` lacks the offset only.
pub(super) struct PackedBrick {
    pub node: NodeKey,
    pub entry: Entry,
    pub bytes: Vec<u8>,
}

/// The file being written, and its table.
pub(super) struct Sink {
    path: PathBuf,
    file: BufWriter<File>,
    /// Where it is while it is being written.
    working_path: TempPath,
    shape: OctreeShape,
    table: NodeTable,
    entries: Vec<Entry>,
    position: u64,
    stored_bricks: u64,
}

impl Sink {
    /// Starts a file in the folder of `path`, with room for header and table.
    pub fn create(
        path: &Path,
        shape: OctreeShape,
        table: NodeTable,
        header: &Header,
    ) -> Result<Self, StoreError> {
        if path.is_dir() {
            return Err(StoreError::write(path)(std::io::ErrorKind::IsADirectory.into()));
        }
        let (file, working_path) =
            temporary_in(folder_of(path)).map_err(StoreError::write(path))?.into_parts();
        let mut file = BufWriter::with_capacity(WRITE_BUFFER_BYTES, file);
        let position = header.table_offset() + table.nodes() * ENTRY_BYTES as u64;
        file.seek(SeekFrom::Start(position)).map_err(StoreError::write(path))?;
        let entries = vec![Entry::default(); table.nodes() as usize];
        Ok(Self { path: path.into(), file, working_path, shape, table, entries, position, stored_bricks: 0 })
    }

    /// Writes a brick; each node once.
    pub fn put(&mut self, brick: PackedBrick) -> Result<(), StoreError> {
        let entry = Entry { offset: self.position, length: brick.bytes.len() as u32, ..brick.entry };
        self.entries[self.table.place(brick.node) as usize] = entry;
        self.position += brick.bytes.len() as u64;
        self.stored_bricks += u64::from(!brick.bytes.is_empty());
        self.file.write_all(&brick.bytes).map_err(StoreError::write(&self.path))
    }

    /// Bytes of the file so far.
    pub fn bytes(&self) -> u64 {
        self.position
    }

    /// Bricks that took any bytes.
    pub fn stored_bricks(&self) -> u64 {
        self.stored_bricks
    }

    /// Writes header and table, waits for the disk, and gives the file its name.
    pub fn finish(mut self, header: &Header) -> Result<(), StoreError> {
        self.bound_descendants();
        let failed = StoreError::write(&self.path);
        self.file.seek(SeekFrom::Start(0)).map_err(&failed)?;
        self.file.write_all(&header.to_bytes()).map_err(&failed)?;
        for entry in &self.entries {
            self.file.write_all(&entry.to_bytes()).map_err(&failed)?;
        }
        let file = self.file.into_inner().map_err(|error| failed(error.into_error()))?;
        file.set_len(self.position).map_err(&failed)?;
        file.sync_all().map_err(&failed)?;
        self.working_path.persist(&self.path).map_err(|error| failed(error.error))?;
        Ok(())
    }

    /// Widens the bounds of every node by those of its children, from the finest up.
    fn bound_descendants(&mut self) {
        for depth in (1..=self.shape.finest_depth()).rev() {
            for node in self.shape.nodes(depth) {
                let child = self.entries[self.table.place(node) as usize];
                let Some(parent) = node.parent() else { continue };
                let above = &mut self.entries[self.table.place(parent) as usize];
                above.min = above.min.min(child.min);
                above.max = above.max.max(child.max);
            }
        }
    }
}

/// The folder that a file is in.
pub(super) fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if folder != Path::new("") => folder,
        _ => Path::new("."),
    }
}

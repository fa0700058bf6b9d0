//! A store being written: bricks as they come, then the table, and the header last.

use super::StoreError;
use super::format::{Header, MAGIC};
use super::pack::PackedBrick;
use super::tree::Tree;
use super::writer::Writer;
use crate::OctreeShape;
use crate::links::followed;
use crate::working_file::WorkingFile;
use std::fs::File;
use std::io::{Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

/// The file being written. It has its name only when it is complete, and until then no header either.
pub(super) struct Sink {
    path: PathBuf,
    // Dropped in this order: the name goes before the lock does.
    working: WorkingFile,
    file: Writer,
    tree: Tree,
    position: u64,
    stored_bricks: u64,
}

impl Sink {
    /// Starts a file with room for a header of so many bytes.
    pub fn create(path: &Path, shape: OctreeShape, header_bytes: u64) -> Result<Self, StoreError> {
        let failed = StoreError::write(path);
        // Without a slash at the end, which a path of a file may have until something is to be written there.
        let path = &followed(path.components().as_path()).map_err(&failed)?;
        check_replaceable(path)?;
        let (working, mut file) = WorkingFile::create(path).map_err(&failed)?;
        file.seek(SeekFrom::Start(header_bytes)).map_err(&failed)?;
        let file = Writer::new(file);
        let tree = Tree::new(shape);
        Ok(Self { path: path.into(), working, file, tree, position: header_bytes, stored_bricks: 0 })
    }

    /// Writes a brick; they come in the order that [`Tree::put`] wants.
    pub fn put(&mut self, mut brick: PackedBrick) -> Result<(), StoreError> {
        if !brick.bytes.is_empty() {
            brick.entry.extent.offset = self.position;
            self.position += brick.bytes.len() as u64;
            self.stored_bricks += 1;
            self.file.write_all(&brick.bytes).map_err(StoreError::write(&self.path))?;
        }
        self.tree.put(brick.node, brick.entry);
        Ok(())
    }

    /// Ends a layer of bricks of constant z.
    pub fn end_layer(&mut self, depth: u8, z: u32) {
        self.tree.end_layer(depth, z);
    }

    /// Bricks that took any bytes.
    pub fn stored_bricks(&self) -> u64 {
        self.stored_bricks
    }

    /// Writes the table and the header, waits for the disk, and gives the file its name. Returns its bytes.
    pub fn finish(mut self, header: Header) -> Result<u64, StoreError> {
        let failed = StoreError::write(&self.path);
        let nodes = self.tree.write(&mut self.file).map_err(&failed)?;
        let mut file = self.file.finish().map_err(&failed)?;
        let bytes = file.stream_position().map_err(&failed)?;
        let stored_bricks = Some(self.stored_bricks);
        let header = Header { nodes, table_offset: self.position, stored_bricks, ..header };
        file.seek(SeekFrom::Start(0)).map_err(&failed)?;
        file.write_all(&header.to_bytes()).map_err(&failed)?;
        file.sync_all().map_err(&failed)?;
        self.working.rename(&self.path).map_err(&failed)?;
        sync_folder(&self.path);
        Ok(bytes)
    }
}

/// A store may replace a store and nothing else: a mistyped name must not destroy data.
fn check_replaceable(path: &Path) -> Result<(), StoreError> {
    let Ok(found) = std::fs::metadata(path) else { return Ok(()) };
    let mut start = Vec::new();
    let is_store = found.is_file()
        && File::open(path).is_ok_and(|file| file.take(MAGIC.len() as u64).read_to_end(&mut start).is_ok())
        && (start.is_empty() || start == MAGIC);
    // Of a folder, the working file will say that it is one.
    match is_store || found.is_dir() {
        true => Ok(()),
        false => Err(StoreError::Occupied { path: path.into() }),
    }
}

/// Makes a new name last through a power cut, where folders can be synced.
fn sync_folder(path: &Path) {
    // The file itself is safe; a file system that refuses this only delays the name.
    let _ = File::open(folder_of(path)).and_then(|folder| folder.sync_all());
}

/// The folder that a file is in.
pub(super) fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if folder != Path::new("") => folder,
        _ => Path::new("."),
    }
}

//! A store being written: bricks as they come, then the table, and the header last.

use super::format::Header;
use super::pack::PackedBrick;
use super::tree::Tree;
use super::working_file::WorkingFile;
use super::{OctreeShape, StoreError};
use std::fs::File;
use std::io::{BufWriter, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

/// Bytes collected before they are written.
const WRITE_BUFFER_BYTES: usize = 1 << 20;

/// The file being written. It has its name only when it is complete, and until then no header either.
pub(super) struct Sink {
    path: PathBuf,
    file: BufWriter<File>,
    working: WorkingFile,
    tree: Tree,
    position: u64,
    stored_bricks: u64,
}

impl Sink {
    /// Starts a file with room for a header of so many bytes.
    pub fn create(path: &Path, shape: OctreeShape, header_bytes: u64) -> Result<Self, StoreError> {
        let failed = StoreError::write(path);
        let (working, file) = WorkingFile::create(path).map_err(&failed)?;
        let mut file = BufWriter::with_capacity(WRITE_BUFFER_BYTES, file);
        file.seek(SeekFrom::Start(header_bytes)).map_err(&failed)?;
        let tree = Tree::new(shape);
        Ok(Self { path: path.into(), file, working, tree, position: header_bytes, stored_bricks: 0 })
    }

    /// Writes a layer of bricks, in the order that [`Tree::put_layer`] wants.
    pub fn put_layer(&mut self, bricks: &[PackedBrick]) {
        self.tree.put_layer(bricks.iter().map(|brick| (brick.node, brick.entry)));
    }

    /// Writes a brick's bytes and notes where they are.
    pub fn write(&mut self, brick: &mut PackedBrick) -> Result<(), StoreError> {
        if !brick.bytes.is_empty() {
            brick.entry.extent.offset = self.position;
            self.position += brick.bytes.len() as u64;
            self.stored_bricks += 1;
            self.file.write_all(&brick.bytes).map_err(StoreError::write(&self.path))?;
            brick.bytes = Vec::new();
        }
        Ok(())
    }

    /// Bricks that took any bytes.
    pub fn stored_bricks(&self) -> u64 {
        self.stored_bricks
    }

    /// Writes the table and the header, waits for the disk, and gives the file its name. Returns its bytes.
    pub fn finish(mut self, header: Header) -> Result<u64, StoreError> {
        let failed = StoreError::write(&self.path);
        let nodes = self.tree.write(&mut self.file).map_err(&failed)?;
        let bytes = self.file.stream_position().map_err(&failed)?;
        let header = Header { nodes, table_offset: self.position, ..header };
        self.file.seek(SeekFrom::Start(0)).map_err(&failed)?;
        self.file.write_all(&header.to_bytes()).map_err(&failed)?;
        let file = self.file.into_inner().map_err(|error| failed(error.into_error()))?;
        file.sync_all().map_err(&failed)?;
        self.working.rename(&self.path).map_err(&failed)?;
        sync_folder(&self.path);
        Ok(bytes)
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

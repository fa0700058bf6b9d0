//! TIFF pages as a volume: one page is decoded at a time.

use super::gaps::gap;
use super::hyperstack::Hyperstack;
use super::pages::TiffFile;
use super::{imagej, ome};
use crate::Selection;
use bricks::volume::{MAX_EDGE_VOXELS, Samples, VolumeError, VolumeFrame, VolumeInfo, VolumeReader};
use glam::{DVec3, UVec3};
use std::path::{Path, PathBuf};

/// Where the slices come from.
enum Slices {
    /// One after the other, each a page of the open file.
    Pages(Vec<u32>),
    /// Each a file of its own.
    Files(Vec<PathBuf>),
}

/// An open stack.
pub(super) struct TiffVolume {
    info: VolumeInfo,
    slices: Slices,
    /// The file of all pages, or of the slice read last.
    file: TiffFile,
    /// Which of the samples of a page.
    sample: usize,
    page: Vec<u8>,
}

impl TiffVolume {
    /// A file with all slices.
    pub fn of_file(path: &Path, selection: &Selection) -> Result<Self, VolumeError> {
        let mut file = TiffFile::open(path)?;
        let stack = hyperstack(&mut file)?;
        let (pages, sample) = stack.choose(path, file.format.samples, selection)?;
        let voxel_mm = selection.spacing_mm.unwrap_or_else(|| stack.voxel_mm(path));
        Self::new(path, file, Slices::Pages(pages), sample, voxel_mm)
    }

    /// Files with a slice each, in order.
    pub fn of_files(folder: &Path, paths: Vec<PathBuf>, selection: &Selection) -> Result<Self, VolumeError> {
        let mut first = TiffFile::open(&paths[0])?;
        let mut stack = Hyperstack::of_slices(1);
        stack.voxel_mm = description(&mut first)?.map_or([None; 3], |(stack, _)| stack.voxel_mm);
        let (_, sample) = stack.choose(folder, first.format.samples, selection)?;
        for path in &paths {
            let file = TiffFile::open(path)?;
            if file.pages.len() > 1 {
                let count = file.pages.len();
                let what =
                    format!("it has {count} pages, and files of a folder have one: open the file itself");
                return Err(VolumeError::unsupported(path, what));
            }
            if file.format != first.format {
                let what = format!(
                    "it is {}, and {} is {}: all slices must be alike",
                    file.format,
                    first.path.display(),
                    first.format
                );
                return Err(VolumeError::unsupported(path, what));
            }
        }
        warn_of_gap(folder, &paths);
        let voxel_mm = selection.spacing_mm.unwrap_or_else(|| stack.voxel_mm(folder));
        Self::new(folder, first, Slices::Files(paths), sample, voxel_mm)
    }

    fn new(
        path: &Path,
        file: TiffFile,
        slices: Slices,
        sample: u32,
        voxel_mm: DVec3,
    ) -> Result<Self, VolumeError> {
        let count = match &slices {
            Slices::Pages(pages) => pages.len(),
            Slices::Files(paths) => paths.len(),
        };
        if file.has_palette {
            tracing::warn!(path = %path.display(), "its numbers stand for colours of a palette: they are taken as values");
        }
        let frame = VolumeFrame::of_voxels(voxel_mm * 1e-3);
        if count > MAX_EDGE_VOXELS as usize {
            let what = format!("it has {count} slices, and {MAX_EDGE_VOXELS} are the most");
            return Err(VolumeError::unsupported(path, what));
        }
        if !frame.is_sound() {
            let what = format!("the voxel size is {voxel_mm} mm, and {}", VolumeFrame::SOUND_EDGES);
            return Err(VolumeError::header(path, what));
        }
        let info = VolumeInfo {
            name: path.file_name().unwrap_or_default().to_string_lossy().into_owned(),
            dims: UVec3::new(file.format.width, file.format.height, count as u32),
            frame,
            element: file.format.element,
            slope: 1.0,
            intercept: 0.0,
        };
        Ok(Self { info, slices, file, sample: sample as usize, page: Vec::new() })
    }
}

impl VolumeReader for TiffVolume {
    fn info(&self) -> &VolumeInfo {
        &self.info
    }

    fn read_slab(&mut self, z: u32, slab: &mut Samples) -> Result<(), VolumeError> {
        assert!(z < self.info.dims.z && slab.len() == self.info.slab_voxels(), "slab {z} of {:?}", self.info);
        let page = match &self.slices {
            Slices::Pages(pages) => pages[z as usize] as usize,
            Slices::Files(paths) => {
                let path = &paths[z as usize];
                if *path != self.file.path {
                    self.file = TiffFile::open(path)?;
                }
                0
            }
        };
        let format = self.file.format;
        if format.samples == 1 {
            return self.file.read(page, slab.bytes_mut());
        }
        self.page.resize(format.bytes(), 0);
        self.file.read(page, &mut self.page)?;
        let bytes = format.element.bytes();
        if format.is_planar {
            let plane = format.pixels() * bytes;
            slab.bytes_mut().copy_from_slice(&self.page[self.sample * plane..][..plane]);
            return Ok(());
        }
        let pixels = self.page.chunks_exact(bytes * format.samples as usize);
        for (number, pixel) in slab.bytes_mut().chunks_exact_mut(bytes).zip(pixels) {
            number.copy_from_slice(&pixel[self.sample * bytes..][..bytes]);
        }
        Ok(())
    }
}

/// Files are slices in the order of their names, so a gap between these is all that tells of a missing one.
fn warn_of_gap(folder: &Path, paths: &[PathBuf]) {
    let names: Vec<_> =
        paths.iter().map(|path| path.file_stem().unwrap_or_default().to_string_lossy()).collect();
    let names: Vec<&str> = names.iter().map(|name| &**name).collect();
    if let Some((before, after)) = gap(&names) {
        let path = folder.display();
        tracing::warn!(%path, before, after, "between these slices one may be missing, or another stack begins");
    }
}

/// What the description of a file says of all of its pages; None if it says nothing. Also how many pages there are.
fn description(file: &mut TiffFile) -> Result<Option<(Hyperstack, u32)>, VolumeError> {
    let (text, pages) = (file.description(), file.pages.len() as u32);
    if ome::is_ome(&text) {
        let stack = ome::hyperstack(&text, pages, file.format.samples);
        let stack = stack.map_err(|what| VolumeError::unsupported(&file.path, what))?;
        return Ok(Some((stack, pages)));
    }
    let resolution = file.resolution();
    Ok(imagej::hyperstack(&text, pages, resolution))
}

fn hyperstack(file: &mut TiffFile) -> Result<Hyperstack, VolumeError> {
    let pages = file.pages.len() as u32;
    let (mut stack, count) = match description(file)? {
        Some(told) => told,
        None => (Hyperstack::of_slices(pages), pages),
    };
    if count != pages {
        file.set_contiguous(count)?;
    }
    if stack.voxel_mm[..2] == [None; 2] {
        let [x, y] = super::hyperstack::printed_mm(file.resolution());
        (stack.voxel_mm[0], stack.voxel_mm[1]) = (x, y);
    }
    Ok(stack)
}

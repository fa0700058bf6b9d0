//! TIFF pages as a volume: one page is decoded at a time.

use super::gaps::gap;
use super::hyperstack::Hyperstack;
use super::pages::TiffFile;
use super::{imagej, ome};
use crate::Selection;
use bricks::volume::{MAX_EDGE_VOXELS, Samples, VolumeError, VolumeFrame, VolumeInfo, VolumeReader};
use glam::{DVec3, UVec3};
use std::path::{Path, PathBuf};

/// Largest page of several channels, unless the user allows more memory.
const MOST_PAGE_BYTES: u64 = 2 << 30;

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
        check_page(&file, selection)?;
        let voxel_mm = selection.spacing_mm.unwrap_or_else(|| stack.voxel_mm(path));
        Self::new(path, file, Slices::Pages(pages), sample, voxel_mm)
    }

    /// Files with a slice each, in order.
    pub fn of_files(folder: &Path, paths: Vec<PathBuf>, selection: &Selection) -> Result<Self, VolumeError> {
        let mut first = TiffFile::open(&paths[0])?;
        let mut stack = Hyperstack::of_slices(1);
        stack.voxel_mm = description(&mut first)?.map_or([None; 3], |stack| stack.voxel_mm);
        let (_, sample) = stack.choose(folder, first.format.samples, selection)?;
        check_page(&first, selection)?;
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
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        let dims = UVec3::new(file.format.width, file.format.height, count as u32);
        let info = VolumeInfo::unscaled(name, dims, frame, file.format.element);
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

/// A page of several channels is decoded whole, whichever of them is chosen.
fn check_page(file: &TiffFile, selection: &Selection) -> Result<(), VolumeError> {
    let bytes = file.format.bytes() as u64;
    if file.format.samples == 1 || bytes <= MOST_PAGE_BYTES.max(selection.memory_bytes) {
        return Ok(());
    }
    let what = format!("a page with all its channels takes {bytes} bytes: save the channels apart");
    Err(VolumeError::unsupported(&file.path, what))
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

/// What the description of a file says of all of its pages; None if it says nothing. Pages that are not listed are
/// found.
fn description(file: &mut TiffFile) -> Result<Option<Hyperstack>, VolumeError> {
    let (text, pages) = (file.description(), file.pages.len() as u32);
    if ome::is_ome(&text) {
        let stack = ome::hyperstack(&text, pages, file.format.samples);
        let stack = stack.map_err(|what| VolumeError::unsupported(&file.path, what))?;
        return Ok(Some(stack));
    }
    let Some(counts) = imagej::counts(&text, pages) else { return Ok(None) };
    match Hyperstack::page_count(counts) {
        Some(count) if count != pages => file.set_contiguous(count)?,
        _ => {}
    }
    let resolution = file.resolution();
    Ok(Some(imagej::hyperstack(&text, counts, resolution)))
}

fn hyperstack(file: &mut TiffFile) -> Result<Hyperstack, VolumeError> {
    let pages = file.pages.len() as u32;
    let mut stack = description(file)?.unwrap_or_else(|| Hyperstack::of_slices(pages));
    if stack.voxel_mm[..2] == [None; 2] {
        let [x, y] = super::hyperstack::printed_mm(file.resolution());
        (stack.voxel_mm[0], stack.voxel_mm[1]) = (x, y);
    }
    Ok(stack)
}

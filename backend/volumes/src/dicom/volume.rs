//! A DICOM series as a volume: one slice is decoded at a time.

use super::decode::{self, Decoder};
use super::header::{Frame, ImageFile};
use super::stack::Stack;
use crate::Selection;
use bricks::volume::{
    Element, MAX_EDGE_VOXELS, Modality, Samples, VolumeError, VolumeFrame, VolumeInfo, VolumeReader,
};
use glam::UVec3;
use std::path::Path;

/// An open series.
pub(super) struct DicomVolume {
    info: VolumeInfo,
    slices: Vec<Frame>,
    /// Whether values are handed out, not the numbers of the files.
    is_scaled: bool,
    decoder: Decoder,
}

impl DicomVolume {
    /// Checks what can be checked without decoding.
    pub fn new(path: &Path, stack: Stack, selection: &Selection) -> Result<Self, VolumeError> {
        let Stack { slices, frame } = stack;
        for slice in &slices {
            check_slice(slice)?;
        }
        let first = &slices[0];
        if first.file.has_palette {
            tracing::warn!(path = %first.file.path.display(), "its numbers stand for colours of a palette: they are taken as values");
        }
        let mut info = VolumeInfo {
            name: name(path, first),
            dims: UVec3::new(first.file.columns, first.file.rows, slices.len() as u32),
            frame,
            modality: modality(&first.file),
            element: one_element(&slices)?,
            slope: first.scaling.0,
            intercept: first.scaling.1,
        };
        // Slices that are scaled differently (PET) have no common stored number: they are handed out as values.
        let is_scaled = slices.iter().any(|slice| slice.scaling != first.scaling);
        if is_scaled {
            (info.element, info.slope, info.intercept) = (Element::F32, 1.0, 0.0);
        }
        if slices.len() > MAX_EDGE_VOXELS as usize {
            let what = format!("it has {} slices, and {MAX_EDGE_VOXELS} are the most", slices.len());
            return Err(VolumeError::unsupported(path, what));
        }
        if !info.frame.is_sound() {
            let size_mm = info.frame.voxel_size_m() * 1e3;
            let what = format!("its voxels of {size_mm} mm cannot lie so: {}", VolumeFrame::SOUND_EDGES);
            return Err(VolumeError::header(&first.file.path, what));
        }
        Ok(Self { info, slices, is_scaled, decoder: Decoder::new(selection.memory_bytes) })
    }
}

impl VolumeReader for DicomVolume {
    fn info(&self) -> &VolumeInfo {
        &self.info
    }

    fn read_slab(&mut self, z: u32, slab: &mut Samples) -> Result<(), VolumeError> {
        assert!(z < self.info.dims.z && slab.len() == self.info.slab_voxels(), "slab {z} of {:?}", self.info);
        let slice = &self.slices[z as usize];
        let bytes = self.decoder.frame(slice)?;
        slice.file.pixels.unpack(&bytes, self.is_scaled.then_some(slice.scaling), slab);
        Ok(())
    }
}

/// Values of CT are Hounsfield units unless the file says that they are others (PS3.3 C.11.1.1.2).
fn modality(file: &ImageFile) -> Modality {
    match (file.modality.as_str(), file.rescale_type.as_str()) {
        ("CT", "" | "HU") => Modality::Ct,
        ("MR", _) => Modality::Mr,
        _ => Modality::Unknown,
    }
}

/// What the scanner's operator called the series; otherwise the file's or folder's name.
fn name(path: &Path, first: &Frame) -> String {
    match first.file.description.as_str() {
        "" => path.file_name().unwrap_or_default().to_string_lossy().into_owned(),
        description => description.to_owned(),
    }
}

fn check_slice(slice: &Frame) -> Result<(), VolumeError> {
    let file = &slice.file;
    let (slope, intercept) = slice.scaling;
    if !slope.is_finite() || !intercept.is_finite() || slope == 0.0 {
        let what = format!("values are scaled by {slope} and shifted by {intercept}");
        return Err(VolumeError::header(&file.path, what));
    }
    if file.samples_per_pixel != 1 {
        let what = format!(
            "it has {} samples per pixel, and volumes have one: colours cannot be shown",
            file.samples_per_pixel
        );
        return Err(VolumeError::unsupported(&file.path, what));
    }
    decode::check(file)
}

fn one_element(slices: &[Frame]) -> Result<Element, VolumeError> {
    let mut one = None;
    for slice in slices {
        let (file, bits) = (&slice.file, &slice.file.pixels);
        let Some(element) = bits.element() else {
            let what = format!(
                "pixels have {} bits of which {} up to bit {} are used: cells of 8, 16 or 32 bits are read",
                bits.allocated, bits.stored, bits.high_bit
            );
            return Err(VolumeError::unsupported(&file.path, what));
        };
        if *one.get_or_insert(element) != element {
            let what = format!("{} has {element} pixels, and {} others", slice.name(), slices[0].name());
            return Err(VolumeError::unsupported(&file.path, what));
        }
    }
    Ok(one.expect("a stack has slices"))
}

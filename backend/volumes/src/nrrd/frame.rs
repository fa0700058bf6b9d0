//! Where the voxels of an NRRD header lie.

use super::super::header_text::HeaderText;
use super::axes::{Axes, vector};
use bricks::volume::{Space, VolumeError, VolumeFrame};
use glam::{DMat3, DVec3};

/// From `space directions` and `space origin`, or from `spacings` and `axis mins` if there are none; 1 mm where no
/// length is given or known.
pub(super) fn frame(header: &HeaderText, axes: &Axes) -> Result<VolumeFrame, VolumeError> {
    match &axes.directions {
        Some(directions) => in_space(header, &axes.volume.map(|axis| directions[axis].as_deref())),
        None => along_axes(header, axes),
    }
}

fn in_space(header: &HeaderText, directions: &[Option<&[f64]>; 3]) -> Result<VolumeFrame, VolumeError> {
    let units_m = space_units_m(header)?;
    let (signs, space) = signs(header.get(&["space"]).unwrap_or(""));
    let in_file = |vector: &[f64]| DVec3::new(vector[0], vector[1], vector[2]) * units_m * signs;
    let origin_m = match header.get(&["space origin"]) {
        Some(value) => in_file(&vector(header, "space origin", value)?.0),
        None => DVec3::ZERO,
    };
    let [x, y, z] = directions.map(|vector| vector.map_or(DVec3::ZERO, in_file));
    Ok(VolumeFrame { axes_m: DMat3::from_cols(x, y, z), origin_m, space })
}

/// What turns the file's space into a patient's (left, posterior, superior), where it is one; a fourth axis of time
/// changes nothing.
fn signs(space: &str) -> (DVec3, Space) {
    let space = space.to_ascii_lowercase();
    let space = space.strip_suffix("-time").unwrap_or(&space);
    match space {
        "left-posterior-superior" | "lps" | "lpst" => (DVec3::ONE, Space::Patient),
        "right-anterior-superior" | "ras" | "rast" => (DVec3::new(-1.0, -1.0, 1.0), Space::Patient),
        "left-anterior-superior" | "las" | "last" => (DVec3::new(1.0, -1.0, 1.0), Space::Patient),
        _ => (DVec3::ONE, Space::Unknown),
    }
}

fn along_axes(header: &HeaderText, axes: &Axes) -> Result<VolumeFrame, VolumeError> {
    let units_m = axis_units_m(header, axes)?;
    let spacings = per_axis(header, "spacings", axes)?.abs();
    let spacings = DVec3::select(spacings.is_nan_mask(), DVec3::ONE, spacings);
    let mins = per_axis(header, "axis mins", axes)?;
    let mins = DVec3::select(mins.is_nan_mask(), DVec3::ZERO, mins + first_centre(header, axes) * spacings);
    Ok(VolumeFrame { origin_m: mins * units_m, ..VolumeFrame::of_voxels(spacings * units_m) })
}

/// A number for each axis of the volume, NaN if it is not given.
fn per_axis(header: &HeaderText, key: &str, axes: &Axes) -> Result<DVec3, VolumeError> {
    let names = [key, &key.replace(' ', "")];
    let Some(value) = header.get(&names) else { return Ok(DVec3::NAN) };
    let numbers: Vec<f64> = header.exactly(key, value, axes.sizes.len())?;
    Ok(DVec3::from_array(axes.volume.map(|axis| numbers[axis])))
}

/// Where the first voxel's centre is, in voxels from the axis' minimum: half of one where voxels are cells.
fn first_centre(header: &HeaderText, axes: &Axes) -> DVec3 {
    let Some(value) = header.get(&["centers", "centerings"]) else { return DVec3::ZERO };
    let words: Vec<&str> = value.split_whitespace().collect();
    let centre = |axis: usize| if words.get(axis) == Some(&"cell") { 0.5 } else { 0.0 };
    DVec3::from_array(axes.volume.map(centre))
}

/// Metres per unit of each axis of the space.
fn space_units_m(header: &HeaderText) -> Result<DVec3, VolumeError> {
    let names = units(header, "space units");
    let unit = |axis: usize| unit_m(header, "space units", names.get(axis));
    Ok(DVec3::new(unit(0)?, unit(1)?, unit(2)?))
}

/// Metres per unit of each axis of the volume.
fn axis_units_m(header: &HeaderText, axes: &Axes) -> Result<DVec3, VolumeError> {
    let names = units(header, "units");
    let [x, y, z] = axes.volume.map(|axis| unit_m(header, "units", names.get(axis)));
    Ok(DVec3::new(x?, y?, z?))
}

/// The names of units, which are between quotes.
fn units<'a>(header: &'a HeaderText, key: &str) -> Vec<&'a str> {
    header.get(&[key]).map_or(Vec::new(), |value| value.split('"').skip(1).step_by(2).collect())
}

fn unit_m(header: &HeaderText, key: &str, name: Option<&&str>) -> Result<f64, VolumeError> {
    Ok(match name.map_or("", |name| name.trim()) {
        "" | "???" | "mm" | "millimeter" | "millimeters" | "millimetre" => 1e-3,
        "m" | "meter" | "meters" | "metre" => 1.0,
        "cm" | "centimeter" | "centimetre" => 1e-2,
        "um" | "µm" | "μm" | "micron" | "microns" | "micrometer" | "micrometre" => 1e-6,
        "nm" | "nanometer" | "nanometre" => 1e-9,
        name => return Err(header.wrong(format!("`{key}` has the unknown unit {name:?}"))),
    })
}

//! Where the voxels of a MetaImage header lie.

use super::super::header_text::HeaderText;
use bricks::volume::{Space, VolumeError, VolumeFrame};
use glam::{DMat3, DVec3};

/// MetaImage gives no unit of length but in `DistanceUnits`; millimetres are usual and assumed.
///
/// The numbers are those of ITK's space, whose axes are left, posterior, superior where it is a patient's. ITK writes
/// `AnatomicalOrientation` for every volume, derived from the matrix; the matrix says the same with more precision, so
/// the letters only say that there is a patient. Without them (or as `???`) the space is unknown, its axes kept. With a
/// fourth axis ITK has no letters for what it writes letters for without it, and always writes `????`.
pub(super) fn frame(header: &HeaderText, axes: usize) -> Result<VolumeFrame, VolumeError> {
    let unit_m = unit_m(header)?;
    let origin = match header.get(&["offset", "position", "origin"]) {
        Some(value) => first_three(&header.exactly("Offset", value, axes)?),
        None => DVec3::ZERO,
    };
    let directions = directions(header, axes)?;
    let axes_m = directions * DMat3::from_diagonal(spacing(header, axes)? * unit_m);
    Ok(VolumeFrame { axes_m, origin_m: origin * unit_m, space: space(header, axes) })
}

/// Unit vectors along x, y, z: the matrix lists them one after the other (as SimpleITK's files show).
fn directions(header: &HeaderText, axes: usize) -> Result<DMat3, VolumeError> {
    let Some(value) = header.get(&["transformmatrix", "rotation", "orientation"]) else {
        return Ok(DMat3::IDENTITY);
    };
    let numbers: Vec<f64> = header.exactly("TransformMatrix", value, axes * axes)?;
    let direction = |axis: usize| first_three(&numbers[axis * axes..]);
    let directions = DMat3::from_cols(direction(0), direction(1), direction(2));
    // Lengths are the spacing's to say.
    let [x, y, z] = [directions.x_axis, directions.y_axis, directions.z_axis].map(DVec3::try_normalize);
    match (x, y, z) {
        (Some(x), Some(y), Some(z)) => Ok(DMat3::from_cols(x, y, z)),
        _ => Err(header.wrong(format!("`TransformMatrix` is {value:?}, which are no three directions"))),
    }
}

fn spacing(header: &HeaderText, axes: usize) -> Result<DVec3, VolumeError> {
    match header.get(&["elementspacing"]).or_else(|| header.get(&["elementsize"])) {
        Some(value) => Ok(first_three(&header.exactly("ElementSpacing", value, axes)?).abs()),
        None => Ok(DVec3::ONE),
    }
}

fn first_three(numbers: &[f64]) -> DVec3 {
    DVec3::new(numbers[0], numbers[1], numbers[2])
}

fn space(header: &HeaderText, axes: usize) -> Space {
    match header.get(&["anatomicalorientation"]) {
        Some("????") if axes == 4 => Space::Patient,
        Some(letters) if letters.contains(|letter: char| "RLAPIS".contains(letter)) => Space::Patient,
        _ => Space::Unknown,
    }
}

fn unit_m(header: &HeaderText) -> Result<f64, VolumeError> {
    Ok(match header.get(&["distanceunits"]).unwrap_or("") {
        "" | "?" | "mm" => 1e-3,
        "um" => 1e-6,
        "cm" => 1e-2,
        name => return Err(header.wrong(format!("`DistanceUnits` is the unknown unit {name:?}"))),
    })
}

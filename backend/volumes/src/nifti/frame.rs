//! Where the voxels of a NIfTI header lie.

use super::header::Header;
use bricks::volume::{Space, VolumeError, VolumeFrame};
use glam::{DMat3, DVec3};

/// Smallest 1 − b² − c² − d² of a quaternion that is taken for more than a rounding error.
const LEAST_SQUARE: f64 = 1e-7;
/// Largest b² + c² + d² that rounding to single precision makes of a unit quaternion.
const LARGEST_SQUARE: f64 = 1.0 + 1e-5;

/// By the affine map if there is one (method 3 of nifti1.h), else by the rotation (method 2), else the voxels'
/// edges alone (method 1), whose axes belong to no patient. An impossible map is ignored.
///
/// An unknown unit is taken for millimetres and an unknown length for one of them.
pub(super) fn frame(header: &Header) -> Result<VolumeFrame, VolumeError> {
    let unit_m = unit_m(header)?;
    let affine = (header.sform_code > 0).then(|| by_affine(header, unit_m));
    let rotation = (header.qform_code > 0).then(|| by_rotation(header, unit_m));
    let found = [affine, rotation].into_iter().flatten().find(VolumeFrame::is_sound);
    if found.is_none() && (header.sform_code > 0 || header.qform_code > 0) {
        tracing::warn!(path = %header.path.display(), "its orientation is flat or not a number, and is ignored");
    }
    Ok(found.unwrap_or_else(|| VolumeFrame::of_voxels(edges(header) * unit_m)))
}

fn unit_m(header: &Header) -> Result<f64, VolumeError> {
    // The other bits are the unit of time.
    match header.units & 7 {
        0 | 2 => Ok(1e-3),
        1 => Ok(1.0),
        3 => Ok(1e-6),
        code => {
            let what = format!("its unit of length has the unknown code {code}");
            Err(VolumeError::header(&header.path, what))
        }
    }
}

/// Edge lengths in the header's unit.
fn edges(header: &Header) -> DVec3 {
    let [x, y, z] = [1, 2, 3].map(|axis| match header.pixdim[axis].abs() {
        0.0 => 1.0,
        length => length,
    });
    DVec3::new(x, y, z)
}

fn by_affine(header: &Header, unit_m: f64) -> VolumeFrame {
    let column = |i: usize| DVec3::from_array(header.s_rows.map(|row| row[i]));
    patient(DMat3::from_cols(column(0), column(1), column(2)), column(3), unit_m)
}

/// The rotation of the unit quaternion a + bi + cj + dk, a ≥ 0, as nifti1.h has it; the third axis is turned round
/// where pixdim[0] is negative.
fn by_rotation(header: &Header, unit_m: f64) -> VolumeFrame {
    let mut vector = DVec3::from_array(header.quaternion);
    if vector.length_squared() > LARGEST_SQUARE {
        tracing::warn!(path = %header.path.display(), "its rotation (quatern_b, c, d) is longer than 1, and is shortened");
    }
    let mut a = 1.0 - vector.length_squared();
    if a < LEAST_SQUARE {
        vector = vector.normalize();
        a = 0.0;
    }
    let (a, [b, c, d]) = (a.sqrt(), vector.to_array());
    let rotation = DMat3::from_cols_array_2d(&[
        [a * a + b * b - c * c - d * d, 2.0 * (b * c + a * d), 2.0 * (b * d - a * c)],
        [2.0 * (b * c - a * d), a * a + c * c - b * b - d * d, 2.0 * (c * d + a * b)],
        [2.0 * (b * d + a * c), 2.0 * (c * d - a * b), a * a + d * d - b * b - c * c],
    ]);
    let third = if header.pixdim[0] < 0.0 { -1.0 } else { 1.0 };
    let lengths = edges(header) * DVec3::new(1.0, 1.0, third);
    patient(rotation * DMat3::from_diagonal(lengths), DVec3::from_array(header.q_offset), unit_m)
}

/// From NIfTI's patient axes (right, anterior, superior) to left, posterior, superior.
fn patient(axes: DMat3, origin: DVec3, unit_m: f64) -> VolumeFrame {
    let turned_m = DVec3::new(-unit_m, -unit_m, unit_m);
    VolumeFrame {
        axes_m: DMat3::from_diagonal(turned_m) * axes,
        origin_m: turned_m * origin,
        space: Space::Patient,
    }
}

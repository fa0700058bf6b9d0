//! Where the voxels of a level, or of a part of it, lie.

use super::{ExportError, ExportOptions, Part};
use bricks::BrickSource;
use bricks::volume::VolumeFrame;
use glam::{DMat3, DVec3, UVec3};

/// Every level whole, the finest first.
pub(super) fn all_levels(source: &dyn BrickSource) -> Vec<Part> {
    let depths = (0..=source.shape().finest_depth()).rev();
    depths.map(|depth| Part { depth, low: UVec3::ZERO, size: source.shape().level_dims(depth) }).collect()
}

/// The part that is asked for.
pub(super) fn part(source: &dyn BrickSource, options: &ExportOptions) -> Result<Part, ExportError> {
    let shape = source.shape();
    let level = options.level.unwrap_or(0);
    let depth = shape.finest_depth().checked_sub(level).ok_or_else(|| ExportError::Part {
        what: format!("there is no level {level}; its levels are {}", listing(source)),
    })?;
    let dims = shape.level_dims(depth);
    let low = options.low.unwrap_or(UVec3::ZERO);
    let size = options.size.unwrap_or(dims.saturating_sub(low));
    let end = [0, 1, 2].map(|axis| low[axis].checked_add(size[axis]));
    let is_inside = [0, 1, 2].iter().all(|&axis| end[axis].is_some_and(|end| end <= dims[axis]));
    match is_inside && size.min_element() > 0 {
        true => Ok(Part { depth, low, size }),
        false => Err(ExportError::Part {
            what: format!(
                "level {level} has {} voxels, and {} from {} are asked for",
                times(dims),
                times(size),
                times(low).replace(" ×", ",")
            ),
        }),
    }
}

fn listing(source: &dyn BrickSource) -> String {
    let levels = all_levels(source);
    let levels = levels.iter().enumerate().map(|(level, part)| format!("{level} ({})", times(part.size)));
    levels.collect::<Vec<_>>().join(", ")
}

fn times(n: UVec3) -> String {
    format!("{} × {} × {}", n.x, n.y, n.z)
}

/// Where a part's voxels lie. A voxel of level l is the mean of 2^l along each axis, so its centre is that of theirs.
pub(super) fn frame(source: &dyn BrickSource, part: &Part) -> VolumeFrame {
    let finest = source.frame();
    let (edge, first) = edge_and_first(source, part);
    let origin_m = finest.origin_m + finest.axes_m * first;
    VolumeFrame { axes_m: finest.axes_m * edge, origin_m, space: finest.space }
}

/// Edges of a part's voxels and the centre of its first one, metres, along the volume's own axes; from the file's
/// origin where the axes of both are the same, from the volume's first voxel elsewhere.
pub(super) fn upright(source: &dyn BrickSource, part: &Part) -> (DVec3, DVec3) {
    let finest = source.frame();
    let (edge, first) = edge_and_first(source, part);
    let size = finest.voxel_size_m();
    let origin = if is_upright(&finest) { finest.origin_m } else { DVec3::ZERO };
    (size * edge, origin + size * first)
}

/// Whether the volume's axes are those of its file's space.
pub(super) fn is_upright(frame: &VolumeFrame) -> bool {
    let size = frame.voxel_size_m();
    let difference = frame.axes_m - DMat3::from_diagonal(size);
    let largest = difference.to_cols_array().into_iter().fold(0.0, |most: f64, entry| most.max(entry.abs()));
    largest < 1e-6 * size.min_element()
}

/// Edge of a part's voxels, and centre of its first one from that of the first finest one, in finest voxels.
fn edge_and_first(source: &dyn BrickSource, part: &Part) -> (f64, DVec3) {
    let edge = f64::from(1u32 << source.shape().level(part.depth));
    (edge, part.low.as_dvec3() * edge + (edge - 1.0) / 2.0)
}

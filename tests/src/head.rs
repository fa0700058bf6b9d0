//! A head as a scanner gives it, at any size: for benchmarks, which need more voxels than the real ones have.

use glam::{DVec3, UVec3};

/// The value in Hounsfield units at a voxel of a volume of `dims`: skin, a skull with sutures, tissue with folds, and a
/// scanner's noise.
pub fn head(voxel: UVec3, dims: UVec3) -> i16 {
    let p = (voxel.as_dvec3() + 0.5) / dims.as_dvec3() * 2.0 - 1.0;
    let r = (p / DVec3::new(0.78, 0.9, 0.95)).length();
    let value = match r {
        r if r > 1.0 => -1000.0,
        r if r > 0.93 => 20.0 + 60.0 * folds(p),
        r if r > 0.84 => 900.0 + 500.0 * (40.0 * (p.y + 0.2 * (12.0 * p.x).sin())).cos().abs(),
        _ => 35.0 + 25.0 * folds(p),
    };
    let hash = (voxel.x ^ voxel.y.rotate_left(11) ^ voxel.z.rotate_left(22)).wrapping_mul(2_654_435_761);
    (value + 30.0 * (f64::from(hash >> 8) / f64::from(1u32 << 24) - 0.5)) as i16
}

fn folds(p: DVec3) -> f64 {
    (24.0 * p.x + 3.0 * (9.0 * p.y).sin()).sin() * (20.0 * p.y + 4.0 * (7.0 * p.z).cos()).cos()
}

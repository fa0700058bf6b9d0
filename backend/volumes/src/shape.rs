//! Which numbers of a file's array are the volume.

use bricks::volume::MAX_EDGE_VOXELS;
use glam::UVec3;

/// Numbers of the largest array: the largest number has 8 bytes, and their count must be below 2⁶⁴.
const MOST_NUMBERS: u64 = 1 << 60;

/// What an axis of a file's array is to the volume.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Axis {
    /// One of its three axes.
    Volume,
    /// An axis of which one place was chosen.
    At(u32),
}

/// Where the volume's numbers lie in an array, counted in numbers.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Shape {
    /// Voxels along x, y, z; each from 1 to [`MAX_EDGE_VOXELS`].
    pub dims: UVec3,
    /// Numbers before the first voxel.
    pub first: u64,
    /// From a voxel to the next along x, y, z.
    pub strides: [u64; 3],
    /// Numbers of the whole array.
    pub numbers: u64,
}

impl Shape {
    /// An array of these sizes, fastest axis first; three of its axes must be the volume's. What is wrong comes back
    /// as the end of a sentence.
    pub fn new(axes: &[(i64, Axis)]) -> Result<Self, String> {
        check_sizes(axes)?;
        let mut shape = Self { dims: UVec3::ONE, first: 0, strides: [0; 3], numbers: 1 };
        let mut volume_axes = 0;
        for &(size, axis) in axes {
            let numbers = shape.numbers.checked_mul(size as u64).ok_or_else(|| too_many(axes))?;
            match axis {
                Axis::At(place) => shape.first += u64::from(place) * shape.numbers,
                Axis::Volume => {
                    let slot = shape.strides.get_mut(volume_axes).ok_or("it has more than three axes")?;
                    *slot = shape.numbers;
                    shape.dims[volume_axes] = size as u32;
                    volume_axes += 1;
                }
            }
            shape.numbers = numbers;
        }
        match volume_axes {
            3 if shape.numbers <= MOST_NUMBERS => Ok(shape),
            3 => Err(too_many(axes)),
            _ => Err("it has fewer than three axes".into()),
        }
    }

    /// A volume and nothing else.
    pub fn of_volume(dims: [i64; 3]) -> Result<Self, String> {
        Self::new(&dims.map(|size| (size, Axis::Volume)))
    }

    /// Whether the numbers of a slab follow each other.
    pub fn has_dense_slabs(&self) -> bool {
        self.strides[0] == 1 && self.strides[1] == u64::from(self.dims.x)
    }
}

fn check_sizes(axes: &[(i64, Axis)]) -> Result<(), String> {
    let is_wrong = |size: i64| !(1..=i64::from(MAX_EDGE_VOXELS)).contains(&size);
    if axes.iter().any(|&(size, _)| is_wrong(size)) {
        let sizes = sizes(axes);
        return Err(format!("the dimensions are {sizes}, and each must be from 1 to {MAX_EDGE_VOXELS}"));
    }
    Ok(())
}

fn too_many(axes: &[(i64, Axis)]) -> String {
    format!("the dimensions are {}, which is more than a file can hold", sizes(axes))
}

fn sizes(axes: &[(i64, Axis)]) -> String {
    axes.iter().map(|(size, _)| size.to_string()).collect::<Vec<_>>().join(" × ")
}

#[cfg(test)]
mod tests {
    use super::*;
    use Axis::{At, Volume};

    #[test]
    fn strides_skip_what_was_not_chosen() {
        let shape = Shape::new(&[(3, At(2)), (5, Volume), (6, Volume), (4, Volume), (7, At(1))]).unwrap();
        assert_eq!((shape.dims, shape.first), (UVec3::new(5, 6, 4), 2 + 3 * 120));
        assert_eq!((shape.strides, shape.numbers), ([3, 15, 90], 3 * 120 * 7));
        assert!(!shape.has_dense_slabs());
        assert!(Shape::of_volume([5, 6, 4]).unwrap().has_dense_slabs());
    }

    #[test]
    fn sizes_that_cannot_be_are_refused() {
        let edge = i64::from(MAX_EDGE_VOXELS);
        assert!(Shape::of_volume([edge; 3]).is_ok());
        assert!(Shape::of_volume([edge, edge, edge + 1]).is_err());
        assert!(Shape::of_volume([5, -1, 2]).is_err());
        assert!(Shape::new(&[(edge, Volume), (edge, Volume), (edge, Volume), (2, At(0))]).is_err());
        let last = At(MAX_EDGE_VOXELS - 1);
        assert!(Shape::new(&[(edge, Volume), (edge, Volume), (edge, Volume), (edge, last)]).is_err());
        assert!(Shape::new(&[(5, Volume), (5, Volume)]).is_err());
        assert!(Shape::new(&[(5, Volume); 4]).is_err());
    }
}

//! A trilinear cell: the cube between eight neighbouring samples of a brick.

use super::{Cubic, cut::Voxels};
use bricks::{BRICK_EDGE, Brick};
use glam::{DVec3, IVec3};

/// Strides of the codes along x, y and z.
const STRIDES: [usize; 3] = [1, BRICK_EDGE, BRICK_EDGE * BRICK_EDGE];

/// A cell of a brick, with the straight path through it from `enter` to `leave`, both in [0, 1]³.
pub struct Cell<'a> {
    voxels: &'a Voxels,
    first: usize,
    enter: DVec3,
    leave: DVec3,
}

impl<'a> Cell<'a> {
    /// The cell whose low corner is stored sample `low`, clamped so that gradients stay inside the brick.
    pub fn new(voxels: &'a Voxels, low: IVec3, enter: DVec3, leave: DVec3) -> Self {
        let low = low.clamp(IVec3::ONE, IVec3::splat(BRICK_EDGE as i32 - 3)).as_uvec3();
        let first = Brick::index(low.x as usize, low.y as usize, low.z as usize);
        let unit = |p: DVec3| p.clamp(DVec3::ZERO, DVec3::ONE);
        Self { voxels, first, enter: unit(enter), leave: unit(leave) }
    }

    /// The data value along the way.
    pub fn value(&self) -> Cubic {
        let codes = &self.voxels.codes;
        let corners = self.corners(|index| f64::from(codes[index]));
        along(corners, self.enter, self.leave).scaled(self.voxels.low, self.voxels.step)
    }

    /// The standard deviation along the way of what the values stand for.
    pub fn deviation(&self) -> Option<Cubic> {
        let deviation = self.voxels.deviation.as_ref()?;
        let corners = self.corners(|index| f64::from(deviation.codes[index]));
        Some(along(corners, self.enter, self.leave).scaled(0.0, f64::from(deviation.step)))
    }

    /// The gradient along the way, per finest voxel: trilinear central differences over one voxel of `voxel_edge`
    /// finest voxels on each side.
    pub fn gradient(&self, voxel_edge: f64) -> [Cubic; 3] {
        let codes = &self.voxels.codes;
        STRIDES.map(|stride| {
            let corners = self.corners(|i| f64::from(codes[i + stride]) - f64::from(codes[i - stride]));
            along(corners, self.enter, self.leave).scaled(0.0, self.voxels.step / (2.0 * voxel_edge))
        })
    }

    fn corners(&self, value: impl Fn(usize) -> f64) -> [f64; 8] {
        std::array::from_fn(|corner| {
            let offset = (0..3).map(|axis| (corner >> axis & 1) * STRIDES[axis]).sum::<usize>();
            value(self.first + offset)
        })
    }
}

/// A trilinear function along a straight path is a cubic: its Bernstein coefficients are the means, over the corners of
/// the box spanned by `enter` and `leave`, of those with 0, 1, 2 or 3 coordinates of `leave`.
fn along(mut f: [f64; 8], enter: DVec3, leave: DVec3) -> Cubic {
    for axis in 0..3 {
        let (from, to) = (enter[axis], leave[axis]);
        for low in (0..8).filter(|corner| corner >> axis & 1 == 0) {
            let high = low | 1 << axis;
            let (a, b) = (f[low], f[high]);
            f[low] = (1.0 - from) * a + from * b;
            f[high] = (1.0 - to) * a + to * b;
        }
    }
    Cubic([f[0], (f[1] + f[2] + f[4]) / 3.0, (f[3] + f[5] + f[6]) / 3.0, f[7]])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_trilinear_function_is_its_cubic() {
        let f = [0.3, -1.0, 2.0, 0.7, 5.0, -2.5, 0.1, 1.9];
        let (enter, leave) = (DVec3::new(0.1, 0.9, 0.0), DVec3::new(0.8, 0.2, 1.0));
        let cubic = along(f, enter, leave);
        for step in 0..=10 {
            let u = f64::from(step) / 10.0;
            let p = enter.lerp(leave, u);
            let weight =
                |corner: usize, axis: usize| if corner >> axis & 1 == 1 { p[axis] } else { 1.0 - p[axis] };
            let exact: f64 = (0..8).map(|c| f[c] * weight(c, 0) * weight(c, 1) * weight(c, 2)).sum();
            assert!((cubic.at(u) - exact).abs() < 1e-14);
        }
    }
}

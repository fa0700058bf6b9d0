//! What a display resolves: the smallest thing that it shows, by depth.

use glam::DAffine3;

/// The resolution of a display, s(z) = s0 + 2 |z| tan(Φ/2) (LFD section 4).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Resolution {
    /// s0: pixel size on the screen, metres.
    pub pixel_size_m: f64,
    /// Φ: angular accuracy, radians.
    pub angular_accuracy: f64,
}

impl Resolution {
    /// s(z): the size of the smallest thing that is shown at depth z, metres.
    pub fn at(&self, z_m: f64) -> f64 {
        self.pixel_size_m + self.slope() * z_m.abs()
    }

    /// 2 tan(Φ/2): how s grows over |z|, metres per metre.
    pub fn slope(&self) -> f64 {
        2.0 * (0.5 * self.angular_accuracy).tan()
    }
}

/// The longest edge of a volume's finest voxel in its place, metres.
pub fn longest_voxel_edge_m(display_from_volume: &DAffine3) -> f64 {
    let linear = display_from_volume.matrix3;
    linear.x_axis.length().max(linear.y_axis.length()).max(linear.z_axis.length())
}

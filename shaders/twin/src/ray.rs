//! The ray of a projector pixel (LFD eq. 1), seen from the volume.

use super::{ProjectorRays, Real, SceneNumbers, real::Number, vector::Vec3};

/// Stands for infinity, as in the kernel.
pub(super) const FAR: f64 = 1e30;
/// Slower than this along an axis (voxels per metre), a ray counts as parallel to it.
const PARALLEL: f64 = 1e-12;

/// See `Ray` in `wgsl/ray.wgsl`.
#[derive(Clone, Copy, Debug)]
pub struct Ray<F> {
    /// Where the ray meets the screen; t = 0 there.
    pub origin_in_volume: Vec3<F>,
    /// Voxels per metre.
    pub direction_in_volume: Vec3<F>,
    /// Metres per voxel along each axis.
    pub inverse: Vec3<F>,
    /// The same place, metres.
    pub origin_in_display: Vec3<F>,
    /// The same direction, a unit vector.
    pub direction_in_display: Vec3<F>,
    /// t of the ray's start on the observer's line.
    pub start: F,
    /// t of its end, beyond which nothing is looked at.
    pub end: F,
    /// Voxels per metre of t.
    pub speed: F,
}

/// A straight way, display frame, of one ray or of eight side by side.
#[derive(Clone, Copy, Debug)]
pub struct Line<F> {
    /// Where t is 0, metres.
    pub origin: Vec3<F>,
    /// A unit vector.
    pub direction: Vec3<F>,
}

impl<F: Number> Line<F> {
    /// The point at t.
    #[inline(always)]
    pub fn point(&self, t: F) -> Vec3<F> {
        self.origin + self.direction * t
    }

    /// t where `normal` · point = `offset`; far where the way is parallel to that plane.
    #[inline(always)]
    pub fn plane_crossing(&self, normal: Vec3<F>, offset: F) -> F {
        let speed = normal.dot(self.direction);
        let crossing = (offset - normal.dot(self.origin)) / speed;
        speed.abs().choose(speed.alike(PARALLEL), speed.alike(FAR), crossing)
    }
}

impl<F: Real> Ray<F> {
    /// The ray through a point of the raster, in pixels.
    #[inline(always)]
    pub fn of_pixel(scene: &SceneNumbers<F>, rays: &ProjectorRays<F>, x: F, y: F) -> Self {
        let h = &rays.screen_from_pixel;
        let on_screen = h[0] * x + h[1] * y + h[2];
        let screen = Vec3([on_screen.0[0] / on_screen.0[2], on_screen.0[1] / on_screen.0[2], F::ZERO]);
        let beam = rays.beam;
        let origin = Vec3([beam[0] + beam[1] * screen.0[0], beam[2], beam[3]]);
        let toward = screen - origin;
        let reach = toward.length();
        let m = &scene.volume_from_display;
        let ray = Self {
            origin_in_volume: m[0] * screen.0[0] + m[1] * screen.0[1] + m[3],
            direction_in_volume: Vec3::ZERO,
            inverse: Vec3::ZERO,
            origin_in_display: screen,
            direction_in_display: Vec3::ZERO,
            start: -reach,
            end: F::of(FAR),
            speed: F::ZERO,
        };
        ray.turned(scene, toward.map(|c| c / reach))
    }

    /// A ray from the same origin along another unit vector.
    #[inline(always)]
    pub fn turned(self, scene: &SceneNumbers<F>, direction_in_display: Vec3<F>) -> Self {
        let (m, v) = (&scene.volume_from_display, direction_in_display);
        let direction_in_volume = m[0] * v.0[0] + m[1] * v.0[1] + m[2] * v.0[2];
        Self {
            direction_in_volume,
            inverse: direction_in_volume
                .map(|d| if d.abs() < F::of(PARALLEL) { F::of(FAR) } else { F::ONE / d }),
            direction_in_display: v,
            speed: direction_in_volume.length(),
            ..self
        }
    }

    /// Whether the ray never crosses a plane across `axis`.
    #[inline(always)]
    pub fn is_parallel(&self, axis: usize) -> bool {
        self.direction_in_volume.0[axis].abs() < F::of(PARALLEL)
    }

    /// Whether the ray goes toward larger coordinates along `axis`.
    #[inline(always)]
    pub fn is_forward(&self, axis: usize) -> bool {
        self.direction_in_volume.0[axis] >= F::ZERO
    }

    /// The point at t.
    #[inline(always)]
    pub fn point(&self, t: F) -> Vec3<F> {
        self.origin_in_volume + self.direction_in_volume * t
    }

    /// The point at t, metres.
    #[inline(always)]
    pub fn point_in_display(&self, t: F) -> Vec3<F> {
        self.line().point(t)
    }

    /// The same ray, display frame.
    #[inline(always)]
    pub fn line(&self) -> Line<F> {
        Line { origin: self.origin_in_display, direction: self.direction_in_display }
    }

    /// The same ray as far as t.
    #[inline(always)]
    pub fn until(self, end: F) -> Self {
        Self { end, ..self }
    }

    /// The part of the ray inside the volume; empty if the first is not below the second.
    #[inline(always)]
    pub fn clip_to_volume(&self, dims: Vec3<F>) -> (F, F) {
        let (mut enter, mut leave) = (self.start, self.end);
        for axis in 0..3 {
            let (origin, high) = (self.origin_in_volume.0[axis], dims.0[axis]);
            if self.is_parallel(axis) {
                if origin < F::ZERO || origin > high {
                    return (F::of(FAR), F::of(-FAR));
                }
            } else {
                let a = (F::ZERO - origin) * self.inverse.0[axis];
                let b = (high - origin) * self.inverse.0[axis];
                enter = enter.most(a.least(b));
                leave = leave.least(a.most(b));
            }
        }
        (enter, leave)
    }
}

/// Larger than any t that occurs.
#[inline(always)]
pub fn far<F: Real>() -> F {
    F::of(FAR)
}

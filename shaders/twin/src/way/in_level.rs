//! Eight straight paths through the samples of a level, side by side: each as [`Level`] computes it alone.

use super::segments::RAYS;
use crate::Casting;
use crate::four::{between_corners, mix};
use crate::levels::Level;
use crate::real::Number;
use crate::sample::{EDGE, LAYER, PER_CODE, PER_DEVIATION, ROW, pair};
use crate::vector::Vec3;
use lanes::*;
use layout::brick::VOXELS;

/// Where paths lie in the samples of a level, one after another.
#[derive(Default)]
pub(super) struct LaidInLevel {
    base: [[f32; RAYS]; 3],
    slope: [[f32; RAYS]; 3],
}

impl LaidInLevel {
    /// Lays a path.
    #[inline(always)]
    pub(super) fn lay(&mut self, lane: usize, level: &Level<f32>) {
        for axis in 0..3 {
            self.base[axis][lane] = level.base.0[axis];
            self.slope[axis][lane] = level.slope.0[axis];
        }
    }
}

/// Paths in the samples of a level.
pub(super) struct PathsInLevel<'a, S: Simd> {
    codes: &'a [u16; VOXELS],
    code_range: [f32; 2],
    gradient_scale: f32,
    deviations: Option<(&'a [u8; VOXELS], f32)>,
    base: [f32x8<S>; 3],
    /// Texels per metre of t.
    pub(super) slope: [f32x8<S>; 3],
}

/// Points between samples: the lowest neighbour of each, and how far it lies from there.
struct Between<S: Simd> {
    base: [i32; RAYS],
    part: [f32x8<S>; 3],
}

impl<'a, S: Simd> PathsInLevel<'a, S> {
    #[inline(always)]
    pub(super) fn new(simd: S, level: &Level<'a, f32>, laid: &LaidInLevel) -> Self {
        Self {
            codes: level.codes,
            code_range: level.code_range(),
            gradient_scale: level.gradient_scale,
            deviations: level.deviations,
            base: each!(axis of 3 => load(simd, &laid.base[axis], 0)),
            slope: each!(axis of 3 => load(simd, &laid.slope[axis], 0)),
        }
    }

    #[inline(always)]
    pub(super) fn point(&self, t: f32x8<S>) -> [f32x8<S>; 3] {
        each!(axis of 3 => self.base[axis] + self.slope[axis] * t)
    }

    /// Points whose lowest neighbours are at least `first` texels from either end of the brick.
    #[inline(always)]
    fn place(&self, t: f32x8<S>, first: i32) -> Between<S> {
        let simd = t.token();
        let point = self.point(t);
        let shifted = each!(axis of 3 => point[axis] - t.alike(0.5));
        let lowest = each!(axis of 3 => {
            let whole: i32x8<S> = shifted[axis].to_int();
            whole.min(i32x8::splat(simd, EDGE as i32 - 2 - first)).max(i32x8::splat(simd, first))
        });
        let part = each!(axis of 3 => {
            let whole: f32x8<S> = lowest[axis].to_float();
            shifted[axis] - whole
        });
        let edge = i32x8::splat(simd, EDGE as i32);
        Between { base: ((lowest[2] * edge + lowest[1]) * edge + lowest[0]).to_array(), part }
    }

    /// The scalars at `t`, not held to [0, 1]: see [`Level::scalar`] and [`crate::sample::sample_brick`].
    #[inline(always)]
    pub(super) fn scalars(&self, t: f32x8<S>) -> f32x8<S> {
        let Between { base, part } = self.place(t, 0);
        let windows = eight!(L => &self.codes[base[L] as usize..base[L] as usize + LAYER + ROW + 2]);
        let along_x = each!(corner of 4 => {
            let offset = [0, ROW, LAYER, LAYER + ROW][corner];
            let [low, high] = halves(t.token(), eight!(L => pair(windows[L], offset) as i32));
            low + (high - low) * part[0]
        });
        let sample = between_corners(along_x, part[1], part[2]) * t.alike(PER_CODE);
        let [offset, scale] = self.code_range;
        splat(t.token(), offset) + splat(t.token(), scale) * sample
    }

    /// The changes of the scalar over a finest voxel, at `t`, display frame: see `gradient::gradient_in` and
    /// [`crate::sample::differences`].
    #[inline(always)]
    pub(super) fn gradients(&self, casting: &Casting<f32>, t: f32x8<S>) -> Vec3<f32x8<S>> {
        let simd = t.token();
        let Between { base, part } = self.place(t, 1);
        const AROUND: usize = LAYER + ROW + 1;
        let windows = eight!(L => {
            let first = base[L] as usize - AROUND;
            &self.codes[first..first + 3 * LAYER + 3 * ROW + 4]
        });
        macro_rules! codes {
            ($offset:expr) => {{
                let offset = $offset;
                let codes: f32x8<S> =
                    i32x8::load_array(simd, eight!(L => i32::from(windows[L][offset]))).to_float();
                codes
            }};
        }
        // Row (j, k) of the 4 × 4 around the point, each from −1 to 2, at its nearer x neighbours.
        macro_rules! row {
            ($j:expr, $k:expr) => {{
                let offset = $k * LAYER + $j * ROW + 1;
                halves(simd, eight!(L => pair(windows[L], offset) as i32))
            }};
        }
        let inner = [row!(1, 1), row!(2, 1), row!(1, 2), row!(2, 2)];
        let back = [
            codes!(AROUND - 1),
            codes!(AROUND + ROW - 1),
            codes!(AROUND + LAYER - 1),
            codes!(2 * AROUND - 2),
        ];
        let front = [
            codes!(AROUND + 2),
            codes!(AROUND + ROW + 2),
            codes!(AROUND + LAYER + 2),
            codes!(2 * AROUND + 1),
        ];
        let x = mix(each!(c of 4 => inner[c][1] - back[c]), each!(c of 4 => front[c] - inner[c][0]), part[0]);
        let y_back = ahead_less_behind([inner[1], inner[3]], [row!(0, 1), row!(0, 2)]);
        let y_front = ahead_less_behind([row!(3, 1), row!(3, 2)], [inner[0], inner[2]]);
        let y = mix(y_back, y_front, part[1]);
        let z_back = ahead_less_behind([inner[2], inner[3]], [row!(1, 0), row!(2, 0)]);
        let z_front = ahead_less_behind([row!(1, 3), row!(2, 3)], [inner[0], inner[1]]);
        let z = mix(z_back, z_front, part[2]);
        let scale = t.alike(PER_CODE);
        let differences = Vec3([
            between_corners(x, part[1], part[2]) * scale,
            between_corners(y, part[0], part[2]) * scale,
            between_corners(z, part[0], part[1]) * scale,
        ]);
        let in_volume = differences * splat(simd, self.gradient_scale);
        let m = &casting.scene.volume_from_display;
        let in_display = Vec3(each!(axis of 3 => {
            Vec3(each!(c of 3 => splat(simd, m[axis].0[c]))).dot(in_volume)
        }));
        in_display * splat(simd, casting.scene.voxel_m)
    }

    /// The standard deviations of what samples at `t` stand for: see [`Level::spread`].
    #[inline(always)]
    pub(super) fn spreads(&self, t: f32x8<S>) -> f32x8<S> {
        let Some((codes, scale)) = self.deviations else { return t.alike(0.0) };
        let Between { base, part } = self.place(t, 0);
        let windows = eight!(L => &codes[base[L] as usize..base[L] as usize + LAYER + ROW + 2]);
        let along_x = each!(corner of 4 => {
            let offset = [0, ROW, LAYER, LAYER + ROW][corner];
            let low = i32x8::load_array(t.token(), eight!(L => i32::from(windows[L][offset])));
            let high = i32x8::load_array(t.token(), eight!(L => i32::from(windows[L][offset + 1])));
            let (low, high): (f32x8<S>, f32x8<S>) = (low.to_float(), high.to_float());
            low + (high - low) * part[0]
        });
        splat(t.token(), scale) * (between_corners(along_x, part[1], part[2]) * t.alike(PER_DEVIATION))
    }
}

/// Differences of two pairs of neighbours along x: see `sample::ahead_less_behind`.
#[inline(always)]
fn ahead_less_behind<S: Simd>(ahead: [[f32x8<S>; 2]; 2], behind: [[f32x8<S>; 2]; 2]) -> [f32x8<S>; 4] {
    [
        ahead[0][0] - behind[0][0],
        ahead[0][1] - behind[0][1],
        ahead[1][0] - behind[1][0],
        ahead[1][1] - behind[1][1],
    ]
}

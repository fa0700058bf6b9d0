//! What a view gathers along the rays of one row.

use crate::Fan;
use crate::blocks::Blocks;
use crate::slab::LANES;
use crate::steep::Pixels;
use glam::DAffine3;
use lanes::*;

/// What a view has gathered along the rays of a row.
#[derive(Clone, Debug, Default)]
pub(crate) struct ViewRow {
    /// Premultiplied red, green and blue, then opacity, each for all pixels.
    pub(crate) rgba: [Vec<f32>; 4],
    /// The largest importance so far, where the scene accumulates any.
    pub(crate) importance: Vec<f32>,
    /// Metres of each ray per metre of depth.
    pub(crate) lengths: Vec<f32>,
    /// Half-way between the light and the eye, unit vectors, each coordinate for all pixels; empty where no light falls.
    pub(crate) halfway: [Vec<f32>; 3],
    /// z at which each ray enters the volume and leaves it, once they are needed.
    pub(crate) ends: [Vec<f32>; 2],
    /// Blocks of pixels that see farther.
    pub(crate) open: Blocks,
}

impl ViewRow {
    pub(crate) fn begin(&mut self, fan: &Fan, view: usize, row: u32, toward_light: Option<[f32; 3]>) {
        let padded = (fan.raster[0] as usize).next_multiple_of(LANES);
        for channel in &mut self.rgba {
            channel.clear();
            channel.resize(padded, 0.0);
        }
        self.importance.clear();
        self.importance.resize(padded, 0.0);
        self.lengths.resize(padded, 0.0);
        fan.lengths(view, row, &mut self.lengths);
        if let Some(light) = toward_light {
            let [x, y, z] = &mut self.halfway;
            for list in [&mut *x, &mut *y, &mut *z] {
                list.resize(padded, 0.0);
            }
            for i in 0..padded {
                let direction = fan.direction(view, row, i);
                let way = [light[0] - direction[0], light[1] - direction[1], light[2] - direction[2]];
                let square = way[0] * way[0] + way[1] * way[1] + way[2] * way[2];
                // A ray straight along the light has no half-way direction.
                let per_length = if square > 1e-12 { 1.0 / square.sqrt() } else { 0.0 };
                (x[i], y[i], z[i]) = (way[0] * per_length, way[1] * per_length, way[2] * per_length);
            }
        }
        let [from, to] = fan.looked_at(view, row);
        self.open.fill(padded / LANES, from / LANES..to.div_ceil(LANES));
    }
}

impl ViewRow {
    /// What eight pixels have gathered.
    #[inline(always)]
    pub(crate) fn pixels<S: Simd>(&self, simd: S, at: usize) -> Pixels<S> {
        let [r, g, b, alpha] = each!(c of 4 => load(simd, &self.rgba[c], at));
        [r, g, b, splat(simd, 1.0) - alpha]
    }

    #[inline(always)]
    pub(crate) fn keep<S: Simd>(&mut self, [r, g, b, visible]: Pixels<S>, at: usize) {
        let alpha = splat(visible.simd, 1.0) - visible;
        for (channel, value) in self.rgba.iter_mut().zip([r, g, b, alpha]) {
            value.store_slice(&mut channel[at..at + LANES]);
        }
    }

    /// Finds where rays enter and leave a volume of `dims` voxels.
    #[inline(always)]
    pub(crate) fn find_ends(
        &mut self,
        fan: &Fan,
        (view, row): (usize, u32),
        volume_from_display: &DAffine3,
        dims: [f32; 3],
    ) {
        let m = volume_from_display.matrix3;
        let y = [fan.screen_y(row), fan.y_slope(row)];
        let [first, each] = fan.lines(view);
        let padded = self.lengths.len();
        let [enter, leave] = &mut self.ends;
        enter.clear();
        enter.resize(padded, f32::MAX);
        leave.clear();
        leave.resize(padded, f32::MIN);
        for (axis, &high) in dims.iter().enumerate() {
            let [mx, my, mz] = [m.x_axis[axis], m.y_axis[axis], m.z_axis[axis]];
            // The coordinate at z = 0 and its change per metre of depth, both of pixel 0 and what each further one adds.
            let origin = [mx * first[0] + my * y[0] + volume_from_display.translation[axis], mx * each[0]];
            let slope = [mx * first[1] + my * y[1] + mz, mx * each[1]];
            let high = f64::from(high);
            for (i, (enter, leave)) in enter.iter_mut().zip(leave.iter_mut()).enumerate() {
                let i = i as f64;
                let (o, d) = (origin[0] + origin[1] * i, slope[0] + slope[1] * i);
                let (a, b) = (-o / d, (high - o) / d);
                // A ray along the faces is between them or not.
                let is_along = d.abs() < 1e-9;
                let (near, far) = if is_along && o >= 0.0 && o <= high {
                    (f64::MAX, f64::MIN)
                } else if is_along {
                    (f64::MIN, f64::MAX)
                } else {
                    (a.max(b), a.min(b))
                };
                *enter = enter.min(near as f32);
                *leave = leave.max(far as f32);
            }
        }
    }
}

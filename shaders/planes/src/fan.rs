//! The geometry that the rows of some views share.

use crate::raster::{Footprint, RasterWarp};
use layout::FanBlock;
use twin::ProjectorRays;

/// Views whose rows lie in the same planes and differ by a shift alone.
///
/// With m = z / Vz a ray of the view with offset A through screen column Sx is at x(z) = Sx (1 − m + B m) + A m, and a ray
/// through row Sy at y(z) = Sy + (Vy − Sy) m. So columns of pitch p (1 − m + B m), p being that of the pixels, are met by every
/// view alike, A m / (p (1 − m + B m)) of them apart.
#[derive(Clone, Debug)]
pub struct Fan {
    /// Screen x of pixel 0's left edge, and metres per pixel to the right.
    x: [f64; 2],
    /// Screen y of row 0's edge, and metres per row.
    y: [f64; 2],
    /// B.
    slope: f64,
    /// Vy and Vz.
    observer: [f64; 2],
    /// A of each view.
    pub(crate) offsets: Vec<f64>,
    /// The part of the raster that each view looks at; None for all of it.
    footprints: Vec<Option<Footprint>>,
    /// The rays of each view.
    pub(crate) rays: Vec<ProjectorRays<f32>>,
    /// The number of each view among all.
    pub views: Vec<usize>,
    /// Pixels of a row, and rows.
    pub raster: [u32; 2],
}

/// The grid at one depth.
#[derive(Clone, Copy, Debug)]
pub(crate) struct AtDepth {
    pub(crate) z: f64,
    /// z / Vz.
    m: f64,
    /// 1 − m + B m.
    scale: f64,
}

impl Fan {
    /// Of views of the same raster, which is level, and of the same beams but for A; these are their numbers, and the ways from the
    /// raster to their own.
    ///
    /// # Errors
    /// Their projectors do not lie behind the screen.
    pub(crate) fn of(
        rays: Vec<ProjectorRays<f32>>,
        warps: Vec<Option<RasterWarp>>,
        views: Vec<usize>,
    ) -> Result<Self, &'static str> {
        let [across, down, corner] = rays[0].screen_from_pixel.map(|column| column.0.map(f64::from));
        let [_, slope, observer_y, observer_z] = rays[0].beam.map(f64::from);
        if slope <= 0.0 {
            return Err("their projectors do not lie behind the screen");
        }
        Ok(Self {
            x: [corner[0], across[0]],
            y: [corner[1], down[1]],
            slope,
            observer: [observer_y, observer_z],
            offsets: rays.iter().map(|view| f64::from(view.beam[0])).collect(),
            footprints: warps.iter().map(|warp| warp.as_ref().map(RasterWarp::footprint)).collect(),
            raster: rays[0].raster,
            rays,
            views,
        })
    }

    /// Those of its views that are among some, numbered as these are.
    pub(crate) fn only(&self, some: &[usize]) -> Self {
        let number = |view: &usize| some.iter().position(|known| known == view);
        let mut kept: Vec<(usize, usize)> =
            self.views.iter().enumerate().filter_map(|(i, view)| Some((number(view)?, i))).collect();
        kept.sort_unstable();
        Self {
            offsets: kept.iter().map(|&(_, i)| self.offsets[i]).collect(),
            footprints: kept.iter().map(|&(_, i)| self.footprints[i].clone()).collect(),
            rays: kept.iter().map(|&(_, i)| self.rays[i]).collect(),
            views: kept.iter().map(|&(number, _)| number).collect(),
            ..self.clone()
        }
    }

    /// The pixels of a row that a view looks at, from the first to before the last.
    pub(crate) fn looked_at(&self, view: usize, row: u32) -> [usize; 2] {
        let [width, _] = self.raster.map(|pixels| pixels as usize);
        match &self.footprints[view] {
            None => [0, width],
            Some(footprint) => match footprint.columns(row) {
                Some(columns) => columns.map(|column| (column.max(0.0) as usize).min(width)),
                None => [0, 0],
            },
        }
    }

    /// What kernels are told of the grid.
    pub(crate) fn block(&self) -> FanBlock {
        FanBlock {
            raster: [self.x[0], self.x[1], self.y[0], self.y[1]].map(|c| c as f32),
            way: [self.slope, self.observer[0], self.observer[1]].map(|c| c as f32),
            views: self.offsets.len() as u32,
            ..FanBlock::default()
        }
    }

    /// A of each view.
    pub fn offsets(&self) -> impl Iterator<Item = f32> + '_ {
        self.offsets.iter().map(|&offset| offset as f32)
    }

    /// Whether the grid goes as far from the viewers as z.
    pub fn reaches(&self, z: f64) -> bool {
        z > self.depths().0
    }

    pub(crate) fn at(&self, z: f64) -> AtDepth {
        let m = z / self.observer[1];
        AtDepth { z, m, scale: 1.0 - m + self.slope * m }
    }

    /// Screen y of a row's middle.
    pub(crate) fn screen_y(&self, row: u32) -> f64 {
        self.y[0] + (f64::from(row) + 0.5) * self.y[1]
    }

    /// The row, as a fraction, whose plane a point of the display frame lies in. None behind the observer.
    pub(crate) fn row_of(&self, y: f64, z: f64) -> Option<f64> {
        let m = z / self.observer[1];
        let screen_y = (y - self.observer[0] * m) / (1.0 - m);
        (m < 1.0 - 1e-9).then(|| (screen_y - self.y[0]) / self.y[1] - 0.5)
    }

    /// y of a row's plane at a depth.
    pub(crate) fn y_at(&self, row: u32, depth: &AtDepth) -> f64 {
        let screen_y = self.screen_y(row);
        screen_y + (self.observer[0] - screen_y) * depth.m
    }

    /// dy/dz in a row's plane.
    pub(crate) fn y_slope(&self, row: u32) -> f64 {
        (self.observer[0] - self.screen_y(row)) / self.observer[1]
    }

    /// dx/dz of a pixel's ray.
    fn x_slope(&self, view: usize, pixel: usize) -> f64 {
        let screen_x = self.x[0] + self.x[1] * (pixel as f64 + 0.5);
        ((self.slope - 1.0) * screen_x + self.offsets[view]) / self.observer[1]
    }

    /// Metres per column at a depth.
    pub(crate) fn pitch(&self, depth: &AtDepth) -> f64 {
        self.x[1] * depth.scale
    }

    /// x of column `u`, in pixels of a view without offset.
    pub(crate) fn x_of(&self, u: f64, depth: &AtDepth) -> f64 {
        (self.x[0] + self.x[1] * u) * depth.scale
    }

    /// The inverse of [`Self::x_of`].
    pub(crate) fn column_of(&self, x: f64, depth: &AtDepth) -> f64 {
        (x / depth.scale - self.x[0]) / self.x[1]
    }

    /// Columns from a pixel of view `view` to where it meets the grid.
    pub(crate) fn shift(&self, view: usize, depth: &AtDepth) -> f64 {
        self.offsets[view] * depth.m / (self.x[1] * depth.scale)
    }

    /// The columns that any view meets.
    pub(crate) fn seen(&self, depth: &AtDepth) -> (f64, f64) {
        let shifts = (0..self.offsets.len()).map(|view| self.shift(view, depth));
        let (low, high) = shifts.fold((f64::MAX, f64::MIN), |(low, high), s| (low.min(s), high.max(s)));
        (low, high + f64::from(self.raster[0]))
    }

    /// Metres of a ray per metre of depth, for each pixel of a view's row.
    pub(crate) fn lengths(&self, view: usize, row: u32, out: &mut [f32]) {
        let y = self.y_slope(row);
        let base = 1.0 + y * y;
        for (i, length) in out.iter_mut().enumerate() {
            let x = self.x_slope(view, i);
            *length = (base + x * x).sqrt() as f32;
        }
    }

    /// What a pixel's ray adds to x, at z = 0 and per metre of depth, for pixel 0 and for each further one.
    pub(crate) fn lines(&self, view: usize) -> [[f64; 2]; 2] {
        let first = self.x[0] + 0.5 * self.x[1];
        let per_metre = |x: f64| (self.slope - 1.0) * x / self.observer[1];
        [[first, per_metre(first) + self.offsets[view] / self.observer[1]], [self.x[1], per_metre(self.x[1])]]
    }

    /// The unit direction of a ray.
    pub(crate) fn direction(&self, view: usize, row: u32, pixel: usize) -> [f32; 3] {
        let x = self.x_slope(view, pixel);
        let y = self.y_slope(row);
        let length = (1.0 + x * x + y * y).sqrt();
        [-x / length, -y / length, -1.0 / length].map(|c| c as f32)
    }

    /// The depth range within which the grid is one: in front of where all beams cross and of the observer.
    pub(crate) fn depths(&self) -> (f64, f64) {
        let observer = self.observer[1];
        let crossing = if self.slope > 1.0 { -observer / (self.slope - 1.0) } else { f64::NEG_INFINITY };
        (crossing + 1e-3 * observer, observer * (1.0 - 1e-6))
    }
}

//! The warp by a mesh: what each pixel of a projector sees of the picture that was drawn.

use crate::present::resample::between;
use display_config::{Mesh, Raster};
use glam::DVec2;
use layout::present::NOWHERE;
use rayon::prelude::*;

/// A place this far outside the picture (pixels) still belongs to it: a mesh has its points in f32.
const EDGE_PX: f64 = 1e-3;

/// Where in the picture each pixel takes its light from.
pub(super) struct Warp {
    /// Pixel coordinates less a half: the centre of the picture's first pixel is at 0.
    pub(super) places: Vec<[f32; 2]>,
}

impl Warp {
    pub fn new(mesh: &Mesh, raster: &Raster) -> Self {
        let (size, inverse) = (raster.size(), raster.inverse());
        let place = |x: u32, y: u32| {
            let share = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5) / size;
            let place = inverse.and_then(|inverse| inverse.pixel(mesh.screen(share)))?;
            let is_inside = place.cmpge(DVec2::splat(-EDGE_PX)).all() && place.cmple(size + EDGE_PX).all();
            is_inside.then(|| (place - 0.5).as_vec2().to_array())
        };
        let mut places = vec![[NOWHERE; 2]; raster.width as usize * raster.height as usize];
        places.par_chunks_mut(raster.width.max(1) as usize).zip(0..raster.height).for_each(|(row, y)| {
            row.iter_mut().zip(0..).for_each(|(into, x)| *into = place(x, y).unwrap_or([NOWHERE; 2]));
        });
        Self { places }
    }

    /// The light that falls to a pixel, by its number; black where it sees none of the picture.
    pub fn colour(&self, rgba: &[f32], size: [usize; 2], at: usize) -> [f32; 3] {
        match self.places[at] {
            [NOWHERE, _] => [0.0; 3],
            place => between(rgba, size, place),
        }
    }
}

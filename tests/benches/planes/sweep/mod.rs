//! A competitor, the published way for many views (plane sweep): planes parallel to the screen, each classified once at the screen's
//! resolution and warped into the picture of every projector, from the front to the back.
//!
//! Planes share one classification, so highlights are those of a viewer before the middle of the screen. What projectors' own
//! rasters, enhancers and importance would ask for is left out.

mod content;
mod look;
mod plane;
mod warp;

use crate::scene::{COMPARED, Scene};
use content::Content;
use lightloom_tests::compare::{self, Errors};
use plane::{Frustum, Plane};
use protocol::ProjectorImage;
use rayon::prelude::*;
use std::time::Instant;
use warp::View;

/// Planes that are kept at a time: enough for pictures to be gone through seldom, and few enough for memory.
const AT_ONCE: usize = 32;

/// What so many planes made of all views.
pub struct Swept {
    /// To classify, and to warp into all views.
    pub seconds: f64,
    /// Texels that were sampled.
    pub samples: u64,
    /// Those read.
    pub bricks: usize,
    pub errors: Errors,
}

/// Whether it draws a scene at all.
pub fn can_draw(scene: &Scene) -> bool {
    View::of(scene, 0).is_some()
}

/// Draws all views of a scene, whose bricks are read beforehand.
pub fn sweep(scene: &Scene, count: usize) -> Swept {
    let content = Content::of(scene);
    let views: Vec<View> =
        (0..scene.display.projectors.len()).filter_map(|view| View::of(scene, view)).collect();
    let mut pictures: Vec<Vec<f32>> = views.iter().map(View::picture).collect();
    let frustum = Frustum::of(scene, &content, count);
    let mut planes: Vec<Plane> = (0..AT_ONCE.min(count)).map(|_| Plane::new(&frustum)).collect();
    let (started, mut samples) = (Instant::now(), 0);
    for first in (0..count).step_by(AT_ONCE) {
        let some = &mut planes[..AT_ONCE.min(count - first)];
        let classify = |(at, plane): (usize, &mut Plane)| plane.classify(&frustum, first + at, &content);
        samples += some.par_iter_mut().enumerate().map(classify).sum::<u64>();
        for (view, picture) in views.iter().zip(&mut pictures) {
            view.warp(&frustum, some, picture);
        }
    }
    let seconds = started.elapsed().as_secs_f64();
    let image = |projector: u32| {
        let raster = &scene.display.projectors[projector as usize].raster;
        let rgba = std::mem::take(&mut pictures[projector as usize]);
        ProjectorImage { projector, width: raster.width, height: raster.height, rgba }
    };
    let images = COMPARED.map(image);
    Swept { seconds, samples, bricks: content.leaves.len(), errors: compare::errors(&images, scene.truth()) }
}

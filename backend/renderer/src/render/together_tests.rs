//! Complete frames whose views are cast together.

use super::Renderer;
use super::test_scene::{Pictures, frame, options};
use bricks::procedural::ProceduralVolume;
use bricks::{BRICK_VOXELS, BrickSource};
use display_config::Homography;
use glam::{DVec2, UVec3};
use protocol::{FrameReport, RendererOptions};
use std::sync::Arc;

/// Projectors that show a quarter of the screen each: they need different bricks.
fn quarters() -> RendererOptions {
    let mut options = options();
    let half = 0.5 * DVec2::new(options.display.width_m, options.display.height_m);
    let projector = options.display.projectors[0].clone();
    options.display.projectors = [(-1.0, -1.0), (0.0, -1.0), (-1.0, 0.0), (0.0, 0.0)]
        .map(|corner| {
            let mut projector = projector.clone();
            let lower_left = half * DVec2::from(corner);
            projector.raster.screen_from_pixel =
                Homography::of_rectangle(projector.raster.size(), lower_left, half);
            projector
        })
        .to_vec();
    RendererOptions { projectors: vec![0, 1, 2, 3], ..options }
}

/// One frame by a new renderer with a cache of so many bricks, which casts so many views together.
fn drawn(views: usize, bricks: u64) -> (Pictures, FrameReport) {
    let volume = ProceduralVolume::new("sparse-vessels", UVec3::splat(200), 5e-4).unwrap();
    let source: Arc<dyn BrickSource> = Arc::new(volume);
    let options = RendererOptions { cache_bytes: bricks * 2 * BRICK_VOXELS as u64, ..quarters() };
    let mut renderer = Renderer::new(&options, source).unwrap().0;
    renderer.restart(&frame(0.05)).unwrap();
    renderer.cast_together(views);
    let mut pictures = Vec::new();
    loop {
        let report = renderer.advance(&|| false).unwrap().report;
        renderer.present(&mut |image| pictures.push(image.rgba)).unwrap();
        if let Some(report) = report {
            return (pictures, *report);
        }
    }
}

#[test]
fn views_that_are_cast_together_show_what_each_shows_alone() {
    let (alone, report) = drawn(1, 1 << 10);
    let each = report.working_set_sum.expect("each view was cast alone");
    assert!(report.complete && report.working_set_union < each);
    // In groups of one size, with a smaller one at the end, or with more room than there are views.
    for views in [2, 3, 4, 9] {
        let (together, joined) = drawn(views, 1 << 10);
        assert!(together == alone && joined.complete, "{views}");
        assert_eq!(joined.working_set_union, report.working_set_union, "{views}");
        assert_eq!(joined.working_set_sum, None, "{views}: nobody knows what each sampled");
        assert_eq!(joined.projectors, [0, 1, 2, 3]);
    }
}

#[test]
fn views_whose_bricks_do_not_fit_together_are_cast_one_by_one() {
    let (large, report) = drawn(1, 1 << 10);
    let (mut are_alone, mut are_short) = (0, 0);
    for percent in [95, 90, 85, 70] {
        let bricks = report.bricks_resident * percent / 100;
        let (alone, of_each) = drawn(1, bricks);
        let (together, joined) = drawn(4, bricks);
        assert_eq!(joined.complete, of_each.complete, "{percent} %");
        if of_each.complete {
            assert!(alone == large && together == large, "{percent} %");
            are_alone += u32::from(joined.working_set_sum.is_some());
        } else {
            assert!(joined.working_set_sum.is_some(), "{percent} %: each was tried alone");
            are_short += 1;
        }
    }
    // Caches of all kinds were tried: that hold each view but not all, and that do not hold each.
    assert!(are_alone > 0 && are_short > 0, "{are_alone} {are_short}");
}

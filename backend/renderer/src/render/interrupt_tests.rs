//! Frames that are left off between tiles, gone on with, and dropped for others.

use super::Renderer;
use super::test_scene::{Pictures, draw, frame, renderer};
use bricks::BrickSource;
use bricks::procedural::ProceduralVolume;
use glam::UVec3;
use protocol::{Advance, FrameReport, FrameState, Pace};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

fn shells() -> Arc<dyn BrickSource> {
    Arc::new(ProceduralVolume::new("shells", UVec3::splat(100), 1e-3).unwrap())
}

fn live(frame: &FrameState, index: u32) -> FrameState {
    let pace = Pace::Live { upload_bytes: 64 << 20, fade_s: 0.0 };
    FrameState { index, time_s: f64::from(index), pace, ..frame.clone() }
}

/// Goes on with a frame until it is done, leaving off each time that `stop` has been asked so often.
fn draw_in_pieces(
    renderer: &mut Renderer,
    frame: &FrameState,
    patience: u64,
) -> (Pictures, FrameReport, u32) {
    renderer.restart(frame).unwrap();
    let (mut pictures, mut pieces) = (Vec::new(), 0);
    loop {
        let asked = AtomicU64::new(0);
        let stop = || asked.fetch_add(1, Ordering::Relaxed) >= patience;
        let advance = renderer.advance(&stop).unwrap();
        renderer.present(&mut |image| pictures.push(image.rgba)).unwrap();
        pieces += 1;
        if let Some(report) = advance.report {
            return (pictures, *report, pieces);
        }
        assert!(pieces < 100_000, "it does not get on");
    }
}

#[test]
fn a_frame_in_pieces_is_the_whole_frame_to_the_bit() {
    let frame = frame(0.05);
    let (whole, account) = draw(&mut renderer(shells()), &frame).unwrap();
    for patience in [3, 7, 50] {
        let (pictures, report, pieces) = draw_in_pieces(&mut renderer(shells()), &frame, patience);
        assert!(pieces > 3, "{pieces}");
        assert_eq!(pictures, whole, "{patience}");
        let counts =
            |report: &FrameReport| (report.rays, report.samples, report.bricks_loaded, report.complete);
        assert_eq!(counts(&report), counts(&account));
    }
}

#[test]
fn a_live_frame_in_pieces_is_the_whole_frame_to_the_bit() {
    let complete = frame(0.05);
    let (mut one, mut other) = (renderer(shells()), renderer(shells()));
    for renderer in [&mut one, &mut other] {
        draw(renderer, &complete).unwrap();
    }
    let (whole, _) = draw(&mut one, &live(&complete, 1)).unwrap();
    let (pictures, _, pieces) = draw_in_pieces(&mut other, &live(&complete, 1), 5);
    assert!(pieces > 2, "{pieces}");
    assert_eq!(pictures, whole);
}

/// Each thread may be at a tile when it is asked to stop; nobody begins another.
#[test]
fn it_leaves_off_within_a_tile() {
    let mut renderer = renderer(shells());
    let frame = frame(0.05);
    renderer.restart(&frame).unwrap();
    let tiles = AtomicU64::new(0);
    // Until the first picture is under way: the coarse look is over.
    while renderer.advance(&|| tiles.fetch_add(1, Ordering::Relaxed) % 8 == 7).unwrap().done == 0 {
        renderer.present(&mut drop).unwrap();
        let asked = AtomicU64::new(0);
        let rays = |renderer: &Renderer| renderer.rays_cast();
        let before = rays(&renderer);
        renderer.advance(&|| asked.fetch_add(1, Ordering::Relaxed) >= 4).unwrap();
        let cast = rays(&renderer) - before;
        assert!(cast <= 4 * 64, "{cast} rays after it was asked to stop at the fifth tile");
    }
}

#[test]
fn a_frame_in_the_place_of_another_is_drawn_as_if_alone() {
    let (first, second) = (frame(0.3), frame(0.05));
    let alone = draw(&mut renderer(shells()), &second).unwrap().0;
    let mut renderer = renderer(shells());
    for asked in [0, 1, 5, 20, 60] {
        renderer.restart(&first).unwrap();
        let count = AtomicU64::new(0);
        let Advance { report, .. } =
            renderer.advance(&|| count.fetch_add(1, Ordering::Relaxed) >= asked).unwrap();
        assert!(report.is_none());
        assert_eq!(draw(&mut renderer, &second).unwrap().0, alone, "{asked}");
    }
}

#[test]
fn a_change_of_pace_keeps_the_cache() {
    let complete = frame(0.05);
    let mut renderer = renderer(shells());
    let (whole, first) = draw(&mut renderer, &complete).unwrap();
    assert!(first.bricks_loaded > 0);
    let (pictures, report) = draw(&mut renderer, &live(&complete, 1)).unwrap();
    assert_eq!((report.bricks_loaded, &pictures), (0, &whole));
    let (pictures, report) = draw(&mut renderer, &complete).unwrap();
    assert_eq!((report.bricks_loaded, &pictures), (0, &whole));
}

#[test]
fn a_light_that_moves_keeps_a_view_from_coming_to_rest() {
    use glam::DVec3;
    use optics::Light;
    let view = frame(0.05);
    let comes_to_rest = |moves: f64| {
        let at = |index: u32| {
            let toward_light_in_display = DVec3::new(moves * f64::from(index), 0.0, 1.0).normalize();
            let light = Some(Light { toward_light_in_display, ..Light::default() });
            FrameState { light, ..live(&view, index) }
        };
        let mut renderer = renderer(shells());
        draw(&mut renderer, &FrameState { pace: Pace::Complete, ..at(0) }).unwrap();
        (1..40).any(|index| draw(&mut renderer, &at(index)).unwrap().1.complete)
    };
    assert!(comes_to_rest(0.0));
    assert!(!comes_to_rest(0.1), "it changes what is seen");
}

//! Frames that cast a quarter of their pixels, and come to the full picture.

use super::Renderer;
use super::test_scene::{Pictures, Way, draw, frame};
use bricks::BrickSource;
use bricks::procedural::ProceduralVolume;
use glam::{DVec3, UVec3};
use protocol::{FrameState, Pace, RendererOptions, SubFrame};
use std::sync::Arc;

fn renderer(way: Way) -> Renderer {
    let source: Arc<dyn BrickSource> =
        Arc::new(ProceduralVolume::new("shells", UVec3::splat(100), 1e-3).unwrap());
    let options = way.options();
    let mut renderer = Renderer::new(&options, source).unwrap().0;
    draw(&mut renderer, &frame(0.05)).unwrap();
    renderer
}

fn live(frame: &FrameState, index: u32) -> FrameState {
    let pace = Pace::Live { upload_bytes: 64 << 20, fade_s: 0.0 };
    let sub_frame = Some(SubFrame::of_frame(index));
    FrameState { index, time_s: f64::from(index), pace, sub_frame, ..frame.clone() }
}

fn moved(frame: &FrameState) -> FrameState {
    let mut moved = frame.clone();
    moved.display_from_volume.translation += DVec3::new(0.02, 0.01, 0.0);
    moved
}

/// The same, waiting for its detail.
fn complete(frame: &FrameState, index: u32) -> FrameState {
    FrameState { pace: Pace::Complete, ..live(frame, index) }
}

/// The share of pixels that differ.
fn differing(a: &Pictures, b: &Pictures) -> f64 {
    let pixels = a.iter().flatten().zip(b.iter().flatten());
    let (all, differing) =
        pixels.fold((0, 0), |(all, differing), (a, b)| (all + 1, differing + i32::from(a != b)));
    f64::from(differing) / f64::from(all)
}

#[test]
fn a_still_view_comes_to_the_full_picture_to_the_bit() {
    for (way, paced) in Way::ALL.into_iter().flat_map(|way| [(way, live as fn(&_, _) -> _), (way, complete)])
    {
        let (still, mut renderer) = (frame(0.05), renderer(way));
        let full = draw(&mut renderer, &still).unwrap().0;
        let casts = if way == Way::Rays { 4 } else { 2 };
        // Wherever it was, and whatever the number of the frame.
        for first in [0, 5, 11] {
            draw(&mut renderer, &paced(&moved(&still), first)).unwrap();
            for cast in 1..=6 {
                let (pictures, report) = draw(&mut renderer, &paced(&still, first + cast)).unwrap();
                let is_full = pictures == full;
                assert_eq!(is_full, cast >= casts, "{way:?} {first} {cast}: {}", differing(&pictures, &full));
                assert!(is_full || !report.complete, "a picture that is not complete does not say so");
            }
        }
    }
}

/// A path of frames that move, rest and jump.
fn path() -> Vec<FrameState> {
    let (here, there) = (frame(0.05), moved(&frame(0.05)));
    let halves = |index: u32| if matches!(index, 2..=7 | 11) { here.clone() } else { there.clone() };
    (0..14).map(|index| complete(&halves(index), index)).collect()
}

#[test]
fn complete_sub_frames_are_the_same_whoever_draws_the_other_projectors() {
    for way in Way::ALL {
        let draw_all = |projectors: Vec<u32>| -> Vec<Pictures> {
            let source: Arc<dyn BrickSource> =
                Arc::new(ProceduralVolume::new("shells", UVec3::splat(100), 1e-3).unwrap());
            let options = RendererOptions { projectors, ..way.options() };
            let mut renderer = Renderer::new(&options, source).unwrap().0;
            path().iter().map(|frame| draw(&mut renderer, frame).unwrap().0).collect()
        };
        let (both, left, right) = (draw_all(vec![0, 1]), draw_all(vec![0]), draw_all(vec![1]));
        for (frame, both) in both.iter().enumerate() {
            assert_eq!(both, &[&left[frame][..], &right[frame][..]].concat(), "{way:?} {frame}");
        }
    }
}

#[test]
fn kinds_of_frames_in_turn_do_not_disturb_each_other() {
    let (still, mut renderer) = (frame(0.05), renderer(Way::Rays));
    let full = draw(&mut renderer, &still).unwrap().0;
    for index in 0..3 {
        draw(&mut renderer, &moved(&still)).unwrap();
        (0..3).for_each(|i| drop(draw(&mut renderer, &live(&still, i)).unwrap()));
        let after = |renderer: &mut Renderer, i: u32| draw(renderer, &complete(&still, i)).unwrap().0;
        let last = (index..index + 4).map(|i| after(&mut renderer, i)).last();
        assert_eq!(last.as_ref(), Some(&full));
        assert_eq!(draw(&mut renderer, &still).unwrap().0, full);
    }
}

#[test]
fn a_frame_casts_its_share_of_the_rays() {
    for (way, share) in [(Way::Rays, 4), (Way::Planes, 2)] {
        let mut renderer = renderer(way);
        let full =
            draw(&mut renderer, &FrameState { sub_frame: None, ..live(&frame(0.05), 0) }).unwrap().1.rays;
        let rays: Vec<u64> =
            (1..=4).map(|i| draw(&mut renderer, &live(&frame(0.05), i)).unwrap().1.rays).collect();
        assert_eq!(rays.iter().sum::<u64>() * share / 4, full, "{way:?} {rays:?}");
    }
}

#[test]
fn what_moves_is_nearer_to_the_full_picture_than_the_one_before() {
    for way in Way::ALL {
        let (first, second) = (frame(0.05), moved(&frame(0.05)));
        let mut renderer = renderer(way);
        let before = draw(&mut renderer, &first).unwrap().0;
        let truth = draw(&mut renderer, &second).unwrap().0;
        (1..=4).for_each(|i| drop(draw(&mut renderer, &live(&first, i)).unwrap()));
        let shown = draw(&mut renderer, &live(&second, 5)).unwrap().0;
        let error = |pictures: &Pictures| {
            let numbers = pictures.iter().flatten().zip(truth.iter().flatten());
            let squares: f64 = numbers.map(|(a, b)| f64::from(a - b).powi(2)).sum();
            squares.sqrt()
        };
        // The raster is small, and it jumps by several pixels: how much nearer is a study's affair.
        assert!(error(&shown) < 0.75 * error(&before), "{way:?} {} {}", error(&shown), error(&before));
    }
}

#[test]
fn a_sub_frame_that_is_left_off_is_not_taken_for_cast() {
    use std::sync::atomic::{AtomicU32, Ordering};
    let (still, mut renderer) = (frame(0.05), renderer(Way::Rays));
    let full = draw(&mut renderer, &still).unwrap().0;
    (0..4).for_each(|i| drop(draw(&mut renderer, &live(&still, i)).unwrap()));
    renderer.restart(&live(&moved(&still), 4)).unwrap();
    let asked = AtomicU32::new(0);
    renderer.advance(&|| asked.fetch_add(1, Ordering::Relaxed) > 6).unwrap();
    assert!(renderer.rays_cast() > 0, "nothing was cast, so nothing is shown by this test");
    let pictures: Vec<Pictures> = (5..=8).map(|i| draw(&mut renderer, &live(&still, i)).unwrap().0).collect();
    assert_eq!(pictures[3], full);
}

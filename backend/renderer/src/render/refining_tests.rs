//! Pictures that are cast unit by unit come to the full picture, and tell what they err.

use super::Renderer;
use super::test_scene::{Pictures, Way, draw, frame};
use bricks::BrickSource;
use bricks::procedural::ProceduralVolume;
use glam::{DVec3, UVec3};
use protocol::{FrameState, Pace, Refined, Refinement, RenderEvent, RendererOptions};
use std::sync::Arc;

const UNITS: u32 = Refinement::UNITS;

fn source() -> Arc<dyn BrickSource> {
    Arc::new(ProceduralVolume::new("shells", UVec3::splat(100), 1e-3).unwrap())
}

fn renderer(way: Way, projectors: Vec<u32>) -> Renderer {
    let options = RendererOptions { projectors, ..way.options() };
    let mut renderer = Renderer::new(&options, source()).unwrap().0;
    draw(&mut renderer, &frame(0.05)).unwrap();
    renderer
}

fn part(frame: &FrameState, pace: Pace, configuration: u32, to: u32) -> FrameState {
    FrameState { index: to, pace, refinement: Some(Refinement { configuration, to }), ..frame.clone() }
}

const LIVE: Pace = Pace::Live { upload_bytes: 64 << 20, fade_s: 0.0 };

fn moved(frame: &FrameState, by_m: f64) -> FrameState {
    let mut moved = frame.clone();
    moved.display_from_volume.translation += DVec3::new(by_m, 0.5 * by_m, 0.0);
    moved
}

/// Draws a part, compared with the newest state if there is one.
fn go_on(renderer: &mut Renderer, part: &FrameState, newest: Option<&FrameState>) -> (Pictures, Refined) {
    let mut pictures = Vec::new();
    renderer.restart(part).unwrap();
    newest.iter().for_each(|newest| renderer.compare_with(newest));
    loop {
        let report = renderer.advance(&|| false).unwrap().report;
        renderer.present(&mut |image| pictures.push(image.rgba)).unwrap();
        if let Some(report) = report {
            return (pictures, report.refined.unwrap());
        }
    }
}

/// The mean of a sum of errors.
fn mean(sum: u64, count: u64) -> f64 {
    sum as f64 / Refined::UNIT as f64 / count.max(1) as f64
}

fn rms(a: &Pictures, b: &Pictures) -> f64 {
    let numbers: Vec<(f32, f32)> = a.iter().flatten().copied().zip(b.iter().flatten().copied()).collect();
    let squares: f64 = numbers.iter().map(|(a, b)| f64::from(a - b).powi(2)).sum();
    (squares / numbers.len() as f64).sqrt()
}

#[test]
fn units_come_to_the_full_picture_to_the_bit_whatever_came_before() {
    for (way, pace) in Way::ALL.into_iter().flat_map(|way| [(way, LIVE), (way, Pace::Complete)]) {
        let (still, mut renderer) = (frame(0.05), renderer(way, vec![0, 1]));
        let full = draw(&mut renderer, &still).unwrap().0;
        // Of a raster as small as this, the first units of rows have none to compare with.
        let first = if way != Way::Rays { 5 } else { 1 };
        for (configuration, steps) in [(1, vec![first, 8, 16, 40, 64]), (2, vec![64]), (3, vec![5, 64])] {
            // Somewhere else before.
            go_on(&mut renderer, &part(&moved(&still, 0.02), pace, 100 + configuration, 7), None);
            let mut before = (f64::INFINITY, u64::MAX);
            for to in steps {
                let (pictures, refined) = go_on(&mut renderer, &part(&still, pace, configuration, to), None);
                let now = (rms(&pictures, &full), refined.spatial);
                assert_eq!(now.0 == 0.0, to == UNITS, "{way:?} {pace:?} {to}: {now:?}");
                assert_eq!((refined.done, refined.spatial == 0), (to, to == UNITS));
                assert!(now.0 < before.0 && now.1 < before.1, "{way:?} {pace:?} {to}: {before:?} {now:?}");
                before = now;
            }
        }
        assert_eq!(draw(&mut renderer, &still).unwrap().0, full, "and leave nothing behind");
    }
}

#[test]
fn a_unit_casts_a_sixty_fourth_of_the_rays_and_none_twice() {
    let mut renderer = renderer(Way::Rays, vec![0, 1]);
    let still = frame(0.05);
    let mut rays = 0;
    for to in 1..=UNITS {
        let report = renderer.draw(&part(&still, LIVE, 1, to), &mut |_: RenderEvent| {}).unwrap();
        assert!(report.rays < 48 * 36 * 2 / 8, "{to}: {}", report.rays);
        rays += report.rays;
    }
    assert_eq!(rays, 48 * 36 * 2);
}

#[test]
fn the_newest_state_is_as_far_as_it_has_moved_and_looking_at_it_changes_nothing() {
    for (way, pace) in Way::ALL.into_iter().flat_map(|way| [(way, LIVE), (way, Pace::Complete)]) {
        let (still, mut renderer) = (frame(0.05), renderer(way, vec![0, 1]));
        let full = draw(&mut renderer, &still).unwrap().0;
        let mut far = frame(0.05);
        far.optics.extinction = optics::Curve::constant(0.5);
        go_on(&mut renderer, &part(&still, pace, 1, 2), None);
        let mut to = 2;
        let mut distance = |newest: &FrameState| {
            to += 10;
            let newest = FrameState { pace, ..newest.clone() };
            let refined = go_on(&mut renderer, &part(&still, pace, 1, to), Some(&newest)).1;
            assert!(refined.compared > 0, "{way:?} {pace:?}");
            mean(refined.change, refined.compared)
        };
        let (none, little, more, most) = (
            distance(&still),
            distance(&moved(&still, 0.004)),
            distance(&moved(&still, 0.02)),
            distance(&far),
        );
        assert_eq!(none, 0.0, "{way:?} {pace:?}");
        assert!(0.0 < little && little < more && more < most, "{way:?} {pace:?} {little} {more} {most}");
        let (pictures, refined) = go_on(&mut renderer, &part(&still, pace, 1, UNITS), None);
        assert_eq!(pictures, full, "{way:?} {pace:?}");
        assert_eq!(refined.compared, 0);
    }
}

#[test]
fn a_picture_that_is_begun_tells_how_far_it_is_from_the_one_before() {
    let mut renderer = renderer(Way::Rays, vec![0, 1]);
    let still = frame(0.05);
    let first = go_on(&mut renderer, &part(&still, LIVE, 1, 1), None).1;
    assert_eq!(first.compared, 0, "there is none before");
    let same = go_on(&mut renderer, &part(&still, LIVE, 2, 1), None).1;
    assert_eq!((same.change, same.compared), (0, 2 * 6 * 5));
    let other = go_on(&mut renderer, &part(&moved(&still, 0.02), LIVE, 3, 1), None).1;
    assert!(other.change > 0);
}

#[test]
fn sums_of_errors_do_not_depend_on_who_draws_what() {
    for way in Way::ALL {
        let newest = moved(&frame(0.05), 0.01);
        let sums = |projectors: Vec<u32>| {
            let mut renderer = renderer(way, projectors);
            let draw = |renderer: &mut Renderer, to| {
                go_on(renderer, &part(&frame(0.05), Pace::Complete, 1, to), Some(&newest)).1
            };
            [draw(&mut renderer, 3), draw(&mut renderer, 20)]
        };
        let (both, left, right) = (sums(vec![0, 1]), sums(vec![0]), sums(vec![1]));
        for ((both, left), right) in both.into_iter().zip(left).zip(right) {
            assert!(both.change > 0 && both.spatial > 0);
            assert_eq!(both.change, left.change + right.change, "{way:?}");
            assert_eq!(both.spatial, left.spatial + right.spatial, "{way:?}");
        }
    }
}

#[test]
fn a_picture_that_went_on_without_this_back_end_is_begun_whole() {
    let mut renderer = renderer(Way::Rays, vec![0, 1]);
    let full = draw(&mut renderer, &frame(0.05)).unwrap().0;
    // It was away while units 1 to 30 were cast.
    let whole = go_on(&mut renderer, &part(&frame(0.05), LIVE, 9, 31), None);
    assert!(rms(&whole.0, &full) < 0.05);
    assert_eq!(go_on(&mut renderer, &part(&frame(0.05), LIVE, 9, UNITS), None).0, full);
}

#[test]
fn detail_that_comes_is_told_of_until_all_is_there() {
    let mut renderer = Renderer::new(&Way::Rays.options(), source()).unwrap().0;
    let full = draw(&mut Renderer::new(&Way::Rays.options(), source()).unwrap().0, &frame(0.05)).unwrap().0;
    let at = |configuration: u32| FrameState { time_s: f64::from(configuration), ..frame(0.05) };
    let mut begun = 0;
    let (mut pictures, mut refined) = go_on(&mut renderer, &part(&at(begun), LIVE, begun, UNITS), None);
    assert!(refined.has_detail, "nothing has been loaded");
    while refined.has_detail {
        begun += 1;
        assert!(begun < 500, "it never comes to an end");
        std::thread::sleep(std::time::Duration::from_millis(2));
        (pictures, refined) = go_on(&mut renderer, &part(&at(begun), LIVE, begun, UNITS), None);
    }
    assert_eq!(pictures, full);
}

//! Row planes on a GPU show what the reference has: where they are too steep for means, rays sample for themselves.

use crate::planes::promised;
use display_config::Display;
use lightloom_tests::compare::{Errors, errors, truth};
use lightloom_tests::draw::{self, Drawn, With, draw};
use lightloom_tests::scenes::{self, TestScene};
use protocol::{Caster, DeviceChoice, FrameState};

const PROJECTORS: [u32; 8] = [0, 1, 2, 3, 4, 5, 6, 7];
const COMPARED: [u32; 2] = [0, 5];

fn display() -> Display {
    scenes::small_desk8(64, 48)
}

fn drawn(display: &Display, scene: &TestScene, frame: &FrameState, projectors: &[u32]) -> Drawn {
    let drawn = draw(display, frame, &scene.source, projectors, With::PLANES_ON_GPU);
    let views = projectors.len() as u32;
    assert_eq!(drawn.report.caster, Caster::Planes { views, fans: 1, resampled: 0 });
    assert!(drawn.report.complete, "{}", drawn.report.shortfall);
    drawn
}

fn errors_of(display: &Display, scene: &TestScene, frame: &FrameState) -> Errors {
    let truth = truth(display, &scene.frame, &scene.source, &COMPARED, 2);
    errors(&drawn(display, scene, frame, &PROJECTORS).images, &truth)
}

#[test]
fn they_keep_the_promise_of_planes() {
    if !draw::has_gpu() {
        return;
    }
    let _turn = draw::turn();
    let display = display();
    for (scene, limits) in promised(&display) {
        let found = errors_of(&display, &scene, &scene.frame);
        println!("{:20} {found}", scene.name);
        assert!(limits.hold(&found), "{}: {found}", scene.name);
    }
}

#[test]
fn a_medium_that_is_too_thick_by_a_twentieth_is_found_there_too() {
    if !draw::has_gpu() {
        return;
    }
    let _turn = draw::turn();
    let display = display();
    let (scene, limits) = promised(&display).swap_remove(0);
    let mut frame = scene.frame.clone();
    frame.optics.extinction = scenes::scaled(&frame.optics.extinction, 1.05);
    let spoiled = errors_of(&display, &scene, &frame);
    assert!(!limits.hold(&spoiled), "{spoiled}");
}

#[test]
fn a_view_is_the_same_there_whoever_shares_its_rows() {
    if !draw::has_gpu() {
        return;
    }
    let _turn = draw::turn();
    let display = display();
    let mut all = vec![scenes::shells(&display), scenes::stored_vessels(&display)];
    all.extend(scenes::cranium(&display));
    for scene in all {
        let together = drawn(&display, &scene, &scene.frame, &PROJECTORS);
        let again = drawn(&display, &scene, &scene.frame, &PROJECTORS);
        assert!(together.images == again.images, "{}: drawn twice", scene.name);
        for projector in [1, 6] {
            let alone = drawn(&display, &scene, &scene.frame, &[projector]);
            assert!(
                together.images[projector as usize] == alone.images[0],
                "{}: view {projector}",
                scene.name
            );
        }
    }
}

#[test]
fn planes_want_there_what_rays_want() {
    if !draw::has_gpu() {
        return;
    }
    let _turn = draw::turn();
    let display = display();
    for scene in [scenes::shells(&display), scenes::stored_vessels(&display)] {
        let rays = draw(&display, &scene.frame, &scene.source, &PROJECTORS, With::device(DeviceChoice::Gpu));
        let planes = drawn(&display, &scene, &scene.frame, &PROJECTORS);
        let [by_rays, by_planes] = [&rays, &planes].map(|drawn| drawn.report.working_set_union);
        println!("{}: {by_rays} bricks by rays, {by_planes} by planes", scene.name);
        assert!(by_planes as f64 <= 1.1 * by_rays as f64 + 2.0, "{by_planes} after {by_rays}");
    }
}

//! Live frames: they wait for nothing, and come to rest at the picture that a complete frame gives.

use bricks::procedural::ProceduralVolume;
use bricks::{BrickSource, NodeKey};
use display_config::Display;
use glam::{DQuat, UVec3};
use lightloom_tests::cold_start::cold_start;
use lightloom_tests::draw::{self, With, draw_with};
use lightloom_tests::faulty_source::{FOR_EVER, Fault, FaultySource};
use lightloom_tests::remembered::Remembered;
use lightloom_tests::scenes::{self, TestScene};
use optics::{Light, Quality};
use protocol::{Caster, DeviceChoice, FrameReport, FrameState, Pace, ProjectorImage};
use renderer::Renderer;
use std::sync::{Arc, Once, OnceLock};
use std::time::Duration;

/// Two neighbours of one back-end.
const PROJECTORS: [u32; 2] = [35, 36];
/// Voxels along an edge.
const EDGE: u32 = 700;
/// What a pixel of a still view may change by in a frame.
const MOST_STEP: f64 = 12.0 / 255.0;
/// When it rests, seconds.
const MOST_REST_S: f64 = 2.5;
/// A view that has not come to rest by then does not.
const MOST_FRAMES: u32 = 4000;

/// Shells that take three depths at once on holo72. All bricks that its pictures need are made: when a view rests is the working set's
/// to find, not how soon a volume is computed.
fn scene(display: &Display) -> TestScene {
    static MADE: Once = Once::new();
    static SOURCE: OnceLock<Arc<Remembered>> = OnceLock::new();
    let volume = || Arc::new(ProceduralVolume::new("shells", UVec3::splat(EDGE), 1e-3).unwrap());
    let source: Arc<dyn BrickSource> = SOURCE.get_or_init(|| Arc::new(Remembered::new(volume()))).clone();
    let mut optics = scenes::shells(display).frame.optics;
    // The scene's own volume has 128 voxels along an edge.
    optics.extinction = scenes::scaled(&optics.extinction, 128.0 / f64::from(EDGE));
    let place = scenes::placed(&*source, 1.2, DQuat::from_euler(glam::EulerRot::XYZ, 0.4, 0.7, 0.1));
    let frame = scenes::frame(display, place, optics, Some(Light::default()));
    MADE.call_once(|| {
        drop(draw::draw(display, &frame, &source, &PROJECTORS, With::device(DeviceChoice::Cpu)))
    });
    TestScene { name: "shells", source, frame }
}

fn display() -> Display {
    Display::load("holo72").unwrap().with_rasters(28, 21)
}

fn renderer(display: &Display, source: &Arc<dyn BrickSource>, device: DeviceChoice, mib: u64) -> Renderer {
    draw::renderer(display, source, &PROJECTORS, With { cache_bytes: mib << 20, ..With::device(device) }).0
}

/// Frame `index` of a still view, 1/60 s after the one before.
fn live(frame: &FrameState, index: u32) -> FrameState {
    let pace = Pace::Live { upload_bytes: 4 << 20, fade_s: 0.1 };
    FrameState { index, time_s: f64::from(index) / 60.0, pace, ..frame.clone() }
}

/// Draws live frames until one says that nothing is missing.
fn come_to_rest(renderer: &mut Renderer, frame: &FrameState) -> (Vec<ProjectorImage>, FrameReport) {
    let mut lacks = String::new();
    for index in 0..MOST_FRAMES {
        let (images, report) = draw_with(renderer, &live(frame, index));
        assert_eq!(report.working_set_sum, None, "the views of a live frame count together");
        if report.complete {
            return (images, report);
        }
        lacks = report.shortfall;
        std::thread::sleep(Duration::from_millis(1));
    }
    panic!("not at rest after {MOST_FRAMES} frames: {lacks}");
}

fn assert_same(live: &[ProjectorImage], complete: &[ProjectorImage], what: &str) {
    for (a, b) in live.iter().zip(complete) {
        let differ = a.rgba.iter().zip(&b.rgba).filter(|(a, b)| a.to_bits() != b.to_bits()).count();
        let most = a.rgba.iter().zip(&b.rgba).fold(0.0, |most: f32, (a, b)| most.max((a - b).abs()));
        assert_eq!(differ, 0, "{what}: projector {}, by {most} at most", a.projector);
        assert!(a.rgba.iter().any(|&c| c > 0.1), "{what}: a black picture proves nothing");
    }
}

#[test]
fn a_still_view_comes_to_rest_at_the_complete_picture_to_the_bit() {
    let _turn = draw::turn();
    let display = display();
    let scene = scene(&display);
    let plain = scene.frame.clone();
    let quadrilinear = Quality { quadrilinear: true, ..Quality::default() };
    let unblended = Quality { blended: false, ..Quality::default() };
    let frames = [
        ("blended", plain.clone()),
        ("quadrilinear", FrameState { quality: quadrilinear, ..plain.clone() }),
        ("unblended", FrameState { quality: unblended, ..plain.clone() }),
    ];
    let mut pictures = Vec::new();
    for device in draw::devices() {
        for (name, frame) in &frames {
            let (complete, report) = draw_with(&mut renderer(&display, &scene.source, device, 256), frame);
            assert!(report.complete, "{}", report.shortfall);
            let mut cold = renderer(&display, &scene.source, device, 256);
            let (images, report) = come_to_rest(&mut cold, frame);
            assert_same(&images, &complete, &format!("{name} on {device:?}"));
            let upkeep = report.upkeep.unwrap();
            assert_eq!((upkeep.in_flight, upkeep.fading, upkeep.largest_deficit), (0, 0, 0.0));
            if device == DeviceChoice::Cpu {
                pictures.push(complete);
            }
        }
    }
    let planes = || draw::renderer(&display, &scene.source, &PROJECTORS, With::PLANES).0;
    let (complete, report) = draw_with(&mut planes(), &plain);
    assert!(
        report.complete && report.caster == Caster::Planes { views: 2, fans: 1, resampled: 0 },
        "{report:?}"
    );
    assert_same(&come_to_rest(&mut planes(), &plain).0, &complete, "row planes");
    // The canary: blending does something here.
    assert!(pictures[0].iter().zip(&pictures[2]).any(|(a, b)| a.rgba != b.rgba), "no borders are to be seen");
}

#[test]
fn a_cold_start_changes_no_pixel_by_much() {
    let _turn = draw::turn();
    let display = display();
    let scene = scene(&display);
    let start = |fade_s| {
        let pace = Pace::Live { upload_bytes: 4 << 20, fade_s };
        let mut cold = draw::renderer(
            &display,
            &scene.source,
            &PROJECTORS[..1],
            With { cache_bytes: 256 << 20, ..With::device(DeviceChoice::Cpu) },
        );
        cold_start(&mut cold.0, &FrameState { pace, ..scene.frame.clone() }, MOST_FRAMES, |_| true)
    };
    let eased = start(0.4);
    assert!(eased.rest_s.is_some_and(|seconds| seconds <= MOST_REST_S), "{:?}", eased.rest_s);
    assert!(eased.step.max <= MOST_STEP + 1e-6, "{}", eased.step);
    // The canary: without fades it does.
    assert!(start(0.0).step.max > 4.0 * MOST_STEP);
}

#[test]
fn a_picture_does_not_depend_on_the_other_views_of_the_back_end() {
    let _turn = draw::turn();
    let display = display();
    let scene = scene(&display);
    for device in draw::devices() {
        let both = draw::draw(&display, &scene.frame, &scene.source, &PROJECTORS, With::device(device));
        for (image, projector) in both.images.iter().zip(PROJECTORS) {
            let alone = draw::draw(&display, &scene.frame, &scene.source, &[projector], With::device(device));
            assert_same(&alone.images, std::slice::from_ref(image), "alone");
        }
    }
}

#[test]
fn a_small_cache_shows_something_that_stays() {
    let _turn = draw::turn();
    let display = display();
    let scene = scene(&display);
    let mut small = renderer(&display, &scene.source, DeviceChoice::Cpu, 6);
    let mut last = Vec::new();
    for index in 0..700 {
        let (images, report) = draw_with(&mut small, &live(&scene.frame, index));
        assert!(report.bricks_resident <= 96, "the cache holds 96 bricks");
        if index >= 500 {
            assert!(index == 500 || images == last, "frame {index} flickers: {:?}", report.upkeep);
            assert!(!report.complete && report.upkeep.unwrap().largest_deficit > 0.0);
        }
        last = images;
        std::thread::sleep(Duration::from_millis(1));
    }
    assert!(last[0].rgba.iter().any(|&c| c > 0.1), "a black picture stays, too");
}

#[test]
fn complete_and_live_frames_follow_each_other() {
    let _turn = draw::turn();
    let display = display();
    let scene = scene(&display);
    // So small that families are on their way out when a complete frame comes.
    let mut small = renderer(&display, &scene.source, DeviceChoice::Cpu, 6);
    let mut alone = renderer(&display, &scene.source, DeviceChoice::Cpu, 256);
    let (complete, report) = draw_with(&mut alone, &scene.frame);
    assert!(report.complete, "{}", report.shortfall);
    for round in 0..12 {
        for index in 0..10 * round {
            draw_with(&mut small, &live(&scene.frame, index));
            std::thread::sleep(Duration::from_millis(1));
        }
        draw_with(&mut small, &scene.frame);
    }
    for index in 0..20 {
        draw_with(&mut alone, &live(&scene.frame, index));
    }
    let (images, report) = draw_with(&mut alone, &scene.frame);
    assert!(report.complete, "{}", report.shortfall);
    assert_same(&images, &complete, "after live frames");
}

#[test]
fn a_disk_that_hangs_costs_detail_and_no_frame() {
    let _turn = draw::turn();
    let display = display();
    let scene = scene(&display);
    let faulty = FaultySource::shared(Arc::clone(&scene.source), 1, Vec::new());
    let source: Arc<dyn BrickSource> = Arc::clone(&faulty) as _;
    let (complete, _) =
        draw_with(&mut renderer(&display, &scene.source, DeviceChoice::Cpu, 256), &scene.frame);
    let mut renderer = renderer(&display, &source, DeviceChoice::Cpu, 256);
    faulty.hold();
    for index in 0..5 {
        let (_, report) = draw_with(&mut renderer, &live(&scene.frame, index));
        assert!(!report.complete && report.bricks_resident == 0, "nothing has come");
        assert!(!report.shortfall.is_empty());
    }
    faulty.release();
    for index in 5..60 {
        draw_with(&mut renderer, &live(&scene.frame, index));
        std::thread::sleep(Duration::from_millis(1));
    }
    faulty.hold();
    let (held, _) = draw_with(&mut renderer, &live(&scene.frame, 60));
    assert!(held[0].rgba.iter().any(|&c| c > 0.1), "what had come is shown");
    faulty.release();
    assert_same(&come_to_rest(&mut renderer, &scene.frame).0, &complete, "after the disk hung");
}

#[test]
fn faults_are_named_and_the_picture_is_right_wherever_data_came() {
    let _turn = draw::turn();
    let display = display();
    let scene = scene(&display);
    for seed in [1, 2, 3] {
        let damage = vec![(Fault::Damaged, 40)];
        let all = vec![
            (Fault::Damaged, 40),
            (Fault::Away(2), 60),
            (Fault::Late(Duration::from_millis(50)), 60),
            (Fault::Panic, 0),
        ];
        let with = |rates| {
            let faulty = FaultySource::shared(Arc::clone(&scene.source), seed, rates);
            faulty.give(NodeKey::ROOT, None);
            faulty
        };
        // The picture of complete frames over the same damage, without the other faults.
        let (damaged, faulty) = (with(damage), with(all));
        let (complete, told) =
            draw_with(&mut renderer(&display, &(damaged as _), DeviceChoice::Cpu, 256), &scene.frame);
        let mut renderer = renderer(&display, &(Arc::clone(&faulty) as _), DeviceChoice::Cpu, 256);
        let (mut images, mut report) = draw_with(&mut renderer, &live(&scene.frame, 0));
        // A tenth of a second a frame, so that waits for another try are over in time; bricks that are late are late by the
        // wall's clock, however fast frames are. Nothing is on its way for longer than the longest wait for another try.
        let mut quiet = 0;
        for index in 1..MOST_FRAMES {
            let frame = FrameState { time_s: f64::from(index) * 0.1, ..live(&scene.frame, index) };
            (images, report) = draw_with(&mut renderer, &frame);
            let is_quiet = report.upkeep.as_ref().is_some_and(|upkeep| upkeep.in_flight == 0);
            quiet = if is_quiet { quiet + 1 } else { 0 };
            if index >= 400 && quiet >= 50 {
                break;
            }
            std::thread::sleep(Duration::from_millis(2));
        }
        assert!(told.damaged_bricks > 0, "the faults miss the scene: {told:?}");
        assert!(report.damaged_bricks > 0 && !report.damaged.is_empty() && !report.complete, "{report:?}");
        assert_same(&images, &complete, &format!("seed {seed}"));
    }
    // A root that is away for ever is a black picture and a sentence; one that is damaged ends the run.
    let faulty = FaultySource::shared(Arc::clone(&scene.source), 9, Vec::new());
    faulty.give(NodeKey::ROOT, Some(Fault::Away(FOR_EVER)));
    let mut renderer = renderer(&display, &(faulty as _), DeviceChoice::Cpu, 256);
    for index in 0..5 {
        let (_, report) = draw_with(&mut renderer, &live(&scene.frame, index));
        assert!(report.shortfall.contains("coarsest"), "{}", report.shortfall);
    }
}

//! Row planes show what the reference has, as closely as their tolerance asks.

use display_config::Display;
use glam::{DAffine3, DVec3};
use lightloom_tests::compare::{Errors, Limits, errors, truth};
use lightloom_tests::draw::{self, With, draw};
use lightloom_tests::scenes::{self, TestScene};
use lightloom_tests::twin_scene::{TwinScene, view};
use optics::{Curve, Quality};
use planes::{Fan, Fans, Planes, Scratch};
use protocol::{Caster, CasterChoice, DeviceChoice};
use twin::{FeedbackCell, ProjectorRays, SceneNumbers};

const PROJECTORS: [u32; 8] = [0, 1, 2, 3, 4, 5, 6, 7];
const COMPARED: [u32; 2] = [0, 5];
const SHARED: Caster = Caster::Planes { views: 8, fans: 1, resampled: 0 };

fn display() -> Display {
    scenes::small_desk8(64, 48)
}

/// What planes keep at default quality, about 1.4 times what they err: most of it is what a scalar half-way between two samples
/// is off, where it was thought to be small enough.
pub fn promised(display: &Display) -> Vec<(TestScene, Limits)> {
    let mut all = vec![
        (scenes::shells(display), Limits::of_255(0.25, 4.0, 6.0)),
        (scenes::marschner_lobb(display), Limits::of_255(0.9, 10.0, 11.0)),
        (scenes::sparse_vessels(display), Limits::of_255(0.3, 6.0, 13.0)),
        (scenes::stored_vessels(display), Limits::of_255(0.35, 8.0, 13.0)),
        (scenes::noise(display), Limits::of_255(2.0, 13.0, 16.0)),
    ];
    all.extend(scenes::cranium(display).map(|scene| (scene, Limits::of_255(0.5, 6.0, 9.0))));
    all.extend(scenes::head_mri(display).map(|scene| (scene, Limits::of_255(0.7, 8.0, 12.0))));
    all
}

fn errors_of(display: &Display, scene: &TestScene, quality: Quality) -> Errors {
    let mut frame = scene.frame.clone();
    let truth = truth(display, &frame, &scene.source, &COMPARED, 2);
    frame.quality = quality;
    let drawn = draw(display, &frame, &scene.source, &PROJECTORS, With::PLANES);
    assert_eq!(drawn.report.caster, SHARED);
    assert!(drawn.report.complete, "{}", drawn.report.shortfall);
    errors(&drawn.images, &truth)
}

#[test]
fn planes_keep_their_promise_and_come_nearer_with_the_tolerance() {
    let _turn = draw::turn();
    let display = display();
    for (scene, limits) in promised(&display) {
        let quality = scene.frame.quality;
        let found = errors_of(&display, &scene, quality);
        let close = errors_of(&display, &scene, Quality { tolerance: quality.tolerance / 4.0, ..quality });
        println!("{:20} {found}; at a quarter of the tolerance {close}", scene.name);
        assert!(limits.hold(&found), "{}: {found}", scene.name);
        // Samples twice as close; a kink between two of them costs more than the square of their distance.
        assert!(close.rms < 0.5 * found.rms + 0.01 / 255.0, "{}: {close} after {found}", scene.name);
    }
}

#[test]
fn a_medium_that_is_too_thick_by_a_twentieth_is_found() {
    let _turn = draw::turn();
    let display = display();
    let scene = scenes::shells(&display);
    let (_, limits) = promised(&display).swap_remove(0);
    let truth = truth(&display, &scene.frame, &scene.source, &COMPARED, 2);
    let mut frame = scene.frame.clone();
    frame.optics.extinction = scenes::scaled(&frame.optics.extinction, 1.05);
    let spoiled = errors(&draw(&display, &frame, &scene.source, &PROJECTORS, With::PLANES).images, &truth);
    assert!(!limits.hold(&spoiled), "{spoiled}");
}

/// Where samples are too far apart, rays sample for themselves, and halve a cell as long as what they meet asks for it. Once, each
/// cell was halved to the end if the transfer function was not smooth anywhere, even at scalars that no voxel has.
#[test]
fn a_spike_that_no_scalar_meets_asks_for_no_samples() {
    let _turn = draw::turn();
    let display = display();
    let scene = scenes::marschner_lobb(&display);
    let samples = |beyond: &[(f64, f64)]| {
        let surface = [(0.45, 0.0), (0.6, 1.5)];
        let mut frame = scene.frame.clone();
        frame.optics = scenes::optics(
            (0.0, 2.0),
            &surface.iter().chain(beyond).copied().collect(),
            &vec![(0.0, [0.2, 0.5, 0.9]), (0.9, [0.9, 0.8, 0.3])],
        );
        draw(&display, &frame, &scene.source, &PROJECTORS, With::PLANES).report.samples
    };
    let (smooth, spiked) = (samples(&[]), samples(&[(1.5, 1.5), (1.51, 300.0), (1.52, 1.5)]));
    println!("{smooth} samples, {spiked} with the spike");
    // Some cells lie on a border of the table's.
    assert!(spiked <= smooth + smooth / 20, "{spiked} samples instead of {smooth}");
}

/// A scene's numbers, and the rays of all views.
fn views_of(display: &Display, scene: &TestScene) -> (SceneNumbers<f32>, Vec<ProjectorRays<f32>>) {
    let view = |&projector: &u32| view(display, projector, &scene.frame, &*scene.source).rounded();
    let views: Vec<_> = PROJECTORS.iter().map(view).collect();
    (views[0].scene, views.iter().map(|view| view.rays).collect())
}

/// The fan of views that all share planes.
fn only(fans: &Fans) -> &Fan {
    assert_eq!(fans.count(), 1);
    fans.iter().next().unwrap()
}

/// The rows of all views, as bytes.
fn rows(planes: &Planes, fan: &Fan, views: usize) -> Vec<u32> {
    let mut scratch = Scratch::default();
    let mut bytes = Vec::new();
    for row in 0..fan.raster[1] {
        let mut pixels = vec![vec![0.0f32; 4 * fan.raster[0] as usize]; views];
        let mut out: Vec<&mut [f32]> = pixels.iter_mut().map(Vec::as_mut_slice).collect();
        planes.cast_row(row, &mut scratch, &mut out);
        bytes.extend(pixels.iter().flatten().map(|value| value.to_bits()));
    }
    bytes
}

#[test]
fn every_level_of_instructions_gives_the_same_bytes() {
    let _turn = draw::turn();
    let display = display();
    for scene in [scenes::shells(&display), scenes::stored_vessels(&display), scenes::noise(&display)] {
        let twin = TwinScene::new(&display, &scene.frame, &*scene.source);
        let (numbers, rays) = views_of(&display, &scene);
        let fans = Fans::of(&rays).unwrap();
        let fan = only(&fans);
        let feedback: Vec<FeedbackCell> = twin.nodes.iter().map(|_| FeedbackCell::default()).collect();
        let casting = twin.casting(&numbers, &feedback);
        let best = rows(&Planes::new(&casting, fan, &[]), fan, rays.len());
        let plain = rows(&Planes::new(&casting, fan, &[]).plainly(), fan, rays.len());
        assert!(best == plain, "{}", scene.name);
        assert!(best.iter().any(|&bits| f32::from_bits(bits) > 0.1), "a black picture proves nothing");
        assert!(feedback.iter().any(|cell| cell.entry().rays > 0), "{}: no node was noted", scene.name);
    }
}

#[test]
fn a_view_is_the_same_whoever_shares_its_rows() {
    let _turn = draw::turn();
    let display = display();
    let mut all = vec![scenes::stored_vessels(&display), beyond_the_screen(&display)];
    all.extend(scenes::cranium(&display));
    for scene in all {
        let twin = TwinScene::new(&display, &scene.frame, &*scene.source);
        let (numbers, rays) = views_of(&display, &scene);
        let feedback: Vec<FeedbackCell> = twin.nodes.iter().map(|_| FeedbackCell::default()).collect();
        let casting = twin.casting(&numbers, &feedback);
        let cast = |rays: &[_]| {
            let fans = Fans::of(rays).unwrap();
            let fan = only(&fans);
            rows(&Planes::new(&casting, fan, &[]), fan, rays.len())
        };
        let together = cast(&rays);
        for index in [1, 6] {
            // The rows of all views follow each other, row by row.
            let pixels = 4 * rays[index].raster[0] as usize;
            let of_view = together.chunks_exact(pixels).skip(index).step_by(rays.len()).flatten();
            let alone = cast(&[rays[index]]);
            assert!(of_view.eq(&alone), "{}: view {index}", scene.name);
        }
    }
}

/// Shells wider than the screen, around it: rays come to its sides from beyond them.
fn beyond_the_screen(display: &Display) -> TestScene {
    let mut scene = scenes::shells(display);
    let larger = DAffine3::from_scale(DVec3::splat(4.0));
    scene.frame.display_from_volume = larger * scene.frame.display_from_volume;
    scene
}

#[test]
fn auto_casts_planes_where_many_views_share_them() {
    let _turn = draw::turn();
    let small = |preset: &str| Display::load(preset).unwrap().with_rasters(32, 24);
    let caster_at = |tolerance: f64, display: &Display, device: DeviceChoice, projectors: &[u32]| {
        let mut scene = scenes::shells(display);
        scene.frame.quality.tolerance = tolerance;
        let with = With { caster: CasterChoice::Auto, ..With::device(device) };
        draw(display, &scene.frame, &scene.source, projectors, with).report.caster.to_string()
    };
    let caster = |display: &Display, device: DeviceChoice, projectors: &[u32]| {
        caster_at(Quality::default().tolerance, display, device, projectors)
    };
    let (wide, desk) = (small("holo72"), small("desk8"));
    // Whoever draws only some of a display's views casts like those who draw the others.
    assert_eq!(caster(&wide, DeviceChoice::Cpu, &[0, 5, 70]), "row planes, each for 3 views");
    let few = "rays: the display has fewer than 24 projectors, too few for row planes to save time";
    assert_eq!(caster(&desk, DeviceChoice::Cpu, &[0, 5]), few);
    let gpu = "rays: on a GPU row planes have not been timed against rays yet";
    assert_eq!(caster(&wide, DeviceChoice::Gpu, &[0]), gpu);
    let exact = "rays: the tolerance is below 3e-5, where row planes err by more than it allows or take longer than rays";
    assert_eq!(caster_at(2e-5, &wide, DeviceChoice::Cpu, &[0]), exact);
}

#[test]
fn what_planes_cannot_draw_is_refused_by_name() {
    let display = display();
    let scene = scenes::shells(&display);
    let mut frame = scene.frame.clone();
    frame.optics.refraction = Some(Curve::new(vec![(0.0, 1.0), (1.0, 1.2)]).unwrap());
    let (mut renderer, _) = draw::renderer(&display, &scene.source, &PROJECTORS, With::PLANES);
    let error = renderer.draw(&frame, &mut |_| {}).unwrap_err().to_string();
    assert_eq!(error, "row planes cannot draw this frame: light is bent; --caster rays can");
    // The renderer goes on.
    assert!(renderer.draw(&scene.frame, &mut |_| {}).unwrap().complete);
}

//! Debug views tell of the working set what is so, on the GPU as on the CPU, and leave the casting alone.

use display_config::Display;
use lightloom_tests::compare::{Limits, errors_between};
use lightloom_tests::draw::{self, Drawn, With, draw_with, renderer};
use lightloom_tests::scenes::{self, TestScene};
use optics::DebugView;
use protocol::{DeviceChoice, FilterChoice};
use twin::debug::heat;

const PROJECTORS: [u32; 2] = [1, 5];

/// Light of one colour adds up to that colour times its opacity, but for the rounding of some hundred steps.
const ROUNDING: f64 = 1e-5;

/// As pictures, see `devices`. Where a length sits on a whole number of steps, rounding gives kernel or twin one
/// sample more, which a dark ray shows as up to a few codes.
const SAME_TO_ROUNDING: Limits = Limits::of_255(0.05, 1.0, 12.0);

fn scene(display: &Display, lod_scale: f64, debug: Option<DebugView>) -> TestScene {
    let mut scene = scenes::shells(display);
    scene.frame.quality.lod_scale = lod_scale;
    scene.frame.debug = debug;
    scene
}

fn display() -> Display {
    Display::load("desk8").unwrap().with_rasters(96, 72)
}

fn drawn(device: DeviceChoice, lod_scale: f64, debug: Option<DebugView>) -> Drawn {
    let display = display();
    let scene = scene(&display, lod_scale, debug);
    let with = With { filter: FilterChoice::Exact, ..With::device(device) };
    let (mut renderer, info) = renderer(&display, &scene.source, &PROJECTORS, with);
    // The first frame may cast some rays again after it has loaded what they missed; the second casts each once.
    draw_with(&mut renderer, &scene.frame);
    let (images, report) = draw_with(&mut renderer, &scene.frame);
    Drawn { images, report, info }
}

/// Whether all light has the colour at x, as opaque as in the picture itself.
fn is_of_one_colour(picture: &Drawn, shown: &Drawn, x: f64) -> bool {
    let colour = heat(x).0;
    let pixels = |drawn: &Drawn| drawn.images.iter().flat_map(|i| i.rgba.clone()).collect::<Vec<f32>>();
    let (picture, shown) = (pixels(picture), pixels(shown));
    assert!(picture.chunks(4).any(|pixel| pixel[3] > 0.5), "nothing is to be seen");
    picture.chunks(4).zip(shown.chunks(4)).all(|(picture, shown)| {
        let alpha = f64::from(shown[3]);
        let is_lit = |c: usize| (f64::from(shown[c]) - alpha * colour[c]).abs() < ROUNDING;
        shown[3] == picture[3] && (0..3).all(is_lit)
    })
}

#[test]
fn the_finest_level_is_all_blue_and_all_its_own() {
    let _turn = draw::turn();
    for device in draw::devices() {
        let picture = drawn(device, 0.0, None);
        for (view, x) in [(DebugView::Lod, 0.2), (DebugView::Deficit, 0.2), (DebugView::Weights, 0.8)] {
            let shown = drawn(device, 0.0, Some(view));
            assert!(is_of_one_colour(&picture, &shown, x), "{device:?}, {view:?}");
            assert!(!is_of_one_colour(&picture, &shown, x + 0.05), "{device:?}, {view:?}: any colour passes");
            assert_eq!(shown.report.samples, picture.report.samples, "{device:?}, {view:?}");
        }
        // Voxels may be as long as they like: the root is fine enough.
        let coarse = drawn(device, 1e3, None);
        let shown = drawn(device, 1e3, Some(DebugView::Lod));
        assert!(!is_of_one_colour(&coarse, &shown, 0.2), "{device:?}: coarse levels look like the finest");
    }
}

#[test]
fn samples_are_counted_ray_by_ray() {
    let _turn = draw::turn();
    for device in draw::devices() {
        let picture = drawn(device, 1.0, None);
        let shown = drawn(device, 1.0, Some(DebugView::Samples));
        assert_eq!(shown.report.samples, picture.report.samples, "{device:?}");
        // Every colour is that of a whole number of samples, and the numbers add up to the report's.
        let counts: Vec<[f32; 3]> = (0..=1024)
            .map(|n| heat(DebugView::Samples.place(f64::from(n))).0.map(|c: f64| c as f32))
            .collect();
        let count = |pixel: &[f32]| {
            let distance = |n: &usize| (0..3).map(|c| (counts[*n][c] - pixel[c]).abs()).fold(0.0, f32::max);
            let nearest = (0..counts.len()).min_by(|a, b| distance(a).total_cmp(&distance(b))).unwrap();
            assert!(distance(&nearest) < 1e-5 && pixel[3] == 1.0, "{device:?}: {pixel:?} is no count");
            nearest as u64
        };
        let total: u64 = shown.images.iter().flat_map(|image| image.rgba.chunks(4)).map(count).sum();
        assert_eq!(total, shown.report.samples, "{device:?}");
    }
}

#[test]
fn kernel_and_twin_show_the_same() {
    let _turn = draw::turn();
    if !draw::has_gpu() {
        return;
    }
    for view in DebugView::ALL {
        let shown = [DeviceChoice::Cpu, DeviceChoice::Gpu].map(|device| drawn(device, 1.0, Some(view)));
        let errors = errors_between(&shown[1].images, &shown[0].images);
        println!("{view:?}: {errors}");
        assert!(SAME_TO_ROUNDING.hold(&errors), "{view:?}: {errors}");
        // The canary: another view does not pass for this one.
        let other = if view == DebugView::Samples { DebugView::Lod } else { DebugView::Samples };
        let other = drawn(DeviceChoice::Cpu, 1.0, Some(other));
        assert!(!SAME_TO_ROUNDING.hold(&errors_between(&shown[1].images, &other.images)));
    }
}

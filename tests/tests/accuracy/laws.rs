//! Laws that whole pictures obey, on both devices.

use bricks::BrickSource;
use bricks::procedural::ProceduralVolume;
use display_config::{Display, Homography};
use glam::{DQuat, DVec2, UVec3};
use lightloom_tests::closure_volume::ClosureVolume;
use lightloom_tests::compare::{Limits, errors_between};
use lightloom_tests::draw::{self, With, draw, draw_with, renderer};
use lightloom_tests::scenes::{self, TestScene, frame, optics, placed};
use optics::{Curve, Light, Mimda, MimdaForm};
use protocol::{DeviceChoice, FrameState, ProjectorImage};
use std::sync::Arc;

/// On a GPU a sample's place is counted in texels of the whole atlas, so what rounding does depends on the slots that
/// bricks got, and those on the order in which loaders delivered them. The CPU device counts from the brick's corner.
const OTHER_SLOTS: Limits = Limits::of_255(0.002, 0.02, 1.0);

/// Whether two pictures are the same: to the bit on the CPU, on a GPU as far as slots leave them.
fn same(device: DeviceChoice, a: &[ProjectorImage], b: &[ProjectorImage]) -> bool {
    match device {
        DeviceChoice::Cpu => a == b,
        DeviceChoice::Gpu | DeviceChoice::Auto => {
            let errors = errors_between(a, b);
            if errors.max > 0.0 {
                println!("{device:?}: {errors}");
            }
            OTHER_SLOTS.hold(&errors)
        }
    }
}

fn desk8() -> Display {
    Display::load("desk8").unwrap()
}

/// Where a chord begins and ends is rounded in f32: 1.2 m away, in voxels of some 5 mm, with two roundings at each end
/// and a few between.
const CHORD_VOXELS: f64 = 2e-4;
/// A few dozen segments composited in f32.
const ROUNDING: f64 = 1e-5;

/// The chord of each pixel of projector 3 through the box, voxels.
fn chords(display: &Display, frame: &FrameState, dims: UVec3) -> Vec<f64> {
    let law = display.beam_law(3, frame.observer_in_display, frame.eta).unwrap();
    let raster = &display.projectors[3].raster;
    let inverse = frame.display_from_volume.inverse();
    let pixels = (0..raster.height).flat_map(|y| (0..raster.width).map(move |x| (x, y)));
    pixels
        .map(|(x, y)| {
            let ray = law.ray(raster.pixel_on_screen(x, y));
            let origin = inverse.transform_point3(ray.origin_in_display);
            let along = inverse.transform_vector3(ray.direction_in_display);
            let (a, b) = (-origin / along, (dims.as_dvec3() - origin) / along);
            let (enter, leave) = (a.min(b).max_element().max(0.0), a.max(b).min_element());
            (leave - enter).max(0.0) * along.length()
        })
        .collect()
}

/// The share of pixels whose opacity is that of a chord not more than `CHORD_VOXELS` off.
fn share_right(image: &ProjectorImage, chords: &[f64], kappa: f64) -> f64 {
    let opacity = |chord: f64| -(-kappa * chord.max(0.0)).exp_m1();
    let is_right = |(pixel, &chord): (&[f32], &f64)| {
        let (low, high) = (opacity(chord - CHORD_VOXELS), opacity(chord + CHORD_VOXELS));
        let found = f64::from(pixel[3]);
        let colours_follow = [1.0, 0.5, 0.25]
            .iter()
            .zip(pixel)
            .all(|(c, &n)| (f64::from(n) - c * found).abs() <= ROUNDING * found);
        found >= low * (1.0 - ROUNDING) && found <= high * (1.0 + ROUNDING) && colours_follow
    };
    let right = image.rgba.chunks_exact(4).zip(chords).filter(|&pair| is_right(pair)).count();
    right as f64 / chords.len() as f64
}

#[test]
fn a_constant_medium_has_the_opacity_of_its_chord() {
    let _turn = draw::turn();
    let display = desk8().with_rasters(80, 60);
    let dims = UVec3::new(57, 40, 29);
    let source: Arc<dyn BrickSource> = Arc::new(ClosureVolume::new(dims, (0.0, 1.0), |_| 0.5));
    let place = placed(&*source, 0.6 * display.height_m, DQuat::from_rotation_y(0.4));
    let colour = vec![(0.0, [1.0, 0.5, 0.25])];
    for device in draw::devices() {
        for exponent in [-6, -4, -2, -1, 0, 1, 2, 4, 6] {
            let kappa = 10f64.powi(exponent);
            let picture = |kappa: f64, light| {
                let mut frame =
                    frame(&display, place, optics((0.0, 1.0), &vec![(0.0, kappa)], &colour), light);
                frame.quality.termination = 0.0;
                let drawn = draw(&display, &frame, &source, &[3], With::device(device));
                (share_right(&drawn.images[0], &chords(&display, &frame, dims), kappa), drawn)
            };
            // Where nothing changes there is no gradient, and light shows the plain colour.
            for light in [None, Some(Light::default())] {
                let (right, drawn) = picture(kappa, light);
                let lit = drawn.images[0].rgba.chunks_exact(4).filter(|p| p[3] > 0.0).count();
                assert!(right == 1.0 && lit > 500, "{device:?}, κ = 1e{exponent}: {right} right, {lit} lit");
            }
        }
        // The canary: a thousandth more.
        let drawn = {
            let optics = optics((0.0, 1.0), &vec![(0.0, 0.01 * 1.001)], &colour);
            draw(&display, &frame(&display, place, optics, None), &source, &[3], With::device(device))
        };
        let chords = chords(
            &display,
            &frame(&display, place, optics((0.0, 1.0), &vec![(0.0, 0.01)], &colour), None),
            dims,
        );
        let right = share_right(&drawn.images[0], &chords, 0.01);
        println!(
            "{device:?}: with 0.1 % more extinction {:.1} % of the pixels are still right",
            100.0 * right
        );
        assert!(right < 0.95);
    }
}

/// desk8 with two projectors, one for each half of the screen: they need different bricks.
fn halves() -> Display {
    let mut display = desk8().with_rasters(160, 120);
    display.projectors = display.projectors[3..5].to_vec();
    let half = DVec2::new(0.5 * display.width_m, display.height_m);
    for (projector, left) in display.projectors.iter_mut().zip([-half.x, 0.0]) {
        let lower_left = DVec2::new(left, -0.5 * half.y);
        projector.raster.screen_from_pixel =
            Homography::of_rectangle(projector.raster.size(), lower_left, half);
    }
    display
}

#[test]
fn a_small_cache_gives_the_same_bytes_where_it_suffices() {
    let _turn = draw::turn();
    let display = halves();
    let mut scene = scenes::sparse_vessels(&display);
    // The finest level everywhere: more bricks than the 256 that a GPU's cache holds at least.
    scene.frame.quality.lod_scale = 0.0;
    let everyone = [0, 1];
    for device in draw::devices() {
        let pictures = |bricks: u64| {
            let with = With { cache_bytes: bricks * 65536, ..With::device(device) };
            draw(&display, &scene.frame, &scene.source, &everyone, with)
        };
        let large = pictures(1 << 12);
        assert!(large.report.complete);
        let all = large.report.bricks_resident;
        let (mut settled, mut short) = (Vec::new(), Vec::new());
        for percent in [95, 90, 85, 80, 70, 60, 40, 20] {
            let small = pictures(all * percent / 100);
            if small.report.complete {
                assert!(same(device, &small.images, &large.images), "{device:?}: {percent} % of the bricks");
                settled.push(percent);
            } else {
                // The canary: a cache that does not suffice says so, and the comparison sees it.
                assert!(!same(device, &small.images, &large.images), "{device:?}: {percent} %");
                short.push(percent);
            }
        }
        println!("{device:?}: of {all} bricks, {settled:?} % settle, {short:?} % do not");
        // A GPU's atlas has at least 256 slots, whatever the cache's size: 80 % of these bricks, so that none of the caches is
        // too small there.
        let must_be_short = device == DeviceChoice::Cpu;
        assert!(
            !settled.is_empty() && (!must_be_short || !short.is_empty()),
            "{device:?}: {settled:?} {short:?}"
        );
    }
}

#[test]
fn what_was_drawn_before_leaves_no_trace() {
    let _turn = draw::turn();
    let display = desk8().with_rasters(160, 120);
    let scene = scenes::shells(&display);
    let mut elsewhere = scene.frame.clone();
    elsewhere.display_from_volume = placed(&*scene.source, 2.0, DQuat::from_rotation_y(-0.7));
    elsewhere.quality.lod_scale = 0.5;
    elsewhere.optics.extinction = Curve::constant(0.01);
    for device in draw::devices() {
        let with = With { cache_bytes: 128 * 65536, ..With::device(device) };
        let fresh = draw(&display, &scene.frame, &scene.source, &[1, 5], with);
        let (mut used, _) = renderer(&display, &scene.source, &[1, 5], with);
        let (others, _) = draw_with(&mut used, &elsewhere);
        let (again, report) = draw_with(&mut used, &scene.frame);
        assert!(fresh.report.complete && report.complete, "{device:?}: {}", report.shortfall);
        assert!(same(device, &again, &fresh.images) && !same(device, &others, &fresh.images), "{device:?}");
    }
}

#[test]
fn asking_for_the_finest_level_is_asking_for_finer_than_there_is() {
    let _turn = draw::turn();
    let display = desk8().with_rasters(160, 120);
    let scene = scenes::shells(&display);
    for device in draw::devices() {
        let at = |lod_scale: f64| {
            let mut frame = scene.frame.clone();
            frame.quality.lod_scale = lod_scale;
            draw(&display, &frame, &scene.source, &[1, 5], With::device(device)).images
        };
        let finest = at(0.0);
        assert!(same(device, &finest, &at(1e-6)), "{device:?}");
        assert!(!same(device, &finest, &at(4.0)), "{device:?}: coarser levels show the same");
    }
}

#[test]
fn mimda_with_gamma_zero_is_ordinary_compositing_to_the_bit() {
    let _turn = draw::turn();
    let display = desk8().with_rasters(160, 120);
    let TestScene { frame, .. } = scenes::shells(&display);
    // One brick has one slot, so that a GPU, too, can be held to the bit.
    let source: Arc<dyn BrickSource> =
        Arc::new(ProceduralVolume::new("shells", UVec3::splat(28), 1e-3).unwrap());
    let frame =
        FrameState { display_from_volume: placed(&*source, 0.3, DQuat::from_rotation_y(0.4)), ..frame };
    for device in draw::devices() {
        let with = |mimda: Option<(MimdaForm, f64)>| {
            let mut frame = frame.clone();
            let importance = Curve::new(vec![(0.3, 0.0), (0.8, 1.0)]).unwrap();
            frame.optics.mimda = mimda.map(|(form, gamma)| Mimda { importance, gamma, form });
            draw(&display, &frame, &source, &[1, 5], With::device(device)).images
        };
        let plain = with(None);
        for form in [MimdaForm::Paper, MimdaForm::Consistent] {
            assert!(with(Some((form, 0.0))) == plain, "{device:?}, {form:?}");
            assert!(with(Some((form, 0.01))) != plain, "{device:?}, {form:?}: a little of it shows nothing");
        }
    }
}

#[test]
fn splitting_projectors_over_renderers_gives_the_same_bytes() {
    let _turn = draw::turn();
    let display = desk8().with_rasters(160, 120);
    let scene = scenes::shells(&display);
    for device in draw::devices() {
        let draw = |projectors: &[u32]| {
            let mut images =
                draw(&display, &scene.frame, &scene.source, projectors, With::device(device)).images;
            images.sort_by_key(|image| image.projector);
            images
        };
        let together = draw(&[0, 1, 2, 3, 4, 5, 6, 7]);
        for split in [&[&[0u32, 1, 2, 3][..], &[4, 5, 6, 7]][..], &[&[6, 1], &[7, 0, 3], &[2], &[5, 4]]] {
            let mut apart: Vec<ProjectorImage> = split.iter().flat_map(|share| draw(share)).collect();
            apart.sort_by_key(|image| image.projector);
            assert!(same(device, &apart, &together), "{device:?}: {split:?}");
            apart[2].rgba.rotate_left(4);
            assert!(!same(device, &apart, &together), "{device:?}: a picture moved by a pixel passes");
        }
    }
}

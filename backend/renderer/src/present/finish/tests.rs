//! Laws of the codes of projectors: against the reference, on random maps; where light lands; and what changes nothing.

use super::*;
use crate::output::srgb_code;
use display_config::{BlackLevel, Finish, Homography, LightMap, Mesh, Raster, Response, Transfer};
use glam::{DVec2, DVec3, Vec2};
use proptest::prelude::*;
use proptest::test_runner::{RngSeed, TestRunner};
use reference::{Filter, FinishTruth};
use std::cell::Cell;

/// By how much the light of a pixel may differ from the reference's: f32 places in a picture of noise.
const LIGHT_TOLERANCE: f64 = 2e-5;
/// Where a point of the screen may land beside the place that the mesh gives it, pixels.
const LANDING_PX: f64 = 0.1;
const SCREEN_M: DVec2 = DVec2::new(0.6, 0.45);

fn projector(width: u32, height: u32, screen_from_pixel: Homography, finish: Finish) -> Projector {
    let raster = Raster { width, height, screen_from_pixel, output: None };
    let centre_in_display = DVec3::new(0.1, 0.0, -1.5);
    Projector { name: "p".into(), centre_in_display, raster, backend: 0, finish }
}

fn whole_screen(width: u32, height: u32) -> Homography {
    Homography::of_rectangle(DVec2::new(width.into(), height.into()), -SCREEN_M / 2.0, SCREEN_M)
}

/// Where a place of the raster, from −1 to 1 (right, down), falls through a lens with a barrel's distortion, mirrored in x and
/// set off the middle: no two directions can be mistaken for each other.
fn barrel(at: DVec2) -> DVec2 {
    let bent = at * (1.0 - 0.06 * at.length_squared());
    DVec2::new(-0.27 * bent.x + 0.012, -0.2 * bent.y - 0.007 + 0.01 * bent.x)
}

fn mesh_of(columns: u32, rows: u32, place: impl Fn(DVec2) -> DVec2) -> Mesh {
    let along = |i: u32, count: u32| 2.0 * f64::from(i) / f64::from(count - 1) - 1.0;
    let point = |i: u32| place(DVec2::new(along(i % columns, columns), along(i / columns, rows))).as_vec2();
    Mesh::new(columns, rows, (0..columns * rows).map(point).collect()).unwrap()
}

/// A picture of a colour for each pixel.
fn picture(width: u32, height: u32, colour: impl Fn(u32, u32) -> [f32; 3]) -> Vec<f32> {
    let pixels = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
    pixels.flat_map(|(x, y)| colour(x, y).into_iter().chain([1.0])).collect()
}

prop_compose! {
    fn light_map()(width in 1_u32..9, height in 1_u32..9)(
        shares in prop::collection::vec(any::<u16>(), (width * height) as usize), width in Just(width), height in Just(height),
    ) -> LightMap {
        LightMap::new(width, height, shares).unwrap()
    }
}

prop_compose! {
    // Bent by up to a tenth of the screen, turned, mirrored or not; parts may lie beside the screen.
    fn mesh()(size in [2_u32..9, 2_u32..9], bend in prop::array::uniform4(-0.1..0.1), turn in -0.3..0.3, mirror in any::<bool>())
        -> Mesh {
        let place = |at: DVec2| {
            let bent = at + DVec2::new(bend[0] * at.y * at.y + bend[1], bend[2] * at.x * at.x + bend[3]) * 0.5;
            let upright = DVec2::new(if mirror { -bent.x } else { bent.x }, -bent.y);
            DVec2::from_angle(turn).rotate(upright * SCREEN_M * 0.5)
        };
        mesh_of(size[0], size[1], place)
    }
}

fn transfer() -> impl Strategy<Value = Transfer> {
    let response = |knots: &[(f64, u8)]| Response::new(knots.to_vec()).unwrap();
    let red = response(&[(0.0, 0), (0.1, 90), (0.9, 240), (1.4, 255)]);
    let measured = [red.clone(), response(&[(0.02, 5), (0.7, 250)]), red];
    prop_oneof![
        Just(Transfer::Srgb),
        (1.0..3.0).prop_map(Transfer::Gamma),
        Just(Transfer::Measured(Box::new(measured)))
    ]
}

prop_compose! {
    fn finish()(
        mesh in prop::option::of(mesh()), blend in prop::option::of(light_map()), map in light_map(), kind in 0..3,
        transfer in transfer(), is_dithered in any::<bool>(),
    ) -> Finish {
        let blacks = [None, Some(BlackLevel::Level([0.01, 0.0, 0.05])), Some(BlackLevel::Map(map))];
        Finish { mesh, blend, black: blacks[kind as usize].clone(), transfer, is_dithered }
    }
}

prop_compose! {
    fn seen()(finish in finish(), width in 1_u32..40, height in 1_u32..30, corners in prop::array::uniform4(-0.05..0.05))(
        // Beyond white and below black, too.
        rgba in prop::collection::vec(-0.1_f32..1.2, (4 * width * height) as usize),
        finish in Just(finish), width in Just(width), height in Just(height), corners in Just(corners),
    ) -> (Projector, Vec<f32>) {
        let half = SCREEN_M / 2.0;
        let jittered = [(-1.0, 1.0), (1.0, 1.0), (1.0, -1.0), (-1.0, -1.0)].map(|(x, y)| DVec2::new(x, y) * half);
        let jittered = std::array::from_fn(|i| jittered[i] + corners[i]);
        let pixels = DVec2::new(width.into(), height.into());
        (projector(width, height, Homography::of_corners(pixels, jittered).unwrap(), finish), rgba)
    }
}

/// Codes that the reference does not allow, and those that it leaves no choice of; of how many.
fn judge(found: &[u8], truth: &FinishTruth<'_>, width: u32) -> (usize, usize) {
    let (mut wrong, mut certain) = (0, 0);
    for (codes, i) in found.chunks_exact(3).zip(0..) {
        for (code, [low, high]) in codes.iter().zip(truth.codes(i % width, i / width, LIGHT_TOLERANCE)) {
            wrong += usize::from(!(low..=high).contains(code));
            certain += usize::from(low == high);
        }
    }
    (wrong, certain)
}

#[test]
fn codes_are_the_reference_s() {
    let seed = RngSeed::Fixed(17);
    let config = ProptestConfig { rng_seed: seed, failure_persistence: None, ..ProptestConfig::default() };
    // Of all codes, those that the reference leaves no choice of: dark ones of a steep transfer curve are few of them.
    let (certain_of_all, all) = (Cell::new(0), Cell::new(0));
    let law = |(projector, rgba): (Projector, Vec<f32>)| {
        let codes = Finisher::new(&projector).codes(&rgba);
        let truth = FinishTruth::new(&projector, &rgba, Filter::Cubic);
        let (wrong, certain) = judge(&codes, &truth, projector.raster.width);
        certain_of_all.set(certain_of_all.get() + certain);
        all.set(all.get() + codes.len());
        prop_assert_eq!(wrong, 0);
        Ok(())
    };
    TestRunner::new(config).run(&seen(), law).unwrap();
    let (certain, all) = (certain_of_all.get(), all.get());
    assert!(4 * certain > 3 * all, "{certain} of {all}");
}

/// A picture of smooth waves, and a projector with every stage.
fn whole() -> (Projector, Vec<f32>) {
    let blend = LightMap::new(3, 2, vec![65535, 40000, 65535, 20000, 65535, 50000]).unwrap();
    let finish = Finish {
        mesh: Some(mesh_of(17, 13, barrel)),
        blend: Some(blend),
        black: Some(BlackLevel::Level([0.02, 0.03, 0.04])),
        transfer: Transfer::Gamma(2.2),
        is_dithered: true,
    };
    let wave = |x: u32, y: u32| [0.5 + 0.4 * (x as f32 * 0.3).sin(), y as f32 / 48.0, 0.3];
    (projector(64, 48, whole_screen(64, 48), finish), picture(64, 48, wave))
}

/// The canaries of the law above: the reference notices every stage that is left out, and a mesh upside down.
#[test]
fn a_stage_that_is_left_out_is_noticed() {
    let (projector, rgba) = whole();
    let truth = FinishTruth::new(&projector, &rgba, Filter::Cubic);
    let wrong = |finish: Finish| {
        let spoiled = Projector { finish, ..projector.clone() };
        judge(&Finisher::new(&spoiled).codes(&rgba), &truth, 64).0
    };
    let right = &projector.finish;
    assert_eq!(wrong(right.clone()), 0);
    let upside_down = mesh_of(17, 13, |at| barrel(at * DVec2::new(1.0, -1.0)));
    for (what, spoiled) in [
        ("no mesh", Finish { mesh: None, ..right.clone() }),
        ("upside down", Finish { mesh: Some(upside_down), ..right.clone() }),
        ("no blend", Finish { blend: None, ..right.clone() }),
        ("no black level", Finish { black: None, ..right.clone() }),
        ("sRGB", Finish { transfer: Transfer::Srgb, ..right.clone() }),
        ("no dither", Finish { is_dithered: false, ..right.clone() }),
    ] {
        let wrong = wrong(spoiled);
        assert!(wrong > 500, "{what}: {wrong} of {}", 3 * 64 * 48);
    }
    let bilinear = FinishTruth::new(&projector, &rgba, Filter::Bilinear);
    assert!(judge(&Finisher::new(&projector).codes(&rgba), &bilinear, 64).0 > 100, "another filter");
}

#[test]
fn a_finish_that_is_the_identity_gives_the_bytes_of_a_png() {
    let rgba: Vec<f32> = (0..4 * 37 * 23).map(|i| (i as f32 * 0.37).sin() * 0.8 + 0.4).collect();
    let plain = projector(37, 23, whole_screen(37, 23), Finish::default());
    let expected: Vec<u8> = rgba.chunks_exact(4).flat_map(|p| [p[0], p[1], p[2]].map(srgb_code)).collect();
    assert_eq!(Finisher::new(&plain).codes(&rgba), expected);
    let spoiled = Finish { transfer: Transfer::Gamma(2.2), ..Finish::default() };
    assert_ne!(Finisher::new(&Projector { finish: spoiled, ..plain }).codes(&rgba), expected);
}

#[test]
fn what_is_no_number_or_not_there_is_black_and_beside_the_picture_it_is_dark() {
    let (mut projector, mut rgba) = whole();
    rgba.fill(f32::NAN);
    projector.finish.is_dithered = false;
    let black = [0.02_f64, 0.03, 0.04].map(|level| (255.0 * level.powf(1.0 / 2.2)).round() as u8);
    let codes = Finisher::new(&projector).codes(&rgba);
    assert!(codes.chunks_exact(3).all(|codes| codes == black));
    assert_eq!(
        Finisher::new(&projector).codes(&rgba[..40]).len(),
        codes.len(),
        "a picture that is cut short"
    );
    // A mesh twice as wide as the screen: a quarter of its columns on each side see nothing.
    let wide = mesh_of(2, 2, |at| DVec2::new(0.6 * at.x, -0.2 * at.y));
    projector.finish = Finish { mesh: Some(wide), ..Finish::default() };
    let codes = Finisher::new(&projector).codes(&picture(64, 48, |_, _| [1.0; 3]));
    for (codes, i) in codes.chunks_exact(3).zip(0..) {
        let is_lit = (16..48).contains(&(i % 64));
        assert_eq!(codes, [if is_lit { 255 } else { 0 }; 3], "{}, {}", i % 64, i / 64);
    }
}

/// The place of the raster, in pixels, that the lens throws onto a point of the screen: by Newton's method on the lens
/// itself, which knows no mesh.
fn thrown_from(screen: DVec2, size: DVec2) -> DVec2 {
    let mut at = DVec2::ZERO;
    for _ in 0..30 {
        let miss = barrel(at) - screen;
        let [along_x, along_y] =
            [DVec2::X, DVec2::Y].map(|axis| (barrel(at + 1e-6 * axis) - barrel(at)) / 1e-6);
        let determinant = along_x.perp_dot(along_y);
        at -= DVec2::new(miss.perp_dot(along_y), along_x.perp_dot(miss)) / determinant;
    }
    (at + 1.0) / 2.0 * size
}

/// The middle of the light in the codes of one channel, pixels.
fn middle_of_light(codes: &[u8], width: u32, channel: usize) -> DVec2 {
    let lit = codes.chunks_exact(3).zip(0..).map(|(codes, i)| {
        let centre = DVec2::new(f64::from(i % width) + 0.5, f64::from(i / width) + 0.5);
        (f64::from(codes[channel]), centre)
    });
    let (sum, moment) =
        lit.fold((0.0, DVec2::ZERO), |(sum, moment), (light, at)| (sum + light, moment + light * at));
    moment / sum
}

/// How far from its place a spot of light lands, pixels, at most of three spots of three colours.
fn farthest_landing(mesh: Mesh, screen_from_pixel: Homography) -> f64 {
    let spots = [DVec2::new(0.11, 0.12), DVec2::new(-0.17, 0.05), DVec2::new(0.04, -0.14)];
    let (width, height) = (160, 120);
    let finish = Finish { mesh: Some(mesh), transfer: Transfer::Gamma(1.0), ..Finish::default() };
    let projector = projector(width, height, screen_from_pixel, finish);
    let inverse = projector.raster.inverse().unwrap();
    let spot = |at: DVec2, spot: DVec2| (-(at - spot).length_squared() / 3.0).exp() as f32;
    let rgba = picture(width, height, |x, y| {
        let at = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
        spots.map(|screen| spot(at, inverse.pixel(screen).unwrap()))
    });
    let codes = Finisher::new(&projector).codes(&rgba);
    let miss = |channel: usize| {
        let place = thrown_from(spots[channel], projector.raster.size());
        (middle_of_light(&codes, width, channel) - place).length()
    };
    (0..3).map(miss).fold(0.0, f64::max)
}

/// The lens is mirrored in x and looks down in y; the pictures are upright, or mirrored and pinned at crooked corners.
#[test]
fn light_lands_where_the_mesh_says() {
    let upright = whole_screen(160, 120);
    let corners = [[0.32, 0.24], [-0.31, 0.26], [-0.33, -0.23], [0.31, -0.25]].map(DVec2::from);
    let mirrored = Homography::of_corners(DVec2::new(160.0, 120.0), corners).unwrap();
    for screen_from_pixel in [upright, mirrored] {
        let right = farthest_landing(mesh_of(33, 25, barrel), screen_from_pixel);
        println!("light lands within {right:.3} px of its place");
        assert!(right < LANDING_PX, "{right} px");
        for spoil in [DVec2::new(-1.0, 1.0), DVec2::new(1.0, -1.0), DVec2::new(1.01, 1.0)] {
            let wrong = farthest_landing(mesh_of(33, 25, |at| barrel(at * spoil)), screen_from_pixel);
            assert!(wrong > 4.0 * LANDING_PX, "{spoil}: {wrong} px");
        }
    }
    let shifted = mesh_of(33, 25, |at| barrel(at) + DVec2::new(0.001, 0.0));
    assert!(farthest_landing(shifted, upright) > LANDING_PX, "half a pixel of the mesh shows");
    assert_eq!(mesh_of(2, 2, barrel).points()[0], barrel(DVec2::NEG_ONE).as_vec2() + Vec2::ZERO);
}

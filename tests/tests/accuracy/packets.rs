//! A ray sees the same whoever goes beside it, and alone.

use display_config::Display;
use lightloom_tests::draw;
use lightloom_tests::scenes::{self, TestScene};
use lightloom_tests::techniques;
use lightloom_tests::twin_scene::{TwinScene, View, view};
use optics::{Light, MimdaForm};
use twin::Cast;

const PROJECTOR: u32 = 5;
/// Raster of the projector.
const RASTER: [u32; 2] = [64, 48];
/// Coprime with the number of pixels: no two of a packet are neighbours.
const STRIDE: usize = 1237;
/// The canary changes so many neighbouring codes of the atlas.
const SPOILED: usize = 64;

/// Enhancers one by one, and several.
const ENHANCED: [&str; 5] =
    ["clip plane", "probe", "band picker", "layer opacity", "picker, probe and clip plane with MImDA"];

/// A scene with enhancers, one after the other; the last time without the importance that several come with.
fn enhanced(base: &TestScene) -> Vec<TestScene> {
    let mut all: Vec<TestScene> = ENHANCED.iter().map(|name| techniques::with(base, name)).collect();
    let mut chained = techniques::with(base, ENHANCED[4]);
    chained.frame.optics.mimda = None;
    all.push(chained);
    all
}

/// Scenes with and without skins, levels of detail that are shown, importance, deviations and enhancers.
fn all(display: &Display) -> Vec<TestScene> {
    let mut all = vec![techniques::bumps(display), scenes::sparse_vessels(display)];
    all.extend(scenes::cranium(display));
    for form in [MimdaForm::Paper, MimdaForm::Consistent] {
        all.extend(scenes::cranium_mimda(display, form));
    }
    let mut coarse = scenes::stored_vessels(display);
    coarse.frame.quality.lod_scale = 2.0;
    all.push(coarse);
    let enhanced: Vec<TestScene> =
        all.iter().filter(|scene| scene.frame.optics.mimda.is_none()).flat_map(enhanced).collect();
    all.extend(enhanced);
    all
}

/// Those of the raster, line by line.
fn pixels() -> Vec<(u32, u32)> {
    (0..RASTER[1]).flat_map(|y| (0..RASTER[0]).map(move |x| (x, y))).collect()
}

/// The pixels of a raster in another order.
fn scattered(pixels: &[(u32, u32)]) -> Vec<(u32, u32)> {
    (0..pixels.len()).map(|i| pixels[i * STRIDE % pixels.len()]).collect()
}

/// What all pixels bring back: in packets of neighbours, in packets of rays far apart, and one by one.
fn casts(twin: &TwinScene, view: &View<f32>, pixels: &[(u32, u32)]) -> [Vec<Cast<f32>>; 3] {
    let mixed = twin.cast_whole(view, &scattered(pixels));
    let mut ordered = mixed.clone();
    for (i, cast) in mixed.into_iter().enumerate() {
        ordered[i * STRIDE % pixels.len()] = cast;
    }
    let alone = pixels.iter().flat_map(|pixel| twin.cast_whole(view, std::slice::from_ref(pixel))).collect();
    [twin.cast_whole(view, pixels), ordered, alone]
}

#[test]
fn a_ray_sees_the_same_whoever_goes_beside_it() {
    let _turn = draw::turn();
    let display = Display::load("desk8").unwrap().with_rasters(RASTER[0], RASTER[1]);
    let pixels = pixels();
    for mut scene in all(&display) {
        for (light, blended, tolerance) in
            [(None, true, 1e-4), (Some(Light::default()), false, 1e-4), (None, false, 1e-2)]
        {
            scene.frame.light = light;
            scene.frame.quality.blended = blended;
            // A loose one has long steps, which are asked in several points whether they see anything.
            scene.frame.quality.tolerance = tolerance;
            let view = view(&display, PROJECTOR, &scene.frame, &*scene.source).rounded();
            let twin = TwinScene::new(&display, &scene.frame, &*scene.source).with_visible_cells();
            let what = format!("{}, {light:?}, blended {blended}, tolerance {tolerance}", scene.name);
            let [beside, apart, alone] = casts(&twin, &view, &pixels);
            let lit = alone.iter().filter(|cast| cast.rgba[3] > 0.0).count();
            assert!(lit > 100, "{what}: {lit} pixels show anything");
            let differ = |casts: &[Cast<f32>]| casts.iter().zip(&alone).filter(|(a, b)| a != b).count();
            assert_eq!([differ(&beside), differ(&apart)], [0, 0], "{what}: rays that differ");
        }
    }
}

/// The canary: what one ray alone meets otherwise is found.
#[test]
fn a_ray_that_sees_something_else_is_found() {
    let display = Display::load("desk8").unwrap().with_rasters(RASTER[0], RASTER[1]);
    let scene = techniques::bumps(&display);
    let view = view(&display, PROJECTOR, &scene.frame, &*scene.source).rounded();
    let twin = TwinScene::new(&display, &scene.frame, &*scene.source).with_visible_cells();
    let mut spoiled = twin.clone();
    let middle = spoiled.atlas.len() / 2;
    spoiled.atlas[middle..middle + SPOILED].iter_mut().for_each(|code| *code ^= 1);
    let pixels = pixels();
    assert_ne!(twin.cast_whole(&view, &pixels), spoiled.cast_whole(&view, &pixels));
}

//! The scenes that pictures are tested on.

use crate::data;
use crate::made_once::MadeOnce;
use crate::remembered::Remembered;
use bricks::BrickSource;
use bricks::procedural::ProceduralVolume;
use display_config::Display;
use glam::{DAffine3, DQuat, DVec3, UVec3};
use optics::{Curve, Light, Mimda, MimdaForm, Optics};
use protocol::FrameState;
use std::f64::consts::FRAC_PI_2;
use std::sync::Arc;

/// A scene.
#[derive(Clone)]
pub struct TestScene {
    /// Its name.
    pub name: &'static str,
    /// Its volume.
    pub source: Arc<dyn BrickSource>,
    /// Its one frame.
    pub frame: FrameState,
}

/// Extinction control points in data units.
pub type Points = Vec<(f64, f64)>;

/// Colour control points in data units.
pub type Colours = Vec<(f64, [f64; 3])>;

/// An optical model from control points in data units; extinction per finest voxel.
pub fn optics(domain: (f64, f64), extinction: &Points, colour: &Colours) -> Optics {
    let s = |value: f64| (value - domain.0) / (domain.1 - domain.0);
    let extinction = extinction.iter().map(|&(v, tau)| (s(v), tau)).collect();
    let colour = colour.iter().map(|&(v, rgb)| (s(v), DVec3::from(rgb))).collect();
    let extinction = Curve::new(extinction).expect("the points of a test scene make a curve");
    let colour = Curve::new(colour).expect("the points of a test scene make a curve");
    Optics::plain(domain, extinction, colour)
}

/// The volume's centre at the screen's centre, its longest edge `longest_m` long, turned by `rotation`.
pub fn placed(source: &dyn BrickSource, longest_m: f64, rotation: DQuat) -> DAffine3 {
    let dims = source.shape().dims().as_dvec3();
    let spacing = source.voxel_size_m();
    let scale = longest_m / (dims * spacing).max_element();
    DAffine3::from_quat(rotation)
        * DAffine3::from_scale(spacing * scale)
        * DAffine3::from_translation(-0.5 * dims)
}

/// A frame of `display` at default quality.
pub fn frame(
    display: &Display,
    display_from_volume: DAffine3,
    optics: Optics,
    light: Option<Light>,
) -> FrameState {
    FrameState { light, ..FrameState::still(display.observer_in_display, display_from_volume, optics) }
}

/// Whether pictures are to be tested whole: `LIGHTLOOM_FULL_SIZE=1`, for figures that are kept.
pub fn full_size() -> bool {
    std::env::var("LIGHTLOOM_FULL_SIZE").as_deref() == Ok("1")
}

/// desk8 with rasters of `width` × `height` pixels, or with its own at full size.
///
/// # Panics
/// The preset cannot be read.
pub fn small_desk8(width: u32, height: u32) -> Display {
    let display = Display::load("desk8").expect("desk8 is a preset");
    if full_size() { display } else { display.with_rasters(width, height) }
}

/// The curve with every value times `factor`.
pub fn scaled(curve: &Curve<f64>, factor: f64) -> Curve<f64> {
    let points = curve.points().iter().map(|&(s, value)| (s, value * factor)).collect();
    Curve::new(points).expect("a curve times a positive number is a curve")
}

/// The volume of this name for every scene of the process, its bricks in memory once they were asked for.
fn shared<S: BrickSource + 'static>(name: String, make: impl FnOnce() -> S) -> Arc<dyn BrickSource> {
    static VOLUMES: MadeOnce<Arc<dyn BrickSource>> = MadeOnce::new();
    Arc::clone(&VOLUMES.get(name, || Arc::new(Remembered::new(Arc::new(make())))))
}

fn procedural(name: &str, edge: u32) -> Arc<dyn BrickSource> {
    let make = || ProceduralVolume::new(name, UVec3::splat(edge), 1e-3).expect("the name is one of ours");
    shared(format!("{name}@{edge}"), make)
}

/// Voxels along an edge of the shells, for which their extinction per voxel is meant.
const SHELLS_EDGE: u32 = 128;

/// Nested semi-transparent shells, shaded.
pub fn shells(display: &Display) -> TestScene {
    shells_of(display, SHELLS_EDGE)
}

/// The same of so many voxels along an edge, and as thick.
pub fn shells_of(display: &Display, edge: u32) -> TestScene {
    let source = procedural("shells", edge);
    let mut optics = optics(
        (0.0, 1.0),
        &vec![(0.15, 0.0), (0.35, 0.03), (0.5, 0.0), (0.6, 0.0), (0.75, 0.15), (0.9, 0.02), (1.0, 0.3)],
        &vec![(0.2, [0.9, 0.35, 0.1]), (0.6, [0.1, 0.6, 0.9]), (1.0, [1.0, 0.95, 0.8])],
    );
    optics.extinction = scaled(&optics.extinction, f64::from(SHELLS_EDGE) / f64::from(edge));
    let place = placed(&*source, 0.6 * display.height_m, DQuat::from_rotation_y(0.4));
    let frame = frame(display, place, optics, Some(Light::default()));
    TestScene { name: "shells", source, frame }
}

/// The Marschner–Lobb signal as an opaque surface, shaded.
pub fn marschner_lobb(display: &Display) -> TestScene {
    let source = procedural("marschner-lobb", 64);
    let optics = optics(
        (0.0, 1.0),
        &vec![(0.45, 0.0), (0.6, 1.5)],
        &vec![(0.0, [0.2, 0.5, 0.9]), (1.0, [0.9, 0.8, 0.3])],
    );
    let place = placed(&*source, 0.6 * display.height_m, DQuat::from_rotation_x(0.9));
    let frame = frame(display, place, optics, Some(Light::default()));
    TestScene { name: "marschner-lobb", source, frame }
}

/// Thin opaque vessels in empty space, unshaded.
pub fn sparse_vessels(display: &Display) -> TestScene {
    vessels_of("sparse-vessels", procedural("sparse-vessels", 256), display)
}

/// The same as a store, fewer voxels of them: what coarse voxels lose most of.
pub fn stored_vessels(display: &Display) -> TestScene {
    vessels_of("stored vessels", shared("stored vessels".into(), data::vessels), display)
}

fn vessels_of(name: &'static str, source: Arc<dyn BrickSource>, display: &Display) -> TestScene {
    let optics = optics(
        (0.0, 1.0),
        &vec![(0.05, 0.0), (0.6, 0.8), (1.0, 2.0)],
        &vec![(0.0, [0.5, 0.05, 0.05]), (1.0, [1.0, 0.5, 0.3])],
    );
    let place = placed(&*source, 0.7 * display.height_m, DQuat::from_rotation_y(-0.3));
    TestScene { name, source, frame: frame(display, place, optics, None) }
}

/// Skin and bone of the cranium CT, shaded, the head upright.
pub fn cranium(display: &Display) -> Option<TestScene> {
    let store = data::cranium()?;
    let source = shared("cranium".into(), || store);
    let optics = optics(
        (-1024.0, 3071.0),
        &vec![(-400.0, 0.0), (-150.0, 0.03), (100.0, 0.01), (200.0, 0.02), (500.0, 0.5), (3000.0, 0.9)],
        &vec![(-400.0, [0.8, 0.45, 0.3]), (150.0, [0.8, 0.3, 0.2]), (500.0, [0.95, 0.9, 0.8])],
    );
    let upright = DQuat::from_rotation_y(0.5) * DQuat::from_rotation_x(-FRAC_PI_2);
    let place = placed(&*source, 0.8 * display.height_m, upright);
    let frame = frame(display, place, optics, Some(Light::default()));
    Some(TestScene { name: "cranium", source, frame })
}

/// The cranium with its bone more important than what lies before it.
pub fn cranium_mimda(display: &Display, form: MimdaForm) -> Option<TestScene> {
    let scene = cranium(display)?;
    let s = |value: f64| scene.frame.optics.normalise(value);
    let importance = Curve::new(vec![(s(100.0), 0.0), (s(600.0), 1.0)]).expect("rising points make a curve");
    let mut frame = scene.frame.clone();
    frame.optics.mimda = Some(Mimda { importance, gamma: 0.8, form });
    let name = match form {
        MimdaForm::Consistent => "cranium, consistent MImDA",
        MimdaForm::Paper => "cranium, MImDA as published",
    };
    Some(TestScene { name, frame, ..scene })
}

/// The head MRI as a cloud, unshaded.
pub fn head_mri(display: &Display) -> Option<TestScene> {
    let store = data::head_mri()?;
    let source = shared("head MRI".into(), || store);
    let optics = optics(
        (0.0, 255.0),
        &vec![(25.0, 0.0), (60.0, 0.02), (110.0, 0.06), (140.0, 0.0), (255.0, 0.1)],
        &vec![(25.0, [0.3, 0.2, 0.5]), (100.0, [0.9, 0.6, 0.5]), (200.0, [1.0, 1.0, 0.9])],
    );
    let upright = DQuat::from_rotation_y(0.8) * DQuat::from_rotation_x(-FRAC_PI_2);
    let place = placed(&*source, 0.8 * display.height_m, upright);
    Some(TestScene { name: "head MRI", source, frame: frame(display, place, optics, None) })
}

/// The bright part of noise.
pub fn noise(display: &Display) -> TestScene {
    let source = shared("noise".into(), data::noise);
    let optics = optics(
        (0.0, 255.0),
        &vec![(150.0, 0.0), (200.0, 0.3), (255.0, 0.3)],
        &vec![(150.0, [0.2, 0.6, 0.9]), (220.0, [1.0, 0.8, 0.3])],
    );
    let place = placed(&*source, 0.5 * display.height_m, DQuat::from_rotation_y(0.4));
    TestScene { name: "noise", source, frame: frame(display, place, optics, None) }
}

/// Every scene of which the data is there.
pub fn all(display: &Display) -> Vec<TestScene> {
    [
        Some(shells(display)),
        Some(marschner_lobb(display)),
        Some(sparse_vessels(display)),
        cranium(display),
        cranium_mimda(display, MimdaForm::Consistent),
        head_mri(display),
    ]
    .into_iter()
    .flatten()
    .collect()
}

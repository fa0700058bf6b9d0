//! The illustrative techniques, each on a scene that shows it.

use crate::closure_volume::ClosureVolume;
use crate::remembered::Remembered;
use crate::scenes::{self, TestScene};
use bricks::BrickSource;
use display_config::Display;
use glam::{DQuat, DVec3, UVec3};
use optics::{
    BandPicker, ClipPlane, Curve, Detail, Enhancer, LayerOpacity, Light, Material, Mimda, MimdaForm, Probe,
    Ramp, Trapezoid,
};
use std::sync::{Arc, OnceLock};

/// A plane across the middle of the screen, that cuts away what lies before it.
pub fn clip_plane() -> ClipPlane {
    ClipPlane {
        point_in_display: DVec3::new(0.0, 0.0, 0.01),
        normal_in_display: DVec3::new(0.3, 0.2, 1.0).normalize(),
        context: Ramp { low: 0.05, high: 0.4 },
        thickness_m: 0.012,
        boost: ClipPlane::OPAQUE,
        strength: 1.0,
    }
}

/// A probe in the front half of what floats around the screen's centre.
pub fn probe() -> Probe {
    Probe {
        centre_in_display: DVec3::new(0.005, 0.01, 0.07),
        radius_m: 0.09,
        axis_in_display: DVec3::NEG_Z,
        facing: Ramp { low: 0.4, high: 0.98 },
        gradient_most: 0.08,
        edges: Ramp { low: 0.02, high: 0.5 },
        strength: 1.0,
    }
}

/// A picker of a band of s.
pub fn band_picker(corners: [f64; 4]) -> BandPicker {
    BandPicker {
        band: band(corners),
        axis_in_display: DVec3::NEG_Z,
        facing: Ramp { low: 0.5, high: 1.0 },
        strength: 0.8,
    }
}

/// A layer of s shown to viewers on one side.
pub fn layer_opacity(corners: [f64; 4]) -> LayerOpacity {
    LayerOpacity {
        band: band(corners),
        axis_in_display: DVec3::X,
        facing: Ramp { low: -0.3, high: 0.3 },
        away: 0.05,
        toward: 1.5,
    }
}

fn band(corners: [f64; 4]) -> Trapezoid {
    Trapezoid::new(corners).expect("the corners of a test scene rise")
}

/// A smooth field of bumps, 56 voxels along each axis.
pub fn bumps(display: &Display) -> TestScene {
    let field = |p: DVec3| 0.5 + 0.3 * (0.2 * p.x).sin() * (0.15 * p.y).cos() * (0.1 * p.z + 1.0).sin();
    static SOURCE: OnceLock<Arc<dyn BrickSource>> = OnceLock::new();
    let volume =
        || Arc::new(Remembered::new(Arc::new(ClosureVolume::new(UVec3::splat(56), (0.0, 1.0), field))));
    let source = Arc::clone(SOURCE.get_or_init(|| volume()));
    let optics = scenes::optics(
        (0.0, 1.0),
        &vec![(0.2, 0.0), (0.45, 0.02), (0.6, 0.1), (0.8, 0.3)],
        &vec![(0.2, [0.9, 0.3, 0.1]), (0.6, [0.2, 0.7, 0.9]), (0.8, [0.9, 0.9, 0.7])],
    );
    let place = scenes::placed(&*source, 0.6 * display.height_m, DQuat::from_rotation_y(0.4));
    let frame = scenes::frame(display, place, optics, Some(Light::default()));
    TestScene { name: "bumps", source, frame }
}

/// A change of a scene that shows one technique; the numbers are in units of s.
type Change = fn(&mut TestScene);

/// Every technique by name.
pub const TECHNIQUES: [(&str, Change); 12] = [
    ("quadrilinear filtering", |scene| {
        scene.frame.quality.quadrilinear = true;
        scene.frame.quality.lod_scale = 2.3;
    }),
    ("materials", |scene| {
        let at = |s: f64, ambient: f64, specular: f64, shininess: f64| {
            (s, Material { ambient, diffuse: 1.0 - ambient, specular, shininess })
        };
        let points = vec![at(0.2, 0.9, 0.0, 1.0), at(0.45, 0.1, 0.9, 40.0), at(0.8, 0.4, 0.2, 8.0)];
        scene.frame.optics.materials = Some(Curve::new(points).expect("the points rise"));
    }),
    ("unsharp masking", |scene| {
        scene.frame.light =
            scene.frame.light.map(|l| Light { detail: Detail::Unsharp { strength: 1.5 }, ..l });
    }),
    ("exaggerated shading", |scene| {
        scene.frame.light =
            scene.frame.light.map(|l| Light { detail: Detail::Exaggerated { contrast: 4.0 }, ..l });
    }),
    ("detail over levels", |scene| {
        scene.frame.quality.quadrilinear = true;
        scene.frame.quality.lod_scale = 1.4;
        scene.frame.light =
            scene.frame.light.map(|l| Light { detail: Detail::Unsharp { strength: 1.0 }, ..l });
    }),
    ("refraction", |scene| {
        let index = Curve::new(vec![(0.15, 1.0), (0.5, 1.12), (0.9, 1.2)]).expect("the points rise");
        scene.frame.optics.refraction = Some(index);
    }),
    ("clip plane", |scene| scene.frame.optics.enhancers = vec![Enhancer::ClipPlane(clip_plane())]),
    ("probe", |scene| scene.frame.optics.enhancers = vec![Enhancer::Probe(probe())]),
    ("band picker", |scene| {
        scene.frame.optics.enhancers = vec![Enhancer::BandPicker(band_picker([0.35, 0.4, 0.5, 0.7]))];
    }),
    ("layer opacity", |scene| {
        scene.frame.optics.enhancers = vec![Enhancer::LayerOpacity(layer_opacity([0.1, 0.2, 0.3, 0.4]))];
    }),
    ("picker, probe and clip plane with MImDA", |scene| {
        let importance = Curve::new(vec![(0.3, 0.1), (0.6, 0.7)]).expect("the points rise");
        scene.frame.optics.mimda = Some(Mimda { importance, gamma: 0.8, form: MimdaForm::Consistent });
        scene.frame.optics.enhancers = vec![
            Enhancer::BandPicker(band_picker([0.35, 0.4, 0.5, 0.7])),
            Enhancer::Probe(probe()),
            Enhancer::ClipPlane(ClipPlane { boost: 6.0, strength: 0.9, ..clip_plane() }),
        ];
    }),
    ("probe by importance", |scene| {
        let importance = Curve::new(vec![(0.35, 0.05), (0.6, 0.9)]).expect("the points rise");
        scene.frame.optics.mimda = Some(Mimda { importance, gamma: 0.0, form: MimdaForm::Consistent });
        scene.frame.optics.enhancers = vec![Enhancer::Probe(probe())];
    }),
];

/// A scene with a technique on.
pub fn with(scene: &TestScene, name: &'static str) -> TestScene {
    let (name, change) = TECHNIQUES.iter().find(|(known, _)| *known == name).expect("the technique is known");
    let mut changed = TestScene { name, ..scene.clone() };
    change(&mut changed);
    changed
}

/// The scenes that techniques are tested on: one smooth, one real.
pub fn bases(display: &Display) -> Vec<TestScene> {
    std::iter::once(bumps(display)).chain(scenes::cranium(display)).collect()
}

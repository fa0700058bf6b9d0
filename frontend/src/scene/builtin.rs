//! Scenes that need no file.

use super::{Edits, Look, LookWish, Motion, Placement, Scene, Size, VolumeSource, WishedLook, placement};
use glam::DVec3;
use optics::{Curve, Light, Quality};
use std::path::Path;

/// Control points over s: optical depth across the volume, and linear red, green, blue.
type Points = &'static [(f64, f64, [f64; 3])];

/// Nested translucent shells: each band of values is one skin, blue outside, glowing inside. The field's shells
/// peak at s = 0.13, 0.42, 0.75 and 0.97.
const SHELLS: Points = &[
    (0.0, 0.0, [0.02, 0.25, 0.75]),
    (0.085, 0.0, [0.02, 0.25, 0.75]),
    (0.11, 7.0, [0.02, 0.4, 0.9]),
    (0.14, 0.0, [0.05, 0.55, 0.7]),
    (0.31, 0.0, [0.35, 0.06, 0.6]),
    (0.38, 20.0, [0.7, 0.03, 0.45]),
    (0.43, 0.0, [0.85, 0.1, 0.35]),
    (0.62, 0.0, [0.95, 0.2, 0.05]),
    (0.7, 45.0, [1.0, 0.26, 0.02]),
    (0.76, 0.0, [1.0, 0.45, 0.06]),
    (0.86, 0.0, [1.0, 0.75, 0.2]),
    (0.93, 220.0, [1.0, 0.85, 0.45]),
    (1.0, 220.0, [1.0, 0.95, 0.7]),
];

/// The test signal's surface at s = 0.5, with a thin veil over it.
const MARSCHNER_LOBB: Points = &[
    (0.0, 0.0, [0.02, 0.3, 0.5]),
    (0.36, 0.0, [0.02, 0.3, 0.5]),
    (0.42, 5.0, [0.05, 0.5, 0.6]),
    (0.46, 0.0, [0.2, 0.5, 0.5]),
    (0.48, 0.0, [0.9, 0.42, 0.08]),
    (0.52, 900.0, [0.95, 0.5, 0.12]),
    (0.75, 900.0, [0.6, 0.1, 0.2]),
    (1.0, 900.0, [0.2, 0.03, 0.25]),
];

/// Vessels: a red wall that lets the bright core through.
const SPARSE_VESSELS: Points = &[
    (0.0, 0.0, [0.3, 0.01, 0.03]),
    (0.08, 0.0, [0.35, 0.01, 0.04]),
    (0.3, 110.0, [0.65, 0.04, 0.05]),
    (0.6, 320.0, [0.95, 0.25, 0.08]),
    (1.0, 900.0, [1.0, 0.75, 0.4]),
];

/// Any volume that nothing is known of: nothing low, then a cool veil, then warm and solid toward the high values.
const ANY_VOLUME: Points = &[
    (0.0, 0.0, [0.02, 0.12, 0.4]),
    (0.15, 0.0, [0.03, 0.2, 0.55]),
    (0.35, 3.0, [0.1, 0.45, 0.6]),
    (0.6, 14.0, [0.8, 0.5, 0.25]),
    (0.8, 70.0, [0.95, 0.75, 0.5]),
    (1.0, 250.0, [1.0, 0.95, 0.9]),
];

/// The scene of a procedural volume, with the look made for it.
pub(super) fn procedural_scene(argument: &str, volume: VolumeSource) -> Scene {
    Scene { name: argument.to_owned(), ..default_scene(volume) }
}

/// The scene of a store, whose look is chosen by its values.
pub(super) fn store_scene(path: &Path) -> Scene {
    let name = path.file_stem().unwrap_or(path.as_os_str()).to_string_lossy().into_owned();
    Scene { name, ..default_scene(VolumeSource::Store(path.to_owned())) }
}

/// A still scene in the middle of the screen, with the look that fits the volume.
pub(super) fn default_scene(volume: VolumeSource) -> Scene {
    Scene {
        name: String::new(),
        voxel_size_m: None,
        placement: default_placement(&volume),
        look: default_look(&volume),
        wish: default_wish(&volume),
        bands: Vec::new(),
        enhancers: Vec::new(),
        light: Some(default_light(&volume)),
        quality: Quality::default(),
        eta: None,
        observer_m: None,
        tool: None,
        motion: Motion::default(),
        edits: Edits::default(),
        source_place: None,
        frame_count: 1,
        rate_hz: 30.0,
        volume,
    }
}

/// Procedural fields are smooth: their shells and vessels need a light that responds to gentle slopes, whatever the
/// number of voxels that a slope is spread over.
fn default_light(volume: &VolumeSource) -> Light {
    match volume {
        VolumeSource::Store(_) => Light::default(),
        VolumeSource::Procedural { dims, .. } => Light {
            ambient: 0.3,
            diffuse: 0.95,
            specular: 0.12,
            gradient_half: 1.5 / f64::from(dims.max_element()),
            ..Light::default()
        },
    }
}

/// Turned to give a good view: into the shells, along the ripples, onto the tree.
fn default_placement(volume: &VolumeSource) -> Placement {
    let (deg, share) = match procedural_name(volume) {
        Some("shells") => (DVec3::new(20.0, -35.0, 0.0), 1.0),
        Some("marschner-lobb") => (DVec3::new(-50.0, 0.0, 0.0), 0.58),
        Some("sparse-vessels") => (DVec3::new(-90.0, 20.0, 0.0), 0.85),
        _ => (DVec3::ZERO, 0.75),
    };
    let (rotation, size) = (placement::rotation_from_deg(deg), Size::ScreenShare(share));
    Placement { rotation, size, ..Placement::default() }
}

/// Volumes that are not made here wish for a look of the library.
fn default_wish(volume: &VolumeSource) -> LookWish {
    let look = match volume {
        VolumeSource::Store(_) => WishedLook::Best,
        VolumeSource::Procedural { .. } => WishedLook::BuiltIn,
    };
    LookWish { look, keeps_light: false }
}

/// The look of a volume that no scene file describes.
pub(super) fn default_look(volume: &VolumeSource) -> Look {
    let points = match procedural_name(volume) {
        Some("shells") => SHELLS,
        Some("marschner-lobb") => MARSCHNER_LOBB,
        Some("sparse-vessels") => SPARSE_VESSELS,
        _ => ANY_VOLUME,
    };
    let depth = points.iter().map(|&(s, depth, _)| (s, depth)).collect();
    let colour = points.iter().map(|&(s, _, rgb)| (s, DVec3::from_array(rgb))).collect();
    Look::Relative {
        depth_across: Curve::new(depth)
            .expect("the tables above are sorted and finite: a test builds them all"),
        colour: Curve::new(colour).expect("the tables above are sorted and finite: a test builds them all"),
    }
}

fn procedural_name(volume: &VolumeSource) -> Option<&str> {
    match volume {
        VolumeSource::Store(_) => None,
        VolumeSource::Procedural { name, .. } => Some(name),
    }
}
